//! `trajectory`: the members follow a line of gates to a goal.

use super::{BehaviourCard, BehaviourError, BehaviourParameter, Score, Setting, Signal, Values};

pub(super) const CARD: BehaviourCard = BehaviourCard {
    id: "trajectory",
    title: "Trajectory",
    definition: "share of the members that crossed all gates of the setting, in their order, and then reached the region `goal` within `horizon` steps",
    source: "the source's section 8.2",
    needs: &["region goal"],
    parameters: &[BehaviourParameter {
        name: "horizon",
        unit: "steps",
        default: 900.0,
        about: "Steps within which the goal must be reached.",
    }],
};

pub(super) fn score(values: &Values, setting: &Setting) -> Result<Score, BehaviourError> {
    let gates = setting.gates.iter().map(|(_, gate)| *gate).collect();
    let (goal, within) = (setting.region("goal")?, values.steps("horizon"));
    Ok(Score::Share(Signal::ShareThrough { gates, goal, within }))
}
