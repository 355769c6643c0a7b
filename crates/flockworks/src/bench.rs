//! `flockworks bench`: agent-updates per second of the workloads, and what each model costs beside a plain loop.

use crate::fault::{Fault, hint, wrong};
use crate::step::Precision;
use crate::table::Table;
use crate::workloads::{NAMES, Running, SEED, Workload};
use clap::{Args, ValueEnum};
use plain::{Plain, PlainStep, in_space, kept, on_a_ring, plain};
use serde_json::{Value as Json, json};
use space::{Space, Vector};
use std::io::{IsTerminal, Write};
use std::time::Instant;
use swarm::engine::{GroupPlan, Placement};
use swarm::models::{Catalogue, Entry, LIST, Models};
use swarm::parameters::{Scalar, Values};
use swarm::{World, WorldPlan};

/// Shortest time over which anything is measured, in seconds; shorter trials are repeated within a measurement.
const SHORTEST: f64 = 0.2;
/// Neighbours that `bench models` aims at where a law's sets depend on the density.
pub(crate) const NEIGHBOURS: f64 = 16.0;

/// Precisions to run in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Precisions {
    /// 32 bits.
    F32,
    /// 64 bits.
    F64,
    /// Both.
    Both,
}

/// Options of `bench`.
#[derive(Args, Debug)]
pub struct BenchOptions {
    /// Workloads: W1 W1c W2 W3 W4 W5 W6, a variant such as W4/Align/6, `models`, or `compositions`; W1 W2 W3 W4/Align/6 if none is given.
    pub workloads: Vec<String>,
    /// Numbers of agents, in place of each workload's own.
    #[arg(long, value_delimiter = ',', value_name = "N,N,..", value_parser = clap::value_parser!(u32).range(1..=100_000_000))]
    pub agents: Vec<u32>,
    /// Numbers of threads.
    #[arg(long, value_delimiter = ',', value_name = "N,N,..", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Vec<u16>,
    /// Precision of reals; each workload's own if not given.
    #[arg(long, value_enum)]
    pub precision: Option<Precisions>,
    /// Steps of a run, in place of each workload's own.
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..))]
    pub steps: Option<u64>,
    /// Runs of each row; medians are printed.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub repeats: u16,
    /// Print an array of objects instead of a table.
    #[arg(long)]
    pub json: bool,
    /// Measure this model alone, as `bench models` does.
    #[arg(long, value_name = "ID")]
    pub model: Option<String>,
}

/// One measured row.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Name of the workload.
    pub workload: String,
    /// Number of agents.
    pub agents: usize,
    /// Number of threads.
    pub threads: usize,
    /// Precision of reals.
    pub precision: Precision,
    /// Steps of a run.
    pub steps: u64,
    /// Wall time of a run in seconds, median over the repeats.
    pub wall: f64,
    /// Time of the processors in seconds, where the system tells.
    pub cpu: Option<f64>,
    /// Mean number of others in any named set of an agent.
    pub mean_neighbours: f64,
}

impl Row {
    /// Agent-updates per second.
    pub fn updates(&self) -> f64 {
        (self.agents as u64 * self.steps) as f64 / self.wall
    }
    fn json(&self) -> Json {
        json!({
            "workload": self.workload,
            "agents": self.agents,
            "threads": self.threads,
            "precision": self.precision.word(),
            "steps": self.steps,
            "wall_s": self.wall,
            "cpu_s": self.cpu,
            "agent_updates_per_s": self.updates(),
            "useful_pairs_per_s": self.updates() * self.mean_neighbours,
            "mean_neighbours": self.mean_neighbours,
        })
    }
    fn cells(&self) -> Vec<String> {
        vec![
            self.workload.clone(),
            self.agents.to_string(),
            self.threads.to_string(),
            self.precision.word().into(),
            self.steps.to_string(),
            format!("{:.4}", self.wall),
            self.cpu.map_or_else(|| "-".into(), |cpu| format!("{cpu:.4}")),
            rounded(self.updates()),
            rounded(self.updates() * self.mean_neighbours),
            format!("{:.1}", self.mean_neighbours),
        ]
    }
}

fn rounded(rate: f64) -> String {
    match rate {
        r if r >= 1e9 => format!("{:.2} G", r / 1e9),
        r if r >= 1e6 => format!("{:.2} M", r / 1e6),
        r if r >= 1e3 => format!("{:.2} k", r / 1e3),
        r => format!("{r:.2}"),
    }
}

fn table() -> Table {
    let mut table = Table::new(&[
        "workload",
        "agents",
        "threads",
        "precision",
        "steps",
        "wall s",
        "cpu s",
        "agent-updates/s",
        "useful pairs/s",
        "mean neighbours",
    ]);
    table.right(&[1, 2, 4, 5, 6, 7, 8, 9]);
    table
}

/// Runs the workloads and prints what they cost.
///
/// # Errors
/// An unknown workload or model, or a reader that went away.
pub fn bench(options: &BenchOptions, out: &mut dyn Write) -> Result<(), Fault> {
    let names: Vec<&str> = options.workloads.iter().map(String::as_str).collect();
    if options.model.is_some() && names.iter().any(|&name| name != "models") {
        return wrong("--model goes with `bench models`, not with other workloads");
    }
    if options.model.is_some() || names.contains(&"models") {
        if names.iter().any(|&name| name != "models") {
            return wrong("`models` does not go together with other workloads; run them one after the other");
        }
        return of_models(options, out);
    }
    if names.contains(&"compositions") {
        if names.len() > 1 {
            return wrong("`compositions` does not go together with other workloads; run them one after the other");
        }
        return crate::compositions::bench(options, out);
    }
    let usual = ["W1", "W2", "W3", "W4/Align/6"];
    let sizes: Vec<usize> = options.agents.iter().map(|&n| n as usize).collect();
    let mut workloads = Vec::new();
    for name in if names.is_empty() { &usual[..] } else { &names[..] } {
        if !NAMES.iter().any(|(known, _)| known == name) {
            let known: Vec<&str> = NAMES.iter().map(|(name, _)| *name).collect();
            return wrong(format!("unknown workload `{name}`{}", hint(name, &known)));
        }
        workloads.extend(Workload::named(name, &sizes, options.steps)?);
    }
    let mut rows: Vec<Row> = Vec::new();
    let mut refused: Vec<String> = Vec::new();
    for workload in &workloads {
        match measure(workload, options) {
            Ok(measured) => rows.extend(measured),
            Err(Fault::Input(reason)) => {
                if !refused.contains(&reason) {
                    refused.push(reason);
                }
            }
            Err(other) => return Err(other),
        }
    }
    if rows.is_empty() {
        return wrong(refused.join("; "));
    }
    if options.json {
        let list: Vec<Json> = rows.iter().map(Row::json).collect();
        writeln!(out, "{:#}", Json::from(list))?;
        return Ok(());
    }
    let mut table = table();
    for row in &rows {
        table.row(row.cells());
    }
    out.write_all(table.text().as_bytes())?;
    for line in growth(&rows).iter().chain(&refused) {
        writeln!(out, "{line}")?;
    }
    Ok(())
}

/// Cost per agent at the largest size over that at the smallest, for every workload measured at more than one size.
fn growth(rows: &[Row]) -> Vec<String> {
    let mut lines = Vec::new();
    let same = |a: &Row, b: &Row| a.workload == b.workload && a.threads == b.threads && a.precision == b.precision;
    for (k, row) in rows.iter().enumerate() {
        if rows[..k].iter().any(|other| same(other, row)) {
            continue;
        }
        let alike = || rows.iter().filter(|other| same(other, row));
        let (Some(small), Some(large)) = (alike().min_by_key(|r| r.agents), alike().max_by_key(|r| r.agents)) else {
            continue;
        };
        if small.agents < large.agents {
            lines.push(format!(
                "growth {}, {} {}, {}: an agent costs {:.2} times as much among {} as among {}",
                row.workload,
                row.threads,
                if row.threads == 1 { "thread" } else { "threads" },
                row.precision.word(),
                small.updates() / large.updates(),
                large.agents,
                small.agents
            ));
        }
    }
    lines
}

/// The rows of one workload at one size: every number of threads and precision, their repeats interleaved.
fn measure(workload: &Workload, options: &BenchOptions) -> Result<Vec<Row>, Fault> {
    let available = std::thread::available_parallelism().map_or(1, usize::from);
    let threads: Vec<usize> = match &options.threads[..] {
        [] if workload.threads_help() && available > 1 => vec![1, available],
        [] => vec![1],
        given => given.iter().map(|&n| usize::from(n)).collect(),
    };
    let precisions = match options.precision {
        None => vec![workload.usual_precision()],
        Some(Precisions::F32) => vec![Precision::F32],
        Some(Precisions::F64) => vec![Precision::F64],
        Some(Precisions::Both) => vec![Precision::F32, Precision::F64],
    };
    let mut subjects = Vec::new();
    for &precision in &precisions {
        for &threads in &threads {
            subjects.push(Subject::new(workload, precision, threads)?);
        }
    }
    for _ in 0..options.repeats {
        for subject in &mut subjects {
            subject.measure()?;
        }
    }
    Ok(subjects.iter().map(Subject::row).collect())
}

/// Something that is measured several times.
struct Subject<'a> {
    workload: &'a Workload,
    precision: Precision,
    threads: usize,
    /// Runs within a measurement.
    trials: u32,
    wall: Vec<f64>,
    cpu: Vec<Option<f64>>,
    neighbours: Vec<f64>,
}

impl<'a> Subject<'a> {
    fn new(workload: &'a Workload, precision: Precision, threads: usize) -> Result<Self, Fault> {
        let mut world = workload.world(precision, threads)?;
        // the warm-up, which also tells how many runs fill a measurement
        let warm_up = if workload.is_trial() { workload.steps.min(200) } else { workload.steps };
        let start = Instant::now();
        world.run(warm_up);
        let trial = start.elapsed().as_secs_f64() * workload.steps as f64 / warm_up.max(1) as f64;
        let trials = (SHORTEST / trial.max(1e-6)).ceil().clamp(1.0, 1000.0) as u32;
        let (wall, cpu, neighbours) = (Vec::new(), Vec::new(), Vec::new());
        Ok(Self { workload, precision, threads, trials, wall, cpu, neighbours })
    }
    /// A world where a measurement begins, always in the same state: rows that differ in threads alone have the same neighbours.
    fn begun(&self) -> Result<Box<dyn Running>, Fault> {
        let mut world = self.workload.world(self.precision, self.threads)?;
        if !self.workload.is_trial() {
            world.run(self.workload.steps);
        }
        Ok(world)
    }
    fn measure(&mut self) -> Result<(), Fault> {
        let steps = self.workload.steps;
        let every = (self.workload.agents / 200).max(1);
        let (mut wall, mut cpu, mut neighbours) = (0.0, Some(0.0), 0.0);
        for _ in 0..self.trials {
            let mut world = self.begun()?;
            let (before, start) = (processor_time(), Instant::now());
            world.run(steps);
            wall += start.elapsed().as_secs_f64();
            cpu = match (cpu, before, processor_time()) {
                (Some(sum), Some(before), Some(after)) => Some(sum + (after - before).max(0.0)),
                _ => None,
            };
            if !self.workload.is_trial() {
                neighbours = world.mean_neighbours(every);
            }
        }
        if self.workload.is_trial() {
            // counted a few times along a run of its own, so that counting disturbs nothing that is measured
            let parts = steps.clamp(1, 8);
            let mut world = self.begun()?;
            neighbours = 0.0;
            for part in 0..parts {
                world.run(steps * (part + 1) / parts - steps * part / parts);
                neighbours += world.mean_neighbours(every);
            }
            neighbours /= parts as f64;
        }
        let trials = f64::from(self.trials);
        self.wall.push(wall / trials);
        self.cpu.push(cpu.map(|cpu| cpu / trials));
        self.neighbours.push(neighbours);
        Ok(())
    }
    fn row(&self) -> Row {
        let cpu: Option<Vec<f64>> = self.cpu.iter().copied().collect();
        Row {
            workload: self.workload.name.clone(),
            agents: self.workload.agents,
            threads: self.threads,
            precision: self.precision,
            steps: self.workload.steps,
            wall: median(&self.wall),
            cpu: cpu.map(|cpu| median(&cpu)),
            mean_neighbours: median(&self.neighbours),
        }
    }
}

pub(crate) fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len();
    match n {
        0 => 0.0,
        _ if n % 2 == 1 => sorted[n / 2],
        _ => (sorted[n / 2 - 1] + sorted[n / 2]) / 2.0,
    }
}

/// Time that the processors have spent on this process, in seconds, where the system tells.
fn processor_time() -> Option<f64> {
    // the scheduler counts nanoseconds for every thread (up to the last switch, hence the yield); the older file has
    // hundredths of a second only
    std::thread::yield_now();
    let mut sum = 0.0;
    let mut counted = false;
    if let Ok(threads) = std::fs::read_dir("/proc/self/task") {
        for thread in threads.flatten() {
            let text = std::fs::read_to_string(thread.path().join("schedstat")).ok();
            let nanoseconds = text.and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
            if let Some(nanoseconds) = nanoseconds {
                sum += nanoseconds * 1e-9;
                counted = true;
            }
        }
    }
    if counted && sum > 0.0 {
        return Some(sum);
    }
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    let mut fields = text.rsplit(')').next()?.split_whitespace().skip(11);
    let user: f64 = fields.next()?.parse().ok()?;
    let system: f64 = fields.next()?.parse().ok()?;
    Some((user + system) / 100.0)
}

/// What a model of the list costs, and a plain loop of the same law beside it.
struct Cost {
    engine: Row,
    plain: Option<Row>,
    /// Largest difference between engine and plain loop after a step.
    apart: f64,
}

fn of_models(options: &BenchOptions, out: &mut dyn Write) -> Result<(), Fault> {
    let entries: Vec<&Entry> = match &options.model {
        Some(id) => vec![crate::case::model(id)?],
        None => LIST.iter().collect(),
    };
    let sizes: Vec<usize> =
        if options.agents.is_empty() { vec![200, 1000] } else { options.agents.iter().map(|&n| n as usize).collect() };
    let threads = usize::from(options.threads.first().copied().unwrap_or(1));
    let precisions = match options.precision {
        None | Some(Precisions::F64) => vec![Precision::F64],
        Some(Precisions::F32) => vec![Precision::F32],
        Some(Precisions::Both) => vec![Precision::F32, Precision::F64],
    };
    let mut table = Table::new(&[
        "model",
        "agents",
        "precision",
        "mean neighbours",
        "ns per update",
        "plain loop, ns",
        "times as fast",
        "apart after a step",
    ]);
    table.right(&[1, 3, 4, 5, 6, 7]);
    let mut list = Vec::new();
    let mut refused = Vec::new();
    for (k, entry) in entries.iter().enumerate() {
        tell(k + 1, entries.len(), entry.card.id);
        for &agents in &sizes {
            for &precision in &precisions {
                match cost(entry, agents, threads, precision, options) {
                    Ok(cost) => {
                        let nanoseconds = |row: &Row| 1e9 / row.updates();
                        let mut cells = vec![
                            entry.card.id.to_owned(),
                            agents.to_string(),
                            precision.word().into(),
                            format!("{:.1}", cost.engine.mean_neighbours),
                            format!("{:.1}", nanoseconds(&cost.engine)),
                        ];
                        list.push(cost.engine.json());
                        if let Some(plain) = &cost.plain {
                            cells.push(format!("{:.1}", nanoseconds(plain)));
                            cells.push(format!("{:.2}", nanoseconds(plain) / nanoseconds(&cost.engine)));
                            cells.push(format!("{:.1e}", cost.apart));
                            list.push(plain.json());
                        }
                        table.row(cells);
                    }
                    Err(Fault::Input(reason)) => refused.push(format!("{}: {reason}", entry.card.id)),
                    Err(other) => return Err(other),
                }
            }
        }
    }
    if options.json {
        writeln!(out, "{:#}", Json::from(list))?;
        return Ok(());
    }
    out.write_all(table.text().as_bytes())?;
    refused.dedup();
    for line in &refused {
        writeln!(out, "{line}")?;
    }
    Ok(())
}

/// Tells on a terminal which model of how many is measured.
#[allow(clippy::print_stderr, reason = "progress is told on standard error")]
fn tell(number: usize, models: usize, id: &str) {
    if std::io::stderr().is_terminal() {
        eprintln!("model {number} of {models}: {id}");
    }
}

fn cost(
    entry: &'static Entry,
    agents: usize,
    threads: usize,
    precision: Precision,
    options: &BenchOptions,
) -> Result<Cost, Fault> {
    let id = entry.card.id;
    let dimension = if entry.dimensions.contains(&2) { 2 } else { entry.dimensions[0] };
    match (precision, dimension) {
        (Precision::F32, 1) => cost_in::<f32, 1>(entry, agents, threads, precision, on_a_ring(id), options),
        (Precision::F64, 1) => cost_in::<f64, 1>(entry, agents, threads, precision, on_a_ring(id), options),
        (Precision::F32, 2) => cost_in::<f32, 2>(entry, agents, threads, precision, plain(id), options),
        (Precision::F64, 2) => cost_in::<f64, 2>(entry, agents, threads, precision, plain(id), options),
        (Precision::F32, _) => cost_in::<f32, 3>(entry, agents, threads, precision, in_space(id), options),
        (Precision::F64, _) => cost_in::<f64, 3>(entry, agents, threads, precision, in_space(id), options),
    }
}

fn cost_in<R: Scalar, const D: usize>(
    entry: &'static Entry,
    agents: usize,
    threads: usize,
    precision: Precision,
    step_of_plain: Option<PlainStep<D>>,
    options: &BenchOptions,
) -> Result<Cost, Fault>
where
    Models: Catalogue<R, D>,
{
    let side = fitting_side(agents, D, &|side| start::<R, D>(entry, agents, side, threads))?;
    let build = || begun::<R, D>(entry, agents, side, threads);
    let mut world = build()?;
    let first = members(&world, kept(entry.card.id));
    let neighbours = world.mean_neighbours(1);
    world.run(1);
    let after = members(&world, kept(entry.card.id));
    let mut engine_steps = options.steps.unwrap_or(20);
    let row = |name: String, steps: u64, threads: usize, precision: Precision| Row {
        workload: name,
        agents,
        threads,
        precision,
        steps,
        wall: 0.0,
        cpu: None,
        mean_neighbours: neighbours,
    };
    // as many fresh worlds as fill a measurement: members drift apart or together as time goes on
    let begin = Instant::now();
    world.run(engine_steps);
    let once = begin.elapsed().as_secs_f64();
    if once > 4.0 * SHORTEST && options.steps.is_none() {
        engine_steps = 5;
    }
    let worlds = (SHORTEST / once.max(1e-6)).ceil().clamp(1.0, 200.0) as usize;
    let steps_of_plain = step_of_plain.map(|step| (step, engine_steps));
    let (mut walls, mut cpus, mut plain_walls, mut plain_cpus) = (vec![], vec![], vec![], vec![]);
    let mut furthest: f64 = 0.0;
    for _ in 0..options.repeats {
        let timed = |work: &mut dyn FnMut()| {
            let (before, begin) = (processor_time(), Instant::now());
            work();
            let wall = begin.elapsed().as_secs_f64();
            (wall, before.zip(processor_time()).map(|(before, after)| (after - before).max(0.0)))
        };
        let (mut wall, mut cpu) = (0.0, Some(0.0));
        for _ in 0..worlds {
            let mut world = build()?;
            let (w, c) = timed(&mut || world.run(engine_steps));
            wall += w / worlds as f64;
            cpu = cpu.zip(c).map(|(sum, c)| sum + c / worlds as f64);
        }
        walls.push(wall);
        cpus.push(cpu);
        if let Some((step, steps)) = steps_of_plain {
            // as often as fills a measurement, too
            let (mut wall, mut cpu, mut times) = (0.0, Some(0.0), 0.0);
            while times == 0.0 || (wall < SHORTEST && times < 200.0) {
                let mut now = first.clone();
                let (w, c) = timed(&mut || {
                    for _ in 0..steps {
                        now = step(&now);
                    }
                });
                wall += w;
                cpu = cpu.zip(c).map(|(sum, c)| sum + c);
                times += 1.0;
            }
            plain_walls.push(wall / times);
            plain_cpus.push(cpu.map(|cpu| cpu / times));
        }
    }
    let mut engine = row(format!("models/{}", entry.card.id), engine_steps, threads, precision);
    engine.wall = median(&walls);
    engine.cpu = cpus.into_iter().collect::<Option<Vec<f64>>>().map(|cpu| median(&cpu));
    let plain = steps_of_plain.map(|(step, steps)| {
        furthest = apart(&step(&first), &after);
        let mut plain = row(format!("plain/{}", entry.card.id), steps, 1, Precision::F64);
        plain.wall = median(&plain_walls);
        plain.cpu = plain_cpus.into_iter().collect::<Option<Vec<f64>>>().map(|cpu| median(&cpu));
        plain
    });
    Ok(Cost { engine, plain, apart: furthest })
}

/// The side of a box in which members have about [`NEIGHBOURS`] neighbours, where that depends on the side.
pub(crate) fn fitting_side(
    agents: usize,
    dimension: usize,
    build: &dyn Fn(f64) -> Result<Box<dyn Running>, Fault>,
) -> Result<f64, Fault> {
    let usual = (agents as f64).powf(1.0 / dimension as f64);
    let count = |side: f64| -> Result<f64, Fault> { Ok(build(side)?.mean_neighbours((agents / 100).max(1))) };
    let wanted = NEIGHBOURS.min((agents.max(2) - 1) as f64 * 0.5);
    let (mut low, mut high) = (usual * 1e-3, usual * 1e3);
    if count(low)? < wanted || count(high)? > wanted {
        return Ok(usual);
    }
    // members are more in the smaller box
    for _ in 0..24 {
        let side = (low * high).sqrt();
        if count(side)? > wanted {
            low = side;
        } else {
            high = side;
        }
    }
    Ok((low * high).sqrt())
}

/// A world of a model with its defaults, uniform in a box of this side: in open space, or on a ring twice as long.
pub(crate) fn start<R: Scalar, const D: usize>(
    entry: &Entry,
    agents: usize,
    side: f64,
    threads: usize,
) -> Result<Box<dyn Running>, Fault>
where
    Models: Catalogue<R, D>,
{
    Ok(Box::new(begun::<R, D>(entry, agents, side, threads)?))
}

fn begun<R: Scalar, const D: usize>(
    entry: &Entry,
    agents: usize,
    side: f64,
    threads: usize,
) -> Result<World<R, D>, Fault>
where
    Models: Catalogue<R, D>,
{
    let high = Vector([R::of(side); D]);
    let placement = Placement::Uniform { low: Vector::ZERO, high };
    let group = GroupPlan::new("members", entry.card.id, Values::new(), agents, placement);
    let space = if D == 1 { Space::periodic([R::of(2.0 * side); D]) } else { Space::open() };
    let mut plan = WorldPlan::new(space, group);
    plan.seed = SEED;
    plan.threads = threads;
    World::new(plan).or_else(|error| wrong(error.to_string()))
}

/// The members of a world, with these of their declared columns.
fn members<R: Scalar, const D: usize>(world: &World<R, D>, kept: &[&str]) -> Plain<D> {
    let frame = world.frame();
    let rows = frame.rows_by_id();
    let column = |name: &&str| {
        let at = frame.declared.iter().position(|column| column.name == *name);
        rows.iter().map(|&row| at.map_or(f64::NAN, |at| frame.columns.state[at][row].to_f64())).collect()
    };
    Plain {
        position: rows.iter().map(|&row| frame.columns.position(row).0.map(R::to_f64)).collect(),
        velocity: rows.iter().map(|&row| frame.columns.velocity(row).0.map(R::to_f64)).collect(),
        state: kept.iter().map(column).collect(),
        seed: SEED,
        step: frame.step,
        ring: frame.space.side(0).map_or(f64::INFINITY, R::to_f64),
    }
}

/// Largest difference of any number; infinite where one is none.
fn apart<const D: usize>(a: &Plain<D>, b: &Plain<D>) -> f64 {
    let numbers = |of: &Plain<D>| -> Vec<f64> {
        let motion = of.position.iter().chain(&of.velocity).flatten();
        motion.chain(of.state.iter().flatten()).copied().collect()
    };
    let differences = numbers(a).into_iter().zip(numbers(b)).map(|(a, b)| (a - b).abs());
    differences.map(|apart| if apart.is_nan() { f64::INFINITY } else { apart }).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), 2.5);
        assert_eq!(median(&[]), 0.0);
    }

    #[test]
    fn the_plain_loops_and_the_engine_agree() {
        let options = BenchOptions {
            workloads: Vec::new(),
            agents: Vec::new(),
            threads: Vec::new(),
            precision: None,
            steps: Some(1),
            repeats: 1,
            json: false,
            model: None,
        };
        let has_loop = |id: &str| plain(id).is_some() || on_a_ring(id).is_some() || in_space(id).is_some();
        for entry in LIST.iter().filter(|entry| has_loop(entry.card.id)) {
            let cost = cost(entry, 60, 1, Precision::F64, &options);
            let apart = cost.map(|cost| cost.apart).unwrap_or(f64::INFINITY);
            assert!(apart < 1e-9, "{}: {apart}", entry.card.id);
        }
    }
}
