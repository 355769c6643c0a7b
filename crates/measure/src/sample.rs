//! The members a metric is computed over, read once from a frame.

use crate::ground::{departure, geodesic, middle};
use crate::near::{linked, nearest_distances};
use crate::{Counted, Ground};
use space::{Edge, Frame, GroupRange, Real, Space, Vector};
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
    bodies: Vec<Option<Vector<f64, D>>>,
    /// Longitude and latitude, degrees; empty in the plane.
    places: Vec<[f64; 2]>,
    distances: OnceLock<Option<Vec<f64>>>,
    nearest: OnceLock<Vec<f64>>,
    groups: OnceLock<(f64, Vec<usize>)>,
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
            distances: OnceLock::new(),
            nearest: OnceLock::new(),
            groups: OnceLock::new(),
        };
        sample.fill(&Ground::Plane(space), members.into_iter().map(|(position, velocity)| (position, velocity, None)));
        sample
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
        (self.distances, self.nearest, self.groups) = (OnceLock::new(), OnceLock::new(), OnceLock::new());
        self.space = match ground {
            Ground::Plane(space) => *space,
            Ground::Globe => Space::open(),
        };
        for (position, velocity, body) in members {
            if position.finite() {
                self.positions.push(self.space.place(position));
                self.velocities.push(Some(velocity).filter(|v| v.finite()));
                self.bodies.push(body);
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
        let columns = frame.columns;
        let mut rows: Vec<usize> = members.iter().copied().filter(|&row| row < columns.len()).collect();
        rows.sort_unstable_by_key(|&row| (columns.id[row], row));
        rows.dedup();
        let wide = |v: Vector<R, D>| Vector(v.0.map(R::to_f64));
        let edges = frame.space.edges.map(|edge| match edge {
            Edge::Open => Edge::Open,
            Edge::Periodic(length) => Edge::Periodic(length.to_f64()),
            Edge::Walls(length) => Edge::Walls(length.to_f64()),
        });
        let member = |row| (wide(columns.position(row)), wide(columns.velocity(row)));
        Self::new(Space { edges }, rows.into_iter().map(member))
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
        self.bodies.iter().flatten().copied()
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
        self.distances.get_or_init(compute).as_deref()
    }
    /// Distances to the nearest other member, `[len]`. `None` for fewer than two members.
    pub fn nearest_distances(&self) -> Option<&[f64]> {
        (self.len() > 1).then(|| &self.nearest.get_or_init(|| nearest_distances(&self.space, &self.positions))[..])
    }
    /// Sizes of the groups that form when members at most `linking_distance` apart are linked, in the order of the
    /// lowest id in each.
    pub fn group_sizes(&self, linking_distance: f64) -> Vec<usize> {
        let compute = || {
            let mut sizes = Vec::new();
            for group in linked(&self.space, &self.positions, linking_distance) {
                if group == sizes.len() {
                    sizes.push(0);
                }
                sizes[group] += 1;
            }
            sizes
        };
        // the metrics of a list nearly always share one distance
        let (distance, sizes) = self.groups.get_or_init(|| (linking_distance, compute()));
        if *distance == linking_distance { sizes.clone() } else { compute() }
    }
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
