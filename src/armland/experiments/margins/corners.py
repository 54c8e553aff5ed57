"""Deviations at the ends of a range, so that few seeds find what a range can do; which rows are meant by a pattern.

| row | at the factor k |
|---|---|
| one sign | exactly k times the published end, in every seed |
| two signs, one number | the high end with even seeds, the low end with odd ones |
| two signs, several numbers | each number at one end or the other, by chance; a seed's signs are the same at every k |
"""

from collections.abc import Iterable
from difflib import get_close_matches
from fnmatch import fnmatchcase
from typing import Any

from armland.errors import ConfigurationError
from armland.scenario.deviation import Row, rows

Changes = dict[str, Any]
"""Nested values for `Scenario.replaced`."""

COMPANIONS = {
    "camera.outlier": "camera.outlier_m",
    "camera.outlier_m": "camera.outlier",
    "link.burst": "link.loss",
    "hinge.askew_deg": "hinge.stiffness_nm",
}
"""Row -> another without which it does nothing: that one stands at its published end while the row is varied."""


def one_sign(row: Row) -> bool:
    """Whether the deviation is zero or above it."""
    return row.told.low >= 0.0


def two_ended(row: Row) -> bool:
    """Whether the deviation is one number of two signs: seeds then take turns between its ends."""
    return not one_sign(row) and row.told.size == "1"


def end_of(row: Row, seed: int) -> str | None:
    """At which end of a two-ended row a flight with `seed` stands; None for others."""
    return ("low" if seed % 2 else "high") if two_ended(row) else None


def largest(row: Row) -> float:
    """The factor k, 1, at which the row reaches the bound of what such a device can be."""
    t = row.told
    below = t.least / t.low if t.low < 0.0 else float("inf")
    return min(below, t.most / t.high)


def at(row: Row, factor: float, seed: int) -> Changes:
    """The row's range in a flight with `seed`, at `factor` times the published ends."""
    low, high = ends(row, factor)
    if one_sign(row):
        return spread(row, high, high)
    if two_ended(row):
        end = low if end_of(row, seed) == "low" else high
        return spread(row, end, end)
    return spread(row, low, high)


def ends(row: Row, factor: float) -> tuple[float, float]:
    """Low and high end of the row at `factor`, in its unit, within its bound; of one sign both are the same."""
    t = row.told
    low, high = max(factor * t.low, t.least), min(factor * t.high, t.most)
    return (high, high) if one_sign(row) else (low, high)


def spread(row: Row, low: float, high: float) -> Changes:
    """The change that draws the row from its ends `low` and `high` alone."""
    return {row.path: {"low": low, "high": high, "normal": False, "ends": True}}


def nested(changes: Iterable[Changes]) -> Changes:
    """Ranges by `device.key` as the scenario's section `deviation`; of two for one row the later counts."""
    section: Changes = {}
    for change in changes:
        for path, value in change.items():
            device, key = path.split(".")
            section.setdefault(device, {})[key] = value
    return {"deviation": section}


def chosen(patterns: str | None) -> tuple[Row, ...]:
    """The rows that the `patterns`, with commas between them, mean, in the order of the table; all if there are none.

    Raises:
        ConfigurationError: patterns that mean no row; it names near ones.
    """
    known = tuple(rows())
    wanted = [p.strip() for p in (patterns or "*").split(",") if p.strip()]
    paths = [row.path for row in known]
    unknown = [p for p in wanted if not any(fnmatchcase(path, p) for path in paths)]
    if unknown or not wanted:
        lines = [f"--rows {p!r}: no such deviation{_near(p, paths)}" for p in unknown or [""]]
        raise ConfigurationError("\n  ".join(lines))
    return tuple(row for row in known if any(fnmatchcase(row.path, p) for p in wanted))


def _near(pattern: str, paths: list[str]) -> str:
    keys = {path.partition(".")[2]: path for path in paths}
    near = get_close_matches(pattern, paths, 3) or [keys[k] for k in get_close_matches(pattern, keys, 3)]
    of = [path for path in paths if path.partition(".")[0] == pattern.partition(".")[0]]
    devices = dict.fromkeys(f"{path.partition('.')[0]}.*" for path in paths)
    return f"; near: {', '.join(near)}" if near else f"; there are {', '.join(of or devices)}"
