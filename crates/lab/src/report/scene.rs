//! Chosen moments as static SVG: agents, where they came from, obstacles, food, walls and seams, a scale bar.

use super::escape::markup;
use super::number::{place, quantity};
use super::palette::SERIES;
use super::replay::{axes, extent};
use super::ticks::round_length;
use super::{Border, Moment, Outline, Scenes, Seen, Stage};
use core::fmt::Write;

/// Width of a drawing; the page scales it to its column.
const WIDTH: f64 = 400.0;
/// Greatest height of the views together.
const TALLEST: f64 = 440.0;
/// Room around a view, for agents and lines at its edge.
const ROOM: f64 = 7.0;
/// Least height or width of a view.
const NARROWEST: f64 = 30.0;
/// Height of the line of words above a view in space.
const WORDS: f64 = 18.0;
/// Room for the name of a view.
const NAMED: f64 = 126.0;
/// Distance between views.
const GAP: f64 = 10.0;
/// Least half length of an agent.
const SMALLEST: f64 = 4.2;
/// Least half length where there are many agents.
const SMALLEST_AMONG_MANY: f64 = 2.6;
/// Many agents.
const MANY: usize = 800;
/// Steps in which a trail fades.
const FADES: usize = 5;
/// Names of the axes.
const AXES: [char; 3] = ['x', 'y', 'z'];

/// A view along one axis.
struct View {
    /// Its name; empty where there is one view alone.
    name: &'static str,
    /// The axis to the right and the axis upwards; a line has no second one.
    right: usize,
    up: Option<usize>,
    /// Its rectangle in the drawing.
    left: f64,
    top: f64,
    width: f64,
    height: f64,
}

/// Where everything stands in a drawing.
struct Layout {
    views: Vec<View>,
    /// Units of the drawing per unit of length.
    scale: f64,
    extent: [(f64, f64); 3],
    /// Left end and base line of the scale bar.
    bar: (f64, f64),
    height: f64,
}

impl Layout {
    fn of(stage: &Stage) -> Self {
        let extent = extent(stage);
        let size = extent.map(|(low, high)| high - low);
        let inside = WIDTH - 2.0 * ROOM;
        // a view that would be a hair line gets room on both sides
        let wide = |scale: f64, axis: usize| (size[axis] * scale).max(NARROWEST);
        let fitting = |length: f64, room: f64| (room / length).max(f64::MIN_POSITIVE);
        let (views, scale, bar, height);
        match axes(stage) {
            1 => {
                scale = fitting(size[0], inside);
                views = vec![View { name: "", right: 0, up: None, left: ROOM, top: ROOM, width: inside, height: 64.0 }];
                bar = (ROOM, 64.0 + 2.0 * ROOM + 14.0);
                height = bar.1 + 10.0;
            }
            2 => {
                scale = fitting(size[0], inside).min(fitting(size[1], TALLEST));
                let (width, tall) = (wide(scale, 0).min(inside), wide(scale, 1));
                let left = (WIDTH - width) / 2.0;
                views = vec![View { name: "", right: 0, up: Some(1), left, top: ROOM, width, height: tall }];
                bar = (left, tall + 2.0 * ROOM + 14.0);
                height = bar.1 + 10.0;
            }
            _ => {
                let beside = inside - 2.0 * ROOM - GAP;
                scale = fitting(size[0] + size[1], beside).min(fitting(size[1] + size[2], TALLEST));
                let [x, y, z] = [0, 1, 2].map(|axis| wide(scale, axis).min(beside));
                let aside = (x + 2.0 * ROOM + GAP).max(NAMED);
                let left = ((WIDTH - aside - y) / 2.0).max(ROOM);
                let (second, below) = (left + aside, WORDS + y + 2.0 * ROOM + WORDS + GAP);
                let view = |name, right, up, left, top, width, height| View {
                    name,
                    right,
                    up: Some(up),
                    left,
                    top,
                    width,
                    height,
                };
                views = vec![
                    view("above", 0, 1, left, WORDS + ROOM, x, y),
                    view("the front", 0, 2, left, below + ROOM, x, z),
                    view("the side", 1, 2, second, below + ROOM, y, z),
                ];
                bar = (second, WORDS + ROOM + y);
                height = below + z + 2.0 * ROOM + 2.0;
            }
        }
        Self { views, scale, extent, bar, height }
    }
    /// A place in a view.
    fn at(&self, view: &View, position: &[f64; 3]) -> (f64, f64) {
        let middle = |axis: usize| (self.extent[axis].0 + self.extent[axis].1) / 2.0;
        let across = (position[view.right] - middle(view.right)) * self.scale;
        let up = view.up.map_or(0.0, |axis| (position[axis] - middle(axis)) * self.scale);
        (view.left + view.width / 2.0 + across, view.top + view.height / 2.0 - up)
    }
}

/// The drawing of a moment.
pub(super) fn scene(scenes: &Scenes, moment: &Moment) -> String {
    let stage = &scenes.stage;
    let layout = Layout::of(stage);
    let mut svg = String::new();
    // writing to a string cannot fail, here and below
    let _ = write!(
        svg,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"scene\" viewBox=\"0 0 {WIDTH} {}\" role=\"img\" \
         aria-label=\"{}\">",
        place(layout.height),
        markup(&describe(scenes, moment))
    );
    for view in &layout.views {
        if !view.name.is_empty() {
            let up = view.up.map_or(' ', |axis| AXES[axis]);
            let _ = write!(
                svg,
                "<text class=\"view\" x=\"{}\" y=\"{}\">from {} <tspan class=\"axes\">{}\u{2009}\u{2192} {up}\u{2009}\u{2191}</tspan></text>",
                place(view.left),
                place(view.top - ROOM - 4.0),
                view.name,
                AXES[view.right]
            );
        }
        draw_view(&mut svg, stage, moment, &layout, view);
    }
    scale_bar(&mut svg, stage, &layout);
    svg.push_str("</svg>");
    svg
}

/// Where the agents of a moment are, as CSV.
pub(super) fn data(scenes: &Scenes, moment: &Moment) -> String {
    let mut csv = String::from("group,x,y,z,heading_x,heading_y,heading_z\n");
    for agent in moment.agents.iter().filter(|agent| finite(&agent.position)) {
        let name = scenes.stage.groups.get(agent.group).map_or("", String::as_str);
        // a position has as many digits as were recorded
        let numbers: Vec<String> =
            agent.position.iter().chain(&agent.heading).map(|&value| (value as f32).to_string()).collect();
        let _ = writeln!(csv, "\"{}\",{}", name.replace('"', "\"\""), numbers.join(","));
    }
    csv
}

/// What the drawing shows, in words.
fn describe(scenes: &Scenes, moment: &Moment) -> String {
    let views =
        if axes(&scenes.stage) == 3 { "seen from above, from the front and from the side" } else { "seen from above" };
    let groups: Vec<String> =
        counts(&scenes.stage, moment).iter().map(|(name, count)| format!("{count} {name}")).collect();
    format!(
        "Scene at t = {}, {views}: {}; {} obstacles, {} items of food",
        quantity(moment.time, &scenes.time_unit),
        if groups.is_empty() { "no agents".into() } else { groups.join(", ") },
        moment.obstacles.len(),
        moment.items.len()
    )
}

/// Members of each group at a moment.
fn counts(stage: &Stage, moment: &Moment) -> Vec<(String, usize)> {
    let count = |group: usize| moment.agents.iter().filter(|agent| agent.group == group).count();
    let name = |group: usize| stage.groups.get(group).cloned().unwrap_or_else(|| format!("group {}", group + 1));
    (0..groups(stage, moment)).map(|group| (name(group), count(group))).filter(|(_, count)| *count > 0).collect()
}

/// Number of groups, also of those without a name.
fn groups(stage: &Stage, moment: &Moment) -> usize {
    let members = moment.agents.iter().map(|agent| agent.group + 1).max().unwrap_or(0);
    // a group of this number has no colour of its own anyway
    stage.groups.len().max(members).min(10_000)
}

fn draw_view(svg: &mut String, stage: &Stage, moment: &Moment, layout: &Layout, view: &View) {
    let (left, top) = (view.left - ROOM, view.top - ROOM);
    let (width, height) = (view.width + 2.0 * ROOM, view.height + 2.0 * ROOM);
    let [left, top, width, height] = [left, top, width, height].map(place);
    // an inner drawing cuts off what lies outside
    let _ = write!(
        svg,
        "<svg x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" viewBox=\"{left} {top} {width} {height}\">\
         <rect class=\"floor\" x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\"/>"
    );
    if view.up.is_none() {
        let _ = write!(
            svg,
            "<path class=\"base\" d=\"M{} {}h{}\"/>",
            place(view.left),
            place(view.top + view.height / 2.0),
            place(view.width)
        );
    }
    for outline in &moment.obstacles {
        draw_outline(svg, outline, layout, view);
    }
    for item in moment.items.iter().filter(|item| finite(item)) {
        let (x, y) = layout.at(view, item);
        let _ = write!(svg, "<path class=\"item\" d=\"M{} {}l3.2 3.2l-3.2 3.2l-3.2-3.2z\"/>", place(x), place(y - 3.2));
    }
    for group in 0..groups(stage, moment) {
        let members = || moment.agents.iter().filter(|agent| agent.group == group && finite(&agent.position));
        draw_trails(svg, stage, group, members(), layout, view);
    }
    for group in 0..groups(stage, moment) {
        let members = moment.agents.iter().filter(|agent| agent.group == group && finite(&agent.position));
        let radius = stage.radius.get(group).copied().filter(|radius| radius.is_finite()).unwrap_or(0.0);
        let smallest = if moment.agents.len() > MANY { SMALLEST_AMONG_MANY } else { SMALLEST };
        let size = (radius * layout.scale).clamp(smallest, 60.0);
        let mut path = String::new();
        for agent in members {
            draw_agent(&mut path, agent, size, layout, view);
        }
        if !path.is_empty() {
            let _ = write!(svg, "<path class=\"agent s{}\" d=\"{path}\"/>", group % SERIES);
        }
    }
    draw_edges(svg, stage, view);
    svg.push_str("</svg>");
}

fn finite(position: &[f64; 3]) -> bool {
    position.iter().all(|value| value.is_finite())
}

/// An arrowhead along the heading, shorter where it points towards the reader; a disc at rest.
fn draw_agent(path: &mut String, agent: &Seen, size: f64, layout: &Layout, view: &View) {
    let (x, y) = layout.at(view, &agent.position);
    let (right, up) = (agent.heading[view.right], view.up.map_or(0.0, |axis| agent.heading[axis]));
    let seen = right.hypot(up);
    if !seen.is_finite() || seen < 0.2 {
        let radius = size * 0.6;
        let _ = write!(path, "M{} {}", place(x - radius), place(y));
        for way in [1.0, -1.0] {
            let _ = write!(path, "a{0} {0} 0 0 1 {1} 0", place(radius), place(2.0 * radius * way));
        }
        path.push('z');
        return;
    }
    let (along, length) = ((right / seen, -up / seen), size * seen.clamp(0.5, 1.0));
    // corners of the arrowhead: ahead and to the side, in lengths of half the agent
    let corners = [(1.0, 0.0), (-0.8, 0.68), (-0.4, 0.0), (-0.8, -0.68)];
    let mut command = 'M';
    for (ahead, aside) in corners {
        let (ahead, aside) = (ahead * length, aside * size);
        let corner = (x + ahead * along.0 - aside * along.1, y + ahead * along.1 + aside * along.0);
        let _ = write!(path, "{command}{} {}", place(corner.0), place(corner.1));
        command = 'L';
    }
    path.push('z');
}

/// The trails of a group, one path for each step of fading.
fn draw_trails<'a>(
    svg: &mut String,
    stage: &Stage,
    group: usize,
    members: impl Iterator<Item = &'a Seen>,
    layout: &Layout,
    view: &View,
) {
    let mut paths = vec![String::new(); FADES];
    for agent in members {
        let trail: Vec<&[f64; 3]> = agent.trail.iter().chain([&agent.position]).collect();
        let steps = trail.len() - 1;
        let mut pen = None;
        for (index, step) in trail.windows(2).enumerate() {
            let (from, to) = (step[0], step[1]);
            if !finite(from) || !finite(to) || crosses_seam(stage, &layout.extent, from, to) {
                pen = None;
                continue;
            }
            let fade = index * FADES / steps;
            let path = &mut paths[fade];
            if pen != Some(fade) {
                let (x, y) = layout.at(view, from);
                let _ = write!(path, "M{} {}", place(x), place(y));
            }
            let (x, y) = layout.at(view, to);
            let _ = write!(path, "L{} {}", place(x), place(y));
            pen = Some(fade);
        }
    }
    for (fade, path) in paths.iter().enumerate().filter(|(_, path)| !path.is_empty()) {
        let opacity = 0.1 + 0.5 * (fade as f64 + 1.0) / FADES as f64;
        let _ = write!(svg, "<path class=\"trail s{}\" opacity=\"{opacity:.2}\" d=\"{path}\"/>", group % SERIES);
    }
}

/// Whether a step went across a seam: more than half of an axis that closes on itself.
fn crosses_seam(stage: &Stage, extent: &[(f64, f64); 3], from: &[f64; 3], to: &[f64; 3]) -> bool {
    (0..axes(stage)).any(|axis| {
        let (low, high) = extent[axis];
        stage.edges[axis] == Border::Seam && (to[axis] - from[axis]).abs() > (high - low) / 2.0
    })
}

fn draw_outline(svg: &mut String, outline: &Outline, layout: &Layout, view: &View) {
    match outline {
        Outline::Ball { centre, radius } if finite(centre) && radius.is_finite() => {
            let (x, y) = layout.at(view, centre);
            let radius = (radius.abs() * layout.scale).max(1.0);
            let _ = write!(
                svg,
                "<circle class=\"obstacle\" cx=\"{}\" cy=\"{}\" r=\"{}\"/>",
                place(x),
                place(y),
                place(radius)
            );
        }
        Outline::Segment { from, to } if finite(from) && finite(to) => {
            let ((x, y), (u, v)) = (layout.at(view, from), layout.at(view, to));
            let _ = write!(svg, "<path class=\"wall\" d=\"M{} {}L{} {}\"/>", place(x), place(y), place(u), place(v));
        }
        Outline::Polygon(corners) if !corners.is_empty() && corners.iter().all(finite) => {
            let places: Vec<String> = corners
                .iter()
                .map(|corner| layout.at(view, corner))
                .map(|(x, y)| format!("{} {}", place(x), place(y)))
                .collect();
            let _ = write!(svg, "<path class=\"obstacle\" d=\"M{}z\"/>", places.join("L"));
        }
        Outline::Cuboid { low, high } if finite(low) && finite(high) => {
            let ((x, y), (u, v)) = (layout.at(view, low), layout.at(view, high));
            // a line has no height of its own
            let tall = if view.up.is_some() { (y - v).abs() } else { 16.0 };
            let _ = write!(
                svg,
                "<rect class=\"obstacle\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>",
                place(x.min(u)),
                place(if view.up.is_some() { y.min(v) } else { y - 8.0 }),
                place((u - x).abs().max(1.0)),
                place(tall.max(1.0))
            );
        }
        _ => {}
    }
}

/// The ends of both axes: walls solid, seams dashed.
fn draw_edges(svg: &mut String, stage: &Stage, view: &View) {
    let (right, bottom) = (view.left + view.width, view.top + view.height);
    let [left, top, right, bottom] = [view.left, view.top, right, bottom].map(place);
    let mut draw = |axis: usize, path: String| match stage.edges[axis] {
        Border::Wall => {
            let _ = write!(svg, "<path class=\"wall\" d=\"{path}\"/>");
        }
        Border::Seam => {
            let _ = write!(svg, "<path class=\"seam\" d=\"{path}\"/>");
        }
        Border::Open => {}
    };
    draw(view.right, format!("M{left} {top}V{bottom}M{right} {top}V{bottom}"));
    if let Some(up) = view.up {
        draw(up, format!("M{left} {top}H{right}M{left} {bottom}H{right}"));
    }
}

fn scale_bar(svg: &mut String, stage: &Stage, layout: &Layout) {
    let length = round_length(80.0 / layout.scale);
    let (left, base) = layout.bar;
    let wide = length * layout.scale;
    let _ = write!(
        svg,
        "<path class=\"bar\" d=\"M{} {}v6h{}v-6\"/><text class=\"tick\" x=\"{}\" y=\"{}\">{}</text>",
        place(left),
        place(base - 5.0),
        place(wide),
        place(left + wide + 7.0),
        place(base + 3.0),
        markup(&quantity(length, &stage.unit))
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stage(dimensions: usize) -> Stage {
        Stage {
            dimensions,
            low: [0.0; 3],
            high: [10.0, 10.0, 10.0],
            edges: [Border::Seam, Border::Wall, Border::Open],
            unit: "m".into(),
            groups: vec!["fish".into()],
            radius: vec![0.1],
        }
    }

    fn scenes(stage: Stage, moment: Moment) -> Scenes {
        Scenes { title: String::new(), about: String::new(), stage, time_unit: "s".into(), moments: vec![moment] }
    }

    fn agent(position: [f64; 3], heading: [f64; 3], trail: &[[f64; 3]]) -> Seen {
        Seen { group: 0, position, heading, trail: trail.to_vec() }
    }

    fn drawn(stage: Stage, agents: Vec<Seen>) -> String {
        let moment = Moment { time: 1.0, agents, items: vec![[1.0; 3]], obstacles: vec![] };
        scene(&scenes(stage, moment.clone()), &moment)
    }

    #[test]
    fn three_views_in_space_and_one_in_the_plane() {
        let views = [1, 2, 3].map(|dimensions| drawn(stage(dimensions), vec![]).matches("class=\"floor\"").count());
        assert_eq!(views, [1, 1, 3]);
    }

    #[test]
    fn a_trail_is_not_drawn_across_a_seam() {
        let seam = drawn(stage(2), vec![agent([0.5, 5.0, 0.0], [1.0, 0.0, 0.0], &[[9.0, 5.0, 0.0], [9.5, 5.0, 0.0]])]);
        let trails: String = seam.split("class=\"trail").skip(1).filter_map(|rest| rest.split('>').next()).collect();
        assert_eq!(trails.matches('M').count(), 1, "{trails}");
        let wall = drawn(stage(2), vec![agent([5.0, 0.5, 0.0], [1.0, 0.0, 0.0], &[[5.0, 9.5, 0.0]])]);
        assert!(wall.contains("class=\"trail"), "a long step between walls is a step");
    }

    #[test]
    fn an_arrowhead_points_along_the_heading_and_up_is_up() {
        let layout = Layout::of(&stage(2));
        let mut path = String::new();
        draw_agent(&mut path, &agent([5.0, 5.0, 0.0], [0.0, 1.0, 0.0], &[]), 10.0, &layout, &layout.views[0]);
        let (x, y) = layout.at(&layout.views[0], &[5.0, 5.0, 0.0]);
        assert!(path.starts_with(&format!("M{} {}", place(x), place(y - 10.0))), "{path}");
        let rest = drawn(stage(2), vec![agent([5.0; 3], [0.0; 3], &[])]);
        assert!(rest.contains("0 0 1"), "a disc at rest");
    }

    #[test]
    fn walls_are_solid_seams_dashed_and_open_axes_have_no_frame() {
        let svg = drawn(stage(2), vec![]);
        assert!(svg.contains("class=\"seam\"") && svg.contains("class=\"wall\""));
        let open = Stage { edges: [Border::Open; 3], ..stage(3) };
        let svg = drawn(open, vec![]);
        assert!(!svg.contains("class=\"seam\"") && !svg.contains("class=\"wall\""));
    }

    #[test]
    fn degenerate_scenes() {
        let nan = [f64::NAN; 3];
        let strange = Stage {
            low: nan,
            high: [f64::INFINITY; 3],
            dimensions: 0,
            radius: vec![f64::NAN],
            groups: vec![],
            ..stage(2)
        };
        let flat = Stage { low: [0.0; 3], high: [0.0; 3], ..stage(3) };
        let thin = Stage { low: [0.0; 3], high: [1e9, 1e-9, 1.0], ..stage(2) };
        let mut far = agent([1e300; 3], [1.0, 0.0, 0.0], &[[0.0; 3]]);
        far.group = 3;
        for stage in [strange, flat, thin] {
            for dimensions in 1..=3 {
                let stage = Stage { dimensions, ..stage.clone() };
                let moment = Moment {
                    time: f64::NAN,
                    agents: vec![agent(nan, nan, &[nan]), far.clone()],
                    items: vec![nan],
                    obstacles: vec![
                        Outline::Ball { centre: nan, radius: 1.0 },
                        Outline::Cuboid { low: [0.0; 3], high: [0.0; 3] },
                        Outline::Polygon(vec![]),
                    ],
                };
                let svg = scene(&scenes(stage, moment.clone()), &moment);
                assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
            }
        }
    }

    #[test]
    fn bytes_per_agent() {
        let agents =
            (0..1000).map(|i| agent([f64::from(i % 10), f64::from(i / 100), 0.0], [0.6, 0.8, 0.0], &[])).collect();
        assert!(drawn(stage(2), agents).len() < 70_000);
    }
}
