//! How far the six nearest neighbours of all members stand in one hexagonal pattern: 1 in a triangular lattice.
//!
//! D. R. Nelson, B. I. Halperin (1979), Dislocation-mediated melting in two dimensions, Physical Review B 19:2457.

use crate::sample::mean_vector;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};
use space::Vector;

/// The bond order psi of each member, as a vector of its real and imaginary part. `None` unless there are seven members in two
/// dimensions.
pub(super) fn bonds<const D: usize>(sample: &Sample<D>) -> Option<Vec<Vector<f64, 2>>> {
    const NEIGHBOURS: usize = 6;
    if D != 2 {
        return None;
    }
    let others = sample.nearest_others(NEIGHBOURS)?;
    let times = |a: Vector<f64, 2>, b: Vector<f64, 2>| {
        Vector([a.0[0] * b.0[0] - a.0[1] * b.0[1], a.0[0] * b.0[1] + a.0[1] * b.0[0]])
    };
    let places = sample.positions();
    let bond = |(i, nearest): (usize, &[(f64, u32)])| {
        let sixth = |&(_, j): &(f64, u32)| {
            let unit = Vector::<f64, 2>::of(&sample.space().offset(places[i], places[j as usize]).unit().0);
            let cube = times(unit, times(unit, unit));
            times(cube, cube)
        };
        nearest.iter().map(sixth).fold(Vector::ZERO, |sum, v| sum + v) / NEIGHBOURS as f64
    };
    Some(others.chunks_exact(NEIGHBOURS).enumerate().map(bond).collect())
}

/// `hexatic_order`.
#[derive(Clone, Copy, Debug, Default)]
pub struct HexaticOrder;

impl Metric for HexaticOrder {
    const CARD: MetricCard = MetricCard {
        id: "hexatic_order",
        title: "Hexatic order",
        symbol: "Psi_6",
        unit: "1",
        range: Some((0.0, 1.0)),
        definition: "|mean_i psi_i|,  psi_i = (1/6) sum_j exp(6 i theta_ij) over the six nearest others (ties by id), \
                     theta_ij the angle of d_ij; seven or more members",
        variant: "global: the pattern has one direction; neighbours are the six nearest",
        source: "Nelson and Halperin 1979; six nearest as the default of the package freud",
        counted: Counted::Positions,
        dimensions: &[2],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "undefined", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        let bonds = bonds(sample)?;
        Some(mean_vector(bonds.into_iter())?.length())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, placed};
    use space::Space;

    /// A triangular lattice that fits its box.
    pub(super) fn triangles() -> Sample<2> {
        let height = 0.75f64.sqrt();
        let place = |k: i32| [f64::from(k % 8) + 0.5 * f64::from(k / 8 % 2), height * f64::from(k / 8)];
        placed(Space::periodic([8.0, 8.0 * height]), &Vec::from_iter((0..64).map(place)))
    }

    #[test]
    fn lattices() {
        close(HexaticOrder.on(&triangles()), 1.0);
        // six of eight directions of a square lattice cannot agree
        let square = Vec::from_iter((0..64).map(|k| [f64::from(k % 8), f64::from(k / 8)]));
        let found = HexaticOrder.on(&placed(Space::periodic([8.0; 2]), &square));
        assert!(found.is_some_and(|found| found < 0.5), "{found:?}");
        assert_eq!(HexaticOrder.on(&placed(Space::open(), &square[..6])), None);
    }

    #[test]
    fn coincident_members_have_no_direction() {
        close(HexaticOrder.on(&placed(Space::open(), &[[1.0, 1.0]; 9])), 0.0);
    }
}
