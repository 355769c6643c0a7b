//! What came of an optimisation, and the names by which statements ask for it.

use super::form::Search;
use super::plan::Plan;
use super::trials::Found;
use crate::environment::claims::{Data, hint, known};
use crate::study::expression::{Mistake, Selector, Value};
use core::ops::Range;
use search::elites::Elite;
use terrain::Construct;

/// A run of a method.
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// Its candidates and what was found of them, in their order.
    pub evaluations: Vec<(Vec<f64>, Found)>,
    /// Places at which generations begin: candidates of one meet in the same trials.
    pub begins: Vec<usize>,
    /// Places of the candidates that were tried again, the best score first, with what was found then.
    pub finalists: Vec<(usize, Found)>,
    /// The place of its best, and what new trials found.
    pub best: Option<(usize, Found)>,
    /// The best of every kind, where kinds are told apart.
    pub elites: Vec<Elite>,
}

impl Run {
    /// The generation of a candidate.
    pub fn generation(&self, place: usize) -> usize {
        self.begins.partition_point(|&begin| begin <= place).saturating_sub(1)
    }
    /// The candidate that was the best.
    pub fn point(&self) -> Option<&[f64]> {
        self.best.map(|(place, _)| self.evaluations[place].0.as_slice())
    }
}

/// A construct that was made lighter.
#[derive(Clone, Debug)]
pub struct Lighter {
    /// What it was, and what was found of it.
    pub before: (Construct, Found),
    /// What it became.
    pub after: (Construct, Found),
    /// Lighter ones that were tried.
    pub tried: usize,
}

/// The results.
pub struct Results<'a> {
    /// The plan.
    pub plan: &'a Plan,
    /// The runs, `[methods][runs]`.
    pub runs: Vec<Vec<Run>>,
    /// What was found without a construct; none where nobody asked.
    pub control: Option<Found>,
    /// The best construct, made lighter.
    pub lighter: Option<Lighter>,
}

impl<'a> Results<'a> {
    /// Results of one made-up candidate, to find out whether statements have a meaning.
    pub(super) fn example(plan: &'a Plan) -> Self {
        let found = Found { score: 1.0, successes: 1, trials: 1, fitness: 1.0, steps: 1.0, material: 1.0, pieces: 1 };
        let point = plan.domain.lows();
        let run = Run {
            evaluations: vec![(point, found)],
            begins: vec![0],
            finalists: vec![(0, found)],
            best: Some((0, found)),
            elites: Vec::new(),
        };
        let none = Construct::new(plan.workspace.workspace.units, Vec::new());
        let lighter = Lighter { before: (none.clone(), found), after: (none, found), tried: 1 };
        let runs = vec![vec![run; plan.runs]; plan.form.method.0.len()];
        Self { plan, runs, control: Some(found), lighter: Some(lighter) }
    }
    /// Method and run of the best of all by its new trials; of equals the first.
    pub fn best(&self) -> Option<(usize, usize)> {
        let all = self.runs.iter().enumerate().flat_map(|(method, runs)| {
            runs.iter().enumerate().filter_map(move |(run, own)| Some(((method, run), own.best?.1.score)))
        });
        all.reduce(|best, other| if other.1 > best.1 { other } else { best }).map(|(at, _)| at)
    }
    /// What new trials found of the best of runs, each as often as it was drawn.
    pub fn bests(&self, method: usize, drawn: Option<&[usize]>) -> Vec<Found> {
        let of = |run: usize| self.runs[method].get(run).and_then(|run| run.best).map(|(_, found)| found);
        match drawn {
            Some(drawn) => drawn.iter().filter_map(|&run| of(run)).collect(),
            None => (0..self.runs[method].len()).filter_map(of).collect(),
        }
    }
    /// Kinds reached by runs of an archive, and the sum of their scores; none of another method.
    pub fn archive(&self, method: usize, drawn: Option<&[usize]>) -> Option<(f64, f64)> {
        let Search::MapElites(_) = self.plan.form.method.0[method].1 else { return None };
        let of = |run: usize| {
            self.runs[method]
                .get(run)
                .map(|run| (run.elites.len() as f64, run.elites.iter().map(|elite| elite.score).sum::<f64>()))
        };
        let all: Vec<(f64, f64)> = match drawn {
            Some(drawn) => drawn.iter().filter_map(|&run| of(run)).collect(),
            None => (0..self.runs[method].len()).filter_map(of).collect(),
        };
        let count = all.len() as f64;
        Some((all.iter().map(|one| one.0).sum::<f64>() / count, all.iter().map(|one| one.1).sum::<f64>() / count))
    }
    /// The part of the material that was saved by making the best lighter.
    pub fn saved(&self) -> Option<f64> {
        self.lighter.as_ref().map(|lighter| 1.0 - lighter.after.1.material / lighter.before.1.material)
    }
}

/// The mean of numbers.
pub fn mean(numbers: impl IntoIterator<Item = f64>) -> f64 {
    let (sum, count) = numbers.into_iter().fold((0.0, 0usize), |(sum, count), one| (sum + one, count + 1));
    sum / count as f64
}

/// What statements can ask for, with what it is.
pub const NAMES: [(&str, &str); 7] = [
    ("rate", "share of successes of the best of a run in new trials, mean over the runs of a method"),
    ("rates", "the same of each run, a list"),
    ("score", "score of the best of a run in new trials, mean over runs"),
    ("material_used", "length of wall of the best of a run, mean over runs"),
    ("kinds", "kinds that an archive reached, mean over runs"),
    ("control", "share of successes without a construct"),
    ("saved", "part of the material saved by making the best construct lighter"),
];

impl Data for Results<'_> {
    fn items(&self) -> usize {
        self.plan.runs
    }
    fn value(
        &self,
        name: &str,
        selectors: &[Selector],
        bytes: &Range<usize>,
        drawn: Option<&[usize]>,
    ) -> Result<Value, Mistake> {
        known(name, &NAMES, bytes, "an optimisation")?;
        match name {
            "control" => return Ok(Value::Number(self.control.map_or(f64::NAN, |found| found.rate()))),
            "saved" => return Ok(Value::Number(self.saved().unwrap_or(f64::NAN))),
            _ => {}
        }
        let methods = self.plan.methods();
        let mut method = None;
        for selector in selectors {
            if selector.factor != "method" {
                let what = format!("unknown `{}`", selector.factor);
                let help = hint(&selector.factor, &["method"]);
                return Err(Mistake { help, ..Mistake::new(selector.bytes.clone(), what) });
            }
            let Value::Text(level) = &selector.level else {
                return Err(Mistake::new(selector.bytes.clone(), "a name is needed here"));
            };
            method = Some(methods.iter().position(|known| known == level).ok_or_else(|| {
                let what = format!("there is no method `{level}`");
                Mistake { help: hint(level, &methods), ..Mistake::new(selector.bytes.clone(), what) }
            })?);
        }
        let method = match method {
            Some(method) => method,
            None if methods.len() == 1 => 0,
            None => {
                let text = format!("there are several, so that `{name}` needs [method = ...]");
                return Err(Mistake {
                    help: format!("one of {}", methods.join(", ")),
                    ..Mistake::new(bytes.clone(), text)
                });
            }
        };
        let bests = self.bests(method, drawn);
        Ok(match name {
            "rate" => Value::Number(mean(bests.iter().map(Found::rate))),
            "rates" => Value::List(bests.iter().map(|found| Value::Number(found.rate())).collect()),
            "score" => Value::Number(mean(bests.iter().map(|found| found.score))),
            "material_used" => Value::Number(mean(bests.iter().map(|found| found.material))),
            _ => Value::Number(self.archive(method, drawn).map_or(f64::NAN, |(kinds, _)| kinds)),
        })
    }
}
