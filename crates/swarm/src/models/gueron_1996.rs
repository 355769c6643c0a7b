//! Three nested boxes about the body: in the innermost a member turns or changes its speed by who stands where, in the middle
//! one it walks on, in the outermost it closes up.
//!
//! S. Gueron, S. A. Levin, D. I. Rubenstein (1996), The dynamics of herds: from individuals to aggregations, Journal of
//! Theoretical Biology 182:85.

use crate::card::*;
use crate::models::families::facing;
use crate::motion::*;
use crate::parameters;
use crate::parameters::{PerAgent, Scalar};
use crate::selection::{NamedSet, Perception};
use space::{Column, Vector};

parameters! {
    /// Parameters of `gueron_1996`.
    pub struct Gueron1996 {
        /// Half-lengths of the stress box, along and across the heading.
        stress_box alias "stress": Vec<R> = [1.0, 1.0], "-", "length", NonNegative, Ours;
        /// Half-lengths of the neutral box, along and across the heading.
        neutral_box alias "neutral": Vec<R> = [3.0, 3.0], "-", "length", NonNegative, Ours;
        /// Half-lengths of the attraction box, along and across the heading.
        attraction_box alias "attraction": Vec<R> = [8.0, 8.0], "-", "length", NonNegative, Ours;
        /// Half-angle of the front sector.
        front_half_angle alias "front_deg": R = 15.0, "-", "deg", Within(0.0, 90.0), Ours;
        /// Factor by which a member speeds up or slows down.
        speed_factor alias "factor": R = 1.5, "w", "1", Positive, Ours;
        /// Own walking speed, the same for all or one for each member.
        walking_speed alias "u0": PerAgent<R> = 1.0, "u0_i", "length/time", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 1.0, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for Gueron1996<R> {
    const CARD: Card = Card {
        id: "gueron_1996",
        title: "Gueron et al. 1996",
        about: "Members turn away from a crowded side, wait for those behind, and hurry after those ahead.",
        reference: "S. Gueron, S. A. Levin, D. I. Rubenstein (1996). The dynamics of herds: from individuals to aggregations. \
                    Journal of Theoretical Biology 182, 85-98",
        equations: "sectors by phi: F |phi| <= front; LF, RF up to 90 deg; LB, RB beyond;  L = LF or LB, R = RF or RB\n\
                    any in stress:  theta' = theta - 90 deg if L and not R; theta + 90 deg if R and not L; else theta\n\
                    u = u0 if one-sided; else 0 if LF and RF; else u0/w if F; else u0 w if LB and RB, not LF, RF; else u0\n\
                    else any in neutral or attraction:  all behind (|phi| > 90 deg): theta, u0/w;\n\
                    some in neutral: theta, u0;  only attraction: theta' = angle(sum_front e_ij), u = u0 w\n\
                    else theta, u0;  v_i' = u h(theta');  x_i' = x_i + v_i' Dt",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, half the diagonal of the attraction box); of these by closed boxes \
                        about the body, each member to the smallest that holds it",
            motion: "heading and speed by cases",
            physics: "ideal",
            obstacles: "",
        },
        departures: "factors apply to the own walking speed, where the table multiplies the present speed (a stop would be for \
                     ever); sector limits, the front sector together with one side, diagonal pairs and the outer boxes are \
                     interpretation; the table's seven rows come out exactly",
        edge: "coincident: in front; 180 deg counts as LB; zero sum of those in front: the heading is kept; a member that \
               stands keeps its orientation theta",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Heterogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::Member,
            identification: false,
            uses: [true, false, false],
            validation: "S",
            synchronous: true,
            information: [Information::Local, Information::Global, Information::Global],
            environment: "unbounded free",
        },
    };
    fn columns() -> &'static [Column] {
        &[facing::THETA]
    }
    fn needs(&self) -> Needs {
        Needs::default()
    }
    fn time_step(&self) -> R {
        self.time_step
    }
    fn initial_speed(&self) -> R {
        self.walking_speed.of(0).copied().unwrap_or(R::ZERO)
    }
    fn check(&self, members: usize) -> Result<(), String> {
        let boxes = [&self.stress_box, &self.neutral_box, &self.attraction_box];
        if boxes.iter().any(|half| half.len() != 2) {
            return Err("each box needs two half-lengths, along and across the heading".into());
        }
        if boxes.windows(2).any(|pair| pair[0].iter().zip(pair[1]).any(|(inner, outer)| inner > outer)) {
            return Err("the stress box must lie in the neutral box, and that in the attraction box".into());
        }
        match self.walking_speed.count() {
            Some(count) if count != members => Err(format!("{count} walking speeds for {members} members")),
            _ => Ok(()),
        }
    }
}

/// What a member can do, by number.
const CASES: [&str; 6] = ["turn away", "stop", "slow down", "speed up", "approach", "walk on"];
const TURN_AWAY: usize = 0;
const STOP: usize = 1;
const SLOW_DOWN: usize = 2;
const SPEED_UP: usize = 3;
const APPROACH: usize = 4;
const WALK_ON: usize = 5;

/// Who stands in a box about the body, by sector.
#[derive(Clone, Copy, Default)]
struct Sectors {
    front: bool,
    left_front: bool,
    right_front: bool,
    left_back: bool,
    right_back: bool,
}

impl<R: Scalar> Model<R, 2> for Gueron1996<R> {
    fn sets(&self) -> Vec<NamedSet<R, 2>> {
        let corner = self.attraction_box.iter().map(|half| half.squared()).sum::<R>().root();
        // the box is closed: a little more than its corner
        let reach = corner * R::of(1.000_001) + R::TINY;
        vec![NamedSet::new("neighbours", Perception::distance(R::ZERO, reach))]
    }
    fn complete(&self, start: &mut Start<'_, R, 2>) {
        facing::complete(start, self.walking_speed.of(start.member).copied().unwrap_or(R::ZERO));
    }
    fn decide(&self, me: &mut Me<'_, R, 2>, seen: &Percepts<'_, R, 2>, _: &Draws<'_>) -> Motion<R, 2> {
        let theta = me.own[0];
        let ahead: Vector<R, 2> = Vector::at_angle(theta);
        let (front, quarter) = (self.front_half_angle.radians(), R::PI * R::HALF);
        let mut stress: Option<Sectors> = None;
        let (mut outer, mut neutral, mut before, mut towards) = (false, false, false, Vector::ZERO);
        for j in seen.set(0) {
            let offset = seen.offset(j);
            let (along, across) = (offset.dot(ahead).abs(), offset.dot(ahead.left()).abs());
            let within = |half: &[R]| along <= half[0] && across <= half[1];
            if !within(&self.attraction_box) {
                continue;
            }
            let bearing = if offset.is_tiny() { R::ZERO } else { (offset.angle() - theta).wrapped() };
            if within(&self.stress_box) {
                let sectors = stress.get_or_insert_default();
                *match (bearing.abs() <= front, bearing.abs() <= quarter, bearing > R::ZERO) {
                    (true, ..) => &mut sectors.front,
                    (_, true, true) => &mut sectors.left_front,
                    (_, true, false) => &mut sectors.right_front,
                    (_, false, true) => &mut sectors.left_back,
                    (_, false, false) => &mut sectors.right_back,
                } = true;
                continue;
            }
            outer = true;
            neutral |= within(&self.neutral_box);
            if bearing.abs() <= quarter {
                before = true;
                towards += seen.direction(j);
            }
        }
        let own = self.walking_speed.of(me.member()).copied().unwrap_or(R::ZERO);
        let (case, turned, speed) = if let Some(s) = stress {
            match (s.left_front || s.left_back, s.right_front || s.right_back) {
                (true, false) => (TURN_AWAY, (theta - quarter).wrapped(), own),
                (false, true) => (TURN_AWAY, (theta + quarter).wrapped(), own),
                _ if s.left_front && s.right_front => (STOP, theta, R::ZERO),
                _ if s.front => (SLOW_DOWN, theta, own / self.speed_factor),
                _ if s.left_back && s.right_back && !(s.left_front || s.right_front) => {
                    (SPEED_UP, theta, own * self.speed_factor)
                }
                _ => (WALK_ON, theta, own),
            }
        } else if outer && !before {
            (SLOW_DOWN, theta, own / self.speed_factor)
        } else if outer && !neutral {
            (APPROACH, if towards.is_tiny() { theta } else { towards.angle() }, own * self.speed_factor)
        } else {
            (WALK_ON, theta, own)
        };
        me.own[0] = turned;
        let velocity = Vector::at_angle(turned) * speed;
        me.unit("length/time");
        me.note(CASES[case], velocity);
        me.sum(velocity);
        me.either(CASES, case);
        Motion::new_velocity(velocity, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    /// Velocity and orientation of a member at the origin that heads along x, with others at these places.
    #[track_caller]
    fn expect(others: &[[f64; 2]], velocity: [f64; 2], degrees: f64) {
        let mut agents = vec![([0.0, 0.0], [1.0, 0.0])];
        agents.extend(others.iter().map(|&place| (place, [1.0, 0.0])));
        let w = Oracle::new("gueron_1996").step(&agents);
        close(w.velocity(0), velocity);
        close(w.position(0), velocity);
        let theta = w.state(0, "theta").unwrap_or(f64::NAN);
        assert!((theta - degrees.to_radians()).abs() < 1e-12, "{theta}");
    }

    const F: [f64; 2] = [0.9, 0.1];
    const LF: [f64; 2] = [0.5, 0.5];
    const RF: [f64; 2] = [0.5, -0.5];
    const LB: [f64; 2] = [-0.5, 0.5];
    const RB: [f64; 2] = [-0.5, -0.5];

    #[test]
    fn the_stress_box_row_by_row() {
        expect(&[LF], [0.0, -1.0], -90.0);
        expect(&[LB], [0.0, -1.0], -90.0);
        expect(&[RF, F], [0.0, 1.0], 90.0);
        expect(&[RB], [0.0, 1.0], 90.0);
        expect(&[LF, RF, F], [0.0, 0.0], 0.0);
        expect(&[F], [1.0 / 1.5, 0.0], 0.0);
        expect(&[LB, RB], [1.5, 0.0], 0.0);
        expect(&[LB, RB, F], [1.0 / 1.5, 0.0], 0.0);
        expect(&[LF, RB], [1.0, 0.0], 0.0);
        // right behind counts as left, at the side as ahead, coincident as front; the box is closed
        expect(&[[-1.0, 0.0]], [0.0, -1.0], -90.0);
        expect(&[[0.0, 1.0], RF], [0.0, 0.0], 0.0);
        expect(&[[0.0, 0.0]], [1.0 / 1.5, 0.0], 0.0);
    }

    #[test]
    fn the_outer_boxes() {
        expect(&[], [1.0, 0.0], 0.0);
        expect(&[[2.0, 1.0]], [1.0, 0.0], 0.0);
        expect(&[[-2.0, 1.0]], [1.0 / 1.5, 0.0], 0.0);
        expect(&[[-2.0, 1.0], [-7.0, 1.0]], [1.0 / 1.5, 0.0], 0.0);
        expect(&[[5.0, 5.0]], [1.5 * 0.5f64.sqrt(), 1.5 * 0.5f64.sqrt()], 45.0);
        // those behind do not draw, the sum of opposite sides is nothing, and beyond the box nobody is
        expect(&[[5.0, 5.0], [-5.0, 5.0]], [1.5 * 0.5f64.sqrt(), 1.5 * 0.5f64.sqrt()], 45.0);
        expect(&[[0.0, 5.0], [0.0, -5.0]], [1.5, 0.0], 0.0);
        expect(&[[8.0, 8.0]], [1.5 * 0.5f64.sqrt(), 1.5 * 0.5f64.sqrt()], 45.0);
        expect(&[[8.1, 0.0]], [1.0, 0.0], 0.0);
    }

    #[test]
    fn who_stands_keeps_its_orientation_and_its_own_speed() {
        let mut w = Oracle::new("gueron_1996").set("u0", [2.0, 0.0, 0.0]).world(&[
            ([0.0, 0.0], [0.0, 1.0]),
            ([0.6, 0.6], [0.0, 1.0]),
            ([-0.6, 0.6], [0.0, 1.0]),
        ]);
        w.step();
        close(w.velocity(0), [0.0, 0.0]);
        assert_eq!(w.state(0, "theta"), Some(core::f64::consts::FRAC_PI_2));
        w.step();
        close(w.position(0), [0.0, 0.0]);
    }
}
