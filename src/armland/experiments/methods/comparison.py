"""Methods flown with the same seeds: a campaign for each, and what their rows say side by side.

Success is the judge's, by all criteria of the method's mission. `stands` is weaker, and the same for all: in the end the UAV stands
upright and at rest where it should, however hard it came down. `lost` is one that neither stands nor flies nor is held.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.stats import binomtest

from armland.errors import ConfigurationError
from armland.experiments.campaign.answers.paired import Difference, rate_difference
from armland.experiments.campaign.description import Description
from armland.experiments.campaign.engine import Campaign
from armland.experiments.campaign.flight import prepared
from armland.experiments.campaign.rows import Job, Task
from armland.experiments.campaign.store import Store
from armland.experiments.judge.figures import bounds
from armland.experiments.methods.table import Method
from armland.rotations import Array
from armland.scenario import Scenario

FIGURES = {
    "touchdown.speed_mps": "speed (m/s)",
    "touchdown.tilt_deg": "tilt (°)",
    "touchdown.offset_m": "off (m)",
}
"""What is compared beside rates, where it stands in a result: speed and tilt at the touchdown, distance to the middle at the end."""

QUANTILES = (0.5, 0.95)


class Flights(NamedTuple):
    """What came of one method, k flights in the order of their seeds."""

    name: str
    seed: NDArray[np.int64]
    success: NDArray[np.bool_]
    stands: NDArray[np.bool_]
    lost: NDArray[np.bool_]
    figures: dict[str, Array]
    """By key of `FIGURES`; NaN where a flight never touched down."""
    bounds: dict[str, float]
    """Of the figures, SI units and degrees, where the method's mission has any."""
    reasons: dict[str, int]
    """Why flights failed, in the words of the first, and how many did for the same."""


class Rate(NamedTuple):
    """Of n flights those that did, with Wilson's interval at 95 %."""

    number: int
    of: int
    low: float
    high: float


class Paired(NamedTuple):
    """A method against the first, by seed."""

    name: str
    only_first: int
    only_second: int
    difference: Difference
    """Of the rates, second less first, with Agresti's and Min's interval."""
    chance: float
    """McNemar's exact test."""


def campaign_of_method(method: Method, name: str, scenario: Scenario, runs: int, first: int) -> Campaign:
    """The campaign that flies a method.

    Args:
        method: row of `table.METHODS`.
        name: its name.
        scenario: the method's, with the conditions that all methods share.
        runs: number of flights.
        first: seed of the first.

    Raises:
        ConfigurationError: the first flight is refused.
    """
    described = Description(
        title=name, mission=method.mission, scenario=method.scenario, law=method.law, first_seed=first
    )
    job = Job(scenario.frozen(), method.mission, method.law)
    limits = bounds(prepared(job, Task(0, 0, first, {})).brief)
    return Campaign(described, job, runs, limits)


def flights_of(store: Store, name: str, limits: dict[str, float], runs: int | None = None) -> Flights:
    """The flights of a store, of one point, as columns.

    Args:
        store: of the method.
        name: of the method.
        limits: of figures, see `judge.figures.bounds`.
        runs: only rows below this number; all if absent.

    Raises:
        ConfigurationError: it has no rows.
    """
    seeds, success, stands, lost = [], [], [], []
    columns: dict[str, list[float]] = {key: [] for key in FIGURES}
    reasons: dict[str, int] = {}
    for row in store.rows():
        if runs is not None and row.run >= runs:
            continue
        result = row.judged()
        touchdown: dict[str, Any] = result.get("touchdown") or {}
        seeds.append(row.seed)
        success.append(row.success)
        offset = touchdown.get("offset_m")
        placed = offset is not None and offset <= limits.get("touchdown.offset_m", np.inf)
        stands.append(result["state"] == "standing" and placed)
        lost.append(result["state"] == "lost")
        for key, column in columns.items():
            found = touchdown.get(key.partition(".")[2])
            column.append(np.nan if found is None else float(found))
        if not row.success:
            cause = result["reason"].split(":")[0].split(" (")[0]
            reasons[cause] = reasons.get(cause, 0) + 1
    if not seeds:
        raise ConfigurationError(f"{store.file} has no rows yet")
    order = np.argsort(np.array(seeds), kind="stable")
    figures = {key: np.array(column)[order] for key, column in columns.items()}
    good, upright, gone = (np.array(flag, bool)[order] for flag in (success, stands, lost))
    ranked = dict(sorted(reasons.items(), key=lambda item: -item[1]))
    return Flights(name, np.array(seeds)[order], good, upright, gone, figures, dict(limits), ranked)


def rate(flags: NDArray[np.bool_]) -> Rate:
    """How many of `flags` (k,) are true, with Wilson's interval."""
    interval = binomtest(int(flags.sum()), len(flags)).proportion_ci(0.95, method="wilson")
    return Rate(int(flags.sum()), len(flags), float(interval.low), float(interval.high))


def quantiles(values: Array) -> tuple[float, ...]:
    """`QUANTILES` of the `values` (k,) that are numbers, their unit; NaN where none is."""
    known = values[np.isfinite(values)]
    return tuple(float(x) for x in np.quantile(known, QUANTILES)) if len(known) else (np.nan,) * len(QUANTILES)


def paired(first: Flights, second: Flights, what: str = "success") -> Paired:
    """The second method against the first, over the seeds that both flew.

    Args:
        first: of one method.
        second: of another.
        what: `success`, `stands` or `lost`.

    Raises:
        ConfigurationError: they share no seed.
    """
    _, at_a, at_b = np.intersect1d(first.seed, second.seed, return_indices=True)
    if not len(at_a):
        raise ConfigurationError(f"{first.name} and {second.name} were flown with different seeds")
    one, two = getattr(first, what)[at_a], getattr(second, what)[at_b]
    lost, won = int(np.sum(one & ~two)), int(np.sum(two & ~one))
    chance = float(binomtest(won, lost + won).pvalue) if lost + won else 1.0
    return Paired(second.name, lost, won, rate_difference(one, two), chance)


def as_data(methods: Sequence[Flights]) -> dict[str, Any]:
    """The comparison as plain data, for JSON; the first of `methods` is what the others are held against."""
    out: dict[str, Any] = {"methods": [], "paired": []}
    for m in methods:
        figures = {
            key: dict(zip(map(str, QUANTILES), quantiles(values), strict=True)) for key, values in m.figures.items()
        }
        rates = {what: rate(getattr(m, what))._asdict() for what in ("success", "stands", "lost")}
        out["methods"].append({"name": m.name, **rates, "figures": figures, "bounds": m.bounds, "reasons": m.reasons})
    for other in methods[1:]:
        for what in ("success", "stands"):
            p = paired(methods[0], other, what)
            out["paired"].append(
                {**p._asdict(), "against": methods[0].name, "of": what, "difference": p.difference._asdict()}
            )
    return out
