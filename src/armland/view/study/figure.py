"""The figure of a study: rates of success, what each change gives, and what it does to missed captures."""

from itertools import pairwise
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from armland.experiments.study.answer import Findings, Gain
from armland.view.figures.canvas import PAGE_IN, drawn, sheet

BETTER, WORSE, ALIKE = "#0072B2", "#D55E00", "0.45"
"""Told apart and better, told apart and worse, not told apart."""


def draw_study(out: Path, found: Findings, conditions: str) -> list[Path]:
    """Write study_NAME.pdf and .png into the folder `out`; `conditions` are said above."""
    return drawn(out, {f"study_{found.study.name}": lambda: study_page(found, conditions)})


def study_page(found: Findings, conditions: str) -> Figure:
    """A row for each change, by group: success with Wilson's interval, difference of success, difference of missed captures."""
    groups = list(dict.fromkeys(c.group for c in found.study.changes))
    rows = sorted(found.gains, key=lambda g: groups.index(g.group))
    page = sheet(PAGE_IN, 1.1 + 0.19 * (len(rows) + 1))
    page.suptitle(f"{found.study.title}: {conditions}", fontsize=8.0)
    rates, gives, misses = page.subplots(1, 3, sharey=True, width_ratios=[1.0, 1.2, 1.0])
    _rates(rates, found, rows)
    _differences(gives, [(100.0 * g.rate.value, 100.0 * g.rate.low, 100.0 * g.rate.high) for g in rows], rows)
    _differences(misses, [(g.misses.value, g.misses.low, g.misses.high) for g in rows], rows)
    by = "the term gives" if found.study.removes else "the exchange gives"
    rates.set_xlabel("without it, success (%)" if found.study.removes else "success (%)")
    gives.set_xlabel(f"success that {by} (%)")
    misses.set_xlabel(f"missed captures that {by}")
    return page


def _colour(g: Gain) -> str:
    return (BETTER if g.rate.value > 0.0 else WORSE) if g.told else ALIKE


def _rates(axes: Axes, found: Findings, rows: list[Gain]) -> None:
    u = found.usual
    points = [
        (u.successes / u.flights, u.wilson, "black"),
        *((g.successes / g.flights, g.wilson, _colour(g)) for g in rows),
    ]
    for y, (rate, (low, high), colour) in enumerate(points):
        axes.plot([100.0 * low, 100.0 * high], [y, y], color=colour, linewidth=1.1)
        axes.plot(100.0 * rate, y, "o", color=colour, markersize=3.5)
    axes.axvline(100.0 * u.successes / u.flights, color="black", linewidth=0.6, linestyle=(0, (4.0, 2.0)))
    axes.set_yticks(range(len(points)), [found.study.usual, *(g.name for g in rows)])
    axes.set_ylim(len(points) - 0.4, -0.6)
    axes.set_xlim(None, 102.0)
    for y, (before, after) in enumerate(pairwise(rows), start=1):
        if before.group != after.group:
            axes.axhline(y + 0.5, color="0.75", linewidth=0.5)


def _differences(axes: Axes, spans: list[tuple[float, float, float]], rows: list[Gain]) -> None:
    for y, ((value, low, high), g) in enumerate(zip(spans, rows, strict=True), start=1):
        if np.isfinite(value):
            axes.plot([low, high], [y, y], color=_colour(g), linewidth=1.1)
            axes.plot(value, y, "o", color=_colour(g), markersize=3.5)
        if y > 1 and rows[y - 2].group != g.group:
            axes.axhline(y - 0.5, color="0.75", linewidth=0.5)
    axes.axvline(0.0, color="black", linewidth=0.6)
