//! What every statistic keeps: an answer is finite, or there is an error that says why; whatever the values.

use super::*;
use core::fmt::Debug;

/// Few, equal, tiny, huge, nearly equal and missing values.
const STRANGE: &[&[f64]] = &[
    &[],
    &[1.0],
    &[2.0, 2.0, 2.0],
    &[0.0, 5e-324, 1e-320],
    &[1e-160, 2e-160, 4e-160, 3e-160],
    &[1e300, -1e300, 1.0],
    &[1e153, 2e153, -3e153, 1e153],
    &[f64::MAX, f64::MAX, -f64::MAX],
    &[1e15, 1e15 + 0.125, 1e15 + 0.25],
    &[0.1 + 0.2, 0.3, 0.3],
    &[1.0, f64::NAN, 2.0],
    &[f64::INFINITY, 1.0, 2.0],
    &[0.0, -0.0, 1.0, 1.0, 0.0],
    &[3.0, 1.0, 4.0, 1.5, 9.0, 2.6, 5.0, 3.5, 8.9, 7.9, 3.2, 3.8, 4.6, 2.7, 4.3, 3.3, 8.3, 2.5, 2.8, 4.2, 5.7],
];

/// Asserts that an answer holds no NaN and nothing infinite; tells whether there is one.
#[track_caller]
fn finite<T: Debug>(answer: Result<T, StatisticsError>, of: &dyn Debug) -> bool {
    match answer {
        Ok(answer) => {
            let text = format!("{answer:?}");
            assert!(!text.contains("NaN") && !text.contains("inf"), "{text} of {of:?}");
            true
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
    }
}

#[test]
fn answers_about_one_sample_are_finite() {
    let resampling = Resampling { replicates: 100, ..Resampling::default() };
    for &values in STRANGE {
        let mut answers = 0;
        for answered in [
            finite(Summary::of(values), &values),
            finite(quantile(values, 0.3), &values),
            finite(mean_interval(values, 0.95), &values),
            finite(shapiro_wilk(values), &values),
            finite(dagostino(values), &values),
            finite(one_sample_t_test(values, 1.0, 0.95), &values),
            finite(ranks(values), &values),
            finite(autocorrelation_time(values), &values),
            finite(bootstrap(&[values], |samples| mean(samples[0]).ok(), &resampling), &values),
            finite(block_bootstrap(values, Blocks::Moving(1), |values| mean(values).ok(), &resampling), &values),
        ] {
            answers += u32::from(answered);
        }
        let plain = values.len() > 20;
        assert_eq!(answers == 10, plain, "{answers} answers of {values:?}");
    }
}

#[test]
fn answers_about_several_samples_are_finite() {
    let resampling = Resampling { replicates: 100, ..Resampling::default() };
    for &first in STRANGE {
        for &second in STRANGE {
            let (groups, of): ([&[f64]; 2], _) = ([first, second], (first, second));
            if let Ok(anova) = one_way(&groups) {
                finite(Ok(&anova), &of);
                finite(tukey_kramer(&anova.groups, &anova.residual, 0.95), &of);
            }
            finite(blocked(&groups), &of);
            finite(welch_anova(&groups), &of);
            finite(games_howell(&groups, 0.95), &of);
            finite(kruskal_wallis(&groups), &of);
            finite(dunn(&groups, Correction::Holm, 0.05), &of);
            for test in [levene, brown_forsythe, bartlett] {
                finite(test(&groups), &of);
            }
            for test in [t_test, welch_t_test, paired_t_test] {
                finite(test(first, second, 0.95), &of);
            }
            finite(wilcoxon(first, second), &of);
            finite(mann_whitney(first, second), &of);
            finite(pearson(first, second, 0.95), &of);
            finite(spearman(first, second, 0.95), &of);
            finite(linear_regression(first, second, 0.95), &of);
            for effect in
                [EffectSize::HedgesG, EffectSize::PairedDz, EffectSize::OmegaSquared, EffectSize::RankBiserial]
            {
                finite(effect.estimate(&groups, &resampling), &of);
            }
            let levels: Vec<usize> = groups.iter().enumerate().flat_map(|(level, of)| vec![level; of.len()]).collect();
            finite(factorial(&groups.concat(), &[&levels], true, SquaresType::Second), &of);
        }
    }
}

#[test]
fn units_do_not_matter() {
    // p is the same in millimetres and in parsecs
    let groups: [&[f64]; 2] = [&STRANGE[13][..9], &STRANGE[13][9..]];
    let of = |unit: f64| {
        let scaled: Vec<Vec<f64>> = groups.iter().map(|of| of.iter().map(|value| value * unit).collect()).collect();
        let groups: [&[f64]; 2] = [&scaled[0], &scaled[1]];
        [
            one_way(&groups).map(|anova| anova.effect.p),
            welch_anova(&groups).map(|anova| anova.p),
            bartlett(&groups).map(|test| test.p),
            levene(&groups).map(|test| test.p),
            shapiro_wilk(groups[1]).map(|test| test.p),
            linear_regression(&groups[1][..9], groups[0], 0.95).map(|line| line.p),
        ]
    };
    for unit in [1e-100, 1e-9, 1e9, 1e100] {
        for (here, there) in of(1.0).into_iter().zip(of(unit)) {
            let difference = here.and_then(|here| there.map(|there| (here / there - 1.0).abs()));
            assert!(difference.as_ref().is_ok_and(|difference| *difference < 1e-9), "{unit}: {difference:?}");
        }
    }
}
