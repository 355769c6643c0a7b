//! How many members belong to no dense cluster.

use super::dbscan_clusters::{EPS, MIN_SAMPLES};
use crate::metric::takes;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample, Takes};

takes! {
    /// `dbscan_noise`.
    pub struct DbscanNoise { eps: EPS, min_samples: MIN_SAMPLES }
}

impl Metric for DbscanNoise {
    const CARD: MetricCard = MetricCard {
        id: "dbscan_noise",
        title: "Members in no dense cluster (DBSCAN)",
        symbol: "N_0",
        unit: "1",
        range: None,
        definition: "number of members in no cluster of DBSCAN: a member with min_samples members (itself included) \
                    at most eps away is a core; cores at most eps apart are in one cluster, and so is whoever is \
                    that near to a core",
        variant: "the member itself counts; distance included, as in scikit-learn",
        source: "Ester et al. 1996",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        edge: EdgeCases { empty: "0", one: "1", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        let clusters = sample.dense_clusters(self.eps, self.min_samples as usize);
        Some(clusters.iter().filter(|cluster| cluster.is_none()).count() as f64)
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
    fn closed_forms() {
        // a row of four, a pair, and one alone
        let places = [[0.0], [1.0], [2.0], [3.0], [10.0], [11.0], [20.0]];
        let sample = placed(Space::open(), &places);
        close(DbscanNoise { eps: 1.0, min_samples: 3.0 }.on(&sample), 3.0);
        close(DbscanNoise { eps: 1.0, min_samples: 2.0 }.on(&sample), 1.0);
        close(DbscanNoise { eps: 0.5, min_samples: 2.0 }.on(&sample), 7.0);
    }
}
