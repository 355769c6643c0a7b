//! How large a difference is, whatever the number of trials.

use super::descriptive::centre;
use super::resampling::{Estimate, Resampling, bootstrap, bootstrap_rows};
use super::two_samples::{mann_whitney, signed_ranks};
use super::{StatisticsError, check, one_way};

/// A measure of effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EffectSize {
    /// Two samples: difference of means over the pooled standard deviation (Cohen 1988).
    CohenD,
    /// The same without its bias in small samples: times Gamma(m / 2) / (sqrt(m / 2) Gamma((m - 1) / 2)), m = n - 2 (Hedges
    /// 1981).
    HedgesG,
    /// Pairs: mean difference over the standard deviation of the differences.
    PairedDz,
    /// Groups: share of the variance that they explain.
    EtaSquared,
    /// Groups: the same for the population, with less bias.
    OmegaSquared,
    /// Two samples: probability that a value of the first is greater, less the probability that it is smaller (Cliff's
    /// delta).
    RankBiserial,
    /// Pairs: share of the ranks of differences that favour the first, less that of the second (Kerby 2014).
    PairedRankBiserial,
}

impl EffectSize {
    /// Of these samples: two, pairs in two, or any number of groups.
    ///
    /// # Errors
    /// For another number of samples, too few values, one that is not finite, no spread, or values too large for their
    /// squares.
    pub fn of(self, samples: &[&[f64]]) -> Result<f64, StatisticsError> {
        if let Self::EtaSquared | Self::OmegaSquared = self {
            let anova = one_way(samples)?;
            return Ok(if self == Self::EtaSquared { anova.eta_squared } else { anova.omega_squared });
        }
        let [first, second] = samples else {
            let what = "an effect size of two samples".into();
            return Err(StatisticsError::Lengths { what, expected: 2, found: samples.len() });
        };
        match self {
            Self::CohenD => cohen_d(first, second),
            Self::HedgesG => {
                let degrees = (first.len() + second.len()) as f64 - 2.0;
                Ok(cohen_d(first, second)? * small_sample(degrees))
            }
            Self::PairedDz => {
                let differences = check::differences(first, second, 2)?;
                let deviation = check::spread_of("in the differences", &differences)?.sqrt();
                Ok(centre(&differences) / deviation)
            }
            Self::PairedRankBiserial => {
                let (differing, positive, negative, _) = signed_ranks(&check::differences(first, second, 1)?);
                if differing == 0 {
                    return Err(StatisticsError::NoSpread { what: "within the pairs".into() });
                }
                Ok((positive - negative) / (positive + negative))
            }
            _ => Ok(2.0 * mann_whitney(first, second)?.u / (first.len() * second.len()) as f64 - 1.0),
        }
    }

    /// Of these samples, with its BCa interval over resampled values (of pairs: over resampled pairs).
    ///
    /// # Errors
    /// As [`EffectSize::of`] and [`bootstrap`].
    pub fn estimate(self, samples: &[&[f64]], resampling: &Resampling) -> Result<Estimate, StatisticsError> {
        self.of(samples)?;
        let statistic = |samples: &[&[f64]]| self.of(samples).ok();
        match self {
            Self::PairedDz | Self::PairedRankBiserial => bootstrap_rows(samples, statistic, resampling),
            _ => bootstrap(samples, statistic, resampling),
        }
    }
}

fn cohen_d(first: &[f64], second: &[f64]) -> Result<f64, StatisticsError> {
    let variance = check::pooled_variance(first, second)?;
    check::not_overflown("an effect size", (centre(first) - centre(second)) / variance.sqrt())
}

/// Hedges' factor for one degree of freedom or more; it is 0 for one.
fn small_sample(degrees: f64) -> f64 {
    if degrees <= 1.0 {
        return 0.0;
    }
    libm::exp(libm::lgamma(0.5 * degrees) - libm::lgamma(0.5 * (degrees - 1.0))) / (0.5 * degrees).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: [f64; 3] = [1.0, 2.0, 3.0];
    const B: [f64; 3] = [3.0, 4.0, 5.0];

    #[test]
    fn by_hand() {
        let of = |effect: EffectSize| effect.of(&[&A, &B]).unwrap();
        assert_eq!(of(EffectSize::CohenD), -2.0);
        // four degrees: Gamma(2) / (sqrt 2 Gamma(3/2)) = sqrt(2 / pi)
        assert!((of(EffectSize::HedgesG) + 2.0 * core::f64::consts::FRAC_2_PI.sqrt()).abs() < 1e-14);
        // of nine pairs eight are smaller and one is equal
        assert!((of(EffectSize::RankBiserial) + 8.0 / 9.0).abs() < 1e-15);
        assert!((of(EffectSize::EtaSquared) - 0.6).abs() < 1e-15);
        let pairs = |effect: EffectSize| effect.of(&[&[2.0, 4.0, 9.0, 0.0], &[1.0, 2.0, 6.0, 4.0]]).unwrap();
        // differences 1 2 3 -4
        assert!((pairs(EffectSize::PairedDz) - 0.5 / (29.0 / 3.0f64).sqrt()).abs() < 1e-15);
        assert!((pairs(EffectSize::PairedRankBiserial) - 0.2).abs() < 1e-15);
    }

    #[test]
    fn the_interval_holds_the_value() {
        let (first, second): (Vec<f64>, Vec<f64>) =
            (0..30).map(|i| (f64::from(i * 7 % 30), f64::from(i * 11 % 30) + 9.0)).unzip();
        for effect in [
            EffectSize::CohenD,
            EffectSize::HedgesG,
            EffectSize::PairedDz,
            EffectSize::EtaSquared,
            EffectSize::OmegaSquared,
            EffectSize::RankBiserial,
            EffectSize::PairedRankBiserial,
        ] {
            let resampling = Resampling { replicates: 1_000, ..Resampling::default() };
            let estimate = effect.estimate(&[&first, &second], &resampling).unwrap();
            let (low, high) = (estimate.interval.low, estimate.interval.high);
            assert!(low < estimate.value && estimate.value < high, "{effect:?}: {low} {high}");
            // one value of the same numbers is their own
            assert_eq!(estimate.value, effect.of(&[&first, &second]).unwrap());
        }
    }

    #[test]
    fn bad_input() {
        assert!(EffectSize::CohenD.of(&[&A]).is_err() && EffectSize::CohenD.of(&[&[1.0, 1.0], &[2.0, 2.0]]).is_err());
        assert!(EffectSize::PairedDz.of(&[&A, &B]).is_err() && EffectSize::PairedDz.of(&[&A, &B[..2]]).is_err());
        assert!(EffectSize::PairedRankBiserial.of(&[&A, &A]).is_err());
        assert!(EffectSize::RankBiserial.of(&[&[1.0, f64::NAN], &B]).is_err());
        assert!(EffectSize::EtaSquared.of(&[&A]).is_err());
    }
}
