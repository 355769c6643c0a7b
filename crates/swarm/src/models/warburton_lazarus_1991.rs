//! Everyone approaches or leaves each of the others by a tendency that depends on their distance.
//!
//! K. Warburton, J. Lazarus (1991), Tendency-distance models of social cohesion in animal groups, Journal of Theoretical Biology
//! 150:473 (an interpretation: the project's sources classify the paper and give no law).

use crate::card::*;
use crate::motion::*;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use crate::{choice, parameters};
use space::Vector;

choice! {
    /// How the tendency to approach depends on distance beyond the preferred one.
    pub enum Approach {
        /// It grows and levels off.
        Rising = "rising",
        /// It is the same at any distance.
        Constant = "constant",
        /// It is greatest just beyond the preferred distance and fades.
        Falling = "falling",
    }
}

parameters! {
    /// Parameters of `warburton_lazarus_1991`.
    pub struct WarburtonLazarus1991 {
        /// Distance at which the tendency changes its sign.
        preferred_distance alias "r_e": R = 2.0, "r_e", "length", Positive, Ours;
        /// Distance over which approach grows or fades.
        decay alias "l": R = 4.0, "lambda", "length", Positive, Ours;
        /// How the tendency to approach depends on distance.
        approach: Approach = "rising", "-", "-", Any, Ours;
        /// Weight of withdrawal, relative to approach.
        withdrawal_weight alias "w_rep": R = 1.0, "w_rep", "1", NonNegative, Ours;
        /// Largest distance moved per update.
        step_length alias "step": R = 0.5, "l", "length", NonNegative, Ours;
    }
}

impl<R: Scalar> Law<R> for WarburtonLazarus1991<R> {
    const CARD: Card = Card {
        id: "warburton_lazarus_1991",
        title: "Warburton and Lazarus 1991, tendency and distance",
        about: "Members move by the mean of tendencies to approach the far and to leave the near among all others.",
        reference: "K. Warburton, J. Lazarus (1991). Tendency-distance models of social cohesion in animal groups. Journal of \
                    Theoretical Biology 150, 473-488. doi:10.1016/S0022-5193(05)80441-2",
        equations: "t(rho) = -w_rep (1 - rho/r_e)  for rho < r_e\n\
                    t(rho) = 1 - exp(-(rho - r_e)/lambda) (rising), 1 (constant), exp(-(rho - r_e)/lambda) (falling)  beyond\n\
                    x_i' = x_i + l clip(mean_{j in I} t(rho_ij) e_ij, 1)",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = all",
            motion: "target point",
            physics: "ideal",
            obstacles: "",
        },
        departures: "an interpretation: the sources classify the paper and give no law. The paper compares shapes of the tendency to \
                     approach; the functions here are ours, and so is the classification by design",
        edge: "alone or balanced: stays; coincident members have no direction but count",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::Member,
            identification: false,
            uses: [true, false, false],
            validation: "S",
            synchronous: true,
            information: [Information::Global, Information::Global, Information::Global],
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

impl<R: Scalar> WarburtonLazarus1991<R> {
    /// The tendency to approach (positive) or to leave somebody at a distance.
    fn tendency(&self, distance: R) -> R {
        if distance < self.preferred_distance {
            return self.withdrawal_weight * (distance / self.preferred_distance - R::ONE);
        }
        let faded = ((self.preferred_distance - distance) / self.decay).exp();
        match self.approach {
            Approach::Rising => R::ONE - faded,
            Approach::Constant => R::ONE,
            Approach::Falling => faded,
        }
    }
}

impl<R: Scalar, const D: usize> Model<R, D> for WarburtonLazarus1991<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        vec![NamedSet::new("neighbours", Perception::All)]
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, _: &Draws<'_>) -> Motion<R, D> {
        let (mut approach, mut withdrawal, mut count) = (Vector::ZERO, Vector::ZERO, R::ZERO);
        for k in seen.set(0) {
            let tendency = self.tendency(seen.distance(k));
            let part = seen.direction(k) * tendency;
            if tendency < R::ZERO {
                withdrawal += part;
            } else {
                approach += part;
            }
            count += R::ONE;
        }
        let mean = |sum: Vector<R, D>| if count > R::ZERO { sum / count } else { sum };
        let (approach, withdrawal) = (mean(approach), mean(withdrawal));
        me.note("approach", approach);
        me.note("withdrawal", withdrawal);
        me.sum(approach + withdrawal);
        Motion::step((approach + withdrawal).clip(R::ONE) * self.step_length)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    fn first(approach: &str, places: &[[f64; 2]]) -> space::Vector<f64, 2> {
        let mut agents = vec![([0.0, 0.0], [0.0, 0.0])];
        agents.extend(places.iter().map(|&place| (place, [0.0, 0.0])));
        Oracle::new("warburton_lazarus_1991").set("approach", approach).step(&agents).position(0)
    }

    #[test]
    fn tendencies_by_distance() {
        let faded = (-1.0f64).exp();
        close(first("rising", &[[6.0, 0.0]]), [0.5 * (1.0 - faded), 0.0]);
        close(first("constant", &[[6.0, 0.0]]), [0.5, 0.0]);
        close(first("falling", &[[6.0, 0.0]]), [0.5 * faded, 0.0]);
        for approach in ["rising", "constant", "falling"] {
            close(first(approach, &[[0.0, 1.0]]), [0.0, -0.25]);
        }
        close(first("rising", &[[2.0, 0.0]]), [0.0, 0.0]);
    }

    #[test]
    fn the_mean_of_all_and_nobody() {
        // one to leave at 1, one to approach: half of each; a coincident one counts
        close(first("constant", &[[0.0, 1.0], [9.0, 0.0]]), [0.25, -0.125]);
        close(first("constant", &[[9.0, 0.0], [0.0, 0.0]]), [0.25, 0.0]);
        close(first("constant", &[[9.0, 0.0], [-5.0, 0.0]]), [0.0, 0.0]);
        close(first("constant", &[]), [0.0, 0.0]);
        let w = Oracle::new("warburton_lazarus_1991")
            .set("w_rep", 9.0)
            .step(&[([0.0; 3], [0.0; 3]), ([0.0, 0.0, 1.0], [0.0; 3])]);
        close(w.position(0), [0.0, 0.0, -0.5]);
        close(w.velocity(0), [0.0, 0.0, -0.5]);
    }
}
