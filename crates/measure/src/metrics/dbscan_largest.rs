//! How many members the largest dense cluster has.

use super::dbscan_clusters::{EPS, MIN_SAMPLES};
use crate::metric::takes;
use crate::sample::sizes;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample, Takes};

takes! {
    /// `dbscan_largest`.
    pub struct DbscanLargest { eps: EPS, min_samples: MIN_SAMPLES }
}

impl Metric for DbscanLargest {
    const CARD: MetricCard = MetricCard {
        id: "dbscan_largest",
        title: "Members of the largest dense cluster (DBSCAN)",
        symbol: "N_d",
        unit: "1",
        range: None,
        definition: "members of the largest cluster of DBSCAN: a member with min_samples members (itself included) at \
                    most eps away is a core; cores at most eps apart are in one cluster, and so is whoever is that \
                    near to a core; 0 without a cluster",
        variant: "the member itself counts; distance included, as in scikit-learn; a member near two clusters is \
                    in the one with the lower first core",
        source: "Ester et al. 1996",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        edge: EdgeCases { empty: "0", one: "0", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        let clusters = sample.dense_clusters(self.eps, self.min_samples as usize);
        Some(sizes(clusters.iter().flatten().copied()).into_iter().max().unwrap_or(0) as f64)
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
        close(DbscanLargest { eps: 1.0, min_samples: 3.0 }.on(&sample), 4.0);
        close(DbscanLargest { eps: 0.5, min_samples: 3.0 }.on(&sample), 0.0);
    }
}
