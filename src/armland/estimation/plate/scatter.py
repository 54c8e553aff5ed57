"""What the differences of consecutive innovations say of the camera's noise, and their sum of the UAV's thrust; compiled.

| symbol | name | unit, frame |
|---|---|---|
| y | innovation of a sample: seen less expected | m, D |
| (y − y′)/√2 | of noise alone as large as y, of a motion that no model explains 0; y′ is the one before | m, D |
| (y + y′)/√2 | the other way round | m, D |
"""

import numpy as np
from numba import njit

from armland.estimation.plate.late_fusion import distance_of
from armland.records import Record
from armland.rotations import Array

MEAN = 3.0
"""Of a squared distance with 3 degrees of freedom."""

NOISE_GAIN, FAR_RATIO, NOISE_MAX = 0.05, 4.0, 400.0
"""Share by which one sample changes the learnt noise; distance over its mean at which more says no more, unless samples before it
were as far; largest variance ratio."""

SETTLED = 15
"""Samples after which the filter knows velocity and attitude well enough to call anything a leap."""

PERSISTS, SURGE_MPS2, SURGE_S = 9.0, 2.0, 0.15
"""Squared standard deviations of two innovations' sum beyond which a UAV that is lower than expected has lost thrust; how much, m/s²,
and for how long. Nothing else comes at once: the random walk of the disturbance follows the wind."""


@njit(cache=True)
def compare(z: Array, x: Array, P: Array, R: Array, s: Record) -> float:
    """Squared distance of the difference of two innovations: noise makes them differ, motion and another marker make them alike.

    Args:
        z: seen (3,), m, D.
        x: state (9,) at the exposure, m, m/s, m/s², D.
        P: its covariance (9, 9), widened where the UAV is seen to have lost thrust.
        R: covariance (3, 3) of the sample, m².
        s: of `layouts.kept_layout`; the innovation before is replaced.
    """
    apart, both = np.empty(3), np.sqrt(0.5) * (s.innovation[2] + z[2] - x[2])
    for i in range(3):
        y = z[i] - x[i]
        apart[i] = np.sqrt(0.5) * (y - s.innovation[i])
        s.innovation[i] = y
    if s.compared == 0:
        return MEAN
    far = distance_of(apart, P, R)
    # Two that differ far are no fall, which both of them see: one of them is an outlier.
    if (
        far < MEAN * FAR_RATIO
        and s.fused >= SETTLED
        and s.scattered == 0
        and both < 0.0
        and both**2 > PERSISTS * (P[2, 2] + R[2, 2])
    ):
        # p, v and b err by one acceleration that has acted since.
        err = (0.5 * SURGE_S**2 * SURGE_MPS2, SURGE_S * SURGE_MPS2, SURGE_MPS2)
        for i in range(3):
            for k in range(3):
                P[3 * i + 2, 3 * k + 2] += err[i] * err[k]
        return distance_of(apart, P, R)
    return far


@njit(cache=True)
def compare_attitude(theta: Array, R: Array, s: Record) -> float:
    """Likewise of an attitude that cannot be believed: one that flips once stays as it is.

    Args:
        theta: residual of the attitude (3,), rad, D.
        R: its covariance (3, 3), rad².
        s: of `layouts.kept_layout`; the residual before is replaced.
    """
    apart = np.sqrt(0.5) * (theta - s.turn)
    for i in range(3):
        s.turn[i] = theta[i]
    return distance_of(apart, np.zeros((3, 3)), R) if s.compared else MEAN


@njit(cache=True)
def learn_scatter(place: float, attitude: float, upright: bool, s: Record) -> None:
    """Learn from the distances of `compare`, or of `compare_attitude` where the attitude is not believed; count those far off.

    Args:
        place: squared distance, 3 degrees of freedom.
        attitude: likewise.
        upright: whether the attitude is believed.
        s: of `layouts.kept_layout`, updated.
    """
    distance = place if upright else max(place, attitude)
    s.scattered += 1 if distance > MEAN * FAR_RATIO else 0
    s.compared = 1
    learn_noise(distance, s)


@njit(cache=True)
def learn_noise(distance: float, s: Record) -> None:
    """Learn by how much the camera's noise exceeds what it claims: then innovations differ by more than their mean square of 3.

    Args:
        distance: squared Mahalanobis distance of half a difference of two innovations, 3 degrees of freedom. One outlier makes two
            that are far off; more of them before any is believed are noise, each the surer.
        s: of `layouts.kept_layout`; `noise` is updated. A camera that errs less than it claims gains nothing.
    """
    most = FAR_RATIO * max(s.scattered - 1, 1)
    s.noise *= np.exp(NOISE_GAIN * (min(distance / MEAN, most) - 1.0))
    s.noise = min(max(s.noise, 1.0), NOISE_MAX)
