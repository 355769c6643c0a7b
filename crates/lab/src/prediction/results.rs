//! What was simulated and what was predicted, construct by construct, and the names by which statements ask for it.

use super::model::Fit;
use super::plan::{BASELINES, Drawn, Plan};
use crate::design::results::Share;
use crate::environment::claims::{Data, hint, known};
use crate::study::expression::{Mistake, Selector, Value};
use core::ops::Range;
use measure::statistics::spearman;
use space::Real;

/// Numbers of neighbours among which the baseline by parameters chooses.
const NEIGHBOURS: [usize; 7] = [1, 2, 3, 5, 8, 13, 21];

/// What was predicted of a construct.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Predicted {
    /// Successes among the predicted trials.
    pub share: Share,
    /// Transitions made.
    pub transitions: u64,
}

/// A construct with what was simulated and predicted.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// Its number in its lot.
    pub number: u64,
    /// The values of the parameters that were drawn.
    pub values: Vec<f64>,
    /// What was simulated.
    pub simulated: Share,
    /// Steps of agents simulated.
    pub updates: u64,
    /// The predicted chance of success, `[predictors]`.
    pub chances: Vec<f64>,
    /// Transitions made for it, `[predictors]`; 0 of baselines.
    pub transitions: Vec<u64>,
}

/// A test.
#[derive(Clone, Debug, PartialEq)]
pub struct Test {
    /// Its name.
    pub name: String,
    /// The lot that its constructs are of.
    pub lot: usize,
    /// Its constructs.
    pub items: Vec<Item>,
}

/// What came of a prediction.
pub struct Results<'a> {
    /// The plan.
    pub plan: &'a Plan,
    /// The constructs that models were fitted to: what was simulated.
    pub training: Vec<Item>,
    /// The tests.
    pub tests: Vec<Test>,
    /// How well each model fits, `[models]`.
    pub fits: Vec<Fit>,
    /// Without a construct: simulated, and predicted by each model.
    pub bare: (Share, Vec<Share>),
    /// Neighbours of the baseline by parameters.
    pub neighbours: usize,
}

/// The chance of success told by the nearest constructs of known shares: the mean of so many.
fn by_neighbours(drawn: &[Drawn], known: &[(&[f64], f64)], values: &[f64], count: usize) -> f64 {
    let apart = |other: &[f64]| -> f64 {
        let one = |(drawn, (a, b)): (&Drawn, (&f64, &f64))| {
            let share = ((a - b) / (drawn.axis.high - drawn.axis.low)).abs();
            let share = if drawn.axis.periodic { share.min(1.0 - share) } else { share };
            share * share
        };
        drawn.iter().zip(values.iter().zip(other)).map(one).sum()
    };
    let mut all: Vec<(f64, f64)> = known.iter().map(|(other, rate)| (apart(other), *rate)).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let near = &all[..count.min(all.len())];
    near.iter().map(|(_, rate)| rate).sum::<f64>() / near.len() as f64
}

/// The number of neighbours with which each training construct is told best by the others.
fn best_count(drawn: &[Drawn], known: &[(&[f64], f64)]) -> usize {
    let error = |count: usize| -> f64 {
        let left_out = |k: usize| {
            let others: Vec<(&[f64], f64)> =
                known.iter().enumerate().filter(|(other, _)| *other != k).map(|(_, one)| *one).collect();
            let told = by_neighbours(drawn, &others, known[k].0, count);
            (told - known[k].1) * (told - known[k].1)
        };
        (0..known.len()).map(left_out).sum()
    };
    let possible = NEIGHBOURS.into_iter().filter(|&count| count < known.len());
    let all = possible.map(|count| (error(count), count));
    all.reduce(|best, other| if other.0 < best.0 { other } else { best }).map_or(1, |best| best.1)
}

impl<'a> Results<'a> {
    /// Results of what was simulated, and of what the models predicted: `predicted` tells of a model, a lot and a number.
    pub fn new(
        plan: &'a Plan,
        simulated: &dyn Fn(usize, u64) -> (Share, u64),
        predicted: &dyn Fn(usize, usize, u64) -> Predicted,
        fits: Vec<Fit>,
        bare: (Share, Vec<Share>),
    ) -> Self {
        let item = |lot: usize, number: u64| {
            let (simulated, updates) = simulated(lot, number);
            // what was tried once can be built again
            let values = plan.built(lot, number).map_or_else(|_| Vec::new(), |built| built.values);
            Item { number, values, simulated, updates, chances: Vec::new(), transitions: Vec::new() }
        };
        let numbers = plan.numbers(0, false).into_iter();
        let training: Vec<Item> =
            numbers.map(|number| item(0, number)).filter(|item| item.simulated.trials > 0).collect();
        let drawn = &plan.lots[0].drawn;
        let known: Vec<(&[f64], f64)> =
            training.iter().map(|item| (item.values.as_slice(), item.simulated.rate())).collect();
        let neighbours = best_count(drawn, &known);
        let sum = training.iter().fold(Share::default(), |sum, item| Share {
            successes: sum.successes + item.simulated.successes,
            trials: sum.trials + item.simulated.trials,
        });
        let told = |lot: usize, mut item: Item| {
            // the values of the parameters that the training constructs have, of a lot that may draw others
            let own = &plan.lots[lot];
            let value = |one: &Drawn| {
                let place = own.drawn.iter().position(|other| other.place == one.place);
                place.map_or(own.values[one.place], |k| item.values[k])
            };
            let values: Vec<f64> = drawn.iter().map(value).collect();
            item.chances = vec![sum.rate(), by_neighbours(drawn, &known, &values, neighbours)];
            item.transitions = vec![0; BASELINES.len()];
            for model in 0..plan.form.model.0.len() {
                let found = predicted(model, lot, item.number);
                item.chances.push(found.share.rate());
                item.transitions.push(found.transitions);
            }
            item
        };
        let tests = plan.tests().into_iter().map(|(lot, name)| {
            let all = plan.numbers(lot, true).into_iter().map(|number| item(lot, number));
            let possible = all.filter(|item| item.simulated.trials > 0);
            Test { name: name.to_owned(), lot, items: possible.map(|item| told(lot, item)).collect() }
        });
        let tests = tests.collect();
        Self { plan, tests, fits, bare, neighbours, training }
    }
    /// Results of made-up constructs, to find out whether statements have a meaning.
    pub(super) fn example(plan: &'a Plan) -> Self {
        let simulated = |_: usize, number: u64| (Share { successes: 1 + number % 2, trials: 3 }, 100);
        let predicted = |_: usize, _: usize, number: u64| Predicted {
            share: Share { successes: 1 + number % 3, trials: 4 },
            transitions: 10,
        };
        let share = Share { successes: 1, trials: 2 };
        let models = plan.form.model.0.len();
        Self::new(plan, &simulated, &predicted, vec![Fit::default(); models], (share, vec![share; models]))
    }
    /// The least chance that counts in a logarithm: that of half a success among the predicted trials.
    fn least(&self) -> f64 {
        0.5 / (self.plan.predicted as f64 + 1.0)
    }
    /// A score of a predictor over constructs of a test, each as often as it is drawn; not a number where it has none.
    pub fn score(&self, score: Score, items: &[&Item], by: usize) -> f64 {
        let mean = |of: &dyn Fn(&Item) -> f64| items.iter().map(|item| of(item)).sum::<f64>() / items.len() as f64;
        let rate = |item: &Item| item.simulated.rate();
        let chance = |item: &Item| item.chances[by];
        match score {
            Score::Brier => mean(&|item| {
                let (p, r) = (chance(item), rate(item));
                r * (1.0 - p) * (1.0 - p) + (1.0 - r) * p * p
            }),
            Score::LogLoss => mean(&|item| {
                let (p, r) = (chance(item).clamp(self.least(), 1.0 - self.least()), rate(item));
                -(r * Real::ln(p) + (1.0 - r) * Real::ln(1.0 - p))
            }),
            Score::Mae => mean(&|item| (chance(item) - rate(item)).abs()),
            Score::Bias => mean(&|item| chance(item) - rate(item)),
            Score::Spearman => {
                let told: Vec<f64> = items.iter().map(|item| chance(item)).collect();
                let found: Vec<f64> = items.iter().map(|item| rate(item)).collect();
                spearman(&told, &found, 0.95).map_or(f64::NAN, |found| found.r)
            }
        }
    }
    /// The mean absolute error that chance alone gives to whoever knows the true chances, taken to be the shares found.
    pub fn sampling(&self, items: &[&Item]) -> f64 {
        let one = |item: &&Item| {
            let (n, p) = (item.simulated.trials, item.simulated.rate());
            if p >= 1.0 {
                return 0.0;
            }
            // number by number of successes, from the chance of none on
            let mut chance = Real::exp(n as f64 * Real::ln(1.0 - p));
            let mut sum = 0.0;
            for k in 0..=n {
                sum += chance * (k as f64 / n as f64 - p).abs();
                chance *= (n - k) as f64 / (k + 1) as f64 * p / (1.0 - p);
            }
            sum
        };
        items.iter().map(one).sum::<f64>() / items.len() as f64
    }
    /// The constructs of all tests in one row, by test and place; these are drawn again for intervals.
    fn places(&self) -> Vec<(usize, usize)> {
        let of = |(test, own): (usize, &Test)| (0..own.items.len()).map(move |k| (test, k)).collect::<Vec<_>>();
        self.tests.iter().enumerate().flat_map(of).collect()
    }
    /// The constructs of a test, each as often as it was drawn.
    fn drawn(&self, test: usize, drawn: Option<&[usize]>) -> Vec<&Item> {
        match drawn {
            None => self.tests[test].items.iter().collect(),
            Some(drawn) => {
                let places = self.places();
                let own = drawn.iter().filter_map(|&k| places.get(k)).filter(|(of, _)| *of == test);
                own.map(|&(_, k)| &self.tests[test].items[k]).collect()
            }
        }
    }
}

/// How a prediction is judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Score {
    /// Mean squared difference of chance and outcome of a trial.
    Brier,
    /// Mean logarithmic loss of a trial.
    LogLoss,
    /// Mean absolute error of the share of successes.
    Mae,
    /// Mean error of it.
    Bias,
    /// Rank correlation of predicted and simulated shares.
    Spearman,
}

impl Score {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Brier, Self::LogLoss, Self::Mae, Self::Bias, Self::Spearman];
    /// Its name.
    pub fn word(self) -> &'static str {
        match self {
            Self::Brier => "brier",
            Self::LogLoss => "log_loss",
            Self::Mae => "mae",
            Self::Bias => "bias",
            Self::Spearman => "spearman",
        }
    }
}

/// What statements can ask for, with what it is.
pub const NAMES: [(&str, &str); 11] = [
    (
        "brier",
        "Brier score: mean squared difference of the predicted chance and the outcome of a trial, over a test's constructs",
    ),
    (
        "log_loss",
        "mean logarithmic loss of a trial; no chance is less than that of half a success among the predicted trials",
    ),
    ("mae", "mean absolute error of the share of successes"),
    ("bias", "mean error of it: predicted less simulated"),
    ("spearman", "rank correlation of predicted and simulated shares of successes"),
    ("predicted", "mean predicted chance of success"),
    ("rate", "mean simulated share of successes of a test's constructs"),
    ("sampling", "mean absolute error that the number of trials alone gives to whoever knows the chances"),
    ("tested", "constructs of a test"),
    ("work", "steps of agents that a simulated trial takes, for a transition of the group that a predicted one takes"),
    ("bare", "share of trials without a construct that succeeded: simulated, or predicted [by = a model]"),
];

impl Data for Results<'_> {
    fn items(&self) -> usize {
        self.tests.iter().map(|test| test.items.len()).sum()
    }
    fn value(
        &self,
        name: &str,
        selectors: &[Selector],
        bytes: &Range<usize>,
        drawn: Option<&[usize]>,
    ) -> Result<Value, Mistake> {
        known(name, &NAMES, bytes, "a prediction")?;
        let predictors = self.plan.predictors();
        let tests: Vec<&str> = self.tests.iter().map(|test| test.name.as_str()).collect();
        let (mut by, mut test) = (None, None);
        for selector in selectors {
            let (list, place) = match selector.factor.as_str() {
                "by" => (&predictors, &mut by),
                "test" => (&tests, &mut test),
                other => {
                    let help = hint(other, &["by", "test"]);
                    return Err(Mistake { help, ..Mistake::new(selector.bytes.clone(), format!("unknown `{other}`")) });
                }
            };
            let level = match &selector.level {
                Value::Text(level) => level.clone(),
                // a name may be a number
                Value::Number(number) => number.to_string(),
                _ => return Err(Mistake::new(selector.bytes.clone(), "a name is needed here")),
            };
            *place = Some(list.iter().position(|known| *known == level).ok_or_else(|| {
                let what =
                    format!("there is no {} `{level}`", if selector.factor == "by" { "predictor" } else { "test" });
                Mistake { help: hint(&level, list), ..Mistake::new(selector.bytes.clone(), what) }
            })?);
        }
        if name == "bare" {
            let share = match by.map(|by| by.checked_sub(BASELINES.len())) {
                None => self.bare.0,
                Some(Some(model)) => self.bare.1[model],
                Some(None) => return Err(Mistake::new(bytes.clone(), "without a construct only models predict")),
            };
            return Ok(Value::Number(share.rate()));
        }
        let needed = |found: Option<usize>, list: &[&str], what: &str| match found {
            Some(found) => Ok(found),
            None if list.len() == 1 => Ok(0),
            None => {
                let text = format!("there are several, so that `{name}` needs [{what} = ...]");
                Err(Mistake { help: format!("one of {}", list.join(", ")), ..Mistake::new(bytes.clone(), text) })
            }
        };
        // what is held out is meant where nothing is said
        let test = match test {
            None if tests.first() == Some(&super::plan::HELD_OUT) => 0,
            test => needed(test, &tests, "test")?,
        };
        let items = self.drawn(test, drawn);
        let mean = |of: &dyn Fn(&Item) -> f64| items.iter().map(|item| of(item)).sum::<f64>() / items.len() as f64;
        match name {
            "rate" => return Ok(Value::Number(mean(&|item| item.simulated.rate()))),
            "sampling" => return Ok(Value::Number(self.sampling(&items))),
            "tested" => return Ok(Value::Number(items.len() as f64)),
            _ => {}
        }
        let by = needed(by, &predictors, "by")?;
        let score = Score::ALL.into_iter().find(|score| score.word() == name);
        Ok(Value::Number(match (score, name) {
            (Some(score), _) => self.score(score, &items, by),
            (None, "predicted") => mean(&|item| item.chances[by]),
            (None, _) => {
                let trials = self.plan.predicted as f64;
                let simulated = mean(&|item| item.updates as f64 / item.simulated.trials as f64);
                simulated / mean(&|item| item.transitions[by] as f64 / trials)
            }
        }))
    }
}
