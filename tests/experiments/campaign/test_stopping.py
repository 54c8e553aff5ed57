"""The confidence sequence: against its own martingale, and by simulation with many looks; Wilson's interval as the negative control."""

import math

import numpy as np
import pytest
from scipy.special import betaln

from armland.errors import ConfigurationError
from armland.experiments.campaign.stopping import Watch, always_valid, half_width


def log_mixture(s, f, p):
    # By steps, another way than with Beta functions: each flight is foretold by the rate of those before, (s + ½)/(n + 1).
    total = 0.0
    for i in range(s):
        total += math.log((i + 0.5) / (i + 1.0))
    for j in range(f):
        total += math.log((j + 0.5) / (s + j + 1.0))
    return total - (s * math.log(p) if s else 0.0) - (f * math.log1p(-p) if f else 0.0)


@pytest.mark.parametrize(("s", "f"), [(3, 1), (100, 0), (0, 12), (970, 30), (1, 1)])
def test_ends_are_where_the_martingale_is_one_over_alpha(s, f):
    low, high = always_valid(s, f)
    assert 0.0 <= low <= s / (s + f) <= high <= 1.0
    for end in (low, high):
        if 0.0 < end < 1.0:
            assert log_mixture(s, f, end) == pytest.approx(math.log(20.0), abs=1e-6)
    inside = 0.5 * (low + high)
    assert log_mixture(s, f, inside) < math.log(20.0)


def test_martingale_has_mean_one_where_the_rate_is_true():
    # Over all outcomes of ten flights.
    p = 0.83
    mean = sum(math.comb(10, s) * p**s * (1 - p) ** (10 - s) * math.exp(log_mixture(s, 10 - s, p)) for s in range(11))
    assert mean == pytest.approx(1.0, rel=1e-12)


def test_nothing_is_known_of_no_flight():
    assert always_valid(0, 0) == (0.0, 1.0)


def looked_at(p, paths=4000, looks=1000):
    """Successes and failures (paths, looks) of campaigns after each flight."""
    good = np.cumsum(np.random.default_rng(5).random((paths, looks)) < p, axis=1)
    return good, np.arange(1, looks + 1) - good


@pytest.mark.parametrize("p", [0.5, 0.9, 0.99])
def test_coverage_holds_at_all_looks_at_once_and_that_of_wilson_does_not(p):
    s, f = looked_at(p)
    n = s + f
    excess = betaln(s + 0.5, f + 0.5) - betaln(0.5, 0.5) - s * math.log(p) - f * math.log1p(-p) - math.log(20.0)
    assert (excess >= 0.0).any(axis=1).mean() <= 0.05
    # The negative control: an interval of a fixed number of flights, looked at as often, misses far more than 5 %.
    z = 1.959964
    middle = (s / n + z * z / (2.0 * n)) / (1.0 + z * z / n)
    half = z / (1.0 + z * z / n) * np.sqrt(s * f / n**3 + z * z / (4.0 * n * n))
    assert (abs(p - middle) > half).any(axis=1).mean() > 0.3
    # And the intervals are those of the martingale.
    for k, j in zip(range(0, 400, 3), range(0, 1000, 7), strict=False):
        low, high = always_valid(int(s[k, j]), int(f[k, j]))
        assert (low <= p <= high) == (excess[k, j] < 0.0)


def test_half_width_is_read_as_a_share_or_per_cent():
    assert half_width("0.5%") == half_width("0.005") == pytest.approx(0.005)
    for text in ("none", "0%", "50%", "-1%", "nan", ""):
        with pytest.raises(ConfigurationError, match="expected half the width"):
            half_width(text)


def test_watch_stops_at_the_same_row_in_whichever_order_flights_end():
    rng = np.random.default_rng(2)
    success = rng.random(900) < 0.95
    ended = np.argsort(np.arange(900) + 30.0 * rng.random(900))
    ordered, mixed = Watch(1, 0.03), Watch(1, 0.03)
    for run in range(900):
        ordered.add(run, bool(success[run]))
    for run in ended:
        mixed.add(int(run), bool(success[run]))
    assert ordered.enough
    assert ordered.rows < 900
    assert (mixed.rows, mixed.counts) == (ordered.rows, ordered.counts)
    assert ordered.intervals()[0].half <= 0.03


def test_watch_waits_for_a_slow_flight_before_it_counts_later_ones():
    watch = Watch(1, 0.2)
    for run in range(1, 200):
        watch.add(run, False)
    assert (watch.rows, watch.enough) == (0, False)
    watch.add(0, True)
    assert watch.enough


def test_watch_waits_for_every_point():
    watch = Watch(2, 0.1)
    for run in range(900):
        watch.add(run, run % 2 == 0 or run % 4 == 1)
    assert watch.enough
    assert watch.counts[0][0] == 0
    assert watch.intervals()[1].half <= 0.1
    assert watch.rows % 2 == 0


def test_without_a_width_nothing_stops():
    watch = Watch(1, None)
    for run in range(500):
        watch.add(run, True)
    assert (watch.rows, watch.enough) == (500, False)
