//! Tracks of a recording to scrub through: real individuals in the player of simulated ones.

mod marks;
mod over_time;

use super::{LiveError, Shown, packed};
use crate::run::tables::AXES;
use crate::run::{EVENTS, METRICS, TRAJECTORY};
use crate::store::StoreError;
use crate::store::table::{Table, Values};
use crate::tracks::folder;
use crate::tracks::tables::OVER_TIME;
use serde_json::{Value as Json, json};
use std::collections::HashMap;
use std::path::Path;

/// Moments of the metrics that the page is told.
const MEASURED: usize = 3000;
/// Individuals up to which each is a group of its own, with a colour and a name.
const NAMED: usize = 250;

/// The tracks of one recording in the folder of an analysis, frame by frame.
pub struct Tracked {
    trajectory: Table,
    text: String,
    dimensions: usize,
    agents: usize,
    rate: f64,
    /// Time of each frame.
    times: Vec<f64>,
    /// Where each frame's rows lie: row group, first row, number of rows; none where nobody was found.
    places: Vec<Option<(usize, usize, usize)>>,
    at: usize,
    /// The row group in memory: its number, the individuals, positions and velocities.
    block: (usize, Vec<Values>),
    /// Row of each individual in the frame shown.
    rows: Vec<Option<usize>>,
    scene: Json,
    metrics: Json,
    name: String,
    names: Vec<String>,
    units: (String, String),
    /// What was measured of each individual over the whole recording, by its name.
    each: HashMap<String, Vec<(String, f64, String)>>,
}

impl Tracked {
    /// Opens a recording, by its number, of the analysis in a folder.
    ///
    /// # Errors
    /// Where a table cannot be read or there is no such recording.
    pub fn open(path: &Path, recording: usize) -> Result<Self, LiveError> {
        let manifest = folder::manifest_of(path)?;
        let about = manifest.pointer(&format!("/recordings/{recording}")).cloned().unwrap_or(Json::Null);
        let number = |key: &str| about.get(key).and_then(Json::as_u64).map(|n| n as usize);
        let (Some(dimensions), Some(names)) = (number("dimensions"), about.get("individuals").and_then(Json::as_array))
        else {
            return Err(LiveError::Request(format!("`{}` holds no recording {recording}", path.display())));
        };
        let agents = names.len();
        let metrics = Table::open(&path.join(METRICS))?;
        let trajectory = Table::open(&path.join(TRAJECTORY))?;
        let names: Vec<String> = names.iter().map(|name| name.as_str().unwrap_or_default().to_owned()).collect();
        let (numbers, times) = frames(&metrics, recording)?;
        let (places, gaps) = places(&trajectory, recording, &numbers, agents)?;
        let mut marks = gaps.marks(&names);
        if path.join(EVENTS).exists() {
            marks.extend(marks::told(&Table::open(&path.join(EVENTS))?, recording, &numbers, &names)?);
        }
        let over = if path.join(OVER_TIME).exists() {
            over_time::read(&Table::open(&path.join(OVER_TIME))?, recording)?
        } else {
            over_time::Found::default()
        };
        let step = times.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
        let step = if step.is_finite() { step } else { 1.0 };
        let unit = |key: &str| about.pointer(&format!("/units/{key}")).cloned().unwrap_or(Json::Null);
        let rate = if unit("time") == "s" { (1.0 / step).clamp(10.0, 60.0) } else { 20.0 };
        let (mut list, mut all) = metrics_of(&metrics, recording)?;
        if let Some(list) = list.as_array_mut() {
            list.extend(over.charts);
        }
        all["own"] = over.lines.into();
        let name = about.get("name").and_then(Json::as_str).unwrap_or_default().to_owned();
        let groups: Vec<Json> = if agents <= NAMED {
            let one = |(k, name): (usize, &String)| json!({ "name": name, "model": "", "title": "", "first": k, "count": 1, "radius": 0.0 });
            names.iter().enumerate().map(one).collect()
        } else {
            vec![json!({ "name": name, "model": "", "title": "recorded", "first": 0, "count": agents, "radius": 0.0 })]
        };
        // frames have numbers of their own, which are told where they follow each other evenly
        let by = numbers.get(1).map_or(1, |second| second - numbers[0]);
        let even = numbers.windows(2).all(|pair| pair[1] - pair[0] == by);
        let numbered = (even && !numbers.is_empty()).then(|| json!({ "first": numbers[0], "by": by }));
        let ends = |key: &str| about.get(key).cloned().unwrap_or(Json::Null);
        let scene = json!({
            "is": "scene",
            "kind": "run",
            "of": "tracks",
            "title": manifest.get("title"),
            "about": manifest.get("about"),
            "seed": Json::Null,
            "recording": name,
            "numbered": numbered,
            "dimensions": dimensions,
            "units": { "length": unit("length"), "time": unit("time") },
            "space": {
                "edges": vec!["open"; dimensions], "size": vec![Json::Null; dimensions],
                "low": ends("low"), "high": ends("high"),
            },
            "groups": groups,
            "labels": [],
            "step": step,
            "steps": times.len().saturating_sub(1),
            "frames": times.len(),
            "from_step": 0,
            "every_steps": 1,
            "metrics": list,
            "controls": [],
            "events": marks::listed(marks, &times),
        });
        let text = manifest.pointer("/file/text").and_then(Json::as_str).unwrap_or_default().to_owned();
        let block = (usize::MAX, Vec::new());
        let rows = vec![None; agents];
        let word = |key: &str| unit(key).as_str().unwrap_or_default().to_owned();
        let units = (word("length"), word("time"));
        let mut tracked = Self {
            trajectory,
            text,
            dimensions,
            agents,
            rate,
            times,
            places,
            at: 0,
            block,
            rows,
            scene,
            metrics: all,
            name,
            names,
            units,
            each: over.each,
        };
        tracked.load()?;
        Ok(tracked)
    }
    /// Brings the frame shown into memory.
    fn load(&mut self) -> Result<(), StoreError> {
        self.rows.fill(None);
        let Some(Some((group, first, count))) = self.places.get(self.at).copied() else { return Ok(()) };
        if self.block.0 != group {
            let mut wanted = vec![column(&self.trajectory, "id")?];
            for axis in &AXES[..self.dimensions] {
                wanted.push(column(&self.trajectory, axis)?);
            }
            for axis in &AXES[..self.dimensions] {
                wanted.push(column(&self.trajectory, &format!("v{axis}"))?);
            }
            self.block = (group, self.trajectory.read(group, &wanted)?);
        }
        for row in first..first + count {
            let id = self.block.1[0].number(row) as usize;
            if let Some(place) = self.rows.get_mut(id) {
                *place = Some(row);
            }
        }
        Ok(())
    }
}

fn column(table: &Table, name: &str) -> Result<usize, StoreError> {
    table.column(name).ok_or_else(|| StoreError::Damaged(format!("a table lacks the column `{name}`")))
}

/// Numbers and times of the frames of a recording, from its metrics: a frame in which nobody was found is one too.
fn frames(metrics: &Table, recording: usize) -> Result<(Vec<i64>, Vec<f64>), StoreError> {
    let wanted = [column(metrics, "run")?, column(metrics, "frame")?, column(metrics, "t")?];
    let (mut numbers, mut times) = (Vec::new(), Vec::new());
    for group in 0..metrics.groups() {
        let read = metrics.read(group, &wanted)?;
        for row in (0..read[0].len()).filter(|&row| read[0].number(row) as usize == recording) {
            numbers.push(read[1].number(row) as i64);
            times.push(read[2].number(row));
        }
    }
    Ok((numbers, times))
}

/// Where rows lie: row group, first row, number of rows; none where nobody was found.
type Places = Vec<Option<(usize, usize, usize)>>;

/// Where the rows of each frame lie, and what is missing between them.
fn places(
    trajectory: &Table,
    recording: usize,
    numbers: &[i64],
    individuals: usize,
) -> Result<(Places, marks::Gaps), StoreError> {
    let wanted = [column(trajectory, "run")?, column(trajectory, "frame")?, column(trajectory, "id")?];
    let index: HashMap<i64, usize> = numbers.iter().enumerate().map(|(place, &number)| (number, place)).collect();
    let (mut places, mut gaps) = (vec![None; numbers.len()], marks::Gaps::new(individuals));
    for group in 0..trajectory.groups() {
        let read = trajectory.read(group, &wanted)?;
        let mut from = 0;
        let rows = read[0].len();
        while from < rows {
            let frame = read[1].number(from);
            let to = (from + 1..rows).find(|&row| read[1].number(row) != frame).unwrap_or(rows);
            let place = index.get(&(frame as i64)).filter(|_| read[0].number(from) as usize == recording);
            if let Some(&place) = place {
                places[place] = Some((group, from, to - from));
                (from..to).for_each(|row| gaps.see(read[2].number(row) as usize, place));
            }
            from = to;
        }
    }
    Ok((places, gaps))
}

/// The metrics of a recording that are defined somewhere, as the scene lists them, and the message `metrics_all`.
fn metrics_of(table: &Table, recording: usize) -> Result<(Json, Json), StoreError> {
    let cards: Vec<(usize, &measure::MetricCard)> =
        measure::metrics::LIST.iter().filter_map(|card| Some((table.column(card.id)?, *card))).collect();
    let mut wanted = vec![column(table, "run")?, column(table, "t")?, column(table, "group")?];
    wanted.extend(cards.iter().map(|&(at, _)| at));
    let every = (table.rows() as usize / MEASURED).max(1);
    let (mut times, mut name, mut values) = (Vec::new(), String::new(), vec![Vec::new(); cards.len()]);
    for group in 0..table.groups() {
        let read = table.read(group, &wanted)?;
        let rows = (0..read[0].len()).filter(|&row| read[0].number(row) as usize == recording);
        for row in rows.step_by(every) {
            times.push(read[1].number(row));
            name = read[2].text(row);
            for (values, column) in values.iter_mut().zip(&read[3..]) {
                values.push(Some(column.number(row)).filter(|value| value.is_finite()));
            }
        }
    }
    let defined = |k: &usize| values[*k].iter().any(Option::is_some);
    let defined: Vec<usize> = (0..cards.len()).filter(defined).collect();
    let about = |&k: &usize| {
        let (at, card) = cards[k];
        let range = card.range.map(|(low, high)| [low, high]);
        json!({ "id": card.id, "title": card.title, "unit": table.headings()[at].unit, "range": range })
    };
    let list = defined.iter().map(about).collect();
    let values: Vec<&Vec<Option<f64>>> = defined.iter().map(|&k| &values[k]).collect();
    let all = json!({ "is": "metrics_all", "t": times, "groups": [{ "group": name, "values": values }] });
    Ok((list, all))
}

impl Shown for Tracked {
    fn scene(&self) -> Json {
        self.scene.clone()
    }
    fn obstacles(&self) -> Json {
        json!({ "is": "obstacles", "list": [] })
    }
    fn items(&self) -> Option<Json> {
        None
    }
    fn obstacles_move(&self) -> bool {
        false
    }
    fn advance(&mut self, count: i64) -> Result<i64, LiveError> {
        let before = self.at;
        let last = self.times.len().saturating_sub(1) as u64;
        self.seek((before as u64).saturating_add_signed(count).min(last))?;
        Ok(self.at as i64 - before as i64)
    }
    fn moment(&self) -> (u64, f64, Option<u64>) {
        let time = self.times.get(self.at).copied().unwrap_or(0.0);
        (self.at as u64, time, Some(self.at as u64))
    }
    fn frame(&self, number: u32) -> Vec<u8> {
        let dimensions = self.dimensions;
        let columns = &self.block.1;
        let place = |agent: usize, a: usize| self.rows[agent].map_or(f32::NAN, |row| columns[1 + a].number(row) as f32);
        let heading = |agent: usize, a: usize| {
            let Some(row) = self.rows[agent] else { return 0.0 };
            let v = |a: usize| columns[1 + dimensions + a].number(row);
            let speed = (0..dimensions).map(|a| v(a) * v(a)).sum::<f64>().sqrt();
            if speed > 1e-12 { (v(a) / speed) as f32 } else { 0.0 }
        };
        let (step, time, _) = self.moment();
        packed(number, step, time, dimensions, self.agents, place, heading, None)
    }
    fn measure(&mut self) -> Option<Json> {
        None
    }
    fn all_metrics(&self) -> Option<Json> {
        Some(self.metrics.clone())
    }
    /// Nobody knows what moves a recorded individual: what it does is told, and what was measured of it.
    fn explain(&mut self, agent: u32) -> Result<Json, LiveError> {
        let id = agent as usize;
        let Some(name) = self.names.get(id) else {
            return Err(LiveError::Request(format!("there is no individual {agent}")));
        };
        let (length, time) = &self.units;
        let columns = &self.block.1;
        let (step, t, _) = self.moment();
        let row = self.rows[id];
        let axis = |a: usize| row.map_or(f64::NAN, |row| columns[a].number(row));
        let three = |first: usize| -> Vec<f64> {
            let there = (0..self.dimensions).map(|a| axis(first + a));
            there.map(|value| if value.is_finite() { value } else { 0.0 }).chain([0.0; 3]).take(3).collect()
        };
        let (position, velocity) = (three(1), three(1 + self.dimensions));
        let speed = velocity.iter().map(|v| v * v).sum::<f64>().sqrt();
        let heading: Vec<f64> = velocity.iter().map(|v| if speed > 1e-12 { v / speed } else { 0.0 }).collect();
        let moves = row.is_some() && axis(1 + self.dimensions).is_finite();
        let mut values = vec![
            json!({ "stage": "now", "name": "there", "value": if row.is_some() { "yes" } else { "missing in this frame" } }),
        ];
        if row.is_some() {
            let places = AXES.iter().take(self.dimensions).zip(&position);
            values.extend(
                places.map(|(axis, value)| json!({ "stage": "now", "name": axis, "value": value, "unit": length })),
            );
        }
        if moves {
            values.push(json!({ "stage": "now", "name": "speed", "value": speed, "unit": format!("{length}/{time}") }));
        }
        let whole = self.each.get(name).into_iter().flatten();
        values.extend(whole.map(
            |(name, value, unit)| json!({ "stage": "whole recording", "name": name, "value": value, "unit": unit }),
        ));
        Ok(json!({
            "agent": agent, "recorded": true, "name": marks::called(&self.names, id), "group": self.name, "model": "",
            "step": step, "t": t, "position": position, "heading": heading, "radius": 0.0,
            "velocity": moves.then_some(velocity),
            "sensing": Json::Null, "rays": [], "detected": [], "sets": [], "obstacles": [], "components": [], "choice": [],
            "values": values, "wanted": Json::Null, "performed": Json::Null,
        }))
    }
    fn seek(&mut self, frame: u64) -> Result<(), LiveError> {
        self.at = (frame as usize).min(self.times.len().saturating_sub(1));
        Ok(self.load()?)
    }
    fn reset(&mut self, _: Option<u64>) -> Result<(), LiveError> {
        self.seek(0)
    }
    fn set(&mut self, _: &str, _: &Json) -> Result<bool, LiveError> {
        Err(LiveError::Request("a recording does not change".into()))
    }
    fn file(&self) -> Result<String, LiveError> {
        Ok(self.text.clone())
    }
    fn natural_rate(&self) -> f64 {
        self.rate
    }
}
