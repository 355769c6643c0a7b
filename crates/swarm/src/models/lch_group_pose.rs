//! Everyone steps towards the middle of the largest connected part of the group that it sees.
//!
//! B. T. Fine, D. A. Shell (2012), Examining the information requirements for flocking motion (the variation of the local
//! crowded horizon that is group-centric and uses pose).

use crate::card::*;
use crate::models::families::horizon::{CrowdedHorizon, Input, OnEmpty};
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;

parameters! {
    /// Parameters of `lch_group_pose`.
    pub struct LchGroupPose {
        /// Distance up to which two inputs belong together.
        splitting_threshold alias "st": R = 0.5, "st", "length", NonNegative, Source;
        /// Distance moved per update.
        step_length alias "step": R = 0.1, "l", "body length", NonNegative, Ours;
        /// Distance below which inputs count.
        range: R = 3000.0, "beta", "length", Positive, Source;
        /// What a member does when nobody is detected.
        on_empty: OnEmpty = "stay", "-", "-", Any, Source;
    }
}

impl<R: Scalar> Law<R> for LchGroupPose<R> {
    const CARD: Card = Card {
        id: "lch_group_pose",
        title: "Fine and Shell 2012, group-centric, pose",
        about: "Members step towards the mean position of the largest connected component of those they see.",
        reference: "B. T. Fine, D. A. Shell (2012). Examining the information requirements for flocking motion; also in \
                    B. T. Fine (2015). Constructing geometries for group control",
        equations: "I = largest component of the graph that links inputs at distance <= st\n\
                    x_i' = x_i + l unit(mean_{j in I} d_ij)",
        stages: Stages {
            sensing: "ideal within range, or range-finder",
            detection: "any",
            selection: "inputs = distance_based(0, range); of these the largest connected component",
            motion: "target point",
            physics: "ideal, or differential drive",
            obstacles: "",
        },
        departures: "the components of the unit vector are added to the coordinates, where the listing adds the whole \
                     quotient to each; the step is 0.1, from the published final distances",
        edge: "nobody: stays, or one step along the heading (on_empty); components of equal size: the one that holds the \
               lowest index; the member itself is not in the graph; zero resultant: stays",
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

impl<R: Scalar> Variant<R> for LchGroupPose<R> {
    type Shared = CrowdedHorizon<R>;
    fn shared(&self) -> Self::Shared {
        CrowdedHorizon {
            input: Input::Pose,
            splitting_threshold: Some(self.splitting_threshold),
            step_length: self.step_length,
            range: self.range,
            on_empty: self.on_empty,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};
    use space::Space;

    const REST: [f64; 2] = [0.0, 0.0];

    #[test]
    fn the_larger_component_wins_and_links_reach_through_others() {
        // a chain of three to the right, linked pairwise at exactly the threshold, against two above
        let w = Oracle::new("lch_group_pose").step(&[
            ([0.0, 0.0], REST),
            ([2.0, 0.0], REST),
            ([0.0, 5.0], REST),
            ([3.0, 0.0], REST),
            ([2.5, 0.0], REST),
            ([0.0, 5.25], REST),
        ]);
        close(w.position(0), [0.1, 0.0]);
        // the same from the upper pair, whose own component has only the other one of it
        close(w.position(2), [0.1 * 2.5 / 31.25f64.sqrt(), 5.0 - 0.1 * 5.0 / 31.25f64.sqrt()]);
    }

    #[test]
    fn of_equal_components_the_one_with_the_lowest_index_counts() {
        let w = Oracle::new("lch_group_pose").step(&[
            ([0.0, 0.0], REST),
            ([0.0, 4.0], REST),
            ([5.0, 0.0], REST),
            ([5.2, 0.0], REST),
            ([0.0, 4.2], REST),
        ]);
        close(w.position(0), [0.0, 0.1]);
    }

    #[test]
    fn links_close_over_a_periodic_edge() {
        let space = Space::periodic([10.0, 10.0]);
        // seen from 5 the two at the edge lie on opposite sides, 0.4 apart
        let agents = [([5.0, 5.0], REST), ([9.8, 5.0], REST), ([0.2, 5.0], REST), ([5.0, 8.0], REST)];
        let w = Oracle::new("lch_group_pose").space(space).step(&agents);
        close(w.position(0), [5.0, 5.0]);
    }

    #[test]
    fn nobody_there() {
        let alone = [([1.0, 1.0], [0.0, 2.0])];
        close(Oracle::new("lch_group_pose").step(&alone).position(0), [1.0, 1.0]);
        let w = Oracle::new("lch_group_pose").set("on_empty", "keep_heading").step(&alone);
        close(w.position(0), [1.0, 1.1]);
        close(w.velocity(0), [0.0, 0.1]);
    }
}
