//! A recording as one file to send: a page that plays by itself, pictures, moving pictures, a scene in space.
//!
//! A form is one file and one line of [`LIST`]. All are made from a [`Recording`], which is read frame by frame from whatever
//! the viewer can show, so that what is sent is what was seen.

mod gif;
mod gltf;
mod glyphs;
mod html;
mod mp4;
mod picture;
mod png;
mod raster;
mod recording;
mod svg;

pub use recording::{Chosen, Recording, read};

use crate::store::StoreError;

/// Every form, in the order in which they are named.
pub const LIST: &[&dyn Form] = &[&html::Html, &png::Png, &svg::Svg, &gif::Gif, &mp4::Mp4, &gltf::Gltf];

/// How it is to look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Width of pictures, pixels.
    pub width: u32,
    /// Frames in a second of what moves.
    pub rate: f64,
}

/// How much of a recording a form takes where nobody says: what is more is thinned evenly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Most {
    /// Frames.
    pub frames: usize,
    /// Positions: agents in all frames.
    pub positions: usize,
}

/// A form in which a recording can be sent.
pub trait Form: Sync {
    /// Its name on the command line.
    fn id(&self) -> &'static str;
    /// How the name of its file ends.
    fn ending(&self) -> &'static str {
        self.id()
    }
    /// What it is, in a line.
    fn about(&self) -> &'static str;
    /// Whether it shows one moment.
    fn still(&self) -> bool {
        false
    }
    /// How much of a recording it takes.
    fn most(&self) -> Most;
    /// The bytes of its file.
    ///
    /// # Errors
    /// A recording without a frame, and what is missing on this machine; each with the remedy.
    fn bytes(&self, recording: &Recording, look: &Look) -> Result<Vec<u8>, StoreError>;
}

/// The form of a name.
pub fn find(id: &str) -> Option<&'static dyn Form> {
    LIST.iter().find(|form| form.id() == id).copied()
}

/// A number of bytes, with its unit.
pub fn size(bytes: usize) -> String {
    crate::report::number::bytes(bytes)
}

/// What a system refuses while a form is made.
fn failed(what: &str, error: impl core::fmt::Display) -> StoreError {
    StoreError::Refused(format!("cannot make {what}: {error}"))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::report::{Border, Outline, Replay, Stage};

    /// Two groups on their ways, with an agent that is missing at times and all kinds of obstacles.
    pub(super) fn recording(dimensions: usize, frames: usize, agents: usize) -> Recording {
        let way = |frame: usize, agent: usize| (frame as f32 * 0.05 + agent as f32, agent as f32 * 0.7);
        let place = |frame, agent| {
            let (angle, out) = way(frame, agent);
            let place = [5.0 + 3.0 * angle.cos(), 5.0 + 3.0 * angle.sin(), 2.0 + out % 5.0];
            let nobody = agent == 1 && frame % 3 == 0;
            core::array::from_fn(|a| {
                if nobody {
                    f32::NAN
                } else if a < dimensions {
                    place[a]
                } else {
                    0.0
                }
            })
        };
        let heading = |frame, agent| {
            let (angle, _) = way(frame, agent);
            let heading = [-angle.sin(), angle.cos(), 0.0];
            core::array::from_fn(|a| if a < dimensions { heading[a] } else { 0.0 })
        };
        let each = |of: &dyn Fn(usize, usize) -> [f32; 3]| -> Vec<Vec<[f32; 3]>> {
            (0..frames).map(|frame| (0..agents).map(|agent| of(frame, agent)).collect()).collect()
        };
        let high = core::array::from_fn(|a| if a < dimensions { 10.0 } else { 0.0 });
        let obstacles = vec![
            Outline::Ball { centre: [5.0, 5.0, 0.0], radius: 1.0 },
            Outline::Segment { from: [1.0, 1.0, 0.0], to: [1.0, 9.0, 0.0] },
            Outline::Cuboid { low: [7.0, 1.0, 0.0], high: [9.0, 2.0, 1.0] },
            Outline::Polygon(vec![[2.0, 2.0, 0.0], [3.0, 2.0, 0.0], [2.5, 3.0, 0.0]]),
        ];
        Recording {
            title: "A <test> & more".into(),
            about: "Nothing.".into(),
            source: String::new(),
            command: String::new(),
            made_by: "flockworks".into(),
            charts: Vec::new(),
            replay: Replay {
                title: "Replay".into(),
                about: String::new(),
                stage: Stage {
                    dimensions,
                    low: [0.0; 3],
                    high,
                    edges: [Border::Wall, Border::Seam, Border::Open],
                    unit: "m".into(),
                    groups: vec!["fish".into(), "others".into()],
                    radius: vec![0.1, 0.0],
                },
                time_unit: "s".into(),
                times: (0..frames).map(|frame| frame as f64 * 0.1).collect(),
                group: (0..agents).map(|agent| agent * 2 / agents.max(1)).collect(),
                position: each(&place),
                heading: each(&heading),
                obstacles: vec![obstacles],
            },
        }
    }

    #[test]
    fn names_are_names_of_one_form_each() {
        for form in LIST {
            assert_eq!(find(form.id()).map(|found| found.about()), Some(form.about()));
            assert_eq!(LIST.iter().filter(|other| other.id() == form.id()).count(), 1, "{}", form.id());
        }
        assert!(find("tiff").is_none());
    }

    #[test]
    fn every_form_takes_every_number_of_axes_and_of_agents() {
        let look = Look { width: 300, rate: 25.0 };
        for dimensions in 1..=3 {
            for (frames, agents) in [(1, 1), (4, 0), (5, 12)] {
                for form in LIST.iter().filter(|form| form.id() != "mp4") {
                    let bytes = form.bytes(&recording(dimensions, frames, agents), &look).unwrap();
                    assert!(bytes.len() > 100, "{} {dimensions} {frames} {agents}", form.id());
                    let text = String::from_utf8_lossy(&bytes);
                    assert!(!["svg", "gltf"].contains(&form.id()) || !text.contains("NaN"), "{}", form.id());
                }
            }
        }
    }

    #[test]
    fn nothing_at_all_is_told() {
        let look = Look { width: 300, rate: 25.0 };
        for form in LIST {
            let error = form.bytes(&recording(2, 0, 0), &look).map(|_| ()).unwrap_err();
            assert!(error.to_string().contains("no frame"), "{}: {error}", form.id());
        }
    }
}
