//! Forms: what may stand where in a file. From one declaration come reading, checks, schema, help and templates.

use super::source::{Problem, Span};
use super::tree::{Entry, Node, Tree};
use space::spelling::nearest;
use swarm::parameters::Range;

/// What is asked of the numbers in a field.
#[derive(Clone, Copy, Debug)]
pub struct Rule<'a> {
    /// Name of the field.
    pub name: &'a str,
    /// Unit of its numbers.
    pub unit: &'static str,
    /// Range of each of its numbers.
    pub range: Range,
}

impl Rule<'_> {
    /// Of a thing that has no name and no limits of its own.
    pub const FREE: Rule<'static> = Rule { name: "the value", unit: "", range: Range::Any };
}

/// What may stand in a place.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A number.
    Number {
        /// Unit.
        unit: &'static str,
        /// Range.
        range: Range,
    },
    /// A whole number.
    Whole {
        /// Unit.
        unit: &'static str,
        /// Range.
        range: Range,
    },
    /// True or false.
    Truth,
    /// A text.
    Text,
    /// One of some words, each with what it means.
    Word(Vec<(&'static str, &'static str)>),
    /// A list.
    List(Box<Shape>),
    /// One of several shapes.
    Either(Vec<Shape>),
    /// A table with these keys. Made when asked for, since forms may contain themselves.
    Table {
        /// Name of the form.
        name: &'static str,
        /// What it is.
        about: &'static str,
        /// Its keys.
        fields: fn() -> Vec<Field>,
    },
    /// A table with exactly one of these keys.
    Tagged {
        /// Name of the form.
        name: &'static str,
        /// What it is.
        about: &'static str,
        /// Its keys.
        variants: fn() -> Vec<Variant>,
    },
    /// A table with these keys, known only at run time.
    Fields(Vec<Field>),
    /// A table whose keys are names that the user chooses.
    Named(Box<Shape>),
    /// Anything; what it may be is told elsewhere.
    Anything,
}

/// A key of a table.
#[derive(Clone, Debug)]
pub struct Field {
    /// The key.
    pub name: String,
    /// Another key that means the same.
    pub alias: Option<&'static str>,
    /// What it is, in a sentence.
    pub about: String,
    /// What may stand there.
    pub shape: Shape,
    /// Unit of its numbers.
    pub unit: String,
    /// What holds where it is left out; none where it must be given, or where leaving it out means none.
    pub default: Option<Tree>,
    /// Whether it must be given.
    pub required: bool,
}

/// A choice.
#[derive(Clone, Debug)]
pub struct Variant {
    /// The key.
    pub name: &'static str,
    /// What it is, in a sentence.
    pub about: &'static str,
    /// What stands below it.
    pub shape: Shape,
}

/// Where problems are put while a file is read.
#[derive(Debug, Default)]
pub struct Desk {
    /// What was found.
    pub problems: Vec<Problem>,
    /// Places of values that were put under a new name, each with the names that were there already.
    pub new_names: Vec<(Span, String)>,
}

impl Desk {
    /// Notes a problem.
    pub fn problem(
        &mut self,
        span: &Span,
        what: impl Into<String>,
        expected: impl Into<String>,
        help: impl Into<String>,
    ) {
        let (what, expected, help) = (what.into(), expected.into(), help.into());
        self.problems.push(Problem { span: span.clone(), what, expected, help });
    }
    /// Notes that a value is of another kind than what was expected.
    pub fn kind(&mut self, node: &Node, rule: &Rule<'_>, expected: &str) {
        let what = format!("{} takes {expected}, found {}", quoted(rule.name), node.tree.describe());
        self.problem(&node.span, what, format!("expected {expected}"), "");
    }
    /// The entries of a table.
    pub fn table<'a>(&mut self, node: &'a Node, rule: &Rule<'_>) -> Option<&'a [Entry]> {
        if let Tree::Table(entries) = &node.tree {
            return Some(entries);
        }
        self.kind(node, rule, "a table");
        None
    }
    /// Notes keys that are not among those known.
    pub fn only(&mut self, entries: &[Entry], known: &[&str]) {
        for entry in entries.iter().filter(|e| !known.contains(&e.key.as_str())) {
            let help = match nearest(&entry.key, known.iter().copied()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("known here: {}", known.join(", ")),
            };
            self.problem(&entry.span, format!("unknown key `{}`", entry.key), "not known here", help);
        }
    }
    /// The value of a key that must be there, or the note that it is missing.
    pub fn need(&mut self, at: &Span, entries: &[Entry], key: &str) -> Option<Node> {
        let found = entries.iter().find(|e| e.key == key).map(told_at_key);
        if found.is_none() {
            let help = self.new_names.iter().find(|(place, _)| place == at).map_or("", |(_, help)| help).to_owned();
            self.problem(at, format!("`{key}` is missing"), format!("`{key}` must be given here"), help);
        }
        found
    }
    /// A finite number in its range.
    pub fn number(&mut self, node: &Node, rule: &Rule<'_>) -> Option<f64> {
        let Some(number) = node.tree.number() else {
            self.kind(node, rule, "a number");
            return None;
        };
        match rule.range.admits(number) {
            Ok(()) => Some(number),
            Err(expected) => self.outside(node, rule, expected),
        }
    }
    fn outside<T>(&mut self, node: &Node, rule: &Rule<'_>, expected: String) -> Option<T> {
        let found = node.tree.describe();
        let what = format!("{} must be {expected}, found {found}", quoted(rule.name));
        self.problem(&node.span, what, format!("expected {expected}"), "");
        None
    }
    /// A whole number in its range.
    pub fn whole(&mut self, node: &Node, rule: &Rule<'_>) -> Option<i64> {
        let Tree::Whole(number) = node.tree else {
            self.kind(node, rule, "a whole number");
            return None;
        };
        // a seed may be larger than anything that is computed with
        if rule.range.holds(number as f64) {
            return Some(number);
        }
        self.outside(node, rule, rule.range.to_string())
    }
}

fn quoted(name: &str) -> String {
    if name.contains(' ') { name.to_owned() } else { format!("`{name}`") }
}

/// Something that can be read from a place in a file.
pub trait Form: Sized {
    /// Reads it; problems go to the desk.
    fn read(node: &Node, rule: &Rule<'_>, desk: &mut Desk) -> Option<Self>;
    /// What may stand there.
    fn shape(rule: &Rule<'_>) -> Shape;
    /// Writes it as it would be read, with defaults filled in.
    fn write(&self) -> Tree;
}

impl Form for f64 {
    fn read(node: &Node, rule: &Rule<'_>, desk: &mut Desk) -> Option<Self> {
        desk.number(node, rule)
    }
    fn shape(rule: &Rule<'_>) -> Shape {
        Shape::Number { unit: rule.unit, range: rule.range }
    }
    fn write(&self) -> Tree {
        Tree::Number(*self)
    }
}

macro_rules! whole_form {
    ($($t:ty),*) => {$(
        impl Form for $t {
            fn read(node: &Node, rule: &Rule<'_>, desk: &mut Desk) -> Option<Self> {
                let number = desk.whole(node, rule)?;
                let read = Self::try_from(number).ok();
                if read.is_none() {
                    let what = format!("{} must be 0 or more and not too large, found {number}", quoted(rule.name));
                    desk.problem(&node.span, what, "expected a whole number of 0 or more", "");
                }
                read
            }
            fn shape(rule: &Rule<'_>) -> Shape {
                Shape::Whole { unit: rule.unit, range: rule.range }
            }
            fn write(&self) -> Tree {
                i64::try_from(*self).map_or(Tree::Number(*self as f64), Tree::Whole)
            }
        }
    )*};
}
whole_form!(u32, u64, usize);

impl Form for bool {
    fn read(node: &Node, rule: &Rule<'_>, desk: &mut Desk) -> Option<Self> {
        if let Tree::Truth(truth) = node.tree {
            return Some(truth);
        }
        desk.kind(node, rule, "true or false");
        None
    }
    fn shape(_: &Rule<'_>) -> Shape {
        Shape::Truth
    }
    fn write(&self) -> Tree {
        Tree::Truth(*self)
    }
}

impl Form for String {
    fn read(node: &Node, rule: &Rule<'_>, desk: &mut Desk) -> Option<Self> {
        if let Tree::Text(text) = &node.tree {
            return Some(text.clone());
        }
        desk.kind(node, rule, "a text in quotes");
        None
    }
    fn shape(_: &Rule<'_>) -> Shape {
        Shape::Text
    }
    fn write(&self) -> Tree {
        Tree::Text(self.clone())
    }
}

impl<T: Form> Form for Vec<T> {
    fn read(node: &Node, rule: &Rule<'_>, desk: &mut Desk) -> Option<Self> {
        let Tree::List(list) = &node.tree else {
            desk.kind(node, rule, "a list");
            return None;
        };
        // every entry is read, so that every problem is found
        let read: Vec<Option<T>> = list.iter().map(|entry| T::read(entry, rule, desk)).collect();
        read.into_iter().collect()
    }
    fn shape(rule: &Rule<'_>) -> Shape {
        Shape::List(Box::new(T::shape(rule)))
    }
    fn write(&self) -> Tree {
        Tree::list(self.iter().map(T::write))
    }
}

impl<T: Form> Form for Box<T> {
    fn read(node: &Node, rule: &Rule<'_>, desk: &mut Desk) -> Option<Self> {
        T::read(node, rule, desk).map(Self::new)
    }
    fn shape(rule: &Rule<'_>) -> Shape {
        T::shape(rule)
    }
    fn write(&self) -> Tree {
        (**self).write()
    }
}

/// A value for each axis, or one for all.
#[derive(Clone, Debug, PartialEq)]
pub enum PerAxis<T> {
    /// The same on every axis.
    All(T),
    /// One for each.
    Each(Vec<T>),
}

impl<T: Clone> PerAxis<T> {
    /// The value of an axis; none where there is none for it.
    pub fn of(&self, axis: usize) -> Option<T> {
        match self {
            Self::All(value) => Some(value.clone()),
            Self::Each(values) => values.get(axis).cloned(),
        }
    }
    /// For how many axes there is a value; none where one holds for all.
    pub fn count(&self) -> Option<usize> {
        if let Self::Each(values) = self { Some(values.len()) } else { None }
    }
}

impl<T: Form> Form for PerAxis<T> {
    fn read(node: &Node, rule: &Rule<'_>, desk: &mut Desk) -> Option<Self> {
        if matches!(node.tree, Tree::List(_)) {
            return Vec::read(node, rule, desk).map(Self::Each);
        }
        T::read(node, rule, desk).map(Self::All)
    }
    fn shape(rule: &Rule<'_>) -> Shape {
        Shape::Either(vec![T::shape(rule), Vec::<T>::shape(rule)])
    }
    fn write(&self) -> Tree {
        match self {
            Self::All(value) => value.write(),
            Self::Each(values) => values.write(),
        }
    }
}

/// Things by the names that the user gives them, in the order of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Named<T>(pub Vec<(String, T)>);

impl<T> Default for Named<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T: Form> Form for Named<T> {
    fn read(node: &Node, rule: &Rule<'_>, desk: &mut Desk) -> Option<Self> {
        let entries = desk.table(node, rule)?;
        let mut read = Vec::with_capacity(entries.len());
        for entry in entries {
            read.push(
                T::read(&told_at_key(entry), &Rule { name: &entry.key, ..*rule }, desk).map(|t| (entry.key.clone(), t)),
            );
        }
        read.into_iter().collect::<Option<_>>().map(Self)
    }
    fn shape(rule: &Rule<'_>) -> Shape {
        Shape::Named(Box::new(T::shape(rule)))
    }
    fn write(&self) -> Tree {
        Tree::table(self.0.iter().map(|(name, value)| (name.clone(), value.write())))
    }
}

/// Where to point for the value of a key: at the key when the value is a table, which may lie anywhere.
pub fn place_of(entry: &Entry) -> Span {
    if matches!(entry.node.tree, Tree::Table(_)) { entry.span.clone() } else { entry.node.span.clone() }
}

/// The value of a key, so that what is missing in a table is told at the table's name.
pub fn told_at_key(entry: &Entry) -> Node {
    Node { tree: entry.node.tree.clone(), span: place_of(entry) }
}

/// A table without keys, for choices that need no more said.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Nothing;

impl Form for Nothing {
    fn read(node: &Node, rule: &Rule<'_>, desk: &mut Desk) -> Option<Self> {
        let entries = desk.table(node, rule)?;
        desk.only(entries, &[]);
        Some(Self)
    }
    fn shape(_: &Rule<'_>) -> Shape {
        Shape::Fields(Vec::new())
    }
    fn write(&self) -> Tree {
        Tree::Table(Vec::new())
    }
}

/// The one key of a choice, with its value: `{ key = ... }`, or `"key"` alone where nothing more must be said.
pub fn choice<'a>(node: &'a Node, rule: &Rule<'_>, known: &[&str], desk: &mut Desk) -> Option<(&'a str, Node)> {
    let (key, span, below) = match &node.tree {
        Tree::Text(word) => {
            let below = Node { tree: Tree::Table(Vec::new()), span: node.span.clone() };
            (word.as_str(), &node.span, below)
        }
        Tree::Table(entries) => match entries.as_slice() {
            [one] => (one.key.as_str(), &one.span, told_at_key(one)),
            [] => {
                let what = format!("{} is empty", quoted(rule.name));
                desk.problem(&node.span, what, format!("expected one of {}", known.join(", ")), "");
                return None;
            }
            [_, second, ..] => {
                desk.only(entries, known);
                let keys: Vec<&str> = entries.iter().map(|e| e.key.as_str()).collect();
                let what = format!("{} takes one choice, found {}", quoted(rule.name), keys.join(" and "));
                desk.problem(&second.span, what, "one choice too many", "");
                return None;
            }
        },
        _ => {
            desk.kind(node, rule, &format!("one of {}", known.join(", ")));
            return None;
        }
    };
    if known.contains(&key) {
        return Some((key, below));
    }
    let help = nearest(key, known.iter().copied()).map_or_else(String::new, |near| format!("did you mean `{near}`?"));
    let what = format!("{} has no choice `{key}`", quoted(rule.name));
    desk.problem(span, what, format!("expected one of {}", known.join(", ")), help);
    None
}

/// A value that is not read here, with its place: what it may be depends on where it is put.
#[derive(Clone, Debug, PartialEq)]
pub struct Anything(pub Node);

impl Form for Anything {
    fn read(node: &Node, _: &Rule<'_>, _: &mut Desk) -> Option<Self> {
        Some(Self(node.clone()))
    }
    fn shape(_: &Rule<'_>) -> Shape {
        Shape::Anything
    }
    fn write(&self) -> Tree {
        self.0.tree.clone()
    }
}

/// Declares a table with its keys.
///
/// A key reads: doc sentence, `name: Type = default, "unit", Range;`, where the default is `need` (it must be given),
/// `none` (an `Option` that may be left out) or a value in brackets.
#[macro_export]
macro_rules! form {
    ($(#[doc = $what:literal])+ pub struct $name:ident {
        $($(#[doc = $about:literal])+ $field:ident: $type:ty = $default:tt, $unit:literal, $range:expr;)*
    }) => {
        $(#[doc = $what])+
        #[derive(Clone, Debug, PartialEq)]
        pub struct $name { $($(#[doc = $about])+ pub $field: $type,)* }
        impl $crate::file::Form for $name {
            fn read(
                node: &$crate::file::Node,
                rule: &$crate::file::Rule<'_>,
                desk: &mut $crate::file::Desk,
            ) -> Option<Self> {
                #[allow(unused_imports, reason = "not every form uses every range")]
                use swarm::parameters::Range::*;
                let entries = desk.table(node, rule)?;
                desk.only(entries, &[$(stringify!($field)),*]);
                $(let $field = {
                    let rule = $crate::file::Rule { name: stringify!($field), unit: $unit, range: $range };
                    form!(@read node, entries, rule, desk, $field, $type, $default)
                };)*
                Some(Self { $($field: $field?,)* })
            }
            fn shape(_: &$crate::file::Rule<'_>) -> $crate::file::Shape {
                fn fields() -> Vec<$crate::file::Field> {
                    #[allow(unused_imports, reason = "not every form uses every range")]
                    use swarm::parameters::Range::*;
                    vec![$({
                        let rule = $crate::file::Rule { name: stringify!($field), unit: $unit, range: $range };
                        $crate::file::Field {
                            name: stringify!($field).to_owned(),
                            alias: None,
                            about: concat!($($about),+).trim().to_owned(),
                            shape: form!(@shape rule, $type, $default),
                            unit: $unit.to_owned(),
                            default: form!(@default $type, $default),
                            required: form!(@required $default),
                        }
                    }),*]
                }
                $crate::file::Shape::Table { name: stringify!($name), about: concat!($($what),+).trim_ascii(), fields }
            }
            fn write(&self) -> $crate::file::Tree {
                $crate::file::Tree::table([$(form!(@write self, $field, $default)),*].into_iter().flatten())
            }
        }
    };
    (@read $node:ident, $entries:ident, $rule:ident, $desk:ident, $field:ident, $type:ty, need) => {
        $desk.need(&$node.span, $entries, stringify!($field))
            .and_then(|found| <$type as $crate::file::Form>::read(&found, &$rule, $desk))
    };
    (@read $node:ident, $entries:ident, $rule:ident, $desk:ident, $field:ident, $type:ty, none) => {
        match $entries.iter().find(|e| e.key == stringify!($field)) {
            None => Some(None),
            Some(entry) => {
                let below = $crate::file::form::told_at_key(entry);
                $crate::file::form::read_some(&below, &$rule, $desk)
            }
        }
    };
    (@read $node:ident, $entries:ident, $rule:ident, $desk:ident, $field:ident, $type:ty, [$default:expr]) => {
        match $entries.iter().find(|e| e.key == stringify!($field)) {
            None => Some(<$type>::from($default)),
            Some(entry) => {
                let below = $crate::file::form::told_at_key(entry);
                <$type as $crate::file::Form>::read(&below, &$rule, $desk)
            }
        }
    };
    (@shape $rule:ident, $type:ty, none) => { $crate::file::form::shape_of_some::<$type>(&$rule) };
    (@shape $rule:ident, $type:ty, $default:tt) => { <$type as $crate::file::Form>::shape(&$rule) };
    (@default $type:ty, [$default:expr]) => { Some($crate::file::Form::write(&<$type>::from($default))) };
    (@default $type:ty, $default:tt) => { None };
    (@required need) => { true };
    (@required $default:tt) => { false };
    (@write $self:ident, $field:ident, none) => {
        $self.$field.as_ref().map(|value| (stringify!($field).to_owned(), $crate::file::Form::write(value)))
    };
    (@write $self:ident, $field:ident, $default:tt) => {
        Some((stringify!($field).to_owned(), $crate::file::Form::write(&$self.$field)))
    };
}

/// Reads a value that may be left out and was not.
pub fn read_some<T: Form>(node: &Node, rule: &Rule<'_>, desk: &mut Desk) -> Option<Option<T>> {
    T::read(node, rule, desk).map(Some)
}

/// An optional value, for its shape.
pub trait Optional {
    /// What it is when it is there.
    type Inner: Form;
}
impl<T: Form> Optional for Option<T> {
    type Inner = T;
}

/// The shape of a value that may be left out.
pub fn shape_of_some<T: Optional>(rule: &Rule<'_>) -> Shape {
    <T::Inner as Form>::shape(rule)
}

/// Declares a choice: a table with exactly one key, or that key as a word where nothing more must be said.
///
/// A variant reads: doc sentence, `key: Variant(Type);`, with `"unit", Range` before the colon for bare numbers.
#[macro_export]
macro_rules! tagged {
    ($(#[doc = $what:literal])+ pub enum $name:ident {
        $($(#[doc = $about:literal])+ $key:ident $(in $unit:literal, $range:expr)? => $variant:ident($type:ty);)*
    }) => {
        $(#[doc = $what])+
        #[derive(Clone, Debug, PartialEq)]
        pub enum $name { $($(#[doc = $about])+ $variant($type),)* }
        impl $crate::file::Form for $name {
            fn read(
                node: &$crate::file::Node,
                rule: &$crate::file::Rule<'_>,
                desk: &mut $crate::file::Desk,
            ) -> Option<Self> {
                let (key, below) = $crate::file::form::choice(node, rule, &[$(stringify!($key)),*], desk)?;
                $(if key == stringify!($key) {
                    let rule = tagged!(@rule $key $(, $unit, $range)?);
                    return <$type as $crate::file::Form>::read(&below, &rule, desk).map(Self::$variant);
                })*
                None
            }
            fn shape(_: &$crate::file::Rule<'_>) -> $crate::file::Shape {
                fn variants() -> Vec<$crate::file::form::Variant> {
                    vec![$($crate::file::form::Variant {
                        name: stringify!($key),
                        about: concat!($($about),+).trim_ascii(),
                        shape: {
                            let rule = tagged!(@rule $key $(, $unit, $range)?);
                            <$type as $crate::file::Form>::shape(&rule)
                        },
                    }),*]
                }
                $crate::file::Shape::Tagged { name: stringify!($name), about: concat!($($what),+).trim_ascii(), variants }
            }
            fn write(&self) -> $crate::file::Tree {
                match self {
                    $(Self::$variant(value) => {
                        $crate::file::Tree::table([(stringify!($key).to_owned(), $crate::file::Form::write(value))])
                    })*
                }
            }
        }
    };
    (@rule $key:ident) => { $crate::file::Rule { name: stringify!($key), ..$crate::file::Rule::FREE } };
    (@rule $key:ident, $unit:literal, $range:expr) => {
        $crate::file::Rule { name: stringify!($key), unit: $unit, range: $range }
    };
}

/// Declares a choice between words.
#[macro_export]
macro_rules! words {
    ($(#[doc = $what:literal])+ pub enum $name:ident {
        $($(#[doc = $about:literal])+ $variant:ident = $word:literal,)*
    }) => {
        $(#[doc = $what])+
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name { $($(#[doc = $about])+ $variant,)* }
        impl $name {
            /// The word.
            pub fn word(self) -> &'static str {
                match self { $(Self::$variant => $word,)* }
            }
        }
        impl $crate::file::Form for $name {
            fn read(
                node: &$crate::file::Node,
                rule: &$crate::file::Rule<'_>,
                desk: &mut $crate::file::Desk,
            ) -> Option<Self> {
                let known = [$($word),*];
                if let $crate::file::Tree::Text(text) = &node.tree {
                    $(if text == $word {
                        return Some(Self::$variant);
                    })*
                    let near = space::spelling::nearest(text, known.iter().copied());
                    let help = near.map_or_else(String::new, |near| format!("did you mean \"{near}\"?"));
                    let what = format!("`{}` cannot be \"{text}\"", rule.name);
                    desk.problem(&node.span, what, format!("expected one of {}", known.join(", ")), help);
                    return None;
                }
                desk.kind(node, rule, &format!("one of {}", known.map(|w| format!("\"{w}\"")).join(", ")));
                None
            }
            fn shape(_: &$crate::file::Rule<'_>) -> $crate::file::Shape {
                $crate::file::Shape::Word(vec![$(($word, concat!($($about),+).trim_ascii())),*])
            }
            fn write(&self) -> $crate::file::Tree {
                $crate::file::Tree::Text(self.word().to_owned())
            }
        }
    };
}

#[cfg(test)]
#[allow(clippy::unwrap_used, unreachable_pub, reason = "tests; the macros declare public items")]
mod tests {
    use super::*;
    use crate::file::Sources;
    use crate::file::tree::parse;

    words! {
        /// A colour.
        pub enum Colour {
            /// Like blood.
            Red = "red",
            /// Like the sky.
            Blue = "blue",
        }
    }
    form! {
        /// A disc.
        pub struct Disc {
            /// How far it reaches.
            radius: f64 = need, "length", Positive;
            /// Its colour.
            colour: Colour = [Colour::Red], "", Any;
            /// How many.
            count: Option<usize> = none, "1", Within(1.0, 9.0);
        }
    }
    tagged! {
        /// A thing.
        pub enum Thing {
            /// A disc.
            disc => Disc(Disc);
            /// So many points.
            points in "1", swarm::parameters::Range::Positive => Points(usize);
            /// Nothing.
            empty => Empty(Nothing);
            /// Several.
            all => All(Vec<Thing>);
        }
    }

    fn read(text: &str) -> Result<Thing, Vec<String>> {
        let mut sources = Sources::default();
        let source = sources.add("t", text);
        let mut desk = Desk::default();
        let node = parse(&sources, source, &mut desk.problems);
        let thing = Thing::read(&node.get("thing").unwrap().clone(), &Rule::FREE, &mut desk);
        if desk.problems.is_empty() {
            return Ok(thing.unwrap());
        }
        Err(desk.problems.into_iter().map(|p| format!("{} @{}", p.what, &text[p.span.bytes])).collect())
    }

    #[test]
    fn reads_and_writes() {
        let text = "thing.all = [{ disc = { radius = 2, count = 3 } }, { points = 4 }, \"empty\"]";
        let thing = read(text).unwrap();
        let disc = Disc { radius: 2.0, colour: Colour::Red, count: Some(3) };
        assert_eq!(thing, Thing::All(vec![Thing::Disc(disc), Thing::Points(4), Thing::Empty(Nothing)]));
        let json = thing.write().json().to_string();
        assert_eq!(json, r#"{"all":[{"disc":{"radius":2.0,"colour":"red","count":3}},{"points":4},{"empty":{}}]}"#);
    }

    #[test]
    fn every_problem_is_found_at_its_place() {
        let text = "thing.disc = { radius = -1, coluor = 2, colour = \"rde\", count = 1.5 }";
        let problems = read(text).unwrap_err();
        assert_eq!(problems.len(), 4, "{problems:?}");
        assert!(problems.contains(&"unknown key `coluor` @coluor".to_owned()));
        assert!(problems.contains(&"`radius` must be more than 0, found -1 @-1".to_owned()), "{problems:?}");
        assert!(problems.contains(&"`colour` cannot be \"rde\" @\"rde\"".to_owned()));
        assert!(problems.contains(&"`count` takes a whole number, found 1.5 @1.5".to_owned()));
        for (text, what) in [
            ("thing.disc = {}", "`radius` is missing"),
            ("thing = \"disk\"", "has no choice `disk`"),
            ("thing = 3", "takes one of disc, points"),
            ("thing = { points = 1, empty = {} }", "one choice, found points and empty"),
            ("thing = {}", "is empty"),
            ("thing.points = nan", "whole number"),
            ("thing.disc.radius = nan", "more than 0, found NaN"),
            ("thing.empty = { a = 1 }", "unknown key `a`"),
        ] {
            let problems = read(text).unwrap_err();
            assert!(problems[0].contains(what), "{text}: {problems:?}");
        }
    }
}
