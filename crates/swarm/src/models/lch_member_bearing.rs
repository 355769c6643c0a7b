//! Everyone steps in the mean direction of all that it sees.
//!
//! B. T. Fine, D. A. Shell (2012), Examining the information requirements for flocking motion (the variation of the local
//! crowded horizon that is member-centric and uses bearing).

use crate::card::*;
use crate::models::families::horizon::{CrowdedHorizon, Input, OnEmpty};
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;

parameters! {
    /// Parameters of `lch_member_bearing`.
    pub struct LchMemberBearing {
        /// Distance moved per update.
        step_length alias "step": R = 0.1, "l", "body length", NonNegative, Ours;
        /// Distance below which inputs count.
        range: R = 3000.0, "beta", "length", Positive, Source;
        /// What a member does when nobody is detected.
        on_empty: OnEmpty = "stay", "-", "-", Any, Source;
    }
}

impl<R: Scalar> Law<R> for LchMemberBearing<R> {
    const CARD: Card = Card {
        id: "lch_member_bearing",
        title: "Fine and Shell 2012, member-centric, bearing",
        about: "Members step in the mean direction of those they see, however far these are.",
        reference: "B. T. Fine, D. A. Shell (2012). Examining the information requirements for flocking motion; also in \
                    B. T. Fine (2015). Constructing geometries for group control",
        equations: "x_i' = x_i + l unit(sum_{j in I} e_ij)",
        stages: Stages {
            sensing: "ideal within range, or range-finder",
            detection: "any",
            selection: "inputs = distance_based(0, range)",
            motion: "target point",
            physics: "ideal, or differential drive",
            obstacles: "",
        },
        departures: "bearings are averaged as unit vectors, where a mean of angles would break at the cut; \
                     the components of the unit vector are added to the coordinates, where the listing adds the whole quotient to each; the step is 0.1, from the published final distances",
        edge: "nobody: stays, or one step along the heading (on_empty); zero resultant: stays; coincident inputs have no direction",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: false,
            discrete: true,
            avoidance: Avoidance::None,
            identification: false,
            uses: [true, false, false],
            validation: "SP",
            synchronous: false,
            information: [Information::Local, Information::None, Information::None],
            environment: "unbounded free",
        },
    };
    fn needs(&self) -> Needs {
        Needs::default()
    }
}

impl<R: Scalar> Variant<R> for LchMemberBearing<R> {
    type Shared = CrowdedHorizon<R>;
    fn shared(&self) -> Self::Shared {
        CrowdedHorizon {
            input: Input::Bearing,
            splitting_threshold: None,
            step_length: self.step_length,
            range: self.range,
            on_empty: self.on_empty,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    const REST: [f64; 2] = [0.0, 0.0];

    #[test]
    fn moving_neighbours_along_their_lines_of_sight_changes_nothing() {
        for far in [1.0, 7.0, 900.0] {
            let w =
                Oracle::new("lch_member_bearing").step(&[([0.0, 0.0], REST), ([far, 0.0], REST), ([0.0, 2.0], REST)]);
            close(w.position(0), [0.1 * 0.5f64.sqrt(), 0.1 * 0.5f64.sqrt()]);
        }
    }

    #[test]
    fn opposite_and_coincident_inputs_and_nobody() {
        let w = Oracle::new("lch_member_bearing").step(&[([0.0, 0.0], REST), ([5.0, 0.0], REST), ([-1.0, 0.0], REST)]);
        close(w.position(0), [0.0, 0.0]);
        let w = Oracle::new("lch_member_bearing").step(&[([0.0, 0.0], REST), ([0.0, 0.0], REST), ([0.0, -9.0], REST)]);
        close(w.position(0), [0.0, -0.1]);
        let alone = [([1.0, 1.0], [0.0, 2.0])];
        close(Oracle::new("lch_member_bearing").set("on_empty", "keep_heading").step(&alone).position(0), [1.0, 1.1]);
        let w = Oracle::new("lch_member_bearing").step(&[([0.0; 3], [0.0; 3]), ([0.0, 3.0, 4.0], [0.0; 3])]);
        close(w.position(0), [0.0, 0.06, 0.08]);
    }
}
