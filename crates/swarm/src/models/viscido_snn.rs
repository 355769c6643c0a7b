//! Everyone steps towards its nearest neighbour until that is near enough.
//!
//! S. V. Viscido, M. Miller, D. S. Wethey (2002), The dilemma of the selfish herd: the search for a realistic movement rule,
//! Journal of Theoretical Biology 217:183 (simple nearest neighbour).

use crate::card::*;
use crate::models::families::nearest_neighbour::NearestNeighbour;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;

parameters! {
    /// Parameters of `viscido_snn`.
    pub struct ViscidoSnn {
        /// Distance moved per update.
        step_length alias "step": R = 1.0, "l", "body length", NonNegative, Source;
        /// Distance at which the neighbour is near enough.
        repulsion_distance alias "r_rep": R = 2.0, "r_rho", "length", NonNegative, Source;
    }
}

impl<R: Scalar> Law<R> for ViscidoSnn<R> {
    const CARD: Card = Card {
        id: "viscido_snn",
        title: "Viscido et al. 2002, simple nearest neighbour",
        about: "Members step towards their nearest neighbour until it is within the repulsion distance.",
        reference: "S. V. Viscido, M. Miller, D. S. Wethey (2002). The dilemma of the selfish herd: the search for a \
                    realistic movement rule. Journal of Theoretical Biology 217, 183-194. doi:10.1006/jtbi.2002.3025",
        equations: "k = nearest(I)\nx_i' = x_i + l e_ik  if rho_ik > r_rho, else x_i",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = nearest",
            motion: "target point",
            physics: "ideal",
            obstacles: "",
        },
        departures: "none",
        edge: "alone or coincident: stays",
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
            environment: "bounded free",
        },
    };
    fn needs(&self) -> Needs {
        Needs::default()
    }
    fn velocity_is_step(&self) -> bool {
        true
    }
}

impl<R: Scalar> Variant<R> for ViscidoSnn<R> {
    type Shared = NearestNeighbour<R>;
    fn shared(&self) -> Self::Shared {
        NearestNeighbour {
            range: None,
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
    fn a_step_towards_the_nearest_and_none_within_the_repulsion_distance() {
        let w = Oracle::new("viscido_snn").step(&[
            ([0.0, 0.0], [0.0, 0.0]),
            ([3.0, 4.0], [0.0, 0.0]),
            ([3.0, 5.5], [0.0, 0.0]),
        ]);
        close(w.position(0), [0.6, 0.8]);
        close(w.velocity(0), [0.6, 0.8]);
        close(w.position(1), [3.0, 4.0]);
        close(w.position(2), [3.0, 5.5]);
    }

    #[test]
    fn ties_go_to_the_lower_id_and_the_lone_stay() {
        let w = Oracle::new("viscido_snn").step(&[
            ([0.0, 0.0], [0.0, 0.0]),
            ([5.0, 0.0], [0.0, 0.0]),
            ([-5.0, 0.0], [0.0, 0.0]),
        ]);
        close(w.position(0), [1.0, 0.0]);
        close(Oracle::new("viscido_snn").step(&[([1.0, 2.0], [0.0, 0.0])]).position(0), [1.0, 2.0]);
    }
}
