//! Who turns first: the delay at which the heading of another is most like the own.
//!
//! M. Nagy, Z. Akos, D. Biro, T. Vicsek (2010), Hierarchical group dynamics in pigeon flocks, Nature 464:890.

use super::lags::{MAX_LAG, lags};
use crate::metric::takes;
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};
use space::Vector;

takes! {
    /// `leadership`.
    pub struct Leadership { max_lag: MAX_LAG }
}

impl TrackMetric for Leadership {
    const CARD: TrackCard = TrackCard {
        id: "leadership",
        title: "Leadership by directional delay",
        definition: "for each two: C(tau) = mean over t of h_i(t) . h_j(t + tau), tau from -max_lag to max_lag; the \
                    delay is the tau of the greatest C (of equal ones the shortest, then the positive one): positive \
                    where i leads",
        variant: "directional correlation delay; the cost grows with the square of the number of individuals times \
                    the lags",
        source: "Nagy et al. 2010",
        counted: Counted::Headings,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::individual("individual", "The one (i)."),
            Field::individual("other", "The other (j)."),
            Field::number("delay", "s", "How much later the other turns: positive where the individual leads."),
            Field::number("correlation", "1", "Greatest mean cosine between the headings."),
            Field::count("pairs", "Moments that were averaged at that delay."),
        ],
        edge: "no row for two that are never seen together",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let (lags, interval) = lags(Self::CARD.id, tracks, self.max_lag, f64::from(u32::MAX))?;
        let paths = tracks.paths();
        // headings at every usual step of the numbers of frames; the zero vector where there is none
        let (first, step) = (tracks.frames().first().copied().unwrap_or(0), tracks.step());
        let length = tracks.frames().last().map_or(0, |last| ((last - first) / step + 1) as usize);
        let mut headings: Vec<Vec<Vector<f64, D>>> = Vec::new();
        for individual in 0..paths.len() {
            let mut of_one = vec![Vector::ZERO; length];
            for (frame, row) in paths.of(individual) {
                let moment = tracks.frames()[frame] - first;
                if let Some(heading) = tracks.heading(row).filter(|_| moment % step == 0) {
                    of_one[(moment / step) as usize] = heading;
                }
            }
            headings.push(of_one);
        }
        let mut delays = vec![0];
        delays.extend(lags.iter().flat_map(|&lag| [lag, -lag]));
        for i in 0..paths.len() {
            for j in i + 1..paths.len() {
                let mut best: Option<(f64, i64, f64)> = None;
                for &delay in &delays {
                    let shift = delay.unsigned_abs() as usize;
                    let shifted = |k: usize| headings[k].get(shift..).unwrap_or_default();
                    let (from, to) =
                        if delay >= 0 { (&headings[i][..], shifted(j)) } else { (shifted(i), &headings[j][..]) };
                    let (sum, pairs) = from.iter().zip(to).fold((0.0, 0.0), |(sum, pairs), (&one, &other)| {
                        let both = one != Vector::ZERO && other != Vector::ZERO;
                        if both { (sum + one.dot(other), pairs + 1.0) } else { (sum, pairs) }
                    });
                    let c = sum / pairs;
                    if pairs > 0.0 && best.is_none_or(|(most, _, _)| c > most) {
                        best = Some((c, delay, pairs));
                    }
                }
                if let Some((c, delay, pairs)) = best {
                    found.push([i as f64, j as f64, delay as f64 * interval, c, pairs]);
                }
            }
        }
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::over_time::sketch::{Fine, close, tracks};
    use space::Space;

    #[test]
    fn the_follower_turns_later() -> Fine {
        // both on the same winding way, the second three frames behind
        let way = |t: f64| Some([t + (0.3 * t).sin(), (0.25 * t).cos() * 3.0]);
        let tracks = tracks(Space::open(), 2.0, 60, 2, |frame, k| way(frame as f64 - 3.0 * f64::from(k)))?;
        let found = Leadership { max_lag: 4.0 }.on(&tracks)?;
        close(&found.row(0), &[0.0, 1.0, 1.5, 1.0, 56.0]);
        Ok(())
    }
}
