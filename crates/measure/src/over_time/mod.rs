//! The metrics over time: one file each, one line each in the list below. What they find is a table whose columns their
//! cards describe.

use crate::doors::{in_dimensions, of_dimension};
use crate::{MeasureError, MeasureTracks, TrackCard, TrackMetric};
use space::spelling::nearest;

mod groups;
mod lags;
mod line;

macro_rules! over_time {
    ($($file:ident::$name:ident;)*) => {
        $(pub mod $file;)*
        /// The cards of all metrics over time, in the order of the list.
        pub const LIST: &[&TrackCard] = &[$(&<$file::$name as TrackMetric>::CARD),*];
        in_dimensions! { MeasureTracks: $($file::$name),* }
    };
}

over_time! {
    mean_squared_displacement::MeanSquaredDisplacement;
    relative_mean_squared_displacement::RelativeMeanSquaredDisplacement;
    heading_autocorrelation::HeadingAutocorrelation;
    velocity_correlation::VelocityCorrelation;
    correlation_length::CorrelationLength;
    radial_distribution::RadialDistribution;
    speed::Speed;
    acceleration::Acceleration;
    path_curvature::PathCurvature;
    coverage::Coverage;
    domains_of_danger::DomainsOfDanger;
    occupied_area::OccupiedArea;
    occupancy::Occupancy;
    relative_positions::RelativePositions;
    group_overlap::GroupOverlap;
    group_membership::GroupMembership;
    nearest_neighbours::NearestNeighbours;
    collisions::Collisions;
    leadership::Leadership;
    group_events::GroupEvents;
    motion_events::MotionEvents;
    lane_order::LaneOrder;
    line_crossings::LineCrossings;
    flow::Flow;
    classic_density::ClassicDensity;
    voronoi_density::VoronoiDensity;
    speed_in_area::SpeedInArea;
    mean_median_distance::MeanMedianDistance;
    consensus_robustness::ConsensusRobustness;
}

/// All metrics over time with their parameters at the defaults, in the order of the list; none in more than three dimensions.
pub fn all<const D: usize>() -> Vec<Box<dyn MeasureTracks<D>>> {
    of_dimension(in_1, in_2, in_3).unwrap_or_default()
}

/// The metric over time of an id, with its parameters at the defaults.
///
/// # Errors
/// Where none has this id.
pub fn find<const D: usize>(id: &str) -> Result<Box<dyn MeasureTracks<D>>, MeasureError> {
    all::<D>().into_iter().find(|metric| metric.card().id == id).ok_or_else(|| MeasureError::UnknownMetric {
        id: id.to_owned(),
        nearest: nearest(id, LIST.iter().map(|card| card.id)),
    })
}

#[cfg(test)]
mod sketch;

#[cfg(test)]
mod tests;
