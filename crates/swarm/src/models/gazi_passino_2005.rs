//! Members on a line keep their order and move towards the middle between their two neighbours, on old readings if need be.
//!
//! V. Gazi, K. M. Passino (2005), Stability of a one-dimensional discrete-time asynchronous swarm, IEEE Transactions on
//! Systems, Man, and Cybernetics B 35:834.

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;

parameters! {
    /// Parameters of `gazi_passino_2005`.
    pub struct GaziPassino2005 {
        /// Least spacing of neighbours.
        least_spacing alias "d": R = 0.5, "d", "length", NonNegative, Ours;
        /// Comfort distance, at which the last member follows its neighbour.
        comfort_distance alias "r": R = 1.0, "r", "length", NonNegative, Ours;
        /// Share of the way to the wanted place that is made in a step.
        gain: R = 0.5, "g", "1", NonNegative, Ours;
    }
}

impl<R: Scalar> Law<R> for GaziPassino2005<R> {
    const CARD: Card = Card {
        id: "gazi_passino_2005",
        title: "Gazi and Passino 2005",
        about: "Members on a line move towards the middle between their neighbours, the last one to the comfort distance from \
                its own.",
        reference: "V. Gazi, K. M. Passino (2005). Stability of a one-dimensional discrete-time asynchronous swarm. IEEE \
                    Transactions on Systems, Man, and Cybernetics, Part B 35 (4), 834-841",
        equations: "x_0' = x_0\n\
                    x_i' = max(x_{i-1} + d, min(x_i - g (x_i - (left + right)/2), x_{i+1} - d)),  0 < i < N-1\n\
                    x_n' = max(x_{n-1} + d, x_n - g (x_n - left - r)),  n = N-1\n\
                    v_i' = x_i' - x_i",
        stages: Stages {
            sensing: "ideal, readings may be old",
            detection: "ideal",
            selection: "neighbours = all; of these the members next in the initial order (index)",
            motion: "position",
            physics: "ideal",
            obstacles: "",
        },
        departures: "the bound on the right uses the right neighbour, where the table repeats the left one",
        edge: "one member: stays; two: the last one's rule; a neighbour that is not sensed is taken where it is. Bounds use \
               the true places. Order and least spacing are certain only where no two adjacent members move at the same time \
               (synchronously without delays order needs a gain of at most 2/3)",
        random: &[
            RandomQuantity {
                name: "left",
                about: "last sensed position of the left neighbour; supplied only, else as perceived; no draw",
            },
            RandomQuantity {
                name: "right",
                about: "last sensed position of the right neighbour; supplied only, else as perceived; no draw",
            },
        ],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::None,
            identification: true,
            uses: [true, false, false],
            validation: "MS",
            synchronous: false,
            information: [Information::Global, Information::Global, Information::Global],
            environment: "unbounded free",
        },
    };
    fn needs(&self) -> Needs {
        Needs { identity: true, ..Needs::default() }
    }
}

impl<R: Scalar> Model<R, 1> for GaziPassino2005<R> {
    fn sets(&self) -> Vec<NamedSet<R, 1>> {
        vec![NamedSet::new("neighbours", Perception::All)]
    }
    fn decide(&self, me: &mut Me<'_, R, 1>, seen: &Percepts<'_, R, 1>, draws: &Draws<'_>) -> Motion<R, 1> {
        let (first, count) = me.around.group;
        me.unit("length");
        if me.id == first {
            me.note("the first stays", Vector::ZERO);
            return Motion::step(Vector::ZERO);
        }
        // everything below is relative to my own place
        let from_me = |place: Vector<R, 1>| me.around.space.offset(me.position, place)[0];
        let truly = |id: u32| from_me(me.around.truth.position(me.around.row_of(id)));
        let sensed = |name: &str, id: u32| match draws.given(name) {
            Some(place) => from_me(Vector([R::of(place)])),
            None => seen.set(0).find(|&k| seen.id(k) == id).map_or_else(|| truly(id), |k| seen.offset(k)[0]),
        };
        let left = sensed("left", me.id - 1);
        let lower = truly(me.id - 1) + self.least_spacing;
        let (parts, free, step) = if me.id - first + 1 < count {
            let right = sensed("right", me.id + 1);
            let upper = truly(me.id + 1) - self.least_spacing;
            let free = self.gain * ((left + right) * R::HALF);
            let share = |to: R| self.gain * to * R::HALF;
            ([("left", share(left)), ("right", share(right))], free, free.least(upper).most(lower))
        } else {
            let free = self.gain * (left + self.comfort_distance);
            let parts = [("left", self.gain * left), ("comfort distance", self.gain * self.comfort_distance)];
            (parts, free, free.most(lower))
        };
        for (name, part) in parts {
            me.note(name, Vector([part]));
        }
        me.note("bounds", Vector([step - free]));
        me.sum(Vector([step]));
        Motion::step(Vector([step]))
    }
}

#[cfg(test)]
mod tests {
    use crate::engine::Driver;
    use crate::engine::Order;
    use crate::models::oracle::{Oracle, close};

    fn at<const N: usize>(places: [f64; N]) -> [([f64; 1], [f64; 1]); N] {
        places.map(|x| ([x], [0.0]))
    }

    #[test]
    fn half_way_to_the_middle_within_the_bounds() {
        let w = Oracle::new("gazi_passino_2005").step(&at([0.0, 1.0, 4.0, 4.5, 9.0]));
        close(w.position(0), [0.0]);
        close(w.position(1), [1.5]);
        close(w.velocity(1), [0.5]);
        // the middle of 1 and 4.5 is 2.75, half way 3.375
        close(w.position(2), [3.375]);
        // half way to the middle of 4 and 9 is 5.5
        close(w.position(3), [5.5]);
        // the last: half way to 4.5 + 1
        close(w.position(4), [7.25]);
        // the right neighbour bounds a long way: half way to 10 is 5, but 0.9 - 0.5 is the bound; the left bound prevails
        let w = Oracle::new("gazi_passino_2005").inject("right", &[0.0, 20.0, 0.0]).step(&at([0.0, 0.6, 0.9]));
        close(w.position(1), [0.5]);
    }

    #[test]
    fn supplied_old_readings_move_but_true_places_bound() {
        let old = Oracle::new("gazi_passino_2005").inject("left", &[9.0, -8.0, 2.0]).inject("right", &[9.0, 8.0, 9.0]);
        let w = old.step(&at([0.0, 2.0, 5.0]));
        // half way from 2 to the middle of -8 and 8; half way from 5 to 2 + 1
        close(w.position(1), [1.0]);
        close(w.position(2), [4.0]);
        let w = Oracle::new("gazi_passino_2005").inject("left", &[0.0, -50.0]).step(&at([0.0, 2.0]));
        close(w.position(1), [0.5]);
    }

    #[test]
    fn gaps_converge_to_the_comfort_distance() {
        let mut w = Oracle::new("gazi_passino_2005")
            .driver(Driver::Sequential(Order::Random))
            .world(&at([0.0, 0.7, 4.0, 4.6, 9.0]));
        for _ in 0..400 {
            w.step();
            assert!((1..5).all(|i| w.position(i)[0] - w.position(i - 1)[0] >= 0.5 - 1e-12));
        }
        for i in 0..5 {
            close(w.position(i), [f64::from(i)]);
        }
        close(Oracle::new("gazi_passino_2005").step(&at([3.0])).position(0), [3.0]);
    }
}
