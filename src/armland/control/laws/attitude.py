"""Attitude controllers on board: quaternion PD, geometric on SO(3), attitude P over rate PID; and what the ground feeds them forward.

All three have the same arguments and results, so that one can stand in for another:
`(q, omega, q_d, omega_d, omega_dot_d, gains, memory) -> (torque, memory)`. They are compiled and take one sample:
float64 arrays, C-contiguous. The torque is the same for q and −q.

| symbol | name | unit, frame |
|---|---|---|
| q, q_d | `q`, `q_d` (4,) | 1, D<-B |
| ω, ω_d, ω̇_d | `omega`, `omega_d`, `omega_dot_d` (3,) | rad/s, rad/s², body; desired: in the desired body frame |
| R_e = R_dᵀR | `R_e` (3, 3) | 1, desired body<-B |
| ω_e = ω − R_eᵀω_d | `omega_e` (3,) | rad/s, body |
| τ | `torque` (3,) | N·m, body |
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from armland.rotations import Array, cross, error, matrix, sgn, turned_back


class AttitudeMemory(NamedTuple):
    """What a controller keeps from sample to sample; only `cascade` needs it. Start it with `initial_memory`."""

    integral: Array
    """Torque (3,) of the rate loop's integrator, N·m, body."""
    rate: Array
    """Low-passed angular velocity (3,), rad/s, body."""


class QuaternionPdGains(NamedTuple):
    """Gains of `quaternion_pd`, per body axis."""

    kp: Array
    """(3,), N·m/rad, at small angles."""
    kd: Array
    """(3,), N·m·s/rad."""


class GeometricGains(NamedTuple):
    """Gains of `geometric`, per body axis, and the inertia that its feed-forward assumes."""

    kp: Array
    """(3,), N·m/rad, at small angles."""
    kd: Array
    """(3,), N·m·s/rad."""
    inertia: Array
    """(3, 3) about the centre of mass, kg·m², body."""


class CascadeGains(NamedTuple):
    """Gains and limits of `cascade`, per body axis."""

    k_angle: Array
    """(3,), 1/s: rate asked for per angle."""
    rate_limit: Array
    """(3,), rad/s: largest rate asked for."""
    kp: Array
    """(3,), N·m·s/rad."""
    ki: Array
    """(3,), N·m/rad."""
    kd: Array
    """(3,), N·m·s²/rad, on the measured rate."""
    torque_limit: Array
    """(3,), N·m: what the rotors can give; the integrator stops there."""
    filter_time: float
    """Time constant of the derivative's low pass, s."""
    period: float
    """Time between two samples, s."""


@njit(cache=True)
def initial_memory(omega: Array) -> AttitudeMemory:
    """Memory before the first sample, taken at omega (3,), rad/s, body, so that the derivative starts without a kick.

    The controllers without memory return it too: `cascade` can take over from them at any sample.
    """
    return AttitudeMemory(np.zeros(3), omega.copy())


@njit(cache=True)
def quaternion_pd(
    q: Array,
    omega: Array,
    q_d: Array,
    omega_d: Array,
    omega_dot_d: Array,
    gains: QuaternionPdGains,
    memory: AttitudeMemory,
) -> tuple[Array, AttitudeMemory]:
    """τ (3,), N·m, = −kp 2 sgn(η_e) ε_e − kd ω_e. Turns by the smaller angle; its torque is largest at 180°, where it jumps.

    omega_dot_d and memory are not used.

    Source: Wie, Weiss, Arapostathis, "Quaternion feedback regulator for spacecraft eigenaxis rotations", 1989, without
    the gyroscopic term; sgn after (18), against unwinding.
    """
    q_e = error(q_d, q)
    omega_e = omega - matrix(q_e).T @ omega_d
    return -gains.kp * (2.0 * sgn(q_e[0]) * q_e[1:]) - gains.kd * omega_e, initial_memory(omega)


@njit(cache=True)
def geometric(
    q: Array,
    omega: Array,
    q_d: Array,
    omega_d: Array,
    omega_dot_d: Array,
    gains: GeometricGains,
    memory: AttitudeMemory,
) -> tuple[Array, AttitudeMemory]:
    """τ (3,), N·m, = −e_R − kd ω_e + ω × Jω + J(R_eᵀω̇_d − ω × R_eᵀω_d), so that Jω̇_e = −e_R − kd ω_e for any moving reference.

    e_R is the gradient of Ψ = ½ tr(G(I − R_e)), hence Ψ + ½ ω_eᵀJω_e falls at the rate ω_eᵀ kd ω_e. It vanishes at 180°
    too, an unstable equilibrium. memory is not used.

    Source: Lee, Leok, McClamroch, "Geometric tracking control of a quadrotor UAV on SE(3)", 2010. Departs from it by
    the weight G, which allows kp to differ between the axes; with equal elements e_R is their kp ½(R_dᵀR − RᵀR_d)^∨.
    """
    R_e = matrix(error(q_d, q))
    omega_d_b = R_e.T @ omega_d
    # Turning about axis i strains the weights of the two other axes: kp_i = (G_j + G_k)/2.
    G = gains.kp.sum() - 2.0 * gains.kp
    e_R = 0.5 * np.array(
        [
            G[2] * R_e[2, 1] - G[1] * R_e[1, 2],
            G[0] * R_e[0, 2] - G[2] * R_e[2, 0],
            G[1] * R_e[1, 0] - G[0] * R_e[0, 1],
        ]
    )
    feed_forward = cross(omega, gains.inertia @ omega)
    feed_forward += gains.inertia @ (R_e.T @ omega_dot_d - cross(omega, omega_d_b))
    return feed_forward - e_R - gains.kd * (omega - omega_d_b), initial_memory(omega)


@njit(cache=True)
def cascade(
    q: Array,
    omega: Array,
    q_d: Array,
    omega_d: Array,
    omega_dot_d: Array,
    gains: CascadeGains,
    memory: AttitudeMemory,
) -> tuple[Array, AttitudeMemory]:
    """Attitude P that asks for a limited rate, over a rate PID with limited torque; to be called every `gains.period`.

    The derivative acts on the measured rate, low-passed, so a jump of the reference gives no kick. An axis stops
    integrating while its torque is at the limit and the rate error would drive it further. omega_dot_d is not used.

    Source: the structure of PX4's multicopter attitude and rate control; its attitude part: Brescianini, Hehn,
    D'Andrea, "Nonlinear quadrocopter attitude control", 2013, without their reduced yaw priority.
    """
    q_e = error(q_d, q)
    rate_wanted = matrix(q_e).T @ omega_d - gains.k_angle * (2.0 * sgn(q_e[0]) * q_e[1:])
    rate_wanted = np.minimum(np.maximum(rate_wanted, -gains.rate_limit), gains.rate_limit)
    rate_error = rate_wanted - omega
    rate_change = (omega - memory.rate) / (gains.period + gains.filter_time)
    wanted = gains.kp * rate_error + memory.integral - gains.kd * rate_change
    torque = np.minimum(np.maximum(wanted, -gains.torque_limit), gains.torque_limit)
    integral = memory.integral.copy()
    for i in range(3):
        if torque[i] == wanted[i] or rate_error[i] * wanted[i] < 0.0:
            integral[i] += gains.ki[i] * rate_error[i] * gains.period
    return torque, AttitudeMemory(integral, memory.rate + gains.period * rate_change)


@njit(cache=True)
def feed_forward(R: Array, force: Array, lever: Array, limit: Array) -> Array:
    """Torque (3,), N·m, body, that cancels the moment −ρ × (RᵀF) of a force at the pivot, each axis within `limit`.

    Args:
        R: rotation (3, 3), D<-B.
        force: (3,), N, D, on the UAV at the pivot.
        lever: ρ (3,), m, body.
        limit: (3,), N·m.

    Source: (X.6). The moment is cancelled exactly only if `force` is the true hinge force.
    """
    torque = cross(lever, turned_back(R, force))
    for i in range(3):
        torque[i] = min(max(-torque[i], -limit[i]), limit[i])  # (X.6)
    return torque
