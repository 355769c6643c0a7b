"""Analyses, tests and intervals against SciPy and statsmodels, on data made from seeds."""

import itertools
import math
import pathlib

import numpy
import pandas
from scipy import stats
from statsmodels.formula.api import ols
from statsmodels.stats import anova as sm_anova
from statsmodels.stats import multitest, oneway, power, proportion
from statsmodels.stats.multicomp import pairwise_tukeyhsd
from statsmodels.tsa.stattools import acf

from case import Case


def groups(seed, sizes, shifts, spreads=None, decimals=None):
    draw = numpy.random.default_rng(seed)
    made = [draw.normal(shift, spread, size) for size, shift, spread in zip(sizes, shifts, spreads or [1.0] * len(sizes))]
    return [values if decimals is None else values.round(decimals) for values in made]


DATA = {
    "equal sizes": groups(1, [20] * 5, [0.0, 0.1, 0.5, 0.9, 0.6]),
    "unequal sizes": groups(2, [4, 13, 30], [10.0, 10.4, 12.0]),
    "unequal variances": groups(3, [12, 15, 9, 20], [0.0, 0.5, 2.0, 0.2], [0.3, 1.0, 4.0, 0.7]),
    "two groups": groups(4, [8, 7], [1.0, 1.5]),
    "no difference": groups(5, [10, 10, 10], [0.0, 0.0, 0.0]),
    "large offset": groups(6, [15, 15, 15], [1e6, 1e6 + 0.5, 1e6 + 1.0]),
    "ties": groups(7, [12, 12, 12], [0.0, 0.5, 1.0], decimals=0),
}


def read(name):
    table = pandas.read_csv(pathlib.Path(__file__).parents[1] / "data" / f"{name}.csv")
    return {name: values["value"].to_numpy() for name, values in table.groupby("group", sort=False)}


PUBLISHED = ["three_groups", "chickwts"]


def analyses():
    data = DATA | {name: list(read(name).values()) for name in PUBLISHED}
    for name, made in data.items():
        given, all_values = {"groups": made}, numpy.concatenate(made)
        f = stats.f_oneway(*made)
        within = sum(((values - values.mean()) ** 2).sum() for values in made)
        between = ((all_values - all_values.mean()) ** 2).sum() - within
        degrees = [len(made) - 1.0, float(len(all_values) - len(made))]
        error = within / degrees[1]
        # with a large offset these sums of SciPy lose digits themselves
        relative = 1e-6 if name == "large offset" else 1e-9
        yield Case(
            f"one_way, {name}",
            "one_way",
            given,
            {
                "effect": {"squares": between, "degrees": degrees[0], "f": f.statistic, "p": f.pvalue},
                "residual": {"squares": within, "degrees": degrees[1]},
                "eta_squared": between / (between + within),
                "omega_squared": (between - degrees[0] * error) / (between + within + error),
            },
            relative=relative,
        )
        welch = oneway.anova_oneway(made, use_var="unequal", welch_correction=True)
        wanted = {"f": welch.statistic, "between": float(welch.df[0]), "within": welch.df[1], "p": welch.pvalue}
        yield Case(f"welch, {name}", "welch", given, wanted, relative=relative)
        kruskal = stats.kruskal(*made)
        yield Case(f"kruskal_wallis, {name}", "kruskal_wallis", given, {"h": kruskal.statistic, "p": kruskal.pvalue})
        yield Case(f"tukey_kramer, {name}", "tukey_kramer", given | {"confidence": 0.95, "blocked": False}, tukey(made, name in PUBLISHED), relative=1e-6, absolute=1e-9)
        yield Case(f"games_howell, {name}", "games_howell", given | {"confidence": 0.9}, games_howell(made, 0.9), relative=1e-6, absolute=1e-9)
        for correction, method in CORRECTIONS.items():
            yield Case(f"dunn, {name}, {correction}", "dunn", given | {"correction": correction}, dunn(made, method))
        for test, compute in {
            "levene": lambda: stats.levene(*made, center="mean"),
            "brown_forsythe": lambda: stats.levene(*made, center="median"),
            "bartlett": lambda: stats.bartlett(*made),
        }.items():
            wanted = {"statistic": compute().statistic, "p": compute().pvalue}
            yield Case(f"{test}, {name}", "variance_test", given | {"name": test}, wanted, relative=relative)
    # what R says of the two published tables
    for name, f, p in [
        ("chickwts", 15.364799774712534, 5.936419853471334e-10),
        ("three_groups", 26.6896283964686, 4.99415657819001e-07),
    ]:
        yield Case(f"one_way of {name} by R", "one_way", {"groups": data[name]}, {"effect": {"f": f, "p": p}})
    pairs = [{"p": 7.03928782708e-07}, {"p": 0.367386929999}, {"p": 0.000297203105103}]
    given = {"groups": data["three_groups"], "confidence": 0.95, "blocked": False}
    yield Case("tukey_kramer of three_groups by R", "tukey_kramer", given, pairs, relative=1e-6)


CORRECTIONS = {"bonferroni": "bonferroni", "holm": "holm", "benjamini_hochberg": "fdr_bh", "benjamini_yekutieli": "fdr_by"}


def tukey(made, both):
    """By SciPy; where both are asked, statsmodels must say the same with the fewer digits that it has."""
    found = stats.tukey_hsd(*made)
    interval = found.confidence_interval(0.95)
    if both:
        labels = numpy.repeat(range(len(made)), [len(values) for values in made])
        table = pairwise_tukeyhsd(numpy.concatenate(made), labels, 0.05)
        upper = numpy.triu_indices(len(made), 1)
        assert numpy.allclose(table.meandiffs, -found.statistic[upper], rtol=1e-9)
        assert numpy.allclose(table.confint[:, 0], -interval.high[upper], rtol=1e-3)
    return [
        {
            "first": a, "second": b, "difference": found.statistic[a, b], "p": found.pvalue[a, b],
            "low": interval.low[a, b], "high": interval.high[a, b],
        }
        for a, b in itertools.combinations(range(len(made)), 2)
    ]


def games_howell(made, confidence):
    rows = []
    for a, b in itertools.combinations(range(len(made)), 2):
        errors = [made[place].var(ddof=1) / len(made[place]) for place in (a, b)]
        degrees = sum(errors) ** 2 / sum(error**2 / (len(made[place]) - 1) for error, place in zip(errors, (a, b)))
        scale = math.sqrt(sum(errors) / 2)
        difference = made[a].mean() - made[b].mean()
        q = abs(difference) / scale
        rows.append({
            "first": a, "second": b, "difference": difference, "statistic": q, "degrees": degrees,
            "p": stats.studentized_range.sf(q, len(made), degrees),
        })
        if (a, b) == (0, 1):
            # SciPy's quantile is slow
            half = stats.studentized_range.ppf(confidence, len(made), degrees) * scale
            rows[-1] |= {"low": difference - half, "high": difference + half}
    return rows


def dunn(made, method):
    ranks, sizes = stats.rankdata(numpy.concatenate(made)), [len(values) for values in made]
    means = [part.mean() for part in numpy.split(ranks, numpy.cumsum(sizes)[:-1])]
    n, (_, ties) = len(ranks), numpy.unique(ranks, return_counts=True)
    variance = n * (n + 1) / 12 - (ties**3 - ties).sum() / (12 * (n - 1))
    pairs = list(itertools.combinations(range(len(made)), 2))
    z = numpy.array([(means[a] - means[b]) / math.sqrt(variance * (1 / sizes[a] + 1 / sizes[b])) for a, b in pairs])
    p = 2 * stats.norm.sf(abs(z))
    adjusted = multitest.multipletests(p, method=method)[1]
    return [{"z": z, "p": p, "adjusted": adjusted} for z, p, adjusted in zip(z, p, adjusted)]


def models():
    draw = numpy.random.default_rng(11)
    blocks = draw.normal(0, 3, 12)
    made = [blocks + shift + draw.normal(0, 1, 12) for shift in (0.0, 0.4, 1.5, 1.6)]
    table = pandas.DataFrame(
        [(i, j, made[i][j]) for i in range(4) for j in range(12)], columns=["a", "b", "y"]
    )
    fit = sm_anova.anova_lm(ols("y ~ C(a) + C(b)", table).fit(), typ=2)
    wanted = {"effect": row(fit, 0), "blocks": row(fit, 1), "residual": rest(fit)}
    yield Case("blocked", "blocked", {"groups": made}, wanted)
    error, degrees = fit.iloc[-1]["sum_sq"] / fit.iloc[-1]["df"], fit.iloc[-1]["df"]
    q = [abs(a.mean() - b.mean()) / math.sqrt(error / 12) for a, b in itertools.combinations(made, 2)]
    wanted = [{"statistic": q, "p": stats.studentized_range.sf(q, 4, degrees)} for q in q]
    given = {"groups": made, "confidence": 0.95, "blocked": True}
    yield Case("tukey_kramer in blocks", "tukey_kramer", given, wanted, absolute=1e-10)

    # cells of different size, with and without interactions; a third factor; a missing cell
    table = pandas.DataFrame({"a": draw.integers(0, 3, 90), "b": draw.integers(0, 4, 90), "c": draw.integers(0, 2, 90)})
    table["y"] = 5 + table.a * 0.5 + (table.b == 2) * table.a + draw.normal(0, 1, 90)
    less = table[~((table.a == 1) & (table.b == 3))]
    for name, data, factors, interactions in [
        ("two factors", table, "ab", True),
        ("two factors, additive", table, "ab", False),
        ("three factors", table, "abc", True),
        ("a missing cell, additive", less, "ab", False),
    ]:
        formula = "y ~ " + ("*" if interactions else "+").join(f"C({factor}, Sum)" for factor in factors)
        for squares in (2, 3):
            fit = sm_anova.anova_lm(ols(formula, data).fit(), typ=squares)
            fit = fit.drop(index="Intercept", errors="ignore")
            # main effects first, then interactions of two, as the answer has them
            order = sorted(range(len(fit) - 1), key=lambda i: (fit.index[i].count(":"), fit.index[i]))
            given = {
                "values": data.y, "factors": [data[factor] for factor in factors],
                "interactions": interactions, "type": squares,
            }
            given = {key: list(value) if key == "values" else value for key, value in given.items()}
            given["factors"] = [[int(level) for level in factor] for factor in given["factors"]]
            wanted = {"terms": [row(fit, i) for i in order], "residual": rest(fit)}
            yield Case(f"factorial, {name}, type {squares}", "factorial", given, wanted, relative=1e-8, absolute=1e-9)


def row(fit, place):
    line = fit.iloc[place]
    return {"squares": line["sum_sq"], "degrees": line["df"], "f": line["F"], "p": line["PR(>F)"]}


def rest(fit):
    return {"squares": fit.iloc[-1]["sum_sq"], "degrees": fit.iloc[-1]["df"]}


def samples():
    draw = numpy.random.default_rng(21)
    shares = [0.0, 0.1, 0.25, 0.333, 0.9, 1.0]
    for name, values in {
        "normal": draw.normal(3, 2, 50), "three": numpy.array([1.0, 5.0, 2.5]), "large offset": draw.normal(1e9, 1, 40),
        "skewed": draw.exponential(2, 200), "small": draw.uniform(0, 1, 7), "eleven": draw.normal(0, 1, 11),
        "four": draw.normal(0, 1, 4), "long": draw.normal(0, 1, 3000),
    }.items():
        n = len(values)
        wanted = {
            "mean": values.mean(), "sd": values.std(ddof=1), "sem": stats.sem(values), "median": numpy.median(values),
            "quantiles": numpy.quantile(values, shares),
        }
        loose = {"relative": 1e-7} if name == "large offset" else {}
        yield Case(f"summary, {name}", "summary", {"values": values, "shares": shares}, wanted, **loose)
        shapiro = stats.shapiro(values)
        wanted = {"statistic": shapiro.statistic, "p": shapiro.pvalue}
        yield Case(f"shapiro_wilk, {name}", "normality", {"values": values, "name": "shapiro_wilk"}, wanted, relative=1e-7)
        if n >= 20:
            test = stats.normaltest(values)
            wanted = {"statistic": test.statistic, "p": test.pvalue}
            yield Case(f"dagostino, {name}", "normality", {"values": values, "name": "dagostino"}, wanted, relative=1e-5 if loose else 1e-9)
        wanted = stats.t.interval(0.9, n - 1, values.mean(), stats.sem(values))
        yield Case(f"mean_interval, {name}", "mean_interval", {"values": values, "confidence": 0.9}, wanted)
        test = stats.ttest_1samp(values, 1.0)
        interval = test.confidence_interval(0.9)
        given = {"name": "one_sample", "first": values, "mean": 1.0, "confidence": 0.9}
        yield Case(f"one_sample_t_test, {name}", "t_test", given, {"t": test.statistic, "degrees": float(n - 1), "p": test.pvalue, "low": interval.low - 1.0, "high": interval.high - 1.0}, relative=1e-7 if loose else 1e-9)


def pairs_of_samples():
    draw = numpy.random.default_rng(31)
    for name, first, second in [
        ("small", draw.normal(0, 1, 7), draw.normal(1, 1, 7)),
        ("eight", draw.normal(0, 1, 8), draw.normal(0.5, 2, 8)),
        ("larger", draw.normal(0, 1, 40), draw.normal(0.4, 2, 40)),
        ("long", draw.normal(0, 1, 120), draw.normal(0.2, 1, 120)),
        ("ties", draw.integers(0, 6, 30).astype(float), draw.integers(1, 7, 30).astype(float)),
    ]:
        given = {"first": first, "second": second}
        for kind, test in {
            "student": stats.ttest_ind(first, second), "welch": stats.ttest_ind(first, second, equal_var=False),
            "paired": stats.ttest_rel(first, second),
        }.items():
            interval = test.confidence_interval(0.95)
            wanted = {"t": test.statistic, "degrees": float(test.df), "p": test.pvalue, "low": interval.low, "high": interval.high}
            yield Case(f"{kind} t, {name}", "t_test", given | {"name": kind, "confidence": 0.95}, wanted)
        exact = name in ("small", "eight", "larger")
        test = stats.wilcoxon(first, second, method="exact" if exact else "asymptotic")
        yield Case(f"wilcoxon, {name}", "wilcoxon", given, {"least": test.statistic, "p": test.pvalue, "exact": exact})
        test = stats.mannwhitneyu(first, second)
        exact = name in ("small", "eight")
        yield Case(f"mann_whitney, {name}", "mann_whitney", given, {"u": test.statistic, "p": test.pvalue, "exact": exact})
        yield from effects(name, first, second)
        for kind, test in {"pearson": stats.pearsonr(first, second), "spearman": stats.spearmanr(first, second)}.items():
            given = {"x": first, "y": second, "confidence": 0.95, "name": kind}
            variance = 1.0 if kind == "pearson" else 1.0 + test.statistic**2 / 2
            half = stats.norm.ppf(0.975) * math.sqrt(variance / (len(first) - 3))
            interval = [math.tanh(math.atanh(test.statistic) + sign * half) for sign in (-1, 1)]
            if kind == "pearson":
                assert abs(interval[0] - test.confidence_interval().low) < 1e-12
            yield Case(f"{kind}, {name}", "correlation", given, {"r": test.statistic, "p": test.pvalue, "interval": interval})
        line = stats.linregress(first, second)
        half = stats.t.ppf(0.975, len(first) - 2) * line.stderr
        wanted = {
            "slope": line.slope, "intercept": line.intercept, "error": line.stderr, "p": line.pvalue,
            "r_squared": line.rvalue**2, "low": line.slope - half, "high": line.slope + half,
        }
        yield Case(f"linear_regression, {name}", "linear_regression", {"x": first, "y": second, "confidence": 0.95}, wanted)
    few, many = draw.normal(0, 1, 3), draw.normal(1, 1, 60)
    test = stats.mannwhitneyu(few, many)
    yield Case("mann_whitney, few and many", "mann_whitney", {"first": few, "second": many}, {"u": test.statistic, "p": test.pvalue, "exact": True})


def effects(name, first, second):
    n, m = len(first), len(second)
    pooled = math.sqrt(((n - 1) * first.var(ddof=1) + (m - 1) * second.var(ddof=1)) / (n + m - 2))
    d = (first.mean() - second.mean()) / pooled
    gamma = math.lgamma((n + m - 2) / 2) - math.lgamma((n + m - 3) / 2) - math.log((n + m - 2) / 2) / 2
    differences = first - second
    nonzero = differences[differences != 0]
    ranks = stats.rankdata(abs(nonzero))
    values = {
        "cohen_d": d,
        "hedges_g": d * math.exp(gamma),
        "paired_d_z": differences.mean() / differences.std(ddof=1),
        "rank_biserial": numpy.sign(first[:, None] - second[None, :]).mean(),
        "paired_rank_biserial": (ranks * numpy.sign(nonzero)).sum() / ranks.sum(),
    }
    for effect, value in values.items():
        yield Case(f"{effect}, {name}", "effect_size", {"groups": [first, second], "name": effect}, value)


def resampling():
    draw = numpy.random.default_rng(41)
    first, second = draw.exponential(1, 25), draw.exponential(1.6, 20)
    given = {"groups": [first, second], "name": "rank_biserial", "replicates": 1999, "seed": 5, "confidence": 0.95}

    def statistic(first, second):
        return numpy.sign(first[:, None] - second[None, :]).mean()

    def corrected(answer):
        """Efron's interval of the replicates in the answer, put beside the one in it."""
        replicates = numpy.array(answer["replicates"])
        value = statistic(first, second)
        # equal but for rounding is equal
        below, equal = replicates < value - 1e-9, abs(replicates - value) <= 1e-9
        bias = stats.norm.ppf(below.mean() + equal.mean() / 2)
        influence = []
        for place, sample in enumerate((first, second)):
            parts = [first, second]
            without = []
            for left_out in range(len(sample)):
                parts[place] = numpy.delete(sample, left_out)
                without.append(statistic(*parts))
            influence.append((len(sample) - 1) * (numpy.mean(without) - numpy.array(without)) / len(sample))
        influence = numpy.concatenate(influence)
        acceleration = (influence**3).sum() / (6 * (influence**2).sum() ** 1.5)
        ends = []
        for z in stats.norm.ppf([0.025, 0.975]):
            share = stats.norm.cdf(bias + (bias + z) / (1 - acceleration * (bias + z)))
            ends.append(numpy.quantile(replicates, share))
        scipy = stats.bootstrap((first, second), statistic, n_resamples=1999, vectorized=False, rng=1)
        interval = scipy.confidence_interval
        near = abs(ends[0] - interval.low) < 0.05 and abs(ends[1] - interval.high) < 0.05
        return {
            "low": answer["interval"][0] - ends[0], "high": answer["interval"][1] - ends[1],
            "value": answer["value"] - value, "error": answer["error"] - replicates.std(ddof=1), "near SciPy": bool(near),
        }

    wanted = {"low": 0.0, "high": 0.0, "value": 0.0, "error": 0.0, "near SciPy": True}
    yield Case("bootstrap, BCa", "effect_estimate", given, wanted, of=corrected, absolute=1e-10)

    series = [0.0]
    for shock in draw.normal(0, 1, 2000):
        series.append(0.7 * series[-1] + shock)
    series = numpy.array(series[1:])
    correlations = acf(series, nlags=len(series) - 1, adjusted=False, fft=False)
    times = 2.0 * numpy.cumsum(correlations) - 1.0
    window = int(numpy.argmax(numpy.arange(len(times)) >= 5 * times))
    wanted = {"time": times[window], "window": window, "correlations": correlations[:21]}
    yield Case("autocorrelation", "autocorrelation", {"values": series}, wanted)
    for kind in ("moving", "stationary"):
        given = {"values": series, "name": kind, "length": 40, "replicates": 1000, "seed": 9, "confidence": 0.9}
        # the deviation of a mean of blocks, from the series itself
        blocks = numpy.lib.stride_tricks.sliding_window_view(series, 40).mean(axis=1)
        scale = blocks.std() / math.sqrt(len(series) / 40)

        def compare(answer, scale=scale):
            replicates = numpy.array(answer["replicates"])
            quantiles = numpy.quantile(replicates, [0.05, 0.95])
            return {
                "low": answer["interval"][0] - quantiles[0], "high": answer["interval"][1] - quantiles[1],
                "near": bool(abs(answer["error"] / scale - 1) < 0.15),
            }

        yield Case(f"block bootstrap, {kind}", "block_bootstrap", given, {"low": 0.0, "high": 0.0, "near": True}, of=compare)


def shares_and_power():
    for successes, trials in [(0, 10), (3, 10), (10, 10), (37, 100), (999, 1000), (123456, 400000)]:
        for name, method in {"wilson": "wilson", "clopper_pearson": "beta"}.items():
            given = {"name": name, "successes": successes, "trials": trials, "confidence": 0.95}
            wanted = [float(end) for end in proportion.proportion_confint(successes, trials, 0.05, method)]
            yield Case(f"{name}, {successes} of {trials}", "share_interval", given, wanted, absolute=1e-12)
    p = numpy.random.default_rng(51).uniform(0, 0.1, 12) ** 2
    p[3] = p[7]
    for correction, method in CORRECTIONS.items():
        yield Case(f"adjust, {correction}", "adjust", {"p": p, "correction": correction}, multitest.multipletests(p, method=method)[1])
    for effect, trials in [(0.2, 20), (0.5, 64), (0.8, 5), (1.5, 4)]:
        given = {"effect": effect, "trials": trials, "level": 0.05}
        tolerance = {"absolute": 1e-9}
        yield Case(f"power, two samples, {effect}", "power", given | {"design": "two_samples"}, power.TTestIndPower().power(effect, trials, 0.05), **tolerance)
        yield Case(f"power, paired, {effect}", "power", given | {"design": "paired"}, power.TTestPower().power(effect, trials, 0.05), **tolerance)
        yield Case(f"power, one way, {effect}", "power", given | {"design": "one_way", "groups": 5}, power.FTestAnovaPower().power(effect, 5 * trials, 0.05, 5), **tolerance)
    for effect in (0.15, 0.4, 1.2):
        given = {"effect": effect, "power": 0.9, "level": 0.01}
        for design, solve in {
            "two_samples": lambda: power.TTestIndPower().solve_power(effect, None, 0.01, 0.9),
            "paired": lambda: power.TTestPower().solve_power(effect, None, 0.01, 0.9),
        }.items():
            yield Case(f"trials needed, {design}, {effect}", "trials_needed", given | {"design": design}, math.ceil(float(numpy.squeeze(solve()))))
    # the sequential test of the group control study: all courses by brute force recursion, at most 12 trials
    given = {"lower": 0.5, "higher": 0.8, "alpha": 0.05, "beta": 0.05, "most": 12, "share": 0.65}
    yield Case("sequential test", "sequential_test", given, courses(12, 0.65))


def courses(most, share):
    """Every sequence of successes and failures, one by one."""
    found = [0.0, 0.0, 0.0, 0.0]
    for outcome in itertools.product((0, 1), repeat=most):
        evidence = 0.0
        for trial, success in enumerate(outcome, 1):
            evidence += math.log(0.8 / 0.5) if success else math.log(0.2 / 0.5)
            if evidence >= math.log(19) or evidence <= -math.log(19):
                break
        weight = share ** sum(outcome) * (1 - share) ** (most - sum(outcome))
        place = 0 if evidence >= math.log(19) else 1 if evidence <= -math.log(19) else 2
        found[place] += weight
        found[3] += weight * trial
    return found


def cases():
    for part in (analyses, models, samples, pairs_of_samples, resampling, shares_and_power):
        yield from part()
