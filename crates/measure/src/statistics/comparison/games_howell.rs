//! All pairs without equal variances.

use super::{Pair, PairComparison, pairs_below};
use crate::statistics::descriptive::centre;
use crate::statistics::two_samples::welch_degrees;
use crate::statistics::{StatisticsError, check, distribution};

/// Which pairs of means differ, over all pairs at once and whatever the variances?
///
/// q = |m_i - m_j| / sqrt((s_i^2 / n_i + s_j^2 / n_j) / 2) against the studentised range with the degrees of freedom of
/// Welch's t for each pair (Games & Howell 1976, J. Educ. Stat. 1:113). Assumes independent values, about normal within
/// groups; for groups of six values or more.
///
/// # Errors
/// For fewer than two groups, fewer than two values in one, a value that is not finite, a group without spread, values
/// too large for their squares, or a confidence outside 0 and 1.
pub fn games_howell(groups: &[&[f64]], confidence: f64) -> Result<PairComparison, StatisticsError> {
    check::groups(groups, 2)?;
    check::between_0_and_1("the confidence", confidence)?;
    let means: Vec<f64> = groups.iter().map(|group| centre(group)).collect();
    let mut errors = Vec::new();
    for (group, values) in groups.iter().enumerate() {
        errors.push(check::spread_of(&format!("in group {group}"), values)? / values.len() as f64);
    }
    let compare = |(first, second): (usize, usize)| {
        let (a, b) = (errors[first], errors[second]);
        let degrees = welch_degrees(a, groups[first].len(), b, groups[second].len());
        let difference = means[first] - means[second];
        let error = (0.5 * (a + b)).sqrt();
        let statistic = difference.abs() / error;
        let critical = distribution::studentised_range_quantile(confidence, groups.len(), degrees);
        Pair {
            first,
            second,
            difference,
            statistic,
            degrees,
            p: distribution::studentised_range_tail(statistic, groups.len(), degrees),
            low: difference - critical * error,
            high: difference + critical * error,
        }
    };
    Ok(PairComparison::new(&means, pairs_below(groups.len()).map(compare).collect(), confidence))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::{one_way, tukey_kramer, welch_t_test};

    #[test]
    fn two_groups_are_welch_t() {
        let (a, b) = ([1.0, 2.0, 4.0, 2.5], [3.0, 14.0, 6.0]);
        let pair = games_howell(&[&a, &b], 0.9).unwrap().pairs[0];
        let test = welch_t_test(&a, &b, 0.9).unwrap();
        assert!((pair.p - test.p).abs() < 1e-11 && (pair.low - test.low).abs() < 1e-9);
        // the broken twin pools the variances
        let anova = one_way(&[&a, &b]).unwrap();
        assert!((tukey_kramer(&anova.groups, &anova.residual, 0.9).unwrap().pairs[0].p - pair.p).abs() > 0.01);
        assert!(games_howell(&[&a, &[1.0, 1.0]], 0.9).is_err());
    }
}
