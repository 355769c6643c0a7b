//! From rows to columns: whatever the layout and the form of the file, rows are read the same way.

use super::layouts::{Plan, Who};
use super::{Ask, stamps, wrong};
use crate::store::StoreError;
use std::collections::HashMap;
use std::path::Path;
use swarm::parameters::GREATEST;

/// A row of a table.
pub(super) trait Row {
    /// A cell as a number; not a number where it is empty or says that there is none.
    fn number(&self, column: usize) -> Result<f64, Bad>;
    /// A cell as a word.
    fn word(&self, column: usize) -> Result<&[u8], Bad>;
    /// Where the row stands in the file, for messages.
    fn place(&self) -> String;
}

/// A cell that cannot be read.
pub(super) enum Bad {
    /// It is a word where a number is expected.
    Word(String),
    /// The row has only so many cells.
    Short(usize),
}

/// The columns of a table as they were read: a row for each place that is there.
#[derive(Debug, Default)]
pub(super) struct Gathered {
    /// Names of the individuals, in the order in which they appear.
    pub(super) names: Vec<String>,
    /// Whose a place is, `[rows]`.
    pub(super) who: Vec<u32>,
    /// Number of the frame, `[rows]`; empty where the table has none.
    pub(super) frame: Vec<i64>,
    /// Time in seconds, `[rows]`; empty where the table has none.
    pub(super) time: Vec<f64>,
    /// Coordinates, `[axes][rows]`.
    pub(super) place: Vec<Vec<f64>>,
    /// Velocities, `[axes][rows]`, where the table has them.
    pub(super) velocity: Vec<Vec<f64>>,
    /// Frame and time of rows without a place.
    pub(super) empty: Vec<(i64, f64)>,
    /// Rows of cells, or of a wide table cells, that name no individual.
    pub(super) lost: usize,
    /// Points left out for their confidence.
    pub(super) doubtful: usize,
    index: HashMap<Vec<u8>, u32>,
    rows: i64,
}

impl Gathered {
    /// Columns to be filled by a plan.
    pub(super) fn new(plan: &Plan) -> Self {
        let dimensions = plan.dimensions();
        let moving = plan.places.iter().any(|place| place.velocity.is_some());
        Self {
            place: vec![Vec::new(); dimensions],
            velocity: vec![Vec::new(); if moving { dimensions } else { 0 }],
            ..Self::default()
        }
    }

    /// Adds the places of a row.
    pub(super) fn add(&mut self, path: &Path, plan: &Plan, ask: &Ask, row: &dyn Row) -> Result<(), StoreError> {
        let bad = |column: usize, bad: Bad| {
            let name = plan.names.get(column).map_or("?", String::as_str);
            let what = match bad {
                Bad::Word(word) => {
                    let word: String = word.chars().take(40).collect();
                    format!("{}, column `{name}`: expected a number, found `{word}`", row.place())
                }
                Bad::Short(found) => {
                    format!("{} has {found} cells; column `{name}` is number {}", row.place(), column + 1)
                }
            };
            wrong(path, &what)
        };
        let number = |column: usize| row.number(column).map_err(|error| bad(column, error));
        let frame = match plan.frame {
            Some(column) => {
                let frame = number(column)?;
                if frame.fract() != 0.0 || frame.abs() > 9e15 {
                    let name = plan.names.get(column).map_or("?", String::as_str);
                    return Err(wrong(
                        path,
                        &format!(
                            "{}, column `{name}`: expected the number of a frame, found {frame}; if it is a time, say \
                             --columns frame=none,time={name}",
                            row.place()
                        ),
                    ));
                }
                frame as i64
            }
            // of a wide table without a clock, rows are frames
            None => self.rows,
        };
        self.rows += 1;
        let time = match plan.time {
            None => f64::NAN,
            Some(clock) if clock.stamps => {
                let word = row.word(clock.column).map_err(|error| bad(clock.column, error))?;
                stamps::seconds(word).ok_or_else(|| {
                    let name = plan.names.get(clock.column).map_or("?", String::as_str);
                    let word = String::from_utf8_lossy(word).chars().take(40).collect::<String>();
                    let expected = "expected a time as 2012-08-05 03:00:01.5 or 03:00:01.5";
                    wrong(path, &format!("{}, column `{name}`: {expected}, found `{word}`", row.place()))
                })?
            }
            Some(clock) => number(clock.column)? * clock.unit.unwrap_or(1.0),
        };
        if plan.time.is_some() && !time.is_finite() {
            if plan.frame.is_none() {
                let column = plan.time.map_or(0, |clock| clock.column);
                let name = plan.names.get(column).map_or("?", String::as_str);
                return Err(wrong(path, &format!("{}, column `{name}`: expected a time, found none", row.place())));
            }
            // TRex has no time for a lost individual
            return Ok(());
        }
        for place in &plan.places {
            let mut at = [0.0; 3];
            let mut points = 0.0;
            for point in &place.points {
                let mut there = [0.0; 3];
                for (a, &column) in point.axes.iter().enumerate() {
                    there[a] = number(column)?;
                }
                if !there.iter().all(|c| c.is_finite()) {
                    continue;
                }
                if let (Some(column), Some(least)) = (point.confidence, ask.confidence)
                    && number(column)? < least
                {
                    self.doubtful += 1;
                    continue;
                }
                (0..3).for_each(|a| at[a] += there[a]);
                points += 1.0;
            }
            if points == 0.0 {
                if self.empty.last().is_none_or(|last| last.0 != frame || last.1.total_cmp(&time).is_ne()) {
                    self.empty.push((frame, time));
                }
                continue;
            }
            let who = match &place.who {
                Who::Name(name) => self.named(path, ask, name.as_bytes())?,
                Who::Column(column) => {
                    let word = row.word(*column).map_err(|error| bad(*column, error))?;
                    if super::text::missing(word) {
                        self.lost += 1;
                        continue;
                    }
                    self.named(path, ask, word)?
                }
                Who::Columns(arena, number) => {
                    let word = |column: usize| row.word(column).map_err(|error| bad(column, error));
                    let name = [&b"Arena"[..], word(*arena)?, &b"_Ind"[..], word(*number)?].concat();
                    self.named(path, ask, &name)?
                }
            };
            self.who.push(who);
            if plan.frame.is_some() || plan.time.is_none() {
                self.frame.push(frame);
            }
            if plan.time.is_some() {
                self.time.push(time);
            }
            for (a, column) in self.place.iter_mut().enumerate() {
                let coordinate = at[a] / points * ask.scale;
                if coordinate.abs() > GREATEST {
                    let what = format!("{}: a coordinate of {coordinate:e} is beyond {GREATEST:e}", row.place());
                    return Err(wrong(path, &what));
                }
                column.push(coordinate);
            }
            if let Some(columns) = &place.velocity {
                for (to, &column) in self.velocity.iter_mut().zip(columns) {
                    to.push(number(column)? * ask.scale);
                }
            }
        }
        Ok(())
    }

    /// The number of an individual by its name.
    fn named(&mut self, path: &Path, ask: &Ask, name: &[u8]) -> Result<u32, StoreError> {
        // rows of one individual often follow each other
        if let Some(&last) = self.who.last()
            && self.names.get(last as usize).is_some_and(|known| known.as_bytes() == name)
        {
            return Ok(last);
        }
        if let Some(&known) = self.index.get(name) {
            return Ok(known);
        }
        let text = core::str::from_utf8(name).map_err(|_| {
            wrong(path, &format!("the individual `{}` is not named in UTF-8", String::from_utf8_lossy(name)))
        })?;
        let count = self.names.len();
        if count >= ask.individuals {
            return Err(wrong(
                path,
                &format!(
                    "more than {count} individuals: is it another column that names them? --columns id=NAME says which; \
                     --individuals N allows N of them"
                ),
            ));
        }
        self.names.push(text.to_owned());
        self.index.insert(name.to_vec(), count as u32);
        Ok(count as u32)
    }
}
