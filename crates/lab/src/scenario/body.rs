//! Bodies: how large, what they can do, what happens on contact, how badly they do it.

use crate::file::Nothing;
use crate::{form, tagged, words};
use space::Real;
use swarm::engine::MotionNoise;
use swarm::physics::{self, Mobility};

form! {
    /// Bodies.
    pub struct Physics {
        /// Radius of a body; left out, as the model says.
        radius: Option<f64> = none, "length", NonNegative;
        /// Length of an elongated body along its heading, from tip to tip: a capsule, what is nearer than the radius to its axis.
        /// Distances to others are then those between axes, to obstacles from the axis. Left out, bodies are round.
        length: Option<f64> = none, "length", Positive;
        /// What a body can do.
        mobility: BodyMobility = [BodyMobility::Ideal(Nothing)], "", Any;
        /// What happens where the way is not free; left out, as the model says.
        contact: Option<Contact> = none, "", Any;
        /// Errors of computation and execution.
        noise: Noise = [Noise::default()], "", Any;
    }
}

words! {
    /// What happens where the way is not free.
    pub enum Contact {
        /// Nothing stops a body.
        Free = "free",
        /// A move that would end in contact is not made, and counted.
        Refuse = "refuse",
        /// A body slides along what it hits and is pushed out of it.
        Slide = "slide",
        /// A body is reflected, as light is.
        Reflect = "reflect",
        /// A body stops at a wall, and its velocity into the wall is reversed.
        Clamp = "clamp",
    }
}

impl From<Contact> for physics::Contact {
    fn from(contact: Contact) -> Self {
        match contact {
            Contact::Free => Self::Free,
            Contact::Refuse => Self::Refuse,
            Contact::Slide => Self::Slide,
            Contact::Reflect => Self::Reflect,
            Contact::Clamp => Self::Clamp,
        }
    }
}

form! {
    /// Errors of computation and execution.
    pub struct Noise {
        /// Standard deviation of the wanted direction.
        computation: f64 = [0.0], "deg", NonNegative;
        /// Standard deviation of the direction taken.
        execution_direction: f64 = [0.0], "deg", NonNegative;
        /// Standard deviation of the speed taken, as a share of it.
        execution_speed: f64 = [0.0], "1", NonNegative;
    }
}

impl Default for Noise {
    fn default() -> Self {
        Self { computation: 0.0, execution_direction: 0.0, execution_speed: 0.0 }
    }
}

impl Noise {
    pub(super) fn resolved<R: Real>(&self) -> MotionNoise<R> {
        MotionNoise {
            computation: R::of(self.computation.to_radians()),
            execution_direction: R::of(self.execution_direction.to_radians()),
            execution_speed: R::of(self.execution_speed),
        }
    }
}

tagged! {
    /// What a body can do.
    pub enum BodyMobility {
        /// Whatever is wanted.
        ideal => Ideal(Nothing);
        /// Always move at this speed.
        constant_speed in "length/time", swarm::parameters::Range::Positive => ConstantSpeed(f64);
        /// Turn at a limited rate.
        turn_limited => TurnLimited(TurnLimited);
        /// Drive on two wheels (2-D).
        differential_drive => DifferentialDrive(DifferentialDrive);
    }
}

form! {
    /// A limit to turning.
    pub struct TurnLimited {
        /// Largest rate of turning; of the azimuth alone where `vertical` is given.
        rate: f64 = need, "deg/time", Positive;
        /// Largest rate of the elevation (3-D): azimuth and elevation are then limited each on its own.
        vertical: Option<f64> = none, "deg/time", Positive;
    }
}

form! {
    /// A robot with two driven wheels.
    pub struct DifferentialDrive {
        /// Distance between the wheels.
        wheel_base: f64 = [0.26], "m", Positive;
        /// Largest speed of a wheel.
        wheel_speed: f64 = [0.5], "m/s", Positive;
        /// Largest forward speed.
        forward_speed: f64 = [0.25], "m/s", Positive;
        /// Largest rate of turning.
        turn_rate: f64 = [85.943_669_269_623_48], "deg/s", Positive;
        /// Largest change of the forward speed.
        acceleration: f64 = [0.5], "m/s^2", Positive;
        /// Rate of turning per angle of error.
        gain: f64 = [4.0], "1/s", Positive;
    }
}

impl BodyMobility {
    pub(super) fn resolved<R: Real>(&self) -> Mobility<R> {
        match self {
            Self::Ideal(_) => Mobility::Ideal,
            Self::ConstantSpeed(speed) => Mobility::ConstantSpeed(R::of(*speed)),
            Self::TurnLimited(limit) => Mobility::TurnLimited {
                rate: R::of(limit.rate.to_radians()),
                vertical: limit.vertical.map(|rate| R::of(rate.to_radians())),
            },
            Self::DifferentialDrive(drive) => {
                let &DifferentialDrive { wheel_base, wheel_speed, forward_speed, turn_rate, acceleration, gain } =
                    drive;
                Mobility::DifferentialDrive(physics::DifferentialDrive {
                    wheel_base: R::of(wheel_base),
                    wheel_speed: R::of(wheel_speed),
                    forward_speed: R::of(forward_speed),
                    turn_rate: R::of(turn_rate.to_radians()),
                    acceleration: R::of(acceleration),
                    gain: R::of(gain),
                })
            }
        }
    }
}
