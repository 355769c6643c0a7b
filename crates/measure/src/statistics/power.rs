//! How many trials an effect needs to be seen.

use super::{StatisticsError, check, distribution};

/// What will be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Design {
    /// Independent groups, by a one-way analysis of variance. The effect is Cohen's f: the standard deviation of the
    /// true means over that within groups.
    OneWay {
        /// How many groups.
        groups: usize,
    },
    /// Two independent samples of equal size, by a two-sided t test. The effect is Cohen's d.
    TwoSamples,
    /// Pairs, by a two-sided t test of their differences. The effect is the mean difference over the standard deviation
    /// of the differences.
    Paired,
}

/// The probability that a test at this level finds an effect of this size with so many trials in each group (or pairs).
///
/// From the noncentral F and t (Cohen 1988; statsmodels `FTestAnovaPower`, `TTestIndPower`, `TTestPower`).
///
/// # Errors
/// For fewer than two groups or trials, an effect that is not a finite number of 0 or more, or a level outside 0 and 1.
pub fn power(design: Design, effect: f64, trials: usize, level: f64) -> Result<f64, StatisticsError> {
    check::between_0_and_1("the level", level)?;
    check::in_range("the effect", "finite and at least 0", effect, effect.is_finite() && effect >= 0.0)?;
    check::at_least("trials", 2, trials)?;
    let n = trials as f64;
    // beyond this every test sees it
    let two_sided = |degrees: f64, shift: f64| {
        let critical = distribution::t_two_sided_quantile(1.0 - level, degrees);
        let shift = shift.min(1e4);
        distribution::noncentral_t_tail(critical, degrees, shift)
            + distribution::noncentral_t_tail(critical, degrees, -shift)
    };
    let power = match design {
        Design::OneWay { groups } => {
            check::at_least("groups", 2, groups)?;
            let (between, within) = ((groups - 1) as f64, (groups * (trials - 1)) as f64);
            let critical = distribution::f_tail_quantile(level, between, within);
            let noncentrality = (effect * effect * n * groups as f64).min(1e6);
            distribution::noncentral_f_tail(critical, between, within, noncentrality)
        }
        Design::TwoSamples => two_sided(2.0 * (n - 1.0), effect * (0.5 * n).sqrt()),
        Design::Paired => two_sided(n - 1.0, effect * n.sqrt()),
    };
    Ok(power.min(1.0))
}

/// The least number of trials in each group (or pairs) with at least this [`power`].
///
/// # Errors
/// As [`power`]; also for a wanted power outside 0 and 1, and where a million trials are not enough.
pub fn trials_needed(design: Design, effect: f64, wanted: f64, level: f64) -> Result<usize, StatisticsError> {
    const MOST: usize = 1_000_000;
    check::between_0_and_1("the wanted power", wanted)?;
    let enough = |trials| power(design, effect, trials, level).map(|power| power >= wanted);
    let (mut few, mut many) = (1, 2);
    while !enough(many)? {
        check::in_range("the effect", "large enough to be seen in a million trials", effect, many < MOST)?;
        (few, many) = (many, (2 * many).min(MOST));
    }
    while many - few > 1 {
        let middle = few + (many - few) / 2;
        if enough(middle)? {
            many = middle;
        } else {
            few = middle;
        }
    }
    Ok(many)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn textbook_numbers() {
        // Cohen 1988: d = 0.5, 80 %, 5 % needs 64 in each group; pairs 34; f = 0.25 over 4 groups 45
        assert_eq!(trials_needed(Design::TwoSamples, 0.5, 0.8, 0.05), Ok(64));
        assert_eq!(trials_needed(Design::Paired, 0.5, 0.8, 0.05), Ok(34));
        assert_eq!(trials_needed(Design::OneWay { groups: 4 }, 0.25, 0.8, 0.05), Ok(45));
        // two groups: f is half of d
        let (f, t) = (power(Design::OneWay { groups: 2 }, 0.3, 20, 0.05), power(Design::TwoSamples, 0.6, 20, 0.05));
        assert!((f.unwrap() - t.unwrap()).abs() < 1e-10);
    }

    #[test]
    fn ends_and_bad_input() {
        // without an effect the power is the level
        assert!((power(Design::Paired, 0.0, 9, 0.05).unwrap() - 0.05).abs() < 1e-10);
        assert!(power(Design::TwoSamples, 1e300, 5, 0.05).unwrap() > 1.0 - 1e-12);
        assert_eq!(trials_needed(Design::TwoSamples, 1e3, 0.8, 0.05), Ok(2));
        assert!(
            trials_needed(Design::Paired, 0.0, 0.8, 0.05).is_err_and(|error| error.to_string().contains("million"))
        );
        assert!(power(Design::OneWay { groups: 1 }, 0.3, 9, 0.05).is_err());
        assert!(power(Design::Paired, 0.3, 1, 0.05).is_err() && power(Design::Paired, f64::NAN, 9, 0.05).is_err());
    }
}
