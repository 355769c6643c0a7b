//! The three boid rules as vectors that can be drawn: collision avoidance by an inverse-square weight, velocity matching, flock
//! centring.
//!
//! The rule-vector view of a flocking applet, after C. W. Reynolds (1987), Flocks, herds, and schools: a distributed behavioral
//! model, Computer Graphics 21:25.

use crate::card::*;
use crate::motion::*;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use crate::{choice, parameters};
use space::Vector;
use space::lanes::{Lanes, Mask};

choice! {
    /// What the avoidance sum is divided by.
    pub enum Normalise {
        /// The number of neighbours and obstacles.
        Count = "count",
        /// The sum of their weights.
        Weights = "weights",
    }
}

parameters! {
    /// Parameters of `boids_rule_vectors`.
    pub struct BoidsRuleVectors {
        /// Interaction radius.
        radius: R = 10.0, "R", "length", Positive, Ours;
        /// Weight of collision avoidance.
        avoidance_weight alias "w_av": R = 1.0, "w_av", "length/time^2", NonNegative, Ours;
        /// Weight of velocity matching.
        matching_weight alias "w_vm": R = 1.0, "w_vm", "length/time^2", NonNegative, Ours;
        /// Weight of flock centring.
        centring_weight alias "w_fc": R = 0.1, "w_fc", "1/time^2", NonNegative, Ours;
        /// What the avoidance sum is divided by.
        normalise: Normalise = "count", "-", "-", Any, Ours;
        /// Cap of the speed.
        maximum_speed alias "max_speed": R = 2.0, "v_max", "length/time", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 0.1, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for BoidsRuleVectors<R> {
    const CARD: Card = Card {
        id: "boids_rule_vectors",
        title: "Boids as rule vectors",
        about: "Members avoid those within a radius by the inverse square of distance, match their direction and seek their \
                middle.",
        reference: "Description of a flocking applet, after C. W. Reynolds (1987). Flocks, herds, and schools: a distributed \
                    behavioral model. Computer Graphics 21, 25-34. doi:10.1145/37402.37406",
        equations: "avoid = (1/|I|) sum (R/max(rho_ij, R/1000))^2 (-e_ij)  (or divided by the sum of the weights)\n\
                    match = mean h_j;  centre = mean d_ij\n\
                    v_i' = clip(v_i + Dt (w_av avoid + w_vm match + w_fc centre), v_max);  x_i' = x_i + Dt v_i'",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, radius)",
            motion: "weighted rule vectors",
            physics: "speed cap",
            obstacles: "obstacles and walls within radius add to avoid, and to what it is divided by, like a neighbour at \
                        their nearest point",
        },
        departures: "the weight that the text calls exponential is a power law; below R/1000 it is a million, where (R/rho)^2 would \
                     grow without bound, so that sums stay finite in both precisions",
        edge: "coincident (rho <= 1e-12): no avoidance and no weight, but counted; nobody and nothing within radius: straight \
               on; inside an obstacle: out of it with the greatest weight",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: false,
            discrete: false,
            avoidance: Avoidance::All,
            identification: false,
            uses: [true, true, true],
            validation: "S",
            synchronous: true,
            information: [Information::Global, Information::Global, Information::Global],
            environment: "unbounded obstacles",
        },
    };
    fn time_step(&self) -> R {
        self.time_step
    }
    fn obstacle_reach(&self) -> Option<R> {
        Some(self.radius)
    }
    fn initial_speed(&self) -> R {
        self.maximum_speed
    }
}

impl<R: Scalar> BoidsRuleVectors<R> {
    /// The weight of somebody or something at a distance; no more than a million, which no sum of neighbours overflows.
    #[inline(always)]
    fn weight<L: Lanes<R>>(&self, distance: L) -> L {
        let near = L::splat(self.radius) / distance.greater(L::splat(self.radius / R::of(1000.0)));
        near * near
    }
}

impl<R: Scalar, const D: usize> Stream<R, D> for BoidsRuleVectors<R> {
    /// Avoidance, matching, centring; number of neighbours and sum of their weights.
    type Sums<L: Lanes<R>> = ([L; D], [L; D], [L; D], [L; 2]);

    fn sets(&self) -> Vec<NamedSet<R, D>> {
        vec![NamedSet::new("neighbours", Perception::distance(R::ZERO, self.radius))]
    }
    fn reach(&self) -> R {
        self.radius
    }
    #[inline(always)]
    fn classify<L: Lanes<R>>(&self, _: &MeLanes<L, D>, _: &[L; D], _: L, _: &Other<'_, R, D>) -> SetMasks<L::Mask> {
        let [yes, no] = [true, false].map(L::Mask::all_of);
        [yes, no, no, no]
    }
    #[inline(always)]
    fn gather<L: Lanes<R>>(
        &self,
        (avoid, matching, centre, totals): &mut Self::Sums<L>,
        _: &MeLanes<L, D>,
        offset: &[L; D],
        squared: L,
        other: &Other<'_, R, D>,
        sets: &SetMasks<L::Mask>,
    ) {
        let distance = squared.square_root();
        let apart = sets[0].and(L::splat(R::TINY).less(distance));
        let (weight, towards) = (self.weight(distance), directions(offset, squared));
        add_where(avoid, apart, core::array::from_fn(|a| -towards[a] * weight));
        add_where(matching, sets[0], splat(other.heading));
        add_where(centre, sets[0], *offset);
        totals[0] = totals[0].add_where(sets[0], L::splat(R::ONE));
        totals[1] = totals[1].add_where(apart, weight);
    }
    #[inline(always)]
    fn finish(
        &self,
        me: &mut Me<'_, R, D>,
        (avoid, matching, centre, [count, weights]): &Self::Sums<R>,
        _: &Draws<'_>,
    ) -> Motion<R, D> {
        let (mut avoid, mut total) = (Vector(*avoid), [*count, *weights]);
        for obstacle in me.around.obstacles.iter().filter(|obstacle| obstacle.distance < self.radius) {
            total[0] += R::ONE;
            if !obstacle.away.is_tiny() {
                let weight: R = self.weight(obstacle.distance);
                avoid += obstacle.away * weight;
                total[1] += weight;
            }
        }
        let share = |sum: Vector<R, D>, by: R| if by > R::ZERO { sum / by } else { Vector::ZERO };
        let divisor = match self.normalise {
            Normalise::Count => total[0],
            Normalise::Weights => total[1],
        };
        let avoid = share(avoid, divisor) * self.avoidance_weight;
        let matching = share(Vector(*matching), *count) * self.matching_weight;
        let centre = share(Vector(*centre), *count) * self.centring_weight;
        let acceleration = avoid + matching + centre;
        me.unit("length/time^2");
        me.note("collision avoidance", avoid);
        me.note("velocity matching", matching);
        me.note("flock centring", centre);
        me.sum(acceleration);
        let velocity = (me.velocity + acceleration * self.time_step).clip(self.maximum_speed);
        Motion::new_velocity(velocity, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};
    use space::shape::Shape;
    use space::{Space, Vector};

    const REST: [f64; 2] = [0.0, 0.0];

    /// The avoidance vector alone, in steps of one.
    fn avoidance() -> Oracle<2> {
        Oracle::new("boids_rule_vectors").set("w_vm", 0.0).set("w_fc", 0.0).set("max_speed", 1e9).set("dt", 1.0)
    }

    #[test]
    fn twice_the_distance_a_quarter_of_the_avoidance() {
        let at = |x| avoidance().step(&[([0.0, 0.0], REST), ([x, 0.0], REST)]).velocity(0);
        close(at(2.0), [-25.0, 0.0]);
        close(at(4.0), [-6.25, 0.0]);
        // floored at a thousandth of the radius, and nothing where they coincide
        close(at(0.001) * 1e-6, [-1.0, 0.0]);
        close(at(0.0), [0.0, 0.0]);
        close(at(10.0), [0.0, 0.0]);
    }

    #[test]
    fn near_contact_the_weight_has_a_bound_and_in_contact_nobody_has_one() {
        // the third is at half the radius and weighs 4; both others count, wherever they are
        let at = |near: f64, normalise: &str| {
            let agents = [[0.0, 0.0], [near, 0.0], [0.0, 5.0]].map(|place| (place, REST));
            avoidance().set("normalise", normalise).step(&agents).velocity(0)
        };
        for near in [1e-300, 1e-100, 1e-13, 1e-12] {
            close(at(near, "count"), [0.0, -2.0]);
            close(at(near, "weights"), [0.0, -1.0]);
        }
        for near in [1.1e-12, 1e-9, 1e-4, 1e-2] {
            close(at(near, "count") * 1e-6, [-0.5, -2e-6]);
            close(at(near, "weights"), [-1e6 / 1_000_004.0, -4.0 / 1_000_004.0]);
        }
        // the cap of the speed holds there as anywhere
        let w = Oracle::new("boids_rule_vectors").step(&[([0.0, 0.0], REST), ([1e-11, 0.0], REST)]);
        close(w.velocity(0), [-2.0, 0.0]);
    }

    #[test]
    fn matching_and_centring_are_means() {
        let w = Oracle::new("boids_rule_vectors").set("w_av", 0.0).step(&[
            ([0.0, 0.0], [1.0, 0.0]),
            ([4.0, 0.0], [0.0, 7.0]),
            ([0.0, 2.0], REST),
        ]);
        close(w.velocity(0), [1.0 + 0.1 * 0.1 * 2.0, 0.1 * (0.5 + 0.1)]);
    }

    #[test]
    fn dividing_by_the_count_or_by_the_weights() {
        let agents = [([0.0, 0.0], REST), ([5.0, 0.0], REST), ([0.0, 10.0 / 3.0], REST), ([0.0, 0.0], REST)];
        close(avoidance().step(&agents).velocity(0), [-4.0 / 3.0, -9.0 / 3.0]);
        close(avoidance().set("normalise", "weights").step(&agents).velocity(0), [-4.0 / 13.0, -9.0 / 13.0]);
    }

    #[test]
    fn obstacles_and_walls_weigh_like_neighbours() {
        let disc = || Shape::Ball { centre: Vector([3.0, 0.0]), radius: 1.0 };
        let agents = [([0.0, 0.0], REST), ([0.0, 5.0], REST)];
        let w = avoidance().obstacle(disc()).step(&agents);
        close(w.velocity(0), [-25.0 / 2.0, -4.0 / 2.0]);
        let w = avoidance().obstacle(disc()).set("normalise", "weights").step(&agents[..1]);
        close(w.velocity(0), [-1.0, 0.0]);
        // a wall at 2 to the left of it, the others out of reach
        let w = avoidance().space(Space::walled([100.0, 100.0])).step(&[([2.0, 50.0], REST)]);
        close(w.velocity(0), [25.0, 0.0]);
    }
}
