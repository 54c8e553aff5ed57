"""The spread of the paper's experiments: each point's E1 against its E2, and the ratio of the z errors against E2.

| mark | demonstrator |
|---|---|
| pale dots | a point of its ranges |
| ringed dot | at its own values |
| star | the paper |
"""

from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullLocator

from armland.experiments.spread import E1_DEG, E1_LARGEST, E2_DEG, E2_LARGEST, RATIO, Spread
from armland.view.figures.canvas import PAGE_IN, drawn, sheet

TICKS_DEG = (1.0, 2.0, 5.0, 10.0, 20.0, 40.0)
COLORS = {"fitted": "#D55E00", "bench": "#0072B2"}


def draw_spread(out: Path, found: Spread) -> list[Path]:
    """Write spread as PDF and PNG into the folder `out`, and return the files' paths."""
    return drawn(out, {"spread": lambda: spread_figure(found)})


def spread_figure(found: Spread) -> Figure:
    """The page."""
    figure = sheet(PAGE_IN, 2.8)
    left, right = figure.subplots(1, 2)
    for axes, x, y in ((left, E1_LARGEST, E2_LARGEST), (right, E2_LARGEST, RATIO)):
        for d in found.demonstrators:
            color = COLORS[d.name]
            axes.plot([s[x] for s in d.standing], [s[y] for s in d.standing], ".", color=color, alpha=0.35)
            axes.plot(d.central[x], d.central[y], "o", color=color, markeredgecolor="black", label=d.name)
        axes.set(xlabel=x, ylabel=y, xscale="log")
    left.set_yscale("log")
    for axis in (left.xaxis, left.yaxis, right.xaxis):
        axis.set_major_locator(FixedLocator(TICKS_DEG))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_locator(NullLocator())
    left.plot(E1_DEG, E2_DEG, "*", color="black", markersize=9, label="paper")
    left.axline((1.0, 1.0), (10.0, 10.0), color="0.5", linewidth=0.6)
    right.axhline(1.0, color="0.5", linewidth=0.6)
    left.legend(loc="lower right")
    return figure
