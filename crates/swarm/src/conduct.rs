//! Conduct: a state machine over a law. In the state `forage` an agent moves by its own law; in the others by what the state says.
//!
//! The states that a group has are tried in a fixed order: who is threatened flees, else hunts, else rests, else leads, else
//! explores, else follows its law. It stands between the law and the body, so that every law may have it.

use crate::names::lasting;
use space::{Column, ColumnKind, Real};

/// What a group does beside its law. Everything is off unless it is given.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Conduct<R> {
    /// From whom it flees.
    pub flee: Option<Flee<R>>,
    /// Whom it hunts.
    pub hunt: Option<Hunt<R>>,
    /// When it rests.
    pub rest: Option<Rest<R>>,
    /// When it leads.
    pub lead: Option<Lead<R>>,
    /// When it explores.
    pub explore: Option<Explore<R>>,
    /// Largest change of the velocity per time in these states; `None`: any.
    pub acceleration: Option<R>,
}

/// Straight away from the nearest threat.
#[derive(Clone, Debug, PartialEq)]
pub struct Flee<R> {
    /// Names of the groups that are threats.
    pub from: Vec<String>,
    /// A threat nearer than this is fled.
    pub within: R,
    /// Speed of flight.
    pub speed: R,
}

/// Straight towards the nearest prey.
#[derive(Clone, Debug, PartialEq)]
pub struct Hunt<R> {
    /// Names of the groups that are prey.
    pub prey: Vec<String>,
    /// Prey nearer than this is hunted.
    pub within: R,
    /// Speed of the hunt.
    pub speed: R,
}

/// At rest while a store is full.
#[derive(Clone, Debug, PartialEq)]
pub struct Rest<R> {
    /// The declared column.
    pub column: String,
    /// Rest begins from this value on,
    pub from: R,
    /// and ends below this one.
    pub until: R,
}

/// Ahead of the others for a while, as a change of leadership by eccentricity (C. Hartman, B. Benes 2006).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lead<R> {
    /// Members of the own group nearer than this are seen.
    pub within: R,
    /// Least eccentricity of who may lead: distance to the centre of those seen, over `within`; the centre lies behind.
    pub least: R,
    /// Chance of beginning per time at an eccentricity of 1.
    pub rate: R,
    /// How long it lasts.
    pub time: R,
    /// Speed of a leader.
    pub speed: R,
}

/// A random walk where no item is near.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Explore<R> {
    /// No item is nearer than this.
    pub without: R,
    /// Speed of the walk.
    pub speed: R,
    /// Standard deviation of the heading after a unit of time, rad.
    pub turning: R,
}

/// The states, in the order of the numbers in the column `conduct`.
pub const STATES: [&str; 6] = ["forage", "flee", "hunt", "rest", "lead", "explore"];

/// Columns that a group with a conduct has.
const COLUMNS: [Column; 2] = [
    Column {
        name: "conduct",
        unit: "",
        kind: ColumnKind::Label(&STATES),
        about: "What the agent does; in `forage` it moves by its law.",
    },
    Column { name: "leading", unit: "time", kind: ColumnKind::Quantity, about: "Time of leadership that is left." },
];

impl<R: Real> Conduct<R> {
    /// Declared columns it needs.
    pub fn columns(&self) -> &'static [Column] {
        if self.lead.is_some() { &COLUMNS } else { &COLUMNS[..1] }
    }
    /// Names of all groups it speaks of.
    pub fn groups(&self) -> impl Iterator<Item = &String> {
        let flee = self.flee.iter().flat_map(|flee| &flee.from);
        flee.chain(self.hunt.iter().flat_map(|hunt| &hunt.prey))
    }
    /// What can be known at load.
    ///
    /// # Errors
    /// A sentence that says what does not fit.
    pub fn check(&self) -> Result<(), String> {
        let mut numbers: Vec<(&str, R)> = Vec::new();
        if let Some(flee) = &self.flee {
            numbers.extend([("flee.within", flee.within), ("flee.speed", flee.speed)]);
        }
        if let Some(hunt) = &self.hunt {
            numbers.extend([("hunt.within", hunt.within), ("hunt.speed", hunt.speed)]);
        }
        if let Some(lead) = &self.lead {
            numbers.extend([("lead.within", lead.within), ("lead.least", lead.least), ("lead.rate", lead.rate)]);
            numbers.extend([("lead.time", lead.time), ("lead.speed", lead.speed)]);
        }
        if let Some(explore) = &self.explore {
            numbers.extend([("explore.without", explore.without), ("explore.speed", explore.speed)]);
            numbers.push(("explore.turning", explore.turning));
        }
        if let Some(acceleration) = self.acceleration {
            numbers.push(("acceleration", acceleration));
        }
        if let Some((name, value)) = numbers.into_iter().find(|(_, value)| !(*value >= R::ZERO && value.finite())) {
            return Err(format!("conduct: {name} must be 0 or more, found {value}"));
        }
        match &self.rest {
            Some(rest) if !(rest.until <= rest.from && rest.from.finite() && rest.until.finite()) => {
                Err(format!("conduct: rest ends below {} and would begin at {}", rest.until, rest.from))
            }
            _ => Ok(()),
        }
    }
}

/// The columns that resources give to all agents.
pub(crate) fn stored(name: &str) -> Column {
    Column {
        name: lasting(name),
        unit: "1",
        kind: ColumnKind::Quantity,
        about: "A store that the world gives to all its agents.",
    }
}
