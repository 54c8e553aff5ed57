"""Paired comparisons against numbers worked by hand, and their intervals by simulation."""

import numpy as np
import pytest

from armland.experiments.campaign.answers.paired import compare, rate_difference
from armland.experiments.campaign.answers.table import Table


def table(success, figure=None, seeds=None):
    """Two points: rows of `success` (2, n), flight by flight."""
    points, n = success.shape
    run = np.arange(points * n)
    point, flight = run % points, run // points
    figures = {} if figure is None else {"hinge_force_max_n": figure[point, flight]}
    seed = flight if seeds is None else seeds[point, flight]
    zeros = np.zeros(len(run))
    return Table(run, point, seed, success[point, flight], ["done"] * len(run), figures, {}, {}, zeros, zeros)


def test_difference_and_mcnemar_by_hand():
    first = np.array([True] * 80 + [True] * 2 + [False] * 10 + [False] * 8)
    second = np.array([True] * 80 + [False] * 2 + [True] * 10 + [False] * 8)
    found = compare(table(np.stack([first, second])), 0, 1)
    assert (found.only_first, found.only_second) == (2, 10)
    assert found.rate.value == pytest.approx(0.08)
    # Two-sided binomial of 2 in 12: 2·(1 + 12 + 66)/4096.
    assert found.chance == pytest.approx(2 * 79 / 4096)
    # (c* − b*)/(n + 2) ± 1.96 √(b* + c* − (c* − b*)²/(n + 2))/(n + 2) with half a flight more in each cell.
    middle, half = 8 / 102, 1.959964 * (13 - 64 / 102) ** 0.5 / 102
    assert (found.rate.low, found.rate.high) == pytest.approx((middle - half, middle + half), abs=1e-6)
    assert found.rate.clear


def test_pairs_that_all_agree_leave_doubt():
    same = np.ones(30, bool)
    found = rate_difference(same, same)
    assert found.value == 0.0
    assert found.low < -0.02
    assert found.high > 0.02
    assert compare(table(np.stack([same, same])), 0, 1).chance == 1.0


def test_interval_of_the_rates_covers():
    rng, truth, held = np.random.default_rng(4), 0.9 * 0.15 - 0.1 * 0.2, 0
    for _ in range(1500):
        first = rng.random(120) < 0.1
        second = np.where(first, rng.random(120) >= 0.2, rng.random(120) < 0.15)
        found = rate_difference(first, second)
        held += found.low <= truth <= found.high
    assert 0.935 <= held / 1500 <= 0.975


def test_pairing_sees_what_unpaired_rates_hide():
    # Luck of the seed, which both share, is ten times what the second is better by.
    rng = np.random.default_rng(1)
    luck = 10.0 * rng.standard_normal(60)
    figure = np.stack([luck, luck - 1.0 + 0.1 * rng.standard_normal(60)])
    found = compare(table(np.ones((2, 60), bool), figure), 0, 1).figures[0]
    assert found.value == pytest.approx(-1.0, abs=0.05)
    assert found.clear
    shuffled = np.stack([figure[0], rng.permutation(figure[1])])
    assert not compare(table(np.ones((2, 60), bool), shuffled), 0, 1).figures[0].clear


def test_flights_are_paired_by_seed_and_figures_by_those_that_both_have():
    seeds = np.array([np.arange(20), np.arange(10, 30)])
    figure = np.array([np.arange(20.0), np.arange(10.0, 30.0) + 0.5])
    figure[0, 12] = np.nan
    found = compare(table(np.ones((2, 20), bool), figure, seeds), 0, 1)
    assert found.rate.pairs == 10
    assert (found.figures[0].pairs, found.figures[0].value) == (9, 0.5)
    assert compare(table(np.ones((2, 20), bool), seeds=np.array([np.arange(20), np.arange(50, 70)])), 0, 1) is None
