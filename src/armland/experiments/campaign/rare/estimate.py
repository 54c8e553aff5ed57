"""The rate of a failure from flights that weigh differently, how sure one may be of it, and what plain flights would have taken.

With weights w of n flights, of which those with x = 1 failed, the rate is y = Σ w x/n. Its interval is that of a weighted sum of
Poisson counts: a gamma distribution with the mean and variance of y for the lower end, and for the upper one as if one more flight had
failed that weighs as much as the heaviest. It keeps its confidence for few failures, where a normal distribution would not.

Source: M. P. Fay, E. J. Feuer: Confidence intervals for directly standardized rates, Statistics in Medicine 16, 1997.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.stats import gamma

from armland.experiments.campaign.rare.proposal import PLAIN
from armland.experiments.campaign.stopping import ALPHA, Interval
from armland.rotations import Array


class Rate(NamedTuple):
    """A rate of failures."""

    value: float
    deviation: float
    """Coefficient of variation, a ratio; infinite where no flight failed."""
    interval: Interval
    """At 95 %."""
    flights: int
    failed: int
    plain: float
    """Flights that a plain campaign takes for the same coefficient of variation; infinite where no flight failed."""


def rate_of(weights: Array, failed: NDArray[np.bool_]) -> Rate:
    """The rate from flights with `weights` (n,), n ≥ 2, of which some `failed` (n,)."""
    n = len(weights)
    if not failed.any():
        # No failure in the flights of the mixture's first part, which are as a plain campaign's.
        return Rate(0.0, math.inf, Interval(0.0, min(-math.log(ALPHA / 2.0) / (PLAIN * n), 1.0)), n, 0, math.inf)
    each = weights * failed
    y, v = float(each.mean()), float(each.var(ddof=1) / n)
    # Where all failed with the same weight chance still was in it.
    v, most = max(v, y * y / n), float(each.max() / n)
    low = gamma.ppf(ALPHA / 2.0, y * y / v, scale=v / y)
    above, more = y + most, v + most * most
    high = gamma.ppf(1.0 - ALPHA / 2.0, above * above / more, scale=more / above)
    plain = (1.0 - min(y, 1.0)) * y / v
    return Rate(y, math.sqrt(v) / y, Interval(float(low), min(float(high), 1.0)), n, int(failed.sum()), plain)
