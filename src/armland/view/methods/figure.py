"""One figure of methods side by side: rates with their intervals, and how hard each comes down."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from armland.experiments.methods.comparison import FIGURES, Flights, rate
from armland.view.figures.canvas import PAGE_IN, drawn, sheet

NAMES = {
    "touchdown.speed_mps": "touchdown speed (m/s)",
    "touchdown.tilt_deg": "touchdown tilt (°)",
    "touchdown.offset_m": "off the middle (m)",
}

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#666666")


def draw_methods(out: Path, methods: Sequence[Flights], conditions: str) -> list[Path]:
    """Write methods.pdf and methods.png into the folder `out`; `conditions` are said above."""
    return drawn(out, {"methods": lambda: methods_page(methods, conditions)})


def methods_page(methods: Sequence[Flights], conditions: str) -> Figure:
    """Rates on the left; on the right the share of flights that stay below a touchdown's speed, tilt and distance."""
    page = sheet(PAGE_IN, 2.3 + 0.22 * len(methods))
    page.suptitle(conditions, fontsize=8.0)
    panels = page.subplots(1, 1 + len(FIGURES), width_ratios=[1.5, *[1.0] * len(FIGURES)])
    _rates(panels[0], methods)
    for axes, key in zip(panels[1:], FIGURES, strict=True):
        _spread(axes, key, methods)
    panels[1].set_ylabel("share of flights (%)")
    return page


def _rates(axes: Axes, methods: Sequence[Flights]) -> None:
    for i, m in enumerate(methods):
        for flags, shift, marker, words in (
            (m.success, -0.12, "o", "all criteria kept"),
            (m.stands, 0.12, "s", "stands"),
        ):
            r, y = rate(flags), i + shift
            middle = 100.0 * r.number / r.of
            colour = COLOURS[i % len(COLOURS)]
            face = colour if marker == "o" else "white"
            axes.plot([100.0 * r.low, 100.0 * r.high], [y, y], color=colour, linewidth=1.2)
            axes.plot(
                middle, y, marker, color=colour, markersize=4.5, markerfacecolor=face, label=words if not i else None
            )
    axes.set_yticks(range(len(methods)), [m.name for m in methods])
    axes.set_ylim(len(methods) - 0.5, -0.5)
    axes.set_xlim(-3.0, 103.0)
    axes.set_xlabel("flights (%), 95 % intervals")
    if axes.get_legend_handles_labels()[0]:
        legend = axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
        for handle in legend.legend_handles:
            handle.set_color("0.25")  # type: ignore[union-attr]


def _spread(axes: Axes, key: str, methods: Sequence[Flights]) -> None:
    most, bounds = 1e-6, {m.bounds[key] for m in methods if key in m.bounds}
    for i, m in enumerate(methods):
        values = np.sort(m.figures[key][np.isfinite(m.figures[key])])
        if not len(values):
            continue
        # Of all flights, so that one that never touched down is no good one.
        share = 100.0 * np.arange(1, len(values) + 1) / len(m.seed)
        axes.step(values, share, where="post", color=COLOURS[i % len(COLOURS)], linewidth=1.1)
        most = max(most, float(np.quantile(values, 0.99)))
    for bound in bounds:
        axes.axvline(bound, color="0.35", linewidth=0.8, linestyle=(0, (4.0, 2.0)))
    axes.set_xlim(0.0, 1.06 * max([most, *(b for b in bounds if b < 3.0 * most)]))
    axes.set_ylim(0.0, 102.0)
    axes.set_xlabel(NAMES[key])
