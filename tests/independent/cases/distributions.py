"""Distribution functions against scipy.stats."""

import numpy
from scipy import special, stats

from case import Case


def of(name, arguments, expected, **tolerance):
    return Case(f"{name} {arguments}", "distribution", {"name": name, "arguments": arguments}, float(expected), **tolerance)


def cases():
    for z in [-30.0, -8.0, -1.0, 0.3, 5.0]:
        yield of("normal", [z], stats.norm.cdf(z))
        yield of("normal_tail", [z], stats.norm.sf(z))
    for p in [1e-200, 1e-12, 0.025, 0.3, 0.6, 0.975]:
        yield of("normal_quantile", [p], stats.norm.ppf(p))
    for degrees in [1.0, 3.7, 26.0, 495.0, 1e6]:
        for t in [0.01, 1.3, 8.0, 40.0]:
            yield of("t_two_sided", [t, degrees], 2.0 * stats.t.sf(t, degrees))
        for confidence in [0.01, 0.95, 0.9999]:
            yield of("t_two_sided_quantile", [confidence, degrees], stats.t.isf((1.0 - confidence) / 2.0, degrees))
    for between, within in [(1.0, 1.0), (2.0, 26.0), (5.0, 65.0), (4.0, 995.0), (54.0, 5445.0), (3.0, 1e6), (400.0, 3e4)]:
        for f in [0.01, 0.9, 3.0, 15.0, 150.0]:
            # far out SciPy's own tail loses digits at large degrees of freedom
            expected = stats.f.sf(f, between, within)
            if expected > 1e-250:
                yield of("f_tail", [f, between, within], expected, relative=1e-9 if expected < 1e-30 else 1e-10)
        yield of("f_tail_quantile", [0.05, between, within], stats.f.isf(0.05, between, within))
    for x, degrees in [(0.01, 1.0), (3.0, 2.0), (19.2, 2.0), (200.0, 5.0), (50.0, 54.0), (30.0, 54.0)]:
        yield of("chi_squared_tail", [x, degrees], stats.chi2.sf(x, degrees))
    for x, a, b in [(0.2, 0.3, 7.0), (0.31, 3e5, 7e5), (0.5, 40.0, 2.0), (1e-8, 2.0, 3.0), (0.3, 2e4, 4.6e4)]:
        yield of("regularised_beta", [x, a, b], special.betainc(a, b, x))
    for p, a, b in [(0.025, 3.0, 8.0), (0.975, 300.0, 701.0), (0.5, 0.5, 0.5)]:
        yield of("beta_quantile", [p, a, b], stats.beta.ppf(p, a, b))
    # SciPy's own quadrature is good to about 1e-11 absolute
    for groups, degrees in [(2, 1.0), (3, 2.0), (3, 26.0), (4, 7.3), (5, 495.0), (6, 65.0), (12, 5e4), (50, 20.0)]:
        for q in [0.3, 2.0, 3.6, 7.0]:
            yield of("studentised_range", [q, groups, degrees], stats.studentized_range.cdf(q, groups, degrees), absolute=1e-10)
            if q > 3.0:
                yield of("studentised_range_tail", [q, groups, degrees], stats.studentized_range.sf(q, groups, degrees), absolute=1e-10)
    for groups, degrees in [(2, 4.0), (3, 26.0), (6, 65.0)]:
        yield of("studentised_range_quantile", [0.95, groups, degrees], stats.studentized_range.ppf(0.95, groups, degrees), relative=1e-7)
    for t, degrees, shift in [(2.0, 10.0, 1.0), (2.776, 4.0, 2.5), (1.98, 126.0, 2.83), (2.0, 10.0, -1.0), (1.96, 5e4, 3.0), (4.0, 1.0, 3.0)]:
        yield of("noncentral_t_tail", [t, degrees, shift], stats.nct.sf(t, degrees, shift), absolute=1e-10)
    for f, between, within, shift in [(3.0, 2.0, 27.0, 5.0), (2.7, 3.0, 176.0, 11.25), (1.4, 54.0, 5445.0, 80.0), (3.0, 2.0, 27.0, 0.0), (4.0, 1.0, 8.0, 300.0)]:
        yield of("noncentral_f_tail", [f, between, within, shift], stats.ncf.sf(f, between, within, shift) if shift else stats.f.sf(f, between, within), absolute=1e-10)
