"""Effects of single factors and of pairs on a figure of merit, from a two-level design, by least squares with pairs chosen one by one.

| symbol | name | |
|---|---|---|
| y | `y` | merit of each run |
| X | `levels` | (n, p) of −1 and 1 |
| b | | coefficients of 1, X and the pairs taken in |
| 2b | `Effect.size` | change of y from a factor's low level to its high one; of a pair, see there |

A pair is taken in while the best of all is clear beyond chance; what is left of y is what errors are estimated from.
"""

from itertools import combinations
from typing import NamedTuple

import numpy as np

from armland.rotations import Array

CHANCE = 0.05
"""Probability that chance alone makes any one of all singles, or of all pairs, clear."""

NOTHING = 1e-9
"""Size of an effect below which rounding made it."""

Terms = tuple[int, ...]
"""Columns of X whose product it is: one or two."""


class Effect(NamedTuple):
    """An effect on the merit."""

    terms: Terms
    size: float
    """Of a factor: change of the merit from low to high; of a pair: half the difference of one's size at the other's two levels."""
    error: float
    """Its standard error."""
    clear: bool
    """Whether it stands out beyond chance, all effects of its kind counted."""


class Effects(NamedTuple):
    """All effects of a design, the largest that make the merit worse or better first."""

    singles: tuple[Effect, ...]
    pairs: tuple[Effect, ...]


def effects(levels: Array, y: Array) -> Effects:
    """Effects of the columns of `levels` (n, p) on `y` (n,), n > p + 2, and of all their pairs."""
    n, p = levels.shape
    singles: list[Terms] = [(i,) for i in range(p)]
    pairs: list[Terms] = list(combinations(range(p), 2))
    products = np.array([levels[:, i] * levels[:, j] for i, j in pairs]).reshape(-1, n).T
    taken: list[Terms] = []
    found = _fitted(levels, y, singles)
    others = _alone(levels, y, singles, pairs, products)
    while others and (best := max(others, key=_strength)).clear and len(taken) + p + 3 < n:
        taken.append(best.terms)
        found = _fitted(levels, y, [*singles, *taken])
        others = _alone(levels, y, [*singles, *taken], pairs, products)
    kept = {e.terms: e for e in found if e.terms in taken}
    all_pairs = [kept.get(e.terms, e) for e in others]
    alone = [e._replace(clear=_is_clear(e.size, e.error, n - 1 - p - len(taken), p)) for e in found[:p]]
    return Effects(
        tuple(sorted(alone, key=_strength, reverse=True)), tuple(sorted(all_pairs, key=_strength, reverse=True))
    )


def _fitted(levels: Array, y: Array, terms: list[Terms]) -> list[Effect]:
    """Effects of all `terms` in one model; those of pairs in it are clear, which is why they are there."""
    A = np.column_stack([np.ones(len(y)), *(levels[:, list(t)].prod(axis=1) for t in terms)])
    b, rest = np.linalg.lstsq(A, y, rcond=None)[0], len(y) - A.shape[1]
    variance = float(((y - A @ b) ** 2).sum()) / rest
    errors = np.sqrt(variance * np.diag(np.linalg.pinv(A.T @ A)))
    return [Effect(t, 2.0 * float(b[k]), 2.0 * float(errors[k]), True) for k, t in enumerate(terms, start=1)]


def _alone(levels: Array, y: Array, terms: list[Terms], pairs: list[Terms], products: Array) -> list[Effect]:
    """The effect of each pair, were it the next in a model of `terms`; by Frisch, Waugh and Lovell."""
    if not pairs:
        return []
    A = np.column_stack([np.ones(len(y)), *(levels[:, list(t)].prod(axis=1) for t in terms)])
    Q = np.linalg.qr(A)[0]
    left, apart = y - Q @ (Q.T @ y), products - Q @ (Q.T @ products)
    own = (apart**2).sum(axis=0)
    # A pair that is in the model, or that the model makes up, leaves nothing to see.
    seen = own > 1e-6 * len(y)
    b = np.divide(apart.T @ left, own, out=np.zeros(len(pairs)), where=seen)
    rest = len(y) - A.shape[1] - 1
    spare = np.maximum((left**2).sum() - b**2 * own, 0.0) / rest
    errors = np.sqrt(np.divide(spare, own, out=np.full(len(pairs), np.inf), where=seen))
    return [
        Effect(t, 2.0 * float(b[k]), 2.0 * float(errors[k]), _is_clear(b[k], errors[k], rest, len(pairs)))
        for k, t in enumerate(pairs)
    ]


def _is_clear(size: float, error: float, rest: int, among: int) -> bool:
    # Imported here: it takes a while, which no other command pays.
    from scipy.special import stdtr

    if abs(size) < NOTHING or not np.isfinite(error):
        return False
    # Bonferroni: any of `among` effects could be clear by chance.
    return bool(error < NOTHING or 2.0 * stdtr(rest, -abs(size) / error) * among < CHANCE)


def _strength(e: Effect) -> float:
    """Size over error."""
    if abs(e.size) < NOTHING:
        return 0.0
    return abs(e.size) / e.error if e.error > 0.0 else np.inf
