//! Which group is it: how well environments tell groups apart, and how soon an unknown group is named by what it does.
//!
//! The trials of the design give the distribution of outcomes in each environment for each group. From them follow how much one
//! trial is expected to tell ([`search::identify`]), the environment that tells most, and which comes next. Whether that is
//! so is tried on unknown groups: each of the file's groups is put into the environments again, with new seeds, until what is
//! seen names one. What was seen is kept trial by trial, so that another threshold, prior or way to choose needs new trials only
//! where it asks for more of them.

mod told;

pub use told::{COURSES, IDENTIFICATIONS, INFORMATION, OUTCOMES, figures, lines, methods, write};

use super::execute::tried;
use super::form::{Design, Inverse as Form};
use super::plan::{CANDIDATE, Plan, TRIAL};
use super::results::Results;
use crate::environment::claims::{self, Data, hint, known};
use crate::environment::trial::{Population, Tried};
use crate::file::{Desk, Node};
use crate::study::expression::{Mistake, Selector, Value};
use core::ops::Range;
use search::identify::{Course, Ending, Estimate, Question, estimated, identify, most_telling};
use space::random::{Purpose, child_seed, uniform};
use space::spelling::nearest;
use std::collections::BTreeMap;

/// Kind of child seeds, beside those of candidates, trials and copies: an unknown group.
const UNKNOWN: u32 = 15;
/// Outcomes of a trial, at most.
const MOST_OUTCOMES: usize = 16;

/// What is asked, as resolved.
#[derive(Clone, Debug)]
pub struct Inverse {
    /// What is seen of a trial: places of behaviours, with the fitnesses at which outcomes part.
    pub seen: Vec<(usize, Vec<f64>)>,
    /// How probable each group is beforehand.
    pub prior: Vec<f64>,
    /// When a group is named.
    pub ending: Ending,
    /// Unknown groups of each group.
    pub identifications: usize,
}

/// Reads what is asked; what is wrong goes to the desk.
pub(super) fn read(
    form: &Form,
    design: &Design,
    populations: &[Population],
    quick: bool,
    tree: &Node,
    desk: &mut Desk,
) -> Option<Inverse> {
    let before = desk.problems.len();
    let mut wrong = |path: &str, what: String, expected: &str, help: String| {
        desk.problem(&tree.place(&format!("inverse{path}")), what, expected, help);
    };
    let near = |name: &str, known: &[&str]| {
        nearest(name, known.iter().copied()).map_or_else(String::new, |near| format!("did you mean `{near}`?"))
    };
    if populations.len() < 2 {
        let what = format!("there is {} group, which cannot be mistaken for another", populations.len());
        wrong("", what, "at least two [population.NAME]", String::new());
    }
    if design.sequential.is_some() {
        let what = "trials that stop once an environment is decided do not show how often each outcome comes";
        wrong("", what.to_owned(), "no `sequential` beside `inverse`", String::new());
    }
    let behaviours: Vec<&str> = design.behaviour.0.iter().map(|(name, _)| name.as_str()).collect();
    let mut seen = Vec::new();
    for (name, parts) in &form.outcome.0 {
        let path = format!(".outcome.{name}");
        match behaviours.iter().position(|known| known == name) {
            None => {
                wrong(&path, format!("there is no behaviour `{name}`"), "one of the file's", near(name, &behaviours))
            }
            Some(_) if parts.is_empty() || parts.windows(2).any(|two| two[0] >= two[1]) => {
                let what = format!("the outcomes of `{name}` part nowhere, or not in order");
                wrong(&path, what, "fitnesses, ascending", String::new());
            }
            Some(place) => seen.push((place, parts.clone())),
        }
    }
    if form.outcome.0.is_empty() {
        seen = (0..behaviours.len()).map(|place| (place, vec![design.success])).collect();
    }
    let outcomes = seen.iter().fold(1usize, |all, (_, parts)| all.saturating_mul(parts.len() + 1));
    if outcomes > MOST_OUTCOMES {
        let what = format!("a trial has {outcomes} outcomes, too many to know how often each comes");
        wrong(".outcome", what, "at most 16", "name fewer behaviours, or part them less".to_owned());
    }
    let groups: Vec<&str> = populations.iter().map(|population| population.name.as_str()).collect();
    for (name, _) in form.prior.0.iter().filter(|(name, _)| !groups.contains(&name.as_str())) {
        let what = format!("there is no population `{name}`");
        wrong(&format!(".prior.{name}"), what, "one of the file's", near(name, &groups));
    }
    let weight = |name: &&str| match form.prior.0.iter().find(|(known, _)| known == name) {
        Some((_, weight)) => Some(*weight),
        None => form.prior.0.is_empty().then_some(1.0),
    };
    let weights: Option<Vec<f64>> = groups.iter().map(weight).collect();
    let sum: f64 = weights.iter().flatten().sum();
    let unknown = form.prior.0.iter().any(|(name, _)| !groups.contains(&name.as_str()));
    match &weights {
        _ if unknown => {}
        None => wrong(".prior", "some groups have no weight".to_owned(), "one for each group", String::new()),
        Some(_) if sum <= 0.0 => wrong(".prior", "no group is possible".to_owned(), "a weight above 0", String::new()),
        Some(_) => {}
    }
    let identifications =
        if quick { form.quick_identifications.min(form.identifications) } else { form.identifications };
    (desk.problems.len() == before).then(|| Inverse {
        seen,
        prior: weights.into_iter().flatten().map(|weight| weight / sum).collect(),
        ending: Ending { threshold: form.threshold, most: form.most },
        identifications,
    })
}

/// Whether the statements have a meaning; what is wrong goes to the desk.
pub(super) fn check(plan: &Plan, tree: &Node, desk: &mut Desk) {
    if let (Some(form), Some(asked)) = (&plan.form.inverse, &plan.inverse) {
        let course = Course { trials: Vec::new(), named: Some(0) };
        let one = Identified { greedy: course.clone(), drawn: course.clone(), alone: vec![course] };
        let courses = vec![vec![one]; plan.populations.len()];
        let telling = Telling { attempts: Vec::new(), questions: Vec::new(), chosen: 0 };
        let found = Found { plan, asked, telling, courses };
        claims::check(&form.claim, &found, "inverse.claim", tree, desk);
    }
}

impl Inverse {
    /// Number of outcomes of a trial.
    pub fn outcomes(&self) -> usize {
        self.seen.iter().map(|(_, parts)| parts.len() + 1).product()
    }
    /// The outcome of a trial; none of one that was impossible.
    pub fn outcome(&self, tried: &Tried) -> Option<usize> {
        self.seen.iter().try_fold(0, |all, (place, parts)| {
            let fitness = tried.outcomes.get(*place)?.fitness;
            let part = parts.iter().filter(|least| fitness >= **least).count();
            fitness.is_finite().then_some(all * (parts.len() + 1) + part)
        })
    }
    /// An outcome in words.
    pub fn words(&self, plan: &Plan, outcome: usize) -> String {
        let names = plan.behaviour_names();
        let mut rest = outcome;
        let mut words = Vec::new();
        for (place, parts) in self.seen.iter().rev() {
            let part = rest % (parts.len() + 1);
            rest /= parts.len() + 1;
            let name = names[*place];
            words.push(match (parts.as_slice(), part) {
                ([_], 0) => format!("not {name}"),
                ([_], _) => name.to_owned(),
                (parts, 0) => format!("{name} below {}", parts[0]),
                (parts, part) if part == parts.len() => format!("{name} from {}", parts[part - 1]),
                (parts, part) => format!("{name} {} to {}", parts[part - 1], parts[part]),
            });
        }
        words.reverse();
        words.join(", ")
    }
}

/// What the trials of a design tell of its groups.
#[derive(Clone, Debug)]
pub struct Telling {
    /// The environments, by the attempts that made them.
    pub attempts: Vec<u64>,
    /// How probable outcomes are in each.
    pub questions: Vec<Question>,
    /// The place of the one in which a trial is expected to tell most.
    pub chosen: usize,
}

/// The outcomes of the trials in an environment, `[trials][groups]`: a trial has the same seed for all groups.
fn observed(results: &Results<'_>, asked: &Inverse, attempt: u64) -> Vec<Vec<Option<usize>>> {
    let trials = |group: usize| results.trials.get(&attempt).and_then(|all| all.get(group));
    let outcome = |group: usize, trial: usize| trials(group).and_then(|all| asked.outcome(all.built.get(trial)?));
    let groups = results.plan.populations.len();
    (0..results.plan.form.trials).map(|trial| (0..groups).map(|group| outcome(group, trial)).collect()).collect()
}

/// How often each outcome came, `[groups][outcomes]`.
fn counts(results: &Results<'_>, asked: &Inverse, attempt: u64) -> Vec<Vec<u64>> {
    let mut counts = vec![vec![0; asked.outcomes()]; results.plan.populations.len()];
    for trial in observed(results, asked, attempt) {
        for (row, outcome) in counts.iter_mut().zip(trial) {
            if let Some(outcome) = outcome {
                row[outcome] += 1;
            }
        }
    }
    counts
}

impl Telling {
    /// What the trials tell.
    ///
    /// # Errors
    /// None that a plan allows.
    pub fn of(results: &Results<'_>, asked: &Inverse) -> Result<Self, String> {
        let question = |attempt: &u64| Question::of_counts(&counts(results, asked, *attempt));
        let questions = results.tried.iter().map(question).collect::<Result<Vec<_>, _>>();
        let questions = questions.map_err(|error| error.to_string())?;
        let chosen = most_telling(&questions, &asked.prior);
        Ok(Self { attempts: results.tried.clone(), questions, chosen })
    }
}

/// How the environment of the next trial is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Always the one that tells most beforehand.
    Chosen,
    /// The one that tells most after what was seen.
    Greedy,
    /// Drawn uniformly for each trial.
    Drawn,
    /// One for all trials, drawn uniformly beforehand: the mean over all environments.
    Average,
}

impl Way {
    /// All, with their words and what they are.
    pub const ALL: [(Self, &'static str, &'static str); 4] = [
        (Self::Chosen, "chosen", "always the environment that tells most beforehand"),
        (Self::Average, "average", "one environment for all trials, the mean over all environments"),
        (Self::Greedy, "greedy", "for each trial the one that tells most after what was seen"),
        (Self::Drawn, "drawn", "for each trial one drawn uniformly"),
    ];
}

/// What was seen of unknown groups: of a group by its place, a number of the unknown one, and an environment by its attempt, the
/// trials in order.
pub type Streams = BTreeMap<(u64, u64, u64), Vec<Tried>>;

/// How an unknown group was identified.
#[derive(Clone, Debug)]
pub struct Identified {
    /// Greedily.
    greedy: Course,
    /// In environments drawn trial by trial.
    drawn: Course,
    /// In each environment alone.
    alone: Vec<Course>,
}

/// Identifies an unknown group; `see` gives the outcome of a trial in an environment, by their places, and none where it does
/// not know it.
fn identified(
    plan: &Plan,
    asked: &Inverse,
    telling: &Telling,
    number: u64,
    see: &mut dyn FnMut(usize, usize) -> Option<Option<usize>>,
) -> Option<Identified> {
    let (questions, ending) = (&telling.questions, asked.ending);
    let mut course =
        |choose: &dyn Fn(usize, &[f64]) -> usize| identify(questions, &asked.prior, ending, choose, &mut *see);
    let all = questions.len();
    let seed = child_seed(plan.form.seed, UNKNOWN, number, 0);
    let drawn = |trial: usize, _: &[f64]| {
        let place = uniform(seed, Purpose::Search, trial as u64, 0) * all as f64;
        (place as usize).min(all - 1)
    };
    let alone = (0..all).map(|place| course(&|_, _| place)).collect::<Option<Vec<_>>>()?;
    let greedy = course(&|_, belief| most_telling(questions, belief))?;
    Some(Identified { greedy, drawn: course(&drawn)?, alone })
}

/// An unknown group: the place of what it is in truth, and its number.
pub type Unknown = (u64, u64);

/// The unknown groups that are to be identified.
fn unknown(plan: &Plan, asked: &Inverse) -> impl Iterator<Item = Unknown> {
    let (groups, each) = (plan.populations.len() as u64, asked.identifications as u64);
    (0..groups).flat_map(move |group| (1..=each).map(move |number| (group, number)))
}

fn seen(
    asked: &Inverse,
    telling: &Telling,
    streams: &Streams,
    unknown: Unknown,
    at: (usize, usize),
) -> Option<Option<usize>> {
    let attempt = *telling.attempts.get(at.0)?;
    streams.get(&(unknown.0, unknown.1, attempt))?.get(at.1).map(|tried| asked.outcome(tried))
}

/// The unknown groups of which more has to be seen.
pub fn missing(plan: &Plan, asked: &Inverse, telling: &Telling, streams: &Streams) -> Vec<Unknown> {
    let lacks = |unknown: &Unknown| {
        let mut see = |place, trial| seen(asked, telling, streams, *unknown, (place, trial));
        identified(plan, asked, telling, unknown.1, &mut see).is_none()
    };
    unknown(plan, asked).filter(lacks).collect()
}

/// The seed of a trial of an unknown group: the same whatever the group is in truth.
fn seed_of(plan: &Plan, attempt: u64, number: u64, trial: usize) -> u64 {
    let unknown = child_seed(child_seed(plan.form.seed, CANDIDATE, attempt, 0), UNKNOWN, number, 0);
    child_seed(unknown, TRIAL, trial as u64, 0) >> 1
}

/// What is seen beyond what is known of an unknown group, by environment; none where it was stopped.
///
/// # Errors
/// An environment without a meaning, in a sentence.
pub fn observe(
    results: &Results<'_>,
    asked: &Inverse,
    telling: &Telling,
    streams: &Streams,
    unknown: Unknown,
    stop: &dyn Fn() -> bool,
) -> Result<Option<Vec<(u64, Vec<Tried>)>>, String> {
    let plan = results.plan;
    let population = &plan.populations[unknown.0 as usize];
    let mut places = Vec::new();
    for attempt in &telling.attempts {
        let found = results.survey.feasible.iter().find(|(own, _)| own == attempt);
        let Some((_, construct)) = found else { return Ok(None) };
        let scenario = population.among(plan.workspace.workspace.geometry.iter().chain(construct.geometry()));
        let behaviours = plan
            .behaviours(population, construct, true)
            .map_err(|wrong| format!("candidate {attempt}, {}: {}", wrong.path, wrong.what))?;
        places.push((*attempt, scenario, behaviours));
    }
    let mut new: Vec<(u64, Vec<Tried>)> = telling.attempts.iter().map(|attempt| (*attempt, Vec::new())).collect();
    let mut see = |place: usize, trial: usize| {
        if let Some(outcome) = seen(asked, telling, streams, unknown, (place, trial)) {
            return Some(outcome);
        }
        let (attempt, scenario, behaviours) = &places[place];
        let there = streams.get(&(unknown.0, unknown.1, *attempt)).map_or(0, Vec::len);
        let own = &mut new[place].1;
        // trials in an environment are asked for one after another, by each way from the first on
        if there + own.len() == trial {
            let seed = seed_of(plan, *attempt, unknown.1, trial + 1);
            own.push(tried(scenario, population, behaviours, seed, stop)?.tried);
        }
        own.get(trial - there).map(|tried| asked.outcome(tried))
    };
    let done = identified(plan, asked, telling, unknown.1, &mut see);
    new.retain(|(_, trials)| !trials.is_empty());
    Ok(done.map(|_| new))
}

/// What came of the question which group it is.
pub struct Found<'a> {
    /// The plan.
    pub plan: &'a Plan,
    /// What was asked.
    pub asked: &'a Inverse,
    /// What the trials tell.
    pub telling: Telling,
    /// The identifications, `[groups][numbers]`.
    courses: Vec<Vec<Identified>>,
}

impl<'a> Found<'a> {
    /// What came of it, where it was asked and nothing is missing.
    pub fn of(results: &Results<'a>, streams: &Streams) -> Option<Self> {
        let plan = results.plan;
        let asked = plan.inverse.as_ref()?;
        let telling = Telling::of(results, asked).ok()?;
        let mut courses = vec![Vec::new(); plan.populations.len()];
        for one in unknown(plan, asked) {
            let mut see = |place, trial| seen(asked, &telling, streams, one, (place, trial));
            courses[one.0 as usize].push(identified(plan, asked, &telling, one.1, &mut see)?);
        }
        Some(Self { plan, asked, telling, courses })
    }
    /// How much a trial in each environment is expected to tell; none where some group never was possible there.
    pub fn estimates(&self, results: &Results<'_>) -> Vec<Option<Estimate>> {
        let one = |attempt: &u64| {
            let observed = observed(results, self.asked, *attempt);
            estimated(
                &self.asked.prior,
                &observed,
                self.asked.outcomes(),
                child_seed(self.plan.form.seed, UNKNOWN, 0, 1),
            )
        };
        self.telling.attempts.iter().map(one).collect()
    }
    /// The courses of an identification by a way; several of the average.
    fn by<'b>(&self, one: &'b Identified, way: Way) -> &'b [Course] {
        match way {
            Way::Greedy => std::slice::from_ref(&one.greedy),
            Way::Drawn => std::slice::from_ref(&one.drawn),
            Way::Average => &one.alone,
            Way::Chosen => one.alone.get(self.telling.chosen).map_or(&[], std::slice::from_ref),
        }
    }
    /// All courses by a way, each with the place of the true group; identifications as often as they were drawn, of one group or of
    /// all.
    pub fn courses(&self, way: Way, group: Option<usize>, drawn: Option<&[usize]>) -> Vec<(usize, &Course)> {
        self.picked(&|one| self.by(one, way), group, drawn)
    }
    /// The courses in one environment alone.
    pub fn alone(&self, place: usize, drawn: Option<&[usize]>) -> Vec<(usize, &Course)> {
        self.picked(&|one| one.alone.get(place).map_or(&[], std::slice::from_ref), None, drawn)
    }
    fn picked<'b>(
        &'b self,
        of: &dyn Fn(&'b Identified) -> &'b [Course],
        group: Option<usize>,
        drawn: Option<&[usize]>,
    ) -> Vec<(usize, &'b Course)> {
        let whole: Vec<usize> = (0..self.each()).collect();
        let mut all = Vec::new();
        for (truth, own) in
            self.courses.iter().enumerate().filter(|(truth, _)| group.is_none_or(|group| group == *truth))
        {
            for one in drawn.unwrap_or(&whole).iter().filter_map(|one| own.get(*one)) {
                all.extend(of(one).iter().map(|course| (truth, course)));
            }
        }
        all
    }
    /// Identifications of each group.
    fn each(&self) -> usize {
        self.courses.iter().map(Vec::len).min().unwrap_or(0)
    }
}

/// What came of some courses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sum {
    /// Mean number of trials; those that ended without a name count with all that were made.
    pub needed: f64,
    /// Share in which a group was named.
    pub identified: f64,
    /// Share of these in which it was the true one.
    pub right: f64,
}

impl Sum {
    /// Over courses, each with the place of the true group. Not numbers where there are none.
    pub fn of(courses: &[(usize, &Course)]) -> Self {
        let count = |of: &dyn Fn(usize, &Course) -> bool| {
            courses.iter().filter(|(truth, course)| of(*truth, course)).count() as f64
        };
        let all = courses.len() as f64;
        let named = count(&|_, course| course.named.is_some());
        Self {
            needed: courses.iter().map(|(_, course)| course.trials.len()).sum::<usize>() as f64 / all,
            identified: named / all,
            right: count(&|truth, course| course.named == Some(truth)) / named,
        }
    }
}

/// What statements can ask for, with what it is.
pub const NAMES: [(&str, &str); 3] = [
    ("needed", "mean number of trials until a group is named; `most` where none is"),
    ("identified", "share of unknown groups that are named"),
    ("right", "share of those named that are what they are named"),
];

impl Data for Found<'_> {
    /// Identifications are drawn again, by their numbers: all ways see the same trials, so that differences stay paired.
    fn items(&self) -> usize {
        self.each()
    }
    fn value(
        &self,
        name: &str,
        selectors: &[Selector],
        bytes: &Range<usize>,
        drawn: Option<&[usize]>,
    ) -> Result<Value, Mistake> {
        known(name, &NAMES, bytes, "an identification")?;
        let ways = Way::ALL.map(|(_, word, _)| word);
        let groups: Vec<&str> = self.plan.populations.iter().map(|population| population.name.as_str()).collect();
        let (mut way, mut group) = (None, None);
        for selector in selectors {
            let (list, place) = match selector.factor.as_str() {
                "by" => (&ways[..], &mut way),
                "population" => (&groups[..], &mut group),
                other => {
                    let help = hint(other, &["by", "population"]);
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
        let Some(way) = way else {
            let text = format!("there are several ways, so that `{name}` needs [by = ...]");
            return Err(Mistake { help: format!("one of {}", ways.join(", ")), ..Mistake::new(bytes.clone(), text) });
        };
        let sum = Sum::of(&self.courses(Way::ALL[way].0, group, drawn));
        Ok(Value::Number(match name {
            "needed" => sum.needed,
            "identified" => sum.identified,
            _ => sum.right,
        }))
    }
}
