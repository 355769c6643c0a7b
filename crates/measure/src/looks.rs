//! Numbers read from a series of looks at one group: clusters, coverage, paths.
//!
//! A metric describes one moment; what stands here needs several, or a part of the members found at each. Members are
//! given by number, so that they can be found again at the next look.

use crate::near::linked;
use space::{Edge, Real, Space, Vector};
use std::collections::BTreeMap;

/// The clusters at one look: what hangs together when members at most a distance apart are linked.
#[derive(Clone, Debug, PartialEq)]
pub struct Clusters {
    of: Vec<usize>,
    sizes: Vec<usize>,
}

impl Clusters {
    /// The clusters of places, single linkage; the distance is included.
    pub fn of<const D: usize>(space: &Space<f64, D>, places: &[Vector<f64, D>], distance: f64) -> Self {
        let of = linked(space, places, distance);
        let mut sizes = Vec::new();
        for &cluster in &of {
            if cluster == sizes.len() {
                sizes.push(0);
            }
            sizes[cluster] += 1;
        }
        Self { of, sizes }
    }
    /// How many there are.
    pub fn count(&self) -> usize {
        self.sizes.len()
    }
    /// Places of the members of the largest, in order; ties go to the cluster of the lowest member.
    pub fn largest(&self) -> Vec<usize> {
        let most = self.sizes.iter().copied().max().unwrap_or(0);
        // clusters are numbered by their lowest members
        let Some(largest) = self.sizes.iter().position(|&size| size == most) else { return Vec::new() };
        (0..self.of.len()).filter(|&k| self.of[k] == largest).collect()
    }
}

/// Which cells of a space were visited by whom.
///
/// The space ends on every axis, at walls or on itself, and is divided into equal cells, so many along each axis.
#[derive(Clone, Debug)]
pub struct Coverage<const D: usize> {
    sides: [f64; D],
    cells: usize,
    /// Of each visited cell the members seen there, one bit each.
    seen: BTreeMap<u64, Vec<u64>>,
    /// Sum over looks of the share of cells that were full at once, and the number of looks.
    at_once: (f64, usize),
}

impl<const D: usize> Coverage<D> {
    /// None where an axis is open, or there are no cells.
    pub fn new(space: &Space<f64, D>, cells: usize) -> Option<Self> {
        let mut sides = [0.0; D];
        for (side, edge) in sides.iter_mut().zip(space.edges) {
            *side = match edge {
                Edge::Walls(length) | Edge::Periodic(length) => length,
                Edge::Open => return None,
            };
        }
        (cells > 0).then(|| Self { sides, cells, seen: BTreeMap::new(), at_once: (0.0, 0) })
    }
    /// Number of cells.
    pub fn total(&self) -> f64 {
        (self.cells as f64).powi(D as i32)
    }
    /// The cell of a place; one on the upper wall is in the last.
    fn cell(&self, place: Vector<f64, D>) -> u64 {
        let mut cell = 0;
        for a in (0..D).rev() {
            let along = (place[a] / self.sides[a] * self.cells as f64).floor();
            cell = cell * self.cells as u64 + (along.clamp(0.0, self.cells as f64 - 1.0)) as u64;
        }
        cell
    }
    /// Takes in a look: members by number, with their places. `needed` members in a cell at once make it full.
    pub fn look(&mut self, members: &[usize], places: &[Vector<f64, D>], needed: f64) {
        let mut now: BTreeMap<u64, usize> = BTreeMap::new();
        for (&member, &place) in members.iter().zip(places) {
            let cell = self.cell(place);
            *now.entry(cell).or_default() += 1;
            let bits = self.seen.entry(cell).or_default();
            let word = member / 64;
            if bits.len() <= word {
                bits.resize(word + 1, 0);
            }
            bits[word] |= 1 << (member % 64);
        }
        let full = now.values().filter(|&&count| count as f64 >= needed).count();
        self.at_once.0 += full as f64 / self.total();
        self.at_once.1 += 1;
    }
    /// Share of the cells in which at least `needed` different members were seen at any look.
    pub fn visited(&self, needed: f64) -> f64 {
        let different = |bits: &Vec<u64>| bits.iter().map(|word| word.count_ones()).sum::<u32>();
        let full = self.seen.values().filter(|bits| f64::from(different(bits)) >= needed).count();
        full as f64 / self.total()
    }
    /// Mean over the looks of the share of cells that were full at once; none before the first look.
    pub fn at_once(&self) -> Option<f64> {
        (self.at_once.1 > 0).then(|| self.at_once.0 / self.at_once.1 as f64)
    }
}

/// Length of the mean displacement of members between two looks: of those of a cluster, how fast it moves.
pub fn mean_displacement<const D: usize>(
    space: &Space<f64, D>,
    before: &[Vector<f64, D>],
    after: &[Vector<f64, D>],
) -> Option<f64> {
    let moved = before.iter().zip(after).map(|(&from, &to)| space.offset(from, to));
    crate::sample::mean_vector(moved).map(Vector::length)
}

/// How much paths turn: over members and pairs of looks, the mean angle between consecutive headings over the mean distance
/// moved.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Curvature {
    turned: f64,
    moved: f64,
}

impl Curvature {
    /// Takes in a member's way from one look to the next. Without a heading at either there is no angle.
    pub fn take<const D: usize>(&mut self, headings: [Vector<f64, D>; 2], offset: Vector<f64, D>) {
        if headings.iter().all(|heading| !heading.is_tiny()) {
            let cos = headings[0].unit().dot(headings[1].unit());
            self.turned += Real::acos(cos.clamp(-1.0, 1.0));
            self.moved += offset.length();
        }
    }
    /// Degrees per length; none where nobody moved.
    pub fn value(&self) -> Option<f64> {
        (self.moved > 0.0).then(|| self.turned.to_degrees() / self.moved)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    fn at(places: &[[f64; 2]]) -> Vec<Vector<f64, 2>> {
        places.iter().map(|&place| Vector(place)).collect()
    }

    #[test]
    fn the_largest_cluster_and_its_tie() {
        let places = at(&[[0.0, 0.0], [5.0, 0.0], [5.0, 1.0], [0.0, 1.0], [9.0, 9.0]]);
        let clusters = Clusters::of(&Space::open(), &places, 1.0);
        assert_eq!((clusters.count(), clusters.largest()), (3, vec![0, 3]), "ties go to the lowest member");
        let more = at(&[[0.0, 0.0], [5.0, 0.0], [5.0, 1.0]]);
        assert_eq!(Clusters::of(&Space::open(), &more, 1.0).largest(), [1, 2]);
        let none = Clusters::of::<2>(&Space::open(), &[], 1.0);
        assert_eq!((none.count(), none.largest()), (0, vec![]));
    }

    #[test]
    fn coverage_counts_different_members() {
        let space = Space::walled([4.0, 4.0]);
        let mut coverage = Coverage::new(&space, 2).unwrap();
        assert_eq!(coverage.at_once(), None);
        // one member twice in a cell is one; two at different times are two
        coverage.look(&[0, 70], &at(&[[1.0, 1.0], [3.0, 3.0]]), 2.0);
        coverage.look(&[0, 70], &at(&[[1.0, 1.0], [1.0, 1.0]]), 2.0);
        assert_eq!(coverage.visited(2.0), 0.25);
        assert_eq!(coverage.visited(1.0), 0.5);
        assert_eq!(coverage.at_once(), Some(0.125), "full at once in the second look only");
        // on the walls
        coverage.look(&[1, 2], &at(&[[4.0, 4.0], [0.0, 4.0]]), 2.0);
        assert_eq!(coverage.visited(1.0), 0.75);
        assert!(Coverage::new(&Space::<f64, 2>::open(), 2).is_none());
    }

    #[test]
    fn displacement_and_curvature() {
        let space = Space::periodic([10.0, 10.0]);
        let (before, after) = (at(&[[9.0, 0.0], [1.0, 1.0]]), at(&[[1.0, 0.0], [1.0, 3.0]]));
        let expected = (1.0f64 + 1.0).sqrt();
        assert!((mean_displacement(&space, &before, &after).unwrap() - expected).abs() < 1e-12);
        assert_eq!(mean_displacement(&space, &[], &[]), None);
        let mut curvature = Curvature::default();
        assert_eq!(curvature.value(), None);
        curvature.take([Vector([1.0, 0.0]), Vector([0.0, 2.0])], Vector([3.0, 0.0]));
        curvature.take([Vector([1.0, 0.0]), Vector([1.0, 0.0])], Vector([0.0, 3.0]));
        curvature.take([Vector([0.0, 0.0]), Vector([1.0, 0.0])], Vector([0.0, 3.0]));
        assert!((curvature.value().unwrap() - 15.0).abs() < 1e-12);
    }
}
