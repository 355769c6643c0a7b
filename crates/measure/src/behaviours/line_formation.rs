//! `line-formation`: the members stand in a line.

use super::{BehaviourCard, BehaviourError, Score, Setting, Signal, Values};

pub(super) const CARD: BehaviourCard = BehaviourCard {
    id: "line-formation",
    title: "Line formation",
    definition: "1 - second over first standard deviation along the principal axes, at the end",
    source: "named by the source; the ratio is a decision of ours",
    needs: &[],
    parameters: &[],
};

pub(super) fn score(_: &Values, _: &Setting) -> Result<Score, BehaviourError> {
    Ok(Score::Share(Signal::Line))
}
