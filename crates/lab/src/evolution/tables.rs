//! The tables of an evolution: a row for each generation, a row for each candidate.

use super::execute::Run;
use super::plan::Plan;
use crate::store::StoreError;
use crate::store::folder::Folder;
use crate::store::table::{Heading, Kind, Values, write_table};

/// A row for each generation of each run.
pub const GENERATIONS: &str = "generations.parquet";
/// A row for each candidate of each generation.
pub const CANDIDATES: &str = "candidates.parquet";
/// A row for each champion.
pub const CHAMPIONS: &str = "champions.parquet";

/// Best, mean, standard deviation (n - 1) and worst of the scores that are there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The greatest; not a number of no scores.
    pub best: f64,
    /// Their mean; not a number of no scores.
    pub mean: f64,
    /// Their standard deviation; not a number of fewer than two.
    pub deviation: f64,
    /// The least; not a number of no scores.
    pub worst: f64,
}

impl Spread {
    /// Of scores, of which some may be missing.
    pub fn of(scores: &[f64]) -> Self {
        let there: Vec<f64> = scores.iter().copied().filter(|score| score.is_finite()).collect();
        let n = there.len() as f64;
        let mean = there.iter().sum::<f64>() / n;
        let squares: f64 = there.iter().map(|score| (score - mean) * (score - mean)).sum();
        let ends = there.iter().fold(None, |ends: Option<(f64, f64)>, &score| {
            Some(ends.map_or((score, score), |(low, high)| (low.min(score), high.max(score))))
        });
        let (worst, best) = ends.unwrap_or((f64::NAN, f64::NAN));
        let deviation = if there.len() > 1 { (squares / (n - 1.0)).sqrt() } else { f64::NAN };
        Self { best, mean, deviation, worst }
    }
}

/// Writes the tables.
///
/// # Errors
/// Where the system refuses.
pub fn write(folder: &Folder, plan: &Plan, runs: &[Run]) -> Result<(), StoreError> {
    let notes = [("flockworks.title".to_owned(), plan.form.title.clone())];
    for (name, (headings, columns)) in [
        (GENERATIONS, generations(plan, runs)),
        (CANDIDATES, candidates(plan, runs)),
        (CHAMPIONS, champions(plan, runs)),
    ] {
        write_table(folder, name, &headings, &columns, &notes)?;
    }
    Ok(())
}

type Filled = (Vec<Heading>, Vec<Values>);

fn of_run() -> Heading {
    Heading::new("run", "1", "Number of the run, from 1.", Kind::Long)
}

fn generations(plan: &Plan, runs: &[Run]) -> Filled {
    let rows = || {
        runs.iter()
            .enumerate()
            .flat_map(|(run, own)| own.generations.iter().enumerate().map(move |(number, one)| (run, number, one)))
    };
    let spreads: Vec<Spread> = rows().map(|(.., one)| Spread::of(&one.evaluated.scores)).collect();
    let mut headings = vec![
        of_run(),
        Heading::new("generation", "1", "Number of the generation, from 0.", Kind::Long),
        Heading::new("fitness_best", "1", "Fitness of the best candidate.", Kind::Double),
        Heading::new("fitness_mean", "1", "Mean fitness of the candidates.", Kind::Double),
        Heading::new("fitness_sd", "1", "Standard deviation of the fitness of the candidates (n - 1).", Kind::Double),
        Heading::new("fitness_worst", "1", "Fitness of the worst candidate.", Kind::Double),
    ];
    let mut columns = vec![
        Values::Long(rows().map(|(run, ..)| run as i64 + 1).collect()),
        Values::Long(rows().map(|(_, number, _)| number as i64).collect()),
        Values::Double(spreads.iter().map(|spread| spread.best).collect()),
        Values::Double(spreads.iter().map(|spread| spread.mean).collect()),
        Values::Double(spreads.iter().map(|spread| spread.deviation).collect()),
        Values::Double(spreads.iter().map(|spread| spread.worst).collect()),
    ];
    if plan.shared.is_some() {
        for (k, name) in plan.kept().into_iter().enumerate() {
            let about = format!("`{name}` of the world at its end.");
            headings.push(Heading::new(name, "", &about, Kind::Double));
            columns.push(Values::Double(rows().map(|(.., one)| one.evaluated.kept[0][k]).collect()));
        }
    }
    (headings, columns)
}

fn candidates(plan: &Plan, runs: &[Run]) -> Filled {
    let rows = || {
        runs.iter().enumerate().flat_map(|(run, own)| {
            own.generations.iter().enumerate().flat_map(move |(number, one)| {
                (0..one.candidates.len()).map(move |candidate| (run, number, candidate, one))
            })
        })
    };
    let mut headings = vec![
        of_run(),
        Heading::new("generation", "1", "Number of the generation, from 0.", Kind::Long),
        Heading::new("candidate", "1", "Number of the candidate in its generation, from 0.", Kind::Long),
        Heading::new("fitness", "1", "Its fitness; missing where its world is impossible.", Kind::Double),
    ];
    let mut columns = vec![
        Values::Long(rows().map(|(run, ..)| run as i64 + 1).collect()),
        Values::Long(rows().map(|(_, number, ..)| number as i64).collect()),
        Values::Long(rows().map(|(_, _, candidate, _)| candidate as i64).collect()),
        Values::Double(rows().map(|(_, _, candidate, one)| one.evaluated.scores[candidate]).collect()),
    ];
    for (k, gene) in plan.axes.iter().enumerate() {
        headings.push(Heading::new(&gene.name, &gene.unit, &gene.about, Kind::Double));
        columns.push(Values::Double(rows().map(|(_, _, candidate, one)| one.candidates[candidate][k]).collect()));
    }
    for (k, (name, _)) in plan.kinds.iter().enumerate() {
        headings.push(Heading::new(name, "", &format!("`{name}`, of which kind it is."), Kind::Double));
        columns.push(Values::Double(rows().map(|(_, _, candidate, one)| one.evaluated.kinds[candidate][k]).collect()));
    }
    if plan.shared.is_none() {
        for (k, (name, reading)) in plan.readings.readings.iter().enumerate() {
            let about = if reading.about.is_empty() { name } else { &reading.about };
            headings.push(Heading::new(name, &reading.unit, about, Kind::Double));
            columns
                .push(Values::Double(rows().map(|(_, _, candidate, one)| one.evaluated.kept[candidate][k]).collect()));
        }
    }
    (headings, columns)
}

fn champions(plan: &Plan, runs: &[Run]) -> Filled {
    let rows: Vec<(usize, &[f64], f64)> = runs
        .iter()
        .enumerate()
        .filter_map(|(k, run)| run.champion(plan).map(|(genes, score)| (k + 1, genes, score)))
        .collect();
    let about = match plan.form.confirm {
        0 => "Its fitness in the search.".to_owned(),
        worlds => format!("Its mean fitness in {worlds} worlds that the search had not seen."),
    };
    let mut headings = vec![
        of_run(),
        Heading::new("seed", "1", "Seed of the run.", Kind::Long),
        Heading::new("fitness", "1", &about, Kind::Double),
    ];
    let mut columns = vec![
        Values::Long(rows.iter().map(|(run, ..)| *run as i64).collect()),
        Values::Long(rows.iter().map(|(run, ..)| plan.seed_of(*run) as i64).collect()),
        Values::Double(rows.iter().map(|(.., score)| *score).collect()),
    ];
    for (k, gene) in plan.axes.iter().enumerate() {
        headings.push(Heading::new(&gene.name, &gene.unit, &gene.about, Kind::Double));
        columns.push(Values::Double(rows.iter().map(|(_, genes, _)| genes[k]).collect()));
    }
    (headings, columns)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spreads_of_what_is_there() {
        let spread = Spread::of(&[1.0, f64::NAN, 3.0]);
        assert_eq!((spread.best, spread.mean, spread.worst), (3.0, 2.0, 1.0));
        assert!((spread.deviation - 2f64.sqrt()).abs() < 1e-15);
        let none = Spread::of(&[f64::NAN]);
        assert!([none.best, none.mean, none.deviation, none.worst].iter().all(|value| value.is_nan()));
    }
}
