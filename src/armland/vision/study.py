"""How well the marker's pose is found in pictures of the landing's own scene, by distance: ideal pictures, and honest ones.

Poses are drawn at random at each distance: any heading, tilted, anywhere in the picture; the marker moves while the shutter
is open; every honest picture is of another camera, as calibrations leave them. Each honest picture is judged twice: with
the intrinsics that the calibration believes (`honest`), and with the true ones (`grain`), which leaves what differs from picture
to picture. The former is what a landing gets, the latter is what `fit.error_laws` takes for noise.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.errors import PictureError
from armland.plant.devices.camera import observe, visible
from armland.plant.devices.camera_numbers import camera_told, kept_layout, noise_through, well
from armland.plant.noise import CAMERA_WIDTH, stream
from armland.rotations import Array, from_rotation_vector, matrix, multiply, rotation_error
from armland.scenario.sensing import Camera, Imperfections
from armland.vision.fiducial import Detection, detect, relocated
from armland.vision.frames import frames
from armland.vision.imaging import IDEAL, Calibration, Imaging, Motion, draw_unit, photographed
from armland.vision.scene import EYE, MarkerScene, build_marker_scene

DISTANCES_M = (0.13, 0.2, 0.3, 0.45, 0.65, 0.9, 1.2, 1.65, 2.2)
"""Depths of the marker: from the capture to beyond the model's largest, 1.65 m for its 60 mm."""

TILT_MAX_DEG = 25.0
"""Largest angle between the camera's axis and the marker's normal: more than UAV and arm make of it near a capture."""

SWEEP_RAD_S = 0.3
"""Standard deviation of the rate at which the line of sight turns, each axis, about twice that of landings in calm air."""

SPEED_MPS = 0.15
"""Largest standard deviation of the relative velocity, each axis: about twice that of landings in calm air."""

SPIN_RAD_S = 0.15  # Standard deviation of the marker's angular velocity, each axis
FACING = np.array([0.0, 1.0, 0.0, 0.0])  # camera<-marker of an upright marker seen face on

ERROR = np.dtype(
    [
        ("distance", "f8"),  # m, true depth
        ("found", "?"),
        ("position", "f8", (3,)),  # m, found minus true, camera frame
        ("rotation", "f8", (3,)),  # rad, rotation vector from the true to the found attitude, camera frame
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
        _compare(detect(sharp, scene.size_m, scene.intrinsics), motion, study.ideal[i])
        unit = draw_unit(scene.intrinsics, calibration, grain)
        image = photographed(picture, scene.intrinsics, motion, imaging, grain, unit.k1)
        seen = detect(image, scene.size_m, scene.intrinsics)
        again = (relocated(d, scene.size_m, unit.believed) for d in seen)
        _compare(seen, motion, study.grain[i])
        _compare([d for d in again if d is not None], motion, study.honest[i])
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


def _compare(seen: list[Detection], motion: Motion, error: np.void) -> None:
    error["distance"], error["found"] = motion.position[2], bool(seen)
    if seen:
        error["position"] = seen[0].position - motion.position
        error["rotation"] = rotation_error(matrix(motion.quat), matrix(seen[0].quat))


DRAWS = 40  # Samples of the measurement model for each picture of the study

ORIGIN, LEVEL = np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0])


class Errors(NamedTuple):
    """Root mean squares for each axis and the share of pictures in which the marker was found; NaN where it never was."""

    found: float
    lateral_m: float
    depth_m: float
    tilt_rad: float
    yaw_rad: float


class Row(NamedTuple):
    """One distance."""

    distance_m: float
    images: int
    ideal: Errors
    honest: Errors
    model: Errors
    published_lateral_m: float
    published_depth_m: float


def rows(study: Study, draws: int = DRAWS) -> list[Row]:
    """The study's table; the model is asked for the very poses of the pictures, with mountings drawn as a landing draws them."""
    n, table = study.per_distance, []
    for i in range(0, len(study.ideal), n):
        part = slice(i, i + n)
        z = float(study.ideal["distance"][i])
        modelled = model_errors(study.motions[part], study.camera, draws, seed=i)
        three = (errors_of(study.ideal[part]), errors_of(study.honest[part]), errors_of(modelled))
        table.append(Row(z, n, *three, *published(study.camera, z)))
    return table


def published(camera: Camera, z: float) -> tuple[float, float]:
    """Lateral and depth standard deviation, m, at depth z m, through the two published points."""
    lateral = noise_through(camera.reference_m, camera.lateral_m, 1)
    depth = noise_through(camera.reference_m, camera.depth_m, 2)
    return float(np.hypot(lateral[0], lateral[1] * z)), float(np.hypot(depth[0], depth[1] * z * z))


def errors_of(errors: NDArray[np.void]) -> Errors:
    """Root mean squares of `errors` (n,) of `ERROR`."""
    found = errors[errors["found"]]
    e, r = found["position"], found["rotation"]
    rms = (float(np.sqrt(np.mean(x**2))) if len(found) else np.nan for x in (e[:, :2], e[:, 2], r[:, :2], r[:, 2]))
    return Errors(len(found) / max(len(errors), 1), *rms)


def model_errors(motions: list[Motion], camera: Camera, draws: int, seed: int = 0) -> NDArray[np.void]:
    """Errors (n·draws,) of `ERROR` of the measurement model at each of the motions."""
    bad, rng = Imperfections(), stream(seed, "model errors")
    errors = np.zeros(len(motions) * draws, ERROR)
    # Two exposures a millisecond apart: the model takes the smear from the path between them.
    told = camera_told(camera.model_copy(update={"rate_hz": 1000, "delay_ms": (0.0, 0.0)}), 1000)
    for k, error in enumerate(errors):
        u, angle = rng.uniform(-1.0, 1.0, 6), np.deg2rad(bad.camera_angle_deg)
        told["shift"], told["slope"] = bad.camera_mount_m * u[:3], (angle * u[3], angle * u[4], bad.camera_scale * u[5])
        _model_error(motions[k // draws], camera, told, rng.standard_normal((2, CAMERA_WIDTH)), error)
    return errors


def _model_error(motion: Motion, camera: Camera, told: NDArray[np.void], noise: Array, error: np.void) -> None:
    kept, errors = np.zeros(1, kept_layout(0)), well()
    kept["eye"], kept["eye_quat"], kept["mark_quat"] = ORIGIN, LEVEL, motion.quat
    told["lose"], kept["mark"] = 0.0, motion.position - 1e-3 * motion.velocity
    observe(0, noise[0], errors[0], told[0], kept[0])
    told["lose"], kept["lost"] = camera.lose / (1.0 + camera.lose - camera.stay_lost), 0
    kept["mark"] = motion.position
    observe(1, noise[1], errors[0], told[0], kept[0])
    sample = kept["sample"][0]
    error["distance"], error["found"] = motion.position[2], bool(sample["fresh"])
    if error["found"]:
        error["position"] = sample["position"] - motion.position
        error["rotation"] = rotation_error(matrix(motion.quat), matrix(sample["quat"]))
