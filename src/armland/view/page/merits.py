"""Figures of a flight beside their bounds, and how near it came to each limit."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from armland.experiments.judge.figures import bounds
from armland.records import Limit
from armland.view.flown import Flown
from armland.view.page.grid import Cell, Grid, holds
from armland.view.tables.flight import GROUPS, LOADS, Row
from armland.view.tables.verdicts import cell


class Tile(NamedTuple):
    """One figure in large letters."""

    name: str
    value: str
    bound: str
    mark: str


def figures(result: Mapping[str, Any], run: Flown) -> Grid:
    """All figures in their groups, with bound and verdict."""
    limits = bounds(run.brief)
    out: list[Sequence[Cell | str]] = []
    for group, row, value, bound in _all(result, limits):
        if group:
            out.append((Cell(group, "group"), "", "", ""))
        out.append((row.label, cell(value, row.scale, row.form), _bound(row, bound), _verdict(row, value, bound)))
    return Grid("Figures and their bounds", ("figure", "found", "bound", "verdict"), out, left=(0, 3))


def tiles(result: Mapping[str, Any], run: Flown) -> list[Tile]:
    """The figures that have a bound, and how long it took."""
    out, group = [], ""
    for begins, row, value, bound in _all(result, bounds(run.brief)):
        group = begins or group
        if bound is not None and value is not None:
            name, _, unit = row.label.rstrip("]").partition(" [")
            name = name if group == WHOLE else f"{group} {name}"
            mark = "good" if value <= bound * (1.0 + 1e-9) else "bad"
            unit = "" if unit == "1" else f" {unit}"
            out.append(
                Tile(
                    name, f"{row.form.format(row.scale * value)}{unit}", f"at most {row.scale * bound:.4g}{unit}", mark
                )
            )
    seconds = result["phases"][-1]["end_s"] if result["phases"] else 0.0
    return [Tile("duration", f"{seconds:.1f} s", f"ended in {result['end'].replace('_', ' ')}", ""), *out]


def limits(result: Mapping[str, Any], run: Flown) -> Grid:
    """How near the flight came to each limit that the supervisor enforces, and in how many ticks it had to."""
    health, brief = run.ticks["health"], run.brief
    flags, age = health["flags"], 1e3 * float(health["uav_age"].max())
    force = float(result["hinge_force_max_n"])
    nearest = {
        Limit.JOINT_POSITION: (f"{float(health['joint_margin'].min()):.3f} rad left", None),
        Limit.JOINT_SPEED: _share(float(health["speed_ratio"].max())),
        Limit.JOINT_TORQUE: _share(float(health["torque_ratio"].max())),
        Limit.TORQUE_RATE: ("-", None),
        Limit.SINGULAR: _least(float(health["sigma_min"].min()), brief.limits.get("sigma_min")),
        Limit.HINGE_FORCE: _most(force, brief.limits.get("hinge_max")),
        Limit.UAV_STALE: (f"oldest sample {age:.0f} ms", None),
        Limit.NON_FINITE: ("-", None),
    }
    if not run.ticks["measurement"]["q"].shape[1]:
        nearest = {bit: found for bit, found in nearest.items() if bit not in OF_JOINTS}
    out: list[Sequence[Cell | str]] = []
    for bit, (words, share) in nearest.items():
        name = NAMES[bit]
        ticks = int(np.count_nonzero(flags & bit))
        violated = bit in JUDGED and JUDGED[bit] in result["limits_violated"]
        out.append(
            (name, Cell(words, share=share), f"{ticks}", Cell("violated", "bad") if violated else Cell("kept", "good"))
        )
    others = [n for n in result["limits_violated"] if n not in JUDGED.values()]
    out += [(n.replace("_", " "), "-", "-", Cell("violated", "bad")) for n in others]
    return Grid("Limits", ("limit", "nearest", "ticks enforced", "in the plant"), out, left=(0, 3))


NAMES = {
    Limit.JOINT_POSITION: "joint position",
    Limit.JOINT_SPEED: "joint speed, of the limit",
    Limit.JOINT_TORQUE: "joint torque asked, of the limit",
    Limit.TORQUE_RATE: "torque rate",
    Limit.SINGULAR: "distance to a singularity (σ)",
    Limit.HINGE_FORCE: "hinge force",
    Limit.UAV_STALE: "age of the UAV's samples",
    Limit.NON_FINITE: "numbers that are none",
}

OF_JOINTS = (Limit.JOINT_POSITION, Limit.JOINT_SPEED, Limit.JOINT_TORQUE, Limit.TORQUE_RATE, Limit.SINGULAR)
"""What only an arm can come near to."""

WHOLE = "whole flight"

JUDGED = {
    Limit.JOINT_POSITION: "joint_position",
    Limit.JOINT_SPEED: "joint_speed",
    Limit.JOINT_TORQUE: "joint_torque",
    Limit.TORQUE_RATE: "torque_rate",
    Limit.SINGULAR: "singularity",
    Limit.HINGE_FORCE: "hinge_force",
}
"""What the judge calls a limit."""


def _all(result: Mapping[str, Any], limits: Mapping[str, float]) -> Iterator[tuple[str, Row, Any, float | None]]:
    # Name of the group where one begins, row, value, bound.
    for group, rows in GROUPS.items():
        for i, row in enumerate(rows if group in result else ()):
            yield group if i == 0 else "", row, result[group].get(row.key), limits.get(f"{group}.{row.key}")
    for i, row in enumerate(LOADS):
        yield WHOLE if i == 0 else "", row, result.get(row.key), limits.get(row.key)


def _bound(row: Row, bound: float | None) -> Cell | str:
    return "-" if bound is None else f"at most {row.scale * bound:.4g}"


def _verdict(row: Row, value: Any, bound: float | None) -> Cell | str:
    # A value that is not there holds nothing. The slack is rounding's, as the judge grants it.
    return "" if bound is None else holds(value is not None and value <= bound * (1.0 + 1e-9))


def _share(share: float) -> tuple[str, float]:
    return f"{100.0 * share:.0f} %", min(share, 1.0)


def _most(value: float, bound: float | None) -> tuple[str, float | None]:
    return (
        (f"{value:.1f} N", None)
        if bound is None
        else (f"{value:.1f} N of {float(bound):.1f} N", min(value / bound, 1.0))
    )


def _least(value: float, bound: float | None) -> tuple[str, float | None]:
    if bound is None:
        return f"{value:.3f}", None
    return f"{value:.3f}, least allowed {float(bound):.3f}", min(float(bound) / value, 1.0) if value > 0.0 else 1.0
