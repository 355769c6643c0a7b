//! Robots instead of walls: the posts that stand for a wall, who goes to which, which way, and the walls that posts stand for.

use crate::TerrainError;
use crate::arrangement::hull;
use crate::geometry::{Point, regular};
use crate::workspace::within;
use space::segment::Relation;
use space::{Segment, Vector};

/// Where the posts of a wall stand along it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Spacing {
    /// In the middles of equal cells, so that the gaps at both ends are half as wide as those between posts.
    #[default]
    Cells,
    /// From end to end; a single post stands in the middle.
    Ends,
}

/// The posts for a wall, from its first end to its second.
pub fn posts(wall: &Segment, count: usize, spacing: Spacing) -> Vec<Point> {
    let share = |j: usize| match spacing {
        Spacing::Cells => (2 * j + 1) as f64 / (2 * count) as f64,
        Spacing::Ends if count == 1 => 0.5,
        Spacing::Ends => j as f64 / (count - 1) as f64,
    };
    (0..count).map(|j| wall.at(share(j))).collect()
}

/// Least number of posts so that no gap between neighbours, each of this body radius, is wider than `most`.
///
/// # Errors
/// A gap that is not a positive number.
pub fn posts_for_gap(wall: &Segment, most: f64, radius: f64, spacing: Spacing) -> Result<usize, TerrainError> {
    if !(most > 0.0 && most.is_finite()) {
        return Err(TerrainError::range("gap", "a finite number above 0", most));
    }
    let cells = (wall.length() / (most + 2.0 * radius.max(0.0))).ceil();
    Ok(cells as usize + usize::from(spacing == Spacing::Ends)).map(|count| count.max(1))
}

/// The least total cost of giving each row a column of its own, and that column for each row.
///
/// Shortest augmenting paths (Kuhn's Hungarian method), rows in order; of equally cheap columns the first is taken.
/// With more rows than columns each column is given a row instead, and the rows left over get `None`.
///
/// # Errors
/// Rows of different lengths, or a cost that is not finite.
pub fn assignment(cost: &[Vec<f64>]) -> Result<(f64, Vec<Option<usize>>), TerrainError> {
    let columns = cost.first().map_or(0, Vec::len);
    if let Some(row) = cost.iter().find(|row| row.len() != columns) {
        return Err(TerrainError::range("row of costs", format!("{columns} numbers"), row.len() as f64));
    }
    if let Some(&bad) = cost.iter().flatten().find(|cost| !cost.is_finite()) {
        return Err(TerrainError::range("cost", "a finite number", bad));
    }
    let chosen = if cost.len() <= columns {
        assigned(cost.len(), columns, |row, column| cost[row][column]).into_iter().map(Some).collect()
    } else {
        let mut chosen = vec![None; cost.len()];
        for (column, row) in assigned(columns, cost.len(), |column, row| cost[row][column]).into_iter().enumerate() {
            chosen[row] = Some(column);
        }
        chosen
    };
    let pairs = chosen.iter().enumerate().filter_map(|(row, column)| Some(cost[row][(*column)?]));
    Ok((pairs.sum(), chosen))
}

/// The column of each row; no more rows than columns.
fn assigned(rows: usize, columns: usize, cost: impl Fn(usize, usize) -> f64) -> Vec<usize> {
    // potentials keep reduced costs at 0 or more, so that shortest paths can be grown one column at a time
    let (mut of_row, mut of_column) = (vec![0.0; rows], vec![0.0; columns]);
    let mut owner: Vec<Option<usize>> = vec![None; columns];
    for first in 0..rows {
        let mut distance = vec![f64::INFINITY; columns];
        let mut before: Vec<Option<usize>> = vec![None; columns];
        let mut done = vec![false; columns];
        let (mut row, mut from, mut reached) = (first, None, 0.0);
        let end = loop {
            let mut nearest: Option<usize> = None;
            for column in (0..columns).filter(|&column| !done[column]) {
                let through = reached + cost(row, column) - of_row[row] - of_column[column];
                if through < distance[column] {
                    (distance[column], before[column]) = (through, from);
                }
                if nearest.is_none_or(|nearest| distance[column] < distance[nearest]) {
                    nearest = Some(column);
                }
            }
            let Some(column) = nearest else { break None };
            done[column] = true;
            reached = distance[column];
            from = Some(column);
            match owner[column] {
                Some(next) => row = next,
                None => break Some(column),
            }
        };
        let Some(end) = end else { continue };
        of_row[first] += reached;
        for column in (0..columns).filter(|&column| done[column] && column != end) {
            if let Some(owner) = owner[column] {
                of_row[owner] += reached - distance[column];
            }
            of_column[column] -= reached - distance[column];
        }
        let mut column = end;
        loop {
            match before[column] {
                Some(previous) => {
                    owner[column] = owner[previous];
                    column = previous;
                }
                None => {
                    owner[column] = Some(first);
                    break;
                }
            }
        }
    }
    let mut chosen = vec![0; rows];
    for (column, row) in owner.into_iter().enumerate() {
        if let Some(row) = row {
            chosen[row] = column;
        }
    }
    chosen
}

/// The least total distance from robots to posts, and the post of each robot; robots too many have none.
///
/// # Errors
/// A coordinate that is not finite.
pub fn assign_to_posts(robots: &[Point], posts: &[Point]) -> Result<(f64, Vec<Option<usize>>), TerrainError> {
    let cost: Vec<Vec<f64>> =
        robots.iter().map(|robot| posts.iter().map(|post| (*post - *robot).length()).collect()).collect();
    assignment(&cost)
}

/// Corners of the polygon that stands for a disc.
const SIDES: usize = 8;

/// The shortest way from a place to another round discs of radius `margin` about some points, by the corners of the polygon that holds
/// them; its last point is `to`. Straight where nothing is in the way, and where either end is among the discs.
pub fn way_round(from: Point, to: Point, points: &[Point], margin: f64) -> Vec<Point> {
    // around the disc, not inside it
    let reach = margin / (std::f64::consts::PI / SIDES as f64).cos();
    let corners: Vec<Point> = points.iter().flat_map(|&point| regular(point, reach, SIDES)).collect();
    let round = hull(&corners);
    let straight = Segment { from, to };
    let edges = (0..round.len()).map(|k| Segment { from: round[k], to: round[(k + 1) % round.len()] });
    let crossed = edges.filter(|edge| edge.relation(&straight) == Relation::Proper).count();
    if round.len() < 3 || crossed < 2 || within(&round, from) || within(&round, to) {
        return vec![to];
    }
    let all: Vec<Point> = round.iter().copied().chain([from, to]).collect();
    let ring = hull(&all);
    let place = |wanted: Point| ring.iter().position(|corner| *corner == wanted);
    let (Some(begin), Some(end)) = (place(from), place(to)) else { return vec![to] };
    let count = ring.len();
    let onward: Vec<Point> = (1..=(end + count - begin) % count).map(|k| ring[(begin + k) % count]).collect();
    let back: Vec<Point> = (1..=(begin + count - end) % count).map(|k| ring[(begin + count - k) % count]).collect();
    let length = |way: &[Point]| way.iter().fold((0.0, from), |(sum, at), &next| (sum + (next - at).length(), next)).0;
    if length(&back) < length(&onward) { back } else { onward }
}

/// The way back: the walls that posts stand for, and the posts that stand for none. Posts no farther apart than `gap` are of one
/// wall; a wall goes along its posts' longest extent, from end to end, or half a cell beyond where they stand in cells.
pub fn walls_of(posts: &[Point], gap: f64, spacing: Spacing) -> (Vec<Segment>, Vec<Point>) {
    let (mut walls, mut alone) = (Vec::new(), Vec::new());
    let mut left: Vec<Point> = posts.to_vec();
    while let Some(first) = left.pop() {
        let mut own = vec![first];
        while let Some(next) = left.iter().position(|&post| own.iter().any(|&other| (post - other).length() <= gap)) {
            own.push(left.remove(next));
        }
        let pairs = own.iter().flat_map(|&a| own.iter().map(move |&b| (a, b)));
        let far = pairs.max_by(|x, y| (x.1 - x.0).length().total_cmp(&(y.1 - y.0).length()));
        let Some((from, to)) = far.filter(|(from, to)| from != to) else {
            alone.push(first);
            continue;
        };
        let beyond = match spacing {
            Spacing::Cells => (to - from) / (2.0 * (own.len() - 1) as f64),
            Spacing::Ends => Vector::ZERO,
        };
        walls.push(Segment { from: from - beyond, to: to + beyond });
    }
    (walls, alone)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::draws::Draws;
    use space::Vector;

    #[test]
    fn posts_in_cells_and_from_end_to_end() {
        let wall = Segment::new([0.0, 0.0], [3.0, 0.0]);
        let along = |count, spacing| posts(&wall, count, spacing).iter().map(|p| p[0]).collect::<Vec<_>>();
        assert_eq!(along(3, Spacing::Cells), [0.5, 1.5, 2.5]);
        assert_eq!(along(3, Spacing::Ends), [0.0, 1.5, 3.0]);
        assert_eq!((along(1, Spacing::Ends), along(1, Spacing::Cells)), (vec![1.5], vec![1.5]));
        assert_eq!(along(0, Spacing::Cells), []);
        assert_eq!(posts_for_gap(&wall, 0.8, 0.1, Spacing::Cells), Ok(3));
        assert_eq!(posts_for_gap(&wall, 0.8, 0.1, Spacing::Ends), Ok(4));
        assert!(posts_for_gap(&wall, 0.0, 0.1, Spacing::Ends).is_err());
    }

    /// The least cost over all ways, one row after the other.
    fn by_all_ways(cost: &[Vec<f64>], used: &mut Vec<usize>) -> f64 {
        let Some(row) = cost.get(used.len()) else { return 0.0 };
        let mut least = f64::INFINITY;
        for column in (0..row.len()).filter(|column| !used.contains(column)).collect::<Vec<_>>() {
            used.push(column);
            least = least.min(row[column] + by_all_ways(cost, used));
            used.pop();
        }
        least
    }

    #[test]
    fn no_way_is_cheaper() {
        for attempt in 0..300 {
            let draws = Draws::new(8, attempt, 0);
            let rows = 1 + draws.below("rows", 5);
            let columns = rows + draws.below("columns", 3);
            // whole costs, some negative, many equal
            let number = |r: usize, c: usize| (draws.uniform("cost", (r * 10 + c) as u32) * 9.0).floor() - 2.0;
            let cost: Vec<Vec<f64>> = (0..rows).map(|r| (0..columns).map(|c| number(r, c)).collect()).collect();
            let (least, chosen) = assignment(&cost).unwrap();
            assert_eq!(least, by_all_ways(&cost, &mut Vec::new()), "{cost:?}");
            let mut columns: Vec<_> = chosen.iter().flatten().collect();
            columns.sort_unstable();
            columns.dedup();
            assert_eq!(columns.len(), rows);
            let turned: Vec<Vec<f64>> = (0..cost[0].len()).map(|c| cost.iter().map(|row| row[c]).collect()).collect();
            let (same, chosen) = assignment(&turned).unwrap();
            assert_eq!((same, chosen.iter().flatten().count()), (least, rows));
        }
    }

    #[test]
    fn ties_go_to_the_first_and_nobody_is_no_error() {
        assert_eq!(assignment(&[vec![1.0, 1.0], vec![1.0, 1.0]]).unwrap(), (2.0, vec![Some(0), Some(1)]));
        assert_eq!(assignment(&[]).unwrap(), (0.0, vec![]));
        assert_eq!(assignment(&[vec![], vec![]]).unwrap(), (0.0, vec![None, None]));
        assert!(assignment(&[vec![1.0], vec![]]).is_err() && assignment(&[vec![f64::NAN]]).is_err());
        let (distance, chosen) =
            assign_to_posts(&[Vector([0.0, 0.0]), Vector([9.0, 0.0])], &[Vector([8.0, 0.0])]).unwrap();
        assert_eq!((distance, chosen), (1.0, vec![None, Some(0)]));
    }

    #[test]
    fn ways_go_round_the_shorter_side_and_keep_the_margin() {
        let (from, to) = (Vector([-3.0, 0.2]), Vector([3.0, 0.2]));
        assert_eq!(way_round(from, to, &[Vector([0.0, 5.0])], 1.0), [to], "nothing is in the way");
        assert_eq!(way_round(from, to, &[], 1.0), [to]);
        assert_eq!(way_round(Vector([0.1, 0.0]), to, &[Vector([0.0, 0.0])], 1.0), [to], "it begins among them");
        let group = [Vector([0.0, 0.0]), Vector([0.5, 0.0])];
        let way = way_round(from, to, &group, 1.0);
        assert!(way.len() > 2 && way.iter().all(|corner| corner[1] > 0.0), "above: {way:?}");
        let mut at = from;
        for next in way {
            let step = Segment { from: at, to: next };
            assert!(group.iter().all(|&member| step.distance(member) >= 1.0 - 1e-12));
            at = next;
        }
        assert_eq!(at, to);
    }

    #[test]
    fn posts_tell_their_walls() {
        let walls = [Segment::new([0.0, 0.0], [3.0, 0.0]), Segment::new([5.0, 1.0], [5.0, 2.5])];
        for spacing in [Spacing::Cells, Spacing::Ends] {
            let all: Vec<Point> = walls.iter().flat_map(|wall| posts(wall, 3, spacing)).collect();
            let (back, alone) = walls_of(&all, 1.6, spacing);
            assert_eq!((back.len(), alone.len()), (2, 0));
            for wall in &walls {
                let same = |other: &Segment| {
                    let apart = |a: Point, b: Point| (a - b).length() < 1e-12;
                    apart(other.from, wall.from) && apart(other.to, wall.to)
                        || apart(other.from, wall.to) && apart(other.to, wall.from)
                };
                assert!(back.iter().any(same), "{wall:?} among {back:?}");
            }
        }
        assert_eq!(walls_of(&[Vector([1.0, 1.0])], 1.0, Spacing::Cells), (vec![], vec![Vector([1.0, 1.0])]));
        assert_eq!(walls_of(&[], 1.0, Spacing::Cells), (vec![], vec![]));
    }
}
