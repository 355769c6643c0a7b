//! Scenarios: who moves where, by which law, with which eyes and bodies, and what is kept of it.
//!
//! A scenario reads like a methods section, top to bottom. Angles are in degrees, lengths and times in the units the
//! scenario declares. What stands here is what was written, checked value by value; [`build`] makes a world of it.

pub mod agents;
pub mod beside;
pub mod body;
pub mod build;
pub mod conduct;
pub mod describe;
pub mod perception;
pub mod sensing;
pub mod start;
pub mod surroundings;

use crate::file::{Named, PerAxis};
use crate::{form, tagged, words};
use measure::MetricCard;
use space::spelling::nearest;

pub use agents::{Model, PerMember};
pub use beside::{Adapt, Decides, Pace, Stimulus, Taxis};
pub use body::Physics;
pub use conduct::Conduct;
pub use perception::Choice;
pub use sensing::{Sensing, ToldObstacles};
pub use start::Start;
pub use surroundings::{Food, Obstacle, Scatter};

/// A commented scenario to start from.
pub const TEMPLATE: &str = include_str!("template.toml");

words! {
    /// What kind of file it is.
    pub enum FileKind {
        /// One world, run once.
        Scenario = "scenario",
    }
}

words! {
    /// How numbers are kept while computing.
    pub enum Precision {
        /// 32 bits: fast; enough for large swarms.
        Single = "f32",
        /// 64 bits.
        Double = "f64",
    }
}

form! {
    /// The units in which lengths and times are written. Nothing is converted by them: a model's defaults are in the units
    /// of its publication.
    pub struct Units {
        /// Unit of length, as it stands behind numbers.
        length: String = ["unit"], "", Any;
        /// Unit of time, as it stands behind numbers.
        time: String = ["s"], "", Any;
    }
}

impl Units {
    /// A unit as this scenario writes it: `length/time` becomes `m/s`.
    pub fn of(&self, unit: &str) -> String {
        unit.replace("length", &self.length).replace("time", &self.time)
    }
}

impl Default for Units {
    fn default() -> Self {
        Self { length: "unit".into(), time: "s".into() }
    }
}

form! {
    /// How long it runs, in which steps, and who acts when.
    pub struct Time {
        /// How long it runs.
        duration: f64 = need, "time", NonNegative;
        /// Step of the motion; left out, the one of the models.
        step: Option<f64> = none, "time", Positive;
        /// Who acts when.
        driver: Driver = [Driver::Synchronous(crate::file::Nothing)], "", Any;
    }
}

tagged! {
    /// Who acts when.
    pub enum Driver {
        /// All read the state at one time, then all move.
        synchronous => Synchronous(crate::file::Nothing);
        /// One after the other; each sees what those before it did.
        sequential => Sequential(Sequential);
        /// Each on its own clock, with the motion of bodies running on beneath, as robots do.
        asynchronous => Asynchronous(Asynchronous);
    }
}

words! {
    /// In which order agents act one after the other.
    pub enum Order {
        /// By number, every step.
        RoundRobin = "round_robin",
        /// In a new random order every step.
        Random = "random",
    }
}

form! {
    /// One after the other.
    pub struct Sequential {
        /// In which order.
        order: Order = [Order::Random], "", Any;
    }
}

words! {
    /// When agents on their own clocks begin.
    pub enum Phase {
        /// All at the start.
        Together = "together",
        /// Evenly over the period.
        Spread = "spread",
        /// At random over the period.
        Random = "random",
    }
}

words! {
    /// How a clock runs.
    pub enum Clock {
        /// At the period, give or take the jitter.
        Regular = "regular",
        /// At random times with the period as their mean distance.
        Poisson = "poisson",
    }
}

form! {
    /// Each on its own clock.
    pub struct Asynchronous {
        /// Step of the motion of bodies.
        tick: f64 = [0.01], "time", Positive;
        /// Time between two decisions of an agent.
        period: f64 = [0.1], "time", Positive;
        /// When agents begin.
        phase: Phase = [Phase::Random], "", Any;
        /// How a clock runs.
        clock: Clock = [Clock::Regular], "", Any;
        /// Largest deviation from the period, as a share of it.
        jitter: f64 = [0.0], "1", Within(0.0, 0.999);
        /// How old readings of others are.
        delay: f64 = [0.0], "time", NonNegative;
    }
}

words! {
    /// How an axis ends.
    pub enum Edges {
        /// At solid walls, at 0 and at its size.
        Walls = "walls",
        /// It closes on itself after its size.
        Periodic = "periodic",
        /// Nowhere.
        Open = "open",
    }
}

form! {
    /// The space.
    pub struct Space {
        /// Number of dimensions.
        dimensions: usize = need, "1", Within(1.0, 3.0);
        /// How the axes end: for all, or a list with one for each.
        edges: PerAxis<Edges> = need, "", Any;
        /// Size of the axes that end: for all, or a list with one for each (what it says of an open axis is not used).
        size: Option<PerAxis<f64>> = none, "length", Positive;
    }
}

form! {
    /// A group of agents with one model.
    pub struct Group {
        /// Number of agents.
        count: usize = need, "1", Within(0.0, 20_000_000.0);
        /// The model, by its id, with the parameters that differ from their defaults.
        model: Model = need, "", Any;
        /// Where and how it begins; left out, anywhere in the space.
        start: Option<Start> = none, "", Any;
        /// How agents sense others: everything exactly, within limits, or by a laser. Left out: everything exactly, by `control_boids` and
        /// `control_snn` what obstacles do not hide.
        sensing: Option<Sensing> = none, "", Any;
        /// Whom the model's named sets select, in place of what the model itself says.
        select: Named<Choice> = [Named::default()], "", Any;
        /// What it is told of obstacles and walls; left out, all that its law asks for.
        obstacles: Option<ToldObstacles> = none, "", Any;
        /// What it does beside its law; left out, nothing.
        conduct: Option<Conduct> = none, "", Any;
        /// How it goes up a stimulus; left out, it does not.
        taxis: Option<Taxis> = none, "", Any;
        /// How its speed varies; left out, as the law says.
        pace: Option<Pace> = none, "", Any;
        /// Other parameters in a situation; left out, always the same.
        adapt: Option<Adapt> = none, "", Any;
        /// How often members decide; left out, in every step.
        decides: Option<Decides> = none, "", Any;
        /// Bodies.
        physics: Option<Physics> = none, "", Any;
    }
}

form! {
    /// What is kept of the motion.
    pub struct Record {
        /// Time between two kept frames; a multiple of the step. Left out: so that about 600 frames are kept.
        interval: Option<f64> = none, "time", Positive;
        /// Time of the first kept frame.
        from: f64 = [0.0], "time", NonNegative;
        /// Whether positions and velocities are kept at all.
        trajectory: bool = [true], "", Any;
    }
}

impl Default for Record {
    fn default() -> Self {
        Self { interval: None, from: 0.0, trajectory: true }
    }
}

form! {
    /// What is measured.
    pub struct Measure {
        /// Metrics by their ids, as `flockworks metrics` lists them. Left out: polarisation, angular_momentum,
        /// nearest_neighbour_distance, mean_speed, group_count and largest_group_share, where they are defined.
        metrics: Option<Vec<String>> = none, "", Any;
        /// Time between two measurements; a multiple of the step. Left out: as the frames that are kept.
        interval: Option<f64> = none, "time", Positive;
        /// Parameters of metrics, by name: each holds for every metric that has it.
        parameters: Named<f64> = [Named::default()], "", Positive;
    }
}

impl Scenario {
    /// Ids of the metrics that are measured.
    pub fn metrics(&self) -> Vec<String> {
        let defined = |id: &&str| {
            let card = measure::metrics::LIST.iter().find(|card| card.id == *id);
            card.is_some_and(|card| card.dimensions.contains(&self.space.dimensions))
        };
        let usual = || MEASURED.iter().filter(|id| defined(id)).map(|&id| id.to_owned()).collect();
        self.measure.metrics.clone().unwrap_or_else(usual)
    }
}

/// What is measured unless a file says otherwise.
const MEASURED: [&str; 6] = [
    "polarisation",
    "angular_momentum",
    "nearest_neighbour_distance",
    "mean_speed",
    "group_count",
    "largest_group_share",
];

form! {
    /// A scenario: one world, run once.
    pub struct Scenario {
        /// What kind of file this is.
        kind: FileKind = need, "", Any;
        /// A title of a few words.
        title: String = need, "", Any;
        /// What it is and what to look for; paragraphs are parted by empty lines.
        about: String = [""], "", Any;
        /// Seed of all random draws; left out, one is drawn and kept with the results.
        seed: Option<u64> = none, "1", NonNegative;
        /// How numbers are kept while computing.
        precision: Precision = [Precision::Double], "", Any;
        /// Units of length and time.
        units: Units = [Units::default()], "", Any;
        /// How long, in which steps, who acts when.
        time: Time = need, "", Any;
        /// The space.
        space: Space = need, "", Any;
        /// Obstacles, one by one.
        obstacle: Vec<Obstacle> = [Vec::new()], "", Any;
        /// Obstacles scattered at random, by a name of yours.
        scatter: Named<Scatter> = [Named::default()], "", Any;
        /// Food.
        food: Option<Food> = none, "", Any;
        /// Fields that bodies may sense, by a name of yours.
        stimulus: Named<Stimulus> = [Named::default()], "", Any;
        /// The groups, by a name of yours.
        group: Named<Group> = need, "", Any;
        /// What is kept of the motion.
        record: Record = [Record::default()], "", Any;
        /// What is measured.
        measure: Measure = [Measure { metrics: None, interval: None, parameters: Named::default() }], "", Any;
    }
}

/// What may have been meant by a parameter that none of the measured metrics has.
fn other_parameter(name: &str, measured: &[&MetricCard]) -> String {
    let mut known: Vec<&str> =
        measured.iter().flat_map(|card| card.parameters).map(|parameter| parameter.name).collect();
    known.sort_unstable();
    known.dedup();
    if let Some(near) = nearest(name, known.iter().copied()) {
        return format!("did you mean `{near}`?");
    }
    let has = |card: &&&MetricCard| card.parameters.iter().any(|parameter| parameter.name == name);
    let of: Vec<&str> = measure::metrics::LIST.iter().filter(has).map(|card| card.id).collect();
    match (of.is_empty(), known.is_empty()) {
        (false, _) => format!("it is a parameter of {}, not measured here", of.join(" and ")),
        (true, false) => format!("those that are measured take {}", known.join(", ")),
        (true, true) => "none of those that are measured takes any".to_owned(),
    }
}

/// The metrics of a scenario, with their parameters.
///
/// # Errors
/// A metric or a parameter that does not exist, or is not for so many dimensions.
pub fn metrics_of<const D: usize>(scenario: &Scenario) -> Result<Vec<Box<dyn measure::Measure<D>>>, build::Wrong> {
    use build::Wrong;
    let mut metrics = Vec::new();
    let ids = scenario.metrics();
    for (k, id) in ids.iter().enumerate() {
        let at = format!("measure.metrics.{k}");
        let metric = measure::metrics::find::<D>(id).map_err(|error| {
            Wrong::new(at.clone(), error.to_string(), "not a metric").help("`flockworks metrics` lists them")
        })?;
        if ids[..k].contains(id) {
            return Err(Wrong::new(at, format!("`{id}` is measured already"), "given twice"));
        }
        if !metric.card().dimensions.contains(&D) {
            return Err(Wrong::new(at, format!("`{id}` is not defined in {D} dimensions"), "not in this space"));
        }
        metrics.push(metric);
    }
    for (name, value) in &scenario.measure.parameters.0 {
        let mut used = false;
        for metric in &mut metrics {
            if metric.card().parameters.iter().any(|parameter| parameter.name == name) {
                used = true;
                metric.set(name, *value).map_err(|error| {
                    Wrong::new(format!("measure.parameters.{name}"), error.to_string(), "not possible")
                })?;
            }
        }
        if !used {
            let what = format!("no measured metric has a parameter `{name}`");
            let cards: Vec<_> = metrics.iter().map(|metric| metric.card()).collect();
            return Err(Wrong::new(format!("measure.parameters.{name}"), what, "not a parameter")
                .help(&other_parameter(name, &cards))
                .key());
        }
    }
    Ok(metrics)
}
