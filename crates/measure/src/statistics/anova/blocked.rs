//! Analysis of variance of a randomised complete block design.

use super::{Effect, Residual};
use crate::statistics::descriptive::{Summary, centre};
use crate::statistics::{StatisticsError, check};

/// An analysis of variance of treatments in blocks.
#[derive(Clone, Debug, PartialEq)]
pub struct Blocked {
    /// Each treatment in a few numbers, in the order given.
    pub groups: Vec<Summary>,
    /// Between the treatments.
    pub effect: Effect,
    /// Between the blocks.
    pub blocks: Effect,
    /// What is left; with one value per cell also the interaction of the two.
    pub residual: Residual,
}

/// Are the means of treatments equal, where every treatment met every block once?
///
/// A trial that was made with the same seed under every condition is a block: differences between trials (layouts,
/// starts) then no longer hide those between conditions. `groups` are `[treatments, blocks]`.
///
/// y = mean + treatment + block + error (Fisher 1935; statsmodels: `anova_lm` of `y ~ C(treatment) + C(block)`). Assumes
/// normal errors of equal variance and no interaction. Blocks with a missing cell are refused here; analyse those with
/// [`factorial`](crate::statistics::factorial) without interactions.
///
/// # Errors
/// For fewer than two treatments or blocks, treatments of different length, a value that is not finite, no spread in
/// the residual, or values too large for their squares.
pub fn blocked(groups: &[&[f64]]) -> Result<Blocked, StatisticsError> {
    check::groups(groups, 2)?;
    let (treatments, blocks) = (groups.len(), groups[0].len());
    for (treatment, values) in groups.iter().enumerate() {
        if values.len() != blocks {
            let what = format!("group {treatment} (one value per block)");
            return Err(StatisticsError::Lengths { what, expected: blocks, found: values.len() });
        }
    }
    let summaries = groups.iter().map(|group| Summary::of(group)).collect::<Result<Vec<_>, _>>()?;
    let all = groups.concat();
    let grand = centre(&all);
    let block_means: Vec<f64> =
        (0..blocks).map(|block| centre(&groups.iter().map(|values| values[block]).collect::<Vec<_>>())).collect();
    let square = |x: f64| x * x;
    let between = blocks as f64 * summaries.iter().map(|group| square(group.mean - grand)).sum::<f64>();
    let between_blocks = treatments as f64 * block_means.iter().map(|mean| square(mean - grand)).sum::<f64>();
    let mut rest = 0.0;
    for (group, values) in summaries.iter().zip(groups) {
        for (value, block) in values.iter().zip(&block_means) {
            rest += square((value - group.mean) - (block - grand));
        }
    }
    let residual = Residual::new(rest, (treatments - 1) * (blocks - 1))?;
    check::spread("once treatments and blocks are taken off", rest, all.len(), check::size(&all))?;
    Ok(Blocked {
        groups: summaries,
        effect: Effect::new(between, treatments - 1, &residual)?,
        blocks: Effect::new(between_blocks, blocks - 1, &residual)?,
        residual,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::one_way;

    #[test]
    fn by_hand() {
        // treatment means 2, 4; block means 1, 3, 5; residuals +-1/2 in the outer blocks
        let anova = blocked(&[&[0.5, 2.0, 3.5], &[1.5, 4.0, 6.5]]).unwrap();
        assert_eq!((anova.effect.sum_of_squares, anova.blocks.sum_of_squares), (6.0, 16.0));
        assert_eq!((anova.residual.sum_of_squares, anova.residual.degrees), (1.0, 2.0));
        assert_eq!((anova.effect.f, anova.blocks.f), (12.0, 16.0));
    }

    #[test]
    fn sees_what_differences_between_trials_hide() {
        let first = [10.0, 22.0, 31.0, 39.0];
        let second = [10.9, 23.1, 32.0, 40.1];
        assert!(blocked(&[&first, &second]).unwrap().effect.p < 0.001);
        // the broken twin that forgets the blocks
        assert!(one_way(&[&first, &second]).unwrap().effect.p > 0.5);
    }

    #[test]
    fn little_and_bad_input() {
        let error = |groups: &[&[f64]]| blocked(groups).map_err(|error| error.to_string()).map(|_| ());
        assert_eq!(
            error(&[&[1.0, 2.0], &[1.0, 2.0, 3.0]]),
            Err("group 1 (one value per block) must have 2 values, found 3".into())
        );
        assert!(error(&[&[1.0], &[2.0]]).is_err());
        // additive without error: nothing to compare with
        assert!(error(&[&[0.1, 0.2, 0.3], &[0.4, 0.5, 0.6]]).is_err_and(|error| error.contains("no spread")));
    }
}
