//! `measure`: numbers that describe how a group moves.
//!
//! A metric reads a [`space::Frame`], one moment of a simulated or a tracked group, and knows nothing of the engine
//! that made it. What every metric shares is settled once, in [`Sample`]: members stand in the order of their ids,
//! sums are taken in that order and in f64, and offsets go by minimum image on periodic axes. Each metric is one
//! file in [`metrics`] and one line in its list; its [`MetricCard`] says what it is and where it is undefined. Whether a
//! group did what was wanted of it, over a whole course, is for [`behaviours`] to say.
//!
//! [`Tracks`] are the frames of animals (or of a recorded run) in one table. [`per_frame`] measures every frame of them;
//! what needs more than one moment is a [`TrackMetric`], listed in [`over_time`].
//!
//! ```
//! use measure::{Metric, Sample, metrics};
//! use space::{Columns, Frame, Space, Vector};
//!
//! let mut columns = Columns::<f64, 2>::new(2, 0);
//! columns.set_velocity(0, Vector([1.0, 0.0]));
//! columns.set_velocity(1, Vector([0.0, 2.0]));
//! let space = Space::open();
//! let frame = Frame { columns: &columns, declared: &[], groups: &[], space: &space, time: 0.0, step: 0 };
//! // by its type
//! let polarisation = metrics::polarisation::Polarisation.of(&frame, &[0, 1]);
//! assert!(polarisation.is_some_and(|p| (p - 0.5f64.sqrt()).abs() < 1e-15));
//! // by its id, for the whole frame
//! assert_eq!(metrics::compute("polarisation", &frame, None), Ok(polarisation));
//! // all of them, from one reading of the frame
//! let sample = Sample::whole(&frame);
//! for metric in metrics::all::<2>() {
//!     let (id, value, counted) = (metric.card().id, metric.on(&sample), sample.count(metric.card().counted));
//!     assert!(value.is_none_or(f64::is_finite), "{id} of {counted} members");
//! }
//! ```

pub mod behaviours;
pub mod consensus;
pub mod domains;
mod doors;
pub mod ground;
pub mod hull;
pub mod looks;
mod metric;
pub mod metrics;
pub mod near;
pub mod over_time;
mod per_frame;
mod sample;
pub mod standing;
pub mod statistics;
mod track_metric;
mod tracks;
pub mod transfer;
pub mod way_points;

pub use ground::Ground;
pub use metric::{Bounds, Counted, EdgeCases, Measure, MeasureError, Metric, MetricCard, Parameter, Takes};
pub use per_frame::{PerFrame, per_frame};
pub use sample::Sample;
pub use track_metric::{Field, Kind, Listing, MeasureTracks, TrackCard, TrackMetric};
pub use tracks::{Clock, Paths, Rows, Tracks, TracksError};
