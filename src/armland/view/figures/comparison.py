"""Laws compared: a mark for each law in a row for each condition, by attitude and by position error."""

from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from armland.view.figures.canvas import PAGE_IN, sheet

COLORS = ("#0072B2", "#D55E00", "#2DBE93", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#808080")
SHAPES = ("o", "s", "^", "D", "v", "P", "X", "*", "<", "h", ">", "p")
"""Colour-blind readers tell the laws apart by shape."""

ROW_IN, FRAME_IN = 0.27, 1.0
"""Height of a condition's row and of all around the rows, inches."""


def comparison_figure(rows: Sequence[Mapping[str, Any]]) -> Figure:
    """The page; `rows` as in comparison.json."""
    conditions, laws = list(dict.fromkeys(r["condition"] for r in rows)), list(dict.fromkeys(r["law"] for r in rows))
    figure = sheet(PAGE_IN, FRAME_IN + ROW_IN * max(len(conditions), 4))
    left, right = figure.subplots(1, 2, sharey=True)
    for i, law in enumerate(laws):
        own = [r for r in rows if r["law"] == law]
        y = [conditions.index(r["condition"]) for r in own]
        style = {
            "marker": SHAPES[i % len(SHAPES)],
            "color": COLORS[i % len(COLORS)],
            "linestyle": "none",
            "markersize": 4.5,
        }
        left.plot([r["metrics"]["attitude_max_deg"] for r in own], y, label=law, **style)
        right.plot([1e3 * max(r["metrics"]["position_rms_m"]) for r in own], y, **style)
    left.set(xscale="log", xlabel="largest attitude\ndeviation (°)", ylim=(len(conditions) - 0.5, -0.5))
    left.set_yticks(range(len(conditions)), conditions)
    right.set(xscale="log", xlabel="position error, RMS\nof the worst axis (mm)")
    for axes in (left, right):
        # Over less than a decade the powers of ten alone would be one number or none.
        axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 3.0)))
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_formatter(NullFormatter())
    handles, labels = left.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=min(len(labels), 6), handlelength=1.0)
    return figure
