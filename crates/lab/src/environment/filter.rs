//! Feasibility filters as they are written.

use crate::file::form::{Desk, Field, Form, Rule, Shape, choice};
use crate::file::{Node, Tree};
use swarm::parameters::Range;
use terrain::filters::{self, Combined, FilterCard};

/// A condition of feasibility: a filter by its id with its numbers, as `{ material = { limit = 100 } }`, or several put
/// together with `all`, `any` and `not`.
#[derive(Clone, Debug, PartialEq)]
pub enum FilterForm {
    /// One filter: its id, and the parameters that differ from their defaults.
    One(String, Vec<(String, f64)>),
    /// All must pass.
    All(Vec<FilterForm>),
    /// One must pass.
    Any(Vec<FilterForm>),
    /// It must not pass.
    Not(Box<FilterForm>),
}

fn cards() -> Vec<&'static FilterCard> {
    filters::all().iter().map(|filter| filter.card()).collect()
}

/// Numbers by name, of those that a card has; what is wrong goes to the desk.
pub(super) fn numbers(
    node: &Node,
    rule: &Rule<'_>,
    names: &[&str],
    range: Range,
    desk: &mut Desk,
) -> Option<Vec<(String, f64)>> {
    let entries = desk.table(node, rule)?;
    let before = desk.problems.len();
    desk.only(entries, names);
    let number = |entry: &crate::file::tree::Entry, desk: &mut Desk| {
        let rule = Rule { name: &entry.key, unit: "", range };
        desk.number(&entry.node, &rule).map(|value| (entry.key.clone(), value))
    };
    let read: Option<Vec<_>> = entries.iter().map(|entry| number(entry, desk)).collect();
    read.filter(|_| desk.problems.len() == before)
}

/// A key of a table of numbers.
pub(super) fn number_field(name: &str, about: &str, unit: &str, default: Option<f64>) -> Field {
    Field {
        name: name.to_owned(),
        alias: None,
        about: about.to_owned(),
        shape: Shape::Number { unit: "", range: Range::Any },
        unit: unit.to_owned(),
        default: default.map(Tree::Number),
        required: false,
    }
}

impl Form for FilterForm {
    fn read(node: &Node, rule: &Rule<'_>, desk: &mut Desk) -> Option<Self> {
        let cards = cards();
        let known: Vec<&str> = cards.iter().map(|card| card.id).chain(["all", "any", "not"]).collect();
        let (key, below) = choice(node, rule, &known, desk)?;
        let rule = Rule { name: key, ..Rule::FREE };
        match key {
            "all" => Vec::read(&below, &rule, desk).map(Self::All),
            "any" => Vec::read(&below, &rule, desk).map(Self::Any),
            "not" => Box::read(&below, &rule, desk).map(Self::Not),
            id => {
                let card = cards.iter().find(|card| card.id == id)?;
                let names: Vec<&str> = card.parameters.iter().map(|(name, _)| *name).collect();
                numbers(&below, &rule, &names, Range::Any, desk).map(|given| Self::One(id.to_owned(), given))
            }
        }
    }
    fn shape(_: &Rule<'_>) -> Shape {
        let field = |name: &str, about: &str, shape| Field { shape, ..number_field(name, about, "", None) };
        let one = |card: &&'static FilterCard| {
            let parameters = card.parameters.iter().map(|(name, about)| number_field(name, about, "", None)).collect();
            field(card.id, card.about, Shape::Fields(parameters))
        };
        let several = || Shape::List(Box::new(Shape::Anything));
        let mut fields: Vec<Field> = cards().iter().map(one).collect();
        fields.push(field("all", "Filters all of which must pass.", several()));
        fields.push(field("any", "Filters one of which must pass.", several()));
        fields.push(field("not", "A filter that must not pass.", Shape::Anything));
        Shape::Either(vec![Shape::Fields(fields), Shape::Text])
    }
    fn write(&self) -> Tree {
        let (key, value) = match self {
            Self::One(id, given) => {
                (id.as_str(), Tree::table(given.iter().map(|(name, value)| (name.clone(), Tree::Number(*value)))))
            }
            Self::All(list) => ("all", list.write()),
            Self::Any(list) => ("any", list.write()),
            Self::Not(filter) => ("not", filter.write()),
        };
        Tree::table([(key.to_owned(), value)])
    }
}

/// All of some filters; what is wrong with them goes to the desk.
pub fn all_of(forms: &[FilterForm], tree: &Node, desk: &mut Desk) -> Combined {
    let mut filters = Vec::new();
    for (k, form) in forms.iter().enumerate() {
        match form.plain() {
            Ok(filter) => filters.push(filter),
            Err(what) => desk.problem(&tree.place(&format!("filter.{k}")), what, "a filter", ""),
        }
    }
    Combined::All(filters)
}

impl FilterForm {
    /// The filter.
    ///
    /// # Errors
    /// What it does not take, in a sentence; nothing of what was read.
    pub fn plain(&self) -> Result<Combined, String> {
        let list = |list: &[Self]| list.iter().map(Self::plain).collect::<Result<Vec<_>, _>>();
        Ok(match self {
            Self::One(id, given) => {
                let given: Vec<(&str, f64)> = given.iter().map(|(name, value)| (name.as_str(), *value)).collect();
                Combined::One(filters::find(id, &given).map_err(|error| error.to_string())?)
            }
            Self::All(all) => Combined::All(list(all)?),
            Self::Any(any) => Combined::Any(list(any)?),
            Self::Not(filter) => Combined::Not(Box::new(filter.plain()?)),
        })
    }
}
