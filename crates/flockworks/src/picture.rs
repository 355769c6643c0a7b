//! A typical run of a model as a small drawing: ways from the start, and everyone's arrow at the end.
//!
//! Most models show what they do from random places in a box of open space. A model that needs more (a goal, walls, a looser
//! start) has a scene: a scenario in `scenes/`, named after the model, and a line in the list of them below.

use crate::bench::{fitting_side, start};
use crate::fault::{Fault, wrong};
use crate::workloads::Running;
use lab::scenario::build;
use space::Edge;
use space::shape::Shape;
use std::fmt::Write as _;
use swarm::WorldPlan;
use swarm::models::Entry;
use swarm::parameters::{Kind, Parameter as _, Points};

/// Members that are drawn.
const MEMBERS: usize = 30;
/// Most steps of a run.
const STEPS: usize = 1500;
/// A run ends when members have gone so far on average, in sides of the box in which they began.
const WAY: f64 = 1.2;
/// Points of a way.
const POINTS: usize = 14;
/// Width and height of the drawing, and the room around what is drawn, in pixels.
const SIZE: f64 = 320.0;
const ROOM: f64 = 14.0;
/// Half an arrow's length, in pixels.
const ARROW: f64 = 5.0;
/// What is seen where there is no scene, and how to read it.
const USUAL: &str = "Thirty members with default parameters, from random places in a box";
const READING: &str = "lines are their ways, arrows where they are at the end";

macro_rules! scenes {
    ($($model:literal)*) => {
        /// The scenes: models with the scenarios that show them.
        const SCENES: &[(&str, &str)] = &[$(($model, include_str!(concat!("scenes/", $model, ".toml")))),*];
    };
}

scenes! {
    "abm_flocking"
    "arkin_balch_1999"
    "boids_plus"
    "boids_rule_vectors"
    "boids_unit_heading"
    "composed"
    "contact_only"
    "control_snn"
    "dorsogna_2006"
    "hamilton_2d"
    "helbing_2005"
    "katz_herbert_read_2011"
    "levine_2000"
    "olfati_saber_2006"
    "reynolds_opensteer"
    "shimoyama_1996"
    "snn_plus"
    "tanner_2003_dynamic"
    "viscido_snn"
}

/// Places and velocities of all members at one moment, in the plane.
type Moment = Vec<([f64; 2], [f64; 2])>;

/// What stands around the members.
enum Mark {
    Wall(Vec<[f64; 2]>),
    Solid(Vec<[f64; 2]>),
    Disc([f64; 2], f64),
    Goal([f64; 2]),
}

impl Mark {
    /// Places that the drawing has to hold.
    fn places(&self) -> Vec<[f64; 2]> {
        match self {
            Self::Wall(corners) | Self::Solid(corners) => corners.clone(),
            Self::Disc([x, y], r) => vec![[x - r, y - r], [x + r, y + r]],
            Self::Goal(place) => vec![*place],
        }
    }
}

/// A run, ready to be drawn.
struct Course {
    about: String,
    marks: Vec<Mark>,
    moments: Vec<Moment>,
    /// Height of the drawing of a run on a line, where time goes down.
    line: Option<f64>,
}

/// The drawing, as SVG: the same bytes on every machine. Its description says what is seen.
///
/// # Errors
/// A model that cannot be started.
pub fn typical_run(entry: &'static Entry) -> Result<String, Fault> {
    let id = entry.card.id;
    let course = match SCENES.iter().find(|(model, _)| *model == id) {
        Some((_, text)) => in_a_scene(id, text)?,
        None => in_a_box(entry)?,
    };
    let Course { about, marks, moments, line } = course;
    let last = moments.len() - 1;
    let place = |step: usize, member: usize| {
        let [x, y] = moments[step][member].0;
        line.map_or([x, y], |side| [x, -(step as f64) / last.max(1) as f64 * side])
    };
    let shown = |member: usize| (0..POINTS).map(|k| place(k * last / (POINTS - 1), member)).collect();
    let ways: Vec<Vec<[f64; 2]>> = (0..moments[last].len()).map(shown).collect();
    Ok(drawn(id, &about, &marks, &ways, &moments[last], line.unwrap_or(f64::INFINITY)))
}

/// Thirty members from random places in a box, until they have gone some way.
fn in_a_box(entry: &'static Entry) -> Result<Course, Fault> {
    let dimension = if entry.dimensions.contains(&2) { 2 } else { entry.dimensions[0] };
    let build = |side: f64| match dimension {
        1 => start::<f64, 1>(entry, MEMBERS, side, 1),
        2 => start::<f64, 2>(entry, MEMBERS, side, 1),
        _ => start::<f64, 3>(entry, MEMBERS, side, 1),
    };
    let side = fitting_side(MEMBERS, dimension, &build)?;
    let mut world = build(side)?;
    let mut moments = vec![moment(&*world)];
    let mut way = 0.0;
    while moments.len() <= STEPS && way < WAY * side {
        world.run(1);
        let now = moment(&*world);
        if let Some(before) = moments.last() {
            way += before.iter().zip(&now).map(|(a, b)| length(a.0, b.0)).sum::<f64>() / MEMBERS as f64;
        }
        moments.push(now);
    }
    let line = (dimension == 1).then_some(side);
    let time = if line.is_some() { "; time goes down" } else { "" };
    Ok(Course { about: format!("{USUAL}{time}; {READING}."), marks: Vec::new(), moments, line })
}

/// The run of a scenario in the plane, with its walls, obstacles and goals.
fn in_a_scene(id: &str, text: &str) -> Result<Course, Fault> {
    let read = build::read(id, text, &[]).map_err(|problems| Fault::Shown(problems.to_string()))?;
    let schedule = build::schedule(&read.scenario, false).or_else(|problem| wrong(problem.what))?;
    let seed = read.scenario.seed.unwrap_or(1);
    let plan = build::plan::<f64, 2>(&read.scenario, seed, 1).or_else(|problems| {
        wrong(problems.iter().map(|problem| problem.what.as_str()).collect::<Vec<_>>().join("; "))
    })?;
    let marks = marks(&plan);
    let mut world = swarm::World::new(plan).or_else(|error| wrong(error.to_string()))?;
    let mut moments = vec![moment(&world)];
    for _ in 0..schedule.steps {
        Running::run(&mut world, 1);
        moments.push(moment(&world));
    }
    Ok(Course { about: format!("{}; {READING}.", read.scenario.title), marks, moments, line: None })
}

/// Walls, obstacles and goals of a plan.
fn marks(plan: &WorldPlan<f64, 2>) -> Vec<Mark> {
    let mut marks = Vec::new();
    if let [Edge::Walls(width), Edge::Walls(height)] = plan.space.edges {
        marks.push(Mark::Wall(vec![[0.0, 0.0], [width, 0.0], [width, height], [0.0, height], [0.0, 0.0]]));
    }
    marks.extend(plan.obstacles.iter().filter_map(|obstacle| match &obstacle.shape {
        Shape::Ball { centre, radius } => Some(Mark::Disc(centre.0, *radius)),
        Shape::Segment { from, to } => Some(Mark::Wall(vec![from.0, to.0])),
        Shape::Polygon { vertices } => Some(Mark::Solid(vertices.iter().map(|corner| corner.0).collect())),
        Shape::Cuboid { low: a, high: b } => Some(Mark::Solid(vec![a.0, [b.0[0], a.0[1]], b.0, [a.0[0], b.0[1]]])),
        Shape::Plane { .. } => None,
    }));
    for group in &plan.groups {
        let descriptors = swarm::models::find(&group.model).map_or_else(Vec::new, |entry| (entry.parameters)());
        // places, and not the velocities of what moves
        for goal in descriptors.iter().filter(|goal| goal.takes == Kind::Points && !goal.unit.contains('/')) {
            let places = group.parameters.get(goal.name).and_then(Points::<f64>::read);
            let places = places.into_iter().flat_map(|points| points.0);
            marks.extend(places.filter_map(|place| <[f64; 2]>::try_from(place).ok()).map(Mark::Goal));
        }
    }
    marks
}

fn moment(world: &dyn Running) -> Moment {
    let (positions, velocities) = world.motion();
    let plane = |v: &Vec<f64>| [v.first().copied().unwrap_or(0.0), v.get(1).copied().unwrap_or(0.0)];
    positions.iter().zip(&velocities).map(|(x, v)| (plane(x), plane(v))).collect()
}

fn length(a: [f64; 2], b: [f64; 2]) -> f64 {
    ((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1])).sqrt()
}

/// Ways through these places, broken where one goes round a ring, by a step of more than `jump`.
fn drawn(id: &str, about: &str, marks: &[Mark], ways: &[Vec<[f64; 2]>], end: &Moment, jump: f64) -> String {
    let all: Vec<[f64; 2]> = ways.iter().flatten().copied().chain(marks.iter().flat_map(Mark::places)).collect();
    let bound = |a: usize| {
        let least = all.iter().map(|p| p[a]).fold(f64::INFINITY, f64::min);
        let greatest = all.iter().map(|p| p[a]).fold(f64::NEG_INFINITY, f64::max);
        ((least + greatest) / 2.0, greatest - least)
    };
    let ([middle_x, middle_y], spans) = ([bound(0).0, bound(1).0], [bound(0).1, bound(1).1]);
    let scale = (SIZE - 2.0 * ROOM) / spans[0].max(spans[1]).max(1e-9);
    let at = |p: [f64; 2]| [SIZE / 2.0 + (p[0] - middle_x) * scale, SIZE / 2.0 - (p[1] - middle_y) * scale];
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {SIZE} {SIZE}\" width=\"{SIZE}\" height=\"{SIZE}\" role=\"img\">\
         <title>A typical run of {id}</title><desc>{about}</desc><rect width=\"{SIZE}\" height=\"{SIZE}\" fill=\"#fff\"/>"
    );
    let through = |places: &[[f64; 2]]| {
        let places = places.iter().map(|&place| at(place)).map(|[x, y]| format!("{x:.1} {y:.1}"));
        format!("M{}", places.collect::<Vec<_>>().join("L"))
    };
    for mark in marks {
        let _ = match mark {
            Mark::Wall(corners) => {
                write!(svg, "<path d=\"{}\" fill=\"none\" stroke=\"#555\" stroke-width=\"2\"/>", through(corners))
            }
            Mark::Solid(corners) => write!(svg, "<path d=\"{}Z\" fill=\"#999\"/>", through(corners)),
            Mark::Disc(centre, radius) => {
                let ([x, y], r) = (at(*centre), radius * scale);
                write!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{r:.1}\" fill=\"#999\"/>")
            }
            Mark::Goal(place) => {
                let [x, y] = at(*place);
                write!(svg, "<path d=\"M{:.1} {y:.1}h12m-6 -6v12\" stroke=\"#b8442a\" stroke-width=\"2\"/>", x - 6.0)
            }
        };
    }
    let mut path = String::new();
    for way in ways {
        for (k, &place) in way.iter().enumerate() {
            let [x, y] = at(place);
            let begins = k == 0 || (place[0] - way[k - 1][0]).abs() > jump;
            let _ = write!(path, "{}{x:.1} {y:.1}", if begins { "M" } else { "L" });
        }
    }
    let _ = write!(svg, "<path d=\"{path}\" fill=\"none\" stroke=\"#a9bfd8\"/>");
    let (mut arrows, mut discs) = (String::new(), String::new());
    for (way, (_, velocity)) in ways.iter().zip(end) {
        let Some([x, y]) = way.last().map(|&place| at(place)) else { continue };
        let speed = length(*velocity, [0.0; 2]);
        if speed <= 1e-12 || jump.is_finite() {
            let _ = write!(discs, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.5\"/>");
            continue;
        }
        let [cos, sin] = [velocity[0] / speed * ARROW, -velocity[1] / speed * ARROW];
        let corner = |ahead: f64, left: f64| [x + ahead * cos + left * sin, y + ahead * sin - left * cos];
        for (k, [x, y]) in
            [corner(1.0, 0.0), corner(-0.8, 0.6), corner(-0.4, 0.0), corner(-0.8, -0.6)].iter().enumerate()
        {
            let _ = write!(arrows, "{}{x:.1} {y:.1}", if k == 0 { "M" } else { "L" });
        }
        arrows.push('Z');
    }
    let _ = writeln!(svg, "<g fill=\"#1f5fae\"><path d=\"{arrows}\"/>{discs}</g></svg>");
    svg
}

#[cfg(test)]
mod tests {
    use super::*;
    use swarm::models::{LIST, find};

    #[test]
    fn a_run_is_drawn_and_drawn_alike() {
        for id in ["vicsek_1995", "hamilton_1d", "behaviour_selection", "helbing_2005"] {
            let entry = find(id).map(|entry| typical_run(entry).ok());
            let again = find(id).map(|entry| typical_run(entry).ok());
            assert_eq!(entry, again);
            let svg = entry.flatten().unwrap_or_default();
            assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n") && !svg.contains("NaN"), "{id}: {svg}");
            // everybody stands at the end of a way of some length
            assert_eq!(svg.matches('Z').count() + svg.matches("<circle").count(), MEMBERS, "{id}");
            assert!(svg.len() < 12_000, "{id}: {}", svg.len());
        }
    }

    #[test]
    fn scenes_are_of_models_that_there_are_and_show_what_they_say() {
        for (id, text) in SCENES {
            assert!(LIST.iter().any(|entry| entry.card.id == *id) && text.contains(&format!("model.{id}]")), "{id}");
            let course = in_a_scene(id, text);
            assert!(course.is_ok(), "{id}: {}", course.err().map_or_else(String::new, |fault| fault.to_string()));
            let Ok(course) = course else { continue };
            // somebody moves
            let (first, last) = (&course.moments[0], &course.moments[course.moments.len() - 1]);
            let gone = first.iter().zip(last).map(|(a, b)| length(a.0, b.0));
            assert!(gone.sum::<f64>() > 0.0, "{id}");
            let count = |of: fn(&Mark) -> bool| course.marks.iter().filter(|mark| of(mark)).count();
            let obstacles = count(|mark| !matches!(mark, Mark::Goal(_)));
            let walled = usize::from(text.contains("\"walls\""));
            assert_eq!(obstacles, text.matches("[[obstacle]]").count() + walled, "{id}");
            let goals = ["goal = ", "target = ", "target_position = "].map(|key| text.matches(key).count());
            assert_eq!(count(|mark| matches!(mark, Mark::Goal(_))), goals.iter().sum::<usize>(), "{id}");
        }
    }
}
