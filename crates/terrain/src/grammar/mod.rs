//! Shape grammars: rules that turn a starting drawing into an environment, as data.
//!
//! Shapes are *terminal* (built), *non-terminal* (structure alone) or *markers* (never built, readable). A rule adds
//! to what its left side matches, puts something in its place, or changes it. One step, in the order of choice
//! `match-first`: (1) all instances that at least one rule matches, one of them uniformly; (2) among the rules that
//! match it, one by weight; (3) the rule's variables; (4) the rule is applied. In the order `rule-first` a rule is
//! chosen by weight among those with a match, then one of its matches uniformly. The derivation ends where no rule
//! matches, after the chosen number of applications, or at the limit of steps.

mod check;
mod decided;
mod derive;
mod matching;

pub use decided::Decided;
pub use derive::{Derivation, Instance, Step};

use crate::draws::Distribution;
use crate::expression::{Condition, Expression};
use crate::geometry::{Geometry, Units};
use crate::{Construct, TerrainError};

/// What becomes of a shape in the end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// It is built, and agents sense it.
    Terminal,
    /// It carries structure and is never built.
    NonTerminal,
    /// It is never built, and behaviours and filters read it.
    Marker,
}

/// A shape: a name, what becomes of it, and its geometry in a frame whose x axis is its heading and whose end is at 1.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeKind {
    /// Its name.
    pub name: String,
    /// What becomes of it.
    pub kind: Kind,
    /// Its geometry in the unit frame.
    pub geometry: Vec<Geometry>,
}

/// Which is chosen first in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Pick {
    /// An instance that some rule matches, then one of those rules by weight.
    #[default]
    MatchFirst,
    /// A rule by weight, then one of its matches.
    RuleFirst,
}

/// What becomes of a derivation that is stopped by its limit of steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum OnLimit {
    /// Its non-terminals are dropped, its terminals kept.
    #[default]
    Drop,
    /// It is refused.
    Reject,
}

/// Where a starting instance stands.
#[derive(Clone, Debug, PartialEq)]
pub enum AxiomPlace {
    /// At a point.
    At([Expression; 2]),
    /// At a distance from the origin, on a bearing (degrees, counter-clockwise from x).
    Polar {
        /// Distance, length.
        radius: Expression,
        /// Direction, degrees.
        bearing: Expression,
    },
}

/// A starting instance.
#[derive(Clone, Debug, PartialEq)]
pub struct Axiom {
    /// Name of its shape.
    pub shape: String,
    /// Where it stands.
    pub place: AxiomPlace,
    /// Whether the place is its middle and not its beginning.
    pub middle: bool,
    /// Its heading, degrees.
    pub heading: Expression,
    /// Its length.
    pub length: Expression,
    /// Its label; empty for none.
    pub label: String,
}

impl Axiom {
    /// An instance of length 1 at a point, along the x axis, without a label.
    pub fn new(shape: &str, at: [f64; 2]) -> Self {
        Self {
            shape: shape.into(),
            place: AxiomPlace::At(at.map(Expression::Number)),
            middle: false,
            heading: 0.0.into(),
            length: 1.0.into(),
            label: String::new(),
        }
    }
}

/// What a rule looks for: one shape of its left side.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Pattern {
    /// Name of the shape.
    pub shape: String,
    /// The label it must have; any where none is given.
    pub label: Option<String>,
    /// Where it stands in the frame of the first pattern (the first itself: at its origin).
    pub at: [f64; 2],
    /// Its heading relative to the first pattern's, degrees.
    pub turn: f64,
}

/// How a rule uses what it matched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RuleKind {
    /// The left side stays; the right side is added.
    Addition,
    /// The left side is removed; the right side is put in.
    Substitution,
    /// The k-th match is changed as the k-th item of the right side says.
    Modification,
}

/// Where an item of the right side stands, relative to the first match.
#[derive(Clone, Debug, PartialEq, Default)]
pub enum ItemPlace {
    /// At the place of the matched shape; in a modification: where the changed shape is.
    #[default]
    Origin,
    /// At the end of the matched shape.
    End,
    /// At the end of an earlier item of the right side, by its index.
    EndOf(usize),
    /// At a point in the matched frame.
    At([Expression; 2]),
}

/// An item of the right side.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Item {
    /// Name of the shape; in a modification: a new shape, or the same where it is empty.
    pub shape: String,
    /// Where it stands.
    pub place: ItemPlace,
    /// Its heading relative to the matched one's, degrees; in a modification to its own. 0 where not given.
    pub turn: Option<Expression>,
    /// Its length; 1 where not given, in a modification unchanged.
    pub length: Option<Expression>,
    /// Its scale; 1 where not given, in a modification unchanged.
    pub scale: Option<Expression>,
    /// Its label; none where not given, in a modification unchanged.
    pub label: Option<String>,
    /// Attributes that it is given.
    pub set: Vec<(String, Expression)>,
}

/// A rule.
#[derive(Clone, Debug, PartialEq)]
pub struct Rule {
    /// Its name.
    pub name: String,
    /// How it uses what it matched.
    pub kind: RuleKind,
    /// How likely it is chosen, beside others.
    pub weight: f64,
    /// What it looks for.
    pub left: Vec<Pattern>,
    /// What it makes.
    pub right: Vec<Item>,
    /// The label that the first match has afterwards, where it stays.
    pub relabel: Option<String>,
    /// Variables drawn when it is applied.
    pub variables: Vec<(String, Distribution)>,
    /// What must hold for it to match.
    pub when: Vec<Condition>,
    /// Whether it also matches at any uniform scale of the arrangement.
    pub scale_free: bool,
    /// Whether it also matches mirrored.
    pub mirror: bool,
}

impl Rule {
    /// A rule of weight 1 that looks for one shape and makes nothing yet.
    pub fn new(name: &str, kind: RuleKind, left: &str) -> Self {
        Self {
            name: name.into(),
            kind,
            weight: 1.0,
            left: vec![Pattern { shape: left.into(), ..Pattern::default() }],
            right: Vec::new(),
            relabel: None,
            variables: Vec::new(),
            when: Vec::new(),
            scale_free: false,
            mirror: false,
        }
    }
    /// The same rule with another weight.
    #[must_use]
    pub fn weighing(mut self, weight: f64) -> Self {
        self.weight = weight;
        self
    }
}

/// A shape grammar.
#[derive(Clone, Debug, PartialEq)]
pub struct Grammar {
    /// Its name.
    pub name: String,
    /// In what lengths are measured.
    pub units: Units,
    /// Which is chosen first in a step.
    pub pick: Pick,
    /// Numbers of applications, one of which is drawn with equal chance; empty: until no rule matches.
    pub steps: Vec<u32>,
    /// Applications after which a derivation is stopped.
    pub max_steps: u32,
    /// What becomes of one that is stopped.
    pub on_limit: OnLimit,
    /// The shapes.
    pub shapes: Vec<ShapeKind>,
    /// Variables drawn once for each derivation.
    pub variables: Vec<(String, Distribution)>,
    /// The starting instances.
    pub axioms: Vec<Axiom>,
    /// The rules.
    pub rules: Vec<Rule>,
}

impl Grammar {
    /// A grammar without shapes and rules that ends when no rule matches, after at most 1000 applications.
    pub fn new(name: &str, units: Units) -> Self {
        Self {
            name: name.into(),
            units,
            pick: Pick::default(),
            steps: Vec::new(),
            max_steps: 1000,
            on_limit: OnLimit::default(),
            shapes: Vec::new(),
            variables: Vec::new(),
            axioms: Vec::new(),
            rules: Vec::new(),
        }
    }
    /// Index of the shape of a name.
    ///
    /// # Errors
    /// Where no shape is called so.
    pub fn shape(&self, name: &str) -> Result<usize, TerrainError> {
        let names = || self.shapes.iter().map(|shape| shape.name.as_str());
        names().position(|known| known == name).ok_or_else(|| TerrainError::unknown("shape", name, names()))
    }
    /// The construct of an attempt under a seed: one derivation, its terminals built. The grammar must have passed
    /// [`Grammar::check`].
    ///
    /// # Errors
    /// [`TerrainError::Unfinished`] where the limit of steps is reached and the grammar rejects such; an expression
    /// without a finite value.
    pub fn construct(&self, seed: u64, attempt: u64) -> Result<Construct, TerrainError> {
        self.derive(seed, attempt)?.construct(self)
    }
}
