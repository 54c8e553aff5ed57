"""Figures of the proof's run: V₂ on the UAV subsystem and on the demonstrator.

| figure | shows |
|---|---|
| `proof_decay` | V₂ over time from random states, in each case of the subsystem |
| `proof_times` | how many states have settled, and arrived, by when |
| `proof_jump` | torque of (29) and V₂ about half a turn, where η_e changes sign; jumps of V₂ from random states |
| `proof_demonstrator` | V₂, its measured rate and (30) on each experiment, and what the broken assumptions feed it |
| `proof_attribution` | power of each broken assumption |
"""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from armland.experiments.proof.attribution import TERMS
from armland.experiments.proof.jumps import sweep
from armland.experiments.proof.paths import LOG, MAX_ROWS, NEAR_M, NEAR_RAD, SETTLED, follow
from armland.experiments.proof.verification import Proof
from armland.rotations import Array
from armland.view.figures.canvas import COLUMN_IN, PAGE_IN, drawn, legend_above, line_of, sheet
from armland.view.figures.curves import thinned

SMOOTH_S = 0.05  # Over this long the powers in the stack are averaged

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


FAN = 50  # Paths that are drawn of each case

WIDE_DEG, CLOSE_DEG = np.linspace(1e-6, 30.0, 61), np.linspace(1e-6, 0.5, 21)
"""To how far from half a turn the torque and V₂ are drawn."""

BLUE, RED, GREEN = "#0072B2", "#D55E00", "#009E73"
CASE_COLORS = {"paper": BLUE, "paper_true": RED, "exact": GREEN}


def draw_proof_figures(out: Path, proof: Proof) -> list[Path]:
    """Write all figures into the folder `out`, as PDF and PNG each, and return the files' paths."""
    shown = [name for name in FIGURES if proof.channels or name not in OF_DEMONSTRATOR]
    return drawn(out, {name: partial(FIGURES[name], proof) for name in shown})


def decay_figure(proof: Proof) -> Figure:
    """V₂ over its start against time, a panel per case, a line per path, coloured by the sign of η_e at the start."""
    figure = sheet(PAGE_IN, 2.5)
    panels = figure.subplots(1, len(proof.cases), sharex=True, sharey=True)
    log = np.empty(MAX_ROWS, LOG)
    for axes, case in zip(panels, proof.cases.values(), strict=True):
        for problem in case.problems[:FAN]:
            rows = log[: follow(problem, case.setting, log)]
            negative = problem["start"][:4] @ problem["q_d"] < 0.0
            label = r"$\eta_e(0) < 0$" if negative else r"$\eta_e(0) > 0$"
            color = RED if negative else BLUE
            axes.semilogy(rows["t"], rows["v2"] / rows["v2"][0], color=color, linewidth=0.35, alpha=0.7, label=label)
        axes.axhline(SETTLED, color="black", linewidth=0.6, linestyle=(0, (4, 3)))
        axes.set_title(f"{fill(case.kind.title, 24)}\n{len(case.paths)} states", fontsize=8.0)
        axes.set_xlabel("time $t$ (s)")
    panels[0].set(
        ylabel=r"$V_2(t) / V_2(0)$",
        xlim=(0.0, max(case.paths["end"].max() for case in proof.cases.values())),
        ylim=(1e-9, 2.0),
    )
    handles, labels = panels[0].get_legend_handles_labels()
    by_label = dict(zip(labels, handles, strict=True))
    panels[-1].legend(by_label.values(), by_label.keys(), loc="upper right")
    return figure


def times_figure(proof: Proof) -> Figure:
    """Share of the states of each case that have settled, and arrived, by a time."""
    figure = sheet(COLUMN_IN, 2.4)
    axes = figure.subplots()
    for name, case in proof.cases.items():
        for key, style in (("settled", (0, (3, 1.5))), ("arrived", "-")):
            times = np.sort(case.paths[key][np.isfinite(case.paths[key])])
            share = np.arange(1, len(times) + 1) / len(case.paths)
            label = case.kind.title if key == "arrived" else None
            axes.plot(
                *thinned(times, 100.0 * share), color=CASE_COLORS[name], linewidth=0.9, linestyle=style, label=label
            )
    legend = f"dashed: $V_2$ at {100 * SETTLED:g} %\nfull: within {np.degrees(NEAR_RAD):g}° and {1e3 * NEAR_M:g} mm"
    axes.text(0.36, 0.7, legend, transform=axes.transAxes, color="0.25")
    axes.set(xlim=(0.0, None), ylim=(0.0, 105.0), xlabel="time $t$ (s)", ylabel="states (%)")
    figure.legend(loc="outside upper center", ncols=1)
    return figure


def jump_figure(proof: Proof) -> Figure:
    """Torque of (29) and V₂ about half a turn, and the jumps of V₂ there from random states."""
    figure = sheet(PAGE_IN, 2.5)
    left, middle, right = figure.subplots(1, 3)
    setting = proof.cases["paper"].setting
    for rate, color in ((-10.0, RED), (0.0, "black"), (10.0, BLUE)):
        label = f"{rate:+g} rad/s".replace("-", "−") if rate else "at rest"
        for side in (-1.0, 1.0):
            wide, close = (sweep(setting, 0, rate, np.pi + side * np.radians(x)) for x in (WIDE_DEG, CLOSE_DEG))
            style = {"color": color, "linewidth": 0.9, "label": label if side > 0.0 else None}
            left.plot(np.degrees(wide.angle), wide.delta_tau, **style)
            middle.plot(np.degrees(close.angle), close.v2, **style)
    left.set_ylabel(r"torque of (29), $\Delta\tau + \tau_{att}$ (N·m)")
    middle.set_ylabel("$V_2$ (N·m)")
    low, high = left.get_ylim()
    left.set_ylim(low, high + 0.6 * (high - low))
    left.legend(title="turning about x", loc="upper left")
    for axes in (left, middle):
        axes.axvline(180.0, color="black", linewidth=0.6, linestyle=(0, (4, 3)))
        axes.set_xlabel("angle about x to the goal (°)")
    middle.xaxis.set_major_locator(MaxNLocator(nbins=4, steps=[1, 5, 10]))
    for name in ("paper", "exact"):
        rise = 100.0 * proof.cases[name].jump_v2
        law = proof.cases[name].kind.title.split(",")[0]
        label = f"{law}: a rise in {100.0 * np.mean(rise > 0.0):.0f} %"
        right.hist(rise, bins=40, density=True, histtype="step", color=CASE_COLORS[name], label=label)
    right.axvline(0.0, ymax=0.76, color="black", linewidth=0.6, linestyle=(0, (4, 3)))
    right.set(
        xlabel=r"jump of $V_2$ at $\eta_e = 0$ (% of $V_2$)",
        ylabel="density (1/%)",
        ylim=(0.0, 1.4 * right.get_ylim()[1]),
    )
    right.legend(loc="upper left")
    return figure


FIGURES: dict[str, Callable[[Proof], Figure]] = {
    "proof_decay": decay_figure,
    "proof_times": times_figure,
    "proof_jump": jump_figure,
    "proof_demonstrator": demonstrator_figure,
    "proof_attribution": attribution_figure,
}
OF_DEMONSTRATOR = ("proof_demonstrator", "proof_attribution")
