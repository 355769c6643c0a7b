//! All pairs by the studentised range.

use super::{Pair, PairComparison, pairs_below};
use crate::statistics::anova::Residual;
use crate::statistics::{StatisticsError, Summary, check, distribution};

/// Which pairs of means differ, over all pairs at once?
///
/// q = |m_i - m_j| / sqrt(MSE / 2 (1 / n_i + 1 / n_j)), against the studentised range of k means with the degrees of
/// freedom of the residual (Tukey 1953, Kramer 1956; statsmodels `pairwise_tukeyhsd`, R `TukeyHSD`). The groups and the
/// residual are those of an analysis of variance, [`one_way`](crate::statistics::one_way) or
/// [`blocked`](crate::statistics::blocked), whose assumptions it shares. Exact for equal sizes, a little conservative
/// for unequal ones. `confidence` is that of all intervals together, and 1 - confidence the level of the letters.
///
/// # Errors
/// For fewer than two groups, an empty one, a residual without spread, or a confidence outside 0 and 1.
pub fn tukey_kramer(
    groups: &[Summary],
    residual: &Residual,
    confidence: f64,
) -> Result<PairComparison, StatisticsError> {
    check::at_least("groups", 2, groups.len())?;
    check::between_0_and_1("the confidence", confidence)?;
    for (group, summary) in groups.iter().enumerate() {
        check::at_least(&format!("values in group {group}"), 1, summary.count)?;
    }
    if residual.mean_square <= 0.0 {
        return Err(StatisticsError::NoSpread { what: "within the groups".into() });
    }
    let (count, degrees) = (groups.len(), residual.degrees);
    let critical = distribution::studentised_range_quantile(confidence, count, degrees);
    let compare = |(first, second): (usize, usize)| {
        let (a, b) = (&groups[first], &groups[second]);
        let difference = a.mean - b.mean;
        let error = (0.5 * residual.mean_square * (1.0 / a.count as f64 + 1.0 / b.count as f64)).sqrt();
        let statistic = difference.abs() / error;
        Pair {
            first,
            second,
            difference,
            statistic,
            degrees,
            p: distribution::studentised_range_tail(statistic, count, degrees),
            low: difference - critical * error,
            high: difference + critical * error,
        }
    };
    let means: Vec<f64> = groups.iter().map(|group| group.mean).collect();
    Ok(PairComparison::new(&means, pairs_below(count).map(compare).collect(), confidence))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::one_way;

    #[test]
    fn two_groups_are_a_t_test() {
        let anova = one_way(&[&[1.0, 2.0, 4.0], &[3.0, 4.0, 6.0, 7.0]]).unwrap();
        let compared = tukey_kramer(&anova.groups, &anova.residual, 0.95).unwrap();
        let pair = compared.pair(1, 0).unwrap();
        assert!((pair.p - anova.effect.p).abs() < 1e-12);
        assert!((pair.statistic.powi(2) - 2.0 * anova.effect.f).abs() < 1e-12);
        let half = distribution::t_two_sided_quantile(0.95, 5.0)
            * (anova.residual.mean_square * (1.0 / 3.0 + 1.0 / 4.0)).sqrt();
        assert!((pair.high - pair.difference - half).abs() < 1e-10);
        assert_eq!(compared.letters, ["a", "a"]);
        // the broken twin for independent pairs: Student's t in place of the range is another number for three groups
        let three = one_way(&[&[1.0, 2.0, 4.0], &[3.0, 4.0, 6.0], &[2.0, 3.0, 4.0]]).unwrap();
        let pair = tukey_kramer(&three.groups, &three.residual, 0.95).unwrap().pairs[0];
        let twin = distribution::t_two_sided(pair.statistic / 2f64.sqrt(), pair.degrees);
        assert!(pair.p > 1.5 * twin);
    }

    #[test]
    fn the_borderline_is_significant() {
        // p <= 0.05 counts: the confidence of the pair itself
        let anova = one_way(&[&[1.0, 2.0, 4.0], &[3.0, 4.0, 6.0, 7.0]]).unwrap();
        let p = tukey_kramer(&anova.groups, &anova.residual, 0.95).unwrap().pairs[0].p;
        assert_eq!(tukey_kramer(&anova.groups, &anova.residual, 1.0 - p).unwrap().letters, ["b", "a"]);
    }

    #[test]
    fn bad_input() {
        let anova = one_way(&[&[1.0, 2.0], &[3.0, 4.0]]).unwrap();
        assert!(tukey_kramer(&anova.groups[..1], &anova.residual, 0.95).is_err());
        assert!(tukey_kramer(&anova.groups, &anova.residual, 1.0).is_err());
        let none = Residual { sum_of_squares: 0.0, degrees: 2.0, mean_square: 0.0 };
        assert!(tukey_kramer(&anova.groups, &none, 0.95).is_err());
    }
}
