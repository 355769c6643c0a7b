//! Events of collective motion, each with the ten measures of the package swaRmverse.
//!
//! M. Papadopoulou, I. Furtbauer, L. R. O'Bryan, S. Garnier, D. G. Georgopoulou, A. M. Bracken, C. Christensen, A. J. King (2023), Dynamics of
//! collective motion across time and species, Philosophical Transactions of the Royal Society B 378:20220068.
//!
//! Written from the package's documentation, not from its code. Where that is silent: the moving average is centred and takes what
//! there is at the ends; the nearest neighbour is among those found; the box is the one of least area about the convex hull.

use crate::hull::flat_hull;
use crate::metric::takes;
use crate::sample::{mean, mean_vector, spread};
use crate::{Bounds, Parameter, Sample};
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};
use space::Vector;

/// Over how long speeds and polarisations are averaged.
const WINDOW: Parameter = Parameter {
    name: "window",
    unit: "s",
    default: Some(1.0),
    bounds: Bounds::Positive,
    about: "Width of the moving average (a whole odd number of frames).",
};

/// Above which speed.
const MOVING_SPEED: Parameter = Parameter {
    name: "moving_speed",
    unit: "length/s",
    default: None,
    bounds: Bounds::Any,
    about: "Above this mean speed a group moves (speed_lim).",
};

/// Above which polarisation.
const LEAST_POLARISATION: Parameter = Parameter {
    name: "least_polarisation",
    unit: "1",
    default: None,
    bounds: Bounds::Any,
    about: "Above this polarisation a group moves together (pol_lim).",
};

takes! {
    /// `motion_events`.
    pub struct MotionEvents { window: WINDOW, moving_speed: MOVING_SPEED, least_polarisation: LEAST_POLARISATION }
}

impl TrackMetric for MotionEvents {
    const CARD: TrackCard = TrackCard {
        id: "motion_events",
        title: "Events of collective motion",
        definition: "an event: consecutive frames in which the mean speed and the polarisation, each a moving average \
                    over window seconds, are above moving_speed and least_polarisation; of each event the means and \
                    standard deviations (divisor n - 1) over its frames",
        variant: "as in swaRmverse: polarisation of headings; shape is the angle between the long side of the box \
                    and the mean heading (0 oblong, pi/2 wide); front is 1 - bearing/pi of the nearest neighbour (1 \
                    ahead, 0 behind); exact headings along x count, which the package drops",
        source: "Papadopoulou et al. 2023; documentation of swaRmverse 0.1.1",
        counted: Counted::Headings,
        dimensions: &[2],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::frame(),
            Field::time(),
            Field::number("duration", "s", "Frames of the event times the time between frames."),
            Field::number("n", "1", "Mean number of individuals."),
            Field::number("mean_mean_nnd", "length", "Mean over frames of the mean nearest-neighbour distance."),
            Field::number("mean_sd_nnd", "length", "Mean over frames of its standard deviation between individuals."),
            Field::number("sd_mean_nnd", "length", "Standard deviation over frames of its mean."),
            Field::number("mean_pol", "1", "Mean polarisation."),
            Field::number("sd_pol", "1", "Standard deviation of the polarisation."),
            Field::number("cv_speed", "1", "Coefficient of variation of the mean speed."),
            Field::number(
                "mean_sd_front",
                "1",
                "Mean over frames of the standard deviation of front between individuals.",
            ),
            Field::number("mean_mean_bangl", "rad", "Mean over frames of the mean bearing to the nearest neighbour."),
            Field::number("mean_shape", "rad", "Mean angle between the long side of the group and its heading."),
            Field::number("sd_shape", "rad", "Standard deviation of that angle."),
        ],
        edge: "no row without an event; standard deviations NaN in an event of one frame",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let Some(interval) = tracks.interval() else { return Ok(found) };
        let frames = tracks.frames().len();
        let mut sample = Sample::empty();
        let mut moments = Vec::with_capacity(frames);
        for frame in 0..frames {
            tracks.sample_into(frame, &mut sample);
            moments.push(moment(&sample));
        }
        let half = ((self.window / interval).round() as usize).saturating_sub(1) / 2;
        let smooth = |of: fn(&Moment) -> f64, frame: usize| {
            let near = &moments[frame.saturating_sub(half)..frames.min(frame + half + 1)];
            mean(near.iter().map(of).filter(|value| value.is_finite())).unwrap_or(f64::NAN)
        };
        let collective = |frame: usize| {
            smooth(|moment| moment.speed, frame) > self.moving_speed
                && smooth(|moment| moment.polarisation, frame) > self.least_polarisation
        };
        let mut start = None;
        for frame in 0..=frames {
            let goes_on = frame < frames && collective(frame);
            let follows = frame < frames && tracks.interval_before(frame).is_some();
            if let Some(first) = start
                && !(goes_on && follows)
            {
                let event = &moments[first..frame];
                let values =
                    |of: fn(&Moment) -> f64| event.iter().map(of).filter(|v| v.is_finite()).collect::<Vec<_>>();
                let mean_of = |of: fn(&Moment) -> f64| mean(values(of).into_iter()).unwrap_or(f64::NAN);
                let sd_of = |of: fn(&Moment) -> f64| spread(&values(of)).map_or(f64::NAN, |spread| spread.1);
                found.push([
                    tracks.frames()[first] as f64,
                    tracks.times()[first],
                    event.len() as f64 * interval,
                    mean_of(|moment| moment.members),
                    mean_of(|moment| moment.nearest),
                    mean_of(|moment| moment.nearest_sd),
                    sd_of(|moment| moment.nearest),
                    mean_of(|moment| moment.polarisation),
                    sd_of(|moment| moment.polarisation),
                    sd_of(|moment| moment.speed) / mean_of(|moment| moment.speed),
                    mean_of(|moment| moment.front_sd),
                    mean_of(|moment| moment.bearing),
                    mean_of(|moment| moment.shape),
                    sd_of(|moment| moment.shape),
                ]);
                start = None;
            }
            if goes_on && start.is_none() {
                start = Some(frame);
            }
        }
        Ok(found)
    }
}

/// What a frame adds to an event.
struct Moment {
    members: f64,
    speed: f64,
    polarisation: f64,
    nearest: f64,
    nearest_sd: f64,
    bearing: f64,
    front_sd: f64,
    shape: f64,
}

fn moment<const D: usize>(sample: &Sample<D>) -> Moment {
    let heading = mean_vector(sample.headings().map(|(_, heading)| heading));
    let nearest = sample.nearest_distances().unwrap_or_default();
    let bearings = bearings(sample);
    let fronts: Vec<f64> = bearings.iter().map(|bearing| 1.0 - bearing / core::f64::consts::PI).collect();
    let sd = |values: &[f64]| spread(values).map_or(f64::NAN, |spread| spread.1);
    let shape = || {
        let places: Vec<Vector<f64, 2>> = sample.unwrapped()?.iter().map(|place| Vector::of(&place.0)).collect();
        let angle = long_side(&places)?.angle_to(Vector::of(&heading?.0));
        Some(angle.min(core::f64::consts::PI - angle))
    };
    Moment {
        members: sample.len() as f64,
        speed: mean(sample.velocities().map(Vector::length)).unwrap_or(f64::NAN),
        polarisation: heading.map_or(f64::NAN, Vector::length),
        nearest: mean(nearest.iter().copied()).unwrap_or(f64::NAN),
        nearest_sd: sd(nearest),
        bearing: mean(bearings.iter().copied()).unwrap_or(f64::NAN),
        front_sd: sd(&fronts),
        shape: shape().unwrap_or(f64::NAN),
    }
}

/// Angle (rad) between the heading of each member and the direction to its nearest neighbour, for those with a heading.
fn bearings<const D: usize>(sample: &Sample<D>) -> Vec<f64> {
    let Some(nearest) = sample.nearest_others(1) else { return Vec::new() };
    let bearing = |(i, &(_, j)): (usize, &(f64, u32))| {
        let heading = sample.known_velocities()[i].filter(|v| !v.is_tiny())?;
        let places = sample.positions();
        Some(heading.angle_to(sample.space().offset(places[i], places[j as usize])))
    };
    nearest.iter().enumerate().filter_map(bearing).collect()
}

/// The direction of the longer side of the box of least area about places. `None` where all are on one line.
fn long_side(places: &[Vector<f64, 2>]) -> Option<Vector<f64, 2>> {
    let corners: Vec<_> = flat_hull(places)?.corners.into_iter().map(|corner| places[corner]).collect();
    let mut best: Option<(f64, Vector<f64, 2>)> = None;
    for (&here, &next) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let along = (next - here).unit();
        let width = |axis: Vector<f64, 2>| {
            let ends = |(low, high): (f64, f64), x: f64| (low.min(x), high.max(x));
            let (low, high) = corners.iter().map(|&c| (c - here).dot(axis)).fold((0.0, 0.0), ends);
            high - low
        };
        let (length, breadth) = (width(along), width(along.left()));
        if best.is_none_or(|(least, _)| length * breadth < least) {
            best = Some((length * breadth, if length >= breadth { along } else { along.left() }));
        }
    }
    best.map(|(_, side)| side)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::over_time::sketch::{Fine, close, tracks};
    use space::Space;

    #[test]
    fn a_row_that_goes_and_rests() -> Fine {
        // three in a row along x, two apart: at rest for 5 frames, on their way for 10, at rest again
        let place =
            |frame: i64, k: u32| Some([(frame - 4).clamp(0, 10) as f64 + 2.0 * f64::from(k), 0.1 * f64::from(k % 2)]);
        let tracks = tracks(Space::open(), 1.0, 20, 3, place)?;
        let found = MotionEvents { window: 1.0, moving_speed: 0.5, least_polarisation: 0.5 }.on(&tracks)?;
        assert_eq!(found.len(), 1);
        let row = found.row(0);
        let apart = 4.01f64.sqrt();
        close(&row[..10], &[5.0, 5.0, 10.0, 3.0, apart, 0.0, 0.0, 1.0, 0.0, 0.0]);
        // the last looks ahead, the middle back (its nearest, of equal ones, is the last), the first back
        let angle = 0.1f64.atan2(2.0);
        let pi = core::f64::consts::PI;
        let bearings = [angle, pi - angle, pi - angle];
        let fronts = bearings.map(|bearing| 1.0 - bearing / pi);
        let sd = spread(&fronts).map_or(0.0, |spread| spread.1);
        close(&row[10..], &[sd, bearings.iter().sum::<f64>() / 3.0, 0.0, 0.0]);
        Ok(())
    }

    #[test]
    fn the_box_of_least_area() {
        let places = [[0.0, 0.0], [4.0, 3.0], [4.0 - 0.6, 3.0 + 0.8], [-0.6, 0.8]].map(Vector);
        let along = long_side(&places).unwrap_or(Vector::ZERO);
        close(&[along.dot(Vector([0.8, 0.6])).abs()], &[1.0]);
    }
}
