"""What a campaign looks like: a table on the terminal, and one page with the spread of each figure."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure as Page
from rich.console import Console
from rich.table import Table
from rich.text import Text

from armland.experiments.campaign_summary import Figure, Spread, Summary, figures
from armland.experiments.landing import LandingOutcome
from armland.view.canvas import PAGE_IN, paper_style, save, sheet

DOT = {"color": "#0072B2", "markersize": 2.6, "linestyle": "none", "marker": "o", "markeredgewidth": 0.0}
FAILED = {**DOT, "color": "#D55E00", "markersize": 3.6, "marker": "x", "markeredgewidth": 0.9}
BOUND = {"color": "0.35", "linewidth": 0.9, "linestyle": (0, (4.0, 2.0))}


def print_campaign(summary: Summary, mission: str, out: Path) -> None:
    """Print how many flights succeed, each figure's spread beside its bound, and why flights failed."""
    console = Console(highlight=False)
    all_good = summary.successes == summary.flights
    low, high = (100.0 * p for p in summary.interval)
    verdict = Text(f"{summary.successes} of {summary.flights}", style="bold green" if all_good else "bold red")
    console.print(verdict.append(f" {mission}s succeed (95 % interval {low:.1f} to {high:.1f} %)", style="default"))
    table = Table()
    for column in ("", "median", "95 %", "worst", "seed", "bound", ""):
        table.add_column(column, justify="right" if column else "left")
    for s in summary.spreads:
        table.add_row(*_cells(s))
    console.print(table)
    console.print(f"Missed captures that were tried again: {summary.retries}.")
    violated = ", ".join(f"{name} in {n}" for name, n in summary.violated.items())
    console.print(f"Limits violated: {violated or 'none'}.")
    for reason, n in summary.reasons.items():
        console.print(f"{n} failed: {reason}", markup=False)
    console.print(f"The data is in {out}/", markup=False)


def _cells(s: Spread) -> tuple[str | Text, ...]:
    numbers = tuple(f"{x:.3g}" for x in (s.median, s.p95, s.worst))
    if s.bound is None:
        return (Text(s.name, no_wrap=True), *numbers, str(s.worst_seed), "-", "")
    verdict = "[green]holds[/]" if s.holds else "[red]fails[/]"
    return (Text(s.name, no_wrap=True), *numbers, str(s.worst_seed), f"≤ {s.bound:.4g}", verdict)


def draw_campaign(out: Path, outcomes: Sequence[LandingOutcome], hinge_bound_n: float, mission: str) -> list[Path]:
    """Write `mission`_campaign as PDF and PNG into the folder `out`, and return the files' paths."""
    with paper_style():
        return save(campaign_page(outcomes, hinge_bound_n), Path(out), f"{mission}_campaign")


def campaign_page(outcomes: Sequence[LandingOutcome], hinge_bound_n: float) -> Page:
    """One panel per figure: its value in each flight over the share of flights that stay below, with the bound."""
    shown = [f for f in figures(hinge_bound_n) if any(f.of(o) is not None for o in outcomes)]
    rows = -(-len(shown) // 3)
    page = sheet(PAGE_IN, 1.75 * rows)
    panels = page.subplots(rows, 3, squeeze=False).ravel()
    for axes, figure in zip(panels, shown, strict=False):
        _draw(axes, figure, outcomes)
    for axes in panels[len(shown) :]:
        axes.set_axis_off()
    for axes in panels[::3]:
        axes.set_ylabel("share of flights (%)")
    return page


def _draw(axes, figure: Figure, outcomes: Sequence[LandingOutcome]) -> None:  # type: ignore[no-untyped-def]
    known = sorted(((v, o.success) for o in outcomes if (v := figure.of(o)) is not None), key=lambda pair: pair[0])
    values, good = np.array([v for v, _ in known]), np.array([g for _, g in known])
    share = 100.0 * (np.arange(len(values)) + 0.5) / len(values)
    axes.plot(values[good], share[good], **DOT)
    axes.plot(values[~good], share[~good], **FAILED)
    axes.set_ylim(0.0, 100.0)
    axes.set_xlim(0.0, 1.06 * max(float(values.max()), figure.bound or 1e-6))
    if figure.bound is not None:
        axes.axvline(figure.bound, **BOUND)
    axes.set_xlabel(figure.name.replace("[", "(").replace("]", ")"))
