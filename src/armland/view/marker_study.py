"""How well the marker's pose is found in rendered images, by distance, beside the measurement model of `plant/camera.py`.

Poses are drawn at random at each distance: any heading, tilted, anywhere in the picture. Blur and noise of a real camera are
put on the rendered images. Their camera has no distortion and known intrinsics, and nothing moves: a principal point that
is off by one pixel would alone shift the marker by 0.9 mm at 1 m. So the errors are a lower bound of what the model, which
comes from a real device's figures, has to claim.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from armland.errors import PictureError
from armland.estimation.fiducial import Detection, detect
from armland.plant.camera import Camera, camera_parameters, visible
from armland.plant.noise import stream
from armland.rotations import Array, from_rotation_vector, matrix, multiply, rotation_error
from armland.view.frames import frames
from armland.view.marker_scene import EYE, build_marker_scene

DISTANCES_M = (0.13, 0.2, 0.3, 0.45, 0.65, 0.9, 1.2, 1.65, 2.2)
"""Depths of the marker: from the capture to beyond the model's largest, 1.65 m for its 60 mm."""

MARKER_SIZE_M = 0.06

TILT_MAX_DEG = 25.0
"""Largest angle between the camera's axis and the marker's normal: more than UAV and arm make of it near a capture."""

INCIDENCE_MAX_DEG = 35.0
"""Largest angle between line of sight and the marker's normal: beyond, hinge plate or skids may cover a part of it."""

FACING = np.array([0.0, 1.0, 0.0, 0.0])
"""camera<-marker of an upright marker seen face on."""

ERROR = np.dtype(
    [
        ("distance", "f8"),  # m, true depth
        ("found", "?"),
        ("position", "f8", (3,)),  # m, found minus true, camera frame
        ("rotation", "f8", (3,)),  # rad, rotation vector from the true to the found attitude, camera frame
        ("residual_px", "f8"),
        ("ambiguity", "f8"),
    ]
)


class Imaging(NamedTuple):
    """What a real camera does to a sharp image. Assumptions: an ordinary lens in focus, an industrial sensor in daylight."""

    blur_px: float = 0.7  # standard deviation of a Gaussian
    noise: float = 2.0  # standard deviation, grey levels of 255


class Row(NamedTuple):
    """Errors at one distance: root mean squares for each axis, NaN where no marker was found, and the model's claims."""

    distance_m: float
    images: int
    found: int
    lateral_m: float
    depth_m: float
    tilt_rad: float
    yaw_rad: float
    model_lateral_m: float
    model_depth_m: float
    model_tilt_rad: float
    model_yaw_rad: float


class Study(NamedTuple):
    """Errors of all images, (n,) of `ERROR`, their table, and the camera."""

    errors: NDArray[np.void]
    rows: list[Row]
    camera: Camera


def marker_study(
    distances: Sequence[float] = DISTANCES_M,
    per_distance: int = 16,
    seed: int = 0,
    imaging: Imaging | None = None,
    camera: Camera | None = None,
) -> Study:
    """Render the marker `per_distance` times at each depth of `distances`, m, find it and compare with the truth.

    Raises:
        PictureError: no OpenGL that works, or a distance at which the marker does not fit into the picture.
        ArmlandError: no OpenCV.
    """
    imaging, camera = imaging or Imaging(), camera or Camera(marker_size_m=MARKER_SIZE_M)
    scene, places, grain = build_marker_scene(camera), stream(seed, "marker poses"), stream(seed, "marker images")
    poses = [_draw_pose(z, camera, places) for z in distances for _ in range(per_distance)]
    errors = np.zeros(len(poses), ERROR)
    qpos = np.array([scene.qpos(*pose) for pose in poses])
    pictures = frames(scene.model, qpos, scene.width, scene.height, EYE)
    for error, pose, picture in zip(errors, poses, pictures, strict=True):
        _compare(detect(photographed(picture, imaging, grain), scene.size_m, scene.intrinsics), *pose, error)
    groups = errors.reshape(len(distances), per_distance)
    return Study(errors, [_row(group, camera) for group in groups], camera)


def photographed(picture: NDArray[np.uint8], imaging: Imaging, rng: np.random.Generator) -> NDArray[np.uint8]:
    """A rendered picture (h, w) or (h, w, 3) as the camera would take it."""
    image = gaussian_filter(picture.astype(np.float32), imaging.blur_px, axes=(0, 1))
    image += imaging.noise * rng.standard_normal(image.shape, np.float32)
    return np.clip(np.rint(image), 0, 255).astype(np.uint8)


def model_sigma(camera: Camera, z: float) -> tuple[float, float, float, float]:
    """The model's standard deviations at depth z, m: lateral and depth, m, tilt and yaw, rad, for each axis."""
    p, s = camera_parameters(camera, 1000)[0], camera.marker_size_m
    lateral, depth = np.hypot(p["lateral"][0], p["lateral"][1] * z), np.hypot(p["depth"][0], p["depth"][1] * z * z)
    return float(lateral), float(depth), float(2.0 * depth / s), float(np.sqrt(2.0) * lateral / s)


def _draw_pose(z: float, camera: Camera, rng: np.random.Generator) -> tuple[Array, Array]:
    p = camera_parameters(camera, 1000)[0]
    # The white margin and the blur are needed, too.
    p["marker_size"], p["depth_min"], p["depth_max"] = 1.3 * camera.marker_size_m, 0.0, np.inf
    p["cos_incidence"] = np.cos(np.deg2rad(INCIDENCE_MAX_DEG))
    for _ in range(1000):
        x, y = rng.uniform(-1.0, 1.0, 2) * z * np.array([p["half_width"], p["half_height"]])
        azimuth, tilt = rng.uniform(0.0, 2.0 * np.pi), np.deg2rad(TILT_MAX_DEG) * np.sqrt(rng.uniform())
        tilted = from_rotation_vector(tilt * np.array([np.cos(azimuth), np.sin(azimuth), 0.0]))
        turned = from_rotation_vector(np.array([0.0, 0.0, rng.uniform(-np.pi, np.pi)]))
        position, quat = np.array([x, y, z]), multiply(tilted, multiply(turned, FACING))
        if visible(position, matrix(quat), p):
            return position, quat
    nearest = 0.75 * 1.3 * camera.marker_size_m / p["half_height"]
    raise PictureError(f"at {z:g} m the marker does not fit into the picture; it does from about {nearest:.2g} m on")


def _compare(seen: list[Detection], position: Array, quat: Array, error: np.void) -> None:
    error["distance"], error["found"] = position[2], bool(seen)
    if seen:
        error["position"] = seen[0].position - position
        error["rotation"] = rotation_error(matrix(quat), matrix(seen[0].quat))
        error["residual_px"], error["ambiguity"] = seen[0].residual_px, seen[0].ambiguity


def _row(errors: NDArray[np.void], camera: Camera) -> Row:
    z, found = float(errors["distance"][0]), errors[errors["found"]]
    e, r = found["position"], found["rotation"]
    rms = (float(np.sqrt(np.mean(x**2))) if len(found) else np.nan for x in (e[:, :2], e[:, 2], r[:, :2], r[:, 2]))
    return Row._make((z, len(errors), len(found), *rms, *model_sigma(camera, z)))
