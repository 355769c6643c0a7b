//! Questions about statistics.

use crate::Question;
use crate::asked::{Answer, Asked};
use measure::statistics::{
    self as ours, Correction, Effect, Estimate, Interval, PairComparison, Resampling, Residual, distribution,
};
use serde_json::{Value, json};

pub(crate) const QUESTIONS: &[Question] = &[
    ("distribution", |asked| {
        let [a, b, c, d] = {
            let given = asked.numbers("arguments")?;
            core::array::from_fn(|place| given.get(place).copied().unwrap_or(f64::NAN))
        };
        Ok(json!(match asked.text("name")? {
            "normal" => distribution::normal(a),
            "normal_tail" => distribution::normal_tail(a),
            "normal_quantile" => distribution::normal_quantile(a),
            "t_two_sided" => distribution::t_two_sided(a, b),
            "t_two_sided_quantile" => distribution::t_two_sided_quantile(a, b),
            "f_tail" => distribution::f_tail(a, b, c),
            "f_tail_quantile" => distribution::f_tail_quantile(a, b, c),
            "chi_squared_tail" => distribution::chi_squared_tail(a, b),
            "regularised_beta" => distribution::regularised_beta(b, c, a),
            "beta_quantile" => distribution::beta_quantile(a, b, c),
            "studentised_range" => distribution::studentised_range(a, b as usize, c),
            "studentised_range_tail" => distribution::studentised_range_tail(a, b as usize, c),
            "studentised_range_quantile" => distribution::studentised_range_quantile(a, b as usize, c),
            "noncentral_t_tail" => distribution::noncentral_t_tail(a, b, c),
            "noncentral_f_tail" => distribution::noncentral_f_tail(a, b, c, d),
            other => return Err(format!("there is no distribution function `{other}`")),
        }))
    }),
    ("summary", |asked| {
        let values = asked.numbers("values")?;
        let summary = ours::Summary::of(&values).map_err(told)?;
        let quantiles = asked.numbers("shares")?;
        let quantiles = quantiles.iter().map(|&share| ours::quantile(&values, share)).collect::<Result<Vec<_>, _>>();
        Ok(json!({
            "mean": summary.mean, "sd": summary.standard_deviation, "sem": summary.standard_error,
            "median": summary.median, "quantiles": quantiles.map_err(told)?,
        }))
    }),
    ("one_way", |asked| {
        with_groups(asked, |groups| {
            let anova = ours::one_way(groups).map_err(told)?;
            Ok(json!({
                "effect": effect(&anova.effect), "residual": residual(&anova.residual),
                "eta_squared": anova.eta_squared, "omega_squared": anova.omega_squared,
            }))
        })
    }),
    ("blocked", |asked| {
        with_groups(asked, |groups| {
            let anova = ours::blocked(groups).map_err(told)?;
            let (treatments, blocks) = (effect(&anova.effect), effect(&anova.blocks));
            Ok(json!({ "effect": treatments, "blocks": blocks, "residual": residual(&anova.residual) }))
        })
    }),
    ("factorial", |asked| {
        let factors = asked.counts("factors")?;
        let squares = match asked.count("type")? {
            2 => ours::SquaresType::Second,
            _ => ours::SquaresType::Third,
        };
        let factors: Vec<&[usize]> = factors.iter().map(Vec::as_slice).collect();
        let model = ours::factorial(&asked.numbers("values")?, &factors, asked.truth("interactions")?, squares);
        let model = model.map_err(told)?;
        let terms: Vec<Value> = model.terms.iter().map(|(_, of)| effect(of)).collect();
        Ok(json!({ "terms": terms, "residual": residual(&model.residual) }))
    }),
    ("welch", |asked| {
        with_groups(asked, |groups| {
            let anova = ours::welch_anova(groups).map_err(told)?;
            Ok(json!({ "f": anova.f, "between": anova.between, "within": anova.within, "p": anova.p }))
        })
    }),
    ("kruskal_wallis", |asked| {
        with_groups(asked, |groups| {
            let test = ours::kruskal_wallis(groups).map_err(told)?;
            Ok(json!({ "h": test.h, "p": test.p }))
        })
    }),
    ("tukey_kramer", |asked| {
        with_groups(asked, |groups| {
            let (summaries, residual) = if asked.truth("blocked")? {
                ours::blocked(groups).map(|anova| (anova.groups, anova.residual))
            } else {
                ours::one_way(groups).map(|anova| (anova.groups, anova.residual))
            }
            .map_err(told)?;
            let compared = ours::tukey_kramer(&summaries, &residual, asked.number("confidence")?);
            Ok(pairs(&compared.map_err(told)?))
        })
    }),
    ("games_howell", |asked| {
        with_groups(asked, |groups| Ok(pairs(&ours::games_howell(groups, asked.number("confidence")?).map_err(told)?)))
    }),
    ("dunn", |asked| {
        with_groups(asked, |groups| {
            let compared = ours::dunn(groups, correction(asked)?, 0.05).map_err(told)?;
            let row = |pair: &ours::RankPair| json!({ "z": pair.z, "p": pair.p, "adjusted": pair.adjusted });
            Ok(compared.pairs.iter().map(row).collect())
        })
    }),
    ("variance_test", |asked| {
        with_groups(asked, |groups| {
            let test = match asked.text("name")? {
                "levene" => ours::levene(groups),
                "brown_forsythe" => ours::brown_forsythe(groups),
                _ => ours::bartlett(groups),
            };
            test.map_err(told).map(|test| json!({ "statistic": test.statistic, "p": test.p }))
        })
    }),
    ("normality", |asked| {
        let values = asked.numbers("values")?;
        let test = match asked.text("name")? {
            "shapiro_wilk" => ours::shapiro_wilk(&values),
            _ => ours::dagostino(&values),
        };
        test.map_err(told).map(|test| json!({ "statistic": test.statistic, "p": test.p }))
    }),
    ("t_test", |asked| {
        let (first, confidence) = (asked.numbers("first")?, asked.number("confidence")?);
        let second = asked.numbers("second");
        let test = match asked.text("name")? {
            "student" => ours::t_test(&first, &second?, confidence),
            "welch" => ours::welch_t_test(&first, &second?, confidence),
            "paired" => ours::paired_t_test(&first, &second?, confidence),
            _ => ours::one_sample_t_test(&first, asked.number("mean")?, confidence),
        };
        let test = test.map_err(told)?;
        Ok(json!({ "t": test.t, "degrees": test.degrees, "p": test.p, "low": test.low, "high": test.high }))
    }),
    ("wilcoxon", |asked| {
        let test = ours::wilcoxon(&asked.numbers("first")?, &asked.numbers("second")?).map_err(told)?;
        Ok(
            json!({ "least": test.positive.min(test.negative), "p": test.p, "exact": test.method == ours::Method::Exact }),
        )
    }),
    ("mann_whitney", |asked| {
        let test = ours::mann_whitney(&asked.numbers("first")?, &asked.numbers("second")?).map_err(told)?;
        Ok(json!({ "u": test.u, "p": test.p, "exact": test.method == ours::Method::Exact }))
    }),
    ("effect_size", |asked| {
        with_groups(asked, |groups| effect_size(asked)?.of(groups).map_err(told).map(|value| json!(value)))
    }),
    ("effect_estimate", |asked| {
        with_groups(asked, |groups| {
            effect_size(asked)?.estimate(groups, &resampling(asked)?).map_err(told).map(|found| estimate(&found))
        })
    }),
    ("block_bootstrap", |asked| {
        let length = asked.count("length")? as usize;
        let blocks = match asked.text("name")? {
            "moving" => ours::Blocks::Moving(length),
            _ => ours::Blocks::Stationary(length),
        };
        let mean = |values: &[f64]| ours::mean(values).ok();
        let found = ours::block_bootstrap(&asked.numbers("values")?, blocks, mean, &resampling(asked)?);
        found.map_err(told).map(|found| estimate(&found))
    }),
    ("autocorrelation", |asked| {
        let values = asked.numbers("values")?;
        let time = ours::autocorrelation_time(&values).map_err(told)?;
        let correlations = ours::autocorrelations(&values, 20).map_err(told)?;
        Ok(json!({ "time": time.time, "window": time.window, "correlations": correlations }))
    }),
    ("share_interval", |asked| {
        let (successes, trials, confidence) =
            (asked.count("successes")?, asked.count("trials")?, asked.number("confidence")?);
        let found = match asked.text("name")? {
            "wilson" => ours::wilson(successes, trials, confidence),
            _ => ours::clopper_pearson(successes, trials, confidence),
        };
        found.map_err(told).map(interval)
    }),
    ("mean_interval", |asked| {
        ours::mean_interval(&asked.numbers("values")?, asked.number("confidence")?).map_err(told).map(interval)
    }),
    ("adjust", |asked| ours::adjust(&asked.numbers("p")?, correction(asked)?).map_err(told).map(|p| json!(p))),
    ("power", |asked| {
        let power = ours::power(
            design(asked)?,
            asked.number("effect")?,
            asked.count("trials")? as usize,
            asked.number("level")?,
        );
        power.map_err(told).map(|power| json!(power))
    }),
    ("trials_needed", |asked| {
        let (effect, wanted, level) = (asked.number("effect")?, asked.number("power")?, asked.number("level")?);
        ours::trials_needed(design(asked)?, effect, wanted, level).map_err(told).map(|trials| json!(trials))
    }),
    ("linear_regression", |asked| {
        let line = ours::linear_regression(&asked.numbers("x")?, &asked.numbers("y")?, asked.number("confidence")?);
        let line = line.map_err(told)?;
        Ok(json!({
            "slope": line.slope, "intercept": line.intercept, "error": line.standard_error, "p": line.p,
            "r_squared": line.r_squared, "low": line.interval.low, "high": line.interval.high,
        }))
    }),
    ("correlation", |asked| {
        let (x, y, confidence) = (asked.numbers("x")?, asked.numbers("y")?, asked.number("confidence")?);
        let found = match asked.text("name")? {
            "pearson" => ours::pearson(&x, &y, confidence),
            _ => ours::spearman(&x, &y, confidence),
        };
        let found = found.map_err(told)?;
        Ok(json!({ "r": found.r, "p": found.p, "interval": found.interval.map(interval) }))
    }),
    ("sequential_test", |asked| {
        let number = |name| asked.number(name);
        let most = asked.count("most")? as u32;
        let test =
            ours::SequentialTest::new(number("lower")?, number("higher")?, number("alpha")?, number("beta")?, most);
        let found = test.and_then(|test| test.behaviour(asked.number("share").unwrap_or(f64::NAN))).map_err(told)?;
        Ok(json!([found.accept, found.reject, found.undecided, found.trials]))
    }),
];

fn told(error: ours::StatisticsError) -> String {
    error.to_string()
}

fn with_groups(asked: Asked<'_>, of: impl Fn(&[&[f64]]) -> Answer) -> Answer {
    let groups = asked.lists("groups")?;
    of(&groups.iter().map(Vec::as_slice).collect::<Vec<_>>())
}

fn effect(effect: &Effect) -> Value {
    json!({ "squares": effect.sum_of_squares, "degrees": effect.degrees, "f": effect.f, "p": effect.p })
}

fn residual(residual: &Residual) -> Value {
    json!({ "squares": residual.sum_of_squares, "degrees": residual.degrees })
}

fn interval(interval: Interval) -> Value {
    json!([interval.low, interval.high])
}

fn estimate(found: &Estimate) -> Value {
    json!({
        "value": found.value, "interval": interval(found.interval), "error": found.standard_error,
        "replicates": found.replicates,
    })
}

fn pairs(compared: &PairComparison) -> Value {
    let row = |pair: &ours::Pair| {
        json!({
            "first": pair.first, "second": pair.second, "difference": pair.difference, "statistic": pair.statistic,
            "degrees": pair.degrees, "p": pair.p, "low": pair.low, "high": pair.high,
        })
    };
    compared.pairs.iter().map(row).collect()
}

fn resampling(asked: Asked<'_>) -> Result<Resampling, String> {
    let (replicates, seed) = (asked.count("replicates")? as u32, asked.count("seed")?);
    Ok(Resampling { replicates, seed, confidence: asked.number("confidence")? })
}

fn correction(asked: Asked<'_>) -> Result<Correction, String> {
    Ok(match asked.text("correction")? {
        "bonferroni" => Correction::Bonferroni,
        "holm" => Correction::Holm,
        "benjamini_hochberg" => Correction::BenjaminiHochberg,
        "benjamini_yekutieli" => Correction::BenjaminiYekutieli,
        other => return Err(format!("there is no correction `{other}`")),
    })
}

fn effect_size(asked: Asked<'_>) -> Result<ours::EffectSize, String> {
    use ours::EffectSize as E;
    Ok(match asked.text("name")? {
        "cohen_d" => E::CohenD,
        "hedges_g" => E::HedgesG,
        "paired_d_z" => E::PairedDz,
        "eta_squared" => E::EtaSquared,
        "omega_squared" => E::OmegaSquared,
        "rank_biserial" => E::RankBiserial,
        "paired_rank_biserial" => E::PairedRankBiserial,
        other => return Err(format!("there is no effect size `{other}`")),
    })
}

fn design(asked: Asked<'_>) -> Result<ours::Design, String> {
    Ok(match asked.text("design")? {
        "one_way" => ours::Design::OneWay { groups: asked.count("groups")? as usize },
        "two_samples" => ours::Design::TwoSamples,
        _ => ours::Design::Paired,
    })
}
