//! `simple-split`: the group falls into two or more.

use super::{BehaviourCard, BehaviourError, BehaviourParameter, Condition, Membership, Score, Setting, Signal, Values};

pub(super) const CARD: BehaviourCard = BehaviourCard {
    id: "simple-split",
    title: "Simple split",
    definition: "at least two groups in `hold` steps in a row, within `horizon` steps",
    source: "the source's table 6.1",
    needs: &[],
    parameters: &[
        BehaviourParameter {
            name: "distance",
            unit: "length",
            default: 25.0,
            about: "Members at most so far apart are linked.",
        },
        BehaviourParameter { name: "hold", unit: "steps", default: 50.0, about: "Steps in a row." },
        BehaviourParameter {
            name: "horizon",
            unit: "steps",
            default: 200.0,
            about: "Steps within which they must be complete.",
        },
    ],
};

pub(super) fn score(values: &Values, _: &Setting) -> Result<Score, BehaviourError> {
    let groups = Signal::GroupCount(Membership::within(values.of("distance")));
    let split = Condition::at_least(groups, 2.0).sustained(values.steps("hold"));
    Ok(Score::Binary(split.within(values.steps("horizon"))))
}
