"""Joint torques for a wanted force and acceleration of the end effector (35), and the acceleration that a law implies (X.2); compiled.

| symbol | name | unit |
|---|---|---|
| F_EE, τ_ori | `wrench` (6,), of the end effector on what it carries, D | N, N·m |
| ẍ | `acceleration` (6,) of the end effector, D | m/s², rad/s² |
| r̈_p | acceleration of the pivot (3,), D | m/s² |
| τ_j | `tau` (n,) | N·m |
| μ ẋ_d | part of `wrench` where it is fed forward | N, N·m |
"""

from functools import lru_cache

import numpy as np
from numba import njit

from armland.control.laws.impedance import orientation_pd
from armland.control.laws.nullspace import null_space_wish
from armland.control.laws.rigid_body import Gravity, UavParameters
from armland.errors import ConfigurationError
from armland.models import friction
from armland.models.arm import ArmModel
from armland.models.elbow import elbow
from armland.models.operational import null_space_torque
from armland.records import Record, Records
from armland.rotations import Array, cross, turned
from armland.scenario import Scenario


@lru_cache
def told_layout(joints: int) -> np.dtype:
    """What realising a force through an arm of `joints` joints needs to be told."""
    return np.dtype(
        [
            ("orientation_kp", "f8"),  # N·m/rad
            ("orientation_kd", "f8"),  # N·m·s/rad
            ("R_d", "f8", (3, 3)),  # D<-E, where the end effector shall point
            ("elbow", "i8"),
            ("elbow_force", "f8"),  # N
            ("null_damping", "f8"),  # N·m·s/rad
            ("posture", "f8", (joints,)),  # rad, pose to which the null space is drawn
            ("posture_rate", "f8"),  # rad/s, bandwidth of that
            ("range_margin", "f8"),  # rad
            ("range_stiffness", "f8"),  # N·m/rad
            ("q_min", "f8", (joints,)),  # rad
            ("q_max", "f8", (joints,)),  # rad
            ("friction", "f8", (joints,)),  # N·m, that is made up for
            ("damping", "f8", (joints,)),  # N·m·s/rad, likewise
        ]
    )


def told(scenario: Scenario, arm: ArmModel, R_d: Array, posture: Array | None = None) -> Records:
    """The record (1,) of `told_layout` for a scenario and its arm model.

    Args:
        scenario: believed.
        arm: its model.
        R_d: the end effector's rotation (3, 3), D<-E.
        posture: pose (n,), rad, to which the null space is drawn; none if absent.

    Raises:
        ConfigurationError: the arm has no joint of the name that `arm.elbow_joint` gives.
    """
    c, p = scenario.control, np.zeros(1, told_layout(arm.joints))
    p["orientation_kp"], p["orientation_kd"], p["R_d"] = c.orientation_kp, c.orientation_kd, R_d
    p["elbow"], p["elbow_force"] = elbow_of(scenario, arm), c.elbow_force_n
    if posture is not None:
        p["posture"], p["posture_rate"] = posture, c.posture_rad_s
    p["null_damping"], p["range_margin"] = c.null_space_damping_nms, c.range_margin_rad
    p["range_stiffness"], p["q_min"], p["q_max"] = c.range_stiffness_nm, arm.q_min, arm.q_max
    p["friction"], p["damping"] = friction.known(arm.friction), friction.known(arm.damping)
    return p


def elbow_of(scenario: Scenario, arm: ArmModel) -> int:
    """Index of the elbow's joint: the one that `arm.elbow_joint` names, or that `models.elbow` finds.

    Raises:
        ConfigurationError: the arm has no joint of that name; says which it has.
    """
    name = scenario.arm.elbow_joint
    if name is None:
        return elbow(arm.model)
    if name not in arm.joint_names:
        raise ConfigurationError(
            f"arm.elbow_joint: the arm has no joint {name!r}; its joints are: {', '.join(arm.joint_names)}"
        )
    return arm.joint_names.index(name)


@njit(cache=True)
def end_effector_rate(qd: Array, arm: Record) -> Array:
    """ω (3,), rad/s, D, of the end effector at joint velocities qd (n,), rad/s; `arm` of `models.chain.state_layout`."""
    omega = np.zeros(3)
    for i in range(3):
        for k in range(qd.shape[0]):
            omega[i] += arm.jacobian[3 + i, k] * qd[k]
    return omega


@njit(cache=True)
def orientation_torque(omega: Array, arm: Record, p: Record) -> Array:
    """τ_ori (3,), N·m, D, that holds the end effector at R_d; `omega` (3,), rad/s, D, is its rate, `p` of `told_layout`."""
    return orientation_pd(arm.rotation, p.R_d, omega, p.orientation_kp, p.orientation_kd)


@njit(cache=True)
def arm_torque(
    q: Array,
    qd: Array,
    acceleration: Array,
    wrench: Array,
    velocity_terms: bool,
    arm: Record,
    p: Record,
    tau: Array,
) -> None:
    """Fill `tau` (n,), N·m: τ_j = g + τ_nsp + 𝒥ᵀ(Λ ẍ + (F_EE, τ_ori)), and with velocity terms C φ̇ + … Λ(ẍ − 𝒥̇ φ̇).

    Args:
        q: joint positions (n,), rad.
        qd: joint velocities (n,), rad/s.
        acceleration: ẍ (6,), m/s², rad/s², D, that the end effector shall have; zeros feed none forward.
        wrench: (6,), N, N·m, D, of the end effector on what it carries; may hold μ ẋ_d.
        velocity_terms: whether the arm's velocity-dependent torques are compensated, so that its acceleration is exactly ẍ.
        arm: of `models.chain.state_layout`, its velocity terms included where they are asked for.
        p: of `told_layout`.
        tau: written.

    Source: (35); with velocity terms (X.2).
    """
    n = q.shape[0]
    total = wrench.copy()
    for i in range(6):
        for k in range(6):
            beyond = acceleration[k] - arm.acceleration_bias[k] if velocity_terms else acceleration[k]
            total[i] += arm.lambda_ee[i, k] * beyond
    tau_nsp = null_space_torque(null_space_wish(q, qd, arm, p), arm.cholesky, arm.jacobian, arm.lambda_ee)
    for i in range(n):
        sum_ = arm.gravity[i] + tau_nsp[i]
        if velocity_terms:
            sum_ += arm.coriolis[i]
        for k in range(6):
            sum_ += arm.jacobian[k, i] * total[k]
        tau[i] = sum_  # (35)
    friction.make_up(qd, p.friction, p.damping, tau)


@njit(cache=True)
def held_acceleration(R: Array, omega: Array, force: Array, uav: UavParameters, gravity: Gravity) -> Array:
    """r̈_p (3,), m/s², D: acceleration of the pivot that the force implies, v̇ + R(ω × (ω × ρ)).

    Fed forward to the arm as Λ r̈_p it makes the hinge force equal to the force asked for, in the nominal model. R(ω̇ × ρ) is left out:
    under (X.6) the torques on board cancel the hinge's, so ω̇ is small, and noise would dominate it.

    Args:
        R: rotation (3, 3), D<-B.
        omega: (3,), rad/s, body.
        force: (3,), N, D: all but gravity, of arm, rotors and what else is known to act.
        uav: rigid body.
        gravity: γ, m/s², D.

    Source: (X.2).
    """
    swing = turned(R, cross(omega, cross(omega, uav.lever)))
    for i in range(3):
        swing[i] += force[i] / uav.mass + gravity[i]  # (X.2)
    return swing
