//! Behaviours: what a group is wanted to do, as functions from its course to a fitness in [0, 1].
//!
//! A [`Behaviour`] is a [`Score`] over [`Condition`]s over [`Signal`]s. A [`Watch`] is fed one moment after the other,
//! knows the fitness so far, knows when it can no longer change, and explains when each condition became true. The
//! behaviours of the list below are one file each.

pub mod blocks;
mod condition;
mod score;
mod signal;
mod watch;

pub use condition::{Comparison, Condition};
pub use score::{Bound, Score};
pub use signal::{Membership, Setting, Signal};
pub use watch::{Behaviour, Explained, Moment, Watch};

use space::spelling::nearest;

/// A number that a behaviour takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BehaviourParameter {
    /// Name in files.
    pub name: &'static str,
    /// Unit: `length`, `steps`, `1`.
    pub unit: &'static str,
    /// Value where none is given.
    pub default: f64,
    /// One sentence.
    pub about: &'static str,
}

/// A behaviour's description of itself.
#[derive(Clone, Copy, Debug)]
pub struct BehaviourCard {
    /// Name in files.
    pub id: &'static str,
    /// Name for readers.
    pub title: &'static str,
    /// What it is, in a sentence.
    pub definition: &'static str,
    /// Where it comes from.
    pub source: &'static str,
    /// What of the setting it needs by name: `region goal`, `gate right`, `place marker`.
    pub needs: &'static [&'static str],
    /// The numbers it takes.
    pub parameters: &'static [BehaviourParameter],
}

/// What can be wrong with a request for a behaviour.
#[derive(Clone, Debug, PartialEq)]
pub enum BehaviourError {
    /// A name that nothing has.
    Unknown {
        /// What kind of thing: `behaviour`, `parameter`, `gate`...
        kind: &'static str,
        /// The name given.
        name: String,
        /// The name that may have been meant.
        nearest: Option<String>,
    },
    /// A number that cannot be.
    Range {
        /// The parameter.
        name: &'static str,
        /// What was expected.
        expected: &'static str,
        /// The value given.
        found: f64,
    },
}

impl BehaviourError {
    fn unknown<'a>(kind: &'static str, name: &str, among: impl Iterator<Item = &'a str>) -> Self {
        Self::Unknown { kind, name: name.to_owned(), nearest: nearest(name, among).map(str::to_owned) }
    }
}

impl core::fmt::Display for BehaviourError {
    fn fmt(&self, out: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Unknown { kind, name, nearest } => {
                write!(out, "unknown {kind} `{name}`")?;
                nearest.as_ref().map_or(Ok(()), |nearest| write!(out, "; did you mean `{nearest}`?"))
            }
            Self::Range { name, expected, found } => write!(out, "`{name}` must be {expected}, found {found}"),
        }
    }
}
impl core::error::Error for BehaviourError {}

/// The values of a behaviour's parameters, by name.
#[derive(Clone, Debug)]
pub struct Values {
    values: Vec<(&'static str, f64)>,
}

impl Values {
    fn new(card: &BehaviourCard, given: &[(&str, f64)]) -> Result<Self, BehaviourError> {
        let mut values: Vec<(&str, f64)> = card.parameters.iter().map(|p| (p.name, p.default)).collect();
        for &(name, value) in given {
            let Some(place) = values.iter_mut().find(|(known, _)| *known == name) else {
                return Err(BehaviourError::unknown("parameter", name, card.parameters.iter().map(|p| p.name)));
            };
            if !(value.is_finite() && value >= 0.0) {
                return Err(BehaviourError::Range {
                    name: place.0,
                    expected: "a finite number of 0 or more",
                    found: value,
                });
            }
            place.1 = value;
        }
        Ok(Self { values })
    }
    /// The value of a parameter of the card.
    fn of(&self, name: &str) -> f64 {
        self.values.iter().find(|(known, _)| *known == name).map_or(0.0, |&(_, value)| value)
    }
    /// A parameter that counts steps.
    fn steps(&self, name: &str) -> u64 {
        self.of(name) as u64
    }
}

macro_rules! behaviours {
    ($($file:ident;)*) => {
        $(mod $file;)*
        /// The cards of all behaviours, in the order of the list.
        pub const LIST: &[&BehaviourCard] = &[$(&$file::CARD),*];
        /// The behaviour of an id in a setting, with its parameters changed as given.
        ///
        /// # Errors
        /// Where no behaviour has this id, it has no such parameter, a value cannot be, or the setting lacks what it needs.
        pub fn find(id: &str, given: &[(&str, f64)], setting: &Setting) -> Result<Behaviour, BehaviourError> {
            $(if $file::CARD.id == id {
                let score = $file::score(&Values::new(&$file::CARD, given)?, setting)?;
                return Ok(Behaviour { name: id.to_owned(), score });
            })*
            Err(BehaviourError::unknown("behaviour", id, LIST.iter().map(|card| card.id)))
        }
    };
}

behaviours! {
    simple_split;
    balanced_split;
    corralling;
    turn_right;
    turn_left;
    reduce_x_sd;
    trajectory;
    point_to_point;
    line_formation;
    segregate;
    gather_and_sort;
    avoid;
    hold;
    throughput;
}

#[cfg(test)]
mod tests;
