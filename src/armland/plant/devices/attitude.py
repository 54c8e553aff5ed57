"""The UAV's attitude loop on board: one of three controllers, and an observer of the torque that disturbs it; compiled.

| symbol | name | unit, frame |
|---|---|---|
| ω, J | `omega` (3,), `inertia` (3, 3) that the controller believes | rad/s, kg·m², B |
| d | torque (3,) that is neither the rotors' nor gyroscopic | N·m, B |
| l | `observer`: bandwidth of its observer (X.3); 0: none | rad/s |
"""

from typing import Any

import numpy as np
from numba import njit

from armland.control.design.gains import DERIVATIVE_LAG_S
from armland.control.laws.attitude import (
    AttitudeMemory,
    CascadeGains,
    GeometricGains,
    QuaternionPdGains,
    cascade,
    geometric,
    quaternion_pd,
)
from armland.estimation.disturbance import observe_moment
from armland.models.parameters import uav_parameters
from armland.records import Record, Records
from armland.rotations import Array, cross, turned
from armland.scenario import Scenario

CONTROLLERS = ("quaternion_pd", "geometric", "cascade")
GEOMETRIC, CASCADE = 1, 2

INTEGRAL_RAD = 0.2
"""Lean that its integral can make up for; assumption."""

UNLIMITED = 1e9
"""rad/s and N·m: the cascade's own limits are not used, the rotors have theirs."""


def attitude_layout() -> list[Any]:
    """Fields that the loop is told."""
    return [
        ("controller", "i8"),  # index into CONTROLLERS
        ("kp", "f8", (3,)),  # N·m/rad
        ("kd", "f8", (3,)),  # N·m·s/rad
        ("k_angle", "f8", (3,)),  # the cascade's gains, see `tell_attitude`
        ("k_rate", "f8", (3,)),
        ("k_change", "f8", (3,)),
        ("k_leaning", "f8", (3,)),  # N·m/rad, of the rate loop's integral
        ("most_leaning", "f8", (3,)),  # N·m
        ("period_s", "f8"),
        ("inertia", "f8", (3, 3)),
        ("observer", "f8"),
        ("lag_gain", "f8"),  # share of a step that a rotor makes between two samples on board
    ]


def tell_attitude(told: Records, scenario: Scenario) -> None:
    """Fill the fields of `attitude_layout` in `told` (1,)."""
    o = scenario.onboard
    told["controller"], told["kp"], told["kd"] = CONTROLLERS.index(o.controller), o.kp_nm, o.kd_nms
    told["observer"], told["period_s"] = o.observer_rad_s, 1.0 / o.rate_hz
    # PD times (1 + lead s): the cascade's derivative on the rate makes up for the rotors' lag.
    told["k_rate"] = told["kd"] + told["kp"] * o.lead_s
    told["k_angle"], told["k_change"] = told["kp"] / told["k_rate"], told["kd"] * o.lead_s
    if o.integral_s > 0.0:
        told["k_leaning"] = told["k_rate"] / o.integral_s
    told["most_leaning"] = INTEGRAL_RAD * told["kp"]
    told["lag_gain"] = 1.0 - np.exp(-1.0 / (o.rate_hz * scenario.rotors.time_constant_s))
    told["inertia"] = uav_parameters(scenario).inertia


@njit(cache=True)
def attitude_torque(quat: Array, omega: Array, q_d: Array, p: Record, s: Record) -> Array:
    """Torque (3,) N·m, B, that turns the UAV towards `q_d`.

    Args:
        quat: measured attitude (4,), scalar first, the UAV's W<-B.
        omega: measured rates (3,), rad/s, B.
        q_d: desired attitude (4,).
        p: fields of `attitude_layout`.
        s: `filtered` (3,) rad/s and `leaning` (3,) N·m, the cascade's integral, are updated.
    """
    still = np.zeros(3)
    memory = AttitudeMemory(s.leaning.copy(), s.filtered.copy())
    if p.controller == GEOMETRIC:
        gains_g = GeometricGains(p.kp, p.kd, p.inertia)
        torque, _ = geometric(quat.copy(), omega.copy(), q_d, still, still, gains_g, memory)
    elif p.controller == CASCADE:
        far = np.array([UNLIMITED, UNLIMITED, UNLIMITED])
        gains_c = CascadeGains(p.k_angle, far, p.k_rate, p.k_leaning, p.k_change, far, DERIVATIVE_LAG_S, p.period_s)
        torque, memory = cascade(quat.copy(), omega.copy(), q_d, still, still, gains_c, memory)
        for i in range(3):
            s.filtered[i] = memory.rate[i]
            s.leaning[i] = min(max(memory.integral[i], -p.most_leaning[i]), p.most_leaning[i])
    else:
        gains_q = QuaternionPdGains(p.kp, p.kd)
        torque, _ = quaternion_pd(quat.copy(), omega.copy(), q_d, still, still, gains_q, memory)
    return torque


@njit(cache=True)
def find_disturbance(omega: Array, extra: Array, asked: Array, mixer: Array, p: Record, s: Record) -> Array:
    """Momentum observer of the disturbing torque d (3,), N·m, B; the rotors' lag is modelled. Source: (X.3).

    What comes over the link is there to cancel part of d, so it counts as part of what is left to find.

    Args:
        omega: measured rates (3,), rad/s, B.
        extra: torque (3,) N·m over the link.
        asked: thrusts (8,) N that were asked for last.
        mixer: (4, 8), 1 and m, thrust and torques per rotor's thrust, `models.airframe.rotor_set.effect_of`.
        p: fields of `attitude_layout`.
        s: `torque`, `impulse`, `momentum` and `disturbance` are updated.
    """
    if p.observer == 0.0:
        return np.zeros(3)
    momentum = turned(p.inertia, omega)
    gyroscopic = cross(omega, momentum)
    observe_moment(momentum, s.impulse, p.period_s, p.observer, s.momentum, s.disturbance)
    for i in range(3):
        given = -extra[i]
        for k in range(mixer.shape[1]):
            given += mixer[i + 1, k] * asked[k]
        s.torque[i] += p.lag_gain * (given - s.torque[i])
        s.impulse[i] = p.period_s * (s.torque[i] - gyroscopic[i])
    return s.disturbance.copy()
