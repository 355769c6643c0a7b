//! Small tracks for tests.

use crate::{Clock, Ground, Rows, Tracks, TracksError};
use space::Space;

/// Tracks at `rate` frames a second of what `place(frame, individual)` gives; `None`: not found.
pub(crate) fn tracks<const D: usize>(
    space: Space<f64, D>,
    rate: f64,
    frames: i64,
    individuals: u32,
    place: impl Fn(i64, u32) -> Option<[f64; D]>,
) -> Result<Tracks<D>, TracksError> {
    let mut rows = Rows::<D>::default();
    for frame in 0..frames {
        for individual in 0..individuals {
            rows.frame.push(frame);
            rows.individual.push(individual);
            let position = place(frame, individual).unwrap_or([f64::NAN; D]);
            (0..D).for_each(|a| rows.position[a].push(position[a]));
        }
    }
    let names = (0..individuals).map(|individual| individual.to_string()).collect();
    Tracks::new(rows, names, Clock::Rate(rate), Ground::Plane(space))
}

/// Asserts that two lists of numbers are equal up to 1e-9; NaN equals NaN.
#[track_caller]
pub(crate) fn close(found: &[f64], expected: &[f64]) {
    let equal = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-9 * b.abs().max(1.0) || a.is_nan() && b.is_nan();
    let fine = found.len() == expected.len() && found.iter().zip(expected).all(equal);
    assert!(fine, "found {found:?}, expected {expected:?}");
}

/// What tests end with.
pub(crate) type Fine = Result<(), Box<dyn std::error::Error>>;
