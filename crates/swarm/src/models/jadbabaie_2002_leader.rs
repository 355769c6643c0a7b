//! Everyone approaches the headings of those within a radius by a share of the differences, except leaders, who keep theirs.
//!
//! A. Jadbabaie, J. Lin, A. S. Morse (2002/2003), Coordination of groups of mobile autonomous agents using nearest neighbor
//! rules, IEEE Transactions on Automatic Control 48:988 (leader following).

use crate::card::*;
use crate::models::families::heading_consensus::HeadingConsensus;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;

parameters! {
    /// Parameters of `jadbabaie_2002_leader`.
    pub struct Jadbabaie2002Leader {
        /// Interaction radius.
        radius: R = 1.0, "r", "length", Positive, Ours;
        /// Speed, the same for all.
        speed: R = 0.05, "v", "length/time", NonNegative, Ours;
        /// Members that keep their heading, by index in the group.
        leaders: Vec<usize> = [0usize], "-", "1", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 1.0, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for Jadbabaie2002Leader<R> {
    const CARD: Card = Card {
        id: "jadbabaie_2002_leader",
        title: "Jadbabaie et al. 2002, with leaders",
        about: "Members of constant speed turn towards the mean heading of neighbours and leaders in range; leaders keep theirs.",
        reference: "A. Jadbabaie, J. Lin, A. S. Morse (2003; first in 2002). Coordination of groups of mobile autonomous agents \
                    using nearest neighbor rules. IEEE Transactions on Automatic Control 48, 988-1001. \
                    doi:10.1109/TAC.2003.812781",
        equations: "followers: theta_i' = theta_i + (1/(1 + |I|)) sum_{j in I} wrap(theta_j - theta_i);  leaders: theta_i' = theta_i\n\
                    x_i' = x_i + v_i Dt  (old velocity);  v_i' = v h(theta_i')",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, radius), followers and leaders alike",
            motion: "heading",
            physics: "ideal, constant speed",
            obstacles: "",
        },
        departures: "the table intersects followers and leaders; the union is meant; differences of headings are wrapped, so that the rule does not depend on the axis (the paper's form where all headings lie \
                     within a half turn)",
        edge: "alone: unchanged; leaders never change their heading, but move at the speed of all; at rest the heading is angle 0",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::None,
            identification: false,
            uses: [true, false, true],
            validation: "M",
            synchronous: true,
            information: [Information::Global, Information::Constant, Information::Global],
            environment: "none",
        },
    };
    fn time_step(&self) -> R {
        self.time_step
    }
    fn initial_speed(&self) -> R {
        self.speed
    }
    fn check(&self, members: usize) -> Result<(), String> {
        match self.leaders.iter().find(|&&leader| leader >= members && members > 0) {
            Some(leader) => Err(format!("`leaders` names member {leader}, but the group's {members} count from 0")),
            None => Ok(()),
        }
    }
}

impl<R: Scalar> Variant<R> for Jadbabaie2002Leader<R> {
    type Shared = HeadingConsensus<R>;
    fn shared(&self) -> Self::Shared {
        HeadingConsensus {
            radius: self.radius,
            speed: self.speed,
            gain: R::ZERO,
            leaders: self.leaders.clone(),
            time_step: self.time_step,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    fn at(degrees: f64) -> [f64; 2] {
        [0.05 * degrees.to_radians().cos(), 0.05 * degrees.to_radians().sin()]
    }

    #[test]
    fn followers_approach_and_leaders_keep() {
        let three = [([0.0, 0.0], at(0.0)), ([0.5, 0.0], at(60.0)), ([0.5, 0.5], at(90.0))];
        let w = Oracle::new("jadbabaie_2002_leader").step(&three);
        close(w.velocity(0), at(0.0));
        close(w.velocity(1), at(60.0 + (-60.0 + 30.0) / 3.0));
        close(w.velocity(2), at(90.0 + (-90.0 - 30.0) / 3.0));
        let w = Oracle::new("jadbabaie_2002_leader").set("leaders", [2usize]).step(&three);
        close(w.velocity(2), at(90.0));
        close(w.velocity(0), at(50.0));
    }

    #[test]
    fn all_converge_to_the_leader() {
        let mut w = Oracle::new("jadbabaie_2002_leader").set("radius", 50.0).world(&[
            ([0.0, 0.0], at(30.0)),
            ([1.0, 0.0], at(-30.0)),
            ([0.0, 1.0], at(100.0)),
        ]);
        w.run(200);
        for id in 0..3 {
            close(w.velocity(id), at(30.0));
        }
    }
}
