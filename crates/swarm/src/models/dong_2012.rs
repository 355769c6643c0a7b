//! Everyone approaches the velocities of those within a radius.
//!
//! J.-G. Dong (2012), Flocking under hierarchical leadership with a free-will leader, International Journal of Robust and
//! Nonlinear Control 23:1891 (the consensus of its row in the table).

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;

parameters! {
    /// Parameters of `dong_2012`.
    pub struct Dong2012 {
        /// Distance up to which others are neighbours.
        radius: R = 2.0, "w1", "length", Positive, Ours;
        /// Length of a step.
        time_step alias "dt": R = 0.05, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for Dong2012<R> {
    const CARD: Card = Card {
        id: "dong_2012",
        title: "Dong 2012",
        about: "Members approach the velocities of all within a radius.",
        reference: "J.-G. Dong (2012). Flocking under hierarchical leadership with a free-will leader. International Journal of \
                    Robust and Nonlinear Control 23, 1891-1898. doi:10.1002/rnc.2861",
        equations: "v_i' = v_i + Dt sum_{j in I} (v_j - v_i),  I = {rho_ij <= w1};  x_i' = x_i + Dt v_i  (old velocity)",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, a hair more than w1), of these those at most w1 away",
            motion: "acceleration",
            physics: "ideal",
            obstacles: "",
        },
        departures: "the weight of the table repeats the selection by distance; the hierarchy of the title is not in the row (a \
                     group whose set is a strictly ordered fixed_set has it)",
        edge: "alone: straight on; stable while Dt times the number of neighbours is below 1",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::None,
            identification: false,
            uses: [true, true, false],
            validation: "M",
            synchronous: true,
            information: [Information::Global, Information::Global, Information::None],
            environment: "unbounded free",
        },
    };
    fn time_step(&self) -> R {
        self.time_step
    }
}

impl<R: Scalar, const D: usize> Model<R, D> for Dong2012<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        // the law's range is closed, a distance's half open
        vec![NamedSet::new("neighbours", Perception::distance(R::ZERO, self.radius * R::of(1.000_001)))]
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, _: &Draws<'_>) -> Motion<R, D> {
        let limit = self.radius * self.radius;
        let mut consensus = Vector::ZERO;
        for k in seen.set(0) {
            if seen.squared[k] <= limit {
                consensus += seen.velocity(k) - me.velocity;
            }
        }
        me.unit("length/time^2");
        me.note("consensus", consensus);
        me.sum(consensus);
        Motion::old_velocity(me.velocity, me.velocity + consensus * self.time_step, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn a_pair_exchanges_velocity_and_moves_with_the_old_one() {
        // exactly at the radius
        let pair = [([0.0, 0.0], [1.0, 0.0]), ([0.0, 2.0], [0.0, 1.0])];
        let w = Oracle::new("dong_2012").step(&pair);
        close(w.velocity(0), [0.95, 0.05]);
        close(w.velocity(1), [0.05, 0.95]);
        close(w.position(0), [0.05, 0.0]);
        let w = Oracle::new("dong_2012").set("radius", 1.9999).step(&pair);
        close(w.velocity(0), [1.0, 0.0]);
    }

    #[test]
    fn the_mean_velocity_stays_and_is_reached() {
        let mut w = Oracle::new("dong_2012").set("radius", 1e3).world(&[
            ([0.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
            ([1.0, 0.0, 0.0], [0.0, 2.0, 0.0]),
            ([0.0, 1.0, 0.0], [0.0, 0.0, 3.0]),
        ]);
        w.run(300);
        for id in 0..3 {
            close(w.velocity(id), [1.0 / 3.0, 2.0 / 3.0, 1.0]);
        }
        let w = Oracle::new("dong_2012").step(&[([2.0], [1.0]), ([2.0], [-1.0])]);
        close(w.velocity(0), [0.9]);
    }
}
