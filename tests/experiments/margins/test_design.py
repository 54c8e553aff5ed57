"""Plackett and Burman's designs: balanced, orthogonal, products of columns nearly so."""

from itertools import combinations

import numpy as np
import pytest

from armland.experiments.margins.design import LEAST, design


@pytest.mark.parametrize("factors", [2, 5, 12, 13, 30, 65])
def test_columns_are_balanced_and_orthogonal(factors):
    X = design(factors)
    n = len(X)
    assert (X.shape[1], n >= 2 * factors, n >= LEAST) == (factors, True, True)
    assert set(np.unique(X)) == {-1.0, 1.0}
    np.testing.assert_array_equal(X.sum(axis=0), 0.0)
    np.testing.assert_array_equal(X.T @ X, n * np.eye(factors))


def test_pairs_of_65_factors_can_be_told_apart():
    X = design(65)
    Z = np.array([X[:, i] * X[:, j] for i, j in combinations(range(65), 2)]).T
    seen = np.abs(Z.T @ Z) / len(X)
    np.fill_diagonal(seen, 0.0)
    assert len(X) == 132
    assert seen.max() < 0.16
    assert (np.abs(Z.T @ X) / len(X)).max() < 0.16
