"""The landing's own scene with the marker printed, as the camera at the end effector sees it.

The arm stands where a landing begins; the UAV can be put so that the camera sees its marker at any pose.
"""

from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from armland.errors import ConfigurationError
from armland.models.description import compile_spec
from armland.plant.scene.composition import build_scene, scene_spec
from armland.plant.scene.eye import CAMERA, MARKER, MARKER_DOWN
from armland.rotations import Array, conjugate, matrix, multiply
from armland.scenario import Scenario, load_scenario
from armland.vision.fiducial import Intrinsics, marker_image, pinhole

HEIGHT_PX = 960
"""Of a picture; its width follows from the field of view, as pixels are square. The rc_visard's, as the published figures."""

EYE = CAMERA  # Name of the camera
NUMBER = 7  # Number of the marker on the UAV, any of the family
CELL_PX = 32  # Texture pixels along a cell of the marker


BLACK = 13  # Grey of the printed black, of 255: toner on paper reflects some 5 % of what paper does


class MarkerScene(NamedTuple):
    """A compiled scene with the printed marker, and the camera that looks at it."""

    model: mujoco.MjModel
    size_m: float  # edge of the marker's black square
    marker: Array  # (3,) m, marker's centre from the UAV's centre of mass, body
    eye: Array  # (3,) m, optical centre with the arm at its start, world
    gaze: Array  # (4,) world<-camera there
    home: Array  # qpos (nq,) with the arm at its start
    uav: NDArray[np.intp]  # (7,) addresses of the UAV in qpos
    hinge: NDArray[np.intp]  # (2,) of the hinge's y and x
    width: int  # px, of a picture
    height: int
    intrinsics: Intrinsics

    def qpos(self, position: Array, quat: Array) -> Array:
        """qpos (nq,) with the UAV so that the camera sees the marker at `position` (3,), m, and `quat` (4,), camera<-marker.

        The hinge plate hangs level, as it does in flight.
        """
        q, q_wb = self.home.copy(), multiply(self.gaze, multiply(quat, conjugate(MARKER_DOWN)))
        R = matrix(q_wb)
        q[self.uav] = np.concatenate([self.eye + matrix(self.gaze) @ position - R @ self.marker, q_wb])
        up = R[2]
        q[self.hinge] = np.arctan2(up[0], up[2]), -np.arcsin(np.clip(up[1], -1.0, 1.0))
        return q


def build_marker_scene(scenario: Scenario | None = None, home: Array | None = None) -> MarkerScene:
    """Compose and compile the landing scene of a scenario with the marker printed.

    Args:
        scenario: its section `camera` says where camera and marker are; `landing` if absent.
        home: joint positions (n,), rad, at which the arm stands; the scenario's `place.home_deg` if absent.

    Raises:
        ConfigurationError: neither is given.
        ArmlandError: no OpenCV to print the marker.
    """
    scenario = scenario or load_scenario("landing")
    camera, plain = scenario.camera, build_scene(scenario, "free")
    spec, _ = scene_spec(scenario, "free")
    print_marker(spec)
    model = compile_spec(spec, "the marker's scene")
    q = model.qpos0.copy()
    if home is None:
        if scenario.place.home_deg is None:
            raise ConfigurationError("place.home_deg: the marker's scene needs the pose of the arm; `landing` has one")
        home = np.deg2rad(scenario.place.home_deg)
    q[plain.joint_qpos] = home
    data = mujoco.MjData(model)
    data.qpos[:] = q
    mujoco.mj_kinematics(model, data)
    mujoco.mj_camlight(model, data)
    view = data.cam(EYE)
    # MuJoCo's cameras look along their -z, with y up; armland's along +z, with y down.
    gaze = np.zeros(4)
    mujoco.mju_mat2Quat(gaze, (view.xmat.reshape(3, 3) @ np.diag([1.0, -1.0, -1.0])).ravel())
    half = np.tan(0.5 * np.deg2rad(camera.field_of_view_deg))
    width = 2 * round(0.5 * HEIGHT_PX * half[0] / half[1])
    return MarkerScene(
        model=model,
        size_m=camera.marker_size_m,
        marker=np.array(camera.marker_m),
        eye=view.xpos.copy(),
        gaze=gaze,
        home=q,
        uav=plain.uav_qpos,
        hinge=plain.hinge_qpos[:2],
        width=width,
        height=HEIGHT_PX,
        intrinsics=pinhole(width, HEIGHT_PX, camera.field_of_view_deg[1]),
    )


def print_marker(spec: mujoco.MjSpec) -> None:
    """Print the marker on the landing scene's blank plate.

    Raises:
        ArmlandError: no OpenCV.
    """
    grey = np.maximum(marker_image(NUMBER, CELL_PX), BLACK)
    texture = spec.add_texture(
        name="marker", type=mujoco.mjtTexture.mjTEXTURE_2D, width=len(grey), height=len(grey), nchannel=3
    )
    texture.data = np.repeat(grey[..., None], 3, axis=2).tobytes()
    material = spec.add_material(name="marker", specular=0.0)
    material.textures[int(mujoco.mjtTextureRole.mjTEXROLE_RGB)] = "marker"
    spec.geom(MARKER).material = "marker"
