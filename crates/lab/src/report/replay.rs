//! Recordings, packed for the player of the page.
//!
//! Positions are 16-bit numbers over the bounds of the data, axis by axis; headings are one byte in the plane (the
//! angle) and two in space (azimuth and polar angle). Everything is little-endian and written in base64. A frame
//! holds, one after the other: for each axis the positions of all agents, then the headings of all agents (in space:
//! all azimuths, then all polar angles).
//!
//! A long recording is squeezed on top of that: of every number only its difference from what the frames before it lead to
//! expect, all high bytes before all low bytes, by the deflate method. A short one is not, so that every browser plays it.

use super::{Border, Outline, Replay, Stage};
use flate2::Compression;
use flate2::write::DeflateEncoder;
use serde_json::{Value, json};
use std::io::Write;

/// The largest number of a position; the one above says that the agent is not there.
const MOST: u16 = u16::MAX - 1;
/// The position of an agent that is not there.
const ABSENT: u16 = u16::MAX;
/// Directions of a heading in the plane, and the byte that says that there is none.
const DIRECTIONS: u8 = 255;
/// Steps of the polar angle from pole to pole.
const POLAR: f64 = 254.0;
/// Bytes from which on a recording is squeezed.
const LONG: usize = 3_000_000;

/// The recording as data for the player.
pub(super) fn data(replay: &Replay) -> Value {
    let frames = replay.times.len().min(replay.position.len());
    let axes = axes(&replay.stage);
    let bounds = bounds(replay, frames, axes);
    let mut packed = Vec::new();
    for frame in 0..frames {
        let no_headings = Vec::new();
        let headings = replay.heading.get(frame).unwrap_or(&no_headings);
        pack(&mut packed, &replay.position[frame], headings, replay.group.len(), &bounds);
    }
    // obstacles that move have an entry each frame
    let shown = if replay.obstacles.len() > 1 { frames } else { 1 };
    let obstacles: Vec<Value> =
        replay.obstacles.iter().take(shown).map(|frame| frame.iter().filter_map(outline).collect()).collect();
    let mut data = json!({
        "stage": stage(&replay.stage),
        "timeUnit": replay.time_unit,
        "times": replay.times[..frames].iter().map(|&time| if time.is_finite() { time } else { 0.0 }).collect::<Vec<_>>(),
        "groups": runs(&replay.group),
        "bounds": bounds,
        "obstacles": obstacles,
    });
    match (packed.len() >= LONG).then(|| squeezed(&packed, frames, axes, replay.group.len())).flatten() {
        Some((order, squeezed)) => {
            data["order"] = json!(order);
            data["squeezed"] = json!(base64(&squeezed));
        }
        None => data["packed"] = json!(base64(&packed)),
    }
    data
}

/// A packed recording, squeezed, and from how many frames before it a position is foretold; none where the machine refuses.
fn squeezed(packed: &[u8], frames: usize, axes: usize, agents: usize) -> Option<(usize, Vec<u8>)> {
    let (words, turns) = (axes * agents, agents * if axes == 3 { 2 } else { 1 });
    let each = 2 * words + turns;
    let word = |frame: usize, k: usize| {
        let at = frame * each + 2 * k;
        u16::from_le_bytes([packed[at], packed[at + 1]])
    };
    let differences = |order: usize| {
        let before = |frame: usize, k: usize, back: usize| if frame >= back { word(frame - back, k) } else { 0 };
        let one = move |frame: usize, k: usize| {
            let foretold = match order {
                2 if frame >= 2 => before(frame, k, 1).wrapping_mul(2).wrapping_sub(before(frame, k, 2)),
                _ => before(frame, k, 1),
            };
            let difference = word(frame, k).wrapping_sub(foretold) as i16;
            // small ones are small numbers, whatever their sign
            ((difference << 1) ^ (difference >> 15)) as u16
        };
        (0..frames).flat_map(move |frame| (0..words).map(move |k| one(frame, k))).collect::<Vec<u16>>()
    };
    let sizes = |list: &[u16]| list.iter().map(|&one| u64::from(one)).sum::<u64>();
    let (steady, straight) = (differences(1), differences(2));
    let (order, list) = if sizes(&straight) < sizes(&steady) { (2, straight) } else { (1, steady) };
    let mut bytes: Vec<u8> = list.iter().map(|one| (one >> 8) as u8).collect();
    bytes.extend(list.iter().map(|&one| one as u8));
    for frame in 0..frames {
        let turn = |frame: usize, k: usize| packed[frame * each + 2 * words + k];
        let before = |k: usize| if frame > 0 { turn(frame - 1, k) } else { 0 };
        bytes.extend((0..turns).map(|k| turn(frame, k).wrapping_sub(before(k))));
    }
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(&bytes).ok()?;
    Some((order, encoder.finish().ok()?))
}

/// Number of axes of a stage: 1, 2 or 3 whatever it says.
pub(crate) fn axes(stage: &Stage) -> usize {
    stage.dimensions.clamp(1, 3)
}

/// Ends of what a stage shows, by axis: finite and apart.
pub(crate) fn extent(stage: &Stage) -> [(f64, f64); 3] {
    core::array::from_fn(|axis| {
        super::ticks::ends(Some((stage.low[axis], stage.high[axis])), [stage.low[axis], stage.high[axis]].into_iter())
    })
}

fn stage(stage: &Stage) -> Value {
    let edge = |border: &Border| match border {
        Border::Wall => "wall",
        Border::Seam => "seam",
        Border::Open => "open",
    };
    let extent = extent(stage);
    let radius: Vec<f64> =
        stage.radius.iter().map(|&radius| if radius.is_finite() { radius.max(0.0) } else { 0.0 }).collect();
    json!({
        "axes": axes(stage),
        "low": extent.map(|(low, _)| low),
        "high": extent.map(|(_, high)| high),
        "edges": stage.edges.each_ref().map(edge),
        "unit": stage.unit,
        "groups": stage.groups,
        "radius": radius,
    })
}

/// An outline as data; none where a number is not finite.
fn outline(outline: &Outline) -> Option<Value> {
    let finite = |place: &[f64; 3]| place.iter().all(|value| value.is_finite());
    match outline {
        Outline::Ball { centre, radius } => {
            (finite(centre) && radius.is_finite()).then(|| json!({"ball": centre, "radius": radius.abs()}))
        }
        Outline::Segment { from, to } => (finite(from) && finite(to)).then(|| json!({"segment": [from, to]})),
        Outline::Polygon(corners) => {
            (!corners.is_empty() && corners.iter().all(finite)).then(|| json!({"polygon": corners}))
        }
        Outline::Cuboid { low, high } => (finite(low) && finite(high)).then(|| json!({"cuboid": [low, high]})),
    }
}

/// Least and greatest position on each axis.
fn bounds(replay: &Replay, frames: usize, axes: usize) -> Vec<(f64, f64)> {
    let seen = |axis: usize| {
        let all = replay.position[..frames].iter().flatten();
        let values = all
            .filter(|place| place[..axes].iter().all(|value| value.is_finite()))
            .map(move |place| f64::from(place[axis]));
        let (low, high) =
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        if low <= high { (low, high) } else { (0.0, 0.0) }
    };
    (0..axes).map(seen).collect()
}

/// Appends a frame.
fn pack(to: &mut Vec<u8>, positions: &[[f32; 3]], headings: &[[f32; 3]], agents: usize, bounds: &[(f64, f64)]) {
    let there =
        |agent: usize| positions.get(agent).filter(|place| place[..bounds.len()].iter().all(|value| value.is_finite()));
    for (axis, &bounds) in bounds.iter().enumerate() {
        for agent in 0..agents {
            let packed = there(agent).map_or(ABSENT, |place| quantised(f64::from(place[axis]), bounds));
            to.extend(packed.to_le_bytes());
        }
    }
    let heading = |agent: usize| headings.get(agent).copied().unwrap_or([0.0; 3]).map(f64::from);
    to.extend((0..agents).map(|agent| azimuth(heading(agent))));
    if bounds.len() == 3 {
        to.extend((0..agents).map(|agent| polar(heading(agent))));
    }
}

/// A position as a share of the bounds, in 65534 steps.
fn quantised(value: f64, (low, high): (f64, f64)) -> u16 {
    let extent = high - low;
    if extent > 0.0 { ((value - low) / extent * f64::from(MOST)).round() as u16 } else { 0 }
}

/// The angle in the plane of the first two axes, in 255ths of a turn; 255 for no heading.
fn azimuth(heading: [f64; 3]) -> u8 {
    let [x, y, z] = heading;
    if !(x.is_finite() && y.is_finite() && z.is_finite()) || (x == 0.0 && y == 0.0 && z == 0.0) {
        return DIRECTIONS;
    }
    let turns = y.atan2(x) / core::f64::consts::TAU;
    ((turns.rem_euclid(1.0) * f64::from(DIRECTIONS)).round() as u32 % u32::from(DIRECTIONS)) as u8
}

/// The angle from the third axis, in 254ths of half a turn.
fn polar([x, y, z]: [f64; 3]) -> u8 {
    let angle = x.hypot(y).atan2(z);
    if angle.is_finite() { (angle / core::f64::consts::PI * POLAR).round() as u8 } else { 0 }
}

/// Groups of the agents as runs: `[group, members]`.
fn runs(group: &[usize]) -> Vec<[usize; 2]> {
    group.chunk_by(|one, next| one == next).filter_map(|run| Some([*run.first()?, run.len()])).collect()
}

/// Bytes as text, in the alphabet of RFC 4648, section 4, with padding.
fn base64(bytes: &[u8]) -> String {
    const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let byte = |at: usize| u32::from(chunk.get(at).copied().unwrap_or(0));
        let word = byte(0) << 16 | byte(1) << 8 | byte(2);
        for place in 0..4 {
            let letter = ALPHABET[(word >> (18 - 6 * place) & 63) as usize];
            text.push(if place <= chunk.len() { letter as char } else { '=' });
        }
    }
    text
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic, reason = "tests")]
mod tests {
    use super::*;

    fn unpacked(text: &str) -> Vec<u8> {
        let value = |letter: u8| match letter {
            b'A'..=b'Z' => letter - b'A',
            b'a'..=b'z' => letter - b'a' + 26,
            b'0'..=b'9' => letter - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => 0,
        };
        let padding = text.bytes().rev().take_while(|&letter| letter == b'=').count();
        let mut bytes = Vec::new();
        for four in text.as_bytes().chunks(4) {
            let word = four.iter().fold(0u32, |word, &letter| word << 6 | u32::from(value(letter)));
            bytes.extend([(word >> 16) as u8, (word >> 8) as u8, word as u8]);
        }
        bytes.truncate(bytes.len() - padding);
        bytes
    }

    fn recording(dimensions: usize, frames: usize, agents: usize) -> Replay {
        let turn = |frame: usize, agent: usize| (frame * 31 + agent * 7) as f32 * 0.1;
        let place =
            |frame, agent| [3.0 * turn(frame, agent).sin(), 500.0 * turn(frame, agent).cos(), turn(frame, agent)];
        let each = |of: &dyn Fn(usize, usize) -> [f32; 3]| -> Vec<Vec<[f32; 3]>> {
            (0..frames).map(|frame| (0..agents).map(|agent| of(frame, agent)).collect()).collect()
        };
        Replay {
            title: String::new(),
            about: String::new(),
            stage: Stage {
                dimensions,
                low: [0.0; 3],
                high: [1.0; 3],
                edges: [Border::Open; 3],
                unit: "m".into(),
                groups: vec!["a".into()],
                radius: vec![0.0],
            },
            time_unit: "s".into(),
            times: (0..frames).map(|frame| frame as f64).collect(),
            group: vec![0; agents],
            position: each(&place),
            heading: each(&|frame, agent| [turn(frame, agent).cos(), turn(frame, agent).sin(), 0.0]),
            obstacles: vec![],
        }
    }

    #[test]
    fn known_texts_of_base64() {
        let cases =
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foob", "Zm9vYg=="), ("foobar", "Zm9vYmFy")];
        for (bytes, text) in cases {
            assert_eq!(base64(bytes.as_bytes()), text);
            assert_eq!(unpacked(text), bytes.as_bytes());
        }
        assert_eq!(base64(&[255, 254, 253]), "//79");
    }

    #[test]
    fn positions_come_back_within_half_a_step() {
        for dimensions in 1..=3 {
            let (frames, agents) = (5, 11);
            let replay = recording(dimensions, frames, agents);
            let data = data(&replay);
            let bytes = unpacked(data["packed"].as_str().unwrap());
            let per_agent = 2 * dimensions + if dimensions == 3 { 2 } else { 1 };
            assert_eq!(bytes.len(), frames * agents * per_agent);
            for frame in 0..frames {
                for axis in 0..dimensions {
                    let (low, high) =
                        (data["bounds"][axis][0].as_f64().unwrap(), data["bounds"][axis][1].as_f64().unwrap());
                    let step = (high - low) / f64::from(MOST);
                    for agent in 0..agents {
                        let at = frame * agents * per_agent + 2 * (axis * agents + agent);
                        let read = low + f64::from(u16::from_le_bytes([bytes[at], bytes[at + 1]])) * step;
                        let error = (read - f64::from(replay.position[frame][agent][axis])).abs();
                        assert!(error <= step * (0.5 + 1e-9), "{dimensions} {frame} {axis} {agent}: {error}");
                    }
                }
            }
        }
    }

    #[test]
    fn what_was_squeezed_comes_back_byte_by_byte() {
        for dimensions in 1..=3 {
            let (frames, agents) = (20, 7);
            let mut replay = recording(dimensions, frames, agents);
            replay.position[3][2] = [f32::NAN; 3];
            let packed = unpacked(data(&replay)["packed"].as_str().unwrap());
            let (order, squeezed) = squeezed(&packed, frames, dimensions, agents).unwrap();
            let mut all = Vec::new();
            std::io::Read::read_to_end(&mut flate2::read::DeflateDecoder::new(&squeezed[..]), &mut all).unwrap();
            // as the page does it
            let (words, turns) = (dimensions * agents, agents * if dimensions == 3 { 2 } else { 1 });
            let (count, each) = (frames * words, 2 * words + turns);
            let mut back = vec![0u8; frames * each];
            let word = |back: &[u8], frame: usize, k: usize| {
                let at = frame * each + 2 * k;
                u16::from_le_bytes([back[at], back[at + 1]])
            };
            for frame in 0..frames {
                for k in 0..words {
                    let coded = u16::from_le_bytes([all[count + frame * words + k], all[frame * words + k]]);
                    let difference = (coded >> 1) ^ 0u16.wrapping_sub(coded & 1);
                    let before = |by: usize| if frame >= by { word(&back, frame - by, k) } else { 0 };
                    let foretold = match order {
                        2 if frame >= 2 => before(1).wrapping_mul(2).wrapping_sub(before(2)),
                        _ => before(1),
                    };
                    let at = frame * each + 2 * k;
                    back[at..at + 2].copy_from_slice(&foretold.wrapping_add(difference).to_le_bytes());
                }
                for k in 0..turns {
                    let before = if frame > 0 { back[(frame - 1) * each + 2 * words + k] } else { 0 };
                    back[frame * each + 2 * words + k] = before.wrapping_add(all[2 * count + frame * turns + k]);
                }
            }
            assert!(back == packed, "{dimensions}");
        }
    }

    #[test]
    fn headings_come_back_within_half_a_step() {
        for index in 0..1000 {
            let angle = f64::from(index) * 0.00721;
            let read = f64::from(azimuth([angle.cos(), angle.sin(), 0.0])) / 255.0 * core::f64::consts::TAU;
            assert!((read - angle).cos() > (0.5001 * core::f64::consts::TAU / 255.0).cos(), "{angle}");
        }
        assert_eq!(azimuth([0.0; 3]), 255);
        assert_eq!(azimuth([f64::NAN, 0.0, 0.0]), 255);
        assert_eq!([polar([0.0, 0.0, 1.0]), polar([1.0, 0.0, 0.0]), polar([0.0, 0.0, -1.0])], [0, 127, 254]);
        assert_ne!(azimuth([0.0, 0.0, 1.0]), 255, "straight up is a heading");
    }

    #[test]
    fn who_is_not_there_is_marked_and_does_not_move_the_bounds() {
        let mut replay = recording(2, 1, 3);
        replay.position[0] = vec![[1.0, 2.0, 0.0], [f32::NAN, 1e9, 0.0]];
        let data = data(&replay);
        assert_eq!(data["bounds"], json!([[1.0, 1.0], [2.0, 2.0]]));
        let bytes = unpacked(data["packed"].as_str().unwrap());
        assert_eq!(&bytes[..6], [0, 0, 255, 255, 255, 255]);
    }

    #[test]
    fn bytes_per_agent_and_frame() {
        for (dimensions, most) in [(2, 6.8), (3, 10.8)] {
            let (frames, agents) = (50, 100);
            let text = data(&recording(dimensions, frames, agents))["packed"].as_str().unwrap().len();
            assert!(text as f64 / (frames * agents) as f64 <= most);
        }
    }

    #[test]
    fn degenerate_recordings() {
        let mut nothing = recording(2, 0, 0);
        assert_eq!(data(&nothing)["packed"], "");
        nothing.times = vec![f64::NAN];
        nothing.position = vec![vec![]];
        nothing.stage.low = [f64::NAN; 3];
        nothing.stage.high = [f64::INFINITY; 3];
        nothing.stage.dimensions = 9;
        nothing.obstacles = vec![vec![Outline::Polygon(vec![]), Outline::Ball { centre: [f64::NAN; 3], radius: 1.0 }]];
        let data = data(&nothing);
        assert_eq!(data["stage"]["axes"], 3);
        assert_eq!(data["times"], json!([0.0]));
        assert_eq!(data["obstacles"], json!([[]]));
        assert!(data["stage"]["low"][0].as_f64().unwrap() < data["stage"]["high"][0].as_f64().unwrap());
        assert_eq!(runs(&[0, 0, 2, 1, 1]), [[0, 2], [2, 1], [1, 2]]);
    }
}
