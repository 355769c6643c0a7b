//! The tables of an evolution: a row for each generation, a row for each candidate.

use super::contest::{Contender, Contest};
use super::execute::{Generation, Run};
use super::variants::Variants;
use crate::store::StoreError;
use crate::store::folder::Folder;
use crate::store::table::{Heading, Kind, Values, write_rows, write_table};
use crate::study::plan::Varied;
use std::sync::Arc;

/// A row for each generation of each run.
pub const GENERATIONS: &str = "generations.parquet";
/// A row for each candidate of each generation.
pub const CANDIDATES: &str = "candidates.parquet";
/// A row for each champion.
pub const CHAMPIONS: &str = "champions.parquet";
/// A row for each contender in each world of a contest.
pub const CONTEST: &str = "contest.parquet";

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

/// Names that columns, or readings of runs, have already.
pub const RESERVED: [&str; 22] = [
    "run",
    "seed",
    "generation",
    "candidate",
    "who",
    "world",
    "fitness",
    "fitness_best",
    "fitness_mean",
    "fitness_sd",
    "fitness_worst",
    "slope",
    "start",
    "end",
    "highest",
    "lowest",
    "champion",
    "differential",
    "drift",
    "margin",
    "won",
    "variant",
];

/// Writes the tables.
///
/// # Errors
/// Where the system refuses.
pub fn write(folder: &Folder, variants: &Variants, runs: &[Run], contests: &[Contest]) -> Result<(), StoreError> {
    let notes = [("flockworks.title".to_owned(), variants.first().form.title.clone())];
    // of these there may be millions
    write_rows(folder, GENERATIONS, rows_of(variants, runs), |rows| generations(variants, rows), &notes)?;
    write_rows(folder, CANDIDATES, candidates_of(variants, runs), |rows| candidates(variants, rows), &notes)?;
    let mut all = vec![(CHAMPIONS, champions(variants, runs))];
    if !contests.is_empty() {
        all.push((CONTEST, contest(variants, contests)));
    }
    for (name, (headings, columns)) in all {
        write_table(folder, name, &headings, &columns, &notes)?;
    }
    Ok(())
}

type Filled = (Vec<Heading>, Vec<Values>);

/// Begins a table: the levels of what is varied and the number of the run, of each row a variant and perhaps a run.
fn begun(variants: &Variants, of: &[usize]) -> Filled {
    let column = |(k, factor): (usize, &Varied)| {
        let levels = of.iter().map(|&variant| variants.levels[variant][k]);
        if factor.numeric() {
            let number = |level: usize| factor.levels[level].number.unwrap_or(f64::NAN);
            let heading = Heading::new(&factor.name, &factor.unit, &factor.about, Kind::Double);
            (heading, Values::Double(levels.map(number).collect()))
        } else {
            let words = factor.levels.iter().map(|level| level.text.clone()).collect();
            let heading = Heading::new(&factor.name, "", &factor.about, Kind::Word);
            (heading, Values::Word(levels.map(|level| level as u32).collect(), Arc::new(words)))
        }
    };
    variants.factors.iter().enumerate().map(column).unzip()
}

/// Adds a column.
fn add(filled: &mut Filled, heading: Heading, values: Values) {
    filled.0.push(heading);
    filled.1.push(values);
}

fn long(values: impl Iterator<Item = usize>) -> Values {
    Values::Long(values.map(|value| value as i64).collect())
}

fn generations(variants: &Variants, rows: &[(usize, usize, usize, &Generation)]) -> Filled {
    let plan = variants.first();
    let spreads: Vec<Spread> = rows.iter().map(|(.., one)| Spread::of(plan.own(&one.evaluated.scores))).collect();
    let mut table = begun(variants, &rows.iter().map(|row| row.0).collect::<Vec<_>>());
    add(&mut table, of_run(), long(rows.iter().map(|row| row.1 + 1)));
    let about = "Number of the generation, from 0.";
    add(&mut table, Heading::new("generation", "1", about, Kind::Long), long(rows.iter().map(|row| row.2)));
    let columns: [(&str, &str, fn(&Spread) -> f64); 4] = [
        ("fitness_best", "Fitness of the best candidate.", |spread| spread.best),
        ("fitness_mean", "Mean fitness of the candidates.", |spread| spread.mean),
        ("fitness_sd", "Standard deviation of the fitness of the candidates (n - 1).", |spread| spread.deviation),
        ("fitness_worst", "Fitness of the worst candidate.", |spread| spread.worst),
    ];
    for (name, about, of) in columns {
        let values = spreads.iter().map(of).collect();
        add(&mut table, Heading::new(name, "1", about, Kind::Double), Values::Double(values));
    }
    if plan.shared.is_some() {
        for (k, name) in plan.kept().into_iter().enumerate() {
            let about = format!("`{name}` of the world at its end.");
            let values = rows.iter().map(|(.., one)| one.evaluated.kept[0][k]).collect();
            add(&mut table, Heading::new(name, "", &about, Kind::Double), Values::Double(values));
        }
    }
    table
}

/// Variant, run (from 0), number and generation of all generations.
fn rows_of<'a>(
    variants: &'a Variants,
    runs: &'a [Run],
) -> impl Iterator<Item = (usize, usize, usize, &'a Generation)> + 'a {
    runs.iter().enumerate().flat_map(|(k, run)| {
        let (variant, own) = variants.of_run(k);
        run.generations.iter().enumerate().map(move |(number, one)| (variant, own, number, one))
    })
}

fn of_run() -> Heading {
    Heading::new("run", "1", "Number of the run, from 1.", Kind::Long)
}

/// Variant, run (from 0), number, candidate and generation of all candidates.
fn candidates_of<'a>(
    variants: &'a Variants,
    runs: &'a [Run],
) -> impl Iterator<Item = (usize, usize, usize, usize, &'a Generation)> + 'a {
    rows_of(variants, runs).flat_map(|(variant, run, number, one)| {
        (0..one.candidates.len()).map(move |candidate| (variant, run, number, candidate, one))
    })
}

fn candidates(variants: &Variants, rows: &[(usize, usize, usize, usize, &Generation)]) -> Filled {
    let mut table = begun(variants, &rows.iter().map(|row| row.0).collect::<Vec<_>>());
    add(&mut table, of_run(), long(rows.iter().map(|row| row.1 + 1)));
    let about = "Number of the generation, from 0.";
    add(&mut table, Heading::new("generation", "1", about, Kind::Long), long(rows.iter().map(|row| row.2)));
    let about = "Number of the candidate in its generation, from 0; those of a rival follow.";
    add(&mut table, Heading::new("candidate", "1", about, Kind::Long), long(rows.iter().map(|row| row.3)));
    let mut number = |heading: Heading, of: &dyn Fn(usize, &Generation) -> f64| {
        let values = rows.iter().map(|(.., candidate, one)| of(*candidate, one)).collect();
        add(&mut table, heading, Values::Double(values));
    };
    let about = "Its fitness; missing where its world is impossible.";
    number(Heading::new("fitness", "1", about, Kind::Double), &|candidate, one| one.evaluated.scores[candidate]);
    let plan = variants.first();
    for (k, gene) in plan.axes.iter().enumerate() {
        let heading = Heading::new(&gene.name, &gene.unit, &gene.about, Kind::Double);
        number(heading, &|candidate, one| one.candidates[candidate][k]);
    }
    for (k, (name, _)) in plan.kinds.iter().enumerate() {
        let heading = Heading::new(name, "", &format!("`{name}`, of which kind it is."), Kind::Double);
        number(heading, &|candidate, one| one.evaluated.kinds[candidate][k]);
    }
    if plan.shared.is_none() {
        for (k, (name, reading)) in plan.readings.readings.iter().enumerate() {
            let about = if reading.about.is_empty() { name } else { &reading.about };
            let heading = Heading::new(name, &reading.unit, about, Kind::Double);
            number(heading, &|candidate, one| one.evaluated.kept[candidate][k]);
        }
    }
    table
}

fn champions(variants: &Variants, runs: &[Run]) -> Filled {
    let plan = variants.first();
    let champion = |(k, run): (usize, &'_ Run)| {
        let (variant, own) = variants.of_run(k);
        run.champion(&variants.plans[variant]).map(|(genes, score)| (variant, own + 1, genes.to_vec(), score))
    };
    let rows: Vec<(usize, usize, Vec<f64>, f64)> = runs.iter().enumerate().filter_map(champion).collect();
    let mut table = begun(variants, &rows.iter().map(|row| row.0).collect::<Vec<_>>());
    add(&mut table, of_run(), long(rows.iter().map(|row| row.1)));
    let seeds = rows.iter().map(|row| plan.seed_of(row.1) as i64).collect();
    add(&mut table, Heading::new("seed", "1", "Seed of the run.", Kind::Long), Values::Long(seeds));
    let about = match plan.form.confirm {
        0 => "Its fitness in the search.".to_owned(),
        worlds => format!("Its mean fitness in {worlds} worlds that the search had not seen."),
    };
    let scores = rows.iter().map(|row| row.3).collect();
    add(&mut table, Heading::new("fitness", "1", &about, Kind::Double), Values::Double(scores));
    for (k, gene) in plan.axes.iter().enumerate() {
        let heading = Heading::new(&gene.name, &gene.unit, &gene.about, Kind::Double);
        add(&mut table, heading, Values::Double(rows.iter().map(|row| row.2[k]).collect()));
    }
    table
}

/// A row for each contender in each world.
fn contest(variants: &Variants, contests: &[Contest]) -> Filled {
    let rows: Vec<(usize, &Contender, usize)> = contests
        .iter()
        .enumerate()
        .flat_map(|(variant, contest)| contest.contenders.iter().map(move |who| (variant, who)))
        .flat_map(|(variant, who)| (0..who.worlds.len()).map(move |world| (variant, who, world)))
        .collect();
    let mut table = begun(variants, &rows.iter().map(|row| row.0).collect::<Vec<_>>());
    let mut names: Vec<String> = Vec::new();
    let mut place = |name: &String| {
        names.iter().position(|own| own == name).unwrap_or_else(|| {
            names.push(name.clone());
            names.len() - 1
        }) as u32
    };
    let who = rows.iter().map(|(_, who, _)| place(&who.name)).collect();
    add(&mut table, Heading::new("who", "", "The contender.", Kind::Word), Values::Word(who, Arc::new(names)));
    let about = "Number of the world, from 1; a world has the same seed for all contenders.";
    add(&mut table, Heading::new("world", "1", about, Kind::Long), long(rows.iter().map(|row| row.2 + 1)));
    let plan = variants.first();
    let kept = plan.kept().into_iter().map(|name| (name, format!("`{name}` of the world.")));
    for (k, (name, about)) in core::iter::once(("fitness", "Its fitness.".to_owned())).chain(kept).enumerate() {
        let values = rows.iter().map(|(_, who, world)| who.worlds[*world][k]).collect();
        add(&mut table, Heading::new(name, "", &about, Kind::Double), Values::Double(values));
    }
    for (k, gene) in plan.axes.iter().enumerate() {
        let heading = Heading::new(&gene.name, &gene.unit, &gene.about, Kind::Double);
        add(&mut table, heading, Values::Double(rows.iter().map(|(_, who, _)| who.genes[k]).collect()));
    }
    table
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
