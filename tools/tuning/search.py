"""One optimiser for every method: the best of random settings, on seeds that nothing is judged by.

Settings are drawn as a Latin hypercube in each method's space; the first are those that stand in its scenario. All fly the same few
training seeds under each condition; the best quarter fly the rest of them, and the best of those is taken. Then the same once more in a
smaller box about it. So each method has as many flights as the others, and one that luck of a few seeds made look good must keep its
promise on more.

| symbol | name |
|---|---|
| c | cost of a flight: 0 where all criteria are kept; else 1 and how far speed and tilt exceed their bounds; 3 if nothing stands |
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.stats import qmc

from armland.errors import ConfigurationError
from armland.experiments.campaign.description import changes
from armland.experiments.episode import attempt
from armland.experiments.methods.table import Method
from armland.scenario import Scenario

Space = Mapping[str, tuple[float, float]]
"""Dotted path in the scenario -> least and largest value."""

Fly = Callable[[Scenario, Method, int], dict[str, Any]]
"""The result of one flight of a scenario, a method and a seed."""

FALLEN, KEEP = 3.0, 4
"""Cost of a flight after which nothing stands; of so many settings one goes on to the second round."""

FIRST_SHARE = 0.4
"""Of the training seeds, those of the first round."""


class Trial(NamedTuple):
    """Settings and what they cost."""

    settings: dict[str, float]
    cost: float
    """Mean over flights."""
    flights: int


def cost(result: Mapping[str, Any], bounds: Mapping[str, float]) -> float:
    """c of a flight's result; `bounds` of its figures as `judge.figures.bounds` has them, SI units and degrees."""
    if result["success"]:
        return 0.0
    if result.get("state") != "standing":
        return FALLEN
    excess = 0.0
    for key in ("speed_mps", "tilt_deg"):
        value, bound = (result.get("touchdown") or {}).get(key), bounds[f"touchdown.{key}"]
        excess += max(value / bound - 1.0, 0.0) if value is not None else 1.0
    return 1.0 + min(excess, 1.0)


def draw(space: Space, number: int, seed: int) -> list[dict[str, float]]:
    """`number` settings of a Latin hypercube in the `space`, rounded to three digits; `seed` of the draw."""
    unit = qmc.LatinHypercube(len(space), rng=np.random.default_rng(seed)).random(number)
    return [
        {
            path: float(f"{low + x * (high - low):.3g}")
            for x, (path, (low, high)) in zip(row, space.items(), strict=True)
        }
        for row in unit
    ]


def near(space: Space, settings: Mapping[str, float]) -> dict[str, tuple[float, float]]:
    """The box about the `settings`, a third as wide as the `space` each way, within it; the space itself about none."""
    out = {}
    for path, (low, high) in space.items():
        middle, half = settings.get(path, 0.5 * (low + high)), (high - low) / (6.0 if path in settings else 2.0)
        out[path] = (max(low, middle - half), min(high, middle + half))
    return out


def flown(scenario: Scenario, method: Method, seed: int) -> dict[str, Any]:
    """The result of one flight, whatever happens in it."""
    return attempt(scenario, method.mission, seed, law=method.law)


def tune(
    method: Method,
    space: Space,
    conditions: Sequence[Scenario],
    seeds: Sequence[int],
    settings: Iterable[dict[str, float]],
    bounds: Mapping[str, float],
    fly: Fly = flown,
) -> list[Trial]:
    """Try the settings, and those of the scenario first; all trials of the last round, the best first.

    Args:
        method: row of `table.METHODS`.
        space: where settings lie; what a scenario refuses is no setting.
        conditions: scenarios of the method, in wind and sea.
        seeds: for training.
        settings: to be tried, see `draw`.
        bounds: of figures, see `judge.figures.bounds`.
        fly: flies once.

    Raises:
        ConfigurationError: a setting outside the space.
    """
    tried = list(settings)
    for one in tried:
        for path, value in one.items():
            low, high = space.get(path, (np.nan, np.nan))
            if not low <= value <= high:
                raise ConfigurationError(f"{path} = {value:g} lies outside the space, {low:g} to {high:g}")
    few = seeds[: max(round(FIRST_SHARE * len(seeds)), 1)]
    first = sorted((_trial(method, one, conditions, few, bounds, fly) for one in [{}, *tried]), key=lambda t: t.cost)
    kept = first[: max(len(first) // KEEP, 1)]
    rest = seeds[len(few) :]
    if not rest:
        return kept
    return sorted(
        (_further(t, _trial(method, t.settings, conditions, rest, bounds, fly)) for t in kept), key=lambda t: t.cost
    )


def _trial(
    method: Method,
    settings: dict[str, float],
    conditions: Sequence[Scenario],
    seeds: Sequence[int],
    bounds: Mapping[str, float],
    fly: Fly,
) -> Trial:
    costs = []
    for scenario in conditions:
        try:
            one = scenario.replaced(changes(scenario.model_dump(mode="json"), settings)) if settings else scenario
        except ConfigurationError:
            return Trial(settings, np.inf, 0)
        costs += [cost(fly(one, method, seed), bounds) for seed in seeds]
    return Trial(settings, float(np.mean(costs)), len(costs))


def _further(t: Trial, more: Trial) -> Trial:
    flights = t.flights + more.flights
    return Trial(t.settings, (t.flights * t.cost + more.flights * more.cost) / max(flights, 1), flights)
