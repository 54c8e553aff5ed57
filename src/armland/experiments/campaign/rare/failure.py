"""What counts as the failure whose rate is asked for, and how near a flight came to it."""

import math
from collections.abc import Mapping

from armland.experiments.campaign.description import Failure
from armland.experiments.campaign.rows import Row
from armland.experiments.campaign.summary import FIGURES, raw


def in_words(failure: Failure | None) -> str:
    """The failure in words; None stands for the mission's own criteria."""
    if failure is None or failure.figure is None or failure.above is None:
        return "no success"
    name, scale = FIGURES[failure.figure]
    words, _, unit = name.removesuffix("]").partition(" [")
    return f"{words} above {failure.above * scale:g} {unit}".removesuffix(" 1")


def score(row: Row, failure: Failure | None, bounds: Mapping[str, float]) -> float:
    """How near a flight came: at or above 0 it failed, below it did not; −∞ if nothing says.

    Of a figure it is the distance to its threshold; a flight that has no such figure did not fail so. Of the mission's criteria it is
    the largest figure over its bound, less 1; every flight that does not succeed failed, one that was refused or broke as well.

    Args:
        row: of the flight.
        failure: what is asked for; None: that it does not succeed.
        bounds: of figures, see `judge.figures.bounds`.
    """
    result = row.judged()
    if failure is not None and failure.figure is not None and failure.above is not None:
        x = raw(result, failure.figure)
        # What lies at the threshold is not above it.
        return -math.inf if x is None else x - failure.above if x != failure.above else -math.ulp(0.0)
    shares = [x / b for key, b in bounds.items() if b > 0.0 and key in FIGURES and (x := raw(result, key)) is not None]
    nearest = max(shares, default=-math.inf) - 1.0
    return min(nearest, -math.ulp(0.0)) if row.success else max(nearest, 0.0)
