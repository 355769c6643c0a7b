//! Maps of a parameter space by dynamic resolution: finer where it matters.
//!
//! The box is cut into the cells of a base grid, and what holds at the centre of a cell is taken to hold in it. Each
//! iteration looks at the cells that the one before made (the *generation*), chooses among them by a [`Rule`], and
//! divides those chosen; the parts are the next generation. Cells that are not divided are *leaves*. Only cells of the
//! same generation are neighbours in this, those across the seam of a periodic axis among them. No point is evaluated
//! twice, since parts have centres of their own.

mod measures;

pub use measures::Region;

use crate::error::{counted, hold};
use crate::{Domain, SearchError};
use std::collections::HashMap;

/// Which cells of a generation are divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// Valid ones, and those that share at least a corner with a valid one.
    Success,
    /// Those that share at least a corner with one of the other label.
    Boundary,
}

/// Into what a cell is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Division {
    /// Halves along every axis: a quadtree in the plane, an octree in space, an orthtree in general.
    Orthtree,
    /// Halves along one axis, the same for the whole generation: the one along which the largest share of neighbours
    /// differ in label (of equals the one divided least often, then the first). For more than two axes.
    OneAxis,
}

/// What is mapped, and how finely.
#[derive(Clone, Debug, PartialEq)]
pub struct RefinementPlan {
    /// The box.
    pub domain: Domain,
    /// Cells of the base grid along each axis, `[dimensions]`.
    pub base: Vec<u32>,
    /// Which cells are divided.
    pub rule: Rule,
    /// Into what.
    pub division: Division,
    /// How often at most.
    pub iterations: u32,
    /// Largest number of evaluations. Where it does not suffice for all cells chosen, the most uncertain (with a rate
    /// nearest to 1/2) are divided, of equals those made first.
    pub budget: Option<usize>,
}

/// What was found at the centre of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Its label.
    pub valid: bool,
    /// Share of successes, from which its uncertainty follows.
    pub rate: f64,
}

/// A cell: along axis `a` the place `place[a]` of `base[a] 2^level[a]` equal parts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cell {
    /// Place along each axis, `[dimensions]`.
    pub place: Vec<u64>,
    /// How often each axis was halved, `[dimensions]`; the same in a whole generation.
    pub level: Vec<u32>,
    /// The iteration that made it; 0 for the base grid.
    pub generation: u32,
}

/// A cell with what was found in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Leaf {
    /// The cell.
    pub cell: Cell,
    /// What was found at its centre.
    pub found: Found,
    /// Number of its evaluation, from 0, in the order of [`Refinement::cells`].
    pub evaluation: usize,
}

/// A map that is being made.
///
/// ```
/// use search::refine::{Division, Found, Refinement, RefinementPlan, Rule};
/// use search::{Axis, Domain};
///
/// let mut map = Refinement::new(RefinementPlan {
///     domain: Domain::new(vec![Axis::new(0.0, 1.0); 2])?,
///     base: vec![4, 4],
///     rule: Rule::Boundary,
///     division: Division::Orthtree,
///     iterations: 5,
///     budget: None,
/// })?;
/// while !map.cells().is_empty() {
///     let inside = |point: Vec<f64>| (point[0] - 0.5).hypot(point[1] - 0.5) < 0.4;
///     let found: Vec<Found> = map
///         .cells()
///         .iter()
///         .map(|cell| inside(map.centre(cell)))
///         .map(|valid| Found { valid, rate: f64::from(u8::from(valid)) })
///         .collect();
///     map.tell(&found)?;
/// }
/// let (valid, all) = map.region().valid_volume();
/// assert!((valid as f64 / all as f64 - 0.16 * std::f64::consts::PI).abs() < 0.01);
/// # Ok::<(), search::SearchError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Refinement {
    plan: RefinementPlan,
    leaves: Vec<Leaf>,
    /// The generation whose cells are to be evaluated.
    cells: Vec<Cell>,
    evaluations: Vec<usize>,
}

/// Above this many axes a cell has too many neighbours to be asked about all.
const MOST_AXES: usize = 8;

impl Refinement {
    /// A map that begins with the base grid.
    ///
    /// # Errors
    /// Where the base grid does not fit the box or the budget, or the finest cells would be too small to be told apart.
    pub fn new(plan: RefinementPlan) -> Result<Self, SearchError> {
        counted("axes of the base grid", plan.base.len(), plan.domain.dimensions())?;
        hold(plan.base.len() <= MOST_AXES, "number of axes", "at most 8")?;
        hold(
            plan.base.iter().all(|&cells| (1..=1 << 16).contains(&cells)),
            "base grid",
            "1 to 65536 cells along each axis",
        )?;
        hold(plan.iterations <= 30, "number of iterations", "at most 30")?;
        let first = plan.base.iter().try_fold(1usize, |cells, &along| cells.checked_mul(along as usize));
        let first = first.filter(|&cells| cells <= plan.budget.unwrap_or(100_000_000));
        hold(first.is_some(), "base grid", "no more cells than the budget of evaluations (without one, 100 million)")?;
        let mut cells = vec![Vec::new()];
        for &along in &plan.base {
            // the last axis runs fastest
            let longer = |place: &Vec<u64>, next| place.iter().copied().chain([next]).collect();
            cells = cells.iter().flat_map(|place| (0..u64::from(along)).map(move |next| longer(place, next))).collect();
        }
        let level = vec![0; plan.base.len()];
        let cells: Vec<Cell> =
            cells.into_iter().map(|place| Cell { place, level: level.clone(), generation: 0 }).collect();
        let evaluations = vec![cells.len()];
        Ok(Self { plan, leaves: Vec::new(), cells, evaluations })
    }
    /// The plan.
    pub fn plan(&self) -> &RefinementPlan {
        &self.plan
    }
    /// The cells whose centres are to be evaluated now; none when the map is complete.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }
    /// Evaluations made or asked for in each generation. The last is 0 where an iteration divided nothing.
    pub fn evaluations(&self) -> &[usize] {
        &self.evaluations
    }
    /// The cells that were not divided, in the order in which they were evaluated; those of the present generation are
    /// not among them.
    pub fn leaves(&self) -> &[Leaf] {
        &self.leaves
    }
    /// Low corner, high corner: `[dimensions]` each.
    pub fn bounds(&self, cell: &Cell) -> (Vec<f64>, Vec<f64>) {
        (self.corner(cell, 0), self.corner(cell, 2))
    }
    /// The centre of a cell, `[dimensions]`: what is evaluated.
    pub fn centre(&self, cell: &Cell) -> Vec<f64> {
        self.corner(cell, 1)
    }
    /// The point `halves` half cells up from the low corner.
    fn corner(&self, cell: &Cell, halves: u64) -> Vec<f64> {
        let along = |a: usize| {
            let parts = 2 * self.parts(a, cell.level[a]);
            self.plan.domain.axes()[a].at((2 * cell.place[a] + halves) as f64 / parts as f64)
        };
        (0..cell.place.len()).map(along).collect()
    }
    /// Cells along an axis at a level.
    fn parts(&self, axis: usize, level: u32) -> u64 {
        u64::from(self.plan.base[axis]) << level
    }

    /// Takes what was found at the centres of [`Refinement::cells`], in their order, and divides.
    ///
    /// # Errors
    /// Where it is not one for each cell.
    pub fn tell(&mut self, found: &[Found]) -> Result<(), SearchError> {
        counted("results", found.len(), self.cells.len())?;
        let cells = core::mem::take(&mut self.cells);
        let Some(generation) = cells.first().map(|cell| cell.generation) else { return Ok(()) };
        let before = self.evaluations.iter().sum::<usize>() - cells.len();
        let mut divided = vec![false; cells.len()];
        if generation < self.plan.iterations {
            let axes = self.axes(&cells, found);
            for k in self.chosen(&cells, found, 1 << axes.len()) {
                divided[k] = true;
                self.divide(&cells[k], &axes);
            }
            self.evaluations.push(self.cells.len());
        }
        let kept = cells.into_iter().enumerate().filter(|(k, _)| !divided[*k]);
        self.leaves.extend(kept.map(|(k, cell)| Leaf { cell, found: found[k], evaluation: before + k }));
        Ok(())
    }
    /// The axes along which this generation is halved.
    fn axes(&self, cells: &[Cell], found: &[Found]) -> Vec<usize> {
        let all: Vec<usize> = (0..self.plan.base.len()).collect();
        if self.plan.division == Division::Orthtree {
            return all;
        }
        let places = places(cells);
        let variation = |axis: usize| {
            let (mut pairs, mut different) = (0usize, 0usize);
            for (k, cell) in cells.iter().enumerate() {
                let mut step = vec![0; cell.place.len()];
                step[axis] = 1;
                if let Some(&other) = self.moved(cell, &step).and_then(|place| places.get(&place[..])) {
                    pairs += 1;
                    different += usize::from(found[k].valid != found[other].valid);
                }
            }
            different as f64 / pairs.max(1) as f64
        };
        let level = cells.first().map_or(&[][..], |cell| &cell.level);
        let better = |best: (usize, f64), axis: usize| {
            let now = variation(axis);
            if now > best.1 || (now == best.1 && level[axis] < level[best.0]) { (axis, now) } else { best }
        };
        let (axis, _) = all[1..].iter().fold((0, variation(0)), |best, &axis| better(best, axis));
        vec![axis]
    }
    /// Numbers of the cells to divide, ascending, so many that the budget suffices for their parts.
    fn chosen(&self, cells: &[Cell], found: &[Found], parts: usize) -> Vec<usize> {
        let places = places(cells);
        let steps = steps(self.plan.base.len());
        let chosen = |&k: &usize| {
            let mut near = steps.iter().filter_map(|step| self.moved(&cells[k], step));
            let mut any = |wanted: bool| {
                near.any(|place| places.get(&place[..]).is_some_and(|&other| found[other].valid == wanted))
            };
            match self.plan.rule {
                Rule::Success => found[k].valid || any(true),
                Rule::Boundary => any(!found[k].valid),
            }
        };
        let mut chosen: Vec<usize> = (0..cells.len()).filter(chosen).collect();
        if let Some(budget) = self.plan.budget {
            let left = budget - self.evaluations.iter().sum::<usize>();
            let certainty = |k: &usize| (found[*k].rate - 0.5).abs();
            chosen.sort_by(|a, b| certainty(a).total_cmp(&certainty(b)));
            chosen.truncate(left / parts);
            chosen.sort_unstable();
        }
        chosen
    }
    /// The place so many cells away; `None` outside the box.
    fn moved(&self, cell: &Cell, step: &[i64]) -> Option<Vec<u64>> {
        let along = |a: usize| {
            let parts = self.parts(a, cell.level[a]);
            match cell.place[a].checked_add_signed(step[a]).filter(|&place| place < parts) {
                None if self.plan.domain.axes()[a].periodic => Some(if step[a] < 0 { parts - 1 } else { 0 }),
                place => place,
            }
        };
        (0..cell.place.len()).map(along).collect()
    }
    /// Halves a cell along these axes; the last runs fastest.
    fn divide(&mut self, cell: &Cell, axes: &[usize]) {
        for part in 0..1u64 << axes.len() {
            let mut child = Cell { generation: cell.generation + 1, ..cell.clone() };
            for (k, &axis) in axes.iter().enumerate() {
                child.place[axis] = 2 * cell.place[axis] + (part >> (axes.len() - 1 - k) & 1);
                child.level[axis] += 1;
            }
            self.cells.push(child);
        }
    }
    /// What the leaves say of the box. Complete when there are no more [`Refinement::cells`].
    pub fn region(&self) -> Region<'_> {
        Region::of(self)
    }
}

/// The number of the cell at each place.
fn places(cells: &[Cell]) -> HashMap<&[u64], usize> {
    cells.iter().enumerate().map(|(k, cell)| (&cell.place[..], k)).collect()
}

/// Steps to all cells that share at least a corner.
fn steps(axes: usize) -> Vec<Vec<i64>> {
    let mut steps = vec![Vec::new()];
    for _ in 0..axes {
        let longer = |step: &Vec<i64>, next| step.iter().copied().chain([next]).collect();
        steps = steps.iter().flat_map(|step| (-1..=1).map(move |next| longer(step, next))).collect();
    }
    steps.retain(|step: &Vec<i64>| step.iter().any(|&along| along != 0));
    steps
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::Axis;

    pub(crate) fn plan(base: &[u32], iterations: u32, rule: Rule) -> RefinementPlan {
        RefinementPlan {
            domain: Domain::new(vec![Axis::new(0.0, 1.0); base.len()]).unwrap(),
            base: base.to_vec(),
            rule,
            division: Division::Orthtree,
            iterations,
            budget: None,
        }
    }

    pub(crate) fn mapped(plan: RefinementPlan, valid: impl Fn(&[f64]) -> bool) -> Refinement {
        let mut map = Refinement::new(plan).unwrap();
        while !map.cells().is_empty() {
            let found = |cell: &Cell| {
                let valid = valid(&map.centre(cell));
                Found { valid, rate: if valid { 0.9 } else { 0.2 } }
            };
            let found: Vec<Found> = map.cells().iter().map(found).collect();
            map.tell(&found).unwrap();
        }
        map
    }

    pub(crate) fn rectangle(x: &[f64]) -> bool {
        (0.3..=0.7).contains(&x[0]) && (0.2..=0.6).contains(&x[1])
    }

    #[test]
    fn a_rectangle_worked_out_by_another_program() {
        let map = mapped(plan(&[4, 4], 3, Rule::Success), rectangle);
        assert_eq!(map.evaluations(), [16, 48, 120, 288]);
        assert_eq!(map.leaves().len(), 358);
        assert_eq!(map.leaves().iter().filter(|leaf| leaf.found.valid).count(), 156);
        assert_eq!(map.region().valid_volume(), (39, 256));
        assert_eq!(map.region().components().len(), 1);
    }

    #[test]
    fn stops_where_nothing_is_divided() {
        let map = mapped(plan(&[4, 4], 3, Rule::Success), |_| false);
        assert_eq!((map.evaluations(), map.leaves().len()), (&[16, 0][..], 16));
        let map = mapped(plan(&[3], 4, Rule::Boundary), |_| true);
        assert_eq!((map.evaluations(), map.leaves().len()), (&[3, 0][..], 3));
        let map = mapped(plan(&[2, 2], 0, Rule::Success), |_| true);
        assert_eq!((map.evaluations(), map.leaves().len()), (&[4][..], 4));
    }

    #[test]
    fn neighbours_across_a_seam() {
        let ring = |closed: bool| {
            let axis = Axis::new(0.0, 360.0);
            let domain = Domain::new(vec![if closed { axis.closed() } else { axis }]).unwrap();
            mapped(RefinementPlan { domain, ..plan(&[6], 1, Rule::Success) }, |x| x[0] < 60.0)
        };
        assert_eq!(ring(false).evaluations(), [6, 4]);
        assert_eq!(ring(true).evaluations(), [6, 6]);
        assert_eq!(ring(true).centre(&ring(true).leaves()[0].cell), [90.0 + 60.0]);
    }

    #[test]
    fn the_leaves_fill_the_box_and_no_centre_comes_twice() {
        for division in [Division::Orthtree, Division::OneAxis] {
            let ball = |x: &[f64]| x.iter().map(|v| (v - 0.5).powi(2)).sum::<f64>() <= 0.33f64.powi(2);
            let map = mapped(RefinementPlan { division, ..plan(&[3, 2, 4], 4, Rule::Boundary) }, ball);
            let volume = |leaf: &Leaf| {
                let (low, high) = map.bounds(&leaf.cell);
                low.iter().zip(&high).map(|(low, high)| high - low).product::<f64>()
            };
            assert!((map.leaves().iter().map(volume).sum::<f64>() - 1.0).abs() < 1e-12);
            let mut centres: Vec<Vec<u64>> = map
                .leaves()
                .iter()
                .map(|leaf| map.centre(&leaf.cell).into_iter().map(f64::to_bits).collect())
                .collect();
            centres.sort();
            assert!(centres.windows(2).all(|pair| pair[0] != pair[1]));
        }
    }

    #[test]
    fn one_axis_is_halved_where_labels_differ() {
        let one = RefinementPlan { division: Division::OneAxis, ..plan(&[4, 4, 4], 3, Rule::Boundary) };
        // only the second axis matters
        let map = mapped(one, |x| x[1] < 0.4);
        assert!(map.leaves().iter().all(|leaf| leaf.cell.level[0] == 0 && leaf.cell.level[2] == 0));
        assert_eq!(map.evaluations(), [64, 64, 64, 64]);
    }

    #[test]
    fn a_budget_goes_to_the_most_uncertain() {
        let mut map = Refinement::new(RefinementPlan { budget: Some(11), ..plan(&[5], 3, Rule::Success) }).unwrap();
        let rates = [0.9, 0.6, 0.55, 0.95, 1.0];
        map.tell(&rates.map(|rate| Found { valid: true, rate })).unwrap();
        let places: Vec<u64> = map.cells().iter().map(|cell| cell.place[0]).collect();
        assert_eq!(places, [0, 1, 2, 3, 4, 5], "the first three cells");
        map.tell(&[Found { valid: true, rate: 0.5 }; 6]).unwrap();
        assert_eq!((map.cells().len(), map.evaluations()), (0, &[5, 6, 0][..]));
        assert_eq!(map.leaves().iter().map(|leaf| leaf.evaluation).collect::<Vec<_>>(), [3, 4, 5, 6, 7, 8, 9, 10]);
    }

    #[test]
    fn what_makes_no_sense_is_refused() {
        assert!(Refinement::new(plan(&[0, 2], 1, Rule::Success)).is_err());
        assert!(Refinement::new(plan(&[2], 31, Rule::Success)).is_err());
        assert!(Refinement::new(RefinementPlan { base: vec![2], ..plan(&[2, 2], 1, Rule::Success) }).is_err());
        assert!(Refinement::new(RefinementPlan { budget: Some(3), ..plan(&[2, 2], 1, Rule::Success) }).is_err());
        assert!(Refinement::new(plan(&[60_000; 8], 1, Rule::Success)).is_err());
        let mut map = Refinement::new(plan(&[2], 1, Rule::Success)).unwrap();
        assert!(map.tell(&[]).is_err());
        assert_eq!(map.cells().len(), 2, "nothing is lost");
    }
}
