//! What is read off the ground that groups hold: how much, and how much of it two of them share.

use super::form::GroundQuantity;
use space::Vector;
use std::collections::BTreeSet;

/// The cells of some places, by their numbers along the axes.
fn cells<const D: usize>(places: impl Iterator<Item = Vector<f64, D>>, size: f64) -> BTreeSet<[i64; D]> {
    places.map(|place| place.0.map(|x| (x / size).floor() as i64)).collect()
}

/// What is asked of the ground of one group, or of two; none where nobody is there.
pub(super) fn value<const D: usize>(
    quantity: GroundQuantity,
    own: impl Iterator<Item = Vector<f64, D>>,
    other: impl Iterator<Item = Vector<f64, D>>,
    size: f64,
) -> Option<f64> {
    let own = cells(own, size);
    match quantity {
        GroundQuantity::Area => (!own.is_empty()).then(|| own.len() as f64 * size.powi(D as i32)),
        GroundQuantity::Overlap => {
            let other = cells(other, size);
            let both = own.intersection(&other).count();
            let either = own.len() + other.len() - both;
            (either > 0).then(|| both as f64 / either as f64)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_and_overlaps_by_hand() {
        let places = |list: &[[f64; 2]]| list.iter().map(|&place| Vector(place)).collect::<Vec<_>>().into_iter();
        let (one, two) = ([[0.5, 0.5], [1.9, 0.1], [2.5, 0.0]], [[2.1, 1.9], [9.0, 9.0]]);
        let of = |quantity| value(quantity, places(&one), places(&two), 2.0);
        assert_eq!(of(GroundQuantity::Area), Some(8.0));
        assert_eq!(of(GroundQuantity::Overlap), Some(1.0 / 3.0));
        assert_eq!(value(GroundQuantity::Overlap, places(&[]), places(&[]), 2.0), None);
        assert_eq!(value(GroundQuantity::Area, places(&[]), places(&two), 2.0), None);
    }
}
