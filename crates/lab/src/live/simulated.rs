//! A simulation that runs while one watches, and changes while it runs.

use super::{LiveError, Shown, controls, coordinates, metrics_json, obstacles, packed, space_json};
use crate::explain;
use crate::scenario::build::{self, Read};
use crate::scenario::metrics_of;
use crate::with_types;
use measure::{Measure, Sample};
use serde_json::{Value as Json, json};
use space::{ColumnKind, Vector};
use swarm::World;
use swarm::models::{Catalogue, Models};
use swarm::parameters::Scalar;

/// A simulation of a scenario.
pub(super) struct Simulated<R: Scalar, const D: usize> {
    /// Name and text of the file.
    name: String,
    text: String,
    /// Values put over the file's, by path, in the order in which they were first put.
    sets: Vec<(String, String)>,
    read: Read,
    seed: u64,
    threads: usize,
    world: World<R, D>,
    metrics: Vec<Box<dyn Measure<D>>>,
    /// What was changed while it ran: step, time, what.
    events: Vec<(u64, f64, String)>,
    /// The declared column that holds named states, if there is one.
    label: Option<usize>,
}

/// A simulation of a scenario file, from its name and text and the values put over it.
///
/// # Errors
/// What is wrong with the file.
pub fn simulate(
    name: &str,
    text: &str,
    sets: &[String],
    seed: Option<u64>,
    threads: usize,
) -> Result<Box<dyn Shown>, LiveError> {
    let read = build::read(name, text, sets)?;
    let seed = seed.or(read.scenario.seed).unwrap_or(1);
    let sets: Vec<(String, String)> = sets
        .iter()
        .filter_map(|set| set.split_once('='))
        .map(|(path, value)| (path.trim().to_owned(), value.trim().to_owned()))
        .collect();
    let scenario = read.scenario.clone();
    with_types!(scenario, R, D => {
        let (world, metrics) = made::<R, D>(&read, seed, threads)?;
        let label = label_of(&world);
        Ok(Box::new(Simulated::<R, D> {
            name: name.to_owned(),
            text: text.to_owned(),
            sets,
            read,
            seed,
            threads,
            world,
            metrics,
            events: Vec::new(),
            label,
        }))
    })
}

/// The world of a scenario, and its metrics.
fn made<R: Scalar, const D: usize>(
    read: &Read,
    seed: u64,
    threads: usize,
) -> Result<(World<R, D>, Vec<Box<dyn Measure<D>>>), LiveError>
where
    Models: Catalogue<R, D>,
{
    let world = build::world::<R, D>(&read.scenario, seed, threads).map_err(LiveError::Request)?;
    let metrics = metrics_of::<D>(&read.scenario).map_err(|wrong| LiveError::Request(wrong.what))?;
    Ok((world, metrics))
}

fn label_of<R: Scalar, const D: usize>(world: &World<R, D>) -> Option<usize> {
    world.frame().declared.iter().position(|column| matches!(column.kind, ColumnKind::Label(_)))
}

impl<R: Scalar + Send, const D: usize> Shown for Simulated<R, D>
where
    Models: Catalogue<R, D>,
{
    fn scene(&self) -> Json {
        let scenario = &self.read.scenario;
        let frame = self.world.frame();
        let schedule = build::schedule(scenario, false).ok();
        let places = (0..frame.columns.len()).map(|row| Vector(frame.columns.position(row).0.map(R::to_f64)));
        let groups: Vec<Json> = self
            .world
            .groups()
            .iter()
            .zip(frame.groups)
            .map(|(group, range)| {
                let title = swarm::models::find(&group.model).map_or("", |entry| entry.card.title);
                json!({
                    "name": group.name, "model": group.model, "title": title,
                    "first": range.first, "count": range.count, "radius": (group.radius() + group.half_axis()).to_f64(),
                })
            })
            .collect();
        let labels: Vec<Json> = self
            .label
            .iter()
            .filter_map(|&column| match frame.declared[column].kind {
                ColumnKind::Label(names) => Some(json!({ "column": frame.declared[column].name, "names": names })),
                ColumnKind::Quantity | ColumnKind::Count => None,
            })
            .collect();
        json!({
            "is": "scene",
            "kind": "live",
            "title": scenario.title,
            "about": scenario.about,
            "seed": self.seed,
            "dimensions": D,
            "units": { "length": scenario.units.length, "time": scenario.units.time },
            "space": space_json(frame.space, places),
            "groups": groups,
            "labels": labels,
            "step": schedule.map_or(1.0, |s| s.step),
            "steps": schedule.map_or(0, |s| s.steps),
            "frames": 0,
            "from_step": 0,
            "every_steps": 1,
            "metrics": metrics_json(scenario),
            "controls": controls::controls(scenario, &self.read.tree),
            "events": self.events.iter().map(|(step, t, what)| json!({ "step": step, "t": t, "what": what }))
                .collect::<Vec<_>>(),
        })
    }
    fn obstacles(&self) -> Json {
        obstacles(self.world.obstacles(), self.world.time())
    }
    fn items(&self) -> Option<Json> {
        let resources = self.world.resources()?;
        let there = resources.place.iter().zip(&resources.absent_until).filter(|(_, until)| until.is_none());
        let places: Vec<Json> = there.map(|(&place, _)| coordinates(place)).collect();
        Some(json!({ "is": "items", "places": places }))
    }
    fn obstacles_move(&self) -> bool {
        self.world.obstacles().list().iter().any(|obstacle| obstacle.plan.is_some())
    }
    fn advance(&mut self, count: i64) -> Result<i64, LiveError> {
        let count = count.max(0);
        self.world.run(count as u64);
        Ok(count)
    }
    fn moment(&self) -> (u64, f64, Option<u64>) {
        (self.world.step_number(), self.world.time(), None)
    }
    fn frame(&self, number: u32) -> Vec<u8> {
        let frame = self.world.frame();
        let (rows, columns) = (&frame.rows_by_id(), frame.columns);
        let dead = |row: usize| self.world.mortality().is_some_and(|c| columns.state[c][row] <= R::ZERO);
        let place = |id: usize, a: usize| {
            let row = rows[id];
            if dead(row) { f32::NAN } else { columns.position[a][row].to_f64() as f32 }
        };
        let unit: Vec<Vector<R, D>> = rows.iter().map(|&row| columns.velocity(row).unit()).collect();
        let heading = |id: usize, a: usize| unit[id][a].to_f64() as f32;
        let label = self.label.map(|column| {
            move |id: usize| {
                let group = frame.groups.partition_point(|range| range.first + range.count <= id as u32);
                if self.world.groups()[group].declares(column) {
                    columns.state[column][rows[id]].to_f64().clamp(0.0, 254.0) as u8
                } else {
                    255
                }
            }
        });
        let rows_count = columns.len();
        match &label {
            Some(label) => packed(number, frame.step, frame.time, D, rows_count, place, heading, Some(label)),
            None => packed(number, frame.step, frame.time, D, rows_count, place, heading, None),
        }
    }
    fn measure(&mut self) -> Option<Json> {
        let frame = self.world.frame();
        let mut rows = Vec::new();
        let mut push = |name: &str, sample: &Sample<D>| {
            let values: Vec<Option<f64>> = self.metrics.iter().map(|metric| metric.on(sample)).collect();
            rows.push(json!({ "group": name, "values": values }));
        };
        // the dead are not measured
        let lives =
            |row: &usize| self.world.mortality().is_none_or(|column| frame.columns.state[column][*row] > R::ZERO);
        let by_id = frame.rows_by_id();
        let living = |ids: std::ops::Range<usize>| by_id[ids].iter().copied().filter(lives).collect::<Vec<_>>();
        for group in frame.groups {
            let ids = group.first as usize..(group.first + group.count) as usize;
            push(&group.name, &Sample::of(&frame, &living(ids)));
        }
        if frame.groups.len() > 1 {
            push(build::WHOLE_GROUP, &Sample::of(&frame, &living(0..by_id.len())));
        }
        Some(json!({ "is": "metrics", "step": frame.step, "t": frame.time, "rows": rows }))
    }
    fn all_metrics(&self) -> Option<Json> {
        None
    }
    fn explain(&mut self, agent: u32) -> Result<Json, LiveError> {
        match self.world.explain(agent) {
            Some(told) => Ok(explain::json(&told, &self.read.scenario)),
            None => Err(LiveError::Request(format!("there is no agent {agent}"))),
        }
    }
    fn seek(&mut self, _: u64) -> Result<(), LiveError> {
        Err(LiveError::Request("a simulation goes forward; record it with `flockworks run` to go back".into()))
    }
    fn reset(&mut self, seed: Option<u64>) -> Result<(), LiveError> {
        let seed = seed.unwrap_or(self.seed);
        let (world, metrics) = made::<R, D>(&self.read, seed, self.threads)?;
        (self.world, self.metrics, self.seed) = (world, metrics, seed);
        self.events.clear();
        Ok(())
    }
    fn set(&mut self, path: &str, value: &Json) -> Result<bool, LiveError> {
        let mut sets = self.sets.clone();
        let value = value.to_string();
        match sets.iter_mut().find(|(other, _)| other == path) {
            Some(set) => set.1 = value.clone(),
            None => sets.push((path.to_owned(), value.clone())),
        }
        let lines: Vec<String> = sets.iter().map(|(path, value)| format!("{path}={value}")).collect();
        let read = build::read(&self.name, &self.text, &lines)?;
        let (old, new) = (&self.read.scenario, &read.scenario);
        if (old.precision, old.space.dimensions) != (new.precision, new.space.dimensions) {
            return Err(LiveError::Request(format!("`{path}` cannot change while it runs; change the file")));
        }
        let (mut world, metrics) = made::<R, D>(&read, self.seed, self.threads)?;
        let kept = world.restore(&self.world.save()).is_ok();
        self.events.push((world.step_number(), world.time(), format!("{path} = {value}")));
        (self.world, self.metrics, self.read, self.sets) = (world, metrics, read, sets);
        self.label = label_of(&self.world);
        Ok(kept)
    }
    fn file(&self) -> Result<String, LiveError> {
        crate::file::edit::with_values(&self.text, &self.sets).map_err(LiveError::Request)
    }
    fn natural_rate(&self) -> f64 {
        let step = build::schedule(&self.read.scenario, false).map_or(1.0, |schedule| schedule.step);
        (1.0 / step).clamp(20.0, 200.0)
    }
}
