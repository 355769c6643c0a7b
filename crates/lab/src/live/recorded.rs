//! A recorded run to scrub through.

use super::{LiveError, Shown, metrics_json, obstacles, packed, space_json};
use crate::explain::{self, Past};
use crate::run::{METRICS, TRAJECTORY};
use crate::scenario::build::{self, Read, Schedule};
use crate::store::StoreError;
use crate::store::table::{Table, Values};
use crate::with_types;
use serde_json::{Value as Json, json};
use space::ColumnKind;
use std::path::{Path, PathBuf};

/// A complete run, frame by frame.
pub struct Recorded {
    folder: PathBuf,
    read: Read,
    seed: u64,
    schedule: Schedule,
    trajectory: Table,
    agents: usize,
    frames: u64,
    at: u64,
    /// First frame of each row group, and of what would follow the last.
    starts: Vec<u64>,
    /// The row group in memory: its number and the columns that are shown.
    block: (usize, Vec<Values>),
    /// Names of the states, where there is a column of them.
    label: Option<(usize, &'static str, &'static [&'static str])>,
    /// What explains its agents, once somebody has asked.
    past: Option<Box<dyn Past>>,
    /// The scene's parts that the plan tells.
    scene: Json,
    /// The obstacles at a time, as the message `obstacles`.
    obstacles_at: Box<dyn Fn(f64) -> Json + Send>,
    metrics: Json,
}

impl Recorded {
    /// Opens the run in a folder.
    ///
    /// # Errors
    /// Where a table cannot be read or there are no frames.
    pub fn open(folder: &Path, read: Read, seed: u64, quick: bool) -> Result<Self, LiveError> {
        let scenario = &read.scenario;
        let schedule = build::schedule(scenario, quick)
            .map_err(|wrong| LiveError::Request(format!("{}: {}", wrong.path, wrong.what)))?;
        let path = folder.join(TRAJECTORY);
        if !path.exists() {
            return Err(LiveError::Request(format!("the run in `{}` kept no trajectory", folder.display())));
        }
        let trajectory = Table::open(&path)?;
        let agents: usize = scenario.group.0.iter().map(|(_, group)| group.count).sum();
        let frames = trajectory.rows().checked_div(agents as u64).unwrap_or(0);
        if frames == 0 {
            return Err(LiveError::Request(format!("the run in `{}` kept no frame", folder.display())));
        }
        let mut starts = vec![0];
        for group in 0..trajectory.groups() {
            let rows = trajectory.rows_in(group);
            starts.push(starts.last().copied().unwrap_or(0) + rows / agents as u64);
        }
        let label = scenario
            .group
            .0
            .iter()
            .filter_map(|(_, group)| swarm::models::find(&group.model.id))
            .flat_map(|entry| (entry.columns)())
            .find_map(|column| match column.kind {
                ColumnKind::Label(names) => Some((trajectory.column(column.name)?, column.name, names)),
                ColumnKind::Quantity | ColumnKind::Count => None,
            });
        let (scene, obstacles_at) =
            scene(scenario, seed, &schedule, frames, label.map(|(_, column, names)| (column, names)))?;
        let metrics = all_metrics(&Table::open(&folder.join(METRICS))?, scenario)?;
        let mut recorded = Self {
            folder: folder.to_owned(),
            read,
            seed,
            schedule,
            trajectory,
            agents,
            frames,
            at: 0,
            starts,
            block: (usize::MAX, Vec::new()),
            label,
            past: None,
            scene,
            obstacles_at,
            metrics,
        };
        recorded.load()?;
        Ok(recorded)
    }
    fn dimensions(&self) -> usize {
        self.read.scenario.space.dimensions
    }
    /// Brings the row group of the present frame into memory.
    fn load(&mut self) -> Result<(), StoreError> {
        let group = self.starts.partition_point(|&start| start <= self.at).saturating_sub(1);
        if self.block.0 == group {
            return Ok(());
        }
        let table = &self.trajectory;
        let missing = || StoreError::Damaged("the trajectory lacks a column".into());
        let (x, vx) = (table.column("x").ok_or_else(missing)?, table.column("vx").ok_or_else(missing)?);
        let mut wanted: Vec<usize> = (0..self.dimensions()).flat_map(|a| [x + a, vx + a]).collect();
        wanted.extend(self.label.map(|(column, ..)| column));
        self.block = (group, table.read(group, &wanted)?);
        Ok(())
    }
    /// Row of an agent in the row group in memory.
    fn row(&self, agent: usize) -> usize {
        (self.at - self.starts[self.block.0]) as usize * self.agents + agent
    }
    fn time(&self) -> f64 {
        self.schedule.step * self.step() as f64
    }
    fn step(&self) -> u64 {
        self.schedule.record_from + self.at * self.schedule.record
    }
}

/// The message `scene` of a run, and what makes its messages `obstacles`.
fn scene(
    scenario: &crate::scenario::Scenario,
    seed: u64,
    schedule: &Schedule,
    frames: u64,
    label: Option<(&str, &[&str])>,
) -> Result<(Json, Box<dyn Fn(f64) -> Json + Send>), LiveError> {
    let (space, groups, obstacles_at) = with_types!(scenario, R, D => {
        let world = build::world::<R, D>(scenario, seed, 1).map_err(LiveError::Request)?;
        let frame = world.frame();
        let places = (0..frame.columns.len())
            .map(|row| space::Vector(frame.columns.position(row).0.map(|c| space::Real::to_f64(c))));
        let groups: Vec<Json> = world.groups().iter().zip(frame.groups).map(|(group, range)| {
            let title = swarm::models::find(&group.model).map_or("", |entry| entry.card.title);
            json!({
                "name": group.name, "model": group.model, "title": title,
                "first": range.first, "count": range.count, "radius": space::Real::to_f64(group.radius() + group.half_axis()),
            })
        }).collect();
        let list = world.obstacles().clone();
        let at: Box<dyn Fn(f64) -> Json + Send> = Box::new(move |time| obstacles(&list, time));
        (space_json(frame.space, places), groups, at)
    });
    let labels: Vec<Json> = label.iter().map(|(column, names)| json!({ "column": column, "names": names })).collect();
    let scene = json!({
        "is": "scene",
        "kind": "run",
        "title": scenario.title,
        "about": scenario.about,
        "seed": seed,
        "dimensions": scenario.space.dimensions,
        "units": { "length": scenario.units.length, "time": scenario.units.time },
        "space": space,
        "groups": groups,
        "labels": labels,
        "step": schedule.step,
        "steps": schedule.steps,
        "frames": frames,
        "from_step": schedule.record_from,
        "every_steps": schedule.record,
        "metrics": metrics_json(scenario),
        "controls": [],
        "events": [],
    });
    Ok((scene, obstacles_at))
}

/// The message `metrics_all` of a run.
fn all_metrics(table: &Table, scenario: &crate::scenario::Scenario) -> Result<Json, LiveError> {
    let column = |name: &str| {
        table.column(name).ok_or_else(|| StoreError::Damaged(format!("the metrics lack the column `{name}`")))
    };
    let mut wanted = vec![column("t")?, column("group")?];
    for id in scenario.metrics() {
        wanted.push(column(&id)?);
    }
    let mut times: Vec<f64> = Vec::new();
    let mut groups: Vec<(String, Vec<Vec<Option<f64>>>)> = Vec::new();
    for block in 0..table.groups() {
        let read = table.read(block, &wanted)?;
        for row in 0..read[0].len() {
            let (t, name) = (read[0].number(row), read[1].text(row));
            if times.last() != Some(&t) {
                times.push(t);
            }
            let at = groups.iter().position(|(other, _)| *other == name).unwrap_or_else(|| {
                groups.push((name, vec![Vec::new(); wanted.len() - 2]));
                groups.len() - 1
            });
            for (values, column) in groups[at].1.iter_mut().zip(&read[2..]) {
                values.push(Some(column.number(row)).filter(|value| value.is_finite()));
            }
        }
    }
    let groups: Vec<Json> =
        groups.into_iter().map(|(group, values)| json!({ "group": group, "values": values })).collect();
    Ok(json!({ "is": "metrics_all", "t": times, "groups": groups }))
}

impl Shown for Recorded {
    fn scene(&self) -> Json {
        self.scene.clone()
    }
    fn obstacles(&self) -> Json {
        (self.obstacles_at)(self.time())
    }
    fn items(&self) -> Option<Json> {
        None
    }
    fn obstacles_move(&self) -> bool {
        let moves = |obstacle: &crate::scenario::Obstacle| {
            obstacle.appears.is_some() || obstacle.disappears.is_some() || !obstacle.path.is_empty()
        };
        self.read.scenario.obstacle.iter().any(moves)
    }
    fn advance(&mut self, count: i64) -> Result<i64, LiveError> {
        let before = self.at;
        self.at = self.at.saturating_add_signed(count).min(self.frames - 1);
        self.load()?;
        Ok(self.at as i64 - before as i64)
    }
    fn moment(&self) -> (u64, f64, Option<u64>) {
        (self.step(), self.time(), Some(self.at))
    }
    fn frame(&self, number: u32) -> Vec<u8> {
        let dimensions = self.dimensions();
        let columns = &self.block.1;
        let place = |agent: usize, a: usize| columns[2 * a].number(self.row(agent)) as f32;
        let heading = |agent: usize, a: usize| {
            let v = |a: usize| columns[2 * a + 1].number(self.row(agent));
            let speed = (0..dimensions).map(|a| v(a) * v(a)).sum::<f64>().sqrt();
            if speed > 1e-12 { (v(a) / speed) as f32 } else { 0.0 }
        };
        let label = self.label.map(|(_, _, names)| {
            move |agent: usize| match columns.last() {
                Some(Values::Word(places, words)) => {
                    let word = words.get(places[self.row(agent)] as usize);
                    let at = word.and_then(|word| names.iter().position(|name| name == word));
                    at.map_or(255, |at| at.min(254) as u8)
                }
                _ => 255,
            }
        });
        let (step, time) = (self.step(), self.time());
        match &label {
            Some(label) => packed(number, step, time, dimensions, self.agents, place, heading, Some(label)),
            None => packed(number, step, time, dimensions, self.agents, place, heading, None),
        }
    }
    fn measure(&mut self) -> Option<Json> {
        None
    }
    fn all_metrics(&self) -> Option<Json> {
        Some(self.metrics.clone())
    }
    fn explain(&mut self, agent: u32) -> Result<Json, LiveError> {
        if agent as usize >= self.agents {
            return Err(LiveError::Request(format!("there is no agent {agent}")));
        }
        let step = self.step();
        let past = match &mut self.past {
            Some(past) => past,
            // only now: most runs are watched without it
            empty => empty.insert(explain::past(&self.folder, &self.read.scenario, self.seed)?),
        };
        Ok(past.explain(step, agent)?)
    }
    fn seek(&mut self, frame: u64) -> Result<(), LiveError> {
        self.at = frame.min(self.frames - 1);
        self.load()?;
        Ok(())
    }
    fn reset(&mut self, _: Option<u64>) -> Result<(), LiveError> {
        self.seek(0)
    }
    fn set(&mut self, _: &str, _: &Json) -> Result<bool, LiveError> {
        Err(LiveError::Request("a recorded run does not change; open its scenario to change values".into()))
    }
    fn file(&self) -> Result<String, LiveError> {
        Ok(self.read.sources.text(0).to_owned())
    }
    fn natural_rate(&self) -> f64 {
        20.0
    }
}
