//! A recording as a scene in space, glTF 2.0 in one binary file: programs for three-dimensional scenes open it.
//!
//! Each agent is a node with a track of places and of turns. glTF has y upwards, so that everything stands below one node
//! that is turned by a quarter.

use super::{Form, Look, Most, Recording};
use crate::report::palette::{SERIES, light};
use crate::report::replay::{axes, extent};
use crate::report::{Border, Outline, Replay};
use crate::store::StoreError;
use core::f32::consts::{FRAC_1_SQRT_2, PI, TAU};
use serde_json::{Value as Json, json};

/// Kinds of numbers and of lines, as glTF numbers them.
const FLOAT: u32 = 5126;
const WHOLE: u32 = 5125;
const LINES: u32 = 1;
const TRIANGLES: u32 = 4;
/// Corners around a cone or a sphere.
const AROUND: u32 = 12;

/// A scene in space.
pub(super) struct Gltf;

impl Form for Gltf {
    fn id(&self) -> &'static str {
        "gltf"
    }
    fn ending(&self) -> &'static str {
        "glb"
    }
    fn about(&self) -> &'static str {
        "a moving scene in space for programs that open glTF, in one binary file"
    }
    fn most(&self) -> Most {
        Most { frames: 600, positions: 200_000 }
    }
    fn bytes(&self, recording: &Recording, look: &Look) -> Result<Vec<u8>, StoreError> {
        recording.needs_frames()?;
        Ok(Scene::of(&recording.replay, look.rate).whole(&recording.title, &recording.made_by))
    }
}

/// A scene while it is made.
#[derive(Default)]
struct Scene {
    binary: Vec<u8>,
    views: Vec<Json>,
    accessors: Vec<Json>,
    meshes: Vec<Json>,
    materials: Vec<Json>,
    nodes: Vec<Json>,
    samplers: Vec<Json>,
    channels: Vec<Json>,
}

/// Corners and triangles (or lines) of a mesh.
type Shape = (Vec<[f32; 3]>, Vec<u32>);

impl Scene {
    fn of(replay: &Replay, rate: f64) -> Self {
        let mut scene = Self::default();
        let extent = extent(&replay.stage);
        let largest = (0..axes(&replay.stage)).map(|a| extent[a].1 - extent[a].0).fold(1e-9, f64::max);
        // node 0 is the one that everything stands below
        scene.nodes.push(Json::Null);
        let (wall, stone) = (scene.material("text"), scene.material("obstacle"));
        let corners: Vec<[f32; 3]> = (0..8usize)
            .map(|bits| core::array::from_fn(|a| if bits >> a & 1 == 1 { extent[a].1 } else { extent[a].0 } as f32))
            .collect();
        if replay.stage.edges.iter().take(axes(&replay.stage)).any(|&edge| edge != Border::Open) {
            let ends = (0..3u32).flat_map(|axis| {
                (0..8u32).filter(move |bits| bits >> axis & 1 == 0).flat_map(move |bits| [bits, bits | 1 << axis])
            });
            let mesh = scene.mesh(&(corners, ends.collect()), LINES, wall);
            scene.nodes.push(json!({ "name": "space", "mesh": mesh }));
        }
        // what is flat stands up a little, so that it is seen
        let height = if axes(&replay.stage) == 3 { 0.0 } else { 0.03 * largest };
        for outline in replay.obstacles.first().into_iter().flatten() {
            if let Some(shape) = obstacle(outline, height as f32) {
                let mesh = scene.mesh(&shape, TRIANGLES, stone);
                scene.nodes.push(json!({ "name": "obstacle", "mesh": mesh }));
            }
        }
        let mut meshes = Vec::new();
        for group in 0..replay.stage.groups.len().max(1) {
            let radius = replay.stage.radius.get(group).copied().unwrap_or(0.0);
            let material = scene.material(&format!("series-{}", group % SERIES));
            let size = radius.max(0.008 * largest) as f32;
            meshes.push(scene.mesh(&cone(size), TRIANGLES, material));
        }
        scene.agents(replay, rate, &meshes);
        scene
    }
    fn agents(&mut self, replay: &Replay, rate: f64, meshes: &[usize]) {
        let times: Vec<f32> = (0..replay.times.len()).map(|frame| (frame as f64 / rate) as f32).collect();
        let moves = times.len() > 1;
        let ends = json!({ "min": [0.0], "max": [times.last()] });
        let input = if moves { self.numbers(&times, "SCALAR", ends) } else { 0 };
        // from one side of a seam to the other nobody goes through the middle
        let seam = replay.stage.edges.contains(&Border::Seam);
        let between = if seam { "STEP" } else { "LINEAR" };
        for (agent, &group) in replay.group.iter().enumerate() {
            let frames = 0..replay.times.len();
            let mut places: Vec<[f32; 3]> = Vec::new();
            let mut turns: Vec<[f32; 4]> = Vec::new();
            let mut sizes: Vec<[f32; 3]> = Vec::new();
            for frame in frames {
                let place = replay.position[frame].get(agent).copied().filter(|p| p.iter().all(|v| v.is_finite()));
                sizes.push([if place.is_some() { 1.0 } else { 0.0 }; 3]);
                places.push(place.or(places.last().copied()).unwrap_or([0.0; 3]));
                let heading = replay.heading[frame].get(agent).copied().unwrap_or([0.0; 3]);
                turns.push(turn(heading).or(turns.last().copied()).unwrap_or([0.0, 0.0, 0.0, 1.0]));
            }
            let node = self.nodes.len();
            let mesh = meshes.get(group).or(meshes.first());
            self.nodes.push(json!({
                "name": format!("agent {agent}"), "mesh": mesh,
                "translation": places.first(), "rotation": turns.first(), "scale": sizes.first(),
            }));
            if !moves {
                continue;
            }
            let missing = sizes.contains(&[0.0; 3]);
            self.channel(node, "translation", input, &places.concat(), "VEC3", between);
            self.channel(node, "rotation", input, &turns.concat(), "VEC4", between);
            if missing {
                self.channel(node, "scale", input, &sizes.concat(), "VEC3", "STEP");
            }
        }
    }
    fn channel(&mut self, node: usize, path: &str, input: usize, values: &[f32], kind: &str, between: &str) {
        let output = self.numbers(values, kind, json!({}));
        self.channels.push(json!({ "sampler": self.samplers.len(), "target": { "node": node, "path": path } }));
        self.samplers.push(json!({ "input": input, "output": output, "interpolation": between }));
    }
    fn material(&mut self, name: &str) -> usize {
        // glTF's colours are of light, those of the palette of a screen
        let linear = light(name).map(|part| (f64::from(part) / 255.0).powf(2.2));
        let colour = [linear[0], linear[1], linear[2], 1.0];
        self.materials.push(json!({
            "name": name, "doubleSided": true,
            "pbrMetallicRoughness": { "baseColorFactor": colour, "metallicFactor": 0.0, "roughnessFactor": 0.8 },
        }));
        self.materials.len() - 1
    }
    fn mesh(&mut self, (corners, order): &Shape, mode: u32, material: usize) -> usize {
        let ends = |of: fn(f32, f32) -> f32| -> Vec<f32> {
            (0..3).map(|a| corners.iter().map(|corner| corner[a]).reduce(of).unwrap_or(0.0)).collect()
        };
        let (low, high) = (ends(f32::min), ends(f32::max));
        let places = self.numbers(&corners.concat(), "VEC3", json!({ "min": low, "max": high }));
        let bytes: Vec<u8> = order.iter().flat_map(|corner| corner.to_le_bytes()).collect();
        let order = self.accessor(&bytes, WHOLE, order.len(), "SCALAR", json!({}));
        self.meshes.push(json!({ "primitives": [
            { "attributes": { "POSITION": places }, "indices": order, "mode": mode, "material": material }
        ] }));
        self.meshes.len() - 1
    }
    fn numbers(&mut self, values: &[f32], kind: &str, more: Json) -> usize {
        let each = match kind {
            "SCALAR" => 1,
            "VEC3" => 3,
            _ => 4,
        };
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.accessor(&bytes, FLOAT, values.len() / each, kind, more)
    }
    fn accessor(&mut self, bytes: &[u8], numbers: u32, count: usize, kind: &str, more: Json) -> usize {
        let from = self.binary.len();
        self.binary.extend(bytes);
        self.views.push(json!({ "buffer": 0, "byteOffset": from, "byteLength": bytes.len() }));
        let mut accessor =
            json!({ "bufferView": self.views.len() - 1, "componentType": numbers, "count": count, "type": kind });
        if let (Json::Object(accessor), Json::Object(more)) = (&mut accessor, more) {
            accessor.extend(more);
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
    /// The file: a head, the scene as JSON, the numbers.
    fn whole(mut self, title: &str, made_by: &str) -> Vec<u8> {
        let children: Vec<usize> = (1..self.nodes.len()).collect();
        let upright = [-FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2];
        self.nodes[0] = json!({ "name": title, "rotation": upright });
        if !children.is_empty() {
            self.nodes[0]["children"] = json!(children);
        }
        let mut scene = json!({
            "asset": { "version": "2.0", "generator": made_by },
            "scene": 0,
            "scenes": [{ "name": title, "nodes": [0] }],
            "nodes": self.nodes,
            "materials": self.materials,
            "meshes": self.meshes,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{ "byteLength": self.binary.len() }],
        });
        if !self.channels.is_empty() {
            scene["animations"] = json!([{ "channels": self.channels, "samplers": self.samplers }]);
        }
        let mut text = scene.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut numbers = self.binary;
        numbers.resize(numbers.len().next_multiple_of(4), 0);
        let length = 12 + 8 + text.len() + 8 + numbers.len();
        let mut file = Vec::with_capacity(length);
        file.extend(b"glTF");
        file.extend(2u32.to_le_bytes());
        file.extend((length as u32).to_le_bytes());
        for (kind, part) in [(b"JSON", &text), (b"BIN\0", &numbers)] {
            file.extend((part.len() as u32).to_le_bytes());
            file.extend(kind);
            file.extend(part);
        }
        file
    }
}

/// The turn from along x to along a heading; none at rest.
fn turn([x, y, z]: [f32; 3]) -> Option<[f32; 4]> {
    if !(x.is_finite() && y.is_finite() && z.is_finite()) || (x == 0.0 && y == 0.0 && z == 0.0) {
        return None;
    }
    let turn = [0.0, -z, y, 1.0 + x];
    let length = turn.iter().map(|part| part * part).sum::<f32>().sqrt();
    // straight back: half a turn about the vertical
    Some(if length < 1e-3 { [0.0, 0.0, 1.0, 0.0] } else { turn.map(|part| part / length) })
}

/// A cone along x.
fn cone(size: f32) -> Shape {
    let mut corners = vec![[size, 0.0, 0.0], [-0.7 * size, 0.0, 0.0]];
    let mut order = Vec::new();
    for k in 0..AROUND {
        let (sin, cos) = (TAU * k as f32 / AROUND as f32).sin_cos();
        corners.push([-0.8 * size, 0.5 * size * cos, 0.5 * size * sin]);
        let next = (k + 1) % AROUND;
        order.extend([0, 2 + k, 2 + next, 1, 2 + next, 2 + k]);
    }
    (corners, order)
}

/// An obstacle; what is flat has this height.
fn obstacle(outline: &Outline, height: f32) -> Option<Shape> {
    let narrow = |place: &[f64; 3]| place.map(|value| value as f32);
    let finite = |place: &[f64; 3]| place.iter().all(|value| value.is_finite());
    match outline {
        Outline::Ball { centre, radius } if finite(centre) && radius.is_finite() => {
            let (centre, radius) = (narrow(centre), *radius as f32);
            let rings = AROUND / 2;
            let (mut corners, mut order) = (Vec::new(), Vec::new());
            for ring in 0..=rings {
                let (down, out) = (PI * ring as f32 / rings as f32).sin_cos();
                for k in 0..AROUND {
                    let (sin, cos) = (TAU * k as f32 / AROUND as f32).sin_cos();
                    let way = [down * cos, down * sin, out];
                    corners.push(core::array::from_fn(|a| centre[a] + radius * way[a]));
                    let (here, next) = (ring * AROUND + k, ring * AROUND + (k + 1) % AROUND);
                    if ring < rings {
                        order.extend([here, here + AROUND, next, next, here + AROUND, next + AROUND]);
                    }
                }
            }
            Some((corners, order))
        }
        Outline::Segment { from, to } if finite(from) && finite(to) => {
            let (a, b) = (narrow(from), narrow(to));
            let top = |place: [f32; 3]| [place[0], place[1], place[2] + height];
            Some((vec![a, b, top(b), top(a)], vec![0, 1, 2, 0, 2, 3]))
        }
        Outline::Polygon(corners) if corners.len() > 2 && corners.iter().all(finite) => {
            let fan = (1..corners.len() as u32 - 1).flat_map(|k| [0, k, k + 1]);
            Some((corners.iter().map(narrow).collect(), fan.collect()))
        }
        Outline::Cuboid { low, high } if finite(low) && finite(high) => {
            let (low, mut high) = (narrow(low), narrow(high));
            high[2] = high[2].max(low[2] + height);
            let at = |bits: usize| core::array::from_fn(|a| if bits >> a & 1 == 1 { high[a] } else { low[a] });
            let faces = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
            let order = faces.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]);
            Some(((0..8).map(at).collect(), order.collect()))
        }
        _ => None,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::super::tests::recording;
    use super::*;

    #[test]
    fn the_file_is_as_its_head_says_and_all_numbers_are_inside() {
        let bytes = Gltf.bytes(&recording(3, 6, 5), &Look { width: 100, rate: 10.0 }).unwrap();
        let word = |at: usize| u32::from_le_bytes(core::array::from_fn(|k| bytes[at + k])) as usize;
        assert_eq!((&bytes[..4], word(4), word(8)), (&b"glTF"[..], 2, bytes.len()));
        let text = word(12);
        assert_eq!((&bytes[16..20], text % 4), (&b"JSON"[..], 0));
        let scene: Json = serde_json::from_slice(&bytes[20..20 + text]).unwrap();
        let length = scene["buffers"][0]["byteLength"].as_u64().unwrap() as usize;
        assert_eq!(&bytes[24 + text..28 + text], b"BIN\0");
        assert!(word(20 + text) >= length);
        let parts = |kind: &str| match kind {
            "SCALAR" => 1,
            "VEC3" => 3,
            _ => 4,
        };
        for accessor in scene["accessors"].as_array().unwrap() {
            let view = &scene["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
            let size = 4 * accessor["count"].as_u64().unwrap() * parts(accessor["type"].as_str().unwrap());
            assert_eq!(view["byteLength"], size);
            assert!(view["byteOffset"].as_u64().unwrap() + size <= length as u64);
        }
        let agents = scene["nodes"]
            .as_array()
            .unwrap()
            .iter()
            .filter(|node| node["name"].as_str().is_some_and(|name| name.starts_with("agent")));
        assert_eq!(agents.count(), 5);
        // two tracks each, and one of sizes for the agent that is missing at times
        assert_eq!(scene["animations"][0]["channels"].as_array().unwrap().len(), 11);
    }

    #[test]
    fn turns_turn_x_to_the_heading() {
        for heading in [[0.6, 0.8, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [-0.48, 0.6, 0.64]] {
            let [x, y, z, w] = turn(heading).unwrap();
            // the first column of the rotation
            let turned = [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)];
            for a in 0..3 {
                assert!((turned[a] - heading[a]).abs() < 1e-5, "{heading:?}: {turned:?}");
            }
        }
        assert_eq!(turn([0.0; 3]), None);
    }
}
