//! What came of the candidates of a design, and the names by which statements ask for it.

use super::plan::{Plan, Survey};
use crate::environment::claims::{Data, hint, known};
use crate::environment::trial::{Outcome, Tried};
use crate::study::expression::{Mistake, Selector, Value};
use core::ops::Range;
use std::collections::BTreeMap;

/// The trials of a candidate by one group: with the construct, and without it (none where there is no control).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trials {
    /// With the construct. A trial that was impossible has no steps, and outcomes that are no numbers.
    pub built: Vec<Tried>,
    /// Without it.
    pub control: Vec<Tried>,
    /// Each stage by itself, `[stages]`, begun where the group was handed over by the one before; empty where there are no
    /// stages, or nobody came so far.
    pub alone: Vec<Vec<Tried>>,
}

/// A share of successes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Share {
    /// Trials that succeeded.
    pub successes: u64,
    /// Trials.
    pub trials: u64,
}

impl Share {
    /// The successes among trials, by least fitness; impossible trials are left out.
    pub fn of(trials: &[Tried], behaviour: usize, success: f64) -> Self {
        let mut share = Self::default();
        for outcome in trials.iter().filter_map(|tried| tried.outcomes.get(behaviour)) {
            if outcome.fitness.is_finite() {
                share.trials += 1;
                share.successes += u64::from(outcome.fitness >= success);
            }
        }
        share
    }
    /// As a number; not a number of no trials.
    pub fn rate(self) -> f64 {
        self.successes as f64 / self.trials as f64
    }
    /// The 95 % Wilson interval; none of no trials.
    pub fn interval(self) -> Option<(f64, f64)> {
        measure::statistics::wilson(self.successes, self.trials, 0.95).ok().map(|found| (found.low, found.high))
    }
}

/// The results of a design: the trials of each feasible candidate, by its attempt, `[populations]`.
pub struct Results<'a> {
    /// The plan.
    pub plan: &'a Plan,
    /// What was generated.
    pub survey: Survey,
    /// The trials of each.
    pub trials: BTreeMap<u64, Vec<Trials>>,
    /// Attempts of the candidates that were tried, in order.
    pub tried: Vec<u64>,
}

impl<'a> Results<'a> {
    /// Results of these trials.
    pub fn new(plan: &'a Plan, survey: Survey, trials: BTreeMap<u64, Vec<Trials>>) -> Self {
        let tried = survey
            .feasible
            .iter()
            .map(|(attempt, _)| *attempt)
            .filter(|attempt| trials.contains_key(attempt))
            .collect();
        Self { plan, survey, trials, tried }
    }
    /// Results of one made-up candidate, to find out whether statements have a meaning.
    pub(super) fn example(plan: &'a Plan) -> Self {
        let outcome = Outcome { fitness: 1.0, value: 1.0 };
        let tried = Tried { steps: 1, outcomes: vec![outcome; plan.behaviour_names().len()] };
        let alone = vec![vec![tried.clone()]; plan.stages()];
        let one = Trials { built: vec![tried.clone()], control: vec![tried], alone };
        let trials = BTreeMap::from([(0, vec![one; plan.populations.len()])]);
        Self { plan, survey: Survey::default(), trials, tried: vec![0] }
    }
    /// The trials of candidates by a group, each as often as it was drawn.
    fn of<'b>(&'b self, population: usize, drawn: Option<&'b [usize]>) -> Vec<&'b Trials> {
        let all = |k: usize| self.trials.get(self.tried.get(k)?)?.get(population);
        match drawn {
            Some(drawn) => drawn.iter().filter_map(|&k| all(k)).collect(),
            None => (0..self.tried.len()).filter_map(all).collect(),
        }
    }
    /// The share of successes over all candidates.
    pub fn share(&self, population: usize, behaviour: usize, control: bool, drawn: Option<&[usize]>) -> Share {
        let of = |trials: &&Trials| {
            let trials = if control { &trials.control } else { &trials.built };
            Share::of(trials, behaviour, self.plan.form.success)
        };
        self.of(population, drawn).iter().map(of).fold(Share::default(), |sum, share| Share {
            successes: sum.successes + share.successes,
            trials: sum.trials + share.trials,
        })
    }
    /// The trials of a stage by itself over all candidates.
    pub fn alone<'b>(&'b self, population: usize, stage: usize, drawn: Option<&'b [usize]>) -> Vec<&'b Tried> {
        let all = self.of(population, drawn);
        all.into_iter().filter_map(|trials| trials.alone.get(stage)).flatten().collect()
    }
    /// The share of successes of a stage by itself over all candidates.
    pub fn share_alone(&self, population: usize, stage: usize, drawn: Option<&[usize]>) -> Share {
        let all: Vec<Tried> = self.alone(population, stage, drawn).into_iter().cloned().collect();
        Share::of(&all, 0, self.plan.form.success)
    }
    /// The share of successes of each candidate.
    pub fn shares(&self, population: usize, behaviour: usize, drawn: Option<&[usize]>) -> Vec<Share> {
        let success = self.plan.form.success;
        self.of(population, drawn).iter().map(|trials| Share::of(&trials.built, behaviour, success)).collect()
    }
    /// How many candidates are valid.
    pub fn valid(&self, population: usize, behaviour: usize, drawn: Option<&[usize]>) -> usize {
        let holds = |share: &&Share| self.plan.form.valid.holds(share.successes, share.trials);
        self.shares(population, behaviour, drawn).iter().filter(holds).count()
    }
    /// What is read of the outcomes of a behaviour in all trials with the construct, where it is a number.
    pub fn numbers(
        &self,
        population: usize,
        behaviour: usize,
        drawn: Option<&[usize]>,
        of: fn(&Outcome) -> f64,
    ) -> Vec<f64> {
        let all = self.of(population, drawn);
        let outcomes = all.iter().flat_map(|trials| &trials.built).filter_map(|tried| tried.outcomes.get(behaviour));
        outcomes.map(of).filter(|number| number.is_finite()).collect()
    }
}

/// What statements can ask for, with what it is.
pub const NAMES: [(&str, &str); 10] = [
    ("rate", "share of trials with the construct that succeeded"),
    ("control", "share of trials without it that succeeded"),
    ("alone", "share of trials of a stage by itself that succeeded"),
    ("tightness", "share of feasible candidates that are valid"),
    ("tightness_all", "share of generated candidates that are valid"),
    ("rates", "share of successes of each candidate, a list"),
    ("values", "the number behind the fitness of each trial, a list"),
    ("fitness", "fitness of each trial, a list"),
    ("generated", "number of candidates generated"),
    ("feasible", "number of feasible candidates"),
];

impl Data for Results<'_> {
    fn items(&self) -> usize {
        self.tried.len()
    }
    fn value(
        &self,
        name: &str,
        selectors: &[Selector],
        bytes: &Range<usize>,
        drawn: Option<&[usize]>,
    ) -> Result<Value, Mistake> {
        known(name, &NAMES, bytes, "a design")?;
        let behaviours = self.plan.behaviour_names();
        let groups: Vec<&str> = self.plan.populations.iter().map(|population| population.name.as_str()).collect();
        let (mut behaviour, mut population) = (None, None);
        for selector in selectors {
            let (list, place) = match selector.factor.as_str() {
                "behaviour" => (&behaviours, &mut behaviour),
                "population" => (&groups, &mut population),
                other => {
                    let help = hint(other, &["behaviour", "population"]);
                    return Err(Mistake { help, ..Mistake::new(selector.bytes.clone(), format!("unknown `{other}`")) });
                }
            };
            let Value::Text(level) = &selector.level else {
                return Err(Mistake::new(selector.bytes.clone(), "a name is needed here"));
            };
            *place = Some(list.iter().position(|known| known == level).ok_or_else(|| {
                let what = format!("there is no {} `{level}`", selector.factor);
                Mistake { help: hint(level, list), ..Mistake::new(selector.bytes.clone(), what) }
            })?);
        }
        let only = |found: Option<usize>, list: &[&str], what: &str| match found {
            Some(found) => Ok(found),
            None if list.len() == 1 => Ok(0),
            None => {
                let text = format!("there are several, so that `{name}` needs [{what} = ...]");
                Err(Mistake { help: format!("one of {}", list.join(", ")), ..Mistake::new(bytes.clone(), text) })
            }
        };
        match name {
            "generated" => return Ok(Value::Number(self.survey.counts.generated as f64)),
            "feasible" => return Ok(Value::Number(self.survey.counts.feasible as f64)),
            _ => {}
        }
        let behaviour = only(behaviour, &behaviours, "behaviour")?;
        let population = only(population, &groups, "population")?;
        let list = |numbers: Vec<f64>| Value::List(numbers.into_iter().map(Value::Number).collect());
        Ok(match name {
            "rate" => Value::Number(self.share(population, behaviour, false, drawn).rate()),
            "control" => Value::Number(self.share(population, behaviour, true, drawn).rate()),
            "alone" if behaviour < self.plan.stages() => {
                Value::Number(self.share_alone(population, behaviour, drawn).rate())
            }
            "alone" => {
                let what = format!("`{}` is no stage", behaviours[behaviour]);
                let stages = behaviours[..self.plan.stages()].join(", ");
                let help =
                    if stages.is_empty() { "candidates have none".to_owned() } else { format!("one of {stages}") };
                return Err(Mistake { help, ..Mistake::new(bytes.clone(), what) });
            }
            "tightness" | "tightness_all" => {
                let all = match name {
                    "tightness" => self.tried.len() as f64,
                    _ => self.survey.counts.generated as f64,
                };
                Value::Number(self.valid(population, behaviour, drawn) as f64 / all)
            }
            "rates" => list(self.shares(population, behaviour, drawn).into_iter().map(Share::rate).collect()),
            "values" => list(self.numbers(population, behaviour, drawn, |outcome| outcome.value)),
            _ => list(self.numbers(population, behaviour, drawn, |outcome| outcome.fitness)),
        })
    }
}
