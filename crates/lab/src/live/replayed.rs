//! Something that was computed from its beginning to its end before it is shown: it is scrubbed through like a recording.

use super::{LiveError, Shown, packed};
use crate::report::replay::extent;
use crate::report::{Border, Outline, Replay};
use serde_json::{Value as Json, json};

/// A course to be played.
#[derive(Clone, Debug, PartialEq)]
pub struct Course {
    /// Title.
    pub title: String,
    /// What it is.
    pub about: String,
    /// The file that it came from.
    pub source: String,
    /// Seed, where there is one.
    pub seed: Option<u64>,
    /// Lines that are in nobody's way: paths, gates, goals.
    pub guides: Vec<Vec<[f64; 2]>>,
    /// The frames.
    pub replay: Replay,
}

/// A course, frame by frame.
pub struct Replayed {
    course: Course,
    at: usize,
}

impl Replayed {
    /// The first frame of a course.
    ///
    /// # Errors
    /// A course without a frame.
    pub fn new(course: Course) -> Result<Self, LiveError> {
        let frames = course.replay.times.len();
        if frames == 0 || course.replay.position.len() < frames || course.replay.heading.len() < frames {
            return Err(LiveError::Request(format!("`{}` has no frame", course.title)));
        }
        Ok(Self { course, at: 0 })
    }
    fn frames(&self) -> usize {
        self.course.replay.times.len()
    }
    /// Mean time from one frame to the next.
    fn step(&self) -> f64 {
        let times = &self.course.replay.times;
        let span = times[times.len() - 1] - times[0];
        if span > 0.0 { span / (times.len() - 1) as f64 } else { 1.0 }
    }
}

/// An obstacle as the message `obstacles` says it.
pub(super) fn shape(outline: &Outline, dimensions: usize) -> Json {
    let at = |place: &[f64; 3]| json!(place[..dimensions]);
    match outline {
        Outline::Ball { centre, radius } => json!({ "ball": { "centre": at(centre), "radius": radius } }),
        Outline::Segment { from, to } => json!({ "segment": { "from": at(from), "to": at(to) } }),
        Outline::Polygon(corners) => json!({ "polygon": corners.iter().map(at).collect::<Vec<_>>() }),
        Outline::Cuboid { low, high } => json!({ "box": { "low": at(low), "high": at(high) } }),
    }
}

impl Shown for Replayed {
    fn scene(&self) -> Json {
        let Course { title, about, seed, replay, .. } = &self.course;
        let stage = &replay.stage;
        let dimensions = stage.dimensions.clamp(1, 3);
        let extent = extent(stage);
        let edges: Vec<&str> = stage.edges[..dimensions]
            .iter()
            .map(|edge| match edge {
                Border::Wall => "walls",
                Border::Seam => "periodic",
                Border::Open => "open",
            })
            .collect();
        let size = |a: usize| (stage.edges[a] != Border::Open).then(|| extent[a].1 - extent[a].0);
        let mut groups = Vec::new();
        let mut first = 0;
        for run in replay.group.chunk_by(|one, next| one == next) {
            let own = run[0];
            groups.push(json!({
                "name": stage.groups.get(own), "model": "", "title": "",
                "first": first, "count": run.len(), "radius": stage.radius.get(own).copied().unwrap_or(0.0),
            }));
            first += run.len();
        }
        json!({
            "is": "scene",
            "kind": "run",
            "of": "course",
            "title": title,
            "about": about,
            "seed": seed,
            "dimensions": dimensions,
            "units": { "length": stage.unit, "time": replay.time_unit },
            "space": {
                "edges": edges,
                "size": (0..dimensions).map(size).collect::<Vec<_>>(),
                "low": (0..dimensions).map(|a| extent[a].0).collect::<Vec<_>>(),
                "high": (0..dimensions).map(|a| extent[a].1).collect::<Vec<_>>(),
            },
            "groups": groups,
            "labels": [],
            "step": self.step(),
            "steps": self.frames() - 1,
            "frames": self.frames(),
            "from_step": 0,
            "every_steps": 1,
            "metrics": [],
            "controls": [],
            "events": [],
        })
    }
    fn obstacles(&self) -> Json {
        let replay = &self.course.replay;
        let dimensions = replay.stage.dimensions.clamp(1, 3);
        let now = replay.obstacles.get(self.at).or_else(|| replay.obstacles.last());
        let standing = now.into_iter().flatten().map(|outline| shape(outline, dimensions));
        let guides = self.course.guides.iter().map(|points| json!({ "guide": points }));
        json!({ "is": "obstacles", "list": standing.chain(guides).collect::<Vec<_>>() })
    }
    fn items(&self) -> Option<Json> {
        None
    }
    fn obstacles_move(&self) -> bool {
        self.course.replay.obstacles.len() > 1
    }
    fn advance(&mut self, count: i64) -> Result<i64, LiveError> {
        let before = self.at;
        self.seek((before as u64).saturating_add_signed(count))?;
        Ok(self.at as i64 - before as i64)
    }
    fn moment(&self) -> (u64, f64, Option<u64>) {
        (self.at as u64, self.course.replay.times[self.at], Some(self.at as u64))
    }
    fn frame(&self, number: u32) -> Vec<u8> {
        let replay = &self.course.replay;
        let dimensions = replay.stage.dimensions.clamp(1, 3);
        let (places, headings) = (&replay.position[self.at], &replay.heading[self.at]);
        let place = |agent: usize, a: usize| places.get(agent).map_or(f32::NAN, |place| place[a]);
        let heading = |agent: usize, a: usize| headings.get(agent).map_or(0.0, |heading| heading[a]);
        let (step, time, _) = self.moment();
        packed(number, step, time, dimensions, replay.group.len(), place, heading, None)
    }
    fn measure(&mut self) -> Option<Json> {
        None
    }
    fn all_metrics(&self) -> Option<Json> {
        None
    }
    fn explain(&mut self, _: u32) -> Result<Json, LiveError> {
        Err(LiveError::Request("what moves an agent is told of simulations and of the folders of runs".into()))
    }
    fn seek(&mut self, frame: u64) -> Result<(), LiveError> {
        self.at = (frame as usize).min(self.frames() - 1);
        Ok(())
    }
    fn reset(&mut self, _: Option<u64>) -> Result<(), LiveError> {
        self.seek(0)
    }
    fn set(&mut self, _: &str, _: &Json) -> Result<bool, LiveError> {
        Err(LiveError::Request("what was computed to its end does not change".into()))
    }
    fn file(&self) -> Result<String, LiveError> {
        Ok(self.course.source.clone())
    }
    fn natural_rate(&self) -> f64 {
        20.0
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::report::Stage;

    fn course(frames: usize) -> Course {
        let stage = Stage {
            dimensions: 2,
            low: [0.0; 3],
            high: [4.0, 4.0, 0.0],
            edges: [Border::Wall, Border::Open, Border::Open],
            unit: "m".into(),
            groups: vec!["targets".into(), "shepherds".into()],
            radius: vec![0.1, 0.2],
        };
        let wall = |x: f64| vec![Outline::Segment { from: [x, 0.0, 0.0], to: [x, 1.0, 0.0] }];
        Course {
            title: "Two targets, one shepherd".into(),
            about: String::new(),
            source: "kind = \"formation\"".into(),
            seed: Some(3),
            guides: vec![vec![[0.0, 0.0], [1.0, 1.0]]],
            replay: Replay {
                title: String::new(),
                about: String::new(),
                stage,
                time_unit: "s".into(),
                times: (0..frames).map(|k| 0.5 * k as f64).collect(),
                group: vec![0, 0, 1],
                position: (0..frames).map(|k| vec![[k as f32, 1.0, 0.0]; 3]).collect(),
                heading: vec![vec![[1.0, 0.0, 0.0]; 3]; frames],
                obstacles: (0..frames).map(|k| wall(k as f64)).collect(),
            },
        }
    }

    #[test]
    fn a_course_is_scrubbed_like_a_recording() {
        let mut shown = Replayed::new(course(4)).unwrap();
        let scene = shown.scene();
        assert_eq!(scene["frames"], 4);
        assert_eq!(
            scene["groups"][1],
            json!({ "name": "shepherds", "model": "", "title": "", "first": 2, "count": 1, "radius": 0.2 })
        );
        assert_eq!(
            (&scene["space"]["size"], &scene["space"]["edges"]),
            (&json!([4.0, null]), &json!(["walls", "open"]))
        );
        assert_eq!(shown.advance(9).unwrap(), 3);
        assert_eq!(shown.moment(), (3, 1.5, Some(3)));
        let list = shown.obstacles();
        assert_eq!(list["list"][0]["segment"]["from"], json!([3.0, 0.0]));
        assert_eq!(list["list"][1]["guide"], json!([[0.0, 0.0], [1.0, 1.0]]));
        assert_eq!(shown.advance(-1).unwrap(), -1);
        // number, step, time, agents, head; then places
        let bytes = shown.frame(7);
        assert_eq!(f32::from_le_bytes(bytes[24..28].try_into().unwrap()), 2.0);
        assert!(shown.set("seed", &json!(1)).is_err() && shown.explain(0).is_err());
    }

    #[test]
    fn a_course_without_a_frame_is_refused() {
        assert!(Replayed::new(course(0)).map(|_| ()).unwrap_err().to_string().contains("no frame"));
    }
}
