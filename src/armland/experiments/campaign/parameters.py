"""What varies in a campaign: a value of the scenario and how it is drawn, or the values that it is swept over."""

from collections.abc import Callable
from typing import Annotated, Any

import numpy as np
from pydantic import Field
from scipy import stats

from armland.rotations import Array
from armland.scenario.quantities import Section

DRAWN = ("uniform", "normal", "lognormal", "choice")
KINDS = (*DRAWN, "sweep", "fixed")
LEAST_MASS = 1e-9
"""Probability that bounds must leave."""
_Number = Annotated[float, Field(allow_inf_nan=False, ge=-1e12, le=1e12)]
_Pair = tuple[_Number, _Number]
_Values = Annotated[tuple[Any, ...], Field(min_length=1, max_length=10_000)]


class Parameter(Section):
    """How one value of the scenario is set: exactly one of the kinds, the others absent."""

    uniform: _Pair | None = Field(None, description="lowest and highest value")
    normal: _Pair | None = Field(None, description="mean and standard deviation")
    lognormal: _Pair | None = Field(None, description="median, and standard deviation of the natural logarithm")
    choice: _Values | None = Field(None, description="values that are drawn from")
    weights: tuple[_Number, ...] | None = Field(None, description="of each value of `choice`; equal if absent")
    sweep: _Values | None = Field(None, description="values, each of which is flown with the same seeds")
    fixed: Any = Field(None, description="a value of all flights")
    low: _Number | None = Field(None, description="bound of a normal or log-normal: what lies below is not drawn")
    high: _Number | None = Field(None, description="likewise above")

    @property
    def kind(self) -> str:
        """Which of `KINDS` it is."""
        return next(name for name in KINDS if getattr(self, name) is not None)

    def _contradictions(self) -> list[str]:
        given = [name for name in KINDS if getattr(self, name) is not None]
        if len(given) != 1:
            return [f"has {' and '.join(given) or 'no distribution'}; it takes one of {', '.join(KINDS)}"]
        (kind,) = given
        found = []
        bounded = kind in ("normal", "lognormal")
        if not bounded and (self.low is not None or self.high is not None):
            found.append(f"low and high are for normal and lognormal; a {kind} has its own ends")
        if self.weights is not None and kind != "choice":
            found.append(f"weights are for choice, not for {kind}")
        return [*found, *_problems(self, kind)]

    def quantile(self) -> Callable[[Array], list[Any]]:
        """What gives the drawn values for shares `u` (k,) of 1, from 0 to 1; of a drawn kind alone."""
        if self.choice is not None:
            steps = np.cumsum(self.weights or np.ones(len(self.choice)))
            values = self.choice
            return lambda u: [
                values[min(int(i), len(values) - 1)] for i in np.searchsorted(steps / steps[-1], u, "right")
            ]
        law = _law(self)
        return lambda u: [float(x) for x in law(u)]

    def examples(self) -> list[Any]:
        """Values that show whether a scenario takes them: all of a list, the ends of a range, or the middle where it has none."""
        if self.uniform is not None:
            return list(self.uniform)
        if self.kind in ("normal", "lognormal"):
            ends = [x for x in (self.low, self.high) if x is not None]
            return [*ends, *self.quantile()(np.array([0.5]))]
        return [self.fixed] if self.fixed is not None else list(self.choice or self.sweep or ())


def _problems(p: Parameter, kind: str) -> list[str]:
    if p.uniform is not None and p.uniform[0] >= p.uniform[1]:
        return [f"uniform = {list(p.uniform)} is an empty range; the first number must be below the second"]
    spread = p.normal or p.lognormal
    if spread is not None:
        if spread[1] <= 0.0:
            return [f"{kind} = {list(spread)}: the standard deviation must be above 0; `fixed` takes a single value"]
        if p.lognormal is not None and spread[0] <= 0.0:
            return [f"lognormal = {list(spread)}: the median must be above 0"]
        if p.low is not None and p.high is not None and p.low >= p.high:
            return [f"low = {p.low:g} to high = {p.high:g} is an empty range; low must be below high"]
        if _mass(p) < LEAST_MASS:
            return [f"low and high leave nothing of {kind} = {list(spread)} to draw from"]
    if p.choice is not None and p.weights is not None:
        if len(p.weights) != len(p.choice):
            return [f"weights has {len(p.weights)} numbers for {len(p.choice)} values of choice"]
        if min(p.weights) < 0.0 or sum(p.weights) <= 0.0:
            return ["weights must not be below 0, and one of them must be above it"]
    values = list(p.choice or p.sweep or ())
    twice = [x for i, x in enumerate(values) if x in values[:i]]
    return [f"{kind} has {twice[0]!r} twice"] if twice else []


def _standard(p: Parameter) -> tuple[float, float, float, float]:
    # Bounds in standard deviations, mean and deviation: of a log-normal those of the logarithm.
    mean, sd = p.normal or p.lognormal or (0.0, 1.0)
    low, high = -np.inf if p.low is None else p.low, np.inf if p.high is None else p.high
    if p.lognormal is not None:
        with np.errstate(divide="ignore"):
            low, high, mean = (float(np.log(max(x, 0.0))) for x in (low, high, mean))
    return (low - mean) / sd, (high - mean) / sd, mean, sd


def _mass(p: Parameter) -> float:
    a, b, _, _ = _standard(p)
    return float(max(stats.norm.cdf(b) - stats.norm.cdf(a), stats.norm.sf(a) - stats.norm.sf(b)))


def _law(p: Parameter) -> Callable[[Array], Array]:
    if p.uniform is not None:
        low, high = p.uniform
        return lambda u: low + u * (high - low)
    normal = stats.truncnorm(*_standard(p))
    return normal.ppf if p.normal is not None else lambda u: np.exp(normal.ppf(u))
