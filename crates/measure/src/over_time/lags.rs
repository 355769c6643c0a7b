//! What metrics with a lag share: which lags, and means over all pairs of moments that far apart.

use crate::{Bounds, MeasureError, Parameter, Tracks};
use space::{Edge, Vector};

/// Up to which lag.
pub(super) const MAX_LAG: Parameter = Parameter {
    name: "max_lag",
    unit: "s",
    default: None,
    bounds: Bounds::Positive,
    about: "The longest lag. The cost grows with the number of lags times that of positions.",
};

/// How many lags.
pub(super) const LAGS: Parameter = Parameter {
    name: "lags",
    unit: "1",
    default: Some(100.0),
    bounds: Bounds::Whole,
    about: "At most so many lags: where there are more frames up to max_lag, as evenly spaced as whole frames allow.",
};

/// A sum over pairs of moments, at a lag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lagged {
    /// In frames (usual steps).
    pub(super) lag: i64,
    /// In seconds.
    pub(super) time: f64,
    /// Sum over all pairs.
    pub(super) sum: f64,
    /// Number of pairs.
    pub(super) pairs: u64,
}

impl Lagged {
    /// The mean; NaN without pairs.
    pub(super) fn mean(&self) -> f64 {
        self.sum / self.pairs as f64
    }
}

/// The lags (in frames) up to `max_lag` seconds.
///
/// # Errors
/// Where there are no two frames, or the lag is less than the time between them.
pub(super) fn lags<const D: usize>(
    metric: &'static str,
    tracks: &Tracks<D>,
    max_lag: f64,
    count: f64,
) -> Result<(Vec<i64>, f64), MeasureError> {
    let needs = "two frames, and a max_lag of at least the time between them";
    let interval = tracks.interval().ok_or(MeasureError::Unfit { metric, needs })?;
    let most = (max_lag / interval + 1e-6).floor() as i64;
    if most < 1 {
        return Err(MeasureError::Unfit { metric, needs });
    }
    let count = (count as i64).clamp(1, most);
    let lag = |k: i64| (k as f64 * most as f64 / count as f64).round() as i64;
    Ok(((1..=count).map(lag).collect(), interval))
}

/// Sums of `value(earlier, later)` over all individuals and all pairs of their rows that are a lag apart. Windows overlap; gaps are
/// left out. A pair counts where it has a value.
pub(super) fn over_pairs<const D: usize, Q: Copy>(
    tracks: &Tracks<D>,
    lags: &[i64],
    interval: f64,
    quantity: impl Fn(usize) -> Option<Q>,
    value: impl Fn(Q, Q) -> f64,
) -> Vec<Lagged> {
    let mut sums: Vec<Lagged> =
        lags.iter().map(|&lag| Lagged { lag, time: lag as f64 * interval, sum: 0.0, pairs: 0 }).collect();
    let paths = tracks.paths();
    let (mut moments, mut known): (Vec<i64>, Vec<Q>) = (Vec::new(), Vec::new());
    for individual in 0..paths.len() {
        moments.clear();
        known.clear();
        for (frame, row) in paths.of(individual) {
            if let Some(q) = quantity(row) {
                moments.push(tracks.frames()[frame]);
                known.push(q);
            }
        }
        for lagged in &mut sums {
            let apart = lagged.lag * tracks.step();
            let mut later = 0;
            for earlier in 0..moments.len() {
                while later < moments.len() && moments[later] - moments[earlier] < apart {
                    later += 1;
                }
                if moments.get(later).is_some_and(|&moment| moment - moments[earlier] == apart) {
                    lagged.sum += value(known[earlier], known[later]);
                    lagged.pairs += 1;
                }
            }
        }
    }
    sums
}

/// Positions without seams, `[D][rows]`: on periodic axes each individual goes on from image to image by the shortest way.
pub(super) fn unwrapped<const D: usize>(tracks: &Tracks<D>) -> [Vec<f64>; D] {
    let mut position: [Vec<f64>; D] = core::array::from_fn(|a| tracks.positions(a).to_vec());
    let crate::Ground::Plane(space) = tracks.ground() else { return position };
    let paths = tracks.paths();
    for a in (0..D).filter(|&a| matches!(space.edges[a], Edge::Periodic(_))) {
        for individual in 0..paths.len() {
            let mut before: Option<usize> = None;
            for (_, row) in paths.of(individual) {
                if let Some(old) = before {
                    let step = tracks.offset(tracks.position(old), tracks.position(row)).0[a];
                    position[a][row] = position[a][old] + step;
                }
                before = Some(row);
            }
        }
    }
    position
}

/// Positions seen from the centre of everyone in their frame, `[D][rows]`; NaN where there is no centre.
pub(super) fn from_centre<const D: usize>(tracks: &Tracks<D>) -> [Vec<f64>; D] {
    let mut position: [Vec<f64>; D] = core::array::from_fn(|_| vec![f64::NAN; tracks.len()]);
    let mut sample = crate::Sample::empty();
    for frame in 0..tracks.frames().len() {
        tracks.sample_into(frame, &mut sample);
        let Some(offsets) = sample.from_centre(sample.positions()) else { continue };
        for (row, offset) in tracks.rows(frame).zip(offsets) {
            (0..D).for_each(|a| position[a][row] = offset.0[a]);
        }
    }
    position
}

/// The row of columns as a vector, where it is known.
pub(super) fn at<const D: usize>(columns: &[Vec<f64>; D], row: usize) -> Option<Vector<f64, D>> {
    Some(Vector(core::array::from_fn(|a| columns[a][row]))).filter(|v| v.finite())
}

/// Calls `visit(individual, row before, row, seconds)` for every two rows of an individual in frames that follow each other.
pub(super) fn each_step<const D: usize>(tracks: &Tracks<D>, mut visit: impl FnMut(usize, usize, usize, f64)) {
    let paths = tracks.paths();
    for individual in 0..paths.len() {
        for ((before, old), (frame, new)) in paths.of(individual).zip(paths.of(individual).skip(1)) {
            if let Some(dt) = tracks.interval_before(frame).filter(|_| before + 1 == frame) {
                visit(individual, old, new, dt);
            }
        }
    }
}

/// An individual as a number of a table: -1 for the last row, of all together.
pub(super) fn which(k: usize, individuals: usize) -> f64 {
    if k < individuals { k as f64 } else { -1.0 }
}
