//! Everyone steps towards the others, the near ones weighing more: the local crowded horizon.
//!
//! S. V. Viscido, M. Miller, D. S. Wethey (2002), The dilemma of the selfish herd: the search for a realistic movement rule,
//! Journal of Theoretical Biology 217:183 (local crowded horizon, in its validated form).

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;
use space::lanes::{Lanes, Mask};

parameters! {
    /// Parameters of `viscido_lch`.
    pub struct ViscidoLch {
        /// Distance moved per update.
        step_length alias "step": R = 1.0, "l", "body length", NonNegative, Source;
        /// How fast the weight of others falls with their distance.
        decay alias "k": R = 0.375, "k", "1/length", NonNegative, Paper;
    }
}

impl<R: Scalar> Law<R> for ViscidoLch<R> {
    const CARD: Card = Card {
        id: "viscido_lch",
        title: "Viscido et al. 2002, local crowded horizon",
        about: "Members step towards all others, who weigh less the farther they are.",
        reference: "S. V. Viscido, M. Miller, D. S. Wethey (2002). The dilemma of the selfish herd: the search for a \
                    realistic movement rule. Journal of Theoretical Biology 217, 183-194. doi:10.1006/jtbi.2002.3025",
        equations: "x_i' = x_i + l unit( sum_{j in I} d_ij / (1 + k rho_ij) )",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = all",
            motion: "target point",
            physics: "ideal",
            obstacles: "",
        },
        departures: "the direction vectors of the table are read as full displacements (no hat is printed); k has the unit \
                     1/length",
        edge: "alone, or a balanced sum: stays",
        random: &[],
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

impl<R: Scalar, const D: usize> Stream<R, D> for ViscidoLch<R> {
    type Sums<L: Lanes<R>> = [L; D];
    const HEADINGS: bool = false;

    fn sets(&self) -> Vec<NamedSet<R, D>> {
        vec![NamedSet::new("neighbours", Perception::All)]
    }
    fn reach(&self) -> R {
        R::INFINITY
    }
    #[inline(always)]
    fn classify<L: Lanes<R>>(&self, _: &MeLanes<L, D>, _: &[L; D], _: L, _: &Other<'_, R, D>) -> SetMasks<L::Mask> {
        let [yes, no] = [true, false].map(L::Mask::all_of);
        [yes, no, no, no]
    }
    #[inline(always)]
    fn gather<L: Lanes<R>>(
        &self,
        crowd: &mut [L; D],
        _: &MeLanes<L, D>,
        offset: &[L; D],
        squared: L,
        _: &Other<'_, R, D>,
        sets: &SetMasks<L::Mask>,
    ) {
        let weight = L::splat(R::ONE) + squared.square_root() * L::splat(self.decay);
        add_where(crowd, sets[0], offset.map(|d| d / weight));
    }
    #[inline(always)]
    fn finish(&self, me: &mut Me<'_, R, D>, crowd: &[R; D], _: &Draws<'_>) -> Motion<R, D> {
        let crowd = Vector(*crowd);
        me.unit("length");
        me.note("crowd", crowd);
        me.sum(crowd);
        Motion::step(crowd.unit() * self.step_length)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    const REST: [f64; 2] = [0.0, 0.0];

    #[test]
    fn the_near_weigh_more() {
        // weights 1/(1 + 1) and 1/(1 + 3): (2, 0)/2 + (0, 6)/4 = (1, 1.5)
        let three = [([0.0, 0.0], REST), ([2.0, 0.0], REST), ([0.0, 6.0], REST)];
        let w = Oracle::new("viscido_lch").set("k", 0.5).step(&three);
        let length = 3.25f64.sqrt();
        close(w.position(0), [1.0 / length, 1.5 / length]);
        close(w.velocity(0), [1.0 / length, 1.5 / length]);
        // with k = 0 the way to the mean of the others
        let w = Oracle::new("viscido_lch").set("k", 0.0).set("step", 0.5).step(&three);
        close(w.position(0), [0.5 / 10f64.sqrt(), 1.5 / 10f64.sqrt()]);
    }

    #[test]
    fn a_balanced_sum_and_the_lone_stay() {
        let w = Oracle::new("viscido_lch").step(&[([0.0, 0.0], REST), ([2.0, 0.0], REST), ([-2.0, 0.0], REST)]);
        close(w.position(0), [0.0, 0.0]);
        close(Oracle::new("viscido_lch").step(&[([1.0, 2.0], REST)]).position(0), [1.0, 2.0]);
        let w = Oracle::new("viscido_lch").step(&[([0.0; 3], [0.0; 3]), ([0.0, 0.0, -4.0], [0.0; 3])]);
        close(w.position(0), [0.0, 0.0, -1.0]);
    }
}
