//! `space`: the ground every other room stands on.
//!
//! Real numbers in two precisions, vectors, the boundaries of space, shapes and rays, the neighbour
//! search, random draws that depend on their purpose alone, and the read-only [`Frame`] of columns that metrics,
//! recorders and pages read. It knows no model, no file and no clock.

pub mod angles;
pub mod boundary;
pub mod exact;
mod frame;
pub mod grid;
pub mod lanes;
pub mod obstacles;
pub mod parallel;
pub mod random;
mod real;
pub mod segment;
pub mod shape;
pub mod spelling;
mod vector;
pub mod voronoi;

pub use boundary::{Edge, Space};
pub use frame::{Column, ColumnKind, Columns, Frame, GroupRange, PADDING};
pub use grid::{Grid, LiveGrid};
pub use real::Real;
pub use segment::Segment;
pub use vector::Vector;
