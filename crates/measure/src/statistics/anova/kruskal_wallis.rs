//! One-way analysis of variance by ranks.

use crate::statistics::rank::ranked;
use crate::statistics::{StatisticsError, check, distribution};

/// The test of Kruskal and Wallis.
#[derive(Clone, Debug, PartialEq)]
pub struct KruskalWallis {
    /// H, corrected for ties.
    pub h: f64,
    /// Degrees of freedom: groups less one.
    pub degrees: f64,
    /// P(chi squared > H) if all groups had one distribution.
    pub p: f64,
    /// Mean rank of each group.
    pub mean_ranks: Vec<f64>,
}

/// Do independent groups come from one distribution, whatever it is?
///
/// H from the mean ranks, divided by 1 - sum(t^3 - t) / (n^3 - n) for runs of t ties; p from chi squared, which is good for
/// groups of five values or more (Kruskal & Wallis 1952; `scipy.stats.kruskal`).
///
/// # Errors
/// For fewer than two groups, an empty one, a value that is not finite, or all values equal.
pub fn kruskal_wallis(groups: &[&[f64]]) -> Result<KruskalWallis, StatisticsError> {
    check::groups(groups, 1)?;
    let (ranks, ties) = ranked(&groups.concat());
    let count = ranks.len() as f64;
    let correction = 1.0 - ties / (count * (count * count - 1.0));
    if correction <= 0.0 {
        return Err(StatisticsError::NoSpread { what: "in all groups".into() });
    }
    let (mut start, mut mean_ranks, mut between) = (0, Vec::new(), 0.0);
    for group in groups {
        let mean = ranks[start..start + group.len()].iter().sum::<f64>() / group.len() as f64;
        between += group.len() as f64 * (mean - 0.5 * (count + 1.0)).powi(2);
        mean_ranks.push(mean);
        start += group.len();
    }
    let h = 12.0 / (count * (count + 1.0)) * between / correction;
    let degrees = (groups.len() - 1) as f64;
    Ok(KruskalWallis { h, degrees, p: distribution::chi_squared_tail(h, degrees), mean_ranks })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand() {
        // ranks 1 2 3 and 4 5 6: H = 12 / 42 * 2 * 3 * 1.5^2
        let test = kruskal_wallis(&[&[1.0, 2.0, 3.0], &[10.0, 20.0, 30.0]]).unwrap();
        assert!((test.h - 27.0 / 7.0).abs() < 1e-12);
        assert_eq!(test.mean_ranks, [2.0, 5.0]);
        // only the order counts
        assert_eq!(kruskal_wallis(&[&[1.0, 2.0, 3.0], &[4.0, 5.0, 1e300]]).unwrap(), test);
        assert!(kruskal_wallis(&[&[1.0, 1.0], &[1.0]]).is_err());
    }
}
