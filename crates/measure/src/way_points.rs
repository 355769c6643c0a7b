//! How steadily members choose where to go, from the way-points of their laws.
//!
//! Catalogue of models, section 5: smoothness, jitter, the percentage of HA behaviour.

use space::Vector;

/// Smoothness of one member's way-points in its own frame, one for each control cycle (`None`: none was chosen), length^2: the
/// trace of their covariance (divisor: the number of cycles with one). Smaller is smoother; the source calls it variance.
/// `None` without way-points. The value of a group is the mean over members.
pub fn smoothness<const D: usize>(way_points: &[Option<Vector<f64, D>>]) -> Option<f64> {
    let mean = crate::sample::mean_vector(way_points.iter().flatten().copied())?;
    crate::sample::mean(way_points.iter().flatten().map(|&point| (point - mean).length_squared()))
}

/// Jitter of one member's way-points, length^2: the mean squared change between those of consecutive cycles. `None` without two in a
/// row.
pub fn jitter<const D: usize>(way_points: &[Option<Vector<f64, D>>]) -> Option<f64> {
    let changes = way_points.windows(2).filter_map(|pair| Some((pair[1]? - pair[0]?).length_squared()));
    crate::sample::mean(changes)
}

/// Which rule a member followed in a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// Towards a gap between neighbours (HA, HA_PERP).
    Ha,
    /// Towards the nearest neighbour (SNN).
    Snn,
    /// It kept its way (KEEP).
    Keep,
}

/// Percentage of HA behaviour, `100 #HA / (#HA + #SNN)` over all cycles of all members, KEEP left out. `None` where neither occurs.
pub fn percentage_ha(rules: impl IntoIterator<Item = Rule>) -> Option<f64> {
    let kept = rules.into_iter().filter(|rule| *rule != Rule::Keep);
    crate::sample::mean(kept.map(|rule| if rule == Rule::Ha { 100.0 } else { 0.0 }))
}

/// The effective percentage of HA behaviour: cycles (KEEP left out) whose chosen direction differs by more than 5 degrees from that
/// to the nearest input, of each the pair of these directions. `None` without cycles.
pub fn effective_percentage_ha<const D: usize>(
    cycles: impl IntoIterator<Item = (Vector<f64, D>, Vector<f64, D>)>,
) -> Option<f64> {
    const SAME: f64 = 5.0;
    let differs = |(chosen, nearest): (Vector<f64, D>, Vector<f64, D>)| chosen.angle_to(nearest).to_degrees() > SAME;
    crate::sample::mean(cycles.into_iter().map(|cycle| if differs(cycle) { 100.0 } else { 0.0 }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::close;

    #[test]
    fn closed_forms() {
        let points = [Some(Vector([0.0, 0.0])), Some(Vector([2.0, 0.0])), None, Some(Vector([1.0, 3.0]))];
        // mean (1, 1): squares 2, 2, 4
        close(smoothness(&points), 8.0 / 3.0);
        close(jitter(&points), 4.0);
        assert_eq!(smoothness::<2>(&[None]), None);
        assert_eq!(jitter(&points[1..]), None);
        close(percentage_ha([Rule::Ha, Rule::Snn, Rule::Keep, Rule::Snn, Rule::Snn]), 25.0);
        assert_eq!(percentage_ha([Rule::Keep]), None);
        let at = |degrees: f64| Vector::<f64, 2>::at_angle(degrees.to_radians());
        close(effective_percentage_ha([(at(0.0), at(4.9)), (at(0.0), at(-5.1))]), 50.0);
    }
}
