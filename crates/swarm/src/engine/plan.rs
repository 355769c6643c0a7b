//! What a world is built from.

use crate::adaptation::{Adaptation, Varied};
use crate::conduct::Conduct;
use crate::engine::{MotionNoise, Sensing};
use crate::pace::Pace;
use crate::parameters::{ParameterError, Values};
use crate::physics::{Contact, Mobility};
use crate::resources::ResourcePlan;
use crate::selection::Perception;
use crate::stimulus::{Stimulus, Taxis};
use space::obstacles::Obstacle;
use space::{Real, Space, Vector};
use std::collections::BTreeMap;

/// The order in which a sequential driver activates agents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// By id, every step.
    RoundRobin,
    /// In a new random order every step.
    Random,
}

/// When an asynchronous agent starts its first period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// All at the start.
    Together,
    /// Evenly over the period, by id.
    Spread,
    /// Uniformly at random over the period.
    Random,
}

/// How an asynchronous agent measures its period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clock {
    /// The period, give or take a share of it drawn uniformly each time.
    Regular {
        /// Largest deviation, as a share of the period (0 to 1).
        jitter: f64,
    },
    /// Exponentially distributed with the period as its mean.
    Poisson,
}

/// Who acts when.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Driver {
    /// All read the frame at `t`, and the whole next frame is written at once.
    Synchronous,
    /// One after the other; each reads the newest state of the others and writes its own at once.
    Sequential(Order),
    /// Each on its own clock, with physics running on beneath.
    Asynchronous {
        /// Step of the physics.
        tick: f64,
        /// Time between an agent's decisions.
        period: f64,
        /// When agents start.
        phase: Phase,
        /// How they measure the period.
        clock: Clock,
        /// Age of what is read of others.
        delay: f64,
    },
}

/// How neighbours are searched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IndexChoice {
    /// Cells where they pay.
    Automatic,
    /// All pairs, always.
    Pairs,
    /// Cells wherever the space and the reach allow, for any number of agents.
    Cells,
}

/// What a group is told of obstacles and walls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObstaclePlan<R> {
    /// Those nearer than this are detected; `None`: as near as the model looks.
    pub within: Option<R>,
    /// So many of them are handed on, the nearest; `None`: all.
    pub nearest: Option<usize>,
    /// Whether each of these is a member too, which the model cannot tell from real ones.
    pub members: bool,
}

impl<R> Default for ObstaclePlan<R> {
    fn default() -> Self {
        Self { within: None, nearest: None, members: false }
    }
}

/// Clocks of the members of a group under an asynchronous driver: each list is empty, where all are as the driver says, or has an
/// entry for each member.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ClockPlan {
    /// Times between two decisions.
    pub period: Vec<f64>,
    /// Times of the first decision.
    pub phase: Vec<f64>,
    /// Largest deviations from the period, as shares of it.
    pub jitter: Vec<f64>,
}

/// A group's state at the start, agent by agent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Start<R, const D: usize> {
    /// Positions.
    pub position: Vec<Vector<R, D>>,
    /// Velocities, or none.
    pub velocity: Option<Vec<Vector<R, D>>>,
    /// Declared columns that are given, by name.
    pub columns: BTreeMap<String, Vec<f64>>,
}

/// How a group's start is had.
#[derive(Clone, Debug, PartialEq)]
pub enum Placement<R, const D: usize> {
    /// As given.
    Given(Start<R, D>),
    /// Uniformly in a box, with headings at random and the model's initial speed.
    Uniform {
        /// Lower corner.
        low: Vector<R, D>,
        /// Upper corner.
        high: Vector<R, D>,
    },
}

/// The plan of a group.
#[derive(Clone, Debug, PartialEq)]
pub struct GroupPlan<R, const D: usize> {
    /// Name in files and tables.
    pub name: String,
    /// Number of agents.
    pub count: usize,
    /// Id of the model.
    pub model: String,
    /// Its parameters; those left out take their defaults.
    pub parameters: Values,
    /// Parameters of which every member has its own value.
    pub varied: Vec<Varied>,
    /// Other parameters in a situation.
    pub adapt: Option<Adaptation<R>>,
    /// Steps between two decisions, by member; empty where all decide in every step. Not under an asynchronous driver.
    pub intervals: Vec<u64>,
    /// Clocks that differ from the driver's. Under an asynchronous driver only.
    pub clocks: ClockPlan,
    /// The start.
    pub placement: Placement<R, D>,
    /// Sensing.
    pub sensing: Sensing<R>,
    /// Perception functions in place of the model's own, by the name of the set.
    pub sets: Vec<(String, Perception<R, D>)>,
    /// What it is told of obstacles and walls.
    pub obstacles: ObstaclePlan<R>,
    /// What it does beside its law.
    pub conduct: Option<Conduct<R>>,
    /// How it goes up a stimulus.
    pub taxis: Option<Taxis<R>>,
    /// How its speed varies; `None`: as the law says.
    pub pace: Option<Pace<R>>,
    /// What a body can do.
    pub mobility: Mobility<R>,
    /// What happens on contact; `None`: as the model says.
    pub contact: Option<Contact>,
    /// Body radius; `None`: as the model says.
    pub radius: Option<R>,
    /// Length of an elongated body along its heading, from tip to tip; `None`: bodies are round.
    pub length: Option<R>,
    /// Errors of computation and execution.
    pub noise: MotionNoise<R>,
}

impl<R: Real, const D: usize> GroupPlan<R, D> {
    /// A group of a model with defaults for everything else.
    pub fn new(name: &str, model: &str, parameters: Values, count: usize, placement: Placement<R, D>) -> Self {
        Self {
            name: name.to_owned(),
            count,
            model: model.to_owned(),
            parameters,
            varied: Vec::new(),
            adapt: None,
            intervals: Vec::new(),
            clocks: ClockPlan::default(),
            placement,
            sensing: Sensing::default(),
            sets: Vec::new(),
            obstacles: ObstaclePlan::default(),
            conduct: None,
            taxis: None,
            pace: None,
            mobility: Mobility::Ideal,
            contact: None,
            radius: None,
            length: None,
            noise: MotionNoise::default(),
        }
    }
}

/// The plan of a world.
#[derive(Clone, Debug, PartialEq)]
pub struct WorldPlan<R, const D: usize> {
    /// The space.
    pub space: Space<R, D>,
    /// The groups, in the order of their ids.
    pub groups: Vec<GroupPlan<R, D>>,
    /// Obstacles.
    pub obstacles: Vec<Obstacle<R, D>>,
    /// Stimuli.
    pub stimuli: Vec<Stimulus<R, D>>,
    /// Resources.
    pub resources: Option<ResourcePlan<R, D>>,
    /// Who acts when.
    pub driver: Driver,
    /// How neighbours are searched.
    pub index: IndexChoice,
    /// Seed of all draws.
    pub seed: u64,
    /// Step number at the start.
    pub first_step: u64,
    /// Number of threads.
    pub threads: usize,
}

impl<R: Real, const D: usize> WorldPlan<R, D> {
    /// A world of one group, everything else by default.
    pub fn new(space: Space<R, D>, group: GroupPlan<R, D>) -> Self {
        Self {
            space,
            groups: vec![group],
            obstacles: Vec::new(),
            stimuli: Vec::new(),
            resources: None,
            driver: Driver::Synchronous,
            index: IndexChoice::Automatic,
            seed: 1,
            first_step: 0,
            threads: 1,
        }
    }
}

/// What is wrong with a plan.
#[derive(Clone, Debug, PartialEq)]
pub enum WorldError {
    /// No model of this id.
    Model {
        /// The id asked for.
        id: String,
        /// The id that may have been meant.
        nearest: Option<&'static str>,
    },
    /// The model does not work in this many dimensions.
    Dimension {
        /// The model.
        id: String,
        /// Dimensions asked for.
        asked: usize,
        /// Dimensions it works in.
        works: &'static [usize],
    },
    /// A parameter.
    Parameter {
        /// Name of the group.
        group: String,
        /// What is wrong with it.
        error: ParameterError,
    },
    /// Something else about a group.
    Group {
        /// Name of the group.
        group: String,
        /// What is wrong, what was expected, and the remedy.
        problem: String,
    },
    /// Something about the world as a whole.
    World(String),
}

impl core::fmt::Display for WorldError {
    fn fmt(&self, out: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Model { id, nearest: Some(nearest) } => {
                write!(out, "unknown model `{id}`; did you mean `{nearest}`?")
            }
            Self::Model { id, nearest: None } => write!(out, "unknown model `{id}`"),
            Self::Dimension { id, asked, works } => {
                let works: Vec<String> = works.iter().map(ToString::to_string).collect();
                write!(out, "`{id}` works in {} dimensions, not in {asked}", works.join(" or "))
            }
            Self::Parameter { group, error } => write!(out, "group `{group}`: {error}"),
            Self::Group { group, problem } => write!(out, "group `{group}`: {problem}"),
            Self::World(problem) => write!(out, "{problem}"),
        }
    }
}
impl core::error::Error for WorldError {}
