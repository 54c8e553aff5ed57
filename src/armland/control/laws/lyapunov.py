"""Errors of the backstepping laws and their Lyapunov function, (15)–(31): what (29) and (X.1) share; compiled.

| symbol | name | unit, frame |
|---|---|---|
| q_e = q_d⁻¹ ⊗ q | `q_e` (4,) | 1 |
| r_e = r_d − r | `r_e` (3,) | m, D |
| z₁ = (1 − abs(η_e), ε_e, r_e) | (7,), not formed | 1, m |
| Qᵀz₁ = (½ s ε_e, −r_e), s = sgn(η_e) | `gradient` (6,) | 1, m |
| α, z₂ = ν − α | `z2` (6,) | rad/s, body; m/s, D |
| K₁, K₂, k₃ | `k1`, `k2` (6,), `k3_attitude`, `k3_position` | 1/s; N·m·s/rad, N·s/m; N·m/rad; N/m |
| V₂, V̇₂ | | J, W |
"""

import numpy as np
from numba import njit

from armland.control.laws.rigid_body import ExactGains, UavParameters, inertial, input_for
from armland.rotations import Array, cross, sgn


@njit(cache=True)
def error_gradient(q_e: Array, r_e: Array) -> Array:
    """Qᵀz₁ (6,), 1 and m, of q_e (4,) and r_e (3,), m: half of z₁ᵀz₁ grows along it. Source: (17), reduced as in (31).

    Departs from the published (31), which lacks the factor ½ in front of sgn(η_e) ε_e: (17) has it, and without it (30) does not hold.
    """
    gradient, half = np.empty(6), 0.5 * sgn(q_e[0])
    for i in range(3):
        gradient[i], gradient[3 + i] = half * q_e[1 + i], -r_e[i]  # (31)
    return gradient


@njit(cache=True)
def turning(q_e: Array, omega_e: Array) -> Array:
    """Rate (3,), 1/s, of the gradient's attitude part where q_e (4,) turns at omega_e (3,), rad/s, body. Source: (17)."""
    rate, quarter = cross(q_e[1:], omega_e), 0.25 * sgn(q_e[0])
    for i in range(3):
        rate[i] = quarter * (q_e[0] * omega_e[i] + rate[i])  # (17)
    return rate


@njit(cache=True)
def tracking_input(
    alpha_dot: Array, z2: Array, a_uav: Array, R: Array, uav: UavParameters, k2: Array
) -> tuple[Array, Array]:
    """B̄⁻¹(M_uav α̇ − K₂z₂ − a_uav): delta_tau (3,), N·m, body, and force (3,), N, D, of (29) without its term in k₃.

    Args:
        alpha_dot: α̇ (6,), rad/s², body, and m/s², D.
        z2: (6,), rad/s and m/s.
        a_uav: of `rigid_body.drift` (6,), N·m and N.
        R: rotation (3, 3), D<-B.
        uav: rigid body.
        k2: K₂ (6,), N·m·s/rad and N·s/m.

    Source: (29) without k₃Qᵀz₁.
    """
    load = inertial(alpha_dot, uav)
    for i in range(6):
        load[i] -= k2[i] * z2[i] + a_uav[i]
    return input_for(load, R, uav)


@njit(cache=True)
def storage(q_e: Array, gradient: Array, z2: Array, uav: UavParameters, gains: ExactGains) -> tuple[float, float]:
    """V₂, J, and its rate V̇₂ ≤ 0, W, under a law for which (30) holds.

    Args:
        q_e: attitude error (4,).
        gradient: of `error_gradient` (6,).
        z2: ν − α (6,), rad/s and m/s.
        uav: rigid body.
        gains: of the law, k₃ by block.

    Source: (26) and the right side of (30), with k₃ by block (X.6).
    """
    # z₁ᵀz₁ of the attitude block is also 2(1 − |η_e|), which loses its digits near the goal.
    eta = 1.0 - abs(q_e[0])
    attitude, position, kinetic, rate = eta * eta, 0.0, 0.0, 0.0
    load = inertial(z2, uav)
    for i in range(6):
        square, k3 = gradient[i] * gradient[i], gains.k3_attitude if i < 3 else gains.k3_position
        attitude += 4.0 * square if i < 3 else 0.0
        position += square if i >= 3 else 0.0
        kinetic += z2[i] * load[i]
        rate -= k3 * gains.k1[i] * square + gains.k2[i] * z2[i] * z2[i]  # (30)
    return 0.5 * (gains.k3_attitude * attitude + gains.k3_position * position + kinetic), rate  # (26)
