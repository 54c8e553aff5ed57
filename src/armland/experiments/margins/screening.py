"""All deviations at once in a two-level design of flights: which ones, and which pairs, bring a flight nearest to its bounds.

Low and high level of a row: its two ends where it is one number of two signs; else absent, and at its ends as `corners.at` has them.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from armland.experiments.episode import prepare
from armland.experiments.judge.figures import bounds
from armland.experiments.margins.corners import Changes, at, ends, nested, spread, two_ended
from armland.experiments.margins.design import design
from armland.experiments.margins.effects import Effect, effects
from armland.experiments.margins.flights import flown, merit, on_threads
from armland.experiments.paper import Progress
from armland.rotations import Array
from armland.scenario import Scenario
from armland.scenario.deviation import Row

SHOWN = 10
"""Effects of each kind that are listed."""


class Listed(NamedTuple):
    """An effect with the names of its rows."""

    rows: tuple[str, ...]
    worst_at: tuple[str, ...]
    """Level of each row at which the merit is worst by single effects and pair: `low`, `high`, `absent`, `there`."""
    size: float
    error: float
    clear: bool


class Screening(NamedTuple):
    """What the design found."""

    flights: int
    landed: int
    factor: float
    singles: tuple[Listed, ...]
    pairs: tuple[Listed, ...]


def level(row: Row, high: bool, factor: float, seed: int) -> Changes:
    """The row at its high or low level, at `factor` times the published range, in a flight with `seed`."""
    if two_ended(row):
        end = ends(row, factor)[high]
        return spread(row, end, end)
    return at(row, factor, seed) if high else spread(row, 0.0, 0.0)


def screened(
    scenario: Scenario,
    mission: str,
    chosen: Sequence[Row],
    factor: float,
    jobs: int | None,
    progress: Progress,
) -> Screening:
    """Fly the design, each run with a seed of its own from the scenario's on, and fit it.

    Args:
        scenario: with what stays the same in all flights.
        mission: name of the mission.
        chosen: rows that the design varies, two at least.
        factor: on the published ranges, 1.
        jobs: flights at a time; one per core if absent.
        progress: called with what is done and in all.
    """
    levels, first = design(len(chosen)), scenario.run.seed
    brief = prepare(scenario, mission).brief
    limits, retries = bounds(brief), scenario.bounds.retries

    def run(k: int) -> tuple[float | None, bool]:
        seed = first + k
        changes = [level(row, bool(x > 0.0), factor, seed) for row, x in zip(chosen, levels[k], strict=True)]
        result = flown(scenario, mission, seed, nested(changes))
        return merit(result, limits, retries), bool(result["success"])

    total = len(levels)
    found = on_threads(run, range(total), jobs, lambda done: progress("pairs", done, total))
    known = np.array([m is not None for m, _ in found])
    y = np.array([m for m, _ in found if m is not None])
    singles, pairs = effects(levels[known], y)
    size = {e.terms: e.size for e in (*singles, *pairs)}
    return Screening(
        len(y),
        sum(good for _, good in found),
        factor,
        *(tuple(listed(e, size, chosen) for e in es[:SHOWN]) for es in (singles, pairs)),
    )


def listed(e: Effect, size: dict[Any, float], chosen: Sequence[Row]) -> Listed:
    """The effect with names, and the corner of its rows' levels that is worst."""
    signs = np.array(np.meshgrid(*[[-1.0, 1.0]] * len(e.terms), indexing="ij")).reshape(len(e.terms), -1).T
    alone: Array = signs @ np.array([size[(i,)] for i in e.terms])
    together = signs.prod(axis=1) * e.size if len(e.terms) > 1 else 0.0
    worst = signs[int(np.argmax(alone + together))]
    rows = [chosen[i] for i in e.terms]
    return Listed(
        tuple(row.path for row in rows),
        tuple(_word(row, s > 0.0) for row, s in zip(rows, worst, strict=True)),
        e.size,
        e.error,
        e.clear,
    )


def _word(row: Row, high: bool) -> str:
    return ("high" if high else "low") if two_ended(row) else ("there" if high else "absent")
