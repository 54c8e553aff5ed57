"""Which parameters failures depend on, from the rows that are there: no flights beside those of the campaign.

The first-order Sobol index of a parameter is the share of the variance of success that its value alone explains,

    S = Var(E[success | value]) / Var(success).

With the values sorted into k classes of equal number it is the correlation ratio, which for a success that is yes or no is χ²/n of the
table of classes by outcome: Cramér's V², squared, of SciPy. By chance alone it would be (k − 1)/(n − 1); that much is taken off. The
index of a pair is counted likewise on the table of both, less those of each: what only the combination explains.

It assumes that parameters are drawn independently of each other, as all designs here do, and sees what the campaign varied and no more.
It is not the total index of Sobol: what needs three parameters at once is in no row.

Source: A. Saltelli et al.: Global sensitivity analysis, the primer, 2008, 4.5; bias of the correlation ratio: T. L. Kelley, 1935.
"""

import json
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2_contingency, spearmanr
from scipy.stats.contingency import association

from armland.experiments.campaign.answers.table import Table
from armland.rotations import Array

CLASSES = 8
"""Classes of a parameter that is a number, where there are flights enough."""
PER_CLASS = 10
"""Flights that a class needs."""
MOST_PAIRS = 5
MOST_TAKEN = 8
"""Parameters, the first by index, whose pairs are looked at."""


class Influence(NamedTuple):
    """How much of the variance of success a parameter explains, or a pair of them beyond each alone."""

    names: tuple[str, ...]
    share: float
    """Ratio."""
    chance: float
    """Probability of as much or more where success does not depend on it."""
    trend: float
    """Rank correlation of value and failure, from −1 to 1: above zero, more of it fails more often; 0 of a pair or of words."""


class Sensitivity(NamedTuple):
    """Parameters by their influence, and the pairs that do most together."""

    single: tuple[Influence, ...]
    pairs: tuple[Influence, ...]


def sensitivity(table: Table) -> Sensitivity:
    """What the outcomes of a campaign depend on; empty where all flights end alike, or none of the values varies."""
    success = table.success
    if not len(success) or success.all() or not success.any():
        return Sensitivity((), ())
    classes = {name: found for name, column in table.values.items() if (found := classed(column)) is not None}
    single = [
        Influence((name,), *explained(found, success), trend(table.values[name], success))
        for name, found in classes.items()
    ]
    single.sort(key=lambda i: -i.share)
    alone = {i.names[0]: i.share for i in single}
    pairs = []
    for a, b in combinations([i.names[0] for i in single[:MOST_TAKEN]], 2):
        # Coarser classes: a table of pairs has the square of them.
        both = _coarse(table.values[a], len(success)) * (2 * CLASSES) + _coarse(table.values[b], len(success))
        index, chance = explained(both, success)
        pairs.append(Influence((a, b), max(index - alone[a] - alone[b], 0.0), chance, 0.0))
    pairs.sort(key=lambda i: -i.share)
    return Sensitivity(tuple(single), tuple(pairs[:MOST_PAIRS]))


def classed(column: list[Any], most: int = CLASSES) -> NDArray[np.int64] | None:
    """Class (k,) of each value: itself where there are few, else of equal number in their order; None where all are the same."""
    distinct = {json.dumps(v, sort_keys=True) for v in column}
    if len(distinct) < 2:
        return None
    numbers = as_numbers(column)
    if len(distinct) <= most or numbers is None:
        names = {text: i for i, text in enumerate(sorted(distinct))}
        return np.array([names[json.dumps(v, sort_keys=True)] for v in column])
    count = max(min(most, len(column) // PER_CLASS), 2)
    edges = np.quantile(numbers, np.linspace(0.0, 1.0, count + 1)[1:-1])
    return np.searchsorted(edges, numbers, "right")


def _coarse(column: list[Any], flights: int) -> NDArray[np.int64]:
    found = classed(column, max(min(4, int((flights / PER_CLASS) ** 0.5)), 2))
    return np.zeros(len(column), int) if found is None else found


def explained(classes: NDArray[np.int64], success: NDArray[np.bool_]) -> tuple[float, float]:
    """Share of the variance of `success` (k,) that `classes` (k,) explain, and the probability of as much by chance."""
    _, at = np.unique(classes, return_inverse=True)
    counted = np.stack([np.bincount(at, weights=success), np.bincount(at, weights=~success)]).astype(int)
    k, n = counted.shape[1], len(success)
    if k < 2 or n <= k:
        return 0.0, 1.0
    raw = association(counted, method="cramer") ** 2
    return max(float((raw * (n - 1) - (k - 1)) / (n - k)), 0.0), float(
        chi2_contingency(counted, correction=False).pvalue
    )


def trend(column: list[Any], success: NDArray[np.bool_]) -> float:
    """Rank correlation of the values of a column with failure, (k,) `success`; 0 of words."""
    numbers = as_numbers(column)
    return 0.0 if numbers is None else float(spearmanr(numbers, ~success).statistic)


def as_numbers(column: list[Any]) -> Array | None:
    """The values (k,) where all are numbers; truth values are none."""
    if all(isinstance(v, int | float) and not isinstance(v, bool) for v in column):
        return np.array(column, float)
    return None
