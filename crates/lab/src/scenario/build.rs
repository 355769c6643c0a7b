//! From a scenario as written to a world that can be stepped.

use super::{Clock, Driver, Edges, Group, Order, Phase, Precision, Scenario, Sensing, Space as WrittenSpace, Start};
use crate::file::form::place_of;
use crate::file::tree::{parse, parse_value};
use crate::file::{Desk, Form, Node, Problem, Problems, Rule, Sources, Span};
use space::obstacles::Obstacles;
use space::{ColumnKind, Edge, Real, Space, Vector};
use swarm::engine::{self as plan, GroupPlan, IndexChoice, Placement, WorldError, WorldPlan};
use swarm::models::{Catalogue, Models};
use swarm::parameters::{ParameterError, Scalar};

/// Something wrong at a path of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wrong {
    /// The path, as in `group.fish.count`.
    pub path: String,
    /// What is wrong.
    pub what: String,
    /// What was expected there.
    pub expected: String,
    /// What would help; may be empty.
    pub help: String,
    /// Whether it is the key that is wrong there, and not its value.
    pub of_key: bool,
}

impl Wrong {
    /// Something wrong at a path.
    pub fn new(path: impl Into<String>, what: impl Into<String>, expected: impl Into<String>) -> Self {
        Self { path: path.into(), what: what.into(), expected: expected.into(), help: String::new(), of_key: false }
    }
    /// The same of the key, where it is wrong that it stands there.
    #[must_use]
    pub fn key(self) -> Self {
        Self { of_key: true, ..self }
    }
    /// Where it is to be shown in a tree.
    fn place(&self, tree: &Node) -> Span {
        if self.of_key { tree.key_place(&self.path) } else { tree.place(&self.path) }
    }
    /// The same with a remedy.
    #[must_use]
    pub fn help(mut self, help: &str) -> Self {
        self.help = help.to_owned();
        self
    }
    /// The same below another path.
    #[must_use]
    pub fn below(mut self, path: &str) -> Self {
        self.path = if self.path.is_empty() { path.to_owned() } else { format!("{path}.{}", self.path) };
        self
    }
}

/// A vector from numbers.
///
/// # Errors
/// Another number of them than the space has dimensions.
pub fn vector<R: Real, const D: usize>(numbers: &[f64]) -> Result<Vector<R, D>, String> {
    if numbers.len() == D {
        return Ok(Vector(core::array::from_fn(|a| R::of(numbers[a]))));
    }
    Err(format!("{} coordinates in a space of {D} dimensions", numbers.len()))
}

/// A scenario file as read: what it says, and where it says it.
#[derive(Clone, Debug)]
pub struct Read {
    /// The texts.
    pub sources: Sources,
    /// The tree, with what `--set` put into it.
    pub tree: Node,
    /// What it says.
    pub scenario: Scenario,
}

/// Reads a scenario from its text and the values put over it (`path=value`), and checks that a world can be made.
///
/// # Errors
/// Everything that is wrong with it, at its place.
pub fn read(name: &str, text: &str, sets: &[String]) -> Result<Read, Problems> {
    let mut sources = Sources::default();
    let file = sources.add(name, text);
    let mut desk = Desk::default();
    if text.trim().is_empty() {
        desk.problem(
            &Span::default(),
            "the file is empty",
            "expected `kind = \"scenario\"`",
            "`flockworks new scenario` writes one to start from",
        );
        return Err(Problems::new(sources, desk.problems));
    }
    let mut tree = parse(&sources, file, &mut desk.problems);
    put(&mut tree, sets, &mut sources, &mut desk);
    if !desk.problems.is_empty() {
        // what follows from text that could not be read, or put anywhere, would only confuse
        return Err(Problems::new(sources, desk.problems));
    }
    match resolved(&tree, &mut desk).filter(|_| desk.problems.is_empty()) {
        Some(scenario) => Ok(Read { sources, tree, scenario }),
        None => {
            if desk.problems.is_empty() {
                // nothing is refused without a word
                desk.problem(&Span::default(), "the file could not be read", "something in it has no meaning", "");
            }
            Err(Problems::new(sources, desk.problems))
        }
    }
}

/// The scenario that a tree says, if a world can be made of it.
pub(crate) fn resolved(tree: &Node, desk: &mut Desk) -> Option<Scenario> {
    let scenario = read_tree(tree, desk)?;
    possible(&scenario, tree, desk).then_some(scenario)
}

/// The scenario that a tree says, value by value.
pub(crate) fn read_tree(tree: &Node, desk: &mut Desk) -> Option<Scenario> {
    let before = desk.problems.len();
    let scenario =
        read_kind(tree, desk).and_then(|()| Scenario::read(tree, &Rule { name: "the file", ..Rule::FREE }, desk));
    scenario.filter(|_| desk.problems.len() == before)
}

/// Whether a world can be made of a scenario; what stands in the way goes to the desk.
pub(crate) fn possible(scenario: &Scenario, tree: &Node, desk: &mut Desk) -> bool {
    let wrongs = check(scenario);
    let fine = wrongs.is_empty();
    for wrong in wrongs {
        let span = wrong.place(tree);
        desk.problems.push(Problem { span, what: wrong.what, expected: wrong.expected, help: wrong.help });
    }
    fine
}

/// Puts values over those of a file, each written as `path=value`.
pub(crate) fn put(tree: &mut Node, sets: &[String], sources: &mut Sources, desk: &mut Desk) {
    let mut put: Vec<(&str, &str)> = Vec::new();
    for set in sets {
        let source = sources.add("--set", set);
        let span = Span { source, bytes: 0..set.len() };
        let Some((path, _)) = set.split_once('=') else {
            desk.problem(&span, format!("`{set}` has no `=`"), "expected path=value", "");
            continue;
        };
        let path = path.trim();
        let within = |path: &str, other: &str| path.strip_prefix(other).is_some_and(|rest| rest.starts_with('.'));
        let clash = put.iter().find(|(other, _)| *other == path || within(path, other) || within(other, path));
        if let Some((other, text)) = clash {
            let (what, help) = if *other == path {
                (format!("`{path}` is set twice"), format!("`--set {text}` sets it already; leave one of them out"))
            } else {
                let (part, whole) = if within(path, other) { (path, *other) } else { (*other, path) };
                let what = format!("`{path}` contradicts `{other}`: `{part}` lies within `{whole}`");
                (what, format!("`--set {text}` says it otherwise; put both into one value of `{whole}`"))
            };
            desk.problem(&span, what, "set already", help);
            continue;
        }
        put.push((path, set));
        let from = set.find('=').map_or(0, |at| at + 1);
        let from = from + set[from..].len() - set[from..].trim_start().len();
        let before = desk.problems.len();
        let value = parse_value(sources, source, from, &mut desk.problems);
        if desk.problems.len() > before {
            // what would follow from a value that could not be read says nothing
            continue;
        }
        let node = Node { span: span.clone(), ..value };
        if let Some((name, there)) = tree.new_name(path) {
            let known = || there.iter().map(String::as_str);
            let help = match space::spelling::nearest(&name, known()) {
                Some(near) => format!("`{name}` is new here; did you mean `{near}`?"),
                None => format!("`{name}` is new here, beside {}", known().collect::<Vec<_>>().join(", ")),
            };
            desk.new_names.push((span.clone(), help));
        }
        if let Err(problem) = tree.set(path, node) {
            desk.problem(&span, problem, "names no place in the file", "");
        }
    }
}

/// A file that is of no kind is told so, and nothing else.
fn read_kind(tree: &Node, desk: &mut Desk) -> Option<()> {
    let crate::file::Tree::Table(entries) = &tree.tree else { return None };
    match entries.iter().find(|e| e.key == "kind") {
        Some(entry) => {
            let rule = Rule { name: "kind", ..Rule::FREE };
            let node = Node { tree: entry.node.tree.clone(), span: place_of(entry) };
            super::FileKind::read(&node, &rule, desk).map(|_| ())
        }
        None => {
            let start = Span { source: tree.span.source, bytes: 0..0 };
            desk.problem(
                &start,
                "the file does not say what it is",
                "`kind` is missing",
                "begin it with kind = \"scenario\"",
            );
            None
        }
    }
}

/// The steps of a run, once the models have said how long a step is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schedule {
    /// Time of a step (of a tick, for agents on their own clocks).
    pub step: f64,
    /// Number of steps.
    pub steps: u64,
    /// Steps between two kept frames.
    pub record: u64,
    /// Step of the first kept frame.
    pub record_from: u64,
    /// Steps between two measurements.
    pub measure: u64,
}

/// Frames that are kept unless a file says otherwise.
const FRAMES: f64 = 600.0;
/// Largest difference between an interval and a whole number of steps, in steps.
const WHOLE: f64 = 1e-6;

/// The schedule of a scenario. `quick` makes it a tenth as long.
///
/// # Errors
/// Intervals that are no multiples of the step.
pub fn schedule(scenario: &Scenario, quick: bool) -> Result<Schedule, Wrong> {
    let step = match &scenario.time.driver {
        Driver::Asynchronous(clocks) => clocks.tick,
        _ => step_of(scenario),
    };
    let steps = |time: f64, path: &str| {
        let steps = time / step;
        if (steps - steps.round()).abs() > WHOLE * steps.max(1.0) {
            let (below, above) = (steps.floor() * step, steps.ceil() * step);
            let what = format!("{time} is no multiple of the step of {step}");
            return Err(Wrong::new(path, what, format!("nearest are {} and {}", short(below), short(above))));
        }
        if steps > 1e15 {
            return Err(Wrong::new(path, format!("{time} would take {steps:.1e} steps"), "too long"));
        }
        Ok(steps.round() as u64)
    };
    let mut total = steps(scenario.time.duration, "time.duration")?;
    if total == 0 && scenario.time.duration > 0.0 {
        let what = format!("the run is shorter than a step of {step}");
        return Err(Wrong::new("time.duration", what, "at least one step, or 0 to see how it begins"));
    }
    if quick {
        total = total.div_ceil(10);
    }
    let interval = |given: Option<f64>, path: &str, default: u64| match given {
        Some(time) => steps(time, path).and_then(|steps| {
            if steps > 0 { Ok(steps) } else { Err(Wrong::new(path, "it is shorter than a step", "at least one step")) }
        }),
        None => Ok(default),
    };
    let record = interval(scenario.record.interval, "record.interval", ((total as f64 / FRAMES).ceil() as u64).max(1))?;
    let measure = interval(scenario.measure.interval, "measure.interval", record)?;
    let record_from = steps(scenario.record.from, "record.from")?;
    if !quick && record_from > total {
        let what =
            format!("recording would begin at {}, after the end at {}", scenario.record.from, scenario.time.duration);
        return Err(Wrong::new("record.from", what, "not after the end"));
    }
    Ok(Schedule { step, steps: total, record, record_from: record_from.min(total), measure })
}

/// A number with nine decimals at most.
pub(super) fn short(value: f64) -> String {
    let text = format!("{value:.9}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The step of the models.
fn step_of(scenario: &Scenario) -> f64 {
    if let Some(step) = scenario.time.step {
        return step;
    }
    let own = |(_, group): &(String, Group)| {
        let descriptors = group.model.descriptors();
        let descriptor = descriptors.iter().find(|d| d.name == TIME_STEP)?;
        let given = group.model.values(group.count, 0, 0).remove(TIME_STEP);
        match given.as_ref().unwrap_or(&descriptor.default) {
            swarm::parameters::Value::Number(step) => Some(*step),
            _ => None,
        }
    };
    scenario.group.0.first().map_or(1.0, |group| own(group).unwrap_or(1.0))
}

/// Name of the parameter by which models are told their step.
const TIME_STEP: &str = "time_step";

/// Runs `$body` with the precision and the number of dimensions of a scenario as types.
#[macro_export]
macro_rules! with_types {
    ($scenario:expr, $R:ident, $D:ident => $body:expr) => {{
        use $crate::scenario::Precision;
        macro_rules! arm {
            ($real:ty, $dimensions:literal) => {{
                type $R = $real;
                const $D: usize = $dimensions;
                $body
            }};
        }
        match ($scenario.precision, $scenario.space.dimensions) {
            (Precision::Single, 1) => arm!(f32, 1),
            (Precision::Single, 2) => arm!(f32, 2),
            (Precision::Single, _) => arm!(f32, 3),
            (Precision::Double, 1) => arm!(f64, 1),
            (Precision::Double, 2) => arm!(f64, 2),
            (Precision::Double, _) => arm!(f64, 3),
        }
    }};
}

/// Intervals after which nothing is left to be kept or measured.
fn longer_than_the_run(scenario: &Scenario) -> Vec<Wrong> {
    let duration = scenario.time.duration;
    // who asks for no step at all wants to see how it begins
    let longer = |(path, interval): (&str, Option<f64>)| {
        let interval = interval.filter(|&interval| interval > duration && duration > 0.0)?;
        let what = format!("`{path}` is {interval}, longer than the run, which ends at {duration}");
        let help = "a shorter interval, or a longer `time.duration`";
        Some(Wrong::new(path, what, format!("at most {duration}")).help(help).key())
    };
    let intervals = [("record.interval", scenario.record.interval), ("measure.interval", scenario.measure.interval)];
    intervals.into_iter().filter_map(longer).collect()
}

/// Everything about a scenario that stands in the way of a world.
fn check(scenario: &Scenario) -> Vec<Wrong> {
    let mut wrongs = Vec::new();
    if scenario.group.0.is_empty() {
        wrongs.push(Wrong::new("group", "there is no group", "at least one [group.NAME]"));
    }
    let groups = scenario.group.0.iter().map(|(name, _)| ("group", name));
    for (kind, name) in groups.chain(scenario.scatter.0.iter().map(|(name, _)| ("scatter", name))) {
        if name.is_empty() || !name.chars().all(|c| c.is_ascii_alphanumeric() || "_-".contains(c)) {
            let what = format!("`{name}` cannot be a name");
            wrongs.push(Wrong::new(format!("{kind}.{name}"), what, "names have letters, digits, `_` and `-`").key());
        }
    }
    if let Driver::Asynchronous(clocks) = &scenario.time.driver {
        if clocks.period < clocks.tick {
            let what = format!("the period ({}) is shorter than a tick ({})", clocks.period, clocks.tick);
            wrongs.push(Wrong::new("time.driver.asynchronous.period", what, "at least one tick"));
        }
        if clocks.clock == Clock::Poisson && clocks.jitter > 0.0 {
            let what = "a clock at random times has no jitter";
            wrongs.push(Wrong::new("time.driver.asynchronous.jitter", what, "leave it out, or use a regular clock"));
        }
    }
    for (name, group) in &scenario.group.0 {
        if name == WHOLE_GROUP {
            let what = format!("`{WHOLE_GROUP}` names everyone together in the tables");
            wrongs.push(Wrong::new(format!("group.{name}"), what, "another name"));
        }
        if let Some(sensing) = &group.sensing {
            if let Some((key, what)) = sensing.problem() {
                wrongs.push(Wrong::new(format!("group.{name}.sensing.laser.{key}"), what, "not possible"));
            }
            if matches!(sensing, Sensing::Laser(_)) && scenario.units.length != "m" {
                let what = format!(
                    "a laser's numbers are in metres, and this file's lengths in \"{}\"",
                    scenario.units.length
                );
                wrongs.push(
                    Wrong::new(format!("group.{name}.sensing"), what, "needs metres").help("set units.length = \"m\""),
                );
            }
        }
    }
    match schedule(scenario, false) {
        Ok(_) => wrongs.extend(longer_than_the_run(scenario)),
        Err(wrong) => wrongs.push(wrong),
    }
    let measured = match scenario.space.dimensions {
        1 => super::metrics_of::<1>(scenario).err(),
        2 => super::metrics_of::<2>(scenario).err(),
        _ => super::metrics_of::<3>(scenario).err(),
    };
    wrongs.extend(measured);
    if !wrongs.is_empty() {
        return wrongs;
    }
    with_types!(scenario, R, D => match plan::<R, D>(scenario, scenario.seed.unwrap_or(0), 1) {
        Ok(plan) => match swarm::World::new(plan) {
            Ok(world) => super::start::in_the_way(scenario, &world),
            Err(error) => vec![of_world(error, scenario)],
        },
        Err(wrongs) => wrongs,
    })
}

/// Name that stands for everyone together in tables.
pub const WHOLE_GROUP: &str = "all";

/// Where in a group the engine's problem with it lies, and whether at the key itself.
fn place_in_group(problem: &str, model: &str) -> (String, bool) {
    let own = ["conduct", "taxis", "pace", "adapt", "decides", "obstacles"];
    // the name that stands in quotes behind a word
    let named = |word: &str| problem.split_once(word).and_then(|(_, rest)| rest.split_once('`')).map(|(name, _)| name);
    if let Some(key) = own.into_iter().find(|key| problem.starts_with(key)) {
        (key.to_owned(), false)
    } else if let Some(set) = named("named set `") {
        (format!("select.{set}"), true)
    } else if let Some(set) = problem.starts_with("set `").then(|| named("set `")).flatten() {
        (format!("select.{set}"), false)
    } else if problem.contains("named set") {
        ("select".to_owned(), false)
    } else if problem.contains("scanner") || problem.contains("sensing") || problem.starts_with("field of view") {
        ("sensing".to_owned(), false)
    } else if let Some(column) = named("no column `") {
        (format!("start.state.{column}"), true)
    } else if problem.contains("column") {
        ("start.state".to_owned(), false)
    } else if problem.starts_with("its step is") {
        (format!("model.{model}.{TIME_STEP}"), false)
    } else {
        let bodies = [
            ("length", "physics.length"),
            ("the body radius", "physics.radius"),
            ("noise", "physics.noise"),
            ("a vertical turn rate", "physics.mobility.turn_limited.vertical"),
        ];
        let place = bodies.into_iter().find(|(word, _)| problem.starts_with(word)).map_or("", |(_, place)| place);
        (place.to_owned(), false)
    }
}

/// What the engine refuses, at its place in the file.
fn of_world(error: WorldError, scenario: &Scenario) -> Wrong {
    let model = |name: &str| {
        scenario.group.0.iter().find(|(other, _)| other == name).map_or("", |(_, group)| group.model.id.as_str())
    };
    match &error {
        WorldError::Parameter { group, error } => {
            let below = format!("group.{group}.model.{}", model(group));
            let path = match error {
                ParameterError::Unknown { name, .. }
                | ParameterError::Type { name, .. }
                | ParameterError::Range { name, .. } => format!("{below}.{name}"),
                ParameterError::Together(_) => below,
            };
            Wrong::new(path, error.to_string(), "not possible together")
        }
        WorldError::Group { group, problem } => {
            let (place, of_key) = place_in_group(problem, model(group));
            let path = format!("group.{group}.{place}");
            Wrong { of_key, ..Wrong::new(path.trim_end_matches('.'), problem.clone(), "not possible") }
        }
        WorldError::Dimension { .. } => Wrong::new("space.dimensions", error.to_string(), "not for this model"),
        WorldError::Model { .. } => Wrong::new("group", error.to_string(), ""),
        WorldError::World(problem) => {
            let place = if problem.contains("predation") {
                "food.predation"
            } else if problem.contains("resources") {
                "food"
            } else if problem.starts_with("stimulus") {
                "stimulus"
            } else if problem.contains("obstacle") {
                "obstacle"
            } else if problem.starts_with("the delay of readings") {
                "time.driver.asynchronous.delay"
            } else if problem.starts_with("the asynchronous driver") || problem.starts_with("the jitter") {
                "time.driver"
            } else {
                ""
            };
            Wrong::new(place, problem.clone(), "not possible")
        }
    }
}

fn space_of<R: Real, const D: usize>(written: &WrittenSpace) -> Result<Space<R, D>, Wrong> {
    for (count, key) in [(written.edges.count(), "edges"), (written.size.as_ref().and_then(|s| s.count()), "size")] {
        if let Some(count) = count
            && count != D
        {
            let what = format!("`{key}` has {count} entries for {D} axes");
            return Err(Wrong::new(format!("space.{key}"), what, format!("one for all, or {D}")));
        }
    }
    let mut edges = [Edge::Open; D];
    for (a, edge) in edges.iter_mut().enumerate() {
        let size = || {
            let size = written.size.as_ref().and_then(|size| size.of(a));
            size.map(R::of).ok_or_else(|| {
                Wrong::new("space", format!("axis {a} ends, so that it needs a size"), "`size` is missing")
            })
        };
        *edge = match written.edges.of(a) {
            Some(Edges::Walls) => Edge::Walls(size()?),
            Some(Edges::Periodic) => Edge::Periodic(size()?),
            Some(Edges::Open) | None => Edge::Open,
        };
    }
    Ok(Space { edges })
}

/// Whether obstacles hide the others from a model, where a file says nothing of its sensing. (Elongated bodies hide behind nothing.)
pub(super) fn blinded(model: &str, scenario: &Scenario) -> bool {
    let round = |group: &Group| group.physics.as_ref().is_none_or(|physics| physics.length.is_none());
    scenario.group.0.iter().all(|(_, group)| round(group))
        && (!scenario.obstacle.is_empty() || !scenario.scatter.0.is_empty())
        && swarm::models::find(model).is_some_and(|entry| (entry.blinded_by_obstacles)())
}

fn driver_of(driver: &Driver) -> plan::Driver {
    match driver {
        Driver::Synchronous(_) => plan::Driver::Synchronous,
        Driver::Sequential(sequential) => plan::Driver::Sequential(match sequential.order {
            Order::RoundRobin => plan::Order::RoundRobin,
            Order::Random => plan::Order::Random,
        }),
        Driver::Asynchronous(clocks) => plan::Driver::Asynchronous {
            tick: clocks.tick,
            period: clocks.period,
            phase: match clocks.phase {
                Phase::Together => plan::Phase::Together,
                Phase::Spread => plan::Phase::Spread,
                Phase::Random => plan::Phase::Random,
            },
            clock: match clocks.clock {
                Clock::Regular => plan::Clock::Regular { jitter: clocks.jitter },
                Clock::Poisson => plan::Clock::Poisson,
            },
            delay: clocks.delay,
        },
    }
}

/// The plan of a scenario's world.
///
/// # Errors
/// Everything that is wrong, by its path in the file.
pub fn plan<R: Scalar, const D: usize>(
    scenario: &Scenario,
    seed: u64,
    threads: usize,
) -> Result<WorldPlan<R, D>, Vec<Wrong>>
where
    Models: Catalogue<R, D>,
{
    let mut wrongs = Vec::new();
    let space = space_of::<R, D>(&scenario.space).map_err(|wrong| vec![wrong])?;
    let mut obstacles = Vec::new();
    for (k, obstacle) in scenario.obstacle.iter().enumerate() {
        match obstacle.resolved() {
            Ok(obstacle) => obstacles.push(obstacle),
            Err(wrong) => wrongs.push(wrong.below(&format!("obstacle.{k}"))),
        }
    }
    for (index, (name, scatter)) in scenario.scatter.0.iter().enumerate() {
        match scatter.resolved(&space, seed, index as u64) {
            Ok(balls) => obstacles.extend(balls),
            Err(wrong) => wrongs.push(wrong.below(&format!("scatter.{name}"))),
        }
    }
    let resources = match scenario.food.as_ref().map(|food| food.resolved(&space, seed)) {
        Some(Err(wrong)) => {
            wrongs.push(wrong.below("food"));
            None
        }
        Some(Ok(resources)) => Some(resources),
        None => None,
    };
    let mut stimuli = Vec::new();
    for (name, stimulus) in &scenario.stimulus.0 {
        match stimulus.resolved(name) {
            Ok(stimulus) => stimuli.push(stimulus),
            Err(wrong) => wrongs.push(wrong.below(&format!("stimulus.{name}"))),
        }
    }
    let mut groups = Vec::new();
    let mut first = 0u32;
    for (index, (name, group)) in scenario.group.0.iter().enumerate() {
        let below = format!("group.{name}");
        match group_of(name, group, scenario, &space, &obstacles, seed, index as u64, first) {
            Ok(plan) => groups.push(plan),
            Err(wrong) => wrongs.push(wrong.below(&below)),
        }
        first += group.count as u32;
    }
    if !wrongs.is_empty() {
        return Err(wrongs);
    }
    Ok(WorldPlan {
        space,
        groups,
        obstacles,
        stimuli,
        resources,
        driver: driver_of(&scenario.time.driver),
        index: IndexChoice::Automatic,
        seed,
        first_step: 0,
        threads,
    })
}

fn group_of<R: Scalar, const D: usize>(
    name: &str,
    group: &Group,
    scenario: &Scenario,
    space: &Space<R, D>,
    obstacles: &[space::obstacles::Obstacle<R, D>],
    seed: u64,
    index: u64,
    first: u32,
) -> Result<GroupPlan<R, D>, Wrong>
where
    Models: Catalogue<R, D>,
{
    let id = group.model.id.as_str();
    let mut values = group.model.values(group.count, seed, first);
    if let Some(step) = scenario.time.step {
        let known = group.model.descriptors().iter().any(|d| d.name == TIME_STEP);
        if values.contains_key(TIME_STEP) {
            let what = "the step is given here and as time.step";
            return Err(Wrong::new(format!("model.{id}.{TIME_STEP}"), what, "leave one of them out").key());
        }
        if known {
            values.insert(TIME_STEP.to_owned(), step.into());
        }
    }
    let prepared = match Models::prepare(id, &values, group.count) {
        Some(Ok(prepared)) => prepared,
        Some(Err(error)) => return Err(Wrong::new(format!("model.{id}"), error.to_string(), "not possible together")),
        None => {
            let works = swarm::models::find(id).map_or(&[][..], |entry| entry.dimensions);
            let works: Vec<String> = works.iter().map(ToString::to_string).collect();
            let what = format!("`{id}` works in {} dimensions, not in {D}", works.join(" or "));
            return Err(Wrong::new("model", what, "needs another number of dimensions").help("change space.dimensions"));
        }
    };
    if let Some((name, found)) = group.model.list_that_does_not_fit(group.count) {
        let what = format!("`{name}` has {found} values for {} members", group.count);
        return Err(Wrong::new(format!("model.{id}.{name}"), what, "one for each"));
    }
    let varied = group.model.varied(group.count, seed, first);
    let mut speeds = prepared.initial_speeds().to_vec();
    for (member, speed) in speeds.iter_mut().enumerate().filter(|_| !varied.is_empty()) {
        let mut own = values.clone();
        own.extend(varied.iter().map(|varied| (varied.parameter.clone(), varied.values[member].clone())));
        match Models::prepare(id, &own, group.count) {
            Some(Ok(prepared)) => *speed = prepared.initial_speeds()[member],
            Some(Err(error)) => {
                let what = format!("member {member} of seed {seed}: {error}");
                return Err(Wrong::new(format!("model.{id}"), what, "not possible together"));
            }
            None => {}
        }
    }
    let physics = group.physics.as_ref();
    let radius = physics.and_then(|p| p.radius).map(R::of);
    let length = physics.and_then(|p| p.length).map(R::of);
    // whichever way an elongated body lies, it is within half its length
    let body_radius = length.map_or(R::ZERO, |length| length * R::HALF).most(radius.unwrap_or(prepared.body_radius()));
    let around = Obstacles::new(obstacles.to_vec(), space.periods(), body_radius.most(R::TINY))
        .map_err(|error| Wrong::new("", format!("obstacles: {error}"), ""))?;
    let surroundings = super::start::Surroundings {
        space,
        obstacles: &around,
        seed,
        group: index,
        first,
        count: group.count,
        body_radius,
        initial_speeds: &speeds,
    };
    let default = Start::default();
    let start =
        group.start.as_ref().unwrap_or(&default).resolved(&surroundings).map_err(|wrong| wrong.below("start"))?;
    states_in_range(id, &start)?;
    let mut plan = GroupPlan::new(name, id, values, group.count, Placement::Given(start));
    for (set, choice) in &group.select.0 {
        let choice = choice
            .resolved()
            .map_err(|what| Wrong::new(format!("select.{set}"), what, "as many as the space has dimensions"))?;
        plan.sets.push((set.clone(), choice));
    }
    if let Some(sensing) = &group.sensing {
        plan.sensing = sensing.resolved();
    } else if let Some(entry) = swarm::models::find(id).filter(|_| blinded(id, scenario)) {
        plan.sensing = entry.default_sensing();
    }
    if let Some(obstacles) = &group.obstacles {
        plan.obstacles = obstacles.resolved();
    }
    plan.conduct = group.conduct.as_ref().map(super::Conduct::resolved);
    plan.varied = varied;
    plan.taxis = group.taxis.as_ref().map(|taxis| taxis.resolved(D));
    plan.pace = group.pace.as_ref().map(super::Pace::resolved);
    if let Some(adapt) = &group.adapt {
        plan.adapt = Some(adapt.resolved(id).map_err(|wrong| wrong.below("adapt"))?);
    }
    if let Some(decides) = &group.decides {
        let below = |wrong: Wrong| wrong.below("decides");
        if let Driver::Asynchronous(_) = &scenario.time.driver {
            plan.clocks = decides.clocks(group.count, seed, first).map_err(below)?;
        } else {
            let step = prepared.time_step().to_f64();
            plan.intervals = decides.intervals(step, group.count, seed, first).map_err(below)?;
        }
    }
    if let Some(physics) = physics {
        plan.mobility = physics.mobility.resolved();
        plan.contact = physics.contact.map(Into::into);
        plan.noise = physics.noise.resolved();
        plan.radius = radius;
        plan.length = length;
    }
    Ok(plan)
}

/// What a world of a scenario is built from.
///
/// # Errors
/// What this seed makes impossible, in a sentence.
pub(crate) fn planned<R: Scalar, const D: usize>(
    scenario: &Scenario,
    seed: u64,
    threads: usize,
) -> Result<WorldPlan<R, D>, String>
where
    Models: Catalogue<R, D>,
{
    plan::<R, D>(scenario, seed, threads).map_err(|wrongs| {
        let lines: Vec<String> = wrongs.iter().map(|wrong| format!("{}: {}", wrong.path, wrong.what)).collect();
        format!("with the seed {seed}: {}", lines.join("; "))
    })
}

/// The world of a scenario with a seed.
///
/// # Errors
/// What this seed makes impossible, in one sentence; a scenario that was read can be with some seed.
pub fn world<R: Scalar, const D: usize>(
    scenario: &Scenario,
    seed: u64,
    threads: usize,
) -> Result<swarm::World<R, D>, String>
where
    Models: Catalogue<R, D>,
{
    let plan = planned::<R, D>(scenario, seed, threads)?;
    swarm::World::new(plan).map_err(|error| format!("with the seed {seed}: {error}"))
}

/// Refuses values of named states and counts that are none.
fn states_in_range<R, const D: usize>(model: &str, start: &plan::Start<R, D>) -> Result<(), Wrong> {
    let Some(entry) = swarm::models::find(model) else { return Ok(()) };
    for column in (entry.columns)() {
        let Some(values) = start.columns.get(column.name) else { continue };
        let (fits, expected): (&dyn Fn(f64) -> bool, String) = match column.kind {
            ColumnKind::Quantity => continue,
            ColumnKind::Count => (&|v| v >= 0.0 && v.fract() == 0.0, "a whole number of 0 or more".to_owned()),
            ColumnKind::Label(names) => {
                let most = names.len() as f64;
                (
                    &move |v| v >= 0.0 && v < most && v.fract() == 0.0,
                    format!("the place, from 0, in {}", names.join(", ")),
                )
            }
        };
        if let Some(wrong) = values.iter().find(|&&v| !fits(v)) {
            let what = format!("`{}` cannot be {wrong}", column.name);
            return Err(Wrong::new(format!("start.state.{}", column.name), what, expected));
        }
    }
    Ok(())
}

/// The precision as a word.
pub fn precision(scenario: &Scenario) -> &'static str {
    match scenario.precision {
        Precision::Single => "f32",
        Precision::Double => "f64",
    }
}
