//! What a metric is: its card, its value, and the door by which the list is used.

use crate::Sample;
use space::spelling::nearest;
use space::{Frame, Real};

/// Which members enter a metric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Counted {
    /// Those with a position.
    Positions,
    /// Those with a position and a velocity; members at rest have the velocity zero.
    Velocities,
    /// Those with a heading, that is with a speed above 1e-12.
    Headings,
    /// Those whose direction of the body is known.
    Bodies,
}

/// What a metric gives where there is little to measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EdgeCases {
    /// For no members.
    pub empty: &'static str,
    /// For one member.
    pub one: &'static str,
    /// With everyone at rest.
    pub at_rest: &'static str,
}

/// A number that a metric takes, more than zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Name in files and on the command line.
    pub name: &'static str,
    /// Unit: `length`...
    pub unit: &'static str,
    /// Value where none is given.
    pub default: f64,
    /// One sentence.
    pub about: &'static str,
}

/// A metric's description of itself.
#[derive(Clone, Copy, Debug)]
pub struct MetricCard {
    /// Name in files, in tables and on the command line.
    pub id: &'static str,
    /// Name for readers.
    pub title: &'static str,
    /// Symbol in text.
    pub symbol: &'static str,
    /// Unit: `1`, `length`, `length/time`, `deg`.
    pub unit: &'static str,
    /// Least and greatest value, where the metric has natural ones.
    pub range: Option<(f64, f64)>,
    /// The formula, as text.
    pub definition: &'static str,
    /// Where the definition comes from.
    pub source: &'static str,
    /// Which members count.
    pub counted: Counted,
    /// Numbers of dimensions it is defined in.
    pub dimensions: &'static [usize],
    /// The numbers it takes.
    pub parameters: &'static [Parameter],
    /// What it gives where there is little to measure.
    pub edge: EdgeCases,
}

/// A number that describes a group at one moment.
pub trait Metric: Default + Send + Sync + 'static {
    /// Its description of itself.
    const CARD: MetricCard;

    /// The formula. `None` where it is undefined.
    ///
    /// Callers use [`Metric::on`], which also gives `None` where numbers too large for f64 led to no finite value.
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64>;

    /// The place of a parameter of the card, to be changed; `None` for any other name.
    fn parameter(&mut self, name: &str) -> Option<&mut f64> {
        let _ = name;
        None
    }

    /// The metric of members read already. `None` where it is undefined; never infinite or NaN.
    fn on<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        self.value(sample).filter(|value| value.is_finite())
    }

    /// The metric of the members in these rows of a frame, in any order. `None` where it is undefined.
    fn of<R: Real, const D: usize>(&self, frame: &Frame<'_, R, D>, members: &[usize]) -> Option<f64> {
        self.on(&Sample::of(frame, members))
    }
}

/// A metric chosen by its id: the door through which the list is used.
///
/// It is the same for both precisions, since a [`Sample`] holds a frame of either in f64.
pub trait Measure<const D: usize>: Send + Sync {
    /// Its description of itself.
    fn card(&self) -> &'static MetricCard;
    /// Changes a parameter.
    ///
    /// # Errors
    /// Where the metric has no parameter of this name, or the value is not a finite number above zero.
    fn set(&mut self, name: &str, value: f64) -> Result<(), MeasureError>;
    /// The metric of a group; see [`Metric::on`].
    fn on(&self, sample: &Sample<D>) -> Option<f64>;
}

impl<M: Metric, const D: usize> Measure<D> for M {
    fn card(&self) -> &'static MetricCard {
        const { &M::CARD }
    }
    fn set(&mut self, name: &str, value: f64) -> Result<(), MeasureError> {
        let Some(place) = self.parameter(name) else {
            let names = M::CARD.parameters.iter().map(|parameter| parameter.name);
            return Err(MeasureError::UnknownParameter {
                metric: M::CARD.id,
                name: name.to_owned(),
                nearest: nearest(name, names),
            });
        };
        if !(value.is_finite() && value > 0.0) {
            return Err(MeasureError::Range { metric: M::CARD.id, name: name.to_owned(), found: value });
        }
        *place = value;
        Ok(())
    }
    fn on(&self, sample: &Sample<D>) -> Option<f64> {
        Metric::on(self, sample)
    }
}

/// What can be wrong with a request for a metric.
#[derive(Clone, Debug, PartialEq)]
pub enum MeasureError {
    /// No metric has this id.
    UnknownMetric {
        /// The id given.
        id: String,
        /// The id that may have been meant.
        nearest: Option<&'static str>,
    },
    /// The metric has no parameter of this name.
    UnknownParameter {
        /// The metric.
        metric: &'static str,
        /// The name given.
        name: String,
        /// The name that may have been meant.
        nearest: Option<&'static str>,
    },
    /// The value is not a finite number above zero.
    Range {
        /// The metric.
        metric: &'static str,
        /// The parameter.
        name: String,
        /// The value given.
        found: f64,
    },
}

impl core::fmt::Display for MeasureError {
    fn fmt(&self, out: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let nearest = match self {
            Self::UnknownMetric { id, nearest } => {
                write!(out, "unknown metric `{id}`")?;
                nearest
            }
            Self::UnknownParameter { metric, name, nearest } => {
                write!(out, "unknown parameter `{name}` of metric `{metric}`")?;
                if nearest.is_none() {
                    write!(out, "; it has none")?;
                }
                nearest
            }
            Self::Range { metric, name, found } => {
                return write!(out, "`{name}` of metric `{metric}` must be more than 0, found {found}");
            }
        };
        nearest.map_or(Ok(()), |nearest| write!(out, "; did you mean `{nearest}`?"))
    }
}
impl core::error::Error for MeasureError {}
