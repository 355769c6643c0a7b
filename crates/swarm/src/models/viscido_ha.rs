//! Everyone heads for the line through its nearest neighbour and that one's nearest other (Hamilton's rule in the plane).
//!
//! S. V. Viscido, M. Miller, D. S. Wethey (2002), The dilemma of the selfish herd: the search for a realistic movement rule,
//! Journal of Theoretical Biology 217:183 (Hamilton's rule).

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::{Space, Vector};

parameters! {
    /// Parameters of `viscido_ha`.
    pub struct ViscidoHa {
        /// Distance moved per update.
        step_length alias "step": R = 1.0, "l", "body length", NonNegative, Source;
        /// Distance from the nearest member at which its line is reached, and within which a member steps aside.
        repulsion_distance alias "r_rep": R = 2.0, "r_rho", "length", NonNegative, Source;
    }
}

impl<R: Scalar> Law<R> for ViscidoHa<R> {
    const CARD: Card = Card {
        id: "viscido_ha",
        title: "Viscido et al. 2002, Hamilton's rule",
        about: "Members step towards a point between their nearest neighbour and that one's nearest other, or aside when near.",
        reference: "S. V. Viscido, M. Miller, D. S. Wethey (2002). The dilemma of the selfish herd: the search for a \
                    realistic movement rule. Journal of Theoretical Biology 217, 183-194. doi:10.1006/jtbi.2002.3025",
        equations: "k = nearest(I);  l = nearest to k in I without k;  w = x_k + r_rho e_kl\n\
                    x_i' = x_i + l unit(w - x_i)  if rho_ik > r_rho\n\
                    x_i' = x_i + l sign_i perp(e_kl)  otherwise",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = all; of these the nearest and the nearest to that one",
            motion: "target point",
            physics: "ideal",
            obstacles: "",
        },
        departures: "the way-point lies at the repulsion distance from the nearest member (the prose), not one unit from the \
                     second (the table); the perpendicular is that of the line, not of a position; the second is never the \
                     member itself",
        edge: "fewer than two others: stays; k and l coincident: the way-point is x_k, and a near member stays",
        random: &[RandomQuantity { name: "sign", about: "side, +1 or -1 with equal chance; behaviour slot 0" }],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::None,
            identification: false,
            uses: [true, false, false],
            validation: "S",
            synchronous: true,
            information: [Information::Global, Information::None, Information::None],
            environment: "bounded free",
        },
    };
    fn needs(&self) -> Needs {
        Needs::default()
    }
    fn velocity_is_step(&self) -> bool {
        true
    }
}

/// The displacement from percept `first` to the percept of set 0 nearest to it among those farther from it than `beyond`.
pub(super) fn to_second<R: Scalar, const D: usize>(
    seen: &Percepts<'_, R, D>,
    space: &Space<R, D>,
    first: usize,
    beyond: R,
) -> Option<Vector<R, D>> {
    let mut best: Option<(R, u32, Vector<R, D>)> = None;
    for j in seen.set(0).filter(|&j| j != first) {
        let offset = space.minimal(seen.offset(j) - seen.offset(first));
        let (squared, id) = (offset.length_squared(), seen.id(j));
        if best.is_none_or(|(s, i, _)| (squared, id) < (s, i)) && squared.root() > beyond {
            best = Some((squared, id, offset));
        }
    }
    best.map(|(.., offset)| offset)
}

/// The side to which a member steps.
pub(super) fn side<R: Scalar>(draws: &Draws<'_>) -> R {
    draws.number("sign", 1.0, |s| if s.uniform(0) < 0.5 { -1.0 } else { 1.0 })
}

/// What a member can do: step to the way-point, aside, or not at all.
const ZONES: [&str; 3] = ["approach", "aside", "stay"];

impl<R: Scalar> Model<R, 2> for ViscidoHa<R> {
    fn sets(&self) -> Vec<NamedSet<R, 2>> {
        vec![NamedSet::new("neighbours", Perception::All)]
    }
    fn decide(&self, me: &mut Me<'_, R, 2>, seen: &Percepts<'_, R, 2>, draws: &Draws<'_>) -> Motion<R, 2> {
        let nearest = seen.nearest(0);
        let pair = nearest.and_then(|k| Some((k, to_second(seen, me.around.space, k, -R::ONE)?.unit())));
        me.unit("length");
        let Some((k, line)) = pair else {
            me.note("stay", Vector::ZERO);
            me.either(ZONES, 2);
            return Motion::step(Vector::ZERO);
        };
        let far = seen.distance(k) > self.repulsion_distance;
        me.either(ZONES, usize::from(!far));
        let step = if far {
            let along = line * self.repulsion_distance;
            let way_point = seen.offset(k) + along;
            me.note("nearest", seen.offset(k));
            me.note("beside it", along);
            me.sum(way_point);
            way_point.unit() * self.step_length
        } else {
            let side = side::<R>(draws);
            let aside = line.left() * (side * self.step_length);
            me.note("aside", aside);
            me.sum(aside);
            me.value("side", side, "1");
            aside
        };
        Motion::step(step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    const REST: [f64; 2] = [0.0, 0.0];

    #[test]
    fn worked_example_of_the_family() {
        let w = Oracle::new("viscido_ha").step(&[([0.0, 0.0], REST), ([3.0, 0.0], REST), ([3.0, 4.0], REST)]);
        close(w.position(0), [0.832050, 0.554700]);
        close(w.velocity(1), [-0.747409, 0.664364]);
        close(w.velocity(2), [-0.447214, -0.894427]);
    }

    #[test]
    fn three_on_a_line_have_their_way_points_behind_the_nearest() {
        let place = |x| ([x, 0.0], REST);
        let w = Oracle::new("viscido_ha").set("step", 5.0).step(&[place(0.0), place(3.0), place(6.0)]);
        // the way-points are 5 and 1, and the step is never shortened
        close(w.position(0), [5.0, 0.0]);
        close(w.position(2), [1.0, 0.0]);
        // on a tie the lower index is the nearest: from 3 to 0, whose nearest other is 6, way-point 2
        close(w.position(1), [-2.0, 0.0]);
    }

    #[test]
    fn near_members_step_aside_and_pairs_stay() {
        let close_by = [([0.0, 0.0], REST), ([1.0, 0.0], REST), ([4.0, 0.0], REST)];
        let w = Oracle::new("viscido_ha").inject("sign", &[1.0, -1.0, 1.0]).step(&close_by);
        close(w.position(0), [0.0, 1.0]);
        close(w.position(1), [1.0, -1.0]);
        let w = Oracle::new("viscido_ha").step(&close_by[1..]);
        close(w.position(0), [1.0, 0.0]);
        // k and l coincide: far from them straight there, near them no side is defined
        let w = Oracle::new("viscido_ha").step(&[([5.0, 0.0], REST), ([0.0, 0.0], REST), ([0.0, 0.0], REST)]);
        close(w.position(0), [4.0, 0.0]);
        let w = Oracle::new("viscido_ha").step(&[([1.0, 0.0], REST), ([0.0, 0.0], REST), ([0.0, 0.0], REST)]);
        close(w.position(0), [1.0, 0.0]);
    }
}
