"""What a flight of any mission looks like on the terminal, from its result and its log."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from rich.table import Table
from rich.text import Text

from armland.experiments.judge.figures import bounds
from armland.records import LIMIT_NAMES
from armland.view.flown import Flown
from armland.view.tables.verdicts import cell, mark, terminal, titled


class Row(NamedTuple):
    """How one figure is shown: its name with unit, its key, what multiplies it and its format."""

    label: str
    key: str
    scale: float = 1.0
    form: str = "{:.3f}"


GROUPS: dict[str, tuple[Row, ...]] = {
    "capture": (
        Row("offset [mm]", "offset_m", 1e3, "{:.1f}"),
        Row("relative speed [m/s]", "relative_speed_mps"),
        Row("tilt of the plate [°]", "tilt_deg", 1.0, "{:.1f}"),
    ),
    "touchdown": (
        Row("speed [m/s]", "speed_mps"),
        Row("tilt [°]", "tilt_deg", 1.0, "{:.1f}"),
        Row("beside the middle [mm]", "offset_m", 1e3, "{:.1f}"),
    ),
    "release": (
        Row("hinge force [N]", "hinge_force_n", 1.0, "{:.2f}"),
        Row("speed [m/s]", "speed_mps"),
        Row("drop [mm]", "drop_m", 1e3, "{:.1f}"),
    ),
    "tracking": (
        Row("attitude max [°]", "attitude_max_deg", 1.0, "{:.2f}"),
        Row("attitude rms [°]", "attitude_rms_deg", 1.0, "{:.2f}"),
        Row("error rms x/y/z [mm]", "position_rms_m", 1e3, "{:.2f}"),
        Row("error max x/y/z [mm]", "position_max_m", 1e3, "{:.2f}"),
        Row("overshoot x/y/z [mm]", "overshoot_m", 1e3, "{:.2f}"),
        Row("Δτ asked max [N·m]", "delta_tau_max_nm", 1.0, "{:.2f}"),
    ),
}
"""Groups of figures, see `judge.figures.MEASURES`."""

LOADS = (
    Row("hinge force max [N]", "hinge_force_max_n", 1.0, "{:.1f}"),
    Row("magnet's pull max [N]", "magnet_pull_max_n", 1.0, "{:.1f}"),
    Row("magnet's shear max [N]", "magnet_shear_max_n", 1.0, "{:.1f}"),
    Row("shear over what the magnet holds [1]", "magnet_shear_max_ratio", 1.0, "{:.2f}"),
    Row("fall onto something [mm]", "fall_m", 1e3, "{:.1f}"),
    Row("joint torque over limit max [1]", "joint_torque_max_ratio", 1.0, "{:.2f}"),
)


def print_flight(result: Mapping[str, Any], run: Flown | None, out: Path) -> None:
    """Print verdict, phases, figures with the judge's bounds, limits, and where the rest is.

    Args:
        result: of the flight, as in result.json.
        run: its log; without one there are no bounds and no limits that were enforced.
        out: folder of the files.
    """
    console = terminal()
    verdict = Text.from_markup("[bold green]success[/]: " if result["success"] else "[bold red]failure[/]: ")
    console.print(verdict.append(result["reason"]))
    console.print(_phases(result))
    console.print(_figures(result, {} if run is None else bounds(run.brief)))
    for line in _sentences(result, run):
        console.print(line, markup=False)
    console.print(f"The data is in {out}/", markup=False)


def _phases(result: Mapping[str, Any]) -> Table:
    table = titled("Phases", "phase", "start [s]", "end [s]", "duration [s]")
    for p in result["phases"]:
        times = (p["start_s"], p["end_s"], p["end_s"] - p["start_s"])
        table.add_row(Text(p["name"]), *(f"{t:.2f}" for t in times))
    return table


def _figures(result: Mapping[str, Any], limits: dict[str, float]) -> Table:
    table = titled("Figures", "", "found", "bound", "", left=(0, 3))
    for group, rows in GROUPS.items():
        if group in result:
            own = {name.partition(".")[2]: bound for name, bound in limits.items() if name.startswith(group)}
            _group(table, group, rows, result[group], own)
    _group(table, "whole flight", LOADS, result, limits)
    return table


def _group(
    table: Table, title: str, rows: tuple[Row, ...], values: Mapping[str, Any], bounds: Mapping[str, float]
) -> None:
    table.add_section()
    table.add_row(title, style="bold")
    for row in rows:
        value, bound = values.get(row.key), bounds.get(row.key)
        words, verdict = "-", ""
        if bound is not None:
            words = f"at most {row.scale * bound:.4g}"
            # A value that is not there holds nothing. The slack is rounding's, as the judge grants it.
            verdict = mark(value is not None and value <= bound * (1.0 + 1e-9))
        table.add_row(Text(f"  {row.label}"), cell(value, row.scale, row.form), words, verdict)


def _sentences(result: Mapping[str, Any], run: Flown | None) -> Iterator[str]:
    yield f"Limits violated: {', '.join(result['limits_violated']) or 'none'}"
    if run is not None:
        yield f"Ticks in which a limit was enforced: {_enforced(run.ticks['health']['flags'])}"
    yield f"Fault: {result['fault']}. Missed captures: {result['retries']}."
    if result.get("law_failure"):
        yield f"The law: {result['law_failure']}."
    if result.get("log_cut_short"):
        yield f"The log is cut short: {result['log_cut_short']}"
    if result.get("never_acted"):
        yield f"Faults that never acted: {', '.join(result['never_acted'])}."
    yield f"Ended in phase {result['end'] or '-'}, the UAV {result['state'] or '-'}."
    simulated = result["phases"][-1]["end_s"] if result["phases"] else 0.0
    factor = result.get("real_time_factor")
    fast = "" if factor is None else f" at {factor:.1f} x real time"
    yield f"Seed {result['seed']}: {simulated:.1f} s simulated{fast}."


def _enforced(flags: np.ndarray) -> str:
    """Names of the limits with the number of ticks in which each was enforced, of flags (ticks,)."""
    ticks = {name: int(np.count_nonzero(flags & bit)) for bit, name in LIMIT_NAMES.items()}
    return ", ".join(f"{name} {n}" for name, n in ticks.items() if n) or "none"
