"""Figures of the marker study: errors by distance beside the model's and the published ones; pictures with what was found."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from armland.errors import PictureError
from armland.plant.noise import stream
from armland.rotations import angle, conjugate, from_rotation_vector, matrix, multiply
from armland.scenario.sensing import Camera
from armland.view.figures.canvas import PAGE_IN, drawn, legend_above, shade, sheet
from armland.vision.fiducial import Detection, detect, project
from armland.vision.flight import Flight, Shot
from armland.vision.frames import frames
from armland.vision.imaging import Imaging, Motion, photographed
from armland.vision.scene import EYE, MarkerScene, build_marker_scene
from armland.vision.study import FACING, Errors, Row

_BLUE, _RED, _GREEN, _GREY = "#0072B2", "#D55E00", "#009E73", "#666666"

_DEMO = Motion(
    np.array([-0.05, 0.03, 0.45]),
    multiply(from_rotation_vector(np.array([0.12, -0.1, 0.15])), FACING),
    np.array([0.06, -0.04, -0.1]),
    np.zeros(3),
)
"""The marker in the picture of `draw_marker_demo`."""

UNITS = (1e3, 1e3, 180.0 / np.pi, 180.0 / np.pi)  # mm and degrees
SHEET = (4, 3)  # Rows and columns of a contact sheet


def draw_marker_figure(out: Path, rows: Sequence[Row], camera: Camera) -> list[Path]:
    """Write `fig_marker_error` into the folder `out`, as PDF and PNG, and return the files' paths.

    Grey: distances at which the model no longer finds the marker.
    """
    return drawn(out, {"fig_marker_error": lambda: _error_figure(rows, camera)})


def draw_marker_demo(out: Path, scene: MarkerScene | None = None) -> tuple[list[Path], Detection]:
    """Write `fig_marker_demo` into the folder `out`, as PDF and PNG: an honest picture and the marker found in it.

    Returns:
        The files' paths and the detection.

    Raises:
        PictureError: no OpenGL that works, or the marker was not found.
        ArmlandError: no OpenCV.
    """
    scene = scene or build_marker_scene()
    picture = frames(scene.model, scene.qpos(_DEMO.position, _DEMO.quat), scene.width, scene.height, EYE)[0]
    image = photographed(picture, scene.intrinsics, _DEMO, Imaging(), stream(0, "marker demo"))
    seen = detect(image, scene.size_m, scene.intrinsics)
    if not seen:
        raise PictureError("the detector found no marker in the demonstration's picture, where there is one")
    return drawn(out, {"fig_marker_demo": lambda: _demo_figure(image, scene, seen[0])}), seen[0]


def draw_contact_sheet(out: Path, shots: Sequence[Shot], scene: MarkerScene, titles: Sequence[str]) -> list[Path]:
    """Write `fig_marker_sheet` into the folder `out`: pictures of a landing in order, with what was found drawn on.

    Args:
        out: folder.
        shots: all pictures of the landing; evenly spread ones are shown.
        scene: whose camera took them.
        titles: of all of the shots.
    """
    return drawn(out, {"fig_marker_sheet": lambda: _contact_sheet(shots, scene, titles)})


def _contact_sheet(shots: Sequence[Shot], scene: MarkerScene, titles: Sequence[str]) -> Figure:
    count, figure = min(SHEET[0] * SHEET[1], len(shots)), sheet(PAGE_IN, 7.6)
    panels = figure.subplots(*SHEET).ravel()
    for axes in panels:
        axes.set_axis_off()
    for axes, i in zip(panels, np.linspace(0, len(shots) - 1, count).round().astype(int), strict=False):
        shot = shots[i]
        height, width = shot.image.shape
        # Half the resolution is enough at this size.
        extent = (-0.5, width - 0.5, height - 0.5, -0.5)
        axes.imshow(shot.image[::2, ::2], cmap="gray", vmin=0, vmax=255, extent=extent)
        if shot.found is not None:
            _ring(axes, shot.found)
            _axes_of_marker(axes, scene, shot.found, names=False)
        off = 1e3 * np.linalg.norm(shot.error[0])
        verdict = f"{shot.motion.position[2]:.2f} m, error {off:.2f} mm" if shot.found else "not found"
        axes.set_title(f"{titles[i]}: {verdict}", fontsize=7.0)
    return figure


def draw_flight(out: Path, flight: Flight) -> list[Path]:
    """Write the contact sheet of a flight's pictures, `fig_marker_sheet`, into the folder `out`."""
    starts = np.array([taken for _, _, taken in flight.phases])
    names = [name for name, _, _ in flight.phases]
    # The first picture is taken before the mission knows its phase.
    titles = [names[max(int(np.searchsorted(starts, i, side="right")) - 1, 0)] for i in range(len(flight.shots))]
    return draw_contact_sheet(out, flight.shots, flight.scene, titles)


def _error_figure(rows: Sequence[Row], camera: Camera) -> Figure:
    figure = sheet(PAGE_IN, 2.7)
    z = np.array([r.distance_m for r in rows])
    panels = figure.subplots(1, 4, sharex=True)
    titles = "lateral (mm)", "depth (mm)", "tilt (°)", "yaw (°)"
    lines = (
        ("detector, ideal pictures", "ideal", {"color": _GREEN, "marker": "v", "linewidth": 0.9}),
        ("detector, honest pictures", "honest", {"color": _BLUE, "marker": "o", "linewidth": 1.1}),
        ("measurement model", "model", {"color": _RED, "marker": "s", "linewidth": 1.1, "linestyle": "--"}),
    )
    for k, (axes, title) in enumerate(zip(panels, titles, strict=True)):
        for label, name, look in lines:
            errors: list[Errors] = [getattr(r, name) for r in rows]
            axes.plot(z, UNITS[k] * np.array([e[1 + k] for e in errors]), label=label, markersize=3.0, **look)
        if k < 2:
            points = np.array([camera.lateral_m, camera.depth_m][k])
            axes.plot(camera.reference_m, 1e3 * points, "*", color=_GREY, markersize=7.0, label="_", zorder=4)
        _finish(axes, title, camera)
    panels[0].plot([], [], "*", color=_GREY, markersize=7.0, label="published, rc_visard")
    legend_above(figure, panels[0])
    return figure


def _finish(axes: Axes, title: str, camera: Camera) -> None:
    axes.set(xscale="log", yscale="log")
    ticks = [0.15, 0.3, 0.6, 1.2, 2.4]
    axes.set_xticks(ticks, [f"{t:g}" for t in ticks])
    axes.set_xticks([], minor=True)
    right = axes.get_xlim()[1]
    shade(axes, [(camera.depth_max_per_size * camera.marker_size_m, right)])
    axes.set(xlim=(None, right), xlabel="distance (m)")
    axes.set_title(title, fontsize=8.0)


def _demo_figure(image: NDArray[np.uint8], scene: MarkerScene, found: Detection) -> Figure:
    figure = sheet(PAGE_IN, 3.1)
    whole, close = figure.subplots(1, 2, width_ratios=[scene.width / scene.height, 1.0])
    for axes in (whole, close):
        axes.imshow(image, interpolation="nearest", cmap="gray", vmin=0, vmax=255)
        axes.set_axis_off()
        _ring(axes, found)
        _axes_of_marker(axes, scene, found)
    low, high = found.corners.min(axis=0), found.corners.max(axis=0)
    middle, half = 0.5 * (low + high), 0.75 * float((high - low).max())
    close.set(xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] + half, middle[1] - half))
    close.plot(*found.corners.T, "+", color=_RED, markersize=7.0)
    whole.set_title("camera at the end effector", fontsize=8.0)
    close.set_title(_verdict(found), fontsize=8.0)
    return figure


def _ring(axes: Axes, found: Detection) -> None:
    ring = np.vstack([found.corners, found.corners[:1]])
    axes.plot(ring[:, 0], ring[:, 1], "-", color=_RED, linewidth=1.0)


def _axes_of_marker(axes: Axes, scene: MarkerScene, found: Detection, names: bool = True) -> None:
    # Half as long as the marker's edge: x, y and z, out of the face.
    tips = found.position + 0.5 * scene.size_m * matrix(found.quat).T
    x, y = project(found.position, scene.intrinsics)
    for tip, colour, name in zip(project(tips, scene.intrinsics), (_RED, _GREEN, _BLUE), "xyz", strict=True):
        arrow = {"arrowstyle": "-|>", "color": colour, "shrinkA": 0, "shrinkB": 0}
        axes.annotate("", (tip[0], tip[1]), (x, y), arrowprops=arrow)
        if names:
            u, v = 1.18 * tip - 0.18 * np.array([x, y])
            axes.text(u, v, f"${name}$", color=colour, ha="center", va="center", fontsize=8.0, clip_on=True)


def _verdict(found: Detection) -> str:
    off = 1e3 * np.linalg.norm(found.position - _DEMO.position)
    turn = np.degrees(angle(multiply(conjugate(_DEMO.quat), found.quat)))
    return f"marker {found.marker} at {found.position[2]:.3f} m; error {off:.2f} mm, {turn:.2f}°"
