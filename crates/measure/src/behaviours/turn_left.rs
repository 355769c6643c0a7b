//! `turn-left`: the group leaves through the gate on the left.

use super::{BehaviourCard, BehaviourError, Score, Setting, Values};

pub(super) const CARD: BehaviourCard = BehaviourCard {
    id: "turn-left",
    title: "Turn left",
    definition: "at least `share` of the members have crossed the gate `left` within `horizon` steps; crossing back does not undo it",
    source: "the mirror image of turn-right, for diagnosis",
    needs: &["gate left"],
    parameters: super::turn_right::CARD.parameters,
};

pub(super) fn score(values: &Values, setting: &Setting) -> Result<Score, BehaviourError> {
    super::turn_right::turn(values, setting, "left")
}
