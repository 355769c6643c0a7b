//! Stimuli: scalar fields that bodies sample with sensors, and how those who are informed go up them.

use space::{Column, ColumnKind, Real, Space, Vector};

/// How the intensity about a point falls off with the distance `d`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decay {
    /// `exp(-d / length)`.
    Exponential,
    /// `1 / (1 + (d / length)^2)`.
    InverseSquare,
}

/// A scalar field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Field<R, const D: usize> {
    /// A point that sends out something.
    Point {
        /// Where it is.
        at: Vector<R, D>,
        /// Intensity there.
        strength: R,
        /// Length of the decay.
        length: R,
        /// Its law.
        decay: Decay,
    },
    /// Grows evenly along a direction: the slope times the coordinate in it.
    Gradient(Vector<R, D>),
}

impl<R: Real, const D: usize> Field<R, D> {
    /// Intensity at a place.
    pub fn at(&self, space: &Space<R, D>, place: Vector<R, D>) -> R {
        match *self {
            Self::Point { at, strength, length, decay } => {
                let far = space.offset(place, at).length() / length;
                match decay {
                    Decay::Exponential => strength * (-far).exp(),
                    Decay::InverseSquare => strength / (R::ONE + far * far),
                }
            }
            Self::Gradient(slope) => slope.dot(place),
        }
    }
    /// What can be known at load.
    ///
    /// # Errors
    /// A sentence that says what does not fit.
    pub fn check(&self) -> Result<(), String> {
        match self {
            Self::Point { at, strength, length, .. } => {
                if !(at.finite() && strength.finite() && *length > R::ZERO && length.finite()) {
                    return Err(format!("a point needs finite numbers and a length above 0, found {length}"));
                }
                Ok(())
            }
            Self::Gradient(slope) if !slope.finite() => Err("the slope must be finite".into()),
            Self::Gradient(_) => Ok(()),
        }
    }
}

/// A field by its name.
#[derive(Clone, Debug, PartialEq)]
pub struct Stimulus<R, const D: usize> {
    /// Name in files.
    pub name: String,
    /// The field.
    pub field: Field<R, D>,
}

/// How the informed members of a group go up a stimulus: towards the sum of their sensors' places, each weighted by how much
/// its reading exceeds the mean of the readings.
#[derive(Clone, Debug, PartialEq)]
pub struct Taxis<R> {
    /// Name of the stimulus.
    pub up: String,
    /// Share of the members that are informed: the first so many of the group.
    pub informed: R,
    /// Places of the sensors on the body: ahead, to the left, up.
    pub sensors: Vec<Vec<R>>,
    /// Weight beside the law's direction, which has 1; `None`: alone, in place of the law's.
    pub weight: Option<R>,
    /// Where mean readings stay below, nothing is sensed.
    pub threshold: R,
    /// A column of the law with named states, and the states in which it acts; `None`: in all.
    pub over: Option<(String, Vec<String>)>,
}

impl<R: Real> Taxis<R> {
    /// Columns of the body.
    pub const COLUMNS: [Column; 2] = [
        Column {
            name: "informed",
            unit: "1",
            kind: ColumnKind::Label(&["no", "yes"]),
            about: "Whether it goes up the stimulus.",
        },
        Column {
            name: "stimulus",
            unit: "1",
            kind: ColumnKind::Quantity,
            about: "Mean reading of its sensors before the step.",
        },
    ];
    /// Number of the informed among so many.
    pub fn count(&self, members: usize) -> u32 {
        (R::count(members) * self.informed + R::HALF).to_f64().floor() as u32
    }
    /// What can be known at load.
    ///
    /// # Errors
    /// A sentence that says what does not fit.
    pub fn check(&self, dimension: usize) -> Result<(), String> {
        if !(self.informed >= R::ZERO && self.informed <= R::ONE) {
            return Err(format!("taxis: the share of the informed must be from 0 to 1, found {}", self.informed));
        }
        if let Some(weight) = self.weight
            && !(weight >= R::ZERO && weight.finite())
        {
            return Err(format!("taxis: the weight must be 0 or more, found {weight}"));
        }
        if self.sensors.len() < 2 {
            return Err("taxis: one sensor cannot tell a direction; it needs two at least".into());
        }
        match self.sensors.iter().find(|sensor| sensor.len() != dimension) {
            Some(sensor) => Err(format!(
                "taxis: a sensor has {} coordinates (ahead, left, up) in a space of {dimension} dimensions",
                sensor.len()
            )),
            None => Ok(()),
        }
    }
}
