//! `hold`: the members stay in a region.

use super::{BehaviourCard, BehaviourError, Score, Setting, Signal, Values};

pub(super) const CARD: BehaviourCard = BehaviourCard {
    id: "hold",
    title: "Staying in a region",
    definition: "share of the members in the region `goal`, averaged over all steps",
    source: "named by the source; the fitness is a decision of ours",
    needs: &["region goal"],
    parameters: &[],
};

pub(super) fn score(_: &Values, setting: &Setting) -> Result<Score, BehaviourError> {
    Ok(Score::Average(Signal::ShareIn(setting.region("goal")?)))
}
