"""Where the marker is for the camera at the end effector, and what share of it is seen, by rays: no OpenGL is needed.

A grid of points on the face, white margin included; a point is seen where it lies in the picture and the straight line from
the optical centre to it meets nothing else that is drawn.
"""

import copy
from functools import lru_cache
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from armland.plant.scene.eye import CAMERA, MARKER
from armland.rotations import Array
from armland.scenario.sensing import Camera

GRID = 21
"""Points along an edge."""

DRAWN = np.array([1, 1, 1, 0, 0, 0], np.uint8)
"""Geom groups that are drawn; the others are collision shapes."""


AZIMUTHS = 24
"""Directions about the marker's normal in which it is asked how far from it the marker is seen."""

STEP_DEG, FROM_M = 2.5, (0.25, 0.5, 1.0)
"""Step of the angle of sight, and distances from the marker, from all of which it must be seen."""

WHOLE = 0.95
"""Share of the face, white margin included, from which on the black square is whole and has white around it: a tenth of the face on
each side is margin."""


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


def clear_angles(model: mujoco.MjModel, uav: int, largest: float) -> Array:
    """Angles of sight (`AZIMUTHS`,), rad, up to which nothing of the UAV itself hides its marker, by azimuth in the marker's frame.

    Args:
        model: scene with a UAV and its marker.
        uav: the UAV's body.
        largest: rad, beyond which nobody looks.
    """
    own = model.body_rootid[model.geom_bodyid] == model.body_rootid[uav]
    # What a UAV looks like, wherever it is and whatever else stands around.
    keys = ("geom_pos", "geom_quat", "geom_size", "geom_type", "geom_dataid", "geom_group")
    looks = b"".join(np.asarray(getattr(model, key))[own].tobytes() for key in keys)
    return _clear(_Looks(model, own, looks), largest)


class _Looks:
    # A model, equal to others of which the UAV looks the same.
    def __init__(self, model: mujoco.MjModel, own: NDArray[np.bool_], looks: bytes) -> None:
        self.model, self.own, self.looks = model, own, looks

    def __hash__(self) -> int:
        return hash(self.looks)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Looks) and other.looks == self.looks


@lru_cache(maxsize=8)
def _clear(looks: _Looks, largest: float) -> Array:
    model = copy.copy(looks.model)
    model.geom_group[~looks.own] = 5
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    face, size, marker = data.geom(MARKER), model.geom(MARKER).size, model.geom(MARKER).id
    F, u = face.xmat.reshape(3, 3), np.linspace(-0.95, 0.95, 9)
    x, y = (size[0] * a.ravel() for a in np.meshgrid(u, u))
    points = face.xpos + np.stack([x, y, np.full(len(x), size[2])], axis=1) @ F.T
    hit, far = np.zeros(len(x), np.int32), np.zeros(len(x))

    def look(towards: Array, distance: float) -> NDArray[np.int32]:
        eye = face.xpos + distance * towards
        rays = (points - eye).ravel()
        mujoco.mj_multiRay(model, data, eye, rays, DRAWN, True, -1, hit, far, None, len(x), np.inf)
        return hit

    while (covers := look(F[:, 2], FROM_M[-1])[(hit != marker) & (hit >= 0)]).size:
        # A hull whose drawing reaches below the marker has it on its outside.
        model.geom_group[covers] = 5
    found = np.full(AZIMUTHS, largest)
    for k, azimuth in enumerate(np.arange(AZIMUTHS) * 2.0 * np.pi / AZIMUTHS):
        for angle in np.arange(STEP_DEG, np.rad2deg(largest) + STEP_DEG, STEP_DEG):
            s, c = np.sin(np.deg2rad(angle)), np.cos(np.deg2rad(angle))
            towards = F @ [s * np.cos(azimuth), s * np.sin(azimuth), c]
            if min(np.mean(look(towards, distance) == marker) for distance in FROM_M) < WHOLE:
                found[k] = np.deg2rad(angle - STEP_DEG)
                break
    found.setflags(write=False)
    return found


def _first(model: mujoco.MjModel, data: mujoco.MjData, start: Array, ray: Array) -> int:
    # The camera's own housing ends behind the optical centre.
    geom = np.zeros(1, np.int32)
    mujoco.mj_ray(model, data, start, ray, DRAWN, 1, -1, geom, None)
    return int(geom[0])


def _name(model: mujoco.MjModel, geom: int) -> str:
    if geom < 0:
        return "nothing"
    return model.geom(geom).name or f"a shape of {model.body(int(model.geom_bodyid[geom])).name}"
