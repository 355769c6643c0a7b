//! The tables of an optimisation: every evaluation, the best of each run, the archives.

use super::form::Search;
use super::results::Results;
use super::trials::Found;
use crate::design::tables::words;
use crate::store::StoreError;
use crate::store::folder::Folder;
use crate::store::table::{Heading, Kind, Values, write_table};

/// A row for each evaluation.
pub const EVALUATIONS: &str = "evaluations.parquet";
/// A row for each run: its best candidate.
pub const BEST: &str = "best.parquet";
/// A row for each kind that an archive reached.
pub const ELITES: &str = "elites.parquet";

/// Writes the tables.
///
/// # Errors
/// Where the system refuses.
pub fn write(folder: &Folder, results: &Results<'_>) -> Result<(), StoreError> {
    let notes = [("flockworks.title".to_owned(), results.plan.form.title.clone())];
    let (headings, columns) = evaluations(results);
    write_table(folder, EVALUATIONS, &headings, &columns, &notes)?;
    let (headings, columns) = best(results);
    write_table(folder, BEST, &headings, &columns, &notes)?;
    let (headings, columns) = elites(results);
    write_table(folder, ELITES, &headings, &columns, &notes)
}

/// A row: method, run, number, candidate, what was found.
type Row<'a> = (usize, usize, usize, &'a [f64], Found);

fn of_rows(results: &Results<'_>, rows: &[Row<'_>]) -> (Vec<Heading>, Vec<Values>) {
    let plan = results.plan;
    let methods = plan.methods();
    let mut headings = vec![
        Heading::new("method", "", "The method.", Kind::Word),
        Heading::new("run", "1", "The run, from 1.", Kind::Long),
        Heading::new("number", "1", "Number of the evaluation in its run, from 1.", Kind::Long),
    ];
    let mut columns = vec![
        words(rows.iter().map(|row| methods[row.0].to_owned())),
        Values::Long(rows.iter().map(|row| row.1 as i64 + 1).collect()),
        Values::Long(rows.iter().map(|row| row.2 as i64 + 1).collect()),
    ];
    for (k, axis) in plan.axes.iter().enumerate() {
        let about = format!("Parameter `{}` of the schema.", axis.name);
        headings.push(Heading::new(&axis.name, &axis.unit, &about, Kind::Double));
        columns.push(Values::Double(rows.iter().map(|row| row.3[k]).collect()));
    }
    headings.extend([
        Heading::new("score", "1", "Objective less what material costs.", Kind::Double),
        Heading::new("trials", "1", "Trials; 0 where the schema gives no construct.", Kind::Long),
        Heading::new("rate", "1", "Share of successes.", Kind::Double),
        Heading::new("fitness", "1", "Mean fitness.", Kind::Double),
        Heading::new("steps", "1", "Mean number of steps of trials that succeeded.", Kind::Double),
        Heading::new("material", "length", "Length of wall.", Kind::Double),
        Heading::new("pieces", "1", "Number of pieces.", Kind::Long),
    ]);
    let double = |of: &dyn Fn(&Found) -> f64| Values::Double(rows.iter().map(|row| of(&row.4)).collect());
    columns.extend([
        double(&|found| if found.trials > 0 { found.score } else { f64::NAN }),
        Values::Long(rows.iter().map(|row| row.4.trials as i64).collect()),
        double(&Found::rate),
        double(&|found| found.fitness),
        double(&|found| found.steps),
        double(&|found| found.material),
        Values::Long(rows.iter().map(|row| row.4.pieces as i64).collect()),
    ]);
    (headings, columns)
}

fn evaluations(results: &Results<'_>) -> (Vec<Heading>, Vec<Values>) {
    let mut rows: Vec<Row<'_>> = Vec::new();
    for (method, runs) in results.runs.iter().enumerate() {
        for (run, own) in runs.iter().enumerate() {
            let all = own.evaluations.iter().enumerate();
            rows.extend(all.map(|(number, (point, found))| (method, run, number, point.as_slice(), *found)));
        }
    }
    of_rows(results, &rows)
}

/// The best of each run, as new trials found it.
fn best(results: &Results<'_>) -> (Vec<Heading>, Vec<Values>) {
    let mut rows: Vec<Row<'_>> = Vec::new();
    for (method, runs) in results.runs.iter().enumerate() {
        for (run, own) in runs.iter().enumerate() {
            let best = own.best.map(|(place, found)| (method, run, place, own.evaluations[place].0.as_slice(), found));
            rows.extend(best);
        }
    }
    of_rows(results, &rows)
}

fn elites(results: &Results<'_>) -> (Vec<Heading>, Vec<Values>) {
    let plan = results.plan;
    let methods = plan.methods();
    // a row for each kind of each elite: archives may tell kinds apart by different numbers
    let mut rows: Vec<(usize, usize, usize, f64, String, f64)> = Vec::new();
    for (method, runs) in results.runs.iter().enumerate() {
        let Search::MapElites(archive) = &plan.form.method.0[method].1 else { continue };
        for (run, own) in runs.iter().enumerate() {
            for elite in &own.elites {
                for ((name, _), value) in archive.kind.0.iter().zip(&elite.descriptors) {
                    rows.push((method, run, elite.cell, elite.score, name.clone(), *value));
                }
            }
        }
    }
    let headings = vec![
        Heading::new("method", "", "The method.", Kind::Word),
        Heading::new("run", "1", "The run, from 1.", Kind::Long),
        Heading::new("cell", "1", "The cell of the archive.", Kind::Long),
        Heading::new("score", "1", "Score of its elite.", Kind::Double),
        Heading::new("kind", "", "What tells kinds apart.", Kind::Word),
        Heading::new("value", "", "Its value.", Kind::Double),
    ];
    let columns = vec![
        words(rows.iter().map(|row| methods[row.0].to_owned())),
        Values::Long(rows.iter().map(|row| row.1 as i64 + 1).collect()),
        Values::Long(rows.iter().map(|row| row.2 as i64).collect()),
        Values::Double(rows.iter().map(|row| row.3).collect()),
        words(rows.iter().map(|row| row.4.clone())),
        Values::Double(rows.iter().map(|row| row.5).collect()),
    ];
    (headings, columns)
}
