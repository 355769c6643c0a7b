//! Do groups have one variance?

use crate::statistics::descriptive::{centre, quantile_of_sorted, sorted};
use crate::statistics::{StatisticsError, check, distribution, one_way};

/// A test of equal variances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VarianceTest {
    /// Levene's W, which is an F, or Bartlett's chi squared.
    pub statistic: f64,
    /// Degrees of freedom between groups.
    pub between: f64,
    /// Degrees of freedom within groups; `None` for chi squared.
    pub within: Option<f64>,
    /// Probability of so large a statistic from groups of equal variance.
    pub p: f64,
}

/// Levene's test (1960): a one-way analysis of the distances to each group's mean (`scipy.stats.levene`,
/// `center="mean"`).
///
/// # Errors
/// As [`one_way`] of the distances.
pub fn levene(groups: &[&[f64]]) -> Result<VarianceTest, StatisticsError> {
    of_distances(groups, centre)
}

/// The test of Brown and Forsythe (1974): distances to each group's median, which stands skewed values better
/// (`scipy.stats.levene`, the default).
///
/// # Errors
/// As [`one_way`] of the distances.
pub fn brown_forsythe(groups: &[&[f64]]) -> Result<VarianceTest, StatisticsError> {
    of_distances(groups, |values| quantile_of_sorted(&sorted(values), 0.5))
}

fn of_distances(groups: &[&[f64]], middle: impl Fn(&[f64]) -> f64) -> Result<VarianceTest, StatisticsError> {
    check::groups(groups, 1)?;
    let distances: Vec<Vec<f64>> = groups
        .iter()
        .map(|group| {
            let middle = middle(group);
            group.iter().map(|value| (value - middle).abs()).collect()
        })
        .collect();
    let anova = one_way(&distances.iter().map(Vec::as_slice).collect::<Vec<_>>())?;
    Ok(VarianceTest {
        statistic: anova.effect.f,
        between: anova.effect.degrees,
        within: Some(anova.residual.degrees),
        p: anova.effect.p,
    })
}

/// Bartlett's test (1937): the pooled variance against the geometric mean of all (`scipy.stats.bartlett`). The most
/// powerful for normal values, and misled by others.
///
/// # Errors
/// For fewer than two groups, fewer than two values in one, a value that is not finite, a group without spread, or values
/// too large for their squares.
pub fn bartlett(groups: &[&[f64]]) -> Result<VarianceTest, StatisticsError> {
    check::groups(groups, 2)?;
    let (mut within, mut pooled, mut logs, mut inverse) = (0.0, 0.0, 0.0, 0.0);
    for (group, values) in groups.iter().enumerate() {
        let variance = check::spread_of(&format!("in group {group}"), values)?;
        let degrees = (values.len() - 1) as f64;
        within += degrees;
        pooled += degrees * variance;
        logs += degrees * libm::log(variance);
        inverse += 1.0 / degrees;
    }
    let between = (groups.len() - 1) as f64;
    let pooled = check::not_overflown("a variance", pooled / within)?;
    let statistic = (within * libm::log(pooled) - logs) / (1.0 + (inverse - 1.0 / within) / (3.0 * between));
    let statistic = statistic.max(0.0);
    Ok(VarianceTest { statistic, between, within: None, p: distribution::chi_squared_tail(statistic, between) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand() {
        // distances 1 0 1 and 2 0 2: means 2/3 and 4/3, squares within 2/3 and 8/3
        let groups: [&[f64]; 2] = [&[1.0, 2.0, 3.0], &[0.0, 2.0, 4.0]];
        for test in [levene(&groups).unwrap(), brown_forsythe(&groups).unwrap()] {
            assert!((test.statistic - (2.0 / 3.0) / (10.0 / 3.0 / 4.0)).abs() < 1e-14);
        }
        // variances 1 and 4, pooled 2.5: (4 ln 2.5 - 2 ln 4) / (1 + (1 - 1/4) / 3)
        let test = bartlett(&groups).unwrap();
        assert!((test.statistic - (4.0 * libm::log(2.5) - 2.0 * libm::log(4.0)) / 1.25).abs() < 1e-14);
        // mean and median are the broken twins of each other
        let skewed: [&[f64]; 2] = [&[1.0, 2.0, 9.0], &[0.0, 2.0, 4.0]];
        assert!((levene(&skewed).unwrap().statistic - brown_forsythe(&skewed).unwrap().statistic).abs() > 0.1);
        // sizes do not matter where variances are equal
        assert!(bartlett(&[&[1.0, 2.0, 3.0], &[7.0, 8.0, 9.0]]).unwrap().p > 1.0 - 1e-7);
    }

    #[test]
    fn bad_input() {
        assert!(bartlett(&[&[1.0, 1.0], &[1.0, 2.0]]).is_err() && bartlett(&[&[1.0], &[1.0, 2.0]]).is_err());
        assert!(levene(&[&[1.0, 2.0]]).is_err() && levene(&[&[1.0, f64::NAN], &[1.0, 2.0]]).is_err());
    }
}
