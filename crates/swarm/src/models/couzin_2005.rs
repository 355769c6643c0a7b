//! Repulsion before all else; otherwise attraction and alignment, and for those who know a way, that way.
//!
//! I. D. Couzin, J. Krause, N. R. Franks, S. A. Levin (2005), Effective leadership and decision-making in animal groups on the
//! move, Nature 433:513.

use crate::card::*;
use crate::models::families::angles::with_noise;
use crate::motion::*;
use crate::parameters;
use crate::parameters::{PerAgent, Points, Scalar};
use crate::selection::{NamedSet, Perception};
use space::Vector;

parameters! {
    /// Parameters of `couzin_2005`.
    pub struct Couzin2005 {
        /// Distance below which others repel.
        repulsion_radius alias "r_rep": R = 1.0, "r_rho", "length", NonNegative, Paper;
        /// Distance below which others attract and align.
        range: R = 6.0, "beta", "length", Positive, Paper;
        /// Speed, the same for all.
        speed: R = 1.0, "v0", "length/time", NonNegative, Paper;
        /// Largest turning rate.
        turning_rate alias "turn": R = 2.0, "theta", "rad/time", NonNegative, Paper;
        /// Length of a step.
        time_step alias "dt": R = 0.2, "Dt", "time", Positive, Paper;
        /// Standard deviation of the random angle.
        noise_deviation alias "sigma": R = 0.0, "sigma", "rad", NonNegative, Ours;
        /// Weight of the preferred direction, or one for each member; 0 for those who know none.
        goal_weight alias "omega": PerAgent<R> = 0.0, "omega_i", "1", NonNegative, Ours;
        /// Preferred direction, or one for each member; none where empty.
        goal: Points<R> = [0.0; 0], "g_i", "1", Any, Ours;
    }
}

impl<R: Scalar> Law<R> for Couzin2005<R> {
    const CARD: Card = Card {
        id: "couzin_2005",
        title: "Couzin et al. 2005, leadership",
        about: "Members avoid, else approach and align with others, and informed ones balance that with a preferred direction.",
        reference: "I. D. Couzin, J. Krause, N. R. Franks, S. A. Levin (2005). Effective leadership and decision-making in \
                    animal groups on the move. Nature 433, 513-516. doi:10.1038/nature03236",
        equations: "repulsion set non-empty:  u = unit(-sum e_ij)  (goal ignored)\n\
                    else  u = unit(sum (e_ij + h_j));  informed (omega_i > 0):  u = unit(u + omega_i unit(g_i))\n\
                    u = 0:  u = h_i;  u turned by noise_i,  noise normal with SD sigma\n\
                    h_i' = turn_toward(h_i, u, theta Dt);  x_i' = x_i + v0 h_i' Dt",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "repulsion = distance_based(0, r_rho); social = distance_based(0, range)",
            motion: "heading",
            physics: "turn-limited, constant speed",
            obstacles: "",
        },
        departures: "the row has lost the avoidance zone, although Table 3.2 lists member avoidance; the alignment sum leaves out \
                     the member itself, as in couzin_2002",
        edge: "informed and alone: heads for its goal; coincident repellers have no direction: the heading is kept; noise comes \
               before the turn limit, also to a kept heading; an empty goal adds no term",
        random: &[
            RandomQuantity { name: "noise", about: "angle, normal with SD sigma; behaviour slots 0 and 1" },
            RandomQuantity {
                name: "axis_angle",
                about: "3-D: place of the axis, uniform in [0, 2 pi); behaviour slot 2",
            },
        ],
        taxonomy: Taxonomy {
            composition: Composition::Heterogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::Member,
            identification: false,
            uses: [true, true, false],
            validation: "S",
            synchronous: true,
            information: [Information::Global, Information::Global, Information::Global],
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
        self.goal_weight.check("goal_weight", members)?;
        self.goal.check("goal", members)
    }
}

impl<R: Scalar, const D: usize> Model<R, D> for Couzin2005<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        vec![
            NamedSet::new("repulsion", Perception::ring(R::ZERO, self.repulsion_radius)),
            NamedSet::new("social", Perception::distance(R::ZERO, self.range)),
        ]
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, draws: &Draws<'_>) -> Motion<R, D> {
        let heading = me.heading();
        let (mut repulsion, mut repels) = (Vector::ZERO, false);
        for k in seen.set(0) {
            repulsion -= seen.direction(k);
            repels = true;
        }
        me.note("repulsion", repulsion);
        me.either(["repulsion", "social and goal"], usize::from(!repels));
        me.acts(&[usize::from(!repels)]);
        let mut wanted = repulsion.unit();
        if !repels {
            let mut social = Vector::ZERO;
            for k in seen.set(1) {
                social += seen.direction(k) + seen.heading(k);
            }
            let omega = self.goal_weight.of(me.member()).copied().unwrap_or(R::ZERO);
            let goal = self.goal.of(me.member()).map_or(Vector::ZERO, Vector::unit) * omega;
            wanted = social.unit();
            me.note("social", wanted);
            me.note("goal", goal);
            if omega > R::ZERO {
                wanted = (wanted + goal).unit();
            }
        }
        let wanted = with_noise(wanted.unit_or(heading), self.noise_deviation, me, draws);
        let limit = self.turning_rate * self.time_step;
        me.turn("turn asked for", heading, wanted);
        me.value("turn allowed", limit, "rad");
        Motion::new_velocity(heading.turned_toward(wanted, limit) * self.speed, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn attraction_and_alignment_weigh_alike_and_turns_are_limited() {
        // e = (1, 0), h_j = (0, 1): 45 degrees, within the 0.4 rad allowed only where half of them are left
        let pair = [([0.0, 0.0], [1.0, 0.0]), ([4.0, 0.0], [0.0, 1.0])];
        let w = Oracle::new("couzin_2005").set("turn", 5.0).step(&pair);
        let half = 0.5f64.sqrt();
        close(w.velocity(0), [half, half]);
        close(w.position(0), [0.2 * half, 0.2 * half]);
        close(Oracle::new("couzin_2005").step(&pair).velocity(0), [0.4f64.cos(), 0.4f64.sin()]);
        // beyond the range straight on, within the repulsion radius away (that is, straight back: to the left)
        close(Oracle::new("couzin_2005").set("range", 4.0).step(&pair).velocity(0), [1.0, 0.0]);
        close(Oracle::new("couzin_2005").set("r_rep", 4.1).step(&pair).velocity(0), [0.4f64.cos(), 0.4f64.sin()]);
    }

    #[test]
    fn the_informed_balance_their_goal() {
        let alone = [([0.0, 0.0], [1.0, 0.0])];
        let informed = || Oracle::new("couzin_2005").set("turn", 50.0).set("omega", 0.5).set("goal", [0.0, -8.0]);
        close(informed().step(&alone).velocity(0), [0.0, -1.0]);
        let w = informed().set("omega", [0.5, 0.0]).step(&[([0.0, 0.0], [1.0, 0.0]), ([4.0, 0.0], [1.0, 0.0])]);
        // unit((1, 0) + (0, -0.5))
        close(w.velocity(0), [2.0 / 5f64.sqrt(), -1.0 / 5f64.sqrt()]);
        // the other sees it behind itself, moving along: the sum is 0 and it keeps its heading
        close(w.velocity(1), [1.0, 0.0]);
        // supplied noise comes before the limit, and turns a kept heading
        let w = Oracle::new("couzin_2005").inject("noise", &[0.1]).step(&alone);
        close(w.velocity(0), [0.1f64.cos(), 0.1f64.sin()]);
        close(
            Oracle::new("couzin_2005").inject("noise", &[3.0]).step(&alone).velocity(0),
            [0.4f64.cos(), 0.4f64.sin()],
        );
    }

    #[test]
    fn repulsion_ignores_the_goal_and_coincident_repellers_have_no_direction() {
        let pair = [([0.0, 0.0], [1.0, 0.0]), ([0.0, 0.5], [1.0, 0.0])];
        let w = Oracle::new("couzin_2005").set("turn", 50.0).set("omega", 9.0).set("goal", [0.0, 1.0]).step(&pair);
        close(w.velocity(0), [0.0, -1.0]);
        let w = Oracle::new("couzin_2005").set("omega", 9.0).set("goal", [0.0, 1.0]).step(&[pair[0]; 2]);
        close(w.velocity(0), [1.0, 0.0]);
        let w = Oracle::new("couzin_2005").step(&[([0.0; 3], [1.0, 0.0, 0.0]), ([0.0, 0.0, 3.0], [1.0, 0.0, 0.0])]);
        close(w.velocity(0), [0.4f64.cos(), 0.0, 0.4f64.sin()]);
    }
}
