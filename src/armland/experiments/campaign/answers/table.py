"""The rows of a store as columns, read one by one, so that a million of them need little memory."""

import json
import re
from collections import Counter
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.experiments.campaign.description import Description
from armland.experiments.campaign.rows import BROKE, KILLED, REFUSED, Row
from armland.experiments.campaign.store import Store
from armland.experiments.campaign.summary import FIGURES, value
from armland.rotations import Array

VARIANT = "variant"

_DETAIL = re.compile(r"\s*\([^()]*\)|-?\d+(\.\d+)?(e-?\d+)?")


class Table(NamedTuple):
    """All rows of a campaign so far, k of them, in the order of their numbers."""

    run: NDArray[np.int64]
    """(k,) numbers of the rows."""
    point: NDArray[np.int64]
    """(k,)."""
    seed: NDArray[np.int64]
    """(k,)."""
    success: NDArray[np.bool_]
    """(k,)."""
    outcome: list[str]
    figures: dict[str, Array]
    """Key of `summary.FIGURES` -> (k,) values in the unit of the figure's name; NaN where a flight has none."""
    values: dict[str, list[Any]]
    """Path in the scenario -> value of each row; of variants, which set different paths, their names, as `VARIANT`."""
    reasons: dict[str, tuple[int, int]]
    """Why flights failed, in the words of the first -> how many have the same first cause, and the row of the first."""
    cpu_s: Array
    """(k,) s."""
    wall_s: Array
    """(k,) s."""

    def at(self, point: int) -> NDArray[np.bool_]:
        """Which rows (k,) are flights of a point."""
        return self.point == point

    @property
    def odd(self) -> dict[str, int]:
        """How many rows are no flights, by outcome."""
        counted = Counter(self.outcome)
        return {name: counted[name] for name in (REFUSED, BROKE, KILLED) if counted[name]}


def tabulate(store: Store) -> Table:
    """The columns of all rows of the store."""
    numbers: list[tuple[int, int, int, bool, float, float]] = []
    outcomes: list[str] = []
    figures: dict[str, list[float]] = {name: [] for name in FIGURES}
    values: dict[str, list[Any]] = {}
    reasons: dict[str, list[Any]] = {}
    variant = _variants(store.about.get("description"))
    for row in store.rows():
        numbers.append((row.run, row.point, row.seed, row.success, row.cpu_s, row.wall_s))
        outcomes.append(row.outcome)
        judged = row.judged()
        for name, column in figures.items():
            found = value(judged, name)
            column.append(np.nan if found is None else found)
        for path, one in variant(row).items():
            values.setdefault(path, []).append(one)
        if not row.success:
            reason = judged["reason"]
            entry = reasons.setdefault(cause(reason), [reason, 0, row.run])
            entry[1] += 1
    run, point, seed, success, cpu, wall = zip(*numbers, strict=True) if numbers else [()] * 6
    most = sorted(reasons.values(), key=lambda entry: -entry[1])
    return Table(
        np.array(run, int),
        np.array(point, int),
        np.array(seed, int),
        np.array(success, bool),
        outcomes,
        {name: np.array(column) for name, column in figures.items() if not np.all(np.isnan(column))},
        values,
        {reason: (count, first) for reason, count, first in most},
        np.array(cpu, float),
        np.array(wall, float),
    )


def _variants(described: dict[str, Any] | None) -> Callable[[Row], dict[str, Any]]:
    # What a row shows: its values, or where those differ in kind the name that stands for them, and what is drawn or swept beside.
    if described is None or not described.get("variants"):
        return lambda row: row.values
    description = Description.model_validate_json(json.dumps(described))
    names, beside = description.named, description.parameters
    return lambda row: {VARIANT: names[row.point]} | {path: x for path, x in row.values.items() if path in beside}


def cause(reason: str) -> str:
    """What failures of one kind have in common: the first cause, without its numbers and what stands in brackets."""
    return _DETAIL.sub("", reason).partition(";")[0].partition(",")[0].strip()
