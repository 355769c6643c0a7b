//! One sample in a few numbers.

use super::{StatisticsError, check};

/// A sample in a few numbers.
///
/// Spread is that of a sample from a population (division by n - 1), and unknown for a single value.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// How many values.
    pub count: usize,
    /// Their mean.
    pub mean: f64,
    /// Standard deviation, with n - 1.
    pub standard_deviation: Option<f64>,
    /// Standard error of the mean: deviation / sqrt(n).
    pub standard_error: Option<f64>,
    /// The least value.
    pub minimum: f64,
    /// Median.
    pub median: f64,
    /// The greatest value.
    pub maximum: f64,
}

impl Summary {
    /// Of a sample.
    ///
    /// # Errors
    /// Where there is no value, one is not finite, or they are too large for their squares.
    pub fn of(values: &[f64]) -> Result<Self, StatisticsError> {
        let mean = mean(values)?;
        let deviation = if values.len() > 1 { Some(variance(values)?.sqrt()) } else { None };
        let sorted = sorted(values);
        Ok(Self {
            count: values.len(),
            mean,
            standard_deviation: deviation,
            standard_error: deviation.map(|deviation| deviation / (values.len() as f64).sqrt()),
            minimum: sorted[0],
            median: quantile_of_sorted(&sorted, 0.5),
            maximum: sorted[sorted.len() - 1],
        })
    }
}

/// The mean: the sum, and once more the mean of what is left, so that a large common offset costs no digits.
///
/// # Errors
/// Where there is no value, one is not finite, or their sum leaves the range of f64.
pub fn mean(values: &[f64]) -> Result<f64, StatisticsError> {
    check::values("the sample", values, 1)?;
    check::not_overflown("a mean", centre(values))
}

/// The variance with n - 1, from deviations from the mean (Chan, Golub & LeVeque 1983).
///
/// # Errors
/// Where there are fewer than two values, one is not finite, or they are too large for their squares.
pub fn variance(values: &[f64]) -> Result<f64, StatisticsError> {
    check::values("the sample", values, 2)?;
    check::not_overflown("a variance", squares(values) / (values.len() - 1) as f64)
}

/// The median.
///
/// # Errors
/// Where there is no value, or one is not finite.
pub fn median(values: &[f64]) -> Result<f64, StatisticsError> {
    quantile(values, 0.5)
}

/// The quantile for a share in 0..=1, interpolated between order statistics (type 7 of Hyndman & Fan 1996: the default
/// of NumPy and R).
///
/// # Errors
/// Where there is no value, one is not finite, or the share is not in 0..=1.
pub fn quantile(values: &[f64], share: f64) -> Result<f64, StatisticsError> {
    check::values("the sample", values, 1)?;
    check::in_range("the share of a quantile", "from 0 to 1", share, (0.0..=1.0).contains(&share))?;
    Ok(quantile_of_sorted(&sorted(values), share))
}

/// [`quantile`] of one value or more in ascending order.
pub(super) fn quantile_of_sorted(sorted: &[f64], share: f64) -> f64 {
    let place = share * (sorted.len() - 1) as f64;
    let (below, part) = (place.floor(), place.fract());
    let low = sorted[below as usize];
    match sorted.get(below as usize + 1) {
        // halves first: the difference of two finite numbers may not be finite
        Some(&high) => low * (1.0 - part) + high * part,
        None => low,
    }
}

/// The values in ascending order.
pub(super) fn sorted(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted
}

/// The mean of one value or more, unchecked.
pub(super) fn centre(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    mean + values.iter().map(|value| value - mean).sum::<f64>() / count
}

/// The sum of squared deviations from the mean of one value or more, unchecked.
pub(super) fn squares(values: &[f64]) -> f64 {
    let mean = centre(values);
    values.iter().map(|value| (value - mean) * (value - mean)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand() {
        let summary = Summary::of(&[4.0, 1.0, 7.0]);
        assert_eq!(
            summary,
            Ok(Summary {
                count: 3,
                mean: 4.0,
                standard_deviation: Some(3.0),
                standard_error: Some(3.0 / 3f64.sqrt()),
                minimum: 1.0,
                median: 4.0,
                maximum: 7.0
            })
        );
        assert_eq!(quantile(&[1.0, 2.0, 3.0, 4.0], 0.25), Ok(1.75));
        assert_eq!(quantile(&[1.0, 2.0, 3.0, 4.0], 1.0), Ok(4.0));
        assert_eq!(median(&[3.0, 1.0]), Ok(2.0));
    }

    #[test]
    fn a_large_offset_costs_no_digits() {
        let values: Vec<f64> = [4.0, 7.0, 13.0, 16.0].iter().map(|x| x + 1e9).collect();
        assert_eq!(variance(&values), Ok(30.0));
        // the textbook formula, a broken twin, loses it
        let (n, sum) = (4.0, values.iter().sum::<f64>());
        let twin = (values.iter().map(|x| x * x).sum::<f64>() - sum * sum / n) / 3.0;
        assert!((twin - 30.0).abs() > 1.0);
    }

    #[test]
    fn little_and_bad_input() {
        assert_eq!(Summary::of(&[2.0]).map(|one| (one.standard_deviation, one.median)), Ok((None, 2.0)));
        let few = |found, needed| StatisticsError::TooFew { what: "values in the sample".into(), needed, found };
        assert_eq!(Summary::of(&[]), Err(few(0, 1)));
        assert_eq!(variance(&[2.0]), Err(few(1, 2)));
        let error = mean(&[1.0, f64::NAN]).map_err(|error| error.to_string());
        assert_eq!(error, Err("value 1 of the sample is NaN; statistics need finite numbers".into()));
        assert_eq!(variance(&[1e200, -1e200]), Err(StatisticsError::TooLarge { what: "a variance".into() }));
        assert!(quantile(&[1.0], 1.5).is_err() && quantile(&[1.0], f64::NAN).is_err());
        assert_eq!(median(&[f64::MAX, f64::MAX]), Ok(f64::MAX));
    }
}
