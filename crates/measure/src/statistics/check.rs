//! What every statistic asks of its input: finite values, enough of them, numbers in range.

use super::StatisticsError;
use super::descriptive::squares;

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

/// The differences of pairs, at least `needed` of them.
pub(super) fn differences(first: &[f64], second: &[f64], needed: usize) -> Result<Vec<f64>, StatisticsError> {
    pairs(first, second, needed)?;
    let difference = |(a, b): (&f64, &f64)| not_overflown("a difference", a - b);
    first.iter().zip(second).map(difference).collect()
}

/// Two samples whose values belong together, pair by pair, at least `needed` of them.
pub(super) fn pairs(first: &[f64], second: &[f64], needed: usize) -> Result<(), StatisticsError> {
    if first.len() != second.len() {
        let what = "the second sample of pairs".to_owned();
        return Err(StatisticsError::Lengths { what, expected: first.len(), found: second.len() });
    }
    values("the first sample", first, needed)?;
    values("the second sample", second, needed)
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

/// The variance of two values or more, which must have spread.
pub(super) fn spread_of(what: &str, values: &[f64]) -> Result<f64, StatisticsError> {
    let squares = not_overflown("a variance", squares(values))?;
    spread(what, squares, values.len(), size(values))?;
    Ok(squares / (values.len() - 1) as f64)
}

/// The variance within two samples, three values or more in both together.
pub(super) fn pooled_variance(first: &[f64], second: &[f64]) -> Result<f64, StatisticsError> {
    values("the first sample", first, 1)?;
    values("the second sample", second, 1)?;
    at_least("values in both samples", 3, first.len() + second.len())?;
    let squares = not_overflown("a variance", squares(first) + squares(second))?;
    let count = first.len() + second.len();
    spread("within the samples", squares, count, size(first).max(size(second)))?;
    Ok(squares / (count - 2) as f64)
}

/// The largest magnitude among values.
pub(super) fn size(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()))
}
