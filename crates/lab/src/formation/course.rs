//! A trial computed anew, frame by frame: targets and shepherds on their ways, walls that come and go.

use super::plan::{Method, Plan};
use super::task::Wall;
use super::trial;
use crate::report::{Border, Outline, Replay, Stage};
use space::Vector;
use terrain::Point;

/// Name of the group of shepherds in a recording.
pub(crate) const SHEPHERDS: &str = "shepherds";

fn deep(p: Point) -> [f64; 3] {
    [p[0], p[1], 0.0]
}

fn segment(at: &space::Segment) -> Outline {
    Outline::Segment { from: deep(at.from), to: deep(at.to) }
}

/// What was there already, and those of the walls that stand.
pub(crate) fn outlines(plan: &Plan, walls: &[Wall], standing: &[bool]) -> Vec<Outline> {
    let there = plan.workspace.workspace.geometry.iter().flat_map(|geometry| geometry.segments());
    let standing = walls.iter().zip(standing).filter(|(_, standing)| **standing).map(|(wall, _)| wall.at);
    there.chain(standing).map(|at| segment(&at)).collect()
}

/// Corners of a box that holds a task in its workspace, and these places.
pub(crate) fn extent(plan: &Plan, task: usize, places: &[Point]) -> (Point, Point) {
    let corners = plan.workspace.workspace.boundary.iter().flatten();
    let all = || places.iter().chain(&plan.tasks[task].path).chain(corners.clone());
    let bound = |axis: usize, of: fn(f64, f64) -> f64, from: f64| all().map(|p| p[axis]).fold(from, of);
    (
        Vector([0, 1].map(|axis| bound(axis, f64::min, f64::INFINITY))),
        Vector([0, 1].map(|axis| bound(axis, f64::max, f64::NEG_INFINITY))),
    )
}

/// What a method is, and what is drawn.
pub(crate) fn about(method: &Method) -> String {
    let about = if method.form.about.is_empty() { String::new() } else { format!("{}.\n\n", method.form.about) };
    format!("{about}Dashed: the path, its gates, where the targets start and where they are to go.")
}

/// A trial of a task with a method, by its number from 1, one moment in `every` kept, and the last. Shepherds are a group of their own
/// behind those of the targets.
///
/// # Errors
/// What makes the trial impossible, in a sentence.
pub fn replay(
    plan: &Plan,
    walls: &[Wall],
    (task, method, number): (usize, usize, usize),
    every: u64,
) -> Result<Replay, String> {
    let own = &plan.methods[method];
    let arena = plan.arena(task, own, walls);
    let mut frames: Vec<(f64, Vec<Point>, Vec<Outline>)> = Vec::new();
    let (mut step, mut robots, mut last, mut body) = (0u64, 0, None, 0.0);
    trial::run(&arena, plan.seed_of(task, number), &|| false, &mut |shown| {
        (robots, body) = (shown.robots.len(), shown.target_radius);
        let outlines = outlines(plan, &arena.walls, shown.standing);
        let frame = (shown.time, shown.targets.iter().chain(shown.robots).copied().collect(), outlines);
        if step.is_multiple_of(every.max(1)) {
            frames.push(frame);
            last = None;
        } else {
            last = Some(frame);
        }
        step += 1;
    })?;
    frames.extend(last);
    let mut group = own.population.types.clone();
    let mut groups = own.population.groups.clone();
    let mut radius = vec![body; groups.len()];
    if robots > 0 {
        group.extend(std::iter::repeat_n(groups.len(), robots));
        groups.push(SHEPHERDS.into());
        radius.push(own.shepherds.radius);
    }
    let everywhere: Vec<Point> = frames.iter().flat_map(|frame| &frame.1).copied().collect();
    let (low, high) = extent(plan, task, &everywhere);
    // the way of each from the frame before is its heading; that of the first frame is the way that follows
    let heading = |frame: usize, member: usize| {
        let to = frame.max(1).min(frames.len() - 1);
        let way = frames[to].1[member] - frames[to.saturating_sub(1)].1[member];
        deep(if way == Vector::ZERO { way } else { way.unit() }).map(|v| v as f32)
    };
    let members = group.len();
    Ok(Replay {
        title: format!("Task {} by {}", plan.tasks[task].name, own.name),
        about: format!("Trial {number}. Lines are walls that stand at the moment."),
        stage: Stage {
            dimensions: 2,
            low: deep(low),
            high: deep(high),
            edges: [Border::Open; 3],
            unit: plan.targets.scenario.units.length.clone(),
            groups,
            radius,
        },
        time_unit: plan.targets.scenario.units.time.clone(),
        times: frames.iter().map(|frame| frame.0).collect(),
        group,
        position: frames.iter().map(|frame| frame.1.iter().map(|&p| deep(p).map(|v| v as f32)).collect()).collect(),
        heading: (0..frames.len()).map(|frame| (0..members).map(|member| heading(frame, member)).collect()).collect(),
        obstacles: frames.iter().map(|frame| frame.2.clone()).collect(),
    })
}
