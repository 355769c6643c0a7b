//! Motile elements with an axis that follows their velocity, a pair force that is stronger ahead, and a pull to the centre.
//!
//! N. Shimoyama, K. Sugawara, T. Mizuguchi, Y. Hayakawa, M. Sano (1996), Collective motion in a system of motile elements,
//! Physical Review Letters 76:3870.

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;
use space::{Column, ColumnKind};

parameters! {
    /// Parameters of `shimoyama_1996`.
    pub struct Shimoyama1996 {
        /// Mass.
        mass alias "m": R = 1.0, "m", "mass", Positive, Ours;
        /// Drag.
        drag alias "gamma": R = 1.0, "gamma", "mass/time", NonNegative, Ours;
        /// Propulsion along the axis.
        propulsion alias "a": R = 1.0, "a", "force", NonNegative, Ours;
        /// Time in which the axis follows the velocity.
        relaxation_time alias "tau": R = 1.0, "tau", "time", Positive, Ours;
        /// How much stronger the pair force is ahead than at the side.
        anisotropy alias "d": R = 1.0, "d", "1", Within(0.0, 1.0), Ours;
        /// Strength of the pair force.
        pair_strength alias "c": R = 1.0, "c", "force", NonNegative, Ours;
        /// Distance at which the pair force vanishes.
        optimal_distance alias "r_c": R = 1.0, "r_c", "length", Positive, Ours;
        /// Strength of the pull to the centre of the neighbours.
        centre_strength alias "g": R = 0.5, "g", "force", NonNegative, Ours;
        /// Distance below which others count.
        range: R = 10.0, "beta", "length", Positive, Ours;
        /// Length of a step.
        time_step alias "dt": R = 0.05, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for Shimoyama1996<R> {
    const CARD: Card = Card {
        id: "shimoyama_1996",
        title: "Shimoyama et al. 1996",
        about: "Elements propel themselves along an axis that follows their velocity, keep a distance, and are pulled to the \
                centre of the others.",
        reference: "N. Shimoyama, K. Sugawara, T. Mizuguchi, Y. Hayakawa, M. Sano (1996). Collective motion in a system of motile \
                    elements. Physical Review Letters 76, 3870-3873. doi:10.1103/PhysRevLett.76.3870",
        equations: "acc = (1/m)(-gamma v_i + a n_i + sum alpha_ij f_ij + g unit(mean d_ij)/|I|),  alpha_ij = 1 + d (n_i . e_ij)\n\
                    f_ij = -c (q^-3 - q^-2) exp(-q) q e_ij,  q = max(rho_ij/r_c, 1/1000)\n\
                    n_i' = unit(n_i + (Dt/tau)(vhat_i - (n_i . vhat_i) n_i)),  vhat = unit(v)\n\
                    v_i' = v_i + Dt acc;  x_i' = x_i + Dt v_i'",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, range)",
            motion: "acceleration",
            physics: "ideal",
            obstacles: "",
        },
        departures: "n x v x n is read as n x (v x n), which turns n to v; otherwise it is 0 or grows n. Members \
                     less than r_c/1000 apart repel each other as at r_c/1000, by a million c, where the published force grows \
                     without bound, so that it stays finite in both precisions",
        edge: "coincident members (rho <= 1e-12) have no pair force but count; at rest the axis stays; an axis that is not given is \
               the heading (at rest the x axis)",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: false,
            avoidance: Avoidance::Member,
            identification: false,
            uses: [true, true, true],
            validation: "S",
            synchronous: true,
            information: [Information::Global, Information::Global, Information::Global],
            environment: "unbounded free",
        },
    };
    fn columns() -> &'static [Column] {
        const ABOUT: &str = "Component of the body axis, a unit vector.";
        const fn column(name: &'static str) -> Column {
            Column { name, unit: "1", kind: ColumnKind::Quantity, about: ABOUT }
        }
        const ALL: [Column; 3] = [column("axis_x"), column("axis_y"), column("axis_z")];
        &ALL
    }
    fn needs(&self) -> Needs {
        Needs::default()
    }
    fn time_step(&self) -> R {
        self.time_step
    }
}

impl<R: Scalar, const D: usize> Model<R, D> for Shimoyama1996<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        vec![NamedSet::new("neighbours", Perception::distance(R::ZERO, self.range))]
    }
    fn complete(&self, start: &mut Start<'_, R, D>) {
        // what is given is taken as it is, as long as it is a direction
        let given: Vector<R, D> = Vector(core::array::from_fn(|a| start.own[a]));
        if given.is_tiny() || !start.given[..D].iter().any(|&given| given) {
            start.own[..D].copy_from_slice(&start.velocity.unit_or(Vector::axis(0)).0);
        }
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, _: &Draws<'_>) -> Motion<R, D> {
        let axis = Vector(core::array::from_fn(|a| me.own[a]));
        let (mut pairs, mut centre, mut count) = (Vector::ZERO, Vector::ZERO, R::ZERO);
        for k in seen.set(0) {
            let (direction, distance) = (seen.direction(k), seen.distance(k));
            centre += seen.offset(k);
            count += R::ONE;
            // the published force has no bound near contact
            let share = (distance / self.optimal_distance).most(R::of(0.001));
            let squared = share * share;
            let strength = (R::ONE / squared - R::ONE / (squared * share)) * (-share).exp() * share;
            // `direction` is zero where coincident
            pairs += direction * (strength * self.pair_strength * (R::ONE + self.anisotropy * axis.dot(direction)));
        }
        let centre = if count > R::ZERO { (centre / count).unit() * (self.centre_strength / count) } else { centre };
        let (drag, propulsion) = (-(me.velocity * self.drag), axis * self.propulsion);
        let force = drag + propulsion + pairs + centre;
        me.unit("force");
        me.note("drag", drag);
        me.note("propulsion", propulsion);
        me.note("pair forces", pairs);
        me.note("centre", centre);
        me.sum(force);
        let heading = me.heading();
        let turned = axis + (heading - axis * axis.dot(heading)) * (self.time_step / self.relaxation_time);
        let turned = if heading.is_tiny() || !turned.finite() { axis } else { turned.unit_or(axis) };
        me.own[..D].copy_from_slice(&turned.0);
        Motion::new_velocity(me.velocity + force * (self.time_step / self.mass), self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    fn axis(w: &crate::World<f64, 2>, id: u32) -> [Option<f64>; 2] {
        [w.state(id, "axis_x"), w.state(id, "axis_y")]
    }

    #[test]
    fn the_lone_propel_themselves_along_an_axis_that_follows() {
        let w = Oracle::new("shimoyama_1996")
            .set("a", 2.0)
            .column("axis_x", &[0.0])
            .column("axis_y", &[1.0])
            .step(&[([0.0, 0.0], [1.0, 0.0])]);
        close(w.velocity(0), [0.95, 0.1]);
        close(w.position(0), [0.05 * 0.95, 0.05 * 0.1]);
        // n = (0, 1) turned to (1, 0): unit((0.05, 1))
        let length = 1.0025f64.sqrt();
        assert!(
            axis(&w, 0)
                .map(|v| v.unwrap_or(9.0))
                .iter()
                .zip([0.05 / length, 1.0 / length])
                .all(|(a, b)| (a - b).abs() < 1e-12)
        );
        // an axis that is not given is the heading; at rest it stays and pushes
        let w = Oracle::new("shimoyama_1996").step(&[([0.0, 0.0], [0.0, 1.0])]);
        close(w.velocity(0), [0.0, 1.0]);
        let w = Oracle::new("shimoyama_1996").step(&[([0.0, 0.0], [0.0, 0.0])]);
        close(w.velocity(0), [0.05, 0.0]);
        assert_eq!(axis(&w, 0), [Some(1.0), Some(0.0)]);
    }

    #[test]
    fn pairs_keep_a_distance_ahead_twice_as_strongly_as_at_the_side() {
        let model = || Oracle::new("shimoyama_1996").set("g", 0.0).set("a", 0.0).set("gamma", 0.0);
        let first = |place: [f64; 2]| model().step(&[([0.0, 0.0], [0.0, 0.0]), (place, [0.0, 0.0])]).velocity(0);
        // at 2: -(1/8 - 1/4) exp(-2) 2 towards it
        let pull = 0.05 * 0.25 * (-2.0f64).exp();
        close(first([0.0, 2.0]), [0.0, pull]);
        close(first([2.0, 0.0]), [2.0 * pull, 0.0]);
        close(first([-2.0, 0.0]), [0.0, 0.0]);
        close(first([0.0, 1.0]), [0.0, 0.0]);
        // at 1/2: -(8 - 4) exp(-1/2)/2 away
        close(first([0.0, 0.5]), [0.0, -0.05 * 2.0 * (-0.5f64).exp()]);
        close(first([0.0, 0.0]), [0.0, 0.0]);
        // near contact no more than at a thousandth of r_c, and in contact nothing
        let touching = 0.05 * (1e6 - 1e3) * (-1e-3f64).exp();
        for near in [1.1e-12, 1e-9, 1e-4, 1e-3] {
            close(first([0.0, near]) / touching, [0.0, -1.0]);
        }
        for near in [1e-300, 1e-100, 1e-13, 1e-12] {
            close(first([0.0, near]), [0.0, 0.0]);
        }
        // the pull to the centre of two is halved once more
        let w = Oracle::new("shimoyama_1996").set("a", 0.0).set("c", 0.0).step(&[
            ([0.0; 3], [0.0; 3]),
            ([0.0, 0.0, 3.0], [0.0; 3]),
            ([0.0, 4.0, 1.0], [0.0; 3]),
        ]);
        close(w.velocity(0), [0.0, 0.0125 * 0.5f64.sqrt(), 0.0125 * 0.5f64.sqrt()]);
    }
}
