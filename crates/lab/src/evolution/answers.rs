//! What an evolution file asks of its results: figures, tests and statements over runs and contenders.
//!
//! Runs are to an evolution what trials are to a study, so that the results are put as those of a study: in its part `runs` a
//! cell is a variant and a trial a run; in its part `contest` a cell is a contender and a trial a world.

use super::contest::{self, Contest, REFERENCE};
use super::evaluate::followed;
use super::execute::{Generation, Run};
use super::form::Search;
use super::plan::Plan;
use super::tables::Spread;
use super::variants::Variants;
use crate::file::{Desk, Node, Sources};
use crate::study::claims;
use crate::study::execute::Results;
use crate::study::form::{ObstacleReading, Quantity, Reading};
use crate::study::plan::{Cell, Condition, Level, Part, Plan as Study, Varied};
use core::ops::Range;
use measure::statistics::linear_regression;
use std::collections::BTreeMap;

/// The part of runs.
const RUNS: &str = "runs";
/// The part of contenders.
const CONTEST: &str = "contest";
/// The factor of a contest.
const WHO: &str = "who";
/// The last share of the generations, over which the end is averaged; as many at the start.
const SHARE: f64 = 0.1;

/// What is read off a run, apart from what a file names.
const OF_RUN: [(&str, &str); 10] = [
    ("slope", "Slope of the mean fitness per 1000 generations"),
    ("start", "Mean fitness in the first tenth of the generations"),
    ("end", "Mean fitness in the last tenth of the generations"),
    ("highest", "Highest mean fitness of a generation"),
    ("lowest", "Lowest mean fitness of a generation"),
    ("differential", "Mean fitness of the parents less that of all, the mean over generations"),
    ("drift", "Standard deviation of the change of the mean fitness from one generation to the next"),
    ("champion", "Fitness of the champion"),
    ("margin", "Fitness of the champion less that of the reference in the worlds of the contest"),
    ("won", "Share of the worlds of the contest in which the champion beats the reference"),
];

/// The results, as those of a study.
pub fn of(variants: &Variants, runs: &[Run], contests: &[Contest]) -> (Study, Results) {
    let study = study(variants);
    let mut results: Results = Vec::with_capacity(study.cells.len());
    for (variant, plan) in variants.plans.iter().enumerate() {
        let own = &runs[variant * variants.runs()..][..variants.runs()];
        let contest = contests.get(variant);
        let row =
            |(run, one): (usize, &Run)| (run + 1, padded(of_run(plan, run, one, contest), 0, study.readings.len()));
        results.push(own.iter().enumerate().map(row).collect());
    }
    let first = of_run_names(variants.first()).len();
    for cell in &study.cells[variants.plans.len()..] {
        let (who, levels) = cell.levels.split_last().map_or((0, &[][..]), |(who, levels)| (*who, levels));
        let variant = variants.levels.iter().position(|own| own == levels).unwrap_or(0);
        let name = &study.parts[1].factors[levels.len()].levels[who].text;
        let found = contests.get(variant).and_then(|contest| contest.find(name));
        let row = |(world, row): (usize, &Vec<f64>)| (world + 1, padded(row.clone(), first, study.readings.len()));
        results.push(found.map_or_else(BTreeMap::new, |who| who.worlds.iter().enumerate().map(row).collect()));
    }
    (study, results)
}

/// Notes what is wrong with what a file asks.
pub(super) fn check(variants: &Variants, file: &Node, sources: &Sources, desk: &mut Desk) {
    let plan = variants.first();
    if let Some(contest) = &plan.form.contest {
        let axes: Vec<&str> = plan.axes.iter().map(|axis| axis.name.as_str()).collect();
        for (name, genes) in &contest.without.0 {
            let place = file.place(&format!("contest.without.{name}"));
            if [REFERENCE, contest::CHAMPION, contest::SINGLE, contest::RANDOM].contains(&name.as_str()) {
                desk.problem(&place, format!("another contender is called `{name}`"), "another name", "");
            }
            for gene in genes.iter().filter(|gene| !axes.contains(&gene.as_str())) {
                let near = space::spelling::nearest(gene, axes.iter().copied());
                let help = near.map_or_else(String::new, |near| format!("did you mean `{near}`?"));
                desk.problem(&place, format!("no gene is called `{gene}`"), "names of genes as in the tables", help);
            }
        }
    }
    let study = study(variants);
    claims::check(&study, 0, file, sources, desk);
    if let (Some(tree), true) = (file.get(CONTEST), study.parts.len() > 1) {
        claims::check(&study, 1, tree, sources, desk);
    }
}

/// The evolution as a study without results.
fn study(variants: &Variants) -> Study {
    let plan = variants.first();
    let mut study = Study { parts: Vec::new(), cells: Vec::new(), conditions: Vec::new(), ..plan.readings.clone() };
    study.seed = plan.form.seed;
    // what is read is known to this module alone
    let nothing = Quantity::ObstacleDistance(ObstacleReading { scale: 1.0 });
    let reading = |(name, about, unit): (String, String, String)| (name, Reading { about, unit, of: nothing.clone() });
    study.readings = of_run_names(plan).into_iter().chain(of_contender_names(plan)).map(reading).collect();
    let all: Vec<Vec<usize>> = variants.levels.clone();
    let form = &plan.form;
    let part = |name: &str, factors: Vec<Varied>, cells: Range<usize>| Part {
        name: name.to_owned(),
        title: String::new(),
        about: String::new(),
        factors,
        cells,
        figures: Vec::new(),
        tests: Vec::new(),
        claims: Vec::new(),
    };
    let add = |study: &mut Study, number: usize, levels: Vec<usize>, variant: usize, trials: usize| {
        let plan = &variants.plans[variant];
        study.cells.push(Cell { part: number, levels, condition: study.conditions.len(), trials });
        study.conditions.push(Condition {
            scenario: plan.scenario.clone(),
            tree: plan.tree.clone(),
            identity: serde_json::Value::Null,
            key: [0; 2],
            schedule: plan.schedule,
            agents: plan.agents,
            trials,
        });
    };
    for (variant, levels) in all.iter().enumerate() {
        add(&mut study, 0, levels.clone(), variant, variants.runs());
    }
    let mut runs = part(RUNS, variants.factors.clone(), 0..all.len());
    (runs.figures, runs.tests, runs.claims) = (form.figure.clone(), form.test.clone(), form.claim.clone());
    study.parts.push(runs);
    if let Some(contest) = &form.contest {
        let level = |name: &str| Level { text: name.to_owned(), number: None };
        let names: Vec<Level> = contest::names(contest).into_iter().map(level).collect();
        let worlds = contest::worlds(plan, contest).1;
        for (variant, levels) in all.iter().enumerate() {
            for who in 0..names.len() {
                add(&mut study, 1, [levels.as_slice(), &[who]].concat(), variant, worlds);
            }
        }
        let who = Varied { name: WHO.to_owned(), about: "contender".to_owned(), unit: String::new(), levels: names };
        let factors = variants.factors.iter().cloned().chain([who]).collect();
        let mut contenders = part(CONTEST, factors, all.len()..study.cells.len());
        (contenders.figures, contenders.tests) = (contest.figure.clone(), contest.test.clone());
        study.parts.push(contenders);
    }
    study
}

/// Name, what it is, and unit of each reading of a run.
fn of_run_names(plan: &Plan) -> Vec<(String, String, String)> {
    let mut names: Vec<(String, String, String)> =
        OF_RUN.iter().map(|(name, about)| ((*name).to_owned(), (*about).to_owned(), String::new())).collect();
    for name in plan.kept() {
        let about = |what: &str| format!("{name}, {what}");
        let unit = || unit_of(plan, name);
        names.push((format!("{name}_end"), about("mean of the last tenth of the generations"), unit()));
        names.push((format!("{name}_lowest"), about("lowest mean of a generation"), unit()));
    }
    let end = |name: &str, about: &str, unit: &str| {
        (format!("{name}_end"), format!("{about}, mean of the last tenth of the generations"), unit.to_owned())
    };
    names.extend(plan.axes.iter().map(|gene| end(&gene.name, &gene.about, &gene.unit)));
    names.extend(plan.follow.iter().map(|(name, _)| end(name, name, "")));
    names
}

/// The unit of what is kept under a name: that of the reading.
pub(super) fn unit_of(plan: &Plan, name: &str) -> String {
    let known = plan.readings.readings.iter().find(|(own, _)| own == name);
    known.map(|(_, reading)| reading.unit.clone()).unwrap_or_default()
}

/// The same of a contender in a world.
fn of_contender_names(plan: &Plan) -> Vec<(String, String, String)> {
    if plan.form.contest.is_none() {
        return Vec::new();
    }
    let kept = plan.kept().into_iter().map(|name| (name.to_owned(), name.to_owned(), unit_of(plan, name)));
    core::iter::once(("fitness".to_owned(), "Fitness".to_owned(), String::new())).chain(kept).collect()
}

/// The readings of a run, in the order of their names.
fn of_run(plan: &Plan, run: usize, one: &Run, contest: Option<&Contest>) -> Vec<f64> {
    let generations = &one.generations;
    let means: Vec<f64> = generations.iter().map(|one| Spread::of(plan.own(&one.evaluated.scores)).mean).collect();
    let part = ((generations.len() as f64 * SHARE).ceil() as usize).max(1).min(generations.len());
    let last = generations.len() - part;
    let numbers: Vec<f64> = (0..means.len()).map(|k| k as f64).collect();
    let slope = linear_regression(&numbers, &means, 0.95).map_or(f64::NAN, |line| 1000.0 * line.slope);
    let changes: Vec<f64> = means.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let (lowest, highest) = ends(&means);
    let (margin, won) = against_reference(run, contest);
    let mut row = vec![
        slope,
        mean(means[..part].iter().copied()),
        mean(means[last..].iter().copied()),
        highest,
        lowest,
        differential(plan, plan.seed_of(run + 1), generations),
        Spread::of(&changes).deviation,
        one.champion(plan).map_or(f64::NAN, |(_, score)| score),
        margin,
        won,
    ];
    for k in 0..plan.kept().len() {
        let of = |one: &Generation| mean(one.evaluated.kept.iter().map(|row| row[k]));
        row.push(mean(generations[last..].iter().map(of)));
        row.push(ends(&generations.iter().map(of).collect::<Vec<_>>()).0);
    }
    let candidates = || generations[last..].iter().flat_map(|one| plan.own(&one.candidates));
    row.extend((0..plan.axes.len()).map(|gene| mean(candidates().map(|genes| genes[gene]))));
    let follow: Vec<Vec<f64>> =
        if plan.follow.is_empty() { Vec::new() } else { candidates().map(|genes| followed(plan, genes)).collect() };
    row.extend((0..plan.follow.len()).map(|k| mean(follow.iter().map(|values| values[k]))));
    row
}

/// A row that begins at a place among all readings; those of other parts are not numbers.
fn padded(row: Vec<f64>, first: usize, all: usize) -> Vec<f64> {
    let mut padded = vec![f64::NAN; all];
    for (to, value) in padded[first..].iter_mut().zip(row) {
        *to = value;
    }
    padded
}

/// The mean of those that are numbers.
fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.filter(|value| value.is_finite()).fold((0.0, 0.0), |(s, n), value| (s + value, n + 1.0));
    sum / count
}

/// The least and the greatest; not numbers where there are none.
fn ends(values: &[f64]) -> (f64, f64) {
    let spread = Spread::of(values);
    (spread.worst, spread.best)
}

/// Mean fitness of the parents less that of all, the mean over the generations that were bred from.
fn differential(plan: &Plan, seed: u64, generations: &[Generation]) -> f64 {
    let Search::Genetic(genetic) = &plan.form.search else { return f64::NAN };
    let operators = genetic.operators();
    let of = |(number, one): (usize, &Generation)| {
        let scores = plan.own(&one.evaluated.scores);
        let parents = operators.parents(scores, seed, number as u64);
        mean(parents.iter().map(|&parent| scores[parent])) - mean(scores.iter().copied())
    };
    mean(generations.iter().enumerate().map(of))
}

/// How far the champion of a run is above the reference in the worlds of a contest, and in what share of them.
fn against_reference(run: usize, contest: Option<&Contest>) -> (f64, f64) {
    let found = contest.and_then(|contest| Some((contest.find(&contest::of_run(run))?, contest.find(REFERENCE)?)));
    let Some((own, reference)) = found else { return (f64::NAN, f64::NAN) };
    let differences = || own.scores().into_iter().zip(reference.scores()).map(|(own, other)| own - other);
    (mean(differences()), mean(differences().map(|difference| f64::from(u8::from(difference > 0.0)))))
}
