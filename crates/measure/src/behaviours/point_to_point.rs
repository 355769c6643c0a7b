//! `point-to-point`: the members reach a region.

use super::{BehaviourCard, BehaviourError, Score, Setting, Signal, Values};

pub(super) const CARD: BehaviourCard = BehaviourCard {
    id: "point-to-point",
    title: "Point to point",
    definition: "share of the members that have been in the region `goal`",
    source: "named by the source; the fitness is a decision of ours",
    needs: &["region goal"],
    parameters: &[],
};

pub(super) fn score(_: &Values, setting: &Setting) -> Result<Score, BehaviourError> {
    Ok(Score::Share(Signal::ShareVisited(setting.region("goal")?)))
}
