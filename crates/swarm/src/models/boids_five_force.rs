//! Five forces: cohesion, alignment and separation in the own flock, food, and avoidance of other flocks.
//!
//! In the style of H. Kawabayashi, Y. Chen (2008), as in the text on genetic flocks among the sources; the world in which flocks
//! compete for food has the model `competing_flocks`.

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::{PerAgent, Scalar};
use crate::selection::{NamedSet, Perception};
use space::{Column, ColumnKind, Vector};

parameters! {
    /// Parameters of `boids_five_force`.
    pub struct BoidsFiveForce {
        /// Distance below which members of the own flock count.
        range: R = 20.0, "beta", "length", Positive, Ours;
        /// Distance below which members of other flocks count.
        other_range: R = 40.0, "-", "length", Positive, Ours;
        /// The number of each member's flock; one flock where empty.
        flock: PerAgent<usize> = [0.0; 0], "-", "1", Within(0.0, 65535.0), Ours;
        /// Divisor of cohesion.
        cohesion_divisor alias "k_coh": R = 30.0, "k_coh", "length", Positive, Source;
        /// Divisor of alignment.
        alignment_divisor alias "k_ali": R = 10.0, "k_ali", "1", Positive, Source;
        /// Factor of separation.
        separation_factor alias "k_sep": R = 0.025, "k_sep", "1", NonNegative, Source;
        /// Factor of the attraction by food that grows with the square of its distance.
        food_factor alias "k_food2": R = 0.0025, "k_food2", "1", NonNegative, Source;
        /// Factor of the attraction by food that falls with it.
        near_food_factor alias "k_food_inv": R = 36.0, "k_food_inv", "1", NonNegative, Source;
        /// Factor of the avoidance of other flocks.
        avoidance_factor alias "k_avoid": R = 300.0, "k_avoid", "1", NonNegative, Source;
        /// Cap of the speed; 0: none.
        maximum_speed alias "max_speed": R = 0.0, "v_max", "length/time", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 0.05, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for BoidsFiveForce<R> {
    const CARD: Card = Card {
        id: "boids_five_force",
        title: "Five-force boids",
        about: "Boids hold together with their own flock, steer to food and away from other flocks.",
        reference: "H. Kawabayashi, Y. Chen (2008), Interactive system of artificial fish school based on the extended boid model, as \
                    described by M. J. Hunter (2019), Investigating the Impact of a Genetic Algorithm on Inter-Flock Dynamics in a \
                    Competitive Environment, BSc dissertation, Abertay University",
        equations: "c = mean d_ij (own flock),  R = |c|;  k = nearest own;  f to the nearest food;  o = mean d_ij (others)\n\
                    acc = unit(c) R^2/(k_coh FlockSize) + unit(mean v_j)/(k_ali R) - e_ik k_sep (|I|/rho_ik)^2\n\
                    + unit(f) (k_food2 |f|^2 + k_food_inv/|f|^2) - unit(o) k_avoid/|o|\n\
                    v_i' = v_i + Dt acc  (clip to v_max if that is more than 0);  x_i' = x_i + Dt v_i'",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "mates = distance_based(0, range), others = distance_based(0, other_range); the law takes those of the own \
                        flock from the first and those of other flocks from the second",
            motion: "force",
            physics: "speed cap",
            obstacles: "",
        },
        departures: "weights are magnitudes and directions unit vectors, as the text asks; the length of the local centre appears \
                     under two names there. Food is the world's resources",
        edge: "R, rho_ik, |f| or |o| = 0: that term is 0; flock size counts the whole own flock in the group; members of other \
               groups belong to the flock of their number",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Heterogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::Member,
            identification: false,
            uses: [true, true, false],
            validation: "S",
            synchronous: true,
            information: [Information::Global, Information::Global, Information::None],
            environment: "bounded free",
        },
    };
    fn columns() -> &'static [Column] {
        &[Column { name: "flock", unit: "1", kind: ColumnKind::Count, about: "Number of the own flock." }]
    }
    fn needs(&self) -> Needs {
        Needs { velocity: true, state: true, ..Needs::default() }
    }
    fn time_step(&self) -> R {
        self.time_step
    }
    fn check(&self, members: usize) -> Result<(), String> {
        match self.flock.count() {
            Some(count) if count != members && count > 0 => Err(format!("{count} flock numbers for {members} members")),
            _ => Ok(()),
        }
    }
}

/// The law, with the size of each member's flock.
#[derive(Debug)]
pub struct FiveForces<R> {
    model: BoidsFiveForce<R>,
    /// By member; empty where all are in one flock.
    sizes: Vec<usize>,
}

impl<R: Scalar> Variant<R> for BoidsFiveForce<R> {
    type Shared = FiveForces<R>;
    fn shared(&self) -> Self::Shared {
        let mut sizes = Vec::new();
        if let PerAgent::Each(flocks) = &self.flock {
            let mut counts = std::collections::BTreeMap::new();
            flocks.iter().for_each(|flock| *counts.entry(flock).or_insert(0) += 1);
            sizes = flocks.iter().map(|flock| counts.get(flock).copied().unwrap_or(0)).collect();
        }
        FiveForces { model: self.clone(), sizes }
    }
}

/// `vector` by unit length times `weight`; nothing where the vector is zero.
fn along<R: Scalar>(vector: Vector<R, 2>, weight: impl FnOnce(R) -> R) -> Vector<R, 2> {
    let length = vector.length();
    if length > R::TINY { vector / length * weight(length) } else { Vector::ZERO }
}

impl<R: Scalar> Model<R, 2> for FiveForces<R> {
    fn sets(&self) -> Vec<NamedSet<R, 2>> {
        vec![
            NamedSet::new("mates", Perception::distance(R::ZERO, self.model.range)),
            NamedSet::new("others", Perception::distance(R::ZERO, self.model.other_range)),
        ]
    }
    fn complete(&self, start: &mut Start<'_, R, 2>) {
        start.own[0] = R::count(self.model.flock.of(start.member).copied().unwrap_or(0));
    }
    fn decide(&self, me: &mut Me<'_, R, 2>, seen: &Percepts<'_, R, 2>, _: &Draws<'_>) -> Motion<R, 2> {
        let law = &self.model;
        let (mut centre, mut velocities, mut mates) = (Vector::ZERO, Vector::ZERO, R::ZERO);
        let (mut others, mut strangers) = (Vector::ZERO, R::ZERO);
        let mut nearest: Option<usize> = None;
        for k in 0..seen.len() {
            let own = seen.state(k, 0) == me.own[0];
            if own && seen.is_in(k, 0) {
                centre += seen.offset(k);
                velocities += seen.velocity(k);
                mates += R::ONE;
                let nearer = |best: usize| (seen.squared[k], seen.id(k)) < (seen.squared[best], seen.id(best));
                if nearest.is_none_or(nearer) {
                    nearest = Some(k);
                }
            } else if !own && seen.is_in(k, 1) {
                others += seen.offset(k);
                strangers += R::ONE;
            }
        }
        let mut parts = [Vector::ZERO; 5];
        if let Some(k) = nearest {
            let centre = centre / mates;
            let size = R::count(self.sizes.get(me.member()).copied().unwrap_or(me.around.group.1 as usize));
            let far = centre.length();
            parts[0] = along(centre, |far| far * far / (law.cohesion_divisor * size));
            if far > R::TINY {
                parts[1] = (velocities / mates).unit() / (law.alignment_divisor * far);
            }
            parts[2] = -along(seen.offset(k), |gap| law.separation_factor * (mates / gap).squared());
        }
        if let Some(item) = me.around.item {
            parts[3] = along(item.offset, |far| law.food_factor * far * far + law.near_food_factor / (far * far));
        }
        if strangers > R::ZERO {
            parts[4] = -along(others / strangers, |far| law.avoidance_factor / far);
        }
        let mut force = Vector::ZERO;
        me.unit("length/time^2");
        for (name, part) in ["cohesion", "alignment", "separation", "food", "flock avoidance"].into_iter().zip(parts) {
            me.note(name, part);
            force += part;
        }
        me.sum(force);
        let mut velocity = me.velocity + force * law.time_step;
        if law.maximum_speed > R::ZERO {
            velocity = velocity.clip(law.maximum_speed);
        }
        Motion::new_velocity(velocity, law.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    use crate::resources::{ResourcePlan, Respawn};
    use space::Vector;

    /// Steps of one, so that velocities are accelerations.
    fn model() -> Oracle<2> {
        Oracle::new("boids_five_force").set("dt", 1.0)
    }

    #[test]
    fn forces_of_the_own_flock() {
        // one mate at 6: 36/(30 * 2) towards it, 1/(10 * 6) along with it, 0.025/36 away
        let w = model().step(&[([0.0, 0.0], [0.0, 0.0]), ([6.0, 0.0], [0.0, 5.0])]);
        close(w.velocity(0), [0.6 - 0.025 / 36.0, 1.0 / 60.0]);
        // two around it: the centre is 0, so that cohesion and alignment are, and both crowd (2/3 and ties to the lower index)
        let w = model().step(&[([0.0, 0.0], [0.0, 0.0]), ([3.0, 0.0], [0.0, 5.0]), ([-3.0, 0.0], [0.0, 5.0])]);
        close(w.velocity(0), [-0.025 * 4.0 / 9.0, 0.0]);
        close(w.position(0), [-0.025 * 4.0 / 9.0, 0.0]);
        // a coincident mate does nothing, and the speed has a cap where one is given
        close(model().step(&[([1.0, 0.0], [0.0, 0.0]); 2]).velocity(0), [0.0, 0.0]);
        close(model().set("max_speed", 2.0).step(&[([0.0, 0.0], [5.0, 0.0])]).velocity(0), [2.0, 0.0]);
        close(model().step(&[([0.0, 0.0], [5.0, 0.0])]).velocity(0), [5.0, 0.0]);
    }

    #[test]
    fn other_flocks_are_avoided() {
        let agents = [([0.0, 0.0], [0.0, 0.0]), ([30.0, 0.0], [0.0, 5.0]), ([0.0, 30.0], [0.0, 5.0])];
        let w = model().set("flock", [0usize, 1, 1]).step(&agents);
        // the mean of the two is 15 sqrt(2) away
        let force = 300.0 / (15.0 * 2f64.sqrt()) * 0.5f64.sqrt();
        close(w.velocity(0), [-force, -force]);
        close(model().set("flock", [0usize, 1, 1]).set("other_range", 30.0).step(&agents).velocity(0), [0.0, 0.0]);
        // the flock of the others has two members, whatever the group has
        let w = model().set("flock", [0usize, 1, 1]).set("range", 50.0).set("k_avoid", 0.0).step(&agents);
        let (far, gap) = (30.0 * 2f64.sqrt(), 1800.0);
        let towards = (far * far / 60.0 - 0.025 / gap) * 0.5f64.sqrt();
        close(w.velocity(1), [-towards, 5.0 + towards + 1.0 / (10.0 * far)]);
    }

    #[test]
    fn food_draws_least_at_its_balance() {
        let pull = |far: f64| {
            let mut oracle = model();
            oracle.plan.resources = Some(ResourcePlan {
                items: vec![Vector([far, 0.0])],
                within: 0.0,
                gains: Vec::new(),
                respawn: Respawn::Never,
                ..ResourcePlan::default()
            });
            oracle.step(&[([0.0, 0.0], [0.0, 0.0])]).velocity(0)[0]
        };
        let balance = (36.0f64 / 0.0025).powf(0.25);
        assert!((pull(2.0) - (0.01 + 9.0)).abs() < 1e-12);
        assert!(pull(balance) < pull(balance - 0.5) && pull(balance) < pull(balance + 0.5));
    }
}
