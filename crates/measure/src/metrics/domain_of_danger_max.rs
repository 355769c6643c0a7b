//! How much ground lies nearest to the member with the largest domain of danger.

use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};

/// `domain_of_danger_max`.
#[derive(Clone, Copy, Debug, Default)]
pub struct DomainOfDangerMax;

impl Metric for DomainOfDangerMax {
    const CARD: MetricCard = MetricCard {
        id: "domain_of_danger_max",
        title: "Greatest domain of danger",
        symbol: "max A_d",
        unit: "length^D",
        range: None,
        definition: "greatest over members of the domain of danger; the domain of a member is the part of the arena \
                    nearer to it than to any other; the arena is the convex hull (on a line the way from the first \
                    to the last)",
        variant: "bounded by the hull of the group (domains_of_danger over time: by the box); coincident members \
                    share alike",
        source: "Hamilton 1971",
        counted: Counted::Positions,
        dimensions: &[1, 2],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "as ever", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        sample.domains_of_danger()?.iter().copied().reduce(f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, placed};
    use space::Space;

    #[test]
    fn half_a_gap_to_either_side() {
        // 20, 50, 45, 75, 60 on a line
        let line = placed(Space::open(), &[[0.0], [40.0], [100.0], [130.0], [250.0]]);
        close(DomainOfDangerMax.on(&line), 75.0);
        // a square with one member in its middle: half of it, and an eighth for each corner
        let square = placed(Space::open(), &[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [2.0, 2.0]]);
        close(DomainOfDangerMax.on(&square), 8.0);
    }
}
