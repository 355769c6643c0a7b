//! Neighbour selection, the third stage: perception functions and their combinations.
//!
//! A perception function takes a candidate set and returns a subset of it; the agent itself is never in it.
//! A model's named sets are perception functions over the detected members, and a scenario may put others in their place.

mod words;

use crate::motion::in_view;
use crate::parameters::Scalar;
use crate::sensing::cos_half;
use space::{Columns, Real, Vector, voronoi};
pub use words::Shell;

/// The eight perception functions and their combinations.
#[derive(Clone, Debug, PartialEq)]
pub enum Perception<R, const D: usize> {
    /// Everyone detected.
    All,
    /// Given ids, a list for each member of the group; needs identities.
    FixedSet(Vec<Vec<u32>>),
    /// Distances in [`low`, `high`).
    DistanceBased {
        /// Nearest distance selected.
        low: R,
        /// First distance no longer selected.
        high: R,
    },
    /// The nearest one; ties go to the lower id.
    Nearest,
    /// Those whose Voronoi cell shares an edge with mine, among the candidates.
    Voronoi,
    /// The `k` nearest; all where there are fewer.
    KNearest(usize),
    /// Displacements between two corners, in the world's axes or turned with the heading.
    BoundingBox {
        /// Lower corner relative to me.
        low: Vector<R, D>,
        /// Upper corner relative to me.
        high: Vector<R, D>,
        /// Whether the first axis is my heading (2-D).
        body_frame: bool,
    },
    /// Within a cone about the heading; all-round at rest, and always when coincident. Made by [`Perception::angle`].
    Angle {
        /// Full opening, rad.
        opening: R,
        /// The cosine of half of it.
        cos_half: R,
    },
    /// In every one of these.
    Intersection(Vec<Perception<R, D>>),
    /// In any of these.
    Union(Vec<Perception<R, D>>),
    /// In the first but not in the second.
    Difference(Box<Perception<R, D>>, Box<Perception<R, D>>),
    /// Each takes the result of the one before as its candidates.
    Sequence(Vec<Perception<R, D>>),
}

/// A named set of the selection stage.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedSet<R, const D: usize> {
    /// Name in files, tables and pictures.
    pub name: &'static str,
    /// Who is in it.
    pub perception: Perception<R, D>,
}

impl<R, const D: usize> NamedSet<R, D> {
    /// A named set.
    pub fn new(name: &'static str, perception: Perception<R, D>) -> Self {
        Self { name, perception }
    }
    /// A named set of which only the name is known: a group's selection has to say who is in it.
    pub fn unsaid(name: &'static str) -> Self {
        Self { name, perception: Perception::Union(Vec::new()) }
    }
    /// Whether it was left so.
    pub fn is_unsaid(&self) -> bool {
        matches!(&self.perception, Perception::Union(parts) if parts.is_empty())
    }
}

/// So many named sets can be rings at once: the zones of repulsion, alignment and attraction of many laws.
pub const RINGS: usize = 3;

/// Named sets that are rings about the agent, each beginning where the one before ends, all round or within one cone about the
/// heading. The engine marks them for several others at a time, where perception functions are asked one by one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rings<R> {
    /// Squared outer radii. A ring that nobody can be in has that of the ring before.
    pub outer: [R; RINGS],
    /// The largest of these radii.
    pub reach: R,
    /// Cosine of half the opening of the cone.
    pub cos_half: R,
    /// Whether the cone limits a ring.
    pub within_cone: [bool; RINGS],
}

impl<R: Scalar> Rings<R> {
    /// The rings that these sets are; `None` where they are anything else.
    pub fn of<const D: usize>(sets: &[NamedSet<R, D>]) -> Option<Self> {
        if sets.len() > RINGS {
            return None;
        }
        let mut rings =
            Self { outer: [R::ZERO; RINGS], reach: R::ZERO, cos_half: -R::ONE, within_cone: [false; RINGS] };
        let (mut cone, mut inner) = (None, R::ZERO);
        for s in 0..RINGS {
            let distance = match sets.get(s).map(|set| &set.perception) {
                Some(Perception::Intersection(parts)) => match parts.as_slice() {
                    [distance, Perception::Angle { cos_half, .. }] if cone.is_none_or(|other| other == *cos_half) => {
                        cone = Some(*cos_half);
                        rings.within_cone[s] = true;
                        Some(distance)
                    }
                    _ => return None,
                },
                other => other,
            };
            match distance {
                Some(Perception::DistanceBased { low, high }) if *low == inner => inner = *high,
                Some(Perception::KNearest(0)) | None => {}
                _ => return None,
            }
            rings.outer[s] = inner * inner;
        }
        rings.reach = inner;
        rings.cos_half = cone.unwrap_or(rings.cos_half);
        Some(rings)
    }
}

/// How many of the nearest are enough to fill all of these sets; `None` where ranks among the nearest do not say who is in them.
pub(crate) fn nearest_of<R: Scalar, const D: usize>(sets: &[NamedSet<R, D>]) -> Option<usize> {
    let counts: Option<Vec<usize>> = sets.iter().map(|set| set.perception.nearest_enough()).collect();
    counts?.into_iter().max().filter(|&count| count > 0)
}

/// Which others have to be looked at to evaluate a perception function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reach<R> {
    /// Those closer than this.
    Within(R),
    /// The nearest so many, however far.
    Nearest(usize),
    /// Everyone.
    All,
}

impl<R: Real> Reach<R> {
    /// Enough for both.
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Within(a), Self::Within(b)) => Self::Within(a.most(b)),
            (Self::Nearest(a), Self::Nearest(b)) => Self::Nearest(a.max(b)),
            _ => Self::All,
        }
    }
    /// Enough for their intersection.
    fn cut(self, other: Self) -> Self {
        match (self, other) {
            (Self::Within(a), Self::Within(b)) => Self::Within(a.least(b)),
            (Self::Within(a), _) | (_, Self::Within(a)) => Self::Within(a),
            (Self::Nearest(a), Self::Nearest(b)) => Self::Nearest(a.max(b)),
            (a, Self::All) => a,
            (Self::All, b) => b,
        }
    }
}

impl<R: Scalar, const D: usize> Perception<R, D> {
    /// Distances in [`low`, `high`).
    pub fn distance(low: R, high: R) -> Self {
        Self::DistanceBased { low, high }
    }
    /// Distances in [`low`, `high`); nobody where there are none.
    pub fn ring(low: R, high: R) -> Self {
        if high > low { Self::distance(low, high) } else { Self::KNearest(0) }
    }
    /// A cone about the heading, by its full opening in radians.
    pub fn angle(opening: R) -> Self {
        Self::Angle { opening, cos_half: cos_half(opening) }
    }
    /// The cosine of half the opening of its cone, where it is one or an intersection with one.
    #[inline]
    pub fn cos_half(&self) -> Option<R> {
        match self {
            Self::Angle { cos_half, .. } => Some(*cos_half),
            Self::Intersection(parts) => parts.iter().find_map(Self::cos_half),
            _ => None,
        }
    }
    /// In both of two functions.
    pub fn both(self, other: Self) -> Self {
        Self::Intersection(vec![self, other])
    }
    /// Which others have to be looked at.
    pub fn reach(&self) -> Reach<R> {
        match self {
            Self::All | Self::FixedSet(_) | Self::Voronoi | Self::Angle { .. } => Reach::All,
            Self::DistanceBased { high, .. } => {
                if high.finite() {
                    Reach::Within(*high)
                } else {
                    Reach::All
                }
            }
            Self::KNearest(0) => Reach::Within(R::TINY),
            Self::Nearest => Reach::Nearest(1),
            Self::KNearest(k) => Reach::Nearest(*k),
            Self::BoundingBox { low, high, .. } => {
                let far = Vector::<R, D>(core::array::from_fn(|a| low[a].abs().most(high[a].abs())));
                Reach::Within(far.length() * R::of(1.000_001) + R::TINY)
            }
            Self::Intersection(parts) => {
                // a rank is taken over all candidates, so it needs all that rank can see
                let ranked = parts.iter().any(Self::ranks);
                let all = parts.iter().map(Self::reach);
                if ranked { all.reduce(Reach::and) } else { all.reduce(Reach::cut) }.unwrap_or(Reach::All)
            }
            Self::Union(parts) => parts.iter().map(Self::reach).reduce(Reach::and).unwrap_or(Reach::Within(R::TINY)),
            Self::Difference(from, _) if !self.ranks() => from.reach(),
            Self::Difference(from, without) => from.reach().and(without.reach()),
            Self::Sequence(parts) => match parts.first() {
                Some(first) => first.reach(),
                None => Reach::All,
            },
        }
    }
    /// How many of the nearest are enough; `None` where that cannot be told.
    fn nearest_enough(&self) -> Option<usize> {
        // those before whom nobody nearer is left out
        let all_round = |part: &Self| match part {
            Self::DistanceBased { low, .. } => *low <= R::ZERO,
            Self::Angle { cos_half, .. } => *cos_half < -R::ONE,
            _ => false,
        };
        match self {
            Self::Nearest => Some(1),
            Self::KNearest(count) => Some(*count),
            Self::Sequence(parts) => match parts.as_slice() {
                [Self::Intersection(first), second] if first.iter().all(all_round) => second.nearest_enough(),
                [first, second] if all_round(first) => second.nearest_enough(),
                _ => None,
            },
            _ => None,
        }
    }
    /// Whether membership depends on the other candidates.
    pub fn ranks(&self) -> bool {
        match self {
            Self::Nearest | Self::KNearest(_) | Self::Voronoi => true,
            Self::Intersection(parts) | Self::Union(parts) | Self::Sequence(parts) => parts.iter().any(Self::ranks),
            Self::Difference(a, b) => a.ranks() || b.ranks(),
            _ => false,
        }
    }
    /// Whether it uses identities.
    pub fn identifies(&self) -> bool {
        match self {
            Self::FixedSet(_) => true,
            Self::Intersection(parts) | Self::Union(parts) | Self::Sequence(parts) => {
                parts.iter().any(Self::identifies)
            }
            Self::Difference(a, b) => a.identifies() || b.identifies(),
            _ => false,
        }
    }
    /// Checks what can be known at load.
    ///
    /// # Errors
    /// A sentence that says what is wrong and what would do.
    pub fn check(&self) -> Result<(), String> {
        match self {
            Self::DistanceBased { low, high } if !(*low >= R::ZERO && high > low) => {
                Err(format!("distance_based needs 0 <= low < high, found low {low} and high {high}"))
            }
            Self::Angle { opening, .. } if !(*opening >= R::ZERO && *opening <= R::TAU * R::of(1.000_001)) => {
                Err(format!("angle is a full opening from 0 to 360 degrees, found {opening} rad"))
            }
            Self::BoundingBox { low, high, body_frame } => {
                if (0..D).any(|a| low[a] > high[a] || !low[a].finite() || !high[a].finite()) {
                    return Err("bounding_box needs low <= high on every axis".into());
                }
                if *body_frame && D != 2 {
                    return Err(
                        "bounding_box turns with the heading in two dimensions only; use axes = \"world\"".into()
                    );
                }
                Ok(())
            }
            Self::Voronoi if D == 3 => {
                Err("Voronoi neighbours are exact in one and two dimensions only; in three use \
                 k_nearest or distance_based"
                    .into())
            }
            Self::Intersection(parts) | Self::Union(parts) | Self::Sequence(parts) => {
                if parts.is_empty() {
                    return Err("a combination of perception functions needs at least one".into());
                }
                parts.iter().try_for_each(Self::check)
            }
            Self::Difference(a, b) => a.check().and_then(|()| b.check()),
            _ => Ok(()),
        }
    }
}

/// What a perception function looks at.
pub struct Candidates<'a, R, const D: usize> {
    /// Displacements, `[D][candidates]`.
    pub offset: [&'a [R]; D],
    /// Squared distances.
    pub squared: &'a [R],
    /// Rows in `others`.
    pub row: &'a [u32],
    /// Their columns.
    pub others: &'a Columns<R, D>,
    /// My heading (zero at rest).
    pub heading: Vector<R, D>,
    /// My index in the group.
    pub member: usize,
    /// Periods of the axes that close on themselves.
    pub periods: [Option<R>; D],
}

/// Buffers of the selection stage.
#[derive(Debug, Default)]
pub struct Scratch<R, const D: usize> {
    spare: Vec<Vec<bool>>,
    order: Vec<u32>,
    offsets: Vec<Vector<R, D>>,
    neighbours: Vec<u32>,
    voronoi: voronoi::Scratch,
}

impl<R: Scalar, const D: usize> Candidates<'_, R, D> {
    fn offset(&self, k: usize) -> Vector<R, D> {
        Vector(core::array::from_fn(|a| self.offset[a][k]))
    }
    fn id(&self, k: usize) -> u32 {
        self.others.id[self.row[k] as usize]
    }
    /// Whether one of the functions that look at one candidate alone selects candidate `k`.
    fn holds(&self, perception: &Perception<R, D>, k: usize) -> bool {
        match perception {
            Perception::All => true,
            Perception::FixedSet(lists) => lists.get(self.member).is_some_and(|list| list.contains(&self.id(k))),
            Perception::BoundingBox { low, high, body_frame } => {
                let mut offset = self.offset(k);
                if *body_frame && !self.heading.is_tiny() {
                    let mut turned = offset;
                    turned.0[0] = offset.dot(self.heading);
                    if D >= 2 {
                        turned.0[1] = offset.dot(self.heading.left());
                    }
                    offset = turned;
                }
                (0..D).all(|a| low[a] <= offset[a] && offset[a] <= high[a])
            }
            _ => false,
        }
    }
    /// Leaves marked in `chosen` those of the marked candidates that the function selects. What [`Perception::check`]
    /// refuses selects nobody.
    pub fn select(&self, perception: &Perception<R, D>, chosen: &mut [bool], scratch: &mut Scratch<R, D>) {
        match perception {
            Perception::Nearest => self.keep_nearest(1, chosen, scratch),
            Perception::KNearest(k) => self.keep_nearest(*k, chosen, scratch),
            Perception::Voronoi => {
                let Scratch { order, offsets, neighbours, voronoi: buffers, .. } = scratch;
                order.clear();
                offsets.clear();
                for k in 0..chosen.len() {
                    if chosen[k] {
                        order.push(k as u32);
                        offsets.push(self.offset(k));
                    }
                }
                chosen.fill(false);
                if voronoi::neighbours_around(offsets, &self.periods, buffers, neighbours).is_ok() {
                    for &n in neighbours.iter() {
                        chosen[order[n as usize] as usize] = true;
                    }
                }
            }
            Perception::Intersection(parts) => {
                // a rank is one among all that were marked; whatever looks at each candidate alone may come after
                let ranked = parts.iter().any(Perception::ranks);
                if ranked {
                    let mut result = scratch.spare.pop().unwrap_or_default();
                    result.clear();
                    result.extend_from_slice(chosen);
                    for part in parts.iter().filter(|part| part.ranks()) {
                        let mut one = scratch.spare.pop().unwrap_or_default();
                        one.clear();
                        one.extend_from_slice(chosen);
                        self.select(part, &mut one, scratch);
                        result.iter_mut().zip(&one).for_each(|(r, o)| *r &= o);
                        scratch.spare.push(one);
                    }
                    chosen.copy_from_slice(&result);
                    scratch.spare.push(result);
                }
                for part in parts.iter().filter(|part| !(ranked && part.ranks())) {
                    self.select(part, chosen, scratch);
                }
            }
            Perception::Union(parts) => {
                let mut result = scratch.spare.pop().unwrap_or_default();
                result.clear();
                result.resize(chosen.len(), false);
                for part in parts {
                    let mut one = scratch.spare.pop().unwrap_or_default();
                    one.clear();
                    one.extend_from_slice(chosen);
                    self.select(part, &mut one, scratch);
                    result.iter_mut().zip(&one).for_each(|(r, o)| *r |= o);
                    scratch.spare.push(one);
                }
                chosen.copy_from_slice(&result);
                scratch.spare.push(result);
            }
            Perception::Difference(from, without) => {
                let mut other = scratch.spare.pop().unwrap_or_default();
                other.clear();
                other.extend_from_slice(chosen);
                self.select(without, &mut other, scratch);
                self.select(from, chosen, scratch);
                chosen.iter_mut().zip(&other).for_each(|(c, o)| *c &= !o);
                scratch.spare.push(other);
            }
            Perception::Sequence(parts) => parts.iter().for_each(|part| self.select(part, chosen, scratch)),
            // the two that most laws ask for: without branches, for everybody
            Perception::DistanceBased { low, high } => {
                let (low, high) = (*low * *low, *high * *high);
                for (chosen, &squared) in chosen.iter_mut().zip(self.squared) {
                    *chosen &= (squared >= low) & (squared < high);
                }
            }
            // a whole turn
            Perception::Angle { cos_half, .. } if *cos_half < -R::ONE => {}
            Perception::Angle { cos_half, .. } => {
                for k in 0..chosen.len() {
                    chosen[k] &= in_view::<R, R, D>(&self.heading.0, &self.offset(k).0, self.squared[k], *cos_half);
                }
            }
            simple => {
                for k in 0..chosen.len() {
                    chosen[k] = chosen[k] && self.holds(simple, k);
                }
            }
        }
    }
    fn keep_nearest(&self, count: usize, chosen: &mut [bool], scratch: &mut Scratch<R, D>) {
        if (1..=FEW).contains(&count) {
            return self.keep_few(count, chosen);
        }
        let order = &mut scratch.order;
        order.clear();
        order.extend((0..chosen.len() as u32).filter(|&k| chosen[k as usize]));
        if order.len() <= count {
            return;
        }
        chosen.fill(false);
        if count == 0 {
            return;
        }
        let nearer = |&a: &u32, &b: &u32| self.nearer(a as usize, b as usize);
        order.select_nth_unstable_by(count - 1, nearer);
        for &k in &order[..count] {
            chosen[k as usize] = true;
        }
    }
    /// [`Self::keep_nearest`] for at most [`FEW`]: the best so far, in order.
    fn keep_few(&self, count: usize, chosen: &mut [bool]) {
        let mut best = [0; FEW];
        let mut found = 0;
        let farthest = self.farthest_of(count, chosen);
        for k in 0..chosen.len() {
            let near = core::mem::replace(&mut chosen[k], false) && self.squared[k] <= farthest;
            if !near {
                continue;
            }
            if found == count {
                // most are farther than the last of the best
                if self.squared[k] > self.squared[best[count - 1]] || self.nearer(best[count - 1], k).is_lt() {
                    continue;
                }
                found -= 1;
            }
            let mut place = found;
            while place > 0 && self.nearer(k, best[place - 1]).is_lt() {
                best[place] = best[place - 1];
                place -= 1;
            }
            best[place] = k;
            found += 1;
        }
        for &k in &best[..found] {
            chosen[k] = true;
        }
    }
    /// A squared distance beyond which none of the nearest `count` stands: the least distance of every sixteenth is one of so many
    /// different candidates.
    fn farthest_of(&self, count: usize, chosen: &[bool]) -> R {
        if chosen.len() < 4 * FEW {
            return R::INFINITY;
        }
        let mut least = [R::INFINITY; FEW];
        let (distances, marks) = (self.squared.chunks_exact(FEW), chosen.chunks_exact(FEW));
        for (distances, marks) in distances.zip(marks) {
            for l in 0..FEW {
                let distance = if marks[l] { distances[l] } else { R::INFINITY };
                least[l] = if distance < least[l] { distance } else { least[l] };
            }
        }
        least.sort_unstable_by(|a, b| a.partial_cmp(b).unwrap_or(core::cmp::Ordering::Equal));
        least[count - 1]
    }
    /// By distance; ties go to the lower id.
    fn nearer(&self, a: usize, b: usize) -> core::cmp::Ordering {
        self.squared[a]
            .partial_cmp(&self.squared[b])
            .unwrap_or(core::cmp::Ordering::Equal)
            .then_with(|| self.id(a).cmp(&self.id(b)))
    }
}

/// So many nearest are found by insertion.
const FEW: usize = 16;
