"""Figures of the marker study: errors by distance beside the model's claims, and one picture with what was found in it."""

import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.image import imread
from numpy.typing import NDArray

from armland.errors import PictureError
from armland.estimation.fiducial import Detection, detect, project
from armland.plant.camera import Camera
from armland.plant.noise import stream
from armland.rotations import angle, conjugate, from_rotation_vector, matrix, multiply
from armland.view.canvas import PAGE_IN, legend_above, paper_style, save, shade, sheet
from armland.view.marker_scene import EYE, MarkerScene, build_marker_scene
from armland.view.marker_study import FACING, MARKER_SIZE_M, Imaging, Row, Study, model_sigma, photographed
from armland.view.picture import render

_BLUE, _RED, _GREEN = "#0072B2", "#D55E00", "#009E73"

_DEMO_POSE = np.array([-0.05, 0.03, 0.55]), multiply(from_rotation_vector(np.array([0.25, -0.2, 0.5])), FACING)
"""Position, m, and attitude of the marker in the picture of `draw_marker_demo`."""


def table(rows: Sequence[Row]) -> str:
    """The study's table as Markdown; errors are root mean squares for each axis, the model's standard deviations in brackets."""
    lines = [
        "| distance m | found | lateral mm | depth mm | tilt ° | yaw ° |",
        "|---|---|---|---|---|---|",
    ]
    for r in rows:
        pairs = zip(_shown(r)[:4], _shown(r)[4:], strict=True)
        cells = " | ".join(f"{found:.2g} ({model:.2g})" for found, model in pairs)
        lines.append(f"| {r.distance_m:g} | {r.found}/{r.images} | {cells} |")
    return "\n".join(lines)


def draw_marker_figure(out: Path, study: Study) -> list[Path]:
    """Write `fig_marker_error` into the folder `out`, as PDF and PNG, and return the files' paths.

    Grey: distances at which the model no longer finds the marker.
    """
    with paper_style():
        return save(_error_figure(study), Path(out), "fig_marker_error")


def draw_marker_demo(out: Path, camera: Camera | None = None) -> tuple[list[Path], Detection]:
    """Write `fig_marker_demo` into the folder `out`, as PDF and PNG: a rendered picture and the marker found in it.

    Returns:
        The files' paths and the detection.

    Raises:
        PictureError: no OpenGL that works, or the marker was not found.
        ArmlandError: no OpenCV.
    """
    scene = build_marker_scene(camera or Camera(marker_size_m=MARKER_SIZE_M))
    with tempfile.TemporaryDirectory(prefix="armland-") as name:
        file = render(scene.model, scene.qpos(*_DEMO_POSE), Path(name) / "eye.png", scene.width, scene.height, EYE)
        picture = np.rint(255.0 * imread(file)[..., :3]).astype(np.uint8)
    image = photographed(picture, Imaging(), stream(0, "marker demo"))
    seen = detect(image, scene.size_m, scene.intrinsics)
    if not seen:
        raise PictureError("the detector found no marker in the demonstration's picture, where there is one")
    with paper_style():
        return save(_demo_figure(image, scene, seen[0]), Path(out), "fig_marker_demo"), seen[0]


def _shown(r: Row) -> list[float]:
    # mm and degrees, found and then claimed, in the order of the table's columns.
    return [factor * x for factor, x in zip([1e3, 1e3, 180.0 / np.pi, 180.0 / np.pi] * 2, r[3:], strict=True)]


def _error_figure(study: Study) -> Figure:
    figure = sheet(PAGE_IN, 2.7)
    e = study.errors[study.errors["found"]]
    rows = np.array([[r.distance_m, *_shown(r)] for r in study.rows if r.found])
    z = np.geomspace(rows[0, 0], rows[-1, 0], 60)
    model = np.array([model_sigma(study.camera, x) for x in z]) * [1e3, 1e3, 180.0 / np.pi, 180.0 / np.pi]
    position, rotation = 1e3 * np.abs(e["position"]), np.degrees(np.abs(e["rotation"]))
    components = position[:, :2], position[:, 2:], rotation[:, :2], rotation[:, 2:]
    panels = figure.subplots(1, 4, sharex=True)
    titles = "lateral (mm)", "depth (mm)", "tilt (°)", "yaw (°)"
    for k, (axes, title, points) in enumerate(zip(panels, titles, components, strict=True)):
        dots = {"color": _BLUE, "markersize": 3.0, "alpha": 0.3, "markeredgewidth": 0.0}
        for i, column in enumerate(points.T):
            axes.plot(e["distance"], column, ".", label="_" if i else "one image, each axis", **dots)
        axes.plot(rows[:, 0], rows[:, 1 + k], "o-", color=_BLUE, linewidth=1.1, markersize=3.0, label="detector, rms")
        axes.plot(z, model[:, k], "--", color=_RED, linewidth=1.1, label="measurement model, σ")
        _finish(axes, title, study.camera, float(np.quantile(points, 0.05)))
    legend_above(figure, panels[0])
    return figure


def _finish(axes: Axes, title: str, camera: Camera, low: float) -> None:
    axes.set_xscale("log")
    axes.set_yscale("log")
    # A few errors that happen to be next to nothing would stretch the axis.
    axes.set_ylim(bottom=0.5 * low)
    ticks = [0.15, 0.3, 0.6, 1.2, 2.4]
    axes.set_xticks(ticks, [f"{t:g}" for t in ticks])
    axes.set_xticks([], minor=True)
    right = axes.get_xlim()[1]
    shade(axes, [(camera.depth_max_per_size * camera.marker_size_m, right)])
    axes.set_xlim(right=right)
    axes.set_xlabel("distance (m)")
    axes.set_title(title, fontsize=8.0)


def _demo_figure(image: NDArray[np.uint8], scene: MarkerScene, found: Detection) -> Figure:
    figure = sheet(PAGE_IN, 3.1)
    whole, close = figure.subplots(1, 2, width_ratios=[scene.width / scene.height, 1.0])
    for axes in (whole, close):
        axes.imshow(image, interpolation="nearest")
        axes.set_axis_off()
        ring = np.vstack([found.corners, found.corners[:1]])
        axes.plot(ring[:, 0], ring[:, 1], "-", color=_RED, linewidth=1.0)
        _axes_of_marker(axes, scene, found)
    low, high = found.corners.min(axis=0), found.corners.max(axis=0)
    middle, half = 0.5 * (low + high), 0.75 * float((high - low).max())
    close.set_xlim(middle[0] - half, middle[0] + half)
    close.set_ylim(middle[1] + half, middle[1] - half)
    close.plot(*found.corners.T, "+", color=_RED, markersize=7.0)
    whole.set_title("camera at the end effector", fontsize=8.0)
    close.set_title(_verdict(found), fontsize=8.0)
    return figure


def _axes_of_marker(axes: Axes, scene: MarkerScene, found: Detection) -> None:
    # Half as long as the marker's edge: x, y and z, out of the face.
    tips = found.position + 0.5 * scene.size_m * matrix(found.quat).T
    x, y = project(found.position, scene.intrinsics)
    for tip, colour, name in zip(project(tips, scene.intrinsics), (_RED, _GREEN, _BLUE), "xyz", strict=True):
        arrow = {"arrowstyle": "-|>", "color": colour, "shrinkA": 0, "shrinkB": 0}
        axes.annotate("", (tip[0], tip[1]), (x, y), arrowprops=arrow)
        u, v = 1.18 * tip - 0.18 * np.array([x, y])
        axes.text(u, v, f"${name}$", color=colour, ha="center", va="center", fontsize=8.0, clip_on=True)


def _verdict(found: Detection) -> str:
    position, quat = _DEMO_POSE
    off = 1e3 * np.linalg.norm(found.position - position)
    turn = np.degrees(angle(multiply(conjugate(quat), found.quat)))
    return f"marker {found.marker} at {found.position[2]:.3f} m; error {off:.2f} mm, {turn:.2f}°"
