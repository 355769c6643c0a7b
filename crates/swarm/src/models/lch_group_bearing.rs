//! Everyone steps in the mean direction of the largest connected part, by bearing, of the group that it sees.
//!
//! B. T. Fine, D. A. Shell (2012), Examining the information requirements for flocking motion (the variation of the local
//! crowded horizon that is group-centric and uses bearing).

use crate::card::*;
use crate::models::families::horizon::{CrowdedHorizon, Input, OnEmpty};
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;

parameters! {
    /// Parameters of `lch_group_bearing`.
    pub struct LchGroupBearing {
        /// Angle up to which the directions of two inputs belong together.
        splitting_angle alias "st_deg": R = 10.0, "st", "deg", Within(0.0, 180.0), Source;
        /// Distance moved per update.
        step_length alias "step": R = 0.1, "l", "body length", NonNegative, Ours;
        /// Distance below which inputs count.
        range: R = 3000.0, "beta", "length", Positive, Source;
        /// What a member does when nobody is detected.
        on_empty: OnEmpty = "stay", "-", "-", Any, Source;
    }
}

impl<R: Scalar> Law<R> for LchGroupBearing<R> {
    const CARD: Card = Card {
        id: "lch_group_bearing",
        title: "Fine and Shell 2012, group-centric, bearing",
        about: "Members step in the mean direction of the largest component, linked by bearing, of those they see.",
        reference: "B. T. Fine, D. A. Shell (2012). Examining the information requirements for flocking motion; also in \
                    B. T. Fine (2015). Constructing geometries for group control",
        equations: "I = largest component of the graph that links inputs whose directions differ by <= st\n\
                    x_i' = x_i + l unit(sum_{j in I} e_ij)",
        stages: Stages {
            sensing: "ideal within range, or range-finder",
            detection: "any",
            selection: "inputs = distance_based(0, range); of these the largest connected component",
            motion: "target point",
            physics: "ideal, or differential drive",
            obstacles: "",
        },
        departures: "bearings are averaged as unit vectors, where a mean of angles would break at the cut; inputs are linked \
                     around the circle; the components of the unit vector are added to the coordinates, where the listing adds the whole quotient to each; the step is 0.1, from the published final distances",
        edge: "nobody: stays, or one step along the heading (on_empty); components of equal size: the one that holds the \
               lowest index; the member itself is not in the graph; a coincident input links to none; zero resultant: stays",
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

impl<R: Scalar> Variant<R> for LchGroupBearing<R> {
    type Shared = CrowdedHorizon<R>;
    fn shared(&self) -> Self::Shared {
        CrowdedHorizon {
            input: Input::Bearing,
            splitting_threshold: Some(self.splitting_angle.radians()),
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

    /// A member at the origin, and inputs at these bearings, in degrees, some near and some far.
    fn bearings(degrees: &[f64]) -> Vec<([f64; 2], [f64; 2])> {
        let place = |(k, d): (usize, &f64)| {
            let (sin, cos) = d.to_radians().sin_cos();
            let far = 1.0 + 5.0 * (k % 3) as f64;
            ([far * cos, far * sin], REST)
        };
        core::iter::once(([0.0, 0.0], REST)).chain(degrees.iter().enumerate().map(place)).collect()
    }

    #[test]
    fn links_reach_through_others_and_around_the_circle() {
        // 174, 180 and -174 are linked in pairs across the cut; 90 and 94 are fewer
        let w = Oracle::new("lch_group_bearing").step(&bearings(&[90.0, 174.0, 94.0, -174.0, 180.0]));
        close(w.position(0), [-0.1, 0.0]);
        // just too far apart: three components of one, of which the first counts
        let w = Oracle::new("lch_group_bearing").set("st_deg", 5.0).step(&bearings(&[90.0, 174.0, -174.0]));
        close(w.position(0), [0.0, 0.1]);
    }

    #[test]
    fn coincident_inputs_link_to_none_and_nobody_is_nowhere() {
        // the coincident input has the lowest index of two components of one, and no direction
        let w = Oracle::new("lch_group_bearing").step(&[([0.0, 0.0], REST), ([0.0, 0.0], REST), ([4.0, 0.0], REST)]);
        close(w.position(0), [0.0, 0.0]);
        let w = Oracle::new("lch_group_bearing").step(&[([0.0; 3], [0.0; 3]), ([0.0, 3.0, 4.0], [0.0; 3])]);
        close(w.position(0), [0.0, 0.06, 0.08]);
        close(Oracle::new("lch_group_bearing").step(&[([1.0, 1.0], [0.0, 2.0])]).position(0), [1.0, 1.0]);
    }
}
