//! Who is near whom: the distance to the nearest other, and groups of linked members.
//!
//! Both come in two ways that give the same answer: over all pairs, and over the cells of a grid. The functions
//! without a way in their name choose the faster one.

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
    // a grid pays where the neighbourhood of a place, three cells a side, is a small part of the whole
    let cells: f64 = extents(space, places).iter().map(|extent| (extent / distance).max(1.0)).product();
    let sparse = places.len() > FEW && cells > 4.0 * 3.0f64.powi(D as i32);
    let by_grid = if sparse { linked_by_grid(space, places, distance) } else { None };
    by_grid.unwrap_or_else(|| linked_by_all_pairs(space, places, distance))
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

/// [`linked`] over the cells of a grid, by union-find. `None` where a grid cannot serve this space and distance.
pub fn linked_by_grid<const D: usize>(
    space: &Space<f64, D>,
    places: &[Vector<f64, D>],
    distance: f64,
) -> Option<Vec<usize>> {
    let grid = LiveGrid::new(space, distance, &columns(places))?;
    // the parent of a place never stands after it: the root of a tree is its first place
    let mut parent: Vec<usize> = (0..places.len()).collect();
    for (i, &place) in places.iter().enumerate() {
        for run in grid.around(i) {
            let members = grid.members(run);
            for j in members.rows[..members.count].iter().map(|&row| row as usize).filter(|&j| j < i) {
                if are_linked(space, place, places[j], distance) {
                    let (a, b) = (root(&mut parent, i), root(&mut parent, j));
                    parent[a.max(b)] = a.min(b);
                }
            }
        }
    }
    let mut groups = 0;
    let mut group = vec![0; places.len()];
    for i in 0..places.len() {
        let first = root(&mut parent, i);
        if first == i {
            group[i] = groups;
            groups += 1;
        } else {
            group[i] = group[first];
        }
    }
    Some(group)
}

fn are_linked<const D: usize>(
    space: &Space<f64, D>,
    here: Vector<f64, D>,
    there: Vector<f64, D>,
    distance: f64,
) -> bool {
    space.offset(here, there).length() <= distance
}

/// The root of a tree, with the path to it halved.
fn root(parent: &mut [usize], mut i: usize) -> usize {
    while parent[i] != i {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    i
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
                    for distance in [0.004, 0.02, 0.3, 2.0, 25.0, 600.0] {
                        let groups = linked_by_all_pairs(&space, &places, distance);
                        if let Some(by_grid) = linked_by_grid(&space, &places, distance) {
                            assert_eq!(by_grid, groups, "{n} in {space:?} at {distance}");
                            served += 1;
                        }
                        assert_eq!(linked(&space, &places, distance), groups);
                    }
                }
            }
        }
        assert!(served > 150, "the grid served only {served} times");
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
            assert_eq!(linked_by_grid(&space, &lattice, 3.0), Some(vec![0; 400]));
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
        assert_eq!(linked_by_grid(&space, &thin, 2.0), Some(vec![0; 100]));
        assert_eq!(linked_by_grid(&Space::walled([1e-6; 2]), &line, 2.0), Some(vec![0; 100]), "beyond the walls");
        assert_eq!(nearest_distances::<2>(&space, &line[..1]), [f64::INFINITY]);
    }
}
