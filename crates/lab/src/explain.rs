//! What one agent does in one step, as JSON: live, or at any frame of a complete run, computed again.

use crate::run::recorder::Carried;
use crate::run::{KEYFRAMES, kind};
use crate::scenario::{Scenario, build};
use crate::store::log::{Log, Record};
use crate::store::{StoreError, folder};
use crate::with_types;
use serde_json::{Value as Json, json};
use std::path::{Path, PathBuf};
use swarm::World;
use swarm::engine::Checkpoint;
use swarm::engine::explain::{Explanation, Seen, Told};
use swarm::models::{Catalogue, Models};
use swarm::parameters::Scalar;
use swarm::physics::Met;
use swarm::sensing::scanner::Origin;

/// An explanation as the viewer and the command line tell it, in the units of its scenario and with angles in degrees;
/// `docs/explanation/viewer-protocol.md` describes it. What is not a finite number is null.
pub fn json(told: &Explanation, scenario: &Scenario) -> Json {
    let seen = |seen: &Seen| json!({ "offset": seen.offset, "id": seen.id });
    let degrees = |angle: Option<f64>| angle.map(f64::to_degrees);
    let length = |v: &[f64]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
    let value = |stage: &str, name: &str, value: &Told, unit: &str| {
        let unit = scenario.units.of(unit);
        let angle = unit.starts_with("rad");
        let value = match value {
            Told::Number(number) if angle => json!(number.to_degrees()),
            Told::Number(number) => json!(number),
            Told::Word(word) => json!(word),
        };
        json!({ "stage": stage, "name": name, "value": value, "unit": if angle { unit.replacen("rad", "deg", 1) } else { unit } })
    };
    let mut values: Vec<Json> = told.values.iter().map(|v| value(v.stage, &v.name, &v.value, v.unit)).collect();
    if !told.components.is_empty() {
        let unit = scenario.units.of(told.unit);
        values.push(value("motion", "unit of the components", &Told::Word(unit), "-"));
    }
    if let Some(sum) = &told.sum {
        values.push(value("motion", "length of their sum", &Told::Number(length(sum)), told.unit));
    }
    json!({
        "agent": told.agent,
        "group": told.group,
        "model": told.model,
        "step": told.step,
        "t": told.time,
        "position": told.position,
        "velocity": told.velocity,
        "heading": told.heading,
        "radius": told.radius,
        "sensing": {
            "kind": if told.sensing.scanner { "laser" } else { "ideal" },
            "range": told.sensing.range,
            "field_of_view": degrees(told.sensing.field_of_view),
        },
        "rays": told.rays.iter().map(|ray| json!({
            "to": ray.to,
            "hit": match ray.hit {
                Origin::Nothing => "nothing",
                Origin::Obstacle => "obstacle",
                Origin::Member(_) => "member",
            },
            "lost": ray.lost,
        })).collect::<Vec<_>>(),
        "detected": told.detected.iter().map(seen).collect::<Vec<_>>(),
        "sets": told.sets.iter().map(|set| json!({
            "name": set.name,
            "rule": set.rule,
            "acts": set.acts,
            "low": set.low,
            "high": set.high,
            "angle": degrees(set.angle),
            "members": set.members.iter().map(seen).collect::<Vec<_>>(),
        })).collect::<Vec<_>>(),
        "obstacles": told.obstacles.iter().map(|near| json!({
            "offset": near.offset,
            "distance": near.distance,
            "away": near.away,
        })).collect::<Vec<_>>(),
        "components": told.components.iter().map(|component| json!({
            "name": component.name,
            "vector": component.vector,
            "magnitude": length(&component.vector),
        })).collect::<Vec<_>>(),
        "values": values,
        "choice": told.choice.iter().map(|choice| json!({
            "name": choice.name,
            "probability": choice.probability,
            "chosen": choice.chosen,
        })).collect::<Vec<_>>(),
        "wanted": { "velocity": told.wanted.velocity, "displacement": told.wanted.displacement },
        "performed": {
            "position": told.performed.position,
            "velocity": told.performed.velocity,
            "met": match told.met {
                Met::Nothing => "nothing",
                Met::Member => "member",
                Met::Obstacle => "obstacle",
                Met::Wall => "wall",
            },
        },
    })
}

/// What an agent of a complete run does in the step that begins at a frame, as [`json()`] writes it. Nothing of it is stored:
/// the state is computed again from the nearest full state before it.
///
/// # Errors
/// Where the folder holds no complete run, the frame or the agent is not there, or a file cannot be read.
pub fn at(folder: &Path, frame: u64, agent: u32) -> Result<Json, StoreError> {
    let refused = |what: String| Err(StoreError::Refused(what));
    let Some(manifest) = folder::manifest(folder)? else {
        return refused(format!("`{}` holds no run", folder.display()));
    };
    let damaged = |what: &str| StoreError::Damaged(format!("the manifest of `{}` has no {what}", folder.display()));
    if manifest.get("status").and_then(Json::as_str) != Some("complete") {
        return refused(format!("the run in `{}` is not complete; run it again to continue it", folder.display()));
    }
    let seed = manifest.get("seed").and_then(Json::as_u64).ok_or_else(|| damaged("seed"))?;
    let schedule = |key: &str| manifest.pointer(&format!("/schedule/{key}")).and_then(Json::as_u64);
    let steps = schedule("steps").ok_or_else(|| damaged("number of steps"))?;
    let every = schedule("steps_between_frames").filter(|&every| every > 0).ok_or_else(|| damaged("frames"))?;
    let from = schedule("step_of_first_frame").ok_or_else(|| damaged("first frame"))?;
    let step = frame.checked_mul(every).and_then(|steps| steps.checked_add(from)).filter(|&step| step <= steps);
    let Some(step) = step else {
        let last = steps.checked_sub(from).map(|steps| steps / every);
        return refused(match last {
            Some(last) => format!("the run has frames 0 to {last}, not {frame}"),
            None => "the run has no frames".into(),
        });
    };
    let file = |key: &str| manifest.pointer(&format!("/file/{key}"));
    let name = file("name").and_then(Json::as_str).unwrap_or_default();
    let text = file("text").and_then(Json::as_str).ok_or_else(|| damaged("scenario"))?;
    let sets = file("set").and_then(Json::as_array).into_iter().flatten();
    let sets: Vec<String> = sets.filter_map(|set| set.as_str().map(str::to_owned)).collect();
    let read = build::read(name, text, &sets).map_err(|problems| StoreError::Refused(problems.show(false)))?;
    past(folder, &read.scenario, seed)?.explain(step, agent)
}

/// The past of a complete run: any moment of it, computed again.
pub trait Past: Send {
    /// Explains what an agent does after so many steps, as [`json()`] writes it.
    ///
    /// # Errors
    /// Where there is no such agent, or a full state cannot be read.
    fn explain(&mut self, step: u64, agent: u32) -> Result<Json, StoreError>;
}

/// The past of the complete run in a folder. It remembers the moment it was asked for last, so that the next ones are
/// near.
///
/// # Errors
/// Where the scenario does not make a world, or the file of full states cannot be read.
pub fn past(folder: &Path, scenario: &Scenario, seed: u64) -> Result<Box<dyn Past>, StoreError> {
    with_types!(scenario, R, D => Ok(Box::new(Again::<R, D>::open(folder, scenario, seed)?)))
}

/// A world that is computed again.
struct Again<R: Scalar, const D: usize> {
    world: World<R, D>,
    scenario: Scenario,
    path: PathBuf,
    log: Log,
    /// Full states in the order of their steps, with the step where it is known.
    states: Vec<(Record, Option<u64>)>,
    start: Checkpoint<R, D>,
}

impl<R: Scalar, const D: usize> Again<R, D>
where
    Models: Catalogue<R, D>,
{
    fn open(folder: &Path, scenario: &Scenario, seed: u64) -> Result<Self, StoreError> {
        let agents = scenario.group.0.iter().map(|(_, group)| group.count).sum();
        let threads = crate::run::threads_for(agents);
        let world = build::world::<R, D>(scenario, seed, threads).map_err(StoreError::Refused)?;
        let path = folder.join(KEYFRAMES);
        let (log, records) = Log::open_to_read(&path)?;
        if records.iter().any(|record| record.kind != kind::KEYFRAME) {
            return Err(StoreError::Damaged(format!("`{}` holds something that is no state", path.display())));
        }
        let states = records.into_iter().map(|record| (record, None)).collect();
        Ok(Self { start: world.save(), world, scenario: scenario.clone(), path, log, states })
    }
    fn state(&mut self, number: usize) -> Result<Checkpoint<R, D>, StoreError> {
        let bytes = self.log.read(&self.states[number].0)?;
        let state = Carried::split(&bytes, self.world.groups().len())
            .and_then(|(_, state)| Checkpoint::from_bytes(state, &self.start))
            .ok_or_else(|| StoreError::Damaged(format!("a state in `{}` does not fit", self.path.display())))?;
        self.states[number].1 = Some(state.step());
        Ok(state)
    }
    /// The number of full states that are not later than a step.
    fn states_until(&mut self, step: u64) -> Result<usize, StoreError> {
        let (mut early, mut late) = (0, self.states.len());
        while early < late {
            let middle = early.midpoint(late);
            let there = match self.states[middle].1 {
                Some(there) => there,
                None => self.state(middle)?.step(),
            };
            if there <= step {
                early = middle + 1;
            } else {
                late = middle;
            }
        }
        Ok(early)
    }
    /// The nearest full state that is not later than a step, none for the start; and its step.
    fn nearest(&mut self, step: u64) -> Result<(Option<usize>, u64), StoreError> {
        let nearest = self.states_until(step)?.checked_sub(1);
        Ok((nearest, nearest.and_then(|nearest| self.states[nearest].1).unwrap_or(0)))
    }
    /// Brings the world to the beginning of a step.
    fn go_to(&mut self, step: u64) -> Result<(), StoreError> {
        let (nearest, from) = self.nearest(step)?;
        if !(from..=step).contains(&self.world.step_number()) {
            let state = match nearest {
                Some(nearest) => self.state(nearest)?,
                None => self.start.clone(),
            };
            self.world.restore(&state).map_err(|error| StoreError::Damaged(error.to_string()))?;
        }
        self.world.run(step.saturating_sub(self.world.step_number()));
        Ok(())
    }
}

impl<R: Scalar, const D: usize> Past for Again<R, D>
where
    Models: Catalogue<R, D>,
{
    fn explain(&mut self, step: u64, agent: u32) -> Result<Json, StoreError> {
        let agents = self.world.frame().columns.len();
        if agent as usize >= agents {
            return Err(StoreError::Refused(format!(
                "the run has {agents} agents, from number 0, and none of number {agent}"
            )));
        }
        self.go_to(step)?;
        match self.world.explain(agent) {
            Some(told) => Ok(json(&told, &self.scenario)),
            None => Err(StoreError::Refused(format!("there is no agent {agent}"))),
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::run::{End, Request, STATE_UPDATES, Watch, run};

    struct Nobody;
    impl Watch for Nobody {
        fn begin(&mut self, _: &Path, _: u64, _: u64, _: u64) {}
        fn at(&mut self, _: u64) {}
        fn stop(&self) -> bool {
            false
        }
    }

    const FISH: &str = r#"
kind = "scenario"
title = "Fish and their explanation"
units = { length = "cm", time = "s" }
time = { duration = 250, DRIVER }
space = { dimensions = 2, edges = "walls", size = 60 }
[group.fish]
count = 100
model = { couzin_2002 = { noise_deviation = 0.1 } }
physics = { radius = 0.2, contact = "slide", noise = { execution_direction = 3 } }
[record]
interval = 2.5
from = 5
"#;

    const ROBOTS: &str = r#"
kind = "scenario"
title = "Robots that scan"
units = { length = "m", time = "s" }
time = { duration = 20, step = 0.1 }
space = { dimensions = 2, edges = "walls", size = 8 }
[group.robots]
count = 6
model = { boids_rule_vectors = {} }
sensing = { laser = { association = 0.5, detection = { sensor_based = {} } } }
physics = { mobility = { differential_drive = {} }, radius = 0.17 }
[record]
interval = 1
"#;

    fn made(name: &str, text: &str) -> (PathBuf, build::Read) {
        let out = std::env::temp_dir().join(format!("flockworks-explain-{}-{name}", std::process::id()));
        let _ = std::fs::remove_dir_all(&out);
        // what is put over the file counts as well
        let sets: Vec<String> =
            text.contains("group.fish").then(|| "group.fish.count=90".to_owned()).into_iter().collect();
        let read =
            build::read("fish.toml", text, &sets).unwrap_or_else(|problems| unreachable!("{}", problems.show(false)));
        let request = Request {
            read: read.clone(),
            seed: Some(7),
            quick: false,
            threads: Some(1),
            out: Some(out.clone()),
            program: "test".into(),
        };
        assert_eq!(run(&request, &mut Nobody).unwrap().end, End::Complete);
        (out, read)
    }

    /// The explanation of the world itself as it passes by.
    fn live(read: &build::Read, step: u64, agent: u32) -> Json {
        let mut world = World::new(build::plan::<f64, 2>(&read.scenario, 7, 2).unwrap()).unwrap();
        world.run(step);
        json(&world.explain(agent).unwrap(), &read.scenario)
    }

    #[test]
    fn any_past_frame_is_explained_as_it_was_live() {
        for (name, driver) in [
            ("together", "driver = \"synchronous\""),
            ("in-turn", "driver = { sequential = { order = \"random\" } }"),
            ("clocks", "driver = { asynchronous = { tick = 0.05, period = 0.1, delay = 0.1 } }"),
        ] {
            let text = FISH.replace("DRIVER", driver);
            let (folder, read) = made(name, &text);
            let manifest = folder::manifest(&folder).unwrap().unwrap();
            let number = |key: &str| manifest["schedule"][key].as_u64().unwrap();
            let (first, every, steps) =
                (number("step_of_first_frame"), number("steps_between_frames"), number("steps"));
            let (_, states) = Log::open_to_read(&folder.join(KEYFRAMES)).unwrap();
            assert!(!states.is_empty(), "{name}: the run is too short for a full state");
            let last = (steps - first) / every;
            for frame in [0, 1, last / 2, last - 1, last] {
                let told = at(&folder, frame, 11).unwrap();
                assert_eq!(told, live(&read, first + frame * every, 11), "{name} frame {frame}");
            }
            // no frame is far from a full state
            let mut again = Again::<f64, 2>::open(&folder, &read.scenario, 7).unwrap();
            for step in (first..=steps).step_by(every as usize) {
                let (_, from) = again.nearest(step).unwrap();
                assert!((step - from) * 90 <= STATE_UPDATES, "{name}: step {step} from {from}");
            }
            // forth and back, on both sides of a full state
            let mut past = past(&folder, &read.scenario, 7).unwrap();
            for frame in [last, 0, last - 1, last - 3, 1, last / 2, last] {
                let step = first + frame * every;
                assert_eq!(past.explain(step, 11).unwrap(), live(&read, step, 11), "{name} frame {frame}");
            }
            assert!(at(&folder, last + 1, 0).unwrap_err().to_string().contains(&format!("frames 0 to {last}")));
            assert!(at(&folder, 0, 5000).unwrap_err().to_string().contains("none of number 5000"));
            std::fs::remove_dir_all(&folder).unwrap();
        }
    }

    #[test]
    fn rays_of_a_laser_are_told_in_a_past_frame_too() {
        let (folder, read) = made("laser", ROBOTS);
        let told = at(&folder, 3, 2).unwrap();
        assert_eq!(told, live(&read, 30, 2));
        assert_eq!(told["sensing"]["kind"], "laser");
        let rays = told["rays"].as_array().unwrap();
        assert!(rays.len() > 100 && rays.iter().any(|ray| ray["hit"] == "obstacle"));
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn an_explanation_has_the_form_of_the_protocol() {
        let text = FISH.replace("DRIVER", "driver = \"synchronous\"");
        let read = build::read("fish.toml", &text, &[]).unwrap_or_else(|p| unreachable!("{}", p.show(false)));
        let told = live(&read, 40, 3);
        let keys: Vec<&str> = told.as_object().unwrap().keys().map(String::as_str).collect();
        let protocol = include_str!("../../../docs/explanation/viewer-protocol.md");
        let (_, form) = protocol.split_once("## An explanation").unwrap();
        for key in keys {
            assert!(form.contains(&format!("\"{key}\"")), "the protocol has no `{key}`");
        }
        for key in
            ["agent", "group", "model", "step", "t", "position", "velocity", "heading", "radius", "sensing", "rays"]
                .into_iter()
                .chain(["detected", "sets", "obstacles", "components", "values", "choice", "wanted", "performed"])
        {
            assert!(told.get(key).is_some(), "`{key}` is missing");
        }
        // 270 degrees, told as degrees; 4 degrees allowed in a step of 0.1 s
        assert_eq!(told["sets"][1]["name"], "orientation");
        assert!((told["sets"][1]["angle"].as_f64().unwrap() - 270.0).abs() < 1e-9);
        let values = told["values"].as_array().unwrap();
        let allowed = values.iter().find(|value| value["name"] == "turn allowed").unwrap();
        assert!((allowed["value"].as_f64().unwrap() - 4.0).abs() < 1e-9 && allowed["unit"] == "deg");
        let speed = values.iter().find(|value| value["name"] == "speed wanted").unwrap();
        assert_eq!(speed["unit"], "cm/s");
        assert_eq!(told["performed"]["met"], "nothing");
    }
}
