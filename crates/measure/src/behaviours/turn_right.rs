//! `turn-right`: the group leaves through the gate on the right. What is said of any gate is here too.

use super::{BehaviourCard, BehaviourError, BehaviourParameter, Condition, Score, Setting, Signal, Values};

pub(super) const CARD: BehaviourCard = BehaviourCard {
    id: "turn-right",
    title: "Turn right",
    definition: "at least `share` of the members have crossed the gate `right` within `horizon` steps; crossing back does not undo it",
    source: "the source's section 7.4.2; the horizon is a decision of ours",
    needs: &["gate right"],
    parameters: &[
        BehaviourParameter { name: "share", unit: "1", default: 0.9, about: "Least share." },
        BehaviourParameter {
            name: "horizon",
            unit: "steps",
            default: 220.0,
            about: "Steps within which they must have crossed.",
        },
    ],
};

pub(super) fn score(values: &Values, setting: &Setting) -> Result<Score, BehaviourError> {
    turn(values, setting, "right")
}

/// The group leaves through a gate.
pub(super) fn turn(values: &Values, setting: &Setting, gate: &str) -> Result<Score, BehaviourError> {
    let crossed = Signal::ShareCrossed(setting.gate(gate)?, None);
    Ok(Score::Binary(Condition::at_least(crossed, values.of("share")).within(values.steps("horizon"))))
}
