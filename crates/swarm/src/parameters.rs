//! Parameters that describe themselves: from one declaration come the struct, its defaults, the checks, and
//! everything that help, schema, sliders and genomes need to know.

use space::Real;
use space::spelling::nearest;
use std::collections::BTreeMap;

/// A parameter as a file or a command line gives it.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Number(f64),
    /// True or false.
    Truth(bool),
    /// A word: one of a choice.
    Text(String),
    /// A list of values.
    List(Vec<Value>),
    /// Values by name.
    Table(Values),
}

impl From<f64> for Value {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}
impl From<usize> for Value {
    fn from(value: usize) -> Self {
        Self::Number(value as f64)
    }
}
impl From<bool> for Value {
    fn from(value: bool) -> Self {
        Self::Truth(value)
    }
}
impl From<&str> for Value {
    fn from(value: &str) -> Self {
        Self::Text(value.to_owned())
    }
}
impl<T: Into<Value> + Clone, const N: usize> From<[T; N]> for Value {
    fn from(values: [T; N]) -> Self {
        Self::List(values.into_iter().map(Into::into).collect())
    }
}

impl core::fmt::Display for Value {
    fn fmt(&self, out: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Number(number) => write!(out, "{number}"),
            Self::Truth(truth) => write!(out, "{truth}"),
            Self::Text(text) => write!(out, "\"{text}\""),
            Self::List(list) => {
                write!(out, "[")?;
                for (k, value) in list.iter().enumerate() {
                    if k > 0 {
                        write!(out, ", ")?;
                    }
                    write!(out, "{value}")?;
                }
                write!(out, "]")
            }
            Self::Table(table) => {
                write!(out, "{{")?;
                for (k, (name, value)) in table.iter().enumerate() {
                    write!(out, "{} {name} = {value}", if k > 0 { "," } else { "" })?;
                }
                write!(out, " }}")
            }
        }
    }
}

/// Parameters by name.
pub type Values = BTreeMap<String, Value>;

/// What went wrong with a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum ParameterError {
    /// No parameter of this name.
    Unknown {
        /// The name given.
        name: String,
        /// The name that may have been meant.
        nearest: Option<String>,
    },
    /// The value has the wrong type.
    Type {
        /// The parameter.
        name: String,
        /// What it takes.
        expected: String,
        /// What was given.
        found: String,
    },
    /// The value lies outside the range.
    Range {
        /// The parameter.
        name: String,
        /// The range.
        expected: String,
        /// What was given.
        found: String,
    },
    /// Parameters that are each possible but not together.
    Together(String),
}

impl core::fmt::Display for ParameterError {
    fn fmt(&self, out: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Unknown { name, nearest: Some(nearest) } => {
                write!(out, "unknown parameter `{name}`; did you mean `{nearest}`?")
            }
            Self::Unknown { name, nearest: None } => write!(out, "unknown parameter `{name}`"),
            Self::Type { name, expected, found } => write!(out, "`{name}` takes {expected}, found {found}"),
            Self::Range { name, expected, found } => write!(out, "`{name}` must be {expected}, found {found}"),
            Self::Together(text) => write!(out, "{text}"),
        }
    }
}
impl core::error::Error for ParameterError {}

/// The values a number may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    /// Every finite number.
    Any,
    /// Zero or more.
    NonNegative,
    /// More than zero.
    Positive,
    /// From the first to the second number, both included.
    Within(f64, f64),
}

/// Largest size of a number that is given: beyond it positions have no fractions left, and squares soon overflow.
pub const GREATEST: f64 = 1e15;

impl Range {
    /// Whether a number that is given lies in the range and is no larger than a world can compute with.
    ///
    /// # Errors
    /// What was expected.
    pub fn admits(&self, value: f64) -> Result<(), String> {
        if !self.holds(value) {
            Err(self.to_string())
        } else if value.abs() > GREATEST {
            Err(format!("from -{GREATEST:e} to {GREATEST:e}"))
        } else {
            Ok(())
        }
    }
    /// Whether a number lies in the range.
    pub fn holds(&self, value: f64) -> bool {
        value.is_finite()
            && match *self {
                Self::Any => true,
                Self::NonNegative => value >= 0.0,
                Self::Positive => value > 0.0,
                Self::Within(low, high) => (low..=high).contains(&value),
            }
    }
}

impl core::fmt::Display for Range {
    fn fmt(&self, out: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Any => write!(out, "a finite number"),
            Self::NonNegative => write!(out, "0 or more"),
            Self::Positive => write!(out, "more than 0"),
            Self::Within(low, high) => write!(out, "from {low} to {high}"),
        }
    }
}

/// Where a default comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The original paper or program.
    Paper,
    /// A source document of the project.
    Source,
    /// A sensible choice of ours.
    Ours,
}

impl Origin {
    /// One word for tables.
    pub fn word(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Source => "source",
            Self::Ours => "ours",
        }
    }
}

/// What kind of value a parameter takes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A number.
    Number,
    /// A whole number.
    Whole,
    /// True or false.
    Truth,
    /// One of these words.
    Word(Vec<&'static str>),
    /// A list, each entry of this kind.
    List(Box<Kind>),
    /// A value for all members, or a list with one each.
    PerAgent(Box<Kind>),
    /// A point, a list with one for each member, or an empty list.
    Points,
    /// A name that the user chooses.
    Name,
    /// A list of stock terms ([`crate::terms`]).
    Terms,
}

impl core::fmt::Display for Kind {
    fn fmt(&self, out: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Number => write!(out, "a number"),
            Self::Whole => write!(out, "a whole number"),
            Self::Truth => write!(out, "true or false"),
            Self::Word(words) => {
                let quoted: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
                write!(out, "one of {}", quoted.join(", "))
            }
            Self::List(entry) => write!(out, "a list, each entry {entry}"),
            Self::PerAgent(one) => write!(out, "{one}, or a list with one for each member"),
            Self::Points => {
                write!(out, "a point as a list of coordinates, a list with one point for each member, or an empty list")
            }
            Self::Name => write!(out, "a name"),
            Self::Terms => write!(out, "a list of stock terms"),
        }
    }
}

/// Everything there is to know about one parameter.
#[derive(Clone, Debug)]
pub struct Descriptor {
    /// Full-word name.
    pub name: &'static str,
    /// The short name of the literature, accepted as well.
    pub alias: Option<&'static str>,
    /// Symbol in the equations.
    pub symbol: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Range of each number in it.
    pub range: Range,
    /// Default.
    pub default: Value,
    /// Where the default comes from.
    pub origin: Origin,
    /// What kind of value it takes.
    pub takes: Kind,
    /// Whether a value is of the right kind and in range.
    pub check: Check,
    /// One sentence.
    pub about: &'static str,
}

/// A type a parameter can have.
pub trait Parameter: Sized {
    /// What it takes.
    fn takes() -> Kind;
    /// From a value; `None` if the type is wrong.
    fn read(value: &Value) -> Option<Self>;
    /// Back to a value.
    fn write(&self) -> Value;
    /// Calls `check` for every number inside, for the range.
    fn numbers(&self, check: &mut dyn FnMut(f64));
}

macro_rules! number_parameter {
    ($t:ident) => {
        impl Parameter for $t {
            fn takes() -> Kind {
                Kind::Number
            }
            fn read(value: &Value) -> Option<Self> {
                if let Value::Number(number) = value { Some(*number as $t) } else { None }
            }
            fn write(&self) -> Value {
                Value::Number(f64::from(*self))
            }
            fn numbers(&self, check: &mut dyn FnMut(f64)) {
                check(f64::from(*self));
            }
        }
    };
}
number_parameter!(f32);
number_parameter!(f64);

impl Parameter for usize {
    fn takes() -> Kind {
        Kind::Whole
    }
    fn read(value: &Value) -> Option<Self> {
        match value {
            Value::Number(number) if *number >= 0.0 && number.fract() == 0.0 && *number < 1e15 => Some(*number as Self),
            _ => None,
        }
    }
    fn write(&self) -> Value {
        Value::from(*self)
    }
    fn numbers(&self, check: &mut dyn FnMut(f64)) {
        check(*self as f64);
    }
}
impl Parameter for bool {
    fn takes() -> Kind {
        Kind::Truth
    }
    fn read(value: &Value) -> Option<Self> {
        if let Value::Truth(truth) = value { Some(*truth) } else { None }
    }
    fn write(&self) -> Value {
        Value::Truth(*self)
    }
    fn numbers(&self, _: &mut dyn FnMut(f64)) {}
}
impl Parameter for String {
    fn takes() -> Kind {
        Kind::Name
    }
    fn read(value: &Value) -> Option<Self> {
        if let Value::Text(name) = value { Some(name.clone()) } else { None }
    }
    fn write(&self) -> Value {
        Value::from(self.as_str())
    }
    fn numbers(&self, _: &mut dyn FnMut(f64)) {}
}
impl<T: Parameter> Parameter for Vec<T> {
    fn takes() -> Kind {
        Kind::List(Box::new(T::takes()))
    }
    fn read(value: &Value) -> Option<Self> {
        if let Value::List(list) = value { list.iter().map(T::read).collect() } else { None }
    }
    fn write(&self) -> Value {
        Value::List(self.iter().map(T::write).collect())
    }
    fn numbers(&self, check: &mut dyn FnMut(f64)) {
        self.iter().for_each(|entry| entry.numbers(check));
    }
}

/// A parameter that is one for all members, or one each: a number may stand where a list could.
#[derive(Clone, Debug, PartialEq)]
pub enum PerAgent<T> {
    /// The same for all.
    One(T),
    /// One each, by the member's index in its group.
    Each(Vec<T>),
}

impl<T> PerAgent<T> {
    /// The value of a member; the last one repeats where the list is shorter than the group.
    pub fn of(&self, member: usize) -> Option<&T> {
        match self {
            Self::One(value) => Some(value),
            Self::Each(values) => values.get(member).or(values.last()),
        }
    }
    /// Whether there is one for all, or one for each of so many members.
    ///
    /// # Errors
    /// A sentence that names the parameter, what it needs, and how many there are.
    pub fn check(&self, name: &str, members: usize) -> Result<(), String> {
        match self.count() {
            Some(count) if count != members => {
                Err(format!("`{name}` needs one number for each of {members} members, found {count}"))
            }
            _ => Ok(()),
        }
    }
    /// Number of values where there is one each.
    pub fn count(&self) -> Option<usize> {
        if let Self::Each(values) = self { Some(values.len()) } else { None }
    }
}

impl<T: Parameter> Parameter for PerAgent<T> {
    fn takes() -> Kind {
        Kind::PerAgent(Box::new(T::takes()))
    }
    fn read(value: &Value) -> Option<Self> {
        if let Some(one) = T::read(value) {
            return Some(Self::One(one));
        }
        Vec::<T>::read(value).map(Self::Each)
    }
    fn write(&self) -> Value {
        match self {
            Self::One(value) => value.write(),
            Self::Each(values) => values.write(),
        }
    }
    fn numbers(&self, check: &mut dyn FnMut(f64)) {
        match self {
            Self::One(value) => value.numbers(check),
            Self::Each(values) => values.numbers(check),
        }
    }
}

/// A point (list of coordinates), or nothing (an empty list), for all members or one each.
#[derive(Clone, Debug, PartialEq)]
pub struct Points<R>(pub Vec<Vec<R>>);

impl<R: Scalar> Points<R> {
    /// Whether there is none, one for all, or one for each of so many members.
    ///
    /// # Errors
    /// A sentence that names the parameter, what it needs, and how many there are.
    pub fn check(&self, name: &str, members: usize) -> Result<(), String> {
        match self.0.len() {
            count if count <= 1 || count == members => Ok(()),
            count => Err(format!("`{name}` needs one point, or one for each of {members} members, found {count}")),
        }
    }
    /// The point of a member: the only one, or its own; `None` where there is none.
    pub fn of<const D: usize>(&self, member: usize) -> Option<space::Vector<R, D>> {
        let point = if self.0.len() == 1 { self.0.first() } else { self.0.get(member) }?;
        if point.len() < D { None } else { Some(space::Vector(core::array::from_fn(|a| point[a]))) }
    }
}

impl<R: Scalar> Parameter for Points<R> {
    fn takes() -> Kind {
        Kind::Points
    }
    fn read(value: &Value) -> Option<Self> {
        if let Some(point) = Vec::<R>::read(value) {
            return Some(Self(if point.is_empty() { Vec::new() } else { vec![point] }));
        }
        Vec::<Vec<R>>::read(value).map(Self)
    }
    fn write(&self) -> Value {
        self.0.write()
    }
    fn numbers(&self, check: &mut dyn FnMut(f64)) {
        self.0.numbers(check);
    }
}

/// A real number that can be a parameter: f32 or f64.
pub trait Scalar: Real + Parameter {}
impl Scalar for f32 {}
impl Scalar for f64 {}

/// A parameter struct.
pub trait Parameters: Sized + Clone {
    /// What the parameters are, in the order of declaration.
    fn descriptors() -> Vec<Descriptor>;
    /// Defaults overridden by values.
    ///
    /// # Errors
    /// A name that does not exist, a wrong type, or a number outside its range.
    fn from_values(values: &Values) -> Result<Self, ParameterError>;
    /// All values by full-word name.
    fn values(&self) -> Values;
}

/// A descriptor's check of a value given for it.
pub type Check = fn(&Descriptor, &Value) -> Result<(), ParameterError>;

/// The value given for a parameter, or its default, checked.
pub fn take<T: Parameter>(descriptor: &Descriptor, values: &Values) -> Result<T, ParameterError> {
    let given = values.get(descriptor.name).or_else(|| descriptor.alias.and_then(|alias| values.get(alias)));
    checked(descriptor, given.unwrap_or(&descriptor.default))
}

/// A value read as what a parameter takes, with its numbers in range.
pub fn checked<T: Parameter>(descriptor: &Descriptor, value: &Value) -> Result<T, ParameterError> {
    let read = T::read(value).ok_or_else(|| ParameterError::Type {
        name: descriptor.name.into(),
        expected: T::takes().to_string(),
        found: value.to_string(),
    })?;
    let mut outside = None;
    read.numbers(&mut |number| {
        if outside.is_none() {
            outside = descriptor.range.admits(number).err().map(|expected| (expected, number));
        }
    });
    match outside {
        Some((expected, number)) => Err(ParameterError::Range {
            name: descriptor.name.into(),
            expected,
            found: if number.abs() > GREATEST { format!("{number:e}") } else { number.to_string() },
        }),
        None => Ok(read),
    }
}

/// Refuses names that no descriptor has, and a parameter given under both its names.
pub fn known(descriptors: &[Descriptor], values: &Values) -> Result<(), ParameterError> {
    for name in values.keys() {
        if !descriptors.iter().any(|d| d.name == name || d.alias == Some(name)) {
            let names = descriptors.iter().flat_map(|d| [Some(d.name), d.alias].into_iter().flatten());
            return Err(ParameterError::Unknown {
                name: name.clone(),
                nearest: nearest(name, names).map(str::to_owned),
            });
        }
    }
    for d in descriptors {
        if let Some(alias) = d.alias
            && values.contains_key(alias)
            && values.contains_key(d.name)
        {
            return Err(ParameterError::Together(format!(
                "`{}` and `{alias}` are the same parameter, given twice",
                d.name
            )));
        }
    }
    Ok(())
}

/// Declares a parameter struct, generic over the scalar `R`, with its descriptors.
///
/// A field reads: doc sentence, `name alias "short": Type = default, "symbol", "unit", Range, Origin;` (the alias
/// may be left out).
#[macro_export]
macro_rules! parameters {
    ($(#[$meta:meta])* pub struct $name:ident {
        $(#[doc = $about:literal] $field:ident $(alias $alias:literal)? : $type:ty = $default:expr,
          $symbol:literal, $unit:literal, $range:expr, $origin:ident;)*
    }) => {
        $(#[$meta])*
        #[derive(Clone, Debug)]
        pub struct $name<R> {
            $(#[doc = $about] pub $field: $type,)*
        }
        impl<R: $crate::parameters::Scalar> $crate::parameters::Parameters for $name<R> {
            fn descriptors() -> Vec<$crate::parameters::Descriptor> {
                #[allow(unused_imports, reason = "not every model uses every range")]
                use $crate::parameters::{Parameter, Range::*, Value};
                vec![$($crate::parameters::Descriptor {
                    name: stringify!($field),
                    alias: parameters!(@alias $($alias)?),
                    symbol: $symbol,
                    unit: $unit,
                    range: $range,
                    default: Value::from($default),
                    origin: $crate::parameters::Origin::$origin,
                    takes: <$type as Parameter>::takes(),
                    check: |descriptor, value| $crate::parameters::checked::<$type>(descriptor, value).map(|_| ()),
                    about: $about,
                },)*]
            }
            fn from_values(
                values: &$crate::parameters::Values,
            ) -> Result<Self, $crate::parameters::ParameterError> {
                let descriptors = Self::descriptors();
                $crate::parameters::known(&descriptors, values)?;
                let mut descriptors = descriptors.into_iter();
                $(let $field = match descriptors.next() {
                    Some(descriptor) => $crate::parameters::take(&descriptor, values)?,
                    None => return Err($crate::parameters::ParameterError::Together(String::new())),
                };)*
                Ok(Self { $($field,)* })
            }
            fn values(&self) -> $crate::parameters::Values {
                #[allow(unused_imports, reason = "not needed where every field is a scalar")]
                use $crate::parameters::Parameter;
                let mut values = $crate::parameters::Values::new();
                $(values.insert(stringify!($field).to_owned(), self.$field.write());)*
                values
            }
        }
    };
    (@alias) => { None };
    (@alias $alias:literal) => { Some($alias) };
}

/// Declares a choice between words that can be a parameter.
#[macro_export]
macro_rules! choice {
    ($(#[$meta:meta])* pub enum $name:ident { $($(#[$about:meta])* $variant:ident = $word:literal,)* }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name { $($(#[$about])* $variant,)* }
        impl $crate::parameters::Parameter for $name {
            fn takes() -> $crate::parameters::Kind {
                $crate::parameters::Kind::Word(vec![$($word),*])
            }
            fn read(value: &$crate::parameters::Value) -> Option<Self> {
                match value {
                    $($crate::parameters::Value::Text(word) if word == $word => Some(Self::$variant),)*
                    _ => None,
                }
            }
            fn write(&self) -> $crate::parameters::Value {
                match self { $(Self::$variant => $crate::parameters::Value::from($word),)* }
            }
            fn numbers(&self, _: &mut dyn FnMut(f64)) {}
        }
    };
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    choice! {
        #[allow(unreachable_pub, reason = "the macro declares public items")]
        /// A choice.
        pub enum Kind {
            /// First.
            Metric = "metric",
            /// Second.
            Topological = "topological",
        }
    }
    parameters! {
        #[allow(unreachable_pub, reason = "the macro declares public items")]
        /// Parameters of the test.
        pub struct Example {
            /// Reach.
            radius alias "r": R = 1.0, "r", "length", Positive, Paper;
            /// Number.
            number alias "k": usize = 7usize, "k", "1", NonNegative, Ours;
            /// Kind.
            kind: Kind = "metric", "-", "-", Any, Ours;
            /// Need.
            need: PerAgent<R> = 0.5, "w", "1", NonNegative, Ours;
        }
    }

    fn of(pairs: &[(&str, Value)]) -> Result<Example<f64>, ParameterError> {
        Example::from_values(&pairs.iter().map(|(n, v)| ((*n).to_owned(), v.clone())).collect())
    }

    #[test]
    fn defaults_aliases_and_round_trip() {
        let default = of(&[]).unwrap();
        assert_eq!((default.radius, default.number, default.kind), (1.0, 7, Kind::Metric));
        assert_eq!(of(&[("r", 2.0.into())]).unwrap().radius, 2.0);
        let given = of(&[("need", [1.0, 2.0].into()), ("kind", "topological".into())]).unwrap();
        assert_eq!(given.need.of(1), Some(&2.0));
        assert_eq!(Example::<f64>::from_values(&given.values()).unwrap().values(), given.values());
    }

    #[test]
    fn wrong_input_is_named() {
        let text = |r: Result<Example<f64>, ParameterError>| r.unwrap_err().to_string();
        assert_eq!(text(of(&[("raduis", 1.0.into())])), "unknown parameter `raduis`; did you mean `radius`?");
        assert_eq!(text(of(&[("radius", 0.0.into())])), "`radius` must be more than 0, found 0");
        assert_eq!(text(of(&[("radius", f64::NAN.into())])), "`radius` must be more than 0, found NaN");
        assert_eq!(text(of(&[("number", 2.5.into())])), "`number` takes a whole number, found 2.5");
        assert!(text(of(&[("kind", "metrical".into())])).contains("one of \"metric\", \"topological\""));
        assert!(text(of(&[("r", 1.0.into()), ("radius", 1.0.into())])).contains("given twice"));
    }
}
