"""The marker study as a table: errors by distance of the detector, of the measurement model, and as published."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.mission.landing_scenario import Imperfections
from armland.plant.camera import NOISE_WIDTH, SAMPLE, STATE, Camera, camera_parameters, observe
from armland.plant.noise import stream
from armland.rotations import Array, matrix, rotation_error
from armland.view.marker_imaging import Motion
from armland.view.marker_study import ERROR, Study

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
    p = camera_parameters(camera, 1000)[0]
    return float(np.hypot(p["lateral"][0], p["lateral"][1] * z)), float(np.hypot(p["depth"][0], p["depth"][1] * z * z))


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
    for k, error in enumerate(errors):
        u, angle = rng.uniform(-1.0, 1.0, 6), np.deg2rad(bad.camera_angle_deg)
        shift = tuple((bad.camera_mount_m * u[:3]).tolist())
        one = camera._replace(shift_m=shift, slope=(angle * u[3], angle * u[4], bad.camera_scale * u[5]))
        _model_error(motions[k // draws], one, rng.standard_normal((2, NOISE_WIDTH)), error)
    return errors


def _model_error(motion: Motion, camera: Camera, noise: Array, error: np.void) -> None:
    # Two exposures a millisecond apart: the model takes the smear from the way between them.
    p = camera_parameters(camera._replace(rate_hz=1000, delay_ms=(0.0, 0.0), lose=0.0), 1000)
    s, sample = np.zeros(1, STATE), np.zeros(1, SAMPLE)
    observe(0, ORIGIN, LEVEL, motion.position - 1e-3 * motion.velocity, motion.quat, noise[0], False, p, s, sample)
    p["lose"], s["lost"] = camera.lose / (1.0 + camera.lose - camera.stay_lost), 0
    observe(1, ORIGIN, LEVEL, motion.position, motion.quat, noise[1], False, p, s, sample)
    error["distance"], error["found"] = motion.position[2], bool(sample["fresh"][0])
    if error["found"]:
        error["position"] = sample["position"][0] - motion.position
        error["rotation"] = rotation_error(matrix(motion.quat), matrix(sample["quat"][0]))
