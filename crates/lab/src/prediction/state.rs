//! The group as a whole: its state in a few numbers, and members that have these.

use measure::behaviours::blocks::centroid;
use measure::behaviours::{Membership, Moment};
use space::Vector;
use terrain::Point;

/// Below this share of the way to a wall a member stands before it.
const BEFORE: f64 = 0.95;
/// Polarisations below this leave the heading as it was.
const ALIGNED: f64 = 1e-9;

/// A symmetric matrix of the plane: xx, xy, yy.
pub type Symmetric = [f64; 3];

/// The macroscopic state of a group.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Its centroid.
    pub at: Point,
    /// The direction of its mean heading, a unit vector.
    pub heading: Point,
    /// The length of its mean heading, 0 to 1.
    pub polarisation: f64,
    /// How far its members reach: the square root of the matrix of mean products of their offsets from the centroid (length).
    pub spread: Symmetric,
    /// Share of the largest group within it.
    pub largest: f64,
}

/// Numbers in which a state is kept.
pub const WORDS: usize = 9;

impl State {
    /// The state at a moment; none where nobody is there. Where members head nowhere in common the heading is that of before, or along x.
    pub fn of(moment: &Moment<'_>, link: f64, before: Option<&Self>) -> Option<Self> {
        let there: Vec<Point> = moment.positions.iter().flatten().copied().collect();
        let at = centroid(&there)?;
        let mut products = [0.0; 3];
        for &p in &there {
            let d = p - at;
            products[0] += d[0] * d[0];
            products[1] += d[0] * d[1];
            products[2] += d[1] * d[1];
        }
        let spread = root(products.map(|sum| sum / there.len() as f64));
        let headings = moment.velocities.iter().flatten().filter(|v| !v.is_tiny()).map(|v| v.unit());
        let mean = centroid(&headings.collect::<Vec<_>>()).unwrap_or(Vector::ZERO);
        let (heading, polarisation) = headed(mean, before.map_or(Vector([1.0, 0.0]), |before| before.heading));
        let sizes = Membership::within(link).sizes(&there);
        let largest = sizes.into_iter().max().unwrap_or(0) as f64 / there.len() as f64;
        Some(Self { at, heading, polarisation, spread, largest })
    }
    /// As words of a record.
    pub fn words(&self) -> [u64; WORDS] {
        let [x, y] = self.at.0;
        let [u, v] = self.heading.0;
        let [xx, xy, yy] = self.spread;
        [x, y, u, v, self.polarisation, xx, xy, yy, self.largest].map(f64::to_bits)
    }
    /// From its words.
    pub fn from_words(words: &[u64; WORDS]) -> Self {
        let [x, y, u, v, polarisation, xx, xy, yy, largest] = words.map(f64::from_bits);
        Self { at: Vector([x, y]), heading: Vector([u, v]), polarisation, spread: [xx, xy, yy], largest }
    }
}

/// Direction and length of a mean heading; `before` where it has no direction.
pub fn headed(mean: Point, before: Point) -> (Point, f64) {
    let length = mean.length();
    if length > ALIGNED { (mean / length, length.min(1.0)) } else { (before, 0.0) }
}

/// The symmetric square root of a matrix that is not negative.
pub fn root([a, b, c]: Symmetric) -> Symmetric {
    let s = (a * c - b * b).max(0.0).sqrt();
    let t = (a + c + 2.0 * s).max(0.0).sqrt();
    if t > 0.0 { [(a + s) / t, b / t, (c + s) / t] } else { [0.0; 3] }
}

/// A matrix in the frame of a heading: along, oblique, across.
pub fn seen([xx, xy, yy]: Symmetric, heading: Point) -> Symmetric {
    let [u, v] = heading.0;
    [
        u * u * xx + 2.0 * u * v * xy + v * v * yy,
        u * v * (yy - xx) + (u * u - v * v) * xy,
        v * v * xx - 2.0 * u * v * xy + u * u * yy,
    ]
}

/// A matrix that was [`seen`] from a heading, along the axes again.
pub fn unseen(matrix: Symmetric, [u, v]: [f64; 2]) -> Symmetric {
    seen(matrix, Vector([u, -v]))
}

/// The nearest matrix that is not negative.
pub fn not_negative([a, b, c]: Symmetric) -> Symmetric {
    let (middle, half) = ((a + c) / 2.0, (((a - c) / 2.0) * ((a - c) / 2.0) + b * b).sqrt());
    if middle >= half {
        return [a, b, c];
    }
    // what belongs to the greater eigenvalue is left
    let greater = (middle + half).max(0.0);
    let share = if half > 0.0 { greater / (2.0 * half) } else { 0.0 };
    [(half + (a - c) / 2.0) * share, b * share, (half - (a - c) / 2.0) * share]
}

/// Members that have a state between them: so many, at the same places of an ellipse for equal states. Their centroid, their mean
/// products of offsets and their mean heading are those of the state, but for those whom a wall keeps from their places.
#[derive(Clone, Debug)]
pub struct Members {
    /// Offsets from the centroid with unit matrix of mean products, `[members]`.
    places: Vec<Point>,
}

impl Members {
    /// So many.
    pub fn new(count: usize) -> Self {
        // evenly over a disc, by turns of the golden angle
        let golden = core::f64::consts::PI * (3.0 - 5.0f64.sqrt());
        let place = |k: usize| Vector::at_angle(golden * k as f64) * ((k as f64 + 0.5) / count as f64).sqrt();
        let mut places: Vec<Point> = (0..count).map(place).collect();
        let middle = centroid(&places).unwrap_or(Vector::ZERO);
        let mut products = [0.0; 3];
        for p in &mut places {
            *p -= middle;
            products[0] += p[0] * p[0];
            products[1] += p[0] * p[1];
            products[2] += p[1] * p[1];
        }
        let [a, b, c] = root(products.map(|sum| sum / count.max(1) as f64));
        let size = a * c - b * b;
        if count > 2 && size > 0.0 {
            for p in &mut places {
                *p = Vector([(c * p[0] - b * p[1]) / size, (a * p[1] - b * p[0]) / size]);
            }
        }
        Self { places }
    }
    /// Where they stand, among walls that keep them from what lies behind, seen from the centroid.
    pub fn positions(&self, state: &State, walls: &[super::surroundings::Wall]) -> Vec<Point> {
        let [xx, xy, yy] = state.spread;
        let pair = |k: usize| {
            // two are on a line: the one of greatest spread
            let direction = if xx >= yy { Vector([xx, xy]) } else { Vector([xy, yy]) }.unit();
            let direction = if direction[0] < 0.0 { -direction } else { direction };
            let reach = (xx * xx + 2.0 * xy * xy + yy * yy).sqrt();
            direction * if k == 0 { reach } else { -reach }
        };
        let offset = |(k, p): (usize, &Point)| match self.places.len() {
            1 => Vector::ZERO,
            2 => pair(k),
            _ => Vector([xx * p[0] + xy * p[1], xy * p[0] + yy * p[1]]),
        };
        let place = |offset: Point| {
            let free = super::surroundings::free(state.at, offset, walls);
            state.at + if free < 1.0 { offset * (free * BEFORE) } else { offset }
        };
        self.places.iter().enumerate().map(offset).map(place).collect()
    }
    /// Where they head: by turns to the left and to the right of the mean, so that their mean is that of the state.
    pub fn headings(&self, state: &State) -> Vec<Point> {
        let count = self.places.len();
        let paired = count - count % 2;
        let cos = ((state.polarisation * count as f64 - (count % 2) as f64) / paired.max(1) as f64).clamp(-1.0, 1.0);
        let sin = (1.0 - cos * cos).sqrt();
        let heading = |k: usize| match (k < paired, k % 2) {
            (false, _) => state.heading,
            (true, 0) => state.heading * cos + state.heading.left() * sin,
            (true, _) => state.heading * cos - state.heading.left() * sin,
        };
        (0..count).map(heading).collect()
    }
}
