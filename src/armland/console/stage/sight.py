"""What the camera on the gripper sees: outlines of all shapes in its image plane, and where it found the marker, as an SVG.

A shape is drawn as the convex hull of its projected corners, the far ones first: exact for boxes, cylinders, capsules and
ellipsoids, of which UAV, plate and gear consist. A rendered picture takes a hundred times as long and needs OpenGL.
"""

from html import escape
from typing import Any

import mujoco
import numpy as np

from armland.console.stage.outlines import NEAR_M, Hull, Outlines, hull_of, outline
from armland.console.stage.poses import Poses, turn_of
from armland.console.stage.shapes import color_of, drawn, triangles
from armland.plant.scene.eye import CAMERA, MARKER
from armland.plant.scene.pad import PAD
from armland.records import Records
from armland.rotations import Array, matrix
from armland.scenario.sensing import Camera

WIDTH = 360
"""Of the picture, in its own units."""

RING = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
"""Edges of a square."""

SKY, BLACK, FOUND, PIVOT = "#dfe7ee", "#111111", "#009E73", "#D55E00"


class Sight:
    """The camera's picture of a scene.

    Args:
        poses: of the scene; they are set by whoever shows it. Others of a scene that looks the same may take their place.
        camera: of the scenario.
    """

    def __init__(self, poses: Poses, camera: Camera) -> None:
        model = poses.model
        self.poses, self._camera = poses, camera
        self._half = np.tan(0.5 * np.deg2rad(camera.field_of_view_deg))
        shapes = [(hull, _color(model, g)) for g in drawn(model) if (hull := _hull(model, g)) is not None]
        # Through a window of the pad the camera looks up past it.
        unseen = poses.absent | {mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, PAD)}
        shapes = [(hull, color) for hull, color in shapes if hull.body not in unseen]
        self._colors = [color for _, color in shapes]
        self._outlines = Outlines([hull for hull, _ in shapes], self._half)
        self._uav = int(model.geom_bodyid[model.geom(MARKER).id])
        half = 0.5 * camera.marker_size_m
        self._square = half * np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])

    def svg(self, tick: Records, period_s: float) -> str:
        """The picture at one tick, to which the poses are set, with a line of words below.

        Args:
            tick: a record of `records.tick_layout`.
            period_s: of a tick, s.
        """
        seen = self.poses.camera(CAMERA)
        if seen is None:
            return ""
        R, centre = matrix(seen[1]), seen[0]
        places, turns = self.poses.bodies
        shapes = [
            (o.depth, o.path, self._colors[o.number]) for o in self._outlines.seen(places, self.poses.turns, centre, R)
        ]
        marker = np.array(self._camera.marker_m) + self._square
        marker = (marker @ matrix(turns[self._uav]).T + places[self._uav] - centre) @ R
        if (path := outline(marker, RING, self._half)) is not None:
            # Before the plate on which it is printed, behind what is nearer.
            shapes.append((float(marker[:, 2].mean()) - 2e-3, path, BLACK))
        shapes.sort(key=lambda shape: -shape[0])
        paths, looks = [path for _, path, _ in shapes], [f'fill="{color}"' for _, _, color in shapes]
        if (path := self._found(tick)) is not None:
            paths.append(path)
            looks.append(f'fill="none" stroke="{FOUND}" stroke-width="3"')
        parts = self._polygons(paths, looks) + self._pivot((np.array(tick["truth"]["r"]) - centre) @ R)
        return _page(parts, self._half, self._words(tick, period_s))

    def _found(self, tick: Records) -> Array | None:
        # Where the newest image had the marker.
        m = tick["measurement"]
        if not tick["estimate"]["plate_valid"] or not m["camera_position"][2] > NEAR_M:
            return None
        corners = self._square @ turn_of(m["camera_quat"]).T + m["camera_position"]
        return outline(corners, RING, self._half)

    def _pivot(self, point: Array) -> list[str]:
        if not point[2] > NEAR_M:
            return []
        u, v = self._pixels(point[:2] / point[2])
        return [f'<path d="M{u - 6:.1f} {v:.1f}h12M{u:.1f} {v - 6:.1f}v12" stroke="{PIVOT}" stroke-width="2"/>']

    def _polygons(self, paths: list[Array], looks: list[str]) -> list[str]:
        # All numbers at once, and written as a list is: as good to SVG, and much quicker than number by number.
        flat = np.vstack([np.zeros((0, 2)), *paths])
        numbers, ends = np.round(self._pixels(flat), 1).ravel().tolist(), 2 * np.cumsum([len(p) for p in paths])
        return [
            f'<polygon points="{str(numbers[end - 2 * len(path) : end])[1:-1]}" {look}/>'
            for path, look, end in zip(paths, looks, ends, strict=True)
        ]

    def _pixels(self, path: Array) -> Array:
        return (path / self._half[0] + [1.0, self._half[1] / self._half[0]]) * 0.5 * WIDTH

    def _words(self, tick: Records, period_s: float) -> str:
        m = tick["measurement"]
        if not tick["estimate"]["plate_valid"]:
            return "the marker is not found"
        age = (int(m["tick"]) - int(m["camera_capture"])) * period_s
        return f"marker at {np.linalg.norm(m['camera_position']):.3f} m, in an image {1e3 * age:.0f} ms old"


def _hull(model: Any, geom: int) -> Hull | None:
    made = triangles(model, geom)
    if made is None:
        return None
    vertices, faces = made
    placed = vertices @ matrix(model.geom_quat[geom]).T + model.geom_pos[geom]
    return hull_of(int(model.geom_bodyid[geom]), placed, faces)


def _color(model: Any, geom: int) -> str:
    r, g, b = (round(255 * c) for c in color_of(model, geom)[:3])
    return f"#{r:02x}{g:02x}{b:02x}"


def _page(parts: list[str], half: Array, words: str) -> str:
    height = round(WIDTH * half[1] / half[0])
    return (
        '<figure style="margin:2px 10px 6px;font-size:11px"><b>what the camera sees</b> '
        f'<svg viewBox="0 0 {WIDTH} {height}" role="img" aria-label="what the camera sees" data-sight="1" '
        'style="display:block;width:70%;border-radius:4px">'
        f'<rect width="{WIDTH}" height="{height}" fill="{SKY}"/>'
        f'<g stroke="#0007" stroke-width="0.6">{"".join(parts)}</g></svg>'
        f"<figcaption>{escape(words)}</figcaption></figure>"
    )
