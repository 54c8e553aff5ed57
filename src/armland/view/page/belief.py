"""Plant against belief: what the seed drew of each deviation's range, and where the scenario's belief is another one."""

from collections.abc import Iterator
from functools import reduce
from typing import Any

import numpy as np

from armland.plant.deviation.drawn import drawn, share_of
from armland.runtime.log import Log
from armland.scenario import Scenario
from armland.scenario.deviation import ranges, rows, unit_of
from armland.scenario.tables import leaves
from armland.view.flown import Flown
from armland.view.page.grid import Cell, Grid
from armland.view.tables.margins import range_in_words

UNITS = ("m", "kg", "deg", "px", "ms", "N")

MOST = 3
"""Numbers of a deviation that are written out; of more, the smallest and the largest."""


def deviations(scenario: Scenario, joints: int, hinged: bool) -> Grid | None:
    """What was drawn, each with its range; None where the plant is as it is believed to be.

    Args:
        scenario: of the run.
        joints: of the arm.
        hinged: whether the UAV is bound to the arm: it is calibrated there, and nothing deviates.
    """
    # Without an arm nothing of one deviates.
    values = {} if hinged else {path: v for path, v in drawn(scenario, joints).items() if np.size(v)}
    if not values:
        return None
    told, meaning = ranges(scenario.deviation), {row.path: row.meaning for row in rows()}
    out = []
    for path, value in values.items():
        spread, unit, share = told[path], unit_of(path), share_of(path, scenario)
        words = range_in_words(share * spread.low, share * spread.high, unit)
        most = max(abs(spread.low), abs(spread.high)) * share
        reach = float(np.abs(value).max()) / most if most else 0.0
        out.append((path, _first(meaning[path]), Cell(_numbers(value, unit), share=min(reach, 1.0)), words))
    return Grid(
        "Deviations of this seed: the plant's, which the controller does not know; the bar is the largest over its range",
        ("what", "meaning", "drawn", "range"),
        out,
        left=(0, 1),
    )


def beliefs(scenario: Scenario) -> Grid | None:
    """Where the controller's belief is set to differ; None where it is nowhere."""
    found = list(_differences(scenario))
    return Grid("Set beliefs", ("key", "plant", "believed"), found, left=(0,)) if found else None


def _differences(scenario: Scenario) -> Iterator[tuple[str, str, str]]:
    for path in leaves(scenario.belief):
        believed: Any = reduce(lambda data, key: data[key], path.split("."), scenario.belief)
        plant: Any = reduce(getattr, path.split("."), scenario)
        yield path, _written(plant), _written(believed)


def learnt(log: Log, run: Flown) -> Grid:
    """What the controller found out of what it did not know, at the end."""
    last, first = run.ticks["estimate"][-1], run.brief
    believed = "-" if not np.isfinite(first.weight) else f"{first.weight:.2f} N"
    out = [
        ("weight of all that flies", believed, f"{float(last['weight']):.2f} N"),
        ("thrust command that carries it", believed, f"{float(last['hover']):.2f} N"),
        ("camera's error over the one that it claims", "1", f"{float(last['camera_noise']):.2f}"),
        ("delay of commands to the UAV", "-", f"{1e3 * float(last['uplink']):.1f} ms"),
        ("delay of its samples", "-", f"{1e3 * float(last['downlink']):.1f} ms"),
    ]
    return Grid("Learnt in flight", ("what", "believed before", "found in the end"), out)


def _numbers(value: np.ndarray, unit: str) -> str:
    numbers = np.atleast_1d(value)
    text = (
        ", ".join(f"{x:+.3g}" for x in numbers)
        if len(numbers) <= MOST
        else f"{numbers.min():+.3g} to {numbers.max():+.3g} ({len(numbers)} values)"
    )
    return text if unit == "1" else f"{text} {unit}"


def _first(text: str) -> str:
    # Without its source, and without the unit, which stands beside the numbers.
    words = text.partition(";")[0].partition(" (")[0]
    head, comma, rest = words.partition(", ")
    return rest if (comma and not head.isalpha() | (" " in head)) or head in UNITS else words


def _written(value: Any) -> str:
    if isinstance(value, list | tuple):
        return ", ".join(_written(v) for v in value)
    if value is None:
        return "by its file"
    return f"{value:g}" if isinstance(value, float) else str(value)
