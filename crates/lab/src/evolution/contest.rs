//! Contests: champions meet what is good without a search, all in the same fresh worlds.
//!
//! What is chosen among many (the best single change, the best of many drawn at random) is chosen in worlds of its own, so
//! that nobody enters the contest with the luck by which it was chosen.

use super::evaluate::{self, Stage};
use super::execute::Run;
use super::form;
use super::plan::Plan;
use core::ops::ControlFlow;
use search::Axis;
use space::random::child_seed;
use std::collections::BTreeMap;

/// The reference as a contender.
pub const REFERENCE: &str = "reference";
/// The champion as a contender.
pub const CHAMPION: &str = "champion";
/// The best change of a single gene as a contender.
pub const SINGLE: &str = "single";
/// The best of many drawn at random as a contender.
pub const RANDOM: &str = "random";

/// What the candidates that are drawn at random get their seed by.
const DRAWN: u32 = 6;

/// Somebody in a contest.
#[derive(Clone, Debug, PartialEq)]
pub struct Contender {
    /// Its name.
    pub name: String,
    /// Its genes.
    pub genes: Vec<f64>,
    /// Score and what is kept, `[worlds][1 + kept]`.
    pub worlds: Vec<Vec<f64>>,
}

impl Contender {
    /// Its scores, `[worlds]`.
    pub fn scores(&self) -> Vec<f64> {
        self.worlds.iter().map(|row| row[0]).collect()
    }
}

/// A contest that is over.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contest {
    /// Reference, champion, those of the file, and the champion of each run.
    pub contenders: Vec<Contender>,
}

impl Contest {
    /// A contender by its name.
    pub fn find(&self, name: &str) -> Option<&Contender> {
        self.contenders.iter().find(|who| who.name == name)
    }
}

/// Name of the champion of a run, which counts from 0, as a contender.
pub fn of_run(run: usize) -> String {
    format!("run_{}", run + 1)
}

/// What was found out of candidates, by stage and genes: score and what is kept, `[worlds][1 + kept]`.
pub type Tried = BTreeMap<(Stage, Vec<u64>), Vec<Vec<f64>>>;

/// The genes as a key.
pub fn key(genes: &[f64]) -> Vec<u64> {
    genes.iter().map(|gene| gene.to_bits()).collect()
}

/// Numbers of worlds: in which contenders are chosen, and in which they meet.
pub fn worlds(plan: &Plan, form: &form::Contest) -> (usize, usize) {
    if plan.quick { (1, form.quick_worlds) } else { (form.chosen_in, form.worlds) }
}

/// Names of the contenders of an evolution, apart from the champions of its runs.
pub fn names(form: &form::Contest) -> Vec<&str> {
    let mut names = vec![REFERENCE, CHAMPION];
    names.extend((!form.single.is_empty()).then_some(SINGLE));
    names.extend((form.random > 0).then_some(RANDOM));
    names.extend(form.without.0.iter().map(|(name, _)| name.as_str()));
    names
}

/// Candidates to choose the best of, by the name of the contender that it becomes.
fn offered(plan: &Plan, form: &form::Contest) -> Result<Vec<(&'static str, Vec<Vec<f64>>)>, search::SearchError> {
    let reference = plan.reference();
    let changed = |axis: usize, factor: f64| {
        let mut genes = reference.clone();
        genes[axis] = plan.axes[axis].axis.inside(genes[axis] * factor);
        genes
    };
    let mut single: Vec<Vec<f64>> = Vec::new();
    for axis in 0..plan.axes.len() {
        single.extend(form.single.iter().map(|&factor| changed(axis, factor)));
    }
    let count = if plan.quick { form.random.div_ceil(10) } else { form.random };
    let starts = plan.axes.iter().map(|gene| Axis { low: gene.start.0, high: gene.start.1, ..gene.axis });
    let seed = child_seed(plan.form.seed, DRAWN, 0, 0);
    let random = search::genetic::Genetic::random(&search::Domain::new(starts.collect())?, count, seed);
    Ok([(SINGLE, single), (RANDOM, random)].into_iter().filter(|(_, list)| !list.is_empty()).collect())
}

/// Holds the contest of the runs of a plan. `tried` has what is known already; what is found out is told to `note`, which says
/// whether to go on. None where it was stopped or there is no contest.
///
/// # Errors
/// What makes a world impossible, in a sentence.
pub fn held(
    plan: &Plan,
    runs: &[Run],
    tried: &mut Tried,
    threads: usize,
    stop: &(dyn Fn() -> bool + Sync),
    note: &mut dyn FnMut(Stage, &[f64], &[Vec<f64>]) -> ControlFlow<()>,
) -> Result<Option<Contest>, String> {
    let Some(form) = &plan.form.contest else { return Ok(None) };
    let (choosing, meeting) = worlds(plan, form);
    let mut find_out = |stage: Stage, candidates: &[Vec<f64>]| -> Result<Option<Vec<Vec<Vec<f64>>>>, String> {
        let count = if stage == Stage::Choose { choosing } else { meeting };
        let known =
            |genes: &[f64], tried: &Tried| tried.get(&(stage, key(genes))).filter(|rows| rows.len() == count).cloned();
        // a few at a time, so that little is lost by a stop
        let missing: Vec<Vec<f64>> = candidates.iter().filter(|genes| known(genes, tried).is_none()).cloned().collect();
        for part in missing.chunks(PART) {
            let Some(found) = evaluate::tried(plan, (stage, 1), part, count, threads, stop)? else { return Ok(None) };
            for (genes, rows) in part.iter().zip(found) {
                if note(stage, genes, &rows).is_break() {
                    return Ok(None);
                }
                tried.insert((stage, key(genes)), rows);
            }
        }
        Ok(candidates.iter().map(|genes| known(genes, tried)).collect())
    };
    let mean = |rows: &[Vec<f64>]| rows.iter().map(|row| row[0]).sum::<f64>() / rows.len() as f64;
    let mut contenders = vec![(REFERENCE.to_owned(), plan.reference())];
    let own: Vec<Option<(Vec<f64>, f64)>> =
        runs.iter().map(|run| run.champion(plan).map(|(genes, score)| (genes.to_vec(), score))).collect();
    let best = own.iter().flatten().reduce(|best, other| if other.1 > best.1 { other } else { best });
    if let Some((champion, _)) = best {
        contenders.push((CHAMPION.to_owned(), champion.clone()));
        for (name, genes) in &form.without.0 {
            let held = |(gene, axis): (&f64, &super::plan::GeneAxis)| {
                if genes.contains(&axis.name) { axis.axis.reference } else { *gene }
            };
            contenders.push((name.clone(), champion.iter().zip(&plan.axes).map(held).collect()));
        }
    }
    for (name, candidates) in offered(plan, form).map_err(|error| error.to_string())? {
        let Some(found) = find_out(Stage::Choose, &candidates)? else { return Ok(None) };
        let scored = candidates.into_iter().zip(found.iter().map(|rows| mean(rows)));
        let finite = scored.filter(|(_, score)| score.is_finite());
        if let Some((genes, _)) = finite.reduce(|best, other| if other.1 > best.1 { other } else { best }) {
            contenders.push((name.to_owned(), genes));
        }
    }
    for (run, champion) in own.into_iter().enumerate() {
        contenders.extend(champion.map(|(genes, _)| (of_run(run), genes)));
    }
    let genes: Vec<Vec<f64>> = contenders.iter().map(|(_, genes)| genes.clone()).collect();
    let Some(found) = find_out(Stage::Contest, &genes)? else { return Ok(None) };
    let contender = |((name, genes), worlds)| Contender { name, genes, worlds };
    Ok(Some(Contest { contenders: contenders.into_iter().zip(found).map(contender).collect() }))
}

/// Candidates that are tried before they are noted.
const PART: usize = 32;
