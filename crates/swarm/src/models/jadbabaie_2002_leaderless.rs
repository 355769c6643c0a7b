//! Everyone approaches the headings of those within a radius by a share of the differences.
//!
//! A. Jadbabaie, J. Lin, A. S. Morse (2002/2003), Coordination of groups of mobile autonomous agents using nearest neighbor
//! rules, IEEE Transactions on Automatic Control 48:988 (leaderless coordination).

use crate::card::*;
use crate::models::families::heading_consensus::HeadingConsensus;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;

parameters! {
    /// Parameters of `jadbabaie_2002_leaderless`.
    pub struct Jadbabaie2002Leaderless {
        /// Interaction radius.
        radius: R = 1.0, "r", "length", Positive, Ours;
        /// Speed, the same for all.
        speed: R = 0.05, "v", "length/time", NonNegative, Ours;
        /// What the summed differences are divided by, more than any number of neighbours; 0: one more than they are.
        gain: R = 0.0, "g", "1", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 1.0, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for Jadbabaie2002Leaderless<R> {
    const CARD: Card = Card {
        id: "jadbabaie_2002_leaderless",
        title: "Jadbabaie et al. 2002, leaderless",
        about: "Members of constant speed turn by a share of the differences between their neighbours' headings and theirs.",
        reference: "A. Jadbabaie, J. Lin, A. S. Morse (2003; first in 2002). Coordination of groups of mobile autonomous agents \
                    using nearest neighbor rules. IEEE Transactions on Automatic Control 48, 988-1001. \
                    doi:10.1109/TAC.2003.812781",
        equations: "theta_i' = theta_i + (1/g_i) sum_{j in I} wrap(theta_j - theta_i),  g_i = g if g > 0, else 1 + |I|\n\
                    x_i' = x_i + v_i Dt  (old velocity);  v_i' = v h(theta_i')",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, radius)",
            motion: "heading",
            physics: "ideal, constant speed",
            obstacles: "",
        },
        departures: "the row (1/w1)(|I| theta_i + sum theta_j) has weights that do not add up to 1; (w1 - |I|) theta_i is the paper's \
                     form; differences of headings are wrapped, so that the rule does not depend on the axis (the paper's form where all headings lie \
                     within a half turn)",
        edge: "alone: unchanged; at rest the heading is angle 0; a gain that is not more than the number of neighbours overshoots",
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
}

impl<R: Scalar> Variant<R> for Jadbabaie2002Leaderless<R> {
    type Shared = HeadingConsensus<R>;
    fn shared(&self) -> Self::Shared {
        HeadingConsensus {
            radius: self.radius,
            speed: self.speed,
            gain: self.gain,
            leaders: Vec::new(),
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
    fn the_mean_heading_across_the_cut() {
        let three = [([0.0, 0.0], at(170.0)), ([0.5, 0.0], at(-160.0)), ([0.0, 0.5], at(179.0))];
        let w = Oracle::new("jadbabaie_2002_leaderless").step(&three);
        // 170 + (30 + 9)/3
        close(w.velocity(0), at(183.0));
        close(w.velocity(1), at(-160.0 + (-30.0 - 21.0) / 3.0));
        // with the old velocity
        let [x, y] = at(170.0);
        close(w.position(0), [x, y]);
    }

    #[test]
    fn a_given_gain_and_nobody_in_range() {
        let pair = [([0.0, 0.0], at(0.0)), ([0.5, 0.0], at(40.0))];
        let w = Oracle::new("jadbabaie_2002_leaderless").set("gain", 4.0).step(&pair);
        close(w.velocity(0), at(10.0));
        close(w.velocity(1), at(30.0));
        let w = Oracle::new("jadbabaie_2002_leaderless").set("radius", 0.5).step(&pair);
        close(w.velocity(0), at(0.0));
        close(w.velocity(1), at(40.0));
    }
}
