//! Statements about what was found, beside what was published. A statement is an expression; where it rests on items that
//! were drawn (environments), the items are drawn again with replacement (the bootstrap), and it holds where it is true of
//! nearly every such drawing, does not hold where it is true of nearly none, and else cannot be judged.

use crate::file::{Desk, Node};
use crate::report::short;
use crate::study::claims::Verdict;
use crate::study::expression::{Expression, Mistake, Names, Selector, Value};
use crate::study::form::{Claim, Strength};
use core::ops::Range;
use space::random::{Purpose, uniform};
use space::spelling::nearest;

/// Times that the items are drawn again.
const DRAWINGS: usize = 400;
/// Share of the drawings that may disagree.
const DOUBT: f64 = 0.025;

/// What helps whoever wrote a name that is not there: the nearest that is, or all.
pub fn hint(name: &str, known: &[&str]) -> String {
    match nearest(name, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("known here: {}", known.join(", ")),
    }
}

/// Checks that a name is among those (with what they mean) that `teller`, a kind of files with its article, tells.
///
/// # Errors
/// The name, with what helps.
pub fn known(name: &str, names: &[(&str, &str)], bytes: &Range<usize>, teller: &str) -> Result<(), Mistake> {
    let known: Vec<&str> = names.iter().map(|(name, _)| *name).collect();
    if known.contains(&name) {
        return Ok(());
    }
    let what = format!("`{name}` is nothing that {teller} tells");
    Err(Mistake { help: hint(name, &known), ..Mistake::new(bytes.clone(), what) })
}

/// What statements are about.
pub trait Data {
    /// Number of items that are drawn again; 0 where what is there is all there is.
    fn items(&self) -> usize;
    /// The value of a name among the items drawn (by their places); none: each once.
    ///
    /// # Errors
    /// A name that is not known, or conditions that nothing fulfils.
    fn value(
        &self,
        name: &str,
        selectors: &[Selector],
        bytes: &Range<usize>,
        drawn: Option<&[usize]>,
    ) -> Result<Value, Mistake>;
}

struct Drawn<'a> {
    data: &'a dyn Data,
    items: Option<&'a [usize]>,
}

impl Names for Drawn<'_> {
    fn value(&self, name: &str, selectors: &[Selector], bytes: &Range<usize>) -> Result<Value, Mistake> {
        self.data.value(name, selectors, bytes, self.items)
    }
}

/// A statement with what came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// The number that belongs to it.
    pub number: Option<f64>,
    /// Its 95 % interval over drawings.
    pub interval: Option<(f64, f64)>,
    /// What the data say; none where the statement is a number alone.
    pub verdict: Option<Verdict>,
}

/// Judges a statement.
pub fn judge(claim: &Claim, data: &dyn Data, seed: u64) -> Judged {
    let parsed = |text: &Option<String>| text.as_deref().and_then(|text| Expression::parse(text).ok());
    let (number, holds) = (parsed(&claim.number), parsed(&claim.holds));
    let all = Drawn { data, items: None };
    let of = |expression: &Expression, names: &Drawn<'_>| expression.value(names).ok();
    let value = number.as_ref().and_then(|number| of(number, &all)).and_then(|value| value.number());
    let value = value.filter(|value| value.is_finite());
    let items = data.items();
    let drawing = |k: usize| -> Vec<usize> {
        let place = |j: usize| uniform(seed, Purpose::Resampling, k as u64, j as u32) * items as f64;
        (0..items).map(|j| (place(j) as usize).min(items - 1)).collect()
    };
    let drawings: Vec<Vec<usize>> = if items > 1 { (0..DRAWINGS).map(drawing).collect() } else { Vec::new() };
    let mut numbers: Vec<f64> = Vec::new();
    let (mut held, mut judged) = (0usize, 0usize);
    for items in &drawings {
        let names = Drawn { data, items: Some(items) };
        numbers.extend(number.as_ref().and_then(|number| of(number, &names)).and_then(|value| value.number()));
        if let Some(truth) = holds.as_ref().and_then(|holds| of(holds, &names)).and_then(|value| value.truth()) {
            judged += 1;
            held += usize::from(truth);
        }
    }
    numbers.retain(|number| number.is_finite());
    numbers.sort_by(f64::total_cmp);
    let at = |share: f64| numbers.get(((numbers.len() as f64 - 1.0) * share).round() as usize).copied();
    let interval = if numbers.len() >= DRAWINGS / 2 { at(0.025).zip(at(0.975)) } else { None };
    let truth = holds.as_ref().and_then(|holds| of(holds, &all)).and_then(|value| value.truth());
    let verdict = holds.as_ref().map(|_| match truth {
        None => Verdict::CannotBeJudged("there is no value".to_owned()),
        Some(truth) if judged == 0 => {
            if truth {
                Verdict::Holds
            } else {
                Verdict::DoesNotHold
            }
        }
        Some(truth) => {
            let share = held as f64 / judged as f64;
            if truth && share >= 1.0 - DOUBT {
                Verdict::Holds
            } else if !truth && share <= DOUBT {
                Verdict::DoesNotHold
            } else {
                let words = if truth { "true here" } else { "not true here" };
                Verdict::CannotBeJudged(format!("{words}, true in {:.0} % of drawings", share * 100.0))
            }
        }
    });
    Judged { number: value, interval, verdict }
}

/// Whether the expressions of statements can be read and have values; what is wrong goes to the desk. `path` is that of the list.
pub fn check(claims: &[Claim], data: &dyn Data, path: &str, tree: &Node, desk: &mut Desk) {
    for (k, claim) in claims.iter().enumerate() {
        for (key, text) in [("number", &claim.number), ("holds", &claim.holds)] {
            let Some(text) = text else { continue };
            let read = Expression::parse(text).and_then(|read| read.value(&Drawn { data, items: None }));
            let wrong = match (&read, key) {
                (Err(mistake), _) => Some((mistake.what.clone(), mistake.help.clone())),
                (Ok(value), "holds") if value.truth().is_none() => {
                    Some((format!("it gives {}, neither true nor false", value.describe()), String::new()))
                }
                (Ok(value), "number") if value.number().is_none() => {
                    Some((format!("it gives {}, no number", value.describe()), String::new()))
                }
                _ => None,
            };
            if let Some((what, help)) = wrong {
                desk.problem(&tree.place(&format!("{path}.{k}.{key}")), what, "", help);
            }
        }
    }
}

/// The rows of a table of statements: name, statement, where it is made, published, obtained, class, verdict.
pub fn rows(claims: &[Claim], data: &dyn Data, seed: u64) -> Vec<Vec<String>> {
    let row = |claim: &Claim| {
        let judged = judge(claim, data, seed);
        let obtained = match (judged.number, judged.interval) {
            (None, _) => String::new(),
            (Some(number), None) => short(number),
            (Some(number), Some((low, high))) => format!("{} ({} to {})", short(number), short(low), short(high)),
        };
        let verdict = match judged.verdict {
            None => "reported".to_owned(),
            Some(Verdict::CannotBeJudged(why)) => format!("cannot be judged: {why}"),
            Some(verdict) => verdict.words().to_owned(),
        };
        let class = match claim.strength {
            Strength::A => "gate",
            Strength::B => "expected",
            Strength::C => "report",
        };
        let texts = [&claim.id, &claim.text, &claim.source, &claim.published];
        texts.into_iter().cloned().chain([obtained, class.to_owned(), verdict]).collect()
    };
    claims.iter().map(row).collect()
}

/// A row of [`rows`] as a line for a terminal: name, verdict, and the number where there is one.
pub fn line(row: &[String]) -> String {
    let word = |k: usize| row.get(k).map_or("", String::as_str);
    let number = if word(4).is_empty() { String::new() } else { format!(" [{}]", word(4)) };
    format!("{}: {}{number}", word(0), word(6))
}

/// The header of [`rows`].
pub fn header() -> Vec<String> {
    ["id", "statement", "source", "published", "obtained (95 %)", "class", "verdict"].map(str::to_owned).to_vec()
}
