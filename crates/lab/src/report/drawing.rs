//! Drawings of places as static SVG: what stands there, what was built, marks, and the ways that members took.

use super::escape::markup;
use super::number::place;
use super::palette::SERIES;
use super::{Drawing, Drawings, Stroke};
use core::fmt::Write;

/// Width of a drawing; the page scales it to its column.
const WIDTH: f64 = 220.0;
/// Greatest height.
const TALLEST: f64 = 240.0;
/// Room around what is drawn.
const ROOM: f64 = 6.0;
/// Parts into which a way is cut by time, each of a colour of its own.
pub(crate) const TIMES: usize = 6;

/// A drawing as SVG.
pub(super) fn drawing(drawings: &Drawings, drawing: &Drawing) -> String {
    let bounds = drawings.bounds.or_else(|| bounds(drawing)).unwrap_or(([0.0; 2], [1.0; 2]));
    let size = |axis: usize| (bounds.1[axis] - bounds.0[axis]).max(1e-9);
    let scale = ((WIDTH - 2.0 * ROOM) / size(0)).min((TALLEST - 2.0 * ROOM) / size(1));
    let height = size(1) * scale + 2.0 * ROOM;
    let left = (WIDTH - size(0) * scale) / 2.0;
    let at = |p: &[f64; 2]| {
        let (x, y) = ((p[0] - bounds.0[0]) * scale + left, (bounds.1[1] - p[1]) * scale + ROOM);
        format!("{} {}", place(x), place(y))
    };
    let mut svg = String::new();
    // writing to a string cannot fail, here and below
    let _ = write!(
        svg,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"scene drawing\" viewBox=\"0 0 {WIDTH} {}\" role=\"img\" \
         aria-label=\"{}\"><rect class=\"floor\" width=\"{WIDTH}\" height=\"{}\"/>",
        place(height),
        markup(&drawing.caption),
        place(height)
    );
    for (stroke, points) in &drawing.strokes {
        let Some((first, rest)) = points.split_first().filter(|_| points.iter().flatten().all(|v| v.is_finite()))
        else {
            continue;
        };
        let class = match stroke {
            Stroke::There => "there".to_owned(),
            Stroke::Built => "built".to_owned(),
            Stroke::Structure => "structure".to_owned(),
            Stroke::Way(part) => format!("way t{}", part.min(&(TIMES - 1))),
            Stroke::Series(number) => format!("series s{}", number % SERIES),
        };
        let _ = write!(svg, "<path class=\"{class}\" d=\"M{}", at(first));
        for point in rest {
            let _ = write!(svg, "L{}", at(point));
        }
        svg.push_str("\"/>");
    }
    for (built, centre, radius) in &drawing.discs {
        let point = at(centre);
        let Some((x, y)) = point.split_once(' ') else { continue };
        let class = if *built { "disc" } else { "disc there" };
        let _ = write!(svg, "<circle class=\"{class}\" cx=\"{x}\" cy=\"{y}\" r=\"{}\"/>", place(radius * scale));
    }
    for mark in &drawing.marks {
        let _ = write!(svg, "<path class=\"cross\" d=\"M{}m-4 0h8m-4-4v8\"/>", at(mark));
    }
    svg.push_str("</svg>");
    svg
}

/// What a drawing shows as CSV: points of lines, discs, marks.
pub(super) fn data(drawing: &Drawing) -> String {
    let mut csv = String::from("what,number,x,y,radius\n");
    for (k, (stroke, points)) in drawing.strokes.iter().enumerate() {
        let what = match stroke {
            Stroke::There => "there",
            Stroke::Built => "built",
            Stroke::Structure => "structure",
            Stroke::Way(_) => "way",
            Stroke::Series(_) => "series",
        };
        for [x, y] in points {
            let _ = writeln!(csv, "{what},{k},{x},{y},");
        }
    }
    for (k, (built, [x, y], radius)) in drawing.discs.iter().enumerate() {
        let _ = writeln!(csv, "{},{k},{x},{y},{radius}", if *built { "disc built" } else { "disc there" });
    }
    for (k, [x, y]) in drawing.marks.iter().enumerate() {
        let _ = writeln!(csv, "mark,{k},{x},{y},");
    }
    csv
}

/// The box around everything in a drawing; none where there is nothing.
pub(crate) fn bounds(drawing: &Drawing) -> Option<([f64; 2], [f64; 2])> {
    let points = drawing.strokes.iter().flat_map(|(_, points)| points).chain(&drawing.marks).copied();
    let discs = drawing.discs.iter().flat_map(|(_, [x, y], r)| [[x - r, y - r], [x + r, y + r]]);
    let finite = points.chain(discs).filter(|p| p.iter().all(|v| v.is_finite()));
    finite.fold(None, |bounds, p| {
        let (low, high) = bounds.unwrap_or((p, p));
        let each = |of: fn(f64, f64) -> f64, a: [f64; 2]| [of(a[0], p[0]), of(a[1], p[1])];
        Some((each(f64::min, low), each(f64::max, high)))
    })
}
