//! The simulated planar range-finder (models.md section 2.3, group-control.md section 9.2).
//!
//! A Hokuyo URG-04LX at the member's centre, its front step along the heading. Every ray returns the nearest hit over
//! bodies (discs) and obstacles, so that occlusion needs no rule of its own. A disc is cast only against the rays
//! within its angular interval.
//!
//! Settled here, where the sources are silent:
//! * a body whose disc holds the scanner's centre is too near to be seen and hides nothing (such an overlap is a
//!   passing state that the physical motion removes);
//! * any other surface nearer than the shortest range blocks its ray, which then gives no return;
//! * a noisy range outside the reported ranges is no return;
//! * all rays of a scan are taken at the same instant.

use space::random::Stream;
use space::{Real, Vector};

/// Errors of the range-finder's readings; every reading draws its own, from its number in the scan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScanNoise<R> {
    /// Standard deviation of a range shorter than [`Self::near_range`], in metres.
    pub near_deviation: R,
    /// Standard deviation of a longer range, as a share of the range.
    pub far_deviation: R,
    /// Where the second rule takes over, in metres.
    pub near_range: R,
    /// Probability that a reading is lost.
    pub drop_out: R,
    /// Angle of incidence above which readings are lost more often, in radians.
    pub grazing_angle: R,
    /// Probability that a reading is lost at an incidence of a right angle; linear from [`Self::drop_out`] at
    /// [`Self::grazing_angle`].
    pub grazing_drop_out: R,
    /// Standard deviation of an intensity; a noisy intensity below 0 becomes 0.
    pub intensity_deviation: R,
}

impl<R: Real> Default for ScanNoise<R> {
    /// 10 mm below 1 m and 1 % of the range above; 1 % lost, growing above 75 degrees; 0.02 of intensity.
    fn default() -> Self {
        Self {
            near_deviation: R::of(0.01),
            far_deviation: R::of(0.01),
            near_range: R::ONE,
            drop_out: R::of(0.01),
            grazing_angle: R::of(75.0).radians(),
            grazing_drop_out: R::ONE,
            intensity_deviation: R::of(0.02),
        }
    }
}

impl<R: Real> ScanNoise<R> {
    /// Standard deviation of a reading of this range, in metres.
    pub fn deviation(&self, range: R) -> R {
        if range < self.near_range { self.near_deviation } else { self.far_deviation * range }
    }
    /// Probability that a reading is lost, from the cosine of its angle of incidence.
    pub fn loss(&self, cos_incidence: R) -> R {
        let right_angle = R::PI * R::HALF;
        let incidence = cos_incidence.acos();
        if incidence <= self.grazing_angle || self.grazing_angle >= right_angle {
            return self.drop_out;
        }
        let share = (incidence - self.grazing_angle) / (right_angle - self.grazing_angle);
        self.drop_out + (self.grazing_drop_out - self.drop_out) * share.least(R::ONE)
    }
}

/// The range-finder's numbers. A step is one ray of the angular grid; steps count counter-clockwise.
///
/// The used steps should span one turn at most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scanner<R> {
    /// Steps in a full turn.
    pub steps_per_turn: u32,
    /// First used step (the rightmost ray).
    pub first_step: u32,
    /// Last used step (the leftmost ray).
    pub last_step: u32,
    /// The step along the heading.
    pub front_step: u32,
    /// Shortest range that is reported, in metres.
    pub shortest_range: R,
    /// Longest range that is reported, in metres.
    pub longest_range: R,
    /// Longest range for which the maker vouches, in metres. Readings beyond it are given all the same; the data base
    /// of body profiles ends here. (Set [`Self::longest_range`] to it to use no other readings.)
    pub guaranteed_range: R,
    /// Errors of the readings; `None` for exact ones.
    pub noise: Option<ScanNoise<R>>,
}

impl<R: Real> Default for Scanner<R> {
    /// The URG-04LX without noise.
    fn default() -> Self {
        Self {
            steps_per_turn: 1024,
            first_step: 44,
            last_step: 725,
            front_step: 384,
            shortest_range: R::of(0.02),
            longest_range: R::of(5.6),
            guaranteed_range: R::of(4.095),
            noise: None,
        }
    }
}

/// A disc that the rays may hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body<R> {
    /// From the scanner to the centre, world-aligned, in metres.
    pub offset: Vector<R, 2>,
    /// In metres.
    pub radius: R,
    /// Share of light thrown back: 1 for members in their reflective wrapping.
    pub albedo: R,
    /// The member's number in the world.
    pub member: u32,
}

impl<R: Real> Body<R> {
    /// Albedo of reflective wrapping.
    pub const WRAPPED: R = R::ONE;
}

/// Where a ray meets an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface<R> {
    /// Along the ray, in metres.
    pub distance: R,
    /// Unit normal of the surface, of either sign.
    pub normal: Vector<R, 2>,
    /// Share of light thrown back: 0.2 for walls.
    pub albedo: R,
}

/// What a ray met first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// Nothing within the longest range.
    Nothing,
    /// A wall or other obstacle.
    Obstacle,
    /// The body of the member of this number.
    Member(u32),
}

/// One scan: a reading per used step, from the rightmost ray to the leftmost. Its buffers are used again by the next
/// scan written into it.
#[derive(Clone, Debug)]
pub struct Scan<R> {
    /// Range per reading, in metres; infinite for no return.
    pub ranges: Vec<R>,
    /// Intensity per reading; 0 for no return.
    pub intensities: Vec<R>,
    /// What the ray truly met first, also where the reading was lost. For counting errors, never for a law.
    pub origin: Vec<Origin>,
    /// Unit vector along each ray, world-aligned.
    pub directions: Vec<Vector<R, 2>>,
    /// Angle of the heading from the world's x axis, in radians.
    pub heading: R,
    /// Unit vectors in the scanner's frame, for the angular grid below.
    body_directions: Vec<Vector<R, 2>>,
    grid: [u32; 4],
    /// Cosine of the angle of incidence of each hit.
    cosines: Vec<R>,
}

impl<R: Real> Default for Scan<R> {
    fn default() -> Self {
        Self {
            ranges: Vec::new(),
            intensities: Vec::new(),
            origin: Vec::new(),
            directions: Vec::new(),
            heading: R::ZERO,
            body_directions: Vec::new(),
            grid: [0; 4],
            cosines: Vec::new(),
        }
    }
}

impl<R: Real> Scan<R> {
    /// The point that a reading shows, as a world-aligned offset from the scanner in metres; `None` for no return.
    pub fn point(&self, reading: usize) -> Option<Vector<R, 2>> {
        let range = *self.ranges.get(reading)?;
        if range.finite() { Some(*self.directions.get(reading)? * range) } else { None }
    }
}

/// Slots of the draws about a reading: range (two), loss, intensity (two).
const RANGE_SLOT: u32 = 0;
const LOSS_SLOT: u32 = 2;
const INTENSITY_SLOT: u32 = 3;

impl<R: Real> Scanner<R> {
    /// Readings in a scan.
    pub fn readings(&self) -> usize {
        if self.last_step < self.first_step { 0 } else { (self.last_step - self.first_step) as usize + 1 }
    }
    /// Angle between neighbouring rays, in radians.
    pub fn resolution(&self) -> R {
        R::of(core::f64::consts::TAU / f64::from(self.steps_per_turn.max(1)))
    }
    /// Bearing of a reading in radians, counter-clockwise from the heading.
    pub fn bearing(&self, reading: usize) -> R {
        let step = f64::from(self.first_step) + reading as f64 - f64::from(self.front_step);
        R::of(step * (core::f64::consts::TAU / f64::from(self.steps_per_turn.max(1))))
    }
    /// Whether a bearing (radians, in (-pi, pi]) lies between the first and the last ray.
    pub fn in_field_of_view(&self, bearing: R) -> bool {
        let count = self.readings();
        if count == 0 {
            return false;
        }
        let (first, last) = (self.bearing(0), self.bearing(count - 1));
        [-R::TAU, R::ZERO, R::TAU].iter().any(|&turn| bearing + turn >= first && bearing + turn <= last)
    }
    /// The intensity law: `albedo max(0, cos incidence) / max(1, range / 1 m)^2`.
    pub fn intensity(&self, albedo: R, cos_incidence: R, range: R) -> R {
        albedo * cos_incidence.most(R::ZERO) / range.most(R::ONE).squared()
    }

    /// Takes a scan into `out`.
    ///
    /// `heading_angle` is the angle of the front ray from the world's x axis in radians. `obstacle` is given a unit
    /// direction (world-aligned) and a limit in metres, and returns the first surface along it up to that limit; it is
    /// not asked if `has_obstacles` is false. Of bodies at the same distance the earlier in the list is hit, and a body
    /// before an obstacle. Without noise nothing is drawn; with it, reading `q` draws by
    /// `draws.uniform_about(q, slot)`, slots 0 to 4.
    pub fn scan(
        &self,
        heading_angle: R,
        bodies: &[Body<R>],
        obstacle: impl Fn(Vector<R, 2>, R) -> Option<Surface<R>>,
        has_obstacles: bool,
        draws: &Stream,
        out: &mut Scan<R>,
    ) {
        self.aim(heading_angle, out);
        for body in bodies {
            self.cast(body, out);
        }
        for q in 0..out.ranges.len() {
            if has_obstacles {
                let limit = out.ranges[q].least(self.longest_range);
                if let Some(surface) = obstacle(out.directions[q], limit)
                    && surface.distance <= self.longest_range
                    && surface.distance < out.ranges[q]
                {
                    out.ranges[q] = surface.distance;
                    out.intensities[q] = surface.albedo;
                    out.cosines[q] = surface.normal.dot(out.directions[q]).abs();
                    out.origin[q] = Origin::Obstacle;
                }
            }
            if out.origin[q] != Origin::Nothing {
                self.read(q, draws, out);
            }
        }
    }

    /// Empties the scan and turns its rays to the heading.
    fn aim(&self, heading: R, out: &mut Scan<R>) {
        let count = self.readings();
        let grid = [self.steps_per_turn, self.first_step, self.last_step, self.front_step];
        if out.grid != grid || out.body_directions.len() != count {
            out.grid = grid;
            out.body_directions.clear();
            out.body_directions.extend((0..count).map(|q| Vector::at_angle(self.bearing(q))));
        }
        out.heading = heading;
        out.ranges.clear();
        out.ranges.resize(count, R::INFINITY);
        out.intensities.clear();
        out.intensities.resize(count, R::ZERO);
        out.cosines.clear();
        out.cosines.resize(count, R::ZERO);
        out.origin.clear();
        out.origin.resize(count, Origin::Nothing);
        let (sin, cos) = heading.sin_cos();
        out.directions.clear();
        out.directions
            .extend(out.body_directions.iter().map(|d| Vector([d[0] * cos - d[1] * sin, d[0] * sin + d[1] * cos])));
    }

    /// Casts the rays that may touch the body. Until [`Self::read`], an intensity holds the albedo.
    fn cast(&self, body: &Body<R>, out: &mut Scan<R>) {
        let distance = body.offset.length();
        let nearest = distance - body.radius;
        // written so that a body of unknown (NaN) place is left out as well
        if !(nearest > R::ZERO && nearest <= self.longest_range && body.radius > R::ZERO) {
            return;
        }
        let bearing = (body.offset.angle() - out.heading).wrapped();
        let step = self.resolution();
        let front = R::of(f64::from(self.front_step) - f64::from(self.first_step));
        let middle = bearing / step + front;
        // one ray to spare on either side, for rounding
        let half = (body.radius / distance).asin() / step + R::ONE;
        let turn = R::of(f64::from(self.steps_per_turn));
        let count = out.ranges.len();
        for shift in [-turn, R::ZERO, turn] {
            let from = (middle + shift - half).ceil().most(R::ZERO).index();
            let past = (middle + shift + half + R::ONE).most(R::ZERO).index().min(count);
            for q in from..past {
                let direction = out.directions[q];
                let along = direction.dot(body.offset);
                let across = direction[0] * body.offset[1] - direction[1] * body.offset[0];
                let depth_squared = body.radius.squared() - across.squared();
                if depth_squared < R::ZERO || along <= R::ZERO {
                    continue;
                }
                let depth = depth_squared.root();
                let range = along - depth;
                if range < out.ranges[q] && range <= self.longest_range {
                    out.ranges[q] = range;
                    out.intensities[q] = body.albedo;
                    out.cosines[q] = depth / body.radius;
                    out.origin[q] = Origin::Member(body.member);
                }
            }
        }
    }

    /// Turns the hit of ray `q` into a reading: the intensity law, then the errors.
    fn read(&self, q: usize, draws: &Stream, out: &mut Scan<R>) {
        let mut range = out.ranges[q];
        let mut intensity = self.intensity(out.intensities[q], out.cosines[q], range);
        let mut lost = false;
        if let Some(noise) = &self.noise {
            let about = q as u32;
            lost = draws.uniform_about(about, LOSS_SLOT) < noise.loss(out.cosines[q]).to_f64();
            if !lost {
                range += noise.deviation(range) * R::of(draws.normal_about(about, RANGE_SLOT));
                let error = noise.intensity_deviation * R::of(draws.normal_about(about, INTENSITY_SLOT));
                intensity = (intensity + error).most(R::ZERO);
            }
        }
        // written so that a NaN from an obstacle is lost as well
        lost = lost || !(range >= self.shortest_range && range <= self.longest_range);
        out.ranges[q] = if lost { R::INFINITY } else { range };
        out.intensities[q] = if lost { R::ZERO } else { intensity };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use space::random::Purpose;

    type V = Vector<f64, 2>;

    fn draws() -> Stream {
        Stream::new(9, Purpose::Sensing, 0, 2)
    }
    fn body(x: f64, y: f64, member: u32) -> Body<f64> {
        Body { offset: Vector([x, y]), radius: 0.17, albedo: 1.0, member }
    }
    fn open(_: V, _: f64) -> Option<Surface<f64>> {
        None
    }
    /// An endless wall at `distance` along the world's x axis.
    fn wall(distance: f64) -> impl Fn(V, f64) -> Option<Surface<f64>> {
        move |direction, limit| {
            let range = distance / direction[0];
            (direction[0] > 0.0 && range <= limit).then_some(Surface {
                distance: range,
                normal: Vector([-1.0, 0.0]),
                albedo: 0.2,
            })
        }
    }
    fn take(scanner: &Scanner<f64>, heading: f64, bodies: &[Body<f64>]) -> Scan<f64> {
        let mut scan = Scan::default();
        scanner.scan(heading, bodies, open, false, &draws(), &mut scan);
        scan
    }
    const FRONT: usize = 384 - 44;

    #[test]
    fn geometry_of_the_readings() {
        let scanner = Scanner::<f64>::default();
        assert_eq!(scanner.readings(), 682);
        let degrees = |reading| scanner.bearing(reading).to_degrees();
        assert!((degrees(0) + 119.53125).abs() < 1e-12 && (degrees(681) - 119.8828125).abs() < 1e-12);
        assert!((degrees(681) - degrees(0) - 239.4140625).abs() < 1e-12);
        assert_eq!(scanner.bearing(FRONT), 0.0);
        assert!((scanner.resolution().to_degrees() - 0.3515625).abs() < 1e-12);
        assert!(scanner.in_field_of_view(0.0) && scanner.in_field_of_view(-2.08) && !scanner.in_field_of_view(3.0));
        let scan = take(&scanner, 0.5, &[]);
        assert_eq!((scan.ranges.len(), scan.intensities.len(), scan.origin.len()), (682, 682, 682));
        assert!(scan.ranges.iter().all(|r| r.is_infinite()) && scan.point(3).is_none());
        assert!((scan.directions[0].angle() - (0.5 + scanner.bearing(0))).abs() < 1e-14);
        let small = Scanner::<f32> { last_step: 10, ..Default::default() };
        assert_eq!(small.readings(), 0);
    }

    #[test]
    fn a_disc_straight_ahead() {
        let scanner = Scanner::<f64>::default();
        let scan = take(&scanner, 0.7, &[Body { offset: V::at_angle(0.7) * 1.5, ..body(0.0, 0.0, 5) }]);
        assert!((scan.ranges[FRONT] - 1.33).abs() < 1e-12);
        assert_eq!(scan.origin[FRONT], Origin::Member(5));
        assert!((scan.intensities[FRONT] - 1.0 / (1.33 * 1.33)).abs() < 1e-12);
        // as many readings as rays within the disc's angle
        let half = (0.17f64 / 1.5).asin() / scanner.resolution();
        let hit = scan.ranges.iter().filter(|r| r.is_finite()).count();
        assert_eq!(hit, 2 * half.floor() as usize + 1);
        assert!((scan.point(FRONT).unwrap_or_default() - V::at_angle(0.7) * 1.33).length() < 1e-12);
    }

    /// Every ray against every disc, by solving for the distance.
    fn slow(scanner: &Scanner<f64>, heading: f64, bodies: &[Body<f64>]) -> Vec<f64> {
        let one = |q| {
            let direction = V::at_angle(heading + scanner.bearing(q));
            let ranges = bodies.iter().filter(|b| b.offset.length() > b.radius).filter_map(|b| {
                let along = direction.dot(b.offset);
                let root = along * along - b.offset.length_squared() + b.radius * b.radius;
                (root >= 0.0 && along > 0.0).then(|| along - root.sqrt())
            });
            ranges.filter(|r| *r >= scanner.shortest_range && *r <= scanner.longest_range).fold(f64::INFINITY, f64::min)
        };
        (0..scanner.readings()).map(one).collect()
    }

    #[test]
    fn casting_by_interval_is_casting_all() {
        let whole = Scanner { first_step: 0, last_step: 1023, ..Default::default() };
        for scanner in [Scanner::default(), whole] {
            for step in 0..60 {
                let place = Stream { step, ..draws() };
                let bodies: Vec<_> = (0..12)
                    .map(|m| Body {
                        offset: Vector::at_angle(7.0 * place.uniform_about(m, 0)) * (6.0 * place.uniform_about(m, 1)),
                        radius: 0.05 + 0.5 * place.uniform_about(m, 2),
                        albedo: 1.0,
                        member: m,
                    })
                    .collect();
                let heading = 6.0 * place.uniform(3) - 3.0;
                let near: Vec<_> = bodies.into_iter().filter(|b| b.offset.length() > b.radius + 0.02).collect();
                let scan = take(&scanner, heading, &near);
                for (q, (fast, slow)) in scan.ranges.iter().zip(slow(&scanner, heading, &near)).enumerate() {
                    assert!(*fast == slow || (fast - slow).abs() < 1e-7, "reading {q} of step {step}: {fast} {slow}");
                }
            }
        }
    }

    #[test]
    fn a_near_disc_hides_a_far_one_in_either_order() {
        let scanner = Scanner::default();
        for bodies in [[body(1.0, 0.0, 0), body(2.0, 0.0, 1)], [body(2.0, 0.0, 1), body(1.0, 0.0, 0)]] {
            let scan = take(&scanner, 0.0, &bodies);
            assert!(!scan.origin.contains(&Origin::Member(1)));
            assert!(scan.origin.contains(&Origin::Member(0)));
        }
        let scan = take(&scanner, 0.0, &[body(1.0, 0.0, 0), body(2.0, 0.3, 1)]);
        assert!(scan.origin.contains(&Origin::Member(1)), "partly hidden");
    }

    #[test]
    fn too_near_too_far_and_behind() {
        let scanner = Scanner::default();
        let scan = take(&scanner, 0.0, &[body(0.1, 0.0, 0), body(1.0, 0.0, 1)]);
        assert_eq!(scan.origin[FRONT], Origin::Member(1), "an overlapping body hides nothing");
        let scan = take(&scanner, 0.0, &[body(0.18, 0.0, 0), body(1.0, 0.0, 1)]);
        assert!(scan.ranges[FRONT].is_infinite() && scan.intensities[FRONT] == 0.0);
        assert_eq!(scan.origin[FRONT], Origin::Member(0), "a touching one blocks the ray");
        assert!(take(&scanner, 0.0, &[body(5.8, 0.0, 0)]).ranges.iter().all(|r| r.is_infinite()));
        assert!(take(&scanner, 0.0, &[body(5.7, 0.0, 0)]).ranges[FRONT] == 5.7 - 0.17);
        assert!(take(&scanner, 0.0, &[body(-1.0, 0.0, 0)]).ranges.iter().all(|r| r.is_infinite()));
        assert!(take(&scanner, 0.0, &[body(f64::NAN, 0.0, 0)]).ranges.iter().all(|r| r.is_infinite()));
    }

    #[test]
    fn walls_are_hit_hide_and_are_hidden() {
        let scanner = Scanner::default();
        let mut scan = Scan::default();
        scanner.scan(0.0, &[body(1.0, 0.0, 0), body(3.0, 1.0, 1)], wall(2.0), true, &draws(), &mut scan);
        assert_eq!(scan.origin[FRONT], Origin::Member(0));
        assert!(!scan.origin.contains(&Origin::Member(1)));
        let at = FRONT + 171;
        let bearing: f64 = scanner.bearing(at);
        assert_eq!(scan.origin[at], Origin::Obstacle);
        assert!((scan.ranges[at] - 2.0 / bearing.cos()).abs() < 1e-12);
        assert!((scan.intensities[at] - 0.2 * bearing.cos().powi(3) / 4.0).abs() < 1e-12);
        scanner.scan(0.0, &[], wall(2.0), false, &draws(), &mut scan);
        assert!(scan.ranges.iter().all(|r| r.is_infinite()), "not asked for obstacles; the buffers start afresh");
        scanner.scan(0.0, &[], wall(0.01), true, &draws(), &mut scan);
        assert!(scan.ranges[FRONT].is_infinite() && scan.origin[FRONT] == Origin::Obstacle);
    }

    #[test]
    fn the_intensity_law() {
        let scanner = Scanner::<f64>::default();
        assert_eq!(scanner.intensity(1.0, 1.0, 0.5), 1.0);
        assert_eq!(scanner.intensity(0.2, 0.5, 2.0), 0.025);
        assert_eq!(scanner.intensity(1.0, -0.5, 2.0), 0.0);
        let scan = take(&scanner, 0.0, &[body(0.9, 0.0, 0)]);
        for q in 0..682 {
            if let Some(point) = scan.point(q) {
                let normal = (point - Vector([0.9, 0.0])) / 0.17;
                let cos = -normal.dot(scan.directions[q]);
                assert!((scan.intensities[q] - cos).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn noise_has_the_stated_deviation_and_losses() {
        let exact = Scanner::<f64>::default();
        let noisy = Scanner { noise: Some(ScanNoise::default()), ..exact };
        let (mut scan, mut truth) = (Scan::default(), Scan::default());
        for (distance, deviation) in [(0.5, 0.01), (3.0, 0.03)] {
            exact.scan(0.0, &[], wall(distance), true, &draws(), &mut truth);
            let (mut sum, mut squares, mut light, mut kept, mut all) = (0.0, 0.0, 0.0, 0.0, 0.0);
            for step in 0..200 {
                noisy.scan(0.0, &[], wall(distance), true, &Stream { step, ..draws() }, &mut scan);
                for q in FRONT - 20..=FRONT + 20 {
                    all += 1.0;
                    if scan.ranges[q].is_finite() {
                        kept += 1.0;
                        let error = scan.ranges[q] - truth.ranges[q];
                        sum += error;
                        squares += error * error;
                        light += (scan.intensities[q] - truth.intensities[q]).powi(2);
                    }
                }
            }
            assert!((sum / kept / deviation).abs() < 0.05);
            assert!(((squares / kept).sqrt() / deviation - 1.0).abs() < 0.04);
            if distance < 1.0 {
                assert!(((light / kept).sqrt() / 0.02 - 1.0).abs() < 0.04);
            }
            assert!((1.0 - kept / all - 0.01).abs() < 0.004, "losses {}", 1.0 - kept / all);
        }
    }

    #[test]
    fn grazing_rays_are_lost_more_often() {
        let noise = ScanNoise::<f64>::default();
        assert_eq!(noise.loss(1.0), 0.01);
        assert!(noise.loss(76f64.to_radians().cos()) > 0.05);
        assert!((noise.loss(82.5f64.to_radians().cos()) - 0.505).abs() < 1e-12);
        assert!((noise.loss(0.0) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn equal_calls_give_equal_scans_and_narrow_numbers_agree() {
        let noisy = Scanner { noise: Some(ScanNoise::default()), ..Default::default() };
        let bodies = [body(1.0, 0.2, 0), body(2.0, -0.7, 1)];
        let (a, mut b) = (take(&noisy, 0.3, &bodies), take(&Scanner::default(), 1.0, &[]));
        noisy.scan(0.3, &bodies, open, false, &draws(), &mut b);
        assert_eq!((&a.ranges, &a.intensities), (&b.ranges, &b.intensities));
        let narrow = Scanner::<f32> { noise: Some(ScanNoise::default()), ..Default::default() };
        let few = bodies.map(|d| Body {
            offset: Vector([d.offset[0] as f32, d.offset[1] as f32]),
            radius: 0.17,
            albedo: 1.0,
            member: d.member,
        });
        let mut scan = Scan::default();
        narrow.scan(0.3, &few, |_, _| None, false, &draws(), &mut scan);
        let near = a
            .ranges
            .iter()
            .zip(&scan.ranges)
            .filter(|(x, y)| **x == f64::from(**y) || (**x - f64::from(**y)).abs() < 1e-3);
        assert!(near.count() > 678, "only rays at a rim may differ");
    }
}
