//! Repulsion before all else; otherwise attraction, alignment and the own target, weighted by need.
//!
//! L. Conradt, J. Krause, I. D. Couzin, T. J. Roper (2009), "Leading according to need" in self-organizing groups, The American
//! Naturalist 173:304.

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::{PerAgent, Points, Scalar};
use crate::selection::{NamedSet, Perception};
use space::Vector;

parameters! {
    /// Parameters of `conradt_2009`.
    pub struct Conradt2009 {
        /// Distance below which others repel.
        repulsion_radius alias "r_rep": R = 1.0, "r_rho", "length", NonNegative, Ours;
        /// Distance below which others attract and align.
        attraction_radius alias "r_att": R = 10.0, "r_att", "length", Positive, Ours;
        /// Speed, the same for all.
        speed: R = 1.0, "v0", "length/time", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 0.2, "Dt", "time", Positive, Ours;
        /// Weight of the own target, or one for each member.
        need: PerAgent<R> = 1.0, "w_i", "1", NonNegative, Ours;
        /// Place to reach, or one for each member; none where empty.
        target: Points<R> = [0.0; 0], "x_*", "length", Any, Ours;
    }
}

impl<R: Scalar> Law<R> for Conradt2009<R> {
    const CARD: Card = Card {
        id: "conradt_2009",
        title: "Conradt et al. 2009",
        about: "Members avoid, else approach and align with others and head for their own targets, the more the greater their \
                need.",
        reference: "L. Conradt, J. Krause, I. D. Couzin, T. J. Roper (2009). \"Leading according to need\" in self-organizing \
                    groups. The American Naturalist 173, 304-312. doi:10.1086/596532",
        equations: "repulsion:   u = -mean e_ij\n\
                    attraction:  u = (1/4) mean e_ij + (1/4) mean h_j + (w_i/2) unit(x_* - x_i)\n\
                    otherwise:   u = unit(x_* - x_i)\n\
                    h_i' = unit(u);  x_i' = x_i + v0 h_i' Dt",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "repulsion = distance_based(0, r_rho); attraction = distance_based(r_rho, r_att)",
            motion: "heading",
            physics: "ideal, constant speed",
            obstacles: "",
        },
        departures: "the number of neighbours is printed as if compared with a number; the length of two positions is their \
                     distance; need enters as printed",
        edge: "no target: its terms are 0; u = 0: heading kept; coincident members have no direction",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Heterogeneous,
            idealized: true,
            discrete: false,
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
        if self.repulsion_radius > self.attraction_radius {
            return Err("the repulsion radius must not be more than the attraction radius".into());
        }
        self.need.check("need", members)?;
        self.target.check("target", members)
    }
}

impl<R: Scalar, const D: usize> Model<R, D> for Conradt2009<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        vec![
            NamedSet::new("repulsion", Perception::ring(R::ZERO, self.repulsion_radius)),
            NamedSet::new("attraction", Perception::ring(self.repulsion_radius, self.attraction_radius)),
        ]
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, _: &Draws<'_>) -> Motion<R, D> {
        let sum = |set: usize| {
            let (mut towards, mut headings, mut count) = (Vector::ZERO, Vector::ZERO, R::ZERO);
            for k in seen.set(set) {
                towards += seen.direction(k);
                headings += seen.heading(k);
                count += R::ONE;
            }
            (towards, headings, count)
        };
        let space = me.around.space;
        let target = self.target.of(me.member()).map_or(Vector::ZERO, |place| space.offset(me.position, place).unit());
        let (near, far) = (sum(0), sum(1));
        let case = if near.2 > R::ZERO { 0 } else { 1 + usize::from(far.2 <= R::ZERO) };
        me.either(["repulsion", "attraction", "target alone"], case);
        let wanted = match case {
            0 => {
                let repulsion = -(near.0 / near.2);
                me.acts(&[0]);
                me.note("repulsion", repulsion);
                repulsion
            }
            1 => {
                let quarter = R::of(0.25);
                let need = self.need.of(me.member()).copied().unwrap_or(R::ZERO);
                let (attraction, alignment) = (far.0 / far.2 * quarter, far.1 / far.2 * quarter);
                let target = target * (need * R::HALF);
                me.note("attraction", attraction);
                me.note("alignment", alignment);
                me.note("target", target);
                attraction + alignment + target
            }
            _ => {
                me.note("target", target);
                target
            }
        };
        me.sum(wanted);
        Motion::new_velocity(wanted.unit_or(me.heading()) * self.speed, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn quarters_and_half_the_need() {
        // (1/4)(1, 0) + (1/4)(0, 1) + (0.8/2)(0, -1)
        let pair = [([0.0, 0.0], [1.0, 0.0]), ([4.0, 0.0], [0.0, 1.0])];
        let model = || Oracle::new("conradt_2009").set("need", 0.8).set("target", [0.0, -9.0]);
        let w = model().step(&pair);
        let length = f64::hypot(0.25, -0.15);
        close(w.velocity(0), [0.25 / length, -0.15 / length]);
        close(w.position(0), [0.2 * 0.25 / length, -0.2 * 0.15 / length]);
        // without a target, and beyond the attraction radius
        let half = 0.5f64.sqrt();
        close(Oracle::new("conradt_2009").step(&pair).velocity(0), [half, half]);
        close(model().set("r_att", 4.0).step(&pair).velocity(0), [0.0, -1.0]);
    }

    #[test]
    fn repulsion_comes_first_and_the_lone_go_straight() {
        let near = [([0.0, 0.0], [1.0, 0.0]), ([0.0, 0.5], [1.0, 0.0])];
        let w = Oracle::new("conradt_2009").set("target", [0.0, 9.0]).step(&near);
        close(w.velocity(0), [0.0, -1.0]);
        let targets = crate::parameters::Value::List(vec![[0.0, 9.0].into(), [-9.0, 0.5].into()]);
        let w = Oracle::new("conradt_2009").set("target", targets).set("r_rep", 0.1).set("r_att", 0.2).step(&near);
        close(w.velocity(0), [0.0, 1.0]);
        close(w.velocity(1), [-1.0, 0.0]);
        // at the target, or without one, the heading is kept; coincident repellers have no direction
        close(Oracle::new("conradt_2009").set("target", [0.0, 0.0]).step(&near[..1]).velocity(0), [1.0, 0.0]);
        close(Oracle::new("conradt_2009").set("target", [0.0, 9.0]).step(&[near[0]; 2]).velocity(0), [1.0, 0.0]);
        let w = Oracle::new("conradt_2009").set("target", [0.0, 0.0, 2.0]).step(&[([0.0; 3], [1.0, 0.0, 0.0])]);
        close(w.velocity(0), [0.0, 0.0, 1.0]);
    }
}
