"""A recorded wind: a CSV file with the columns time_s, x, y, z, checked for what no anemometer records."""

import csv
from pathlib import Path

import numpy as np

from armland.errors import ConfigurationError
from armland.rotations import Array
from armland.scenario.environment import MOST_MPS

COLUMNS = ("time_s", "x", "y", "z")

LARGEST = 100_000_000
"""Bytes."""

GAP = 5.0
"""A step of so many times the median step is a gap."""


def read_trace(path: Path, needed_s: float) -> tuple[Array, Array]:
    """A recorded wind that lasts for `needed_s` or longer.

    Returns:
        Times (k,) s, from 0 on, and velocities (k, 3) m/s.

    Raises:
        ConfigurationError: it cannot be read, is too short, has gaps, is not in order, is not finite, or is too fast to be wind in m/s;
            with the row, the value and the bound.
    """
    rows = _rows(path)
    if len(rows) < 2:
        raise ConfigurationError(f"{path.name}: {len(rows)} rows; a recorded wind has two or more")
    finite = np.isfinite(rows)
    if not finite.all():
        row, column = np.argwhere(~finite)[0]
        raise ConfigurationError(
            f"{path.name}: row {row + 1}: {COLUMNS[column]} = {rows[row, column]} is not a finite number"
        )
    velocities = rows[:, 1:]
    most = np.abs(velocities)
    if most.max() > MOST_MPS:
        row, axis = np.unravel_index(int(most.argmax()), most.shape)
        raise ConfigurationError(
            f"{path.name}: row {row + 1}: {COLUMNS[axis + 1]} = {velocities[row, axis]:g} m/s; at most {MOST_MPS:g} m/s is wind: "
            "is it in other units?"
        )
    _check_times(path.name, rows[:, 0], needed_s)
    return rows[:, 0] - rows[0, 0], velocities


def _check_times(name: str, times: Array, needed_s: float) -> None:
    steps = np.diff(times)
    if (steps <= 0.0).any():
        row = int(np.argmax(steps <= 0.0)) + 1
        raise ConfigurationError(
            f"{name}: row {row + 1}: time_s = {times[row]:g} follows {times[row - 1]:g}; times must rise"
        )
    median = float(np.median(steps))
    if steps.max() > GAP * median:
        row = int(steps.argmax()) + 1
        raise ConfigurationError(
            f"{name}: row {row + 1}: a gap of {steps.max():g} s; the median step is {median:g} s, and {GAP:g} times that is allowed"
        )
    if (lasts := times[-1] - times[0]) < needed_s:
        raise ConfigurationError(
            f"{name}: lasts {lasts:g} s, and run.duration_s = {needed_s:g}; a longer record, or a shorter run"
        )


def _rows(path: Path) -> Array:
    try:
        if (size := path.stat().st_size) > LARGEST:
            raise ConfigurationError(f"{path.name} has {size} bytes; a recorded wind has at most {LARGEST}")
        with path.open(encoding="utf-8-sig", newline="") as file:
            found = [[float(row[name]) for name in COLUMNS] for row in csv.DictReader(file)]
    except OSError as e:
        raise ConfigurationError(f"recorded wind {str(path)!r:.200} cannot be read: {e.strerror}") from e
    except (KeyError, TypeError, ValueError, csv.Error) as e:
        raise ConfigurationError(
            f"{path.name}: should have a header with {', '.join(COLUMNS)}, and numbers ({e})"
        ) from e
    return np.array(found).reshape(-1, len(COLUMNS))
