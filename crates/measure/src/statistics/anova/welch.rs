//! One-way analysis of variance without equal variances.

use crate::statistics::descriptive::Summary;
use crate::statistics::{StatisticsError, check, distribution};

/// Welch's analysis of variance.
#[derive(Clone, Debug, PartialEq)]
pub struct Welch {
    /// Each group in a few numbers, in the order given.
    pub groups: Vec<Summary>,
    /// Welch's F.
    pub f: f64,
    /// Degrees of freedom between groups.
    pub between: f64,
    /// Approximate degrees of freedom within groups.
    pub within: f64,
    /// P(F > f) if all means were equal.
    pub p: f64,
}

/// Are the means of independent groups equal, whatever their variances?
///
/// Each mean weighs n / s^2 (Welch 1951, Biometrika 38:330; statsmodels `anova_oneway(use_var="unequal")`). Assumes
/// independent values, about normal within groups.
///
/// # Errors
/// For fewer than two groups, fewer than two values in one, a value that is not finite, a group without spread, or values
/// too large for their squares.
pub fn welch_anova(groups: &[&[f64]]) -> Result<Welch, StatisticsError> {
    check::groups(groups, 2)?;
    let (mut summaries, mut weights) = (Vec::new(), Vec::new());
    for (group, values) in groups.iter().enumerate() {
        let summary = Summary::of(values)?;
        let error = check::spread_of(&format!("in group {group}"), values)?;
        weights.push(1.0 / (error / values.len() as f64));
        summaries.push(summary);
    }
    let total: f64 = weights.iter().sum();
    let count = groups.len() as f64;
    let centre = summaries.iter().zip(&weights).map(|(group, weight)| weight / total * group.mean).sum::<f64>();
    let between =
        summaries.iter().zip(&weights).map(|(group, weight)| weight * (group.mean - centre).powi(2)).sum::<f64>();
    let uncertain: f64 = summaries
        .iter()
        .zip(&weights)
        .map(|(group, weight)| (1.0 - weight / total).powi(2) / (group.count - 1) as f64)
        .sum();
    let correction = 1.0 + 2.0 * (count - 2.0) / (count * count - 1.0) * uncertain;
    let f = check::not_overflown("F", between / (count - 1.0) / correction)?;
    let within = (count * count - 1.0) / (3.0 * uncertain);
    Ok(Welch { groups: summaries, f, between: count - 1.0, within, p: distribution::f_tail(f, count - 1.0, within) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::{one_way, welch_t_test};

    #[test]
    fn two_groups_are_welch_t() {
        let (a, b) = ([1.0, 2.0, 4.0, 2.5], [3.0, 14.0, 6.0]);
        let (anova, test) = (welch_anova(&[&a, &b]).unwrap(), welch_t_test(&a, &b, 0.95).unwrap());
        assert!((anova.f - test.t * test.t).abs() < 1e-12 && (anova.within - test.degrees).abs() < 1e-12);
        assert!((anova.p - test.p).abs() < 1e-12);
        // the broken twin pools the variances
        assert!((one_way(&[&a, &b]).unwrap().effect.p - anova.p).abs() > 0.01);
    }

    #[test]
    fn bad_input() {
        assert!(welch_anova(&[&[1.0, 2.0], &[3.0]]).is_err());
        assert!(welch_anova(&[&[1.0, 2.0], &[3.0, 3.0]]).is_err_and(|error| error.to_string().contains("in group 1")));
    }
}
