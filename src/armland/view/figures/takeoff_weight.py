"""The study of the take-off weight on one page: what the arm's speed lifts, what it would take, and what a throw is worth.

| panel | shows |
|---|---|
| left | gain of level flight near the arm's speeds: theory as lines, flights as points with the bracket that is left |
| middle | the same up to the speeds of gains of 5, 10, 20 %, with and without drag |
| right | gain of a UAV that is thrown upwards or at the best elevation and then gains speed by itself |
"""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from armland.experiments.takeoff_weight.study import TakeoffWeight
from armland.experiments.takeoff_weight.theory import GAINS, HEIGHTS_M, READINGS, Air, heaviest_thrown
from armland.mission.belief import rotors_of
from armland.models.inflow import Rotors, sustained
from armland.scenario import Scenario
from armland.view.figures.canvas import PAGE_IN, drawn, sheet

COLORS = {"constant rotor speed": "#0072B2", "constant power": "#D55E00"}
MARKS = {"rest": "o", "sideways": "s", "forward": "D", "upwards": "^"}


def draw_takeoff_weight(out: Path, found: TakeoffWeight, scenario: Scenario) -> list[Path]:
    """Write takeoff_weight as PDF and PNG into the folder `out`, and return the files' paths."""
    return drawn(out, {"takeoff_weight": lambda: takeoff_weight_figure(found, scenario)})


def takeoff_weight_figure(found: TakeoffWeight, scenario: Scenario) -> Figure:
    """The page."""
    rotors, drag = rotors_of(scenario), scenario.uav.drag_nspm
    figure = sheet(PAGE_IN, 2.9)
    near, far, thrown = figure.subplots(1, 3)
    fastest = max(found.arm_speed_mps["forward"], found.arm_speed_mps["sideways"])
    _draw_level(near, rotors, drag, 1.3 * fastest)
    for x in found.flights:
        near.errorbar(
            x.speed_mps,
            100.0 * (x.flown - 1.0),
            100.0 * x.half_width,
            fmt=MARKS[x.name],
            color="black",
            markersize=3.5,
            capsize=2.0,
            linewidth=0.8,
            label=f"flown, {x.name}" if x.speed_mps != 0.6 else None,
        )
    near.set_title("kept, near the arm's speeds")
    _draw_level(far, rotors, drag, 8.0)
    for gain in GAINS:
        far.axhline(100.0 * gain, color="0.5", linewidth=0.6, linestyle=(0, (4.0, 2.0)))
    far.set(ylim=(-1.0, 24.0), title="kept, at any speed")
    for axes in (near, far):
        axes.axvspan(-1.0, fastest, color="0.945", linewidth=0.0, zorder=0.0)
    _draw_thrown(thrown, rotors, drag, 1.5)
    thrown.axvspan(0.0, min(found.arm_speed_mps.values()), color="0.945", linewidth=0.0, zorder=0.0)
    for axes in (near, far, thrown):
        axes.set(xlabel="speed given (m/s)", xlim=(-0.02 if axes is near else 0.0, None))
        if axes is not far:
            axes.legend(fontsize=6.0, loc="upper left")
    near.set_ylabel("gain of take-off weight (%)")
    return figure


def _draw_level(axes: Axes, rotors: Rotors, drag: float, most: float) -> None:
    speeds = np.linspace(0.0, most, 81)
    for name, power in READINGS.items():
        for c, style in ((drag, "-"), (0.0, (0, (1.0, 1.5)))):
            gain = [100.0 * (sustained(rotors, v, c, power) / rotors.static - 1.0) for v in speeds]
            label = name if c else f"{name}, no drag"
            axes.plot(speeds, gain, color=COLORS[name], linestyle=style, linewidth=1.0, label=label)


def _draw_thrown(axes: Axes, rotors: Rotors, drag: float, most: float) -> None:
    speeds = np.linspace(0.0, most, 6)
    for height, style in zip(HEIGHTS_M, ("-", (0, (3.0, 1.5))), strict=True):
        gain = [100.0 * (heaviest_thrown(Air(rotors, drag), v, height)[0] - 1.0) for v in speeds]
        label = f"may lose {height:g} m"
        axes.plot(speeds, gain, color="#0072B2", linestyle=style, marker=".", linewidth=1.0, label=label)
    axes.set(ylim=(0.0, None), title="thrown, then gaining speed")
