"""The marker study as a table: errors by distance of the detector, of the measurement model, and as published."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.plant.devices.camera import observe
from armland.plant.devices.camera_numbers import camera_told, kept_layout, noise_through
from armland.plant.noise import CAMERA_WIDTH, stream
from armland.rotations import Array, matrix, rotation_error
from armland.scenario.sensing import Camera, Imperfections
from armland.vision.imaging import Motion
from armland.vision.study import ERROR, Study

DRAWS = 40
"""Samples of the measurement model for each picture of the study."""

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
    kept = np.zeros(1, kept_layout(0))
    kept["eye"], kept["eye_quat"], kept["mark_quat"] = ORIGIN, LEVEL, motion.quat
    told["lose"], kept["mark"] = 0.0, motion.position - 1e-3 * motion.velocity
    observe(0, noise[0], False, told[0], kept[0])
    told["lose"], kept["lost"] = camera.lose / (1.0 + camera.lose - camera.stay_lost), 0
    kept["mark"] = motion.position
    observe(1, noise[1], False, told[0], kept[0])
    sample = kept["sample"][0]
    error["distance"], error["found"] = motion.position[2], bool(sample["fresh"])
    if error["found"]:
        error["position"] = sample["position"] - motion.position
        error["rotation"] = rotation_error(matrix(motion.quat), matrix(sample["quat"]))
