//! Sensing, the first stage: who could I perceive?
//!
//! *Ideal* sensing reads the frozen state; a range, a field of view, occlusion, loss and errors limit it. A *scanner* casts
//! rays and leaves it to detection to find members among the readings.

pub mod robot;
pub mod scanner;

use space::Real;

/// Errors of ideal sensing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SensingNoise<R> {
    /// Standard deviation of the distance, as a share of it.
    pub distance: R,
    /// Standard deviation of the direction, rad (in 3-D about a random axis).
    pub direction: R,
    /// Standard deviation of the other's heading, rad.
    pub heading: R,
    /// Probability that a member is missed in a step.
    pub miss: R,
}

impl<R: Real> SensingNoise<R> {
    /// Whether there is any.
    pub fn any(&self) -> bool {
        [self.distance, self.direction, self.heading, self.miss].iter().any(|&v| v > R::ZERO)
    }
}

/// What hides a member when it stands between: the line between the centres passes through it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Occlusion {
    /// Nothing.
    #[default]
    None,
    /// Opaque obstacles.
    Obstacles,
    /// Opaque obstacles, and the bodies of nearer members.
    All,
}

/// How likely each of a pool is to be the one that is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PoolWeight<R> {
    /// All alike.
    Uniform,
    /// By the inverse of the distance.
    Inverse,
    /// By its square.
    InverseSquare,
    /// `exp(-distance / length)`.
    Exponential(R),
    /// `exp(-(angle - preferred)^2 / (2 width^2))`, by the angle from the heading, rad.
    Angle {
        /// The angle that is preferred.
        preferred: R,
        /// Standard deviation about it.
        width: R,
    },
}

/// One member alone is perceived in each decision: one drawn among the nearest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pool<R> {
    /// So many nearest of those that are perceived.
    pub nearest: usize,
    /// How it is drawn.
    pub weight: PoolWeight<R>,
}

impl<R: Real> PoolWeight<R> {
    /// The weight of a member at a distance and an angle from the heading.
    pub fn of(&self, distance: R, angle: R) -> f64 {
        let far = distance.to_f64().max(1e-9);
        match *self {
            Self::Uniform => 1.0,
            Self::Inverse => 1.0 / far,
            Self::InverseSquare => 1.0 / (far * far),
            Self::Exponential(length) => Real::exp(-far / length.to_f64()),
            Self::Angle { preferred, width } => {
                let off = (angle - preferred).to_f64() / width.to_f64();
                Real::exp(-0.5 * off * off)
            }
        }
    }
}

/// Ideal sensing with its limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ideal<R> {
    /// Members at this distance or farther are not sensed.
    pub range: Option<R>,
    /// Full opening of the cone about the heading that is sensed, rad.
    pub field_of_view: Option<R>,
    /// What hides a member.
    pub occlusion: Occlusion,
    /// Share of a member's disc that must be free for it to be perceived, where something hides; `None`: its centre must be.
    pub free: Option<R>,
    /// Whether one member alone is perceived.
    pub one_of: Option<Pool<R>>,
    /// Errors.
    pub noise: SensingNoise<R>,
}

impl<R: Real> Default for Ideal<R> {
    fn default() -> Self {
        let none = SensingNoise { distance: R::ZERO, direction: R::ZERO, heading: R::ZERO, miss: R::ZERO };
        Self { range: None, field_of_view: None, occlusion: Occlusion::None, free: None, one_of: None, noise: none }
    }
}

impl<R: Real> Ideal<R> {
    /// Whether everybody is sensed exactly, so that laws may read the state itself.
    pub fn is_perfect(&self) -> bool {
        self.range.is_none()
            && self.field_of_view.is_none()
            && self.occlusion == Occlusion::None
            && self.one_of.is_none()
            && !self.noise.any()
    }
    /// What can be known at load.
    ///
    /// # Errors
    /// A sentence that says what is wrong.
    pub fn check(&self) -> Result<(), String> {
        if let Some(range) = self.range
            && (range <= R::ZERO || !range.finite())
        {
            return Err(format!("sensing range must be more than 0, found {range}"));
        }
        if let Some(opening) = self.field_of_view
            && !(opening >= R::ZERO && opening <= R::TAU * R::of(1.000_001))
        {
            return Err(format!("field of view must be from 0 to 360 degrees, found {opening} rad"));
        }
        if let Some(free) = self.free
            && !(free > R::ZERO && free <= R::ONE)
        {
            return Err(format!(
                "the sensing of a member needs a free share of it above 0 and at most 1, found {free}"
            ));
        }
        if let Some(pool) = self.one_of {
            if pool.nearest == 0 {
                return Err("sensing one of a pool: it needs one member at least".into());
            }
            match pool.weight {
                PoolWeight::Exponential(size) | PoolWeight::Angle { width: size, .. }
                    if !(size > R::ZERO && size.finite()) =>
                {
                    return Err(format!("sensing one of a pool: length or width must be more than 0, found {size}"));
                }
                _ => {}
            }
        }
        let n = &self.noise;
        for (name, value) in [("distance", n.distance), ("direction", n.direction), ("heading", n.heading)] {
            if !(value >= R::ZERO && value.finite()) {
                return Err(format!("sensing noise of the {name} must be 0 or more, found {value}"));
            }
        }
        if !(n.miss >= R::ZERO && n.miss <= R::ONE) {
            return Err(format!("the probability of missing a member must be from 0 to 1, found {}", n.miss));
        }
        Ok(())
    }
}

/// The cosine limit of a field of view with this full opening; an opening of a whole turn lets everyone pass.
pub fn cos_half<R: Real>(opening: R) -> R {
    if opening >= R::TAU * R::of(0.999_999_9) {
        return -R::of(2.0);
    }
    let cos = (opening * R::HALF).cos();
    // the cosine of a right angle is 0, whatever pi is rounded to: those exactly at the side of a half-turn's view are in it
    if cos.abs() < R::of(1e-7) { R::ZERO } else { cos }
}
