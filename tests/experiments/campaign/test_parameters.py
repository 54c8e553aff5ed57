"""Distributions against their own formulas, and what is refused."""

import numpy as np
import pytest
from pydantic import ValidationError

from armland.experiments.campaign.parameters import Parameter


def drawn(count=4000, **given):
    u = (np.arange(count) + 0.5) / count
    return np.array(Parameter(**given).quantile()(u))


def test_uniform_fills_its_range_evenly():
    x = drawn(uniform=(2.0, 6.0))
    assert (x.min(), x.max()) == pytest.approx((2.0, 6.0), abs=2e-3)
    assert x.std() == pytest.approx(4.0 / 12.0**0.5, rel=1e-3)


def test_normal_has_mean_and_deviation_and_bounds_cut_it_off():
    x = drawn(normal=(3.0, 0.5))
    assert (x.mean(), x.std()) == pytest.approx((3.0, 0.5), rel=2e-3)
    half = drawn(normal=(0.0, 1.0), low=0.0)
    # Mean of the half normal: √(2/π).
    assert half.min() >= 0.0
    assert half.mean() == pytest.approx((2.0 / np.pi) ** 0.5, rel=2e-3)


def test_lognormal_has_its_median_and_the_deviation_of_its_logarithm():
    x = drawn(lognormal=(2.0, 0.3))
    assert np.median(x) == pytest.approx(2.0, rel=1e-3)
    assert np.log(x).std() == pytest.approx(0.3, rel=3e-3)
    cut = drawn(lognormal=(2.0, 0.3), low=1.5, high=2.5)
    assert 1.5 <= cut.min() < cut.max() <= 2.5


def test_choice_takes_each_value_as_often_as_its_weight_says():
    words = Parameter(choice=("a", "b", "c"), weights=(1.0, 2.0, 1.0)).quantile()((np.arange(400) + 0.5) / 400)
    assert [words.count(w) for w in "abc"] == [100, 200, 100]
    assert set(Parameter(choice=(True, False)).quantile()(np.array([0.0, 0.2, 0.7, 1.0]))) == {True, False}


def test_examples_are_the_ends():
    assert Parameter(uniform=(0.0, 2.0)).examples() == [0.0, 2.0]
    assert Parameter(normal=(1.0, 0.1), high=1.2).examples() == pytest.approx([1.2, 0.998], abs=2e-2)
    assert Parameter(sweep=("a", "b")).examples() == ["a", "b"]
    assert Parameter(fixed=0.5).examples() == [0.5]


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({}, "no distribution; it takes one of uniform, normal, lognormal, choice, sweep, fixed"),
        ({"uniform": (0.0, 1.0), "fixed": 1}, "uniform and fixed"),
        ({"uniform": (2.0, 2.0)}, "empty range"),
        ({"uniform": (2.0, 1.0)}, "empty range"),
        ({"uniform": (0.0, 1.0), "low": 0.0}, "low and high are for normal"),
        ({"normal": (1.0, 0.0)}, "above 0"),
        ({"normal": (0.0, 1.0), "low": 2.0, "high": 1.0}, "low must be below high"),
        ({"normal": (0.0, 1.0), "low": 1e11}, "nothing of normal"),
        ({"lognormal": (-1.0, 1.0)}, "median must be above 0"),
        ({"choice": ()}, "at least 1"),
        ({"sweep": ()}, "at least 1"),
        ({"sweep": (1, 1)}, "1 twice"),
        ({"choice": (1, 2), "weights": (1.0,)}, "1 numbers for 2 values"),
        ({"choice": (1, 2), "weights": (0.0, 0.0)}, "weights must not be below 0"),
        ({"sweep": (1, 2), "weights": (1.0, 1.0)}, "weights are for choice"),
        ({"gamma": (1.0, 2.0)}, "gamma"),
    ],
)
def test_what_is_no_distribution_is_refused(given, words):
    with pytest.raises(ValidationError, match=words):
        Parameter(**given)
