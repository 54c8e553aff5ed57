"""Flights with deviations of their own, over threads, and what a search or a design asks of each."""

import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from typing import Any, TypeVar

from armland.errors import ConfigurationError
from armland.experiments.campaign.summary import FIGURES, value
from armland.experiments.campaign.summary import Row as Result
from armland.experiments.episode import fly
from armland.scenario import Scenario

Task = TypeVar("Task")
Found = TypeVar("Found")

NOT_FLOWN = "not flown"
"""State of a UAV whose simulated devices cannot be as they were asked to be."""

FAILED = 2.0
"""Merit of a flight that failed: twice the bound."""

SHORT = 100
"""Characters of a shortened reason."""


def flown(scenario: Scenario, mission: str, seed: int, changes: Mapping[str, Any]) -> Result:
    """The result of a flight of the scenario with nested `changes`; where none came about, a row that says why."""
    try:
        return fly(scenario.replaced({**changes, "run": {"seed": seed}}), mission).result
    except ConfigurationError as e:
        return {"seed": seed, "success": False, "reason": str(e), "state": NOT_FLOWN}
    except Exception as e:
        return {"seed": seed, "success": False, "reason": f"broke: {type(e).__name__}: {e}", "state": "unknown"}


def merit(result: Result, bounds: Mapping[str, float], retries: int) -> float | None:
    """How near a flight came to its bounds, 1: the largest figure over its bound, at most `FAILED`, which is a failure.

    None where nothing was flown.

    Args:
        result: of a flight.
        bounds: of figures, SI units, see `judge.figures.bounds`; those of zero are left out.
        retries: missed captures that are allowed.
    """
    if result["state"] == NOT_FLOWN:
        return None
    if not result["success"]:
        return FAILED
    shares = [result.get("retries", 0) / max(retries, 1)]
    for name, bound in bounds.items():
        if name in FIGURES and bound > 0.0 and (found := value(result, name)) is not None:
            shares.append(found / (bound * FIGURES[name].scale))
    return min(max(shares), FAILED)


def shortened(reason: str) -> str:
    """The first cause that a reason names, cut at a word."""
    first = reason.partition(";")[0].strip()
    return first if len(first) <= SHORT else first[: SHORT - 1].rpartition(" ")[0] + " …"


def on_threads(
    work: Callable[[Task], Found], tasks: Sequence[Task], jobs: int | None, done: Callable[[int], None]
) -> list[Found]:
    """Do `work` on each task, `jobs` at a time, one per core if absent; `done` is called with how many are. In the tasks' order."""
    with ThreadPoolExecutor(jobs or os.cpu_count() or 1, "margins") as pool:
        futures = [pool.submit(work, task) for task in tasks]
        try:
            for k, _ in enumerate(as_completed(futures), start=1):
                done(k)
            return [future.result() for future in futures]
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
