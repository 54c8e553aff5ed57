"""Figures of V₂ on the demonstrator: over time, and which broken assumption feeds it."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from armland.experiments.proof.attribution import TERMS
from armland.experiments.proof.verification import Proof
from armland.rotations import Array
from armland.view.figures.canvas import PAGE_IN, legend_above, line_of, sheet
from armland.view.figures.curves import thinned

SMOOTH_S = 0.05
"""Over this long the powers in the stack are averaged."""

GROUPS = {
    "arm between law and hinge": (("arm",), "#0072B2"),
    "reference moves": (("reference",), "#E69F00"),
    "Table II leaves out": (("support", "unsent"), "#CC79A7"),
    "Δτ limited, in part, late": (("limit", "effectiveness", "delay"), "#D55E00"),
    "lever arm": (("lever",), "#009E73"),
    "estimates": (("estimation",), "#56B4E9"),
    "rotors, disturbance": (("rotors", "disturbance"), "#999999"),
}
"""Terms that are drawn as one, and their colour."""


def demonstrator_figure(proof: Proof) -> Figure:
    """V₂, its rates and the stack of what feeds it, a column per experiment, since the desired path's start."""
    figure = sheet(PAGE_IN, 5.2)
    grid = figure.subplots(3, len(proof.channels), sharex=True, sharey="row", squeeze=False)
    for column, (name, channels) in enumerate(proof.channels.items()):
        c = channels[channels["t"] >= proof.start_s]
        t, line = c["t"] - proof.start_s, line_of(name, column)
        upper, middle, lower = grid[:, column]
        upper.semilogy(*thinned(t, c["v2"]), color=line["color"], linewidth=0.8)
        upper.set_title(
            f"{name}: $V_2$ rises {100.0 * proof.ledgers[name]['rising_share']:.0f} % of the time", fontsize=8.0
        )
        middle.plot(*thinned(t, c["law"]), color="0.55", linewidth=0.7, label="(30)")
        middle.plot(*thinned(t, c["measured"]), color=line["color"], linewidth=0.8, label="measured")
        middle.legend(loc="lower right")
        _stack(lower, t, c)
        lower.set_xlabel("time $t$ (s)")
        lower.xaxis.set_major_locator(MaxNLocator(nbins=6, integer=True))
    for axes, label in zip(grid[:, 0], ("$V_2$ (N·m)", r"rate of $V_2$ (W)", "power into $V_2$ (W)"), strict=True):
        axes.set_ylabel(label)
    grid[0, 0].set_xlim(0.0, t[-1])
    handles, labels = grid[-1, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4)
    return figure


def _stack(axes: Axes, t: Array, c: NDArray[np.void]) -> None:
    """What feeds V₂ above zero and what takes from it below, the groups on one another, averaged over `SMOOTH_S`."""
    ticks = max(round(SMOOTH_S / (t[1] - t[0])), 1)
    count = len(t) // ticks

    def mean(x: Array) -> Array:
        return x[: count * ticks].reshape(count, ticks).mean(axis=1)

    time, up, down = mean(t), np.zeros(count), np.zeros(count)
    for label, (names, color) in GROUPS.items():
        power = mean(sum((c[n] for n in names), np.zeros(len(c))))
        for base, part in ((up, np.maximum(power, 0.0)), (down, np.minimum(power, 0.0))):
            axes.fill_between(time, base, base + part, color=color, linewidth=0.0, label=label if base is up else None)
            base += part
    axes.plot(time, mean(-c["law"]), color="black", linewidth=0.7, label="−(30): what the law takes out")


def attribution_figure(proof: Proof) -> Figure:
    """RMS power of each broken assumption, and its mean while V₂ rises, a bar per experiment."""
    figure = sheet(PAGE_IN, 3.4)
    left, right = figure.subplots(1, 2, sharey=True)
    names = [n for n in (*TERMS, "remainder") if any(book["power_rms_w"][n] > 0.0 for book in proof.ledgers.values())]
    place = np.arange(len(names))
    height = 0.8 / len(proof.ledgers)
    for i, (experiment, book) in enumerate(proof.ledgers.items()):
        at, color = place + (i - 0.5 * (len(proof.ledgers) - 1)) * height, line_of(experiment, i)["color"]
        for axes, key in ((left, "power_rms_w"), (right, "power_rising_w")):
            axes.barh(at, [1e3 * book[key][n] for n in names], height, color=color, label=experiment)
    left.set_yticks(place, [TERMS.get(n, "left unexplained") for n in names])
    left.invert_yaxis()
    for axes in (left, right):
        axes.tick_params(axis="y", length=0.0)
    left.set_xlabel("RMS power into $V_2$ (mW)")
    right.set_xlabel("mean power while $V_2$ rises (mW)")
    legend_above(figure, left)
    return figure
