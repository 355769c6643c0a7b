//! The bootstrap with its interval corrected for bias and skewness.

use super::{Estimate, Resampling, drawable};
use crate::statistics::descriptive::centre;
use crate::statistics::{StatisticsError, check, distribution};

/// A statistic of independent samples, with its BCa interval (Efron 1987, J. Am. Stat. Assoc. 82:171).
///
/// Each sample is resampled on its own; the acceleration is that of the jackknife over all samples, as in
/// `scipy.stats.bootstrap`. The statistic gives `None` where it is undefined; such replicates are left out, and at most
/// half may be. Assumes independent values; for series see [`block_bootstrap`](super::block_bootstrap).
///
/// # Errors
/// For no sample, fewer than two values in one, a value that is not finite, a statistic that is undefined for the values
/// or for too many replicates, a confidence outside 0 and 1, or fewer than 100 replicates.
pub fn bootstrap(
    samples: &[&[f64]],
    statistic: impl Fn(&[&[f64]]) -> Option<f64>,
    resampling: &Resampling,
) -> Result<Estimate, StatisticsError> {
    check::at_least("samples", 1, samples.len())?;
    for (place, sample) in samples.iter().enumerate() {
        check::values(&format!("group {place}"), sample, 2)?;
    }
    // which values of a replicate each sample keeps: its own places
    let sizes: Vec<usize> = samples.iter().map(|sample| sample.len()).collect();
    interval(&sizes, resampling, |chosen| {
        let drawn: Vec<Vec<f64>> = samples
            .iter()
            .zip(chosen)
            .map(|(sample, places)| places.iter().map(|&place| sample[place]).collect())
            .collect();
        statistic(&drawn.iter().map(Vec::as_slice).collect::<Vec<_>>())
    })
}

/// A statistic of columns whose values belong together row by row (pairs, points): rows are resampled. As
/// [`bootstrap`] in all else.
///
/// # Errors
/// As [`bootstrap`], and for columns of different length.
pub fn bootstrap_rows(
    columns: &[&[f64]],
    statistic: impl Fn(&[&[f64]]) -> Option<f64>,
    resampling: &Resampling,
) -> Result<Estimate, StatisticsError> {
    check::at_least("columns", 1, columns.len())?;
    for column in columns {
        check::pairs(columns[0], column, 2)?;
    }
    interval(&[columns[0].len()], resampling, |chosen| {
        let drawn: Vec<Vec<f64>> =
            columns.iter().map(|column| chosen[0].iter().map(|&row| column[row]).collect()).collect();
        statistic(&drawn.iter().map(Vec::as_slice).collect::<Vec<_>>())
    })
}

/// The estimate of a statistic of chosen places, for samples of these sizes.
fn interval(
    sizes: &[usize],
    resampling: &Resampling,
    statistic: impl Fn(&[Vec<usize>]) -> Option<f64>,
) -> Result<Estimate, StatisticsError> {
    resampling.check()?;
    drawable(sizes.iter().sum())?;
    let all: Vec<Vec<usize>> = sizes.iter().map(|&size| (0..size).collect()).collect();
    let statistic = |chosen: &[Vec<usize>]| statistic(chosen).filter(|value| value.is_finite());
    let Some(value) = statistic(&all) else {
        return Err(StatisticsError::NoSpread { what: "in the values (the statistic is undefined)".into() });
    };
    let replicates: Vec<f64> = (0..resampling.replicates)
        .filter_map(|replicate| {
            let mut draw = 0;
            let chosen: Vec<Vec<usize>> = sizes
                .iter()
                .map(|&size| {
                    let places = (draw..).take(size).map(|draw| resampling.place(replicate, draw, size)).collect();
                    draw += size as u32;
                    places
                })
                .collect();
            statistic(&chosen)
        })
        .collect();
    let acceleration = acceleration(&all, statistic);
    resampling.estimate(value, replicates, |sorted| {
        let count = sorted.len() as f64;
        // equal replicates count half, and no share is 0 or 1
        let below = sorted.partition_point(|&x| x < value) as f64;
        let not_above = sorted.partition_point(|&x| x <= value) as f64;
        let share = (0.5 * (below + not_above) / count).clamp(0.5 / count, 1.0 - 0.5 / count);
        let bias = distribution::normal_quantile(share);
        let outside = distribution::normal_quantile(0.5 * (1.0 - resampling.confidence));
        [outside, -outside].map(|z| {
            let shifted = bias + z;
            distribution::normal(bias + shifted / (1.0 - acceleration * shifted))
        })
    })
}

/// The acceleration, from the influence of each value when it is left out; 0 where that is undefined.
fn acceleration(all: &[Vec<usize>], statistic: impl Fn(&[Vec<usize>]) -> Option<f64>) -> f64 {
    let (mut cubes, mut squares) = (0.0, 0.0);
    for sample in 0..all.len() {
        let size = all[sample].len();
        let mut chosen = all.to_vec();
        let mut without = Vec::with_capacity(size);
        for left_out in 0..size {
            chosen[sample] = (0..size).filter(|&place| place != left_out).collect();
            match statistic(&chosen) {
                Some(value) => without.push(value),
                None => return 0.0,
            }
        }
        let (mean, size) = (centre(&without), size as f64);
        for value in without {
            let influence = (size - 1.0) * (mean - value) / size;
            squares += influence * influence;
            cubes += influence * influence * influence;
        }
    }
    let acceleration = cubes / (6.0 * squares * squares.sqrt());
    if acceleration.is_finite() { acceleration } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::{mean, mean_interval};

    fn mean_of(samples: &[&[f64]]) -> Option<f64> {
        mean(samples[0]).ok()
    }

    #[test]
    fn near_student_for_a_mean() {
        let values: Vec<f64> = (0..60).map(|i| distribution::normal_quantile((f64::from(i) + 0.5) / 60.0)).collect();
        let ours = bootstrap(&[&values], mean_of, &Resampling::default()).unwrap();
        let student = mean_interval(&values, 0.95).unwrap();
        assert!((ours.interval.low - student.low).abs() < 0.02 && (ours.interval.high - student.high).abs() < 0.02);
        assert_eq!(ours.value, mean(&values).unwrap());
        // the seed decides, and nothing else
        assert_eq!(bootstrap(&[&values], mean_of, &Resampling::default()).unwrap(), ours);
        let other = Resampling { seed: 1, ..Resampling::default() };
        assert_ne!(bootstrap(&[&values], mean_of, &other).unwrap().interval, ours.interval);
    }

    #[test]
    fn skewness_moves_the_interval() {
        let values: Vec<f64> = (0..40).map(|i| -libm::log1p(-(f64::from(i) + 0.5) / 40.0)).collect();
        let ours = bootstrap(&[&values], mean_of, &Resampling::default()).unwrap();
        // the broken twin, plain quantiles of the replicates, is further left
        let sorted = crate::statistics::descriptive::sorted(&ours.replicates);
        let twin = crate::statistics::descriptive::quantile_of_sorted(&sorted, 0.975);
        assert!(ours.interval.high > twin + 0.01, "{} {twin}", ours.interval.high);
    }

    #[test]
    fn little_and_bad_input() {
        let resampling = Resampling::default();
        let equal = bootstrap(&[&[2.0, 2.0, 2.0]], mean_of, &resampling).unwrap();
        assert_eq!((equal.interval.low, equal.interval.high, equal.standard_error), (2.0, 2.0, 0.0));
        assert!(bootstrap(&[&[2.0]], mean_of, &resampling).is_err());
        assert!(bootstrap(&[], mean_of, &resampling).is_err());
        assert!(bootstrap(&[&[1.0, 2.0]], |_| None, &resampling).is_err());
        assert!(bootstrap(&[&[1.0, 2.0]], mean_of, &Resampling { replicates: 3, ..resampling }).is_err());
        assert!(bootstrap_rows(&[&[1.0, 2.0], &[1.0]], mean_of, &resampling).is_err());
    }
}
