//! Recordings read back from a page that plays them.

use super::{Border, Outline, Replay, Stage};
use flate2::read::DeflateDecoder;
use serde_json::Value as Json;
use std::io::Read;

/// Where the data of a page begins and ends.
const BEGINS: &str = "<script type=\"application/json\" id=\"figures\">";
const ENDS: &str = "</script>";
/// Bytes of a recording, at most, so that no page can ask for all memory.
const MOST: u64 = 2 << 30;

/// The recordings that a page plays, with the page's title.
///
/// # Errors
/// A page that is not of this program, or plays nothing, in a sentence.
pub fn replays(page: &str) -> Result<Vec<(String, Replay)>, String> {
    let other = "It is a page, but none that flockworks made";
    let (_, data) = page.split_once(BEGINS).ok_or(other)?;
    let (data, _) = data.split_once(ENDS).ok_or(other)?;
    let data: Json = serde_json::from_str(data).map_err(|_| other)?;
    let title = page.split_once("<title>").and_then(|(_, rest)| rest.split_once("</title>"));
    let title = title.map_or(String::new(), |(title, _)| plain(title));
    let list = data.get("replays").and_then(Json::as_array).cloned().unwrap_or_default();
    let read = |one: &Json| replay(one).map(|replay| (title.clone(), replay));
    let found: Option<Vec<(String, Replay)>> = list.iter().map(read).collect();
    match found {
        None => Err("The recording in the page is damaged".into()),
        Some(found) if found.is_empty() => {
            Err("The page plays nothing: it is of a search or of measurements, whose folder can be opened".into())
        }
        Some(found) => Ok(found),
    }
}

/// Text without what markup needs.
fn plain(text: &str) -> String {
    let pairs = [
        ("&lt;", "<"),
        ("&gt;", ">"),
        ("&quot;", "\""),
        ("&#39;", "'"),
        ("&#x27;", "'"),
        ("&#x2f;", "/"),
        ("&amp;", "&"),
    ];
    pairs.iter().fold(text.trim().to_owned(), |text, (written, meant)| text.replace(written, meant))
}

fn numbers(value: Option<&Json>) -> Option<Vec<f64>> {
    value?.as_array()?.iter().map(Json::as_f64).collect()
}

fn place(value: Option<&Json>) -> Option<[f64; 3]> {
    numbers(value)?.try_into().ok()
}

fn texts(value: Option<&Json>) -> Option<Vec<String>> {
    value?.as_array()?.iter().map(|text| text.as_str().map(str::to_owned)).collect()
}

fn stage(value: &Json) -> Option<Stage> {
    let edge = |text: &String| match text.as_str() {
        "wall" => Border::Wall,
        "seam" => Border::Seam,
        _ => Border::Open,
    };
    let edges: Vec<Border> = texts(value.get("edges"))?.iter().map(edge).collect();
    Some(Stage {
        dimensions: value.get("axes")?.as_u64().filter(|axes| (1..=3).contains(axes))? as usize,
        low: place(value.get("low"))?,
        high: place(value.get("high"))?,
        edges: edges.try_into().ok()?,
        unit: value.get("unit")?.as_str()?.to_owned(),
        groups: texts(value.get("groups"))?,
        radius: numbers(value.get("radius"))?,
    })
}

fn outline(value: &Json) -> Option<Outline> {
    if value.get("ball").is_some() {
        return Some(Outline::Ball { centre: place(value.get("ball"))?, radius: value.get("radius")?.as_f64()? });
    }
    let places = |key: &str| -> Option<Vec<[f64; 3]>> {
        value.get(key)?.as_array()?.iter().map(|corner| place(Some(corner))).collect()
    };
    if let Some([from, to]) = places("segment").as_deref() {
        return Some(Outline::Segment { from: *from, to: *to });
    }
    if let Some([low, high]) = places("cuboid").as_deref() {
        return Some(Outline::Cuboid { low: *low, high: *high });
    }
    places("polygon").map(Outline::Polygon)
}

fn replay(value: &Json) -> Option<Replay> {
    let stage = stage(value.get("stage")?)?;
    let (axes, times) = (stage.dimensions, numbers(value.get("times"))?);
    let mut group = Vec::new();
    for run in value.get("groups")?.as_array()? {
        let run = numbers(Some(run))?;
        let &[own, count] = run.as_slice() else { return None };
        if group.len() as f64 + count > 1e8 {
            return None;
        }
        group.resize(group.len() + count as usize, own as usize);
    }
    let bounds = value.get("bounds")?.as_array()?.iter().map(|ends| numbers(Some(ends)));
    let bounds: Vec<Vec<f64>> = bounds.collect::<Option<_>>()?;
    if bounds.len() != axes || bounds.iter().any(|ends| ends.len() != 2) {
        return None;
    }
    let (words, turns) = (axes * group.len(), group.len() * if axes == 3 { 2 } else { 1 });
    let each = 2 * words + turns;
    let packed = match value.get("squeezed").and_then(Json::as_str) {
        Some(text) => unsqueezed(&from_base64(text)?, value.get("order")?.as_u64()?, times.len(), (words, turns))?,
        None => from_base64(value.get("packed")?.as_str()?)?,
    };
    if packed.len() != times.len() * each {
        return None;
    }
    let (mut position, mut heading) = (Vec::new(), Vec::new());
    for frame in packed.chunks_exact(each.max(1)).take(times.len()) {
        let word = |axis: usize, agent: usize| {
            let at = 2 * (axis * group.len() + agent);
            u16::from_le_bytes([frame[at], frame[at + 1]])
        };
        let coordinate = |axis: usize, agent: usize| match (axis < axes, axis < axes && word(axis, agent) == u16::MAX) {
            (false, _) => 0.0,
            (true, true) => f32::NAN,
            (true, false) => {
                let (low, high) = (bounds[axis][0], bounds[axis][1]);
                (low + (high - low) * f64::from(word(axis, agent)) / f64::from(u16::MAX - 1)) as f32
            }
        };
        let way = |agent: usize| {
            let turn = frame[2 * words + agent];
            if turn == 255 {
                return [0.0; 3];
            }
            let angle = f64::from(turn) / 255.0 * core::f64::consts::TAU;
            let polar = if axes == 3 {
                f64::from(frame[2 * words + group.len() + agent]) / 254.0 * core::f64::consts::PI
            } else {
                core::f64::consts::FRAC_PI_2
            };
            let across = polar.sin();
            let up = if axes == 3 { polar.cos() } else { 0.0 };
            [(across * angle.cos()) as f32, (across * angle.sin()) as f32, up as f32]
        };
        position.push((0..group.len()).map(|agent| core::array::from_fn(|axis| coordinate(axis, agent))).collect());
        heading.push((0..group.len()).map(way).collect());
    }
    // frames of nobody have no bytes
    position.resize(times.len(), Vec::new());
    heading.resize(times.len(), Vec::new());
    let frames = value.get("obstacles")?.as_array()?.iter();
    let obstacles = frames.map(|frame| frame.as_array()?.iter().map(outline).collect::<Option<Vec<Outline>>>());
    Some(Replay {
        title: String::new(),
        about: String::new(),
        time_unit: value.get("timeUnit")?.as_str()?.to_owned(),
        stage,
        times,
        group,
        position,
        heading,
        obstacles: obstacles.collect::<Option<_>>()?,
    })
}

/// The bytes of a recording of which differences were kept; see `replay`.
fn unsqueezed(squeezed: &[u8], order: u64, frames: usize, (words, turns): (usize, usize)) -> Option<Vec<u8>> {
    let (count, each) = (frames * words, 2 * words + turns);
    let expected = frames as u64 * each as u64;
    let mut all = Vec::new();
    DeflateDecoder::new(squeezed).take(expected.min(MOST) + 1).read_to_end(&mut all).ok()?;
    if all.len() as u64 != expected {
        return None;
    }
    let mut back = vec![0u8; all.len()];
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
    Some(back)
}

/// Bytes of a text in the alphabet of RFC 4648, section 4.
fn from_base64(text: &str) -> Option<Vec<u8>> {
    let value = |letter: u8| {
        Some(match letter {
            b'A'..=b'Z' => letter - b'A',
            b'a'..=b'z' => letter - b'a' + 26,
            b'0'..=b'9' => letter - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => return None,
        })
    };
    let letters = text.trim_end_matches('=').as_bytes();
    let mut bytes = Vec::with_capacity(letters.len() * 3 / 4);
    for four in letters.chunks(4) {
        let mut word = 0u32;
        for place in 0..4 {
            word = word << 6 | u32::from(four.get(place).map_or(Some(0), |&letter| value(letter))?);
        }
        bytes.extend(&word.to_be_bytes()[1..four.len()]);
    }
    Some(bytes)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::report::{Figure, Page, html};

    fn recording(dimensions: usize, frames: usize, agents: usize) -> Replay {
        let angle = |frame: usize, agent: usize| (frame as f32 * 0.05) + agent as f32;
        let each = |of: &dyn Fn(usize, usize) -> [f32; 3]| -> Vec<Vec<[f32; 3]>> {
            (0..frames).map(|frame| (0..agents).map(|agent| of(frame, agent)).collect()).collect()
        };
        let flat = |v: [f32; 3]| core::array::from_fn(|a| if a < dimensions { v[a] } else { 0.0 });
        let mut position = each(&|frame, agent| {
            let angle = angle(frame, agent);
            flat([3.0 * angle.cos(), 40.0 * angle.sin(), 0.1 * angle])
        });
        position[1][0] = core::array::from_fn(|a| if a < dimensions { f32::NAN } else { 0.0 });
        Replay {
            title: String::new(),
            about: String::new(),
            stage: Stage {
                dimensions,
                low: [-3.0, -40.0, 0.0],
                high: [3.0, 40.0, 9.0],
                edges: [Border::Wall, Border::Seam, Border::Open],
                unit: "m".into(),
                groups: vec!["a".into(), "b <c>".into()],
                radius: vec![0.0, 0.5],
            },
            time_unit: "s".into(),
            times: (0..frames).map(|frame| frame as f64 * 0.5).collect(),
            group: (0..agents).map(|agent| agent % 2).collect(),
            position,
            heading: each(&|frame, agent| flat([-angle(frame, agent).sin(), angle(frame, agent).cos(), 0.0])),
            obstacles: vec![vec![
                Outline::Ball { centre: [1.0, 2.0, 0.0], radius: 0.5 },
                Outline::Segment { from: [0.0; 3], to: [1.0; 3] },
                Outline::Cuboid { low: [0.0; 3], high: [1.0; 3] },
                Outline::Polygon(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]),
            ]],
        }
    }

    #[test]
    fn what_a_page_plays_comes_back_within_what_was_rounded() {
        // long ones are squeezed
        for (dimensions, frames, agents) in [(1, 4, 3), (2, 6, 5), (3, 5, 4), (2, 3000, 220), (3, 2000, 200)] {
            let replay = recording(dimensions, frames, agents);
            let page =
                Page { title: "A & <B> 'c'".into(), figures: vec![Figure::Replay(replay.clone())], ..Page::default() };
            let found = replays(&html(&page)).unwrap();
            let (title, back) = &found[0];
            assert_eq!((title.as_str(), found.len()), ("A & <B> 'c'", 1));
            assert_eq!(
                (&back.stage, &back.times, &back.group, &back.obstacles),
                (&replay.stage, &replay.times, &replay.group, &replay.obstacles)
            );
            for (one, other) in back.position.iter().flatten().zip(replay.position.iter().flatten()) {
                let near = |a: usize| one[a].is_nan() && other[a].is_nan() || (one[a] - other[a]).abs() <= 1e-3;
                assert!((0..3).all(near), "{one:?} for {other:?}");
            }
            for (one, other) in back.heading.iter().flatten().zip(replay.heading.iter().flatten()) {
                let along: f32 = (0..3).map(|a| one[a] * other[a]).sum();
                assert!(dimensions == 1 || along > 0.999, "{one:?} for {other:?}");
            }
        }
    }

    #[test]
    fn other_pages_are_refused() {
        assert!(replays("<html><title>no</title>").unwrap_err().contains("none that flockworks made"));
        let bare = html(&Page::default());
        assert!(replays(&bare).unwrap_err().contains("plays nothing"));
        let page = html(&Page { figures: vec![Figure::Replay(recording(2, 6, 5))], ..Page::default() });
        let torn = page.replacen("\"packed\":\"", "\"packed\":\"AA", 1);
        assert!(torn != page && replays(&torn).unwrap_err().contains("damaged"));
        assert_eq!(from_base64("Zm9vYg=="), Some(b"foob".to_vec()));
        assert_eq!(from_base64("Zm9*"), None);
    }
}
