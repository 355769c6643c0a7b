//! Everyone steps towards its nearest neighbour in range until that is near enough: the selfish herd in the plane.
//!
//! W. D. Hamilton (1971), Geometry for the selfish herd, Journal of Theoretical Biology 31:295 (its two dimensions).

use crate::card::*;
use crate::models::families::nearest_neighbour::NearestNeighbour;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;

parameters! {
    /// Parameters of `hamilton_2d`.
    pub struct Hamilton2d {
        /// Distance moved per update.
        step_length alias "step": R = 1.0, "l", "body length", NonNegative, Source;
        /// Distance at which the neighbour is near enough.
        repulsion_distance alias "r_rep": R = 2.0, "r_rho", "length", NonNegative, Source;
        /// Distance below which others are perceived.
        range: R = 10.0, "beta", "length", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for Hamilton2d<R> {
    const CARD: Card = Card {
        id: "hamilton_2d",
        title: "Hamilton 1971, in the plane",
        about: "Members step towards their nearest neighbour in range until it is within the repulsion distance.",
        reference: "W. D. Hamilton (1971). Geometry for the selfish herd. Journal of Theoretical Biology 31, 295-311. \
                    doi:10.1016/0022-5193(71)90189-5",
        equations: "k = nearest(I)\nx_i' = x_i + l e_ik  if rho_ik > r_rho, else x_i",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, range), of these the nearest",
            motion: "target point",
            physics: "ideal",
            obstacles: "",
        },
        departures: "the table gives Nearest a range that it does not take: composed of a distance and the nearest here",
        edge: "nobody in range, or the nearest coincident: stays",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::None,
            identification: false,
            uses: [true, false, false],
            validation: "S",
            synchronous: true,
            information: [Information::Global, Information::None, Information::None],
            environment: "unbounded free",
        },
    };
    fn needs(&self) -> Needs {
        Needs::default()
    }
    fn velocity_is_step(&self) -> bool {
        true
    }
}

impl<R: Scalar> Variant<R> for Hamilton2d<R> {
    type Shared = NearestNeighbour<R>;
    fn shared(&self) -> Self::Shared {
        NearestNeighbour {
            range: Some(self.range),
            step_length: self.step_length,
            repulsion_distance: self.repulsion_distance,
            environment: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn a_step_towards_the_nearest_in_range() {
        let w =
            Oracle::new("hamilton_2d").step(&[([0.0, 0.0], [0.0; 2]), ([3.0, 4.0], [0.0; 2]), ([3.0, 5.5], [0.0; 2])]);
        close(w.position(0), [0.6, 0.8]);
        close(w.velocity(0), [0.6, 0.8]);
        // within the repulsion distance: stays
        close(w.position(2), [3.0, 5.5]);
        let w = Oracle::new("hamilton_2d").step(&[([0.0; 3], [0.0; 3]), ([0.0, 0.0, 7.0], [0.0; 3])]);
        close(w.position(0), [0.0, 0.0, 1.0]);
    }

    #[test]
    fn the_range_is_half_open_and_the_lone_stay() {
        let pair = [([0.0, 0.0], [0.0; 2]), ([5.0, 0.0], [0.0; 2])];
        close(Oracle::new("hamilton_2d").set("range", 5.0).step(&pair).position(0), [0.0, 0.0]);
        close(Oracle::new("hamilton_2d").set("range", 5.1).step(&pair).position(0), [1.0, 0.0]);
        // exactly the repulsion distance is near enough
        close(Oracle::new("hamilton_2d").set("r_rep", 5.0).step(&pair).position(0), [0.0, 0.0]);
        close(Oracle::new("hamilton_2d").step(&pair[1..]).position(0), [5.0, 0.0]);
    }
}
