//! Whether a body of some size can get away from walls.

use crate::TerrainError;
use crate::geometry::{Point, bounds};
use space::Segment;

/// Side of a cell, in radii of the body.
const CELLS: f64 = 0.25;
/// Most cells that are flooded.
const MOST: f64 = 4e7;

/// The ground about walls in cells a quarter of a body's radius wide, with free ground all round.
struct Cells {
    low: Point,
    cell: f64,
    width: usize,
    height: usize,
    /// Where a body cannot be, or the flood has been.
    closed: Vec<bool>,
}

impl Cells {
    /// The ground about these walls and points; none where there is nothing.
    fn new(walls: &[Segment], points: &[Point], radius: f64) -> Result<Self, TerrainError> {
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(TerrainError::range("clearance", "a number above 0", radius));
        }
        let cell = radius * CELLS;
        let ends = walls.iter().flat_map(|wall| [wall.from, wall.to]);
        let (low, high) = bounds(ends.chain(points.iter().copied())).unwrap_or((Point::ZERO, Point::ZERO));
        // beyond the walls two radii and some cells of free ground
        let margin = 2.0 * radius + 4.0 * cell;
        let extent = [0, 1].map(|a| ((high[a] - low[a] + 2.0 * margin) / cell).ceil() + 1.0);
        let count = extent[0] * extent[1];
        if count.is_nan() || count > MOST {
            return Err(TerrainError::TooMany { count, limit: MOST });
        }
        let [width, height] = extent.map(|n| n as usize);
        let low = low - space::Vector([margin, margin]);
        let mut cells = Self { low, cell, width, height, closed: vec![false; width * height] };
        for wall in walls {
            let reach = radius + cell;
            let range = |axis: usize, most: usize| {
                let (a, b) = (wall.from[axis], wall.to[axis]);
                cells.index(a.min(b) - reach, axis)..(cells.index(a.max(b) + reach, axis) + 1).min(most)
            };
            let (columns, rows) = (range(0, width), range(1, height));
            for y in rows {
                for x in columns.clone() {
                    let middle = low + space::Vector([x as f64 + 0.5, y as f64 + 0.5]) * cell;
                    cells.closed[y * width + x] |= wall.distance(middle) < radius;
                }
            }
        }
        Ok(cells)
    }
    fn index(&self, value: f64, axis: usize) -> usize {
        ((value - self.low[axis]) / self.cell).floor().max(0.0) as usize
    }
    fn of(&self, point: Point) -> usize {
        self.index(point[1], 1) * self.width + self.index(point[0], 0)
    }
    /// Whether a body that begins at a point comes to a cell of which this holds.
    fn reaches(mut self, from: Point, found: impl Fn(&Self, usize) -> bool) -> bool {
        let mut open = vec![self.of(from)];
        while let Some(at) = open.pop() {
            if self.closed[at] {
                continue;
            }
            if found(&self, at) {
                return true;
            }
            self.closed[at] = true;
            let (x, y) = (at % self.width, at / self.width);
            open.extend((x > 0).then(|| at - 1));
            open.extend((x + 1 < self.width).then(|| at + 1));
            open.extend((y > 0).then(|| at - self.width));
            open.extend((y + 1 < self.height).then(|| at + self.width));
        }
        false
    }
}

/// Whether a disc of this radius can move from the point to the outside without coming closer than its radius to a
/// wall, by a flood over cells a quarter of the radius wide: gaps are judged to about one cell. Where it does not fit in
/// the first place it does not get away.
///
/// # Errors
/// A radius that is not a positive number, and one so small beside the walls that there were more than 40 million cells.
pub fn escapes_with_clearance(walls: &[Segment], point: Point, radius: f64) -> Result<bool, TerrainError> {
    let cells = Cells::new(walls, &[point], radius)?;
    Ok(cells.reaches(point, |cells, at| {
        let (x, y) = (at % cells.width, at / cells.width);
        x == 0 || y == 0 || x + 1 == cells.width || y + 1 == cells.height
    }))
}

/// Whether a disc of this radius can move from one point to another without coming closer than its radius to a wall,
/// judged as in [`escapes_with_clearance`]. It may go round the walls.
///
/// # Errors
/// As there.
pub(crate) fn way_with_clearance(walls: &[Segment], from: Point, to: Point, radius: f64) -> Result<bool, TerrainError> {
    let cells = Cells::new(walls, &[from, to], radius)?;
    let goal = cells.of(to);
    Ok(cells.reaches(from, |_, at| at == goal))
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
        let way = |gap: f64, radius: f64, to: [f64; 2]| {
            way_with_clearance(&room(gap), Vector([0.0, 0.0]), Vector(to), radius)
        };
        assert_eq!([way(2.0, 0.8, [5.0, 0.0]), way(2.0, 1.3, [5.0, 0.0])], [Ok(true), Ok(false)]);
        assert_eq!([way(0.0, 0.8, [2.0, 2.0]), way(0.0, 0.8, [2.5, 2.0])], [Ok(true), Ok(false)], "within the room");
        assert_eq!(way(2.0, 0.8, [-9.0, 0.0]), Ok(true), "round the walls");
        assert!(escapes(2.0, 0.0).is_err() && escapes(2.0, 1e-9).is_err() && escapes(2.0, f64::NAN).is_err());
    }
}
