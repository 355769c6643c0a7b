//! `avoid`: the members keep out of a region.

use super::{BehaviourCard, BehaviourError, Bound, Score, Setting, Signal, Values};

pub(super) const CARD: BehaviourCard = BehaviourCard {
    id: "avoid",
    title: "Avoidance of a region",
    definition: "share of the members that have never been in the region `avoid`",
    source: "named by the source; the fitness is a decision of ours",
    needs: &["region avoid"],
    parameters: &[],
};

pub(super) fn score(_: &Values, setting: &Setting) -> Result<Score, BehaviourError> {
    let visited = Signal::ShareVisited(setting.region("avoid")?);
    Ok(Score::Ramp { signal: visited, worst: Bound::Number(1.0), best: Bound::Number(0.0) })
}
