//! What every statistic asks of its input: finite values, enough of them, numbers in range.

use super::StatisticsError;

/// At least `needed` finite values.
pub(super) fn values(what: &str, values: &[f64], needed: usize) -> Result<(), StatisticsError> {
    finite(what, values)?;
    at_least(&format!("values in {what}"), needed, values.len())
}

/// Every value finite.
pub(super) fn finite(what: &str, values: &[f64]) -> Result<(), StatisticsError> {
    match values.iter().position(|value| !value.is_finite()) {
        Some(place) => Err(StatisticsError::NotFinite { what: what.to_owned(), place, found: values[place] }),
        None => Ok(()),
    }
}

/// At least two groups of at least `needed` finite values each.
pub(super) fn groups(groups: &[&[f64]], needed: usize) -> Result<(), StatisticsError> {
    at_least("groups", 2, groups.len())?;
    groups.iter().enumerate().try_for_each(|(group, of)| values(&format!("group {group}"), of, needed))
}

/// A count that is large enough.
pub(super) fn at_least(what: &str, needed: usize, found: usize) -> Result<(), StatisticsError> {
    if found < needed { Err(StatisticsError::TooFew { what: what.to_owned(), needed, found }) } else { Ok(()) }
}

/// A number between 0 and 1, both excluded.
pub(super) fn between_0_and_1(what: &'static str, found: f64) -> Result<(), StatisticsError> {
    in_range(what, "more than 0 and less than 1", found, found > 0.0 && found < 1.0)
}

/// A number in its range; NaN is in none.
pub(super) fn in_range(
    what: &'static str,
    expected: &'static str,
    found: f64,
    holds: bool,
) -> Result<(), StatisticsError> {
    if holds { Ok(()) } else { Err(StatisticsError::Range { what, expected, found }) }
}

/// A number that overflowed is told as such.
pub(super) fn not_overflown(what: &str, value: f64) -> Result<f64, StatisticsError> {
    if value.is_finite() { Ok(value) } else { Err(StatisticsError::TooLarge { what: what.to_owned() }) }
}

/// A spread that is more than what rounding leaves of equal values of this size.
///
/// `squares` is a sum of squared deviations of `count` values none of which is larger than `size`.
pub(super) fn spread(what: &str, squares: f64, count: usize, size: f64) -> Result<(), StatisticsError> {
    let rounding = size * f64::EPSILON * 4.0;
    if squares <= rounding * rounding * count as f64 {
        Err(StatisticsError::NoSpread { what: what.to_owned() })
    } else {
        Ok(())
    }
}

/// The largest magnitude among values.
pub(super) fn size(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()))
}
