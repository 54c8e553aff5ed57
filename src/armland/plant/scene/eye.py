"""Camera at the end effector and marker under the UAV as things in the scene: what sees, what is seen, what collides.

| name | what |
|---|---|
| `CAMERA` | MuJoCo camera in the optical centre; looks along the end effector's z, its image's x along the end effector's x |
| `HOUSING` | capsule around the camera behind the optical centre, drawn and checked for collisions as a part of the tool |
| `MARKER` | plate with the marker's lower face at `camera.marker_m`, one cell of white margin around the black square; blank here |

The print is put on by whoever draws pictures (`armland.view`): the plant needs no OpenCV.
"""

import mujoco
import numpy as np

from armland.errors import ModelError
from armland.plant.scene.gear import TOOL_RADIUS_M
from armland.plant.scene.uav import UAV
from armland.scenario.sensing import Camera

CAMERA = "eye"
HOUSING = "camera"
MARKER = f"{UAV}marker"

MARKER_DOWN = np.array([0.0, 1.0, 0.0, 0.0])
"""B<-marker: the printed face looks down."""

HOUSING_RADIUS_M = 0.02
"""Around a board of 29 mm square, the common size of industrial board cameras."""

HOUSING_LENGTH_M = 0.05
"""Board, sensor and a lens of 4 mm focal length with its mount. Assumption."""

MARGIN = 10.0 / 8.0
"""Edge of the plate over that of the black square: detection needs one of its eight cells as a white margin."""

THIN_M = 5e-4
"""Half the plate's thickness."""


def mount_camera(tool: mujoco.MjsBody, point: float, camera: Camera) -> None:
    """Put camera and housing on the tool's body, whose end effector point is `point` m along its z.

    Raises:
        ModelError: the housing would reach into the tool's axis, where force-torque sensor and magnet are.
    """
    place = np.array(camera.position_m) + [0.0, 0.0, point]
    beside, least = float(np.hypot(*place[:2])), HOUSING_RADIUS_M + TOOL_RADIUS_M
    if beside < least:
        raise ModelError(
            f"camera.position_m = {tuple(camera.position_m)} is {beside:g} m beside the tool's axis; the housing of "
            f"{HOUSING_RADIUS_M:g} m radius and the tool of {TOOL_RADIUS_M:g} m need {least:g} m"
        )
    # MuJoCo's cameras look along their -z, with y up; armland's along +z, with y down.
    tool.add_camera(name=CAMERA, pos=place, quat=[0.0, 1.0, 0.0, 0.0], fovy=camera.field_of_view_deg[1])
    top, bottom = place - [0.0, 0.0, HOUSING_RADIUS_M + 1e-3], place - [0.0, 0.0, HOUSING_LENGTH_M - HOUSING_RADIUS_M]
    look = {"type": mujoco.mjtGeom.mjGEOM_CAPSULE, "mass": 0, "group": 2, "rgba": [0.16, 0.17, 0.2, 1]}
    tool.add_geom(name=HOUSING, fromto=[*bottom, *top], size=[HOUSING_RADIUS_M, 0, 0], **look)
    arm = 0.5 * (top + bottom)
    tool.add_geom(fromto=[0, 0, arm[2], *arm], size=[0.006, 0, 0], **look)


def mount_marker(uav: mujoco.MjsBody, camera: Camera) -> None:
    """Put the blank marker plate under the UAV's body, whose origin is its centre of mass."""
    edge = 0.5 * MARGIN * camera.marker_size_m
    uav.add_geom(
        name=MARKER.removeprefix(UAV),
        type=mujoco.mjtGeom.mjGEOM_BOX,
        # The face that is seen has the marker in its plane.
        pos=np.array(camera.marker_m) + [0.0, 0.0, THIN_M],
        quat=MARKER_DOWN,
        size=[edge, edge, THIN_M],
        rgba=[1.0, 1.0, 1.0, 1.0],
        mass=0,
        group=2,
    )
