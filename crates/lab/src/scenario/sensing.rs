//! Sensing and detection, as written.

use crate::file::Nothing;
use crate::{form, tagged, words};
use swarm::detection::readings::{Clustering, InjectedErrors, Matching, ReadingDetection};
use swarm::engine;
use swarm::parameters::Scalar;
use swarm::sensing::robot::Robot;
use swarm::sensing::scanner::{ScanNoise, Scanner};
use swarm::sensing::{self, PoolWeight, SensingNoise};

words! {
    /// What hides a member that stands behind it.
    pub enum Occlusion {
        /// Nothing.
        None = "none",
        /// Opaque obstacles.
        Obstacles = "obstacles",
        /// Opaque obstacles, and the bodies of nearer members.
        All = "all",
    }
}

form! {
    /// Errors of ideal sensing.
    pub struct Errors {
        /// Standard deviation of distances, as a share of them.
        distance: f64 = [0.0], "1", NonNegative;
        /// Standard deviation of directions.
        direction: f64 = [0.0], "deg", NonNegative;
        /// Standard deviation of the headings of others.
        heading: f64 = [0.0], "deg", NonNegative;
        /// Probability that a member is missed in a step.
        miss: f64 = [0.0], "1", Within(0.0, 1.0);
    }
}

impl Default for Errors {
    fn default() -> Self {
        Self { distance: 0.0, direction: 0.0, heading: 0.0, miss: 0.0 }
    }
}

form! {
    /// Detection and selection of obstacles and walls.
    pub struct ToldObstacles {
        /// Those whose surface is nearer than this are detected; left out, as near as the law looks.
        within: Option<f64> = none, "length", Positive;
        /// So many of them are handed on, the nearest; left out, all.
        nearest: Option<usize> = none, "1", Positive;
        /// Whether each of these is a virtual member as well, which the law cannot tell from real ones: it stands at the obstacle's
        /// nearest point and moves with the agent along the surface.
        members: bool = [false], "", Any;
    }
}

impl ToldObstacles {
    /// The plan for a group.
    pub(super) fn resolved<R: Scalar>(&self) -> engine::ObstaclePlan<R> {
        let Self { within, nearest, members } = *self;
        engine::ObstaclePlan { within: within.map(R::of), nearest, members }
    }
}

tagged! {
    /// How one of a pool is drawn.
    pub enum Weights {
        /// All are alike.
        uniform => Uniform(Nothing);
        /// By the inverse of the distance.
        inverse => Inverse(Nothing);
        /// By the inverse square of the distance.
        inverse_square => InverseSquare(Nothing);
        /// By exp(-distance / length): the length.
        exponential in "length", swarm::parameters::Range::Positive => Exponential(f64);
        /// By the angle from the heading.
        angle => Angle(Preference);
    }
}

form! {
    /// A preference of some angle from the heading.
    pub struct Preference {
        /// The angle, from 0 ahead to 180 behind.
        preferred: f64 = need, "deg", Within(0.0, 180.0);
        /// Standard deviation about it.
        width: f64 = need, "deg", Positive;
    }
}

form! {
    /// A pool of which one member is drawn in each decision; it alone is perceived.
    pub struct Pool {
        /// So many nearest of those that are perceived.
        nearest: usize = need, "1", Positive;
        /// How it is drawn.
        weights: Weights = [Weights::Uniform(Nothing)], "", Any;
    }
}

impl Pool {
    fn resolved<R: Scalar>(&self) -> sensing::Pool<R> {
        let weight = match &self.weights {
            Weights::Uniform(_) => PoolWeight::Uniform,
            Weights::Inverse(_) => PoolWeight::Inverse,
            Weights::InverseSquare(_) => PoolWeight::InverseSquare,
            Weights::Exponential(length) => PoolWeight::Exponential(R::of(*length)),
            Weights::Angle(preference) => PoolWeight::Angle {
                preferred: R::of(preference.preferred.to_radians()),
                width: R::of(preference.width.to_radians()),
            },
        };
        sensing::Pool { nearest: self.nearest, weight }
    }
}

form! {
    /// The state itself, within limits.
    pub struct Ideal {
        /// Members at this distance or farther are not sensed.
        range: Option<f64> = none, "length", Positive;
        /// Full opening of the cone about the heading that is sensed.
        field_of_view: Option<f64> = none, "deg", Within(0.0, 360.0);
        /// What hides a member.
        occlusion: Occlusion = [Occlusion::None], "", Any;
        /// Share of a member's disc that must be free for it to be perceived, where something hides; left out, its centre must be.
        free: Option<f64> = none, "1", Within(0.0, 1.0);
        /// One member alone is perceived: one drawn from a pool of the nearest.
        one_of: Option<Pool> = none, "", Any;
        /// Errors.
        noise: Errors = [Errors::default()], "", Any;
    }
}

form! {
    /// Errors of a laser's readings.
    pub struct LaserNoise {
        /// Standard deviation of a range shorter than `near_range`.
        near_deviation: f64 = [0.01], "m", NonNegative;
        /// Standard deviation of a longer range, as a share of it.
        far_deviation: f64 = [0.01], "1", NonNegative;
        /// Where the second rule takes over.
        near_range: f64 = [1.0], "m", NonNegative;
        /// Probability that a reading is lost.
        drop_out: f64 = [0.01], "1", Within(0.0, 1.0);
        /// Angle of incidence above which readings are lost more often.
        grazing_angle: f64 = [75.0], "deg", Within(0.0, 90.0);
        /// Probability that a reading is lost at a right angle.
        grazing_drop_out: f64 = [1.0], "1", Within(0.0, 1.0);
        /// Standard deviation of an intensity.
        intensity_deviation: f64 = [0.02], "1", NonNegative;
    }
}

form! {
    /// Recognition of bodies by the shape of their profile.
    pub struct Profiles {
        /// Radius of the bodies looked for.
        body_radius: f64 = [0.17], "m", Positive;
        /// Consecutive ranges that differ by more split a segment.
        gap: f64 = [0.1], "m", Positive;
        /// Segments of fewer readings are dropped.
        least_readings: usize = [3usize], "1", Positive;
        /// Warping distance per reading below which a segment is a member.
        tolerance: f64 = [0.02], "m", Positive;
        /// Least width of a member's segment.
        least_width: f64 = [0.0], "m", NonNegative;
        /// Greatest width of a member's segment; left out, any.
        greatest_width: Option<f64> = none, "m", Positive;
    }
}

form! {
    /// Recognition of bodies as bright clusters of the right width.
    pub struct Clusters {
        /// Radius of the bodies looked for.
        body_radius: f64 = [0.17], "m", Positive;
        /// Consecutive ranges that differ by more split a segment.
        gap: f64 = [0.15], "m", Positive;
        /// Least width of a segment.
        least_width: f64 = [0.2], "m", NonNegative;
        /// Greatest width of a segment.
        greatest_width: f64 = [0.5], "m", Positive;
        /// Least brightness of a member.
        least_intensity: f64 = [0.5], "1", NonNegative;
    }
}

form! {
    /// Bright readings, taken one by one.
    pub struct Bright {
        /// Least intensity of the foreground.
        least_intensity: f64 = [0.25], "1", NonNegative;
    }
}

tagged! {
    /// What a laser's readings are taken for.
    pub enum Detection {
        /// Every bright reading is an input.
        sensor_based => SensorBased(Bright);
        /// One input for each segment with the profile of a body.
        member_based => MemberBased(Profiles);
        /// Every reading of such a segment is an input.
        member_extrapolated => MemberExtrapolated(Profiles);
        /// One input for each bright cluster about as wide as a body.
        clustered => Clustered(Clusters);
    }
}

form! {
    /// Errors put into detection on purpose.
    pub struct Faults {
        /// Probability that an input is dropped.
        miss: f64 = [0.0], "1", Within(0.0, 1.0);
        /// Mean number of false inputs in a scan.
        false_inputs: f64 = [0.0], "1", Within(0.0, 700.0);
    }
}

form! {
    /// A planar laser range-finder (2-D, in metres) and the detection behind it.
    pub struct Laser {
        /// What readings are taken for.
        detection: Detection = need, "", Any;
        /// Largest distance between two sights of the same member; left out, velocities of others stay unknown.
        association: Option<f64> = none, "m", Positive;
        /// Errors put in on purpose.
        errors: Option<Faults> = none, "", Any;
        /// Errors of readings; left out, readings are exact.
        noise: Option<LaserNoise> = none, "", Any;
        /// Steps in a full turn.
        steps_per_turn: u32 = [1024u32], "1", Within(1.0, 100_000.0);
        /// First used step, the rightmost ray.
        first_step: u32 = [44u32], "1", NonNegative;
        /// Last used step, the leftmost ray.
        last_step: u32 = [725u32], "1", NonNegative;
        /// The step along the heading.
        front_step: u32 = [384u32], "1", NonNegative;
        /// Shortest range that is reported.
        shortest_range: f64 = [0.02], "m", NonNegative;
        /// Longest range that is reported.
        longest_range: f64 = [5.6], "m", Positive;
    }
}

tagged! {
    /// How agents sense others.
    pub enum Sensing {
        /// From the state itself, within limits.
        ideal => Ideal(Ideal);
        /// By a laser range-finder.
        laser => Laser(Laser);
    }
}

impl Sensing {
    /// What a laser cannot be, with the key it concerns.
    pub(super) fn problem(&self) -> Option<(&'static str, String)> {
        if let Self::Laser(laser) = self { laser.problem() } else { None }
    }
    pub(super) fn resolved<R: Scalar>(&self) -> engine::Sensing<R> {
        match self {
            Self::Ideal(ideal) => engine::Sensing::Ideal(sensing::Ideal {
                range: ideal.range.map(R::of),
                field_of_view: ideal.field_of_view.map(|opening| R::of(opening.to_radians())),
                occlusion: match ideal.occlusion {
                    Occlusion::None => sensing::Occlusion::None,
                    Occlusion::Obstacles => sensing::Occlusion::Obstacles,
                    Occlusion::All => sensing::Occlusion::All,
                },
                free: ideal.free.map(R::of),
                one_of: ideal.one_of.as_ref().map(Pool::resolved),
                noise: SensingNoise {
                    distance: R::of(ideal.noise.distance),
                    direction: R::of(ideal.noise.direction.to_radians()),
                    heading: R::of(ideal.noise.heading.to_radians()),
                    miss: R::of(ideal.noise.miss),
                },
            }),
            Self::Laser(laser) => engine::Sensing::Scanner(Box::new(laser.robot())),
        }
    }
}

impl Laser {
    /// What it cannot be, with the key it concerns.
    fn problem(&self) -> Option<(&'static str, String)> {
        let Self { first_step, last_step, front_step, steps_per_turn, shortest_range, longest_range, .. } = *self;
        if first_step > last_step {
            return Some(("first_step", format!("the first step ({first_step}) lies after the last ({last_step})")));
        }
        if last_step - first_step >= steps_per_turn {
            return Some(("last_step", format!("the rays would go round more than once ({steps_per_turn} a turn)")));
        }
        if front_step >= steps_per_turn {
            let what = format!(
                "the step along the heading ({front_step}) is none of the {steps_per_turn} of a turn, which count from 0"
            );
            return Some(("front_step", what));
        }
        if shortest_range >= longest_range {
            let what = format!("the shortest range ({shortest_range}) must be below the longest ({longest_range})");
            return Some(("shortest_range", what));
        }
        let rays = (last_step - first_step) as usize + 1;
        let narrow = |key, least: f64, greatest: Option<f64>| {
            let greatest = greatest.filter(|&greatest| least > greatest)?;
            Some((key, format!("the least width ({least}) is above the greatest ({greatest}): nobody would be found")))
        };
        let few = |key, least: usize| {
            let what = || format!("the {rays} rays never give {least} readings: nobody would be found");
            (least > rays).then(|| (key, what()))
        };
        match &self.detection {
            Detection::SensorBased(_) => None,
            Detection::MemberBased(profiles) => {
                narrow("detection.member_based.least_width", profiles.least_width, profiles.greatest_width)
                    .or_else(|| few("detection.member_based.least_readings", profiles.least_readings))
            }
            Detection::MemberExtrapolated(profiles) => {
                narrow("detection.member_extrapolated.least_width", profiles.least_width, profiles.greatest_width)
                    .or_else(|| few("detection.member_extrapolated.least_readings", profiles.least_readings))
            }
            Detection::Clustered(clusters) => {
                narrow("detection.clustered.least_width", clusters.least_width, Some(clusters.greatest_width))
            }
        }
    }
    fn robot<R: Scalar>(&self) -> Robot<R> {
        let scanner = Scanner {
            steps_per_turn: self.steps_per_turn,
            first_step: self.first_step,
            last_step: self.last_step,
            front_step: self.front_step,
            shortest_range: R::of(self.shortest_range),
            longest_range: R::of(self.longest_range),
            noise: self.noise.as_ref().map(|noise| ScanNoise {
                near_deviation: R::of(noise.near_deviation),
                far_deviation: R::of(noise.far_deviation),
                near_range: R::of(noise.near_range),
                drop_out: R::of(noise.drop_out),
                grazing_angle: R::of(noise.grazing_angle.to_radians()),
                grazing_drop_out: R::of(noise.grazing_drop_out),
                intensity_deviation: R::of(noise.intensity_deviation),
            }),
            ..Scanner::default()
        };
        let matching = |profiles: &Profiles| {
            let mut matching = Matching::new(&scanner, R::of(profiles.body_radius));
            matching.gap = R::of(profiles.gap);
            matching.least_readings = profiles.least_readings;
            matching.tolerance = R::of(profiles.tolerance);
            matching.least_width = R::of(profiles.least_width);
            matching.greatest_width = profiles.greatest_width.map_or(R::INFINITY, R::of);
            matching
        };
        let detection = match &self.detection {
            Detection::SensorBased(bright) => {
                ReadingDetection::SensorBased { least_intensity: R::of(bright.least_intensity) }
            }
            Detection::MemberBased(profiles) => ReadingDetection::MemberBased(matching(profiles)),
            Detection::MemberExtrapolated(profiles) => ReadingDetection::MemberExtrapolated(matching(profiles)),
            Detection::Clustered(clusters) => ReadingDetection::Clustered(Clustering {
                gap: R::of(clusters.gap),
                least_width: R::of(clusters.least_width),
                greatest_width: R::of(clusters.greatest_width),
                least_intensity: R::of(clusters.least_intensity),
                body_radius: R::of(clusters.body_radius),
            }),
        };
        Robot {
            scanner,
            detection,
            association: self.association.map(R::of),
            errors: self
                .errors
                .as_ref()
                .map(|faults| InjectedErrors { miss: R::of(faults.miss), false_inputs: R::of(faults.false_inputs) }),
            widest_body: R::ZERO,
        }
    }
}
