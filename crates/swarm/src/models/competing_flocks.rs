//! Five forces with evolvable weights: flocks that hold together, look for food and shun each other.
//!
//! The law of a 2019 study in which a flock whose weights are evolved competes for food with one whose weights are fixed
//! (its equations 2 to 7), after H. Kawabayashi and Y. Chen (2008). What a meal gives and what living costs are resources of
//! the world, not of this law.

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::{Kind, Parameter, PerAgent, Scalar, Value};
use crate::physics::Contact;
use crate::selection::{NamedSet, Perception};
use space::lanes::{Lanes, Mask};
use space::{Column, ColumnKind, Vector};

/// Genes of a chromosome.
pub const GENES: usize = 12;

/// The flock of each member, and how many belong to each flock.
#[derive(Clone, Debug)]
pub struct Flocks {
    number: PerAgent<usize>,
    /// Number and size of each flock, where members have one each.
    sizes: Vec<(usize, usize)>,
}

impl Flocks {
    fn of(&self, member: usize) -> usize {
        self.number.of(member).copied().unwrap_or(0)
    }
    /// The whole flock of a group of `members`, the dead included.
    fn size(&self, flock: usize, members: usize) -> usize {
        self.sizes.iter().find(|&&(number, _)| number == flock).map_or(members, |&(_, size)| size)
    }
}

impl Parameter for Flocks {
    fn takes() -> Kind {
        PerAgent::<usize>::takes()
    }
    fn read(value: &Value) -> Option<Self> {
        let number = PerAgent::<usize>::read(value)?;
        let mut sizes: Vec<(usize, usize)> = Vec::new();
        if let PerAgent::Each(numbers) = &number {
            for &flock in numbers {
                match sizes.iter_mut().find(|(number, _)| *number == flock) {
                    Some((_, size)) => *size += 1,
                    None => sizes.push((flock, 1)),
                }
            }
        }
        Some(Self { number, sizes })
    }
    fn write(&self) -> Value {
        self.number.write()
    }
    fn numbers(&self, check: &mut dyn FnMut(f64)) {
        self.number.numbers(check);
    }
}

parameters! {
    /// Parameters of `competing_flocks`.
    pub struct CompetingFlocks {
        /// The twelve weights c0 to c11: one list for all members, or a list of lists with one for each.
        chromosome: PerAgent<Vec<R>> = [1.0, 30.0, 1.0, 10.0, 0.025, 1.0, 1.0, 0.0025, 36.0, 1.0, 300.0, 1.0],
            "c", "-", Any, Source;
        /// The number of each member's flock.
        flock: Flocks = 0usize, "-", "1", Within(0.0, 65535.0), Ours;
        /// Radius within which flock mates count.
        mate_radius alias "comm": R = 50.0, "r_c", "length", Positive, Ours;
        /// Radius within which members of other flocks count.
        other_radius alias "other": R = 50.0, "r_o", "length", Positive, Ours;
        /// Radius within which food is seen.
        food_radius alias "see_food": R = 100.0, "r_f", "length", NonNegative, Ours;
        /// Largest speed.
        largest_speed alias "vmax": R = 12.0, "v_max", "length/time", NonNegative, Ours;
        /// Largest acceleration that the five forces give together, before drag.
        largest_acceleration alias "amax": R = 6.0, "a_max", "length/time^2", NonNegative, Ours;
        /// Drag.
        drag: R = 0.1, "gamma", "1/time", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 1.5, "Dt", "time", Positive, Source;
        /// Whether denominators have a floor, weights a bound, motions must be numbers; false, for tests only, is the broken law.
        safeguards: bool = true, "-", "-", Any, Ours;
    }
}

/// Columns of the law, in the order of their declaration.
const FLOCK: usize = 0;
const HEALTH: usize = 1;
const ENERGY: usize = 2;

/// No weight is larger, so that sums of forces stay finite; far above any acceleration that has an effect.
const LARGEST_WEIGHT: f64 = 1e15;

impl<R: Scalar> Law<R> for CompetingFlocks<R> {
    const CARD: Card = Card {
        id: "competing_flocks",
        title: "Competing flocks with evolvable forces",
        about: "Boids hold together with their flock mates, steer to food and away from other flocks, with twelve weights each.",
        reference: "M. J. Hunter (2019), Investigating the Impact of a Genetic Algorithm on Inter-Flock Dynamics in a Competitive \
                    Environment, BSc dissertation, Abertay University, equations 2-7; after H. Kawabayashi, Y. Chen (2008), \
                    Interactive system of artificial fish school based on the extended boid model",
        equations: "m = mean d_ij over flock mates, d = |m|;  k = nearest of the n mates, s = rho_ik;  f = nearest food;  \
                    o = mean d_ij over others\n\
                    F = unit(m) (c0 d)^2/(c1 FlockSize) + unit(mean v_j) c2/(c3 d) - e_ik c4 (c5 n/(c6 s))^2\n\
                    \x20 + unit(f) (c7 |f|^2 + c8/(c9 |f|^2)) - unit(o) c10/(c11 |o|)\n\
                    v_i' = clip(v_i + (clip(F, a_max) - gamma v_i) Dt, v_max);  x_i' = x_i + v_i' Dt",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "mates = distance_based(0, mate_radius); others = distance_based(0, other_radius); the law takes \
                        those of the own flock from the first and those of other flocks from the second",
            motion: "sum of five forces",
            physics: "ideal, capped acceleration and speed; walls reverse the velocity component",
            obstacles: "",
        },
        departures: "distances in denominators are floored at 1; a weight whose denominator is 0 is the largest there is; \
                     drag and the caps on acceleration and speed are ours (the study leaves them open)",
        edge: "a force whose cause is missing is absent; the unit vector of a zero vector is zero; the nearest of equals is \
               the one with the lower index; flock size counts the members of the own group with the same number, the dead \
               included; the dead stay, feel nothing and are no one's neighbours",
        random: &[RandomQuantity {
            name: "start velocity",
            about: "where no velocity is given: each component normal with SD 1; start slots 0 to 3",
        }],
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
        &[
            Column {
                name: "flock",
                unit: "1",
                kind: ColumnKind::Count,
                about: "Number of the member's flock, always that of the parameter `flock`.",
            },
            Column {
                name: "health",
                unit: "1",
                kind: ColumnKind::Quantity,
                about: "Health; a boid at 0 is dead. 100 at the start.",
            },
            Column {
                name: "energy",
                unit: "1",
                kind: ColumnKind::Quantity,
                about: "Energy, from which living is paid. 68 at the start.",
            },
        ]
    }
    fn needs(&self) -> Needs {
        Needs { velocity: true, state: true, ..Needs::default() }
    }
    fn time_step(&self) -> R {
        self.time_step
    }
    fn contact(&self) -> Contact {
        Contact::Clamp
    }
    fn guarded(&self) -> bool {
        self.safeguards
    }
    fn check(&self, members: usize) -> Result<(), String> {
        let chromosomes = match &self.chromosome {
            PerAgent::One(chromosome) => core::slice::from_ref(chromosome),
            PerAgent::Each(chromosomes) => chromosomes,
        };
        for (what, count) in [("chromosomes", self.chromosome.count()), ("flock numbers", self.flock.number.count())] {
            if let Some(count) = count
                && count != members
            {
                return Err(format!("{count} {what} for {members} members; give one for all, or one each"));
            }
        }
        for (k, chromosome) in chromosomes.iter().enumerate() {
            if chromosome.len() != GENES {
                return Err(format!("chromosome {k} has {} genes, not {GENES}", chromosome.len()));
            }
            if let Some(gene) = chromosome.iter().find(|&&gene| self.safeguards && gene < R::ZERO) {
                return Err(format!("chromosome {k} has the gene {gene}; genes must be 0 or more"));
            }
        }
        Ok(())
    }
}

impl<R: Scalar> CompetingFlocks<R> {
    /// A distance as it stands in a denominator.
    #[inline(always)]
    fn floored(&self, distance: R) -> R {
        if self.safeguards { distance.most(R::ONE) } else { distance }
    }
    /// A weight, made finite.
    #[inline(always)]
    fn weight(&self, weight: R) -> R {
        let largest = R::of(LARGEST_WEIGHT);
        if !self.safeguards {
            weight
        } else if weight >= -largest {
            weight.least(largest)
        } else if weight < -largest {
            -largest
        } else {
            // not a number: nothing over nothing
            R::ZERO
        }
    }
}

impl<R: Scalar> Stream<R, 2> for CompetingFlocks<R> {
    /// Displacements to mates, their velocities, displacements to others, numbers of mates and others; and of the nearest mate
    /// its displacement, squared distance and id.
    type Sums<L: Lanes<R>> = ([L; 2], [L; 2], [L; 2], [L; 2], [L; 4]);
    const HEADINGS: bool = false;

    fn sets(&self) -> Vec<NamedSet<R, 2>> {
        vec![
            NamedSet::new("mates", Perception::distance(R::ZERO, self.mate_radius)),
            NamedSet::new("others", Perception::distance(R::ZERO, self.other_radius)),
        ]
    }
    fn reach(&self) -> R {
        self.mate_radius.most(self.other_radius)
    }
    fn complete(&self, start: &mut Start<'_, R, 2>) {
        start.own[FLOCK] = R::count(self.flock.of(start.member));
        for (column, value) in [(HEALTH, 100.0), (ENERGY, 68.0)] {
            if !start.given[column] {
                start.own[column] = R::of(value);
            }
        }
        if !start.velocity_given {
            *start.velocity = Vector([R::of(start.draws.normal(0)), R::of(start.draws.normal(2))]);
        }
    }
    #[inline(always)]
    fn classify<L: Lanes<R>>(
        &self,
        _: &MeLanes<L, 2>,
        _: &[L; 2],
        squared: L,
        _: &Other<'_, R, 2>,
    ) -> SetMasks<L::Mask> {
        let within = |radius: R| squared.less(L::splat(radius * radius));
        let none = L::Mask::all_of(false);
        [within(self.mate_radius), within(self.other_radius), none, none]
    }
    #[inline(always)]
    fn gather<L: Lanes<R>>(
        &self,
        (mates, velocities, others, numbers, nearest): &mut Self::Sums<L>,
        me: &MeLanes<L, 2>,
        offset: &[L; 2],
        squared: L,
        other: &Other<'_, R, 2>,
        sets: &SetMasks<L::Mask>,
    ) {
        let flock = L::splat(other.state(FLOCK));
        let id = L::splat(R::of(f64::from(other.others.id[other.row])));
        let same = me.own[FLOCK].less_equal(flock).and(flock.less_equal(me.own[FLOCK]));
        let (mate, stranger) = (sets[0].and(same), sets[1].and(same.not()));
        // the members of a flock follow each other, so that for most of the others one of the two has nothing to do
        if mate.any() {
            // neighbours come in the order of cells, so the lower id has to be looked for
            let first = numbers[0].less_equal(L::splat(R::ZERO));
            let lower = squared.less_equal(nearest[2]).and(id.less(nearest[3]));
            let nearer = mate.and(first.or(squared.less(nearest[2])).or(lower));
            for (best, new) in nearest.iter_mut().zip([offset[0], offset[1], squared, id]) {
                *best = L::choose(nearer, new, *best);
            }
            add_where(mates, mate, *offset);
            add_where(velocities, mate, splat(other.velocity));
            numbers[0] = numbers[0].add_where(mate, L::splat(R::ONE));
        }
        if stranger.any() {
            add_where(others, stranger, *offset);
            numbers[1] = numbers[1].add_where(stranger, L::splat(R::ONE));
        }
    }
    #[inline(always)]
    fn finish(
        &self,
        me: &mut Me<'_, R, 2>,
        (mates, velocities, others, numbers, nearest): &Self::Sums<R>,
        _: &Draws<'_>,
    ) -> Motion<R, 2> {
        let mut c = [R::ZERO; GENES];
        for (to, &gene) in c.iter_mut().zip(self.chromosome.of(me.member()).into_iter().flatten()) {
            *to = gene;
        }
        let mut force = Vector::ZERO;
        if numbers[0] > R::ZERO {
            let size = self.flock.size(self.flock.of(me.member()), me.around.group.1 as usize);
            let centre = Vector(*mates) / numbers[0];
            let distance = centre.length();
            let cohesion = centre.unit() * self.weight((c[0] * distance).squared() / (c[1] * R::count(size)));
            let alignment =
                (Vector(*velocities) / numbers[0]).unit() * self.weight(c[2] / (c[3] * self.floored(distance)));
            let gap = nearest[2].root();
            let crowding = c[5] * numbers[0] / (c[6] * self.floored(gap));
            let separation = Vector([nearest[0], nearest[1]]).unit() * -self.weight(c[4] * crowding.squared());
            me.note("cohesion", cohesion);
            me.note("alignment", alignment);
            me.note("separation", separation);
            force = cohesion + alignment + separation;
        }
        if let Some(item) = me.around.item
            && item.offset.length_squared() < self.food_radius * self.food_radius
        {
            let squared = item.offset.length_squared();
            let floored = self.floored(item.offset.length()).squared();
            let food = item.offset.unit() * (self.weight(c[7] * squared) + self.weight(c[8] / (c[9] * floored)));
            me.note("food", food);
            force += food;
        }
        if numbers[1] > R::ZERO {
            let centre = Vector(*others) / numbers[1];
            let avoidance = centre.unit() * -self.weight(c[10] / (c[11] * self.floored(centre.length())));
            me.note("flock avoidance", avoidance);
            force += avoidance;
        }
        me.unit("length/time^2");
        me.sum(force);
        me.value("flock mates", numbers[0], "1");
        me.value("members of other flocks", numbers[1], "1");
        me.length("deceleration by drag", me.velocity * self.drag, "length/time^2");
        me.acts(match numbers.map(|number| number > R::ZERO) {
            [true, true] => &[0, 1],
            [true, false] => &[0],
            [false, true] => &[1],
            [false, false] => &[],
        });
        if self.safeguards && !force.finite() {
            force = Vector::ZERO;
        }
        let acceleration = force.clip(self.largest_acceleration) - me.velocity * self.drag;
        let velocity = (me.velocity + acceleration * self.time_step).clip(self.largest_speed);
        Motion::new_velocity(velocity, self.time_step)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::engine::{World, WorldPlan};
    use crate::models::oracle::{Oracle, close};
    use crate::parameters::GREATEST;
    use crate::resources::{Gain, Metabolism, ResourcePlan, Respawn};
    use space::Space;

    fn food(items: &[[f64; 2]]) -> ResourcePlan<f64, 2> {
        ResourcePlan {
            items: items.iter().map(|&item| Vector(item)).collect(),
            within: 5.0,
            gains: vec![
                Gain { column: "energy".into(), amount: 40.0, capacity: 100.0 },
                Gain { column: "health".into(), amount: 10.0, capacity: 100.0 },
            ],
            respawn: Respawn::After(0.0),
            metabolism: Some(Metabolism::default()),
            ..ResourcePlan::default()
        }
    }

    fn planned(oracle: Oracle<2>, change: impl FnOnce(&mut WorldPlan<f64, 2>)) -> Oracle<2> {
        let mut oracle = oracle;
        change(&mut oracle.plan);
        oracle
    }

    #[test]
    fn two_mates_and_a_stranger_by_hand() {
        let w = Oracle::new("competing_flocks").set("flock", [0.0, 0.0, 1.0]).set("drag", 0.0).set("dt", 0.1).step(&[
            ([0.0, 0.0], [0.0, 0.0]),
            ([20.0, 0.0], [0.0, 2.0]),
            ([0.0, -40.0], [0.0, 0.0]),
        ]);
        let cohesion = 20.0 * 20.0 / (30.0 * 2.0);
        let separation = 0.025 / (20.0 * 20.0);
        let alignment = 1.0 / (10.0 * 20.0);
        let avoidance = 300.0 / 40.0;
        let force = Vector([cohesion - separation, alignment + avoidance]).clip(6.0);
        close(w.velocity(0), (force * 0.1).0);
        close(w.position(0), (force * 0.01).0);
    }

    #[test]
    fn food_pulls_most_when_near_or_far_and_not_beyond_its_radius() {
        for (place, weight) in [(2.0, 0.0025 * 4.0 + 9.0), (60.0, 9.0 + 0.01), (0.5, 36.0), (100.0, 0.0)] {
            let oracle = planned(Oracle::new("competing_flocks").set("amax", 100.0).set("dt", 0.01), |plan| {
                plan.resources = Some(food(&[[place, 0.0]]));
            });
            let w = oracle.step(&[([0.0, 0.0], [0.0, 0.0])]);
            assert!((w.velocity(0)[0] - 0.01 * weight).abs() < 1e-4, "{place}: {:?}", w.velocity(0));
        }
    }

    #[test]
    fn the_nearest_of_equals_has_the_lower_index_whatever_the_order_of_rows() {
        // separation alone; mates 1 and 2 are equally near
        let mut genes = [0.0, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 1.0];
        genes[4] = 0.25;
        for index in [crate::engine::IndexChoice::Pairs, crate::engine::IndexChoice::Cells] {
            let oracle = Oracle::new("competing_flocks").set("chromosome", genes).set("drag", 0.0).set("comm", 4.0);
            let oracle = oracle.set("other", 1.0).set("dt", 1.0).space(Space::walled([100.0, 100.0]));
            let mut plan = oracle.plan;
            plan.index = index;
            plan.groups[0].count = 3;
            plan.groups[0].placement = crate::engine::Placement::Given(crate::engine::Start {
                position: vec![Vector([50.0, 50.0]), Vector([52.0, 50.0]), Vector([48.0, 50.0])],
                velocity: Some(vec![Vector::ZERO; 3]),
                ..Default::default()
            });
            let mut w = World::new(plan).unwrap();
            w.step();
            close(w.velocity(0), [-0.25, 0.0]);
        }
    }

    #[test]
    fn a_boid_that_never_eats_ends_a_generation_at_health_48() {
        let oracle = planned(Oracle::new("competing_flocks"), |plan| plan.resources = Some(food(&[])));
        let mut w = oracle.world(&[([0.0, 0.0], [1.0, 0.0])]);
        w.run(80);
        assert!((w.state(0, "health").unwrap() - 48.0).abs() < 1e-9);
        assert_eq!(w.state(0, "energy"), Some(0.0));
    }

    #[test]
    fn no_state_however_degenerate_gives_anything_but_finite_numbers() {
        let gene_sets = [
            [0.0; GENES],
            [GREATEST; GENES],
            [1e-308; GENES],
            [1.0; GENES],
            [0.0, GREATEST, 0.0, GREATEST, 0.0, GREATEST, 0.0, GREATEST, 0.0, GREATEST, 0.0, GREATEST],
        ];
        for genes in gene_sets {
            for (spread, speed) in [(0.0, 0.0), (1e-200, 1e-200), (1e-13, 5.0), (1.0, 1e150), (30.0, 12.0)] {
                let oracle = Oracle::new("competing_flocks")
                    .set("chromosome", genes)
                    .set("flock", [0.0, 0.0, 0.0, 1.0, 1.0, 1.0])
                    .space(Space::walled([100.0, 100.0]));
                let oracle = planned(oracle, |plan| {
                    plan.resources = Some(food(&[[50.0, 50.0], [50.0 + spread, 50.0]]));
                });
                let agents: [([f64; 2], [f64; 2]); 6] = core::array::from_fn(|k| {
                    let angle = k as f64;
                    ([50.0 + spread * angle.cos(), 50.0 + spread * angle.sin()], [speed * angle.sin(), speed])
                });
                let mut w = oracle.world(&agents);
                for _ in 0..10 {
                    w.step();
                    assert!(w.frame().finite(), "genes {genes:?}, spread {spread}, speed {speed}");
                    let fastest = (0..6).map(|id| w.velocity(id).length()).fold(0.0, f64::max);
                    assert!(fastest <= 12.0 + 1e-9, "genes {genes:?}, spread {spread}, speed {speed}: {fastest}");
                }
            }
        }
    }

    #[test]
    fn genes_are_checked() {
        let law = |genes: &[f64], safeguards: bool| {
            let chromosome = Value::List(genes.iter().map(|&gene| gene.into()).collect());
            let values = [("chromosome", chromosome), ("safeguards", safeguards.into())];
            let values = values.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
            <CompetingFlocks<f64> as crate::parameters::Parameters>::from_values(&values).unwrap().check(3)
        };
        assert!(law(&[1.0; 11], true).unwrap_err().contains("11 genes"));
        assert!(law(&[-1.0; 12], true).unwrap_err().contains("0 or more"));
        assert!(law(&[-1.0; 12], false).is_ok());
    }
}
