"""One tick of the coordinated controller: estimate, reference, laws (29) and (35), limits; compiled.

| symbol | name | unit |
|---|---|---|
| F_EE | `command.force` (3,), law (33) with the support chosen by Table II | N, world |
| τ_ori | `command.torque` (3,) | N·m, world |
| τ_j | `command.tau` (n,) | N·m |
| Λ ẍ_d, μ ẋ_d | `feedforward` (6,) | N, N·m, world |
"""

from functools import lru_cache

import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.control.attitude import QuaternionPdGains, initial_memory, quaternion_pd
from armland.control.backstepping import BacksteppingGains, UavParameters, impedance_force, paper_law
from armland.control.impedance import elbow_field, orientation_pd, range_field
from armland.models.operational import null_space_torque
from armland.records import Flag, Record
from armland.rotations import Array

NON_FINITE, TORQUE_LIMITED, UAV_STALE = Flag.NON_FINITE, Flag.TORQUE_LIMITED, Flag.UAV_STALE


@lru_cache
def parameters_layout(joints: int) -> np.dtype:
    """Parameters of the controller for an arm with `joints` joints, as one structured record."""
    return np.dtype(
        [
            ("mass", "f8"),
            ("inertia", "f8", (3, 3)),
            ("lever", "f8", (3,)),
            ("k1", "f8", (6,)),
            ("k2", "f8", (6,)),
            ("k3", "f8"),
            ("orientation_kp", "f8"),
            ("orientation_kd", "f8"),
            ("R_d", "f8", (3, 3)),
            ("elbow", "i8"),
            ("elbow_force", "f8"),
            ("null_damping", "f8"),
            ("range_margin", "f8"),
            ("range_stiffness", "f8"),
            ("thrust", "f8"),
            ("extra_torque", "i8"),
            ("acceleration_feedforward", "i8"),
            ("measured_support", "i8"),
            ("tool_weight", "f8"),
            ("tau_max", "f8", (joints,)),
            ("q_min", "f8", (joints,)),
            ("q_max", "f8", (joints,)),
            ("onboard_kp", "f8", (3,)),
            ("onboard_kd", "f8", (3,)),
            ("watchdog", "i8"),
            ("tick_s", "f8"),
        ]
    )


@njit(cache=True)
def screen(tick: NDArray[np.void], good: NDArray[np.void], qpos: Array, qvel: Array) -> None:
    """Replace what is not finite in the measurement by the last good value, say so in the health, copy q and q̇ out.

    Args:
        tick: all messages (1,), `tick_layout`.
        good: the last good measurement (1,), updated.
        qpos: receives the joint positions (n,).
        qvel: receives the joint velocities (n,).
    """
    m, g, h = tick[0].measurement, good[0], tick[0].health
    bad = keep_finite(m.q, g.q) + keep_finite(m.qd, g.qd) + keep_finite(m.wrench, g.wrench)
    bad += keep_finite(m.uav_quat, g.uav_quat) + keep_finite(m.uav_rate, g.uav_rate)
    h.flags = NON_FINITE if bad else 0
    for i in range(m.q.shape[0]):
        qpos[i] = m.q[i]
        qvel[i] = m.qd[i]


@njit(cache=True)
def keep_finite(values: Array, last: Array) -> int:
    """Replace values that are not finite by those of `last`, which is then brought up to date; returns how many."""
    bad = 0
    for i in range(values.shape[0]):
        if np.isfinite(values[i]):
            last[i] = values[i]
        else:
            values[i] = last[i]
            bad += 1
    return bad


@njit(cache=True)
def estimate_state(m: Record, p: Record, arm: Record, e: Record) -> None:
    """Fill the estimate: pivot from the arm's joints, attitude as last received, hinge force without the tool's weight."""
    e.tick = m.tick
    for i in range(3):
        e.r[i] = arm.position[i]
        speed = 0.0
        for k in range(m.q.shape[0]):
            speed += arm.jacobian[i, k] * m.qd[k]
        e.v[i] = speed
        e.omega[i] = m.uav_rate[i]
        e.hinge_force[i] = (
            arm.rotation[i, 0] * m.wrench[0] + arm.rotation[i, 1] * m.wrench[1] + arm.rotation[i, 2] * m.wrench[2]
        )
    e.hinge_force[2] -= p.tool_weight
    for i in range(4):
        e.quat[i] = m.uav_quat[i]
    level, still = np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3)
    gains = QuaternionPdGains(p.onboard_kp, p.onboard_kd)
    tau_att, _ = quaternion_pd(e.quat, e.omega, level, still, still, gains, initial_memory(still))
    for i in range(3):
        e.tau_att[i] = tau_att[i]


@njit(cache=True)
def follow(path: Array, tick: int, r: Record) -> None:
    """Fill the reference from row `tick` of `path` (ticks, 9): r_d, ṙ_d, r̈_d; past its end the last row holds."""
    row = path[min(tick, path.shape[0] - 1)]
    r.tick = tick
    for i in range(3):
        r.r[i] = row[i]
        r.v[i] = row[3 + i]
        r.a[i] = row[6 + i]
    r.quat[0] = 1.0
    for i in range(3):
        r.quat[1 + i] = 0.0


@njit(cache=True)
def uav_law(e: Record, r: Record, p: Record, c: Record) -> None:
    """Fill Δτ_att, f_T and F_EE of the command: (29) with Table II's switches.

    Source: (29), (33) and Table II. The velocity is the pivot's, which the arm measures: the paper drops ω × ρ.
    """
    uav = UavParameters(p.mass, p.inertia, p.lever)
    gains = BacksteppingGains(p.k1, p.k2, p.k3)
    force = impedance_force(r.r - e.r, e.v, uav, gains)  # (33)
    if p.measured_support:
        force[2] += e.hinge_force[2]
    for i in range(3):
        c.force[i] = force[i]
        c.delta_tau[i] = 0.0
    c.thrust = p.thrust
    if p.extra_torque:
        delta_tau, _ = paper_law(e.quat, e.omega, e.r, e.v, r.quat, r.r, p.thrust, e.tau_att, uav, gains)  # (29)
        for i in range(3):
            c.delta_tau[i] = delta_tau[i]


@njit(cache=True)
def arm_law(m: Record, r: Record, p: Record, arm: Record, mu: Array, c: Record) -> None:
    """Fill the joint torques of the command: τ_j = g + τ_nsp + 𝒥ᵀ(Λ ẍ_d + μ ẋ_d) + 𝒥ᵀ(F_EE, τ_ori). Source: (35)."""
    n = m.q.shape[0]
    omega = np.zeros(3)
    for i in range(3):
        for k in range(n):
            omega[i] += arm.jacobian[3 + i, k] * m.qd[k]
    torque = orientation_pd(arm.rotation, p.R_d, omega, p.orientation_kp, p.orientation_kd)
    wrench = mu.copy()
    for i in range(3):
        c.torque[i] = torque[i]
        wrench[i] += c.force[i]
        wrench[3 + i] += torque[i]
    if p.acceleration_feedforward:
        for i in range(6):
            for k in range(3):
                wrench[i] += arm.lambda_ee[i, k] * r.a[k]
    tau0 = elbow_field(arm.axis, arm.anchor, p.elbow, p.elbow_force) + range_field(
        m.q, p.q_min, p.q_max, p.range_margin, p.range_stiffness
    )
    for i in range(n):
        tau0[i] -= p.null_damping * m.qd[i]
    tau_nsp = null_space_torque(tau0, arm.mass_matrix, arm.jacobian, arm.lambda_ee)
    for i in range(n):
        tau = arm.gravity[i] + tau_nsp[i]
        for k in range(6):
            tau += arm.jacobian[k, i] * wrench[k]
        c.tau[i] = tau  # (35)


@njit(cache=True)
def limit(m: Record, p: Record, c: Record, h: Record) -> None:
    """Keep the joint torques within their limits and fill the health message."""
    h.tick = m.tick
    c.tick = m.tick
    h.torque_ratio = 0.0
    h.joint_margin = np.inf
    for i in range(m.q.shape[0]):
        h.torque_ratio = max(h.torque_ratio, abs(c.tau[i]) / p.tau_max[i])
        h.joint_margin = min(h.joint_margin, min(m.q[i] - p.q_min[i], p.q_max[i] - m.q[i]))
        if abs(c.tau[i]) > p.tau_max[i]:
            h.flags |= TORQUE_LIMITED
            c.tau[i] = min(max(c.tau[i], -p.tau_max[i]), p.tau_max[i])
    h.uav_age = (m.tick - m.uav_tick) * p.tick_s
    if m.tick - m.uav_tick > p.watchdog:
        h.flags |= UAV_STALE


@njit(cache=True)
def coordinated_tick(
    tick: NDArray[np.void], path: Array, p_: NDArray[np.void], arm_: NDArray[np.void], mu: Array
) -> None:
    """The whole tick, in the order of the loop.

    Args:
        tick: all messages (1,), `tick_layout`; `health.flags` says what screening found.
        path: desired position, velocity, acceleration at each tick (ticks, 9), m, m/s, m/s², world.
        p_: parameters (1,), `parameters_layout`.
        arm_: the arm model's state (1,), `armland.models.arm.state_layout`.
        mu: μ ẋ_d (6,), N, N·m, world; zero where it is neglected.
    """
    t, p, arm = tick[0], p_[0], arm_[0]
    estimate_state(t.measurement, p, arm, t.estimate)
    follow(path, t.measurement.tick, t.reference)
    uav_law(t.estimate, t.reference, p, t.command)
    arm_law(t.measurement, t.reference, p, arm, mu, t.command)
    limit(t.measurement, p, t.command, t.health)
