//! Who is near whom: the nearest others, pairs within a distance, groups of linked members, dense clusters.
//!
//! What depends on distances comes in two ways that give the same answer: over all pairs, and over the cells of a grid.
//! The functions without a way in their name choose the faster one. What is told by a closure works for any distance.

use space::{Columns, LiveGrid, Space, Vector};

/// Up to so many places all pairs are faster than a grid.
const FEW: usize = 64;

/// Distance from each place to the nearest other one, by minimum image, `[places]`; infinite where there is no other.
pub fn nearest_distances<const D: usize>(space: &Space<f64, D>, places: &[Vector<f64, D>]) -> Vec<f64> {
    let by_grid = if places.len() > FEW { nearest_by_grid(space, places) } else { None };
    by_grid.unwrap_or_else(|| nearest_by_all_pairs(space, places))
}

/// [`nearest_distances`] over all pairs.
pub fn nearest_by_all_pairs<const D: usize>(space: &Space<f64, D>, places: &[Vector<f64, D>]) -> Vec<f64> {
    let mut nearest = vec![f64::INFINITY; places.len()];
    for i in 0..places.len() {
        for j in i + 1..places.len() {
            let squared = space.offset(places[i], places[j]).length_squared();
            nearest[i] = nearest[i].min(squared);
            nearest[j] = nearest[j].min(squared);
        }
    }
    nearest.into_iter().map(f64::sqrt).collect()
}

/// [`nearest_distances`] over the cells of a grid. `None` where a grid cannot serve this space and these places.
pub fn nearest_by_grid<const D: usize>(space: &Space<f64, D>, places: &[Vector<f64, D>]) -> Option<Vec<f64>> {
    let across: Vec<f64> = extents(space, places).into_iter().filter(|&extent| extent > 0.0).collect();
    let volume: f64 = across.iter().product();
    let spacing = space::Real::powf(volume / places.len() as f64, 1.0 / across.len() as f64);
    let grid = LiveGrid::new(space, spacing, &columns(places))?;
    let mut nearest = Vec::with_capacity(places.len());
    for (i, &place) in places.iter().enumerate() {
        let (mut radius, mut least) = (spacing, f64::INFINITY);
        // what lies beyond the radius was not met: look again until the nearest lies well inside
        while least > (0.999 * radius) * (0.999 * radius) {
            let searched = radius.is_finite()
                && grid.within(place, radius, |j, _, _| {
                    if j as usize != i {
                        least = least.min(space.offset(place, places[j as usize]).length_squared());
                    }
                });
            if !searched {
                let others = places.iter().enumerate().filter(|&(j, _)| j != i);
                least = others.map(|(_, &other)| space.offset(place, other).length_squared()).fold(least, f64::min);
                break;
            }
            radius *= 2.0;
        }
        nearest.push(least.sqrt());
    }
    Some(nearest)
}

/// The group of each place when places at most `distance` apart are linked, `[places]`: the connected components,
/// numbered from 0 in the order of their first place.
pub fn linked<const D: usize>(space: &Space<f64, D>, places: &[Vector<f64, D>], distance: f64) -> Vec<usize> {
    if places.len() > FEW {
        linked_by_cells(space, places, distance)
    } else {
        linked_by_all_pairs(space, places, distance)
    }
}

/// [`linked`] over all pairs.
pub fn linked_by_all_pairs<const D: usize>(
    space: &Space<f64, D>,
    places: &[Vector<f64, D>],
    distance: f64,
) -> Vec<usize> {
    components(places.len(), |i, j| are_linked(space, places[i], places[j], distance))
}

/// The connected component of each of so many things, whichever two are linked; numbered from 0 in the order of their
/// first. Each component is flooded from there.
pub fn components(count: usize, linked: impl Fn(usize, usize) -> bool) -> Vec<usize> {
    let mut group = vec![0; count];
    let mut groups = 0;
    let mut alone: Vec<usize> = (0..count).rev().collect();
    while let Some(first) = alone.pop() {
        let mut reached = vec![first];
        while let Some(i) = reached.pop() {
            group[i] = groups;
            alone.retain(|&j| {
                let near = linked(i, j);
                if near {
                    reached.push(j);
                }
                !near
            });
        }
        groups += 1;
    }
    group
}

/// No place, in a chain of places.
const END: usize = usize::MAX;

/// [`linked`] over cells as wide as the distance or wider: each group is flooded from its first place, and whoever is
/// reached leaves its cell. So a crowd in which everybody is linked to thousands is dealt with about as fast as a thin one.
pub fn linked_by_cells<const D: usize>(space: &Space<f64, D>, places: &[Vector<f64, D>], distance: f64) -> Vec<usize> {
    let cells = Cells::new(space, places, distance);
    // in each cell a chain of those who are in no group yet
    let mut first = vec![END; cells.count.iter().product()];
    let mut next = vec![END; places.len()];
    for (i, &place) in places.iter().enumerate() {
        let cell = cells.number(cells.of(place));
        next[i] = first[cell];
        first[cell] = i;
    }
    let mut group = vec![END; places.len()];
    let (mut groups, mut reached) = (0, Vec::new());
    for start in 0..places.len() {
        if group[start] != END {
            continue;
        }
        reached.push(start);
        while let Some(i) = reached.pop() {
            cells.around(places[i], |cell| {
                let mut at = std::mem::replace(&mut first[cell], END);
                while at != END {
                    let after = next[at];
                    if are_linked(space, places[i], places[at], distance) {
                        group[at] = groups;
                        reached.push(at);
                    } else {
                        next[at] = first[cell];
                        first[cell] = at;
                    }
                    at = after;
                }
            });
        }
        groups += 1;
    }
    group
}

/// Cells over a box that holds all places, no more than about one for each place.
struct Cells<const D: usize> {
    low: [f64; D],
    side: [f64; D],
    count: [usize; D],
    wraps: [bool; D],
}

impl<const D: usize> Cells<D> {
    /// Cells a little wider than `least`, or wider.
    fn new(space: &Space<f64, D>, places: &[Vector<f64, D>], least: f64) -> Self {
        let wraps = space.periods().map(|period| period.is_some());
        let along = |a: usize| places.iter().map(move |place| place.0[a]);
        let low = core::array::from_fn(|a| if wraps[a] { 0.0 } else { along(a).fold(f64::INFINITY, f64::min) });
        let extent = extents(space, places);
        let most = space::Real::powf(places.len() as f64, 1.0 / D as f64).ceil();
        // rounding never parts linked places by a whole cell
        let count = extent.map(|extent| (extent / (1.001 * least)).min(most).max(1.0) as usize);
        let side = core::array::from_fn(|a| if extent[a] > 0.0 { extent[a] / count[a] as f64 } else { 1.0 });
        Self { low, side, count, wraps }
    }
    /// The cell of a place, axis by axis.
    fn of(&self, place: Vector<f64, D>) -> [usize; D] {
        core::array::from_fn(|a| {
            let cell = ((place.0[a] - self.low[a]) / self.side[a]).floor();
            if self.wraps[a] {
                (cell as i64).rem_euclid(self.count[a] as i64) as usize
            } else {
                (cell as usize).min(self.count[a] - 1)
            }
        })
    }
    fn number(&self, cell: [usize; D]) -> usize {
        (0..D).rev().fold(0, |number, a| number * self.count[a] + cell[a])
    }
    /// Visits the cell of a place and those beside it, each once.
    fn around(&self, place: Vector<f64, D>, mut visit: impl FnMut(usize)) {
        let here = self.of(place);
        'cells: for k in 0..3usize.pow(D as u32) {
            let (mut cell, mut rest) = (here, k);
            for a in 0..D {
                let count = self.count[a];
                let to = here[a] + rest % 3;
                rest /= 3;
                cell[a] = match to.checked_sub(1) {
                    // with one or two cells round the axis both sides are the same
                    None if self.wraps[a] && count > 2 => count - 1,
                    Some(to) if to < count => to,
                    Some(_) if self.wraps[a] && count > 2 => 0,
                    _ => continue 'cells,
                };
            }
            visit(self.number(cell));
        }
    }
}

/// Calls `visit(i, j)` for each pair of places at most `distance` apart, once, in any order.
pub fn pairs_within<const D: usize>(
    space: &Space<f64, D>,
    places: &[Vector<f64, D>],
    distance: f64,
    mut visit: impl FnMut(usize, usize),
) {
    if is_sparse(space, places, distance) && pairs_by_grid(space, places, distance, &mut visit) {
        return;
    }
    for i in 0..places.len() {
        for j in i + 1..places.len() {
            if are_linked(space, places[i], places[j], distance) {
                visit(i, j);
            }
        }
    }
}

/// [`pairs_within`] over the cells of a grid. Nothing is called, and the answer is no, where a grid cannot serve.
pub fn pairs_by_grid<const D: usize>(
    space: &Space<f64, D>,
    places: &[Vector<f64, D>],
    distance: f64,
    mut visit: impl FnMut(usize, usize),
) -> bool {
    let Some(grid) = LiveGrid::new(space, distance, &columns(places)) else { return false };
    for (i, &place) in places.iter().enumerate() {
        for run in grid.around(i) {
            let members = grid.members(run);
            for j in members.rows[..members.count].iter().map(|&row| row as usize).filter(|&j| j < i) {
                if are_linked(space, place, places[j], distance) {
                    visit(j, i);
                }
            }
        }
    }
    true
}

/// The dense cluster of each member, `[members]`, numbered from 0 in the order of their first core member; `None`: noise.
///
/// A member is a core where at least `least` members, itself included, are near it. Cores that are near each other are in one
/// cluster. A member near a core is in its cluster too; of several, in the one that comes first.
/// `pairs` calls its argument for each pair that is near, once, whenever it is called.
///
/// M. Ester, H.-P. Kriegel, J. Sander, X. Xu (1996), A density-based algorithm for discovering clusters (DBSCAN), KDD 96.
pub fn dense_clusters(
    members: usize,
    least: usize,
    pairs: impl Fn(&mut dyn FnMut(usize, usize)),
) -> Vec<Option<usize>> {
    let mut near = vec![1usize; members];
    pairs(&mut |i, j| {
        near[i] += 1;
        near[j] += 1;
    });
    let core = |i: usize| near[i] >= least;
    let mut trees = Trees::new(members);
    pairs(&mut |i, j| {
        if core(i) && core(j) {
            trees.join(i, j);
        }
    });
    let mut cluster: Vec<Option<usize>> = vec![None; members];
    let mut clusters = 0;
    for i in (0..members).filter(|&i| core(i)) {
        let first = trees.root(i);
        if first == i {
            cluster[i] = Some(clusters);
            clusters += 1;
        } else {
            cluster[i] = cluster[first];
        }
    }
    let mut border: Vec<Option<usize>> = vec![None; members];
    pairs(&mut |i, j| {
        for (one, other) in [(i, j), (j, i)] {
            if core(one) && !core(other) {
                border[other] = [border[other], cluster[one]].into_iter().flatten().min();
            }
        }
    });
    cluster.into_iter().zip(border).map(|(core, border)| core.or(border)).collect()
}

/// Distance and index of the `count` nearest others of each place, the nearest first (ties by index), `[places][count]`.
/// `None` for fewer others.
pub fn nearest_others<const D: usize>(
    space: &Space<f64, D>,
    places: &[Vector<f64, D>],
    count: usize,
) -> Option<Vec<(f64, u32)>> {
    if places.len() <= count {
        return None;
    }
    let by_grid = if places.len() > FEW { nearest_others_by_grid(space, places, count) } else { None };
    by_grid.or_else(|| nearest_others_by(places.len(), count, |i, j| space.offset(places[i], places[j]).length()))
}

/// [`nearest_others`] over all pairs, for any distance.
pub fn nearest_others_by(
    members: usize,
    count: usize,
    distance: impl Fn(usize, usize) -> f64,
) -> Option<Vec<(f64, u32)>> {
    let mut nearest = Vec::with_capacity(members * count);
    let mut others = Vec::with_capacity(members);
    for i in 0..members {
        others.clear();
        others.extend((0..members).filter(|&j| j != i).map(|j| (distance(i, j), j as u32)));
        take_nearest(&mut others, count, &mut nearest)?;
    }
    Some(nearest)
}

/// [`nearest_others`] over the cells of a grid. `None` where a grid cannot serve this space and these places.
pub fn nearest_others_by_grid<const D: usize>(
    space: &Space<f64, D>,
    places: &[Vector<f64, D>],
    count: usize,
) -> Option<Vec<(f64, u32)>> {
    let across: Vec<f64> = extents(space, places).into_iter().filter(|&extent| extent > 0.0).collect();
    let share = across.iter().product::<f64>() * count as f64 / places.len() as f64;
    let spacing = space::Real::powf(share, 1.0 / across.len() as f64);
    let grid = LiveGrid::new(space, spacing, &columns(places)).filter(|_| spacing > 0.0)?;
    let mut nearest = Vec::with_capacity(places.len() * count);
    let mut others: Vec<(f64, u32)> = Vec::new();
    for (i, &place) in places.iter().enumerate() {
        let mut radius = spacing;
        // what lies beyond the radius was not met: look again until enough lie well inside
        loop {
            others.clear();
            let searched = radius.is_finite()
                && grid.within(place, radius, |j, _, _| {
                    if j as usize != i {
                        others.push((space.offset(place, places[j as usize]).length(), j));
                    }
                });
            if !searched {
                others.clear();
                let all = (0..places.len()).filter(|&j| j != i);
                others.extend(all.map(|j| (space.offset(place, places[j]).length(), j as u32)));
                break;
            }
            if others.iter().filter(|(distance, _)| *distance <= 0.999 * radius).count() >= count {
                break;
            }
            radius *= 2.0;
        }
        take_nearest(&mut others, count, &mut nearest)?;
    }
    Some(nearest)
}

/// Moves the nearest `count` of some to the end of a list, in order; `None` for fewer.
fn take_nearest(others: &mut [(f64, u32)], count: usize, to: &mut Vec<(f64, u32)>) -> Option<()> {
    let order = |a: &(f64, u32), b: &(f64, u32)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
    if count < others.len() {
        others.select_nth_unstable_by(count, order);
    }
    let nearest = others.get_mut(..count)?;
    nearest.sort_unstable_by(order);
    to.extend_from_slice(nearest);
    Some(())
}

/// Trees of members that belong together. The parent of a member never stands after it: the root of a tree is its first
/// member.
struct Trees(Vec<usize>);

impl Trees {
    fn new(members: usize) -> Self {
        Self((0..members).collect())
    }
    fn join(&mut self, i: usize, j: usize) {
        let (a, b) = (self.root(i), self.root(j));
        self.0[a.max(b)] = a.min(b);
    }
    /// The root of a tree, with the path to it halved.
    fn root(&mut self, mut i: usize) -> usize {
        while self.0[i] != i {
            self.0[i] = self.0[self.0[i]];
            i = self.0[i];
        }
        i
    }
}

/// Whether the neighbourhood of a place, three cells of this size a side, is a small part of the whole: then a grid pays.
fn is_sparse<const D: usize>(space: &Space<f64, D>, places: &[Vector<f64, D>], distance: f64) -> bool {
    let cells: f64 = extents(space, places).iter().map(|extent| (extent / distance).max(1.0)).product();
    places.len() > FEW && cells > 4.0 * 3.0f64.powi(D as i32)
}

fn are_linked<const D: usize>(
    space: &Space<f64, D>,
    here: Vector<f64, D>,
    there: Vector<f64, D>,
    distance: f64,
) -> bool {
    space.offset(here, there).length() <= distance
}

fn columns<const D: usize>(places: &[Vector<f64, D>]) -> Columns<f64, D> {
    let mut columns = Columns::new(places.len(), 0);
    for (row, &place) in places.iter().enumerate() {
        columns.set_position(row, place);
    }
    columns
}

/// The sides of the box that holds all places; on periodic axes the period.
fn extents<const D: usize>(space: &Space<f64, D>, places: &[Vector<f64, D>]) -> [f64; D] {
    let periods = space.periods();
    core::array::from_fn(|a| {
        let along = || places.iter().map(|place| place.0[a]);
        let extent = || along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min);
        periods[a].unwrap_or_else(|| extent().max(0.0))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Places in the box [0, `side`), the same in every run; every fifth beside the one before it.
    fn scattered<const D: usize>(n: usize, side: f64) -> Vec<Vector<f64, D>> {
        let mut state = 1234u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut places: Vec<Vector<f64, D>> = Vec::new();
        for k in 0..n {
            let place = match places.last() {
                Some(last) if k % 5 == 0 => Vector(last.0.map(|x| (x + 0.01 * next()).min(0.999 * side))),
                _ => Vector(core::array::from_fn(|_| side * next())),
            };
            places.push(place);
        }
        places
    }

    fn ways_agree<const D: usize>() {
        let mut served = 0;
        for side in [1.0, 30.0, 1000.0] {
            for n in [1, 2, 7, 65, 400] {
                let places = scattered::<D>(n, side);
                let spaces = [Space::open(), Space::walled([side; D]), Space::periodic([side; D])];
                for space in spaces {
                    let nearest = nearest_by_all_pairs(&space, &places);
                    if n > 1
                        && let Some(by_grid) = nearest_by_grid(&space, &places)
                    {
                        assert_eq!(by_grid, nearest, "{n} in {space:?}");
                        served += 1;
                    }
                    assert_eq!(nearest_distances(&space, &places), nearest);
                    let to = |i: usize, j: usize| space.offset(places[i], places[j]).length();
                    for count in [1, 6, 20].into_iter().filter(|&count| count < n) {
                        let others = nearest_others_by(n, count, to);
                        if let Some(by_grid) = nearest_others_by_grid(&space, &places, count) {
                            assert_eq!(Some(&by_grid), others.as_ref(), "{count} of {n} in {space:?}");
                            served += 1;
                        }
                        assert_eq!(nearest_others(&space, &places, count), others);
                    }
                    assert_eq!(nearest_others(&space, &places, n), None);
                    for distance in [0.004, 0.02, 0.3, 2.0, 25.0, 600.0] {
                        let groups = linked_by_all_pairs(&space, &places, distance);
                        let by_cells = linked_by_cells(&space, &places, distance);
                        assert_eq!(by_cells, groups, "{n} in {space:?} at {distance}");
                        assert_eq!(linked(&space, &places, distance), groups);
                    }
                }
            }
        }
        assert!(served > 90, "the grid served only {served} times");
    }

    #[test]
    fn grid_and_all_pairs_agree() {
        ways_agree::<1>();
        ways_agree::<2>();
        ways_agree::<3>();
    }

    #[test]
    fn places_exactly_at_the_distance_are_linked_by_both_ways() {
        let lattice: Vec<Vector<f64, 2>> =
            (0..400).map(|k| Vector([f64::from(k % 20) * 3.0, f64::from(k / 20) * 3.0])).collect();
        for space in [Space::open(), Space::walled([60.0; 2]), Space::periodic([60.0; 2])] {
            assert_eq!(linked_by_cells(&space, &lattice, 3.0), vec![0; 400]);
            assert_eq!(linked_by_all_pairs(&space, &lattice, 3.0), vec![0; 400]);
            assert_eq!(nearest_by_grid(&space, &lattice), Some(vec![3.0; 400]));
        }
    }

    #[test]
    fn groups_are_numbered_by_their_first_place_and_no_chain_is_too_long() {
        let chain: Vec<Vector<f64, 1>> = (0..300).map(|k| Vector([f64::from((k * 7) % 300)])).collect();
        assert_eq!(linked(&Space::open(), &chain, 1.0), vec![0; 300]);
        assert_eq!(linked(&Space::open(), &chain, 0.5), Vec::from_iter(0..300));
        let two = [[0.0], [9.0], [1.0], [8.0]].map(Vector);
        assert_eq!(linked(&Space::open(), &two, 2.0), [0, 1, 0, 1]);
    }

    /// Clusters as the paper puts it: a cluster grows from each core in turn, and takes whom no other has taken.
    fn grown(members: usize, least: usize, near: &dyn Fn(usize, usize) -> bool) -> Vec<Option<usize>> {
        let around = |i: usize| (0..members).filter(|&j| near(i, j)).collect::<Vec<_>>();
        let mut cluster = vec![None; members];
        let mut clusters = 0;
        for start in 0..members {
            if cluster[start].is_some() || around(start).len() < least {
                continue;
            }
            let mut reached = vec![start];
            while let Some(i) = reached.pop() {
                if cluster[i].is_none() {
                    cluster[i] = Some(clusters);
                    if around(i).len() >= least {
                        reached.extend(around(i));
                    }
                }
            }
            clusters += 1;
        }
        cluster
    }

    #[test]
    fn dense_clusters_are_those_that_grow_from_cores() {
        for space in [Space::open(), Space::periodic([30.0, 30.0])] {
            for (n, least) in [(0, 3), (1, 1), (60, 3), (300, 3), (300, 4), (300, 6)] {
                let places = scattered::<2>(n, 30.0);
                for eps in [0.3, 1.5, 2.5, 40.0] {
                    let found = dense_clusters(n, least, |visit| pairs_within(&space, &places, eps, visit));
                    let near = |i: usize, j: usize| space.offset(places[i], places[j]).length() <= eps;
                    assert_eq!(found, grown(n, least, &near), "{n} at {eps} in {space:?}");
                }
            }
        }
    }

    #[test]
    fn coincident_and_lined_up_places() {
        let space = Space::open();
        let same = vec![Vector([3.0, 3.0]); 100];
        assert_eq!(nearest_distances(&space, &same), vec![0.0; 100]);
        assert_eq!(linked(&space, &same, 1e-9), vec![0; 100]);
        let line: Vec<Vector<f64, 2>> = (0..100).map(|k| Vector([f64::from(k), 5.0])).collect();
        assert_eq!(nearest_by_grid(&space, &line), Some(vec![1.0; 100]));
        let thin: Vec<Vector<f64, 2>> = line.iter().map(|p| Vector([p.0[0], 1e-9 * p.0[0]])).collect();
        assert_eq!(nearest_by_grid(&space, &thin), Some(nearest_by_all_pairs(&space, &thin)));
        assert_eq!(linked_by_cells(&space, &thin, 2.0), vec![0; 100]);
        assert_eq!(linked_by_cells(&Space::walled([1e-6; 2]), &line, 2.0), vec![0; 100], "beyond the walls");
        assert_eq!(nearest_distances::<2>(&space, &line[..1]), [f64::INFINITY]);
    }
}
