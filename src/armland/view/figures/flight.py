"""One page of a flight over time, from its log: what really happened, with the phases as bands.

| panel | shows |
|---|---|
| height | pivot on the UAV and end effector point |
| distance | horizontal distance between the two, logarithmic; values below `CLOSEST_MM` lie on the lower edge |
| hinge force | magnitude of the force at the hinge; without the arm it is the weight of the plate that hangs there |
| vertical force | upward force of rotors, arm and cradle on the UAV: who carries the weight; impacts leave the panel |
| tilt | angle of the UAV's z axis to the vertical |
| torque ratio | largest joint torque asked for over its limit, before limiting |

Pale: every tick; the lines in front of it are means over `curves.SMOOTH_S`.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from armland.errors import LogError
from armland.experiments.judge.judgement import PhaseTime, phase_times
from armland.experiments.judge.whereabouts import tilt_deg
from armland.view.figures.canvas import DESIRED, PAGE_IN, drawn, legend_above, shade, sheet
from armland.view.figures.curves import Run
from armland.view.flown import Flown, Ticks

CLOSEST_MM = 0.1  # Lower edge of the distance panel

# Blue, vermilion and bluish green of Okabe and Ito, as in the other figures.
UAV = {"color": "#0072B2", "linewidth": 1.1, "zorder": 3.1}
ARM = {"color": "#D55E00", "linewidth": 1.1, "zorder": 3.0}
CRADLE = {"color": "#2DBE93", "linewidth": 1.1, "linestyle": (0, (3.0, 1.5)), "zorder": 3.2}

LABEL_SHARE = 0.019
"""Least distance between labels of phases, over the width of the panels: the height of their letters."""


def draw_flight(out: Path, run: Flown) -> list[Path]:
    """Write <mission>_overview as PDF and PNG into the folder `out`, and return the files' paths.

    Raises:
        LogError: fewer than two ticks.
    """
    return drawn(out, {f"{run.brief.mission}_overview": lambda: overview_figure(run)})


def overview_figure(run: Flown) -> Figure:
    """The page; errors as for `draw_flight`."""
    log, time, rate_hz = run.ticks, run.time, run.brief.rate_hz
    if len(time) < 2:
        raise LogError(f"the run has {len(time)} ticks; a figure over time needs two")
    phases = phase_times(log["mission"]["phase"], run.brief.phases, rate_hz)
    figure = sheet(PAGE_IN, 8.6)
    strip, *panels = figure.subplots(7, 1, sharex=True, height_ratios=[0.62, 1.2, 1.0, 1.0, 1.2, 1.0, 0.8])
    draw_height(panels[0], time, log)
    _draw_distance(panels[1], time, log)
    draw_forces(panels[2], panels[3], time, log, rate_hz)
    black = Run("", time, log, DESIRED)
    draw_tilt(panels[4], black)
    black.plot_noisy(panels[5], log["health"]["torque_ratio"])
    panels[5].set_ylabel("torque ratio (1)")
    panels[5].set_ylim(bottom=0.0)
    for axes in (panels[0], *panels[2:]):
        axes.yaxis.set_major_locator(MaxNLocator(nbins=6, steps=[1, 2, 5, 10]))
    panels[-1].xaxis.set_major_locator(MaxNLocator(nbins=10, integer=True))
    panels[-1].set(xlim=(0.0, len(time) / rate_hz), xlabel="time $t$ (s)")
    _draw_phases(strip, panels, phases)
    figure.align_ylabels()
    legend_above(figure, panels[3])
    return figure


def distance_mm(log: Ticks) -> NDArray:
    """Horizontal distance between the pivot on the UAV and the end effector point at each tick, (ticks,), mm."""
    apart = log["truth"]["r"] - log["truth"]["ee"]
    return 1e3 * np.hypot(apart[:, 0], apart[:, 1])


def upward_forces_n(log: Ticks) -> tuple[NDArray, NDArray, NDArray]:
    """Vertical force of rotors, arm and cradle on the UAV at each tick, (ticks,) each, N; at rest their sum is its weight."""
    truth = log["truth"]
    x, y = truth["quat"][:, 1], truth["quat"][:, 2]
    # The rotors push along the body's z axis, whose vertical part is R₃₃.
    rotors = truth["rotor_thrust"].sum(axis=1) * (1.0 - 2.0 * (x * x + y * y))
    return rotors, truth["hinge_force"][:, 2], truth["cradle_force"][:, 2]


def _weight_n(log: Ticks, rate_hz: int) -> float:
    """What the UAV weighs without its plate, N: in its first second it hovers or stands."""
    return max(float(np.median(np.sum(upward_forces_n({"truth": log["truth"][:rate_hz]}), axis=0))), 1e-3)


def label_places(phases: Sequence[PhaseTime], gap_s: float) -> NDArray:
    """Time at which each phase's label stands, s: its middle, pushed aside where labels would come closer than `gap_s`."""
    end = phases[-1].end_s
    gap = min(gap_s, (end - phases[0].start_s) / len(phases))
    steps = gap * np.arange(len(phases))
    middle = np.array([0.5 * (p.start_s + p.end_s) for p in phases])
    # Each stands at least a gap behind the one before it; what that pushes over the end comes back.
    pushed = np.maximum.accumulate(middle - steps) + steps
    return np.minimum(pushed, end - 0.5 * gap - steps[::-1])


def draw_height(height: Axes, time: NDArray, log: Ticks) -> None:
    """Draw the heights of pivot and end effector over `time` (ticks,), s."""
    Run("UAV", time, log, UAV).plot(height, log["truth"]["r"][:, 2])
    Run("arm", time, log, ARM).plot(height, log["truth"]["ee"][:, 2])
    height.set_ylabel("height (m)")


def draw_tilt(axes: Axes, run: Run) -> None:
    """Draw the UAV's tilt."""
    run.plot_noisy(axes, tilt_deg(run.ticks["truth"]["quat"]))
    axes.set_ylabel("UAV tilt (°)")
    axes.set_ylim(bottom=0.0)


def _draw_distance(distance: Axes, time: NDArray, log: Ticks) -> None:
    Run("", time, log, DESIRED).plot(distance, np.maximum(distance_mm(log), CLOSEST_MM))
    distance.set(yscale="log", ylim=(CLOSEST_MM, None), ylabel="distance (mm)")


def draw_forces(hinge: Axes, vertical: Axes, time: NDArray, log: Ticks, rate_hz: int) -> None:
    """Draw the hinge force, and who carries the weight, over `time` (ticks,), s."""
    force = np.linalg.norm(log["truth"]["hinge_force"], axis=1)
    Run("", time, log, DESIRED).plot_noisy(hinge, force)
    hinge.set_ylabel("hinge force (N)")
    hinge.set_ylim(bottom=0.0)
    names = ("UAV (pivot, rotors)", "arm (end effector, hinge)", "cradle")
    for name, line, y in zip(names, (UAV, ARM, CRADLE), upward_forces_n(log), strict=True):
        Run(name, time, log, line).plot_noisy(vertical, y)
    vertical.set_ylabel("vertical force (N)")
    # Impacts of several weights would flatten what the panel is for; the one above shows their height.
    weight = _weight_n(log, rate_hz)
    vertical.set_ylim(-0.6 * weight, 1.6 * weight)


def _draw_phases(strip: Axes, panels: Sequence[Axes], phases: Sequence[PhaseTime]) -> None:
    """Shade every second phase in all panels, and write the names into the strip above them."""
    for axes in (strip, *panels):
        shade(axes, [(p.start_s, p.end_s) for p in phases[1::2]])
    strip.set_ylim(0.0, 1.0)
    strip.set_axis_off()
    for p, place in zip(phases, label_places(phases, LABEL_SHARE * phases[-1].end_s), strict=True):
        strip.plot([0.5 * (p.start_s + p.end_s), place], [0.0, 0.16], color="0.5", linewidth=0.5)
        name = p.name.replace("_", " ")
        strip.text(place, 0.2, name, rotation="vertical", ha="center", va="bottom", fontsize=7.0)
