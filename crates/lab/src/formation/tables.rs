//! The tables of a formation file: what came of each task with each method, every trial, and the walls.

use super::results::{Results, mean, reading};
use super::trial::Tried;
use crate::design::tables::words;
use crate::store::StoreError;
use crate::store::folder::Folder;
use crate::store::table::{Heading, Kind, Values, write_table};

/// A row for each task and method.
pub const OUTCOMES: &str = "outcomes.parquet";
/// A row for each trial.
pub const TRIALS: &str = "trials.parquet";
/// A row for each wall of a task.
pub const WALLS: &str = "walls.parquet";

type Filled = (Vec<Heading>, Vec<Values>);

/// Writes the tables.
///
/// # Errors
/// Where the system refuses.
pub fn write(folder: &Folder, results: &Results<'_>) -> Result<(), StoreError> {
    let notes = [("flockworks.title".to_owned(), results.plan.form.title.clone())];
    for (name, (headings, columns)) in
        [(OUTCOMES, outcomes(results)), (TRIALS, trials(results)), (WALLS, walls(results))]
    {
        write_table(folder, name, &headings, &columns, &notes)?;
    }
    Ok(())
}

fn long(numbers: impl Iterator<Item = u64>) -> Values {
    Values::Long(numbers.map(|number| number as i64).collect())
}

fn names(results: &Results<'_>, rows: &[(usize, usize)]) -> (Vec<Heading>, Vec<Values>) {
    let plan = results.plan;
    let headings =
        vec![Heading::new("task", "", "The task.", Kind::Word), Heading::new("method", "", "The method.", Kind::Word)];
    let columns = vec![
        words(rows.iter().map(|row| plan.tasks[row.0].name.clone())),
        words(rows.iter().map(|row| plan.methods[row.1].name.clone())),
    ];
    (headings, columns)
}

/// What is told of trials: name, unit, and what it is.
const READ: [(&str, &str, &str); 6] = [
    ("fitness", "1", "Share of targets that passed all gates in order and reached the goal"),
    ("time", "time", "Time at which the last target arrived, where all did"),
    ("path_length", "length", "Way of all shepherds together"),
    ("dispersion", "length", "Mean distance of targets from their middle, over time"),
    ("held", "1", "Share of the time in which all targets were inside the hull of the shepherds"),
    ("robots", "1", "Number of shepherds"),
];

fn outcomes(results: &Results<'_>) -> Filled {
    let rows: Vec<(usize, usize)> = results.trials.keys().copied().collect();
    let (mut headings, mut columns) = names(results, &rows);
    let bound = |row: &(usize, usize), high: bool| {
        let (done, all) = results.targets(row.0, row.1);
        let found = measure::statistics::wilson(done, all, 0.95);
        found.map_or(f64::NAN, |found| if high { found.high } else { found.low })
    };
    headings.extend([
        Heading::new("trials", "1", "Trials.", Kind::Long),
        Heading::new("targets_done", "1", "Targets that did the task, in all trials.", Kind::Long),
        Heading::new("fitness_low", "1", "Lower end of the 95 % Wilson interval over targets.", Kind::Double),
        Heading::new("fitness_high", "1", "Upper end of the 95 % Wilson interval over targets.", Kind::Double),
        Heading::new("success", "1", "Share of trials in which all targets did the task.", Kind::Double),
        Heading::new("walls", "1", "Walls of the task.", Kind::Long),
    ]);
    let success = reading("success");
    columns.extend([
        long(rows.iter().map(|row| results.of(row.0, row.1).len() as u64)),
        long(rows.iter().map(|row| results.targets(row.0, row.1).0)),
        Values::Double(rows.iter().map(|row| bound(row, false)).collect()),
        Values::Double(rows.iter().map(|row| bound(row, true)).collect()),
        Values::Double(rows.iter().map(|row| success.map_or(f64::NAN, |of| results.mean(row.0, row.1, of))).collect()),
        long(rows.iter().map(|row| results.walls[row.0].len() as u64)),
    ]);
    for (name, unit, about) in READ {
        let Some(of) = reading(name) else { continue };
        headings.push(Heading::new(name, unit, &format!("{about}; mean over trials."), Kind::Double));
        columns.push(Values::Double(rows.iter().map(|row| mean(results.of(row.0, row.1).iter().map(of))).collect()));
    }
    (headings, columns)
}

fn trials(results: &Results<'_>) -> Filled {
    let each: Vec<(usize, usize, usize, &Tried)> = results
        .trials
        .iter()
        .flat_map(|(&(task, method), all)| all.iter().enumerate().map(move |(k, tried)| (task, method, k + 1, tried)))
        .collect();
    let rows: Vec<(usize, usize)> = each.iter().map(|row| (row.0, row.1)).collect();
    let (mut headings, mut columns) = names(results, &rows);
    headings.extend([
        Heading::new("trial", "1", "Number of the trial, from 1.", Kind::Long),
        Heading::new("seed", "", "Seed of the trial.", Kind::Long),
        Heading::new("steps", "1", "Steps made; 0 where it was impossible.", Kind::Long),
        Heading::new("bumps", "1", "Moves of shepherds that somebody was in the way of.", Kind::Double),
    ]);
    columns.extend([
        long(each.iter().map(|row| row.2 as u64)),
        long(each.iter().map(|row| results.plan.seed_of(row.0, row.2))),
        long(each.iter().map(|row| row.3.steps)),
        Values::Double(each.iter().map(|row| row.3.bumps).collect()),
    ]);
    for (name, unit, about) in READ {
        let Some(of) = reading(name) else { continue };
        headings.push(Heading::new(name, unit, &format!("{about}."), Kind::Double));
        columns.push(Values::Double(each.iter().map(|row| of(row.3)).collect()));
    }
    (headings, columns)
}

fn walls(results: &Results<'_>) -> Filled {
    let each: Vec<(usize, &super::task::Wall)> =
        results.walls.iter().enumerate().flat_map(|(task, walls)| walls.iter().map(move |wall| (task, wall))).collect();
    let number = |k: usize| Values::Double(each.iter().map(|(_, wall)| wall.at.numbers()[k]).collect());
    let coordinate = |name: &str, about: &str| Heading::new(name, "length", about, Kind::Double);
    let headings = vec![
        Heading::new("task", "", "The task.", Kind::Word),
        Heading::new("leg", "1", "The leg of the path that it is for, from 1.", Kind::Long),
        coordinate("x0", "Anchored end, first coordinate."),
        coordinate("y0", "Anchored end, second coordinate."),
        coordinate("x1", "Free end, first coordinate."),
        coordinate("y1", "Free end, second coordinate."),
    ];
    let columns = vec![
        words(each.iter().map(|(task, _)| results.plan.tasks[*task].name.clone())),
        long(each.iter().map(|(_, wall)| wall.leg as u64 + 1)),
        number(0),
        number(1),
        number(2),
        number(3),
    ];
    (headings, columns)
}
