//! Hamilton's rule for robots: the second input must be farther from the first than an exclusion distance, and with too few
//! inputs the rule falls back to the nearest neighbour, then to the previous command.
//!
//! B. T. Fine, D. A. Shell (2011), Flocking: don't need no stink'n robot recognition, algorithm 2.

use crate::card::*;
use crate::models::viscido_ha::{side, to_second};
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::{Column, ColumnKind, Vector};

parameters! {
    /// Parameters of `ha_extended`.
    pub struct HaExtended {
        /// Distance moved per update.
        step_length alias "step": R = 1.0, "l", "body length", NonNegative, Source;
        /// Distance from the first input at which its line is reached, and within which a member steps aside.
        repulsion_distance alias "r_rep": R = 2.0, "r_rho", "length", NonNegative, Source;
        /// Distance from the first input beyond which the second is chosen.
        exclusion_distance alias "exclusion": R = 0.5, "ed", "length", NonNegative, Source;
        /// Distance below which inputs count.
        range: R = 1e9, "beta", "length", Positive, Ours;
    }
}

/// The previous motor command is kept.
const KEEP: usize = 0;
/// Towards the first input.
const SNN: usize = 1;
/// Towards the way-point.
const HA: usize = 2;
/// Aside.
const HA_PERP: usize = 3;

impl<R: Scalar> Law<R> for HaExtended<R> {
    const CARD: Card = Card {
        id: "ha_extended",
        title: "Fine and Shell 2011, extended Hamilton's rule",
        about: "Robots step towards a point between the nearest input and the next one outside its exclusion distance, and \
                keep on where they see nobody.",
        reference: "B. T. Fine, D. A. Shell (2011). Flocking: don't need no stink'n robot recognition. IEEE/RSJ, algorithm 2; \
                    also in B. T. Fine (2015). Constructing geometries for group control",
        equations: "a1 = nearest(I);  a2 = nearest to a1 among the inputs farther than ed from a1\n\
                    |I| = 0:  x' = x + v  (KEEP)\n\
                    no a2:  x' = x + l e_a1  if rho_a1 > r_rho, else x  (SNN)\n\
                    rho_a1 > r_rho:  x' = x + l unit(x_a1 + r_rho e_12 - x)  (HA)\n\
                    otherwise:  x' = x + l sign_i perp(e_12)  (HA_PERP)",
        stages: Stages {
            sensing: "range-finder or ideal",
            detection: "any: members or raw readings",
            selection: "inputs = distance_based(0, range); of these the nearest and the one nearest to it beyond ed",
            motion: "target point",
            physics: "ideal, or differential drive",
            obstacles: "",
        },
        departures: "the second input is the nearest among the far ones (the text); the algorithm picks the plain nearest and \
                     only tests whether a far one exists",
        edge: "none within range: the previous displacement again; one input, or all within ed of the first: nearest \
               neighbour; the first input itself is never the second",
        random: &[RandomQuantity { name: "sign", about: "side, +1 or -1 with equal chance; behaviour slot 0" }],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: false,
            discrete: true,
            avoidance: Avoidance::None,
            identification: false,
            uses: [true, false, false],
            validation: "P",
            synchronous: false,
            information: [Information::Local, Information::None, Information::None],
            environment: "bounded free",
        },
    };
    fn columns() -> &'static [Column] {
        const fn length(name: &'static str, about: &'static str) -> Column {
            Column { name, unit: "length", kind: ColumnKind::Quantity, about }
        }
        const COLUMNS: &[Column] = &[
            Column {
                name: "mode",
                unit: "1",
                kind: ColumnKind::Label(&["KEEP", "SNN", "HA", "HA_PERP"]),
                about: "Branch of the rule that made the last step.",
            },
            length("way_point_ahead", "The last way-point in the member's own frame: how far ahead."),
            length("way_point_left", "How far to the left."),
            length("nearest_ahead", "The nearest input of that decision in the same frame: how far ahead."),
            length("nearest_left", "How far to the left; both 0 where there was none."),
        ];
        COLUMNS
    }
    fn needs(&self) -> Needs {
        Needs::default()
    }
}

impl<R: Scalar> Model<R, 2> for HaExtended<R> {
    fn sets(&self) -> Vec<NamedSet<R, 2>> {
        vec![NamedSet::new("inputs", Perception::distance(R::ZERO, self.range))]
    }
    fn decide(&self, me: &mut Me<'_, R, 2>, seen: &Percepts<'_, R, 2>, draws: &Draws<'_>) -> Motion<R, 2> {
        let first = seen.nearest(0);
        let (mode, step) = match first {
            None => (KEEP, me.velocity),
            Some(first) => {
                let far = seen.distance(first) > self.repulsion_distance;
                match to_second(seen, me.around.space, first, self.exclusion_distance).map(Vector::unit) {
                    None if far => (SNN, seen.direction(first) * self.step_length),
                    None => (SNN, Vector::ZERO),
                    Some(line) if far => {
                        let along = line * self.repulsion_distance;
                        let way_point = seen.offset(first) + along;
                        me.note("first input", seen.offset(first));
                        me.note("beside it", along);
                        me.sum(way_point);
                        (HA, way_point.unit() * self.step_length)
                    }
                    Some(line) => {
                        let side = side::<R>(draws);
                        me.value("side", side, "1");
                        (HA_PERP, line.left() * (side * self.step_length))
                    }
                }
            }
        };
        me.own[0] = R::count(mode);
        let ahead = me.ahead();
        let nearest = first.map_or(Vector::ZERO, |first| seen.offset(first));
        for (k, vector) in [(1, step), (3, nearest)] {
            me.own[k] = vector.dot(ahead);
            me.own[k + 1] = vector.dot(ahead.left());
        }
        me.unit("length");
        if mode != HA {
            me.note(["previous step", "towards the first input", "", "aside"][mode], step);
            me.sum(step);
        }
        me.either(["KEEP", "SNN", "HA", "HA_PERP"], mode);
        Motion::step(step)
    }
}

#[cfg(test)]
mod tests {
    use super::{HA, HA_PERP, KEEP, SNN};
    use crate::models::oracle::{Oracle, close};

    const REST: [f64; 2] = [0.0, 0.0];

    #[test]
    fn worked_example_of_the_catalogue() {
        let w = Oracle::new("ha_extended").step(&[([0.0, 0.0], REST), ([3.0, 0.0], REST), ([3.0, 4.0], REST)]);
        close(w.velocity(0), [0.832050, 0.554700]);
        close(w.velocity(1), [-0.747409, 0.664364]);
        close(w.velocity(2), [-0.447214, -0.894427]);
        for id in 0..3 {
            assert_eq!(w.state(id, "mode"), Some(HA as f64));
        }
    }

    #[test]
    fn the_four_modes() {
        let mode = |w: &crate::World<f64, 2>, id| w.state(id, "mode").map(|m| m as usize);
        // nobody within range: the previous displacement once more
        let w = Oracle::new("ha_extended").set("range", 3.0).step(&[([0.0, 0.0], [0.3, 0.1]), ([9.0, 0.0], REST)]);
        close(w.position(0), [0.3, 0.1]);
        assert_eq!(mode(&w, 0), Some(KEEP));
        // the third is within the exclusion distance of the second, exactly: nearest neighbour, and none when near
        let inputs = [([0.0, 0.0], REST), ([3.0, 0.0], REST), ([3.0, 0.5], REST)];
        let w = Oracle::new("ha_extended").step(&inputs);
        close(w.position(0), [1.0, 0.0]);
        assert_eq!(mode(&w, 0), Some(SNN));
        let w = Oracle::new("ha_extended").set("r_rep", 3.0).step(&inputs);
        close(w.position(0), [0.0, 0.0]);
        assert_eq!(mode(&w, 0), Some(SNN));
        // near, and the second beyond the exclusion distance: aside
        let w = Oracle::new("ha_extended").set("r_rep", 3.0).set("exclusion", 0.4).step(&inputs);
        close(w.position(0), [-1.0, 0.0]);
        assert_eq!(mode(&w, 0), Some(HA_PERP));
    }

    #[test]
    fn way_points_and_nearest_inputs_are_kept_in_the_own_frame() {
        // headed up: an input to the right is ahead by nothing and to the left by less than nothing
        let w = Oracle::new("ha_extended").step(&[([0.0, 0.0], [0.0, 0.4]), ([3.0, 1.0], REST)]);
        let kept = ["way_point_ahead", "way_point_left", "nearest_ahead", "nearest_left"].map(|name| w.state(0, name));
        let length = 10f64.sqrt();
        for (found, expected) in kept.into_iter().zip([1.0 / length, -3.0 / length, 1.0, -3.0]) {
            assert!((found.unwrap_or(f64::NAN) - expected).abs() < 1e-12, "{kept:?}");
        }
    }

    #[test]
    fn the_second_input_is_the_nearest_of_the_far_ones() {
        // from 0: first at 4, another 0.3 beside it, a far one 2 above it
        let w = Oracle::new("ha_extended").step(&[
            ([0.0, 0.0], REST),
            ([4.0, 0.0], REST),
            ([4.3, 0.0], REST),
            ([4.0, 2.0], REST),
        ]);
        close(w.position(0), [4.0 / 20f64.sqrt(), 2.0 / 20f64.sqrt()]);
    }
}
