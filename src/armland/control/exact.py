"""The UAV on its hinge (11)–(13), and the exact backstepping law (X.1): true lever arm, moving reference.

The law of the paper, in `backstepping`, is built from the same parts and is (X.1) with the lever arm's motion dropped
and the reference at rest. All functions are compiled and take one sample: float64 arrays, C-contiguous.

| symbol | name | unit, frame |
|---|---|---|
| q, R | `q` (4,), `R` (3, 3) | 1, body to world |
| ω, ω̇ | `omega` (3,), `omega_dot` | rad/s, rad/s², body |
| r, r_d | `r` (3,), `reference.r_d` | m, world, pivot (hinge) |
| v, v̇ | `v` (3,), `v_dot` | m/s, m/s², world, centre of mass (CM) |
| ν = (ω, v) | `nu` (6,) | rad/s, m/s |
| m, J, ρ | `uav.mass`, `uav.inertia` (3, 3), `uav.lever` (3,) | kg; kg·m² about the CM, body; m, CM → pivot, body |
| f_T, τ_att | `thrust`, `tau_att` (3,) | N along the body's z; N·m, body |
| u = (Δτ_att, F_EE) | `delta_tau` (3,), `force` (3,) | N·m, body; N, world, on the UAV at the pivot |
| a_uav, M_uav ν̇, B̄⁻¹ | `drift` (6,), `inertial` (6,), `input_for` | N·m, N |
| q_e, ω_e | `q_e` (4,), `omega_e` (3,) | 1; rad/s, body |
| Qᵀz₁ = (½ s ε_e, −r_e) | `gradient` (6,) | 1, m |
| α, α̇ | `alpha_omega`, `alpha_v` (3,), `…_dot` | rad/s, m/s and their rates |
| K₁, K₂, k₃ | `gains` | 1/s; N·m·s/rad, N·s/m; N·m/rad (attitude), N/m (position) |
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from armland.models.uav import GRAVITY
from armland.rotations import Array, cross, error, matrix, sgn, turned, turned_back


class UavParameters(NamedTuple):
    """The rigid body: mass, kg; inertia (3, 3) about the CM, kg·m², body; lever (3,) from CM to pivot, m, body."""

    mass: float
    inertia: Array
    lever: Array


class BacksteppingGains(NamedTuple):
    """The paper's gains: k1 (6,) and k2 (6,), the diagonals of K₁ and K₂, rotation first; k3 for both blocks."""

    k1: Array
    k2: Array
    k3: float


class ExactGains(NamedTuple):
    """As `BacksteppingGains`, with k₃ apart for attitude, N·m/rad, and position, N/m. Source: (X.6)."""

    k1: Array
    k2: Array
    k3_attitude: float
    k3_position: float


class Reference(NamedTuple):
    """A moving reference: q_d (4,); ω_d, ω̇_d (3,), desired body frame; r_d, v_d, a_d (3,) of the pivot, world.

    It must be consistent: each is the time derivative of the one before it.
    """

    q_d: Array
    omega_d: Array
    omega_dot_d: Array
    r_d: Array
    v_d: Array
    a_d: Array


@njit(cache=True)
def stacked(rotation: Array, translation: Array) -> Array:
    """(rotation, translation), (6,), of two 3-vectors."""
    return np.array([rotation[0], rotation[1], rotation[2], translation[0], translation[1], translation[2]])


@njit(cache=True)
def drift(R: Array, omega: Array, thrust: float, tau_att: Array, uav: UavParameters) -> Array:
    """a_uav (6,), N·m in body axes and N in world axes: all that acts on the UAV except u. Source: (11), (13)."""
    moment = tau_att - cross(omega, turned(uav.inertia, omega))
    lift = thrust * R[:, 2]
    return stacked(moment, np.array([lift[0], lift[1], lift[2] - uav.mass * GRAVITY]))  # (13)


@njit(cache=True)
def inertial(nu_dot: Array, uav: UavParameters) -> Array:
    """M_uav ν̇ (6,), N·m in body axes and N in world axes, of ν̇ (6,). Source: (13)."""
    return stacked(turned(uav.inertia, nu_dot[:3]), uav.mass * nu_dot[3:])  # (13)


@njit(cache=True)
def input_for(load: Array, R: Array, uav: UavParameters) -> tuple[Array, Array]:
    """u = B̄⁻¹ load: the (delta_tau, force) that puts `load` (6,) on the CM. Source: (13), inverted by hand."""
    force = load[3:]
    return load[:3] - cross(uav.lever, turned_back(R, force)), force  # (13)


@njit(cache=True)
def implied_acceleration(
    q: Array, omega: Array, delta_tau: Array, force: Array, thrust: float, tau_att: Array, uav: UavParameters
) -> Array:
    """Acceleration r̈_p (3,) of the pivot, m/s², world, that the input u = (delta_tau, force) implies.

    Fed forward to the arm as Λ r̈_p it makes the hinge force equal to `force` in the nominal model.
    Shapes, units and frames as in the module's table; the inertia must be regular, see `backstepping.check`.

    Source: (X.2), with ν̇ from (11).
    """
    R = matrix(q)
    load = drift(R, omega, thrust, tau_att, uav)
    moment = load[:3] + delta_tau + cross(uav.lever, turned_back(R, force))
    omega_dot: Array = np.linalg.solve(uav.inertia, moment)  # type: ignore[assignment]  # (11)
    v_dot = (load[3:] + force) / uav.mass  # (11)
    return v_dot + turned(R, cross(omega, cross(omega, uav.lever)) + cross(omega_dot, uav.lever))  # (X.2)


@njit(cache=True)
def error_gradient(q_e: Array, r_e: Array) -> Array:
    """Qᵀz₁ = (½ sgn(η_e) ε_e, −r_e), (6,), rad/2 and m: half of |z₁|² grows along it. Source: (31), with the ½."""
    return stacked(0.5 * sgn(q_e[0]) * q_e[1:], -r_e)  # (31)


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
) -> tuple[Array, Array]:
    """Extra torque delta_tau (3,), N·m, body, and force (3,), N, world, that make V̇₂ equal (30) on the true kinematics.

    r and the reference's r_d, v_d, a_d are those of the pivot, v is that of the CM. Shapes, units and frames as in the
    module's table. q and −q give the same output; it may jump where η_e changes sign (Remark 1).

    Source: (X.1). Departs from the paper's (29): ṙ = v + R(ω × ρ) instead of ṙ = v, a moving reference instead of one
    at rest, B̄ in front of k₃Qᵀz₁, and k₃ may differ between attitude and position (X.6).
    """
    R, q_e, omega_d, gradient, alpha_omega, alpha_v = _targets(q, r, reference, uav, gains)
    omega_e = omega - omega_d
    half_s_eps_dot = 0.25 * sgn(q_e[0]) * (q_e[0] * omega_e + cross(q_e[1:], omega_e))
    omega_dot_d = turned_back(matrix(q_e), reference.omega_dot_d)
    alpha_omega_dot = omega_dot_d - cross(omega_e, omega_d) - gains.k1[:3] * half_s_eps_dot  # (X.1)
    r_dot = v + turned(R, cross(omega, uav.lever))
    alpha_r_dot = reference.a_d + gains.k1[3:] * (reference.v_d - r_dot)
    turning = cross(omega, cross(uav.lever, alpha_omega)) + cross(uav.lever, alpha_omega_dot)
    alpha_dot = stacked(alpha_omega_dot, alpha_r_dot + turned(R, turning))  # (X.1)
    z2 = stacked(omega - alpha_omega, v - alpha_v)  # (21)
    load = inertial(alpha_dot, uav) - gains.k2 * z2 - drift(R, omega, thrust, tau_att, uav)
    delta_tau, force = input_for(load, R, uav)
    # B̄⁻¹ undoes the B̄ in front of k₃Qᵀz₁, so this term stays outside.
    k3_attitude, k3_position = _k3(gains)
    return delta_tau - k3_attitude * gradient[:3], force - k3_position * gradient[3:]  # (X.1)


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
    """V₂, N·m, and its rate V̇₂ ≤ 0, W, under `exact_law`; arguments as there.

    Source: (26) and (30), with the α of (X.1) and, where the gains have two, k₃ by block (X.6).
    """
    _, q_e, _, gradient, alpha_omega, alpha_v = _targets(q, r, reference, uav, gains)
    k3_attitude, k3_position = _k3(gains)
    spill = gains.k1 * gradient * gradient
    z2 = stacked(omega - alpha_omega, v - alpha_v)  # (21)
    # z₁ᵀz₁ of the attitude block is also 2(1 − |η_e|), which loses its digits near the goal.
    eta = 1.0 - abs(q_e[0])
    attitude = eta * eta + 4.0 * (gradient[:3] @ gradient[:3])
    v1 = 0.5 * k3_attitude * attitude + 0.5 * k3_position * (gradient[3:] @ gradient[3:])  # (19)
    v1_rate = -k3_attitude * spill[:3].sum() - k3_position * spill[3:].sum()
    return v1 + 0.5 * (z2 @ inertial(z2, uav)), v1_rate - z2 @ (gains.k2 * z2)  # (26), (30)


@njit(cache=True)
def _targets(
    q: Array, r: Array, reference: Reference, uav: UavParameters, gains: BacksteppingGains | ExactGains
) -> tuple[Array, Array, Array, Array, Array, Array]:
    """R, q_e, ω_d in body axes, Qᵀz₁, α_ω, α_v: what the law and its Lyapunov function share. Source: (X.1)."""
    R = matrix(q)
    q_e = error(reference.q_d, q)  # (15)
    omega_d = turned_back(matrix(q_e), reference.omega_d)
    gradient = error_gradient(q_e, reference.r_d - r)
    alpha_omega = omega_d - gains.k1[:3] * gradient[:3]  # (X.1)
    alpha_r = reference.v_d - gains.k1[3:] * gradient[3:]
    return R, q_e, omega_d, gradient, alpha_omega, alpha_r + turned(R, cross(uav.lever, alpha_omega))  # (X.1)


@njit(cache=True)
def _k3(gains: BacksteppingGains | ExactGains) -> tuple[float, float]:
    """k₃ of the attitude and of the position block: where there is only one, the third gain is also the last."""
    return gains[2], gains[-1]
