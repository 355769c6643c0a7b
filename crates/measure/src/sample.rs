//! The members a metric is computed over, read once from a frame.

use crate::domains;
use crate::ground::{departure, geodesic, middle, polygon};
use crate::hull::{Hull, flat_hull, solid_hull};
use crate::near::{
    components, dense_clusters, linked, nearest_distances, nearest_others, nearest_others_by, pairs_within,
};
use crate::{Counted, Ground};
use space::{Edge, Frame, GroupRange, Real, Space, Vector};
use std::borrow::Cow;
use std::sync::OnceLock;

/// Directions whose mean is at most this long cancel each other, and have no mean direction.
///
/// Far below the mean length of any sample of random directions (about 1/sqrt N), and above what rounding to f32
/// leaves of a sum that is zero.
pub(crate) const CANCELLED: f64 = 1e-6;

/// The members a metric is computed over: a snapshot in f64, in the order of their ids.
///
/// A member whose position is not finite is not there, and one whose velocity is not finite has no velocity: so
/// tracks with gaps can be read. What several metrics need (the centre, the nearest distances, the groups) is
/// computed when it is first asked for, and kept.
///
/// On the globe positions are those of a plane about the centre of the frame; see [`Ground::Globe`].
#[derive(Debug)]
pub struct Sample<const D: usize> {
    space: Space<f64, D>,
    positions: Vec<Vector<f64, D>>,
    velocities: Vec<Option<Vector<f64, D>>>,
    /// The known directions of bodies.
    bodies: Vec<Vector<f64, D>>,
    /// Longitude and latitude, degrees; empty in the plane.
    places: Vec<[f64; 2]>,
    kept: Kept<D>,
}

/// Up to so many members all distances are kept; beyond, a grid is faster for what is near.
const FEW: usize = 256;

/// What several metrics need of one sample.
#[derive(Debug)]
struct Kept<const D: usize> {
    to_centre: OnceLock<Option<Vec<f64>>>,
    pairs: OnceLock<Vec<f64>>,
    pair_mean_and_most: OnceLock<Option<(f64, f64)>>,
    nearest: OnceLock<Vec<f64>>,
    others: OnceLock<(usize, Option<Vec<(f64, u32)>>)>,
    groups: OnceLock<(f64, Vec<usize>)>,
    clusters: OnceLock<(f64, usize, Vec<Option<usize>>)>,
    unwrapped: OnceLock<Option<Vec<Vector<f64, D>>>>,
    hull: OnceLock<Option<Hull>>,
    solid: OnceLock<Option<(f64, f64)>>,
    domains: OnceLock<Option<Vec<f64>>>,
}

impl<const D: usize> Kept<D> {
    const fn nothing() -> Self {
        Self {
            to_centre: OnceLock::new(),
            pairs: OnceLock::new(),
            pair_mean_and_most: OnceLock::new(),
            nearest: OnceLock::new(),
            others: OnceLock::new(),
            groups: OnceLock::new(),
            clusters: OnceLock::new(),
            unwrapped: OnceLock::new(),
            hull: OnceLock::new(),
            solid: OnceLock::new(),
            domains: OnceLock::new(),
        }
    }
}

impl<const D: usize> Sample<D> {
    /// Members by position and velocity, in the order in which sums are to be taken.
    pub fn new(space: Space<f64, D>, members: impl IntoIterator<Item = (Vector<f64, D>, Vector<f64, D>)>) -> Self {
        let mut sample = Self {
            space,
            positions: Vec::new(),
            velocities: Vec::new(),
            bodies: Vec::new(),
            places: Vec::new(),
            kept: Kept::nothing(),
        };
        sample.fill(&Ground::Plane(space), members.into_iter().map(|(position, velocity)| (position, velocity, None)));
        sample
    }
    /// Nobody, in open space: to be filled.
    pub fn empty() -> Self {
        Self::new(Space::open(), [])
    }
    /// Puts other members in place of these, by position, velocity and, where it is known, the direction of the body (a unit
    /// vector). The memory is used again.
    pub fn fill(
        &mut self,
        ground: &Ground<D>,
        members: impl IntoIterator<Item = (Vector<f64, D>, Vector<f64, D>, Option<Vector<f64, D>>)>,
    ) {
        self.positions.clear();
        self.velocities.clear();
        self.bodies.clear();
        self.places.clear();
        self.kept = Kept::nothing();
        self.space = match ground {
            Ground::Plane(space) => *space,
            Ground::Globe => Space::open(),
        };
        let members = members.into_iter();
        self.positions.reserve(members.size_hint().0);
        self.velocities.reserve(members.size_hint().0);
        for (position, velocity, body) in members {
            if position.finite() {
                self.positions.push(self.space.place(position));
                self.velocities.push(Some(velocity).filter(|v| v.finite()));
                self.bodies.extend(body);
            }
        }
        if *ground == Ground::Globe {
            self.places.extend(self.positions.iter().map(|place| [place.0[0], place.0[1]]));
            if let Some(centre) = middle(self.places.iter().copied()) {
                for (position, &place) in self.positions.iter_mut().zip(&self.places) {
                    *position = Vector::of(&departure(centre, place).0);
                }
            }
        }
    }
    /// The members in these rows of a frame, in any order. A row given twice counts once; a row that the frame does
    /// not have is left out.
    pub fn of<R: Real>(frame: &Frame<'_, R, D>, members: &[usize]) -> Self {
        let mut sample = Self::empty();
        sample.read(frame, members);
        sample
    }
    /// Puts the members in these rows of a frame in place of these, as [`Sample::of`] does. The memory is used again.
    pub fn read<R: Real>(&mut self, frame: &Frame<'_, R, D>, members: &[usize]) {
        let columns = frame.columns;
        let there = |row: &usize| *row < columns.len();
        let rows = if members.iter().all(there) && members.is_sorted_by(|&a, &b| columns.id[a] < columns.id[b]) {
            Cow::Borrowed(members)
        } else {
            let mut rows: Vec<usize> = members.iter().copied().filter(there).collect();
            rows.sort_unstable_by_key(|&row| (columns.id[row], row));
            rows.dedup();
            Cow::Owned(rows)
        };
        let wide = |v: Vector<R, D>| Vector(v.0.map(R::to_f64));
        let edges = frame.space.edges.map(|edge| match edge {
            Edge::Open => Edge::Open,
            Edge::Periodic(length) => Edge::Periodic(length.to_f64()),
            Edge::Walls(length) => Edge::Walls(length.to_f64()),
        });
        let member = |&row| (wide(columns.position(row)), wide(columns.velocity(row)), None);
        self.fill(&Ground::Plane(Space { edges }), rows.iter().map(member));
    }
    /// Everyone in a frame.
    pub fn whole<R: Real>(frame: &Frame<'_, R, D>) -> Self {
        Self::of(frame, &Vec::from_iter(0..frame.columns.len()))
    }
    /// The members of one group of a frame.
    pub fn group<R: Real>(frame: &Frame<'_, R, D>, group: &GroupRange) -> Self {
        let inside = |row: &usize| frame.columns.id[*row].checked_sub(group.first).is_some_and(|k| k < group.count);
        Self::of(frame, &Vec::from_iter((0..frame.columns.len()).filter(inside)))
    }

    /// Number of members, that is of positions.
    pub fn len(&self) -> usize {
        self.positions.len()
    }
    /// Whether there are no members.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }
    /// How many members enter a metric.
    pub fn count(&self, counted: Counted) -> usize {
        match counted {
            Counted::Positions => self.len(),
            Counted::Velocities => self.velocities().count(),
            Counted::Headings => self.headings().count(),
            Counted::Bodies => self.bodies().count(),
        }
    }
    /// The space.
    pub fn space(&self) -> &Space<f64, D> {
        &self.space
    }
    /// Positions, `[len]`, inside the box on periodic axes.
    pub fn positions(&self) -> &[Vector<f64, D>] {
        &self.positions
    }
    /// Velocities, `[len]`, where they are known.
    pub fn known_velocities(&self) -> &[Option<Vector<f64, D>>] {
        &self.velocities
    }
    /// The known velocities.
    pub fn velocities(&self) -> impl Iterator<Item = Vector<f64, D>> {
        self.velocities.iter().flatten().copied()
    }
    /// Position and heading of those with a heading.
    pub fn headings(&self) -> impl Iterator<Item = (Vector<f64, D>, Vector<f64, D>)> {
        let moving = |(&position, velocity): (_, &Option<Vector<f64, D>>)| {
            velocity.filter(|v| !v.is_tiny()).map(|v| (position, v.unit()))
        };
        self.positions.iter().zip(&self.velocities).filter_map(moving)
    }

    /// The known directions of bodies, unit vectors.
    pub fn bodies(&self) -> impl Iterator<Item = Vector<f64, D>> {
        self.bodies.iter().copied()
    }
    /// Longitude and latitude of the members, degrees, `[len]`; empty in the plane.
    pub fn places(&self) -> &[[f64; 2]] {
        &self.places
    }
    /// The distance between two members: by minimum image in the plane, geodesic on the globe.
    pub fn distance(&self, i: usize, j: usize) -> f64 {
        match (self.places.get(i), self.places.get(j)) {
            (Some(&here), Some(&there)) => geodesic(here, there),
            _ => self.space.offset(self.positions[i], self.positions[j]).length(),
        }
    }

    /// The centre of the group; see [`Sample::from_centre`].
    pub fn centre(&self) -> Option<Vector<f64, D>> {
        let first = *self.positions.first()?;
        let offset = self.from_centre(&self.positions)?.first().copied()?;
        Some(self.space.place(first - offset))
    }
    /// Offsets of places from their centre, by minimum image. `None` without places or without a centre.
    ///
    /// The centre is the mean position on open and walled axes. On a periodic axis of length L it is the circular
    /// mean: places are angles 2 pi x/L, and the centre is the direction of the sum of their unit vectors. Where
    /// these cancel, as for places spread evenly round the axis, there is no centre. A circular mean is not the mean
    /// position seen from the seam: the two differ for a lopsided group, the more the wider it is.
    ///
    /// All is computed from offsets to the first place, so that coincident places give exact zeros anywhere.
    pub fn from_centre(&self, places: &[Vector<f64, D>]) -> Option<Vec<Vector<f64, D>>> {
        let first = *places.first()?;
        let mut offsets: Vec<_> = places.iter().map(|&place| self.space.offset(first, place)).collect();
        let n = places.len() as f64;
        let mut centre = Vector::ZERO;
        for a in 0..D {
            let along = offsets.iter().map(|offset| offset.0[a]);
            centre.0[a] = match self.space.edges[a] {
                Edge::Open | Edge::Walls(_) => along.sum::<f64>() / n,
                Edge::Periodic(length) => {
                    let angle = |x: f64| Vector::<f64, 2>::at_angle(x / length * f64::TAU);
                    let mean = along.fold(Vector::ZERO, |sum, x| sum + angle(x)) / n;
                    if mean.length() <= CANCELLED {
                        return None;
                    }
                    mean.angle() / f64::TAU * length
                }
            };
        }
        for offset in &mut offsets {
            *offset = self.space.minimal(*offset - centre);
        }
        Some(offsets)
    }
    /// Distances to the centre of the group, `[len]`. `None` without members or without a centre.
    pub fn distances_to_centre(&self) -> Option<&[f64]> {
        let compute = || Some(self.from_centre(&self.positions)?.into_iter().map(Vector::length).collect());
        self.kept.to_centre.get_or_init(compute).as_deref()
    }
    /// Positions as if there were no seam: on periodic axes offsets from the centre. `None` without members, or without a
    /// centre on a periodic axis.
    pub fn unwrapped(&self) -> Option<&[Vector<f64, D>]> {
        let compute = || {
            if !self.space.is_periodic() {
                return Some(self.positions.clone());
            }
            let mut places = self.from_centre(&self.positions)?;
            for (place, position) in places.iter_mut().zip(&self.positions) {
                for a in (0..D).filter(|&a| self.space.periods()[a].is_none()) {
                    place.0[a] = position.0[a];
                }
            }
            Some(places)
        };
        self.kept.unwrapped.get_or_init(compute).as_deref().filter(|places| !places.is_empty())
    }
    /// The convex hull of [`Sample::unwrapped`] in two dimensions. `None` in others, and where all members are on one line.
    pub fn hull(&self) -> Option<&Hull> {
        self.kept.hull.get_or_init(|| if D == 2 { flat_hull(self.unwrapped()?) } else { None }).as_ref()
    }
    /// Area and perimeter of the [`Sample::hull`]; on the globe its sides are geodesics between the same corners.
    pub fn hull_area_and_perimeter(&self) -> Option<(f64, f64)> {
        let hull = self.hull()?;
        if self.places.is_empty() {
            return Some((hull.area, hull.perimeter));
        }
        Some(polygon(hull.corners.iter().map(|&corner| self.places[corner])))
    }
    /// Volume and surface of the convex hull of [`Sample::unwrapped`] in three dimensions. `None` in others, and where all members
    /// are in one plane.
    pub fn solid_hull(&self) -> Option<(f64, f64)> {
        let compute = || {
            let places: Vec<_> = self.unwrapped()?.iter().map(|place| Vector::of(&place.0)).collect();
            solid_hull(&places)
        };
        *self.kept.solid.get_or_init(|| if D == 3 { compute() } else { None })
    }
    /// The domain of danger of each member within the convex hull, `[len]`, length^2; on a line from the first member to the last.
    /// `None` without a hull, and in three dimensions.
    pub fn domains_of_danger(&self) -> Option<&[f64]> {
        let compute = || {
            let places = self.unwrapped()?;
            if D == 1 {
                return Some(domains::on_line(Edge::Open, &Vec::from_iter(places.iter().map(|place| place.0[0]))));
            }
            let places: Vec<_> = places.iter().map(|place| Vector::of(&place.0)).collect();
            let arena: Vec<_> = self.hull()?.corners.iter().map(|&corner| places[corner]).collect();
            Some(domains::in_arena(&places, &arena))
        };
        self.kept.domains.get_or_init(compute).as_deref()
    }
    /// Distances between all members, `[len][len]`, where there are few of them.
    fn pairs(&self) -> Option<&[f64]> {
        let n = self.len();
        let compute = || {
            let mut pairs = vec![0.0; n * n];
            if self.places.is_empty() {
                let plain = !self.space.is_periodic();
                for (row, &here) in pairs.chunks_exact_mut(n.max(1)).zip(&self.positions) {
                    for (pair, &there) in row.iter_mut().zip(&self.positions) {
                        *pair = if plain { there - here } else { self.space.offset(here, there) }.length();
                    }
                }
            } else {
                for i in 0..n {
                    for j in i + 1..n {
                        pairs[i * n + j] = self.distance(i, j);
                        pairs[j * n + i] = pairs[i * n + j];
                    }
                }
            }
            pairs
        };
        (n <= FEW).then(|| &self.kept.pairs.get_or_init(compute)[..])
    }
    /// Calls `visit(i, j)` for each pair of members at most `distance` apart, once, in any order.
    pub fn pairs_within(&self, distance: f64, visit: &mut dyn FnMut(usize, usize)) {
        let n = self.len();
        if let Some(pairs) = self.pairs() {
            for i in 0..n {
                let beyond = pairs[i * n..(i + 1) * n].iter().enumerate().skip(i + 1);
                beyond.filter(|&(_, &pair)| pair <= distance).for_each(|(j, _)| visit(i, j));
            }
        } else if self.places.is_empty() {
            pairs_within(&self.space, &self.positions, distance, visit);
        } else {
            let all = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
            all.filter(|&(i, j)| self.distance(i, j) <= distance).for_each(|(i, j)| visit(i, j));
        }
    }
    /// Calls `visit(i, j, distance)` for each pair of members, once, in the order of `i`, then `j`.
    pub fn each_pair(&self, mut visit: impl FnMut(usize, usize, f64)) {
        let n = self.len();
        for i in 0..n {
            for j in i + 1..n {
                let distance = self.pairs().map_or_else(|| self.distance(i, j), |pairs| pairs[i * n + j]);
                visit(i, j, distance);
            }
        }
    }
    /// Mean and greatest distance of all pairs of members. `None` for fewer than two members.
    ///
    /// Its cost grows with the square of their number.
    pub fn mean_and_greatest_pair_distance(&self) -> Option<(f64, f64)> {
        let compute = || {
            let (mut sum, mut most) = (0.0, 0.0f64);
            let n = self.len();
            if let Some(pairs) = self.pairs() {
                for i in 0..n {
                    for &pair in &pairs[i * n + i + 1..(i + 1) * n] {
                        sum += pair;
                        most = most.max(pair);
                    }
                }
            } else {
                self.each_pair(|_, _, distance| {
                    sum += distance;
                    most = most.max(distance);
                });
            }
            let count = n as f64 * (n as f64 - 1.0) / 2.0;
            (n > 1).then(|| (sum / count, most))
        };
        *self.kept.pair_mean_and_most.get_or_init(compute)
    }
    /// Distances to the nearest other member, `[len]`. `None` for fewer than two members.
    pub fn nearest_distances(&self) -> Option<&[f64]> {
        let n = self.len();
        let compute = || match self.pairs() {
            Some(pairs) => {
                let others = |i: usize| pairs[i * n..i * n + i].iter().chain(&pairs[i * n + i + 1..(i + 1) * n]);
                (0..n).map(|i| others(i).copied().fold(f64::INFINITY, f64::min)).collect()
            }
            None if self.places.is_empty() => nearest_distances(&self.space, &self.positions),
            None => {
                let others = |i: usize| (0..n).filter(move |&j| j != i).map(move |j| self.distance(i, j));
                (0..n).map(|i| others(i).fold(f64::INFINITY, f64::min)).collect()
            }
        };
        (n > 1).then(|| &self.kept.nearest.get_or_init(compute)[..])
    }
    /// Distance and index of the `count` nearest others of each member, the nearest first (ties by index), `[len][count]`.
    /// `None` for fewer others.
    pub fn nearest_others(&self, count: usize) -> Option<Cow<'_, [(f64, u32)]>> {
        let n = self.len();
        let compute = || match self.pairs() {
            _ if n <= count => None,
            Some(pairs) => nearest_others_by(n, count, |i, j| pairs[i * n + j]),
            None if self.places.is_empty() => nearest_others(&self.space, &self.positions, count),
            None => nearest_others_by(n, count, |i, j| self.distance(i, j)),
        };
        let (kept, others) = self.kept.others.get_or_init(|| (count, compute()));
        if *kept == count { others.as_deref().map(Cow::Borrowed) } else { compute().map(Cow::Owned) }
    }
    /// The group of each member when members at most `linking_distance` apart are linked, `[len]`: numbered from 0 in the order
    /// of the lowest id in each.
    pub fn groups(&self, linking_distance: f64) -> Cow<'_, [usize]> {
        let n = self.len();
        let compute = || match self.pairs() {
            Some(pairs) => components(n, |i, j| pairs[i * n + j] <= linking_distance),
            None if self.places.is_empty() => linked(&self.space, &self.positions, linking_distance),
            None => components(n, |i, j| self.distance(i, j) <= linking_distance),
        };
        // the metrics of a list nearly always share one distance
        let (distance, groups) = self.kept.groups.get_or_init(|| (linking_distance, compute()));
        if *distance == linking_distance { Cow::Borrowed(groups) } else { Cow::Owned(compute()) }
    }
    /// Sizes of the [`Sample::groups`].
    pub fn group_sizes(&self, linking_distance: f64) -> Vec<usize> {
        sizes(self.groups(linking_distance).iter().copied())
    }
    /// The members of the largest of the [`Sample::groups`], as a sample of their own; of equally large ones the first.
    pub fn largest_group(&self, linking_distance: f64) -> Self {
        let groups = self.groups(linking_distance);
        let sizes = self.group_sizes(linking_distance);
        let most = sizes.iter().copied().max();
        let largest = sizes.iter().position(|&size| Some(size) == most);
        let mut part = Self::new(self.space, []);
        for i in (0..self.len()).filter(|&i| Some(groups[i]) == largest) {
            part.positions.push(self.positions[i]);
            part.velocities.push(self.velocities[i]);
            part.bodies.push(self.bodies[i]);
            part.places.extend(self.places.get(i));
        }
        part
    }
    /// The dense cluster of each member, `[len]`; `None`: noise. See [`dense_clusters`].
    pub fn dense_clusters(&self, eps: f64, min_samples: usize) -> Cow<'_, [Option<usize>]> {
        let compute = || dense_clusters(self.len(), min_samples, |visit| self.pairs_within(eps, visit));
        let (distance, least, clusters) = self.kept.clusters.get_or_init(|| (eps, min_samples, compute()));
        if (*distance, *least) == (eps, min_samples) { Cow::Borrowed(clusters) } else { Cow::Owned(compute()) }
    }
}

/// How often each number from 0 on occurs.
pub(crate) fn sizes(numbers: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut sizes = Vec::new();
    for number in numbers {
        if number >= sizes.len() {
            sizes.resize(number + 1, 0);
        }
        sizes[number] += 1;
    }
    sizes
}

/// Mean and standard deviation (divisor n - 1) of numbers; `None` for fewer than two.
pub(crate) fn spread(values: &[f64]) -> Option<(f64, f64)> {
    let mean = mean(values.iter().copied())?;
    let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
    (values.len() > 1).then(|| (mean, (squares / (values.len() as f64 - 1.0)).sqrt()))
}

/// Mean of numbers; `None` of no numbers.
pub(crate) fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    (count > 0.0).then(|| sum / count)
}

/// Mean of vectors; `None` of no vectors.
pub(crate) fn mean_vector<const D: usize>(vectors: impl Iterator<Item = Vector<f64, D>>) -> Option<Vector<f64, D>> {
    let (sum, count) = vectors.fold((Vector::ZERO, 0.0), |(sum, count), v| (sum + v, count + 1.0));
    (count > 0.0).then(|| sum / count)
}
