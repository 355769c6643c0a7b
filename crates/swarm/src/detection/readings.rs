//! From a scan to the members in it: the three detections of models.md section 2.4, the pipeline of group-control.md
//! section 9.3, and the counting and injecting of errors (models.md sections 2.4 and 5).
//!
//! Settled here, where the sources are silent:
//! * the warping distance is the least sum of absolute differences over all warping paths (steps 1-0, 0-1, 1-1, ends
//!   tied to ends), divided by the resampled length;
//! * a scan is not joined over its ends: a full-turn scanner splits what lies across them;
//! * returned readings that belong to no accepted member are obstacle points, under every detection;
//! * the error count lets a detection belong to the nearest member whose *centre* is within body radius + margin.
//!
//! **Straight walls under member-based detection.** The specified comparison looks at the shape of the range profile
//! alone, stretched to 32 readings, so that neither the width of a segment nor the sharpness of its rim counts. With
//! the default numbers, a body radius of 0.17 m and exact readings, a piece of wall alone in its segment fares so:
//! * seen face-on it is rejected while it looks flat, and again where its ends lie much farther off than its middle;
//!   between, it is *accepted*: from 0.19 to 1.08 m of width at 0.5 m, 0.26 to 1.45 m at 1 m, 0.37 to 1.99 m at 2 m,
//!   0.55 to 2.76 m at 4 m. The best match (0.85 m of wall at 1 m) is as close as a disc.
//! * seen aslant at 1 m it is accepted from 0.10 to 1.15 m at 10 degrees, 0.06 to 0.39 m at 20, 0.04 to 0.19 m at 45.
//!
//! A corridor wall in one piece is rejected; but bodies before it, losses, and the noise of far readings cut walls into
//! pieces that are accepted. Six bodies at random in a corridor 2.4 m wide: 0.3 walls per scan are taken for members
//! without noise, 4.2 with it. Bounds on the width of a segment ([`Matching::least_width`],
//! [`Matching::greatest_width`]; none by default, as specified) and a lower tolerance keep most of them out, at the
//! price of members missed: widths within 0.5 and 1.2 diameters leave 0.5 walls per scan with noise, and with a
//! tolerance of 0.015 m 0.2.

use crate::sensing::scanner::{Body, Origin, Scan, Scanner};
use core::ops::{AddAssign, Range};
use space::random::Stream;
use space::{Real, Vector};

/// One input of the control-law: a point at which something was detected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// From the focal member, world-aligned, in metres.
    pub offset: Vector<R, 2>,
    /// Counter-clockwise from the heading, in radians.
    pub bearing: R,
    /// In metres.
    pub range: R,
    /// Intensity of the reading, or the mean over the readings behind the input.
    pub intensity: R,
    /// The member that was truly hit, by most of the readings. For counting errors, never for a law.
    pub member: Option<u32>,
}

/// Member detection from the readings of a scan.
#[derive(Clone, Debug, PartialEq)]
pub enum ReadingDetection<R> {
    /// Every reading of at least this intensity is an input.
    SensorBased {
        /// Least intensity of the foreground: 0.25.
        least_intensity: R,
    },
    /// One input per accepted segment: the mean of its points.
    MemberBased(Matching<R>),
    /// Every reading of an accepted segment is an input.
    MemberExtrapolated(Matching<R>),
    /// One input per cluster that is bright and about as wide as a body.
    Clustered(Clustering<R>),
}

impl<R: Real> ReadingDetection<R> {
    /// Sensor-based detection with the default threshold of 0.25. By the intensity law it sees no wrapped member
    /// beyond 2 m.
    pub fn sensor_based() -> Self {
        Self::SensorBased { least_intensity: R::of(0.25) }
    }

    /// Finds the inputs and obstacle points of a scan, both in the order of the readings.
    pub fn detect(&self, scanner: &Scanner<R>, scan: &Scan<R>, out: &mut Readings<R>) {
        out.clear();
        match self {
            Self::SensorBased { least_intensity } => {
                for reading in 0..scan.ranges.len() {
                    if scan.intensities[reading] >= *least_intensity {
                        out.push_readings(scanner, scan, reading..reading + 1);
                    } else {
                        out.push_obstacle(scan, reading..reading + 1);
                    }
                }
            }
            Self::MemberBased(matching) => {
                for segment in segments(scan, matching.gap) {
                    if matching.accepts(scan, segment.clone(), &mut out.profile, &mut out.costs) {
                        out.push_mean(scan, segment, R::ZERO);
                    } else {
                        out.push_obstacle(scan, segment);
                    }
                }
            }
            Self::MemberExtrapolated(matching) => {
                for segment in segments(scan, matching.gap) {
                    if matching.accepts(scan, segment.clone(), &mut out.profile, &mut out.costs) {
                        out.push_readings(scanner, scan, segment);
                    } else {
                        out.push_obstacle(scan, segment);
                    }
                }
            }
            Self::Clustered(clustering) => {
                for segment in segments(scan, clustering.gap) {
                    if clustering.accepts(scan, segment.clone()) {
                        out.push_mean(scan, segment, clustering.body_radius);
                    } else {
                        out.push_obstacle(scan, segment);
                    }
                }
            }
        }
    }
}

/// Runs of returned readings whose consecutive ranges differ by at most `gap` metres.
fn segments<R: Real>(scan: &Scan<R>, gap: R) -> impl Iterator<Item = Range<usize>> + '_ {
    let mut next = 0;
    core::iter::from_fn(move || {
        let from = next + scan.ranges[next..].iter().position(|range| range.finite())?;
        next = from + 1;
        while next < scan.ranges.len()
            && scan.ranges[next].finite()
            && (scan.ranges[next] - scan.ranges[next - 1]).abs() <= gap
        {
            next += 1;
        }
        Some(from..next)
    })
}

/// Recognition of bodies by the shape of their range profile (steps 1 to 3 of member-based detection).
#[derive(Clone, Debug, PartialEq)]
pub struct Matching<R> {
    /// Consecutive ranges that differ by more split a segment, in metres: 0.10.
    pub gap: R,
    /// Shorter segments are dropped: 3 readings.
    pub least_readings: usize,
    /// Warping distance per reading below which a segment is a member, in metres: 0.02.
    pub tolerance: R,
    /// Least distance between the end points of a member's segment, in metres: 0, no bound. (Not in the source.)
    pub least_width: R,
    /// Greatest distance between the end points of a member's segment, in metres: infinite, no bound. (Not in the
    /// source.)
    pub greatest_width: R,
    resampled: usize,
    profiles: Vec<R>,
}

impl<R: Real> Matching<R> {
    /// Readings in a resampled profile, unless told otherwise.
    pub const RESAMPLED: usize = 32;

    /// Default thresholds, with a data base of profiles of 32 readings at seven distances, each 1.5 times the one
    /// before, from the scanner's guaranteed range inwards (0.36 m to 4.095 m for the URG-04LX); distances at
    /// which the body would touch the scanner are left out.
    pub fn new(scanner: &Scanner<R>, body_radius: R) -> Self {
        let distances: [R; 7] = core::array::from_fn(|k| scanner.guaranteed_range / R::of(1.5).powf(R::count(6 - k)));
        Self::with_profiles(scanner, body_radius, Self::RESAMPLED, &distances)
    }

    /// Default thresholds, with a data base of profiles of a disc straight ahead of this scanner, its centre at the
    /// given distances in metres. Distances at which it holds the scanner or is met by fewer than two rays are left
    /// out. `resampled` is raised to 2 if it is less.
    pub fn with_profiles(scanner: &Scanner<R>, body_radius: R, resampled: usize, distances: &[R]) -> Self {
        let resampled = resampled.max(2);
        let mut profiles = Vec::new();
        let (mut ranges, mut profile) = (Vec::new(), Vec::new());
        for &distance in distances {
            if !(distance > body_radius && body_radius > R::ZERO) {
                continue;
            }
            let half = ((body_radius / distance).asin() / scanner.resolution()).index();
            ranges.clear();
            for ray in 0..=2 * half {
                let angle = (R::count(ray) - R::count(half)) * scanner.resolution();
                let (sin, cos) = angle.sin_cos();
                let depth = (body_radius.squared() - (distance * sin).squared()).most(R::ZERO).root();
                ranges.push(distance * cos - depth);
            }
            if ranges.len() >= 2 {
                resample(&ranges, resampled, &mut profile);
                profiles.extend_from_slice(&profile);
            }
        }
        Self {
            gap: R::of(0.10),
            least_readings: 3,
            tolerance: R::of(0.02),
            least_width: R::ZERO,
            greatest_width: R::INFINITY,
            resampled,
            profiles,
        }
    }

    /// Readings in each profile of the data base.
    pub fn resampled(&self) -> usize {
        self.resampled
    }

    /// Whether a segment is a member.
    fn accepts(&self, scan: &Scan<R>, segment: Range<usize>, profile: &mut Vec<R>, costs: &mut Vec<R>) -> bool {
        let width = width(scan, &segment);
        if segment.len() < self.least_readings.max(2) || width < self.least_width || width > self.greatest_width {
            return false;
        }
        resample(&scan.ranges[segment], self.resampled, profile);
        let limit = self.tolerance * R::count(self.resampled);
        self.profiles.chunks_exact(self.resampled).any(|known| warping(profile, known, limit, costs) < limit)
    }
}

/// Distance between the end points of a segment.
fn width<R: Real>(scan: &Scan<R>, segment: &Range<usize>) -> R {
    match (scan.point(segment.start), scan.point(segment.end.saturating_sub(1))) {
        (Some(from), Some(to)) => (to - from).length(),
        _ => R::ZERO,
    }
}

/// Two or more ranges drawn out to `count` by linear interpolation, their mean subtracted.
fn resample<R: Real>(ranges: &[R], count: usize, out: &mut Vec<R>) {
    let last = ranges.len() - 1;
    let stride = R::count(last) / R::count(count - 1);
    out.clear();
    out.extend((0..count).map(|k| {
        let place = R::count(k) * stride;
        let before = place.index().min(last);
        let share = place - R::count(before);
        let (from, to) = (ranges[before], ranges[(before + 1).min(last)]);
        from + (to - from) * share
    }));
    let mean = out.iter().copied().sum::<R>() / R::count(count);
    for range in out.iter_mut() {
        *range -= mean;
    }
}

/// Dynamic time warping: the least sum of absolute differences over the warping paths of two profiles. Infinite as soon
/// as it is sure to exceed `limit`.
fn warping<R: Real>(first: &[R], second: &[R], limit: R, costs: &mut Vec<R>) -> R {
    costs.clear();
    costs.resize(second.len(), R::INFINITY);
    for (row, &a) in first.iter().enumerate() {
        let mut diagonal = if row == 0 { R::ZERO } else { R::INFINITY };
        let (mut left, mut least) = (R::INFINITY, R::INFINITY);
        for (cost, &b) in costs.iter_mut().zip(second) {
            let above = *cost;
            left = (a - b).abs() + above.least(diagonal).least(left);
            *cost = left;
            diagonal = above;
            least = least.least(left);
        }
        if least > limit {
            return R::INFINITY;
        }
    }
    costs.last().copied().unwrap_or(R::INFINITY)
}

/// The pipeline of group-control.md section 9.3: segments that are bright and about as wide as a body are members.
///
/// Brightness is the mean over the segment of the intensity made good for range, `q max(1, range / 1 m)^2`, that is of
/// albedo times the cosine of the incidence: pi/4 for a wrapped disc and at most 0.2 for a wall at any range, where the
/// bare intensity of a wrapped disc at 3 m is below that of a wall at 1 m. Noise of intensity grows alike with range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clustering<R> {
    /// Consecutive ranges that differ by more split a segment, in metres: 0.15.
    pub gap: R,
    /// Least distance between the end points of a segment, in metres: 0.2.
    pub least_width: R,
    /// Greatest distance between the end points of a segment, in metres: 0.5.
    pub greatest_width: R,
    /// Least brightness of a member: 0.5.
    pub least_intensity: R,
    /// By which the mean point is moved outwards along its bearing, in metres. (The mean of a disc's visible points is
    /// pi/4 of the radius before the centre, so that the result is about a fifth of the radius too far.)
    pub body_radius: R,
}

impl<R: Real> Clustering<R> {
    /// The default numbers for bodies of this radius in metres.
    pub fn new(body_radius: R) -> Self {
        Self {
            gap: R::of(0.15),
            least_width: R::of(0.2),
            greatest_width: R::of(0.5),
            least_intensity: R::HALF,
            body_radius,
        }
    }

    fn accepts(&self, scan: &Scan<R>, segment: Range<usize>) -> bool {
        let width = width(scan, &segment);
        let count = R::count(segment.len());
        let brightness: R = segment.map(|q| scan.intensities[q] * scan.ranges[q].most(R::ONE).squared()).sum();
        width >= self.least_width && width <= self.greatest_width && brightness / count >= self.least_intensity
    }
}

/// What was detected in a scan. Its buffers are used again by the next detection written into it.
#[derive(Clone, Debug)]
pub struct Readings<R> {
    /// Inputs of the control-law.
    pub inputs: Vec<Input<R>>,
    /// Returned readings that belong to no detected member, as world-aligned offsets in metres.
    pub obstacles: Vec<Vector<R, 2>>,
    /// The obstacle points as line segments (from, to), once [`Self::find_walls`] was called.
    pub walls: Vec<(Vector<R, 2>, Vector<R, 2>)>,
    /// Number of the reading behind each obstacle point.
    obstacle_readings: Vec<usize>,
    profile: Vec<R>,
    costs: Vec<R>,
    tally: Vec<(Origin, usize)>,
    pending: Vec<(usize, usize)>,
    pieces: Vec<(usize, usize)>,
    found: Vec<bool>,
}

impl<R: Real> Default for Readings<R> {
    fn default() -> Self {
        Self {
            inputs: Vec::new(),
            obstacles: Vec::new(),
            walls: Vec::new(),
            obstacle_readings: Vec::new(),
            profile: Vec::new(),
            costs: Vec::new(),
            tally: Vec::new(),
            pending: Vec::new(),
            pieces: Vec::new(),
            found: Vec::new(),
        }
    }
}

impl<R: Real> Readings<R> {
    fn clear(&mut self) {
        self.inputs.clear();
        self.obstacles.clear();
        self.obstacle_readings.clear();
        self.walls.clear();
    }

    fn push_readings(&mut self, scanner: &Scanner<R>, scan: &Scan<R>, readings: Range<usize>) {
        for q in readings {
            if let Some(offset) = scan.point(q) {
                let member = if let Origin::Member(member) = scan.origin[q] { Some(member) } else { None };
                let (range, intensity) = (scan.ranges[q], scan.intensities[q]);
                self.inputs.push(Input { offset, bearing: scanner.bearing(q), range, intensity, member });
            }
        }
    }

    fn push_obstacle(&mut self, scan: &Scan<R>, readings: Range<usize>) {
        for q in readings {
            if let Some(offset) = scan.point(q) {
                self.obstacles.push(offset);
                self.obstacle_readings.push(q);
            }
        }
    }

    /// One input for a segment: the mean of its points, moved outwards.
    fn push_mean(&mut self, scan: &Scan<R>, segment: Range<usize>, outwards: R) {
        let count = R::count(segment.len());
        let (mut sum, mut intensity) = (Vector::ZERO, R::ZERO);
        self.tally.clear();
        for q in segment {
            sum += scan.point(q).unwrap_or(Vector::ZERO);
            intensity += scan.intensities[q];
            match self.tally.iter_mut().find(|(origin, _)| *origin == scan.origin[q]) {
                Some((_, readings)) => *readings += 1,
                None => self.tally.push((scan.origin[q], 1)),
            }
        }
        let mean = sum / count;
        let offset = mean + mean.unit() * outwards;
        // of equal counts the first met wins
        let most =
            self.tally.iter().fold((Origin::Nothing, 0), |most, &each| if each.1 > most.1 { each } else { most });
        self.inputs.push(Input {
            offset,
            bearing: (offset.angle() - scan.heading).wrapped(),
            range: offset.length(),
            intensity: intensity / count,
            member: if let Origin::Member(member) = most.0 { Some(member) } else { None },
        });
    }

    /// Turns the obstacle points into line segments by splitting and merging.
    ///
    /// Points of neighbouring readings (at most two lost between them) no farther apart than `gap` form a run; a run is split at
    /// the point farthest from the line between its ends until all are within `deviation`, which is given for the range of the
    /// run's farthest point; neighbouring pieces are then merged, from the first on, where the line between their outer ends keeps
    /// within `deviation` of all points. A run of one point gives no segment. All lengths in metres.
    pub fn find_walls(&mut self, gap: R, deviation: impl Fn(R) -> R) {
        self.walls.clear();
        let mut from = 0;
        while from < self.obstacles.len() {
            let mut to = from;
            while to + 1 < self.obstacles.len()
                && self.obstacle_readings[to + 1] <= self.obstacle_readings[to] + 3
                && (self.obstacles[to + 1] - self.obstacles[to]).length() <= gap
            {
                to += 1;
            }
            if to > from {
                let range = self.obstacles[from..=to].iter().map(|point| point.length()).fold(R::ZERO, R::most);
                self.split_and_merge(from, to, deviation(range));
            }
            from = to + 1;
        }
    }

    fn split_and_merge(&mut self, from: usize, to: usize, deviation: R) {
        self.pieces.clear();
        self.pending.clear();
        self.pending.push((from, to));
        while let Some((from, to)) = self.pending.pop() {
            let (farthest, distance) = farthest(&self.obstacles[from..=to]);
            if distance > deviation {
                self.pending.push((from + farthest, to));
                self.pending.push((from, from + farthest));
            } else {
                self.pieces.push((from, to));
            }
        }
        let mut joined = (from, from);
        for &(start, end) in &self.pieces {
            if joined.1 > joined.0 && farthest(&self.obstacles[joined.0..=end]).1 > deviation {
                self.walls.push((self.obstacles[joined.0], self.obstacles[joined.1]));
                joined = (start, end);
            } else {
                joined.1 = end;
            }
        }
        self.walls.push((self.obstacles[joined.0], self.obstacles[joined.1]));
    }

    /// Counts the errors of the inputs against the true bodies (models.md section 5).
    ///
    /// An input belongs to the member whose centre is nearest to it, if that is within the body's radius + `margin`
    /// (0.1 m); of equally near ones to the earlier in the list. A member is in view if its centre lies in the field
    /// of view and its nearest point between the shortest and the longest range, hidden or not; it is not fully
    /// occluded if some ray met it first.
    pub fn count_errors(&mut self, scanner: &Scanner<R>, scan: &Scan<R>, bodies: &[Body<R>], margin: R) -> ErrorCount {
        self.found.clear();
        self.found.resize(bodies.len(), false);
        let mut count = ErrorCount { detections: self.inputs.len() as u64, ..ErrorCount::default() };
        for input in &self.inputs {
            let mut nearest = (R::INFINITY, None);
            for (index, body) in bodies.iter().enumerate() {
                let distance = (input.offset - body.offset).length();
                if distance <= body.radius + margin && distance < nearest.0 {
                    nearest = (distance, Some(index));
                }
            }
            match nearest.1 {
                Some(index) => self.found[index] = true,
                None => count.false_detections += 1,
            }
        }
        for (body, &found) in bodies.iter().zip(&self.found) {
            let range = body.offset.length() - body.radius;
            let bearing = (body.offset.angle() - scan.heading).wrapped();
            let in_range = range >= scanner.shortest_range && range <= scanner.longest_range;
            if !in_range || !scanner.in_field_of_view(bearing) {
                continue;
            }
            let shows = scan.origin.contains(&Origin::Member(body.member));
            count.members_in_view += 1;
            count.members_missed += u64::from(!found);
            count.members_not_fully_occluded += u64::from(shows);
            count.missed_not_fully_occluded += u64::from(shows && !found);
        }
        count
    }
}

/// Place and distance of the point farthest from the line through the first and the last (from the first, if these
/// coincide); (0, 0) for fewer than three points.
fn farthest<R: Real>(points: &[Vector<R, 2>]) -> (usize, R) {
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else {
        return (0, R::ZERO);
    };
    let across = (last - first).unit().left();
    let mut most = (0, R::ZERO);
    for (index, &point) in points.iter().enumerate().take(points.len() - 1).skip(1) {
        let offset = point - first;
        let distance = if across == Vector::ZERO { offset.length() } else { offset.dot(across).abs() };
        if distance > most.1 {
            most = (index, distance);
        }
    }
    most
}

/// Errors of detection, counted over one scan or, summed, over many.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ErrorCount {
    /// Members in range and field of view.
    pub members_in_view: u64,
    /// Those of them without a detection.
    pub members_missed: u64,
    /// Members in view that at least one ray met first.
    pub members_not_fully_occluded: u64,
    /// Those of them without a detection.
    pub missed_not_fully_occluded: u64,
    /// Inputs of the control-law.
    pub detections: u64,
    /// Those of them that belong to no member.
    pub false_detections: u64,
}

impl ErrorCount {
    /// Missed members per member in view; 0 if none is.
    pub fn false_negative_rate(&self) -> f64 {
        share(self.members_missed, self.members_in_view)
    }
    /// Missed members per member in view that is not fully occluded; 0 if there is none.
    pub fn visible_false_negative_rate(&self) -> f64 {
        share(self.missed_not_fully_occluded, self.members_not_fully_occluded)
    }
    /// False detections per detection; 0 if there is none.
    pub fn false_positive_rate(&self) -> f64 {
        share(self.false_detections, self.detections)
    }
}

impl AddAssign for ErrorCount {
    fn add_assign(&mut self, other: Self) {
        self.members_in_view += other.members_in_view;
        self.members_missed += other.members_missed;
        self.members_not_fully_occluded += other.members_not_fully_occluded;
        self.missed_not_fully_occluded += other.missed_not_fully_occluded;
        self.detections += other.detections;
        self.false_detections += other.false_detections;
    }
}

fn share(part: u64, whole: u64) -> f64 {
    if whole == 0 { 0.0 } else { part as f64 / whole as f64 }
}

/// Errors put into a detection on purpose (models.md section 2.4).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InjectedErrors<R> {
    /// Probability that an input is dropped (`p_fn`).
    pub miss: R,
    /// Mean number of false inputs per scan (`lambda_fp`), at most 700.
    pub false_inputs: R,
}

/// Slots of the draws: about an input, its loss; about a false input, its bearing and range; about none, their number.
/// The scanner's own draws about a reading use slots 0 to 4, so that both may share a stream.
const MISS_SLOT: u32 = 5;
const BEARING_SLOT: u32 = 6;
const RANGE_SLOT: u32 = 7;
const NUMBER_SLOT: u32 = 5;

impl<R: Real> InjectedErrors<R> {
    /// Drops inputs, then appends false ones, uniform over the area between the scanner's shortest and longest ranges
    /// and its first and last rays. A false input has the intensity of a wrapped body seen face-on and no member.
    pub fn apply(&self, scanner: &Scanner<R>, scan: &Scan<R>, draws: &Stream, inputs: &mut Vec<Input<R>>) {
        let mut index = 0;
        inputs.retain(|_| {
            let kept = draws.uniform_about(index, MISS_SLOT) >= self.miss.to_f64();
            index += 1;
            kept
        });
        let (near, far) = (scanner.shortest_range.squared(), scanner.longest_range.squared());
        let first = scanner.bearing(0);
        let opening = R::count(scanner.readings().saturating_sub(1)) * scanner.resolution();
        for k in 0..poisson(self.false_inputs.to_f64(), draws.uniform(NUMBER_SLOT)) {
            let bearing = first + opening * R::of(draws.uniform_about(k, BEARING_SLOT));
            let range = (near + (far - near) * R::of(draws.uniform_about(k, RANGE_SLOT))).root();
            inputs.push(Input {
                offset: Vector::at_angle(scan.heading + bearing) * range,
                bearing: bearing.wrapped(),
                range,
                intensity: scanner.intensity(Body::<R>::WRAPPED, R::ONE, range),
                member: None,
            });
        }
    }
}

/// A Poisson number from a uniform number in [0, 1), by inversion. The mean counts as 700 if it is greater (beyond,
/// the probability of 0 underflows) and as 0 if it is negative or not a number.
pub fn poisson(mean: f64, uniform: f64) -> u32 {
    let mean = if mean > 0.0 { mean.min(700.0) } else { 0.0 };
    let mut probability = Real::exp(-mean);
    let (mut below, mut number) = (probability, 0);
    // the sum of the probabilities may stay short of a uniform number close to 1
    while uniform >= below && number < 2000 {
        number += 1;
        probability *= mean / f64::from(number);
        below += probability;
    }
    number
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensing::scanner::{ScanNoise, Surface};
    use space::random::Purpose;

    type V = Vector<f64, 2>;
    const RADIUS: f64 = 0.17;

    fn draws(step: u64) -> Stream {
        Stream::new(12, Purpose::Sensing, step, 1)
    }
    fn body(x: f64, y: f64, member: u32) -> Body<f64> {
        Body { offset: Vector([x, y]), radius: RADIUS, albedo: 1.0, member }
    }
    fn take(scanner: &Scanner<f64>, heading: f64, bodies: &[Body<f64>]) -> Scan<f64> {
        let mut scan = Scan::default();
        scanner.scan(heading, bodies, |_, _| None, false, &draws(0), &mut scan);
        scan
    }
    fn surface(walls: &[(V, V, f64)], direction: V, limit: f64) -> Option<Surface<f64>> {
        let hits = walls.iter().filter_map(|&(point, normal, half)| {
            let distance = point.dot(normal) / direction.dot(normal);
            let along = (direction * distance - point).dot(normal.left()).abs();
            (distance > 0.0 && distance <= limit && along <= half).then_some((distance, normal))
        });
        let (distance, normal) = hits.min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(Surface { distance, normal, albedo: 0.2 })
    }
    /// Pieces of wall, each a point on it, its normal, and half its width.
    fn with_walls(scanner: &Scanner<f64>, bodies: &[Body<f64>], walls: &[(V, V, f64)]) -> Scan<f64> {
        let mut scan = Scan::default();
        scanner.scan(0.0, bodies, |d, limit| surface(walls, d, limit), true, &draws(0), &mut scan);
        scan
    }
    fn detect(detection: &ReadingDetection<f64>, scanner: &Scanner<f64>, scan: &Scan<f64>) -> Readings<f64> {
        let mut out = Readings::default();
        detection.detect(scanner, scan, &mut out);
        out
    }
    fn matching() -> Matching<f64> {
        Matching::new(&Scanner::default(), RADIUS)
    }
    fn member_based() -> ReadingDetection<f64> {
        ReadingDetection::MemberBased(matching())
    }

    #[test]
    fn sensor_based_counts_the_bright_readings_of_a_disc() {
        let scanner = Scanner::default();
        let scan = take(&scanner, 0.4, &[Body { offset: V::at_angle(0.4) * 0.8, ..body(0.0, 0.0, 3) }]);
        let out = detect(&ReadingDetection::sensor_based(), &scanner, &scan);
        // within 1 m the intensity is the cosine of the incidence, sqrt(1 - (sideways / radius)^2)
        let bright = (RADIUS * 0.9375f64.sqrt() / 0.8).asin() / scanner.resolution();
        let all = (RADIUS / 0.8).asin() / scanner.resolution();
        assert_eq!(out.inputs.len(), 2 * bright.floor() as usize + 1);
        assert_eq!(out.obstacles.len(), 2 * all.floor() as usize + 1 - out.inputs.len(), "the dark rim");
        for input in &out.inputs {
            assert_eq!(input.member, Some(3));
            assert!(((input.offset - V::at_angle(0.4) * 0.8).length() - RADIUS).abs() < 1e-12);
            assert!((input.offset.length() - input.range).abs() < 1e-12 && input.intensity >= 0.25);
            assert!((input.offset.angle() - 0.4 - input.bearing).abs() < 1e-12);
        }
        // the intensity of a wrapped body falls below the threshold at 2 m
        assert_eq!(
            detect(&ReadingDetection::sensor_based(), &scanner, &take(&scanner, 0.0, &[body(2.18, 0.0, 0)])).inputs,
            []
        );
    }

    #[test]
    fn with_no_exclusion_the_two_nearest_inputs_are_neighbouring_readings_of_one_body() {
        let scanner = Scanner::default();
        let scan = take(&scanner, 0.0, &[body(1.0, 0.4, 0), body(1.1, -0.5, 1), body(1.6, 0.0, 2)]);
        let nearest = |detection: &ReadingDetection<f64>| {
            let mut inputs = detect(detection, &scanner, &scan).inputs;
            inputs.sort_by(|a, b| a.range.total_cmp(&b.range));
            (inputs[0], inputs[1])
        };
        for detection in [ReadingDetection::sensor_based(), ReadingDetection::MemberExtrapolated(matching())] {
            let (first, second) = nearest(&detection);
            assert_eq!((first.member, second.member), (Some(0), Some(0)));
            assert!(((first.bearing - second.bearing).abs() / scanner.resolution() - 1.0).abs() < 1e-9);
        }
        let (first, second) = nearest(&member_based());
        assert_eq!((first.member, second.member), (Some(0), Some(1)));
    }

    #[test]
    fn member_based_gives_one_point_per_member_a_little_before_its_centre() {
        let scanner = Scanner::default();
        let bodies = [body(0.5, -0.6, 4), body(3.0, 0.2, 7), body(1.5, 1.0, 9)];
        let scan = take(&scanner, 0.0, &bodies);
        let mut out = detect(&member_based(), &scanner, &scan);
        assert_eq!(out.inputs.iter().map(|i| i.member).collect::<Vec<_>>(), [Some(4), Some(7), Some(9)]);
        for (input, body) in out.inputs.iter().zip(bodies) {
            // from afar the visible points lie sqrt(radius^2 - sideways^2) before the centre: pi/4 radius on average
            let short = body.offset.length() - input.range;
            assert!((short - RADIUS * std::f64::consts::PI / 4.0).abs() < 0.03, "{short}");
            assert!((input.bearing - body.offset.angle()).abs() < 0.004);
            assert!((input.offset.angle() - input.bearing).abs() < 1e-12);
        }
        let count = out.count_errors(&scanner, &scan, &bodies, 0.1);
        assert_eq!((count.members_in_view, count.members_missed, count.false_detections), (3, 0, 0));
    }

    #[test]
    fn extrapolated_hands_on_every_reading_of_the_same_segments() {
        let scanner = Scanner::default();
        let bodies = [body(0.5, -0.6, 4), body(3.0, 0.2, 7)];
        let scan = take(&scanner, 0.0, &bodies);
        let out = detect(&ReadingDetection::MemberExtrapolated(matching()), &scanner, &scan);
        assert_eq!(out.inputs.len(), scan.ranges.iter().filter(|r| r.is_finite()).count());
        assert_eq!(out.obstacles, []);
        for member in [4, 7] {
            let own: Vec<_> = out.inputs.iter().filter(|i| i.member == Some(member)).collect();
            let mean = own.iter().fold(V::ZERO, |sum, i| sum + i.offset) / own.len() as f64;
            let single = detect(&member_based(), &scanner, &scan).inputs;
            assert!(single.iter().any(|i| i.member == Some(member) && (i.offset - mean).length() < 1e-12));
        }
    }

    #[test]
    fn discs_are_accepted_at_every_distance() {
        let scanner = Scanner::default();
        for k in 0..220 {
            let scan = take(&scanner, 0.0, &[body(0.25 + 0.025 * f64::from(k), 0.013 * f64::from(k % 9), 0)]);
            assert_eq!(detect(&member_based(), &scanner, &scan).inputs.len(), 1, "{k}");
        }
    }

    #[test]
    fn segments_split_at_jumps_and_lost_readings_and_short_ones_are_dropped() {
        let scanner = Scanner::default();
        let mut scan = take(&scanner, 0.0, &[body(1.0, 0.0, 0)]);
        let all: Vec<_> = segments(&scan, 0.1).collect();
        assert_eq!(all.len(), 1);
        scan.ranges[340] = f64::INFINITY;
        assert_eq!(segments(&scan, 0.1).collect::<Vec<_>>(), [all[0].start..340, 341..all[0].end]);
        scan.ranges[340] = 1.2;
        assert_eq!(segments(&scan, 0.1).count(), 3);
        let far = Scanner { longest_range: 20.0, ..Scanner::default() };
        let scan = take(&far, 0.0, &[body(20.0, 0.003, 0)]);
        assert_eq!(segments(&scan, 0.1).next().map(|s| s.len()), Some(3));
        assert_eq!(
            detect(&ReadingDetection::MemberBased(Matching { least_readings: 4, ..matching() }), &far, &scan).inputs,
            []
        );
    }

    #[test]
    fn straight_walls_as_the_module_text_says() {
        let scanner = Scanner::default();
        let found = |distance: f64, width: f64, degrees: f64, matching: Matching<f64>| {
            let normal = V::at_angle(degrees.to_radians());
            let scan = with_walls(&scanner, &[], &[(Vector([distance, 0.0]), normal, width / 2.0)]);
            detect(&ReadingDetection::MemberBased(matching), &scanner, &scan).inputs.len()
        };
        for (distance, low, high) in [(0.5, 0.19, 1.08), (1.0, 0.26, 1.45), (2.0, 0.37, 1.99), (4.0, 0.55, 2.76)] {
            assert_eq!(found(distance, low * 0.95, 0.0, matching()), 0, "flat at {distance}");
            assert_eq!(found(distance, low * 1.05, 0.0, matching()), 1, "at {distance}");
            assert_eq!(found(distance, high * 0.95, 0.0, matching()), 1, "at {distance}");
            assert_eq!(found(distance, high * 1.05, 0.0, matching()), 0, "deep at {distance}");
        }
        for (degrees, high) in [(10.0, 1.15), (20.0, 0.39), (45.0, 0.19)] {
            assert_eq!(found(1.0, high * 0.95, degrees, matching()), 1, "{degrees}");
            assert_eq!(found(1.0, high * 1.05, degrees, matching()), 0, "{degrees}");
        }
        let bounded = || Matching { greatest_width: 0.4, least_width: 0.17, ..matching() };
        assert_eq!(found(1.0, 0.85, 0.0, bounded()), 0);
        assert_eq!(found(1.0, 0.15, 45.0, bounded()), 0);
        assert_eq!(found(1.2, 100.0, 0.0, matching()), 0, "a whole wall");
        // no part of an exact corridor is taken for a member
        let walls = [(Vector([0.0, 1.2]), Vector([0.0, 1.0]), 50.0), (Vector([0.0, -1.2]), Vector([0.0, 1.0]), 50.0)];
        let scan = with_walls(&scanner, &[body(2.0, 0.1, 5)], &walls);
        let out = detect(&member_based(), &scanner, &scan);
        assert_eq!(out.inputs.iter().map(|i| i.member).collect::<Vec<_>>(), [Some(5)]);
    }

    /// Inputs that no member gave, per scan, and the share of members missed, for six bodies at random in a corridor.
    fn corridor(noise: Option<ScanNoise<f64>>, matching: &Matching<f64>) -> (f64, f64) {
        let scanner = Scanner { noise, ..Scanner::default() };
        let walls = [(Vector([0.0, 1.2]), Vector([0.0, 1.0]), 50.0), (Vector([0.0, -1.2]), Vector([0.0, 1.0]), 50.0)];
        let (mut walls_taken, mut count, scans) = (0, ErrorCount::default(), 120);
        for step in 0..scans {
            let layout = draws(step);
            let mut places: Vec<V> = Vec::new();
            for k in 0..1000 {
                let place = Vector([3.0 * layout.uniform_about(k, 5), 2.0 * layout.uniform_about(k, 6) - 1.0]);
                if places.len() < 6 && places.iter().all(|other| (*other - place).length() > 0.36) {
                    places.push(place);
                }
            }
            let me = places[0];
            let bodies: Vec<_> =
                (1..6u32).map(|m| Body { offset: places[m as usize] - me, ..body(0.0, 0.0, m) }).collect();
            let moved = walls.map(|(point, normal, half)| (point - me, normal, half));
            let heading = std::f64::consts::TAU * layout.uniform(7);
            let mut scan = Scan::default();
            scanner.scan(heading, &bodies, |d, limit| surface(&moved, d, limit), true, &layout, &mut scan);
            let mut out = detect(&ReadingDetection::MemberBased(matching.clone()), &scanner, &scan);
            walls_taken += out.inputs.iter().filter(|input| input.member.is_none()).count();
            count += out.count_errors(&scanner, &scan, &bodies, 0.1);
        }
        (walls_taken as f64 / scans as f64, count.visible_false_negative_rate())
    }

    #[test]
    fn walls_in_pieces_are_taken_for_members_unless_widths_are_bounded() {
        let free = matching();
        let bounded = Matching { least_width: 0.17, greatest_width: 0.41, tolerance: 0.015, ..matching() };
        let (exact, noisy) = (corridor(None, &free), corridor(Some(ScanNoise::default()), &free));
        let (exact_bounded, noisy_bounded) = (corridor(None, &bounded), corridor(Some(ScanNoise::default()), &bounded));
        assert!(exact.0 < 0.6 && noisy.0 > 3.0, "{exact:?} {noisy:?}");
        assert!(exact_bounded.0 < 0.05 && noisy_bounded.0 < 0.4, "{exact_bounded:?} {noisy_bounded:?}");
        assert!(exact.1 < exact_bounded.1 && noisy.1 < noisy_bounded.1, "the price");
        assert!(exact.1 < noisy.1 && exact_bounded.1 < noisy_bounded.1, "noise raises misses");
    }

    #[test]
    fn warping_by_hand() {
        let mut costs = Vec::new();
        let far = f64::INFINITY;
        assert_eq!(warping(&[0.0, 1.0, 2.0], &[0.0, 1.0, 2.0], far, &mut costs), 0.0);
        assert_eq!(warping(&[0.0, 1.0, 2.0], &[0.0, 0.0, 1.0, 2.0, 2.0], far, &mut costs), 0.0);
        assert_eq!(warping(&[0.0, 0.0, 0.0], &[1.0, -2.0, 0.5], far, &mut costs), 3.5);
        assert_eq!(warping(&[0.0, 3.0, 0.0], &[0.0, 1.0, 0.0], far, &mut costs), 2.0);
        assert_eq!(warping(&[0.0, 3.0, 0.0], &[0.0, 1.0, 0.0], 1.0, &mut costs), far);
        let mut profile = Vec::new();
        resample(&[1.0, 2.0, 4.0], 5, &mut profile);
        let wanted = [1.0, 1.5, 2.0, 3.0, 4.0].map(|r| r - 2.3);
        assert!(profile.iter().zip(wanted).all(|(a, b): (&f64, f64)| (a - b).abs() < 1e-15));
    }

    #[test]
    fn the_data_base_leaves_out_impossible_distances() {
        let scanner = Scanner::<f64>::default();
        assert_eq!(matching().profiles.len(), 7 * 32);
        assert_eq!(Matching::with_profiles(&scanner, RADIUS, 16, &[0.1, 1.0, 1000.0]).profiles.len(), 16);
        assert_eq!(Matching::with_profiles(&scanner, 0.0, 16, &[1.0]).profiles.len(), 0);
        assert_eq!(Matching::with_profiles(&scanner, RADIUS, 0, &[1.0]).resampled(), 2);
        for profile in matching().profiles.chunks_exact(32) {
            assert!(profile.iter().sum::<f64>().abs() < 1e-12);
            assert!((0..32).all(|k| (profile[k] - profile[31 - k]).abs() < 1e-9), "symmetric");
            assert!(profile[0] > 0.0 && profile[15] < 0.0);
        }
    }

    #[test]
    fn clusters_are_told_from_walls_and_dark_bodies() {
        let scanner = Scanner::default();
        let wall = [(Vector([3.5, 0.0]), Vector([1.0, 0.0]), 50.0)];
        let shepherd = Body { albedo: 0.2, ..body(1.0, -1.0, 8) };
        let bodies = [body(1.2, 0.5, 2), shepherd, body(2.8, 0.2, 6)];
        let scan = with_walls(&scanner, &bodies, &wall);
        let mut out = detect(&ReadingDetection::Clustered(Clustering::new(RADIUS)), &scanner, &scan);
        assert_eq!(out.inputs.iter().map(|i| i.member).collect::<Vec<_>>(), [Some(6), Some(2)]);
        for (input, centre) in out.inputs.iter().zip([bodies[2].offset, bodies[0].offset]) {
            let error = input.range - centre.length();
            assert!((error - RADIUS * (1.0 - std::f64::consts::PI / 4.0)).abs() < 0.02, "{error}");
            assert!((input.offset - centre).length() < 0.06);
        }
        let returned = scan.ranges.iter().filter(|r| r.is_finite()).count();
        let members = scan.origin.iter().filter(|o| matches!(o, Origin::Member(2 | 6))).count();
        assert_eq!(out.obstacles.len(), returned - members);
        out.find_walls(0.15, |_| 0.03);
        let on_wall = |p: V| (p[0] - 3.5).abs() < 1e-9;
        let pieces = out.walls.iter().filter(|w| on_wall(w.0) && on_wall(w.1));
        // the bodies cut the wall; none of its pieces is bent
        assert_eq!(pieces.filter(|w| (w.1 - w.0).length() > 0.3).count(), 3);
        assert!(out.walls.iter().all(|w| on_wall(w.0) == on_wall(w.1)));
    }

    #[test]
    fn splitting_and_merging() {
        let mut out = Readings::<f64>::default();
        let mut put = |points: &[[f64; 2]], first: usize| {
            out.obstacles.extend(points.iter().map(|&p| Vector(p)));
            out.obstacle_readings.extend(first..first + points.len());
        };
        put(&[[2.0, 0.0], [2.0, 0.1], [2.0, 0.2], [2.0, 0.3], [1.9, 0.3], [1.8, 0.3]], 10);
        put(&[[1.0, 1.0]], 17);
        put(&[[1.0, 1.1], [0.9, 1.1], [0.8, 1.1]], 21);
        put(&[[0.5, 2.0], [0.4, 2.0]], 24);
        out.find_walls(0.15, |_| 0.02);
        let wanted =
            [([2.0, 0.0], [2.0, 0.3]), ([2.0, 0.3], [1.8, 0.3]), ([1.0, 1.1], [0.8, 1.1]), ([0.5, 2.0], [0.4, 2.0])];
        assert_eq!(out.walls, wanted.map(|(a, b)| (Vector(a), Vector(b))));
        // a bend that a split in two leaves in three pieces, of which two are one line
        let mut out = Readings::<f64>::default();
        let line = [[0.0, 0.0], [0.1, 0.0], [0.2, 0.0], [0.3, 0.0], [0.4, 0.0], [0.5, 0.05], [0.6, 0.1]];
        out.obstacles.extend(line.map(Vector));
        out.obstacle_readings.extend(0..7);
        out.find_walls(1.0, |_| 0.015);
        assert_eq!(out.walls.len(), 2);
        assert_eq!((out.walls[0].0, out.walls[1].1), (Vector([0.0, 0.0]), Vector([0.6, 0.1])));
        assert_eq!(out.walls[0].1, out.walls[1].0);
    }

    #[test]
    fn errors_are_counted() {
        let scanner = Scanner::default();
        // seen, fully hidden by it, behind the scanner, out of range, seen but not detected, touching
        let bodies = [
            body(1.0, 0.0, 0),
            body(2.0, 0.0, 1),
            body(-1.0, 0.1, 2),
            body(6.0, 0.0, 3),
            body(0.0, 2.0, 4),
            body(0.1, 0.0, 5),
        ];
        let scan = take(&scanner, 0.0, &bodies);
        let input =
            |x: f64, y: f64| Input { offset: Vector([x, y]), bearing: 0.0, range: 1.0, intensity: 1.0, member: None };
        let mut out = Readings::default();
        // two for member 0, one for the member behind, two false
        out.inputs.extend([input(0.83, 0.0), input(1.0, 0.26), input(-1.0, 0.0), input(1.0, 0.28), input(0.0, 1.7)]);
        let mut count = out.count_errors(&scanner, &scan, &bodies, 0.1);
        let wanted = ErrorCount {
            members_in_view: 3,
            members_missed: 2,
            members_not_fully_occluded: 2,
            missed_not_fully_occluded: 1,
            detections: 5,
            false_detections: 2,
        };
        assert_eq!(count, wanted);
        assert_eq!((count.false_negative_rate(), count.false_positive_rate()), (2.0 / 3.0, 0.4));
        assert_eq!(count.visible_false_negative_rate(), 0.5);
        count += wanted;
        assert_eq!((count.members_in_view, count.false_detections), (6, 4));
        assert_eq!(ErrorCount::default().false_positive_rate(), 0.0);
    }

    #[test]
    fn noise_raises_the_misses_of_member_based_detection() {
        let scanner = Scanner { noise: Some(ScanNoise::default()), ..Scanner::default() };
        let bodies = [body(1.0, 0.6, 0), body(1.2, -0.6, 1), body(1.5, 0.0, 2)];
        let (mut scan, mut out) = (Scan::default(), Readings::default());
        let mut misses = |detection: ReadingDetection<f64>| {
            let mut count = ErrorCount::default();
            for step in 0..100 {
                scanner.scan(0.0, &bodies, |_, _| None, false, &draws(step), &mut scan);
                detection.detect(&scanner, &scan, &mut out);
                count += out.count_errors(&scanner, &scan, &bodies, 0.1);
            }
            count.false_negative_rate()
        };
        let strict = Matching { tolerance: 0.01, ..matching() };
        assert_eq!(misses(ReadingDetection::sensor_based()), 0.0);
        assert!(misses(ReadingDetection::MemberBased(strict)) > 0.01);
    }

    #[test]
    fn injected_errors_have_their_rates_and_fill_the_sensed_area() {
        let scanner = Scanner::default();
        let scan = take(&scanner, 0.3, &[body(1.0, 0.0, 0)]);
        let errors = InjectedErrors { miss: 0.25, false_inputs: 1.5 };
        let original = detect(&ReadingDetection::sensor_based(), &scanner, &scan).inputs;
        let (mut kept, mut added, mut squares, mut bearings) = (0.0, 0.0, 0.0, 0.0);
        let steps = 4000;
        for step in 0..steps {
            let mut inputs = original.clone();
            errors.apply(&scanner, &scan, &draws(step), &mut inputs);
            for input in inputs {
                if input.member.is_some() {
                    kept += 1.0;
                    assert!(original.contains(&input));
                    continue;
                }
                added += 1.0;
                squares += input.range * input.range / (5.6 * 5.6);
                bearings += input.bearing;
                assert!(input.range >= 0.02 && input.range <= 5.6 && scanner.in_field_of_view(input.bearing));
                assert!(((input.offset.angle() - 0.3 - input.bearing).wrapped()).abs() < 1e-12);
                assert!((input.offset.length() - input.range).abs() < 1e-12);
            }
        }
        let steps = steps as f64;
        assert!((kept / steps / original.len() as f64 - 0.75).abs() < 0.005);
        assert!((added / steps - 1.5).abs() < 0.06);
        assert!((squares / added - 0.5).abs() < 0.015, "uniform over area: the squared range is uniform");
        assert!((bearings / added).abs() < 0.06);
        let mut inputs = original.clone();
        InjectedErrors { miss: 0.0, false_inputs: 0.0 }.apply(&scanner, &scan, &draws(0), &mut inputs);
        assert_eq!(inputs, original);
    }

    #[test]
    fn poisson_numbers_have_their_mean_and_variance() {
        for mean in [0.3, 4.0, 60.0] {
            let n = 20_000;
            let numbers = (0..n).map(|k| f64::from(poisson(mean, draws(k).uniform(0))));
            let (sum, squares) = numbers.fold((0.0, 0.0), |(s, q), x| (s + x, q + x * x));
            let found = sum / n as f64;
            assert!((found / mean - 1.0).abs() < 0.03, "{mean}: {found}");
            assert!(((squares / n as f64 - found * found) / mean - 1.0).abs() < 0.05);
        }
        // P(0) = 1/e, P(0) + P(1) = 2/e
        assert_eq!(
            (poisson(1.0, 0.3678), poisson(1.0, 0.3679), poisson(1.0, 0.7357), poisson(1.0, 0.7358)),
            (0, 1, 1, 2)
        );
        assert_eq!((poisson(0.0, 0.999), poisson(-1.0, 0.5), poisson(f64::NAN, 0.5)), (0, 0, 0));
        assert!(poisson(1e9, 0.999_999_999_999_999_9) <= 2000);
    }

    #[test]
    fn buffers_carry_nothing_over() {
        let scanner = Scanner::default();
        let scan = take(&scanner, 0.0, &[body(1.0, 0.0, 0)]);
        let mut out = Readings::default();
        member_based().detect(&scanner, &scan, &mut out);
        let first = out.inputs.clone();
        ReadingDetection::sensor_based().detect(&scanner, &scan, &mut out);
        out.find_walls(0.1, |_| 0.02);
        member_based().detect(&scanner, &scan, &mut out);
        assert_eq!((out.inputs, out.obstacles.len(), out.walls.len()), (first, 0, 0));
    }
}
