//! Whether a body of some size can get away from walls.

use crate::TerrainError;
use crate::geometry::{Point, bounds};
use space::Segment;

/// Side of a cell, in radii of the body.
const CELLS: f64 = 0.25;
/// Most cells that are flooded.
const MOST: f64 = 4e7;

/// Whether a disc of this radius can move from the point to the outside without coming closer than its radius to a
/// wall, by a flood over cells a quarter of the radius wide: gaps are judged to about one cell. Where it does not fit in
/// the first place it does not get away.
///
/// # Errors
/// A radius that is not a positive number, and one so small beside the walls that there were more than 40 million cells.
pub fn escapes_with_clearance(walls: &[Segment], point: Point, radius: f64) -> Result<bool, TerrainError> {
    if !(radius > 0.0 && radius.is_finite()) {
        return Err(TerrainError::range("clearance", "a number above 0", radius));
    }
    let cell = radius * CELLS;
    let points = walls.iter().flat_map(|wall| [wall.from, wall.to]);
    let Some((low, high)) = bounds(points.chain([point])) else { return Ok(true) };
    // beyond the walls two radii and some cells of free ground
    let margin = 2.0 * radius + 4.0 * cell;
    let extent = [0, 1].map(|a| ((high[a] - low[a] + 2.0 * margin) / cell).ceil() + 1.0);
    let count = extent[0] * extent[1];
    if count.is_nan() || count > MOST {
        return Err(TerrainError::TooMany { count, limit: MOST });
    }
    let [width, height] = extent.map(|n| n as usize);
    let middle = |x: usize, y: usize| {
        space::Vector([low[0] - margin + cell * (x as f64 + 0.5), low[1] - margin + cell * (y as f64 + 0.5)])
    };
    let index = |value: f64, axis: usize| (((value - low[axis] + margin) / cell).floor().max(0.0)) as usize;
    let mut closed = vec![false; width * height];
    for wall in walls {
        let reach = radius + cell;
        let range = |axis: usize, most: usize| {
            let (a, b) = (wall.from[axis], wall.to[axis]);
            index(a.min(b) - reach, axis)..(index(a.max(b) + reach, axis) + 1).min(most)
        };
        for y in range(1, height) {
            for x in range(0, width) {
                closed[y * width + x] |= wall.distance(middle(x, y)) < radius;
            }
        }
    }
    let start = index(point[1], 1) * width + index(point[0], 0);
    let mut open = vec![start];
    while let Some(at) = open.pop() {
        if closed[at] {
            continue;
        }
        closed[at] = true;
        let (x, y) = (at % width, at / width);
        if x == 0 || y == 0 || x + 1 == width || y + 1 == height {
            return Ok(true);
        }
        open.extend([at - 1, at + 1, at - width, at + width]);
    }
    Ok(false)
}

#[cfg(test)]
mod tests {
    use super::*;
    use space::Vector;

    #[test]
    fn a_body_needs_a_gap_of_its_width() {
        let room = |gap: f64| {
            let h = gap / 2.0;
            [[3., -3., 3., -h], [3., h, 3., 3.], [3., 3., -3., 3.], [-3., 3., -3., -3.], [-3., -3., 3., -3.]]
                .map(|[x0, y0, x1, y1]| Segment::new([x0, y0], [x1, y1]))
        };
        let escapes = |gap: f64, radius: f64| escapes_with_clearance(&room(gap), Vector([0.0, 0.0]), radius);
        assert_eq!([escapes(2.0, 0.5), escapes(2.0, 0.8), escapes(2.0, 1.3)], [Ok(true), Ok(true), Ok(false)]);
        assert_eq!(escapes(0.0, 0.5), Ok(false));
        assert_eq!(escapes(2.0, 3.5), Ok(false), "it does not fit");
        assert_eq!(escapes_with_clearance(&[], Vector([0.0, 0.0]), 1.0), Ok(true));
        assert!(escapes(2.0, 0.0).is_err() && escapes(2.0, 1e-9).is_err() && escapes(2.0, f64::NAN).is_err());
    }
}
