//! `throughput`: the members pass a gate.

use super::{BehaviourCard, BehaviourError, Score, Setting, Signal, Values};

pub(super) const CARD: BehaviourCard = BehaviourCard {
    id: "throughput",
    title: "Throughput of a gate",
    definition: "share of the members that have crossed the gate `exit`",
    source: "named by the source; the fitness is a decision of ours",
    needs: &["gate exit"],
    parameters: &[],
};

pub(super) fn score(_: &Values, setting: &Setting) -> Result<Score, BehaviourError> {
    Ok(Score::Share(Signal::ShareCrossed(setting.gate("exit")?, None)))
}
