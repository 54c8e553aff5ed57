"""The UAV's underside with a printed marker, and a camera that can be put anywhere before it.

The camera is on a free joint, so that its pose is part of `qpos`, and looks along its body's z, as at the end effector.
"""

from typing import NamedTuple

import mujoco
import numpy as np

from armland.estimation.fiducial import CELLS, Intrinsics, marker_image, pinhole
from armland.models.description import compile_spec, read_spec, resolve
from armland.plant.camera import Camera
from armland.plant.landing_scene import LandingGear, _add_skids
from armland.plant.magnet import hang_plate
from armland.plant.scene import UAV, _add_surroundings
from armland.rotations import Array, conjugate, matrix, multiply

HEIGHT_PX = 960
"""Of a picture; its width follows from the field of view, as pixels are square. The rc_visard's, as the measurement model."""

EYE = "eye"
"""Name of the camera."""

MARKER = 7
"""Number of the marker on the UAV, any of the family."""

OPEN_M = (0.0, 0.09, -0.03)
"""Centre of mass to the marker's centre, m, body: hinge plate, skids and legs leave it in view up to a tilt of 35 degrees."""

ABOVE_M = 5.0
"""Height of the UAV: the camera below it stays above the floor."""

CELL_PX = 32
"""Texture pixels along a cell of the marker."""


class MarkerScene(NamedTuple):
    """A compiled scene and where its marker is."""

    model: mujoco.MjModel
    size_m: float  # edge of the marker's black square
    position: Array  # (3,) m, marker's centre, world
    quat: Array  # (4,) world<-marker
    width: int  # px, of a picture
    height: int
    intrinsics: Intrinsics

    def qpos(self, position: Array, quat: Array) -> Array:
        """qpos (nq,) with the camera so that it sees the marker at `position` (3,), m, and `quat` (4,), camera<-marker."""
        q_wc = multiply(self.quat, conjugate(quat))
        q = self.model.qpos0.copy()
        q[-7:] = np.concatenate([self.position - matrix(q_wc) @ position, q_wc])
        return q


def build_marker_scene(
    camera: Camera | None = None, place: tuple[float, float, float] = OPEN_M, gear: LandingGear | None = None
) -> MarkerScene:
    """Compose and compile the UAV with hinge plate, skids and marker, fixed level in the air, and the camera.

    Args:
        camera: field of view and marker size.
        place: centre of mass to the marker's centre (3,), m, body; the marker looks down.
        gear: hinge plate and skids, which may stand before the marker.

    Raises:
        ArmlandError: no OpenCV to print the marker.
    """
    camera, gear = camera or Camera(), gear or LandingGear()
    spec = mujoco.MjSpec()
    _add_surroundings(spec)
    uav = read_spec(resolve("ardrone2.xml"), "UAV file")
    body = uav.body("uav")
    body.pos = [0.0, 0.0, ABOVE_M]
    pivot = next(s for s in uav.sites if s.name == "pivot").pos.copy()
    _add_skids(body, gear.skids)
    hang_plate(body, pivot, gear.plate, uav.compiler.degree)
    spec.worldbody.add_frame().attach_body(body, UAV, "")
    centre = np.array(place) + [0.0, 0.0, ABOVE_M]
    _add_marker(spec, centre, camera.marker_size_m)
    _add_camera(spec, camera.field_of_view_deg[1])
    half = np.tan(0.5 * np.deg2rad(camera.field_of_view_deg))
    width = 2 * round(0.5 * HEIGHT_PX * half[0] / half[1])
    return MarkerScene(
        model=compile_spec(spec, "the marker's scene"),
        size_m=camera.marker_size_m,
        position=centre,
        quat=np.array([0.0, 1.0, 0.0, 0.0]),
        width=width,
        height=HEIGHT_PX,
        intrinsics=pinhole(width, HEIGHT_PX, camera.field_of_view_deg[1]),
    )


def _add_marker(spec: mujoco.MjSpec, centre: Array, size_m: float) -> None:
    grey = marker_image(MARKER, CELL_PX)
    texture = spec.add_texture(
        name="marker", type=mujoco.mjtTexture.mjTEXTURE_2D, width=len(grey), height=len(grey), nchannel=3
    )
    texture.data = np.repeat(grey[..., None], 3, axis=2).tobytes()
    material = spec.add_material(name="marker", specular=0.0)
    material.textures[int(mujoco.mjtTextureRole.mjTEXROLE_RGB)] = "marker"
    edge = 0.5 * size_m * (CELLS + 2) / CELLS
    # The face that is seen has the marker in its plane.
    thin = 0.0005
    box = {"type": mujoco.mjtGeom.mjGEOM_BOX, "size": [edge, edge, thin], "quat": [0.0, 1.0, 0.0, 0.0]}
    spec.worldbody.add_geom(name="marker", pos=centre + [0.0, 0.0, thin], material="marker", group=2, **box)


def _add_camera(spec: mujoco.MjSpec, fovy_deg: float) -> None:
    body = spec.worldbody.add_body(name=EYE, mass=1.0, inertia=[1.0, 1.0, 1.0])
    body.explicitinertial = True
    body.add_freejoint(name=EYE)
    # MuJoCo's cameras look along their -z, with y up; armland's along +z, with y down.
    body.add_camera(name=EYE, quat=[0.0, 1.0, 0.0, 0.0], fovy=fovy_deg)
