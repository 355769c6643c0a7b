//! `gather-and-sort`: the group is gathered, led through a chute, and sorted by type.

use super::{BehaviourCard, BehaviourError, BehaviourParameter, Condition, Membership, Score, Setting, Signal, Values};

pub(super) const CARD: BehaviourCard = BehaviourCard {
    id: "gather-and-sort",
    title: "Gather and sort",
    definition: "product over three stages: corralled at the place `marker`; then `share` of the members through the gate `chute`; then segregation into the regions. Each stage begins where the one before it came to hold",
    source: "the source's section 6.1.3; the stages' numbers are decisions of ours",
    needs: &["place marker", "gate chute", "regions"],
    parameters: &[
        BehaviourParameter {
            name: "radius",
            unit: "length",
            default: 25.0,
            about: "Greatest distance of the centroid to the marker while gathered.",
        },
        BehaviourParameter {
            name: "distance",
            unit: "length",
            default: 25.0,
            about: "Members at most so far apart are linked.",
        },
        BehaviourParameter { name: "share", unit: "1", default: 0.9, about: "Least share through the chute." },
        BehaviourParameter {
            name: "hold",
            unit: "steps",
            default: 10.0,
            about: "Steps in a row for which each stage must hold.",
        },
    ],
};

pub(super) fn score(values: &Values, setting: &Setting) -> Result<Score, BehaviourError> {
    let hold = values.steps("hold");
    let near = Condition::at_most(Signal::CentroidDistance(setting.place("marker")?), values.of("radius"));
    let one = Signal::LargestShare(Membership::within(values.of("distance")));
    let gathered = near.and(Condition::at_least(one, 1.0)).sustained(hold);
    let led = Condition::at_least(Signal::ShareCrossed(setting.gate("chute")?, None), values.of("share"));
    let led = gathered.clone().then(led);
    let regions: Vec<_> = setting.regions.iter().map(|(_, region)| region.clone()).collect();
    let placed = led.clone().then(Condition::at_least(Signal::SharePlaced(regions.clone()), 1.0).sustained(hold));
    let sorted = Score::Product(vec![Score::Binary(placed), Score::Share(Signal::Purity(regions))]);
    Ok(Score::Product(vec![Score::Binary(gathered), Score::Binary(led), sorted]))
}
