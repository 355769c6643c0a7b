//! Into how many groups the members have split. More than one: fragmented.

use crate::metric::takes;
use crate::{Bounds, Counted, EdgeCases, Metric, MetricCard, Parameter, Sample, Takes};

/// The fragmentation threshold: the parameter that all metrics of groups share.
pub const LINKING_DISTANCE: Parameter = Parameter {
    name: "linking_distance",
    unit: "length",
    default: Some(25.0),
    bounds: Bounds::Positive,
    about: "Members at most this far apart belong to one group (the fragmentation threshold).",
};

takes! {
    /// `group_count`.
    pub struct GroupCount { linking_distance: LINKING_DISTANCE }
}

impl Metric for GroupCount {
    const CARD: MetricCard = MetricCard {
        id: "group_count",
        title: "Number of groups",
        symbol: "G",
        unit: "1",
        range: None,
        definition: "number of connected components of the graph |d_ij| <= linking_distance",
        variant: "single linkage, distance included",
        source: "catalogue of models, section 5 (group membership)",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        edge: EdgeCases { empty: "0", one: "1", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        Some(sample.group_sizes(self.linking_distance).len() as f64)
    }
    fn parameter(&mut self, name: &str) -> Option<&mut f64> {
        self.place(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, placed};
    use space::Space;

    #[test]
    fn worked_example_of_the_catalogue() {
        let worked = placed(Space::open(), &[[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [10.0, 10.0]]);
        close(GroupCount { linking_distance: 5.0 }.on(&worked), 2.0);
        assert_eq!(worked.group_sizes(5.0), [3, 1]);
        close(GroupCount::default().on(&worked), 1.0);
    }

    #[test]
    fn the_linking_distance_is_inclusive() {
        let lattice: Vec<[f64; 2]> = (0..25).map(|k| [f64::from(k % 5), f64::from(k / 5)]).collect();
        let lattice = placed(Space::open(), &lattice);
        close(GroupCount { linking_distance: 1.0 }.on(&lattice), 1.0);
        close(GroupCount { linking_distance: 0.99 }.on(&lattice), 25.0);
        close(GroupCount::default().on(&placed(Space::open(), &[[0.0], [25.0], [50.5]])), 2.0);
    }

    #[test]
    fn a_group_may_lie_across_the_seam_or_go_round() {
        let places = [[0.5], [9.5], [5.0]];
        close(GroupCount { linking_distance: 1.0 }.on(&placed(Space::periodic([10.0]), &places)), 2.0);
        close(GroupCount { linking_distance: 1.0 }.on(&placed(Space::walled([10.0]), &places)), 3.0);
        close(GroupCount { linking_distance: 4.5 }.on(&placed(Space::periodic([10.0]), &places)), 1.0);
    }
}
