//! How much of a box a group visits.

use crate::metric::takes;
use crate::{Bounds, Ground, Kind, Parameter};
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};
use std::collections::BTreeSet;

/// The readings, the primary one first.
const READINGS: [&str; 4] = ["coverage5", "coverage10", "coverage10_full", "at_once"];

/// How many make a visit.
const SHARE: Parameter = Parameter {
    name: "share",
    unit: "1",
    default: Some(0.3),
    bounds: Bounds::Positive,
    about: "A cell is visited where this share of all individuals was seen in it.",
};

/// Over how long.
const WINDOW: Parameter = Parameter {
    name: "window",
    unit: "s",
    default: Some(120.0),
    bounds: Bounds::Positive,
    about: "The last so many seconds count, but in coverage10_full.",
};

/// How often.
const INTERVAL: Parameter = Parameter {
    name: "interval",
    unit: "s",
    default: Some(1.0),
    bounds: Bounds::Positive,
    about: "Time between the frames that are looked at.",
};

takes! {
    /// `coverage`.
    pub struct Coverage { share: SHARE, window: WINDOW, interval: INTERVAL }
}

impl TrackMetric for Coverage {
    const CARD: TrackCard = TrackCard {
        id: "coverage",
        title: "Coverage",
        definition: "100 times the share of equal cells, in a box of cells^D, in which at least share times g \
                    individuals were seen: distinct ones over the window (or at once), sampled at the interval; g \
                    the number of individuals",
        variant: "four readings: 5 cells a side over the last 2 minutes (primary), 10 over these, 10 over \
                    everything, 5 at once; obstacles not left out; where an axis has neither walls nor periods the box \
                    goes from the least to the greatest place of the recording",
        source: "behaviour selection, section 7 (D-COV)",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        fields: &[
            Field { name: "reading", unit: "", kind: Kind::Label(&READINGS), about: "Which reading." },
            Field::count("cells_a_side", "Cells along each side of the box."),
            Field::number("coverage", "%", "Share of the cells that were visited."),
            Field::count("visited", "Cells that were visited."),
        ],
        edge: "0 where nobody was found; an error on the globe",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let Ground::Plane(space) = tracks.ground() else {
            return Err(MeasureError::Unfit { metric: Self::CARD.id, needs: "a plane" });
        };
        let ends: Vec<(f64, f64)> =
            (0..D).map(|a| space.side(a).map_or_else(|| extent(tracks.positions(a)), |side| (0.0, side))).collect();
        let last = tracks.times().last().copied().unwrap_or(0.0);
        let least = self.share * tracks.names().len() as f64;
        let readings =
            [(5, self.window, true), (10, self.window, true), (10, f64::INFINITY, true), (5, self.window, false)];
        for (reading, (cells, window, distinct)) in readings.into_iter().enumerate() {
            let mut seen: BTreeSet<(usize, u32)> = BTreeSet::new();
            let mut visited: BTreeSet<usize> = BTreeSet::new();
            let mut next = f64::NEG_INFINITY;
            for (frame, &time) in tracks.times().iter().enumerate() {
                // frames at the interval, allowing for the rounding of times
                if time <= last - window * (1.0 - 1e-9) || time < next - 1e-6 * self.interval {
                    continue;
                }
                next = time.max(next) + self.interval;
                if !distinct {
                    seen.clear();
                }
                for row in tracks.rows(frame) {
                    let place = space.place(tracks.position(row));
                    let along = |a: usize| {
                        let (low, high) = ends[a];
                        let share = if high > low { (place.0[a] - low) / (high - low) } else { 0.0 };
                        ((share * cells as f64).floor().max(0.0) as usize).min(cells - 1)
                    };
                    seen.insert(((0..D).rev().fold(0, |cell, a| cell * cells + along(a)), tracks.individuals()[row]));
                }
                if !distinct {
                    visited.extend(crowded(&seen, least));
                }
            }
            if distinct {
                visited = crowded(&seen, least).collect();
            }
            let all = cells.pow(D as u32) as f64;
            found.push([reading as f64, cells as f64, 100.0 * visited.len() as f64 / all, visited.len() as f64]);
        }
        Ok(found)
    }
}

/// The least and the greatest of some places.
fn extent(places: &[f64]) -> (f64, f64) {
    places.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| (low.min(x), high.max(x)))
}

/// Cells with at least so many individuals, of pairs of cell and individual.
fn crowded(seen: &BTreeSet<(usize, u32)>, least: f64) -> impl Iterator<Item = usize> {
    let mut counts: std::collections::BTreeMap<usize, usize> = std::collections::BTreeMap::new();
    for &(cell, _) in seen {
        *counts.entry(cell).or_default() += 1;
    }
    counts.into_iter().filter(move |&(_, count)| count as f64 >= least).map(|(cell, _)| cell)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::over_time::sketch::{Fine, close, tracks};
    use space::Space;

    #[test]
    fn four_readings() -> Fine {
        // three on a line of 10: they walk through the cells one after the other, 30 s behind each other
        let place = |frame: i64, k: u32| Some([((frame - 30 * i64::from(k)).clamp(0, 199) as f64) / 20.0]);
        let tracks = tracks(Space::walled([10.0]), 1.0, 200, 3, place)?;
        let found = Coverage { share: 0.5, window: 120.0, interval: 1.0 }.on(&tracks)?;
        close(&found.columns[0], &[0.0, 1.0, 2.0, 3.0]);
        // in the last 120 s (80 to 199): the first in 4..10, the second in 2.5..8.45, the third in 1..7: two of three in 2.5..8.45 and 8..
        close(&found.columns[3], &[4.0, 7.0, 9.0, 4.0]);
        close(&found.columns[2], &[80.0, 70.0, 90.0, 80.0]);
        // without walls the box is where they were: from 0 to 9.95, and the cells are a little smaller
        let open = crate::over_time::sketch::tracks(Space::open(), 1.0, 200, 3, place)?;
        close(&Coverage { share: 0.5, window: 120.0, interval: 1.0 }.on(&open)?.columns[3], &[4.0, 7.0, 9.0, 4.0]);
        let still = crate::over_time::sketch::tracks(Space::open(), 1.0, 2, 1, |_, _| Some([3.0]))?;
        close(&Coverage::default().on(&still)?.columns[3], &[1.0, 1.0, 1.0, 1.0]);
        Ok(())
    }
}
