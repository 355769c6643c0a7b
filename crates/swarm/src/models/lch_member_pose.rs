//! Everyone steps towards the middle of all that it sees.
//!
//! B. T. Fine, D. A. Shell (2012), Examining the information requirements for flocking motion (the variation of the local
//! crowded horizon that is member-centric and uses pose).

use crate::card::*;
use crate::models::families::horizon::{CrowdedHorizon, Input, OnEmpty};
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;

parameters! {
    /// Parameters of `lch_member_pose`.
    pub struct LchMemberPose {
        /// Distance moved per update.
        step_length alias "step": R = 0.1, "l", "body length", NonNegative, Ours;
        /// Distance below which inputs count.
        range: R = 3000.0, "beta", "length", Positive, Source;
        /// What a member does when nobody is detected.
        on_empty: OnEmpty = "stay", "-", "-", Any, Source;
    }
}

impl<R: Scalar> Law<R> for LchMemberPose<R> {
    const CARD: Card = Card {
        id: "lch_member_pose",
        title: "Fine and Shell 2012, member-centric, pose",
        about: "Members step towards the mean position of those they see.",
        reference: "B. T. Fine, D. A. Shell (2012). Examining the information requirements for flocking motion; also in \
                    B. T. Fine (2015). Constructing geometries for group control",
        equations: "x_i' = x_i + l unit(mean_{j in I} d_ij)",
        stages: Stages {
            sensing: "ideal within range, or range-finder",
            detection: "any",
            selection: "inputs = distance_based(0, range)",
            motion: "target point",
            physics: "ideal, or differential drive",
            obstacles: "",
        },
        departures: "the components of the unit vector are added to the coordinates, where the listing adds the whole quotient to \
                     each; the step is 0.1, from the published final distances",
        edge: "nobody: stays, or one step along the heading (on_empty); zero resultant: stays",
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

impl<R: Scalar> Variant<R> for LchMemberPose<R> {
    type Shared = CrowdedHorizon<R>;
    fn shared(&self) -> Self::Shared {
        CrowdedHorizon {
            input: Input::Pose,
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
    fn a_step_towards_the_mean_of_those_in_range() {
        // the third is beyond the range
        let three = [([0.0, 0.0], REST), ([2.0, 0.0], REST), ([0.0, 4.0], REST), ([0.0, -50.0], REST)];
        let w = Oracle::new("lch_member_pose").set("range", 50.0).step(&three);
        close(w.position(0), [0.1 / 5f64.sqrt(), 0.2 / 5f64.sqrt()]);
        let w = Oracle::new("lch_member_pose").set("range", 51.0).step(&three);
        close(w.position(0), [0.1 * 2.0 / 2120f64.sqrt(), -0.1 * 46.0 / 2120f64.sqrt()]);
    }

    #[test]
    fn two_step_as_by_bearing_and_the_balanced_stay() {
        let pair = [([0.0, 0.0], REST), ([3.0, 4.0], REST)];
        for model in ["lch_member_pose", "lch_member_bearing"] {
            close(Oracle::new(model).step(&pair).position(0), [0.06, 0.08]);
        }
        let w = Oracle::new("lch_member_pose").step(&[([0.0, 0.0], REST), ([3.0, 0.0], REST), ([-3.0, 0.0], REST)]);
        close(w.position(0), [0.0, 0.0]);
        let alone = [([1.0, 1.0], [0.0, 2.0])];
        close(Oracle::new("lch_member_pose").step(&alone).position(0), [1.0, 1.0]);
        close(Oracle::new("lch_member_pose").set("on_empty", "keep_heading").step(&alone).position(0), [1.0, 1.1]);
    }
}
