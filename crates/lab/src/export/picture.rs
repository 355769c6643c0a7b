//! A moment of a recording as marks on paper, from which drawings and pixels are made. Space is seen from a fixed side, without
//! perspective, so that lengths can be compared.

use crate::report::number::quantity;
use crate::report::palette::{SERIES, light};
use crate::report::replay::{axes, extent};
use crate::report::ticks::round_length;
use crate::report::{Border, Outline, Replay};

/// Red, green, blue.
pub(super) type Colour = [u8; 3];

/// Room around the stage.
const ROOM: f64 = 14.0;
/// Room below it, for scale, time and names.
const FOOT: f64 = 34.0;
/// Greatest height of the stage, in widths.
const TALLEST: f64 = 1.1;
/// Frames of a trail.
const TRAIL: usize = 12;
/// Radians by which space is turned about the vertical, and tilted.
const TURN: f64 = 0.5;
const TILT: f64 = 0.45;
/// Agents from which on they are drawn small.
const MANY: usize = 800;
/// Corners of an arrowhead: ahead and aside, in half lengths.
const ARROW: [[f64; 2]; 4] = [[1.0, 0.0], [-0.8, 0.68], [-0.4, 0.0], [-0.8, -0.68]];

/// Something that is drawn.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Mark {
    /// A filled shape by its corners.
    Fill { points: Vec<[f64; 2]>, colour: Colour },
    /// A line through points; `strength` is how much of what lies below it hides.
    Line { points: Vec<[f64; 2]>, width: f64, colour: Colour, strength: f64 },
    /// A disc.
    Disc { centre: [f64; 2], radius: f64, colour: Colour },
    /// Words; `at` is their left end on the base line, or their right end.
    Word { at: [f64; 2], text: String, right: bool, colour: Colour },
}

/// A picture.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Picture {
    /// Width and height, pixels; both even, as films need it.
    pub(super) wide: usize,
    pub(super) tall: usize,
    /// Colour of the paper.
    pub(super) ground: Colour,
    /// What is drawn, in this order.
    pub(super) marks: Vec<Mark>,
}

/// From the world to the paper.
struct View {
    space: bool,
    line: bool,
    middle: [f64; 3],
    scale: f64,
    /// Where the middle lies.
    at: [f64; 2],
}

impl View {
    fn of(replay: &Replay, width: f64) -> (Self, f64) {
        let stage = &replay.stage;
        let extent = extent(stage);
        let middle = extent.map(|(low, high)| (low + high) / 2.0);
        let (space, line) = (axes(stage) == 3, axes(stage) == 1);
        let bare = Self { space, line, middle, scale: 1.0, at: [0.0; 2] };
        let corner = |bits: usize| core::array::from_fn(|a| if bits >> a & 1 == 1 { extent[a].1 } else { extent[a].0 });
        let corners: Vec<[f64; 3]> = (0..8).map(|bits| bare.turned(&corner(bits))).collect();
        let reach = |axis: usize| corners.iter().map(|at| at[axis].abs()).fold(1e-12, f64::max);
        let inside = width - 2.0 * ROOM;
        let scale = (inside / (2.0 * reach(0))).min(TALLEST * inside / (2.0 * reach(1)));
        let tall = if line { 60.0 } else { 2.0 * reach(1) * scale + 2.0 * ROOM };
        (Self { scale, at: [width / 2.0, tall / 2.0], ..bare }, tall)
    }
    /// To the right, upwards and towards the reader.
    fn turned(&self, place: &[f64; 3]) -> [f64; 3] {
        let [x, y, z] = core::array::from_fn(|a| place[a] - self.middle[a]);
        if self.line {
            return [x, 0.0, 0.0];
        }
        if !self.space {
            return [x, y, 0.0];
        }
        let ((sin, cos), (up, along)) = (TURN.sin_cos(), TILT.sin_cos());
        let (right, away) = (x * cos - y * sin, x * sin + y * cos);
        [right, z * along + away * up, z * up - away * along]
    }
    /// A place on the paper, and how near it is.
    fn place(&self, place: &[f64; 3]) -> ([f64; 2], f64) {
        let [right, up, near] = self.turned(place);
        ([self.at[0] + right * self.scale, self.at[1] - up * self.scale], near)
    }
}

fn wide(place: [f32; 3]) -> [f64; 3] {
    place.map(f64::from)
}

fn finite(place: &[f64; 3]) -> bool {
    place.iter().all(|value| value.is_finite())
}

impl Picture {
    /// The picture of a frame.
    pub(super) fn of(replay: &Replay, frame: usize, width: f64) -> Self {
        let (view, tall) = View::of(replay, width);
        let even = |length: f64| (length / 2.0).round().max(1.0) as usize * 2;
        let mut marks = vec![Mark::Fill { points: floor(width, tall), colour: light("stage") }];
        marks.extend(edges(replay, &view));
        let standing = replay.obstacles.get(frame).or(replay.obstacles.first()).map_or(&[][..], Vec::as_slice);
        let mut things: Vec<(f64, Vec<Mark>)> = standing
            .iter()
            .flat_map(|outline| obstacle(outline, &view))
            .map(|(near, mark)| (near, vec![mark]))
            .collect();
        if !view.space {
            marks.extend(things.drain(..).flat_map(|(_, marks)| marks));
        }
        marks.extend(trails(replay, frame, &view));
        things.extend((0..replay.group.len()).filter_map(|agent| body(replay, frame, agent, &view)));
        if view.space {
            // what is far away is drawn first
            things.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        marks.extend(things.into_iter().flat_map(|(_, marks)| marks));
        marks.extend(margin(width, tall));
        marks.extend(words(replay, frame, &view, width, tall));
        Self { wide: even(width), tall: even(tall + FOOT), ground: light("ground"), marks }
    }
    /// The colours of its marks, in the order in which they first appear.
    pub(super) fn colours(&self) -> Vec<Colour> {
        let mut all = Vec::new();
        for mark in &self.marks {
            let (Mark::Fill { colour, .. }
            | Mark::Line { colour, .. }
            | Mark::Disc { colour, .. }
            | Mark::Word { colour, .. }) = mark;
            if !all.contains(colour) {
                all.push(*colour);
            }
        }
        all
    }
}

fn floor(width: f64, tall: f64) -> Vec<[f64; 2]> {
    let (near, far, low) = (ROOM / 2.0, width - ROOM / 2.0, tall - ROOM / 2.0);
    vec![[near, near], [far, near], [far, low], [near, low]]
}

/// Strips that hide what is drawn beyond the floor.
fn margin(width: f64, tall: f64) -> Vec<Mark> {
    let (ends, low) = (ROOM / 2.0, tall - ROOM / 2.0);
    let strip = |[left, top, right, bottom]: [f64; 4]| Mark::Fill {
        points: vec![[left, top], [right, top], [right, bottom], [left, bottom]],
        colour: light("ground"),
    };
    let far = 2.0 * width + tall;
    [
        [-far, -far, width + far, ends],
        [-far, low, width + far, tall + far],
        [-far, 0.0, ends, tall],
        [width - ends, 0.0, width + far, tall],
    ]
    .map(strip)
    .to_vec()
}

/// The ends of the axes: walls solid, seams dashed.
fn edges(replay: &Replay, view: &View) -> Vec<Mark> {
    let stage = &replay.stage;
    let (axes, extent) = (axes(stage), extent(stage));
    let corner = |bits: usize| -> [f64; 3] {
        core::array::from_fn(|a| if bits >> a & 1 == 1 { extent[a].1 } else { extent[a].0 })
    };
    let mut marks = Vec::new();
    for axis in 0..axes {
        for bits in (0..1usize << axes).filter(|bits| bits >> axis & 1 == 0) {
            // this edge runs along one axis and ends the others
            let others: Vec<Border> = (0..axes).filter(|&other| other != axis).map(|a| stage.edges[a]).collect();
            let (from, to) = (view.place(&corner(bits)).0, view.place(&corner(bits | 1 << axis)).0);
            if others.contains(&Border::Wall) {
                // edges of a space lie behind and before what is in it: they are thin
                let (width, colour) = if view.space { (1.0, light("faint")) } else { (2.0, light("text")) };
                marks.push(Mark::Line { points: vec![from, to], width, colour, strength: 1.0 });
            } else if others.contains(&Border::Seam) {
                marks.extend(dashes(from, to));
            }
        }
    }
    if axes == 1 {
        let ends = [view.place(&corner(0)).0, view.place(&corner(1)).0];
        let base = Mark::Line { points: ends.to_vec(), width: 1.0, colour: light("faint"), strength: 1.0 };
        marks.push(base);
    }
    marks
}

fn dashes(from: [f64; 2], to: [f64; 2]) -> Vec<Mark> {
    let length = (to[0] - from[0]).hypot(to[1] - from[1]);
    let count = (length / 10.0).round().max(1.0);
    let at = |share: f64| [from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])];
    let dash = |k: usize| Mark::Line {
        points: vec![at(k as f64 / count), at((k as f64 + 0.55) / count)],
        width: 1.4,
        colour: light("faint"),
        strength: 1.0,
    };
    (0..count as usize).map(dash).collect()
}

/// An obstacle as marks, each with how near it is.
fn obstacle(outline: &Outline, view: &View) -> Vec<(f64, Mark)> {
    let (fill, edge) = (light("obstacle"), light("faint"));
    let face = |corners: &[[f64; 3]], colour: Colour| {
        let seen: Vec<([f64; 2], f64)> = corners.iter().map(|corner| view.place(corner)).collect();
        let near = seen.iter().map(|(_, near)| near).sum::<f64>() / seen.len().max(1) as f64;
        let points: Vec<[f64; 2]> = seen.into_iter().map(|(point, _)| point).collect();
        let ring: Vec<[f64; 2]> = points.iter().chain(points.first()).copied().collect();
        let rim = Mark::Line { points: ring, width: 1.0, colour: edge, strength: 1.0 };
        vec![(near, Mark::Fill { points, colour }), (near, rim)]
    };
    match outline {
        Outline::Ball { centre, radius } if finite(centre) && radius.is_finite() => {
            let (at, near) = view.place(centre);
            let radius = (radius.abs() * view.scale).max(1.0);
            let disc = |radius: f64, colour| (near, Mark::Disc { centre: at, radius, colour });
            vec![disc(radius, edge), disc((radius - 1.0).max(0.5), fill)]
        }
        Outline::Segment { from, to } if finite(from) && finite(to) => {
            let ((a, near), (b, other)) = (view.place(from), view.place(to));
            let line = Mark::Line { points: vec![a, b], width: 2.0, colour: light("text"), strength: 1.0 };
            vec![((near + other) / 2.0, line)]
        }
        Outline::Polygon(corners) if corners.len() > 2 && corners.iter().all(finite) => face(corners, fill),
        Outline::Cuboid { low, high } if finite(low) && finite(high) => {
            let at = |bits: usize| core::array::from_fn(|a| if bits >> a & 1 == 1 { high[a] } else { low[a] });
            if !view.space {
                return face(&[0, 1, 3, 2].map(at), fill);
            }
            let faces = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
            faces.iter().flat_map(|corners| face(&corners.map(at), fill)).collect()
        }
        _ => Vec::new(),
    }
}

fn series(group: usize) -> Colour {
    light(["series-0", "series-1", "series-2", "series-3", "series-4", "series-5", "series-6"][group % SERIES])
}

/// Where members have come from, the fainter the longer ago.
fn trails(replay: &Replay, frame: usize, view: &View) -> Vec<Mark> {
    let extent = extent(&replay.stage);
    let crosses = |from: &[f64; 3], to: &[f64; 3]| {
        (0..axes(&replay.stage)).any(|a| {
            let size = extent[a].1 - extent[a].0;
            replay.stage.edges[a] == Border::Seam && (to[a] - from[a]).abs() > size / 2.0
        })
    };
    let first = frame.saturating_sub(TRAIL);
    let mut marks = Vec::new();
    for (agent, &group) in replay.group.iter().enumerate() {
        for at in first..frame {
            let (from, to) = (wide(replay.position[at][agent]), wide(replay.position[at + 1][agent]));
            if finite(&from) && finite(&to) && !crosses(&from, &to) {
                let points = vec![view.place(&from).0, view.place(&to).0];
                let strength = 0.1 + 0.4 * (at - first + 1) as f64 / TRAIL as f64;
                marks.push(Mark::Line { points, width: 1.2, colour: series(group), strength });
            }
        }
    }
    marks
}

/// An agent: an arrowhead along its heading, a disc at rest or where it heads towards the reader.
fn body(replay: &Replay, frame: usize, agent: usize, view: &View) -> Option<(f64, Vec<Mark>)> {
    let place = wide(*replay.position[frame].get(agent)?);
    if !finite(&place) {
        return None;
    }
    let (at, near) = view.place(&place);
    let group = replay.group[agent];
    let smallest = if replay.group.len() > MANY { 2.6 } else { 4.6 };
    let radius = replay.stage.radius.get(group).copied().filter(|radius| radius.is_finite()).unwrap_or(0.0);
    let half = (radius * view.scale).clamp(smallest, 80.0);
    let heading = replay.heading[frame].get(agent).map_or([0.0; 3], |&heading| wide(heading));
    let ahead: [f64; 3] = core::array::from_fn(|a| view.middle[a] + heading[a]);
    let [right, up, _] = view.turned(&ahead);
    let seen = right.hypot(up);
    let colour = series(group);
    if !seen.is_finite() || seen < 0.2 {
        return Some((near, vec![Mark::Disc { centre: at, radius: half * 0.6, colour }]));
    }
    let (along, length) = ([right / seen, -up / seen], half * seen.clamp(0.5, 1.0));
    let points = ARROW.map(|[forth, aside]| {
        let (forth, aside) = (forth * length, aside * half);
        [at[0] + forth * along[0] - aside * along[1], at[1] + forth * along[1] + aside * along[0]]
    });
    Some((near, vec![Mark::Fill { points: points.to_vec(), colour }]))
}

/// Scale, names of the groups, time.
fn words(replay: &Replay, frame: usize, view: &View, width: f64, tall: f64) -> Vec<Mark> {
    let base = tall + 14.0;
    let length = round_length(0.22 * width / view.scale);
    let long = length * view.scale;
    let word = |x: f64, text: String, right: bool| Mark::Word { at: [x, base], text, right, colour: light("text") };
    let bar = [[ROOM, base - 8.0], [ROOM, base], [ROOM + long, base], [ROOM + long, base - 8.0]];
    let bar = Mark::Line { points: bar.to_vec(), width: 1.4, colour: light("text"), strength: 1.0 };
    let mut marks = vec![bar, word(ROOM + long + 8.0, quantity(length, &replay.stage.unit), false)];
    let time = replay.times.get(frame).copied().unwrap_or(0.0);
    let time = format!("t = {}", quantity(time, &replay.time_unit));
    marks.push(word(width - ROOM, time, true));
    let groups = &replay.stage.groups;
    let room = (width * 0.3 / groups.len().max(1) as f64 / 12.0) as usize;
    if groups.len() > 1 && room > 2 {
        for (group, name) in groups.iter().enumerate() {
            let x = width * (0.42 + 0.3 * group as f64 / groups.len() as f64);
            let colour = series(group);
            marks.push(Mark::Disc { centre: [x, base - 6.0], radius: 5.0, colour });
            marks.push(word(x + 9.0, name.chars().take(room).collect(), false));
        }
    }
    marks
}

#[cfg(test)]
mod tests {
    use super::super::tests::recording;
    use super::*;

    #[test]
    fn every_agent_that_is_there_is_drawn_once() {
        for dimensions in 1..=3 {
            let all = recording(dimensions, 5, 10);
            let there = |frame: usize| {
                let picture = Picture::of(&all.replay, frame, 400.0);
                let of_groups = [series(0), series(1)];
                let body = |mark: &&Mark| match mark {
                    Mark::Fill { colour, .. } => of_groups.contains(colour),
                    // the discs of the names are as large as this
                    Mark::Disc { colour, radius, .. } => of_groups.contains(colour) && *radius != 5.0,
                    _ => false,
                };
                picture.marks.iter().filter(body).count()
            };
            // agent 1 is missing in every third frame
            assert_eq!([there(0), there(1)], [9, 10], "{dimensions}");
        }
    }

    #[test]
    fn up_is_up_and_sizes_are_even() {
        let all = recording(2, 2, 3);
        let (view, _) = View::of(&all.replay, 401.0);
        let at = |y: f64| view.place(&[5.0, y, 0.0]).0[1];
        assert!(at(9.0) < at(1.0));
        let picture = Picture::of(&all.replay, 0, 401.0);
        assert!(picture.wide.is_multiple_of(2) && picture.tall.is_multiple_of(2));
        let (view, _) = View::of(&recording(3, 2, 3).replay, 400.0);
        assert!(view.place(&[5.0, 5.0, 9.0]).0[1] < view.place(&[5.0, 5.0, 1.0]).0[1]);
    }
}
