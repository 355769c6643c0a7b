//! How much ground lies nearest to each individual, on average over frames.
//!
//! W. D. Hamilton (1971), Geometry for the selfish herd, Journal of Theoretical Biology 31:295.

use crate::metric::takes;
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};
use crate::{Sample, domains};
use space::{Edge, Space, Vector};

takes! {
    /// `domains_of_danger`.
    pub struct DomainsOfDanger {  }
}

impl TrackMetric for DomainsOfDanger {
    const CARD: TrackCard = TrackCard {
        id: "domains_of_danger",
        title: "Domains of danger",
        definition: "mean over frames of the part of the arena nearer to the individual than to any other; the arena \
                    is the box where all axes have walls or periods, else the hull of the frame",
        variant: "bounded; on a ring half the gap to either side; coincident individuals share alike",
        source: "Hamilton 1971",
        counted: Counted::Positions,
        dimensions: &[1, 2],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::individual("individual", "The individual."),
            Field::number("domain", "length^D", "Mean domain of danger."),
            Field::count("frames", "Frames with a domain."),
        ],
        edge: "NaN without a frame that has a hull",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let mut sums = vec![(0.0, 0.0); tracks.names().len()];
        let mut sample = Sample::empty();
        for frame in 0..tracks.frames().len() {
            tracks.sample_into(frame, &mut sample);
            let space = sample.space();
            let boxed = match D {
                1 if space.edges[0] != Edge::Open => {
                    let places: Vec<f64> = sample.positions().iter().map(|place| place.0[0]).collect();
                    Some(domains::on_line(space.edges[0], &places))
                }
                2 => {
                    let places: Vec<Vector<f64, 2>> =
                        sample.positions().iter().map(|place| Vector::of(&place.0)).collect();
                    domains::in_box(&Space { edges: [space.edges[0], space.edges[1]] }, &places)
                }
                _ => None,
            };
            let domains = boxed.or_else(|| sample.domains_of_danger().map(<[f64]>::to_vec));
            for (row, domain) in tracks.rows(frame).zip(domains.into_iter().flatten()) {
                let (sum, frames) = &mut sums[tracks.individuals()[row] as usize];
                (*sum, *frames) = (*sum + domain, *frames + 1.0);
            }
        }
        for (individual, (sum, frames)) in sums.into_iter().enumerate() {
            found.push([individual as f64, sum / frames, frames]);
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
    fn the_ring_of_the_truths() -> Fine {
        let places = [0.0, 40.0, 100.0, 130.0, 250.0];
        let found =
            DomainsOfDanger {}.on(&tracks(Space::periodic([360.0]), 1.0, 2, 5, |_, k| Some([places[k as usize]]))?)?;
        close(&found.columns[1], &[75.0, 50.0, 45.0, 75.0, 115.0]);
        close(&found.columns[2], &[2.0; 5]);
        Ok(())
    }

    #[test]
    fn in_a_box_they_fill_it_and_in_the_open_the_hull() -> Fine {
        let places = [[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0], [2.0, 2.0]];
        let place = |_: i64, k: u32| Some(places[k as usize]);
        let boxed = DomainsOfDanger {}.on(&tracks(Space::walled([4.0; 2]), 1.0, 1, 5, place)?)?;
        close(&boxed.columns[1], &[3.5, 3.5, 3.5, 3.5, 2.0]);
        let open = DomainsOfDanger {}.on(&tracks(Space::open(), 1.0, 1, 5, place)?)?;
        close(&open.columns[1], &[0.5, 0.5, 0.5, 0.5, 2.0]);
        Ok(())
    }
}
