//! What metrics of a line or a rectangle share.

use crate::{Bounds, Parameter, Tracks};
use space::Vector;

/// A coordinate that must be given.
const fn coordinate(name: &'static str, about: &'static str) -> Parameter {
    Parameter { name, unit: "length", default: None, bounds: Bounds::Any, about }
}

pub(super) const X1: Parameter = coordinate("x1", "x of the first end (or corner).");
pub(super) const Y1: Parameter = coordinate("y1", "y of the first end (or corner).");
pub(super) const X2: Parameter = coordinate("x2", "x of the second end (or corner).");
pub(super) const Y2: Parameter = coordinate("y2", "y of the second end (or corner).");

/// The lower and the upper corner of a rectangle by two opposite ones.
pub(super) fn corners(x1: f64, y1: f64, x2: f64, y2: f64) -> ([f64; 2], [f64; 2]) {
    ([x1.min(x2), y1.min(y2)], [x1.max(x2), y1.max(y2)])
}

/// Somebody crosses the line.
#[derive(Clone, Debug)]
pub(super) struct Crossing {
    pub(super) individual: usize,
    /// The frame of arrival, by its place in the list.
    pub(super) frame: usize,
    /// From right to left of the line.
    pub(super) forwards: bool,
}

/// All crossings of the line between two ends, in the order of frames, then of individuals.
pub(super) fn crossings<const D: usize>(tracks: &Tracks<D>, from: [f64; 2], to: [f64; 2]) -> Vec<Crossing> {
    let along = Vector(to) - Vector(from);
    let seen = |row: usize| Vector::<f64, 2>::of(&tracks.position(row).0) - Vector(from);
    let left = |place: Vector<f64, 2>| along.left().dot(place);
    let paths = tracks.paths();
    let mut crossings = Vec::new();
    for individual in 0..paths.len() {
        for ((before, old), (frame, new)) in paths.of(individual).zip(paths.of(individual).skip(1)) {
            let (old, new) = (seen(old), seen(new));
            let (a, b) = (left(old), left(new));
            if before + 1 != frame || (a > 0.0) == (b > 0.0) {
                continue;
            }
            let at = old + (new - old) * (a / (a - b));
            if (0.0..=along.length_squared()).contains(&at.dot(along)) {
                crossings.push(Crossing { individual, frame, forwards: b > 0.0 });
            }
        }
    }
    crossings.sort_by_key(|crossing| (crossing.frame, crossing.individual));
    crossings
}

/// Frame (by its place in the list) and row of an individual so many frames later. `None` where it is not found there.
pub(super) fn later<const D: usize>(
    tracks: &Tracks<D>,
    frame: usize,
    individual: usize,
    frames: i64,
) -> Option<(usize, usize)> {
    let number = tracks.frames()[frame] + frames * tracks.step();
    let frame = tracks.frames().binary_search(&number).ok()?;
    Some((frame, tracks.row(frame, individual as u32)?))
}

/// Speed from one frame and row to another, of the same individual.
pub(super) fn speed<const D: usize>(tracks: &Tracks<D>, from: (usize, usize), to: (usize, usize)) -> f64 {
    let way = tracks.offset(tracks.position(from.1), tracks.position(to.1)).length();
    way / (tracks.times()[to.0] - tracks.times()[from.0])
}
