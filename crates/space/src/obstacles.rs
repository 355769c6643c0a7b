//! The obstacles of a world: when and where each one is, and which of them a body, a move or a ray concerns.
//!
//! Every question has the answer that a scan over all obstacles in index order would give. With many of them a
//! grid of cells spares the scan: each cell lists the obstacles within `reach` of any of its points.

use crate::shape::{Crossing, Hit, Nearest, Shape, ShapeError, between_faces, epsilon, measurable};
use crate::{Real, Vector};

/// Fewer copies than this are scanned: a grid would not be faster.
const FEW: usize = 16;
/// Greatest reach, and greatest extent of an obstacle, in lengths of a periodic axis; bounds the images.
pub const MOST_LENGTHS: f64 = 8.0;

/// When an obstacle is there, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan<R, const D: usize> {
    /// Time from which it is there.
    pub appears: f64,
    /// Time from which it is there no longer.
    pub disappears: f64,
    /// Times, in order, with the offset from the drawn place at each: linear between two of them, held before the
    /// first and after the last. At two equal times it jumps to the later entry. None: it rests where drawn.
    pub waypoints: Vec<(f64, Vector<R, D>)>,
}

impl<R, const D: usize> Default for Plan<R, D> {
    /// Always there and at rest.
    fn default() -> Self {
        Self { appears: f64::NEG_INFINITY, disappears: f64::INFINITY, waypoints: Vec::new() }
    }
}

/// Whether a moment has come at `time`, which may be a multiple of a step: 3 steps of 0.7 are a little less than 2.1.
pub fn has_come(moment: f64, time: f64) -> bool {
    time >= moment - 1e-12 * moment.abs()
}

impl<R: Real, const D: usize> Plan<R, D> {
    /// Whether the obstacle is there at `time`: from `appears` on, until before `disappears`.
    pub fn present(&self, time: f64) -> bool {
        has_come(self.appears, time) && !has_come(self.disappears, time)
    }

    /// Offset from the drawn place at `time`.
    pub fn offset(&self, time: f64) -> Vector<R, D> {
        let passed = self.waypoints.partition_point(|&(at, _)| has_come(at, time));
        let next = self.waypoints.get(passed);
        match (passed.checked_sub(1).and_then(|last| self.waypoints.get(last)), next) {
            (None, None) => Vector::ZERO,
            (Some(&(_, held)), None) | (None, Some(&(_, held))) => held,
            (Some(&(start, from)), Some(&(end, to))) => from + (to - from) * R::of((time - start) / (end - start)),
        }
    }

    fn checked(&self) -> Result<(), ShapeError> {
        let finite = self.waypoints.iter().all(|&(at, offset)| at.is_finite() && measurable(offset));
        if !finite || self.appears.is_nan() || self.disappears.is_nan() {
            Err(ShapeError::NotFinite)
        } else if !self.waypoints.is_sorted_by(|a, b| a.0 <= b.0) {
            Err(ShapeError::WaypointOrder)
        } else {
            Ok(())
        }
    }
}

/// A shape with what else the world must know of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Obstacle<R, const D: usize> {
    /// Its shape at the drawn place.
    pub shape: Shape<R, D>,
    /// When and where it is there; without a plan always, at the drawn place.
    pub plan: Option<Plan<R, D>>,
    /// Share of a laser's light it sends back, 0 to 1.
    pub albedo: R,
    /// Whether it hides what is behind it.
    pub opaque: bool,
}

impl<R: Real, const D: usize> Obstacle<R, D> {
    /// An opaque obstacle at rest, with the albedo 0.2 of a plain wall.
    pub fn new(shape: Shape<R, D>) -> Self {
        Self { shape, plan: None, albedo: R::of(0.2), opaque: true }
    }
}

/// One obstacle where it now is, or one of its images in periodic space.
#[derive(Clone, Debug)]
struct Placed<R, const D: usize> {
    index: u32,
    opaque: bool,
    shape: Shape<R, D>,
    /// Corners of a box that holds all of it, with more than rounding errors.
    low: Vector<R, D>,
    high: Vector<R, D>,
    /// A ball that holds all of it, with more than the rounding errors of telling so; infinite where none does.
    centre: Vector<R, D>,
    around: R,
}

impl<R: Real, const D: usize> Placed<R, D> {
    fn new(index: u32, opaque: bool, shape: Shape<R, D>) -> Self {
        let (low, high) = shape.bounds();
        let middle = (low + high) * R::HALF;
        let (centre, around) = match &shape {
            Shape::Ball { centre, radius } => (*centre, *radius),
            _ if low.finite() && high.finite() => (middle, (high - low).length() * R::HALF),
            _ => (Vector::ZERO, R::INFINITY),
        };
        let rounding = epsilon::<R>() * R::of(64.0) * (centre.length() + around);
        let slack = Vector([if rounding.finite() { rounding } else { R::ZERO }; D]);
        let around = around * R::of(1.0 + 1e-4) + epsilon::<R>() * R::of(64.0) * centre.length();
        Self { index, opaque, shape, low: low - slack, high: high + slack, centre, around }
    }
    /// Whether its box and one with these corners have a point in common.
    #[inline(always)]
    fn meets(&self, low: Vector<R, D>, high: Vector<R, D>) -> bool {
        (0..D).fold(true, |meets, a| meets & (self.low[a] <= high[a]) & (self.high[a] >= low[a]))
    }
    /// Whether it is certainly farther from `p` than `reach`.
    #[inline(always)]
    fn is_far(&self, p: Vector<R, D>, reach: R) -> bool {
        let within = self.around + reach * R::of(1.0 + 1e-4);
        (p - self.centre).length_squared() > within * within
    }
}

/// Which of few obstacles may hide anything, one bit each; any, where they are many.
#[derive(Clone, Copy, Debug)]
pub struct Screens(Option<u32>);

impl Screens {
    /// Any obstacle may.
    pub const ANY: Self = Self(None);
    /// Whether none does.
    pub fn is_none(self) -> bool {
        self.0 == Some(0)
    }
}

/// All obstacles of a world.
///
/// In periodic space each obstacle is seen through the seams by images of itself, as far as they come within `reach`
/// of the box. So answers are complete for points in the box, and for what lies within `reach` of them; a longer
/// move or ray that leaves the box meets only that. A plane has no images.
#[derive(Clone, Debug)]
pub struct Obstacles<R, const D: usize> {
    list: Vec<Obstacle<R, D>>,
    periodic: [Option<R>; D],
    reach: R,
    /// How far beyond a periodic box anything is seen.
    sight: R,
    /// Whether any obstacle has a plan.
    planned: bool,
    /// Present offset of each obstacle from its drawn place; `None` while it is not there.
    offsets: Vec<Option<Vector<R, D>>>,
    /// Each obstacle where it now is; `None` while it is not there.
    places: Vec<Option<Shape<R, D>>>,
    /// Those now there with their images, in index order.
    copies: Vec<Placed<R, D>>,
    cells: Option<Cells<R, D>>,
}

impl<R: Real, const D: usize> Default for Obstacles<R, D> {
    /// No obstacles.
    fn default() -> Self {
        Self {
            list: Vec::new(),
            periodic: [None; D],
            reach: R::ZERO,
            sight: R::ZERO,
            planned: false,
            offsets: Vec::new(),
            places: Vec::new(),
            copies: Vec::new(),
            cells: None,
        }
    }
}

impl<R: Real, const D: usize> Obstacles<R, D> {
    /// The obstacles as they are at time 0; see [`Self::advance`].
    ///
    /// `periodic` holds the length of space along each periodic axis, whose coordinates run from 0 to it. `reach`
    /// is the distance up to which questions are to be fast, and in periodic space answered at all, where that is not said by
    /// [`Self::with_sight`].
    ///
    /// # Errors
    /// When a shape, plan, albedo, length or the reach breaks a rule of [`ShapeError`].
    pub fn new(list: Vec<Obstacle<R, D>>, periodic: [Option<R>; D], reach: R) -> Result<Self, ShapeError> {
        Self::with_sight(list, periodic, reach, reach)
    }

    /// As [`Self::new`]; in periodic space questions are answered up to the distance `sight`: the longest of interaction ranges,
    /// moves, lines of sight and rays. No less than the reach.
    ///
    /// # Errors
    /// As there.
    pub fn with_sight(
        list: Vec<Obstacle<R, D>>,
        periodic: [Option<R>; D],
        reach: R,
        sight: R,
    ) -> Result<Self, ShapeError> {
        if !(reach >= R::ZERO && reach.finite()) {
            return Err(ShapeError::Reach);
        }
        let sight = sight.most(reach);
        let mut checked = Vec::with_capacity(list.len());
        for obstacle in list {
            if !obstacle.albedo.finite() {
                return Err(ShapeError::NotFinite);
            }
            if let Some(plan) = &obstacle.plan {
                plan.checked()?;
            }
            checked.push(Obstacle { shape: obstacle.shape.checked()?, ..obstacle });
        }
        for a in 0..D {
            let Some(length) = periodic[a] else { continue };
            if !(length > R::ZERO && length.finite()) {
                return Err(ShapeError::PeriodicLength);
            }
            let most = length * R::of(MOST_LENGTHS);
            if sight > most {
                return Err(ShapeError::Reach);
            }
            let too_long = |shape: &Shape<R, D>| {
                let (low, high) = shape.bounds();
                low[a].finite() && high[a] - low[a] > most
            };
            if checked.iter().any(|obstacle| too_long(&obstacle.shape)) {
                return Err(ShapeError::LongerThanSpace);
            }
        }
        let mut obstacles = Self {
            planned: checked.iter().any(|obstacle| obstacle.plan.is_some()),
            offsets: vec![Some(Vector::ZERO); checked.len()],
            list: checked,
            periodic,
            reach,
            sight,
            ..Self::default()
        };
        if !obstacles.advance(0.0) {
            obstacles.place();
        }
        Ok(obstacles)
    }

    /// Whether there is no obstacle at all, at any time.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }
    /// Number of obstacles, present or not.
    pub fn len(&self) -> usize {
        self.list.len()
    }
    /// The obstacles as given, a plane's normal made a unit vector.
    pub fn list(&self) -> &[Obstacle<R, D>] {
        &self.list
    }
    /// The reach given to [`Self::new`].
    pub fn reach(&self) -> R {
        self.reach
    }

    /// Puts every obstacle where its plan has it at `time`; whether any has moved, appeared or disappeared.
    pub fn advance(&mut self, time: f64) -> bool {
        if !self.planned {
            return false;
        }
        let mut changed = false;
        for (obstacle, offset) in self.list.iter().zip(&mut self.offsets) {
            let Some(plan) = &obstacle.plan else { continue };
            let now = plan.present(time).then(|| plan.offset(time));
            changed |= now != *offset;
            *offset = now;
        }
        if changed {
            self.place();
        }
        changed
    }

    /// Puts obstacles, by index, at these offsets from their drawn places; `None` takes one away. Those that have a plan go
    /// where it has them at the next [`Self::advance`]. An index that is not there is passed over.
    pub fn put(&mut self, places: &[(usize, Option<Vector<R, D>>)]) {
        let mut changed = false;
        for &(index, place) in places {
            if let Some(offset) = self.offsets.get_mut(index) {
                changed |= *offset != place;
                *offset = place;
            }
        }
        if changed {
            self.place();
        }
    }

    /// Rebuilds what depends on where the obstacles are.
    fn place(&mut self) {
        self.places.clear();
        self.copies.clear();
        for (index, (obstacle, offset)) in self.list.iter().zip(&self.offsets).enumerate() {
            let place = offset.map(|offset| obstacle.shape.moved(offset));
            if let Some(shape) = &place {
                for by in images(shape, &self.periodic, self.sight) {
                    let shape = shape.moved(by);
                    self.copies.push(Placed::new(index as u32, obstacle.opaque, shape));
                }
            }
            self.places.push(place);
        }
        self.cells = Cells::new(&self.copies, self.reach);
    }

    /// Index and shape of every obstacle now there, in index order and without images; one that has moved
    /// out of a periodic box is not brought back.
    pub fn present(&self) -> impl Iterator<Item = (u32, &Shape<R, D>)> {
        self.places.iter().enumerate().filter_map(|(index, place)| Some((index as u32, place.as_ref()?)))
    }

    /// The copies that may be within `reach` of `p`, in order.
    fn candidates(&self, p: Vector<R, D>, reach: R) -> Candidates<'_, R, D> {
        let numbers = match &self.cells {
            Some(cells) if reach <= self.reach => Some(cells.at(p).iter()),
            _ => None,
        };
        Candidates { copies: &self.copies, numbers, next: 0 }
    }

    /// Visits every obstacle whose signed distance from `p` is below `reach`, in index order; images of one
    /// obstacle count separately and follow one another.
    pub fn near(&self, p: Vector<R, D>, reach: R, mut visit: impl FnMut(u32, &Shape<R, D>, Nearest<R, D>)) {
        for copy in self.candidates(p, reach) {
            if copy.is_far(p, reach) {
                continue;
            }
            let nearest = copy.shape.nearest(p);
            if nearest.distance < reach {
                visit(copy.index, &copy.shape, nearest);
            }
        }
    }

    /// The first obstacle, in index order, whose signed distance from `p` is below `radius`.
    pub fn overlapping(&self, p: Vector<R, D>, radius: R) -> Option<u32> {
        self.candidates(p, radius).find(|copy| copy.shape.nearest(p).distance < radius).map(|copy| copy.index)
    }

    /// Where the straight move is blocked first (see [`Shape::block`]): the share of it made until then, the
    /// obstacle's index (the lowest of several) and the unit normal of its surface on the side of `from`.
    pub fn first_crossing(&self, from: Vector<R, D>, to: Vector<R, D>) -> Option<(R, u32, Vector<R, D>)> {
        let step = to - from;
        let length = step.length();
        let mut first: Option<(Crossing<R, D>, usize)> = None;
        self.along(self.precise_cells(&[from, to]), from, step.unit(), length, |number, copy| {
            if let Some(crossing) = copy.shape.block(from, to)
                && first.is_none_or(|(f, n)| (crossing.fraction, number) < (f.fraction, n))
            {
                first = Some((crossing, number));
            }
            first.map_or(R::INFINITY, |(crossing, _)| crossing.fraction * length)
        });
        let (crossing, number) = first?;
        Some((crossing.fraction, self.copies.get(number)?.index, crossing.normal))
    }

    /// The first hit of a ray (see [`Shape::cast`]; `direction` is a unit vector, `limit` may be infinite) and the
    /// index of the obstacle, the lowest of several.
    pub fn cast(&self, origin: Vector<R, D>, direction: Vector<R, D>, limit: R) -> Option<(Hit<R, D>, u32)> {
        let mut first: Option<(Hit<R, D>, usize)> = None;
        self.along(self.precise_cells(&[origin]), origin, direction, limit, |number, copy| {
            if let Some(hit) = copy.shape.cast(origin, direction, limit)
                && first.is_none_or(|(f, n)| (hit.distance, number) < (f.distance, n))
            {
                first = Some((hit, number));
            }
            first.map_or(R::INFINITY, |(hit, _)| hit.distance)
        });
        let (hit, number) = first?;
        Some((hit, self.copies.get(number)?.index))
    }

    /// Which opaque obstacles now there may lie between two points of a box, for [`Self::hides`].
    pub fn screens(&self, low: Vector<R, D>, high: Vector<R, D>) -> Screens {
        if self.cells.is_some() || self.copies.len() > 32 {
            return Screens(None);
        }
        let near = |(k, copy): (usize, &Placed<R, D>)| u32::from(copy.opaque && copy.meets(low, high)) << k;
        Screens(Some(self.copies.iter().enumerate().map(near).fold(0, |all, one| all | one)))
    }

    /// Whether an opaque obstacle now there, one of those that were picked, lies strictly between two points (see
    /// [`Shape::between`]). In periodic space give `to` as `from` and the shortest way.
    pub fn hides(&self, screens: Screens, from: Vector<R, D>, to: Vector<R, D>) -> bool {
        let low = Vector(core::array::from_fn(|a| from[a].least(to[a])));
        let high = Vector(core::array::from_fn(|a| from[a].most(to[a])));
        let hides = |copy: &Placed<R, D>| copy.opaque && copy.meets(low, high) && copy.shape.between(from, to);
        if let Screens(Some(mut left)) = screens {
            while left != 0 {
                if hides(&self.copies[left.trailing_zeros() as usize]) {
                    return true;
                }
                left &= left - 1;
            }
            return false;
        }
        let Some(cells) = self.precise_cells(&[from, to]) else { return self.copies.iter().any(hides) };
        let step = to - from;
        let mut hidden = false;
        self.along(Some(cells), from, step.unit(), step.length(), |_, copy| {
            hidden = hidden || hides(copy);
            if hidden { -R::INFINITY } else { R::INFINITY }
        });
        hidden
    }

    /// The grid, if its margin covers the rounding errors of a path with these ends.
    fn precise_cells(&self, ends: &[Vector<R, D>]) -> Option<&Cells<R, D>> {
        self.cells.as_ref().filter(|cells| ends.iter().all(|&end| cells.precise(end)))
    }

    /// Visits, with its number, at least every copy that a path from `origin` over `length` along `direction`
    /// touches, some of them more than once. `visit` gives the distance from `origin` beyond which nothing
    /// matters any more. Without cells every copy is visited.
    fn along(
        &self,
        cells: Option<&Cells<R, D>>,
        origin: Vector<R, D>,
        direction: Vector<R, D>,
        length: R,
        mut visit: impl FnMut(usize, &Placed<R, D>) -> R,
    ) {
        let Some(cells) = cells else {
            for (number, copy) in self.copies.iter().enumerate() {
                if visit(number, copy) < R::ZERO {
                    return;
                }
            }
            return;
        };
        let mut enough = R::INFINITY;
        let mut visit_all = |numbers: &[u32]| {
            for &number in numbers {
                if let Some(copy) = self.copies.get(number as usize) {
                    enough = visit(number as usize, copy);
                }
            }
            enough
        };
        let known = visit_all(&cells.unbounded);
        let Some(([enter, leave], _)) = between_faces(cells.low, cells.high, origin, direction) else { return };
        let (enter, leave) = (enter.most(R::ZERO), leave.least(length));
        if enter > leave || known < R::ZERO {
            return;
        }
        // distances are counted from where the path enters the grid, where they are as precise as its margin
        let start = origin + direction * enter;
        let mut at = R::ZERO;
        loop {
            let (cell, end) = cells.passed(start, direction, at);
            let known = visit_all(cell);
            // a cell lists what is within reach of its points, so it also speaks for the path after it
            let covered = end.most(at) + self.reach;
            let goes_on = covered < leave - enter && known >= enter + covered - cells.margin;
            if !goes_on {
                return;
            }
            at = covered.most(at + cells.margin);
        }
    }
}

/// Copies to look at, in order: those of a list of numbers, or all.
struct Candidates<'a, R, const D: usize> {
    copies: &'a [Placed<R, D>],
    numbers: Option<core::slice::Iter<'a, u32>>,
    next: usize,
}

impl<'a, R, const D: usize> Iterator for Candidates<'a, R, D> {
    type Item = &'a Placed<R, D>;
    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let number = match &mut self.numbers {
            Some(numbers) => *numbers.next()? as usize,
            None => {
                self.next += 1;
                self.next - 1
            }
        };
        self.copies.get(number)
    }
}

/// The displacements that bring a shape, or an image of it, within `reach` of a periodic box, the one most to the
/// negative side first.
fn images<R: Real, const D: usize>(
    shape: &Shape<R, D>,
    periodic: &[Option<R>; D],
    reach: R,
) -> impl Iterator<Item = Vector<R, D>> {
    let (low, high) = shape.bounds();
    let mut first = Vector::<R, D>::ZERO;
    let mut lengths = Vector::<R, D>::ZERO;
    let mut counts = [1; D];
    for a in 0..D {
        if let Some(length) = periodic[a]
            && low[a].finite()
            && high[a].finite()
        {
            lengths[a] = length;
            first[a] = ((-reach - high[a]) / length).ceil();
            let last = ((length + reach - low[a]) / length).floor();
            counts[a] = (last - first[a]).index() + 1;
        }
    }
    (0..counts.iter().product()).map(move |number: usize| {
        let mut rest = number;
        Vector(core::array::from_fn(|a| {
            let k = rest % counts[a];
            rest /= counts[a];
            (first[a] + R::count(k)) * lengths[a]
        }))
    })
}

/// A uniform grid over the bounded copies and `reach` around them.
#[derive(Clone, Debug)]
struct Cells<R, const D: usize> {
    low: Vector<R, D>,
    high: Vector<R, D>,
    /// Sides of a cell, and their reciprocals.
    size: Vector<R, D>,
    per_size: Vector<R, D>,
    dimensions: [usize; D],
    /// Where each cell's numbers start in `entries`, and after the last cell where they end.
    starts: Vec<u32>,
    /// Numbers of the copies within reach of any point of the cell, ascending.
    entries: Vec<u32>,
    /// Numbers of the copies without bounds, ascending. Outside the grid nothing else is within reach.
    unbounded: Vec<u32>,
    /// More than the rounding errors of a place in the grid; cells list this much more than they must.
    margin: R,
    /// Greatest coordinate at which `margin` covers the rounding errors.
    farthest: R,
}

impl<R: Real, const D: usize> Cells<R, D> {
    /// The grid for these copies; `None` where a scan does as well.
    fn new(copies: &[Placed<R, D>], reach: R) -> Option<Self> {
        if copies.len() < FEW {
            return None;
        }
        let bounds: Vec<_> = copies.iter().map(|copy| copy.shape.bounds()).collect();
        let bounded = |(low, high): &(Vector<R, D>, Vector<R, D>)| low.finite() && high.finite();
        let unbounded: Vec<u32> = (0..).zip(&bounds).filter(|(_, b)| !bounded(b)).map(|(number, _)| number).collect();
        let (mut low, mut high) = (Vector([R::INFINITY; D]), Vector([-R::INFINITY; D]));
        let mut greatest = R::ZERO;
        for b in bounds.iter().filter(|b| bounded(b)) {
            for a in 0..D {
                low[a] = low[a].least(b.0[a]);
                high[a] = high[a].most(b.1[a]);
                greatest = greatest.most(b.0[a].abs()).most(b.1[a].abs());
            }
        }
        let count = copies.len() - unbounded.len();
        if count < FEW {
            return None;
        }
        let greatest = greatest + reach;
        let rounding = R::of(64.0) * epsilon::<R>() * greatest + R::TINY;
        let around = Vector([reach + rounding * R::of(16.0); D]);
        (low, high) = (low - around, high + around);
        let extent = high - low;

        // cells far smaller than the reach would list almost the same copies again and again
        let (edge, along) = edge(extent, R::count((32 * count).min(1 << 18)));
        let edge = edge.most(reach * R::HALF);
        let dimensions: [usize; D] =
            core::array::from_fn(|a| if along[a] { (extent[a] / edge).floor().index().max(1) } else { 1 });
        let size = Vector(core::array::from_fn(|a| extent[a] / R::count(dimensions[a])));
        let thinnest = size.0.iter().fold(R::INFINITY, |least, &side| least.least(side));
        let margin = thinnest * R::of(1e-3) + rounding;

        let mut cells = Self {
            low,
            high,
            size,
            per_size: Vector(size.0.map(|side| R::ONE / side)),
            dimensions,
            starts: vec![0; dimensions.iter().product::<usize>() + 1],
            entries: Vec::new(),
            unbounded,
            margin,
            farthest: greatest * R::of(4.0),
        };
        cells.fill(copies, &bounds, reach);
        Some(cells)
    }

    fn fill(&mut self, copies: &[Placed<R, D>], bounds: &[(Vector<R, D>, Vector<R, D>)], reach: R) {
        let slack = Vector([reach + self.margin * R::of(4.0); D]);
        // a shape's distance changes no faster than the point, so the cell's centre speaks for all of it
        let within = slack[0] + self.size.length() * R::HALF;
        let mut pairs: Vec<(u32, u32)> = Vec::new();
        for (number, (copy, (low, high))) in (0u32..).zip(copies.iter().zip(bounds)) {
            let (first, last) = (self.coordinates(*low - slack), self.coordinates(*high + slack));
            let counts: [usize; D] = core::array::from_fn(|a| last[a] - first[a] + 1);
            for step in 0..counts.iter().product() {
                let mut rest: usize = step;
                let place: [usize; D] = core::array::from_fn(|a| {
                    let along = rest % counts[a];
                    rest /= counts[a];
                    first[a] + along
                });
                let centre: Vector<R, D> =
                    Vector(core::array::from_fn(|a| self.low[a] + self.size[a] * (R::count(place[a]) + R::HALF)));
                if copy.shape.nearest(centre).distance <= within {
                    pairs.push((self.number(place) as u32, number));
                }
            }
        }
        for &(cell, _) in &pairs {
            self.starts[cell as usize + 1] += 1;
        }
        for cell in 1..self.starts.len() {
            self.starts[cell] += self.starts[cell - 1];
        }
        // copies come in ascending order, so each cell's do
        let mut next = self.starts.clone();
        self.entries = vec![0; pairs.len()];
        for (cell, number) in pairs {
            let slot = &mut next[cell as usize];
            self.entries[*slot as usize] = number;
            *slot += 1;
        }
    }

    /// Coordinates of the cell nearest to `p`.
    fn coordinates(&self, p: Vector<R, D>) -> [usize; D] {
        let mut place = [0; D];
        for a in 0..D {
            place[a] = ((p[a] - self.low[a]) * self.per_size[a]).index().min(self.dimensions[a] - 1);
        }
        place
    }

    fn number(&self, place: [usize; D]) -> usize {
        (0..D).rev().fold(0, |number, a| number * self.dimensions[a] + place[a])
    }

    fn listed(&self, cell: usize) -> &[u32] {
        &self.entries[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }

    /// Numbers of the copies that may be within reach of `p`.
    fn at(&self, p: Vector<R, D>) -> &[u32] {
        if (0..D).all(|a| p[a] >= self.low[a] && p[a] <= self.high[a]) {
            self.listed(self.number(self.coordinates(p)))
        } else {
            &self.unbounded
        }
    }

    /// Whether the margin covers the rounding errors of a path that starts or ends here.
    fn precise(&self, end: Vector<R, D>) -> bool {
        end.0.iter().all(|c| c.abs() <= self.farthest)
    }

    /// The copies of the cell in which a path is at distance `at`, and the distance at which it leaves that cell.
    fn passed(&self, start: Vector<R, D>, direction: Vector<R, D>, at: R) -> (&[u32], R) {
        let place = self.coordinates(start + direction * at);
        let mut end = R::INFINITY;
        for a in 0..D {
            if direction[a] != R::ZERO {
                let ahead = if direction[a] > R::ZERO { place[a] + 1 } else { place[a] };
                let face = self.low[a] + self.size[a] * R::count(ahead);
                end = end.least((face - start[a]) / direction[a]);
            }
        }
        (self.listed(self.number(place)), end)
    }
}

/// Edge of the cubes of which `count` fill a box of this extent, and the axes that are divided at all: those
/// along which the box is longer than the edge.
fn edge<R: Real, const D: usize>(extent: Vector<R, D>, count: R) -> (R, [bool; D]) {
    let mut along = [true; D];
    loop {
        let axes = along.iter().filter(|&&divided| divided).count();
        if axes == 0 {
            return (R::INFINITY, along);
        }
        let volume = (0..D).filter(|&a| along[a]).fold(R::ONE, |volume, a| volume * extent[a]);
        let edge = (volume / count).powf(R::ONE / R::count(axes));
        let mut settled = true;
        for a in 0..D {
            if along[a] && extent[a] < edge {
                (along[a], settled) = (false, false);
            }
        }
        if settled {
            return (edge, along);
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    fn draws(mut state: u64) -> impl FnMut() -> f64 {
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    fn place<R: Real, const D: usize>(draw: &mut impl FnMut() -> f64, side: f64) -> Vector<R, D> {
        Vector(core::array::from_fn(|_| R::of(draw() * side)))
    }

    /// Shapes of every kind up to `size` in a box of side `side`, every seventh one transparent.
    fn mixture<R: Real, const D: usize>(count: usize, side: f64, size: f64) -> Vec<Obstacle<R, D>> {
        let mut draw = draws(1);
        (0..count)
            .map(|k| {
                let a = place::<R, D>(&mut draw, side);
                let by = place::<R, D>(&mut draw, size);
                let turned = Vector(core::array::from_fn(|axis| by[axis] * R::of(if k % 2 == 0 { 1.0 } else { -1.0 })));
                let shape = match k % 4 {
                    0 => Shape::new_ball(a, R::of(draw() * size)),
                    1 => Shape::new_segment(a, a + turned),
                    2 if D == 2 => Shape::new_polygon(vec![a, a + by, a + by.left() * R::HALF]),
                    _ => Shape::new_cuboid(a, a + by),
                };
                Obstacle { opaque: k % 7 != 0, ..Obstacle::new(shape.unwrap()) }
            })
            .collect()
    }

    /// The same collection without its grid.
    fn scanning<R: Real, const D: usize>(obstacles: &Obstacles<R, D>) -> Obstacles<R, D> {
        assert!(obstacles.cells.is_some(), "the test is to compare with a grid");
        Obstacles { cells: None, ..obstacles.clone() }
    }

    fn seen<R: Real, const D: usize>(
        obstacles: &Obstacles<R, D>,
        p: Vector<R, D>,
        reach: R,
    ) -> Vec<(u32, Nearest<R, D>)> {
        let mut seen = Vec::new();
        obstacles.near(p, reach, |index, _, nearest| seen.push((index, nearest)));
        seen
    }

    /// Every question, asked with and without the grid at places in and around the box.
    fn same_answers<R: Real, const D: usize>(obstacles: &Obstacles<R, D>, side: f64, questions: usize) {
        let scan = scanning(obstacles);
        let mut draw = draws(2);
        let reach = obstacles.reach;
        let (mut found, mut crossed, mut struck, mut hidden) = (0, 0, 0, 0);
        for k in 0..questions {
            let spread = if k % 5 == 0 { 3.0 * side } else { side };
            let shift = Vector([R::of((side - spread) * 0.5); D]);
            let p = place::<R, D>(&mut draw, spread) + shift;
            for within in [reach, reach * R::of(draw()), R::ZERO, reach * R::of(1.5)] {
                let (fast, slow) = (seen(obstacles, p, within), seen(&scan, p, within));
                found += fast.len();
                assert!(fast.is_sorted_by_key(|(index, _)| *index));
                assert_eq!(fast, slow, "{p:?} {within}");
                assert_eq!(obstacles.overlapping(p, within), scan.overlapping(p, within));
            }
            let mut q = place::<R, D>(&mut draw, spread) + shift;
            if k % 2 == 0 {
                q = p + (q - p).unit() * reach * R::of(draw());
            }
            if k % 3 == 0 {
                q[k % D] = p[k % D];
            }
            let crossing = obstacles.first_crossing(p, q);
            crossed += usize::from(crossing.is_some());
            assert_eq!(crossing, scan.first_crossing(p, q), "{p:?} {q:?}");
            let between = scan.copies.iter().any(|copy| copy.opaque && copy.shape.between(p, q));
            hidden += usize::from(between);
            let told = |obstacles: &Obstacles<R, D>| obstacles.hides(Screens::ANY, p, q);
            assert_eq!((told(obstacles), told(&scan)), (between, between), "{p:?} {q:?}");
            for limit in [(q - p).length(), R::INFINITY] {
                let hit = obstacles.cast(p, (q - p).unit(), limit);
                struck += usize::from(hit.is_some());
                assert_eq!(hit, scan.cast(p, (q - p).unit(), limit), "{p:?} {q:?} {limit}");
            }
        }
        assert!(found > questions / 10 && crossed > 0 && struck > crossed && hidden > 0, "the questions were idle");
        assert!(crossed < questions && hidden < questions);
    }

    #[test]
    fn what_is_put_somewhere_stays_there() {
        let ball = Obstacle::new(Shape::Ball { centre: Vector([0.0, 0.0]), radius: 1.0 });
        let gone = Obstacle { plan: Some(Plan { appears: 5.0, ..Plan::default() }), ..ball.clone() };
        let mut obstacles = Obstacles::<f64, 2>::new(vec![ball, gone], [None; 2], 1.0).unwrap();
        let at = |obstacles: &Obstacles<f64, 2>, x: f64| obstacles.overlapping(Vector([x, 0.0]), 0.1);
        obstacles.put(&[(0, Some(Vector([7.0, 0.0]))), (9, None)]);
        assert_eq!((at(&obstacles, 0.0), at(&obstacles, 7.0)), (None, Some(0)));
        assert!(obstacles.advance(6.0), "the other has a plan");
        assert_eq!((at(&obstacles, 0.0), at(&obstacles, 7.0)), (Some(1), Some(0)));
        obstacles.put(&[(0, None)]);
        assert_eq!(at(&obstacles, 7.0), None);
    }

    #[test]
    fn the_grid_answers_as_the_scan_does() {
        for reach in [0.0, 0.01, 2.0, 60.0] {
            same_answers(&Obstacles::<f64, 2>::new(mixture(300, 100.0, 4.0), [None; 2], reach).unwrap(), 100.0, 400);
        }
        for reach in [0.0, 3.0] {
            let many = Obstacles::<f64, 3>::new(mixture(1000, 100.0, 9.0), [None; 3], reach).unwrap();
            same_answers(&many, 100.0, 300);
            let single = Obstacles::<f32, 3>::new(mixture(1000, 100.0, 9.0), [None; 3], reach as f32).unwrap();
            same_answers(&single, 100.0, 300);
        }
        same_answers(&Obstacles::<f32, 2>::new(mixture(300, 100.0, 4.0), [None; 2], 2.0).unwrap(), 100.0, 400);
        same_answers(&Obstacles::<f64, 1>::new(mixture(40, 100.0, 0.5), [None; 1], 2.0).unwrap(), 100.0, 400);
    }

    #[test]
    fn the_grid_answers_as_the_scan_does_in_periodic_space_and_far_from_the_origin() {
        let list = mixture(200, 50.0, 4.0);
        same_answers(&Obstacles::<f64, 2>::new(list.clone(), [Some(50.0); 2], 3.0).unwrap(), 50.0, 400);
        same_answers(&Obstacles::<f64, 2>::new(list, [None, Some(50.0)], 3.0).unwrap(), 50.0, 400);
        same_answers(&Obstacles::<f32, 3>::new(mixture(200, 50.0, 9.0), [Some(50.0); 3], 3.0).unwrap(), 50.0, 200);
        // the far origin: the same questions asked around it
        let away = Vector([4096.0f32, -4096.0]);
        let mut moved = mixture::<f32, 2>(200, 50.0, 4.0);
        for obstacle in &mut moved {
            obstacle.shape = obstacle.shape.moved(away);
        }
        let obstacles = Obstacles::new(moved, [None; 2], 2.0).unwrap();
        let scan = scanning(&obstacles);
        let mut draw = draws(9);
        for _ in 0..2000 {
            let (p, q) = (place(&mut draw, 50.0) + away, place(&mut draw, 50.0) + away);
            assert_eq!(obstacles.first_crossing(p, q), scan.first_crossing(p, q));
            assert_eq!(seen(&obstacles, p, 2.0), seen(&scan, p, 2.0));
            let (p, direction) = (Vector([0.0, 0.0]), (q - Vector([0.0, 0.0])).unit());
            assert_eq!(obstacles.cast(p, direction, f32::INFINITY), scan.cast(p, direction, f32::INFINITY));
        }
    }

    #[test]
    fn planes_are_seen_from_everywhere() {
        let mut list = mixture::<f64, 3>(100, 50.0, 4.0);
        let floor = Shape::new_plane(Vector([0.0, 0.0, -1.0]), Vector([0.0, 0.0, 2.0])).unwrap();
        list.insert(50, Obstacle::new(floor));
        let obstacles = Obstacles::new(list, [None; 3], 3.0).unwrap();
        same_answers(&obstacles, 50.0, 300);
        assert_eq!(obstacles.overlapping(Vector([900.0, 0.0, 1.0]), 2.5), Some(50));
        let down = obstacles.cast(Vector([900.0, 0.0, 9.0]), Vector([0.0, 0.0, -1.0]), 99.0).unwrap();
        assert_eq!((down.0.distance, down.1), (10.0, 50));
    }

    #[test]
    fn a_thousand_balls_cost_a_few_candidates() {
        let mut draw = draws(4);
        let list = (0..1000).map(|_| Obstacle::new(Shape::new_ball(place(&mut draw, 335.0), 4.5).unwrap())).collect();
        let obstacles = Obstacles::<f64, 3>::new(list, [None; 3], 10.0).unwrap();
        let looked: usize =
            (0..1000).map(|_| obstacles.candidates(place(&mut draw, 335.0), 10.0).count()).sum::<usize>();
        assert!(looked < 5000, "{looked} candidates in a thousand questions");
    }

    #[test]
    fn a_path_costs_a_few_candidates_in_every_direction() {
        let mut draw = draws(6);
        let list: Vec<_> =
            (0..1000).map(|_| Obstacle::new(Shape::new_ball(place(&mut draw, 335.0), 4.5).unwrap())).collect();
        for reach in [0.0, 10.0] {
            let obstacles = Obstacles::<f64, 3>::new(list.clone(), [None; 3], reach).unwrap();
            let mut looked = 0;
            for _ in 0..100 {
                let (p, q) = (place(&mut draw, 335.0), place(&mut draw, 335.0));
                obstacles.along(obstacles.precise_cells(&[p]), p, (q - p).unit(), (q - p).length(), |_, _| {
                    looked += 1;
                    f64::INFINITY
                });
            }
            assert!(looked < 8000, "{looked} candidates on a hundred paths of reach {reach}");
        }
    }

    #[test]
    fn equal_crossings_go_to_the_lower_index() {
        let wall = Shape::new_segment(Vector([1.0, -1.0]), Vector([1.0, 1.0])).unwrap();
        let obstacles = Obstacles::new(vec![Obstacle::new(wall); 40], [None; 2], 0.5).unwrap();
        let (fraction, index, normal) = obstacles.first_crossing(Vector([0.0, 0.0]), Vector([4.0, 0.0])).unwrap();
        assert_eq!((fraction, index, normal), (0.25, 0, Vector([-1.0, 0.0])));
        assert_eq!(obstacles.cast(Vector([0.0, 0.0]), Vector([1.0, 0.0]), 9.0).unwrap().1, 0);
    }

    #[test]
    fn seen_through_the_seam() {
        let ball = Obstacle::new(Shape::new_ball(Vector([1.0, 5.0]), 0.5).unwrap());
        let obstacles = Obstacles::new(vec![ball], [Some(10.0), None], 3.0).unwrap();
        let near = seen(&obstacles, Vector([9.5, 5.0]), 3.0);
        assert_eq!(near.len(), 1);
        assert_eq!((near[0].1.distance, near[0].1.point), (1.0, Vector([10.5, 5.0])));
        let crossing = obstacles.first_crossing(Vector([9.5, 5.0]), Vector([11.5, 5.0])).unwrap();
        assert_eq!((crossing.0, crossing.1), (0.5, 0));
        assert_eq!(obstacles.cast(Vector([9.5, 5.0]), Vector([1.0, 0.0]), 2.0).unwrap().0.distance, 1.0);
        assert!(obstacles.hides(Screens::ANY, Vector([9.5, 5.0]), Vector([12.0, 5.0])));
        assert_eq!(seen(&obstacles, Vector([1.0, -4.0]), 3.0), vec![], "the other axis has no seam");
        assert_eq!(obstacles.present().count(), 1, "images are not obstacles");

        // at a corner of the box all four images are near
        let corner = Obstacle::new(Shape::new_ball(Vector([0.0, 0.0]), 0.5).unwrap());
        let obstacles = Obstacles::new(vec![corner; 2], [Some(4.0); 2], 3.0).unwrap();
        let indices: Vec<_> = seen(&obstacles, Vector([2.0, 2.0]), 3.0).iter().map(|(index, _)| *index).collect();
        assert_eq!(indices, [0, 0, 0, 0, 1, 1, 1, 1]);
    }

    #[test]
    fn a_moment_has_come_in_the_step_that_is_written_as_its_multiple() {
        for step in [0.1, 0.7, 0.3, 1e-3, 12.6] {
            for n in 1..2000u32 {
                let moment: f64 = format!("{:.4}", step * f64::from(n)).parse().unwrap();
                let plan = Plan::<f64, 2> { appears: moment, ..Plan::default() };
                assert!(plan.present(step * f64::from(n)), "{n} steps of {step}");
                assert!(!plan.present(step * (f64::from(n) - 1e-6)), "{n} steps of {step}");
            }
        }
        assert!(Plan::<f64, 2>::default().present(0.0) && Plan::<f64, 2>::default().present(1e300));
    }

    #[test]
    fn plans() {
        let origin = Vector([0.0, 0.0]);
        let ball = Shape::new_ball(origin, 1.0).unwrap();
        let plan = Plan {
            appears: 1.0,
            disappears: 9.0,
            waypoints: vec![(2.0, Vector([1.0, 0.0])), (4.0, Vector([5.0, 2.0])), (4.0, Vector([0.0, 7.0]))],
        };
        let moving = Obstacle { plan: Some(plan), ..Obstacle::new(ball.clone()) };
        let mut obstacles = Obstacles::new(vec![Obstacle::new(ball), moving], [None; 2], 1.0).unwrap();
        let centre = |obstacles: &Obstacles<f64, 2>| {
            obstacles
                .present()
                .find(|(index, _)| *index == 1)
                .map(|(_, shape)| (shape.bounds().0 + Vector([1.0, 1.0])).0)
        };
        assert_eq!(centre(&obstacles), None, "not there at time 0");
        assert_eq!((obstacles.len(), obstacles.present().count()), (2, 1));
        for (time, expected) in [
            (0.99, None),
            (1.0, Some([1.0, 0.0])),
            (2.0, Some([1.0, 0.0])),
            (3.0, Some([3.0, 1.0])),
            (4.0, Some([0.0, 7.0])),
            (8.9, Some([0.0, 7.0])),
            (9.0, None),
            (3.5, Some([4.0, 1.5])),
        ] {
            obstacles.advance(time);
            assert_eq!(centre(&obstacles), expected, "at {time}");
            assert_eq!(obstacles.overlapping(Vector([3.0, 8.0]), -1.0), None);
        }
        assert!(!obstacles.advance(3.5), "nothing has moved since");
        assert_eq!(obstacles.overlapping(Vector([4.0, 1.5]), 0.0), Some(1));
        assert_eq!(obstacles.overlapping(origin, 0.0), Some(0));
    }

    #[test]
    fn obstacles_that_move_through_the_seam_come_back_in() {
        let plan = Plan { waypoints: vec![(0.0, Vector([0.0])), (10.0, Vector([100.0]))], ..Plan::default() };
        let ball = Shape::new_ball(Vector([1.0]), 0.5).unwrap();
        let list = vec![Obstacle { plan: Some(plan), ..Obstacle::new(ball) }];
        let mut obstacles = Obstacles::<f64, 1>::new(list, [Some(10.0)], 1.0).unwrap();
        obstacles.advance(2.5);
        assert_eq!(obstacles.overlapping(Vector([6.0]), 0.0), Some(0), "1 + 25 is 6 in a box of 10");
        assert_eq!(obstacles.overlapping(Vector([1.0]), 0.0), None);
    }

    #[test]
    fn the_grid_follows_moving_obstacles() {
        let mut list = mixture::<f64, 2>(100, 40.0, 3.0);
        for (k, obstacle) in list.iter_mut().enumerate().filter(|(k, _)| k % 3 == 0) {
            let to = Vector([k as f64 * 0.3 - 10.0, 5.0]);
            let waypoints = vec![(0.0, Vector::ZERO), (10.0, to)];
            obstacle.plan = Some(Plan { appears: k as f64 * 0.1, waypoints, ..Plan::default() });
        }
        let mut obstacles = Obstacles::new(list, [None; 2], 2.0).unwrap();
        for time in [0.0, 3.0, 11.0] {
            obstacles.advance(time);
            same_answers(&obstacles, 40.0, 200);
        }
    }

    #[test]
    fn transparent_obstacles_hide_nothing_but_are_in_the_way() {
        let wall = Shape::new_segment(Vector([1.0, -1.0]), Vector([1.0, 1.0])).unwrap();
        let glass = Obstacle { opaque: false, ..Obstacle::new(wall.clone()) };
        let (from, to) = (Vector([0.0, 0.0]), Vector([2.0, 0.0]));
        let window = Obstacles::new(vec![glass.clone()], [None; 2], 1.0).unwrap();
        assert!(!window.hides(Screens::ANY, from, to) && window.first_crossing(from, to).is_some());
        assert!(window.screens(from, to).is_none());
        let both = Obstacles::new(vec![glass, Obstacle::new(wall)], [None; 2], 1.0).unwrap();
        for screens in [Screens::ANY, both.screens(from, to)] {
            assert!(both.hides(screens, from, to) && !both.hides(screens, from, Vector([1.0, 0.0])));
            assert!(!both.hides(screens, from, from));
        }
        assert!(both.screens(from, Vector([0.5, 0.5])).is_none());
    }

    #[test]
    fn none_at_all() {
        let none = Obstacles::<f32, 2>::new(vec![], [None; 2], 0.0).unwrap();
        assert!(none.is_empty() && Obstacles::<f32, 2>::default().is_empty());
        let (p, q) = (Vector([0.0, 0.0]), Vector([1.0, 0.0]));
        assert!(
            none.first_crossing(p, q).is_none() && none.cast(p, q, 9.0).is_none() && !none.hides(Screens::ANY, p, q)
        );
        assert_eq!(none.overlapping(p, 9.0), None);
    }

    #[test]
    fn many_points_at_one_place_are_no_trouble() {
        let dot = Obstacle::new(Shape::new_ball(Vector([0.0, 0.0]), 0.0).unwrap());
        let obstacles = Obstacles::<f64, 2>::new(vec![dot; 50], [None; 2], 0.0).unwrap();
        assert_eq!(obstacles.overlapping(Vector([0.0, 0.0]), 1.0), Some(0));
        assert_eq!(obstacles.first_crossing(Vector([-1.0, 0.0]), Vector([1.0, 0.0])), None);
        assert_eq!(obstacles.cast(Vector([-1.0, 0.0]), Vector([1.0, 0.0]), 5.0).unwrap().0.distance, 1.0);
        assert_eq!(seen(&obstacles, Vector([0.0, 0.0]), 0.0), vec![]);
    }

    #[test]
    fn senseless_collections_are_refused() {
        let ball = || Obstacle::new(Shape::Ball { centre: Vector([0.0, 0.0]), radius: 1.0 });
        let refused = |list, periodic, reach| Obstacles::<f64, 2>::new(list, periodic, reach).unwrap_err();
        let negative = Obstacle::new(Shape::Ball { centre: Vector([0.0, 0.0]), radius: -1.0 });
        assert_eq!(refused(vec![negative], [None; 2], 1.0), ShapeError::NegativeRadius);
        assert_eq!(refused(vec![ball()], [None; 2], f64::INFINITY), ShapeError::Reach);
        assert_eq!(refused(vec![ball()], [Some(1.0), None], 9.0), ShapeError::Reach);
        assert_eq!(refused(vec![ball()], [Some(0.0), None], 1.0), ShapeError::PeriodicLength);
        assert_eq!(refused(vec![ball()], [Some(0.1), None], 0.1), ShapeError::LongerThanSpace);
        let planned = |plan| Obstacle { plan: Some(plan), ..ball() };
        let backwards = Plan { waypoints: vec![(1.0, Vector::ZERO), (0.0, Vector::ZERO)], ..Plan::default() };
        assert_eq!(refused(vec![planned(backwards)], [None; 2], 1.0), ShapeError::WaypointOrder);
        let never = Plan { appears: f64::NAN, ..Plan::default() };
        assert_eq!(refused(vec![planned(never)], [None; 2], 1.0), ShapeError::NotFinite);
    }
}
