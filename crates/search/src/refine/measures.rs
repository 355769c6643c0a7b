//! What a map says: how much of the box is valid, and how it hangs together.

use super::{Leaf, Refinement};
use std::collections::HashMap;

/// The leaves of a map as boxes with whole coordinates, counted in the finest cells.
#[derive(Clone, Debug)]
pub struct Region<'a> {
    map: &'a Refinement,
    /// Finest cells along each axis, `[dimensions]`.
    fine: Vec<u64>,
    /// Low and high corner of each leaf, `[leaves]`.
    boxes: Vec<(Vec<u64>, Vec<u64>)>,
}

impl<'a> Region<'a> {
    pub(super) fn of(map: &'a Refinement) -> Self {
        let axes = map.plan.base.len();
        let finest = |a: usize| map.leaves.iter().map(|leaf| leaf.cell.level[a]).max().unwrap_or(0);
        let finest: Vec<u32> = (0..axes).map(finest).collect();
        let corner = |leaf: &Leaf, end: u64| -> Vec<u64> {
            (0..axes).map(|a| (leaf.cell.place[a] + end) << (finest[a] - leaf.cell.level[a])).collect()
        };
        let boxes = map.leaves.iter().map(|leaf| (corner(leaf, 0), corner(leaf, 1))).collect();
        Self { map, fine: (0..axes).map(|a| map.parts(a, finest[a])).collect(), boxes }
    }
    fn valid(&self) -> impl Iterator<Item = usize> {
        (0..self.boxes.len()).filter(|&k| self.map.leaves[k].found.valid)
    }
    /// Share of the box that is valid, exactly: numerator and denominator in lowest terms. It is also the chance that a
    /// point drawn uniformly is valid.
    pub fn valid_volume(&self) -> (u128, u128) {
        let all: u128 = self.fine.iter().map(|&cells| u128::from(cells)).product();
        let size = |k: usize| -> u128 {
            let (low, high) = &self.boxes[k];
            low.iter().zip(high).map(|(low, high)| u128::from(high - low)).product()
        };
        let valid: u128 = self.valid().map(size).sum();
        let divisor = greatest_common_divisor(valid, all);
        (valid / divisor, all / divisor)
    }
    /// Share of a box (low and high corner, in the numbers searched over) that is valid. 0 where the box is empty.
    pub fn density(&self, low: &[f64], high: &[f64]) -> f64 {
        let overlap = |(from, to): &(Vec<f64>, Vec<f64>)| -> f64 {
            let along = |a: usize| (to[a].min(high[a]) - from[a].max(low[a])).max(0.0);
            (0..low.len()).map(along).product()
        };
        let (mut valid, mut all) = (0.0, 0.0);
        for leaf in &self.map.leaves {
            let part = overlap(&self.map.bounds(&leaf.cell));
            all += part;
            valid += if leaf.found.valid { part } else { 0.0 };
        }
        if all > 0.0 { valid / all } else { 0.0 }
    }
    /// Share of the centres no farther than `radius` from a point that are valid, where the box is a unit box; leaves
    /// count by their size. 0 where there is none.
    pub fn local_density(&self, point: &[f64], radius: f64) -> f64 {
        let axes = self.map.plan.domain.axes();
        let (mut valid, mut all) = (0.0, 0.0);
        for (k, leaf) in self.map.leaves.iter().enumerate() {
            let along = |a: usize| {
                let share = (self.map.centre(&leaf.cell)[a] - point[a]) / (axes[a].high - axes[a].low);
                if axes[a].periodic { share - libm::round(share) } else { share }
            };
            if (0..point.len()).map(|a| along(a) * along(a)).sum::<f64>() <= radius * radius {
                let (low, high) = &self.boxes[k];
                let size: f64 = low.iter().zip(high).map(|(low, high)| (high - low) as f64).product();
                all += size;
                valid += if leaf.found.valid { size } else { 0.0 };
            }
        }
        if all > 0.0 { valid / all } else { 0.0 }
    }
    /// The connected parts of what is valid: numbers of leaves, ascending; by the lowest number in each. Leaves hang
    /// together where they share a face, or part of one; a shared corner does not join.
    pub fn components(&self) -> Vec<Vec<usize>> {
        let mut parent: Vec<usize> = (0..self.boxes.len()).collect();
        fn root(parent: &mut [usize], mut k: usize) -> usize {
            while parent[k] != k {
                parent[k] = parent[parent[k]];
                k = parent[k];
            }
            k
        }
        self.faces(|a, b, _| {
            if self.map.leaves[a].found.valid && self.map.leaves[b].found.valid {
                let (a, b) = (root(&mut parent, a), root(&mut parent, b));
                parent[a.max(b)] = a.min(b);
            }
        });
        let mut components: Vec<Vec<usize>> = Vec::new();
        let mut number = HashMap::new();
        for k in self.valid() {
            let next = components.len();
            let component = *number.entry(root(&mut parent, k)).or_insert(next);
            if component == next {
                components.push(Vec::new());
            }
            components[component].push(k);
        }
        components
    }
    /// Size of the boundary between what is valid and what is not, where the box is a unit box; the box's own faces do
    /// not count.
    pub fn perimeter(&self) -> f64 {
        let mut perimeter = 0.0;
        self.faces(|a, b, size| {
            if self.map.leaves[a].found.valid != self.map.leaves[b].found.valid {
                perimeter += size;
            }
        });
        perimeter
    }
    /// Share of evaluations that a full grid of the finest cells would have needed in addition.
    pub fn saved(&self) -> f64 {
        let full: f64 = self.fine.iter().map(|&cells| cells as f64).product();
        1.0 - self.map.evaluations.iter().sum::<usize>() as f64 / full
    }
    /// Calls `each` for every two leaves that share a face of positive size, with that size in the unit box; once for
    /// each face they share.
    fn faces(&self, mut each: impl FnMut(usize, usize, f64)) {
        for axis in 0..self.fine.len() {
            let mut ending: HashMap<u64, Vec<usize>> = HashMap::new();
            for (k, (_, high)) in self.boxes.iter().enumerate() {
                ending.entry(high[axis]).or_default().push(k);
            }
            let periodic = self.map.plan.domain.axes()[axis].periodic;
            for (b, (low, _)) in self.boxes.iter().enumerate() {
                let face = if low[axis] == 0 && periodic { self.fine[axis] } else { low[axis] };
                for &a in ending.get(&face).into_iter().flatten() {
                    if let Some(size) = self.shared(a, b, axis) {
                        each(a, b, size);
                    }
                }
            }
        }
    }
    /// Size of the common part of two faces across an axis; `None` where there is none.
    fn shared(&self, a: usize, b: usize, axis: usize) -> Option<f64> {
        let ((a_low, a_high), (b_low, b_high)) = (&self.boxes[a], &self.boxes[b]);
        let mut size = 1.0;
        for k in (0..self.fine.len()).filter(|&k| k != axis) {
            let (low, high) = (a_low[k].max(b_low[k]), a_high[k].min(b_high[k]));
            if low >= high {
                return None;
            }
            size *= (high - low) as f64 / self.fine[k] as f64;
        }
        Some(size)
    }
}

fn greatest_common_divisor(mut a: u128, mut b: u128) -> u128 {
    while a != 0 {
        (a, b) = (b % a, a);
    }
    b
}

#[cfg(test)]
mod tests {
    use super::super::tests::{mapped, plan, rectangle};
    use super::super::{RefinementPlan, Rule};
    use crate::{Axis, Domain};

    #[test]
    fn two_parts_that_meet_in_a_corner() {
        let map = mapped(plan(&[2, 2], 0, Rule::Success), |x| (x[0] < 0.5) == (x[1] < 0.5));
        let region = map.region();
        assert_eq!(region.components(), [vec![0], vec![3]]);
        assert_eq!(region.valid_volume(), (1, 2));
        assert_eq!(region.perimeter(), 2.0);
        assert_eq!(region.density(&[0.0, 0.0], &[0.5, 1.0]), 0.5);
        assert_eq!(region.density(&[0.0, 0.0], &[0.25, 0.25]), 1.0);
        assert_eq!(region.density(&[0.2, 0.2], &[0.2, 0.9]), 0.0);
        assert_eq!(region.local_density(&[0.25, 0.25], 0.1), 1.0);
        assert_eq!(region.local_density(&[0.5, 0.5], 1.0), 0.5);
        assert_eq!(region.saved(), 0.0);
    }

    #[test]
    fn leaves_of_different_size_hang_together() {
        let map = mapped(plan(&[4, 4], 3, Rule::Boundary), rectangle);
        let region = map.region();
        assert_eq!(region.components().len(), 1);
        let (valid, all) = region.valid_volume();
        assert!((valid as f64 / all as f64 - 0.16).abs() < 0.02);
        assert!((region.perimeter() - 1.6).abs() < 0.1, "{}", region.perimeter());
        assert!(region.saved() > 0.5);
    }

    #[test]
    fn a_seam_joins_and_closes() {
        let ring = |closed: bool| {
            let angle = Axis::new(0.0, 360.0);
            let domain = Domain::new(vec![if closed { angle.closed() } else { angle }, Axis::new(0.0, 1.0)]).unwrap();
            let plan = RefinementPlan { domain, ..plan(&[8, 2], 1, Rule::Success) };
            mapped(plan, |x| x[0] < 90.0 || x[0] > 270.0)
        };
        assert_eq!(ring(false).region().components().len(), 2);
        assert_eq!(ring(true).region().components().len(), 1);
        // one side of the unit box at 90 degrees and one at 270; the seam is inside
        assert_eq!(ring(true).region().perimeter(), 2.0);
        assert!(ring(true).region().local_density(&[359.0, 0.5], 0.2) > 0.99);
    }

    #[test]
    fn an_empty_map() {
        let map = mapped(plan(&[3, 3], 2, Rule::Success), |_| false);
        let region = map.region();
        assert_eq!((region.valid_volume(), region.components().len(), region.perimeter()), ((0, 1), 0, 0.0));
    }
}
