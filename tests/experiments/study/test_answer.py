"""What a study found, on rows of which is known how they end."""

import json

import numpy as np
import pytest
from scipy.stats import binomtest

from armland.experiments.study.answer import least_told, mean_difference

CHANGES = {"nothing": {}, "bad": {"bad": True}, "good": {"good": True}, "sure": {"misses": 0}}


def test_gains_are_ranked_with_counts_and_intervals(made, found):
    """Of 48 seeds 12 fail; with `good` none does, with `bad` 12 more of the others."""
    answer = found(made(CHANGES), 48)
    assert (answer.usual.successes, answer.usual.flights) == (36, 48)
    assert [g.name for g in answer.gains] == ["good", "sure", "nothing", "bad"]
    good, _, nothing, bad = answer.gains
    assert (good.successes, good.only_changed, good.only_usual, good.rate.value) == (48, 12, 0, 0.25)
    assert good.chance == pytest.approx(2 * 0.5**12)
    assert good.rate.low > 0.0
    assert (bad.only_changed, bad.only_usual, bad.rate.value) == (0, 12, -0.25)
    assert (nothing.rate.value, nothing.chance, nothing.told) == (0.0, 1.0, False)
    assert nothing.rate.low < 0.0 < nothing.rate.high


def test_chances_are_raised_for_the_number_of_changes(made, found):
    """Benjamini and Hochberg by hand: of four, ordered, p times four over its rank; the two small ones are alike here."""
    gains = {g.name: g for g in found(made(CHANGES), 48).gains}
    assert gains["good"].raised == pytest.approx(2 * 0.5**12 * 4 / 2)
    assert (gains["good"].told, gains["bad"].told, gains["sure"].told) == (True, True, False)


def test_what_a_term_gives_is_what_is_lost_without_it(made, found):
    gains = {g.name: g for g in found(made(CHANGES, removes=True), 48).gains}
    assert gains["bad"].rate.value == 0.25
    assert gains["bad"].rate.low > 0.0
    assert gains["good"].rate.value == -0.25
    assert f"{gains['nothing'].rate.value:+.0f}" == "+0"
    # One miss fewer without: the term costs one.
    assert (gains["sure"].misses.value, gains["sure"].misses.low) == (1.0, 1.0)


def test_missed_captures_are_compared_by_seed(made, found):
    gains = {g.name: g for g in found(made(CHANGES), 12).gains}
    assert gains["sure"].misses[1:] == (-1.0, -1.0, -1.0, 12)
    assert gains["good"].misses.value == 0.0


def test_flights_that_are_the_same_bit_for_bit_are_counted(made, found):
    gains = {g.name: g for g in found(made(CHANGES), 12).gains}
    assert (gains["nothing"].same, gains["good"].same) == (12, 0)


def test_changes_that_were_not_flown_and_rows_of_others_are_left_out(made, found):
    study = made(CHANGES)
    answer = found(study, 8)
    assert len(answer.gains) == 4
    assert json.loads(json.dumps(answer.result()))["gains"][0]["name"] == answer.gains[0].name


def test_mean_difference_has_the_interval_of_the_mean():
    """Of many normal numbers the bootstrap's interval is that of the mean ± 1.96 σ/√n."""
    rng = np.random.default_rng(1)
    apart = rng.normal(0.3, 1.0, 2000)
    found = mean_difference("x", np.zeros(2000), apart)
    half = 1.96 * apart.std() / np.sqrt(2000)
    assert found.value == pytest.approx(apart.mean())
    assert (found.low, found.high) == pytest.approx((apart.mean() - half, apart.mean() + half), abs=0.1 * half)


def test_least_difference_is_six_seeds_all_one_way():
    assert binomtest(6, 6).pvalue < 0.05 < binomtest(5, 5).pvalue
    assert least_told(40) == pytest.approx(0.15)
    assert least_told(5) is None
