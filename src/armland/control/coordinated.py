"""The laws of the coordinated controller: what UAV and arm are asked for, (29) or (X.1) and (35), and the limits; compiled.

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

from armland.control.attitude import QuaternionPdGains, initial_memory, quaternion_pd
from armland.control.backstepping import (
    GRAVITY,
    BacksteppingGains,
    ExactGains,
    Reference,
    UavParameters,
    exact_law,
    exact_lyapunov,
    impedance_force,
    lyapunov,
    paper_law,
    support_force,
)
from armland.control.impedance import elbow_field, orientation_pd, range_field
from armland.control.limits import feasible, takeover
from armland.models.operational import null_space_torque
from armland.records import Flag, Record
from armland.rotations import Array, cross, matrix, turned, turned_back

LAWS = ("classical", "paper", "exact")
EXTRA_TORQUES = ("none", "full", "feedforward")
ACCELERATIONS = ("none", "reference", "implied")
SUPPORTS = ("none", "measured", "model")

CLASSICAL, PAPER, EXACT = range(3)
FULL, FEEDFORWARD = 1, 2
REFERENCE, IMPLIED = 1, 2
MEASURED, MODEL = 1, 2

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
            ("k3_attitude", "f8"),
            ("law", "i8"),  # index into LAWS
            ("extra_torque", "i8"),  # index into EXTRA_TORQUES
            ("acceleration", "i8"),  # index into ACCELERATIONS
            ("support", "i8"),  # index into SUPPORTS
            ("preview", "i8"),  # ticks by which the fed-forward torque looks ahead
            ("torque_limit", "f8", (3,)),
            ("observer", "f8"),  # rad/s; 0 is none
            ("force_limit", "f8"),  # N, of the observer
            ("moment_limit", "f8"),  # N·m
            ("limited", "i8"),  # whether thrust and torque are kept within what the rotors can give (X.4)
            ("mixer_inverse", "f8", (4, 4)),
            ("rotor_min", "f8"),  # N
            ("rotor_max", "f8"),  # N
            ("takeover_limit", "f8"),  # N, force of the arm that stands in for torque
            ("orientation_kp", "f8"),
            ("orientation_kd", "f8"),
            ("R_d", "f8", (3, 3)),
            ("elbow", "i8"),
            ("elbow_force", "f8"),
            ("null_damping", "f8"),
            ("range_margin", "f8"),
            ("range_stiffness", "f8"),
            ("thrust", "f8"),
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
def predict_attitude_torque(p: Record, e: Record) -> None:
    """Fill τ_att of the estimate: what the controller on board makes of the attitude that was received last."""
    level, still = np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3)
    gains = QuaternionPdGains(p.onboard_kp, p.onboard_kd)
    tau_att, _ = quaternion_pd(e.quat, e.omega, level, still, still, gains, initial_memory(still))
    for i in range(3):
        e.tau_att[i] = tau_att[i]


@njit(cache=True)
def uav_law(e: Record, r: Record, p: Record, path: Array, c: Record) -> Array:
    """Fill Δτ_att, f_T and F_EE of the command; returns the acceleration (3,), m/s², that they imply for the pivot.

    Source: (6), (29) with Table II's switches, or (X.1), (X.2), (X.6). The paper's laws take the pivot's velocity, which the
    arm measures, for the CM's: they drop ω × ρ.
    """
    uav = UavParameters(p.mass, p.inertia, p.lever)
    R = matrix(e.quat)
    delta_tau, r_ddot = np.zeros(3), np.zeros(3)
    if p.law == EXACT:
        still = np.zeros(3)
        reference = Reference(r.quat, still, still, r.r, r.v, r.a)
        gains = ExactGains(p.k1, p.k2, p.k3_attitude, p.k3)
        v_cm = e.v - turned(R, cross(e.omega, p.lever))
        delta_tau, force = exact_law(e.quat, e.omega, e.r, v_cm, reference, p.thrust, e.tau_att, uav, gains)  # (X.1)
        force = force - e.disturbance  # (X.3)
    else:
        paper_gains = BacksteppingGains(p.k1, p.k2, p.k3)
        rate = e.v - r.v if p.law == CLASSICAL else e.v + 0.0  # (6) damps the error, (33) the velocity
        force = impedance_force(r.r - e.r, rate, uav, paper_gains)  # (6), (33)
        if p.support == MEASURED:
            force[2] += e.hinge_force[2]
        elif p.support == MODEL:
            force += support_force(e.quat, p.thrust, uav)
        if p.extra_torque == FULL:
            delta_tau, _ = paper_law(
                e.quat, e.omega, e.r, e.v, r.quat, r.r, p.thrust, e.tau_att, uav, paper_gains
            )  # (29)
    if p.extra_torque == FEEDFORWARD:
        # What travels arrives late and acts through the rotors' lag; the reference's part is known ahead.
        ahead = path[min(r.tick + p.preview, path.shape[0] - 1)]
        # The sensor knows the hinge's force whatever wind or model do; the tool behind it accelerates with the pivot.
        coming = e.hinge_force - p.tool_weight / GRAVITY * r.a + p.mass * (ahead[6:9] - r.a)
        delta_tau = np.minimum(
            np.maximum(-cross(p.lever, turned_back(R, coming)), -p.torque_limit), p.torque_limit
        )  # (X.6)
    thrust = p.thrust
    if p.limited:
        # Roll and pitch come first; the thrust that they cost, and the torque that is lost all the same, the arm makes up for.
        asked = e.tau_att + delta_tau
        thrust, given = feasible(p.thrust, asked, p.mixer_inverse, p.rotor_min, p.rotor_max)
        push, _ = takeover(R, 0.0, asked - given, p.lever, p.takeover_limit)
        force = force + (p.thrust - thrust) * R[:, 2] + push  # (X.4)
    if p.acceleration == IMPLIED:
        # The torques on board cancel the hinge's in (X.6): what is left turns the UAV little, and noise would dominate it.
        lift = R[:, 2] * thrust
        for i in range(3):
            r_ddot[i] = (force[i] + lift[i] + e.disturbance[i]) / p.mass
        r_ddot[2] -= GRAVITY
        r_ddot += turned(R, cross(e.omega, cross(e.omega, p.lever)))  # (X.2)
    for i in range(3):
        c.force[i] = force[i]
        c.delta_tau[i] = delta_tau[i] if p.extra_torque else 0.0
    c.thrust = thrust
    return r_ddot


@njit(cache=True)
def prove(e: Record, r: Record, p: Record, proof: Record) -> None:
    """Fill V₂ (26) and the rate (30) that it has under the law in use, on the kinematics that this law assumes."""
    proof.tick = e.tick
    uav, still = UavParameters(p.mass, p.inertia, p.lever), np.zeros(3)
    if p.law == EXACT:
        v_cm = e.v - turned(matrix(e.quat), cross(e.omega, p.lever))
        reference = Reference(r.quat, still, still, r.r, r.v, r.a)
        gains = ExactGains(p.k1, p.k2, p.k3_attitude, p.k3)
        proof.v2, proof.v2_rate = exact_lyapunov(e.quat, e.omega, e.r, v_cm, reference, uav, gains)  # (X.1)
    else:
        paper_gains = BacksteppingGains(p.k1, p.k2, p.k3)
        proof.v2, proof.v2_rate = lyapunov(e.quat, e.omega, e.r, e.v, r.quat, r.r, uav, paper_gains)  # (26), (30)


@njit(cache=True)
def arm_law(m: Record, r: Record, p: Record, arm: Record, mu: Array, r_ddot: Array, c: Record) -> None:
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
    desired = np.zeros(6)
    if p.acceleration == REFERENCE:
        desired[:3] = r.a
    elif p.acceleration == IMPLIED:
        desired[:3] = r_ddot
        desired -= arm.acceleration_bias
    for i in range(6):
        for k in range(6):
            wrench[i] += arm.lambda_ee[i, k] * desired[k]
    tau0 = elbow_field(arm.axis, arm.anchor, p.elbow, p.elbow_force) + range_field(
        m.q, p.q_min, p.q_max, p.range_margin, p.range_stiffness
    )
    for i in range(n):
        tau0[i] -= p.null_damping * m.qd[i]
    tau_nsp = null_space_torque(tau0, arm.mass_matrix, arm.jacobian, arm.lambda_ee)
    for i in range(n):
        tau = arm.gravity[i] + tau_nsp[i]
        if p.acceleration == IMPLIED:
            tau += arm.coriolis[i]
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
