//! How long a series remembers.

use super::descriptive::centre;
use super::{StatisticsError, check};

/// The autocorrelation time of a series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AutocorrelationTime {
    /// tau = 1 + 2 sum of the autocorrelations, in steps of the series; at least 1.
    pub time: f64,
    /// The lag up to which they are summed.
    pub window: usize,
    /// Values over time: so many independent values tell as much about the mean.
    pub effective: f64,
    /// Whether the series is at least 50 times as long as tau; the time of a shorter one tends to be too small.
    pub reliable: bool,
}

/// Autocorrelations for the lags 0 to `most`: covariances, divided by n whatever the lag, over the variance
/// (statsmodels `acf`).
///
/// # Errors
/// For fewer than two values, a lag of their number or more, a value that is not finite, values that are all equal or too
/// large for their squares.
pub fn autocorrelations(series: &[f64], most: usize) -> Result<Vec<f64>, StatisticsError> {
    check::at_least("values in the series", most.saturating_add(1), series.len())?;
    let (deviations, squares) = deviations(series)?;
    Ok((0..=most).map(|lag| product(&deviations, lag) / squares).collect())
}

/// The integrated autocorrelation time, summed up to the first lag of at least five times the sum so far (Sokal 1997; the
/// window of the package emcee).
///
/// Values that alternate have a sum below 1; they are counted as independent, which is on the safe side.
///
/// # Errors
/// For fewer than two values, one that is not finite, values that are all equal or too large for their squares.
pub fn autocorrelation_time(series: &[f64]) -> Result<AutocorrelationTime, StatisticsError> {
    const WINDOW: f64 = 5.0;
    let (deviations, squares) = deviations(series)?;
    let (mut time, mut window) = (1.0, 0);
    while (window as f64) < WINDOW * time && window + 1 < series.len() {
        window += 1;
        time += 2.0 * product(&deviations, window) / squares;
    }
    let (time, count) = (time.max(1.0), series.len() as f64);
    Ok(AutocorrelationTime { time, window, effective: count / time, reliable: count >= 50.0 * time })
}

/// Deviations from the mean and the sum of their squares.
fn deviations(series: &[f64]) -> Result<(Vec<f64>, f64), StatisticsError> {
    check::values("the series", series, 2)?;
    let squares = check::spread_of("in the series", series)? * (series.len() - 1) as f64;
    let mean = centre(series);
    Ok((series.iter().map(|value| value - mean).collect(), squares))
}

/// The sum of products at a lag.
fn product(deviations: &[f64], lag: usize) -> f64 {
    deviations.iter().zip(&deviations[lag..]).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand() {
        // deviations -1.5 -0.5 0.5 1.5
        let r = autocorrelations(&[1.0, 2.0, 3.0, 4.0], 3).unwrap();
        assert_eq!(r, [1.0, 0.25, -0.3, -0.45]);
        let alternating: Vec<f64> = (0..100).map(|i| f64::from(i % 2)).collect();
        assert_eq!(autocorrelation_time(&alternating).map(|time| time.time), Ok(1.0));
    }

    #[test]
    fn persistent_series() {
        use space::random::{Purpose, Stream};
        let mut last = 0.0;
        let series: Vec<f64> = (0..20_000)
            .map(|step| {
                last = 0.8 * last + Stream::new(3, Purpose::Behaviour, step, 0).normal(0);
                last
            })
            .collect();
        // (1 + 0.8) / (1 - 0.8)
        let time = autocorrelation_time(&series).unwrap();
        assert!((time.time / 9.0 - 1.0).abs() < 0.15 && time.reliable, "{time:?}");
        let short = autocorrelation_time(&series[..300]).unwrap();
        assert!(!short.reliable, "{short:?} {:?}", &series[..100]);
    }

    #[test]
    fn bad_input() {
        assert!(autocorrelations(&[1.0, 2.0], 2).is_err() && autocorrelation_time(&[1.0]).is_err());
        assert!(autocorrelation_time(&[1.0, 1.0]).is_err() && autocorrelation_time(&[1.0, f64::NAN]).is_err());
    }
}
