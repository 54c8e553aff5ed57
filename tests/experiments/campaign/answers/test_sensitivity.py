"""Indices against functions whose Sobol indices are known, and against chance."""

import numpy as np
import pytest

from armland.experiments.campaign.answers.sensitivity import classed, explained, sensitivity, trend
from armland.experiments.campaign.answers.table import Table


def table(values, success):
    n, zeros = len(success), np.zeros(len(success))
    columns = {name: [v.item() if hasattr(v, "item") else v for v in column] for name, column in values.items()}
    return Table(np.arange(n), np.zeros(n, int), np.arange(n), success, ["done"] * n, {}, columns, {}, zeros, zeros)


def test_first_order_index_of_a_threshold_with_noise():
    # Success where x < ½, but one in ten by chance the other way: E[y|x] is 0.9 or 0.1, so S = 0.4²/0.25.
    rng = np.random.default_rng(0)
    x, idle = rng.random(8000), rng.random(8000)
    success = (x < 0.5) ^ (rng.random(8000) < 0.1)
    found = sensitivity(table({"idle": idle, "x": x}, success))
    assert [i.names for i in found.single] == [("x",), ("idle",)]
    assert found.single[0].share == pytest.approx(0.64, abs=0.03)
    assert found.single[0].trend > 0.5
    assert found.single[1].share < 0.003
    assert found.single[0].chance < 1e-12


def test_what_only_the_combination_explains():
    # Success where both or neither is above the middle: no first-order index at all, and all of the variance together, but
    # for the few flights between the true middle and that of the sample, where classes meet.
    rng = np.random.default_rng(1)
    x, y, z = rng.random((3, 4000))
    found = sensitivity(table({"x": x, "y": y, "z": z}, (x > 0.5) == (y > 0.5)))
    assert all(i.share < 0.01 for i in found.single)
    assert found.pairs[0].names in (("x", "y"), ("y", "x"))
    assert found.pairs[0].share == pytest.approx(1.0, abs=0.12)
    assert found.pairs[1].share < 0.02


def test_chance_is_taken_off():
    # Raw correlation ratios of nothing have a mean of (k − 1)/(n − 1) = 0.035; corrected ones none.
    rng, shares, chances = np.random.default_rng(2), [], []
    for _ in range(300):
        share, chance = explained(rng.integers(0, 8, 200), rng.random(200) < 0.5)
        shares.append(share)
        chances.append(chance)
    assert np.mean(shares) < 0.012
    assert np.mean(np.array(chances) < 0.05) < 0.1


def test_words_and_truth_values_are_classes():
    rng = np.random.default_rng(3)
    state = rng.integers(0, 3, 900)
    success = state != 2
    found = sensitivity(
        table({"sea.state": [("calm", "ss1", "ss2")[s] for s in state], "flag": [bool(s % 2) for s in state]}, success)
    )
    assert found.single[0].names == ("sea.state",)
    assert found.single[0].share == pytest.approx(1.0)
    assert found.single[0].trend == 0.0


def test_classes_have_equal_numbers_and_values_that_do_not_vary_none():
    classes = classed(list(np.random.default_rng(4).lognormal(0.0, 2.0, 800)))
    assert sorted(np.bincount(classes)) == [100] * 8
    assert classed([1.0] * 50) is None
    assert sorted(set(classed([0.0, 6.0, 8.0] * 20))) == [0, 1, 2]


def test_outcomes_that_are_all_alike_depend_on_nothing():
    x = np.random.default_rng(5).random(50)
    for success in (np.ones(50, bool), np.zeros(50, bool)):
        assert sensitivity(table({"x": x}, success)) == ((), ())


def test_less_that_fails_has_a_negative_trend():
    x = np.linspace(0.0, 1.0, 100)
    assert trend(list(x), x > 0.3) < -0.5
    assert trend(["a"] * 100, x > 0.3) == 0.0
