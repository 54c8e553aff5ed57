"""How deep the surface of a mesh is in another solid, and not its convex hull, which is all that MuJoCo looks at.

| symbol | name | unit |
|---|---|---|
| p | points of a surface, `EDGE_M` apart at most (k, 3) | m |
| d(p) | depth of a point in a solid, negative outside | m |
| w = Σ Ω/4π | winding number of a closed surface about a point, Ω the solid angle of each triangle: 1 inside, 0 outside | 1 |

Source of Ω: van Oosterom and Strackee, The solid angle of a plane triangle, IEEE Trans. Biomed. Eng. 30 (1983).
"""

from typing import NamedTuple

import mujoco
import numpy as np

from armland.rotations import Array

EDGE_M, APART_M = 0.012, 0.004
"""Largest distance of points along a triangle; points that are nearer to each other than the second are one."""

MANY = 2_000_000
"""Pairs of points and triangles that are looked at in one go."""

MESH = int(mujoco.mjtGeom.mjGEOM_MESH)


class Surface(NamedTuple):
    """A mesh of a model, in the frame of its geom."""

    triangles: Array  # (f, 3, 3) m
    points: Array  # (k, 3) m
    low: Array  # (3,) m, corners of the box around it
    high: Array


def surface(model: mujoco.MjModel, geom: int) -> Surface:
    """The surface of a geom that is a mesh."""
    mesh = int(model.geom_dataid[geom])
    first, faces = int(model.mesh_vertadr[mesh]), int(model.mesh_faceadr[mesh])
    vertices = model.mesh_vert[first : first + int(model.mesh_vertnum[mesh])].astype(float)
    corners = vertices[model.mesh_face[faces : faces + int(model.mesh_facenum[mesh])]]
    return Surface(corners, spread(corners), vertices.min(axis=0), vertices.max(axis=0))


def spread(triangles: Array) -> Array:
    """Points (k, 3), m, all over triangles (f, 3, 3), m: no place of them is farther from one than about `EDGE_M`."""
    longest = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max(axis=1, initial=0.0)
    parts, out = np.maximum(np.ceil(longest / EDGE_M), 1).astype(int), [np.zeros((0, 3))]
    for n in np.unique(parts).tolist():
        i, j = (x.ravel() for x in np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij"))
        shares = np.stack([i, j, n - i - j], axis=1)[i + j <= n] / n
        out.append(np.einsum("sc,fcx->fsx", shares, triangles[parts == n]).reshape(-1, 3))
    points = np.concatenate(out)
    _, one = np.unique(np.floor(points / APART_M).astype(np.int64), axis=0, return_index=True)
    return points[np.sort(one)]


class Depths:
    """Depths of pairs of solids of a model, one of each pair a mesh; it keeps the surfaces that it has made."""

    def __init__(self, model: mujoco.MjModel) -> None:
        """Of which model."""
        self.model = model
        self._made: dict[int, Surface] = {}

    def of(self, data: mujoco.MjData, one: int, two: int) -> float:
        """Depth, m, of the deepest point of either geom in the other, 0 where they are apart; `data` says where they are."""
        return max(self._points_in(data, a, b) for a, b in ((one, two), (two, one)) if self._is_mesh(a))

    def _is_mesh(self, geom: int) -> bool:
        return int(self.model.geom_type[geom]) == MESH

    def _surface(self, geom: int) -> Surface:
        if geom not in self._made:
            self._made[geom] = surface(self.model, geom)
        return self._made[geom]

    def _points_in(self, data: mujoco.MjData, mesh: int, other: int) -> float:
        points = self._surface(mesh).points
        R, o = (data.geom_xmat[g].reshape(3, 3) for g in (mesh, other)), data.geom_xpos[other]
        R_mesh, R_other = R
        there = ((points @ R_mesh.T + data.geom_xpos[mesh]) - o) @ R_other
        if self._is_mesh(other):
            return depth_in_mesh(there, self._surface(other))
        return max(float(depth_in(int(self.model.geom_type[other]), self.model.geom_size[other], there).max()), 0.0)


def depth_in(kind: int, size: Array, p: Array) -> Array:
    """d(p) (k,), m, of points (k, 3), m, in a primitive shape of MuJoCo's, in its frame; of an ellipsoid a lower bound.

    Args:
        kind: of `mjtGeom`.
        size: (3,) m, as MuJoCo has it.
        p: points, m.
    """
    if kind == mujoco.mjtGeom.mjGEOM_PLANE:
        return -p[:, 2]
    if kind == mujoco.mjtGeom.mjGEOM_BOX:
        return np.asarray((size - np.abs(p)).min(axis=1))
    if kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
        return np.minimum(size[0] - np.hypot(p[:, 0], p[:, 1]), size[1] - np.abs(p[:, 2]))
    if kind == mujoco.mjtGeom.mjGEOM_ELLIPSOID:
        return np.asarray(size.min() * (1.0 - np.linalg.norm(p / size, axis=1)))
    half = size[1] if kind == mujoco.mjtGeom.mjGEOM_CAPSULE else 0.0
    beyond = np.maximum(np.abs(p[:, 2]) - half, 0.0)
    return np.asarray(size[0] - np.sqrt(p[:, 0] ** 2 + p[:, 1] ** 2 + beyond**2))


def depth_in_mesh(p: Array, solid: Surface) -> float:
    """Depth, m, of the deepest of points (k, 3), m, in a mesh, its frame: to the nearest of its points; 0 where none is inside."""
    near = p[((p > solid.low) & (p < solid.high)).all(axis=1)]
    inside = near[np.abs(winding(near, solid.triangles)) > 0.5]
    away = [np.sqrt(((solid.points - q) ** 2).sum(axis=1).min()) for q in inside]
    return float(max(away, default=0.0))


def winding(p: Array, triangles: Array) -> Array:
    """w (k,) of triangles (f, 3, 3), m, about points (k, 3), m."""
    out, step = np.zeros(len(p)), max(MANY // max(len(triangles), 1), 1)
    for first in range(0, len(p), step):
        a, b, c = np.moveaxis(triangles[None] - p[first : first + step, None, None], 2, 0)
        la, lb, lc = (np.sqrt(np.einsum("kfx,kfx->kf", v, v)) for v in (a, b, c))
        volume = np.einsum("kfx,kfx->kf", a, np.cross(b, c))
        ab, bc, ca = (np.einsum("kfx,kfx->kf", u, v) for u, v in ((a, b), (b, c), (c, a)))
        angle = 2.0 * np.arctan2(volume, la * lb * lc + ab * lc + bc * la + ca * lb)
        out[first : first + step] = angle.sum(axis=1) / (4.0 * np.pi)
    return out
