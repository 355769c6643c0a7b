//! Stock terms: the vectors that motion computations are made of, for compositions that are written in a file
//! ([`crate::models::composed`]). One file each, one line each in the list below; reading, schema, help, docs, controls and
//! arrows are all made from the list.
//!
//! A term about members is summed neighbour by neighbour ([`Term::meet`]), in lanes or over a list; from the sum, or without one
//! from the agent and its surroundings, it makes a vector ([`Term::vector`]), which its weight multiplies.

use crate::choice;
use crate::motion::{Draws, LaneSums, Me, MeLanes, Other, TOGETHER, Together, add_where};
use crate::parameters::{Descriptor, Origin, Parameter, ParameterError, Parameters, Range, Scalar, Value, Values};
use space::lanes::{Lanes, Mask};
use space::{Real, Vector};

/// What a term says of itself.
#[derive(Clone, Copy, Debug)]
pub struct TermCard {
    /// Id: file name, key in files.
    pub id: &'static str,
    /// One plain sentence.
    pub about: &'static str,
    /// The vector that the weight multiplies.
    pub equation: &'static str,
    /// What it is where nobody is there, at rest, and for coincident members.
    pub edge: &'static str,
    /// Whether it is about the members of a named set.
    pub members: bool,
    /// Whether it uses their velocities.
    pub velocity: bool,
}

choice! {
    /// What is made of the vectors of all members of a set.
    pub enum Take {
        /// Their mean.
        Mean = "mean",
        /// Their sum.
        Sum = "sum",
        /// The direction of their sum.
        Direction = "direction",
    }
}

choice! {
    /// How much a member at some distance counts, relative to one at the distance of the scale.
    pub enum ByDistance {
        /// As much at any distance.
        Constant = "constant",
        /// In proportion to the distance.
        Linear = "linear",
        /// In inverse proportion to the distance.
        Inverse = "inverse",
        /// In inverse proportion to its square.
        InverseSquare = "inverse_square",
        /// From 1 here down to 0 at the scale and beyond.
        Falling = "falling",
    }
}

/// A running sum over the members of a set.
#[derive(Clone, Copy, Debug)]
pub struct Sum<L, const D: usize> {
    /// Of vectors.
    pub vector: [L; D],
    /// Of members, or of what else the term counts.
    pub total: L,
}

impl<L: Copy, const D: usize> Sum<L, D> {
    /// Adds a member's vector where the mask holds.
    #[inline(always)]
    pub(crate) fn add<R: Scalar>(&mut self, mask: L::Mask, vector: [L; D])
    where
        L: Lanes<R>,
    {
        add_where(&mut self.vector, mask, vector);
        self.total = self.total.add_where(mask, L::splat(R::ONE));
    }
}

impl<R: Scalar, const D: usize> Sum<R, D> {
    /// What is taken of the sum; zero where there is nobody.
    #[inline(always)]
    pub(crate) fn taken(&self, take: Take) -> Vector<R, D> {
        let sum = Vector(self.vector);
        match take {
            Take::Sum => sum,
            Take::Mean if self.total > R::ZERO => sum / self.total,
            Take::Mean => Vector::ZERO,
            Take::Direction => sum.unit(),
        }
    }
}

/// So many terms of a composition may be about members.
pub const MOST: usize = 8;

/// The sums of all terms about members.
#[derive(Clone, Copy, Debug)]
pub struct Sums<L, const D: usize> {
    /// One for each term.
    pub terms: [Sum<L, D>; MOST],
    /// So many of them are used.
    pub used: usize,
}

impl<R: Real, L: Lanes<R>, const D: usize> LaneSums<R, L> for Sums<L, D> {
    type One = Sums<R, D>;
    #[inline(always)]
    fn zero() -> Self {
        let zero = L::splat(R::ZERO);
        Self { terms: [Sum { vector: [zero; D], total: zero }; MOST], used: 0 }
    }
    #[inline(always)]
    fn split(&self, to: &mut [Sums<R, D>]) {
        if self.used == 0 {
            // nobody was met, and what stands there is of others
            to.fill(Self::zero_one());
        }
        for t in 0..self.used.min(MOST) {
            let sum = &self.terms[t];
            let mut lane = [R::ZERO; crate::motion::WIDEST];
            for a in 0..D {
                sum.vector[a].store(&mut lane);
                for k in 0..L::WIDTH {
                    to[k].terms[t].vector[a] = lane[k];
                }
            }
            sum.total.store(&mut lane);
            for k in 0..L::WIDTH {
                to[k].terms[t].total = lane[k];
            }
        }
        for k in 0..L::WIDTH {
            to[k].used = self.used;
        }
    }
    #[inline(always)]
    fn zero_one() -> Sums<R, D> {
        Sums { terms: [Sum { vector: [R::ZERO; D], total: R::ZERO }; MOST], used: 0 }
    }
}

/// A neighbour as the lanes of a block of agents meet it.
pub struct Met<'a, R, L, const D: usize> {
    /// From each agent to it.
    pub offset: &'a [L; D],
    /// Distance; only valid where a term of the composition has [`Term::DIRECTED`].
    pub distance: L,
    /// Unit vector towards it, zero where coincident; valid as the distance is.
    pub towards: [L; D],
    /// Squared distance.
    pub squared: L,
    /// The agents.
    pub me: &'a MeLanes<'a, L, D>,
    /// The neighbour.
    pub other: &'a Other<'a, R, D>,
}

/// Several neighbours, as [`Met`] is one.
pub(crate) struct MetTogether<'a, R, L: Lanes<R>, const D: usize> {
    pub(crate) neighbours: &'a Together<'a, R, L, D>,
    pub(crate) distance: &'a [L; TOGETHER],
    pub(crate) towards: &'a [[L; D]; TOGETHER],
    pub(crate) me: &'a MeLanes<'a, L, D>,
    /// Whose neighbours each is, in the set of the term.
    pub(crate) mask: &'a [L::Mask; TOGETHER],
}

impl<R: Scalar, L: Lanes<R>, const D: usize> Met<'_, R, L, D> {
    /// The direction towards it, times what it counts at its distance.
    #[inline(always)]
    pub(crate) fn counted(&self, by_distance: ByDistance, scale: R) -> [L; D] {
        let times = |factor: L| {
            let mut vector = self.towards;
            for a in 0..D {
                vector[a] = vector[a] * factor;
            }
            vector
        };
        // distances are floored at a thousandth of the scale
        let near = || L::splat(scale) / self.distance.greater(L::splat(scale / R::of(1000.0)));
        match by_distance {
            ByDistance::Constant => self.towards,
            ByDistance::Linear => {
                let mut vector = *self.offset;
                for a in 0..D {
                    vector[a] = vector[a] / L::splat(scale);
                }
                vector
            }
            ByDistance::Inverse => times(near()),
            ByDistance::InverseSquare => {
                let near = near();
                times(near * near)
            }
            ByDistance::Falling => {
                let left = L::splat(R::ONE) - self.distance / L::splat(scale);
                times(left.greater(L::splat(R::ZERO)))
            }
        }
    }
}

/// A stock term.
pub trait Term<R: Scalar>: Parameters {
    /// Its description.
    const CARD: TermCard;
    /// Whether [`Self::meet`] uses distances and directions.
    const DIRECTED: bool = false;
    /// What its vector is multiplied by.
    fn weight(&self) -> R;
    /// Checks that concern several parameters, or the number of dimensions.
    ///
    /// # Errors
    /// A sentence that says what does not fit.
    fn check(&self, _dimensions: usize) -> Result<(), String> {
        Ok(())
    }
    /// How far away obstacles and walls matter to it.
    fn obstacle_reach(&self) -> Option<R> {
        None
    }
    /// Adds a neighbour to its sum, in the lanes where the mask holds.
    #[inline(always)]
    fn meet<L: Lanes<R>, const D: usize>(&self, _sum: &mut Sum<L, D>, _met: &Met<'_, R, L, D>, _mask: L::Mask) {}
    /// Its vector before the weight. `sum` is zero for terms that are not about members; `slot` is the first of two slots for
    /// draws of its own.
    fn vector<const D: usize>(&self, me: &Me<'_, R, D>, sum: &Sum<R, D>, draws: &Draws<'_>, slot: u32) -> Vector<R, D>;
}

/// A term of the list.
pub struct Entry {
    /// Its description of itself.
    pub card: &'static TermCard,
    /// Its own parameters.
    own: fn() -> Vec<Descriptor>,
}

/// The key under which a term about members names their set.
pub const SET: &str = "set";
/// The key of a term's priority.
pub const PRIORITY: &str = "priority";
/// The set of terms that name none.
pub const NEIGHBOURS: &str = "neighbours";

impl Entry {
    /// All parameters: those that every term has, and its own.
    pub fn parameters(&self) -> Vec<Descriptor> {
        let set = self.card.members.then(|| Descriptor {
            name: SET,
            alias: None,
            symbol: "S",
            unit: "-",
            range: Range::Any,
            default: Value::from(NEIGHBOURS),
            origin: Origin::Ours,
            takes: String::takes(),
            check: |descriptor, value| crate::parameters::checked::<String>(descriptor, value).map(|_| ()),
            about: "The named set whose members it is about.",
        });
        let priority = Descriptor {
            name: PRIORITY,
            alias: None,
            symbol: "k",
            unit: "1",
            range: Range::NonNegative,
            default: Value::from(0usize),
            origin: Origin::Ours,
            takes: usize::takes(),
            check: |descriptor, value| crate::parameters::checked::<usize>(descriptor, value).map(|_| ()),
            about: "Its level where terms have priorities: the lower acts first; terms of one level are summed.",
        };
        set.into_iter().chain((self.own)()).chain([priority]).collect()
    }
}

/// The term of an id.
pub fn find(id: &str) -> Option<&'static Entry> {
    LIST.iter().find(|entry| entry.card.id == id)
}

/// A term as it is written: its id and its parameters by name.
pub type Written = (String, Values);

macro_rules! terms {
    ($($file:ident::$name:ident;)*) => {
        $(pub mod $file;)*
        /// All terms, in the order of the list.
        pub const LIST: &[Entry] = &[$(Entry {
            card: &<$file::$name<f64> as Term<f64>>::CARD,
            own: <$file::$name<f64> as Parameters>::descriptors,
        },)*];
        /// One of the listed terms, with its parameters. Every call is one match; nothing else about it is found at run time.
        #[derive(Clone, Debug)]
        pub(crate) enum Stock<R> {
            $($name($file::$name<R>),)*
        }
        impl<R: Scalar> Stock<R> {
            /// The term of an id, with values for its own parameters.
            pub(crate) fn read(id: &str, own: &Values) -> Option<Result<Self, ParameterError>> {
                $(if id == stringify!($file) {
                    return Some($file::$name::from_values(own).map(Self::$name));
                })*
                None
            }
            pub(crate) fn directed(&self) -> bool {
                match self { $(Self::$name(_) => <$file::$name<R> as Term<R>>::DIRECTED,)* }
            }
            pub(crate) fn check(&self, dimensions: usize) -> Result<(), String> {
                match self { $(Self::$name(term) => term.check(dimensions),)* }
            }
            pub(crate) fn obstacle_reach(&self) -> Option<R> {
                match self { $(Self::$name(term) => term.obstacle_reach(),)* }
            }
            #[inline(always)]
            pub(crate) fn meet<L: Lanes<R>, const D: usize>(
                &self,
                sum: &mut Sum<L, D>,
                met: &Met<'_, R, L, D>,
                mask: L::Mask,
            ) {
                match self { $(Self::$name(term) => term.meet(sum, met, mask),)* }
            }
            /// Adds several neighbours, one after the other; `seldom` where most are in other sets.
            #[inline(always)]
            pub(crate) fn meet_together<L: Lanes<R>, const D: usize>(
                &self,
                sum: &mut Sum<L, D>,
                met: &MetTogether<'_, R, L, D>,
                seldom: bool,
            ) {
                let neighbours = met.neighbours;
                match self { $(Self::$name(term) => {
                    let mut own = *sum;
                    for k in 0..neighbours.count.min(TOGETHER) {
                        let mask = met.mask[k];
                        if seldom && !mask.any() {
                            continue;
                        }
                        let one = Met {
                            offset: &neighbours.offset[k],
                            distance: met.distance[k],
                            towards: met.towards[k],
                            squared: neighbours.squared[k],
                            me: met.me,
                            other: &neighbours.other(k),
                        };
                        term.meet(&mut own, &one, mask);
                    }
                    *sum = own;
                })* }
            }
            /// The weighted vector.
            #[inline(always)]
            pub(crate) fn weighted<const D: usize>(
                &self,
                me: &Me<'_, R, D>,
                sum: &Sum<R, D>,
                draws: &Draws<'_>,
                slot: u32,
            ) -> Vector<R, D> {
                match self { $(Self::$name(term) => term.vector(me, sum, draws, slot) * term.weight(),)* }
            }
        }
    };
}

// one line a term: those about members, then those about the agent itself and its surroundings
terms! {
    align::Align;
    match_velocity::MatchVelocity;
    attract::Attract;
    repel::Repel;
    keep_distance::KeepDistance;
    follow::Follow;
    turn_toward::TurnToward;
    keep_heading::KeepHeading;
    keep_speed::KeepSpeed;
    friction::Friction;
    wander::Wander;
    goal::Goal;
    travel::Travel;
    walls::Walls;
    forage::Forage;
}

#[cfg(test)]
mod tests;
