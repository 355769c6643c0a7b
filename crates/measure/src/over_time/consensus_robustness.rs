//! How well a group would hold an agreement against noise, by how many of its nearest each one listens to.
//!
//! G. F. Young, L. Scardovi, A. Cavagna, I. Giardina, N. E. Leonard (2013), Starling flock networks manage uncertainty in consensus at low
//! cost, PLoS Computational Biology 9:e1002894.

use crate::consensus::Listening;
use crate::metric::takes;
use crate::{Bounds, Counted, Field, Listing, MeasureError, Parameter, Sample, Takes, TrackCard, TrackMetric, Tracks};

/// The most neighbours that are tried.
const MOST_NEIGHBOURS: Parameter = Parameter {
    name: "most_neighbours",
    unit: "1",
    default: None,
    bounds: Bounds::Whole,
    about: "Numbers of neighbours from 1 to this are tried; each costs as much as some thirty products of matrices as large as the \
            group.",
};

takes! {
    /// `consensus_robustness`.
    pub struct ConsensusRobustness { most_neighbours: MOST_NEIGHBOURS }
}

/// The robustness of a group in which each member listens to so many nearest others, or to all where they are fewer; see
/// [`Listening::robustness`].
pub fn robustness<const D: usize>(sample: &Sample<D>, neighbours: usize) -> Option<f64> {
    let count = neighbours.min(sample.len().saturating_sub(1));
    let nearest = sample.nearest_others(count)?;
    let others: Vec<u32> = nearest.iter().map(|&(_, other)| other).collect();
    Listening { others: &others, count }.robustness()
}

/// The number of neighbours, from 1 to `most`, of the greatest robustness for each neighbour; the fewest of several. `None` where the
/// group agrees by none of them.
pub fn best_neighbours<const D: usize>(sample: &Sample<D>, most: usize) -> Option<usize> {
    let mut best = (0.0, None);
    for neighbours in 1..=most.min(sample.len().saturating_sub(1)) {
        let each = robustness(sample, neighbours)? / neighbours as f64;
        if each > best.0 {
            best = (each, Some(neighbours));
        }
    }
    best.1
}

impl TrackMetric for ConsensusRobustness {
    const CARD: TrackCard = TrackCard {
        id: "consensus_robustness",
        title: "Robustness of consensus",
        definition: "sqrt(N) / H2,  H2^2 = the steady sum of squared departures from the mean under dx = -L x dt + dW, L the \
                    Laplacian of the directed graph in which each listens to its k nearest others with weight 1",
        variant: "nodal (for the square root of the number of individuals); directed, unit weights, noise of unit intensity",
        source: "Young et al. 2013",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::frame(),
            Field::time(),
            Field::count("neighbours", "To how many of its nearest each one listens, k."),
            Field::number("robustness", "1/s^0.5", "sqrt(N) / H2."),
            Field::number("per_neighbour", "1/s^0.5", "The same over k."),
        ],
        edge: "0 where nobody's opinion reaches everyone; no row for fewer than two individuals, or with k others or fewer",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let mut sample = Sample::empty();
        for (frame, &number) in tracks.frames().iter().enumerate() {
            tracks.sample_into(frame, &mut sample);
            for neighbours in 1..=(self.most_neighbours as usize).min(sample.len().saturating_sub(1)) {
                let Some(value) = robustness(&sample, neighbours) else { continue };
                let k = neighbours as f64;
                found.push([number as f64, tracks.times()[frame], k, value, value / k]);
            }
        }
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::over_time::sketch::{Fine, close, tracks};
    use space::{Space, Vector};

    #[test]
    fn a_ring_of_neighbours_and_everyone() -> Fine {
        // evenly round a ring of 5, a little irregular: by one neighbour pairs listen to themselves; by two all to both sides
        let place = |_: i64, k: u32| Some([[0.0, 2.0, 3.9, 5.9, 8.0][k as usize]]);
        let ring = tracks(Space::periodic([10.0]), 1.0, 1, 5, place)?;
        let found = ConsensusRobustness { most_neighbours: 7.0 }.on(&ring)?;
        close(&found.columns[2], &[1.0, 2.0, 3.0, 4.0]);
        // H2^2 = (25 - 1) / 24, and 4 modes of the rate 5
        close(&found.columns[3][1..2], &[5f64.sqrt()]);
        close(&found.columns[3][3..], &[(5.0 * 10.0 / 4.0f64).sqrt()]);
        close(&found.columns[4][3..], &[(5.0 * 10.0 / 4.0f64).sqrt() / 4.0]);
        Ok(())
    }

    #[test]
    fn the_best_number_of_neighbours() {
        // two pairs far apart: one neighbour each never brings them together
        let sample = Sample::new(Space::open(), [0.0, 1.0, 9.0, 10.0].map(|x| (Vector([x]), Vector([1.0]))));
        assert_eq!(robustness(&sample, 1), Some(0.0));
        assert_eq!(best_neighbours(&sample, 1), None);
        assert_eq!(best_neighbours(&sample, 9), Some(2));
        assert_eq!(robustness(&Sample::<1>::empty(), 2), None);
        assert_eq!(best_neighbours(&Sample::<1>::empty(), 2), None);
    }
}
