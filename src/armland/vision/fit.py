"""The coefficients of `armland.plant.devices.detector_errors` from rendered pictures, by least squares.

A law σ₁ z^k is a line in logarithms: ln σ = ln σ₁ + k ln z, through the root mean square of each distance. The two laws of loss are
logistic regressions, by Newton's method with a light ridge, so that pictures which part cleanly leave finite coefficients.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from armland.plant.devices.detector_errors import DetectorErrors, PowerLaw
from armland.plant.noise import stream
from armland.rotations import Array
from armland.scenario.sensing import Camera
from armland.vision.fiducial import CELLS, detect
from armland.vision.frames import frames
from armland.vision.imaging import Imaging, Motion, photographed, smear_px
from armland.vision.scene import EYE, MarkerScene, build_marker_scene
from armland.vision.study import draw_motion, marker_study

FIT_DISTANCES_M = (0.13, 0.16, 0.2, 0.25, 0.3, 0.38, 0.48, 0.6, 0.75, 0.95, 1.2, 1.5)

FAR_M = 4.5  # Largest distance of the pictures of loss: there a cell has 1.8 px

SMEAR_CELLS = 3.0
"""Largest smear of the pictures of loss, in cells of the marker, of which half are drawn from; the others are at rest."""

SMEAR_PX = 30.0  # And in pixels: beyond, nothing is found anyway

RIDGE = 1e-3


def fit_detector(per_distance: int = 24, losses: int = 400, seed: int = 1) -> DetectorErrors:
    """Render, detect and fit; some 700 pictures.

    Raises:
        PictureError: no OpenGL that works.
        ArmlandError: no OpenCV.
    """
    scene = build_marker_scene()
    study = marker_study(FIT_DISTANCES_M, per_distance, seed, scene=scene)
    smeared, small = loss_laws(*loss_study(losses, seed, scene=scene))
    return DetectorErrors(*error_laws(study.grain), smeared, small)


def error_laws(errors: NDArray[np.void]) -> tuple[PowerLaw, PowerLaw, PowerLaw, PowerLaw]:
    """Laws of lateral, depth, tilt and yaw through `errors` (n,) of `ERROR`; distances at which nothing was found are left out."""
    found = errors[errors["found"]]
    z = np.unique(found["distance"])
    parts = (
        (found["position"], slice(0, 2)),
        (found["position"], slice(2, 3)),
        (found["rotation"], slice(0, 2)),
        (found["rotation"], slice(2, 3)),
    )
    laws = []
    for values, axes in parts:
        rms = [np.sqrt(np.mean(values[found["distance"] == d][:, axes] ** 2)) for d in z]
        A = np.column_stack([np.ones(len(z)), np.log(z)])
        (intercept, power), *_ = np.linalg.lstsq(A, np.log(rms), rcond=None)
        laws.append(PowerLaw(float(np.exp(intercept)), float(power)))
    return laws[0], laws[1], laws[2], laws[3]


def loss_study(images: int, seed: int, scene: MarkerScene | None = None) -> tuple[NDArray[np.bool_], Array, Array]:
    """Pictures far and near, still and smeared: was the marker found (n,), width of its cells (n,) px, smear (n,) px."""
    # Enough steps that a smear is no row of ghosts.
    imaging, scene = Imaging(substeps=25), scene or build_marker_scene()
    places, grain, k = stream(seed, "loss poses"), stream(seed, "loss images"), scene.intrinsics
    camera = Camera(marker_size_m=scene.size_m)
    motions = [_draw(scene, camera, imaging, i % 2 == 0, places) for i in range(images)]
    pictures = frames(scene.model, [scene.qpos(m.position, m.quat) for m in motions], scene.width, scene.height, EYE)
    found = [
        bool(detect(photographed(picture, k, m, imaging, grain), scene.size_m, k))
        for m, picture in zip(motions, pictures, strict=True)
    ]
    cell = np.array([k.fx * scene.size_m / CELLS / m.position[2] for m in motions])
    return np.array(found), cell, np.array([smear_px(imaging, k, m) for m in motions])


def loss_laws(
    found: NDArray[np.bool_], cell: Array, smear: Array
) -> tuple[tuple[float, float, float], tuple[float, float]]:
    """(b₀, b₁, b₂) of smeared and (a₀, a₁) of small markers."""
    still = smear < 0.1 * cell
    a = logistic(np.column_stack([np.ones(still.sum()), np.log(cell[still])]), ~found[still])
    # What is too small at rest says nothing about smear.
    large = cell > 4.0
    b = logistic(np.column_stack([np.ones(large.sum()), smear[large] / cell[large], smear[large]]), ~found[large])
    return (float(b[0]), float(b[1]), float(b[2])), (float(a[0]), float(a[1]))


def logistic(X: NDArray[Any], y: NDArray[np.bool_]) -> Array:
    """Coefficients w (k,) of P(y) = 1/(1 + exp(−X w)), X (n, k), by Newton's method."""
    w = np.zeros(X.shape[1])
    for _ in range(50):
        p = 1.0 / (1.0 + np.exp(-np.clip(X @ w, -30.0, 30.0)))
        H = X.T @ ((p * (1.0 - p))[:, None] * X) + RIDGE * np.eye(len(w))
        step = np.linalg.solve(H, X.T @ (y - p) - RIDGE * w)
        # Full steps overshoot where the pictures part cleanly.
        w = w + step * min(1.0, 2.0 / float(np.abs(step).max() + 1e-12))
    return w


def _draw(scene: MarkerScene, camera: Camera, imaging: Imaging, still: bool, rng: np.random.Generator) -> Motion:
    z = float(np.exp(rng.uniform(np.log(0.15), np.log(FAR_M))))
    motion = draw_motion(z, camera, rng)
    cell = scene.intrinsics.fx * scene.size_m / CELLS / z
    wanted = 0.0 if still else rng.uniform() * min(SMEAR_CELLS * cell, SMEAR_PX)
    heading = rng.uniform(0.0, 2.0 * np.pi)
    speed = wanted * z / (scene.intrinsics.fx * imaging.exposure_s)
    return motion._replace(velocity=speed * np.array([np.cos(heading), np.sin(heading), 0.0]), omega=np.zeros(3))
