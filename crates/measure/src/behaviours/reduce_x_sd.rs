//! `reduce-x-sd`: the group becomes narrower along x.

use super::{BehaviourCard, BehaviourError, Bound, Score, Setting, Signal, Values};

pub(super) const CARD: BehaviourCard = BehaviourCard {
    id: "reduce-x-sd",
    title: "Narrower along x",
    definition: "how far the standard deviation of x (divisor n - 1) has come from its value at the start towards 0",
    source: "the source's section 7.4.2; the divisor, and the ramp as fitness, are decisions of ours",
    needs: &[],
    parameters: &[],
};

pub(super) fn score(_: &Values, _: &Setting) -> Result<Score, BehaviourError> {
    Ok(Score::Ramp { signal: Signal::Deviation(0), worst: Bound::Initial, best: Bound::Number(0.0) })
}
