//! `balanced-split`: the group falls into parts of comparable size.

use super::{BehaviourCard, BehaviourError, BehaviourParameter, Condition, Membership, Score, Setting, Signal, Values};

pub(super) const CARD: BehaviourCard = BehaviourCard {
    id: "balanced-split",
    title: "Balanced split",
    definition: "at least two groups with an entropy ratio of at least `fraction`, in `hold` steps in a row, within `horizon` steps",
    source: "the source's table 6.1, which does not define its 30 %: here of the entropy of equal groups",
    needs: &[],
    parameters: &[
        BehaviourParameter {
            name: "distance",
            unit: "length",
            default: 25.0,
            about: "Members at most so far apart are linked.",
        },
        BehaviourParameter {
            name: "fraction",
            unit: "1",
            default: 0.3,
            about: "Least entropy of the shares over that of equal shares.",
        },
        BehaviourParameter { name: "hold", unit: "steps", default: 5.0, about: "Steps in a row." },
        BehaviourParameter {
            name: "horizon",
            unit: "steps",
            default: 200.0,
            about: "Steps within which they must be complete.",
        },
    ],
};

pub(super) fn score(values: &Values, _: &Setting) -> Result<Score, BehaviourError> {
    let groups = || Membership::within(values.of("distance"));
    let two = Condition::at_least(Signal::GroupCount(groups()), 2.0);
    let balanced = two.and(Condition::at_least(Signal::EntropyRatio(groups()), values.of("fraction")));
    Ok(Score::Binary(balanced.sustained(values.steps("hold")).within(values.steps("horizon"))))
}
