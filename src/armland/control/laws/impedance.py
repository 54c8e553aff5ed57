"""Classical Cartesian impedance control, and the orientation controller that every arm law here shares; compiled.

| symbol | name | unit |
|---|---|---|
| x_e = x − x_d (6) | `x_e`, position part (3,) | m |
| K_d, D_d | `stiffness`, `damping` (3,) | N/m, N·s/m |
| k_p, k_d | `kp`, `kd` | N·m/rad, N·m·s/rad |
"""

import numpy as np
from numba import njit

from armland.rotations import Array, rotation_error


@njit(cache=True)
def impedance(x_e: Array, x_e_dot: Array, stiffness: Array, damping: Array) -> Array:
    """Force (3,), N, D, of the classical impedance law without inertia shaping.

    With K_d, D_d over a mass, in 1/s² and 1/s, it is the acceleration (3,), m/s², that a free end effector shall have beyond ẍ_d.

    Args:
        x_e: position error x − x_d (3,), m, D.
        x_e_dot: its rate (3,), m/s.
        stiffness: K_d (3,), N/m.
        damping: D_d (3,), N·s/m.

    Source: (6), the term −(K_d x_e + D_d ẋ_e).
    """
    force = np.empty(3)
    for i in range(3):
        force[i] = -(stiffness[i] * x_e[i] + damping[i] * x_e_dot[i])  # (6)
    return force


@njit(cache=True)
def orientation_pd(R: Array, R_d: Array, omega: Array, kp: float, kd: float) -> Array:
    """Torque (3,), N·m, D, that turns the end effector to where it should point.

    Args:
        R: its rotation (3, 3), D<-E.
        R_d: rotation (3, 3), D<-E, that it should have.
        omega: its rate (3,), rad/s, D.
        kp: N·m/rad.
        kd: N·m·s/rad.

    Source: the paper's orientation controller, k_p = 25 N·m/rad, k_d = 7 N·m·s/rad.
    """
    torque = rotation_error(R, R_d)
    for i in range(3):
        torque[i] = kp * torque[i] - kd * omega[i]
    return torque
