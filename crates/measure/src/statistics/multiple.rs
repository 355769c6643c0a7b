//! Several tests at once.

use super::{StatisticsError, check};

/// What is kept under control where several hypotheses are tested.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Correction {
    /// The probability of any false rejection: p times the number of tests.
    Bonferroni,
    /// The same, never less powerful: step down (Holm 1979).
    Holm,
    /// The share of false rejections among the rejections, for independent or positively dependent tests: step up
    /// (Benjamini & Hochberg 1995).
    BenjaminiHochberg,
    /// The same under any dependence (Benjamini & Yekutieli 2001).
    BenjaminiYekutieli,
}

/// p values adjusted for their number: reject where the adjusted value is at most the level.
///
/// In the order given; equal to `multipletests` of statsmodels (`bonferroni`, `holm`, `fdr_bh`, `fdr_by`).
///
/// # Errors
/// Where a value is not in 0..=1.
pub fn adjust(p: &[f64], correction: Correction) -> Result<Vec<f64>, StatisticsError> {
    for &p in p {
        check::in_range("a p value", "from 0 to 1", p, (0.0..=1.0).contains(&p))?;
    }
    Ok(adjusted(p, correction))
}

/// [`adjust`], unchecked.
pub(super) fn adjusted(p: &[f64], correction: Correction) -> Vec<f64> {
    let count = p.len() as f64;
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|&a, &b| p[a].total_cmp(&p[b]));
    let mut adjusted = vec![0.0; p.len()];
    match correction {
        Correction::Bonferroni => return p.iter().map(|p| (p * count).min(1.0)).collect(),
        Correction::Holm => {
            let mut largest: f64 = 0.0;
            for (rank, &place) in order.iter().enumerate() {
                largest = largest.max(p[place] * (count - rank as f64)).min(1.0);
                adjusted[place] = largest;
            }
        }
        Correction::BenjaminiHochberg | Correction::BenjaminiYekutieli => {
            let dependence = match correction {
                Correction::BenjaminiYekutieli => (1..=p.len()).map(|rank| 1.0 / rank as f64).sum(),
                _ => 1.0,
            };
            let mut least: f64 = 1.0;
            for (rank, &place) in order.iter().enumerate().rev() {
                least = least.min(p[place] * count * dependence / (rank + 1) as f64);
                adjusted[place] = least;
            }
        }
    }
    adjusted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand() {
        let p = [0.04, 0.01, 0.03];
        let close = |correction, wanted: [f64; 3]| {
            for (ours, wanted) in adjust(&p, correction).unwrap().iter().zip(wanted) {
                assert!((ours - wanted).abs() < 1e-15, "{correction:?}: {ours} {wanted}");
            }
        };
        close(Correction::Bonferroni, [0.12, 0.03, 0.09]);
        close(Correction::Holm, [0.06, 0.03, 0.06]);
        close(Correction::BenjaminiHochberg, [0.04, 0.03, 0.04]);
        close(Correction::BenjaminiYekutieli, [0.04 * 11.0 / 6.0, 0.03 * 11.0 / 6.0, 0.04 * 11.0 / 6.0]);
    }

    #[test]
    fn none_one_and_bad() {
        assert_eq!(adjust(&[], Correction::Holm), Ok(vec![]));
        assert_eq!(adjust(&[0.2], Correction::BenjaminiYekutieli), Ok(vec![0.2]));
        assert_eq!(adjust(&[0.9, 0.8], Correction::Bonferroni), Ok(vec![1.0, 1.0]));
        assert!(adjust(&[0.2, 1.2], Correction::Holm).is_err() && adjust(&[f64::NAN], Correction::Holm).is_err());
    }
}
