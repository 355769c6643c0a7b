//! Behaviours as they are written: one of the program's, or a score over conditions over signals.

use super::filter::{number_field, numbers};
use super::signal;
use crate::file::form::{Desk, Field, Form, Rule, Shape, choice};
use crate::file::{Node, Tree};
use crate::scenario::build::Wrong;
use crate::{form, tagged};
use measure::behaviours::{self, Behaviour, Bound, Comparison, Condition, Score, Setting};
use swarm::parameters::Range;

/// One of the program's behaviours, by its id, with the numbers that differ from their defaults:
/// `{ corralling = { hold = 20 } }`, or `"corralling"`.
#[derive(Clone, Debug, PartialEq)]
pub struct Listed {
    /// Its id.
    pub id: String,
    /// Numbers by name.
    pub given: Vec<(String, f64)>,
}

impl Form for Listed {
    fn read(node: &Node, rule: &Rule<'_>, desk: &mut Desk) -> Option<Self> {
        let known: Vec<&str> = behaviours::LIST.iter().map(|card| card.id).collect();
        let (key, below) = choice(node, rule, &known, desk)?;
        let card = behaviours::LIST.iter().find(|card| card.id == key)?;
        let names: Vec<&str> = card.parameters.iter().map(|parameter| parameter.name).collect();
        let given = numbers(&below, &Rule { name: key, ..Rule::FREE }, &names, Range::NonNegative, desk)?;
        Some(Self { id: key.to_owned(), given })
    }
    fn shape(_: &Rule<'_>) -> Shape {
        let one = |card: &&behaviours::BehaviourCard| Field {
            shape: Shape::Fields(
                card.parameters
                    .iter()
                    .map(|parameter| {
                        number_field(parameter.name, parameter.about, parameter.unit, Some(parameter.default))
                    })
                    .collect(),
            ),
            ..number_field(card.id, card.definition, "", None)
        };
        Shape::Either(vec![Shape::Fields(behaviours::LIST.iter().map(one).collect()), Shape::Text])
    }
    fn write(&self) -> Tree {
        let given = self.given.iter().map(|(name, value)| (name.clone(), Tree::Number(*value)));
        Tree::table([(self.id.clone(), Tree::table(given))])
    }
}

form! {
    /// A condition: a comparison, or several conditions put together; then what is asked of it in time, from the inside
    /// outwards: `sustained`, `always`, `eventually`, `within`, `until`, `then`.
    pub struct ConditionForm {
        /// A comparison of a signal with a number, as `n_groups(25) >= 2`.
        when: Option<String> = none, "", Any;
        /// All of these hold.
        all: Option<Vec<ConditionForm>> = none, "", Any;
        /// One of these holds.
        any: Option<Vec<ConditionForm>> = none, "", Any;
        /// This does not hold.
        not: Option<Box<ConditionForm>> = none, "", Any;
        /// It has held in so many steps in a row.
        sustained: Option<u64> = none, "steps", Positive;
        /// It held in every step from one to another, both included, or from one on: `[10, 50]`, `[10]`.
        always: Option<Vec<u64>> = none, "steps", NonNegative;
        /// It has held once.
        eventually: bool = [false], "", Any;
        /// It came to hold in one of the first so many steps.
        within: Option<u64> = none, "steps", Positive;
        /// It held in every step until this did, and this did.
        until: Option<Box<ConditionForm>> = none, "", Any;
        /// It came to hold, and this does, its steps counted from there.
        then: Option<Box<ConditionForm>> = none, "", Any;
    }
}

/// A value of a signal at which a ramp begins or ends: a number, or `"initial"`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundForm(pub Bound);

impl Form for BoundForm {
    fn read(node: &Node, rule: &Rule<'_>, desk: &mut Desk) -> Option<Self> {
        match &node.tree {
            Tree::Text(word) if word == "initial" => Some(Self(Bound::Initial)),
            Tree::Text(_) => {
                desk.kind(node, rule, "a number or \"initial\"");
                None
            }
            _ => desk.number(node, rule).map(|number| Self(Bound::Number(number))),
        }
    }
    fn shape(rule: &Rule<'_>) -> Shape {
        Shape::Either(vec![f64::shape(rule), Shape::Word(vec![("initial", "The value at the start.")])])
    }
    fn write(&self) -> Tree {
        match self.0 {
            Bound::Number(number) => Tree::Number(number),
            Bound::Initial => "initial".into(),
        }
    }
}

form! {
    /// A signal at the end, on the way from its worst value (0) to its best (1).
    pub struct Ramp {
        /// The signal.
        signal: String = need, "", Any;
        /// Where the score is 0: a number, or "initial".
        worst: BoundForm = need, "", Any;
        /// Where the score is 1.
        best: BoundForm = need, "", Any;
    }
}

form! {
    /// A score with its weight.
    pub struct Weighed {
        /// Its weight.
        weight: f64 = [1.0], "1", NonNegative;
        /// The score.
        score: ScoreForm = need, "", Any;
    }
}

tagged! {
    /// A fitness from 0 to 1.
    pub enum ScoreForm {
        /// 1 where the condition holds at the end.
        binary => Binary(ConditionForm);
        /// A signal at the end.
        share => Share(String);
        /// The mean of a signal over all steps.
        average => Average(String);
        /// A signal at the end, between two values.
        ramp => Ramp(Ramp);
        /// The product of several.
        product => Product(Vec<ScoreForm>);
        /// The least of several.
        min => Min(Vec<ScoreForm>);
        /// The mean of several.
        mean => Mean(Vec<ScoreForm>);
        /// The mean of several by weight.
        weighted => Weighted(Vec<Weighed>);
    }
}

form! {
    /// A behaviour: one of the program's (`is`), or a score of your own.
    pub struct BehaviourForm {
        /// What it is, for tables and the page; left out, its definition.
        about: String = [""], "", Any;
        /// One of the program's behaviours.
        is: Option<Listed> = none, "", Any;
        /// A score of your own.
        score: Option<ScoreForm> = none, "", Any;
    }
}

/// What the names in a behaviour refer to.
#[derive(Clone, Copy, Debug)]
pub struct Around<'a> {
    /// Walls, places, regions, gates, paths.
    pub setting: &'a Setting,
    /// Names of the groups of the scenario.
    pub groups: &'a [String],
}

impl BehaviourForm {
    /// The behaviour in a setting. Wrongs carry paths below it.
    ///
    /// # Errors
    /// Neither or both of `is` and `score`; signals and names that are not there.
    pub fn plain(&self, name: &str, around: Around<'_>) -> Result<Behaviour, Wrong> {
        let score = match (&self.is, &self.score) {
            (Some(listed), None) => {
                let given: Vec<(&str, f64)> = listed.given.iter().map(|(name, value)| (&**name, *value)).collect();
                let found = behaviours::find(&listed.id, &given, around.setting);
                found.map_err(|error| Wrong::new("is", error.to_string(), "names of workspace and construct"))?.score
            }
            (None, Some(score)) => score.plain(around).map_err(|wrong| wrong.below("score"))?,
            (None, None) => return Err(Wrong::new("", "the behaviour says nothing", "`is` or `score`")),
            (Some(_), Some(_)) => {
                return Err(Wrong::new("score", "`is` says already what the behaviour is", "leave out either"));
            }
        };
        Ok(Behaviour { name: name.to_owned(), score })
    }
    /// What it is, in a sentence.
    pub fn words(&self) -> String {
        let listed = |listed: &Listed| behaviours::LIST.iter().find(|card| card.id == listed.id);
        match (&self.about, self.is.as_ref().and_then(listed)) {
            (about, Some(card)) if about.is_empty() => card.definition.to_owned(),
            (about, _) => about.clone(),
        }
    }
}

impl ScoreForm {
    fn plain(&self, around: Around<'_>) -> Result<Score, Wrong> {
        let signal = |text: &str, path: &str| {
            signal::parse(text, around.setting, around.groups).map_err(|what| Wrong::new(path, what, "a signal"))
        };
        let several = |list: &[Self], path: &str| {
            let one =
                |(k, score): (usize, &Self)| score.plain(around).map_err(|wrong| wrong.below(&format!("{path}.{k}")));
            list.iter().enumerate().map(one).collect::<Result<Vec<_>, _>>()
        };
        Ok(match self {
            Self::Binary(condition) => Score::Binary(condition.plain(around).map_err(|wrong| wrong.below("binary"))?),
            Self::Share(text) => Score::Share(signal(text, "share")?),
            Self::Average(text) => Score::Average(signal(text, "average")?),
            Self::Ramp(ramp) => {
                Score::Ramp { signal: signal(&ramp.signal, "ramp.signal")?, worst: ramp.worst.0, best: ramp.best.0 }
            }
            Self::Product(list) => Score::Product(several(list, "product")?),
            Self::Min(list) => Score::Min(several(list, "min")?),
            Self::Mean(list) => Score::Mean(several(list, "mean")?),
            Self::Weighted(list) => {
                let one = |(k, weighed): (usize, &Weighed)| {
                    let score = weighed.score.plain(around);
                    score
                        .map(|score| (weighed.weight, score))
                        .map_err(|wrong| wrong.below(&format!("weighted.{k}.score")))
                };
                Score::Weighted(list.iter().enumerate().map(one).collect::<Result<_, _>>()?)
            }
        })
    }
}

/// A comparison from its text.
fn comparison(text: &str, around: Around<'_>) -> Result<Condition, String> {
    const SIGNS: [(&str, Comparison); 4] =
        [("<=", Comparison::AtMost), (">=", Comparison::AtLeast), ("<", Comparison::Less), (">", Comparison::More)];
    let Some((signal, comparison, number)) =
        SIGNS.iter().find_map(|(sign, comparison)| text.split_once(sign).map(|(a, b)| (a, *comparison, b.trim())))
    else {
        return Err(format!("`{text}` compares nothing; it is written as n_groups(25) >= 2"));
    };
    let signal = signal::parse(signal, around.setting, around.groups)?;
    match number.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(Condition::Compare(signal, comparison, number)),
        _ => Err(format!("`{number}` is no number to compare with")),
    }
}

impl ConditionForm {
    /// The condition in a setting. Wrongs carry paths below it.
    ///
    /// # Errors
    /// Signals and names that are not there.
    pub fn plain(&self, around: Around<'_>) -> Result<Condition, Wrong> {
        let several = |list: &[Self], path: &str| {
            let one =
                |(k, part): (usize, &Self)| part.plain(around).map_err(|wrong| wrong.below(&format!("{path}.{k}")));
            list.iter().enumerate().map(one).collect::<Result<Vec<_>, _>>()
        };
        let mut condition = match (&self.when, &self.all, &self.any, &self.not) {
            (Some(text), None, None, None) => {
                comparison(text, around).map_err(|what| Wrong::new("when", what, "a comparison"))?
            }
            (None, Some(all), None, None) => Condition::All(several(all, "all")?),
            (None, None, Some(any), None) => Condition::Any(several(any, "any")?),
            (None, None, None, Some(not)) => {
                Condition::Not(Box::new(not.plain(around).map_err(|wrong| wrong.below("not"))?))
            }
            _ => {
                let what = "a condition has exactly one of `when`, `all`, `any` and `not`";
                return Err(Wrong::new("", what, "one of them"));
            }
        };
        if let Some(steps) = self.sustained {
            condition = condition.sustained(steps);
        }
        if let Some(steps) = &self.always {
            condition = match *steps.as_slice() {
                [from] => Condition::Always(from, None, Box::new(condition)),
                [from, to] if from <= to => Condition::Always(from, Some(to), Box::new(condition)),
                _ => return Err(Wrong::new("always", "`always` takes [from] or [from, to], in order", "steps")),
            };
        }
        if self.eventually {
            condition = Condition::Eventually(Box::new(condition));
        }
        if let Some(steps) = self.within {
            condition = condition.within(steps);
        }
        if let Some(until) = &self.until {
            let until = until.plain(around).map_err(|wrong| wrong.below("until"))?;
            condition = Condition::Until(Box::new(condition), Box::new(until));
        }
        if let Some(then) = &self.then {
            condition = condition.then(then.plain(around).map_err(|wrong| wrong.below("then"))?);
        }
        Ok(condition)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::file::{Sources, tree::parse};
    use space::{Segment, Vector};

    fn setting() -> Setting {
        Setting {
            places: vec![("marker".into(), Vector([0.0, 0.0]))],
            gates: vec![("right".into(), Segment::new([2.0, 0.0], [2.0, 2.0]))],
            ..Setting::default()
        }
    }

    fn read(text: &str) -> Result<Behaviour, String> {
        let mut sources = Sources::default();
        let source = sources.add("b", text);
        let mut desk = Desk::default();
        let node = parse(&sources, source, &mut desk.problems);
        let form = BehaviourForm::read(&node, &Rule::FREE, &mut desk).filter(|_| desk.problems.is_empty());
        let Some(form) = form else { return Err(crate::file::Problems::new(sources, desk.problems).to_string()) };
        let around = Around { setting: &setting(), groups: &["blue".to_owned()] };
        form.plain("b", around).map_err(|wrong| format!("{}: {}", wrong.path, wrong.what))
    }

    #[test]
    fn what_is_composed_is_what_is_listed() {
        for (composed, listed) in [
            ("score.binary = { when = \"n_groups(25) >= 2\", sustained = 50, within = 200 }", "is = \"simple-split\""),
            (
                "score.binary = { all = [{ when = \"centroid_dist(marker) <= 25\" }, { when = \"largest_share(25) >= 1\" }], sustained = 50, within = 500 }",
                "is.corralling = {}",
            ),
            (
                "score.binary = { when = \"share_crossed(right) >= 0.9\", within = 100 }",
                "is.turn-right = { horizon = 100 }",
            ),
            ("score.ramp = { signal = \"sd_x\", worst = \"initial\", best = 0 }", "is = \"reduce-x-sd\""),
        ] {
            assert_eq!(read(composed).unwrap(), read(listed).map(|b| Behaviour { name: "b".into(), ..b }).unwrap());
        }
    }

    #[test]
    fn every_signal_is_read_and_wrong_ones_name_the_nearest() {
        for (name, usage, _) in signal::SIGNALS {
            assert!(usage.starts_with(name), "{usage}");
        }
        for (text, what) in [
            ("score.share = \"n_grops(25)\"", "did you mean `n_groups`"),
            ("score.share = \"share_crossed(rihgt)\"", "did you mean `right`"),
            ("score.share = \"type_share_in(pen, bleu)\"", "did you mean `blue`"),
            ("score.share = \"n_groups\"", "written n_groups(distance)"),
            ("score.share = \"spread(1)\"", "written spread"),
            ("score.binary = { when = \"spread = 2\" }", "compares nothing"),
            ("score.binary = { when = \"spread < x\" }", "is no number"),
            ("score.binary = { sustained = 2 }", "exactly one of"),
            ("score.binary = { when = \"spread < 1\", always = [5, 2] }", "in order"),
            ("is.corraling = {}", "did you mean `corralling`"),
            ("is.corralling = { hodl = 2 }", "did you mean `hold`"),
            ("about = \"x\"", "says nothing"),
            ("is = \"simple-split\"\nscore.share = \"alive\"", "already"),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.contains(what), "{text}: {error}");
        }
    }
}
