//! The bootstrap of a series whose neighbouring values depend on each other.

use super::{Estimate, Resampling, drawable};
use crate::statistics::{StatisticsError, check};

/// How a series is cut. Blocks should be a few autocorrelation times long (see
/// [`autocorrelation_time`](crate::statistics::autocorrelation_time)) and still many.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blocks {
    /// Blocks of this length from anywhere in the series (Kuensch 1989, Ann. Stat. 17:1217).
    Moving(usize),
    /// Blocks of random length with this mean, in a series closed to a ring: replicates are stationary (Politis & Romano
    /// 1994, J. Am. Stat. Assoc. 89:1303).
    Stationary(usize),
}

/// A statistic of a stationary series, with the interval between quantiles of its replicates.
///
/// # Errors
/// For fewer than two values, one that is not finite, a block length of 0 or more than half the series, a statistic that is
/// undefined for the series or for too many replicates, a confidence outside 0 and 1, or fewer than 100 replicates.
pub fn block_bootstrap(
    series: &[f64],
    blocks: Blocks,
    statistic: impl Fn(&[f64]) -> Option<f64>,
    resampling: &Resampling,
) -> Result<Estimate, StatisticsError> {
    check::values("the series", series, 2)?;
    resampling.check()?;
    drawable(series.len())?;
    let (Blocks::Moving(length) | Blocks::Stationary(length)) = blocks;
    let fits = length >= 1 && 2 * length <= series.len();
    check::in_range("the length of a block", "from 1 to half the series", length as f64, fits)?;
    let statistic = |values: &[f64]| statistic(values).filter(|value| value.is_finite());
    let Some(value) = statistic(series) else {
        return Err(StatisticsError::NoSpread { what: "in the series (the statistic is undefined)".into() });
    };
    let replicates = (0..resampling.replicates)
        .filter_map(|replicate| {
            let places = places(series.len(), blocks, replicate, resampling);
            statistic(&places.iter().map(|&place| series[place]).collect::<Vec<_>>())
        })
        .collect();
    let outside = 0.5 * (1.0 - resampling.confidence);
    resampling.estimate(value, replicates, |_| [outside, 1.0 - outside])
}

/// The places in the series that a replicate takes, as many as it has values.
fn places(count: usize, blocks: Blocks, replicate: u32, resampling: &Resampling) -> Vec<usize> {
    let mut places: Vec<usize> = Vec::with_capacity(count);
    for place in 0..count {
        // two draws for each place: where a block would begin, and whether one does
        let draw = 2 * place as u32;
        let (begins, starts) = match blocks {
            Blocks::Moving(length) => (place % length == 0, count - length + 1),
            Blocks::Stationary(length) => (resampling.draw(replicate, draw + 1) * (length as f64) < 1.0, count),
        };
        places.push(match places.last() {
            Some(last) if !begins => (last + 1) % count,
            _ => resampling.place(replicate, draw, starts),
        });
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::mean;
    use space::random::{Purpose, Stream};

    /// An autoregressive series of the first order.
    fn series(count: u64, memory: f64) -> Vec<f64> {
        let mut last = 0.0;
        (0..count)
            .map(|step| {
                last = memory * last + Stream::new(3, Purpose::Behaviour, step, 0).normal(0);
                last
            })
            .collect()
    }

    #[test]
    fn sees_the_dependence() {
        let series = series(20_000, 0.8);
        let of = |blocks| {
            let resampling = Resampling { replicates: 200, ..Resampling::default() };
            block_bootstrap(&series, blocks, |values| mean(values).ok(), &resampling).unwrap().standard_error
        };
        // sd of the mean: 1 / (1 - 0.8) / sqrt(n)
        let exact = 5.0 / 20_000f64.sqrt();
        for blocks in [Blocks::Moving(80), Blocks::Stationary(80)] {
            assert!((of(blocks) / exact - 1.0).abs() < 0.2, "{blocks:?}: {} {exact}", of(blocks));
        }
        // the broken twin: single values
        assert!(of(Blocks::Moving(1)) < 0.5 * exact);
    }

    #[test]
    fn blocks_are_runs_of_the_series() {
        let resampling = Resampling::default();
        let moving = places(12, Blocks::Moving(4), 7, &resampling);
        assert!(moving.chunks(4).all(|block| block.windows(2).all(|two| two[1] == two[0] + 1)));
        let runs = (0..500)
            .map(|replicate| {
                let places = places(40, Blocks::Stationary(5), replicate, &resampling);
                places.windows(2).filter(|two| two[1] != (two[0] + 1) % 40).count()
            })
            .sum::<usize>() as f64;
        // a new block at each of 39 places with the probability 1/5, but for the same place by chance
        assert!((runs / 500.0 - 39.0 / 5.0 * 39.0 / 40.0).abs() < 0.4);
    }

    #[test]
    fn bad_input() {
        let of = |series: &[f64], blocks| {
            block_bootstrap(series, blocks, |values| mean(values).ok(), &Resampling::default()).is_err()
        };
        assert!(of(&[1.0], Blocks::Moving(1)) && of(&[1.0, 2.0, 3.0], Blocks::Moving(2)));
        assert!(of(&[1.0, 2.0, 3.0], Blocks::Stationary(0)) && of(&[1.0, f64::NAN], Blocks::Moving(1)));
        assert!(!of(&[1.0, 2.0], Blocks::Moving(1)));
    }
}
