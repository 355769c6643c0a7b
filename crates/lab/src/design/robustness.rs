//! How much the best environments may be off: copies of them that are changed a little are tried, and the share that still succeeds
//! is told by the size of the change.

use super::export::best;
use super::form::{ByWord, Robustness};
use super::plan::Plan;
use super::results::Results;
use crate::environment::trial;
use crate::report::{Axis, Line, Lines};
use crate::store::StoreError;
use crate::store::folder::Folder;
use crate::store::table::{Heading, Kind, Values, write_table};
use space::random::child_seed;
use std::collections::BTreeMap;
use terrain::Draws;

/// A row for each perturbation and size.
pub const ROBUSTNESS: &str = "robustness.parquet";
/// Kind of child seeds, beside those of candidates and trials: a changed copy.
const COPY: u32 = 8;

/// A changed copy: attempt of the environment, place of the perturbation, place of the size, number of the copy.
pub type Changed = (u64, u64, u64, u64);

/// The fitness of each copy that was tried.
pub type Copies = BTreeMap<Changed, f64>;

/// The places of the group and the behaviour that are asked about.
fn asked(plan: &Plan, form: &Robustness) -> (usize, usize) {
    let place = |name: &Option<String>, names: Vec<&str>| {
        name.as_ref().and_then(|name| names.iter().position(|known| known == name)).unwrap_or(0)
    };
    let groups = plan.populations.iter().map(|population| population.name.as_str()).collect();
    (place(&form.population, groups), place(&form.behaviour, plan.behaviour_names()))
}

/// The copies that are to be tried, in order.
pub fn copies(results: &Results<'_>) -> Vec<Changed> {
    let plan = results.plan;
    let Some(form) = &plan.form.robustness else { return Vec::new() };
    let (group, behaviour) = asked(plan, form);
    let mut copies = Vec::new();
    for (attempt, _) in best(results, group, behaviour, form.environments) {
        for (k, perturbation) in form.perturbation.iter().enumerate() {
            for size in 0..perturbation.sizes.len() {
                copies.extend((0..form.copies).map(|copy| (attempt, k as u64, size as u64, copy as u64)));
            }
        }
    }
    copies
}

/// Tries a copy; none where it was stopped.
///
/// # Errors
/// A copy without a meaning, in a sentence.
pub fn tried(results: &Results<'_>, copy: &Changed, stop: &dyn Fn() -> bool) -> Result<Option<f64>, String> {
    let plan = results.plan;
    let Some(form) = &plan.form.robustness else { return Ok(None) };
    let &(attempt, perturbation, size, number) = copy;
    let (group, behaviour) = asked(plan, form);
    let of = &form.perturbation[perturbation as usize];
    let Some((_, construct)) = results.survey.feasible.iter().find(|(own, _)| *own == attempt) else { return Ok(None) };
    // the same draws for every size: what is shown is the size alone
    let seed = child_seed(plan.seed_of(attempt, 0), COPY, number, perturbation as u32) >> 1;
    let changed = of.by.perturbation().apply(construct, of.sizes[size as usize], &Draws::new(seed, 0, 0));
    let population = &plan.populations[group];
    let geometry = plan.workspace.workspace.geometry.iter().chain(changed.geometry());
    let scenario = population.among(geometry);
    let mut wanted =
        plan.behaviours(population, &changed, true).map_err(|wrong| format!("{}: {}", wrong.path, wrong.what))?;
    // without the others a trial ends as soon as this one is settled; stages need each other
    let place = if wanted.relay.is_none() {
        wanted.behaviours = vec![wanted.behaviours.swap_remove(behaviour)];
        0
    } else {
        behaviour
    };
    match trial::relayed(&scenario, population, &wanted, seed, stop, &mut |_| ()) {
        Err(_) => Ok(Some(0.0)),
        Ok(tried) => Ok(tried.and_then(|told| told.tried.outcomes.get(place).map(|outcome| outcome.fitness))),
    }
}

/// By perturbation and size: the number of copies, and how many succeeded.
fn counted(plan: &Plan, copies: &Copies) -> BTreeMap<(u64, u64), (u64, u64)> {
    let mut counts: BTreeMap<(u64, u64), (u64, u64)> = BTreeMap::new();
    for ((_, perturbation, size, _), fitness) in copies {
        let count = counts.entry((*perturbation, *size)).or_default();
        count.0 += 1;
        count.1 += u64::from(*fitness >= plan.form.success);
    }
    counts
}

/// Writes the table.
///
/// # Errors
/// Where the system refuses.
pub fn write(folder: &Folder, results: &Results<'_>, copies: &Copies) -> Result<(), StoreError> {
    let plan = results.plan;
    let Some(form) = &plan.form.robustness else { return Ok(()) };
    let rows: Vec<_> = counted(plan, copies).into_iter().collect();
    let of = |k: u64| &form.perturbation[k as usize];
    let interval = |&(_, (all, held)): &((u64, u64), (u64, u64)), high: bool| {
        let found = measure::statistics::wilson(held, all, 0.95);
        found.map_or(f64::NAN, |interval| if high { interval.high } else { interval.low })
    };
    let headings = [
        Heading::new("perturbation", "", "How environments were changed.", Kind::Word),
        Heading::new("size", "", "By how much.", Kind::Double),
        Heading::new("copies", "1", "Changed copies that were tried.", Kind::Long),
        Heading::new("rate", "1", "Share that still succeeded.", Kind::Double),
        Heading::new("rate_low", "1", "Lower end of its 95 % Wilson interval.", Kind::Double),
        Heading::new("rate_high", "1", "Upper end of its 95 % Wilson interval.", Kind::Double),
    ];
    let columns = [
        super::tables::words(rows.iter().map(|((k, _), _)| of(*k).by.word().to_owned())),
        Values::Double(rows.iter().map(|((k, size), _)| of(*k).sizes[*size as usize]).collect()),
        Values::Long(rows.iter().map(|(_, (all, _))| *all as i64).collect()),
        Values::Double(rows.iter().map(|(_, (all, held))| *held as f64 / *all as f64).collect()),
        Values::Double(rows.iter().map(|row| interval(row, false)).collect()),
        Values::Double(rows.iter().map(|row| interval(row, true)).collect()),
    ];
    write_table(folder, ROBUSTNESS, &headings, &columns, &[])
}

/// A figure for each perturbation.
pub fn figures(results: &Results<'_>, copies: &Copies) -> Vec<Lines> {
    let plan = results.plan;
    let Some(form) = &plan.form.robustness else { return Vec::new() };
    let counts = counted(plan, copies);
    let (group, behaviour) = asked(plan, form);
    let figure = |(k, perturbation): (usize, &super::form::PerturbationForm)| {
        let mut points: Vec<(f64, f64)> = Vec::new();
        for (size, value) in perturbation.sizes.iter().enumerate() {
            if let Some((all, held)) = counts.get(&(k as u64, size as u64)) {
                points.push((*value, *held as f64 / *all as f64));
            }
        }
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (x, y): (Vec<f64>, Vec<Option<f64>>) = points.into_iter().map(|(x, y)| (x, Some(y))).unzip();
        let unit = match perturbation.by {
            ByWord::Joints | ByWord::Shift => plan.populations[group].scenario.units.length.clone(),
            ByWord::Turn => "deg".to_owned(),
            ByWord::Shorten | ByWord::Remove => String::new(),
        };
        Lines {
            id: format!("robustness-{}", perturbation.by.word()),
            title: format!("Environments that are off: {}", perturbation.by.word()),
            about: format!(
                "Share of changed copies of the {} best environments in which {} still did what is wanted ({}).",
                form.environments,
                plan.populations[group].name,
                plan.behaviour_names()[behaviour]
            ),
            x: Axis { label: "size of the change".into(), unit, range: None },
            y: Axis { label: "share of successes".into(), unit: String::new(), range: Some((0.0, 1.0)) },
            lines: vec![Line { name: plan.populations[group].name.clone(), x, y }],
        }
    };
    form.perturbation.iter().enumerate().map(figure).collect()
}
