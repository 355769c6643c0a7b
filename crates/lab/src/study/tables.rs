//! The tables of a study: a row for each trial of each condition, a row for each cell.

use super::execute::{CELLS, Results, TRIALS};
use super::plan::{Level, Plan};
use crate::store::StoreError;
use crate::store::folder::Folder;
use crate::store::table::{self, Heading, Kind, Values};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Names that columns have already.
pub const RESERVED: [&str; 6] = ["part", "cell", "condition", "trial", "seed", "trials"];

/// Mean, standard error and number of values that are there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Mean; not a number of no values.
    pub mean: f64,
    /// Standard error of the mean, `sd / sqrt(n)`; not a number of fewer than two values.
    pub error: f64,
    /// Number of values.
    pub count: usize,
}

impl Summary {
    /// Of values, of which some may be missing.
    pub fn of(values: impl Iterator<Item = f64>) -> Self {
        let values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
        let error = if values.len() > 1 { (squares / (n - 1.0) / n).sqrt() } else { f64::NAN };
        Self { mean, error, count: values.len() }
    }
}

/// The trials of a cell: those that its condition has, up to as many as the cell wants where it wants fewer.
pub fn of_cell<'a>(plan: &Plan, results: &'a Results, cell: usize) -> impl Iterator<Item = (usize, &'a Vec<f64>)> {
    let cell = &plan.cells[cell];
    let most = cell.trials;
    let more = plan.conditions[cell.condition].trials > most;
    results[cell.condition]
        .iter()
        .map(|(&trial, values)| (trial, values))
        .filter(move |(trial, _)| !more || *trial <= most)
}

/// Writes both tables.
///
/// # Errors
/// Where the system refuses.
pub fn write(folder: &Folder, plan: &Plan, results: &Results) -> Result<(), StoreError> {
    for (name, (headings, columns)) in [(TRIALS, trials(plan, results)), (CELLS, cells(plan, results))] {
        let notes = [("flockworks.title".to_owned(), plan.title.clone())];
        table::write_table(folder, name, &headings, &columns, &notes)?;
    }
    Ok(())
}

type Filled = (Vec<Heading>, Vec<Values>);

fn unit_of(plan: &Plan, unit: &str) -> String {
    unit.replace("length", &plan.units.0).replace("time", &plan.units.1)
}

/// A row for each trial of each condition.
fn trials(plan: &Plan, results: &Results) -> Filled {
    let mut headings = vec![
        Heading::new(
            "condition",
            "1",
            "Number of the condition, from 1; `cells` says which cells have it.",
            Kind::Long,
        ),
        Heading::new("trial", "1", "Number of the trial, from 1.", Kind::Long),
        Heading::new("seed", "1", "Seed of the trial.", Kind::Long),
    ];
    let rows = || results.iter().enumerate().flat_map(|(c, trials)| trials.iter().map(move |(t, v)| (c, *t, v)));
    let mut columns = vec![
        Values::Long(rows().map(|(condition, ..)| condition as i64 + 1).collect()),
        Values::Long(rows().map(|(_, trial, _)| trial as i64).collect()),
        Values::Long(rows().map(|(_, trial, _)| plan.seed_of(trial) as i64).collect()),
    ];
    for (k, (name, reading)) in plan.readings.iter().enumerate() {
        let about = if reading.about.is_empty() { name } else { &reading.about };
        headings.push(Heading::new(name, &unit_of(plan, &reading.unit), about, Kind::Double));
        columns.push(Values::Double(rows().map(|(_, _, values)| values[k]).collect()));
    }
    (headings, columns)
}

/// A row for each cell.
fn cells(plan: &Plan, results: &Results) -> Filled {
    let parts: Arc<Vec<String>> = Arc::new(plan.parts.iter().map(|part| part.name.clone()).collect());
    let mut headings = vec![
        Heading::new("part", "", "Part of the study.", Kind::Word),
        Heading::new("cell", "1", "Number of the cell, from 1.", Kind::Long),
        Heading::new("condition", "1", "Number of its condition in `trials`, from 1.", Kind::Long),
    ];
    let all = || plan.cells.iter();
    let mut columns = vec![
        Values::Word(all().map(|cell| cell.part as u32).collect(), parts),
        Values::Long((1..=plan.cells.len() as i64).collect()),
        Values::Long(all().map(|cell| cell.condition as i64 + 1).collect()),
    ];
    let mut factors: Vec<(&str, &str, &str)> = Vec::new();
    for factor in plan.parts.iter().flat_map(|part| &part.factors) {
        if factors.iter().all(|(name, ..)| *name != factor.name) {
            factors.push((&factor.name, &factor.unit, &factor.about));
        }
    }
    for (name, unit, about) in factors {
        let level = |cell: &super::plan::Cell| -> Option<&Level> {
            let part = &plan.parts[cell.part];
            let at = part.factors.iter().position(|factor| factor.name == name)?;
            Some(&part.factors[at].levels[cell.levels[at]])
        };
        let numeric = all().filter_map(level).all(|level| level.number.is_some());
        if numeric {
            headings.push(Heading::new(name, &unit_of(plan, unit), about, Kind::Double));
            let number = |cell| level(cell).and_then(|level| level.number).unwrap_or(f64::NAN);
            columns.push(Values::Double(all().map(number).collect()));
        } else {
            let mut words = vec![String::new()];
            let mut place = |text: &str| {
                words.iter().position(|word| word == text).unwrap_or_else(|| {
                    words.push(text.to_owned());
                    words.len() - 1
                }) as u32
            };
            let places = all().map(|cell| place(level(cell).map_or("", |level| level.text.as_str()))).collect();
            headings.push(Heading::new(name, "", about, Kind::Word));
            columns.push(Values::Word(places, Arc::new(words)));
        }
    }
    headings.push(Heading::new("trials", "1", "Number of trials.", Kind::Long));
    columns.push(Values::Long((0..plan.cells.len()).map(|k| of_cell(plan, results, k).count() as i64).collect()));
    for (k, (name, reading)) in plan.readings.iter().enumerate() {
        let about = if reading.about.is_empty() { name } else { &reading.about };
        let unit = unit_of(plan, &reading.unit);
        let summaries: Vec<Summary> = (0..plan.cells.len())
            .map(|cell| Summary::of(of_cell(plan, results, cell).map(|(_, values)| values[k])))
            .collect();
        headings.push(Heading::new(
            &format!("{name}_mean"),
            &unit,
            &format!("{about}: mean over trials."),
            Kind::Double,
        ));
        columns.push(Values::Double(summaries.iter().map(|s| s.mean).collect()));
        let text = format!("{about}: standard error of the mean.");
        headings.push(Heading::new(&format!("{name}_sem"), &unit, &text, Kind::Double));
        columns.push(Values::Double(summaries.iter().map(|s| s.error).collect()));
        let text = format!("{about}: number of trials that have it.");
        headings.push(Heading::new(&format!("{name}_n"), "1", &text, Kind::Long));
        columns.push(Values::Long(summaries.iter().map(|s| s.count as i64).collect()));
    }
    (headings, columns)
}

/// Readings of the trials of a cell by trial, for tests that pair trials.
pub fn by_trial(plan: &Plan, results: &Results, cell: usize, reading: usize) -> BTreeMap<usize, f64> {
    of_cell(plan, results, cell).map(|(trial, values)| (trial, values[reading])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_and_their_errors() {
        let of = |values: &[f64]| Summary::of(values.iter().copied());
        let three = of(&[1.0, 2.0, f64::NAN, 3.0]);
        assert_eq!((three.mean, three.count), (2.0, 3));
        assert!((three.error - 1.0 / 3.0f64.sqrt()).abs() < 1e-15);
        assert!(of(&[]).mean.is_nan() && of(&[5.0]).error.is_nan());
        assert_eq!(of(&[5.0]).mean, 5.0);
    }
}
