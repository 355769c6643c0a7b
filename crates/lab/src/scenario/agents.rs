//! The model of a group, with its parameters; values that differ from member to member.

use crate::file::form::{Variant, choice, place_of};
use crate::file::{Desk, Field, Form, Node, Rule, Shape, Span, Tree};
use crate::tagged;
use measure::statistics::distribution::normal;
use space::random::{Purpose, uniform};
use space::spelling::nearest;
use swarm::adaptation::Varied;
use swarm::models;
use swarm::motion::Preset;
use swarm::parameters::{Descriptor, Kind, ParameterError, Range, Value, Values};
use swarm::terms;

tagged! {
    /// A distribution over the members of a group.
    pub enum Distribution {
        /// The same for all.
        constant => Constant(f64);
        /// Normal: mean and standard deviation. Values outside the range of the parameter are set to its nearest end.
        normal => Normal(Vec<f64>);
        /// Normal, cut off at two ends: mean, standard deviation, least, greatest.
        truncated => Truncated(Vec<f64>);
        /// One value for each member.
        list => List(Vec<f64>);
        /// Uniform between two ends.
        uniform => Uniform(Vec<f64>);
    }
}

impl Distribution {
    /// Notes what cannot be.
    fn checked(self, span: &Span, desk: &mut Desk) -> Option<Self> {
        let (what, fine) = match &self {
            Self::Constant(_) | Self::List(_) => ("", true),
            Self::Truncated(v) => (
                "truncated takes [mean, standard deviation, least, greatest], the second 0 or more, the third not above the last",
                v.len() == 4 && v[1] >= 0.0 && v[2] <= v[3],
            ),
            Self::Normal(v) => {
                ("normal takes [mean, standard deviation], the second 0 or more", v.len() == 2 && v[1] >= 0.0)
            }
            Self::Uniform(v) => {
                ("uniform takes [least, greatest], the first not above the second", v.len() == 2 && v[0] <= v[1])
            }
        };
        if !fine {
            desk.problem(span, what, "two numbers in order", "");
        }
        fine.then_some(self)
    }
    /// Whether there is one value for each of so many members.
    fn fits(&self, count: usize) -> Result<(), usize> {
        match self {
            Self::List(values) if values.len() != count => Err(values.len()),
            _ => Ok(()),
        }
    }
    /// The value of a member of so many of the group, by its place in it. The draws depend on the seed, the name of the quantity and the member's id alone.
    pub fn of(&self, seed: u64, name: &str, first: u32, member: u32) -> f64 {
        let id = first + member;
        // FNV-1a: a stream of its own for every quantity
        let hash = name.bytes().fold(0x811c_9dc5u32, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193));
        let a = (1 << 43) | u64::from(hash);
        let draw = |slot: u32| uniform(seed, Purpose::Init, a, id.wrapping_mul(8).wrapping_add(slot));
        match self {
            Self::Constant(value) => *value,
            Self::List(values) => values.get(member as usize).copied().unwrap_or(f64::NAN),
            Self::Truncated(v) => truncated(draw(0), v[0], v[1], v[2], v[3]),
            Self::Normal(v) => v[0] + v[1] * space::random::normal(draw(0), draw(1)),
            Self::Uniform(v) => v[0] + (v[1] - v[0]) * draw(0),
        }
    }
}

/// A number for all members, a list with one each, or a distribution.
#[derive(Clone, Debug, PartialEq)]
pub enum PerMember {
    /// The same for all.
    All(f64),
    /// One each.
    Each(Vec<f64>),
    /// Drawn for each.
    Drawn(Distribution),
}

impl Form for PerMember {
    fn read(node: &Node, rule: &Rule<'_>, desk: &mut Desk) -> Option<Self> {
        match &node.tree {
            Tree::Table(_) => Distribution::read(node, rule, desk)?.checked(&node.span, desk).map(Self::Drawn),
            Tree::List(_) => Vec::read(node, rule, desk).map(Self::Each),
            _ => f64::read(node, rule, desk).map(Self::All),
        }
    }
    fn shape(rule: &Rule<'_>) -> Shape {
        Shape::Either(vec![f64::shape(rule), Vec::<f64>::shape(rule), Distribution::shape(rule)])
    }
    fn write(&self) -> Tree {
        match self {
            Self::All(value) => value.write(),
            Self::Each(values) => values.write(),
            Self::Drawn(distribution) => distribution.write(),
        }
    }
}

impl PerMember {
    /// The values of `count` members from the id `first` on; `Err` with the number of values where that is another.
    pub fn values(&self, count: usize, seed: u64, name: &str, first: u32) -> Result<Vec<f64>, usize> {
        match self {
            Self::All(value) => Ok(vec![*value; count]),
            Self::Each(values) if values.len() == count => Ok(values.clone()),
            Self::Each(values) => Err(values.len()),
            Self::Drawn(distribution) => {
                distribution.fits(count)?;
                Ok((0..count as u32).map(|k| distribution.of(seed, name, first, k)).collect())
            }
        }
    }
}

/// A parameter's value as written.
#[derive(Clone, Debug, PartialEq)]
pub enum Given {
    /// A value.
    Value(Value),
    /// Drawn for each member.
    Drawn(Distribution),
}

/// A model with the parameters that were written, by their full names; angles in degrees.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Its id.
    pub id: String,
    /// Parameters by full name.
    pub parameters: Vec<(String, Given)>,
}

impl Model {
    /// The descriptors of its parameters.
    pub fn descriptors(&self) -> Vec<Descriptor> {
        models::find(&self.id).map_or_else(Vec::new, |entry| (entry.parameters)())
    }
    /// Parameters of which each of `count` members from the id `first` on has its own value, angles in radians: those that are
    /// drawn and of which the law itself takes only one.
    pub fn varied(&self, count: usize, seed: u64, first: u32) -> Vec<Varied> {
        let descriptors = self.descriptors();
        let mut varied = Vec::new();
        for (name, given) in &self.parameters {
            let Some(descriptor) = descriptors.iter().find(|d| d.name == name) else { continue };
            if let (Given::Drawn(distribution), Kind::Number | Kind::Whole) = (given, &descriptor.takes) {
                let values = drawn(descriptor, distribution, count, seed, first);
                let radian = in_radians(descriptor);
                let values = values.into_iter().map(|value| if radian { radians(value) } else { value }).collect();
                varied.push(Varied { parameter: name.clone(), values });
            }
        }
        varied
    }
    /// A list with another number of values than there are members: the parameter, and how many it has.
    pub fn list_that_does_not_fit(&self, count: usize) -> Option<(&str, usize)> {
        self.parameters.iter().find_map(|(name, given)| match given {
            Given::Drawn(distribution) => distribution.fits(count).err().map(|found| (name.as_str(), found)),
            Given::Value(_) => None,
        })
    }
    /// The values for a group of `count` members from the id `first` on, angles in radians.
    pub fn values(&self, count: usize, seed: u64, first: u32) -> swarm::parameters::Values {
        let descriptors = self.descriptors();
        let mut values = swarm::parameters::Values::new();
        for (name, given) in &self.parameters {
            let Some(descriptor) = descriptors.iter().find(|d| d.name == name) else { continue };
            let value = match given {
                Given::Value(value) => value.clone(),
                // those of a law that takes one for each member; the others make laws of their own
                Given::Drawn(_) if !matches!(descriptor.takes, Kind::PerAgent(_)) => continue,
                Given::Drawn(distribution) => Value::List(drawn(descriptor, distribution, count, seed, first)),
            };
            values.insert(name.clone(), if in_radians(descriptor) { radians(value) } else { value });
        }
        values
    }
}

/// The values of a parameter for so many members, in the units of the file.
fn drawn(descriptor: &Descriptor, distribution: &Distribution, count: usize, seed: u64, first: u32) -> Vec<Value> {
    let whole = matches!(&descriptor.takes, Kind::Whole);
    let of = |k| {
        let value = clamped(descriptor.range, distribution.of(seed, descriptor.name, first, k));
        Value::Number(if whole { value.round().max(0.0) } else { value })
    };
    (0..count as u32).map(of).collect()
}

/// A normal number between two ends, from a uniform one, by inversion.
fn truncated(draw: f64, mean: f64, deviation: f64, low: f64, high: f64) -> f64 {
    if deviation <= 0.0 {
        return mean.clamp(low, high);
    }
    let normal = |x: f64| normal((x - mean) / deviation);
    let (from, to) = (normal(low), normal(high));
    let wanted = from + (to - from) * draw;
    // the distribution function grows: halving finds the place to the last bit
    let (mut below, mut above) = (low, high);
    for _ in 0..100 {
        let middle = below + (above - below) / 2.0;
        if normal(middle) < wanted {
            below = middle;
        } else {
            above = middle;
        }
    }
    below + (above - below) / 2.0
}

fn clamped(range: Range, value: f64) -> f64 {
    match range {
        Range::Any => value,
        Range::NonNegative => value.max(0.0),
        Range::Positive => value.max(1e-9),
        Range::Within(low, high) => value.clamp(low, high),
    }
}

/// Whether the model computes it in radians, so that a file gives it in degrees.
pub fn in_radians(descriptor: &Descriptor) -> bool {
    descriptor.unit == "rad" || descriptor.unit.starts_with("rad/")
}

/// The unit of a parameter in a file.
pub fn unit_in_files(descriptor: &Descriptor) -> String {
    if in_radians(descriptor) { descriptor.unit.replacen("rad", "deg", 1) } else { descriptor.unit.to_owned() }
}

fn radians(value: Value) -> Value {
    match value {
        Value::Number(number) => Value::Number(number.to_radians()),
        Value::List(list) => Value::List(list.into_iter().map(radians).collect()),
        other => other,
    }
}

fn degrees(value: Value) -> Value {
    match value {
        Value::Number(number) => Value::Number(number.to_degrees()),
        Value::List(list) => Value::List(list.into_iter().map(degrees).collect()),
        other => other,
    }
}

/// The default of a parameter as a file would give it.
pub fn default_in_files(descriptor: &Descriptor) -> Value {
    let default = descriptor.default.clone();
    if in_radians(descriptor) { degrees(default) } else { default }
}

fn tree_of(value: &Value) -> Tree {
    match value {
        Value::Number(number) if number.fract() == 0.0 && number.abs() < 1e15 => Tree::Whole(*number as i64),
        Value::Number(number) => Tree::Number(*number),
        Value::Truth(truth) => Tree::Truth(*truth),
        Value::Text(text) => Tree::Text(text.clone()),
        Value::List(list) => Tree::list(list.iter().map(tree_of)),
        Value::Table(table) => Tree::table(table.iter().map(|(name, value)| (name.clone(), tree_of(value)))),
    }
}

fn value_of(tree: &Tree) -> Option<Value> {
    Some(match tree {
        Tree::Number(_) | Tree::Whole(_) => Value::Number(tree.number()?),
        Tree::Truth(truth) => Value::Truth(*truth),
        Tree::Text(text) => Value::Text(text.clone()),
        Tree::List(list) => Value::List(list.iter().map(|n| value_of(&n.tree)).collect::<Option<_>>()?),
        Tree::Table(_) => return None,
    })
}

impl Form for Model {
    fn read(node: &Node, rule: &Rule<'_>, desk: &mut Desk) -> Option<Self> {
        let (id, span, below) = match &node.tree {
            Tree::Text(id) => (id.as_str(), &node.span, None),
            Tree::Table(entries) => match entries.as_slice() {
                [one] => (one.key.as_str(), &one.span, Some(one)),
                [] => {
                    desk.problem(
                        &node.span,
                        "no model is named",
                        "the id of a model",
                        "`flockworks models` lists them",
                    );
                    return None;
                }
                [_, second, ..] => {
                    let what = format!("a group has one model; `{}` is a second one", second.key);
                    desk.problem(&second.span, what, "one model too many", "give it a group of its own");
                    return None;
                }
            },
            _ => {
                desk.kind(node, rule, "the id of a model");
                return None;
            }
        };
        let Some(entry) = models::find(id) else {
            let ids = models::LIST.iter().map(|e| e.card.id);
            let help = match nearest(id, ids) {
                Some(near) => format!("did you mean `{near}`?"),
                None => "`flockworks models` lists them".to_owned(),
            };
            desk.problem(span, format!("unknown model `{id}`"), "not the id of a model", help);
            return None;
        };
        let descriptors = (entry.parameters)();
        let (mut read, mut preset) = (Vec::new(), Vec::new());
        let mut fine = true;
        if let Some(one) = below {
            let entries = desk.table(&Node { tree: one.node.tree.clone(), span: place_of(one) }, rule)?.to_vec();
            let presets = (entry.presets)();
            let (named, entries): (Vec<_>, Vec<_>) =
                entries.into_iter().partition(|entry| entry.key == PRESET && !presets.is_empty());
            for entry in &named {
                match preset_of(presets, &entry.node, desk) {
                    Some(values) => preset.extend(values),
                    None => fine = false,
                }
            }
            for entry in &entries {
                match parameter(&descriptors, id, entry, desk) {
                    Some((name, _)) if read.iter().any(|(other, _)| *other == name) => {
                        let what = format!("`{}` is `{name}`, which is given already", entry.key);
                        desk.problem(&entry.span, what, "given twice", "leave one of them out");
                        fine = false;
                    }
                    Some(given) => read.push(given),
                    None => fine = false,
                }
            }
        }
        // what is given beside a set wins over it
        for (name, value) in preset {
            let Some(descriptor) = descriptors.iter().find(|d| d.name == *name) else { continue };
            if !read.iter().any(|(other, _)| other == name) {
                let value = if in_radians(descriptor) { degrees(value.clone()) } else { value.clone() };
                read.push(((*name).to_owned(), Given::Value(value)));
            }
        }
        fine.then(|| Self { id: id.to_owned(), parameters: read })
    }
    fn shape(_: &Rule<'_>) -> Shape {
        fn variants() -> Vec<Variant> {
            let variant = |entry: &models::Entry| {
                let mut fields: Vec<Field> = (entry.parameters)().iter().map(field_of_model).collect();
                let names = (entry.presets)().iter().map(|&(name, _)| (name, "")).collect::<Vec<_>>();
                if !names.is_empty() {
                    fields.push(Field {
                        name: PRESET.to_owned(),
                        alias: None,
                        about: "A set of parameters by its name; those that are given beside it win over it."
                            .to_owned(),
                        shape: Shape::Word(names),
                        unit: String::new(),
                        default: None,
                        required: false,
                    });
                }
                Variant { name: entry.card.id, about: entry.card.about, shape: Shape::Fields(fields) }
            };
            models::LIST.iter().map(variant).collect()
        }
        Shape::Tagged { name: "Model", about: "A model, by its id, with its parameters.", variants }
    }
    fn write(&self) -> Tree {
        let values = self.descriptors().into_iter().map(|descriptor| {
            let given = self.parameters.iter().find(|(name, _)| name == descriptor.name).map(|(_, given)| given);
            let tree = match given {
                Some(Given::Value(value)) => tree_of(value),
                Some(Given::Drawn(distribution)) => distribution.write(),
                None => tree_of(&default_in_files(&descriptor)),
            };
            (descriptor.name.to_owned(), tree)
        });
        Tree::table([(self.id.clone(), Tree::table(values))])
    }
}

/// The key of a set of parameters.
const PRESET: &str = "preset";

/// The values of a set of parameters, by its name.
fn preset_of(presets: &'static [Preset], node: &Node, desk: &mut Desk) -> Option<&'static [(&'static str, Value)]> {
    let names: Vec<&str> = presets.iter().map(|&(name, _)| name).collect();
    let Tree::Text(found) = &node.tree else {
        desk.kind(node, &Rule { name: PRESET, ..Rule::FREE }, "the name of a set of parameters");
        return None;
    };
    let values = presets.iter().find(|(name, _)| name == found).map(|&(_, values)| values);
    if values.is_none() {
        let help = match nearest(found, names.iter().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("there are {}", names.join(", ")),
        };
        desk.problem(&node.span, format!("no set of parameters `{found}`"), "not one of the model's sets", help);
    }
    values
}

fn parameter(
    descriptors: &[Descriptor],
    model: &str,
    entry: &crate::file::tree::Entry,
    desk: &mut Desk,
) -> Option<(String, Given)> {
    let key = entry.key.as_str();
    let Some(descriptor) = descriptors.iter().find(|d| d.name == key || d.alias == Some(key)) else {
        let sets_of = |id: &str| models::find(id).is_some_and(|entry| !(entry.presets)().is_empty());
        let names = descriptors.iter().flat_map(|d| [Some(d.name), d.alias].into_iter().flatten());
        let names = names.chain(sets_of(model).then_some(PRESET));
        let help = match nearest(key, names) {
            // it has none, or it would have been taken
            None if key == PRESET => {
                let have = models::LIST.iter().map(|entry| entry.card.id).filter(|id| sets_of(id)).collect::<Vec<_>>();
                format!("it has no sets of parameters; models that have some: {}", have.join(", "))
            }
            Some(near) => format!("did you mean `{near}`?"),
            None => {
                let verb = if terms::find(model).is_some() { "terms" } else { "models" };
                format!("`flockworks {verb} {model}` lists its parameters")
            }
        };
        desk.problem(&entry.span, format!("`{model}` has no parameter `{key}`"), "not one of its parameters", help);
        return None;
    };
    let rule = Rule { name: key, unit: "", range: descriptor.range };
    if descriptor.takes == Kind::Terms {
        return Some((descriptor.name.to_owned(), Given::Value(terms(&entry.node, &rule, desk)?)));
    }
    // terms of a composition are the same for all
    let per_agent = match &descriptor.takes {
        Kind::PerAgent(one) => matches!(**one, Kind::Number),
        Kind::Number | Kind::Whole => models::find(model).is_some(),
        _ => false,
    };
    if let Tree::Table(_) = entry.node.tree {
        if !per_agent {
            let what = format!("`{key}` takes {}, found a table", descriptor.takes);
            desk.problem(&place_of(entry), what, format!("expected {}", descriptor.takes), "");
            return None;
        }
        let drawn = Distribution::read(&entry.node, &rule, desk)?.checked(&entry.node.span, desk)?;
        return Some((descriptor.name.to_owned(), Given::Drawn(drawn)));
    }
    let Some(value) = value_of(&entry.node.tree) else {
        let what = format!("`{key}` takes {}, found a table in it", descriptor.takes);
        desk.problem(&entry.node.span, what, format!("expected {}", descriptor.takes), "");
        return None;
    };
    let asked = if in_radians(descriptor) { radians(value.clone()) } else { value.clone() };
    match (descriptor.check)(descriptor, &asked) {
        Ok(()) => Some((descriptor.name.to_owned(), Given::Value(value))),
        Err(error) => {
            let (expected, found) = match &error {
                ParameterError::Type { expected, .. } => (format!("takes {expected}"), entry.node.tree.describe()),
                ParameterError::Range { expected, found, .. } => (format!("must be {expected}"), found.clone()),
                other => (other.to_string(), entry.node.tree.describe()),
            };
            let found = if in_radians(descriptor) { entry.node.tree.describe() } else { found };
            let what = format!("`{key}` {expected}, found {found}");
            let unit = unit_in_files(descriptor);
            let unit = if unit == "1" || unit == "-" { String::new() } else { format!(", in {unit}") };
            desk.problem(&entry.node.span, what, format!("{expected}{unit}"), "");
            None
        }
    }
}

/// The stock terms of a composition, each with all its parameters.
fn terms(node: &Node, rule: &Rule<'_>, desk: &mut Desk) -> Option<Value> {
    let Tree::List(list) = &node.tree else {
        desk.kind(node, rule, "a list of stock terms");
        return None;
    };
    if list.is_empty() {
        let help = "`flockworks terms` lists them";
        desk.problem(&node.span, "a composition needs at least one term", "an empty list", help);
        return None;
    }
    let ids: Vec<&str> = terms::LIST.iter().map(|entry| entry.card.id).collect();
    let one = |node: &Node, desk: &mut Desk| {
        let (id, below) = choice(node, &Rule { name: "a term", ..*rule }, &ids, desk)?;
        let descriptors = terms::find(id)?.parameters();
        let mut values: Values = descriptors.iter().map(|d| (d.name.to_owned(), default_in_files(d))).collect();
        let mut fine = true;
        for entry in desk.table(&below, rule)? {
            match parameter(&descriptors, id, entry, desk) {
                Some((name, Given::Value(value))) => drop(values.insert(name, value)),
                _ => fine = false,
            }
        }
        fine.then(|| Value::Table(Values::from([(id.to_owned(), Value::Table(values))])))
    };
    // every term is read, so that every problem is found
    let read: Vec<Option<Value>> = list.iter().map(|node| one(node, desk)).collect();
    read.into_iter().collect::<Option<_>>().map(Value::List)
}

/// A parameter of a model as a key of a file: numbers may be drawn for each member.
fn field_of_model(descriptor: &Descriptor) -> Field {
    let mut field = field(descriptor);
    if matches!(descriptor.takes, Kind::Number | Kind::Whole) {
        field.shape = Shape::Either(vec![field.shape, Distribution::shape(&Rule::FREE)]);
    }
    field
}

/// A parameter as a key of a file.
fn field(descriptor: &Descriptor) -> Field {
    Field {
        name: descriptor.name.to_owned(),
        alias: descriptor.alias,
        about: descriptor.about.trim().to_owned(),
        shape: shape_of(&descriptor.takes, descriptor.range),
        unit: unit_in_files(descriptor),
        default: Some(tree_of(&default_in_files(descriptor))),
        required: false,
    }
}

fn shape_of(kind: &Kind, range: Range) -> Shape {
    let number = Shape::Number { unit: "", range };
    match kind {
        Kind::Number => number,
        Kind::Whole => Shape::Whole { unit: "", range },
        Kind::Truth => Shape::Truth,
        Kind::Word(words) => Shape::Word(words.iter().map(|&word| (word, "")).collect()),
        Kind::List(entry) => Shape::List(Box::new(shape_of(entry, range))),
        Kind::PerAgent(one) => {
            let one = shape_of(one, range);
            let mut either = vec![one.clone(), Shape::List(Box::new(one))];
            if matches!(kind, Kind::PerAgent(one) if matches!(**one, Kind::Number)) {
                either.push(Distribution::shape(&Rule::FREE));
            }
            Shape::Either(either)
        }
        Kind::Points => {
            let point = Shape::List(Box::new(number));
            Shape::Either(vec![point.clone(), Shape::List(Box::new(point))])
        }
        Kind::Name => Shape::Text,
        Kind::Terms => {
            fn variants() -> Vec<Variant> {
                let variant = |entry: &terms::Entry| {
                    let fields = entry.parameters().iter().map(field).collect();
                    Variant { name: entry.card.id, about: entry.card.about, shape: Shape::Fields(fields) }
                };
                terms::LIST.iter().map(variant).collect()
            }
            let about = "A stock term, by its id, with its parameters.";
            Shape::List(Box::new(Shape::Tagged { name: "Term", about, variants }))
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use crate::scenario::build;

    const FILE: &str = r#"
kind = "scenario"
title = "Two beside a wall"
time.duration = 4
[space]
dimensions = 2
edges = "walls"
size = 20
[[obstacle]]
shape.segment = { from = [10, 2], to = [10, 18] }
[group.boids]
count = 2
start = { place.points = [[9, 10], [11, 10]] }
model.control_boids = { preset = "field-mill", alignment = 2 }
"#;

    #[test]
    fn a_named_set_fills_in_what_is_not_given() {
        let read = build::read("file", FILE, &[]).unwrap();
        let model = &read.scenario.group.0[0].1.model;
        let values = model.values(2, 1, 0);
        let of = |name: &str| values.get(name).unwrap().clone();
        assert_eq!([of("alignment"), of("cohesion"), of("radius")], [2.0, 2.0, 25.0].map(Into::into));
        for (wrong, says) in [("\"field-mil\"", "did you mean `field-mill`?"), ("3", "the name of a set")] {
            let text = FILE.replace("\"field-mill\"", wrong);
            let problems = build::read("file", &text, &[]).unwrap_err().to_string();
            assert!(problems.contains(says), "{problems}");
        }
        let none = FILE.replace("control_boids", "control_snn").replace(", alignment = 2", "");
        let problems = build::read("file", &none, &[]).unwrap_err().to_string();
        assert!(problems.contains("it has no sets of parameters; models that have some: control_boids"), "{problems}");
        let misspelt = FILE.replace("preset =", "presset =");
        let problems = build::read("file", &misspelt, &[]).unwrap_err().to_string();
        assert!(problems.contains("did you mean `preset`?"), "{problems}");
    }

    #[test]
    fn control_models_look_through_walls_only_where_a_file_says_so() {
        let seen = |text: &str| {
            let read = build::read("file", text, &[]).unwrap();
            build::world::<f64, 2>(&read.scenario, 5, 1).unwrap().explain(0).unwrap().detected.len()
        };
        assert_eq!(seen(FILE), 0);
        assert_eq!(seen(&FILE.replace("count = 2", "count = 2\nsensing.ideal = {}")), 1);
        assert_eq!(seen(&FILE.replace("from = [10, 2]", "from = [10, 12]")), 1);
    }
}
