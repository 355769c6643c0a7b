//! Pace: how fast a body goes where speed is not the law's own matter. The law says where to; the speed follows a target within
//! limits of acceleration.

use space::{Column, ColumnKind, Real};

/// How the speed of a group's members varies. The target is the law's speed, times a factor of the state, times what the
/// stimulus and the drive make of it, drawn to the mean speed of the neighbours.
#[derive(Clone, Debug, PartialEq)]
pub struct Pace<R> {
    /// Least speed, above 0: a body at rest has no heading.
    pub least: R,
    /// Greatest speed.
    pub greatest: R,
    /// Largest gain of speed per time; `None`: any.
    pub acceleration: Option<R>,
    /// Largest loss of speed per time; `None`: any.
    pub deceleration: Option<R>,
    /// A column with named states, and a factor for some of them; the others have 1.
    pub states: Option<(String, Vec<(String, R)>)>,
    /// The speed of neighbours.
    pub neighbours: Option<Neighbours<R>>,
    /// Name of a stimulus, and by how much the target grows with its intensity.
    pub stimulus: Option<(String, R)>,
    /// An internal drive.
    pub drive: Option<Drive<R>>,
}

/// Those whose speed is matched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbours<R> {
    /// Members of the own group nearer than this.
    pub within: R,
    /// Share of their mean speed in the target.
    pub weight: R,
}

/// A drive that comes and goes: a stationary Gaussian process with an exponential correlation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive<R> {
    /// Standard deviation, as a share of the target.
    pub deviation: R,
    /// Time in which its correlation falls to 1/e.
    pub time: R,
}

impl<R: Real> Pace<R> {
    /// Column of the drive.
    pub const DRIVE: Column = Column {
        name: "drive",
        unit: "1",
        kind: ColumnKind::Quantity,
        about: "Internal drive: the share by which it wants to be faster.",
    };
    /// What can be known at load.
    ///
    /// # Errors
    /// A sentence that says what does not fit.
    pub fn check(&self) -> Result<(), String> {
        if !(self.least > R::ZERO && self.least <= self.greatest && self.greatest.finite()) {
            return Err(format!(
                "pace: the least speed ({}) must be above 0 and not above the greatest ({})",
                self.least, self.greatest
            ));
        }
        let mut numbers = vec![
            ("acceleration", self.acceleration.unwrap_or(R::ZERO)),
            ("deceleration", self.deceleration.unwrap_or(R::ZERO)),
        ];
        numbers.extend(self.neighbours.iter().map(|n| ("neighbours.within", n.within)));
        numbers.extend(self.neighbours.iter().map(|n| ("neighbours.weight", n.weight)));
        numbers.extend(self.drive.iter().map(|drive| ("drive.deviation", drive.deviation)));
        if let Some((name, value)) = numbers.into_iter().find(|(_, value)| !(*value >= R::ZERO && value.finite())) {
            return Err(format!("pace: {name} must be 0 or more, found {value}"));
        }
        match (self.drive, self.neighbours) {
            (Some(drive), _) if !(drive.time > R::ZERO && drive.time.finite()) => {
                Err(format!("pace: drive.time must be more than 0, found {}", drive.time))
            }
            (_, Some(neighbours)) if neighbours.weight > R::ONE => {
                Err(format!("pace: neighbours.weight must be from 0 to 1, found {}", neighbours.weight))
            }
            _ => Ok(()),
        }
    }
}
