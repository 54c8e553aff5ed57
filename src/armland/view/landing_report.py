"""What a landing or a take-off looks like on the terminal."""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text

from armland.experiments.landing import LandingOutcome
from armland.experiments.landing_judge import PLACED_M, TOUCHDOWN_SPEED_MPS, TOUCHDOWN_TILT_DEG
from armland.mission.records import LIMIT_NAMES


class Row(NamedTuple):
    """How one number is shown: its name with unit, its key, what multiplies it, its format, and the judge's upper bound."""

    label: str
    key: str
    scale: float
    form: str
    bound: float | None = None


CAPTURE = (
    Row("offset [mm]", "offset_m", 1e3, "{:.1f}"),
    Row("relative speed [m/s]", "relative_speed_mps", 1.0, "{:.3f}"),
    Row("tilt of the plate [°]", "tilt_deg", 1.0, "{:.1f}"),
)
TOUCHDOWN = (
    Row("speed [m/s]", "speed_mps", 1.0, "{:.3f}", TOUCHDOWN_SPEED_MPS),
    Row("tilt [°]", "tilt_deg", 1.0, "{:.1f}", TOUCHDOWN_TILT_DEG),
    Row("beside the middle [mm]", "offset_m", 1e3, "{:.1f}", PLACED_M),
)
RELEASE = (
    Row("hinge force [N]", "hinge_force_n", 1.0, "{:.2f}"),
    Row("speed [m/s]", "speed_mps", 1.0, "{:.3f}"),
    Row("drop [mm]", "drop_m", 1e3, "{:.1f}"),
)
LOADS = (
    Row("hinge force max [N]", "hinge_force_max_n", 1.0, "{:.1f}"),
    Row("joint torque over limit max [1]", "joint_torque_max_ratio", 1.0, "{:.2f}", 1.0),
)


def print_landing(outcome: LandingOutcome, out: Path) -> None:
    """Print verdict, phases, figures with the judge's bounds, limits, the real-time factor, and where the rest is."""
    console = Console(highlight=False)
    verdict = Text.from_markup("[bold green]success[/]: " if outcome.success else "[bold red]failure[/]: ")
    console.print(verdict.append(outcome.reason))
    console.print(_phases(outcome))
    console.print(_figures(outcome))
    for line in _lines(outcome):
        console.print(line, markup=False)
    console.print(f"The data is in {out}/", markup=False)


def _phases(outcome: LandingOutcome) -> Table:
    table = Table(title="Phases", title_justify="left")
    table.add_column("phase")
    for column in ("start [s]", "end [s]", "duration [s]"):
        table.add_column(Text(column), justify="right")
    for p in outcome.phases:
        times = (p.start_s, p.end_s, p.end_s - p.start_s)
        table.add_row(Text(p.name), *(f"{t:.2f}" for t in times))
    return table


def _figures(outcome: LandingOutcome) -> Table:
    table = Table(title="Figures", title_justify="left")
    for column in ("", "found", "bound", ""):
        table.add_column(column, justify="right" if column else "left")
    loads = {row.key: getattr(outcome, row.key) for row in LOADS}
    # Only a take-off has figures of a release, and it has none of the other two.
    flown: tuple[tuple[str, tuple[Row, ...], dict[str, float | None]], ...] = (
        (("release", RELEASE, outcome.release),)
        if outcome.release
        else (("capture", CAPTURE, outcome.capture), ("touchdown", TOUCHDOWN, outcome.touchdown))
    )
    for title, rows, values in (*flown, ("whole flight", LOADS, loads)):
        table.add_section()
        table.add_row(title, style="bold")
        for row in rows:
            table.add_row(Text(f"  {row.label}"), *_cells(row, values.get(row.key)))
    return table


def _cells(row: Row, value: float | None) -> tuple[str, str, str]:
    """What was found, the bound and whether it holds; a dash where there is none."""
    found = "-" if value is None else row.form.format(row.scale * value)
    if row.bound is None:
        return found, "-", ""
    # Not "fails where above": a value that is not a number holds nothing. The slack is rounding's, as the judge grants it.
    holds = value is not None and value <= row.bound * (1.0 + 1e-9)
    return found, f"at most {row.scale * row.bound:.4g}", "[green]holds[/]" if holds else "[red]fails[/]"


def _lines(outcome: LandingOutcome) -> Iterator[str]:
    yield f"Limits violated: {', '.join(outcome.limits_violated) or 'none'}"
    if outcome.records is not None:
        yield f"Ticks in which the supervisor enforced a limit: {_enforced(outcome.records['health']['flags'])}"
    yield f"Fault: {outcome.fault}. Missed captures: {outcome.retries}."
    yield f"Ended in phase {outcome.end or '-'}, the UAV {outcome.state or '-'}."
    simulated = outcome.phases[-1].end_s if outcome.phases else 0.0
    yield f"Seed {outcome.seed}: {simulated:.1f} s simulated at {outcome.real_time_factor:.1f} x real time."


def _enforced(flags: np.ndarray) -> str:
    """Names of the limits with the number of ticks in which each was enforced, of flags (ticks,)."""
    ticks = {name: int(np.count_nonzero(flags & bit)) for bit, name in LIMIT_NAMES.items()}
    return ", ".join(f"{name} {n}" for name, n in ticks.items() if n) or "none"
