//! Chosen moments as static SVG: agents, where they came from, obstacles, food, walls and seams, a scale bar.

use super::escape::markup;
use super::number::{place, quantity};
use super::palette::SERIES;
use super::replay::{axes, extent};
use super::ticks::{ends, round_length};
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
/// Room for the scale bar below the views.
const BELOW: f64 = 24.0;
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
/// In the open, the window follows the agents where the stage is so many times as wide as they are.
const SPREAD: f64 = 2.5;
/// What stands around them is in the window where it then is at most so many times as wide as they are.
const AROUND: f64 = 3.0;
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

/// Ends by axis.
type Ends = [(f64, f64); 3];

/// The ends of points; none where there are no points.
fn around<'a>(points: impl Iterator<Item = &'a [f64; 3]>) -> Option<Ends> {
    points.filter(|point| finite(point)).map(|point| point.map(|value| (value, value))).reduce(joined)
}

fn joined(one: Ends, other: Ends) -> Ends {
    core::array::from_fn(|axis| (one[axis].0.min(other[axis].0), one[axis].1.max(other[axis].1)))
}

/// The longest side along axes without an end.
fn open_side(stage: &Stage, ends: &Ends) -> f64 {
    let open = (0..axes(stage)).filter(|&axis| stage.edges[axis] == Border::Open);
    open.map(|axis| ends[axis].1 - ends[axis].0).fold(0.0, f64::max)
}

/// The agents of a moment and how wide they are: at least half as wide as their trails, which are all there is to see of one
/// alone.
fn crowd(stage: &Stage, moment: &Moment) -> Option<(Ends, f64)> {
    let widest = stage.radius.iter().copied().filter(|radius| radius.is_finite()).fold(0.0, f64::max);
    let crowd = around(moment.agents.iter().map(|agent| &agent.position))?;
    let crowd = crowd.map(|(low, high)| (low - widest, high + widest));
    let trails =
        around(moment.agents.iter().flat_map(|agent| &agent.trail)).map_or(crowd, |trails| joined(crowd, trails));
    Some((crowd, open_side(stage, &crowd).max(open_side(stage, &trails) / 2.0)))
}

/// What a moment shows: the stage; in the open, where a group may travel far, its surroundings at that moment. Whoever is
/// beyond the stage is shown as well.
fn window(scenes: &Scenes, moment: &Moment) -> Ends {
    let (stage, whole) = (&scenes.stage, extent(&scenes.stage));
    let Some((crowd, side)) = crowd(stage, moment) else { return whole };
    // all moments of a figure or none, so that those that can be compared are drawn to one scale
    let travels = |(_, side): (Ends, f64)| side > 0.0 && side * SPREAD < open_side(stage, &whole);
    let follows = scenes.moments.iter().filter_map(|moment| self::crowd(stage, moment)).any(travels);
    let mut shown = if follows && side > 0.0 {
        let things = moment
            .obstacles
            .iter()
            .filter_map(reach)
            .chain(moment.items.iter().filter_map(|item| around([item].into_iter())));
        let near = things.filter(|thing| open_side(stage, &joined(crowd, *thing)) <= AROUND * side);
        near.fold(crowd, joined)
    } else {
        joined(whole, crowd)
    };
    for axis in 0..3 {
        let (low, high) = shown[axis];
        shown[axis] = if stage.edges[axis] != Border::Open || axis >= axes(stage) {
            (low.min(whole[axis].0), high.max(whole[axis].1))
        } else if high - low < side / 10.0 {
            // a group in single file is no reason to look at a single line
            ((low + high - side / 10.0) / 2.0, (low + high + side / 10.0) / 2.0)
        } else {
            (low, high)
        };
    }
    shown.map(|range| ends(Some(range), [range.0, range.1].into_iter()))
}

/// The ends of an obstacle; none of one that is not finite.
fn reach(outline: &Outline) -> Option<Ends> {
    match outline {
        Outline::Ball { centre, radius } => radius
            .is_finite()
            .then(|| around([centre].into_iter()))
            .flatten()
            .map(|ends| ends.map(|(low, high)| (low - radius.abs(), high + radius.abs()))),
        Outline::Segment { from, to } => around([from, to].into_iter()),
        Outline::Polygon(corners) => around(corners.iter()),
        Outline::Cuboid { low, high } => around([low, high].into_iter()),
    }
}

/// Where everything stands in a drawing.
struct Layout {
    views: Vec<View>,
    /// Units of the drawing per unit of length.
    scale: f64,
    /// What is shown.
    window: Ends,
    /// Where the stage ends.
    stage: Ends,
    /// Left end and base line of the scale bar.
    bar: (f64, f64),
    height: f64,
}

impl Layout {
    fn of(stage: &Stage, window: Ends) -> Self {
        let size = window.map(|(low, high)| high - low);
        let inside = WIDTH - 2.0 * ROOM;
        // a view that would be a hair line gets room on both sides
        let wide = |scale: f64, axis: usize| (size[axis] * scale).max(NARROWEST);
        let fitting = |length: f64, room: f64| (room / length).max(f64::MIN_POSITIVE);
        let (views, scale, left, bottom);
        match axes(stage) {
            1 => {
                scale = fitting(size[0], inside);
                views = vec![View { name: "", right: 0, up: None, left: ROOM, top: ROOM, width: inside, height: 64.0 }];
                (left, bottom) = (ROOM, ROOM + 64.0);
            }
            2 => {
                scale = fitting(size[0], inside).min(fitting(size[1], TALLEST));
                let (width, tall) = (wide(scale, 0), wide(scale, 1));
                left = (WIDTH - width) / 2.0;
                views = vec![View { name: "", right: 0, up: Some(1), left, top: ROOM, width, height: tall }];
                bottom = ROOM + tall;
            }
            _ => {
                // two columns and two rows; beside the widest there must be room for the narrowest and its name
                let beside = inside - 2.0 * ROOM - GAP;
                let pair = |one: usize, other: usize, room: f64, least: f64| {
                    let both = fitting(size[one] + size[other], room);
                    both.min(fitting(size[one].max(size[other]), room - least))
                };
                scale = pair(0, 1, beside, NAMED).min(pair(1, 2, TALLEST, NARROWEST));
                let [x, y, z] = [0, 1, 2].map(|axis| wide(scale, axis));
                let aside = (x + 2.0 * ROOM + GAP).max(NAMED);
                left = ((WIDTH - aside - y.max(NAMED)) / 2.0).max(ROOM);
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
                bottom = below + ROOM + z;
            }
        }
        let base = bottom + ROOM + 14.0;
        Self { views, scale, window, stage: extent(stage), bar: (left, base), height: bottom + BELOW + 7.0 }
    }
    /// A place in a view.
    fn at(&self, view: &View, position: &[f64; 3]) -> (f64, f64) {
        let middle = |axis: usize| (self.window[axis].0 + self.window[axis].1) / 2.0;
        let across = (position[view.right] - middle(view.right)) * self.scale;
        let up = view.up.map_or(0.0, |axis| (position[axis] - middle(axis)) * self.scale);
        (view.left + view.width / 2.0 + across, view.top + view.height / 2.0 - up)
    }
}

/// The drawing of a moment.
pub(super) fn scene(scenes: &Scenes, moment: &Moment) -> String {
    let stage = &scenes.stage;
    let layout = Layout::of(stage, window(scenes, moment));
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
    draw_edges(svg, stage, layout, view);
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
            if !finite(from) || !finite(to) || crosses_seam(stage, &layout.stage, from, to) {
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
fn crosses_seam(stage: &Stage, extent: &Ends, from: &[f64; 3], to: &[f64; 3]) -> bool {
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
fn draw_edges(svg: &mut String, stage: &Stage, layout: &Layout, view: &View) {
    let (low, high) = (layout.stage.map(|(low, _)| low), layout.stage.map(|(_, high)| high));
    let ((left, mut bottom), (right, mut top)) = (layout.at(view, &low), layout.at(view, &high));
    if view.up.is_none() {
        (top, bottom) = (view.top, view.top + view.height);
    }
    // along an axis without an end, lines go on to the end of the view
    let open = |axis: usize| stage.edges[axis] == Border::Open;
    let across = if open(view.right) { (view.left - ROOM, view.left + view.width + ROOM) } else { (left, right) };
    let upright =
        if view.up.is_some_and(open) { (view.top - ROOM, view.top + view.height + ROOM) } else { (top, bottom) };
    let [left, top, right, bottom] = [left, top, right, bottom].map(place);
    let [(west, east), (north, south)] = [across, upright].map(|(from, to)| (place(from), place(to)));
    let mut draw = |axis: usize, path: String| match stage.edges[axis] {
        Border::Wall => {
            let _ = write!(svg, "<path class=\"wall\" d=\"{path}\"/>");
        }
        Border::Seam => {
            let _ = write!(svg, "<path class=\"seam\" d=\"{path}\"/>");
        }
        Border::Open => {}
    };
    draw(view.right, format!("M{left} {north}V{south}M{right} {north}V{south}"));
    if let Some(up) = view.up {
        draw(up, format!("M{west} {top}H{east}M{west} {bottom}H{east}"));
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
        let layout = Layout::of(&stage(2), extent(&stage(2)));
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

    /// Middles of the agents in each view, with the rectangle of the view.
    fn middles(scenes: &Scenes, moment: &Moment) -> Vec<([f64; 2], [f64; 4])> {
        let layout = Layout::of(&scenes.stage, window(scenes, moment));
        let seen = |view: &View| {
            let rectangle = [view.left, view.top, view.left + view.width, view.top + view.height];
            moment.agents.iter().map(|agent| (layout.at(view, &agent.position).into(), rectangle)).collect::<Vec<_>>()
        };
        layout.views.iter().flat_map(seen).collect()
    }

    #[test]
    fn nobody_is_cut_away() {
        let shapes = [
            [20.0, 20.0, 20.0],
            [1.0, 2.0, 900.0],
            [900.0, 2.0, 1.0],
            [0.0, 900.0, 0.0],
            [3.0, 900.0, 900.0],
            [0.0; 3],
        ];
        let edges = [[Border::Open; 3], [Border::Wall; 3], [Border::Seam, Border::Open, Border::Wall]];
        for (size, edges) in shapes.into_iter().flat_map(|size| edges.map(|edges| (size, edges))) {
            for (dimensions, far) in [(2, 0.0), (3, 0.0), (2, 5e3), (3, 5e3)] {
                let corner = |bits: usize| {
                    core::array::from_fn(|axis| far + if bits >> axis & 1 > 0 { size[axis] } else { 0.0 })
                };
                let agents = (0..8).map(|bits| agent(corner(bits), [1.0, 0.0, 0.0], &[[0.0; 3]])).collect();
                let stage = Stage { high: [10.0; 3].map(|side| side + far), edges, ..stage(dimensions) };
                let moment = Moment { time: 0.0, agents, items: vec![], obstacles: vec![] };
                for ([x, y], [left, top, right, bottom]) in middles(&scenes(stage, moment.clone()), &moment) {
                    let within = x >= left - 1e-6 && x <= right + 1e-6 && y >= top - 1e-6 && y <= bottom + 1e-6;
                    assert!(within, "{size:?} {edges:?} {dimensions} {far}: {x} {y} of {left} {top} {right} {bottom}");
                    assert!(left >= 0.0 && right <= WIDTH + 1e-6, "{size:?} {edges:?} {dimensions}: {left} {right}");
                }
            }
        }
    }

    #[test]
    fn in_the_open_a_scene_shows_where_the_agents_are() {
        let flock = |at: f64| -> Vec<Seen> {
            (0..8)
                .map(|bits: i32| {
                    agent([0, 1, 2].map(|axis| at + f64::from(bits >> axis & 1) * 10.0), [1.0, 0.0, 0.0], &[])
                })
                .collect()
        };
        let near = Outline::Ball { centre: [995.0; 3], radius: 2.0 };
        let moments = [0.0, 1000.0].map(|at| Moment {
            time: at,
            agents: flock(at),
            items: vec![],
            obstacles: vec![near.clone(), Outline::Ball { centre: [5e4; 3], radius: 2.0 }],
        });
        let stage = Stage { high: [1010.0; 3], edges: [Border::Open; 3], ..stage(3) };
        let all = Scenes { moments: moments.to_vec(), ..scenes(stage.clone(), moments[0].clone()) };
        let shown = moments.each_ref().map(|moment| window(&all, moment)[2]);
        assert_eq!(shown[0], (-0.1, 10.1));
        assert_eq!(shown[1], (993.0, 1010.1), "an obstacle near by is seen, one far away is not");
        let walled = Scenes { stage: Stage { edges: [Border::Wall; 3], ..stage }, ..all };
        assert_eq!(window(&walled, &moments[1]), [(0.0, 1010.0 + 0.1); 3], "between walls the whole stage is");
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
