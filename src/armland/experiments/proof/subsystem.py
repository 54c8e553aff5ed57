"""The UAV subsystem (11), closed by (29) or (X.1), as an equation of motion from any state; compiled.

| symbol | name | unit, frame |
|---|---|---|
| y = (q, ω, r, v) | `y` (13,) | 1, body to world; rad/s, body; m, world, pivot; m/s, world, centre of mass |
| ẏ | `rate` (13,) | |
| τ_att, f_T | `tau_att` (3,), `thrust` | quaternion PD, N·m, body; N along the body's z |
| u = (Δτ_att, F_EE) | `delta_tau` (3,), `force` (3,) | N·m, body; N, world, at the pivot |
| q_d, r_d | `reference` | at rest, or swinging about `problem.q_d` and `problem.r_d` |
| V₂, V̇₂ | `storage` | N·m, W |
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from armland.control.laws.attitude import QuaternionPdGains
from armland.control.laws.backstepping import lyapunov, paper_law
from armland.control.laws.exact import Reference, exact_law, exact_lyapunov
from armland.control.laws.rigid_body import BacksteppingGains, Gravity
from armland.models.uav import UavParameters
from armland.records import Record
from armland.rotations import Array, cross, error, from_rotation_vector, matrix, multiply, sgn

PROBLEM = np.dtype(
    [
        ("start", "f8", (13,)),  # y at t = 0
        ("q_d", "f8", (4,)),
        ("r_d", "f8", (3,)),  # m, world
        ("thrust", "f8"),  # N
        ("amplitude", "f8", (5,)),  # of the reference's swing: x, y, z, m; roll, yaw, rad
        ("pulsation", "f8", (5,)),  # rad/s
        ("phase", "f8", (5,)),  # rad
    ]
)
"""A state to start from and what the UAV shall do."""


class Setting(NamedTuple):
    """What all paths of one case share."""

    exact: bool  # Law (X.1) with its Lyapunov function; else (29) with (26) of the paper
    lever_moves: bool  # True kinematics ṙ = v + R(ω × ρ), or the paper's ṙ = v
    uav: UavParameters  # The body that moves, and that V₂ speaks of
    inverse: Array  # J⁻¹ (3, 3) of that body
    gains: BacksteppingGains  # The gains that V₂ speaks of
    told_uav: UavParameters  # The body that the law believes in
    told_gains: BacksteppingGains  # The gains that the law uses
    onboard: QuaternionPdGains  # Gains of the UAV's own attitude controller
    gravity: Gravity  # m/s², world
    tolerance: float  # Error allowed to a step: this part of each element of y, and this much of its unit
    horizon: float  # Longest time that a path is followed, s
    enough: float  # V₂ at which a path is followed no further, N·m


@njit(cache=True)
def reference_at(t: float, problem: Record) -> Reference:
    """The reference at time t, s: r_d swings along each axis; q_d is turned by a yaw, then by a roll, both swinging."""
    value, rate, acceleration = np.zeros(5), np.zeros(5), np.zeros(5)
    for i in range(5):
        a, w, phase = problem.amplitude[i], problem.pulsation[i], problem.phase[i]
        if a != 0.0:
            value[i] = a * np.sin(w * t + phase)
            rate[i] = a * w * np.cos(w * t + phase)
            acceleration[i] = -a * w * w * np.sin(w * t + phase)
    q_d, r_d = problem.q_d.copy(), problem.r_d + value[:3]
    if problem.amplitude[3] == 0.0 and problem.amplitude[4] == 0.0:
        return Reference(q_d, np.zeros(3), np.zeros(3), r_d, rate[:3], acceleration[:3])
    yaw = from_rotation_vector(np.array([0.0, 0.0, value[4]]))
    roll = from_rotation_vector(np.array([value[3], 0.0, 0.0]))
    # The yaw's axis, seen from the rolled body, turns with the roll.
    x, z = np.array([1.0, 0.0, 0.0]), matrix(roll)[2].copy()
    omega = rate[3] * x + rate[4] * z
    omega_dot = acceleration[3] * x + acceleration[4] * z - rate[4] * cross(rate[3] * x, z)
    return Reference(multiply(q_d, multiply(yaw, roll)), omega, omega_dot, r_d, rate[:3], acceleration[:3])


@njit(cache=True)
def onboard_torque(y: Array, q_d: Array, onboard: QuaternionPdGains) -> Array:
    """τ_att (3,), N·m, body: the UAV's own PD towards q_d (4,) at rest, as `attitude.quaternion_pd`."""
    q_e = error(q_d, y[:4])
    torque = np.empty(3)
    for i in range(3):
        torque[i] = -2.0 * onboard.kp[i] * sgn(q_e[0]) * q_e[1 + i] - onboard.kd[i] * y[4 + i]
    return torque


@njit(cache=True)
def asked(y: Array, reference: Reference, thrust: float, tau_att: Array, setting: Setting) -> tuple[Array, Array]:
    """u = (Δτ_att, F_EE) that the setting's law asks for in state y (13,). Source: (29) or (X.1)."""
    q, omega, r, v, uav, gains = y[:4], y[4:7], y[7:10], y[10:], setting.told_uav, setting.told_gains
    if setting.exact:
        return exact_law(q, omega, r, v, reference, thrust, tau_att, uav, gains, setting.gravity)
    return paper_law(q, omega, r, v, reference.q_d, reference.r_d, thrust, tau_att, uav, gains, setting.gravity)


@njit(cache=True)
def motion(
    y: Array, delta_tau: Array, force: Array, thrust: float, tau_att: Array, setting: Setting, rate: Array
) -> None:
    """Fill `rate` (13,) with ẏ by Newton and Euler, written apart from the laws' own model. Source: (9)–(11)."""
    eta, e1, e2, e3, w1, w2, w3 = y[0], y[1], y[2], y[3], y[4], y[5], y[6]
    rate[0] = -0.5 * (e1 * w1 + e2 * w2 + e3 * w3)
    rate[1] = 0.5 * (eta * w1 + e2 * w3 - e3 * w2)
    rate[2] = 0.5 * (eta * w2 + e3 * w1 - e1 * w3)
    rate[3] = 0.5 * (eta * w3 + e1 * w2 - e2 * w1)
    R, J, rho = matrix(y[:4]), setting.uav.inertia, setting.uav.lever
    # Loops over three elements: a call of BLAS would cost more than all of this.
    at_pivot, momentum = np.zeros(3), np.zeros(3)
    for i in range(3):
        for k in range(3):
            at_pivot[i] += R[k, i] * force[k]
            momentum[i] += J[i, k] * y[4 + k]
    moment = tau_att + delta_tau - cross(y[4:7], momentum) + cross(rho, at_pivot)
    swing = cross(y[4:7], rho) if setting.lever_moves else np.zeros(3)
    for i in range(3):
        rate[4 + i] = 0.0
        rate[7 + i] = y[10 + i]
        for k in range(3):
            rate[4 + i] += setting.inverse[i, k] * moment[k]  # (9)
            rate[7 + i] += R[i, k] * swing[k]
        rate[10 + i] = (force[i] + thrust * R[i, 2]) / setting.uav.mass + setting.gravity[i]  # (10)


@njit(cache=True)
def flow(t: float, y: Array, problem: Record, setting: Setting, rate: Array) -> float:
    """Fill `rate` (13,) with ẏ of the closed loop at time t, s, and return η_e, whose sign says which way round."""
    reference = reference_at(t, problem)
    tau_att = onboard_torque(y, reference.q_d, setting.onboard)
    delta_tau, force = asked(y, reference, problem.thrust, tau_att, setting)
    motion(y, delta_tau, force, problem.thrust, tau_att, setting, rate)
    d = reference.q_d
    return d[0] * y[0] + d[1] * y[1] + d[2] * y[2] + d[3] * y[3]


@njit(cache=True)
def storage(t: float, y: Array, problem: Record, setting: Setting) -> tuple[float, float]:
    """V₂, N·m, and the rate, W, that (30) states for it, at time t, s, in state y (13,)."""
    reference = reference_at(t, problem)
    q, omega, r, v = y[:4], y[4:7], y[7:10], y[10:]
    if setting.exact:
        return exact_lyapunov(q, omega, r, v, reference, setting.uav, setting.gains)
    return lyapunov(q, omega, r, v, reference.q_d, reference.r_d, setting.uav, setting.gains)
