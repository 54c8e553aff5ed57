"""What the camera on the gripper sees: outlines of all shapes in its image plane, and where it found the marker, as an SVG.

| symbol | name | unit, frame |
|---|---|---|
| c | camera frame: z along the view, x to the image's right, y down | m |
| (u, v) = (x/z, y/z) | a point of the picture | 1 |

A shape is drawn as the convex hull of its projected corners, the far ones first: exact for boxes, cylinders, capsules and
ellipsoids, of which UAV, plate and gear consist. A rendered picture takes ten times as long and needs OpenGL.
"""

from html import escape
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from armland.console.stage.poses import Poses, rotation
from armland.console.stage.shapes import color_of, drawn, triangles
from armland.plant.scene.eye import CAMERA, MARKER
from armland.records import Records
from armland.rotations import Array, matrix
from armland.scenario.sensing import Camera

WIDTH = 360
"""Of the picture, in its own units."""

NEAR_M = 0.01
"""What is nearer to the optical centre is cut off."""

SKY, BLACK, FOUND, PIVOT = "#dfe7ee", "#111111", "#009E73", "#D55E00"


class Shape(NamedTuple):
    """One shape of the scene."""

    body: int
    corners: Array  # (v, 3) m, body
    edges: np.ndarray  # (e, 2) indices of corners
    color: str


class Sight:
    """The camera's picture of a scene.

    Args:
        poses: of the scene; they are set by whoever shows it.
        camera: of the scenario.
    """

    def __init__(self, poses: Poses, camera: Camera) -> None:
        model = poses.model
        self._poses, self._camera = poses, camera
        self._half = np.tan(0.5 * np.deg2rad(camera.field_of_view_deg))
        self._shapes = [s for g in drawn(model) if (s := _shape(model, g)) is not None and s.body not in poses.absent]
        self._uav = int(model.geom_bodyid[model.geom(MARKER).id])
        half = 0.5 * camera.marker_size_m
        self._square = half * np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])

    def svg(self, tick: Records, period_s: float) -> str:
        """The picture at one tick, to which the poses are set, with a line of words below.

        Args:
            tick: a record of `records.tick_layout`.
            period_s: of a tick, s.
        """
        seen = self._poses.camera(CAMERA)
        if seen is None:
            return ""
        R, centre = rotation(seen[1]).as_matrix(), seen[0]
        places, turns = self._poses.bodies
        near: list[tuple[float, str]] = []
        for shape in self._shapes:
            points = (shape.corners @ matrix(turns[shape.body]).T + places[shape.body] - centre) @ R
            if (path := self._outline(points, shape.edges)) is not None:
                near.append((-float(points[:, 2].mean()), _polygon(path, shape.color)))
        marker = np.array(self._camera.marker_m) + self._square
        marker = (marker @ matrix(turns[self._uav]).T + places[self._uav] - centre) @ R
        if (path := self._outline(marker, _ring(4))) is not None:
            # Before the plate on which it is printed, behind what is nearer.
            near.append((-float(marker[:, 2].mean()) + 2e-3, _polygon(path, BLACK)))
        parts = [text for _, text in sorted(near)]
        parts += self._found(tick) + self._pivot((np.array(tick["truth"]["r"]) - centre) @ R)
        return _page(parts, self._half, self._words(tick, period_s))

    def _found(self, tick: Records) -> list[str]:
        # Where the newest image had the marker.
        m = tick["measurement"]
        if not tick["estimate"]["plate_valid"] or not m["camera_position"][2] > NEAR_M:
            return []
        corners = self._square @ rotation(m["camera_quat"]).as_matrix().T + m["camera_position"]
        path = self._outline(corners, _ring(4))
        return (
            []
            if path is None
            else [f'<polygon points="{_points(path)}" fill="none" stroke="{FOUND}" stroke-width="3"/>']
        )

    def _pivot(self, point: Array) -> list[str]:
        if not point[2] > NEAR_M:
            return []
        u, v = self._pixels(point[None])[0]
        return [f'<path d="M{u - 6:.1f} {v:.1f}h12M{u:.1f} {v - 6:.1f}v12" stroke="{PIVOT}" stroke-width="2"/>']

    def _outline(self, points: Array, edges: np.ndarray) -> Array | None:
        # (k, 2), the hull of what is before the camera and in the picture; None where nothing is.
        before = points[:, 2] > NEAR_M
        if not before.all():
            if not before.any():
                return None
            a, b = (points[edges[:, i]] for i in (0, 1))
            cut = (a[:, 2] > NEAR_M) != (b[:, 2] > NEAR_M)
            a, b = a[cut], b[cut]
            share = ((NEAR_M - a[:, 2]) / (b[:, 2] - a[:, 2]))[:, None]
            points = np.vstack([points[before], a + share * (b - a)])
        flat = points[:, :2] / points[:, 2:]
        low, high = flat.min(axis=0), flat.max(axis=0)
        if not (np.isfinite(flat).all() and (high > -self._half).all() and (low < self._half).all()):
            return None
        try:
            return self._pixels(points[ConvexHull(flat).vertices])
        except QhullError:
            # Seen edge on it has no area.
            return None

    def _pixels(self, points: Array) -> Array:
        return (points[:, :2] / points[:, 2:] / self._half[0] + [1.0, self._half[1] / self._half[0]]) * 0.5 * WIDTH

    def _words(self, tick: Records, period_s: float) -> str:
        m = tick["measurement"]
        if not tick["estimate"]["plate_valid"]:
            return "the marker is not found"
        age = (int(m["tick"]) - int(m["camera_capture"])) * period_s
        return f"marker at {np.linalg.norm(m['camera_position']):.3f} m, in an image {1e3 * age:.0f} ms old"


def _shape(model: Any, geom: int) -> Shape | None:
    made = triangles(model, geom)
    if made is None:
        return None
    vertices, faces = made
    placed = vertices @ matrix(model.geom_quat[geom]).T + model.geom_pos[geom]
    try:
        hull = ConvexHull(placed)
    except QhullError:
        hull, faces = None, faces
    faces = faces if hull is None else hull.simplices
    used, numbers = np.unique(faces, return_inverse=True)
    numbers = numbers.reshape(-1, 3)
    edges = np.unique(np.sort(numbers[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)
    r, g, b = (round(255 * c) for c in color_of(model, geom)[:3])
    return Shape(int(model.geom_bodyid[geom]), placed[used], edges, f"#{r:02x}{g:02x}{b:02x}")


def _ring(n: int) -> np.ndarray:
    return np.stack([np.arange(n), np.roll(np.arange(n), -1)], axis=1)


def _points(path: Array) -> str:
    return " ".join(f"{u:.1f},{v:.1f}" for u, v in path)


def _polygon(path: Array, color: str) -> str:
    return f'<polygon points="{_points(path)}" fill="{color}"/>'


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
