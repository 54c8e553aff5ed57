"""Follow a sampled signal and its first two derivatives, so that a late sample can be carried on to now; compiled.

| symbol | name | unit |
|---|---|---|
| x, ẋ, ẍ | `value`, `first`, `second` (3,): of three axes by themselves | u, u/s, u/s² |
| z, σ | sample, standard deviation of its noise | u |
| q | `density` of the white third derivative that is taken to drive the signal | u²/s⁵ |
| k | `gains` (3,) | 1, 1/s, 1/s² |

    x⁻ = x + ẋ T + ½ ẍ T²,  ẋ⁻ = ẋ + ẍ T,  ẍ⁻ = ẍ;  (x, ẋ, ẍ) = (x⁻, ẋ⁻, ẍ⁻) + k (z − x⁻)                      (D.1)

k is that of the Kalman filter at rest. A quotient of differences behind a low pass of time constant τ is late by τ; this one is not
late where the signal has a constant second derivative, and of one that swings at ω it misses of order (ω/ω_k)³, ω_k⁶ = q/(σ² T).
"""

import numpy as np
from numba import njit
from scipy.linalg import solve_discrete_are

from armland.records import Record
from armland.rotations import Array

LEAST = 1e-6
"""Of a signal's noise: below it the filter would trust a sample for ever."""


def kept_layout() -> np.dtype:
    """What is remembered of a signal; zeros at first."""
    return np.dtype([(name, "f8", (3,)) for name in ("value", "first", "second")])


def steady_gains(period_s: float, density: float, sigma: float) -> Array:
    """k (3,) for samples every `period_s`, s, with q = `density` and σ = `sigma`. Source: (D.1), the algebraic Riccati equation."""
    t, seen = period_s, np.array([[1.0, 0.0, 0.0]])
    F = np.array([[1.0, t, 0.5 * t * t], [0.0, 1.0, t], [0.0, 0.0, 1.0]])
    Q = density * np.array(
        [[t**5 / 20.0, t**4 / 8.0, t**3 / 6.0], [t**4 / 8.0, t**3 / 3.0, t**2 / 2.0], [t**3 / 6.0, t**2 / 2.0, t]]
    )
    noise = max(sigma, LEAST) ** 2
    P = solve_discrete_are(F.T, seen.T, Q, np.array([[noise]]))
    return np.asarray(P[:, 0] / (P[0, 0] + noise))


@njit(cache=True)
def begin(sample: Array, s: Record) -> None:
    """Begin at `sample` (3,), in its own unit, at rest."""
    for i in range(3):
        s.value[i], s.first[i], s.second[i] = sample[i], 0.0, 0.0


@njit(cache=True)
def track(sample: Array, since_s: float, gains: Array, s: Record) -> None:
    """One sample.

    Args:
        sample: z (3,), in the unit of the signal, u.
        since_s: time since the sample before, s.
        gains: k (3,).
        s: of `kept_layout`, updated.
    """
    for i in range(3):
        x = s.value[i] + (s.first[i] + 0.5 * s.second[i] * since_s) * since_s
        missed = sample[i] - x
        s.value[i] = x + gains[0] * missed
        s.first[i] += s.second[i] * since_s + gains[1] * missed
        s.second[i] += gains[2] * missed  # (D.1)
