//! The tables of a prediction: every construct with what was simulated and predicted, every score, every look at a simulated group.

use super::course::Course;
use super::results::{Item, Results, Score};
use super::state::{State, seen};
use crate::design::tables::words;
use crate::store::StoreError;
use crate::store::folder::Folder;
use crate::store::table::{Heading, Kind, Values, write_table};
use measure::statistics::{Resampling, bootstrap_rows};

/// A row for each construct.
pub const CONSTRUCTS: &str = "constructs.parquet";
/// A row for each test, predictor and score.
pub const SCORES: &str = "scores.parquet";
/// A row for each look at the group in each simulated trial.
pub const STATES: &str = "states.parquet";
/// The word for constructs that models are fitted to.
const TRAINING: &str = "training";
/// Times that constructs are drawn again for an interval.
const REPLICATES: u32 = 1000;

type Filled = (Vec<Heading>, Vec<Values>);

/// The simulated trials of a construct, by lot and number.
pub type Courses<'a> = &'a dyn Fn(usize, u64) -> &'a [Course];

/// Writes the tables.
///
/// # Errors
/// Where the system refuses.
pub fn write(folder: &Folder, results: &Results<'_>, courses: Courses<'_>) -> Result<(), StoreError> {
    let notes = [("flockworks.title".to_owned(), results.plan.form.title.clone())];
    let tables = [(CONSTRUCTS, constructs(results)), (SCORES, scores(results)), (STATES, states(results, courses))];
    for (name, (headings, columns)) in tables {
        write_table(folder, name, &headings, &columns, &notes)?;
    }
    Ok(())
}

/// Every construct: the word for its part, its lot, and what came of it.
fn rows<'a>(results: &'a Results<'_>) -> Vec<(&'a str, usize, &'a Item)> {
    let tests =
        results.tests.iter().flat_map(|test| test.items.iter().map(|item| (test.name.as_str(), test.lot, item)));
    results.training.iter().map(|item| (TRAINING, 0, item)).chain(tests).collect()
}

/// Names of all parameters that are drawn in any lot, with their units.
pub(super) fn parameters(results: &Results<'_>) -> Vec<(usize, String, String)> {
    let mut all: Vec<(usize, String, String)> = Vec::new();
    for one in results.plan.lots.iter().flat_map(|lot| &lot.drawn) {
        if all.iter().all(|(place, ..)| *place != one.place) {
            all.push((one.place, one.name.clone(), one.unit.clone()));
        }
    }
    all
}

/// The value of a parameter of a construct of a lot.
pub(super) fn value(results: &Results<'_>, lot: usize, item: &Item, place: usize) -> f64 {
    let lot = &results.plan.lots[lot];
    let own = lot.drawn.iter().position(|one| one.place == place);
    own.map_or(lot.values[place], |k| item.values.get(k).copied().unwrap_or(f64::NAN))
}

fn constructs(results: &Results<'_>) -> Filled {
    let rows = rows(results);
    let mut headings = vec![
        Heading::new("part", "", "`training`, or the test.", Kind::Word),
        Heading::new("construct", "1", "Number of the construct, from 0.", Kind::Long),
    ];
    let mut columns = vec![
        words(rows.iter().map(|(part, ..)| (*part).to_owned())),
        Values::Long(rows.iter().map(|(.., item)| item.number as i64).collect()),
    ];
    for (place, name, unit) in parameters(results) {
        headings.push(Heading::new(&name, &unit, &format!("Parameter `{name}` of the schema."), Kind::Double));
        columns.push(Values::Double(rows.iter().map(|(_, lot, item)| value(results, *lot, item, place)).collect()));
    }
    headings.extend([
        Heading::new("trials", "1", "Simulated trials.", Kind::Long),
        Heading::new("rate", "1", "Share of them that succeeded.", Kind::Double),
    ]);
    columns.extend([
        Values::Long(rows.iter().map(|(.., item)| item.simulated.trials as i64).collect()),
        Values::Double(rows.iter().map(|(.., item)| item.simulated.rate()).collect()),
    ]);
    for (k, name) in results.plan.predictors().into_iter().enumerate() {
        let about = format!("Chance of success predicted by `{name}`; not a number of what it was fitted to.");
        headings.push(Heading::new(&format!("predicted_{name}"), "1", &about, Kind::Double));
        let chance = |(.., item): &(&str, usize, &Item)| item.chances.get(k).copied().unwrap_or(f64::NAN);
        columns.push(Values::Double(rows.iter().map(chance).collect()));
    }
    (headings, columns)
}

/// A score with its 95 % interval over constructs; the interval is not a number where there are too few.
pub(super) fn scored(results: &Results<'_>, test: usize, by: usize, score: Score) -> (f64, f64, f64) {
    let items: Vec<&Item> = results.tests[test].items.iter().collect();
    let value = results.score(score, &items, by);
    // items are drawn by their places, as any number
    let places: Vec<f64> = (0..items.len()).map(|k| k as f64).collect();
    let of = |columns: &[&[f64]]| {
        let drawn: Vec<&Item> = columns[0].iter().filter_map(|place| items.get(*place as usize).copied()).collect();
        Some(results.score(score, &drawn, by)).filter(|value| value.is_finite())
    };
    let resampling = Resampling { replicates: REPLICATES, seed: results.plan.form.seed, confidence: 0.95 };
    let interval = bootstrap_rows(&[&places], of, &resampling);
    interval.map_or((value, f64::NAN, f64::NAN), |found| (value, found.interval.low, found.interval.high))
}

fn scores(results: &Results<'_>) -> Filled {
    let predictors = results.plan.predictors();
    let tests = 0..results.tests.len();
    let all = tests.flat_map(|test| {
        (0..predictors.len()).flat_map(move |by| Score::ALL.into_iter().map(move |score| (test, by, score)))
    });
    let rows: Vec<(usize, usize, Score)> = all.collect();
    let found: Vec<(f64, f64, f64)> = rows.iter().map(|&(test, by, score)| scored(results, test, by, score)).collect();
    let headings = vec![
        Heading::new("test", "", "The test.", Kind::Word),
        Heading::new("by", "", "By what it was predicted.", Kind::Word),
        Heading::new("score", "", "The score.", Kind::Word),
        Heading::new("constructs", "1", "Constructs of the test.", Kind::Long),
        Heading::new("value", "1", "Its value.", Kind::Double),
        Heading::new("low", "1", "Lower end of its 95 % interval, by drawing constructs again.", Kind::Double),
        Heading::new("high", "1", "Upper end.", Kind::Double),
    ];
    let columns = vec![
        words(rows.iter().map(|(test, ..)| results.tests[*test].name.clone())),
        words(rows.iter().map(|(_, by, _)| predictors[*by].to_owned())),
        words(rows.iter().map(|(.., score)| score.word().to_owned())),
        Values::Long(rows.iter().map(|(test, ..)| results.tests[*test].items.len() as i64).collect()),
        Values::Double(found.iter().map(|found| found.0).collect()),
        Values::Double(found.iter().map(|found| found.1).collect()),
        Values::Double(found.iter().map(|found| found.2).collect()),
    ];
    (headings, columns)
}

fn states(results: &Results<'_>, courses: Courses<'_>) -> Filled {
    let mut rows: Vec<(&str, u64, usize, u64, &State)> = Vec::new();
    for (part, lot, item) in self::rows(results) {
        for (trial, course) in courses(lot, item.number).iter().enumerate() {
            let looks = course.looks.iter().enumerate();
            let every = results.plan.form.every;
            rows.extend(looks.map(|(k, state)| (part, item.number, trial + 1, k as u64 * every, state)));
        }
    }
    let number = |of: &dyn Fn(&State) -> f64| Values::Double(rows.iter().map(|row| of(row.4)).collect());
    let spread = |k: usize| move |state: &State| seen(state.spread, state.heading)[k];
    let headings = vec![
        Heading::new("part", "", "`training`, or the test.", Kind::Word),
        Heading::new("construct", "1", "Number of the construct, from 0.", Kind::Long),
        Heading::new("trial", "1", "The simulated trial, from 1.", Kind::Long),
        Heading::new("step", "1", "The step.", Kind::Long),
        Heading::new("x", "length", "Centroid.", Kind::Double),
        Heading::new("y", "length", "Centroid.", Kind::Double),
        Heading::new("heading", "deg", "Direction of the mean heading, counter-clockwise from x.", Kind::Double),
        Heading::new("polarisation", "1", "Length of the mean heading.", Kind::Double),
        Heading::new("along", "length", "Spread along the heading.", Kind::Double),
        Heading::new("oblique", "length", "Spread, the part that is neither along nor across.", Kind::Double),
        Heading::new("across", "length", "Spread across the heading.", Kind::Double),
        Heading::new("largest", "1", "Share of the largest group.", Kind::Double),
    ];
    let columns = vec![
        words(rows.iter().map(|row| row.0.to_owned())),
        Values::Long(rows.iter().map(|row| row.1 as i64).collect()),
        Values::Long(rows.iter().map(|row| row.2 as i64).collect()),
        Values::Long(rows.iter().map(|row| row.3 as i64).collect()),
        number(&|state| state.at[0]),
        number(&|state| state.at[1]),
        number(&|state| state.heading.angle().to_degrees()),
        number(&|state| state.polarisation),
        number(&spread(0)),
        number(&spread(1)),
        number(&spread(2)),
        number(&|state| state.largest),
    ];
    (headings, columns)
}
