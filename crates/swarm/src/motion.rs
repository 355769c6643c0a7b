//! Motion computation, the fourth stage: what a law is given and what it gives back.
//!
//! A law is a [`Model`]: it sees itself ([`Me`]), the detected members with their named sets ([`Percepts`]), and its random
//! quantities ([`Draws`]), and returns a [`Motion`]. A law that sums neighbour by neighbour is written as a [`Stream`]
//! instead, once, for plain numbers and vector lanes alike; [`Summed`] makes a `Model` of it, by the same code. A law whose
//! agents need lists, but end in arithmetic that several of them can do side by side, is written as [`Abreast`], and
//! [`Single`] makes a `Model` of it.

use crate::card::Card;
use crate::parameters::{Parameters, Scalar, Value};
use crate::physics::Contact;
use crate::selection::{NamedSet, RINGS};
use space::lanes::{Lanes, Mask};
use space::random::{Purpose, Stream as DrawStream};
use space::{Column, Columns, Real, Space, Vector};
use std::collections::BTreeMap;

/// The motion that a law wants for one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<R, const D: usize> {
    /// Velocity after the step.
    pub velocity: Vector<R, D>,
    /// Displacement in the step.
    pub displacement: Vector<R, D>,
}

impl<R: Real, const D: usize> Motion<R, D> {
    /// Moves with the new velocity: `x' = x + v' dt`.
    #[inline(always)]
    pub fn new_velocity(velocity: Vector<R, D>, dt: R) -> Self {
        Self { velocity, displacement: velocity * dt }
    }
    /// Moves with the velocity before the update: `x' = x + v dt`.
    #[inline(always)]
    pub fn old_velocity(before: Vector<R, D>, velocity: Vector<R, D>, dt: R) -> Self {
        Self { velocity, displacement: before * dt }
    }
    /// A way-point model's step: the displacement is the velocity too.
    #[inline(always)]
    pub fn step(displacement: Vector<R, D>) -> Self {
        Self { velocity: displacement, displacement }
    }
    /// Every number finite.
    #[inline(always)]
    pub fn finite(&self) -> bool {
        self.velocity.finite() && self.displacement.finite()
    }
}

/// Random quantities supplied by a caller, per agent and by name; what is not supplied takes its neutral value.
#[derive(Clone, Debug, Default)]
pub struct Injected {
    /// `[agents][components]` by name.
    pub values: BTreeMap<String, Vec<Vec<f64>>>,
}

/// The random quantities of one agent's decision.
#[derive(Clone, Copy)]
pub struct Draws<'a> {
    /// Where live draws come from.
    pub stream: DrawStream,
    /// Supplied quantities in place of live draws.
    pub injected: Option<&'a Injected>,
}

impl<'a> Draws<'a> {
    /// The draws of agent `id` in `step`.
    #[inline(always)]
    pub fn new(seed: u64, step: u64, id: u32, injected: Option<&'a Injected>) -> Self {
        Self { stream: DrawStream::new(seed, Purpose::Behaviour, step, id), injected }
    }
    /// A scalar quantity: supplied by name, or drawn by `law`; `neutral` where others are supplied but not this one.
    #[inline(always)]
    pub fn number<R: Real>(&self, name: &str, neutral: f64, law: impl FnOnce(&DrawStream) -> f64) -> R {
        R::of(match self.injected {
            None => law(&self.stream),
            Some(injected) => self.supplied(injected, name).and_then(|v| v.first().copied()).unwrap_or(neutral),
        })
    }
    /// Whether quantities are drawn, and not supplied.
    pub fn drawn(&self) -> bool {
        self.injected.is_none()
    }
    /// A vector quantity; the zero vector is neutral.
    #[inline(always)]
    pub fn vector<R: Real, const D: usize>(
        &self,
        name: &str,
        law: impl FnOnce(&DrawStream) -> Vector<R, D>,
    ) -> Vector<R, D> {
        match self.injected {
            None => law(&self.stream),
            Some(injected) => self.supplied(injected, name).map_or(Vector::ZERO, |v| Vector::of(v)),
        }
    }
    /// A vector quantity whose components are normal with this standard deviation (slots 0 and 1, 2 and 3, ...); the zero vector where
    /// nothing is drawn.
    #[inline]
    pub fn normal_vector<R: Real, const D: usize>(&self, name: &str, deviation: R) -> Vector<R, D> {
        if deviation <= R::ZERO && self.injected.is_none() {
            return Vector::ZERO;
        }
        self.vector(name, |s| Vector(core::array::from_fn(|a| deviation * R::of(s.normal(2 * a as u32)))))
    }
    /// A quantity that only a caller can supply (its live value comes from elsewhere).
    pub fn given(&self, name: &str) -> Option<f64> {
        self.supplied(self.injected?, name).and_then(|v| v.first().copied())
    }
    /// A scalar quantity about the other member `j`: supplied in the list by name, one for each member, or drawn by `law`.
    #[inline(always)]
    pub fn number_about<R: Real>(&self, name: &str, j: u32, law: impl FnOnce(&DrawStream) -> f64) -> R {
        R::of(match self.injected {
            None => law(&self.stream),
            Some(injected) => {
                injected.values.get(name).and_then(|all| all.get(j as usize)?.first().copied()).unwrap_or(0.0)
            }
        })
    }
    fn supplied(&self, injected: &'a Injected, name: &str) -> Option<&'a Vec<f64>> {
        injected.values.get(name)?.get(self.stream.agent as usize)
    }
}

/// An obstacle or wall as a member perceives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearObstacle<R, const D: usize> {
    /// From me to the nearest point of its surface.
    pub offset: Vector<R, D>,
    /// Distance to the surface, negative inside.
    pub distance: R,
    /// Unit vector from the obstacle to free space at my place; zero where undefined.
    pub away: Vector<R, D>,
    /// Radius of a ball, infinite for anything flat.
    pub radius: R,
}

/// A resource item as a member perceives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearItem<R, const D: usize> {
    /// From me to the item.
    pub offset: Vector<R, D>,
    /// Its number.
    pub item: u32,
}

/// The world around a deciding agent, as far as stages beside the members' own concern it.
pub struct Around<'a, R, const D: usize> {
    /// Obstacles and walls within the model's reach.
    pub obstacles: &'a [NearObstacle<R, D>],
    /// The nearest resource item, where there are any.
    pub item: Option<NearItem<R, D>>,
    /// The newest true state, for laws whose bounds use it whatever was sensed.
    pub truth: &'a Columns<R, D>,
    /// Row of this agent in `truth`.
    pub row: usize,
    /// Rows by id in `truth`, where rows are not in the order of ids.
    pub rows: Option<&'a [u32]>,
    /// The space.
    pub space: &'a Space<R, D>,
    /// First id of the group, and its number of members.
    pub group: (u32, u32),
    /// Angle in which the own body faces, where it keeps one (2-D).
    pub facing: Option<R>,
}

impl<R: Real, const D: usize> Around<'_, R, D> {
    /// The row of an agent in `truth`.
    #[inline]
    pub fn row_of(&self, id: u32) -> usize {
        self.rows.map_or(id as usize, |rows| rows[id as usize] as usize)
    }
}

/// The agent that decides.
pub struct Me<'a, R, const D: usize> {
    /// Index in the whole world.
    pub id: u32,
    /// Position, as the member itself knows it.
    pub position: Vector<R, D>,
    /// Velocity before the step.
    pub velocity: Vector<R, D>,
    /// Unit vector of the velocity; zero at rest.
    pub heading: Vector<R, D>,
    /// Own values of the model's declared columns, in their order; what is written here is the next state.
    pub own: &'a mut [R],
    /// The rest of the world.
    pub around: Around<'a, R, D>,
    /// Receives what the law says of its computation, when somebody looks. A step has none in it, so that what is said
    /// there costs nothing.
    pub trace: Option<&'a mut Trace<R, D>>,
}

impl<R: Real, const D: usize> Me<'_, R, D> {
    /// Unit vector of the velocity; zero at rest.
    #[inline(always)]
    pub fn heading(&self) -> Vector<R, D> {
        self.heading
    }
    /// Where ahead is, at rest too: the direction in which the body faces where it keeps one, else the heading.
    #[inline(always)]
    pub fn ahead(&self) -> Vector<R, D> {
        self.around.facing.map_or(self.heading, |angle| {
            let (sin, cos) = angle.sin_cos();
            Vector(core::array::from_fn(|a| [cos, sin, R::ZERO][a.min(2)]))
        })
    }
    /// Index in the own group.
    #[inline(always)]
    pub fn member(&self) -> usize {
        (self.id - self.around.group.0) as usize
    }
    /// Tells a component of the motion computation: a vector that the law sums, or chooses among others.
    #[inline(always)]
    pub fn note(&mut self, name: &'static str, component: Vector<R, D>) {
        if let Some(trace) = &mut self.trace {
            trace.components.push((name, component));
        }
    }
    /// Tells the unit of the components.
    #[inline(always)]
    pub fn unit(&mut self, unit: &'static str) {
        if let Some(trace) = &mut self.trace {
            trace.unit = unit;
        }
    }
    /// Tells the vector that the components add up to.
    #[inline(always)]
    pub fn sum(&mut self, sum: Vector<R, D>) {
        if let Some(trace) = &mut self.trace {
            trace.sum = Some(sum);
        }
    }
    /// Tells a number that the computation uses, with its unit.
    #[inline(always)]
    pub fn value(&mut self, name: &'static str, value: R, unit: &'static str) {
        if let Some(trace) = &mut self.trace {
            trace.values.push((name, value, unit));
        }
    }
    /// Tells the angle from one direction to another, rad.
    #[inline(always)]
    pub fn turn(&mut self, name: &'static str, from: Vector<R, D>, to: Vector<R, D>) {
        if let Some(trace) = &mut self.trace {
            trace.values.push((name, from.angle_to(to), "rad"));
        }
    }
    /// Tells the length of a vector, with its unit.
    #[inline(always)]
    pub fn length(&mut self, name: &'static str, vector: Vector<R, D>, unit: &'static str) {
        if let Some(trace) = &mut self.trace {
            trace.values.push((name, vector.length(), unit));
        }
    }
    /// Tells a behaviour that the law could have chosen, its probability in this state, and whether it was chosen.
    #[inline(always)]
    pub fn choice(&mut self, name: &'static str, probability: f64, chosen: bool) {
        if let Some(trace) = &mut self.trace {
            trace.choice.push(Choice { name, probability, chosen });
        }
    }
    /// Tells the behaviours among which the law chooses without a draw, and which of them it takes.
    #[inline(always)]
    pub fn either<const N: usize>(&mut self, names: [&'static str; N], chosen: usize) {
        if let Some(trace) = &mut self.trace {
            trace.choice.extend(names.into_iter().enumerate().map(|(k, name)| {
                let chosen = k == chosen;
                Choice { name, probability: f64::from(u8::from(chosen)), chosen }
            }));
        }
    }
    /// Tells which named sets decide about the motion. A law that does not tell is decided by all that have members.
    #[inline(always)]
    pub fn acts(&mut self, sets: &[usize]) {
        if let Some(trace) = &mut self.trace {
            trace.acts = Some(sets.iter().fold(0, |bits, &set| bits | 1 << set));
        }
    }
}

/// A behaviour among which a law chooses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// Its name.
    pub name: &'static str,
    /// Its probability, before the draw.
    pub probability: f64,
    /// Whether it was chosen.
    pub chosen: bool,
}

/// What a law says of one decision. Laws write it through [`Me`].
#[derive(Clone, Debug)]
pub struct Trace<R, const D: usize> {
    /// Named vectors of the computation.
    pub components: Vec<(&'static str, Vector<R, D>)>,
    /// Their unit.
    pub unit: &'static str,
    /// What the components add up to, where the law is their sum.
    pub sum: Option<Vector<R, D>>,
    /// Named numbers with their units.
    pub values: Vec<(&'static str, R, &'static str)>,
    /// Behaviours among which the law chose.
    pub choice: Vec<Choice>,
    /// Bit `s` is set where named set `s` decides; `None`: all that have members.
    pub acts: Option<u32>,
}

impl<R, const D: usize> Default for Trace<R, D> {
    fn default() -> Self {
        Self { components: Vec::new(), unit: "1", sum: None, values: Vec::new(), choice: Vec::new(), acts: None }
    }
}

/// So many percepts stand in a block.
pub const BLOCK: usize = 16;

/// The named sets by blocks of percepts: bit `l` of number `b` of set `s` is set where percept `l` of block `b` is in it.
pub type Marks<'a> = [&'a [u16]; RINGS];

/// The detected members of one agent, as columns, with the named sets that selection put them in.
#[derive(Clone, Copy)]
pub struct Percepts<'a, R, const D: usize> {
    /// From me to each, `[D][percepts]`.
    pub offset: [&'a [R]; D],
    /// Squared distances.
    pub squared: &'a [R],
    /// Row of each in `others`.
    pub row: &'a [u32],
    /// Bit `s` is set for members of named set `s`. Empty where a law asks for marks.
    pub sets: &'a [u32],
    /// The named sets by blocks of percepts, for laws that ask for marks.
    pub marks: Marks<'a>,
    /// Where velocities and declared columns of the percepts stand: the state itself, or what was sensed of it.
    pub others: &'a Columns<R, D>,
    /// Column in `others` of each of the model's declared columns.
    pub columns: &'a [usize],
    /// Their headings, where these are at hand; else empty.
    pub headings: [&'a [R]; D],
    /// Whether percept `k` is row `k` of `others`. Only for laws that ask for marks.
    pub whole: bool,
    /// Whether members may be unequally fast, so that headings are not velocities over one speed.
    pub uneven: bool,
    /// How laws that ask for marks may have to do with less; they use [`Self::at`] and [`Self::several`].
    pub rough: Option<Rough<'a, R, D>>,
}

/// Percepts that are whole, and of which only squared distances are written down, roughly.
#[derive(Clone, Copy)]
pub struct Rough<'a, R, const D: usize> {
    /// From where displacements are taken.
    pub from: Vector<R, D>,
    /// Squared distances, wrong by less than `margin` where percepts are in a set.
    pub squared: &'a [f32],
    /// See there.
    pub margin: f32,
    /// Where everyone is, in single precision.
    pub position: [&'a [f32]; D],
    /// Row of the agent in question.
    pub row: usize,
    /// How wrong differences of two such places may be, along each axis.
    pub displaced: f32,
}

impl<R: Real, const D: usize> Rough<'_, R, D> {
    /// Displacements to the percepts from number `first` on, one per lane.
    #[inline(always)]
    pub fn offsets<L: Lanes<f32>>(&self, first: usize) -> [L; D] {
        let mut offset = [L::splat(0.0); D];
        for a in 0..D {
            offset[a] = L::load(&self.position[a][first..]) - L::splat(self.position[a][self.row]);
        }
        offset
    }
}

impl<R: Real, const D: usize> Percepts<'_, R, D> {
    /// Number of detected members.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.row.len()
    }
    /// Whether nobody is detected.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.row.is_empty()
    }
    /// Displacement from me to percept `k`.
    #[inline(always)]
    pub fn offset(&self, k: usize) -> Vector<R, D> {
        Vector(core::array::from_fn(|a| self.offset[a][k]))
    }
    /// Number of blocks of marks.
    #[inline(always)]
    pub fn blocks(&self) -> usize {
        self.marks[0].len()
    }
    /// Displacement from me to percept `k`, and its square, whether written down or not.
    #[inline(always)]
    pub fn at(&self, k: usize) -> (Vector<R, D>, R) {
        let Some(Rough { from, .. }) = self.rough else { return (self.offset(k), self.squared[k]) };
        let mut offset = Vector::ZERO;
        for a in 0..D {
            offset.0[a] = self.others.position[a][k] - from.0[a];
        }
        (offset, dot::<R, R, D>(&offset.0, &offset.0))
    }
    /// The same for the percepts from number `first` on, one per lane. Room for a block of percepts is always there.
    #[inline(always)]
    pub fn several<L: Lanes<R>>(&self, first: usize) -> ([L; D], L) {
        let mut offset = [L::splat(R::ZERO); D];
        let Some(Rough { from, .. }) = self.rough else {
            for a in 0..D {
                offset[a] = L::load(&self.offset[a][first..]);
            }
            return (offset, L::load(&self.squared[first..]));
        };
        for a in 0..D {
            offset[a] = L::load(&self.others.position[a][first..]) - L::splat(from.0[a]);
        }
        (offset, dot(&offset, &offset))
    }
    /// Distance of percept `k`.
    #[inline(always)]
    pub fn distance(&self, k: usize) -> R {
        self.squared[k].root()
    }
    /// Unit vector to percept `k`; zero when coincident.
    #[inline(always)]
    pub fn direction(&self, k: usize) -> Vector<R, D> {
        let distance = self.distance(k);
        if distance > R::TINY { self.offset(k) / distance } else { Vector::ZERO }
    }
    /// Velocity of percept `k`; the agent's own where it is not known yet, zero where readings are not
    /// associated over time.
    #[inline(always)]
    pub fn velocity(&self, k: usize) -> Vector<R, D> {
        self.others.velocity(self.row[k] as usize)
    }
    /// Heading of percept `k`.
    #[inline(always)]
    pub fn heading(&self, k: usize) -> Vector<R, D> {
        if self.headings[0].is_empty() {
            return self.velocity(k).unit();
        }
        let row = self.row[k] as usize;
        Vector(core::array::from_fn(|a| self.headings[a][row]))
    }
    /// Id of percept `k`, for laws that need identities.
    #[inline(always)]
    pub fn id(&self, k: usize) -> u32 {
        self.others.id[self.row[k] as usize]
    }
    /// The model's declared column `column` of percept `k`.
    #[inline(always)]
    pub fn state(&self, k: usize, column: usize) -> R {
        self.others.state[self.columns[column]][self.row[k] as usize]
    }
    /// Whether percept `k` is in a named set.
    #[inline(always)]
    pub fn is_in(&self, k: usize, set: usize) -> bool {
        self.sets[k] >> set & 1 == 1
    }
    /// The members of a named set, in canonical order.
    #[inline(always)]
    pub fn set(&self, set: usize) -> impl Iterator<Item = usize> + '_ {
        (0..self.len()).filter(move |&k| self.is_in(k, set))
    }
    /// Size of a named set.
    #[inline(always)]
    pub fn count(&self, set: usize) -> usize {
        self.set(set).count()
    }
    /// The nearest member of a named set; ties go to the lower id (to the earlier reading, where ids are readings).
    #[inline]
    pub fn nearest(&self, set: usize) -> Option<usize> {
        // the distance first, several at a time
        const TOGETHER: usize = 8;
        let distance = |k: usize| if self.is_in(k, set) { self.squared[k] } else { R::INFINITY };
        let mut least = [R::INFINITY; TOGETHER];
        let whole = self.len() / TOGETHER * TOGETHER;
        for first in (0..whole).step_by(TOGETHER) {
            for l in 0..TOGETHER {
                least[l] = distance(first + l).least(least[l]);
            }
        }
        let rest = (whole..self.len()).map(distance);
        let least = least.into_iter().chain(rest).fold(R::INFINITY, R::least);
        let nearest = self.set(set).filter(|&k| self.squared[k] <= least);
        nearest.min_by_key(|&k| self.id(k))
    }
}

/// What a law needs to know of others beyond where they are; a sensing that cannot give it is refused at load.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Needs {
    /// Velocities or headings of others.
    pub velocity: bool,
    /// Who they are.
    pub identity: bool,
    /// Declared state columns of others.
    pub state: bool,
}

/// A named set of parameters: those that differ from the defaults.
pub type Preset = (&'static str, &'static [(&'static str, Value)]);

/// What every law has, whichever way it is written.
pub trait Law<R: Scalar>: Parameters + Send + Sync + 'static {
    /// The model's description.
    const CARD: Card;
    /// Declared state columns.
    fn columns() -> &'static [Column] {
        &[]
    }
    /// What it needs to know of others.
    fn needs(&self) -> Needs {
        Needs { velocity: true, ..Needs::default() }
    }
    /// Whether obstacles hide the others from it, where a file says nothing of its sensing.
    fn blinded_by_obstacles() -> bool {
        false
    }
    /// Parameter sets by name, each with the values that differ from the defaults.
    fn presets() -> &'static [Preset] {
        &[]
    }
    /// Length of a step in time.
    fn time_step(&self) -> R {
        R::ONE
    }
    /// How far away obstacles and walls matter; `None` where the law has no obstacle stage.
    fn obstacle_reach(&self) -> Option<R> {
        None
    }
    /// Body radius when the scenario gives none.
    fn body_radius(&self) -> R {
        R::ZERO
    }
    /// What happens on contact when the scenario does not say: the move is not made.
    fn contact(&self) -> Contact {
        Contact::Refuse
    }
    /// Whether bodies meet each other, or only walls and obstacles.
    fn bodies_meet(&self) -> bool {
        true
    }
    /// Whether the velocity is by definition the displacement made in the step, as in way-point models: a refused move then
    /// leaves none.
    fn velocity_is_step(&self) -> bool {
        false
    }
    /// Whether a motion that is no number is not made. Only a law that is broken on purpose, to study that, says no.
    fn guarded(&self) -> bool {
        true
    }
    /// Speed at the start when the scenario gives none.
    fn initial_speed(&self) -> R {
        R::ONE
    }
    /// The same for one member, by its index in the group, where members differ.
    fn initial_speed_of(&self, _member: usize) -> R {
        self.initial_speed()
    }
    /// Checks that need the number of members (lists with one entry each) or concern several parameters at once.
    ///
    /// # Errors
    /// A sentence that says what does not fit.
    fn check(&self, _members: usize) -> Result<(), String> {
        Ok(())
    }
}

/// A model whose law is shared with others of its family: it has a card and parameters of its own, and one kernel serves all
/// (a law compiled once for each precision and dimension, however many models there are of it).
pub trait Variant<R: Scalar>: Law<R> {
    /// The law, as the engine sees it.
    type Shared: 'static;
    /// The law with the parameters of this model.
    fn shared(&self) -> Self::Shared;
}

/// Completes an initial state: which columns were given and which follow from others.
pub struct Start<'a, R, const D: usize> {
    /// Index in the group.
    pub member: usize,
    /// Draws of the initial state (purpose 1, step 2^41, the member's slots).
    pub draws: DrawStream,
    /// Velocity; to be set if it was not given and follows from the columns.
    pub velocity: &'a mut Vector<R, D>,
    /// Whether the velocity was given.
    pub velocity_given: bool,
    /// The model's declared columns.
    pub own: &'a mut [R],
    /// Which of them were given.
    pub given: &'a [bool],
}

/// A law as the engine sees it.
pub trait Model<R: Scalar, const D: usize>: Send + Sync + 'static {
    /// Whether the law reads its named sets (three at most) as [`Marks`]; see [`Abreast`].
    const MARKS: bool = false;
    /// The named sets of its selection stage, at most 32, with their default perception functions.
    fn sets(&self) -> Vec<NamedSet<R, D>>;
    /// Fills in what an initial state leaves out.
    fn complete(&self, _start: &mut Start<'_, R, D>) {}
    /// The wanted motion.
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, draws: &Draws<'_>) -> Motion<R, D>;
    /// Called with the new values of the declared columns where the body moves otherwise than wanted, for laws that keep
    /// headings in columns of their own.
    fn performed(&self, _own: &mut [R], _velocity: Vector<R, D>) {}
}

/// A law in two parts: what an agent wishes, found by each for itself, and what the wish makes of its motion, computed for
/// several agents abreast.
///
/// It reads its named sets as [`Marks`]. It is given percepts that may be in no set, and may be anybody: it must look at
/// none but those marked. What it computes must depend on who is in a set, in their order, and not on who stands between
/// them.
pub trait Abreast<R: Scalar, const D: usize>: Send + Sync + 'static {
    /// What an agent wishes.
    type Wish: Copy + Default + Send + Sync;
    /// The named sets, three at most.
    fn sets(&self) -> Vec<NamedSet<R, D>>;
    /// Fills in what an initial state leaves out.
    fn complete(&self, _start: &mut Start<'_, R, D>) {}
    /// The wish of an agent. Declared columns that only depend on it are written here.
    fn wish(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, draws: &Draws<'_>) -> Self::Wish;
    /// The motions of the agents from number `first` on, one per lane.
    fn conclude<L: Lanes<R>>(&self, first: usize, wishes: &[Self::Wish; WIDEST], agents: &mut Agents<R, D>);
    /// As [`Model::performed`].
    fn performed(&self, _own: &mut [R], _velocity: Vector<R, D>) {}
}

/// Some agents abreast, as columns.
pub struct Agents<R, const D: usize> {
    /// Velocities before the step, and then those wanted after it.
    pub velocity: [[R; WIDEST]; D],
    /// Displacements wanted in the step.
    pub displacement: [[R; WIDEST]; D],
    /// Own values of the model's declared columns, in their order; what is written here is the next state.
    pub own: Vec<[R; WIDEST]>,
}

impl<R: Real, const D: usize> Agents<R, D> {
    /// Room for agents with so many declared columns.
    pub fn new(columns: usize) -> Self {
        let nothing = [[R::ZERO; WIDEST]; D];
        Self { velocity: nothing, displacement: nothing, own: vec![[R::ZERO; WIDEST]; columns] }
    }
    /// Puts an agent into place `k`.
    #[inline(always)]
    pub fn put(&mut self, k: usize, velocity: Vector<R, D>, own: &[R]) {
        for a in 0..D {
            self.velocity[a][k] = velocity.0[a];
        }
        for (column, &value) in self.own.iter_mut().zip(own) {
            column[k] = value;
        }
    }
    /// The wanted motion of the agent in place `k`, and its declared columns.
    #[inline(always)]
    pub fn take(&self, k: usize, own: &mut [R]) -> Motion<R, D> {
        for (value, column) in own.iter_mut().zip(&self.own) {
            *value = column[k];
        }
        let mut motion = Motion { velocity: Vector::ZERO, displacement: Vector::ZERO };
        for a in 0..D {
            motion.velocity.0[a] = self.velocity[a][k];
            motion.displacement.0[a] = self.displacement[a][k];
        }
        motion
    }
}

/// A law for agents abreast, given one agent.
pub struct Single<T>(pub T);

impl<R: Scalar, const D: usize, T: Abreast<R, D>> Model<R, D> for Single<T> {
    const MARKS: bool = true;

    fn sets(&self) -> Vec<NamedSet<R, D>> {
        self.0.sets()
    }
    fn complete(&self, start: &mut Start<'_, R, D>) {
        self.0.complete(start);
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, draws: &Draws<'_>) -> Motion<R, D> {
        let mut wishes = [T::Wish::default(); WIDEST];
        wishes[0] = self.0.wish(me, seen, draws);
        let mut alone = Agents::new(me.own.len());
        alone.put(0, me.velocity, me.own);
        self.0.conclude::<R>(0, &wishes, &mut alone);
        alone.take(0, me.own)
    }
    fn performed(&self, own: &mut [R], velocity: Vector<R, D>) {
        self.0.performed(own, velocity);
    }
}

/// One agent per lane, deciding.
#[derive(Clone, Copy)]
pub struct MeLanes<'a, L, const D: usize> {
    /// Velocities.
    pub velocity: [L; D],
    /// Unit headings; zero at rest.
    pub heading: [L; D],
    /// Own values of the model's declared columns, in their order; at most the first [`MOST_OWN`].
    pub own: &'a [L],
}

/// So many declared columns of the deciding agents are at hand in lanes.
pub const MOST_OWN: usize = 4;

/// The neighbour that all lanes look at.
#[derive(Clone, Copy)]
pub struct Other<'a, R, const D: usize> {
    /// Velocity.
    pub velocity: Vector<R, D>,
    /// Unit heading; zero at rest. Only valid where [`Stream::HEADINGS`] says so.
    pub heading: Vector<R, D>,
    /// Row in `others`.
    pub row: usize,
    /// Where declared columns stand.
    pub others: &'a Columns<R, D>,
    /// Column in `others` of each of the model's declared columns.
    pub columns: &'a [usize],
}

impl<R: Real, const D: usize> Other<'_, R, D> {
    /// A declared column of this neighbour.
    #[inline(always)]
    pub fn state(&self, column: usize) -> R {
        self.others.state[self.columns[column]][self.row]
    }
}

/// So many neighbours stand in [`Together`].
pub const TOGETHER: usize = 16;

/// Neighbours of some of the agents of a block, for laws that take several at a time.
pub struct Together<'a, R, L: Lanes<R>, const D: usize> {
    /// So many there are; what stands behind them is anything.
    pub count: usize,
    /// From each agent to each of them.
    pub offset: [[L; D]; TOGETHER],
    /// Squared distances.
    pub squared: [L; TOGETHER],
    /// Whose neighbours they are.
    pub near: [L::Mask; TOGETHER],
    row: [usize; TOGETHER],
    others: &'a Columns<R, D>,
    heading: &'a [Vec<R>; D],
    columns: &'a [usize],
}

impl<'a, R: Real, L: Lanes<R>, const D: usize> Together<'a, R, L, D> {
    /// Nobody yet, of these others with these headings.
    #[inline(always)]
    pub fn new(others: &'a Columns<R, D>, heading: &'a [Vec<R>; D], columns: &'a [usize]) -> Self {
        let zero = L::splat(R::ZERO);
        Self {
            count: 0,
            offset: [[zero; D]; TOGETHER],
            squared: [zero; TOGETHER],
            near: [L::Mask::all_of(false); TOGETHER],
            row: [0; TOGETHER],
            others,
            heading,
            columns,
        }
    }
    /// Puts one more behind the first `found` of them, and tells how many there are then: it stays if it is anybody's neighbour
    /// (nothing branches on that, since nobody could foretell it).
    #[inline(always)]
    pub fn put(&mut self, found: usize, offset: &[L; D], squared: L, near: L::Mask, row: usize) -> usize {
        let k = found % TOGETHER;
        (self.offset[k], self.squared[k], self.near[k], self.row[k]) = (*offset, squared, near, row);
        k + usize::from(near.any())
    }
    /// One of them.
    #[inline(always)]
    pub fn other(&self, k: usize) -> Other<'a, R, D> {
        let row = self.row[k];
        Other {
            velocity: self.others.velocity(row),
            heading: Vector(core::array::from_fn(|a| self.heading[a][row])),
            row,
            others: self.others,
            columns: self.columns,
        }
    }
}

/// Named sets of a streaming law, one mask each; those a law does not use stay false.
pub type SetMasks<M> = [M; 4];

/// A law that can be summed neighbour by neighbour.
pub trait Stream<R: Scalar, const D: usize>: Send + Sync + 'static {
    /// The running sums.
    type Sums<L: Lanes<R>>: LaneSums<R, L, One = Self::Sums<R>>;
    /// Whether headings of neighbours are used (they are then computed once a step).
    const HEADINGS: bool = true;
    /// The named sets, at most four, as perception functions (what [`Self::classify`] computes).
    fn sets(&self) -> Vec<NamedSet<R, D>>;
    /// Distance below which others can matter; infinite for all of them.
    fn reach(&self) -> R;
    /// The named sets of a neighbour at `offset` whose squared distance is below the square of the reach.
    fn classify<L: Lanes<R>>(
        &self,
        me: &MeLanes<L, D>,
        offset: &[L; D],
        squared: L,
        other: &Other<'_, R, D>,
    ) -> SetMasks<L::Mask>;
    /// Adds a neighbour to the sums of the lanes whose masks hold.
    fn gather<L: Lanes<R>>(
        &self,
        sums: &mut Self::Sums<L>,
        me: &MeLanes<L, D>,
        offset: &[L; D],
        squared: L,
        other: &Other<'_, R, D>,
        sets: &SetMasks<L::Mask>,
    );
    /// Whether neighbours come to [`Self::gather_together`], and not one by one; not without [`Self::HEADINGS`].
    const TOGETHER: bool = false;
    /// Adds several neighbours to the sums, one after the other.
    #[inline(always)]
    fn gather_together<L: Lanes<R>>(
        &self,
        sums: &mut Self::Sums<L>,
        me: &MeLanes<L, D>,
        neighbours: &Together<'_, R, L, D>,
    ) {
        for k in 0..neighbours.count.min(TOGETHER) {
            let (offset, squared, other) = (&neighbours.offset[k], neighbours.squared[k], neighbours.other(k));
            let mut sets = self.classify::<L>(me, offset, squared, &other);
            for set in &mut sets {
                *set = set.and(neighbours.near[k]);
            }
            self.gather::<L>(sums, me, offset, squared, &other, &sets);
        }
    }
    /// The wanted motion from the sums over all neighbours.
    fn finish(&self, me: &mut Me<'_, R, D>, sums: &Self::Sums<R>, draws: &Draws<'_>) -> Motion<R, D>;
    /// Whether every decision uses the uniform draw of slot 0; it is then made for a whole block of agents at once.
    fn draws_first(&self) -> bool {
        false
    }
    /// Fills in what an initial state leaves out.
    fn complete(&self, _start: &mut Start<'_, R, D>) {}
}

/// A streaming law given a list: the same sums, taken over it in its order.
pub struct Summed<T>(pub T);

impl<R: Scalar, const D: usize, T: Stream<R, D>> Model<R, D> for Summed<T> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        self.0.sets()
    }
    fn complete(&self, start: &mut Start<'_, R, D>) {
        self.0.complete(start);
    }
    #[inline]
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, draws: &Draws<'_>) -> Motion<R, D> {
        let lanes = MeLanes { velocity: me.velocity.0, heading: me.heading.0, own: &*me.own };
        let mut sums = T::Sums::<R>::zero();
        for k in 0..seen.len() {
            let bits = seen.sets[k];
            if bits == 0 {
                continue;
            }
            let other = Other {
                velocity: seen.velocity(k),
                heading: if T::HEADINGS { seen.heading(k) } else { Vector::ZERO },
                row: seen.row[k] as usize,
                others: seen.others,
                columns: seen.columns,
            };
            let mut sets = [false; 4];
            for (s, set) in sets.iter_mut().enumerate() {
                *set = bits >> s & 1 == 1;
            }
            self.0.gather::<R>(&mut sums, &lanes, &seen.offset(k).0, seen.squared[k], &other, &sets);
        }
        self.0.finish(me, &sums, draws)
    }
}

/// Sums held in lanes: arrays and tuples of them.
pub trait LaneSums<R: Real, L: Lanes<R>>: Copy {
    /// The sums of one lane.
    type One: Copy;
    /// All zero.
    fn zero() -> Self;
    /// Writes the sums of each lane to its place.
    fn split(&self, to: &mut [Self::One]);
    /// All zero, for one lane.
    fn zero_one() -> Self::One;
}

/// No lane type is wider.
pub const WIDEST: usize = 16;

impl<R: Real, L: Lanes<R>, const N: usize> LaneSums<R, L> for [L; N] {
    type One = [R; N];
    #[inline(always)]
    fn zero() -> Self {
        [L::splat(R::ZERO); N]
    }
    #[inline(always)]
    fn split(&self, to: &mut [[R; N]]) {
        for n in 0..N {
            let mut lane = [R::ZERO; WIDEST];
            self[n].store(&mut lane);
            for (to, &from) in to.iter_mut().zip(&lane[..L::WIDTH]) {
                to[n] = from;
            }
        }
    }
    #[inline(always)]
    fn zero_one() -> [R; N] {
        [R::ZERO; N]
    }
}

macro_rules! tuple_sums {
    ($($t:ident $k:tt),*) => {
        impl<R: Real, L: Lanes<R>, $($t: LaneSums<R, L>),*> LaneSums<R, L> for ($($t,)*) {
            type One = ($($t::One,)*);
            #[inline(always)]
            fn zero() -> Self {
                ($($t::zero(),)*)
            }
            #[inline(always)]
            fn split(&self, to: &mut [Self::One]) {
                $({
                    let mut lane = [$t::zero_one(); WIDEST];
                    self.$k.split(&mut lane[..L::WIDTH]);
                    for (to, &from) in to.iter_mut().zip(&lane[..L::WIDTH]) {
                        to.$k = from;
                    }
                })*
            }
            #[inline(always)]
            fn zero_one() -> Self::One {
                ($($t::zero_one(),)*)
            }
        }
    };
}
tuple_sums!(A 0, B 1);
tuple_sums!(A 0, B 1, C 2);
tuple_sums!(A 0, B 1, C 2, E 3);
tuple_sums!(A 0, B 1, C 2, E 3, F 4);
tuple_sums!(A 0, B 1, C 2, E 3, F 4, G 5);

/// Adds a broadcast or lane-wise vector to sums, where the mask holds.
#[inline(always)]
pub fn add_where<R: Real, L: Lanes<R>, const D: usize>(sums: &mut [L; D], mask: L::Mask, add: [L; D]) {
    for a in 0..D {
        sums[a] = sums[a].add_where(mask, add[a]);
    }
}

/// The same vector in every lane.
#[inline(always)]
pub fn splat<R: Real, L: Lanes<R>, const D: usize>(vector: Vector<R, D>) -> [L; D] {
    // loops throughout: a closure is not compiled for the lanes
    let mut all = [L::splat(R::ZERO); D];
    for a in 0..D {
        all[a] = L::splat(vector.0[a]);
    }
    all
}

/// Unit vectors of offsets whose squared lengths are known; zero where the length is at most 1e-12.
#[inline(always)]
pub fn directions<R: Real, L: Lanes<R>, const D: usize>(offset: &[L; D], squared: L) -> [L; D] {
    let distance = squared.square_root();
    let apart = L::splat(R::TINY).less(distance);
    let zero = L::splat(R::ZERO);
    let mut unit = *offset;
    for a in 0..D {
        unit[a] = L::choose(apart, offset[a] / distance, zero);
    }
    unit
}

/// Inner product, lane by lane.
#[inline(always)]
pub fn dot<R: Real, L: Lanes<R>, const D: usize>(a: &[L; D], b: &[L; D]) -> L {
    let mut sum = a[0] * b[0];
    for k in 1..D {
        sum = sum + a[k] * b[k];
    }
    sum
}

/// Where a neighbour lies within a cone of full opening given by `cos_half` about the heading. All-round sight for a member
/// at rest; a coincident member is always seen.
#[inline(always)]
pub fn in_view<R: Real, L: Lanes<R>, const D: usize>(
    heading: &[L; D],
    offset: &[L; D],
    squared: L,
    cos_half: R,
) -> L::Mask {
    // `cos_half distance <= along`, with both sides times their own size, which saves the root
    let along = dot(heading, offset);
    let ahead = (L::splat(cos_half * cos_half.abs()) * squared).less_equal(along * along.size());
    let coincident = squared.less_equal(L::splat(R::TINY * R::TINY));
    let resting = dot(heading, heading).less_equal(L::splat(R::ZERO));
    ahead.or(coincident).or(resting)
}
