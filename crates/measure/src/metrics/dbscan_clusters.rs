//! Into how many dense clusters a group falls.
//!
//! M. Ester, H.-P. Kriegel, J. Sander, X. Xu (1996), A density-based algorithm for discovering clusters, KDD 96:226.

use super::group_count::LINKING_DISTANCE;
use crate::metric::takes;
use crate::{Bounds, Parameter};
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample, Takes};

/// How near is near.
pub const EPS: Parameter = Parameter {
    name: "eps",
    unit: "length",
    default: LINKING_DISTANCE.default,
    bounds: Bounds::Positive,
    about: "Members at most this far apart are near each other (DBSCAN).",
};

/// How many make a core.
pub const MIN_SAMPLES: Parameter = Parameter {
    name: "min_samples",
    unit: "1",
    default: Some(3.0),
    bounds: Bounds::Whole,
    about: "A member with so many near it, itself included, is the core of a cluster (DBSCAN).",
};

takes! {
    /// `dbscan_clusters`.
    pub struct DbscanClusters { eps: EPS, min_samples: MIN_SAMPLES }
}

impl Metric for DbscanClusters {
    const CARD: MetricCard = MetricCard {
        id: "dbscan_clusters",
        title: "Number of dense clusters (DBSCAN)",
        symbol: "G_d",
        unit: "1",
        range: None,
        definition: "number of clusters of DBSCAN: a member with min_samples members (itself included) at most eps \
                    away is a core; cores at most eps apart are in one cluster, and so is whoever is that near to a \
                    core",
        variant: "the member itself counts; distance included, as in scikit-learn",
        source: "Ester et al. 1996",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        edge: EdgeCases { empty: "0", one: "0", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        let clusters = sample.dense_clusters(self.eps, self.min_samples as usize);
        Some(clusters.iter().flatten().max().map_or(0.0, |&last| last as f64 + 1.0))
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
        let clusters = |eps, min_samples| DbscanClusters { eps, min_samples }.on(&sample);
        close(clusters(1.0, 3.0), 1.0);
        close(clusters(1.0, 2.0), 2.0);
        close(clusters(1.0, 1.0), 3.0);
        close(clusters(0.99, 2.0), 0.0);
        close(clusters(7.0, 4.0), 1.0);
    }
}
