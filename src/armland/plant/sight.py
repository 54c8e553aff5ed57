"""Where the marker is for the camera at the end effector, and what share of it is seen, by rays: no OpenGL is needed.

A grid of points on the face, white margin included; a point is seen where it lies in the picture and the straight line from
the optical centre to it meets nothing else that is drawn.
"""

from typing import NamedTuple

import mujoco
import numpy as np

from armland.plant.scene.eye import CAMERA, MARKER
from armland.rotations import Array
from armland.scenario.sensing import Camera

GRID = 21
"""Points along an edge."""

DRAWN = np.array([1, 1, 1, 0, 0, 0], np.uint8)
"""Geom groups that are drawn; the others are collision shapes."""


class Sight(NamedTuple):
    """What the camera sees of the marker's face."""

    seen: float  # share of the face
    in_picture: float  # share that would be seen with nothing in the way
    depth: float  # m, of the face's centre along the optical axis
    hidden_by: tuple[str, ...]  # names of geoms, or of their bodies, that stand in the way


def sight(model: mujoco.MjModel, data: mujoco.MjData, camera: Camera | None = None) -> Sight:
    """Share of the marker's face in view now; `data` needs its positions up to date (`mj_kinematics`, `mj_camlight`)."""
    half = np.tan(0.5 * np.deg2rad((camera or Camera()).field_of_view_deg))
    eye, face = data.cam(CAMERA), data.geom(MARKER)
    # MuJoCo's camera looks along its -z, with y up.
    R = eye.xmat.reshape(3, 3) @ np.diag([1.0, -1.0, -1.0])
    size, F = model.geom(MARKER).size, face.xmat.reshape(3, 3)
    u = np.linspace(-1.0, 1.0, GRID) * (1.0 - 0.5 / GRID)
    x, y = (size[0] * a.ravel() for a in np.meshgrid(u, u))
    points = face.xpos + np.stack([x, y, np.full(GRID**2, size[2])], axis=1) @ F.T
    local = (points - eye.xpos) @ R
    inside = (local[:, 2] > 0.0) & (np.abs(local[:, :2]) <= half * local[:, 2:]).all(axis=1)
    hit = [_first(model, data, eye.xpos, p - eye.xpos) for p in points]
    own = model.geom(MARKER).id
    clear = np.array([g == own for g in hit])
    names = {_name(model, g) for g, c, i in zip(hit, clear, inside, strict=True) if i and not c}
    depth = float((face.xpos + size[2] * F[:, 2] - eye.xpos) @ R[:, 2])
    return Sight(float(np.mean(inside & clear)), float(np.mean(inside)), depth, tuple(sorted(names)))


def marker_pose(model: mujoco.MjModel, data: mujoco.MjData) -> tuple[Array, Array]:
    """Pose of the marker in the camera's frame: position (3,) m and quat (4,), camera<-marker; needs the state's kinematics."""
    view, plate = data.cam(CAMERA), data.geom(MARKER)
    R_wc, R_wm = view.xmat.reshape(3, 3) @ np.diag([1.0, -1.0, -1.0]), plate.xmat.reshape(3, 3)
    face = plate.xpos + model.geom(MARKER).size[2] * R_wm[:, 2]
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, (R_wc.T @ R_wm).ravel())
    return R_wc.T @ (face - view.xpos), quat


def _first(model: mujoco.MjModel, data: mujoco.MjData, start: Array, ray: Array) -> int:
    # The camera's own housing ends behind the optical centre.
    geom = np.zeros(1, np.int32)
    mujoco.mj_ray(model, data, start, ray, DRAWN, 1, -1, geom, None)
    return int(geom[0])


def _name(model: mujoco.MjModel, geom: int) -> str:
    if geom < 0:
        return "nothing"
    return model.geom(geom).name or f"a shape of {model.body(int(model.geom_bodyid[geom])).name}"
