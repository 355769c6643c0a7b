//! A run: a scenario stepped from its start to its end, watched, recorded, and continued where it stopped.

pub mod recorder;
pub mod tables;

use crate::scenario::build::{self, Read, Schedule};
use crate::store::folder::{self, Folder};
use crate::store::log::{Log, Record};
use crate::store::{StoreError, table};
use crate::with_types;
use recorder::{Message, Recorder};
use serde_json::{Value as Json, json};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Instant, SystemTime, UNIX_EPOCH};
use swarm::engine::Checkpoint;
use swarm::models::{Catalogue, Models};
use swarm::parameters::Scalar;

/// The file in which a run grows until it is complete.
const GROWING: &str = "unfinished.log";
/// Full states, from which any moment can be computed again.
pub const KEYFRAMES: &str = "keyframes.log";
/// Positions and velocities.
pub const TRAJECTORY: &str = "trajectory.parquet";
/// Metrics.
pub const METRICS: &str = "metrics.parquet";
/// What happened.
pub const EVENTS: &str = "events.parquet";
/// The page.
pub const REPORT: &str = "report.html";

/// Kinds of records in the growing file.
pub(crate) mod kind {
    pub(crate) const FRAMES: u32 = 1;
    pub(crate) const METRICS: u32 = 2;
    pub(crate) const EVENTS: u32 = 3;
    /// Ends a block: what came before it is kept.
    pub(crate) const KEYFRAME: u32 = 4;
    /// Ends the run.
    pub(crate) const DONE: u32 = 5;
}

/// Updates of agents between two full states: what a processor does in about 100 ms.
const BLOCK_UPDATES: u64 = 200_000;
/// Least steps in a block: a full state costs about as much to keep as a step of a large swarm to make.
const BLOCK_STEPS: u64 = 20;
/// About so many bytes an agent has in a full state.
const STATE_BYTES: u64 = 64;
/// Bytes of full states that a long run may write: it has fewer then, and may lose more when it is stopped.
const GROWN_STATES: u64 = 256 << 20;
/// Bytes of full states that are kept of a complete run; beyond it every second one is left out, again and again.
const KEPT_STATES: u64 = 64 << 20;

/// What is to be run.
#[derive(Clone, Debug)]
pub struct Request {
    /// The scenario as read.
    pub read: Read,
    /// Seed in place of the scenario's.
    pub seed: Option<u64>,
    /// A tenth of the time.
    pub quick: bool,
    /// Number of threads; none for as many as pay.
    pub threads: Option<usize>,
    /// Folder; none for one below `runs`.
    pub out: Option<PathBuf>,
    /// Name of the program with its version.
    pub program: String,
}

/// Who watches a run.
pub trait Watch {
    /// A run begins or goes on.
    fn begin(&mut self, folder: &Path, seed: u64, from: u64, steps: u64);
    /// So many steps are done.
    fn at(&mut self, step: u64);
    /// Whether to stop.
    fn stop(&self) -> bool;
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// It is complete.
    Complete,
    /// It was complete already.
    Already,
    /// It was stopped after so many steps; the same request continues it.
    Stopped(u64),
}

/// What became of a run.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Its folder.
    pub folder: PathBuf,
    /// How it ended.
    pub end: End,
    /// Seed.
    pub seed: u64,
    /// Updates of agents in this session.
    pub updates: u64,
    /// Seconds of this session.
    pub seconds: f64,
}

/// A number that was not there before.
fn drawn_seed() -> u64 {
    use std::hash::{BuildHasher, Hasher};
    let mut hasher = std::collections::hash_map::RandomState::new().build_hasher();
    hasher.write_u128(SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |t| t.as_nanos()));
    // short enough to be typed again
    hasher.finish() % 1_000_000_000
}

/// Seconds since 1970.
fn now() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |t| t.as_secs())
}

/// What decides about the results, apart from the seed.
fn identity(request: &Request) -> Json {
    let mut file = request.read.scenario.clone();
    file.seed = None;
    json!({ "scenario": crate::file::Form::write(&file).json(), "quick": request.quick })
}

/// The folder of a request, and what is there already.
fn place(request: &Request, identity: &Json) -> Result<(PathBuf, Option<Json>), StoreError> {
    let seed = request.seed.or(request.read.scenario.seed);
    let same = |manifest: &Json| {
        let kept = manifest.get("seed").and_then(Json::as_u64);
        // as text: the order of groups decides about ids and draws
        let there = manifest.get("identity").map(Json::to_string);
        there == Some(identity.to_string()) && (seed.is_none() || seed == kept)
    };
    if let Some(out) = &request.out {
        let manifest = folder::manifest(out)?;
        if let Some(manifest) = manifest.as_ref().filter(|manifest| !same(manifest)) {
            let empty = Json::Null;
            let mut lines = folder::differences(manifest.get("identity").unwrap_or(&empty), identity);
            let kept = manifest.get("seed").and_then(Json::as_u64);
            if let (Some(kept), Some(seed)) = (kept, seed.filter(|&seed| Some(seed) != kept)) {
                lines.push(format!("seed: {kept} there, {seed} now"));
            }
            if lines.is_empty() {
                lines.push("the same keys in another order, which decides about ids and draws".to_owned());
            }
            let more = lines.len().saturating_sub(8);
            lines.truncate(8);
            if more > 0 {
                lines.push(format!("and {more} more"));
            }
            return Err(StoreError::Refused(format!(
                "`{}` holds another run; choose another folder with --out\n  {}",
                out.display(),
                lines.join("\n  ")
            )));
        }
        return Ok((out.clone(), manifest));
    }
    let name = request.read.sources.name(0);
    let stem = Path::new(name).file_stem().and_then(|stem| stem.to_str()).unwrap_or("run");
    for number in 1.. {
        let path = Path::new("runs").join(if number == 1 { stem.to_owned() } else { format!("{stem}-{number}") });
        if !path.exists() {
            return Ok((path, None));
        }
        // a damaged or foreign folder is somebody's: the next number is free
        if let Ok(Some(manifest)) = folder::manifest(&path)
            && same(&manifest)
        {
            return Ok((path, Some(manifest)));
        }
    }
    Err(StoreError::Refused("no folder is free below `runs`".into()))
}

/// Threads that pay for so many agents.
fn threads_for(agents: usize) -> usize {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    (agents / 2000).clamp(1, cores)
}

/// Runs a scenario, or continues it.
///
/// # Errors
/// Where the folder is of something else or the system refuses. What was written before stays and can be continued.
pub fn run(request: &Request, watch: &mut dyn Watch) -> Result<Outcome, StoreError> {
    let identity = identity(request);
    let (path, before) = place(request, &identity)?;
    let kept = before.as_ref().and_then(|manifest| manifest.get("seed")).and_then(Json::as_u64);
    let seed = kept.or(request.seed).or(request.read.scenario.seed).unwrap_or_else(drawn_seed);
    let outcome = |end, updates, seconds| Outcome { folder: path.clone(), end, seed, updates, seconds };
    if before.as_ref().is_some_and(|manifest| manifest.get("status") == Some(&json!("complete"))) {
        return Ok(outcome(End::Already, 0, 0.0));
    }
    let schedule = build::schedule(&request.read.scenario, request.quick)
        .map_err(|wrong| StoreError::Refused(format!("{}: {}", wrong.path, wrong.what)))?;
    // what this seed makes impossible is found before anything is written
    with_types!(request.read.scenario, R, D => build::world::<R, D>(&request.read.scenario, seed, 1).map(|_| ()))
        .map_err(StoreError::Refused)?;
    let folder = Folder::claim(&path)?;
    // another process may have had the folder in the meantime
    let before = folder::manifest(&path)?;
    if before.as_ref().is_some_and(|manifest| manifest.get("status") == Some(&json!("complete"))) {
        return Ok(outcome(End::Already, 0, 0.0));
    }
    let agents: usize = request.read.scenario.group.0.iter().map(|(_, group)| group.count).sum();
    let threads = request.threads.unwrap_or_else(|| threads_for(agents));
    let mut manifest = before.unwrap_or_else(|| new_manifest(request, identity, seed, &schedule));
    if let Some(Json::Array(sessions)) = manifest.get_mut("sessions") {
        sessions.push(session(&request.program, threads));
    }
    manifest["status"] = json!("running");
    folder.write_manifest(&manifest)?;
    let began = Instant::now();
    let executed = with_types!(request.read.scenario, R, D => {
        execute::<R, D>(request, &folder, seed, threads, &schedule, watch)
    });
    let (from, reached) = match executed {
        Ok(reached) => reached,
        Err(error) => {
            manifest["status"] = json!("stopped");
            // the first error is the one to tell
            let _ = folder.write_manifest(&manifest);
            return Err(error);
        }
    };
    let complete = reached == schedule.steps;
    let seconds = began.elapsed().as_secs_f64();
    let updates = agents as u64 * (reached - from);
    if let Some(Json::Object(session)) =
        manifest.get_mut("sessions").and_then(Json::as_array_mut).and_then(|s| s.last_mut())
    {
        session.insert("seconds".into(), json!(seconds));
        session.insert("from_step".into(), json!(from));
        session.insert("to_step".into(), json!(reached));
        session.insert("agent_updates_per_second".into(), json!(updates as f64 / seconds.max(1e-9)));
    }
    manifest["status"] = json!(if complete { "complete" } else { "stopped" });
    if !complete {
        folder.write_manifest(&manifest)?;
        return Ok(outcome(End::Stopped(reached), updates, seconds));
    }
    finish(&folder, request, seed)?;
    folder.write_manifest(&manifest)?;
    let growing = folder.file(GROWING);
    std::fs::remove_file(&growing).map_err(|error| StoreError::io("remove", &growing, error))?;
    Ok(outcome(End::Complete, updates, seconds))
}

fn new_manifest(request: &Request, identity: Json, seed: u64, schedule: &Schedule) -> Json {
    let sources = &request.read.sources;
    json!({
        "format": 1,
        "kind": "scenario",
        "status": "running",
        "title": request.read.scenario.title,
        "seed": seed,
        "seed_given": request.seed.or(request.read.scenario.seed).is_some(),
        "file": {
            "name": sources.name(0),
            "text": sources.text(0),
            "set": sets(request),
        },
        "identity": identity,
        "schedule": {
            "step": schedule.step,
            "steps": schedule.steps,
            "steps_between_frames": schedule.record,
            "step_of_first_frame": schedule.record_from,
            "steps_between_measurements": schedule.measure,
        },
        "events": [],
        "host": { "os": std::env::consts::OS, "processor": std::env::consts::ARCH },
        "sessions": [],
    })
}

/// What was put over the file.
fn sets(request: &Request) -> Vec<&str> {
    (1..).map(|k| request.read.sources.text(k)).take_while(|text| !text.is_empty()).collect()
}

/// What is kept of a session when it begins.
pub(crate) fn session(program: &str, threads: usize) -> Json {
    json!({ "program": program, "build": build_id(), "threads": threads, "started": now() })
}

/// A name for the very program that runs: a checksum of its file.
fn build_id() -> String {
    let bytes = std::env::current_exe().and_then(std::fs::read).unwrap_or_default();
    format!("{:016x}", twox_hash::XxHash64::oneshot(0, &bytes))
}

/// Steps between two full states. It follows from the scenario alone, so that a run that was stopped has them at the same
/// steps.
fn block_steps(agents: u64, schedule: &Schedule) -> u64 {
    let agents = agents.max(1);
    let by_bytes = schedule.steps.saturating_mul(agents) / (GROWN_STATES / STATE_BYTES);
    (BLOCK_UPDATES / agents).min(schedule.steps / 10).max(BLOCK_STEPS).max(by_bytes)
}

/// Steps the world from where it is to the end, or to where it is stopped; where it began, and how far it came.
fn execute<R: Scalar + Send + 'static, const D: usize>(
    request: &Request,
    folder: &Folder,
    seed: u64,
    threads: usize,
    schedule: &Schedule,
    watch: &mut dyn Watch,
) -> Result<(u64, u64), StoreError>
where
    Models: Catalogue<R, D>,
{
    let scenario = &request.read.scenario;
    let mut world = build::world::<R, D>(scenario, seed, threads).map_err(StoreError::Refused)?;
    let growing = folder.file(GROWING);
    let (mut log, mut from, mut carried) = (None, 0, recorder::Carried::new(world.groups().len()));
    if growing.exists() {
        let (mut old, records) = Log::open(&growing)?;
        if records.last().is_some_and(|record| record.kind == kind::DONE) {
            return Ok((schedule.steps, schedule.steps));
        }
        let last = records.iter().rev().find(|record| record.kind == kind::KEYFRAME).copied();
        if let Some(record) = &last {
            let bytes = old.read(record)?;
            let (kept, state) = recorder::Carried::split(&bytes, world.groups().len())
                .and_then(|(kept, state)| Some((kept, Checkpoint::from_bytes(state, &world.save())?)))
                .ok_or_else(|| {
                    StoreError::Damaged(format!(
                        "a state in `{}` does not fit; remove the folder to run anew",
                        growing.display()
                    ))
                })?;
            world.restore(&state).map_err(|error| StoreError::Damaged(error.to_string()))?;
            carried = kept;
            from = state.step();
        }
        old.keep_until(last.as_ref())?;
        log = Some(old);
    }
    let log = match log {
        Some(log) => log,
        None => Log::create(&growing)?,
    };
    watch.begin(folder.path(), seed, from, schedule.steps);
    let agents = world.frame().columns.len() as u64;
    let block = block_steps(agents, schedule);
    let metrics = crate::scenario::metrics_of::<D>(scenario).map_err(|wrong| StoreError::Refused(wrong.what))?;
    let recorder = Recorder::start(&world, scenario, metrics, log);
    let mut observer = recorder::Observer::new(&world, carried, schedule.step);
    let sent = 'steps: loop {
        let step = world.step_number();
        if step > from && step.is_multiple_of(block) {
            let state = Message::Keyframe(observer.carried.clone(), Box::new(world.save()));
            if !recorder.send(state) {
                break 'steps false;
            }
        }
        let frame = (scenario.record.trajectory
            && step >= schedule.record_from
            && (step - schedule.record_from).is_multiple_of(schedule.record))
        .then(|| (step - schedule.record_from) / schedule.record);
        let measured = step.is_multiple_of(schedule.measure);
        if (frame.is_some() || measured) && !recorder.send(observer.sample(&world, frame, measured)) {
            break 'steps false;
        }
        if step == schedule.steps {
            break recorder.send(Message::Done);
        }
        if watch.stop() {
            break true;
        }
        world.step();
        if let Some(events) = observer.observe(&world)
            && !recorder.send(Message::Events(events))
        {
            break 'steps false;
        }
        watch.at(world.step_number());
    };
    let written = recorder.finish();
    if !sent {
        written?;
        return Err(StoreError::Damaged("the recorder ended before the run".into()));
    }
    written?;
    Ok((from, world.step_number()))
}

/// Makes the tables and the page of a run whose growing file is complete.
fn finish(folder: &Folder, request: &Request, seed: u64) -> Result<(), StoreError> {
    let (mut log, records) = Log::open(&folder.file(GROWING))?;
    let scenario = &request.read.scenario;
    let (frames, metrics, events) = with_types!(scenario, R, D => {
        let world = build::world::<R, D>(scenario, seed, 1).map_err(StoreError::Refused)?;
        let metrics = crate::scenario::metrics_of::<D>(scenario).map_err(|wrong| StoreError::Refused(wrong.what))?;
        let all = tables::Tables::new(&world, scenario, &metrics);
        (all.frames, all.metrics, all.events)
    });
    let notes = notes(request, seed);
    let tables = [
        (TRAJECTORY, kind::FRAMES, frames, scenario.record.trajectory),
        (METRICS, kind::METRICS, metrics, true),
        (EVENTS, kind::EVENTS, events, true),
    ];
    for (name, kind, headings, wanted) in tables {
        if !wanted {
            continue;
        }
        let of_kind: Vec<&Record> = records.iter().filter(|record| record.kind == kind).collect();
        folder.write(name, |out| {
            let blocks = of_kind.iter().map(|record| log.read(record));
            table::join(out, &headings, &notes, blocks).map(|_| ())
        })?;
    }
    let states: Vec<&Record> = records.iter().filter(|record| record.kind == kind::KEYFRAME).collect();
    let bytes: u64 = states.iter().map(|record| record.length).sum();
    let every = (bytes.div_ceil(KEPT_STATES) as usize).next_power_of_two();
    let part = folder.file(&format!("{KEYFRAMES}.part"));
    let mut kept = Log::create(&part)?;
    for record in states.into_iter().skip(every - 1).step_by(every) {
        let state = log.read(record)?;
        kept.append(kind::KEYFRAME, &state)?;
    }
    drop(kept);
    let path = folder.file(KEYFRAMES);
    std::fs::rename(&part, &path).map_err(|error| StoreError::io("write", &path, error))?;
    let page = crate::report::of_run::page(folder.path(), &request.read, seed, request.quick, &request.program)?;
    let html = crate::report::html(&page);
    let path = folder.file(REPORT);
    folder.write(REPORT, |out| out.write_all(html.as_bytes()).map_err(|error| StoreError::io("write", &path, error)))
}

/// What a table says of the run it comes from.
fn notes(request: &Request, seed: u64) -> Vec<(String, String)> {
    let units = &request.read.scenario.units;
    vec![
        ("flockworks.title".into(), request.read.scenario.title.clone()),
        ("flockworks.seed".into(), seed.to_string()),
        ("flockworks.length_unit".into(), units.length.clone()),
        ("flockworks.time_unit".into(), units.time.clone()),
        ("flockworks.file".into(), request.read.sources.text(0).to_owned()),
        ("flockworks.set".into(), sets(request).join("\n")),
    ]
}
