//! A law composed of stock terms in a file, without code.
//!
//! The terms stand in [`crate::terms`]; the named sets are those of the group's selection. Nothing about a composition is found
//! while it runs but one match for each of its terms: it streams in lanes where its sets and its sensing allow, as compiled laws
//! do, and is summed over lists elsewhere, with the same bits.

use super::vicsek_1995::{AngleNoise, Update};
use crate::card::{self, Avoidance, Card, Information, RandomQuantity, Taxonomy};
use crate::engine::{Kernel, Listed, Stages, Streamed};
use crate::models::{Composite, Prepared, listed, prepared};
use crate::motion::*;
use crate::names::lasting;
use crate::parameters::{Kind, Parameter, ParameterError, Scalar, Value, Values};
use crate::selection::{NamedSet, Perception, Reach};
use crate::terms::{self, MOST, Met, MetTogether, NEIGHBOURS, PRIORITY, SET, Stock, Sum, Sums, Written};
use crate::{choice, parameters};
use space::Vector;
use space::lanes::{Lanes, Mask};
use space::spelling::nearest;

choice! {
    /// How the terms come together.
    pub enum Combine {
        /// All are summed.
        Sum = "sum",
        /// The first level of priority whose sum is not zero acts alone.
        First = "first",
        /// Level after level is granted, until the budget is spent.
        Budget = "budget",
    }
}

choice! {
    /// What the vector of the terms is.
    pub enum Motive {
        /// An acceleration.
        Acceleration = "acceleration",
        /// A direction, taken at constant speed.
        Direction = "direction",
        /// The velocity itself.
        Velocity = "velocity",
    }
}

/// Terms as they are written, in their order.
#[derive(Clone, Debug, PartialEq)]
pub struct Terms(pub Vec<Written>);

impl Parameter for Terms {
    fn takes() -> Kind {
        Kind::Terms
    }
    /// A list of tables with one key each, the term, over a table of its parameters.
    fn read(value: &Value) -> Option<Self> {
        let one = |term: &Value| match term {
            Value::Text(id) => Some((id.clone(), Values::new())),
            Value::Table(table) => match table.iter().next() {
                Some((id, Value::Table(given))) if table.len() == 1 => Some((id.clone(), given.clone())),
                _ => None,
            },
            _ => None,
        };
        if let Value::List(list) = value { list.iter().map(one).collect::<Option<_>>().map(Self) } else { None }
    }
    fn write(&self) -> Value {
        let one = |(id, given): &Written| Value::Table(Values::from([(id.clone(), Value::Table(given.clone()))]));
        Value::List(self.0.iter().map(one).collect())
    }
    fn numbers(&self, _: &mut dyn FnMut(f64)) {}
}

/// The boid rules: the terms of a composition that names none.
fn boid_rules() -> Value {
    let given =
        |given: &[(&str, Value)]| given.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect();
    Terms(vec![
        ("repel".into(), given(&[("scale", 10.0.into())])),
        ("align".into(), Values::new()),
        ("attract".into(), given(&[("weight", 0.1.into())])),
    ])
    .write()
}

parameters! {
    /// Parameters of `composed`.
    pub struct Composed {
        /// The stock terms, each with its weight and its priority, and its set where it is about members.
        terms: Terms = boid_rules(), "u_k", "-", Any, Ours;
        /// How the terms come together.
        combine: Combine = "sum", "-", "-", Any, Ours;
        /// The greatest length of the combined vector where it is granted level by level.
        budget: R = 1.0, "b", "length/time^2", NonNegative, Ours;
        /// What the combined vector is.
        motion: Motive = "acceleration", "-", "-", Any, Ours;
        /// Radius of the set `neighbours`, where the selection does not say who is in it.
        radius: R = 10.0, "R", "length", Positive, Ours;
        /// Constant speed, where the vector is a direction.
        speed: R = 1.0, "s", "length/time", NonNegative, Ours;
        /// Cap of the speed, where it is an acceleration or the velocity.
        maximum_speed alias "max_speed": R = 2.0, "v_max", "length/time", NonNegative, Ours;
        /// Greatest turn in a time, where it is a direction; 0: any turn.
        turning_rate: R = 0.0, "theta", "rad/time", NonNegative, Ours;
        /// Size of the error of the new direction.
        noise_amplitude alias "eta": R = 0.0, "eta", "rad", NonNegative, Ours;
        /// Whether that angle is uniform in an interval so wide, or normal with so large a standard deviation.
        noise_distribution: AngleNoise = "uniform", "-", "-", Any, Ours;
        /// Whether the velocity before or after the update moves the member.
        position_update: Update = "new_velocity", "-", "-", Any, Ours;
        /// Length of a step.
        time_step alias "dt": R = 0.1, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for Composed<R> {
    const CARD: Card = Card {
        id: "composed",
        title: "Composed of stock terms",
        about: "Members do what a list of stock terms says, as a file composes it; by default they are boids.",
        reference: "flockworks: a composition, not a publication. After C. W. Reynolds (1999). Steering behaviors for \
                    autonomous characters. Game Developers Conference, 763-782",
        equations: "u = sum_k w_k u_k  over the terms (sum)\n\
                    u = the sum of the first level of priority that is not zero (first)\n\
                    u = the sums of the levels in their order, each cut to what is left of the budget b (budget)\n\
                    v_i' = clip(v_i + Dt u, v_max)  (acceleration);  v_i' = clip(u, v_max)  (velocity)\n\
                    h_i' = turn_toward(h_i, unit(u) turned by noise_i, theta Dt), v_i' = s h_i'  (direction)\n\
                    x_i' = x_i + Dt v_i'  (new velocity)  or  x_i + Dt v_i  (old velocity)",
        stages: card::Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "the sets that its terms name, as the group's selection says; neighbours = distance_based(0, radius) \
                        where it does not",
            motion: "the stock terms, combined",
            physics: "speed cap, or constant speed and limited turns",
            obstacles: "those within the reach of the term `walls`, where there is one",
        },
        departures: "none: nothing is published",
        edge: "as the terms say; a direction of no length: straight on; a vector of at most 1e-12 is zero",
        random: &[
            RandomQuantity {
                name: "noise",
                about: "angle, uniform in [-eta/2, eta/2); behaviour slot 0 (normal: SD eta, slots 0 and 2)",
            },
            RandomQuantity {
                name: "axis_angle",
                about: "3-D: place of the axis, uniform in [0, 2 pi); behaviour slot 1",
            },
            RandomQuantity {
                name: "wander",
                about: "unit vector of the term `wander`; behaviour slots 3 and 4, of a second one 5 and 6",
            },
        ],
        taxonomy: Taxonomy {
            composition: card::Composition::Homogeneous,
            idealized: false,
            discrete: true,
            avoidance: Avoidance::Member,
            identification: false,
            uses: [true, true, true],
            validation: "S",
            synchronous: true,
            information: [Information::Global, Information::Global, Information::Global],
            environment: "unbounded",
        },
    };
    fn time_step(&self) -> R {
        self.time_step
    }
    fn initial_speed(&self) -> R {
        if self.motion == Motive::Direction { self.speed } else { self.maximum_speed }
    }
}

/// A term of a composition.
#[derive(Clone, Debug)]
struct Part<R> {
    term: Stock<R>,
    /// Its id, with its set.
    name: &'static str,
    level: usize,
    /// Which of the sums is its own, and the number of its set, where it is about members.
    about: Option<(usize, usize)>,
    /// First slot of its draws.
    slot: u32,
}

/// What a composition needs of the world around its law.
struct Demands<R> {
    sets: Vec<&'static str>,
    needs: Needs,
    obstacle_reach: Option<R>,
}

/// So many named sets may a composition have.
const SETS: usize = 4;

/// Slots of the draws of terms, two each.
const SLOTS: [u32; 2] = [3, 5];

impl<R: Scalar> Composed<R> {
    /// The terms in the order of their priority, and what they demand.
    fn parts(&self, dimensions: usize) -> Result<(Vec<Part<R>>, Demands<R>), String> {
        let mut demands = Demands::<R> { sets: Vec::new(), needs: Needs::default(), obstacle_reach: None };
        let (mut parts, mut called, mut summed, mut drawing) = (Vec::new(), Vec::new(), 0, 0);
        if self.terms.0.is_empty() {
            let ids: Vec<&str> = terms::LIST.iter().map(|entry| entry.card.id).collect();
            return Err(format!("a composition needs at least one term: {}", ids.join(", ")));
        }
        for (k, (id, given)) in self.terms.0.iter().enumerate() {
            let wrong = |problem: String| format!("term {k}, `{id}`: {problem}");
            let Some(entry) = terms::find(id) else {
                let near = nearest(id, terms::LIST.iter().map(|entry| entry.card.id));
                let near = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
                return Err(format!("term {k}: there is no stock term `{id}`{near}"));
            };
            let descriptors = entry.parameters();
            crate::parameters::known(&descriptors, given).map_err(|error| wrong(error.to_string()))?;
            let of = |name: &str| descriptors.iter().find(|descriptor| descriptor.name == name);
            let level = match of(PRIORITY) {
                Some(descriptor) => crate::parameters::take(descriptor, given).map_err(|e| wrong(e.to_string()))?,
                None => 0,
            };
            let mut own = given.clone();
            own.retain(|name, _| name != SET && name != PRIORITY);
            let term = match Stock::read(id, &own) {
                Some(read) => read.map_err(|error| wrong(error.to_string()))?,
                None => return Err(wrong("it is not a stock term".into())),
            };
            term.check(dimensions).map_err(wrong)?;
            let mut name = lasting(id);
            let about = match of(SET) {
                None => None,
                Some(descriptor) => {
                    let set: String = crate::parameters::take(descriptor, given).map_err(|e| wrong(e.to_string()))?;
                    let set = lasting(&set);
                    name = lasting(&format!("{id} {set}"));
                    let at = demands.sets.iter().position(|other| *other == set).unwrap_or(demands.sets.len());
                    if at == demands.sets.len() {
                        demands.sets.push(set);
                    }
                    summed += 1;
                    Some((summed - 1, at))
                }
            };
            let slot = if matches!(term, Stock::Wander(_)) {
                drawing += 1;
                *SLOTS.get(drawing - 1).ok_or_else(|| wrong(format!("there can be {} of them", SLOTS.len())))?
            } else {
                0
            };
            demands.needs.velocity |= entry.card.velocity;
            demands.obstacle_reach =
                term.obstacle_reach().into_iter().chain(demands.obstacle_reach).reduce(|a, b| a.most(b));
            called.push(name);
            let again = called.iter().filter(|other| **other == name).count();
            let name = if again == 1 { name } else { lasting(&format!("{name} ({again})")) };
            parts.push(Part { term, name, level, about, slot });
        }
        if summed > MOST {
            return Err(format!("a composition can have {MOST} terms about members, found {summed}"));
        }
        if demands.sets.len() > SETS {
            let found = demands.sets.join(", ");
            return Err(format!("a composition can have {SETS} named sets, found {found}"));
        }
        parts.sort_by_key(|part| part.level);
        Ok((parts, demands))
    }
}

impl<R: Scalar, const D: usize> Composite<R, D> for Composed<R> {
    fn prepared(self, members: usize) -> Result<Prepared<R, D>, ParameterError> {
        let (parts, demands) = self.parts(D).map_err(ParameterError::Together)?;
        let set = |&name: &&'static str| match name {
            NEIGHBOURS => NamedSet::new(name, Perception::distance(R::ZERO, self.radius)),
            _ => NamedSet::unsaid(name),
        };
        let sets = demands.sets.iter().map(set).collect();
        let reach = if demands.sets.is_empty() { R::TINY } else { self.radius };
        let model = self.clone();
        let build = Box::new(move |mut stages: Stages<R, D>| -> Box<dyn Kernel<R, D>> {
            let reach = match stages.reach {
                Reach::Within(reach) => reach,
                Reach::Nearest(_) | Reach::All => R::INFINITY,
            };
            let law = Composition::new(self, parts, stages.sets.clone(), reach);
            if law.limits.is_some() {
                // the sets of the selection are the law's own
                stages.own_sets = true;
                Box::new(Streamed { listed: Listed { law: Summed(law), stages } })
            } else {
                listed(Summed(law))(stages)
            }
        });
        let mut prepared = prepared(&model, members, sets, Some(reach), build)?;
        (prepared.needs, prepared.obstacle_reach) = (demands.needs, demands.obstacle_reach);
        Ok(prepared)
    }
}

/// What membership of a set depends on, neighbour by neighbour.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Limit<R> {
    /// Squared distances from this on.
    From(R),
    /// Squared distances below this.
    Below(R),
    /// Within a cone, by the cosine of half its opening.
    Cone(R),
    /// Nobody.
    Never,
}

/// Limits of all sets, each limit once.
struct Limits<R> {
    all: Vec<Limit<R>>,
    /// For each set, its limits as bits by their number.
    of: [u32; SETS],
}

/// So many different limits are told apart in lanes.
const LIMITS: usize = 12;

impl<R: Scalar> Limits<R> {
    /// The limits of these sets among those within the reach; `None` where a set is anything else, such as a rank.
    fn new<const D: usize>(sets: &[NamedSet<R, D>], reach: R) -> Option<Self> {
        let mut limits = Self { all: Vec::new(), of: [0; SETS] };
        for (set, bits) in sets.iter().zip(&mut limits.of) {
            let mut own = Vec::new();
            Self::add(&set.perception, reach, &mut own)?;
            for limit in own {
                let at = limits.all.iter().position(|other| *other == limit).unwrap_or(limits.all.len());
                if at == LIMITS {
                    return None;
                }
                if at == limits.all.len() {
                    limits.all.push(limit);
                }
                *bits |= 1 << at;
            }
        }
        Some(limits)
    }
    fn add<const D: usize>(perception: &Perception<R, D>, reach: R, to: &mut Vec<Limit<R>>) -> Option<()> {
        match perception {
            Perception::All => {}
            Perception::DistanceBased { low, high } => {
                if *low > R::ZERO {
                    to.push(Limit::From(*low * *low));
                }
                if *high < reach {
                    to.push(Limit::Below(*high * *high));
                }
            }
            Perception::Angle { cos_half, .. } => to.push(Limit::Cone(*cos_half)),
            Perception::KNearest(0) => to.push(Limit::Never),
            Perception::Intersection(parts) => parts.iter().try_for_each(|part| Self::add(part, reach, to))?,
            _ => return None,
        }
        Some(())
    }
}

/// A composition with its sets, ready to run.
struct Composition<R, const D: usize> {
    how: Composed<R>,
    parts: Vec<Part<R>>,
    /// The terms about members, in the order of their sums, each with the number of its set.
    met: Vec<(Stock<R>, usize)>,
    sets: Vec<NamedSet<R, D>>,
    /// Where the sets can be told neighbour by neighbour.
    limits: Option<Limits<R>>,
    reach: R,
    /// Whether a term uses distances and directions.
    directed: bool,
}

impl<R: Scalar, const D: usize> Composition<R, D> {
    fn new(how: Composed<R>, parts: Vec<Part<R>>, sets: Vec<NamedSet<R, D>>, reach: R) -> Self {
        let mut met: Vec<_> = parts.iter().filter_map(|part| Some((part.about?, part.term.clone()))).collect();
        met.sort_by_key(|((sum, _), _)| *sum);
        let met: Vec<_> = met.into_iter().map(|((_, set), term)| (term, set)).collect();
        let directed = met.iter().any(|(term, _)| term.directed());
        Self { how, parts, met, limits: Limits::new(&sets, reach), sets, reach, directed }
    }
    /// The combined vector of the terms.
    #[inline(always)]
    fn combined(&self, me: &mut Me<'_, R, D>, sums: &Sums<R, D>, draws: &Draws<'_>) -> Vector<R, D> {
        let nobody = Sum { vector: [R::ZERO; D], total: R::ZERO };
        let (mut total, mut left, mut acts) = (Vector::ZERO, self.how.budget, 0u32);
        let mut at = 0;
        while at < self.parts.len() {
            // a level: all terms where they have no priorities, else those of one priority
            let level = self.parts[at].level;
            let mut end = self.parts.len();
            if self.how.combine != Combine::Sum {
                end = at;
                while end < self.parts.len() && self.parts[end].level == level {
                    end += 1;
                }
            }
            let (mut sum, mut sets) = (Vector::ZERO, 0);
            for part in &self.parts[at..end] {
                let own = match part.about {
                    Some((own, set)) => {
                        sets |= 1 << set;
                        &sums.terms[own]
                    }
                    None => &nobody,
                };
                sum += part.term.weighted(me, own, draws, part.slot);
            }
            let acting = !sum.is_tiny();
            let granted = if self.how.combine == Combine::Budget { sum.clip(left) } else { sum };
            if me.trace.is_some() {
                self.tell(me, sums, draws, &self.parts[at..end], granted.length() / sum.length().most(R::TINY), acting);
            }
            if acting || self.how.combine == Combine::Sum {
                total += granted;
                acts |= sets;
            }
            left = (left - granted.length()).most(R::ZERO);
            let done = match self.how.combine {
                Combine::Sum => true,
                Combine::First => acting,
                Combine::Budget => left <= R::TINY,
            };
            if done {
                break;
            }
            at = end;
        }
        if let Some(trace) = &mut me.trace {
            trace.acts = Some(acts);
            trace.sum = Some(total);
        }
        total
    }
    /// Tells the terms of a level, as far as they were granted.
    #[cold]
    fn tell(
        &self,
        me: &mut Me<'_, R, D>,
        sums: &Sums<R, D>,
        draws: &Draws<'_>,
        parts: &[Part<R>],
        share: R,
        acting: bool,
    ) {
        let nobody = Sum { vector: [R::ZERO; D], total: R::ZERO };
        let share = if self.how.combine == Combine::Budget && acting { share } else { R::ONE };
        for part in parts {
            let own = part.about.map_or(&nobody, |(own, _)| &sums.terms[own]);
            let vector = part.term.weighted(me, own, draws, part.slot);
            me.note(part.name, vector * share);
        }
        if self.how.combine == Combine::Budget {
            me.value("share of the level that is granted", share, "1");
        }
    }
}

impl<R: Scalar, const D: usize> Stream<R, D> for Composition<R, D> {
    type Sums<L: Lanes<R>> = Sums<L, D>;

    fn sets(&self) -> Vec<NamedSet<R, D>> {
        self.sets.clone()
    }
    fn reach(&self) -> R {
        self.reach
    }
    fn draws_first(&self) -> bool {
        self.how.noise_amplitude > R::ZERO
    }
    #[inline(always)]
    fn classify<L: Lanes<R>>(
        &self,
        me: &MeLanes<L, D>,
        offset: &[L; D],
        squared: L,
        _: &Other<'_, R, D>,
    ) -> SetMasks<L::Mask> {
        let Some(limits) = &self.limits else { return [L::Mask::all_of(false); SETS] };
        let mut masks: SetMasks<L::Mask> = core::array::from_fn(|s| L::Mask::all_of(s < self.sets.len()));
        for (l, limit) in limits.all.iter().enumerate() {
            let held = match *limit {
                Limit::From(low) => L::splat(low).less_equal(squared),
                Limit::Below(high) => squared.less(L::splat(high)),
                Limit::Cone(cos_half) => in_view(&me.heading, offset, squared, cos_half),
                Limit::Never => L::Mask::all_of(false),
            };
            for s in 0..SETS {
                if limits.of[s] >> l & 1 == 1 {
                    masks[s] = masks[s].and(held);
                }
            }
        }
        masks
    }
    #[inline(always)]
    fn gather<L: Lanes<R>>(
        &self,
        sums: &mut Sums<L, D>,
        me: &MeLanes<L, D>,
        offset: &[L; D],
        squared: L,
        other: &Other<'_, R, D>,
        sets: &SetMasks<L::Mask>,
    ) {
        let (mut distance, mut towards) = (squared, *offset);
        if self.directed {
            distance = squared.square_root();
            towards = directions(offset, squared);
        }
        let met = Met { offset, distance, towards, squared, me, other };
        sums.used = self.met.len();
        for t in 0..self.met.len().min(MOST) {
            let (term, set) = &self.met[t];
            let mask = sets[*set];
            // most neighbours are in one of several sets
            if self.sets.len() == 1 || mask.any() {
                term.meet(&mut sums.terms[t], &met, mask);
            }
        }
    }
    // a term is looked up once for several neighbours, and keeps its sum at hand
    const TOGETHER: bool = true;
    #[inline(always)]
    fn gather_together<L: Lanes<R>>(
        &self,
        sums: &mut Sums<L, D>,
        me: &MeLanes<L, D>,
        neighbours: &Together<'_, R, L, D>,
    ) {
        let count = neighbours.count.min(TOGETHER);
        let mut masks = [neighbours.near; SETS];
        for (l, limit) in self.limits.iter().flat_map(|limits| limits.all.iter().enumerate()) {
            let mut held = neighbours.near;
            match *limit {
                Limit::From(low) => {
                    for k in 0..count {
                        held[k] = L::splat(low).less_equal(neighbours.squared[k]);
                    }
                }
                Limit::Below(high) => {
                    for k in 0..count {
                        held[k] = neighbours.squared[k].less(L::splat(high));
                    }
                }
                Limit::Cone(cos_half) => {
                    for k in 0..count {
                        held[k] = in_view(&me.heading, &neighbours.offset[k], neighbours.squared[k], cos_half);
                    }
                }
                Limit::Never => held = [L::Mask::all_of(false); TOGETHER],
            }
            for s in 0..self.sets.len().min(SETS) {
                if self.limits.as_ref().is_some_and(|limits| limits.of[s] >> l & 1 == 1) {
                    for k in 0..count {
                        masks[s][k] = masks[s][k].and(held[k]);
                    }
                }
            }
        }
        let (mut distance, mut towards) = (neighbours.squared, neighbours.offset);
        if self.directed {
            for k in 0..count {
                distance[k] = neighbours.squared[k].square_root();
                towards[k] = directions(&neighbours.offset[k], neighbours.squared[k]);
            }
        }
        sums.used = self.met.len();
        for t in 0..self.met.len().min(MOST) {
            let (term, set) = &self.met[t];
            let met = MetTogether { neighbours, distance: &distance, towards: &towards, me, mask: &masks[*set] };
            term.meet_together(&mut sums.terms[t], &met, self.sets.len() > 1);
        }
    }
    #[inline(always)]
    fn finish(&self, me: &mut Me<'_, R, D>, sums: &Sums<R, D>, draws: &Draws<'_>) -> Motion<R, D> {
        let how = &self.how;
        me.unit(match how.motion {
            Motive::Acceleration => "length/time^2",
            Motive::Direction => "1",
            Motive::Velocity => "length/time",
        });
        let combined = self.combined(me, sums, draws);
        let heading = me.heading();
        let velocity = match how.motion {
            Motive::Acceleration => {
                how.aside(me, me.velocity + combined * how.time_step, draws).clip(how.maximum_speed)
            }
            Motive::Velocity => how.aside(me, combined, draws).clip(how.maximum_speed),
            Motive::Direction => {
                let mut wanted = how.astray(me, combined.unit_or(heading), draws);
                if how.turning_rate > R::ZERO {
                    let limit = how.turning_rate * how.time_step;
                    me.turn("turn asked for", heading, wanted);
                    me.value("turn allowed", limit, "rad");
                    wanted = heading.turned_toward(wanted, limit);
                }
                wanted * how.speed
            }
        };
        match how.position_update {
            Update::Old => Motion::old_velocity(me.velocity, velocity, how.time_step),
            Update::New => Motion::new_velocity(velocity, how.time_step),
        }
    }
}

impl<R: Scalar> Composed<R> {
    /// A velocity turned by the random angle, where there is one.
    #[inline(always)]
    fn aside<const D: usize>(&self, me: &mut Me<'_, R, D>, velocity: Vector<R, D>, draws: &Draws<'_>) -> Vector<R, D> {
        if self.noise_amplitude > R::ZERO || draws.injected.is_some() {
            self.astray(me, velocity.unit(), draws) * velocity.length()
        } else {
            velocity
        }
    }
    /// A direction turned by it.
    #[inline(always)]
    fn astray<const D: usize>(&self, me: &mut Me<'_, R, D>, wanted: Vector<R, D>, draws: &Draws<'_>) -> Vector<R, D> {
        let eta = self.noise_amplitude.to_f64();
        if eta <= 0.0 && draws.injected.is_none() {
            return wanted;
        }
        let noise = draws.number("noise", 0.0, |s| match self.noise_distribution {
            AngleNoise::Uniform => eta * (s.uniform(0) - 0.5),
            AngleNoise::Normal => eta * space::random::normal(s.uniform(0), s.uniform(2)),
        });
        let axis = if D == 3 { draws.number("axis_angle", 0.0, |s| s.uniform(1) * R::TAU.to_f64()) } else { R::ZERO };
        me.value("noise", noise, "rad");
        wanted.turned_by(noise, axis)
    }
}
