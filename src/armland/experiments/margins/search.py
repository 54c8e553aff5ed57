"""Where something that holds up to a point stops to hold: doubling until it fails, then halving the bracket by its ratio."""

from collections.abc import Callable
from typing import NamedTuple

STEPS = 6
"""Trials of a search at most."""

MOST = 8.0
"""Factor on the published range beyond which nobody looks."""

CLOSE = 1.1
"""Ratio of a bracket's ends at which it is narrow enough."""


class Failure(NamedTuple):
    """The first flight that failed at a factor."""

    seed: int
    reason: str
    state: str
    """Where the UAV then was."""
    flown: bool = True
    """False where the simulated device cannot be like that, so that nothing was flown."""


class Bracket(NamedTuple):
    """Between which factors the limit lies."""

    lands: float
    """Largest factor at which it held; 0 where it held at none that was tried."""
    fails: float | None
    """Smallest factor at which it failed; None where it never did."""
    failure: Failure | None
    """What ended it there."""
    trials: int


def bracketed(trial: Callable[[float], Failure | None], most: float, steps: int = STEPS) -> Bracket:
    """Search the limit of `trial`, which takes a factor and returns why it fails there, or None where it holds.

    What holds again beyond a failure is not looked for.

    Args:
        trial: called with rising factors from 1 until it fails, then between the ends of the bracket.
        most: largest factor, 1, that is tried.
        steps: largest number of trials.
    """
    low, high, failure, k = 0.0, None, None, 0
    while k < steps and (factor := following(low, high, most)) is not None:
        k, why = k + 1, trial(factor)
        if why is None:
            low = factor
        else:
            high, failure = factor, why
    return Bracket(low, high, failure, k)


def following(low: float, high: float | None, most: float) -> float | None:
    """The factor to try next in the bracket from `low`, which held, to `high`, which failed; None where it is narrow enough."""
    if high is None:
        return None if low >= most else min(max(2.0 * low, 1.0), most)
    if low == 0.0:
        return 0.5 * high
    return None if high <= CLOSE * low else (low * high) ** 0.5
