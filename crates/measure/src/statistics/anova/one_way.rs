//! One-way analysis of variance.

use super::{Effect, Residual};
use crate::statistics::descriptive::{Summary, centre, squares};
use crate::statistics::{StatisticsError, check};

/// A one-way analysis of variance.
#[derive(Clone, Debug, PartialEq)]
pub struct OneWay {
    /// Each group in a few numbers, in the order given.
    pub groups: Vec<Summary>,
    /// Between the groups.
    pub effect: Effect,
    /// Within the groups.
    pub residual: Residual,
    /// Share of the variance that the groups explain: SS_between / SS_total.
    pub eta_squared: f64,
    /// The same for the population, with less bias: (SS_b - df_b MS_w) / (SS_total + MS_w); may be below zero.
    pub omega_squared: f64,
}

/// Are the means of independent groups equal?
///
/// F = MS_between / MS_within with k - 1 and n - k degrees of freedom (Fisher 1925; `scipy.stats.f_oneway`). Assumes
/// independent values, normal within groups of equal variance; for unequal variances see
/// [`welch_anova`](crate::statistics::welch_anova). Sizes may differ, and a group may hold one value.
///
/// # Errors
/// For fewer than two groups, an empty one, no more values than groups, a value that is not finite, values that are all
/// equal within their groups, or too large for their squares.
pub fn one_way(groups: &[&[f64]]) -> Result<OneWay, StatisticsError> {
    check::groups(groups, 1)?;
    let all = groups.concat();
    let summaries = groups.iter().map(|group| Summary::of(group)).collect::<Result<Vec<_>, _>>()?;
    let grand = centre(&all);
    let between = summaries.iter().map(|group| group.count as f64 * (group.mean - grand) * (group.mean - grand)).sum();
    let within: f64 = groups.iter().map(|group| squares(group)).sum();
    let residual = Residual::new(within, all.len() - groups.len())?;
    check::spread("within the groups", within, all.len(), check::size(&all))?;
    let effect = Effect::new(between, groups.len() - 1, &residual)?;
    let omega = (effect.sum_of_squares - effect.degrees * residual.mean_square)
        / (effect.sum_of_squares + residual.sum_of_squares + residual.mean_square);
    Ok(OneWay {
        groups: summaries,
        effect,
        residual,
        eta_squared: effect.partial_eta_squared(&residual),
        omega_squared: omega,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand() {
        // means 2, 3, 7; grand mean 4; within: three times 2, six degrees
        let anova = one_way(&[&[1.0, 2.0, 3.0], &[2.0, 3.0, 4.0], &[6.0, 7.0, 8.0]]).unwrap();
        assert_eq!((anova.effect.sum_of_squares, anova.residual.sum_of_squares), (42.0, 6.0));
        assert_eq!((anova.effect.degrees, anova.residual.degrees, anova.effect.f), (2.0, 6.0, 21.0));
        // with two degrees above, P(F > f) = (1 + 2 f / df)^(-df / 2)
        assert!((anova.effect.p - 8f64.powi(-3)).abs() < 1e-16);
        assert_eq!((anova.eta_squared, anova.omega_squared), (42.0 / 48.0, 40.0 / 49.0));
    }

    #[test]
    fn little_and_bad_input() {
        let error = |groups: &[&[f64]]| one_way(groups).map_err(|error| error.to_string()).map(|_| ());
        assert_eq!(error(&[&[1.0, 2.0]]), Err("at least 2 groups are needed, found 1".into()));
        assert_eq!(error(&[&[1.0, 2.0], &[]]), Err("at least 1 values in group 1 are needed, found 0".into()));
        assert_eq!(
            error(&[&[1.0], &[2.0]]),
            Err("at least 1 degrees of freedom in the residual are needed, found 0".into())
        );
        let equal = Err("all values are equal within the groups: there is no spread to compare with".into());
        assert_eq!(error(&[&[1.0, 1.0], &[2.0, 2.0]]), equal);
        // equal but for rounding
        assert_eq!(error(&[&[0.1 + 0.2, 0.3], &[0.3, 0.3]]), equal);
        assert!(error(&[&[1.0, f64::NAN], &[2.0, 2.0]]).is_err());
        assert_eq!(
            error(&[&[1e200, 2e200], &[1.0, 3.0]]),
            Err("a variance: the values are too large for f64; use a larger unit".into())
        );
        assert_eq!(error(&[&[1.0, 2.0], &[3.0]]), Ok(()));
    }
}
