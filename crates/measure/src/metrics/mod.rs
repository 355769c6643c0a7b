//! The metrics: one file each, one line each in the list below. Files, tables, help and law tests are made from the
//! list.

use crate::doors::{in_dimensions, of_dimension};
use crate::{Measure, MeasureError, Metric, MetricCard, Sample};
use space::spelling::nearest;
use space::{Frame, GroupRange, Real};

macro_rules! metrics {
    ($($file:ident::$name:ident;)*) => {
        $(pub mod $file;)*
        /// The cards of all metrics, in the order of the list.
        pub const LIST: &[&MetricCard] = &[$(&<$file::$name as Metric>::CARD),*];
        in_dimensions! { Measure: $($file::$name),* }
    };
}

metrics! {
    polarisation::Polarisation;
    weighted_polarisation::WeightedPolarisation;
    body_polarisation::BodyPolarisation;
    mean_angular_deviation::MeanAngularDeviation;
    angular_momentum::AngularMomentum;
    signed_angular_momentum::SignedAngularMomentum;
    hexatic_order::HexaticOrder;
    local_hexatic_order::LocalHexaticOrder;
    nearest_neighbour_distance::NearestNeighbourDistance;
    nearest_neighbour_distance_sd::NearestNeighbourDistanceSd;
    nearest_neighbour_distance_max::NearestNeighbourDistanceMax;
    kth_neighbour_distance::KthNeighbourDistance;
    k_nearest_distance::KNearestDistance;
    mean_pair_distance::MeanPairDistance;
    max_pair_distance::MaxPairDistance;
    mean_edge_length::MeanEdgeLength;
    deviation_energy::DeviationEnergy;
    hull_area::HullArea;
    hull_perimeter::HullPerimeter;
    hull_vertices::HullVertices;
    hull_volume::HullVolume;
    hull_surface::HullSurface;
    elongation::Elongation;
    expanse::Expanse;
    mean_distance_to_centre::MeanDistanceToCentre;
    median_distance_to_centre::MedianDistanceToCentre;
    group_count::GroupCount;
    largest_group_share::LargestGroupShare;
    largest_group_size::LargestGroupSize;
    group_entropy::GroupEntropy;
    balance::Balance;
    fragmented::Fragmented;
    stragglers::Stragglers;
    dbscan_clusters::DbscanClusters;
    dbscan_noise::DbscanNoise;
    dbscan_largest::DbscanLargest;
    view_groups_literal::ViewGroupsLiteral;
    view_largest_share_literal::ViewLargestShareLiteral;
    view_groups_mutual::ViewGroupsMutual;
    view_largest_share_mutual::ViewLargestShareMutual;
    visible_share::VisibleShare;
    mean_speed::MeanSpeed;
    speed_sd::SpeedSd;
    group_speed::GroupSpeed;
    overlapping_pairs::OverlappingPairs;
    domain_of_danger_median::DomainOfDangerMedian;
    domain_of_danger_max::DomainOfDangerMax;
}

/// All metrics with their parameters at the defaults, in the order of the list; none in more than three dimensions.
pub fn all<const D: usize>() -> Vec<Box<dyn Measure<D>>> {
    of_dimension(in_1, in_2, in_3).unwrap_or_default()
}

/// The metric of an id, with its parameters at the defaults.
///
/// # Errors
/// Where no metric has this id.
pub fn find<const D: usize>(id: &str) -> Result<Box<dyn Measure<D>>, MeasureError> {
    all::<D>().into_iter().find(|metric| metric.card().id == id).ok_or_else(|| MeasureError::UnknownMetric {
        id: id.to_owned(),
        nearest: nearest(id, LIST.iter().map(|card| card.id)),
    })
}

/// The metric of an id over one group of a frame, or over everyone, with its parameters at the defaults.
///
/// For several metrics of one frame, or for other parameters, use [`find`] or [`all`] with one [`Sample`].
///
/// # Errors
/// Where no metric has this id.
pub fn compute<R: Real, const D: usize>(
    id: &str,
    frame: &Frame<'_, R, D>,
    group: Option<&GroupRange>,
) -> Result<Option<f64>, MeasureError> {
    let metric = find::<D>(id)?;
    let sample = group.map_or_else(|| Sample::whole(frame), |group| Sample::group(frame, group));
    Ok(metric.on(&sample))
}

#[cfg(test)]
pub(crate) mod sketch;

#[cfg(test)]
mod tests;
