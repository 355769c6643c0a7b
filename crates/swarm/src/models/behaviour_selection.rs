//! One behaviour at a time: avoid whoever is near, else align with or go to the others, by a draw that depends on how many
//! there are to align with.
//!
//! The agents of a 3-D study of collective motion in which each selects one behaviour per step by a logistic function of the
//! number of its aligning neighbours (the study's Algorithm 1 and equations 1 to 7).

use crate::card::*;
use crate::engine::mask_of;
use crate::motion::*;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use crate::sensing::cos_half;
use crate::{choice, parameters};
use core::cmp::Ordering;
use core::marker::PhantomData;
use space::angles::{arc_tangent, sine_cosine, wrapped};
use space::lanes::{Lanes, Mask, Task, level, reciprocal_root, with_lanes};
use space::random::{Purpose, Stream as DrawStream};
use space::{Column, ColumnKind, Real, Vector};

choice! {
    /// How an agent that could both align and be attracted decides.
    pub enum Variant {
        /// Aligns with the probability `1/(1 + exp(-K (n_align - M)))`.
        Logistic = "logistic",
        /// Takes the average of both directions.
        Control = "control",
        /// Aligns with a constant probability.
        Preset = "preset",
        /// The first members of the group are of kind b, the others of kind a; both logistic.
        Mixed = "mixed",
        /// Everyone draws its kind anew in each step.
        Switching = "switching",
        /// Aligns with a probability that fuzzy rules make of how many there are: none, some, or many.
        Fuzzy = "fuzzy",
    }
}
choice! {
    /// The shape of the field of view.
    pub enum View {
        /// A cone about the heading.
        Cone = "cone",
        /// Limits of azimuth and elevation, each for itself.
        Axes = "axes",
    }
}
choice! {
    /// How the average of two directions is taken.
    pub enum Average {
        /// Of their unit vectors.
        Unit = "unit",
        /// Of the sums as they are.
        Raw = "raw",
    }
}
choice! {
    /// What becomes of members in the zone of avoidance.
    pub enum Avoiding {
        /// The agent turns away from them.
        TurnAway = "turn_away",
        /// It takes their heading before they meet.
        Match = "match",
    }
}
choice! {
    /// What fuzzy rules give.
    pub enum Output {
        /// A probability of alignment.
        Probability = "probability",
        /// The likelier of alignment and attraction; a draw where both are alike.
        Crisp = "crisp",
    }
}
choice! {
    /// From which range the direction of a search is drawn.
    pub enum Search {
        /// The turn is uniform within the turning limits of a step.
        Limits = "limits",
        /// The direction is uniform, in azimuth and in elevation, within the field of view; the turn towards it is then limited.
        View = "view",
    }
}
choice! {
    /// Along which heading an agent moves.
    pub enum Update {
        /// The one chosen in this step.
        New = "new",
        /// The one before it.
        Old = "old",
    }
}

parameters! {
    /// Parameters of `behaviour_selection`.
    pub struct BehaviourSelection {
        /// How the choice between alignment and attraction is made.
        variant: Variant = "logistic", "-", "-", Any, Source;
        /// Number of aligning neighbours at which both are equally likely.
        preferred_neighbours alias "M": R = 10.0, "M", "1", Any, Source;
        /// Growth of the logistic function.
        growth alias "K": R = 2.0, "K", "1", NonNegative, Source;
        /// Probability of alignment, for the variant `preset`.
        probability alias "P": R = 0.5, "P", "1", Within(0.0, 1.0), Source;
        /// Share of kind b, for the variants `mixed` and `switching`.
        share_b alias "ratio_b": R = 0.0, "-", "%", Within(0.0, 100.0), Source;
        /// Preferred neighbours of kind a.
        preferred_neighbours_a alias "Ma": R = 0.0, "M_a", "1", Any, Source;
        /// Growth of kind a.
        growth_a alias "Ka": R = 4.0, "K_a", "1", NonNegative, Source;
        /// Preferred neighbours of kind b.
        preferred_neighbours_b alias "Mb": R = 10.0, "M_b", "1", Any, Source;
        /// Growth of kind b.
        growth_b alias "Kb": R = 2.0, "K_b", "1", NonNegative, Source;
        /// So many nearest neighbours of a zone are aligned with or gone to; 0 means all.
        considered alias "N": usize = 0usize, "N", "1", NonNegative, Source;
        /// Speed, the same for all.
        speed alias "s": R = 6.0, "s", "length/time", Positive, Source;
        /// Length of a step.
        time_step alias "tau": R = 0.1, "tau", "time", Positive, Source;
        /// Body radius.
        body_radius alias "r_agent": R = 1.0, "r_agent", "length", NonNegative, Source;
        /// Width of the zone of avoidance, from surface to surface.
        avoidance_radius alias "r_avoid": R = 4.0, "r_avoid", "length", NonNegative, Source;
        /// Outer radius of the zone of alignment, from surface to surface.
        alignment_radius alias "r_align": R = 10.0, "r_align", "length", NonNegative, Source;
        /// Outer radius of the zone of attraction, from surface to surface; the bound is included.
        sight_radius alias "r_fov": R = 24.0, "r_fov", "length", Positive, Source;
        /// Full field of view: of the cone, or of the azimuth.
        field_of_view alias "fov_deg": R = 270.0, "theta_fov", "deg", Within(0.0, 360.0), Source;
        /// Full field of view of the elevation, where the view is by axes.
        vertical_field_of_view alias "fov_v_deg": R = 360.0, "phi_fov", "deg", Within(0.0, 360.0), Ours;
        /// Shape of the field of view.
        view alias "fov": View = "cone", "-", "-", Any, Ours;
        /// Largest turning rate of the azimuth.
        horizontal_turning_rate alias "turn_h": R = 180.0, "theta_max", "deg/time", NonNegative, Source;
        /// Largest turning rate of the elevation.
        vertical_turning_rate alias "turn_v": R = 90.0, "phi_max", "deg/time", NonNegative, Source;
        /// Whether the blind region hides members that would be avoided.
        avoid_blind: bool = true, "-", "-", Any, Source;
        /// Whether the blind region hides obstacles and walls.
        obstacle_blind alias "obs_blind": bool = false, "-", "-", Any, Ours;
        /// Whether walls (whatever is flat) are avoided as obstacles are.
        avoid_walls: bool = true, "-", "-", Any, Ours;
        /// From which range the direction of a search is drawn.
        search: Search = "limits", "-", "-", Any, Source;
        /// How the variant `control` averages.
        control_mode: Average = "unit", "-", "-", Any, Ours;
        /// Along which heading a step goes.
        position_update alias "move": Update = "new", "-", "-", Any, Ours;
        /// Up to so many aligning neighbours are surely none, for the variant `fuzzy`.
        none_until: R = 7.0, "-", "1", Any, Ours;
        /// From so many on they are surely not none.
        none_ends: R = 10.0, "-", "1", Any, Ours;
        /// From so many on they begin to be many; those that are neither none nor many are some.
        many_from: R = 10.0, "-", "1", Any, Ours;
        /// From so many on they are surely many.
        many_full: R = 13.0, "-", "1", Any, Ours;
        /// Probability of alignment where they are some; it is 0 where they are none and 1 where they are many.
        some_align: R = 0.5, "-", "1", Within(0.0, 1.0), Ours;
        /// What the fuzzy rules give.
        fuzzy_output: Output = "probability", "-", "-", Any, Ours;
        /// What becomes of members in the zone of avoidance; obstacles and walls are always turned away from.
        avoiding: Avoiding = "turn_away", "-", "-", Any, Ours;
        /// Error of computation: standard deviation of the number of aligning neighbours.
        count_error: R = 0.0, "-", "1", NonNegative, Ours;
        /// Error of computation: standard deviation of the probability of alignment.
        probability_error: R = 0.0, "-", "1", NonNegative, Ours;
        /// Error of computation: share of the choices between alignment and attraction that are made by a coin.
        random_choice alias "eps": R = 0.0, "epsilon", "1", Within(0.0, 1.0), Ours;
    }
}

/// Declared columns, in their order.
const THETA: usize = 0;
const PHI: usize = 1;
const N_AVOID: usize = 2;
const N_ALIGN: usize = 3;
const N_ATTRACT: usize = 4;
const O_AVOID: usize = 5;
const BEHAVIOUR: usize = 6;
const KIND: usize = 8;

/// Named sets, in their order.
const AVOIDANCE: usize = 0;
const ALIGNMENT: usize = 1;
const ATTRACTION: usize = 2;

/// Directions shorter than this share of their parts do not turn anyone.
const SHORT: f64 = 1e-9;

/// Sines smaller than this are not trusted to tell an angle from a limit; several times the rounding of single precision.
const UNSURE: f64 = 1e-5;

/// Up to so many nearest are listed while looking.
const KEPT: usize = BLOCK;

#[derive(Clone, Copy)]
enum Behaviour {
    Avoid = 0,
    Align = 1,
    Attract = 2,
    Search = 3,
    Average = 4,
}

impl<R: Scalar> Law<R> for BehaviourSelection<R> {
    const CARD: Card = Card {
        id: "behaviour_selection",
        title: "Selection of one behaviour at a time",
        about: "Agents avoid whoever and whatever is near, else align, else approach, and draw by the number of their neighbours \
                where they could do both.",
        reference: "A study of behaviour selection in collective motion in three dimensions, whose text at hand names no author: Algorithm 1 \
                    and equations 1-7",
        equations: "d = distance between surfaces;  h = (cos phi cos theta, cos phi sin theta, sin phi)\n\
                    anybody or anything in z_avoid: avoid, w = -sum e_ij + sum of unit vectors away from obstacles and walls\n\
                    only z_align filled: align, w = sum h_j;  only z_attract: attract, w = sum e_ij (N nearest of each)\n\
                    both: align if R < P = 1/(1 + exp(-K (n_align - M))), else attract;  control: w = unit(a) + unit(b)\n\
                    fuzzy: none, some, many by trapezoids of n_align;  P = (some_align some + many) / (none + some + many)\n\
                    none: search, Dtheta = delta_1 theta_max tau, Dphi = delta_2 phi_max tau\n\
                    Dtheta = wrap(atan2(w_y, w_x) - theta), Dphi = asin(w_z/|w|) - phi, each clamped to its rate\n\
                    theta' = wrap(theta + Dtheta);  phi' = clamp(phi + Dphi, -90, 90);  x_i' = x_i + s tau h_i'",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "avoidance = d in [0, r_avoid); alignment = [r_avoid, r_align); attraction = [r_align, r_fov]; all \
                        within angle(270); the law takes the N nearest of the last two",
            motion: "one behaviour, selected by counts",
            physics: "turn-limited in azimuth and elevation, constant speed; a move that would touch is refused",
            obstacles: "obstacles and walls nearer than r_avoid, sensed all round",
        },
        departures: "obstacles and walls are sensed all round; walls are avoided like obstacles; moves go along the new heading; \
                     control averages unit vectors; a search turns within the limits. Each has a parameter for the literal reading. N = 0 stands for all others",
        edge: "nobody sensed: search; a resultant below 1e-9 keeps the heading; an upright one keeps theta; an exact half turn \
               goes to the left; coincident members have no direction but count",
        random: &[
            RandomQuantity {
                name: "choice",
                about: "uniform in [0, 1), where both zones are filled; behaviour slot 0",
            },
            RandomQuantity { name: "search_theta", about: "uniform in [-1, 1), in search; behaviour slot 1" },
            RandomQuantity { name: "search_phi", about: "uniform in [-1, 1), in search; behaviour slot 2" },
            RandomQuantity { name: "switch", about: "uniform in [0, 1), variant switching; behaviour slot 3" },
            RandomQuantity {
                name: "count_error",
                about: "normal, with count_error; computation about oneself, slots 2 and 3",
            },
            RandomQuantity {
                name: "probability_error",
                about: "normal, with probability_error; computation about oneself, slots 4 and 5",
            },
            RandomQuantity {
                name: "random_choice",
                about: "uniform in [0, 1), with random_choice: whether a coin decides; computation about oneself, slot 6",
            },
        ],
        taxonomy: Taxonomy {
            composition: Composition::Heterogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::All,
            identification: false,
            uses: [true, false, true],
            validation: "S",
            synchronous: true,
            information: [Information::Global, Information::Constant, Information::Global],
            environment: "bounded obstacles",
        },
    };
    fn columns() -> &'static [Column] {
        const fn column(name: &'static str, unit: &'static str, kind: ColumnKind, about: &'static str) -> Column {
            Column { name, unit, kind, about }
        }
        const COLUMNS: [Column; 9] = [
            column("theta", "rad", ColumnKind::Quantity, "Azimuth of the heading."),
            column("phi", "rad", ColumnKind::Quantity, "Elevation of the heading."),
            column("n_avoid", "1", ColumnKind::Count, "Visible members in the zone of avoidance."),
            column("n_align", "1", ColumnKind::Count, "Visible members in the zone of alignment."),
            column("n_attract", "1", ColumnKind::Count, "Visible members in the zone of attraction."),
            column("o_avoid", "1", ColumnKind::Count, "Obstacles and walls in the zone of avoidance."),
            column(
                "behaviour",
                "1",
                ColumnKind::Label(&["avoid", "align", "attract", "search", "average"]),
                "Behaviour selected in the step.",
            ),
            column("collided", "1", ColumnKind::Count, "Whether the move of the step was refused."),
            column("kind", "1", ColumnKind::Label(&["a", "b"]), "Kind in force, in mixed and switching groups."),
        ];
        &COLUMNS
    }
    fn time_step(&self) -> R {
        self.time_step
    }
    fn initial_speed(&self) -> R {
        self.speed
    }
    fn body_radius(&self) -> R {
        self.body_radius
    }
    fn obstacle_reach(&self) -> Option<R> {
        Some(self.avoidance_radius + self.body_radius)
    }
    fn check(&self, _: usize) -> Result<(), String> {
        if self.avoidance_radius > self.alignment_radius || self.alignment_radius > self.sight_radius {
            return Err("the radii must not decrease from avoidance over alignment to sight".into());
        }
        let knots = [self.none_until, self.none_ends, self.many_from, self.many_full];
        if self.variant == Variant::Fuzzy && (knots[0] > knots[1] || knots[2] > knots[3] || knots[0] > knots[2]) {
            return Err(
                "the knots of the fuzzy counts must not decrease: none_until, none_ends; many_from, many_full".into()
            );
        }
        Ok(())
    }
}

/// Which percepts an agent sees: the named sets by blocks of percepts.
#[derive(Clone, Copy)]
struct Sight<'a>(Marks<'a>);
impl Sight<'_> {
    /// Members of a named set in a block of percepts.
    #[inline(always)]
    fn members(self, set: usize, block: usize) -> u16 {
        self.0[set][block]
    }
    /// Members of a named set in so many blocks.
    #[inline(always)]
    fn count(self, set: usize, blocks: usize) -> u32 {
        // no closures: they would be compiled for processors that cannot count bits; and four blocks at a time
        let mut count = 0;
        let (fours, rest) = self.0[set][..blocks].as_chunks();
        for &[a, b, c, d] in fours {
            let together = u64::from(a) | u64::from(b) << 16 | u64::from(c) << 32 | u64::from(d) << 48;
            count += together.count_ones();
        }
        let mut last = 0;
        for &members in rest {
            last = last << 16 | u64::from(members);
        }
        count + last.count_ones()
    }
}

/// Limits of azimuth and elevation about a heading.
struct Axes<N> {
    /// Cosine and sine of azimuth and elevation of the heading.
    heading: [(N, N); 2],
    /// Cosine and sine of the limits to either side, and up and down.
    limits: [(N, N); 2],
    /// How wrong offsets may be.
    slack: N,
}
impl<N: Real> Axes<N> {
    /// About a heading, where offsets are wrong by less than so much.
    #[inline(always)]
    fn of<R: Scalar, L: Lanes<N>>(law: &BehaviourSelection<R>, angles: (R, R), slack: N) -> Self {
        let (half, vertical) = law.half_angles();
        let mut given = [N::ZERO; WIDEST];
        for (to, angle) in given.iter_mut().zip([angles.0, angles.1, half, vertical]) {
            *to = N::of(angle.to_f64());
        }
        let (mut sines, mut cosines) = ([N::ZERO; WIDEST], [N::ZERO; WIDEST]);
        for first in (0..4).step_by(L::WIDTH) {
            let (sine, cosine) = sine_cosine::<N, L>(L::load(&given[first..]));
            sine.store(&mut sines[first..]);
            cosine.store(&mut cosines[first..]);
        }
        let pair = |l: usize| (cosines[l], sines[l]);
        Self { heading: [pair(0), pair(1)], limits: [pair(2), pair(3)], slack }
    }
    /// Where offsets are surely within the limits, and where surely not: what [`BehaviourSelection::sees_by_axes`] says, without
    /// its angles, wherever rounding cannot decide. An angle is within a limit where the sine of their difference is not positive.
    #[inline(always)]
    fn tell<L: Lanes<N>>(&self, offset: &[L; 3]) -> (L::Mask, L::Mask) {
        let [x, y, z] = *offset;
        let level = (x * x + y * y).square_root();
        let turned = |(cos, sin): (N, N), along: L, across: L| {
            let (cos, sin) = (L::splat(cos), L::splat(sin));
            (along * cos + across * sin, across * cos - along * sin)
        };
        let beyond =
            |(along, across): (L, L), (cos, sin): (N, N)| across.size() * L::splat(cos) - along * L::splat(sin);
        let aside = beyond(turned(self.heading[0], x, y), self.limits[0]);
        let above = beyond(turned(self.heading[1], level, z), self.limits[1]);
        let (unsure, slack) = (L::splat(N::of(UNSURE)), L::splat(self.slack));
        let (near, far) = (level * unsure + slack, (level + z.size()) * unsure + slack);
        let within = aside.less(-near).and(above.less(-far));
        let beside = near.less(aside).and(L::splat(N::TINY).less(level));
        (within, far.less(above).or(beside))
    }
}

/// The named sets without those whom the limits of azimuth and elevation hide, one set behind the other.
struct ByAxes<'a, R> {
    law: &'a BehaviourSelection<R>,
    seen: &'a Percepts<'a, R, 3>,
    /// Azimuth and elevation of the heading.
    angles: (R, R),
}
impl<R: Scalar> ByAxes<'_, R> {
    /// The sets, by offsets in any precision; whoever cannot be told by these is looked at alone.
    #[inline(always)]
    fn told<N: Real, L: Lanes<N>>(&self, offsets: impl Offsets<N>, slack: N) -> Vec<u16> {
        let &Self { law, seen, angles } = self;
        let axes = Axes::of::<R, L>(law, angles, slack);
        let mut marks = seen.marks.concat();
        let blocks = seen.blocks();
        let first_hidden = if law.avoid_blind { AVOIDANCE } else { ALIGNMENT };
        for block in 0..blocks {
            let asked = (first_hidden..=ATTRACTION).fold(0, |asked, set| asked | u32::from(seen.marks[set][block]));
            let mut visible = 0;
            for part in (0..BLOCK).step_by(L::WIDTH) {
                if asked >> part & mask_of(L::WIDTH) == 0 {
                    continue;
                }
                let (within, hidden) = axes.tell::<L>(&offsets.several::<L>(block * BLOCK + part));
                visible |= within.bits() << part;
                let mut unsure = !(within.bits() | hidden.bits()) & mask_of(L::WIDTH) & asked >> part;
                while unsure != 0 {
                    let l = part + unsure.trailing_zeros() as usize;
                    visible |= u32::from(law.sees_by_axes(angles, seen.at(block * BLOCK + l).0)) << l;
                    unsure &= unsure - 1;
                }
            }
            for set in first_hidden..=ATTRACTION {
                marks[set * blocks + block] &= visible as u16;
            }
        }
        marks
    }
}
impl<R: Scalar> Task<R> for ByAxes<'_, R> {
    type Output = Vec<u16>;
    #[inline(always)]
    fn run<L: Lanes<R>>(self) -> Vec<u16> {
        self.told::<R, L>(self.seen, R::ZERO)
    }
}

/// The same by places in single precision, twice as many others at a time.
struct ByAxesRoughly<'a, R>(ByAxes<'a, R>, Rough<'a, R, 3>);
impl<R: Scalar> Task<f32> for ByAxesRoughly<'_, R> {
    type Output = Vec<u16>;
    #[inline(always)]
    fn run<L: Lanes<f32>>(self) -> Vec<u16> {
        let Self(exactly, rough) = self;
        exactly.told::<f32, L>(rough, rough.displaced)
    }
}

/// Offsets of percepts, so many from a number on.
trait Offsets<N> {
    /// One per lane.
    fn several<L: Lanes<N>>(&self, first: usize) -> [L; 3];
}
impl<R: Scalar> Offsets<R> for &Percepts<'_, R, 3> {
    #[inline(always)]
    fn several<L: Lanes<R>>(&self, first: usize) -> [L; 3] {
        Percepts::several::<L>(self, first).0
    }
}
impl<R: Scalar> Offsets<f32> for Rough<'_, R, 3> {
    #[inline(always)]
    fn several<L: Lanes<f32>>(&self, first: usize) -> [L; 3] {
        self.offsets(first)
    }
}

// Small traits in place of closures, which would not be compiled for the processor's widest vectors.

/// What is summed over neighbours.
trait Term<R: Scalar> {
    /// That of a percept.
    fn of(seen: &Percepts<'_, R, 3>, k: usize) -> Vector<R, 3>;
    /// The sum over a whole set.
    fn sum(seen: &Percepts<'_, R, 3>, sight: Sight<'_>, set: usize) -> Vector<R, 3>;
    /// The sum over those of a short list, in its order, whose bits are set.
    #[inline(always)]
    fn sum_listed<L: Lanes<R>>(seen: &Percepts<'_, R, 3>, list: &Listed<R>, mut bits: u32) -> Vector<R, 3> {
        let mut sum = Vector::ZERO;
        while bits != 0 {
            sum += Self::of(seen, list.kept[bits.trailing_zeros() as usize] as usize);
            bits &= bits - 1;
        }
        sum
    }
}

/// Up to [`KEPT`] percepts side by side. Behind them, nobody is infinitely far away.
struct Listed<R> {
    kept: [u32; KEPT],
    offset: [[R; KEPT]; 3],
    squared: [R; KEPT],
}

/// Velocities, in place of headings: all are equally fast.
struct Velocities;
impl<R: Scalar> Term<R> for Velocities {
    #[inline(always)]
    fn of(seen: &Percepts<'_, R, 3>, k: usize) -> Vector<R, 3> {
        seen.velocity(k)
    }
    #[inline(always)]
    fn sum(seen: &Percepts<'_, R, 3>, sight: Sight<'_>, set: usize) -> Vector<R, 3> {
        sum_in_order::<R, Self>(seen, sight, set)
    }
}

/// Headings, where some are faster than others.
struct Headings;
impl<R: Scalar> Term<R> for Headings {
    #[inline(always)]
    fn of(seen: &Percepts<'_, R, 3>, k: usize) -> Vector<R, 3> {
        seen.heading(k)
    }
    #[inline(always)]
    fn sum(seen: &Percepts<'_, R, 3>, sight: Sight<'_>, set: usize) -> Vector<R, 3> {
        sum_in_order::<R, Self>(seen, sight, set)
    }
}

/// Unit vectors towards others.
struct Directions;
impl<R: Scalar> Term<R> for Directions {
    #[inline(always)]
    fn of(seen: &Percepts<'_, R, 3>, k: usize) -> Vector<R, 3> {
        let (offset, squared) = seen.at(k);
        Vector(towards(&offset.0, squared))
    }
    #[inline(always)]
    fn sum(seen: &Percepts<'_, R, 3>, sight: Sight<'_>, set: usize) -> Vector<R, 3> {
        with_lanes(level(), SumOfDirections { seen, sight, set })
    }
    #[inline(always)]
    fn sum_listed<L: Lanes<R>>(_: &Percepts<'_, R, 3>, list: &Listed<R>, mut bits: u32) -> Vector<R, 3> {
        let mut units = [[R::ZERO; KEPT]; 3];
        for part in (0..KEPT).step_by(L::WIDTH) {
            if bits >> part == 0 {
                break;
            }
            let offset = list.offset.each_ref().map(|offset| L::load(&offset[part..]));
            let unit = towards(&offset, L::load(&list.squared[part..]));
            for a in 0..3 {
                unit[a].store(&mut units[a][part..]);
            }
        }
        let mut sum = Vector::ZERO;
        while bits != 0 {
            let n = bits.trailing_zeros() as usize % KEPT;
            sum += Vector([units[0][n], units[1][n], units[2][n]]);
            bits &= bits - 1;
        }
        sum
    }
}

/// Unit vectors of offsets; zero where coincident.
#[inline(always)]
fn towards<R: Scalar, L: Lanes<R>>(offset: &[L; 3], squared: L) -> [L; 3] {
    let apart = L::splat(R::TINY * R::TINY).less(squared);
    let per = L::choose(apart, reciprocal_root::<R, L>(squared), L::splat(R::ZERO));
    [offset[0] * per, offset[1] * per, offset[2] * per]
}

/// The sum over a whole set, one member after the other.
#[inline(always)]
fn sum_in_order<R: Scalar, T: Term<R>>(seen: &Percepts<'_, R, 3>, sight: Sight<'_>, set: usize) -> Vector<R, 3> {
    let mut sum = Vector::ZERO;
    for block in 0..seen.blocks() {
        let mut members = sight.members(set, block);
        while members != 0 {
            sum += T::of(seen, block * BLOCK + members.trailing_zeros() as usize);
            members &= members - 1;
        }
    }
    sum
}

/// Sums of the unit vectors towards the members in every sixteenth row each, so that the processor may add several at a time,
/// and then the sum of these; the number depends neither on the processor nor on who stands between the members.
struct SumOfDirections<'a, R> {
    seen: &'a Percepts<'a, R, 3>,
    sight: Sight<'a>,
    set: usize,
}
impl<R: Scalar> Task<R> for SumOfDirections<'_, R> {
    type Output = Vector<R, 3>;
    #[inline(always)]
    fn run<L: Lanes<R>>(self) -> Vector<R, 3> {
        let Self { seen, sight, set } = self;
        let mut sums = [[R::ZERO; BLOCK]; 3];
        for block in 0..seen.blocks() {
            let mut members = u32::from(sight.members(set, block));
            if seen.whole && members != 0 {
                for part in (0..BLOCK).step_by(L::WIDTH) {
                    if members >> part & mask_of(L::WIDTH) == 0 {
                        continue;
                    }
                    let (offset, squared) = seen.several::<L>(block * BLOCK + part);
                    let unit = towards(&offset, squared);
                    for a in 0..3 {
                        let sum = L::load(&sums[a][part..]);
                        sum.add_where(L::Mask::from_bits(members >> part), unit[a]).store(&mut sums[a][part..]);
                    }
                }
                continue;
            }
            while members != 0 {
                let k = block * BLOCK + members.trailing_zeros() as usize;
                let unit = Directions::of(seen, k);
                for a in 0..3 {
                    sums[a][seen.row[k] as usize % BLOCK] += unit[a];
                }
                members &= members - 1;
            }
        }
        let mut sum = Vector::ZERO;
        for a in 0..3 {
            let each = &mut sums[a];
            let mut half = BLOCK / 2;
            while half > 0 {
                for l in 0..half {
                    each[l] += each[l + half];
                }
                half /= 2;
            }
            sum.0[a] = each[0];
        }
        sum
    }
}

/// The order of two by their squared distances; ties go to the lower id.
#[inline]
fn nearer_first<R: Scalar>(a: &(R, u32, usize), b: &(R, u32, usize)) -> Ordering {
    a.0.partial_cmp(&b.0).unwrap_or(Ordering::Equal).then(a.1.cmp(&b.1))
}

/// The nearest `considered` of a set that has more members, in their order; none where that takes more than [`KEPT`] to tell.
struct Nearest<'a, R> {
    seen: &'a Percepts<'a, R, 3>,
    sight: Sight<'a>,
    set: usize,
    considered: usize,
}

/// So many members of a set are listed before the farther ones are left out.
const LISTED: usize = 256;
const ROOM: usize = LISTED + 2 * BLOCK;

/// Keeps those among so many that may be among the nearest, in their order. Behind them stands anything.
#[inline(always)]
fn nearer<R: Scalar, L: Lanes<R>>(
    squares: &mut [R; ROOM],
    rows: &mut [u32; ROOM],
    count: usize,
    considered: usize,
) -> usize {
    squares[count..count + BLOCK].fill(R::INFINITY);
    // the nearest of each lane's share: so many of these as are considered are that near, so the nearest of all are no farther
    let mut least = [L::splat(R::INFINITY); KEPT];
    for first in (0..count).step_by(KEPT) {
        for part in (0..KEPT).step_by(L::WIDTH) {
            let least = &mut least[part / L::WIDTH];
            *least = L::load(&squares[first + part..]).lesser(*least);
        }
    }
    let bound = L::splat(in_order::<R, L>(&least, considered));
    let mut near = 0;
    for first in (0..count).step_by(L::WIDTH) {
        let lanes = L::load(&squares[first..]);
        let mut some = [0; WIDEST];
        some[..L::WIDTH].copy_from_slice(&rows[first..first + L::WIDTH]);
        let bits = lanes.less_equal(bound).bits() & mask_of(count - first);
        // never beyond what was read
        L::pack_listed(&some, bits, &mut rows[near..]);
        lanes.pack(bits, &mut squares[near..]);
        near += bits.count_ones() as usize;
    }
    near
}

impl<R: Scalar> Task<R> for Nearest<'_, R> {
    type Output = Option<[u32; KEPT]>;
    #[inline(always)]
    fn run<L: Lanes<R>>(self) -> Option<[u32; KEPT]> {
        let Self { seen, sight, set, considered } = self;
        // the members, whoever stands between them
        let (mut squares, mut rows) = ([R::INFINITY; ROOM], [0; ROOM]);
        let mut count = 0;
        for block in 0..seen.blocks() {
            let marks = u32::from(sight.members(set, block));
            if marks == 0 {
                continue;
            }
            if count > LISTED {
                count = nearer::<R, L>(&mut squares, &mut rows, count, considered);
                if count > LISTED {
                    return None;
                }
            }
            for part in (0..BLOCK).step_by(L::WIDTH) {
                let bits = marks >> part & mask_of(L::WIDTH);
                let first = block * BLOCK + part;
                seen.several::<L>(first).1.pack(bits, &mut squares[count..]);
                L::pack_numbers(first as u32, bits, &mut rows[count..]);
                count += bits.count_ones() as usize;
            }
        }
        if count > KEPT {
            count = nearer::<R, L>(&mut squares, &mut rows, count, considered);
        }
        if count > KEPT {
            return None;
        }
        squares[count..count + BLOCK].fill(R::INFINITY);
        let mut least = [L::splat(R::INFINITY); KEPT];
        for part in (0..KEPT).step_by(L::WIDTH) {
            least[part / L::WIDTH] = L::load(&squares[part..]);
        }
        let bound = in_order::<R, L>(&least, considered);
        let mut kept = [0; KEPT];
        let mut filled = 0;
        for n in 0..count {
            kept[filled % KEPT] = rows[n];
            filled += usize::from(squares[n] <= bound);
        }
        (filled == considered).then_some(kept)
    }
}

/// The least of [`KEPT`] numbers that so many do not exceed.
#[inline(always)]
fn in_order<R: Scalar, L: Lanes<R>>(numbers: &[L; KEPT], count: usize) -> R {
    let mut each = [R::ZERO; KEPT];
    for part in (0..KEPT).step_by(L::WIDTH) {
        numbers[part / L::WIDTH].store(&mut each[part..]);
    }
    // how many of them each does not fall short of
    let (one, enough) = (L::splat(R::ONE), L::splat(R::count(count)));
    // in four sums that need not wait for each other
    let mut ranks = [[L::splat(R::ZERO); KEPT]; 4];
    for first in (0..KEPT).step_by(4) {
        for (n, ranks) in ranks.iter_mut().enumerate() {
            let number = L::splat(each[first + n]);
            for part in 0..KEPT / L::WIDTH {
                ranks[part] = ranks[part].add_where(number.less_equal(numbers[part]), one);
            }
        }
    }
    let mut bound = L::splat(R::INFINITY);
    for part in 0..KEPT / L::WIDTH {
        let rank = (ranks[0][part] + ranks[1][part]) + (ranks[2][part] + ranks[3][part]);
        bound = L::choose(enough.less_equal(rank), bound.lesser(numbers[part]), bound);
    }
    bound.store(&mut each);
    let mut half = L::WIDTH / 2;
    while half > 0 {
        for lane in 0..half {
            each[lane] = each[lane].least(each[lane + half]);
        }
        half /= 2;
    }
    each[0]
}

/// Some members of a set, all of the nearest `considered` among them, by what is roughly known of their distances; none where
/// that are more than [`KEPT`]. The answer: their numbers, and how many they are.
struct NearestRoughly<'a> {
    squared: &'a [f32],
    margin: f32,
    blocks: usize,
    sight: Sight<'a>,
    set: usize,
    considered: usize,
}

impl Task<f32> for NearestRoughly<'_> {
    type Output = Option<([u32; KEPT], usize)>;
    #[inline(always)]
    fn run<L: Lanes<f32>>(self) -> Option<([u32; KEPT], usize)> {
        let Self { squared, margin, blocks, sight, set, considered } = self;
        let squared = &squared[..blocks * BLOCK];
        let mut least = [L::splat(f32::INFINITY); KEPT];
        for block in 0..blocks {
            let marks = u32::from(sight.members(set, block));
            for part in (0..BLOCK).step_by(L::WIDTH) {
                let least = &mut least[part / L::WIDTH];
                let nearer = L::load(&squared[block * BLOCK + part..]).lesser(*least);
                *least = L::choose(L::Mask::from_bits(marks >> part), nearer, *least);
            }
        }
        // so many are that near, each of them wrong by the margin at most
        let bound = L::splat(in_order::<f32, L>(&least, considered) + 2.0 * margin);
        let mut list = [0; 2 * KEPT];
        let mut listed = 0;
        for block in 0..blocks {
            let marks = u32::from(sight.members(set, block));
            for part in (0..BLOCK).step_by(L::WIDTH) {
                let first = block * BLOCK + part;
                let near = L::load(&squared[first..]).less_equal(bound).bits() & marks >> part;
                L::pack_numbers(first as u32, near, &mut list[listed.min(KEPT)..]);
                listed += near.count_ones() as usize;
            }
        }
        let mut kept = [0; KEPT];
        kept.copy_from_slice(&list[..KEPT]);
        (listed <= KEPT).then_some((kept, listed))
    }
}

/// The sum over the nearest `considered` of a short list of percepts; ties go to the first.
struct SumOfListed<'a, R, T> {
    seen: &'a Percepts<'a, R, 3>,
    kept: [u32; KEPT],
    listed: usize,
    considered: usize,
    term: PhantomData<T>,
}

impl<R: Scalar, T: Term<R>> Task<R> for SumOfListed<'_, R, T> {
    type Output = Vector<R, 3>;
    #[inline(always)]
    fn run<L: Lanes<R>>(self) -> Vector<R, 3> {
        let Self { seen, kept, listed, considered, .. } = self;
        let mut list = Listed { kept, offset: [[R::ZERO; KEPT]; 3], squared: [R::INFINITY; KEPT] };
        for n in 0..listed.min(KEPT) {
            let (offset, squared) = seen.at(kept[n] as usize);
            for a in 0..3 {
                list.offset[a][n] = offset[a];
            }
            list.squared[n] = squared;
        }
        let mut nearest = mask_of(listed);
        if listed > considered {
            let (one, enough) = (L::splat(R::ONE), L::splat(R::count(considered)));
            let mut left = 0;
            for part in (0..KEPT).step_by(L::WIDTH) {
                if part >= listed {
                    break;
                }
                // how many are before each: nearer, or as near and before it in the list
                let mine = L::load(&list.squared[part..]);
                let mut before = L::splat(R::ZERO);
                for n in 0..listed.min(KEPT) {
                    let other = L::splat(list.squared[n]);
                    let behind = L::Mask::from_bits((!mask_of(n + 1) & mask_of(KEPT)) >> part);
                    before = before.add_where(other.less(mine).or(other.less_equal(mine).and(behind)), one);
                }
                left |= before.less(enough).bits() << part;
            }
            nearest &= left;
        }
        T::sum_listed::<L>(seen, &list, nearest)
    }
}

/// How far a number has risen from `low` to `high`, 0 to 1; half where both are that number.
fn rising(number: f64, low: f64, high: f64) -> f64 {
    if low < high {
        return ((number - low) / (high - low)).clamp(0.0, 1.0);
    }
    match number.partial_cmp(&low) {
        Some(core::cmp::Ordering::Greater) => 1.0,
        Some(core::cmp::Ordering::Equal) => 0.5,
        _ => 0.0,
    }
}

impl<R: Scalar> BehaviourSelection<R> {
    /// Bounds of the zones, from centre to centre.
    #[inline(always)]
    fn bounds(&self) -> [R; 3] {
        let bodies = self.body_radius + self.body_radius;
        // sight includes its bound, so its last number is the next one
        let next = R::ONE + R::of(f64::EPSILON) + R::of(f64::EPSILON);
        let next = if next > R::ONE { next } else { R::ONE + R::of(f64::from(f32::EPSILON)) };
        [self.avoidance_radius + bodies, self.alignment_radius + bodies, (self.sight_radius + bodies) * next]
    }
    /// Whether a direction (of any length) lies within the field of view.
    #[inline(always)]
    fn sees(&self, heading: Vector<R, 3>, angles: (R, R), offset: Vector<R, 3>) -> bool {
        match self.view {
            View::Cone => {
                let limit = cos_half(self.field_of_view.radians());
                in_view::<R, R, 3>(&heading.0, &offset.0, offset.length_squared(), limit)
            }
            View::Axes => self.sees_by_axes(angles, offset),
        }
    }
    /// How far one sees to either side, and up and down.
    fn half_angles(&self) -> (R, R) {
        (self.field_of_view.radians() * R::HALF, self.vertical_field_of_view.radians() * R::HALF)
    }
    fn sees_by_axes(&self, (theta, phi): (R, R), offset: Vector<R, 3>) -> bool {
        let level = (offset[0].squared() + offset[1].squared()).root();
        let aside = (offset[1].atan2(offset[0]) - theta).wrapped().abs();
        let above = (offset[2].atan2(level) - phi).abs();
        let (half, vertical) = self.half_angles();
        // straight above or below has no azimuth
        (aside <= half || level <= R::TINY) && above <= vertical
    }
    /// The heading of two angles.
    #[inline(always)]
    fn heading_of(theta: R, phi: R) -> Vector<R, 3> {
        let ((sin_theta, cos_theta), (sin_phi, cos_phi)) = (theta.sin_cos(), phi.sin_cos());
        Vector([cos_phi * cos_theta, cos_phi * sin_theta, sin_phi])
    }
    /// The angles of a direction that is not zero; `theta` where it is upright.
    #[inline(always)]
    fn angles_of(direction: Vector<R, 3>, theta: R) -> (R, R) {
        let level = (direction[0].squared() + direction[1].squared()).root();
        let length = direction.length();
        let azimuth = if level < length * R::of(SHORT) { theta } else { direction[1].atan2(direction[0]) };
        (azimuth, (direction[2] / length).asin())
    }
    /// Whether the member is of kind b in this step.
    #[inline(always)]
    fn is_b(&self, me: &Me<'_, R, 3>, draws: &Draws<'_>) -> bool {
        let share = self.share_b.to_f64() / 100.0;
        match self.variant {
            Variant::Mixed => (me.member() as f64) < (f64::from(me.around.group.1) * share + 0.5).floor(),
            Variant::Switching => draws.number::<f64>("switch", 1.0, |s| s.uniform(3)) < share,
            _ => false,
        }
    }
    /// The probability of aligning with so many.
    #[inline(always)]
    fn probability(&self, b: bool, aligning: f64) -> f64 {
        let (preferred, growth) = match self.variant {
            Variant::Preset => return self.probability.to_f64(),
            Variant::Fuzzy => return self.fuzzy(aligning),
            Variant::Mixed | Variant::Switching if b => (self.preferred_neighbours_b, self.growth_b),
            Variant::Mixed | Variant::Switching => (self.preferred_neighbours_a, self.growth_a),
            _ => (self.preferred_neighbours, self.growth),
        };
        let exponent = -growth.to_f64() * (aligning - preferred.to_f64());
        if exponent < -40.0 {
            // what is added to 1 below is less than half of its last digit
            return 1.0;
        }
        // from libm, as everywhere
        1.0 / (1.0 + Real::exp(exponent))
    }
    /// The probability of aligning by the rules: none - attract, some - `some_align`, many - align.
    #[inline(never)]
    fn fuzzy(&self, aligning: f64) -> f64 {
        let none = 1.0 - rising(aligning, self.none_until.to_f64(), self.none_ends.to_f64());
        let many = rising(aligning, self.many_from.to_f64(), self.many_full.to_f64());
        let some = (1.0 - none).min(1.0 - many);
        let held = none + some + many;
        // neither rule holds only where the knots leave nothing between; then they are some
        let probability =
            if held > 0.0 { (some * self.some_align.to_f64() + many) / held } else { self.some_align.to_f64() };
        match self.fuzzy_output {
            Output::Probability => probability,
            Output::Crisp if probability > 0.5 => 1.0,
            Output::Crisp if probability < 0.5 => 0.0,
            Output::Crisp => 0.5,
        }
    }
    /// The probability of aligning with so many, with the errors of computation.
    #[cold]
    fn mistaken(&self, b: bool, aligning: u32, draws: &Draws<'_>) -> f64 {
        let stream = |s: &DrawStream| DrawStream::new(s.seed, Purpose::Computation, s.step, s.agent);
        let off = draws.number::<f64>("count_error", 0.0, |s| stream(s).normal_about(s.agent, 2));
        let aligning = f64::from(aligning) + self.count_error.to_f64() * off;
        let off = draws.number::<f64>("probability_error", 0.0, |s| stream(s).normal_about(s.agent, 4));
        let probability = self.probability(b, aligning) + self.probability_error.to_f64() * off;
        let coin = draws.number::<f64>("random_choice", 1.0, |s| stream(s).uniform_about(s.agent, 6));
        if coin < self.random_choice.to_f64() { 0.5 } else { probability.clamp(0.0, 1.0) }
    }
    /// Whether computation makes errors.
    #[inline(always)]
    fn errs(&self) -> bool {
        self.count_error + self.probability_error + self.random_choice > R::ZERO
    }
    /// The sum of the headings of the `considered` nearest that are aligned with.
    #[inline(always)]
    fn aligned(&self, seen: &Percepts<'_, R, 3>, sight: Sight<'_>, count: u32) -> Vector<R, 3> {
        if seen.uneven {
            return self.aligned_by_heading(seen, sight, count);
        }
        self.sum_of_nearest::<Velocities>(seen, sight, ALIGNMENT, count) / self.speed
    }
    #[cold]
    #[inline(never)]
    fn aligned_by_heading(&self, seen: &Percepts<'_, R, 3>, sight: Sight<'_>, count: u32) -> Vector<R, 3> {
        self.sum_of_nearest::<Headings>(seen, sight, ALIGNMENT, count)
    }
    /// What is wanted of the members that are avoided.
    #[cold]
    #[inline(never)]
    fn beside(&self, seen: &Percepts<'_, R, 3>, sight: Sight<'_>) -> Vector<R, 3> {
        sum_in_order::<R, Headings>(seen, sight, AVOIDANCE)
    }
    /// The sum of headings or directions over the `considered` nearest members of a set of `count`.
    #[inline(always)]
    fn sum_of_nearest<T: Term<R>>(
        &self,
        seen: &Percepts<'_, R, 3>,
        sight: Sight<'_>,
        set: usize,
        count: u32,
    ) -> Vector<R, 3> {
        let considered = self.considered;
        let count = count as usize;
        if considered == 0 || considered >= count {
            return T::sum(seen, sight, set);
        }
        let mut sum = Vector::ZERO;
        if considered <= KEPT
            && let Some(Rough { squared, margin, .. }) = seen.rough
        {
            let blocks = seen.blocks();
            let roughly = NearestRoughly { squared, margin, blocks, sight, set, considered };
            if let Some((kept, listed)) = with_lanes::<f32, _>(level(), roughly) {
                return with_lanes(level(), SumOfListed { seen, kept, listed, considered, term: PhantomData::<T> });
            }
        }
        if considered <= KEPT
            && let Some(kept) = with_lanes(level(), Nearest { seen, sight, set, considered })
        {
            for &k in &kept[..considered] {
                sum += T::of(seen, k as usize);
            }
            return sum;
        }
        // too many to list, or ties
        let mut members = Vec::with_capacity(count);
        for block in 0..seen.blocks() {
            let mut bits = sight.members(set, block);
            while bits != 0 {
                let k = block * BLOCK + bits.trailing_zeros() as usize;
                members.push((seen.at(k).1, seen.id(k), k));
                bits &= bits - 1;
            }
        }
        let mut ranked = members.clone();
        let last = *ranked.select_nth_unstable_by(considered - 1, nearer_first).1;
        for member in members {
            if nearer_first(&member, &last).is_le() {
                sum += T::of(seen, member.2);
            }
        }
        sum
    }

    /// Tells what the behaviours would have wanted, and how one of them was chosen.
    #[cold]
    fn tell(
        &self,
        me: &mut Me<'_, R, 3>,
        seen: &Percepts<'_, R, 3>,
        sight: Sight<'_>,
        counts: [u32; 3],
        from_obstacles: Vector<R, 3>,
        behaviour: Behaviour,
        drawn: Option<(f64, f64)>,
    ) {
        me.note("obstacles", from_obstacles);
        me.note("avoidance", -sum_in_order::<R, Directions>(seen, sight, AVOIDANCE));
        let headings = self.aligned(seen, sight, counts[ALIGNMENT]);
        me.note("alignment", headings);
        me.note("attraction", self.sum_of_nearest::<Directions>(seen, sight, ATTRACTION, counts[ATTRACTION]));
        let names = ["avoid", "align", "attract", "search", "average"];
        let chosen = behaviour as usize;
        for (k, name) in names.into_iter().enumerate() {
            let probability = match (drawn, k) {
                (Some((_, align)), 1) => align,
                (Some((_, align)), 2) => 1.0 - align,
                _ => f64::from(u8::from(k == chosen)),
            };
            me.choice(name, probability, k == chosen);
        }
        if let Some((drawn, _)) = drawn {
            me.value("drawn number", R::of(drawn), "1");
        }
        me.acts(match behaviour {
            Behaviour::Avoid => &[AVOIDANCE],
            Behaviour::Align => &[ALIGNMENT],
            Behaviour::Attract => &[ATTRACTION],
            Behaviour::Average => &[ALIGNMENT, ATTRACTION],
            Behaviour::Search => &[],
        });
    }

    #[inline(always)]
    fn wished(&self, me: &mut Me<'_, R, 3>, seen: &Percepts<'_, R, 3>, sight: Sight<'_>, draws: &Draws<'_>) -> Wish<R> {
        let (theta, phi) = (me.own[THETA], me.own[PHI]);
        let blocks = seen.blocks();
        let counts = [sight.count(AVOIDANCE, blocks), sight.count(ALIGNMENT, blocks), sight.count(ATTRACTION, blocks)];
        let (mut away, mut obstacles) = (Vector::<R, 3>::ZERO, 0u32);
        for obstacle in me.around.obstacles {
            if !self.avoid_walls && !obstacle.radius.finite() {
                continue;
            }
            if !self.obstacle_blind || self.sees(me.heading(), (theta, phi), -obstacle.away) {
                away += obstacle.away;
                obstacles += 1;
            }
        }
        let from_obstacles = away;
        let b = self.is_b(me, draws);
        let mut drawn = None;
        let behaviour = match (counts[AVOIDANCE] + obstacles, counts[ALIGNMENT], counts[ATTRACTION]) {
            (0, 0, 0) => Behaviour::Search,
            (0, _, 0) => Behaviour::Align,
            (0, 0, _) => Behaviour::Attract,
            (0, ..) if self.variant == Variant::Control => Behaviour::Average,
            (0, aligning, _) => {
                let probability = if self.errs() {
                    self.mistaken(b, aligning, draws)
                } else {
                    self.probability(b, f64::from(aligning))
                };
                // what is certain needs no draw, but where it is to be told
                let certain = probability >= 1.0 && draws.drawn() && me.trace.is_none();
                let choice = if certain { 0.0 } else { draws.number::<f64>("choice", 1.0, |s| s.uniform(0)) };
                drawn = Some((choice, probability));
                if choice < probability { Behaviour::Align } else { Behaviour::Attract }
            }
            _ => Behaviour::Avoid,
        };
        let wanted = match behaviour {
            Behaviour::Avoid if self.avoiding == Avoiding::Match => away + self.beside(seen, sight),
            Behaviour::Avoid => away - sum_in_order::<R, Directions>(seen, sight, AVOIDANCE),
            Behaviour::Align => self.aligned(seen, sight, counts[ALIGNMENT]),
            Behaviour::Attract => self.sum_of_nearest::<Directions>(seen, sight, ATTRACTION, counts[ATTRACTION]),
            Behaviour::Average => {
                let a = self.aligned(seen, sight, counts[ALIGNMENT]);
                let b = self.sum_of_nearest::<Directions>(seen, sight, ATTRACTION, counts[ATTRACTION]);
                match self.control_mode {
                    Average::Unit => a.unit() + b.unit(),
                    Average::Raw => a + b,
                }
            }
            Behaviour::Search => Vector::ZERO,
        };
        let mut wish = Wish { direction: wanted, ..Wish::default() };
        if let Behaviour::Search = behaviour {
            let limits = self.limits();
            let range = match (self.search, self.view) {
                (Search::Limits, _) => limits,
                (Search::View, View::Cone) => [self.field_of_view.radians() * R::HALF; 2],
                (Search::View, View::Axes) => self.half_angles().into(),
            };
            wish.turn[0] = range[0] * draws.number("search_theta", 0.0, |s| 2.0 * s.uniform(1) - 1.0);
            wish.turn[1] = range[1] * draws.number("search_phi", 0.0, |s| 2.0 * s.uniform(2) - 1.0);
            for (turn, limit) in wish.turn.iter_mut().zip(limits) {
                *turn = turn.clamped(-limit, limit);
            }
        }
        if me.trace.is_some() {
            self.tell(me, seen, sight, counts, from_obstacles, behaviour, drawn);
            me.note("wanted direction", wanted);
            let [turn, rise] = self.turns::<R>(me.own[THETA], me.own[PHI], &wish.direction.0, &wish.turn);
            for (name, angle) in [("turn", turn), ("rise", rise)] {
                me.value(name, angle, "rad");
            }
            for (name, limit) in ["turn allowed", "rise allowed"].into_iter().zip(self.limits()) {
                me.value(name, limit, "rad");
            }
        }
        me.own[KIND] = R::of(f64::from(u8::from(b)));
        let count = |count: u32| R::of(f64::from(count));
        (me.own[N_AVOID], me.own[N_ALIGN], me.own[N_ATTRACT]) = (count(counts[0]), count(counts[1]), count(counts[2]));
        (me.own[O_AVOID], me.own[BEHAVIOUR]) = (count(obstacles), count(behaviour as u32));
        wish
    }

    /// Largest turns in a step, rad: of the azimuth, of the elevation.
    #[inline(always)]
    fn limits(&self) -> [R; 2] {
        [self.horizontal_turning_rate, self.vertical_turning_rate].map(|rate| rate.radians() * self.time_step)
    }

    /// The turns of azimuth and elevation (rad) towards a direction; those of the search where there is none.
    #[inline(always)]
    fn turns<L: Lanes<R>>(&self, theta: L, phi: L, direction: &[L; 3], search: &[L; 2]) -> [L; 2] {
        let [x, y, z] = *direction;
        let level = x * x + y * y;
        let length = level + z * z;
        let short = L::splat(R::of(SHORT * SHORT));
        let upright = level.less(length * short);
        let still = length.less(short);
        let across = L::choose(upright, theta, arc_tangent::<R, L>(y, x));
        let up = arc_tangent::<R, L>(z, level.square_root());
        let [most_turn, most_rise] = self.limits().map(L::splat);
        let turn = wrapped::<R, L>(across - theta).greater(-most_turn).lesser(most_turn);
        let rise = (up - phi).greater(-most_rise).lesser(most_rise);
        [L::choose(still, search[0], turn), L::choose(still, search[1], rise)]
    }
}

/// What an agent wishes.
#[derive(Clone, Copy)]
pub struct Wish<R> {
    /// Where to, of any length; zero where nobody says.
    direction: Vector<R, 3>,
    /// Turns of azimuth and elevation in a search, rad; else zero.
    turn: [R; 2],
}

impl<R: Real> Default for Wish<R> {
    fn default() -> Self {
        Self { direction: Vector::ZERO, turn: [R::ZERO; 2] }
    }
}

impl<R: Scalar> Abreast<R, 3> for BehaviourSelection<R> {
    type Wish = Wish<R>;

    fn sets(&self) -> Vec<NamedSet<R, 3>> {
        let [near, middle, far] = self.bounds();
        let ring = |low: R, high: R, seen: bool| {
            let ring = if high > low { Perception::distance(low, high) } else { Perception::KNearest(0) };
            // the view by axes is left to the law: it hangs on the azimuth, which a heading straight up does not have
            let cone = seen && self.view == View::Cone;
            if cone { ring.both(Perception::angle(self.field_of_view.radians())) } else { ring }
        };
        vec![
            NamedSet::new("avoidance", ring(R::ZERO, near, self.avoid_blind)),
            NamedSet::new("alignment", ring(near, middle, true)),
            NamedSet::new("attraction", ring(middle, far, true)),
        ]
    }
    fn complete(&self, start: &mut Start<'_, R, 3>) {
        if !(start.given[THETA] && start.given[PHI]) {
            let (theta, phi) =
                if start.velocity.is_tiny() { (R::ZERO, R::ZERO) } else { Self::angles_of(*start.velocity, R::ZERO) };
            if !start.given[THETA] {
                start.own[THETA] = theta;
            }
            if !start.given[PHI] {
                start.own[PHI] = phi;
            }
        }
        *start.velocity = Self::heading_of(start.own[THETA], start.own[PHI]) * self.speed;
    }
    fn performed(&self, own: &mut [R], velocity: Vector<R, 3>) {
        if !velocity.is_tiny() {
            (own[THETA], own[PHI]) = Self::angles_of(velocity, own[THETA]);
        }
    }
    #[inline(always)]
    fn wish(&self, me: &mut Me<'_, R, 3>, seen: &Percepts<'_, R, 3>, draws: &Draws<'_>) -> Wish<R> {
        match self.view {
            View::Cone => self.wished(me, seen, Sight(seen.marks), draws),
            View::Axes => {
                let angles = (me.own[THETA], me.own[PHI]);
                let exactly = ByAxes { law: self, seen, angles };
                let marks = match seen.rough {
                    Some(rough) => with_lanes(level(), ByAxesRoughly(exactly, rough)),
                    None => with_lanes(level(), exactly),
                };
                let (avoidance, others) = marks.split_at(seen.blocks());
                let (alignment, attraction) = others.split_at(seen.blocks());
                self.wished(me, seen, Sight([avoidance, alignment, attraction]), draws)
            }
        }
    }
    #[inline(always)]
    fn conclude<L: Lanes<R>>(&self, first: usize, wishes: &[Wish<R>; WIDEST], agents: &mut Agents<R, 3>) {
        let mut wished = [[R::ZERO; WIDEST]; 5];
        for l in 0..L::WIDTH {
            let wish = &wishes[first + l];
            let [x, y, z] = wish.direction.0;
            for (column, number) in wished.iter_mut().zip([x, y, z, wish.turn[0], wish.turn[1]]) {
                column[l] = number;
            }
        }
        let [x, y, z, turn, rise] = wished.each_ref().map(|column| L::load(column));
        let (theta, phi) = (L::load(&agents.own[THETA][first..]), L::load(&agents.own[PHI][first..]));
        let [turn, rise] = self.turns::<L>(theta, phi, &[x, y, z], &[turn, rise]);
        let pole = L::splat(R::PI * R::HALF);
        let theta = wrapped::<R, L>(theta + turn);
        let phi = (phi + rise).greater(-pole).lesser(pole);
        theta.store(&mut agents.own[THETA][first..]);
        phi.store(&mut agents.own[PHI][first..]);
        let ((sine, cosine), (sine_up, cosine_up)) = (sine_cosine::<R, L>(theta), sine_cosine::<R, L>(phi));
        let (speed, time) = (L::splat(self.speed), L::splat(self.time_step));
        let new = [cosine_up * cosine * speed, cosine_up * sine * speed, sine_up * speed];
        for a in 0..3 {
            let moving = match self.position_update {
                Update::New => new[a],
                Update::Old => L::load(&agents.velocity[a][first..]),
            };
            (moving * time).store(&mut agents.displacement[a][first..]);
            new[a].store(&mut agents.velocity[a][first..]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::models::oracle::{Oracle, close};
    use space::Space;
    use space::shape::Shape;

    type State = ([f64; 3], [f64; 3]);
    const AHEAD: [f64; 3] = [6.0, 0.0, 0.0];

    /// The law with its default parameters.
    fn law() -> BehaviourSelection<f64> {
        <BehaviourSelection<f64> as crate::parameters::Parameters>::from_values(&crate::parameters::Values::new())
            .unwrap_or_else(|error| unreachable!("{error}"))
    }
    fn oracle() -> Oracle<3> {
        Oracle::new("behaviour_selection")
    }
    fn heading(theta: f64, phi: f64) -> [f64; 3] {
        (BehaviourSelection::<f64>::heading_of(theta.to_radians(), phi.to_radians()) * 6.0).0
    }
    /// Behaviour, azimuth and elevation (degrees) of member 0 after a step.
    #[track_caller]
    fn selects(oracle: Oracle<3>, agents: &[State], behaviour: f64, theta: f64, phi: f64) {
        let w = oracle.step(agents);
        assert_eq!(w.state(0, "behaviour"), Some(behaviour));
        let found = ["theta", "phi"].map(|name| w.state(0, name).unwrap_or(f64::NAN).to_degrees());
        assert!((found[0] - theta).abs() < 1e-9 && (found[1] - phi).abs() < 1e-9, "{found:?}, not {theta}, {phi}");
        close(w.velocity(0), heading(theta, phi));
    }

    #[test]
    fn one_neighbour_in_each_zone() {
        // centres 5 apart: surfaces 3, avoided, and turns of 18 and 9 degrees at most
        selects(oracle(), &[([0.0; 3], AHEAD), ([0.0, -3.0, 4.0], AHEAD)], 0.0, 18.0, -9.0);
        selects(oracle(), &[([0.0; 3], AHEAD), ([0.0, 8.0, 0.0], heading(10.0, 5.0))], 1.0, 10.0, 5.0);
        selects(oracle(), &[([0.0; 3], AHEAD), ([15.0, 0.0, 2.0], AHEAD)], 2.0, 0.0, (2f64 / 15.0).atan().to_degrees());
        // sight includes its bound of 24, from surface to surface; behind is blind
        selects(oracle(), &[([0.0; 3], AHEAD), ([0.0, 26.0, 0.0], AHEAD)], 2.0, 18.0, 0.0);
        selects(oracle(), &[([0.0; 3], AHEAD), ([0.0, 26.001, 0.0], AHEAD)], 3.0, 0.0, 0.0);
        selects(oracle(), &[([0.0; 3], AHEAD), ([-8.0, 0.5, 0.0], AHEAD)], 3.0, 0.0, 0.0);
    }

    #[test]
    fn both_zones_filled_is_a_matter_of_the_draw() {
        let agents = [([0.0; 3], AHEAD), ([0.0, 8.0, 0.0], heading(10.0, 5.0)), ([15.0, 0.0, -2.0], AHEAD)];
        let down = -(2f64 / 15.0).atan().to_degrees();
        // P = 1/(1 + exp(2 (10 - 1))) = 1.5e-8
        selects(oracle().inject("choice", &[1.5e-8; 3]), &agents, 1.0, 10.0, 5.0);
        selects(oracle().inject("choice", &[1.6e-8; 3]), &agents, 2.0, 0.0, down);
        for (p, behaviour) in [(0.0, 2.0), (1.0, 1.0)] {
            let w = oracle().set("variant", "preset").set("P", p).inject("choice", &[0.0; 3]).step(&agents);
            assert_eq!(w.state(0, "behaviour"), Some(behaviour));
        }
        let sum = Vector(heading(10.0, 5.0)) * (1.0 / 6.0) + Vector([15.0, 0.0, -2.0]).unit();
        let (theta, phi) = BehaviourSelection::angles_of(sum, 0.0);
        selects(oracle().set("variant", "control"), &agents, 4.0, theta.to_degrees(), phi.to_degrees());
    }

    #[test]
    fn the_n_nearest_of_a_zone_count_and_ties_go_to_the_lower_index() {
        let agents = [
            ([0.0; 3], AHEAD),
            ([0.0, 9.0, 0.0], heading(90.0, 0.0)),
            ([0.0, -8.0, 0.0], heading(12.0, 0.0)),
            ([0.0, 8.0, 0.0], heading(-6.0, 0.0)),
            ([0.0, 0.0, 8.0], heading(-90.0, 0.0)),
        ];
        selects(oracle().set("N", 1usize), &agents, 1.0, 12.0, 0.0);
        selects(oracle().set("N", 2usize), &agents, 1.0, 3.0, 0.0);
        assert_eq!(oracle().set("N", 1usize).step(&agents).state(0, "n_align"), Some(4.0));
        // the same through every way of finding them
        let crowd: Vec<State> = (0..40)
            .map(|k| {
                let (angle, height) = (f64::from(k) * 2.4, f64::from(k) / 20.0 - 1.0);
                let place = Vector([0.3 + angle.cos(), angle.sin(), height]).unit() * (7.0 + 0.1 * f64::from(k));
                (place.0, heading(f64::from(k), f64::from(k) / 2.0))
            })
            .collect();
        for considered in [1usize, 6, 16, 17, 30, 39, 0] {
            let agents: Vec<State> = core::iter::once(([0.0; 3], AHEAD)).chain(crowd.iter().copied()).collect();
            let w = oracle().set("fov_deg", 360.0).set("N", considered).set("turn_h", 3600.0).step(&agents);
            let taken = if considered == 0 { 40 } else { considered };
            let sum = crowd[..taken].iter().fold(Vector::ZERO, |sum, agent| sum + Vector(agent.1));
            let theta = BehaviourSelection::angles_of(sum, 0.0).0;
            assert!((w.state(0, "theta").unwrap_or(f64::NAN) - theta).abs() < 1e-9, "N = {considered}");
        }
    }

    #[test]
    fn walls_and_obstacles_are_avoided_all_round_and_moves_that_touch_are_refused() {
        let tank = || oracle().space(Space::walled([100.0; 3]));
        // right behind: sensed, unless obstacles hide in the blind region too
        let away = [([3.0, 50.0, 50.0], heading(17.0, 0.0))];
        selects(tank(), &away, 0.0, 0.0, 0.0);
        selects(tank().set("obs_blind", true), &away, 3.0, 17.0, 0.0);
        let ball = || Shape::new_ball(Vector([62.5, 50.0, 50.0]), 10.0).unwrap_or_else(|_| unreachable!());
        let w = tank().obstacle(ball()).step(&[([51.5, 50.0, 50.0], AHEAD)]);
        assert_eq!((w.state(0, "o_avoid"), w.state(0, "collided")), (Some(1.0), Some(1.0)));
        close(w.position(0), [51.5, 50.0, 50.0]);
        close(w.velocity(0), heading(18.0, 0.0));
        let w = tank().obstacle(ball()).step(&[([47.5, 50.0, 50.0], AHEAD)]);
        assert_eq!((w.state(0, "o_avoid"), w.state(0, "collided")), (Some(0.0), Some(0.0)));
    }

    #[test]
    fn a_search_and_walls_have_their_other_readings() {
        // half of the greatest draw: within the limits of a step, or of half the view, of which more than the limits is left out
        for (search, draw, turn) in
            [("limits", 0.5, 9.0), ("view", 0.5, 18.0), ("view", 0.1, 13.5), ("view", -0.5, -18.0)]
        {
            let w = oracle().set("search", search).inject("search_theta", &[draw]).step(&[([0.0; 3], AHEAD)]);
            close(w.velocity(0), heading(turn, 0.0));
        }
        for (avoided, theta) in [(true, 18.0f64), (false, 0.0)] {
            let walled = oracle().space(Space::walled([100.0; 3])).set("avoid_walls", avoided);
            let w = walled.step(&[([50.0, 3.0, 50.0], AHEAD)]);
            close(w.velocity(0), heading(theta, 0.0));
        }
    }

    #[test]
    fn an_upright_wish_keeps_the_azimuth_and_the_elevation_stops_at_the_pole() {
        let above = [([0.0; 3], heading(40.0, 85.0)), ([0.0, 0.0, 15.0], AHEAD)];
        selects(oracle(), &above, 2.0, 40.0, 90.0);
        let search = oracle().inject("search_theta", &[0.5]).inject("search_phi", &[-1.0]);
        selects(search, &[([0.0; 3], heading(175.0, 0.0))], 3.0, -176.0, -9.0);
    }

    #[test]
    fn quick_selection_is_the_named_sets() {
        let agents: Vec<State> = (0..60)
            .map(|k| {
                let k = f64::from(k);
                ([(k * 7.3) % 31.0, (k * 3.7) % 29.0, (k * 5.9) % 23.0], heading(k * 37.0, (k * 17.0) % 90.0))
            })
            .collect();
        for (view, blind) in [("cone", true), ("cone", false), ("axes", true)] {
            let set_up = || oracle().set("fov", view).set("avoid_blind", blind);
            let quick = set_up().step(&agents);
            let mut slow = set_up();
            let law = <BehaviourSelection<f64> as crate::parameters::Parameters>::from_values(
                &slow.plan.groups[0].parameters,
            );
            // the same functions, in a shape that is not known for rings: the quick way is not taken
            let sets = law.map(|law| law.sets()).unwrap_or_default();
            let slowly = |set: NamedSet<f64, 3>| (set.name.to_owned(), Perception::Union(vec![set.perception]));
            slow.plan.groups[0].sets = sets.into_iter().map(slowly).collect();
            let slow = slow.step(&agents);
            for id in 0..60 {
                for name in ["n_avoid", "n_align", "n_attract", "theta", "phi"] {
                    assert_eq!(quick.state(id, name), slow.state(id, name), "{view} {name} {id}");
                }
            }
        }
    }

    fn sees_alike<R: Scalar>() {
        let number = |k: u64, d: u32| space::random::uniform(7, space::random::Purpose::Search, k, d);
        let turn = |share: f64| R::of(360.0 * share).radians();
        let values = oracle().plan.groups[0].parameters.clone();
        let law = <BehaviourSelection<R> as crate::parameters::Parameters>::from_values(&values);
        assert!(law.is_ok());
        let Ok(mut law) = law else { return };
        let (mut seen, mut roughly) = ([0; 2], 0);
        for k in 0..20_000u64 {
            law.field_of_view = R::of(360.0 * number(k, 0));
            law.vertical_field_of_view = R::of(180.0 * number(k, 1));
            let angles = (turn(number(k, 2) - 0.5), turn(0.5 * number(k, 3) - 0.25));
            let axes = Axes::of::<R, R>(&law, angles, R::ZERO);
            // by places in single precision, of one who stands anywhere in a tank
            let from = Vector([8, 9, 10].map(|d| R::of(335.0 * number(k, d))));
            let rough = Axes::of::<R, f32>(&law, angles, 335.0 / f32::powi(2.0, 20));
            let told = |offset: Vector<R, 3>| {
                let (within, hidden) = axes.tell::<R>(&offset.0);
                assert!(!(within && hidden));
                within || (!hidden && law.sees_by_axes(angles, offset))
            };
            // anywhere, and as near to a limit as can be told
            let (half, vertical) = law.half_angles();
            let slight = R::of(1e-6 * (number(k, 4) - 0.5));
            for (theta, phi) in [
                (turn(number(k, 5) - 0.5), turn(0.5 * number(k, 6) - 0.25)),
                (angles.0 + half + slight, angles.1),
                (angles.0 - half, angles.1 + slight),
                (angles.0, angles.1 + vertical + slight),
                (angles.0, angles.1 - vertical),
            ] {
                let offset = BehaviourSelection::heading_of(theta, phi) * R::of(10.0 * number(k, 7));
                let exactly = law.sees_by_axes(angles, offset);
                assert_eq!(told(offset), exactly, "{k}");
                seen[usize::from(exactly)] += 1;
                let coarse =
                    core::array::from_fn(|a| ((from[a] + offset[a]).to_f64() as f32) - (from[a].to_f64() as f32));
                let exactly = law.sees_by_axes(angles, from + offset - from);
                let (within, hidden) = rough.tell::<f32>(&coarse);
                assert!(if exactly { !hidden } else { !within }, "{k}");
                roughly += usize::from(within || hidden);
            }
            for offset in [[0.0; 3], [0.0, 0.0, 1.0], [0.0, 0.0, -1e-300], [1e-14, 0.0, 0.0], [1.0, 0.0, 0.0]] {
                let offset = Vector(offset.map(R::of));
                assert_eq!(told(offset), law.sees_by_axes(angles, offset), "{k} {offset:?}");
            }
        }
        assert!(seen.iter().all(|&count| count > 10_000), "{seen:?}");
        // one of five is drawn anywhere, the others about the limits
        assert!(roughly > 19_000, "{roughly}");
    }

    #[test]
    fn limits_of_azimuth_and_elevation_are_told_without_angles() {
        sees_alike::<f64>();
        sees_alike::<f32>();
    }

    #[test]
    fn angles_follow_a_body_that_moves_otherwise_than_wanted() {
        let mut noisy = oracle();
        noisy.plan.groups[0].noise.execution_direction = 0.3;
        let w = noisy.step(&[([0.0; 3], AHEAD), ([0.0, 50.0, 0.0], heading(20.0, 60.0))]);
        for id in 0..2 {
            let angles = ["theta", "phi"].map(|name| w.state(id, name).unwrap_or(f64::NAN));
            close(w.velocity(id), (BehaviourSelection::heading_of(angles[0], angles[1]) * 6.0).0);
        }
    }

    #[test]
    fn fuzzy_steps_are_the_limit_of_steep_growth() {
        let crowd: Vec<State> = (0..80)
            .map(|k| {
                let k = f64::from(k);
                ([(k * 7.3) % 37.0, (k * 3.7) % 31.0, (k * 5.9) % 29.0], heading(k * 37.0, (k * 17.0) % 60.0))
            })
            .collect();
        let run = |oracle: Oracle<3>| {
            let mut world = oracle.live().world(&crowd);
            world.run(60);
            world.frame().hash()
        };
        let steep = run(oracle().set("M", 6.0).set("K", 1e9));
        let fuzzy = || oracle().set("variant", "fuzzy").set("some_align", 0.5);
        let at = |from: f64, to: f64| {
            let knots = [("none_until", from), ("none_ends", to), ("many_from", from), ("many_full", to)];
            knots.into_iter().fold(fuzzy(), |oracle, (name, value)| oracle.set(name, value))
        };
        assert_eq!(run(at(6.0, 6.0)), steep);
        assert_eq!(run(at(6.0, 6.0).set("fuzzy_output", "crisp")), steep);
        assert_ne!(run(at(4.0, 9.0)), steep);
        assert_ne!(run(oracle().set("M", 6.0).set("K", 0.5)), steep, "the limit is one");
    }

    #[test]
    fn fuzzy_rules_give_the_probability_that_they_say() {
        let law = BehaviourSelection::<f64> { variant: Variant::Fuzzy, some_align: 0.25, ..law() };
        // knots 7, 10 and 10, 13: surely none, half none and half some, some, half some and half many, many
        for (count, probability) in [(7.0, 0.0), (8.5, 0.125), (10.0, 0.25), (11.5, 0.625), (13.0, 1.0)] {
            assert!((law.probability(false, count) - probability).abs() < 1e-12, "{count}");
        }
        let crisp = BehaviourSelection { fuzzy_output: Output::Crisp, ..law };
        assert_eq!([8.5, 11.5].map(|count| crisp.probability(false, count)), [0.0, 1.0]);
    }

    #[test]
    fn errors_of_computation_are_made_where_they_are_asked_for() {
        let agents = [([0.0; 3], AHEAD), ([0.0, 8.0, 0.0], heading(10.0, 5.0)), ([15.0, 0.0, -2.0], AHEAD)];
        let behaviour = |oracle: Oracle<3>| oracle.step(&agents).state(0, "behaviour");
        let drawn = || oracle().inject("choice", &[0.4; 3]);
        assert_eq!(behaviour(drawn()), Some(2.0));
        // 1 neighbour is taken for 11
        let mistaken = drawn().set("count_error", 2.0).inject("count_error", &[5.0; 3]);
        assert_eq!(behaviour(mistaken), Some(1.0));
        assert_eq!(behaviour(drawn().set("probability_error", 0.5).inject("probability_error", &[1.0; 3])), Some(1.0));
        assert_eq!(
            behaviour(drawn().set("eps", 0.2).inject("random_choice", &[0.1; 3])),
            Some(1.0),
            "a coin: 0.4 < 1/2"
        );
        assert_eq!(behaviour(drawn().set("eps", 0.2).inject("random_choice", &[0.3; 3])), Some(2.0));
    }

    #[test]
    fn who_is_too_near_is_matched_in_place_of_turned_away_from() {
        let agents = [([0.0; 3], AHEAD), ([0.0, -3.0, 4.0], heading(10.0, 5.0))];
        selects(oracle().set("avoiding", "match"), &agents, 0.0, 10.0, 5.0);
        // a wall is turned away from all the same
        let tank = oracle().space(Space::walled([100.0; 3])).set("avoiding", "match");
        selects(tank, &[([50.0, 3.0, 50.0], AHEAD)], 0.0, 18.0, 0.0);
    }
}
