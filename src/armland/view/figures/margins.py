"""The margins as a tornado: a bar for each deviation up to the factor that still holds, the narrowest on top.

| mark | shows |
|---|---|
| bar, in the colour of its device | factors on the published range at which flights succeed |
| pale end, and what stands behind it | the bracket in which they begin to fail, and what ended the first one |
| arrow | nothing failed up to there |
| bold stroke | the bound of what such a device can be |
| lines | levels: mild, published, harsh |
"""

from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from armland.experiments.margins.corners import ends
from armland.experiments.margins.search import MOST
from armland.experiments.margins.study import Margin, Margins
from armland.scenario.deviation import LEVELS, Deviation, unit_of
from armland.scenario.deviation.spread import Device
from armland.view.figures.canvas import PAGE_IN, drawn, sheet
from armland.view.tables.margins import range_in_words

# Okabe and Ito's, and two greys for the devices beyond them.
_PALETTE = ("#0072B2", "#56B4E9", "#009E73", "#E69F00", "#D55E00", "#CC79A7", "#999999", "#444444", "#F0E442")
_DEVICES = [
    n for n, f in Deviation.model_fields.items() if isinstance(f.annotation, type) and issubclass(f.annotation, Device)
]
COLORS = dict(zip(_DEVICES, _PALETTE, strict=True))
"""Device -> colour of its bars."""

LEAST, END = 1.0 / 32.0, 1.25 * MOST
"""Ends of the axis; below the first the bars are as short as nothing."""

ROW_IN, FRAME_IN = 0.128, 0.75
"""Height of a bar's line and of all around the bars, inches."""

SMALL = 6.5
"""Size of the letters beside the bars, points."""

LETTERS = 52
"""Of a reason behind a bar."""


def draw_margins(out: Path, found: Margins) -> list[Path]:
    """Write margins as PDF and PNG into the folder `out`; returns the files' paths."""
    return drawn(out, {"margins": lambda: margins_figure(found)})


def margins_figure(found: Margins) -> Figure:
    """The page."""
    figure = sheet(PAGE_IN, FRAME_IN + ROW_IN * max(len(found.margins), 6))
    axes = figure.subplots()
    axes.set(xscale="log", xlim=(LEAST, END), ylim=(len(found.margins) - 0.4, -0.6))
    for k, m in enumerate(found.margins):
        _bar(axes, k, m)
    _levels(axes)
    axes.set_xticks([2.0**k for k in range(-5, 4)], ["1/32", "1/16", "1/8", "1/4", "1/2", "1", "2", "4", "8"])
    axes.set_xticks([], minor=True)
    axes.set_xlabel("factor on the published range")
    axes.set_yticks(range(len(found.margins)), [m.row.path for m in found.margins], fontsize=SMALL)
    axes.tick_params(axis="y", length=0.0)
    axes.grid(False, axis="y")
    used = [d for d in COLORS if any(m.row.path.startswith(f"{d}.") for m in found.margins)]
    handles = [Patch(color=COLORS[d], label=d) for d in used]
    figure.legend(handles=handles, loc="outside upper center", ncols=len(used), handlelength=1.0)
    return figure


def _bar(axes: Axes, k: int, m: Margin) -> None:
    color, holds = COLORS[m.row.path.partition(".")[0]], max(m.lands, LEAST)
    axes.barh(k, holds - LEAST, left=LEAST, height=0.72, color=color, zorder=3.0)
    if m.fails is not None:
        axes.barh(k, m.fails - holds, left=holds, height=0.72, color=color, alpha=0.3, zorder=3.0)
    elif m.lands < m.bound:
        axes.plot(
            1.06 * holds, k, marker=">", color=color, markersize=5.0, markeredgewidth=0.0, clip_on=False, zorder=3.1
        )
    if m.bound < END:
        axes.plot([m.bound] * 2, [k - 0.45, k + 0.45], color="black", linewidth=2.0, zorder=3.6)
    t, unit, failure = m.row.told, unit_of(m.row.path), m.bracket.failure
    holds_at = range_in_words(*ends(m.row, m.lands), unit) if m.lands else f"not {range_in_words(t.low, t.high, unit)}"
    place: dict[str, Any] = {
        "va": "center",
        "fontsize": SMALL,
        "annotation_clip": False,
        "xycoords": axes.get_yaxis_transform(),
    }
    axes.annotate(holds_at, (1.02, k), **place)
    if failure is not None:
        axes.annotate(_cut(failure.reason), (1.27, k), color="0.35", **place)


def _levels(axes: Axes) -> None:
    across = axes.get_xaxis_transform()
    for name, factor in LEVELS.items():
        if factor:
            axes.axvline(factor, color="black", linewidth=1.0 if factor == 1.0 else 0.5, zorder=3.5)
            axes.text(factor, 1.004, name, transform=across, ha="center", va="bottom", fontsize=SMALL)
    for at, words in ((1.02, "holds at"), (1.27, "fails first by")):
        axes.text(at, 1.004, words, transform=axes.transAxes, va="bottom", fontsize=SMALL, fontstyle="italic")


def _cut(reason: str) -> str:
    words = reason.removeprefix("limits violated: ")
    return words if len(words) <= LETTERS else words[: LETTERS - 1] + "…"
