"""Outlines of convex shapes as a camera sees them, those of all shapes in a few passes of NumPy.

| symbol | name | unit, frame |
|---|---|---|
| c | camera frame: z along the view, x to the image's right, y down | m |
| (u, v) = (x/z, y/z) | a point of the picture | 1 |

The outline of a convex shape runs along the edges between a face that the camera sees and one that it does not, and its corners
follow one another by their angle about their middle. A convex hull of the projected corners, shape by shape, gives the same in three
times the time; only what the near plane cuts, and what is flat, is done in that way.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from armland.rotations import Array

NEAR_M = 0.01
"""What is nearer to the optical centre is cut off."""


class Hull(NamedTuple):
    """A convex shape that is fixed to a body."""

    body: int
    corners: Array  # (v, 3) m, body
    edges: np.ndarray  # (e, 2) corners
    planes: Array  # (f, 4) outward normal, and what is added: above zero outside; no planes where the shape is flat
    starts: np.ndarray  # (f, 3) corner at which each edge of a face starts, counter-clockwise seen from outside
    beside: np.ndarray  # (f, 3) face at the other side of that edge


class Outline(NamedTuple):
    """What is seen of a shape."""

    number: int
    depth: float  # m, of its middle
    path: Array  # (k, 2) u, v


class Outlines:
    """The outlines of shapes.

    Args:
        hulls: the shapes.
        half: half the width and height of the view at a distance of one, (2,).
    """

    def __init__(self, hulls: Sequence[Hull], half: Array) -> None:
        self._hulls, self._half = hulls, half
        self._bodies = np.array([h.body for h in hulls], dtype=int)
        self._solid = np.array([len(h.planes) > 0 for h in hulls], dtype=bool)
        low, high = (np.array([end(h.corners, axis=0) for h in hulls]).reshape(-1, 3) for end in (np.min, np.max))
        self._middles, self._sizes = 0.5 * (low + high), 0.5 * (high - low)
        faces, corners = (np.array([len(part) for part in parts], dtype=int) for parts in _parts(hulls))
        self._shape = np.repeat(np.arange(len(hulls)), faces)
        self._corners = np.vstack([np.zeros((0, 3)), *(h.corners for h in hulls)])
        self._planes = np.vstack([np.zeros((0, 4)), *(h.planes for h in hulls)])
        none, first, before = np.zeros((0, 3), int), np.cumsum(corners) - corners, np.cumsum(faces) - faces
        self._starts = np.vstack([none, *(h.starts + k for h, k in zip(hulls, first, strict=True))])
        self._beside = np.vstack([none, *(h.beside + k for h, k in zip(hulls, before, strict=True))])

    def seen(self, places: Array, turns: Array, centre: Array, R: Array) -> list[Outline]:
        """The outlines of all that is in view.

        Args:
            places: (nbody, 3) m, W.
            turns: (nbody, 3, 3), W<-body.
            centre: the camera's optical centre (3,), m, W.
            R: (3, 3), W<-c.
        """
        of = self._bodies
        # Boxes along the axes of their bodies hold the shapes.
        axes = turns[of].transpose(0, 2, 1) @ R
        middles = (_turned(turns[of], self._middles) + places[of] - centre) @ R
        reach = np.einsum("ki,kij->kj", self._sizes, np.abs(axes))
        nearest, farthest = middles[:, 2] - reach[:, 2], middles[:, 2] + reach[:, 2]
        aside = np.abs(middles) - reach
        seen = (farthest > NEAR_M) & (aside[:, :2] < self._half * farthest[:, None]).all(axis=1)
        whole, depth = seen & (nearest > NEAR_M) & self._solid, middles[:, 2]
        found = []
        for i in np.flatnonzero(seen & ~whole).tolist():
            hull = self._hulls[i]
            points = (hull.corners @ turns[hull.body].T + places[hull.body] - centre) @ R
            if (path := outline(points, hull.edges, self._half)) is not None:
                found.append(Outline(i, float(depth[i]), path))
        eyes = np.einsum("bji,bj->bi", turns, centre - places)
        starts, shapes = self._silhouettes(whole, eyes)
        on = of[shapes]
        points = (_turned(turns[on], self._corners[starts]) + places[on] - centre) @ R
        return found + self._paths(points[:, :2] / points[:, 2:], shapes, depth)

    def _silhouettes(self, whole: np.ndarray, eyes: Array) -> tuple[np.ndarray, np.ndarray]:
        # Corners and their shapes, (k,), without order: each edge starts at another corner.
        faces = np.flatnonzero(whole[self._shape])
        planes, eye = self._planes[faces], eyes[self._bodies[self._shape[faces]]]
        facing = np.zeros(len(self._shape), bool)
        facing[faces] = np.einsum("fi,fi->f", planes[:, :3], eye) + planes[:, 3] > 0.0
        faces = np.flatnonzero(facing)
        row, edge = np.nonzero(~facing[self._beside[faces]])
        return self._starts[faces[row], edge], self._shape[faces[row]]

    def _paths(self, flat: Array, shapes: np.ndarray, depth: Array) -> list[Outline]:
        # From the points (k, 2) of all outlines.
        count = np.bincount(shapes, minlength=len(depth))
        sums = np.stack([np.bincount(shapes, flat[:, i], len(depth)) for i in (0, 1)], axis=1)
        off = flat - (sums / np.maximum(count, 1)[:, None])[shapes]
        flat = flat[np.lexsort((np.arctan2(off[:, 1], off[:, 0]), shapes))]
        numbers = np.flatnonzero(count)
        pieces = np.split(flat, np.cumsum(count[numbers])[:-1]) if len(numbers) else []
        return [Outline(int(i), float(depth[i]), path) for i, path in zip(numbers, pieces, strict=True)]


def hull_of(body: int, points: Array, faces: np.ndarray) -> Hull:
    """The convex hull of points (n, 3), m, that are fixed to a body; of flat ones, their `faces` (f, 3) instead."""
    try:
        hull = ConvexHull(points)
    except QhullError:
        used, numbers = np.unique(faces, return_inverse=True)
        none = np.zeros((0, 3), int)
        return Hull(body, points[used], _edges(numbers.reshape(-1, 3)), np.zeros((0, 4)), none, none)
    used, numbers = np.unique(hull.simplices, return_inverse=True)
    corners, faces, beside = points[used], numbers.reshape(-1, 3), hull.neighbors.copy()
    a, b, c = (corners[faces[:, k]] for k in range(3))
    # So that seen from outside all go round in one direction.
    turned = np.einsum("fi,fi->f", np.cross(b - a, c - a), hull.equations[:, :3]) < 0.0
    faces[turned], beside[turned] = faces[turned][:, ::-1], beside[turned][:, ::-1]
    # A face's k-th neighbour lies beside the edge that its k-th corner is not on.
    return Hull(body, corners, _edges(faces), hull.equations, np.roll(faces, -1, axis=1), beside)


def outline(points: Array, edges: np.ndarray, half: Array) -> Array | None:
    """The outline (k, 2), u and v, of one shape's points (n, 3), m, c: of what is before the camera; None where nothing is in view."""
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
    if not (np.isfinite(flat).all() and (high > -half).all() and (low < half).all()):
        return None
    try:
        return np.array(flat[ConvexHull(flat).vertices])
    except QhullError:
        # Seen edge on it has no area.
        return None


def _parts(hulls: Sequence[Hull]) -> tuple[list[Array], list[Array]]:
    return [h.planes for h in hulls], [h.corners for h in hulls]


def _edges(faces: np.ndarray) -> np.ndarray:
    return np.unique(np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)


def _turned(turns: Array, points: Array) -> Array:
    return np.array(np.einsum("kij,kj->ki", turns, points))
