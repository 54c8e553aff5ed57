"""Figures of the paper's experiments, from the logs of the runs. Time counts from the start of the desired path.

| figure | shows |
|---|---|
| `fig5_trajectory` | desired pivot path r_d; grey where it moves |
| `fig6a_attitude` | angle between the UAV's attitude and q_d, and the maxima that the paper reports |
| `fig6b_tilt` | roll, pitch and yaw of the UAV |
| `fig7a_x`, `fig7b_y`, `fig7c_z` | desired and actual pivot position, and their difference |
| `fig_forces` | force at the hinge, torque asked of the UAV, joint torques |
"""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from armland.errors import LogError
from armland.experiments.paper import PUBLISHED
from armland.plant.scene.composition import build_scene
from armland.plant.simulator import level_hinge
from armland.rotations import matrix
from armland.runtime.log import Log
from armland.scenario import Scenario
from armland.view.figures.canvas import COLUMN_IN, DESIRED, PAGE_IN, drawn, legend_above, shade, sheet
from armland.view.figures.curves import Run, clocked, deviation_deg, error_mm, moves, rests, roll_pitch_yaw_deg
from armland.view.flown import Flown
from armland.vision.picture import render

PUBLISHED_DEG = {name: PUBLISHED[name]["attitude_max_deg"] for name in ("E1", "E2")}
"""Largest attitude deviations that the paper reports, deg."""

_WORLD = "xyz"


def draw_paper_figures(out: Path, runs: Sequence[Flown]) -> list[Path]:
    """Write all figures into the folder `out`, as PDF and PNG each, and return the files' paths.

    What comes before the desired path starts is drawn at negative times and left out of all numbers in the figures.

    Raises:
        LogError: no runs, or one that ends before the desired path starts.
    """
    on_clock = clocked(runs)
    return drawn(out, {name: partial(figure_of, on_clock) for name, figure_of in FIGURES.items()})


def trajectory_figure(runs: Sequence[Run]) -> Figure:
    """Desired pivot path over time, one panel per axis, all at the same scale."""
    run = _longest(runs)
    figure = sheet(COLUMN_IN, 2.8)
    panels = figure.subplots(3, 1, sharex=True)
    r_d = run.ticks["reference"]["r"]
    middle = 0.5 * (r_d.min(axis=0) + r_d.max(axis=0))
    half = 0.62 * max(np.ptp(r_d, axis=0).max(), 1e-3)
    for i, axes in enumerate(panels):
        run.plot(axes, r_d[:, i], **{"label": "desired", **DESIRED})
        axes.set(ylim=(middle[i] - half, middle[i] + half), ylabel=f"$r_{{d,{_WORLD[i]}}}$ (m)")
    _finish(figure, panels, runs)
    for begin, end in rests(run):
        # In a shorter rest the word would cover the moves beside it.
        if end - begin > 0.07 * np.ptp(run.time):
            place = {"xy": (0.5 * (begin + end), 0.0), "xycoords": ("data", "axes fraction"), "xytext": (0, 7)}
            panels[0].annotate("rest", **place, textcoords="offset points", ha="center", color="0.35")
    return figure


def attitude_figure(runs: Sequence[Run]) -> Figure:
    """Angle between the UAV's attitude and the desired one over time, with the published maxima."""
    figure = sheet(COLUMN_IN, 2.3)
    axes = figure.subplots()
    top = 0.0
    for run in runs:
        angle = deviation_deg(run.ticks)
        largest = run.judged(angle).max()
        run.plot(axes, angle, label=f"{run.name}, max. {largest:.1f}°")
        published = PUBLISHED_DEG.get(run.name, 0.0)
        top = max(top, angle.max(), published)
        if published:
            color = run.line["color"]
            axes.axhline(published, color=color, linewidth=0.7, linestyle=(0, (6, 3)), zorder=2.0)
            text = f"{run.name} in the paper: {published}°"
            axes.annotate(
                text, (1.0, published), (-3, 2.5), ("axes fraction", "data"), "offset points", ha="right", color=color
            )
    axes.set(ylim=(0.0, max(1.14 * top, 1e-3)), ylabel="attitude deviation (°)")
    _finish(figure, [axes], runs)
    legend_above(figure, axes)
    return figure


def tilt_figure(runs: Sequence[Run]) -> Figure:
    """Roll, pitch and yaw of the UAV over time, one panel each, all at the same scale."""
    figure = sheet(PAGE_IN, 3.6)
    panels = figure.subplots(3, 1, sharex=True, sharey=True)
    for run in runs:
        for axes, angle in zip(panels, roll_pitch_yaw_deg(run.ticks).T, strict=True):
            run.plot(axes, angle)
    for axes, name in zip(panels, ("roll", "pitch", "yaw"), strict=True):
        axes.set_ylabel(f"{name} (°)")
    _finish(figure, panels, runs)
    legend_above(figure, panels[0])
    return figure


def position_figure(runs: Sequence[Run], axis: int) -> Figure:
    """Desired and actual pivot position along one world axis over time, and below it their difference."""
    figure = sheet(PAGE_IN, 3.2)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[1.25, 1.0])
    longest, name = _longest(runs), _WORLD[axis]
    longest.plot(upper, longest.ticks["reference"]["r"][:, axis], **{"label": "desired", **DESIRED})
    for run in runs:
        error = error_mm(run.ticks)[:, axis]
        judged = run.judged(error)
        rms, largest = np.sqrt(np.mean(judged**2)), np.abs(judged).max()
        run.plot(upper, run.ticks["truth"]["r"][:, axis], label=f"{run.name} (rms {rms:.1f} mm, max. {largest:.1f} mm)")
        run.plot(lower, error)
    upper.set_ylabel(f"$r_{name}$ (m)")
    lower.set_ylabel(f"$r_{name} - r_{{d,{name}}}$ (mm)")
    _finish(figure, [upper, lower], runs)
    legend_above(figure, upper)
    return figure


def forces_figure(runs: Sequence[Run]) -> Figure:
    """Hinge force, torque asked of the UAV beyond its attitude controller, largest joint torque over its limit.

    Pale: every tick; the lines are means over `curves.SMOOTH_S`.
    """
    figure = sheet(PAGE_IN, 4.8)
    grid = figure.add_gridspec(4, 2)
    bottom = figure.add_subplot(grid[3, :])
    left, right = ([figure.add_subplot(grid[i, side], sharex=bottom) for i in range(3)] for side in (0, 1))
    for run in runs:
        for i in range(3):
            run.plot_noisy(left[i], run.ticks["truth"]["hinge_force"][:, i])
            run.plot_noisy(right[i], run.ticks["command"]["delta_tau"][:, i])
        run.plot_noisy(bottom, run.ticks["health"]["torque_ratio"])
    for i, name in enumerate(_WORLD):
        left[i].set_ylabel(f"hinge force $F_{name}$ (N)")
        right[i].set_ylabel(rf"asked $\Delta\tau_{name}$ (N·m)")
    for axes in (*left[:2], *right[:2]):
        axes.tick_params(labelbottom=False)
    bottom.set_ylabel("torque ratio (1)")
    _finish(figure, [*left, *right, bottom], runs)
    legend_above(figure, left[0])
    return figure


def _longest(runs: Sequence[Run]) -> Run:
    return max(runs, key=lambda run: len(run.time))


def _finish(figure: Figure, panels: Sequence[Axes], runs: Sequence[Run]) -> None:
    """Shade the moves and put the common time axis below the last of the panels."""
    longest = _longest(runs)
    for axes in panels:
        shade(axes, moves(longest))
        axes.yaxis.set_major_locator(MaxNLocator(nbins=6, steps=[1, 2, 5, 10]))
        axes.xaxis.set_major_locator(MaxNLocator(nbins=8, integer=True))
    panels[-1].set(xlim=(longest.time[0], longest.time[-1]), xlabel="time $t$ (s)")
    figure.align_ylabels()


FIGURES: dict[str, Callable[[Sequence[Run]], Figure]] = {
    "fig5_trajectory": trajectory_figure,
    "fig6a_attitude": attitude_figure,
    "fig6b_tilt": tilt_figure,
    "fig7a_x": partial(position_figure, axis=0),
    "fig7b_y": partial(position_figure, axis=1),
    "fig7c_z": partial(position_figure, axis=2),
    "fig_forces": forces_figure,
}
"""The figures by the names of their files."""


def draw_scene(out: Path, log: Log) -> Path:
    """Draw arm and hinged UAV as the log's first tick has them, with the scenario that stands in the log.

    Raises:
        LogError: a log without scenario or ticks, or of a UAV that is not hinged.
        PictureError: no OpenGL that works.
        ModelError: a file of the scenario is no longer there.
    """
    if "scenario" not in log.metadata or not len(log.messages["truth"]) or log.metadata.get("start") != "hinged":
        raise LogError("a picture of the scene needs the log of an experiment with its scenario, such as E1")
    truth = log.messages["truth"][0]
    scene = build_scene(Scenario.model_validate_json(log.metadata["scenario"]), "hinged")
    qpos = np.zeros(scene.model.nq)
    qpos[scene.joint_qpos], qpos[scene.hinge_qpos] = truth["q"], level_hinge(matrix(truth["ee_quat"]))
    return render(scene.model, qpos, out / "scene.png")
