"""Two points of a campaign flown with the same seeds: how much more often one succeeds, and how much larger its figures are.

The difference of two rates that were counted on the same seeds, with b flights of n that only the first survives and c that only the
second does, is (c − b)/n. Its interval is Wald's with half a flight added to each of the four cells, which keeps its confidence for few
flights, too, where none differs as well. McNemar's exact test asks whether b and c could be a fair coin's.

Source: A. Agresti, Y. Min: Simple improved confidence intervals for comparing matched proportions, Statistics in Medicine 24, 2005.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.stats import binomtest, bootstrap, norm

from armland.experiments.campaign.answers.table import Table
from armland.experiments.campaign.summary import FIGURES
from armland.rotations import Array

LEAST = 8
"""Pairs of which a median is worth an interval."""
RESAMPLES = 2000


class Difference(NamedTuple):
    """By how much the second of two paired samples exceeds the first."""

    name: str
    value: float
    low: float
    high: float
    pairs: int

    @property
    def clear(self) -> bool:
        """Whether the interval of 95 % leaves out zero."""
        return self.low > 0.0 or self.high < 0.0


class Pairing(NamedTuple):
    """A point beside another one, seed by seed."""

    first: int
    second: int
    """Points."""
    only_first: int
    only_second: int
    """Seeds with which only one of them succeeds."""
    rate: Difference
    """Of the rates of success, ratios."""
    chance: float
    """Probability of counts as unequal as these or more, if neither is better: McNemar's exact test."""
    figures: tuple[Difference, ...]
    """Of medians, over the seeds with which both have the figure."""


def compare(table: Table, first: int, second: int) -> Pairing | None:
    """The point `second` against `first`; None where they have no seed in common."""
    a, b = table.at(first), table.at(second)
    _, at_a, at_b = np.intersect1d(table.seed[a], table.seed[b], return_indices=True)
    if not len(at_a):
        return None
    one, two = table.success[a][at_a], table.success[b][at_b]
    lost, won = int(np.sum(one & ~two)), int(np.sum(two & ~one))
    chance = float(binomtest(won, lost + won).pvalue) if lost + won else 1.0
    found = []
    for key, column in table.figures.items():
        x, y = column[a][at_a], column[b][at_b]
        both = np.isfinite(x) & np.isfinite(y)
        if both.sum() >= LEAST:
            found.append(_median(FIGURES[key].name, x[both], y[both]))
    return Pairing(first, second, lost, won, rate_difference(one, two), chance, tuple(found))


def rate_difference(first: NDArray[np.bool_], second: NDArray[np.bool_], confidence: float = 0.95) -> Difference:
    """Rate of `second` less that of `first`, both (n,) successes with the same seeds; `confidence`, a ratio, of the interval."""
    n = len(first)
    lost, won = np.sum(first & ~second) + 0.5, np.sum(second & ~first) + 0.5
    middle, total = (won - lost) / (n + 2.0), n + 2.0
    half = norm.ppf(0.5 + 0.5 * confidence) * np.sqrt((lost + won) - (won - lost) ** 2 / total) / total
    value = float(np.mean(second, dtype=float) - np.mean(first, dtype=float))
    return Difference("success", value, float(max(middle - half, -1.0)), float(min(middle + half, 1.0)), n)


def _median(name: str, first: Array, second: Array) -> Difference:
    apart = second - first
    if np.ptp(apart) == 0.0:
        return Difference(name, float(apart[0]), float(apart[0]), float(apart[0]), len(apart))
    rng = np.random.default_rng(0)
    found = bootstrap(
        (apart,), np.median, n_resamples=RESAMPLES, method="percentile", rng=rng, vectorized=True, batch=100
    )
    interval = found.confidence_interval
    return Difference(name, float(np.median(apart)), float(interval.low), float(interval.high), len(apart))
