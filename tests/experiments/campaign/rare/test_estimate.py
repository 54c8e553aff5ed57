"""The rate from flights that weigh differently: against counts, against exact intervals, and by how often the interval holds."""

import math

import numpy as np
import pytest
from scipy.stats import chi2

from armland.experiments.campaign.rare.estimate import rate_of


def test_flights_of_equal_weight_are_counted():
    failed = np.arange(20_000) < 6
    rate = rate_of(np.ones(20_000), failed)
    assert (rate.value, rate.flights, rate.failed) == (pytest.approx(3e-4), 20_000, 6)
    assert rate.deviation == pytest.approx(1.0 / math.sqrt(6.0), rel=1e-3)
    # So many plain flights are as many.
    assert rate.plain == pytest.approx(20_000, rel=1e-3)
    exact = 0.5 * chi2.ppf([0.025, 0.975], [12, 14]) / 20_000
    assert tuple(rate.interval) == pytest.approx(tuple(exact), rel=2e-3)


def test_weights_scale_the_rate_and_all_about_it():
    failed = np.arange(1000) < 50
    one, small = rate_of(np.ones(1000), failed), rate_of(np.full(1000, 1e-4), failed)
    assert small.value == pytest.approx(1e-4 * one.value)
    assert small.deviation == pytest.approx(one.deviation)
    assert tuple(small.interval) == pytest.approx(tuple(1e-4 * x for x in one.interval))
    assert small.plain > 9e3 * one.plain


def test_where_none_failed_the_plain_ones_among_them_bound_the_rate():
    rate = rate_of(np.ones(1000), np.zeros(1000, bool))
    assert (rate.value, rate.deviation, rate.plain) == (0.0, math.inf, math.inf)
    assert rate.interval.low == 0.0
    # With that rate 100 plain flights all succeed in one of forty campaigns.
    assert (1.0 - rate.interval.high) ** 100 == pytest.approx(0.025, abs=0.003)


def test_interval_holds_where_a_few_failures_of_uneven_weight_are_seen():
    rng, n, held = np.random.default_rng(0), 500, 0
    # Two kinds of flights: light ones that fail often, heavy ones that fail seldom.
    true = 0.8 * 0.02 * 0.05 + 0.2 * 0.5 * 0.1
    for _ in range(400):
        heavy = rng.random(n) < 0.2
        weights = np.where(heavy, 0.5, 0.02)
        rate = rate_of(weights, rng.random(n) < np.where(heavy, 0.1, 0.05))
        held += rate.interval.low <= true <= rate.interval.high
    assert held >= 0.93 * 400


def test_all_that_failed_with_the_same_weight_were_still_drawn_by_chance():
    rate = rate_of(np.full(50, 1e-3), np.ones(50, bool))
    assert rate.value == pytest.approx(1e-3)
    assert rate.interval.low < 0.9e-3
    assert rate.interval.high > 1.1e-3
