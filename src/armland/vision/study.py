"""How well the marker's pose is found in pictures of the landing's own scene, by distance: ideal pictures, and honest ones.

Poses are drawn at random at each distance: any heading, tilted, anywhere in the picture; the marker moves while the shutter
is open; every honest picture is of another camera, as calibrations leave them. Each honest picture is judged twice: with
the intrinsics that the calibration believes (`honest`), and with the true ones (`grain`), which leaves what differs from picture
to picture. The former is what a landing gets, the latter is what `marker_fit` takes for noise.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.errors import PictureError
from armland.plant.devices.camera import visible
from armland.plant.devices.camera_numbers import camera_told
from armland.plant.noise import stream
from armland.rotations import from_rotation_vector, matrix, multiply, rotation_error
from armland.scenario.sensing import Camera
from armland.vision.fiducial import Detection, Intrinsics, detect, relocated
from armland.vision.frames import frames
from armland.vision.imaging import IDEAL, Calibration, Imaging, Motion, draw_unit, photographed, smear_px
from armland.vision.scene import EYE, MarkerScene, build_marker_scene

DISTANCES_M = (0.13, 0.2, 0.3, 0.45, 0.65, 0.9, 1.2, 1.65, 2.2)
"""Depths of the marker: from the capture to beyond the model's largest, 1.65 m for its 60 mm."""

TILT_MAX_DEG = 25.0
"""Largest angle between the camera's axis and the marker's normal: more than UAV and arm make of it near a capture."""

SWEEP_RAD_S = 0.3
"""Standard deviation of the rate at which the line of sight turns, each axis, about twice that of landings in calm air."""

SPEED_MPS = 0.15
"""Largest standard deviation of the relative velocity, each axis: about twice that of landings in calm air."""

SPIN_RAD_S = 0.15
"""Standard deviation of the marker's angular velocity, each axis."""

FACING = np.array([0.0, 1.0, 0.0, 0.0])
"""camera<-marker of an upright marker seen face on."""

ERROR = np.dtype(
    [
        ("distance", "f8"),  # m, true depth
        ("tilt", "f8"),  # rad, between optical axis and the marker's normal
        ("smear", "f8"),  # px, path of the marker during the exposure
        ("found", "?"),
        ("position", "f8", (3,)),  # m, found minus true, camera frame
        ("rotation", "f8", (3,)),  # rad, rotation vector from the true to the found attitude, camera frame
        ("residual_px", "f8"),
        ("ambiguity", "f8"),
    ]
)


class Study(NamedTuple):
    """Errors of all pictures, (n,) of `ERROR` each, and the camera's settings."""

    ideal: NDArray[np.void]
    honest: NDArray[np.void]
    grain: NDArray[np.void]  # the honest pictures with intrinsics free of error
    motions: list[Motion]
    camera: Camera
    per_distance: int


def marker_study(
    distances: Sequence[float] = DISTANCES_M,
    per_distance: int = 16,
    seed: int = 0,
    imaging: Imaging | None = None,
    calibration: Calibration | None = None,
    scene: MarkerScene | None = None,
) -> Study:
    """Render the marker `per_distance` times at each depth of `distances`, m, find it and compare with the truth.

    Raises:
        PictureError: no OpenGL that works, or a distance at which the marker does not fit into the picture.
        ArmlandError: no OpenCV.
    """
    imaging, calibration, scene = imaging or Imaging(), calibration or Calibration(), scene or build_marker_scene()
    camera = Camera(marker_size_m=scene.size_m)
    places, grain = stream(seed, "marker poses"), stream(seed, "marker images")
    motions = [draw_motion(z, camera, places) for z in distances for _ in range(per_distance)]
    ideal, honest, known = (np.zeros(len(motions), ERROR) for _ in range(3))
    study = Study(ideal, honest, known, motions, camera, per_distance)
    qpos = np.array([scene.qpos(m.position, m.quat) for m in motions])
    pictures = frames(scene.model, qpos, scene.width, scene.height, EYE)
    for i, (motion, picture) in enumerate(zip(motions, pictures, strict=True)):
        sharp = photographed(picture, scene.intrinsics, motion, IDEAL, grain)
        _compare(detect(sharp, scene.size_m, scene.intrinsics), motion, 0.0, study.ideal[i])
        unit = draw_unit(scene.intrinsics, calibration, grain)
        image = photographed(picture, scene.intrinsics, motion, imaging, grain, unit.k1)
        seen, smear = detect(image, scene.size_m, scene.intrinsics), smear_px(imaging, scene.intrinsics, motion)
        _compare(seen, motion, smear, study.grain[i])
        _compare(_again(seen, scene.size_m, unit.believed), motion, smear, study.honest[i])
    return study


def draw_motion(z: float, camera: Camera, rng: np.random.Generator) -> Motion:
    """A marker at depth z m somewhere in the picture, tilted, and moving.

    Raises:
        PictureError: so near it does not fit into the picture.
    """
    p = camera_told(camera, 1000)[0]
    # The white margin and the blur are needed, too.
    p["marker_size"], p["depth_min"], p["depth_max"] = 1.3 * camera.marker_size_m, 0.0, np.inf
    for _ in range(1000):
        x, y = rng.uniform(-1.0, 1.0, 2) * z * np.array([p["half_width"], p["half_height"]])
        # Face on as often as at the largest tilt: face on it is hardest to tell, and seen most in a landing.
        azimuth, tilt = rng.uniform(0.0, 2.0 * np.pi), np.deg2rad(TILT_MAX_DEG) * rng.uniform()
        tilted = from_rotation_vector(tilt * np.array([np.cos(azimuth), np.sin(azimuth), 0.0]))
        turned = from_rotation_vector(np.array([0.0, 0.0, rng.uniform(-np.pi, np.pi)]))
        position, quat = np.array([x, y, z]), multiply(tilted, multiply(turned, FACING))
        if visible(position, matrix(quat), p):
            speed = min(SWEEP_RAD_S * z, SPEED_MPS)
            return Motion(position, quat, speed * rng.standard_normal(3), SPIN_RAD_S * rng.standard_normal(3))
    nearest = 0.75 * 1.3 * camera.marker_size_m / p["half_height"]
    raise PictureError(f"at {z:g} m the marker does not fit into the picture; it does from about {nearest:.2g} m on")


def _again(seen: list[Detection], size_m: float, believed: Intrinsics) -> list[Detection]:
    again = (relocated(d, size_m, believed) for d in seen)
    return [d for d in again if d is not None]


def _compare(seen: list[Detection], motion: Motion, smear: float, error: np.void) -> None:
    R = matrix(motion.quat)
    error["distance"], error["smear"], error["found"] = motion.position[2], smear, bool(seen)
    error["tilt"] = np.arccos(np.clip(-R[2, 2], -1.0, 1.0))
    if seen:
        error["position"] = seen[0].position - motion.position
        error["rotation"] = rotation_error(R, matrix(seen[0].quat))
        error["residual_px"], error["ambiguity"] = seen[0].residual_px, seen[0].ambiguity
