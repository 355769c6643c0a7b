//! Flying robots of limited turning that separate, align, close up and migrate.
//!
//! S. Hauert, S. Leven, M. Varga, F. Ruini, A. Cangelosi, J.-C. Zufferey, D. Floreano (2011), Reynolds flocking in reality with
//! fixed-wing robots: communication range vs. maximum turning rate, IROS 2011.

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::{Points, Scalar};
use crate::selection::{NamedSet, Perception};
use space::Vector;

parameters! {
    /// Parameters of `hauert_2011`.
    pub struct Hauert2011 {
        /// Distance below which others are heard.
        range: R = 300.0, "beta", "m", Positive, Ours;
        /// Weight of separation.
        separation_weight alias "w_s": R = 1.0, "w1", "1", NonNegative, Ours;
        /// Weight of alignment.
        alignment_weight alias "w_a": R = 1.0, "w2", "1", NonNegative, Ours;
        /// Weight of cohesion.
        cohesion_weight alias "w_c": R = 1.0, "w3", "1", NonNegative, Ours;
        /// Weight of migration.
        migration_weight alias "w_m": R = 0.5, "w4", "1", NonNegative, Ours;
        /// Where to go, or one place for each member; nowhere where empty.
        target: Points<R> = [0.0; 0], "x_*", "m", Any, Ours;
        /// Speed, the same for all.
        speed: R = 14.0, "v0", "m/s", NonNegative, Ours;
        /// Largest turning rate.
        turning_rate alias "turn": R = 0.5, "theta", "rad/s", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 0.1, "Dt", "s", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for Hauert2011<R> {
    const CARD: Card = Card {
        id: "hauert_2011",
        title: "Hauert et al. 2011",
        about: "Fixed-wing robots turn, as fast as they can, by the sum of separation, alignment, cohesion and migration.",
        reference: "S. Hauert, S. Leven, M. Varga, F. Ruini, A. Cangelosi, J.-C. Zufferey, D. Floreano (2011). Reynolds flocking \
                    in reality with fixed-wing robots: communication range vs. maximum turning rate. IEEE/RSJ International \
                    Conference on Intelligent Robots and Systems, 5015-5020. doi:10.1109/IROS.2011.6095129",
        equations: "u = w1 unit(mean -e_ij/rho_ij) + w2 unit(mean v_j) + w3 unit(mean d_ij) + w4 unit(x_* - x_i)\n\
                    h_i' = turn_toward(h_i, unit(u), theta Dt);  x_i' = x_i + Dt v0 h_i'",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, range)",
            motion: "heading",
            physics: "turn-limited, constant speed",
            obstacles: "",
        },
        departures: "the table adds vectors to an angle, takes the bare mean position for cohesion and a scalar for separation",
        edge: "coincident: not in the separation sum; nobody and no target: straight on",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: false,
            discrete: true,
            avoidance: Avoidance::Member,
            identification: false,
            uses: [true, true, false],
            validation: "SP",
            synchronous: false,
            information: [Information::Local, Information::Local, Information::None],
            environment: "unbounded free",
        },
    };
    fn time_step(&self) -> R {
        self.time_step
    }
    fn initial_speed(&self) -> R {
        self.speed
    }
    fn check(&self, members: usize) -> Result<(), String> {
        self.target.check("target", members)
    }
}

impl<R: Scalar> Model<R, 2> for Hauert2011<R> {
    fn sets(&self) -> Vec<NamedSet<R, 2>> {
        vec![NamedSet::new("neighbours", Perception::distance(R::ZERO, self.range))]
    }
    fn decide(&self, me: &mut Me<'_, R, 2>, seen: &Percepts<'_, R, 2>, _: &Draws<'_>) -> Motion<R, 2> {
        let (mut away, mut velocities, mut offsets) = (Vector::ZERO, Vector::ZERO, Vector::ZERO);
        for k in seen.set(0) {
            let distance = seen.distance(k);
            if distance > R::TINY {
                away -= seen.direction(k) / distance;
            }
            velocities += seen.velocity(k);
            offsets += seen.offset(k);
        }
        let space = me.around.space;
        let target = self.target.of(me.member()).map_or(Vector::ZERO, |place| space.offset(me.position, place));
        let mut wanted = Vector::ZERO;
        // the unit vector of a mean is that of the sum
        for (name, part, weight) in [
            ("separation", away, self.separation_weight),
            ("alignment", velocities, self.alignment_weight),
            ("cohesion", offsets, self.cohesion_weight),
            ("migration", target, self.migration_weight),
        ] {
            let part = part.unit() * weight;
            me.note(name, part);
            wanted += part;
        }
        me.sum(wanted);
        let (heading, limit) = (me.heading(), self.turning_rate * self.time_step);
        me.turn("turn asked for", heading, wanted);
        me.value("turn allowed", limit, "rad");
        Motion::new_velocity(heading.turned_toward(wanted.unit(), limit) * self.speed, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    fn at(angle: f64) -> [f64; 2] {
        [14.0 * angle.cos(), 14.0 * angle.sin()]
    }

    #[test]
    fn unit_vectors_are_weighed_and_turns_limited() {
        // separation and cohesion cancel: along with the neighbour
        let pair = [([0.0, 0.0], at(0.0)), ([50.0, 0.0], at(0.04))];
        let w = Oracle::new("hauert_2011").step(&pair);
        close(w.velocity(0), at(0.04));
        close(w.position(0), at(0.04).map(|v| 0.1 * v));
        let pair = [([0.0, 0.0], at(0.0)), ([50.0, 0.0], at(1.0))];
        close(Oracle::new("hauert_2011").step(&pair).velocity(0), at(0.05));
        // (-1, 0) + 3 (1, 0) + (cos 1, sin 1)
        let w = Oracle::new("hauert_2011").set("w_c", 3.0).set("turn", 99.0).step(&pair);
        close(w.velocity(0), at(1f64.sin().atan2(2.0 + 1f64.cos())));
        close(Oracle::new("hauert_2011").set("range", 50.0).step(&pair).velocity(0), at(0.0));
    }

    #[test]
    fn the_target_draws_and_the_coincident_do_not_separate() {
        let alone = [([0.0, 0.0], at(0.0))];
        close(
            Oracle::new("hauert_2011").set("target", [0.0, 9.0]).set("turn", 99.0).step(&alone).velocity(0),
            [0.0, 14.0],
        );
        close(Oracle::new("hauert_2011").step(&alone).velocity(0), at(0.0));
        let w = Oracle::new("hauert_2011").set("turn", 99.0).step(&[([0.0, 0.0], at(0.0)), ([0.0, 0.0], at(1.0))]);
        close(w.velocity(0), at(1.0));
    }
}
