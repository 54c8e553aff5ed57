"""Classical Cartesian impedance control and what every arm controller here shares: orientation PD and null space.

| symbol | name | unit |
|---|---|---|
| x_e = x − x_d (6) | `x_e`, position part (3,) | m |
| K_d, D_d | `stiffness`, `damping` (3,) | N/m, N·s/m |
| τ₀ | `tau0` (n,) | N·m |
"""

import numpy as np
from numba import njit

from armland.rotations import Array, rotation_error


@njit(cache=True)
def impedance(x_e: Array, x_e_dot: Array, stiffness: Array, damping: Array) -> Array:
    """Force (3,), N, world, of the classical impedance law without inertia shaping.

    Args:
        x_e: position error x − x_d (3,), m, world.
        x_e_dot: its rate (3,), m/s.
        stiffness: K_d (3,), N/m.
        damping: D_d (3,), N·s/m.

    Source: (6), the term −(K_d x_e + D_d ẋ_e).
    """
    return -(stiffness * x_e + damping * x_e_dot)  # (6)


@njit(cache=True)
def orientation_pd(R: Array, R_d: Array, omega: Array, kp: float, kd: float) -> Array:
    """Torque (3,), N·m, world, that turns the end effector R (3, 3) into R_d (3, 3) against its rate omega (3,), rad/s, world.

    Source: the paper's orientation controller, k_p = 25 N·m/rad, k_d = 7 N·m·s/rad.
    """
    return kp * rotation_error(R, R_d) - kd * omega


@njit(cache=True)
def elbow_field(axis: Array, anchor: Array, elbow: int, pull: float) -> Array:
    """Joint torques (n,), N·m, of a force `pull`, N, downwards at the elbow: the anchor of joint `elbow`.

    Args:
        axis: joint axes (n, 3), world.
        anchor: a point on each joint's axis (n, 3), m, world.
        elbow: index of the elbow's joint; only the hinges before it move its anchor.
        pull: N.

    Source: the paper's null-space behaviour, elbow pulled downwards.
    """
    tau = np.zeros(axis.shape[0])
    for i in range(elbow):
        dx, dy = anchor[elbow, 0] - anchor[i, 0], anchor[elbow, 1] - anchor[i, 1]
        # z component of axis × lever: how fast joint i raises the elbow.
        tau[i] = -pull * (axis[i, 0] * dy - axis[i, 1] * dx)
    return tau


@njit(cache=True)
def range_field(q: Array, low: Array, high: Array, margin: float, stiffness: float) -> Array:
    """Joint torques (n,), N·m, that push joints away from their range's ends within `margin` rad; `stiffness` in N·m/rad."""
    tau = np.zeros(q.shape[0])
    for i in range(q.shape[0]):
        if q[i] < low[i] + margin:
            tau[i] = stiffness * (low[i] + margin - q[i])
        elif q[i] > high[i] - margin:
            tau[i] = stiffness * (high[i] - margin - q[i])
    return tau
