"""One page of the capture envelope.

| panel | shows |
|---|---|
| a, b, c | boundary of two quantities at the gate, the others at the mission's thresholds; what these allow; landings as flown |
| d | bound of the offset in all directions, around the magnet's pads |
| e | amplitude of a swinging plate that the arm can match, and what limits it |
| f | thresholds over their bounds |
"""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Rectangle

from armland.experiments.envelope.bounds import Map
from armland.experiments.envelope.study import UNITS, EnvelopeStudy, shown
from armland.models.capture import Grip, covered_offset
from armland.view.figures.canvas import PAGE_IN, drawn, sheet

# Blue, vermilion, bluish green and reddish purple of Okabe and Ito, as in the other figures.
INSIDE: dict[str, Any] = {"color": "#0072B2", "linewidth": 1.3, "zorder": 3.1}
BOX: dict[str, Any] = {"edgecolor": "#D55E00", "facecolor": "none", "linewidth": 1.2, "zorder": 3.3}
CLOSED: dict[str, Any] = {"color": "black", "linewidth": 0.9, "linestyle": (0, (4.0, 2.0)), "zorder": 3.0}
FLOWN: dict[str, Any] = {"color": "#2DBE93", "marker": "o", "markersize": 3.2, "linestyle": "none", "zorder": 3.4}
OTHERS = ("#CC79A7", "#E69F00", "#56B4E9", "#666666", "#2DBE93")

SCALE = {"m": 1e3, "m/s": 1.0, "deg": 1.0}
LABELS = {
    "offset": "offset (mm)",
    "speed": "lateral speed (m/s)",
    "tilt": "tilt of the UAV (°)",
    "closing": "closing speed (m/s)",
}


def draw_envelope(out: Path, found: EnvelopeStudy) -> list[Path]:
    """Write the page as PDF and PNG into the folder `out`; returns the files' paths."""
    return drawn(out, {"envelope": lambda: envelope_figure(found)})


def envelope_figure(found: EnvelopeStudy) -> Figure:
    """The page."""
    figure = sheet(PAGE_IN, 5.2)
    top, bottom = figure.subplots(2, 3)
    for axes, m, letter in zip(top, found.maps, "abc", strict=True):
        _draw_map(axes, m, found)
        axes.set_title(letter, loc="left", fontweight="bold")
    for axes, draw, letter in zip(bottom, (_draw_directions, _draw_interception, _draw_use), "def", strict=True):
        draw(axes, found)
        axes.set_title(letter, loc="left", fontweight="bold")
    handles, labels = top[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(handles))
    return figure


def in_units(name: str, value: float) -> float:
    """A value of `Start` as the page shows it: millimetres, metres per second, degrees."""
    return SCALE[UNITS[name]] * shown(name, value)


def _draw_map(axes: Axes, m: Map, found: EnvelopeStudy) -> None:
    x = [in_units(m.x, v) for v in m.at]
    y = [in_units(m.y, e.bound) for e in m.boundary]
    axes.fill_between(x, y, color=INSIDE["color"], alpha=0.12, linewidth=0.0, zorder=1.0)
    axes.plot(x, y, label="boundary", **INSIDE)
    axes.plot(x, [in_units(m.y, v) for v in m.closed], label="closed form", **CLOSED)
    width, height = in_units(m.x, m.box[0]), in_units(m.y, m.box[1])
    if m.x == "closing":
        # The mission bounds the magnitude of the relative speed: a half circle about the closing speed of the flight.
        axes.add_patch(Arc((found.closing, 0.0), 2.0 * height, 2.0 * height, theta2=180.0, **BOX))
    else:
        axes.add_patch(Rectangle((0.0, 0.0), width, height, label="allowed by the mission", **BOX))
    flown = [(SCALE[UNITS[m.x]] * getattr(f, m.x), SCALE[UNITS[m.y]] * getattr(f, m.y)) for f in found.flown]
    axes.plot([p[0] for p in flown], [p[1] for p in flown], label="flown", **FLOWN)
    axes.set(xlim=(0.0, max(x)), ylim=(0.0, 1.08 * max(y)), xlabel=LABELS[m.x], ylabel=LABELS[m.y])


def _draw_directions(axes: Axes, found: EnvelopeStudy) -> None:
    axis, grip = found.axis("offset"), Grip()
    angle = np.array([e.towards for e in axis.alone])
    bound = 1e3 * np.array([e.bound for e in axis.alone])
    axes.fill(bound * np.cos(angle), bound * np.sin(angle), color=INSIDE["color"], alpha=0.12, linewidth=0.0)
    around = np.append(np.arange(len(angle)), 0)
    axes.plot((bound * np.cos(angle))[around], (bound * np.sin(angle))[around], **INSIDE, marker=".")
    fine = np.linspace(0.0, 2.0 * np.pi, 181)
    form = 1e3 * np.array([covered_offset(grip, float(a)) for a in fine])
    axes.plot(form * np.cos(fine), form * np.sin(fine), **CLOSED)
    r = 1e3 * found.allowed.offset
    axes.plot(r * np.cos(fine), r * np.sin(fine), color=BOX["edgecolor"], linewidth=BOX["linewidth"])
    lost = 1e3 * found.allowed.lost
    axes.plot(lost * np.cos(fine), lost * np.sin(fine), color=BOX["edgecolor"], linewidth=0.9, linestyle=":")
    axes.text(0.0, 0.78 * lost, "closing given up", ha="center", va="center", fontsize=7.0)
    axes.set(aspect="equal", xlabel="offset along $x$ (mm)", ylabel="offset along $y$ (mm)")


def _draw_interception(axes: Axes, found: EnvelopeStudy) -> None:
    if not found.tracked:
        return
    f = [t.frequency for t in found.tracked]
    axes.fill_between(
        f, [1e3 * t.amplitude for t in found.tracked], 1e-2, color=INSIDE["color"], alpha=0.12, linewidth=0.0
    )
    axes.plot(f, [1e3 * t.limits["offset"] for t in found.tracked], label="offset", **INSIDE)
    names = [n for n in found.tracked[0].limits if n != "offset"]
    for name, color in zip(names, OTHERS, strict=True):
        axes.plot(f, [1e3 * t.limits[name] for t in found.tracked], color=color, linewidth=0.9, label=name)
    axes.set(xscale="log", yscale="log", ylim=(0.5, 1e7))
    axes.set_xticks([0.3, 0.5, 1.0, 2.0], ["0.3", "0.5", "1", "2"])
    axes.set_xticks([], minor=True)
    axes.legend(loc="upper right", fontsize=6.0, ncols=2, handlelength=1.0, columnspacing=0.8, borderaxespad=0.2)
    axes.set(xlabel="frequency of the plate (Hz)", ylabel="amplitude (mm)")


def _draw_use(axes: Axes, found: EnvelopeStudy) -> None:
    rows = [m for m in found.margins if "lowest" not in m.threshold][::-1]
    use = [m.value / m.bound if m.bound > 0.0 else np.inf for m in rows]
    words = [m.threshold.removeprefix("bounds.").rsplit("_", 1)[0].removesuffix(", highest") for m in rows]
    names = [w.replace("_", "\n").replace(" ", "\n") for w in words]
    colors = [INSIDE["color"] if m.holds else BOX["edgecolor"] for m in rows]
    axes.barh(range(len(rows)), np.minimum(use, 2.5), color=colors, height=0.55, zorder=3.0)
    axes.axvline(1.0, color="black", linewidth=0.9, zorder=3.2)
    axes.set_yticks(range(len(rows)), names)
    axes.grid(False, axis="y")
    axes.set_xlabel("threshold over bound (1)")
