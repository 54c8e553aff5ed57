"""Errors of the marker detector on honest pictures, fitted: what the camera's measurement model may not undercut.

| law | for |
|---|---|
| σ(z) = σ₁ (z / 1 m)^k, marker of `SIZE_M` | lateral, depth, m; tilt, yaw, rad; standard deviation for each axis |
| σ_s(z) = (s/s₀) σ(z s₀/s) for positions, σ(z s₀/s) for angles | marker of size s: the same picture at another scale |
| P(lost) = 1/(1 + exp(−(b₀ + b₁ w/c + b₂ w))) | picture smeared by w px, cells of the marker c px wide |
| P(lost) = 1/(1 + exp(−(a₀ + a₁ ln c))) | picture at rest: a cell is hard to read where it is small |

Source: `armland detector --fit`, which renders the landing's scene, spoils the pictures (`armland.vision.imaging`), runs
`armland.vision.fiducial` and prints the numbers below; calibration errors are left out of them (they are a bias:
`imperfections.camera_mount_m`, `camera_angle_deg`).

Valid from 0.13 m to 1.5 m, tilts up to 25 degrees, 1078 px of focal length, exposures of 4 ms.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from armland.records import Record
from armland.rotations import Array, multiply

SIZE_M = 0.06
"""Marker of the fit."""


class PowerLaw(NamedTuple):
    """σ₁ at 1 m and exponent k."""

    at_1m: float
    power: float


class DetectorErrors(NamedTuple):
    """The fitted numbers."""

    lateral: PowerLaw
    depth: PowerLaw
    tilt: PowerLaw
    yaw: PowerLaw
    smeared: tuple[float, float, float]
    small: tuple[float, float]


DETECTOR = DetectorErrors(
    lateral=PowerLaw(1.10e-4, 2.38),
    depth=PowerLaw(4.73e-4, 1.91),
    tilt=PowerLaw(3.85e-3, 1.56),
    yaw=PowerLaw(9.76e-4, 1.64),
    smeared=(-13.5, 3.09, 0.882),
    small=(25.7, -32.5),
)
"""288 pictures for the errors, 400 for the losses, seed 1."""


@njit(cache=True)
def claim(z: float, p: Record, sigma: Array) -> None:
    """Fill `sigma` (6,): standard deviations at depth z m, position m and rotation rad, camera axes."""
    scale = p.marker_size / SIZE_M
    lateral = np.sqrt(p.lateral[0] ** 2 + (p.lateral[1] * z) ** 2)
    depth = np.sqrt(p.depth[0] ** 2 + (p.depth[1] * z * z) ** 2)
    tilt, yaw = 2.0 * depth / p.marker_size, np.sqrt(2.0) * lateral / p.marker_size
    d = p.detector
    sigma[0] = sigma[1] = max(lateral, scale * d[0, 0] * (z / scale) ** d[0, 1])
    sigma[2] = max(depth, scale * d[1, 0] * (z / scale) ** d[1, 1])
    sigma[3] = sigma[4] = max(tilt, d[2, 0] * (z / scale) ** d[2, 1])
    sigma[5] = max(yaw, d[3, 0] * (z / scale) ** d[3, 1])


@njit(cache=True)
def loss(smear: float, cell: float, b: Array) -> float:
    """Probability that an image shows no marker to the detector; 0 at rest.

    Args:
        smear: w, px.
        cell: c, px.
        b: (3,): b₀, b₁ and b₂, 1, 1 and 1/px.
    """
    rest = 1.0 / (1.0 + np.exp(-b[0]))
    moved = 1.0 / (1.0 + np.exp(-(b[0] + b[1] * smear / cell + b[2] * smear)))
    return float((moved - rest) / (1.0 - rest))


@njit(cache=True)
def second_pose(offset: Array, quat: Array) -> Array:
    """The other attitude (4,) that makes nearly the same picture of a planar marker: mirrored about the line of sight.

    Far from the camera, a picture shows p - l (l·p) of each point p of the marker, l being the line of sight; with depths of the
    other sign it is the same. So R' = S R diag(1, 1, -1) with S = 1 - 2 l lᵀ, which is a half turn about l after one about the
    marker's normal. Source: T. Collins, A. Bartoli, "Infinitesimal plane-based pose estimation", IJCV 109 (2014).

    Args:
        offset: marker's centre (3,), m, camera frame, not at its origin.
        quat: its attitude (4,), a unit quaternion, camera<-marker.
    """
    distance = np.sqrt(offset[0] ** 2 + offset[1] ** 2 + offset[2] ** 2)
    about_sight = np.array([0.0, offset[0] / distance, offset[1] / distance, offset[2] / distance])
    about_normal = np.array([0.0, 0.0, 0.0, 1.0])
    return multiply(about_sight, multiply(quat, about_normal))
