"""The backstepping law of the paper for the UAV on the robot's hinge, (29), (33), with its proof as a function; compiled.

| symbol | name | unit, frame |
|---|---|---|
| q, q_d | `q`, `q_d` (4,) | 1, D<-B |
| ω, v | `omega`, `v` (3,) | rad/s, body; m/s, D, CM |
| r, r_d, r_e = r_d − r | `r`, `r_d`, `r_e` (3,) | m, D, pivot |
| f_T, τ_att | `thrust`, `tau_att` (3,) | N along the body's z; N·m, body |
| u = (Δτ_att, F_EE) | `delta_tau`, `force` (3,) | N·m, body; N, D, on the UAV at the pivot |
| V₂, V̇₂ | of `lyapunov` | J, W |

Body, gains and γ as in `rigid_body`, errors as in `control.laws.lyapunov`.
"""

import numpy as np
from numba import njit

from armland.control.laws.lyapunov import error_gradient, storage, tracking_input, turning
from armland.control.laws.rigid_body import (
    BacksteppingGains,
    ExactGains,
    Gravity,
    UavParameters,
    drift,
)
from armland.models.environment import DOWN
from armland.rotations import Array, error, matrix


@njit(cache=True)
def paper_law(
    q: Array,
    omega: Array,
    r: Array,
    v: Array,
    q_d: Array,
    r_d: Array,
    thrust: float,
    tau_att: Array,
    uav: UavParameters,
    gains: BacksteppingGains,
    gravity: Gravity = DOWN,
) -> tuple[Array, Array]:
    """Extra torque delta_tau (3,), N·m, body, for the UAV and force (3,), N, D, of the end effector on it.

    Shapes, units and frames as in the module's table; `gravity` γ in m/s², D. q and −q give the same output; it may jump where
    η_e changes sign (Remark 1). `force` is the whole of (33): `impedance_force` plus `support_force`.

    Source: (29). As published it drops ω × ρ in ṙ and takes q_d, r_d as constant; `error_gradient` says what departs.
    """
    R, q_e = matrix(q), error(q_d, q)
    gradient, turn, alpha_dot = error_gradient(q_e, r_d - r), turning(q_e, omega), np.empty(6)
    a_uav = drift(R, omega, thrust, tau_att, uav, gravity)
    for i in range(3):
        alpha_dot[i], alpha_dot[3 + i] = -gains.k1[i] * turn[i], -gains.k1[3 + i] * v[i]  # (22)
    for i in range(6):
        # What k₃ adds acts on the CM, as a_uav does.
        a_uav[i] += gains.k3 * gradient[i]  # (29)
    return tracking_input(alpha_dot, _z2(omega, v, gradient, gains), a_uav, R, uav, gains.k2)


@njit(cache=True)
def lyapunov(
    q: Array, omega: Array, r: Array, v: Array, q_d: Array, r_d: Array, uav: UavParameters, gains: BacksteppingGains
) -> tuple[float, float]:
    """V₂, J, and the rate V̇₂ ≤ 0, W, that `paper_law` gives it; arguments as there.

    Source: (26) and the right side of (30), on the paper's kinematics.
    """
    q_e = error(q_d, q)
    gradient = error_gradient(q_e, r_d - r)
    split = ExactGains(gains.k1, gains.k2, gains.k3, gains.k3)
    return storage(q_e, gradient, _z2(omega, v, gradient, gains), uav, split)


@njit(cache=True)
def _z2(omega: Array, v: Array, gradient: Array, gains: BacksteppingGains) -> Array:
    """z₂ = ν − α (6,), α = −K₁Qᵀz₁. Source: (21), (22)."""
    z2 = np.empty(6)
    for i in range(3):
        z2[i] = omega[i] + gains.k1[i] * gradient[i]
        z2[3 + i] = v[i] + gains.k1[3 + i] * gradient[3 + i]  # (21)
    return z2


@njit(cache=True)
def impedance_force(r_e: Array, v: Array, uav: UavParameters, gains: BacksteppingGains) -> Array:
    """Spring and damper of the end effector's force (3,), N, D, of r_e = r_d − r (3,), m, and v (3,), m/s.

    Source: (33) without its last two terms, which are `support_force`. With the published gains 935 N/m and 44.4 N·s/m.
    """
    stiffness, damping = spring_and_damper(uav, gains)
    force = np.empty(3)
    for i in range(3):
        force[i] = stiffness[i] * r_e[i] - damping[i] * v[i]  # (33)
    return force


@njit(cache=True)
def spring_and_damper(uav: UavParameters, gains: BacksteppingGains) -> tuple[Array, Array]:
    """Stiffness (3,), N/m, and damping (3,), N·s/m, of (33): K₁K₂ + k₃ and mK₁ + K₂."""
    stiffness, damping = np.empty(3), np.empty(3)
    for i in range(3):
        stiffness[i] = gains.k1[3 + i] * gains.k2[3 + i] + gains.k3
        damping[i] = uav.mass * gains.k1[3 + i] + gains.k2[3 + i]  # (33)
    return stiffness, damping


@njit(cache=True)
def support_force(q: Array, thrust: float, uav: UavParameters, gravity: Gravity = DOWN) -> Array:
    """Static part −m γ − f_T R e₃ (3,), N, D: the weight that the UAV's thrust leaves to the end effector.

    Args:
        q: attitude (4,), D<-B.
        thrust: f_T, N.
        uav: rigid body.
        gravity: γ, m/s², D.

    Source: the last two terms of (33). Experiments E1 and E2 put zero in its place, E3 the measured force along z.
    """
    support = np.empty(3)
    R = matrix(q)
    for i in range(3):
        support[i] = -uav.mass * gravity[i] - thrust * R[i, 2]  # (33)
    return support
