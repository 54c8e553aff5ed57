"""Effects that were planted are found with their size and error; in noise none is."""

import numpy as np
import pytest

from armland.experiments.margins.design import design
from armland.experiments.margins.effects import effects


@pytest.fixture(scope="module")
def levels():
    return design(65)


def planted(X, seed, noise=0.2):
    y = 1.0 + 0.25 * X[:, 3] - 0.2 * X[:, 10] + 0.25 * X[:, 4] * X[:, 17] - 0.2 * X[:, 3] * X[:, 30]
    return y + noise * np.random.default_rng(seed).standard_normal(len(X))


@pytest.mark.parametrize("seed", range(3))
def test_planted_effects_are_found_and_no_others(levels, seed):
    found = effects(levels, planted(levels, seed))
    assert {e.terms for e in found.singles if e.clear} == {(3,), (10,)}
    assert {e.terms for e in found.pairs if e.clear} == {(4, 17), (3, 30)}
    sizes = {e.terms: (e.size, e.error) for e in (*found.singles, *found.pairs)}
    for terms, size in (((3,), 0.5), ((10,), -0.4), ((4, 17), 0.5), ((3, 30), -0.4)):
        assert abs(sizes[terms][0] - size) < 3.5 * sizes[terms][1]
        # The error of 2b is 2σ/√n where columns are orthogonal.
        # The error of 2b is 2σ/√n where columns are orthogonal; what of a pair single effects take up makes it larger.
        least = 2.0 * 0.2 / np.sqrt(len(levels))
        assert 0.75 * least < sizes[terms][1] < (1.35 if len(terms) == 1 else 2.0) * least


def test_strongest_stand_first(levels):
    found = effects(levels, planted(levels, 0))
    assert {e.terms for e in found.singles[:2]} == {(3,), (10,)}
    assert {e.terms for e in found.pairs[:2]} == {(4, 17), (3, 30)}
    assert len(found.pairs) == 65 * 64 // 2


def test_in_noise_nothing_is_clear(levels):
    # Chance alone makes one single or one pair clear in one study of twenty each.
    clear = [
        e
        for seed in range(6)
        for es in effects(levels, np.random.default_rng(seed).standard_normal(len(levels)))
        for e in es
        if e.clear
    ]
    assert len(clear) <= 2


def test_without_the_correction_for_many_noise_would_be_full_of_pairs(levels):
    y = np.random.default_rng(1).standard_normal(len(levels))
    assert sum(abs(e.size) > 2.0 * e.error for e in effects(levels, y).pairs) > 10


def test_exact_effects_are_exact(levels):
    found = effects(levels, planted(levels, 0, noise=0.0))
    assert {e.terms: round(e.size, 9) for e in found.pairs if e.clear} == {(4, 17): 0.5, (3, 30): -0.4}
    assert {e.terms: round(e.size, 9) for e in found.singles if e.clear} == {(3,): 0.5, (10,): -0.4}


def test_where_all_flights_are_alike_there_is_no_effect(levels):
    found = effects(levels, np.full(len(levels), 2.0))
    assert not any(e.clear or abs(e.size) > 1e-9 for es in found for e in es)


def test_two_factors_have_one_pair():
    X = design(2)
    y = X[:, 0] * X[:, 1] + 0.1 * np.random.default_rng(0).standard_normal(len(X))
    (pair,) = effects(X, y).pairs
    assert (pair.terms, pair.clear, round(pair.size)) == ((0, 1), True, 2)
