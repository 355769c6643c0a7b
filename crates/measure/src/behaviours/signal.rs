//! Signals: numbers that a behaviour reads from a group at every step.

use super::BehaviourError;
use super::blocks::{centroid, entropy_ratio, sample_deviation};
use super::watch::Moment;
use crate::near::{components, linked};
use space::segment::{Passage, Relation};
use space::shape::Shape;
use space::{Segment, Space, Vector};
use std::fmt;

type Point = Vector<f64, 2>;

/// The named things of an environment that behaviours refer to (lengths).
#[derive(Clone, Debug, Default)]
pub struct Setting {
    /// Walls, for what is visible and for distances to walls.
    pub walls: Vec<Segment>,
    /// Points by name.
    pub places: Vec<(String, Point)>,
    /// Regions by name: what is inside them or on their boundary counts as inside.
    pub regions: Vec<(String, Shape<f64, 2>)>,
    /// Gates by name.
    pub gates: Vec<(String, Segment)>,
    /// Trajectories that are wanted, by name.
    pub paths: Vec<(String, Vec<Point>)>,
}

impl Setting {
    /// The place of a name.
    ///
    /// # Errors
    /// Where there is none.
    pub fn place(&self, name: &str) -> Result<Point, BehaviourError> {
        named("place", &self.places, name).copied()
    }
    /// The region of a name.
    ///
    /// # Errors
    /// Where there is none.
    pub fn region(&self, name: &str) -> Result<Shape<f64, 2>, BehaviourError> {
        named("region", &self.regions, name).cloned()
    }
    /// The gate of a name.
    ///
    /// # Errors
    /// Where there is none.
    pub fn gate(&self, name: &str) -> Result<Segment, BehaviourError> {
        named("gate", &self.gates, name).copied()
    }
}

fn named<'a, T>(kind: &'static str, list: &'a [(String, T)], name: &str) -> Result<&'a T, BehaviourError> {
    match list.iter().find(|(known, _)| known == name) {
        Some((_, found)) => Ok(found),
        None => Err(BehaviourError::unknown(kind, name, list.iter().map(|(known, _)| known.as_str()))),
    }
}

/// Who belongs to one group.
#[derive(Clone, Debug, PartialEq)]
pub struct Membership {
    /// Members at most so far apart are linked (length).
    pub distance: f64,
    /// Walls that cut links; none where they do not.
    pub walls: Vec<Segment>,
}

impl Membership {
    /// By distance alone.
    pub fn within(distance: f64) -> Self {
        Self { distance, walls: Vec::new() }
    }
    /// Sizes of the groups, in the order of their first members.
    pub fn sizes(&self, places: &[Point]) -> Vec<usize> {
        let group = if self.walls.is_empty() {
            linked(&Space::open(), places, self.distance)
        } else {
            components(places.len(), |i, j| {
                let (from, to) = (places[i], places[j]);
                let sight = Segment { from, to };
                (to - from).length() <= self.distance
                    && self.walls.iter().all(|wall| wall.relation(&sight) == Relation::Apart)
            })
        };
        let mut sizes = vec![0; group.iter().max().map_or(0, |&last| last + 1)];
        group.into_iter().for_each(|group| sizes[group] += 1);
        sizes
    }
}

/// A number that a behaviour reads from a group at every step. Shares are of all members there ever were.
#[derive(Clone, Debug, PartialEq)]
pub enum Signal {
    /// Number of groups.
    GroupCount(Membership),
    /// Share of the largest group among those there are.
    LargestShare(Membership),
    /// Entropy of the shares of the groups over that of equal shares.
    EntropyRatio(Membership),
    /// Distance of the centroid to a point.
    CentroidDistance(Point),
    /// Coordinate of the centroid along an axis.
    Centroid(usize),
    /// Root mean squared distance to the centroid.
    Spread,
    /// Standard deviation along an axis, with the divisor n - 1.
    Deviation(usize),
    /// Length of the mean heading.
    Polarisation,
    /// How close to a line the members are: 1 - second over first standard deviation along the principal axes.
    Line,
    /// Share inside a region.
    ShareIn(Shape<f64, 2>),
    /// Share that has ever been inside a region.
    ShareVisited(Shape<f64, 2>),
    /// Share that has ever crossed a gate, to this side or to either.
    ShareCrossed(Segment, Option<Passage>),
    /// Share that has crossed these gates in their order, and then been inside a region within so many steps.
    ShareThrough {
        /// The gates.
        gates: Vec<Segment>,
        /// The region.
        goal: Shape<f64, 2>,
        /// Steps within which it must be reached.
        within: u64,
    },
    /// Share of the members of a type that are inside a region.
    TypeShareIn(Shape<f64, 2>, usize),
    /// Share of those inside any of the regions that are of the commonest type of theirs.
    Purity(Vec<Shape<f64, 2>>),
    /// Share inside any of the regions.
    SharePlaced(Vec<Shape<f64, 2>>),
    /// Mean distance to a line of points.
    PathError(Vec<Point>),
    /// Least distance of a member to a wall.
    WallDistance(Vec<Segment>),
    /// Share that is there.
    Alive,
}

/// Whether a point is inside a region or on its boundary.
fn inside(region: &Shape<f64, 2>, p: Point) -> bool {
    region.nearest(p).distance <= 0.0
}

impl Signal {
    /// Whether it can only grow, since whoever has done it has done it for good.
    pub(super) fn latched(&self) -> bool {
        matches!(self, Self::ShareVisited(_) | Self::ShareCrossed(..) | Self::ShareThrough { .. })
    }

    /// Its value at a moment; `None` where it is undefined there, as for nobody. `progress` is what each member has done
    /// so far, `before` the positions a step earlier, and `step` the number of the step.
    pub(super) fn value(
        &self,
        moment: &Moment<'_>,
        before: &[Option<Point>],
        progress: &mut [usize],
        step: u64,
    ) -> Option<f64> {
        let there: Vec<Point> = moment.positions.iter().flatten().copied().filter(|p| p.finite()).collect();
        let all = moment.positions.len();
        let share = |count: usize, of: usize| (of > 0).then(|| count as f64 / of as f64);
        match self {
            Self::GroupCount(membership) => Some(membership.sizes(&there).len() as f64),
            Self::LargestShare(membership) => {
                share(membership.sizes(&there).into_iter().max().unwrap_or(0), there.len())
            }
            Self::EntropyRatio(membership) => (!there.is_empty()).then(|| entropy_ratio(&membership.sizes(&there))),
            Self::CentroidDistance(p) => centroid(&there).map(|centre| (centre - *p).length()),
            Self::Centroid(axis) => centroid(&there).map(|centre| centre[*axis]),
            Self::Spread => {
                let centre = centroid(&there)?;
                let squares: f64 = there.iter().map(|&p| (p - centre).length_squared()).sum();
                Some((squares / there.len() as f64).sqrt())
            }
            Self::Deviation(axis) => sample_deviation(&there.iter().map(|p| p[*axis]).collect::<Vec<_>>()),
            Self::Polarisation => {
                let headings = moment.velocities.iter().flatten().filter(|v| !v.is_tiny()).map(|v| v.unit());
                let headings: Vec<Point> = headings.collect();
                centroid(&headings).map(Vector::length)
            }
            Self::Line => line(&there),
            Self::ShareIn(region) => share(there.iter().filter(|&&p| inside(region, p)).count(), all),
            Self::ShareVisited(_) | Self::ShareCrossed(..) | Self::ShareThrough { .. } => {
                let done = self.progressed(moment, before, progress, step);
                share(done, all)
            }
            Self::TypeShareIn(region, wanted) => {
                let of_type = |k: &usize| moment.types.get(*k).copied().unwrap_or(0) == *wanted;
                let members: Vec<usize> = (0..all).filter(of_type).collect();
                let placed = |k: &&usize| moment.positions[**k].is_some_and(|p| inside(region, p));
                share(members.iter().filter(placed).count(), members.len())
            }
            Self::Purity(regions) => purity(regions, moment),
            Self::SharePlaced(regions) => {
                share(there.iter().filter(|&&p| regions.iter().any(|region| inside(region, p))).count(), all)
            }
            Self::PathError(path) => {
                let legs: Vec<Segment> = path.windows(2).map(|two| Segment { from: two[0], to: two[1] }).collect();
                let distance = |p: &Point| legs.iter().map(|leg| leg.distance(*p)).fold(f64::INFINITY, f64::min);
                let sum: f64 = there.iter().map(distance).sum();
                (!there.is_empty()).then(|| sum / there.len() as f64)
            }
            Self::WallDistance(walls) => {
                let all = there.iter().flat_map(|&p| walls.iter().map(move |wall| wall.distance(p)));
                all.min_by(f64::total_cmp)
            }
            Self::Alive => share(there.len(), all),
        }
    }

    /// How many have now done what a latched signal counts.
    fn progressed(&self, moment: &Moment<'_>, before: &[Option<Point>], progress: &mut [usize], step: u64) -> usize {
        let (gates, side, goal, within): (&[Segment], _, _, _) = match self {
            Self::ShareCrossed(gate, side) => (std::slice::from_ref(gate), *side, None, u64::MAX),
            Self::ShareVisited(region) => (&[], None, Some(region), u64::MAX),
            Self::ShareThrough { gates, goal, within } => (gates, None, Some(goal), *within),
            _ => return 0,
        };
        let wanted = gates.len() + usize::from(goal.is_some());
        for (k, done) in progress.iter_mut().enumerate() {
            let Some(now) = moment.positions[k].filter(|p| p.finite()) else { continue };
            if let Some(was) = before.get(k).copied().flatten().filter(|p| p.finite()) {
                // one step may cross several gates; they count in their order
                while let Some(gate) = gates.get(*done)
                    && gate.passage(was, now).is_some_and(|passage| side.is_none_or(|side| side == passage))
                {
                    *done += 1;
                }
            }
            if *done == gates.len() && goal.is_some_and(|goal| step < within && inside(goal, now)) {
                *done += 1;
            }
        }
        progress.iter().filter(|&&done| done >= wanted).count()
    }
}

/// See [`Signal::Line`]. `None` for fewer than two members, or all in one place.
fn line(places: &[Point]) -> Option<f64> {
    let centre = centroid(places).filter(|_| places.len() > 1)?;
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for &p in places {
        let d = p - centre;
        xx += d[0] * d[0];
        xy += d[0] * d[1];
        yy += d[1] * d[1];
    }
    // eigenvalues of the matrix of inertia
    let (middle, half) = ((xx + yy) / 2.0, (((xx - yy) / 2.0) * ((xx - yy) / 2.0) + xy * xy).sqrt());
    let (first, second) = (middle + half, (middle - half).max(0.0));
    (first > 0.0).then(|| 1.0 - (second / first).sqrt())
}

/// See [`Signal::Purity`]. `None` where nobody is in any region.
fn purity(regions: &[Shape<f64, 2>], moment: &Moment<'_>) -> Option<f64> {
    let (mut placed, mut pure) = (0, 0);
    for region in regions {
        let mut counts: Vec<usize> = Vec::new();
        for (k, p) in moment.positions.iter().enumerate() {
            if p.is_some_and(|p| inside(region, p)) {
                let kind = moment.types.get(k).copied().unwrap_or(0);
                counts.resize(counts.len().max(kind + 1), 0);
                counts[kind] += 1;
            }
        }
        placed += counts.iter().sum::<usize>();
        pure += counts.iter().max().copied().unwrap_or(0);
    }
    (placed > 0).then(|| pure as f64 / placed as f64)
}

impl fmt::Display for Signal {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let axis = |axis: &usize| if *axis == 0 { "x" } else { "y" };
        match self {
            Self::GroupCount(membership) => write!(out, "n_groups({})", membership.distance),
            Self::LargestShare(membership) => write!(out, "largest_share({})", membership.distance),
            Self::EntropyRatio(membership) => write!(out, "entropy_ratio({})", membership.distance),
            Self::CentroidDistance(p) => write!(out, "centroid_dist({}, {})", p[0], p[1]),
            Self::Centroid(a) => write!(out, "centroid_{}", axis(a)),
            Self::Spread => out.write_str("spread"),
            Self::Deviation(a) => write!(out, "sd_{}", axis(a)),
            Self::Polarisation => out.write_str("polarisation"),
            Self::Line => out.write_str("line"),
            Self::ShareIn(_) => out.write_str("share_in(region)"),
            Self::ShareVisited(_) => out.write_str("share_visited(region)"),
            Self::ShareCrossed(..) => out.write_str("share_crossed(gate)"),
            Self::ShareThrough { gates, .. } => write!(out, "share_through({} gates, region)", gates.len()),
            Self::TypeShareIn(_, kind) => write!(out, "type_share_in(region, {kind})"),
            Self::Purity(regions) => write!(out, "purity({} regions)", regions.len()),
            Self::SharePlaced(regions) => write!(out, "share_placed({} regions)", regions.len()),
            Self::PathError(_) => out.write_str("path_error(path)"),
            Self::WallDistance(_) => out.write_str("min_wall_dist"),
            Self::Alive => out.write_str("alive"),
        }
    }
}

/// A signal as it is followed: what each member has done, where everyone was a step ago, and its values.
#[derive(Clone, Debug)]
pub(super) struct Followed {
    signal: Signal,
    progress: Vec<usize>,
    before: Vec<Option<Point>>,
    steps: u64,
    /// Its first defined value.
    pub(super) first: Option<f64>,
    /// Its present value.
    pub(super) now: Option<f64>,
    sum: f64,
    defined: u64,
}

impl Followed {
    pub(super) fn new(signal: &Signal) -> Self {
        let signal = signal.clone();
        let (progress, before) = (Vec::new(), Vec::new());
        Self { signal, progress, before, steps: 0, first: None, now: None, sum: 0.0, defined: 0 }
    }
    /// Takes the next moment.
    pub(super) fn step(&mut self, moment: &Moment<'_>) {
        self.progress.resize(moment.positions.len(), 0);
        self.now = self.signal.value(moment, &self.before, &mut self.progress, self.steps).filter(|v| v.is_finite());
        self.first = self.first.or(self.now);
        if let Some(value) = self.now {
            self.sum += value;
            self.defined += 1;
        }
        if self.signal.latched() {
            self.before.clear();
            self.before.extend_from_slice(moment.positions);
        }
        self.steps += 1;
    }
    /// Mean of its values so far.
    pub(super) fn mean(&self) -> Option<f64> {
        (self.defined > 0).then(|| self.sum / self.defined as f64)
    }
    /// Whether it has reached 1 and cannot fall.
    pub(super) fn full(&self) -> bool {
        self.signal.latched() && self.now.is_some_and(|value| value >= 1.0)
    }
    pub(super) fn signal(&self) -> &Signal {
        &self.signal
    }
}
