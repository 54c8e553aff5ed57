"""Joint friction that is known, made up for: a share of it, so that what is left always brakes; compiled.

| symbol | name | unit |
|---|---|---|
| f, d | `friction`, `damping` of each joint (n,), as the arm's file has them | N·m, N·m·s/rad |
| σ | `SHARE` | 1 |
| v₀ | `SOFT_RAD_S`, about which Coulomb friction turns over | rad/s |

    τ_f = σ (f tanh(q̇/v₀) + d q̇)

The plant's own friction dissipates |q̇| f + d q̇² while it slips, of which τ_f gives back less than σ: the joint stays passive, and a
file that says too little is no danger. What is small is left to feedback: a velocity is measured with noise.
"""

import numpy as np
from numba import njit

from armland.rotations import Array

SHARE = 0.8

SOFT_RAD_S = 0.1

LEAST = 0.5
"""N·m and N·m·s/rad from which on friction and damping are made up for."""


def known(values: Array) -> Array:
    """What of friction `values` (n,), N·m, or damping (n,), N·m·s/rad, is made up for: σ of each, nothing of what is small."""
    return np.where(values >= LEAST, SHARE * values, 0.0)


@njit(cache=True)
def make_up(qd: Array, friction: Array, damping: Array, tau: Array) -> None:
    """Add τ_f to `tau` (n,), N·m.

    Args:
        qd: joint velocities (n,), rad/s, measured.
        friction: σ f (n,), N·m, of `known`.
        damping: σ d (n,), N·m·s/rad, of `known`.
        tau: (n,), N·m, added to; joints without friction keep it to the last bit.
    """
    for i in range(qd.shape[0]):
        if friction[i] > 0.0 or damping[i] > 0.0:
            tau[i] += friction[i] * np.tanh(qd[i] / SOFT_RAD_S) + damping[i] * qd[i]
