"""Two-level designs that screen many factors with few runs: Plackett and Burman's, by Paley's construction.

For a prime q with q mod 4 = 3 the quadratic characters χ of differences modulo q make an orthogonal matrix of q + 1 rows: its columns
are balanced and orthogonal, so each factor's effect is estimated by all runs. A product of two columns is nearly orthogonal to all
other columns and products (the sum of q characters of a polynomial is below a multiple of √q), so pairs can be told apart.

Source: R. E. A. C. Paley: On orthogonal matrices, 1933; R. L. Plackett, J. P. Burman: The design of optimum multifactorial
experiments, 1946.
"""

from itertools import count

import numpy as np

from armland.rotations import Array

LEAST = 24
"""Runs of the smallest design: fewer leave nothing to estimate an error by."""


def design(factors: int) -> Array:
    """Levels (n, factors) of −1 and 1, columns orthogonal and balanced, with at least twice as many runs as `factors`."""
    q = next(q for q in count(max(2 * factors, LEAST) - 1) if q % 4 == 3 and _prime(q))
    difference = np.subtract.outer(np.arange(q), np.arange(q)) % q
    square = np.zeros(q, dtype=bool)
    square[np.arange(1, q) ** 2 % q] = True
    core = np.where(square[difference], 1.0, -1.0)
    # The diagonal of I + S is one, and the first row is turned so that all columns but the first, which is left out, balance.
    np.fill_diagonal(core, 1.0)
    return np.vstack([-np.ones(q), core])[:, :factors]


def _prime(q: int) -> bool:
    return q > 1 and all(q % d for d in range(2, int(q**0.5) + 1))
