//! Everyone follows the mean velocity and the mean acceleration of those within a radius, itself included.
//!
//! P. Szabo, M. Nagy, T. Vicsek (2008, 2009), Transitions in a self-propelled-particles model with coupling of accelerations,
//! Physical Review E 79:021908 (one model for both papers).

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;
use space::{Column, ColumnKind};

parameters! {
    /// Parameters of `szabo_2008`.
    pub struct Szabo2008 {
        /// Interaction radius.
        radius: R = 1.0, "r", "length", Positive, Ours;
        /// Speed, the same for all.
        speed: R = 0.1, "v", "length/time", NonNegative, Ours;
        /// Weight of the velocities; the rest is that of the accelerations.
        strategy alias "s": R = 0.5, "s", "1", Within(0.0, 1.0), Ours;
        /// Share of a half turn to either side up to which a heading errs (in the plane).
        noise_amplitude alias "eta": R = 0.0, "eta", "1", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 1.0, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for Szabo2008<R> {
    const CARD: Card = Card {
        id: "szabo_2008",
        title: "Szabo et al. 2008 and 2009",
        about: "Members of constant speed follow the mean velocity and the mean acceleration of all within a radius.",
        reference: "P. Szabo, M. Nagy, T. Vicsek (2009; first in 2008). Transitions in a self-propelled-particles model with \
                    coupling of accelerations. Physical Review E 79, 021908. doi:10.1103/PhysRevE.79.021908",
        equations: "a_j = (v_j - v_j^before)/Dt\n\
                    u = s mean_{I, i} v_j + (1 - s) Dt mean_{I, i} a_j\n\
                    h_i' = unit(u) turned by noise_i,  noise uniform in [-eta pi, eta pi)\n\
                    v_i' = v h_i';  x_i' = x_i + v_i' Dt  (new velocity)",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, radius)",
            motion: "mean velocity and acceleration with self, turned by noise",
            physics: "ideal, constant speed",
            obstacles: "",
        },
        departures: "the acceleration term of the table has lost its average over neighbours; noise in the plane only, as \
                     published",
        edge: "u = 0: heading kept, turned by the noise; a velocity before the first step is that of the first step",
        random: &[RandomQuantity {
            name: "noise",
            about: "angle (2-D), uniform in [-eta pi, eta pi); behaviour slot 0",
        }],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::None,
            identification: false,
            uses: [true, true, true],
            validation: "S",
            synchronous: true,
            information: [Information::Global, Information::Global, Information::Global],
            environment: "periodic free",
        },
    };
    fn columns() -> &'static [Column] {
        const ABOUT: &str = "Component of the velocity before the last step.";
        const fn column(name: &'static str) -> Column {
            Column { name, unit: "length/time", kind: ColumnKind::Quantity, about: ABOUT }
        }
        const ALL: [Column; 3] = [column("prev_vel_x"), column("prev_vel_y"), column("prev_vel_z")];
        &ALL
    }
    fn needs(&self) -> Needs {
        Needs { velocity: true, state: true, ..Needs::default() }
    }
    fn time_step(&self) -> R {
        self.time_step
    }
    fn initial_speed(&self) -> R {
        self.speed
    }
}

impl<R: Scalar, const D: usize> Model<R, D> for Szabo2008<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        vec![NamedSet::new("neighbours", Perception::distance(R::ZERO, self.radius))]
    }
    fn complete(&self, start: &mut Start<'_, R, D>) {
        for a in 0..D {
            if !start.given[a] {
                start.own[a] = start.velocity[a];
            }
        }
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, draws: &Draws<'_>) -> Motion<R, D> {
        let before = Vector(core::array::from_fn(|a| me.own[a]));
        let (mut velocities, mut changes, mut members) = (me.velocity, me.velocity - before, R::ONE);
        for k in seen.set(0) {
            let velocity = seen.velocity(k);
            velocities += velocity;
            changes += velocity - Vector(core::array::from_fn(|a| seen.state(k, a)));
            members += R::ONE;
        }
        let velocities = velocities * (self.strategy / members);
        // Dt times the mean acceleration
        let changes = changes * ((R::ONE - self.strategy) / members);
        let sum = velocities + changes;
        me.unit("length/time");
        me.note("velocities", velocities);
        me.note("accelerations", changes);
        me.sum(sum);
        let mut heading = sum.unit_or(me.heading());
        if D == 2 && (self.noise_amplitude > R::ZERO || draws.injected.is_some()) {
            let most = core::f64::consts::TAU * self.noise_amplitude.to_f64();
            let noise = draws.number("noise", 0.0, |s| most * (s.uniform(0) - 0.5));
            me.value("noise", noise, "rad");
            heading = heading.turned_by(noise, R::ZERO);
        }
        me.own[..D].copy_from_slice(&me.velocity.0);
        Motion::new_velocity(heading * self.speed, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn with_s_one_only_velocities_count() {
        let pair = [([0.0, 0.0], [0.1, 0.0]), ([0.5, 0.0], [0.0, 0.1])];
        let w = Oracle::new("szabo_2008").set("s", 1.0).column("prev_vel_x", &[0.0, 9.0]).step(&pair);
        let half = 0.1 * 0.5f64.sqrt();
        close(w.velocity(0), [half, half]);
        close(w.position(0), [half, half]);
        assert_eq!((w.state(0, "prev_vel_x"), w.state(1, "prev_vel_y")), (Some(0.1), Some(0.1)));
    }

    #[test]
    fn with_s_zero_only_changes_count() {
        // changes (0.1, -0.2) and (0, 0.1): the sum is (0.1, -0.1)
        let pair = [([0.0, 0.0], [0.1, 0.0]), ([0.5, 0.0], [0.0, 0.1])];
        let w = Oracle::new("szabo_2008")
            .set("s", 0.0)
            .column("prev_vel_x", &[0.0, 0.0])
            .column("prev_vel_y", &[0.2, 0.0])
            .step(&pair);
        let half = 0.1 * 0.5f64.sqrt();
        close(w.velocity(1), [half, -half]);
        // no velocity before the first step is given: nothing changed, and the heading is kept, turned by the noise
        let w = Oracle::new("szabo_2008").set("s", 0.0).inject("noise", &[0.3, 0.0]).step(&pair);
        close(w.velocity(0), [0.1 * 0.3f64.cos(), 0.1 * 0.3f64.sin()]);
        let w = Oracle::new("szabo_2008").step(&[([0.0; 3], [0.0, 0.0, 0.1]), ([0.0, 0.5, 0.0], [0.0, 0.1, 0.0])]);
        close(w.velocity(0), [0.0, half, half]);
    }
}
