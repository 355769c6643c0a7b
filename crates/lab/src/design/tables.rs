//! The tables of a design: the candidates, what came of each, every trial, and the shares over all.

use super::results::{Results, Share, Trials};
use crate::environment::trial::Tried;
use crate::store::StoreError;
use crate::store::folder::Folder;
use crate::store::table::{Heading, Kind, Values, write_table};
use std::sync::Arc;

/// A row for each feasible candidate.
pub const CANDIDATES: &str = "candidates.parquet";
/// A row for each feasible candidate, group and behaviour.
pub const RESULTS: &str = "results.parquet";
/// A row for each trial and behaviour.
pub const TRIALS: &str = "trials.parquet";
/// A row for each group and behaviour.
pub const RATES: &str = "rates.parquet";
/// A row for each feasible candidate, group and stage, where there are stages.
pub const STAGES: &str = "stages.parquet";

/// Writes the tables.
///
/// # Errors
/// Where the system refuses.
pub fn write(folder: &Folder, results: &Results<'_>) -> Result<(), StoreError> {
    let notes = [("flockworks.title".to_owned(), results.plan.form.title.clone())];
    for (name, (headings, columns)) in [
        (CANDIDATES, candidates(results)),
        (RESULTS, of_candidates(results)),
        (TRIALS, trials(results)),
        (RATES, rates(results)),
    ] {
        write_table(folder, name, &headings, &columns, &notes)?;
    }
    if results.plan.stages() > 0 {
        let (headings, columns) = stages(results);
        write_table(folder, STAGES, &headings, &columns, &notes)?;
    }
    Ok(())
}

type Filled = (Vec<Heading>, Vec<Values>);

/// A column of words, of which there are few.
pub(crate) fn words(all: impl IntoIterator<Item = String>) -> Values {
    let mut known: Vec<String> = Vec::new();
    let place = |word: String| {
        let place = known.iter().position(|other| *other == word).unwrap_or_else(|| {
            known.push(word);
            known.len() - 1
        });
        place as u32
    };
    let places = all.into_iter().map(place).collect();
    Values::Word(places, Arc::new(known))
}

fn long(numbers: impl Iterator<Item = u64>) -> Values {
    Values::Long(numbers.map(|number| number as i64).collect())
}

fn candidates(results: &Results<'_>) -> Filled {
    let all = &results.survey.feasible;
    let mut headings = vec![
        Heading::new("candidate", "1", "Number of the attempt that made it, from 0.", Kind::Long),
        Heading::new("pieces", "1", "Number of built pieces.", Kind::Long),
        Heading::new("material", "length", "Length of wall.", Kind::Double),
        Heading::new("hash", "", "Fingerprint of its geometry.", Kind::Long),
    ];
    let mut columns = vec![
        long(all.iter().map(|(attempt, _)| *attempt)),
        long(all.iter().map(|(_, construct)| construct.pieces.len() as u64)),
        Values::Double(all.iter().map(|(_, construct)| construct.material()).collect()),
        long(all.iter().map(|(_, construct)| construct.hash())),
    ];
    for name in results.plan.source.parameters() {
        let value = |(_, construct): &(u64, terrain::Construct)| {
            let parameters = &construct.provenance.parameters;
            parameters.iter().find(|(known, _)| *known == name).map_or(f64::NAN, |(_, value)| *value)
        };
        headings.push(Heading::new(&name, "", &format!("Parameter `{name}` of the schema."), Kind::Double));
        columns.push(Values::Double(all.iter().map(value).collect()));
    }
    (headings, columns)
}

/// Attempt, group and behaviour of every row, by their places.
fn rows<'a>(results: &'a Results<'_>) -> impl Iterator<Item = (u64, usize, usize, &'a Trials)> {
    let behaviours = results.plan.behaviour_names().len();
    results.tried.iter().flat_map(move |attempt| {
        let groups = results.trials.get(attempt).into_iter().flatten().enumerate();
        groups.flat_map(move |(group, trials)| (0..behaviours).map(move |one| (*attempt, group, one, trials)))
    })
}

fn names(results: &Results<'_>, rows: &[(u64, usize, usize, &Trials)]) -> [Values; 3] {
    let (plan, behaviours) = (results.plan, results.plan.behaviour_names());
    [
        long(rows.iter().map(|(attempt, ..)| *attempt)),
        words(rows.iter().map(|(_, group, ..)| plan.populations[*group].name.clone())),
        words(rows.iter().map(|(_, _, behaviour, _)| behaviours[*behaviour].to_owned())),
    ]
}

fn of_row() -> Vec<Heading> {
    vec![
        Heading::new("candidate", "1", "Number of the attempt that made it, from 0.", Kind::Long),
        Heading::new("population", "", "The group.", Kind::Word),
        Heading::new("behaviour", "", "The behaviour.", Kind::Word),
    ]
}

fn of_candidates(results: &Results<'_>) -> Filled {
    let rows: Vec<_> = rows(results).collect();
    let success = results.plan.form.success;
    let share = |row: &(u64, usize, usize, &Trials)| Share::of(&row.3.built, row.2, success);
    let control = |row: &(u64, usize, usize, &Trials)| Share::of(&row.3.control, row.2, success);
    let bound = |row: &(u64, usize, usize, &Trials), high: bool| {
        share(row).interval().map_or(f64::NAN, |interval| if high { interval.1 } else { interval.0 })
    };
    let numbers = |row: &(u64, usize, usize, &Trials)| -> Vec<f64> {
        let all = row.3.built.iter().filter_map(|tried| tried.outcomes.get(row.2));
        all.map(|outcome| outcome.fitness).filter(|fitness| fitness.is_finite()).collect()
    };
    let mean = |row: &(u64, usize, usize, &Trials)| measure::statistics::mean(&numbers(row)).unwrap_or(f64::NAN);
    let deviation =
        |row: &(u64, usize, usize, &Trials)| measure::statistics::variance(&numbers(row)).map_or(f64::NAN, f64::sqrt);
    let mut headings = of_row();
    headings.extend([
        Heading::new("trials", "1", "Trials with the construct.", Kind::Long),
        Heading::new("successes", "1", "Trials that succeeded.", Kind::Long),
        Heading::new("rate", "1", "Share of successes.", Kind::Double),
        Heading::new("rate_low", "1", "Lower end of its 95 % Wilson interval.", Kind::Double),
        Heading::new("rate_high", "1", "Upper end of its 95 % Wilson interval.", Kind::Double),
        Heading::new("valid", "1", "1 where the environment counts as valid.", Kind::Long),
        Heading::new("fitness_mean", "1", "Mean fitness.", Kind::Double),
        Heading::new("fitness_sd", "1", "Standard deviation of the fitness (n - 1).", Kind::Double),
        Heading::new("control_trials", "1", "Trials without the construct.", Kind::Long),
        Heading::new("control_rate", "1", "Share of successes without the construct.", Kind::Double),
    ]);
    let valid = |row: &(u64, usize, usize, &Trials)| {
        let share = share(row);
        u64::from(results.plan.form.valid.holds(share.successes, share.trials))
    };
    let mut columns = names(results, &rows).to_vec();
    columns.extend([
        long(rows.iter().map(|row| share(row).trials)),
        long(rows.iter().map(|row| share(row).successes)),
        Values::Double(rows.iter().map(|row| share(row).rate()).collect()),
        Values::Double(rows.iter().map(|row| bound(row, false)).collect()),
        Values::Double(rows.iter().map(|row| bound(row, true)).collect()),
        long(rows.iter().map(valid)),
        Values::Double(rows.iter().map(mean).collect()),
        Values::Double(rows.iter().map(deviation).collect()),
        long(rows.iter().map(|row| control(row).trials)),
        Values::Double(rows.iter().map(|row| control(row).rate()).collect()),
    ]);
    (headings, columns)
}

/// Each stage by itself beside the same stage behind the others, and all together.
fn stages(results: &Results<'_>) -> Filled {
    let plan = results.plan;
    let rows: Vec<_> = rows(results).filter(|row| row.2 < plan.stages()).collect();
    let success = plan.form.success;
    fn alone<'a>(row: &(u64, usize, usize, &'a Trials)) -> &'a [Tried] {
        row.3.alone.get(row.2).map_or(&[], Vec::as_slice)
    }
    let mean = |trials: &[Tried], of: usize| {
        let fitness = trials.iter().filter_map(|tried| tried.outcomes.get(of)).map(|outcome| outcome.fitness);
        let fitness: Vec<f64> = fitness.filter(|fitness| fitness.is_finite()).collect();
        measure::statistics::mean(&fitness).unwrap_or(f64::NAN)
    };
    let mut headings = of_row();
    headings.extend([
        Heading::new("alone_trials", "1", "Trials of the stage by itself.", Kind::Long),
        Heading::new("alone_rate", "1", "Share of them that succeeded.", Kind::Double),
        Heading::new("alone_fitness", "1", "Mean fitness of them.", Kind::Double),
        Heading::new("joint_trials", "1", "Trials of all stages together.", Kind::Long),
        Heading::new("joint_rate", "1", "Share of them in which this stage succeeded.", Kind::Double),
        Heading::new("joint_fitness", "1", "Mean fitness of this stage in them; 0 where it never began.", Kind::Double),
        Heading::new("whole_fitness", "1", "Mean product of the fitnesses of all stages in them.", Kind::Double),
    ]);
    let mut columns = names(results, &rows).to_vec();
    columns.extend([
        long(rows.iter().map(|row| Share::of(alone(row), 0, success).trials)),
        Values::Double(rows.iter().map(|row| Share::of(alone(row), 0, success).rate()).collect()),
        Values::Double(rows.iter().map(|row| mean(alone(row), 0)).collect()),
        long(rows.iter().map(|row| Share::of(&row.3.built, row.2, success).trials)),
        Values::Double(rows.iter().map(|row| Share::of(&row.3.built, row.2, success).rate()).collect()),
        Values::Double(rows.iter().map(|row| mean(&row.3.built, row.2)).collect()),
        Values::Double(rows.iter().map(|row| mean(&row.3.built, plan.stages())).collect()),
    ]);
    (headings, columns)
}

fn trials(results: &Results<'_>) -> Filled {
    let mut keys = Vec::new();
    let mut each: Vec<(u64, bool, u64, &Tried)> = Vec::new();
    for row in rows(results) {
        for (control, list) in [(false, &row.3.built), (true, &row.3.control)] {
            for (k, tried) in list.iter().enumerate() {
                keys.push(row);
                each.push((k as u64 + 1, control, results.plan.seed_of(row.0, k + 1), tried));
            }
        }
    }
    let outcome = |k: usize, of: fn(&crate::environment::trial::Outcome) -> f64| {
        each[k].3.outcomes.get(keys[k].2).map_or(f64::NAN, of)
    };
    let mut headings = of_row();
    headings.extend([
        Heading::new("trial", "1", "Number of the trial, from 1.", Kind::Long),
        Heading::new("construct", "1", "1 with the construct, 0 without it.", Kind::Long),
        Heading::new("seed", "", "Seed of the trial.", Kind::Long),
        Heading::new("steps", "1", "Steps made; 0 where it was impossible.", Kind::Long),
        Heading::new("fitness", "1", "Fitness.", Kind::Double),
        Heading::new("value", "", "The number behind the fitness: a signal, or the step of success.", Kind::Double),
    ]);
    let mut columns = names(results, &keys).to_vec();
    columns.extend([
        long(each.iter().map(|(trial, ..)| *trial)),
        long(each.iter().map(|(_, control, ..)| u64::from(!control))),
        long(each.iter().map(|(_, _, seed, _)| *seed)),
        long(each.iter().map(|(.., tried)| tried.steps)),
        Values::Double((0..each.len()).map(|k| outcome(k, |outcome| outcome.fitness)).collect()),
        Values::Double((0..each.len()).map(|k| outcome(k, |outcome| outcome.value)).collect()),
    ]);
    (headings, columns)
}

fn rates(results: &Results<'_>) -> Filled {
    let plan = results.plan;
    let behaviours = plan.behaviour_names();
    let cells: Vec<(usize, usize)> =
        (0..behaviours.len()).flat_map(|one| (0..plan.populations.len()).map(move |group| (one, group))).collect();
    let share = |(one, group): &(usize, usize), control| results.share(*group, *one, control, None);
    let bound = |share: Share, high: bool| {
        share.interval().map_or(f64::NAN, |interval| if high { interval.1 } else { interval.0 })
    };
    let valid = |(one, group): &(usize, usize)| results.valid(*group, *one, None) as f64;
    let headings = vec![
        Heading::new("behaviour", "", "The behaviour.", Kind::Word),
        Heading::new("population", "", "The group.", Kind::Word),
        Heading::new("candidates", "1", "Feasible candidates that were tried.", Kind::Long),
        Heading::new("trials", "1", "Trials with the construct.", Kind::Long),
        Heading::new("rate", "1", "Share of successes.", Kind::Double),
        Heading::new("rate_low", "1", "Lower end of its 95 % Wilson interval over trials.", Kind::Double),
        Heading::new("rate_high", "1", "Upper end of its 95 % Wilson interval over trials.", Kind::Double),
        Heading::new("control_rate", "1", "Share of successes without the construct.", Kind::Double),
        Heading::new("tightness", "1", "Share of feasible candidates that are valid.", Kind::Double),
        Heading::new("tightness_all", "1", "Share of all generated candidates that are valid.", Kind::Double),
    ];
    let columns = vec![
        words(cells.iter().map(|(one, _)| behaviours[*one].to_owned())),
        words(cells.iter().map(|(_, group)| plan.populations[*group].name.clone())),
        long(cells.iter().map(|_| results.tried.len() as u64)),
        long(cells.iter().map(|cell| share(cell, false).trials)),
        Values::Double(cells.iter().map(|cell| share(cell, false).rate()).collect()),
        Values::Double(cells.iter().map(|cell| bound(share(cell, false), false)).collect()),
        Values::Double(cells.iter().map(|cell| bound(share(cell, false), true)).collect()),
        Values::Double(cells.iter().map(|cell| share(cell, true).rate()).collect()),
        Values::Double(cells.iter().map(|cell| valid(cell) / results.tried.len() as f64).collect()),
        Values::Double(cells.iter().map(|cell| valid(cell) / results.survey.counts.generated as f64).collect()),
    ];
    (headings, columns)
}
