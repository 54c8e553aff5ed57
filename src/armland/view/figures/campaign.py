"""One page of a campaign: the spread of each figure of merit."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from armland.experiments.campaign.summary import FIGURES, Row, value
from armland.view.figures.canvas import PAGE_IN, drawn, sheet

DOT: dict[str, Any] = {
    "color": "#0072B2",
    "markersize": 2.6,
    "linestyle": "none",
    "marker": "o",
    "markeredgewidth": 0.0,
}
FAILED: dict[str, Any] = {**DOT, "color": "#D55E00", "markersize": 3.6, "marker": "x", "markeredgewidth": 0.9}
BOUND: dict[str, Any] = {"color": "0.35", "linewidth": 0.9, "linestyle": (0, (4.0, 2.0))}


def draw_campaign(out: Path, rows: Sequence[Row], bounds: Mapping[str, float], mission: str) -> list[Path]:
    """Write `mission`_campaign as PDF and PNG into the folder `out`, and return the files' paths."""
    return drawn(out, {f"{mission}_campaign": lambda: campaign_page(rows, bounds)})


def campaign_page(rows: Sequence[Row], bounds: Mapping[str, float]) -> Figure:
    """One panel per figure: its value in each flight over the share of flights that stay below, with the bound in SI units."""
    shown = [figure for figure in FIGURES if any(value(row, figure) is not None for row in rows)]
    lines = max(-(-len(shown) // 3), 1)
    page = sheet(PAGE_IN, 1.75 * lines)
    panels = page.subplots(lines, 3, squeeze=False).ravel()
    for axes, figure in zip(panels, shown, strict=False):
        _draw(axes, figure, bounds.get(figure), rows)
    for axes in panels[len(shown) :]:
        axes.set_axis_off()
    for axes in panels[::3]:
        axes.set_ylabel("share of flights (%)")
    return page


def _draw(axes: Axes, figure: str, bound: float | None, rows: Sequence[Row]) -> None:
    name, scale = FIGURES[figure]
    known = sorted(
        ((v, bool(row["success"])) for row in rows if (v := value(row, figure)) is not None), key=lambda p: p[0]
    )
    values, good = np.array([v for v, _ in known]), np.array([g for _, g in known])
    share = 100.0 * (np.arange(len(values)) + 0.5) / len(values)
    axes.plot(values[good], share[good], **DOT)
    axes.plot(values[~good], share[~good], **FAILED)
    axes.set_ylim(0.0, 100.0)
    limit = None if bound is None else scale * bound
    axes.set_xlim(0.0, 1.06 * max(float(values.max()), limit or 1e-6))
    if limit is not None:
        axes.axvline(limit, **BOUND)
    axes.set_xlabel(name.replace("[", "(").replace("]", ")"))
