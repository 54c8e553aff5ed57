"""Rotation from the UAV's attitude reference to the deck's axes: small, drifting, estimated from attitudes seen; compiled.

| symbol | name | unit, frame |
|---|---|---|
| δ | `quat` (4,): q_wb = δ ⊗ q_imu | 1 |
| θ | error of δ, a rotation vector: q_wb = exp(θ) ⊗ δ ⊗ q_imu, a random walk | rad, D |
| P | `P` (3, 3), covariance of θ | rad² |

The UAV knows roll and pitch from gravity, but hardly its heading, and its gyros drift. δ changes slowly, so a late sample tells of the
present δ as well as of the one at its capture.
"""

import numpy as np
from numba import njit

from armland.estimation.plate import late_fusion
from armland.records import Record
from armland.rotations import Array, conjugate, from_rotation_vector, multiply, sgn

TILT_MAX = 0.1
"""Roll and pitch that a UAV may get wrong, rad: beyond, the camera is believed less than gravity."""

ALIGNMENT = np.dtype([("quat", "f8", (4,)), ("P", "f8", (3, 3)), ("tick", "i8")])


@njit(cache=True)
def begin(a: Record, tick: int, seen: Array, reported: Array, tilt: float, heading: float) -> None:
    """Take the heading from what was seen, roll and pitch from the UAV, which knows them better than one image.

    Args:
        a: `ALIGNMENT`, written.
        tick: of both attitudes.
        seen: attitude (4,), scalar first, D<-B, from the camera.
        reported: attitude (4,), scalar first, by the UAV.
        tilt: standard deviation of the UAV's roll and pitch, rad.
        heading: standard deviation of the heading that was seen, rad.
    """
    e = multiply(seen, conjugate(reported))
    length = np.sqrt(e[0] ** 2 + e[3] ** 2)
    P = np.zeros((3, 3))
    P[0, 0], P[1, 1], P[2, 2] = tilt**2, tilt**2, heading**2
    _set(a, np.array([e[0] / length, 0.0, 0.0, e[3] / length]), P)
    a.tick = tick


@njit(cache=True)
def covariance(a: Record, seconds: float, walk: float) -> Array:
    """P (3, 3), rad², `seconds` after the last sample; `walk` in rad/√s."""
    P = a.P.copy()
    for i in range(3):
        P[i, i] += walk**2 * max(seconds, 0.0)
    return P


@njit(cache=True)
def residual(seen: Array, believed: Array) -> Array:
    """θ (3,), rad, D, between two attitudes that differ by little.

    Args:
        seen: (4,), scalar first, D<-B.
        believed: q_wb (4,), scalar first, D<-B.
    """
    e = multiply(seen, conjugate(believed))
    twice = 2.0 * sgn(e[0])
    return np.array([twice * e[1], twice * e[2], twice * e[3]])


@njit(cache=True)
def correct(a: Record, tick: int, theta: Array, R: Array, walk: float, gate: float, tick_s: float) -> float:
    """Fuse the residual θ seen at `tick`, unless its distance exceeds `gate`.

    Args:
        a: `ALIGNMENT`, updated.
        tick: at which it was seen.
        theta: θ (3,), rad, D.
        R: its covariance (3, 3), rad².
        walk: rad/√s.
        gate: largest squared Mahalanobis distance that is believed.
        tick_s: s.

    Returns:
        Its squared Mahalanobis distance, χ² with 3 degrees of freedom.
    """
    P, missing = covariance(a, (tick - a.tick) * tick_s, walk), np.zeros(3)
    distance = late_fusion.correct(missing, P, theta, R, gate)
    if distance <= gate:
        _set(a, _upright(multiply(from_rotation_vector(missing), a.quat)), P)
        a.tick = max(a.tick, tick)
    return distance


@njit(cache=True)
def _upright(quat: Array) -> Array:
    # δ (4,) with no more tilt than `TILT_MAX`: a camera that takes the second solution of a marker's pose does not turn the world over.
    half = np.sqrt(quat[1] ** 2 + quat[2] ** 2)
    if half <= 0.5 * TILT_MAX:
        return quat
    out, size = quat.copy(), 0.0
    for i in (1, 2):
        out[i] *= 0.5 * TILT_MAX / half
    for i in range(4):
        size += out[i] ** 2
    return out / np.sqrt(size)


@njit(cache=True)
def _set(a: Record, quat: Array, P: Array) -> None:
    for i in range(4):
        a.quat[i] = quat[i]
    for i in range(3):
        for k in range(3):
            a.P[i, k] = P[i, k]
