"""The table of laws for a UAV that the arm holds: what arm and rotors are asked for, by row and by the switches of Table II; compiled.

| row | law |
|---|---|
| `classical` | impedance (6) on the error, with the stiffness and damping of (33) |
| `paper` | (33), and (29) where the torque is asked for |
| `exact` | (X.1) |
| `FILE.py:FUNCTION` | a user's own, see `control.laws.own` |

| switch | says |
|---|---|
| extra torque | Δτ_att over the link: none, all of the law's, or only what cancels the hinge's force (X.6) |
| acceleration | what the arm feeds forward: nothing, ẍ_d as in (35), or what the law implies (X.2) |
| support | static support force of (33): none, the measured z force, or the model's |
| limited | thrust and torque within what the rotors give, the arm takes over the rest (X.4) |
| attitude | whether the law controls the attitude; if not, the UAV's own controller does, and q_d is the attitude as estimated |
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numba import float64, njit

from armland.control.laws.attitude import feed_forward
from armland.control.laws.backstepping import (
    impedance_force,
    lyapunov,
    paper_law,
    spring_and_damper,
    support_force,
)
from armland.control.laws.exact import Reference, exact_law, exact_lyapunov
from armland.control.laws.impedance import impedance
from armland.control.laws.limits import feasible, takeover
from armland.control.laws.own import GIVEN, call, pack
from armland.control.laws.realisation import held_acceleration
from armland.control.laws.rigid_body import BacksteppingGains, ExactGains, Gravity, UavParameters
from armland.linking import VECTOR, heads, linked, record
from armland.models.airframe.allocation import allocation_layout
from armland.models.environment import apparent_gravity, apparent_moment, environment_layout
from armland.records import Record
from armland.rotations import Array, cross, matrix, turned

LAWS = ("classical", "paper", "exact")
"""Rows that come with the package; a user's own is the one behind them."""
EXTRA_TORQUES = ("none", "full", "feedforward")
ACCELERATIONS = ("none", "reference", "implied")
SUPPORTS = ("none", "measured", "model")

CLASSICAL, PAPER, EXACT, OWN = range(4)
FULL, FEEDFORWARD = 1, 2
REFERENCE, IMPLIED = 1, 2
MEASURED, MODEL = 1, 2


@lru_cache
def told_layout() -> np.dtype:
    """What `held_law` is told."""
    return np.dtype(
        [
            ("law", "i8"),  # index into LAWS; OWN: at `address`
            ("address", "i8"),  # of a user's law
            ("extra_torque", "i8"),  # index into EXTRA_TORQUES
            ("acceleration", "i8"),  # index into ACCELERATIONS
            ("support", "i8"),  # index into SUPPORTS
            ("limited", "i8"),
            ("attitude", "i8"),
            ("preview", "i8"),  # ticks by which the fed-forward torque looks ahead
            ("mass", "f8"),  # kg, that the hinge carries
            ("inertia", "f8", (3, 3)),  # kg·m² [B]
            ("lever", "f8", (3,)),  # m [B]
            ("k1", "f8", (6,)),
            ("k2", "f8", (6,)),
            ("k3", "f8"),
            ("k3_attitude", "f8"),
            ("tool_mass", "f8"),  # kg, between force-torque sensor and hinge
            ("torque_limit", "f8", (3,)),  # N·m, of Δτ_att over the link
            ("allocation", np.dtype(allocation_layout())),
            ("takeover_limit", "f8"),  # N, force of the arm that stands in for torque
        ]
    )


@lru_cache
def kept_layout() -> np.dtype:
    """What `held_law` keeps: what it found last, and what a user's law was given and returned when it failed."""
    return np.dtype(
        [
            ("implied", "f8", (3,)),  # m/s² [D], acceleration of the pivot
            ("failed", "i8"),  # see `own`; 0: all is well
            ("tick", "i8"),  # of the failure
            ("given", "f8", (GIVEN,)),
            ("returned", "f8", (6,)),
        ]
    )


class State(NamedTuple):
    """What a law sees of one tick, as plain arrays: fields of records are another type, for which every law would be compiled again."""

    q: Array
    omega: Array
    r: Array
    v: Array
    """Pivot's velocity (3,), m/s, D."""
    v_cm: Array
    R: Array
    thrust: float
    tau_att: Array
    gravity: Gravity
    uav: UavParameters


@linked(
    lambda _: (
        *(float64, VECTOR, *heads("estimate", "reference"), record(environment_layout())),
        *(record(told_layout()), record(kept_layout()), *heads("command")),
    )
)
@njit(cache=True)
def held_law(
    thrust: float,
    ahead: Array,
    e: Record,
    r: Record,
    environment: Record,
    p: Record,
    s: Record,
    c: Record,
) -> None:
    """Fill Δτ_att, F_EE and f_T of the command `c`, and the acceleration `s.implied` (3,), m/s², D, that they mean for the pivot.

    Args:
        thrust: f_T, N: asked of the UAV on the hinge, or as it acts.
        ahead: the reference's acceleration (3,), m/s², D, `p.preview` ticks from now.
        e: estimate of the tick; its disturbance is zero without an observer.
        r: reference of the tick.
        environment: of `models.environment.environment_layout`.
        p: of `told_layout`.
        s: of `kept_layout`, updated.
        c: command of the tick, `linking.head`.

    A user's law that fails is replaced by `exact` from that tick on; `s.failed` says so.

    Source: (6), (29), (33), (X.1), (X.4), (X.6), each in its module. The paper's laws take the pivot's velocity, which the arm
    measures, for the CM's: they drop ω × ρ.
    """
    now = _state(thrust, e, environment, p)
    delta_tau, force = _asked(now, e, r, p, s)
    if p.law >= EXACT:
        # Less what the observer holds responsible: the arm makes up for it.
        for i in range(3):
            force[i] -= e.disturbance[i]
    if p.extra_torque == FEEDFORWARD:
        # The sensor knows the hinge's force whatever wind or model do; the tool behind it accelerates with the pivot. What
        # travels arrives late and acts through the rotors' lag; the reference's part is known ahead.
        coming = np.empty(3)
        for i in range(3):
            coming[i] = e.hinge_force[i] - p.tool_mass * r.a[i] + p.mass * (ahead[i] - r.a[i])
        delta_tau = feed_forward(now.R, coming, now.uav.lever, p.torque_limit.copy())
    if p.limited:
        # Roll and pitch come first; the thrust that they cost, and the torque that is lost all the same, the arm makes up for.
        thrust = _share(now, delta_tau, force, e, p)
    if p.acceleration == IMPLIED:
        acting = np.empty(3)
        for i in range(3):
            acting[i] = force[i] + thrust * now.R[i, 2] + e.disturbance[i]
        implied = held_acceleration(now.R, now.omega, acting, now.uav, now.gravity)
        for i in range(3):
            s.implied[i] = implied[i]
    for i in range(3):
        c.force[i] = force[i]
        c.delta_tau[i] = delta_tau[i] if p.extra_torque else 0.0
    c.thrust = thrust


@njit(cache=True)
def _share(now: State, delta_tau: Array, force: Array, e: Record, p: Record) -> float:
    # Thrust, N, that the rotors give beside the torque; what they do not give is added to the arm's force.
    asked = e.tau_att.copy() + delta_tau
    thrust, given = feasible(now.thrust, asked, p.allocation)
    push, _ = takeover(now.R, 0.0, asked - given, now.uav.lever, p.takeover_limit)
    for i in range(3):
        force[i] += (now.thrust - thrust) * now.R[i, 2] + push[i]
    return thrust


@njit(cache=True)
def end_effector_acceleration(r: Record, p: Record, s: Record) -> Array:
    """ẍ (6,), m/s², rad/s², D, that `arm_torque` feeds forward, as Table II switches it.

    Args:
        r: reference.
        p: of `told_layout`.
        s: of `kept_layout`, as `held_law` left it.
    """
    desired = np.zeros(6)
    for i in range(3):
        if p.acceleration == REFERENCE:
            desired[i] = r.a[i]
        elif p.acceleration == IMPLIED:
            desired[i] = s.implied[i]
    return desired


@linked(lambda _: (*heads("estimate", "reference"), record(told_layout()), record(kept_layout()), *heads("proof")))
@njit(cache=True)
def held_lyapunov(e: Record, r: Record, p: Record, s: Record, proof: Record) -> None:
    """Fill `proof`: V₂ (26), J, and the rate (30), W, that it has under the law in use, on the kinematics that this law assumes.

    Arguments as in `held_law`. A user's own law promises none: NaN, until `exact` has taken over from it.
    """
    q, omega, v, R = e.quat.copy(), e.omega.copy(), e.v.copy(), matrix(e.quat.copy())
    uav = UavParameters(p.mass, p.inertia.copy(), p.lever.copy())
    proof.tick, proof.v2, proof.v2_rate = e.tick, np.nan, np.nan
    if p.law == EXACT or (p.law == OWN and s.failed):
        v_cm = v - turned(R, cross(omega, uav.lever))
        reference = _reference(q, r, p)
        proof.v2, proof.v2_rate = exact_lyapunov(q, omega, e.r.copy(), v_cm, reference, uav, _gains(p))
    elif p.law < EXACT:
        gains = BacksteppingGains(p.k1.copy(), p.k2.copy(), p.k3)
        q_d, r_d = r.quat.copy(), r.r.copy()
        proof.v2, proof.v2_rate = lyapunov(q, omega, e.r.copy(), v, q_d, r_d, uav, gains)


@njit(cache=True)
def _state(thrust: float, e: Record, environment: Record, p: Record) -> State:
    q, omega, v, r = e.quat.copy(), e.omega.copy(), e.v.copy(), e.r.copy()
    uav = UavParameters(p.mass, p.inertia.copy(), p.lever.copy())
    R = matrix(q)
    v_cm = v - turned(R, cross(omega, uav.lever))
    gravity = apparent_gravity(environment, r - turned(R, uav.lever), v_cm)
    tau_att = e.tau_att.copy() + apparent_moment(environment, R, omega, uav.inertia)
    return State(q, omega, r, v, v_cm, R, thrust, tau_att, gravity, uav)


@njit(cache=True)
def _reference(q: Array, r: Record, p: Record) -> Reference:
    still = np.zeros(3)
    return Reference(r.quat.copy() if p.attitude else q, still, still, r.r.copy(), r.v.copy(), r.a.copy())


@njit(cache=True)
def _gains(p: Record) -> ExactGains:
    return ExactGains(p.k1.copy(), p.k2.copy(), p.k3_attitude, p.k3)


@njit(cache=True)
def _asked(now: State, e: Record, r: Record, p: Record, s: Record) -> tuple[Array, Array]:
    # Δτ_att and F_EE of the row.
    if p.law < EXACT:
        return _published(now, e, r, p)
    reference, gains = _reference(now.q, r, p), _gains(p)
    if p.law == OWN and s.failed == 0:
        returned = np.zeros(6)
        state = now.q, now.omega, now.r, now.v_cm
        given = pack(state, reference, now.thrust, now.tau_att, now.uav, gains)
        s.failed = call(p.address, given, returned)
        if s.failed == 0:
            return returned[:3], returned[3:]
        s.tick = e.tick
        for i in range(GIVEN):
            s.given[i] = given[i]
        for i in range(6):
            s.returned[i] = returned[i]
    return exact_law(now.q, now.omega, now.r, now.v_cm, reference, now.thrust, now.tau_att, now.uav, gains, now.gravity)


@njit(cache=True)
def _published(now: State, e: Record, r: Record, p: Record) -> tuple[Array, Array]:
    # Laws (6) and (33) with the support that Table II switches, and (29) where its torque is wanted.
    gains, r_d = BacksteppingGains(p.k1.copy(), p.k2.copy(), p.k3), r.r.copy()
    if p.law == CLASSICAL:
        stiffness, damping = spring_and_damper(now.uav, gains)
        force = impedance(now.r - r_d, now.v - r.v.copy(), stiffness, damping)
    else:
        force = impedance_force(r_d - now.r, now.v, now.uav, gains)
    if p.support == MEASURED:
        force[2] += e.hinge_force[2]
    elif p.support == MODEL:
        support = support_force(now.q, now.thrust, now.uav, now.gravity)
        for i in range(3):
            force[i] += support[i]
    delta_tau = np.zeros(3)
    if p.extra_torque == FULL:
        delta_tau, _ = paper_law(
            now.q, now.omega, now.r, now.v, r.quat.copy(), r_d, now.thrust, now.tau_att, now.uav, gains, now.gravity
        )
    return delta_tau, force
