"""The exact backstepping law (X.1): true lever arm, moving reference; compiled.

The law of the paper, in `backstepping`, is (X.1) with the lever arm's motion dropped and the reference at rest.

| symbol | name | unit, frame |
|---|---|---|
| q, R | `q` (4,), `R` (3, 3) | 1, D<-B |
| ω, v | `omega`, `v` (3,) | rad/s, body; m/s, D, CM |
| r, r_d | `r`, `reference.r_d` (3,) | m, D, pivot (hinge) |
| f_T, τ_att | `thrust`, `tau_att` (3,) | N along the body's z; N·m, body |
| u = (Δτ_att, F_EE) | `delta_tau`, `force` (3,) | N·m, body; N, D, on the UAV at the pivot |
| q_e, ω_e | `q_e` (4,), `omega_e` (3,) | 1; rad/s, body |
| α, α̇ | `alpha_omega`, `alpha_v` (3,), `…_dot` | rad/s, m/s and their rates |

Body, gains and γ as in `rigid_body`, Qᵀz₁ and z₂ as in `control.laws.lyapunov`.
"""

from typing import NamedTuple

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
from armland.rotations import Array, cross, error, matrix, turned, turned_back


class Reference(NamedTuple):
    """A moving reference: q_d (4,); ω_d, ω̇_d (3,), rad/s, rad/s², desired body frame; r_d, v_d, a_d (3,), m, m/s, m/s², D: pivot.

    It must be consistent: each is the time derivative of the one before it.
    """

    q_d: Array
    omega_d: Array
    omega_dot_d: Array
    r_d: Array
    v_d: Array
    a_d: Array


@njit(cache=True)
def exact_law(
    q: Array,
    omega: Array,
    r: Array,
    v: Array,
    reference: Reference,
    thrust: float,
    tau_att: Array,
    uav: UavParameters,
    gains: BacksteppingGains | ExactGains,
    gravity: Gravity = DOWN,
) -> tuple[Array, Array]:
    """Extra torque delta_tau (3,), N·m, body, and force (3,), N, D, that make V̇₂ equal (30) on the true kinematics.

    r and the reference's r_d, v_d, a_d are those of the pivot, v is that of the CM; `gravity` γ in m/s², D. Shapes, units and
    frames as in the module's table. q and −q give the same output; it may jump where η_e changes sign (Remark 1).

    Source: (X.1). Departs from the paper's (29): ṙ = v + R(ω × ρ) instead of ṙ = v, a moving reference instead of one
    at rest, B̄ in front of k₃Qᵀz₁, and k₃ may differ between attitude and position (X.6).
    """
    R, q_e, omega_d, gradient, alpha_omega, z2 = _targets(q, omega, r, v, reference, uav, gains)
    omega_e = omega - omega_d
    alpha_omega_dot = turned_back(matrix(q_e), reference.omega_dot_d)
    across, turn = cross(omega_e, omega_d), turning(q_e, omega_e)
    for i in range(3):
        alpha_omega_dot[i] -= across[i] + gains.k1[i] * turn[i]  # (X.1)
    swing = turned(R, cross(omega, cross(uav.lever, alpha_omega)) + cross(uav.lever, alpha_omega_dot))
    lever_dot = turned(R, cross(omega, uav.lever))
    alpha_dot = np.empty(6)
    for i in range(3):
        alpha_r_dot = reference.a_d[i] + gains.k1[3 + i] * (reference.v_d[i] - v[i] - lever_dot[i])
        alpha_dot[i], alpha_dot[3 + i] = alpha_omega_dot[i], alpha_r_dot + swing[i]  # (X.1)
    delta_tau, force = tracking_input(alpha_dot, z2, drift(R, omega, thrust, tau_att, uav, gravity), R, uav, gains.k2)
    # B̄⁻¹ undoes the B̄ in front of k₃Qᵀz₁, so this term stays outside.
    for i in range(3):
        delta_tau[i] -= gains[2] * gradient[i]
        force[i] -= gains[-1] * gradient[3 + i]  # (X.1)
    return delta_tau, force


@njit(cache=True)
def exact_lyapunov(
    q: Array,
    omega: Array,
    r: Array,
    v: Array,
    reference: Reference,
    uav: UavParameters,
    gains: BacksteppingGains | ExactGains,
) -> tuple[float, float]:
    """V₂, J, and its rate V̇₂ ≤ 0, W, under `exact_law`; arguments as there.

    Source: (26) and (30), with the α of (X.1).
    """
    _, q_e, _, gradient, _, z2 = _targets(q, omega, r, v, reference, uav, gains)
    # Where there is only one k₃, the third gain is also the last.
    return storage(q_e, gradient, z2, uav, ExactGains(gains.k1, gains.k2, gains[2], gains[-1]))


@njit(cache=True)
def _targets(
    q: Array,
    omega: Array,
    r: Array,
    v: Array,
    reference: Reference,
    uav: UavParameters,
    gains: BacksteppingGains | ExactGains,
) -> tuple[Array, Array, Array, Array, Array, Array]:
    """R, q_e, ω_d in body axes, Qᵀz₁, α_ω, z₂: what the law and its Lyapunov function share. Source: (X.1)."""
    R = matrix(q)
    q_e = error(reference.q_d, q)
    omega_d = turned_back(matrix(q_e), reference.omega_d)
    gradient = error_gradient(q_e, reference.r_d - r)
    alpha_omega, z2 = np.empty(3), np.empty(6)
    for i in range(3):
        alpha_omega[i] = omega_d[i] - gains.k1[i] * gradient[i]  # (X.1)
    lever_v = turned(R, cross(uav.lever, alpha_omega))
    for i in range(3):
        alpha_v = reference.v_d[i] - gains.k1[3 + i] * gradient[3 + i] + lever_v[i]  # (X.1)
        z2[i], z2[3 + i] = omega[i] - alpha_omega[i], v[i] - alpha_v
    return R, q_e, omega_d, gradient, alpha_omega, z2
