//! `segregate`: the types are sorted into the regions of the setting.

use super::{BehaviourCard, BehaviourError, BehaviourParameter, Condition, Score, Setting, Signal, Values};

pub(super) const CARD: BehaviourCard = BehaviourCard {
    id: "segregate",
    title: "Segregation by type",
    definition: "purity of the regions at the end, if all members stay placed in some region for `hold` steps in a row; otherwise 0",
    source: "named by the source; the fitness is a decision of ours",
    needs: &["regions"],
    parameters: &[BehaviourParameter {
        name: "hold",
        unit: "steps",
        default: 10.0,
        about: "Steps in a row for which all must be placed.",
    }],
};

pub(super) fn score(values: &Values, setting: &Setting) -> Result<Score, BehaviourError> {
    let regions = || setting.regions.iter().map(|(_, region)| region.clone()).collect::<Vec<_>>();
    let placed = Condition::at_least(Signal::SharePlaced(regions()), 1.0).sustained(values.steps("hold"));
    Ok(Score::Product(vec![Score::Binary(placed), Score::Share(Signal::Purity(regions()))]))
}
