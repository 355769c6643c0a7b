//! Mobility policies: what a body can make of a wanted motion.

use crate::motion::Motion;
use space::{Column, ColumnKind, Real, Vector};

/// What a body can do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mobility<R> {
    /// The wanted motion is performed exactly.
    Ideal,
    /// Always this speed, in the wanted direction (in the present one where none is wanted).
    ConstantSpeed(R),
    /// The heading turns at a limited rate; the speed is the wanted one.
    TurnLimited {
        /// Largest rate of turning, rad/time; of the azimuth alone where `vertical` is given.
        rate: R,
        /// Largest rate of the elevation, rad/time (3-D): azimuth and elevation are then limited each on its own.
        vertical: Option<R>,
    },
    /// Two driven wheels.
    DifferentialDrive(DifferentialDrive<R>),
}

/// A robot with two driven wheels (2-D). It turns towards the wanted direction and drives with the cosine of the
/// remaining angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DifferentialDrive<R> {
    /// Distance between the wheels, m.
    pub wheel_base: R,
    /// Largest speed of a wheel, m/s.
    pub wheel_speed: R,
    /// Largest forward speed, m/s.
    pub forward_speed: R,
    /// Largest rate of turning, rad/s.
    pub turn_rate: R,
    /// Largest change of the forward speed, m/s^2.
    pub acceleration: R,
    /// Rate of turning per radian of error, 1/s.
    pub gain: R,
}

impl<R: Real> Default for DifferentialDrive<R> {
    /// iRobot Create with the limits of the trials (group-control specification, 9.1).
    fn default() -> Self {
        Self {
            wheel_base: R::of(0.26),
            wheel_speed: R::of(0.5),
            forward_speed: R::of(0.25),
            turn_rate: R::of(1.5),
            acceleration: R::of(0.5),
            gain: R::of(4.0),
        }
    }
}

impl<R: Real> Mobility<R> {
    /// Columns a body needs beyond position and velocity.
    pub fn columns(&self) -> &'static [Column] {
        const DRIVE: [Column; 2] = [
            Column {
                name: "orientation",
                unit: "rad",
                kind: ColumnKind::Quantity,
                about: "direction in which the robot faces, from the x axis",
            },
            Column {
                name: "drive_speed",
                unit: "length/time",
                kind: ColumnKind::Quantity,
                about: "forward speed of the robot",
            },
        ];
        if let Self::DifferentialDrive(_) = self { &DRIVE } else { &[] }
    }

    /// What can be known at load.
    ///
    /// # Errors
    /// A sentence that says what does not fit.
    pub fn check(&self, dimension: usize) -> Result<(), String> {
        let positive = |name: &str, value: R| {
            if value > R::ZERO && value.finite() {
                Ok(())
            } else {
                Err(format!("{name} must be more than 0, found {value}"))
            }
        };
        match self {
            Self::Ideal => Ok(()),
            Self::ConstantSpeed(speed) => positive("constant speed", *speed),
            Self::TurnLimited { rate, vertical } => {
                positive("turn rate", *rate)?;
                match vertical {
                    Some(_) if dimension != 3 => {
                        Err("a vertical turn rate needs three dimensions; leave it out".to_owned())
                    }
                    Some(vertical) => positive("vertical turn rate", *vertical),
                    None => Ok(()),
                }
            }
            Self::DifferentialDrive(drive) => {
                if dimension != 2 {
                    return Err("a differential drive moves in two dimensions; use turn_limited".to_owned());
                }
                positive("wheel base", drive.wheel_base)?;
                positive("wheel speed", drive.wheel_speed)?;
                positive("forward speed", drive.forward_speed)?;
                positive("turn rate", drive.turn_rate)?;
                positive("acceleration", drive.acceleration)?;
                positive("gain", drive.gain)
            }
        }
    }

    /// The motion performed in `dt` when `wanted` is wanted. `own` are the body's columns.
    #[inline]
    pub fn perform<const D: usize>(
        &self,
        before: Vector<R, D>,
        wanted: Motion<R, D>,
        dt: R,
        own: &mut [R],
    ) -> Motion<R, D> {
        match self {
            Self::Ideal => wanted,
            Self::ConstantSpeed(speed) => {
                let mut heading = wanted.displacement.unit();
                if heading.is_tiny() {
                    heading = before.unit();
                }
                Motion::new_velocity(heading * *speed, dt)
            }
            Self::TurnLimited { rate, vertical } => {
                let heading = before.unit();
                let towards = wanted.displacement.unit();
                let turned = match vertical {
                    Some(vertical) if D == 3 => turn_in_angles(heading, towards, *rate * dt, *vertical * dt),
                    _ => heading.turned_toward(towards, *rate * dt),
                };
                let displacement = turned * wanted.displacement.length();
                Motion { velocity: turned * wanted.velocity.length(), displacement }
            }
            Self::DifferentialDrive(drive) => drive.perform(wanted, dt, own),
        }
    }
}

/// Azimuth and elevation turned each on its own; an exact half turn of the azimuth turns left.
fn turn_in_angles<R: Real, const D: usize>(
    heading: Vector<R, D>,
    towards: Vector<R, D>,
    horizontal: R,
    vertical: R,
) -> Vector<R, D> {
    if towards.is_tiny() {
        return heading;
    }
    if heading.is_tiny() || D < 3 {
        return towards;
    }
    let (azimuth, elevation) = (heading.angle(), heading.0[2].asin());
    let flat = (towards.0[0].squared() + towards.0[1].squared()).root();
    let across = if flat < R::of(1e-9) {
        R::ZERO
    } else {
        (towards.angle() - azimuth).wrapped().clamped(-horizontal, horizontal)
    };
    let up = (towards.0[2].asin() - elevation).clamped(-vertical, vertical);
    let half = R::PI * R::HALF;
    let (sin_up, cos_up) = (elevation + up).clamped(-half, half).sin_cos();
    let (sin, cos) = (azimuth + across).sin_cos();
    let mut out = Vector::ZERO;
    out.0[0] = cos_up * cos;
    out.0[1] = cos_up * sin;
    out.0[2] = sin_up;
    out
}

impl<R: Real> DifferentialDrive<R> {
    fn perform<const D: usize>(&self, wanted: Motion<R, D>, dt: R, own: &mut [R]) -> Motion<R, D> {
        let (facing, speed) = (own[0], own[1]);
        let far = wanted.displacement.length();
        let still = far <= R::TINY;
        let error = if still { R::ZERO } else { (wanted.displacement.angle() - facing).wrapped() };
        let mut turn = (self.gain * error).clamped(-self.turn_rate, self.turn_rate);
        let aim = if still { R::ZERO } else { (far / dt).least(self.forward_speed) * error.cos().most(R::ZERO) };
        let mut forward = aim.clamped(speed - self.acceleration * dt, speed + self.acceleration * dt).most(R::ZERO);
        // a wheel cannot exceed its speed: both are slowed alike, so that the curve stays the wanted one
        let fastest = forward + turn.abs() * self.wheel_base * R::HALF;
        if fastest > self.wheel_speed {
            let slower = self.wheel_speed / fastest;
            forward *= slower;
            turn *= slower;
        }
        let turned = turn * dt;
        // exact on arcs: the chord of a circle of radius forward/turn
        let middle = facing + turned * R::HALF;
        let half = turned * R::HALF;
        let chord = if half.abs() > R::of(1e-6) { half.sin() / half } else { R::ONE };
        own[0] = (facing + turned).wrapped();
        own[1] = forward;
        Motion {
            velocity: Vector::at_angle(own[0]) * forward,
            displacement: Vector::at_angle(middle) * (forward * dt * chord),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn go(x: f64, y: f64) -> Motion<f64, 2> {
        Motion::new_velocity(Vector([x, y]), 1.0)
    }

    #[test]
    fn constant_speed_and_turn_limit() {
        let fast = Mobility::ConstantSpeed(2.0).perform(Vector([1.0, 0.0]), go(0.0, 9.0), 0.5, &mut []);
        assert_eq!(fast.displacement, Vector([0.0, 1.0]));
        let kept = Mobility::ConstantSpeed(2.0).perform(Vector([1.0, 0.0]), go(0.0, 0.0), 0.5, &mut []);
        assert_eq!(kept.velocity, Vector([2.0, 0.0]));
        let limited =
            Mobility::TurnLimited { rate: 0.1, vertical: None }.perform(Vector([1.0, 0.0]), go(0.0, 3.0), 1.0, &mut []);
        assert!((limited.velocity.angle() - 0.1).abs() < 1e-12 && (limited.velocity.length() - 3.0).abs() < 1e-12);
    }

    #[test]
    fn separate_limits_in_three_dimensions() {
        let wanted = Motion::new_velocity(Vector([0.0, 0.0, 1.0f64]), 1.0);
        let m = Mobility::TurnLimited { rate: 1.0, vertical: Some(0.2) };
        let out = m.perform(Vector([1.0, 0.0, 0.0]), wanted, 1.0, &mut []);
        assert!((out.velocity[2].asin() - 0.2).abs() < 1e-12 && out.velocity[1].abs() < 1e-12);
        let side = m.perform(Vector([1.0, 0.0, 0.0]), Motion::new_velocity(Vector([0.0, 1.0, 0.0]), 1.0), 1.0, &mut []);
        assert!((side.velocity.angle() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_robot_drives_exact_arcs_and_respects_its_wheels() {
        let drive = DifferentialDrive { acceleration: 1e9, gain: 1.0, ..DifferentialDrive::default() };
        let mut own = [0.0, 0.0];
        // many small steps at a constant error would be a circle: turn by 1 rad/s while driving
        let mut at = Vector([0.0, 0.0f64]);
        for _ in 0..1000 {
            let wanted = Motion::step(Vector::at_angle(own[0] + 1.0) * 0.0002);
            at += drive.perform(wanted, 0.001, &mut own).displacement;
        }
        let radius = 0.2 * 1.0f64.cos();
        assert!((at - Vector([radius * 1.0f64.sin(), radius * (1.0 - 1.0f64.cos())])).length() < 1e-9);
        let mut own = [0.0, 0.0];
        let hard = DifferentialDrive { gain: 100.0, turn_rate: 100.0, forward_speed: 5.0, acceleration: 1e9, ..drive };
        let out = hard.perform(Motion::step(Vector([1.0, 0.5f64])), 0.1, &mut own);
        assert!(own[1] + own[0].abs() / 0.1 * 0.13 <= 0.5 + 1e-12, "{out:?}");
        let mut still = [1.0, 0.0];
        assert_eq!(drive.perform(Motion::step(Vector([0.0, 0.0])), 0.1, &mut still).displacement, Vector::ZERO);
    }
}
