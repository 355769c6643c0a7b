//! `corralling`: the group stays together at a place.

use super::{BehaviourCard, BehaviourError, BehaviourParameter, Condition, Membership, Score, Setting, Signal, Values};

pub(super) const CARD: BehaviourCard = BehaviourCard {
    id: "corralling",
    title: "Corralling",
    definition: "centroid within `radius` of the place `marker`, and the largest group at least `connected` of all, in `hold` steps in a row, within `horizon` steps",
    source: "the source's table 6.1; with connected = 2/3 its section 7.3, the centroid over all members",
    needs: &["place marker"],
    parameters: &[
        BehaviourParameter {
            name: "radius",
            unit: "length",
            default: 25.0,
            about: "Greatest distance of the centroid to the marker.",
        },
        BehaviourParameter {
            name: "distance",
            unit: "length",
            default: 25.0,
            about: "Members at most so far apart are linked.",
        },
        BehaviourParameter { name: "connected", unit: "1", default: 1.0, about: "Least share of the largest group." },
        BehaviourParameter { name: "hold", unit: "steps", default: 50.0, about: "Steps in a row." },
        BehaviourParameter {
            name: "horizon",
            unit: "steps",
            default: 500.0,
            about: "Steps within which they must be complete.",
        },
    ],
};

pub(super) fn score(values: &Values, setting: &Setting) -> Result<Score, BehaviourError> {
    let near = Condition::at_most(Signal::CentroidDistance(setting.place("marker")?), values.of("radius"));
    let largest = Signal::LargestShare(Membership::within(values.of("distance")));
    let corralled = near.and(Condition::at_least(largest, values.of("connected")));
    Ok(Score::Binary(corralled.sustained(values.steps("hold")).within(values.steps("horizon"))))
}
