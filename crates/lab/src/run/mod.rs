//! A run: a scenario stepped from its start to its end, watched, recorded, and continued where it stopped.

mod obstacles;
pub mod recorder;
pub mod tables;

use crate::scenario::build::{self, Read, Schedule};
use crate::store::folder::{self, Folder};
use crate::store::log::{Log, Record};
use crate::store::{StoreError, table};
use crate::with_types;
use bytes::Bytes;
use recorder::{Message, Recorder};
use serde_json::{Value as Json, json};
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
/// Where obstacles were drawn, where there are any.
pub const OBSTACLES: &str = "obstacles.parquet";
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
    /// A full state within a block.
    pub(crate) const STATE: u32 = 6;
}

/// Updates of agents between two full states: what a slow law makes in about 50 ms, so that any moment of a run is computed
/// again in less than 100 ms.
pub(crate) const STATE_UPDATES: u64 = 50_000;
/// Least steps between them: a full state costs about as much to keep as a step of a large swarm to make.
const STATE_STEPS: u64 = 20;
/// Updates of agents in a block.
const BLOCK_UPDATES: u64 = 200_000;
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
pub(crate) fn now() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |t| t.as_secs())
}

/// What decides about the results, apart from the seed.
fn identity(request: &Request) -> Json {
    let mut file = request.read.scenario.clone();
    file.seed = None;
    json!({ "scenario": crate::file::Form::write(&file).json(), "quick": request.quick })
}

/// The program that began an unfinished run, where it is not the very one that runs now. A compiler, a flag or a changed line
/// may change the last bits of a number, and a run is the work of one program from its start to its end.
fn other_build(manifest: &Json) -> Option<String> {
    let last = manifest.get("sessions")?.as_array()?.last()?;
    let unfinished = manifest.get("status") != Some(&json!("complete"));
    (unfinished && last.get("build") != Some(&json!(build_id())))
        .then(|| last.get("program").and_then(Json::as_str).unwrap_or("unknown").to_owned())
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
        if out.exists() && !out.is_dir() {
            let what =
                format!("`{}` is no folder, in which results could be put; choose another with --out", out.display());
            return Err(StoreError::Refused(what));
        }
        let manifest = folder::manifest(out)?;
        let kind = manifest.as_ref().and_then(|manifest| manifest.get("kind")).and_then(Json::as_str);
        if let Some(kind) = kind.filter(|&kind| kind != "scenario") {
            return Err(StoreError::Refused(format!(
                "`{}` holds another run, of the kind {kind}; choose another folder with --out",
                out.display()
            )));
        }
        if manifest.as_ref().is_some_and(|manifest| manifest.get("identity").is_none()) {
            return Err(StoreError::Damaged(format!(
                "`{}` does not say what was run; choose another folder with --out",
                out.join(folder::MANIFEST).display()
            )));
        }
        if let Some(program) = manifest.as_ref().filter(|manifest| same(manifest)).and_then(other_build) {
            return Err(StoreError::Refused(format!(
                "the unfinished run in `{}` was begun by another build of the program ({program}), whose numbers may \
                 differ in their last bits; finish it with that one, or choose another folder with --out",
                out.display()
            )));
        }
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
            return Err(StoreError::Refused(format!(
                "`{}` holds another run; choose another folder with --out\n  {}",
                out.display(),
                folder::first(lines)
            )));
        }
        return Ok((out.clone(), manifest));
    }
    let stem = request.read.sources.stem(0).unwrap_or("run");
    // what another build began stays as it is
    folder::free(stem, &|manifest| same(manifest) && other_build(manifest).is_none())
}

/// Threads that pay for so many agents.
pub(crate) fn threads_for(agents: usize) -> usize {
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
    let complete = |manifest: &Json| manifest.get("status") == Some(&json!("complete"));
    if before.as_ref().is_some_and(complete) {
        whole(&path, request)?;
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
    if before.as_ref().is_some_and(complete) {
        whole(&path, request)?;
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
    let Reached { from, to: reached, log, records } = match executed {
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
    finish(&folder, request, seed, log, &records)?;
    folder.write_manifest(&manifest)?;
    let growing = folder.file(GROWING);
    std::fs::remove_file(&growing).map_err(|error| StoreError::io("remove", &growing, error))?;
    Ok(outcome(End::Complete, updates, seconds))
}

/// Refuses a complete run of which something was removed: its file would make all of it anew, at the cost of the whole run, and
/// what is still there may be somebody's results.
fn whole(path: &Path, request: &Request) -> Result<(), StoreError> {
    let scenario = &request.read.scenario;
    let scattered = scenario.scatter.0.iter().any(|(_, scatter)| scatter.count.is_some_and(|count| count > 0));
    let wanted = [TRAJECTORY, METRICS, EVENTS, OBSTACLES, KEYFRAMES, REPORT].into_iter().filter(|&name| match name {
        TRAJECTORY => scenario.record.trajectory,
        OBSTACLES => scattered || !scenario.obstacle.is_empty(),
        _ => true,
    });
    let there = |name: &str| std::fs::metadata(path.join(name)).is_ok_and(|file| file.len() > 0 || name == KEYFRAMES);
    let gone: Vec<&str> = wanted.filter(|name| !there(name)).collect();
    let folder = path.display();
    match gone.as_slice() {
        [] => Ok(()),
        [REPORT] => Err(StoreError::Refused(format!(
            "the run in `{folder}` is complete, but its page {REPORT} is gone; `flockworks report {folder}` makes it anew"
        ))),
        gone => Err(StoreError::Refused(format!(
            "the run in `{folder}` is complete, but {} is gone or empty; remove the folder to run anew, or choose another \
             with --out",
            gone.join(" and ")
        ))),
    }
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

/// Steps between two full states, and between two ends of blocks, which are at full states. They follow from the scenario
/// alone, so that a run that was stopped has them at the same steps.
fn spacing(agents: u64, schedule: &Schedule) -> (u64, u64) {
    let agents = agents.max(1);
    let by_bytes = schedule.steps.saturating_mul(agents).div_ceil(GROWN_STATES / STATE_BYTES);
    let state = (STATE_UPDATES / agents).max(STATE_STEPS).max(by_bytes);
    let block = (BLOCK_UPDATES / agents).min(schedule.steps / 10) / state;
    (state, state * block.max(1))
}

/// How far a session came.
struct Reached {
    /// Steps that were made before it.
    from: u64,
    /// Steps that are made now.
    to: u64,
    /// The growing file and what it holds.
    log: Log,
    records: Vec<Record>,
}

/// Steps the world from where it is to the end, or to where it is stopped.
fn execute<R: Scalar + Send + 'static, const D: usize>(
    request: &Request,
    folder: &Folder,
    seed: u64,
    threads: usize,
    schedule: &Schedule,
    watch: &mut dyn Watch,
) -> Result<Reached, StoreError>
where
    Models: Catalogue<R, D>,
{
    let scenario = &request.read.scenario;
    let mut world = build::world::<R, D>(scenario, seed, threads).map_err(StoreError::Refused)?;
    let growing = folder.file(GROWING);
    let (mut log, mut records) =
        if growing.exists() { Log::open(&growing)? } else { (Log::create(&growing)?, Vec::new()) };
    let (mut from, mut carried) = (0, recorder::Carried::new(world.groups().len()));
    if records.last().is_some_and(|record| record.kind == kind::DONE) {
        return Ok(Reached { from: schedule.steps, to: schedule.steps, log, records });
    }
    let whole = records.iter().rposition(|record| record.kind == kind::KEYFRAME).map_or(0, |last| last + 1);
    records.truncate(whole);
    if let Some(record) = records.last() {
        let bytes = log.read(record)?;
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
    log.keep_until(records.last())?;
    watch.begin(folder.path(), seed, from, schedule.steps);
    let agents = world.frame().columns.len() as u64;
    let (state, block) = spacing(agents, schedule);
    let metrics = crate::scenario::metrics_of::<D>(scenario).map_err(|wrong| StoreError::Refused(wrong.what))?;
    let recorder = Recorder::start(&world, scenario, metrics, log, records)?;
    let mut observer = recorder::Observer::new(&world, carried, schedule.step);
    let sent = 'steps: loop {
        let step = world.step_number();
        if step > from && step.is_multiple_of(state) {
            let ends = step.is_multiple_of(block);
            let state = Message::State { ends, carried: observer.carried.clone(), state: Box::new(world.save()) };
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
    let (log, records) = written?;
    Ok(Reached { from, to: world.step_number(), log, records })
}

/// Makes the tables and the page of a run whose growing file is complete.
fn finish(folder: &Folder, request: &Request, seed: u64, mut log: Log, records: &[Record]) -> Result<(), StoreError> {
    let scenario = &request.read.scenario;
    let (frames, metrics, events, drawn) = with_types!(scenario, R, D => {
        let world = build::world::<R, D>(scenario, seed, 1).map_err(StoreError::Refused)?;
        let metrics = crate::scenario::metrics_of::<D>(scenario).map_err(|wrong| StoreError::Refused(wrong.what))?;
        let all = tables::Tables::new(&world, scenario, &metrics);
        let drawn = world.obstacles().list();
        (all.frames, all.metrics, all.events, (!drawn.is_empty()).then(|| obstacles::table(drawn, scenario)))
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
            let blocks = of_kind.iter().map(|record| log.read(record).map(Bytes::from));
            table::join(out, &headings, &notes, blocks).map(|_| ())
        })?;
    }
    if let Some((headings, columns)) = drawn {
        table::write_table(folder, OBSTACLES, &headings, &columns, &notes)?;
    }
    let full = |record: &&Record| record.kind == kind::KEYFRAME || record.kind == kind::STATE;
    let states: Vec<&Record> = records.iter().filter(full).collect();
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
    folder.write_text(REPORT, &crate::report::html(&page))
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

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn every_moment_is_near_a_full_state_and_blocks_end_at_full_states() {
        for agents in [0, 1, 7, 90, 200, 999, 5_000, 100_000, 2_000_000] {
            for steps in [1, 30, 600, 6_000, 100_000] {
                let schedule = Schedule { step: 0.1, steps, record: 1, record_from: 0, measure: 1 };
                let (state, block) = spacing(agents, &schedule);
                assert!(block.is_multiple_of(state) && state >= STATE_STEPS);
                let updates = state * agents;
                let few = updates <= STATE_UPDATES || state == STATE_STEPS;
                let states = steps / state * agents.max(1) * STATE_BYTES;
                // fewer only where they would fill the disk
                assert!(few || states > GROWN_STATES / 4, "{agents} agents, {steps} steps: {state}");
                assert!(states <= GROWN_STATES || steps < state, "{agents} agents, {steps} steps: {state}");
            }
        }
    }

    /// Stops after so many steps.
    struct Until(u64, u64);
    impl Watch for Until {
        fn begin(&mut self, _: &Path, _: u64, _: u64, _: u64) {}
        fn at(&mut self, step: u64) {
            self.1 = step;
        }
        fn stop(&self) -> bool {
            self.1 >= self.0
        }
    }

    #[test]
    fn what_another_build_began_is_not_continued() {
        let text = r#"
kind = "scenario"
title = "Two"
time = { duration = 100 }
space = { dimensions = 2, edges = "open" }
group.two = { count = 2, model = { vicsek_1995 = {} }, start = { place = { ball = { centre = [0, 0], radius = 1 } } } }
"#;
        let read =
            build::read("two.toml", text, &[]).unwrap_or_else(|problems| unreachable!("{}", problems.show(false)));
        let out = std::env::temp_dir().join(format!("flockworks-build-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&out);
        let request = Request {
            read,
            seed: Some(1),
            quick: false,
            threads: Some(1),
            out: Some(out.clone()),
            program: "test 1".into(),
        };
        assert_eq!(run(&request, &mut Until(50, 0)).unwrap().end, End::Stopped(50));
        let manifest = std::fs::read_to_string(out.join(folder::MANIFEST)).unwrap();
        std::fs::write(out.join(folder::MANIFEST), manifest.replace(&build_id(), "0123456789abcdef")).unwrap();
        let refused = run(&request, &mut Until(1000, 0)).unwrap_err().to_string();
        assert!(refused.contains("another build of the program (test 1)"), "{refused}");
        std::fs::write(out.join(folder::MANIFEST), &manifest).unwrap();
        assert_eq!(run(&request, &mut Until(1000, 0)).unwrap().end, End::Complete);
        std::fs::remove_dir_all(&out).unwrap();
    }
}
