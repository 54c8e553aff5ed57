"""Columns of a CSV file as numbers, and times that a recording can have."""

import csv
from pathlib import Path

import numpy as np

from armland.errors import ConfigurationError
from armland.rotations import Array

LARGEST = 100_000_000
"""Bytes."""

GAP = 5.0
"""A step of so many times the median step is a gap."""


def read_header(path: Path, what: str) -> list[str]:
    """Names of the columns of `path`, which is `what`.

    Raises:
        ConfigurationError: it cannot be read.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            return [name.strip() for name in next(csv.reader(file), [])]
    except (OSError, UnicodeDecodeError, csv.Error) as e:
        raise ConfigurationError(f"{what} {str(path)!r:.200} cannot be read: {getattr(e, 'strerror', e)}") from e


def read_columns(path: Path, columns: tuple[str, ...], what: str) -> Array:
    """The numbers (k, columns) of those `columns` of `path`, which is `what`; there may be others.

    Raises:
        ConfigurationError: it cannot be read, has not two rows, or a number that is not finite; with the row.
    """
    try:
        if (size := path.stat().st_size) > LARGEST:
            raise ConfigurationError(f"{path.name} has {size} bytes; {what} has at most {LARGEST}")
        with path.open(encoding="utf-8-sig", newline="") as file:
            found = [[float(row[name]) for name in columns] for row in csv.DictReader(file, skipinitialspace=True)]
    except OSError as e:
        raise ConfigurationError(f"{what} {str(path)!r:.200} cannot be read: {e.strerror}") from e
    except (KeyError, TypeError, ValueError, csv.Error) as e:
        raise ConfigurationError(
            f"{path.name}: should have a header with {', '.join(columns)}, and numbers ({e})"
        ) from e
    if len(found) < 2:
        raise ConfigurationError(f"{path.name}: {len(found)} rows; {what} has two or more")
    rows = np.array(found)
    finite = np.isfinite(rows)
    if not finite.all():
        row, column = np.argwhere(~finite)[0]
        raise ConfigurationError(
            f"{path.name}: row {row + 1}: {columns[column]} = {rows[row, column]} is not a finite number"
        )
    return rows


def check_times(name: str, times: Array, needed_s: float) -> None:
    """Refuse times (k,), s, of the file `name` that fall, have a gap, or do not last for `needed_s`.

    Raises:
        ConfigurationError: with row, value and bound.
    """
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
