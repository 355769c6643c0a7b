//! Worlds to be looked at: a simulation that runs while one watches and changes it, a trial of a formation file, a recorded run or
//! recorded tracks to scrub through, and a course that was computed to its end.
//!
//! What a viewer shows is said in the messages of `docs/explanation/viewer-protocol.md`; this module makes them, and
//! knows nothing of how they travel.

mod controls;
mod formed;
mod recorded;
mod replayed;
mod simulated;
mod tracked;

pub use formed::form;
pub use recorded::Recorded;
pub use replayed::{Course, Replayed};
pub use simulated::simulate;
pub use tracked::Tracked;

use crate::file::Problems;
use crate::scenario::Scenario;
use crate::store::StoreError;
use serde_json::{Value as Json, json};
use space::obstacles::Obstacles;
use space::shape::Shape;
use space::{Edge, Real, Space, Vector};

/// What can go wrong while one looks.
#[derive(Debug)]
pub enum LiveError {
    /// The scenario, or a value put into it.
    Scenario(Problems),
    /// Files.
    Store(StoreError),
    /// Something else about the request.
    Request(String),
}

impl core::fmt::Display for LiveError {
    fn fmt(&self, out: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Scenario(problems) => write!(out, "{problems}"),
            Self::Store(error) => write!(out, "{error}"),
            Self::Request(text) => write!(out, "{text}"),
        }
    }
}
impl core::error::Error for LiveError {}

impl From<Problems> for LiveError {
    fn from(problems: Problems) -> Self {
        Self::Scenario(problems)
    }
}
impl From<StoreError> for LiveError {
    fn from(error: StoreError) -> Self {
        Self::Store(error)
    }
}

/// Something to look at.
pub trait Shown: Send {
    /// The message `scene`.
    fn scene(&self) -> Json;
    /// The message `obstacles`, for the moment shown.
    fn obstacles(&self) -> Json;
    /// Places of the food that is there; none where there never is any.
    fn items(&self) -> Option<Json>;
    /// Whether obstacles move or come and go.
    fn obstacles_move(&self) -> bool;
    /// Goes on by so many steps (frames of a recording; backwards where negative). How many it went, which is fewer at an
    /// end.
    fn advance(&mut self, count: i64) -> Result<i64, LiveError>;
    /// Step and time of the moment shown, and the frame in a recording.
    fn moment(&self) -> (u64, f64, Option<u64>);
    /// The moment as a binary message, under a number.
    fn frame(&self, number: u32) -> Vec<u8>;
    /// The metrics of the moment: the rows of the message `metrics`; none in a recording, which has them all at once.
    fn measure(&mut self) -> Option<Json>;
    /// The message `metrics_all`, of a recording.
    fn all_metrics(&self) -> Option<Json>;
    /// Explains an agent in the step that begins at the moment shown.
    fn explain(&mut self, agent: u32) -> Result<Json, LiveError>;
    /// Shows a frame of a recording.
    fn seek(&mut self, frame: u64) -> Result<(), LiveError>;
    /// Begins anew, with another seed if one is given.
    fn reset(&mut self, seed: Option<u64>) -> Result<(), LiveError>;
    /// Changes a value of what its controls show from now on. Whether the state went on as it was; else it began anew.
    fn set(&mut self, path: &str, value: &Json) -> Result<bool, LiveError>;
    /// Lets a formation go on to its next walls in the step that begins at the moment shown. What happened, in a word or two.
    fn go_on(&mut self) -> Result<String, LiveError> {
        Err(LiveError::Request("there is no formation here that could go on".into()))
    }
    /// The file as it is now, as TOML.
    fn file(&self) -> Result<String, LiveError>;
    /// Steps per second (frames in a recording) at which to begin.
    fn natural_rate(&self) -> f64;
}

/// Coordinates as JSON.
fn coordinates<R: Real, const D: usize>(v: Vector<R, D>) -> Json {
    v.0.iter().map(|c| c.to_f64()).collect()
}

/// The obstacles that are there, as the message `obstacles`.
fn obstacles<R: Real, const D: usize>(obstacles: &Obstacles<R, D>, time: f64) -> Json {
    let mut list = Vec::new();
    for obstacle in obstacles.list() {
        let mut by = Vector::ZERO;
        if let Some(plan) = &obstacle.plan {
            if !plan.present(time) {
                continue;
            }
            by = plan.offset(time);
        }
        let at = |v: Vector<R, D>| coordinates(v + by);
        list.push(match &obstacle.shape {
            Shape::Ball { centre, radius } => json!({ "ball": { "centre": at(*centre), "radius": radius.to_f64() } }),
            Shape::Segment { from, to } => json!({ "segment": { "from": at(*from), "to": at(*to) } }),
            Shape::Polygon { vertices } => json!({ "polygon": vertices.iter().map(|&v| at(v)).collect::<Vec<_>>() }),
            Shape::Cuboid { low, high } => json!({ "box": { "low": at(*low), "high": at(*high) } }),
            Shape::Plane { point, normal } => {
                json!({ "plane": { "point": at(*point), "normal": coordinates(*normal) } })
            }
        });
    }
    json!({ "is": "obstacles", "list": list })
}

/// The space as the scene says it, with a box that holds the given places where an axis is open.
fn space_json<R: Real, const D: usize>(space: &Space<R, D>, places: impl Iterator<Item = Vector<f64, D>>) -> Json {
    let (mut low, mut high) = ([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
    for place in places.filter(|place| place.finite()) {
        for a in 0..D {
            low[a] = low[a].min(place[a]);
            high[a] = high[a].max(place[a]);
        }
    }
    let mut edges = Vec::new();
    let mut size = Vec::new();
    for a in 0..D {
        let (edge, side) = match space.edges[a] {
            Edge::Open => ("open", None),
            Edge::Periodic(side) => ("periodic", Some(side.to_f64())),
            Edge::Walls(side) => ("walls", Some(side.to_f64())),
        };
        if let Some(side) = side {
            (low[a], high[a]) = (0.0, side);
        } else if low[a] > high[a] {
            (low[a], high[a]) = (0.0, 1.0);
        }
        edges.push(edge);
        size.push(side);
    }
    json!({ "edges": edges, "size": size, "low": low.to_vec(), "high": high.to_vec() })
}

/// The metrics of a scenario as the scene lists them.
fn metrics_json(scenario: &Scenario) -> Json {
    let card = |id: &String| {
        let card = measure::metrics::LIST.iter().find(|card| card.id == id)?;
        let range = card.range.map(|(low, high)| [low, high]);
        Some(json!({ "id": card.id, "title": card.title, "unit": scenario.units.of(card.unit), "range": range }))
    };
    scenario.metrics().iter().filter_map(card).collect()
}

/// The binary message of a moment: places and headings in the order of ids, and labels where there are any.
fn packed(
    number: u32,
    step: u64,
    time: f64,
    dimensions: usize,
    agents: usize,
    place: impl Fn(usize, usize) -> f32,
    heading: impl Fn(usize, usize) -> f32,
    label: Option<&dyn Fn(usize) -> u8>,
) -> Vec<u8> {
    let mut out = Vec::with_capacity(24 + agents * (8 * dimensions + 1));
    out.extend(number.to_le_bytes());
    out.extend((step as u32).to_le_bytes());
    out.extend(time.to_le_bytes());
    out.extend((agents as u32).to_le_bytes());
    out.extend([dimensions as u8, u8::from(label.is_some()), 0, 0]);
    for agent in 0..agents {
        (0..dimensions).for_each(|a| out.extend(place(agent, a).to_le_bytes()));
    }
    for agent in 0..agents {
        (0..dimensions).for_each(|a| out.extend(heading(agent, a).to_le_bytes()));
    }
    if let Some(label) = label {
        out.extend((0..agents).map(label));
    }
    out
}
