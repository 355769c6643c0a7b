//! Statements, asked of the data.
//!
//! A statement is an expression over means of cells. How sure its verdict is comes from drawing the trials again, with
//! replacement (the bootstrap): since every cell has the same seeds, the same trials are drawn for all cells at once. It
//! holds where it is true of nearly every such drawing, it does not hold where it is true of nearly none, and else the
//! trials are too few to judge. A statement about the very trials that were made needs no drawings.

use super::execute::Results;
use super::expression::{Expression, Mistake, Names, Selector, Value};
use super::form::{Claim, Figure, Test};
use super::plan::{self, Part, Plan, within};
use super::tables::{RESERVED, of_cell};
use crate::file::{Anything, Desk, Named, Node, Sources, Tree};
use crate::report::short;
use core::cell::{Cell, RefCell};
use core::ops::Range;
use space::random::{Purpose, uniform};
use space::spelling::nearest;
use std::collections::HashMap;
use std::rc::Rc;

/// Times that the trials are drawn again.
pub(super) const DRAWINGS: usize = 2000;
/// What an interval leaves out on each side.
const OUTSIDE: f64 = 0.025;

/// What the data say of a statement.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// It holds.
    Holds,
    /// It does not hold.
    DoesNotHold,
    /// It cannot be judged, for this reason.
    CannotBeJudged(String),
    /// Its numbers are reported; nothing was said of when it holds.
    Reported,
}

impl Verdict {
    /// In words.
    pub fn words(&self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::DoesNotHold => "does not hold",
            Self::CannotBeJudged(_) => "cannot be judged",
            Self::Reported => "reported only",
        }
    }
}

/// A statement with what came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// The number that belongs to it, or several.
    pub number: Vec<f64>,
    /// The 95 % interval of each.
    pub interval: Vec<(f64, f64)>,
    /// What the data say.
    pub verdict: Verdict,
    /// Share of the drawings in which it is true.
    pub share: Option<f64>,
}

/// A statement of a study beside what came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Judgement {
    /// The part that makes it; empty where there is one part, or where it is about several.
    pub part: String,
    /// The statement.
    pub claim: Claim,
    /// What came of it.
    pub judged: Judged,
}

/// The cells of a part that have given levels, by index.
pub fn matching(plan: &Plan, part: &Part, only: &[(String, Level)]) -> Vec<usize> {
    let fits = |&cell: &usize| {
        only.iter().all(|(name, level)| {
            part.factors
                .iter()
                .position(|factor| factor.name == *name)
                .is_some_and(|at| level.is(&part.factors[at].levels[plan.cells[cell].levels[at]]))
        })
    };
    part.cells.clone().filter(fits).collect()
}

/// A level as it is asked for.
#[derive(Clone, Debug, PartialEq)]
pub enum Level {
    /// A number.
    Number(f64),
    /// A word.
    Text(String),
}

impl Level {
    /// Whether a level of a factor is the one asked for.
    pub fn is(&self, own: &plan::Level) -> bool {
        match self {
            Self::Number(number) => own.number == Some(*number),
            Self::Text(text) => own.text == *text,
        }
    }
    /// As a page has it.
    pub fn words(&self) -> String {
        match self {
            Self::Number(number) => short(*number),
            Self::Text(text) => text.clone(),
        }
    }
}

/// The levels that a table of a file asks for.
pub fn asked(only: &Named<Anything>) -> Vec<(String, Level)> {
    let level = |(name, value): &(String, Anything)| {
        let level = match &value.0.tree {
            Tree::Text(text) => Level::Text(text.clone()),
            tree => tree.number().map_or_else(|| Level::Text(tree.describe()), Level::Number),
        };
        (name.clone(), level)
    };
    only.0.iter().map(level).collect()
}

/// Where the values of expressions come from.
struct Data<'a> {
    plan: &'a Plan,
    part: &'a Part,
    /// The mean of a reading in a cell; none where there is none.
    mean: &'a dyn Fn(usize, usize) -> Option<f64>,
}

impl Names for Data<'_> {
    fn judges(&self) -> bool {
        true
    }
    fn value(&self, name: &str, selectors: &[Selector], bytes: &Range<usize>) -> Result<Value, Mistake> {
        // a name of another part has the part before it: exp1.coverage
        if let Some((part, below)) = name.split_once('.')
            && let Some(part) = self.plan.parts.iter().find(|own| own.name == part)
        {
            return Data { part, ..*self }.value(below, selectors, bytes);
        }
        let factor = |name: &str| self.part.factors.iter().position(|factor| factor.name == name);
        let reading = self.plan.readings.iter().position(|(own, _)| own == name);
        let known = || {
            let readings = self.plan.readings.iter().map(|(name, _)| name.as_str());
            readings.chain(self.part.factors.iter().map(|factor| factor.name.as_str()))
        };
        if reading.is_none() && factor(name).is_none() {
            let near = nearest(name, known());
            let help = near.map_or_else(
                || format!("known here: {}", known().collect::<Vec<_>>().join(", ")),
                |near| format!("did you mean `{near}`?"),
            );
            return Err(Mistake {
                help,
                ..Mistake::new(bytes.clone(), format!("no reading and no factor is called `{name}`"))
            });
        }
        let mut only = Vec::new();
        for selector in selectors {
            let Some(at) = factor(&selector.factor) else {
                let names = self.part.factors.iter().map(|factor| factor.name.as_str());
                let near = nearest(&selector.factor, names);
                let help = near.map_or_else(String::new, |near| format!("did you mean `{near}`?"));
                let what = format!("no factor is called `{}`", selector.factor);
                return Err(Mistake { help, ..Mistake::new(selector.bytes.clone(), what) });
            };
            let level = match &selector.level {
                Value::Number(number) => Level::Number(*number),
                Value::Text(text) => Level::Text(text.clone()),
                other => Level::Text(other.describe()),
            };
            let own = &self.part.factors[at].levels;
            if !own.iter().any(|own| level.is(own)) {
                let levels: Vec<&str> = own.iter().map(|level| level.text.as_str()).collect();
                let what = format!("`{}` has no such level", selector.factor);
                let help = format!("it has {}", levels.join(", "));
                return Err(Mistake { help, ..Mistake::new(selector.bytes.clone(), what) });
            }
            only.push((selector.factor.clone(), level));
        }
        let cells = matching(self.plan, self.part, &only);
        let of = |&cell: &usize| match (reading, factor(name)) {
            (Some(reading), _) => (self.mean)(cell, reading).map(Value::Number).ok_or_else(|| {
                let what = format!("`{name}` has no value in the cell {}", self.plan.name_of(&self.plan.cells[cell]));
                Mistake::new(bytes.clone(), what)
            }),
            (None, at) => {
                let at = at.unwrap_or(0);
                let level = &self.part.factors[at].levels[self.plan.cells[cell].levels[at]];
                Ok(level.number.map_or_else(|| Value::Text(level.text.clone()), Value::Number))
            }
        };
        match cells.as_slice() {
            [] => Err(Mistake::new(bytes.clone(), "no cell has these levels together")),
            [one] => of(one),
            cells => cells.iter().map(of).collect::<Result<_, _>>().map(Value::List),
        }
    }
}

/// Notes what is wrong with the names, figures, tests and statements of a part.
pub(crate) fn check(plan: &Plan, part: usize, tree: &Node, sources: &Sources, desk: &mut Desk) {
    let part = &plan.parts[part];
    names_are_free(plan, part, tree, desk);
    let readings: Vec<&str> = plan.readings.iter().map(|(name, _)| name.as_str()).collect();
    let factors: Vec<&str> = part.factors.iter().map(|factor| factor.name.as_str()).collect();
    let mut known = |what: &str, name: &str, among: &[&str], place: String| {
        if !among.contains(&name) {
            let help = nearest(name, among.iter().copied())
                .map_or_else(|| format!("there is {}", among.join(", ")), |near| format!("did you mean `{near}`?"));
            desk.problem(&tree.place(&place), format!("no {what} is called `{name}`"), "not known", help);
        }
    };
    for (k, Figure { y, x, lines, only, .. }) in part.figures.iter().enumerate() {
        for (n, name) in y.iter().enumerate() {
            known("reading", name, &readings, format!("figure.{k}.y.{n}"));
        }
        known("factor", x, &factors, format!("figure.{k}.x"));
        if let Some(lines) = lines {
            known("factor", lines, &factors, format!("figure.{k}.lines"));
        }
        only.0.iter().for_each(|(name, _)| known("factor", name, &factors, format!("figure.{k}.only.{name}")));
    }
    for (k, Test { y, between, only, each }) in part.tests.iter().enumerate() {
        known("reading", y, &readings, format!("test.{k}.y"));
        known("factor", between, &factors, format!("test.{k}.between"));
        only.0.iter().for_each(|(name, _)| known("factor", name, &factors, format!("test.{k}.only.{name}")));
        for (n, name) in each.iter().enumerate() {
            known("factor", name, &factors, format!("test.{k}.each.{n}"));
        }
    }
    check_claims(plan, part, &part.claims, tree, sources, desk);
}

/// Notes what is wrong with statements.
pub(super) fn check_claims(
    plan: &Plan,
    part: &Part,
    claims: &[Claim],
    tree: &Node,
    sources: &Sources,
    desk: &mut Desk,
) {
    // with any numbers, an expression must have a value
    let any = |_: usize, _: usize| Some(1.0);
    let data = Data { plan, part, mean: &any };
    for (k, claim) in claims.iter().enumerate() {
        for (key, text, truth) in [("number", &claim.number, false), ("holds", &claim.holds, true)] {
            let Some(text) = text else { continue };
            let value = Expression::parse(text).and_then(|expression| {
                let value = expression.value(&data)?;
                let fits = if truth { value.truth().is_some() } else { numbers(&value).is_some() };
                let wanted = if truth { "true or false" } else { "a number" };
                let what = || format!("`{key}` must give {wanted}, found {}", value.describe());
                if fits { Ok(()) } else { Err(Mistake::new(0..text.len(), what())) }
            });
            if let Err(mistake) = value
                && !mistake.of_numbers
            {
                let place = within(sources, &tree.place(&format!("claim.{k}.{key}")), &mistake.bytes);
                desk.problem(&place, format!("`{}`: {}", claim.id, mistake.what), "", mistake.help);
            }
        }
    }
}

/// Names are used in expressions and as names of columns.
fn names_are_free(plan: &Plan, part: &Part, tree: &Node, desk: &mut Desk) {
    let word = |name: &str| {
        name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
            && name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
    };
    let factors = part.factors.iter().map(|factor| ("factor", factor.name.as_str()));
    let readings = plan.readings.iter().map(|(name, _)| ("reading", name.as_str()));
    let mut seen: Vec<&str> = Vec::new();
    for (key, name) in factors.chain(readings) {
        let place = super::plan::entry_place(tree, key, name);
        if !word(name) {
            desk.problem(&place, format!("`{name}` cannot be a name"), "names have letters, digits and `_`", "");
        } else if RESERVED.contains(&name) {
            let what = format!("a column of the tables is called `{name}` already");
            desk.problem(&place, what, "another name", "");
        } else if seen.contains(&name) {
            desk.problem(&place, format!("`{name}` is both a factor and a reading"), "another name", "");
        }
        seen.push(name);
    }
}

fn numbers(value: &Value) -> Option<Vec<f64>> {
    match value {
        Value::Number(number) => Some(vec![*number]),
        Value::List(list) => list.iter().map(Value::number).collect(),
        _ => None,
    }
}

/// The drawings of the trials of a study: how often each trial is in each.
#[derive(Clone, Debug)]
pub struct Drawings {
    /// `[drawings][trials]`.
    counts: Vec<Vec<f64>>,
}

impl Drawings {
    /// Of so many trials.
    pub fn of(seed: u64, trials: usize) -> Self {
        let drawing = |k: usize| {
            let mut counts = vec![0.0; trials];
            for n in 0..trials {
                let drawn = (uniform(seed, Purpose::Search, k as u64, n as u32) * trials as f64) as usize;
                counts[drawn.min(trials - 1)] += 1.0;
            }
            counts
        };
        Self { counts: (0..DRAWINGS).map(drawing).collect() }
    }
}

/// What an expression comes to; none where there is no expression.
fn evaluated(expression: &Option<Result<Expression, Mistake>>, data: &Data<'_>) -> Option<Result<Value, Mistake>> {
    let expression = expression.as_ref()?.as_ref();
    Some(expression.map_err(Clone::clone).and_then(|expression| expression.value(data)))
}

/// Judges a statement of a part.
pub fn judge(plan: &Plan, results: &Results, part: &Part, claim: &Claim, drawings: &Drawings) -> Judged {
    // what a reading is in the trials of a cell; each is asked for once a drawing
    let columns: RefCell<HashMap<(usize, usize), Rc<[(usize, f64)]>>> = RefCell::default();
    let values = |cell: usize, reading: usize| {
        let made = || of_cell(plan, results, cell).map(|(trial, values)| (trial, values[reading]));
        let mut columns = columns.borrow_mut();
        Rc::clone(columns.entry((cell, reading)).or_insert_with(|| made().filter(|(_, v)| v.is_finite()).collect()))
    };
    // the trials of the cell, of those it is about, that has fewest
    let fewest = Cell::new(usize::MAX);
    let mean = |cell: usize, reading: usize| {
        let values = values(cell, reading);
        fewest.set(fewest.get().min(values.len()));
        let (sum, count) = values.iter().fold((0.0, 0.0), |(sum, count), (_, v)| (sum + v, count + 1.0));
        (count > 0.0).then(|| sum / count)
    };
    let data = Data { plan, part, mean: &mean };
    let parsed = |text: &Option<String>| text.as_ref().map(|text| Expression::parse(text));
    let (number_of, holds) = (parsed(&claim.number), parsed(&claim.holds));
    let number = match evaluated(&number_of, &data) {
        Some(Ok(value)) => numbers(&value).unwrap_or_default(),
        _ => Vec::new(),
    };
    let truth = evaluated(&holds, &data).map(|value| match value {
        Ok(value) => value.truth().ok_or_else(|| "it is neither true nor false".to_owned()),
        Err(mistake) => Err(mistake.what),
    });
    let (mut drawn, mut told, mut held) = (vec![Vec::new(); number.len()], 0.0, 0.0);
    for counts in drawings.counts.iter().filter(|_| !claim.exact) {
        let mean = |cell: usize, reading: usize| {
            let (mut sum, mut count) = (0.0, 0.0);
            for &(trial, v) in values(cell, reading).iter() {
                let weight = counts.get(trial - 1).copied().unwrap_or(0.0);
                sum += v * weight;
                count += weight;
            }
            if count > 0.0 { Some(sum / count) } else { mean(cell, reading) }
        };
        let data = Data { plan, part, mean: &mean };
        if let Some(Ok(value)) = evaluated(&number_of, &data) {
            numbers(&value).unwrap_or_default().into_iter().zip(&mut drawn).for_each(|(x, list)| list.push(x));
        }
        if let Some(Ok(value)) = evaluated(&holds, &data)
            && let Some(truth) = value.truth()
        {
            told += 1.0;
            held += if truth { 1.0 } else { 0.0 };
        }
    }
    // drawings in which it is neither true nor false say nothing
    let all = drawings.counts.len() as f64;
    let share = if told > 0.0 { held / told } else { 0.0 };
    let verdict = match truth {
        None => Verdict::Reported,
        Some(Err(what)) => Verdict::CannotBeJudged(what),
        Some(Ok(true)) if claim.exact => Verdict::Holds,
        Some(Ok(false)) if claim.exact => Verdict::DoesNotHold,
        Some(Ok(_)) if fewest.get() < 2 => {
            Verdict::CannotBeJudged("a single trial says nothing of how sure it is".to_owned())
        }
        Some(Ok(_)) if told < all * (1.0 - claim.doubt) => {
            let silent = 100.0 * (1.0 - told / all);
            Verdict::CannotBeJudged(format!("it has no value in {silent:.0} % of the drawings"))
        }
        Some(Ok(true)) if share >= 1.0 - claim.doubt => Verdict::Holds,
        Some(Ok(false)) if share <= claim.doubt => Verdict::DoesNotHold,
        Some(Ok(truth)) => {
            let is = if truth { "true" } else { "false" };
            let what = format!("{is} of the means, but true in {:.0} % of the drawings", 100.0 * share);
            Verdict::CannotBeJudged(what)
        }
    };
    let judged = claim.holds.is_some() && !claim.exact && told > 0.0;
    let interval = if claim.exact { Vec::new() } else { drawn.iter_mut().map(middle).collect() };
    Judged { number, interval, verdict, share: judged.then_some(share) }
}

/// The middle 95 % of numbers.
fn middle(numbers: &mut Vec<f64>) -> (f64, f64) {
    numbers.retain(|x| x.is_finite());
    numbers.sort_by(f64::total_cmp);
    let at = |share: f64| {
        let place = ((numbers.len() as f64 - 1.0) * share).round().max(0.0) as usize;
        numbers.get(place).copied().unwrap_or(f64::NAN)
    };
    (at(OUTSIDE), at(1.0 - OUTSIDE))
}
