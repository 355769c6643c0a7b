//! What is sent: the frames of whatever the viewer can show, its words and its metrics.

use super::{Form, Most};
use crate::live::{LiveError, Shown};
use crate::report::{Axis, Border, Line, Lines, Outline, Replay, Stage};
use crate::store::StoreError;
use core::ops::RangeInclusive;
use serde_json::Value as Json;

/// Frames before a moment that its trails show.
const TRAIL: u64 = 12;

/// A recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Title.
    pub title: String,
    /// What it is.
    pub about: String,
    /// The file it came from.
    pub source: String,
    /// The command that made it.
    pub command: String,
    /// Program and seed.
    pub made_by: String,
    /// Metrics over time.
    pub charts: Vec<Lines>,
    /// The frames.
    pub replay: Replay,
}

impl Recording {
    /// Refuses a recording without a frame.
    pub(super) fn needs_frames(&self) -> Result<(), StoreError> {
        if self.replay.times.is_empty() || self.replay.position.len() < self.replay.times.len() {
            return Err(StoreError::Refused("there is no frame to be sent".into()));
        }
        Ok(())
    }
}

/// Which frames are wanted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Chosen {
    /// The frame of a form that shows one moment; none for the last.
    pub frame: Option<u64>,
    /// From which to which; none for all.
    pub frames: Option<RangeInclusive<u64>>,
    /// Every so manieth of them; none for as many as the form takes.
    pub every: Option<u64>,
    /// So many of them at most, where that is fewer than the form takes.
    pub most: Option<usize>,
}

impl Chosen {
    /// The frames of a recording of so many, and how many lie from one to the next.
    ///
    /// # Errors
    /// Frames that are not there, in a sentence.
    fn of(&self, form: &dyn Form, frames: u64, agents: usize) -> Result<(Vec<u64>, u64), String> {
        let last = frames.checked_sub(1).ok_or("there is no frame to be sent")?;
        let there = |frame: u64| match frame <= last {
            true => Ok(frame),
            false => Err(format!("there is no frame {frame}: the last one is {last}")),
        };
        if form.still() {
            let frame = self.frame.map_or(Ok(last), there)?;
            return Ok(((frame.saturating_sub(TRAIL)..=frame).collect(), 1));
        }
        let range = self.frames.clone().unwrap_or(0..=last);
        let (from, to) = (there(*range.start())?, there(*range.end())?);
        if from > to {
            return Err(format!("frames go forwards: {from}..{to} does not"));
        }
        let Most { frames: most, positions } = form.most();
        let most = most.min(self.most.unwrap_or(most)).max(2);
        let fits = (positions / agents.max(1)).clamp(2, most) as u64;
        let every = self.every.unwrap_or_else(|| (to - from + 1).div_ceil(fits)).max(1);
        Ok(((from..=to).step_by(every as usize).collect(), every))
    }
}

/// Reads the chosen frames of a recording; also how many lie from one to the next. The frames of a simulation, which stands at its
/// beginning, are its steps: they are made.
///
/// # Errors
/// Frames that are not there or cannot be read.
pub fn read(
    shown: &mut dyn Shown,
    form: &dyn Form,
    chosen: &Chosen,
    program: &str,
) -> Result<(Recording, u64), LiveError> {
    let scene = shown.scene();
    let text = |path: &str| scene.pointer(path).and_then(Json::as_str).unwrap_or_default().to_owned();
    let whole = |path: &str| scene.pointer(path).and_then(Json::as_u64).unwrap_or(0);
    let dimensions = (whole("/dimensions") as usize).clamp(1, 3);
    let named = scene.pointer("/groups").and_then(Json::as_array).cloned().unwrap_or_default();
    let (mut group, mut names, mut radius) = (Vec::new(), Vec::new(), Vec::new());
    for (k, one) in named.iter().enumerate() {
        let count = one.get("count").and_then(Json::as_u64).unwrap_or(0) as usize;
        group.resize(group.len() + count, k);
        names.push(one.get("name").and_then(Json::as_str).unwrap_or_default().to_owned());
        radius.push(one.get("radius").and_then(Json::as_f64).unwrap_or(0.0));
    }
    let agents = group.len();
    let lives = scene.get("kind").and_then(Json::as_str) == Some("live");
    let there = if lives { whole("/steps") + 1 } else { whole("/frames") };
    let (frames, every) = chosen.of(form, there, agents).map_err(LiveError::Request)?;
    let (mut times, mut position, mut heading, mut obstacles) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (moves, mut at) = (shown.obstacles_move(), 0);
    for &frame in &frames {
        if lives {
            shown.advance(frame as i64 - at as i64)?;
            at = frame;
        } else {
            shown.seek(frame)?;
        }
        times.push(shown.moment().1);
        let (places, headings) = unpacked(&shown.frame(0), dimensions, agents);
        position.push(places);
        heading.push(headings);
        if moves || obstacles.is_empty() {
            obstacles.push(outlines(&shown.obstacles(), dimensions));
        }
    }
    let stage = stage(&scene, dimensions, &position, (names, radius), text("/units/length"));
    let seed = whole("/seed");
    let thinned = match (every, lives) {
        (1, _) => String::new(),
        (_, true) => format!(" One step in {every} is kept."),
        (_, false) => format!(" One frame in {every} is kept."),
    };
    let what = match (lives, scene.get("of").and_then(Json::as_str)) {
        (true, _) => "Simulated anew, from its seed.",
        (_, Some("course")) => "Computed anew, from its beginning to its end.",
        _ => "The recording as it was.",
    };
    let recording = Recording {
        title: text("/title"),
        about: text("/about"),
        source: shown.file()?,
        command: String::new(),
        made_by: if seed > 0 { format!("{program}, seed {seed}") } else { program.to_owned() },
        charts: shown.all_metrics().map_or_else(Vec::new, |all| charts(&scene, &all)),
        replay: Replay {
            title: "Replay".into(),
            about: format!("{what}{thinned}"),
            stage,
            time_unit: text("/units/time"),
            times,
            group,
            position,
            heading,
            obstacles,
        },
    };
    Ok((recording, every))
}

/// Places and headings of a frame as the viewer has it.
fn unpacked(bytes: &[u8], dimensions: usize, agents: usize) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    const HEAD: usize = 24;
    let number = |at: usize| {
        let four = bytes.get(HEAD + 4 * at..HEAD + 4 * at + 4);
        four.map_or(f32::NAN, |four| f32::from_le_bytes(core::array::from_fn(|k| four[k])))
    };
    let vector = |first: usize, agent: usize| {
        core::array::from_fn(|a| if a < dimensions { number(first + agent * dimensions + a) } else { 0.0 })
    };
    let all = |first: usize| (0..agents).map(|agent| vector(first, agent)).collect();
    (all(0), all(agents * dimensions))
}

fn numbers(value: Option<&Json>) -> [f64; 3] {
    core::array::from_fn(|a| value.and_then(|list| list.get(a)).and_then(Json::as_f64).unwrap_or(0.0))
}

/// The stage that holds all frames.
fn stage(
    scene: &Json,
    dimensions: usize,
    frames: &[Vec<[f32; 3]>],
    (groups, radius): (Vec<String>, Vec<f64>),
    unit: String,
) -> Stage {
    let (mut low, mut high) = (numbers(scene.pointer("/space/low")), numbers(scene.pointer("/space/high")));
    let mut edges = [Border::Open; 3];
    let widest = radius.iter().copied().fold(0.0, f64::max);
    for a in 0..dimensions {
        edges[a] = match scene.pointer(&format!("/space/edges/{a}")).and_then(Json::as_str) {
            Some("walls") => Border::Wall,
            Some("periodic") => Border::Seam,
            _ => Border::Open,
        };
        // a course knows its whole stage
        if edges[a] != Border::Open || scene.get("of").and_then(Json::as_str) == Some("course") {
            continue;
        }
        let places = || frames.iter().flatten().map(|place| f64::from(place[a])).filter(|value| value.is_finite());
        let (least, greatest) = (places().fold(f64::INFINITY, f64::min), places().fold(f64::NEG_INFINITY, f64::max));
        if least <= greatest {
            (low[a], high[a]) = (least - widest, greatest + widest);
        }
    }
    Stage { dimensions, low, high, edges, unit, groups, radius }
}

/// Obstacles as the viewer is told them.
fn outlines(message: &Json, dimensions: usize) -> Vec<Outline> {
    let list = message.get("list").and_then(Json::as_array).cloned().unwrap_or_default();
    let outline = |one: &Json| {
        if let Some(ball) = one.get("ball") {
            let radius = ball.get("radius").and_then(Json::as_f64)?;
            return Some(Outline::Ball { centre: numbers(ball.get("centre")), radius });
        }
        if let Some(wall) = one.get("segment") {
            return Some(Outline::Segment { from: numbers(wall.get("from")), to: numbers(wall.get("to")) });
        }
        if let Some(block) = one.get("box") {
            return Some(Outline::Cuboid { low: numbers(block.get("low")), high: numbers(block.get("high")) });
        }
        if let Some(plane) = one.get("plane").filter(|_| dimensions == 2) {
            // the line where a half-plane begins, far longer than any stage
            let (point, normal) = (numbers(plane.get("point")), numbers(plane.get("normal")));
            let along = |far: f64| [point[0] - far * normal[1], point[1] + far * normal[0], 0.0];
            return Some(Outline::Segment { from: along(-1e4), to: along(1e4) });
        }
        let corners = one.get("polygon").and_then(Json::as_array)?;
        Some(Outline::Polygon(corners.iter().map(|corner| numbers(Some(corner))).collect()))
    };
    list.iter().filter_map(outline).collect()
}

/// Metrics over time as the viewer has them.
fn charts(scene: &Json, all: &Json) -> Vec<Lines> {
    let list = |value: &Json, path: &str| value.pointer(path).and_then(Json::as_array).cloned().unwrap_or_default();
    let x: Vec<f64> = list(all, "/t").iter().filter_map(Json::as_f64).collect();
    let time = scene.pointer("/units/time").and_then(Json::as_str).unwrap_or_default().to_owned();
    let groups = list(all, "/groups");
    let chart = |(k, metric): (usize, &Json)| {
        let text = |key: &str| metric.get(key).and_then(Json::as_str).unwrap_or_default().to_owned();
        let range = metric.get("range").filter(|range| range.is_array()).map(|range| {
            let ends = numbers(Some(range));
            (ends[0], ends[1])
        });
        let line = |group: &Json| {
            let name = group.get("group").and_then(Json::as_str).unwrap_or_default().to_owned();
            Line { name, x: x.clone(), y: list(group, &format!("/values/{k}")).iter().map(Json::as_f64).collect() }
        };
        Lines {
            id: text("id"),
            title: text("title"),
            about: String::new(),
            x: Axis { label: "time".into(), unit: time.clone(), range: None },
            y: Axis { label: text("title").to_lowercase(), unit: text("unit"), range },
            lines: groups.iter().map(line).filter(|line| line.y.len() == line.x.len()).collect(),
        }
    };
    list(scene, "/metrics").iter().enumerate().map(chart).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::export::find;

    #[test]
    fn frames_are_chosen_and_thinned() {
        let (html, png) = (find("html").unwrap(), find("png").unwrap());
        let all = Chosen::default();
        assert_eq!(all.of(html, 10, 5), Ok(((0..10).collect(), 1)));
        assert_eq!(all.of(png, 20, 5).unwrap().0, (7..=19).collect::<Vec<_>>(), "a moment has its trail before it");
        let few = Chosen { most: Some(4), ..Chosen::default() };
        assert_eq!(few.of(html, 10, 5), Ok((vec![0, 3, 6, 9], 3)));
        let some = Chosen { frames: Some(2..=8), every: Some(3), ..Chosen::default() };
        assert_eq!(some.of(html, 10, 5), Ok((vec![2, 5, 8], 3)));
        let (many, every) = all.of(html, 1_000_000, 100_000).unwrap();
        assert!(many.len() * 100_000 <= html.most().positions + 100_000 && every > 1);
        let late = Chosen { frames: Some(2..=10), ..Chosen::default() };
        assert!(late.of(html, 10, 5).unwrap_err().contains("the last one is 9"));
        assert!(Chosen { frame: Some(10), ..Chosen::default() }.of(png, 10, 5).is_err());
        assert!(all.of(html, 0, 5).unwrap_err().contains("no frame"));
    }
}
