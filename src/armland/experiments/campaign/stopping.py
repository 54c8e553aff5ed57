"""How sure one may be of a rate while it is being counted, however often one looks.

An interval of a fixed number of flights is no longer one of 95 % when somebody looks after each flight and stops when he likes what he
sees. A confidence sequence is: with probability 1 − α it holds the true rate at all looks at once.

For s successes and f failures and any rate p, the mixture of likelihoods over rates, each as probable as Beta(½, ½) says, divided by
the likelihood at p, is a martingale of mean 1 where p is true:

    M(p) = B(s + ½, f + ½) / (B(½, ½) pˢ (1 − p)ᶠ)

By Ville's inequality it ever exceeds 1/α with probability α at most. The rates with M(p) < 1/α are the sequence. It asks that flights
are drawn independently of each other: the design `random`.

Source: H. Robbins: Statistical methods related to the law of the iterated logarithm, 1970; S. R. Howard, A. Ramdas, J. McAuliffe,
J. Sekhon: Time-uniform, nonparametric, nonasymptotic confidence sequences, Annals of Statistics 49(2), 2021 (beta-binomial mixture).
"""

import math
from typing import NamedTuple

from scipy.optimize import brentq
from scipy.special import betaln

from armland.errors import ConfigurationError

ALPHA = 0.05
_PRIOR = 0.5


class Interval(NamedTuple):
    """Where a rate lies, ratios."""

    low: float
    high: float

    @property
    def half(self) -> float:
        """Half of its width."""
        return 0.5 * (self.high - self.low)


def always_valid(successes: int, failures: int, alpha: float = ALPHA) -> Interval:
    """The confidence sequence at this look; `alpha` is the probability, a ratio, that it ever misses the true rate."""
    s, f = successes, failures
    top = betaln(s + _PRIOR, f + _PRIOR) - betaln(_PRIOR, _PRIOR) + math.log(alpha)

    def excess(p: float) -> float:
        return top - (s * math.log(p) if s else 0.0) - (f * math.log1p(-p) if f else 0.0)

    best, tiny = s / (s + f) if s + f else 0.5, 1e-15
    low = brentq(excess, tiny, best, xtol=1e-12) if s and excess(tiny) > 0.0 else 0.0
    high = brentq(excess, best, 1.0 - tiny, xtol=1e-12) if f and excess(1.0 - tiny) > 0.0 else 1.0
    return Interval(float(low), float(high))


def half_width(text: str) -> float:
    """The half width, a ratio, that an option such as `0.5%` asks for.

    Raises:
        ConfigurationError: no number, or none between 0 and 50 %.
    """
    bare = text.strip().removesuffix("%")
    try:
        value = float(bare) / (100.0 if bare != text.strip() else 1.0)
    except ValueError:
        value = math.nan
    if not 1e-5 <= value < 0.5:
        raise ConfigurationError(
            f"--until {text!r}: expected half the width of the rate's interval, above 0.001% and below 50%, e.g. 0.5%"
        )
    return value


class Watch:
    """Counts flights in the order of their rows and says when every point's rate is known well enough.

    Flights end in any order, and one that fails early ends sooner, so what has ended is no fair sample. Only rows before which none is
    missing are counted.

    Args:
        points: number of points, each with a rate of its own.
        half: half width, a ratio, at which a rate is known well enough; None: never.
        alpha: as for `always_valid`, of each point alone.
    """

    def __init__(self, points: int, half: float | None, alpha: float = ALPHA) -> None:
        self._points, self._half, self._alpha = points, half, alpha
        self._early: dict[int, bool] = {}
        self.counts = [[0, 0] for _ in range(points)]
        """Failures and successes of each point."""
        self.rows = 0
        """Rows that are counted."""
        self.enough = False
        """Whether to stop; what comes later is not counted."""

    def add(self, run: int, success: bool) -> None:
        """Take the row `run`."""
        self._early[run] = success
        while not self.enough and self.rows in self._early:
            self.counts[self.rows % self._points][self._early.pop(self.rows)] += 1
            self.rows += 1
            if self._half is not None and self.rows % self._points == 0:
                self.enough = all(i.half <= self._half for i in self.intervals())

    def intervals(self) -> list[Interval]:
        """The confidence sequence of each point."""
        return [always_valid(good, bad, self._alpha) for bad, good in self.counts]
