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

/// Which values a parameter may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bounds {
    /// A finite number above zero.
    Positive,
    /// A whole number, 1 or more.
    Whole,
    /// Any finite number.
    Any,
}

impl Bounds {
    /// Whether a value may be had.
    pub fn allow(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Self::Positive => value > 0.0,
                Self::Whole => value >= 1.0 && value.fract() == 0.0,
                Self::Any => true,
            }
    }
}

impl core::fmt::Display for Bounds {
    fn fmt(&self, out: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        out.write_str(match self {
            Self::Positive => "more than 0",
            Self::Whole => "a whole number, 1 or more",
            Self::Any => "a finite number",
        })
    }
}

/// A number that a metric takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Name in files and on the command line.
    pub name: &'static str,
    /// Unit: `length`...
    pub unit: &'static str,
    /// Value where none is given; `None` where one must be given.
    pub default: Option<f64>,
    /// Which values it may have.
    pub bounds: Bounds,
    /// One sentence.
    pub about: &'static str,
}

impl Parameter {
    /// The value that a metric begins with: NaN where one must be given.
    pub const fn initial(&self) -> f64 {
        match self.default {
            Some(value) => value,
            None => f64::NAN,
        }
    }
}

/// What takes parameters.
pub trait Takes {
    /// They.
    const PARAMETERS: &'static [Parameter];
    /// The place of a parameter, to be changed; `None` for any other name.
    fn place(&mut self, name: &str) -> Option<&mut f64>;
    /// A parameter that must be given and was not.
    fn lacks(&self) -> Option<&'static Parameter>;
}

/// A metric that takes parameters: the struct, its defaults, the list of its parameters, and the place of each by its name.
macro_rules! takes {
    ($(#[$about:meta])* pub struct $metric:ident { $($field:ident: $parameter:expr),* $(,)? }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug)]
        pub struct $metric {
            $(#[doc = concat!("See the parameter `", stringify!($field), "` of the card.")] pub $field: f64,)*
        }
        impl Default for $metric {
            fn default() -> Self {
                Self { $($field: $parameter.initial()),* }
            }
        }
        impl $crate::Takes for $metric {
            const PARAMETERS: &'static [$crate::Parameter] = &[$($parameter),*];
            #[allow(unused_variables, reason = "a metric may take nothing")]
            fn place(&mut self, name: &str) -> Option<&mut f64> {
                $(if name == $parameter.name {
                    return Some(&mut self.$field);
                })*
                None
            }
            fn lacks(&self) -> Option<&'static $crate::Parameter> {
                $(if self.$field.is_nan() {
                    return Some(const { &$parameter });
                })*
                None
            }
        }
    };
}
pub(crate) use takes;

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
    /// Which reading of its name this is, where several are in use.
    pub variant: &'static str,
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
    /// Where the metric has no parameter of this name, or it may not have this value.
    fn set(&mut self, name: &str, value: f64) -> Result<(), MeasureError>;
    /// The metric of a group; see [`Metric::on`].
    fn on(&self, sample: &Sample<D>) -> Option<f64>;
}

impl<M: Metric, const D: usize> Measure<D> for M {
    fn card(&self) -> &'static MetricCard {
        const { &M::CARD }
    }
    fn set(&mut self, name: &str, value: f64) -> Result<(), MeasureError> {
        let known = M::CARD.parameters;
        let Some(place) = self.parameter(name) else { return Err(unknown_parameter(M::CARD.id, name, known)) };
        check_parameter(M::CARD.id, name, known, value)?;
        *place = value;
        Ok(())
    }
    fn on(&self, sample: &Sample<D>) -> Option<f64> {
        Metric::on(self, sample)
    }
}

/// The refusal of a parameter that a metric does not have.
pub(crate) fn unknown_parameter(metric: &'static str, name: &str, known: &'static [Parameter]) -> MeasureError {
    MeasureError::UnknownParameter { metric, name: name.to_owned(), known }
}

/// Refuses a value that a parameter may not have.
pub(crate) fn check_parameter(
    metric: &'static str,
    name: &str,
    known: &[Parameter],
    found: f64,
) -> Result<(), MeasureError> {
    match known.iter().find(|parameter| parameter.name == name) {
        Some(parameter) if !parameter.bounds.allow(found) => {
            Err(MeasureError::Range { metric, name: name.to_owned(), found, bounds: parameter.bounds })
        }
        _ => Ok(()),
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
        /// Those it has.
        known: &'static [Parameter],
    },
    /// A parameter may not have this value.
    Range {
        /// The metric.
        metric: &'static str,
        /// The parameter.
        name: String,
        /// The value given.
        found: f64,
        /// What it may be.
        bounds: Bounds,
    },
    /// A parameter that must be given was not.
    Missing {
        /// The metric.
        metric: &'static str,
        /// The parameter.
        name: &'static str,
        /// What it says.
        about: &'static str,
    },
    /// A metric needs something that these tracks do not have.
    Unfit {
        /// The metric.
        metric: &'static str,
        /// What it needs.
        needs: &'static str,
    },
}

impl core::fmt::Display for MeasureError {
    fn fmt(&self, out: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::UnknownMetric { id, nearest } => {
                write!(out, "unknown metric `{id}`")?;
                nearest.map_or(Ok(()), |nearest| write!(out, "; did you mean `{nearest}`?"))
            }
            Self::UnknownParameter { metric, name, known: [] } => {
                write!(out, "metric `{metric}` takes no parameters, so none that is called `{name}`")
            }
            Self::UnknownParameter { metric, name, known } => {
                write!(out, "metric `{metric}` has no parameter `{name}`; ")?;
                let names: Vec<&str> = known.iter().map(|parameter| parameter.name).collect();
                match nearest(name, names.iter().copied()) {
                    Some(nearest) => write!(out, "did you mean `{nearest}`?"),
                    None => write!(out, "it takes {}", names.join(", ")),
                }
            }
            Self::Range { metric, name, found, bounds } => {
                write!(out, "`{name}` of metric `{metric}` must be {bounds}, found {found}")
            }
            Self::Missing { metric, name, about } => {
                write!(out, "metric `{metric}` needs a value for `{name}`: {about}")
            }
            Self::Unfit { metric, needs } => write!(out, "metric `{metric}` needs {needs}"),
        }
    }
}
impl core::error::Error for MeasureError {}
