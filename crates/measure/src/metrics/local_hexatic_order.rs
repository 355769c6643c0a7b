//! How far the six nearest neighbours of each member stand in a hexagon, whatever its direction.

use super::hexatic_order::bonds;
use crate::sample::mean;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};
use space::Vector;

/// `local_hexatic_order`.
#[derive(Clone, Copy, Debug, Default)]
pub struct LocalHexaticOrder;

impl Metric for LocalHexaticOrder {
    const CARD: MetricCard = MetricCard {
        id: "local_hexatic_order",
        title: "Local hexatic order",
        symbol: "psi_6",
        unit: "1",
        range: Some((0.0, 1.0)),
        definition: "mean_i |psi_i|,  psi_i as in hexatic_order; seven or more members",
        variant: "local: each member's hexagon has a direction of its own",
        source: "Nelson and Halperin 1979; six nearest as the default of the package freud",
        counted: Counted::Positions,
        dimensions: &[2],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "undefined", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        mean(bonds(sample)?.into_iter().map(Vector::length))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, placed};
    use space::Space;

    #[test]
    fn hexagons_of_two_directions() {
        // a member with six around it, twice, one turned by 30 degrees: psi 1 and 1 at the centres
        let around = |centre: f64, turn: f64| {
            let corner = move |k: i32| {
                let angle = (f64::from(k) * 60.0 + turn).to_radians();
                [centre + angle.cos(), angle.sin()]
            };
            (0..6).map(corner).chain([[centre, 0.0]])
        };
        let sample = placed(Space::open(), &Vec::from_iter(around(0.0, 0.0).chain(around(50.0, 30.0))));
        let bonds = bonds(&sample).unwrap_or_default();
        close(Some(bonds[6].length()), 1.0);
        close(Some(bonds[13].length()), 1.0);
        close(Some((bonds[6] + bonds[13]).length()), 0.0);
        let mean = LocalHexaticOrder.on(&sample);
        assert!(mean.is_some_and(|mean| mean > 1.0 / 7.0 && mean < 1.0), "{mean:?}");
    }
}
