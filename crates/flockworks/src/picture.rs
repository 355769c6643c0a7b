//! A typical run of a model as a small drawing: ways from the start, and everyone's arrow at the end.

use crate::bench::{fitting_side, start};
use crate::fault::Fault;
use crate::workloads::Running;
use std::fmt::Write as _;
use swarm::models::Entry;

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

/// Places and velocities of all members at one moment, in the plane.
type Moment = Vec<([f64; 2], [f64; 2])>;

/// The drawing, as SVG: the same bytes on every machine.
///
/// # Errors
/// A model that cannot be started with its defaults.
pub fn typical_run(entry: &'static Entry) -> Result<String, Fault> {
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
    let last = moments.len() - 1;
    let shown: Vec<usize> = (0..POINTS).map(|k| k * last / (POINTS - 1)).collect();
    // on a line, time goes downwards
    let line = dimension == 1;
    let place = |step: usize, member: usize| {
        let [x, y] = moments[step][member].0;
        if line { [x, -(step as f64) / last.max(1) as f64 * side] } else { [x, y] }
    };
    let ways: Vec<Vec<[f64; 2]>> =
        (0..MEMBERS).map(|member| shown.iter().map(|&step| place(step, member)).collect()).collect();
    Ok(drawn(entry, &ways, &moments[last], if line { side } else { f64::INFINITY }))
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
fn drawn(entry: &Entry, ways: &[Vec<[f64; 2]>], end: &Moment, jump: f64) -> String {
    let all = || ways.iter().flatten();
    let bound = |a: usize| {
        let least = all().map(|p| p[a]).fold(f64::INFINITY, f64::min);
        let greatest = all().map(|p| p[a]).fold(f64::NEG_INFINITY, f64::max);
        ((least + greatest) / 2.0, greatest - least)
    };
    let ([middle_x, middle_y], spans) = ([bound(0).0, bound(1).0], [bound(0).1, bound(1).1]);
    let scale = (SIZE - 2.0 * ROOM) / spans[0].max(spans[1]).max(1e-9);
    let at = |p: [f64; 2]| [SIZE / 2.0 + (p[0] - middle_x) * scale, SIZE / 2.0 - (p[1] - middle_y) * scale];
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {SIZE} {SIZE}\" width=\"{SIZE}\" height=\"{SIZE}\" role=\"img\">\
         <title>A typical run of {}</title><rect width=\"{SIZE}\" height=\"{SIZE}\" fill=\"#fff\"/>",
        entry.card.id
    );
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
    use swarm::models::LIST;

    #[test]
    fn a_run_is_drawn_and_drawn_alike() {
        for id in ["vicsek_1995", "hamilton_1d", "behaviour_selection"] {
            let entry = LIST.iter().find(|entry| entry.card.id == id).map(|entry| typical_run(entry).ok());
            let again = LIST.iter().find(|entry| entry.card.id == id).map(|entry| typical_run(entry).ok());
            assert_eq!(entry, again);
            let svg = entry.flatten().unwrap_or_default();
            assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n") && !svg.contains("NaN"), "{id}: {svg}");
            // everybody stands at the end of a way of some length
            assert_eq!(svg.matches('Z').count() + svg.matches("<circle").count(), MEMBERS, "{id}");
            assert!(svg.len() < 12_000, "{id}: {}", svg.len());
        }
    }
}
