"""Momentum observer: torques on the arm's joints that neither motors nor model explain, from the joints' momentum; compiled.

| symbol | name | unit |
|---|---|---|
| φ̇ | `qd` (n,): joint velocities, measured | rad/s |
| M, C φ̇, g | of `arm`, `models.chain.state_layout`, the controller's own | kg·m², N·m |
| τ, F | motors' torques as sent (n,); force on what is known to touch the end effector (3,) | N·m; N, D |
| τ_f = f tanh(φ̇/v₀) + d φ̇ | `friction`, `damping` (n,): of the arm's file | N·m |
| r | `kept.r` (n,): what nothing explains | N·m |
| K, h | bandwidth, of which `gain` is what a step of length h makes; h: `period` | rad/s, 1/s; ticks |
| ε | `doubt` (n,): what model and motors may be wrong by | N·m |

The momentum p = M φ̇ obeys ṗ = τ − 𝒥ᵀF + τ_ext + Cᵀφ̇ − g − τ_f, as Ṁ = C + Cᵀ, and

    r = K (p − p₀ − ∫ (τ − 𝒥ᵀF + Cᵀφ̇ − g − τ_f + r) dt)                                                         (X.7)

is τ_ext behind a low pass of the first order, for contacts anywhere on the arm; no acceleration is needed. Over a step,
Δp − ∫ Cᵀφ̇ dt = M Δφ̇ + ∫ C φ̇ dt up to O(h²), since ΔM φ̇ = ∫ Ṁ φ̇ dt, so that neither Cᵀ nor an old M is kept:

    r ← r + K (M Δφ̇ + ∫ (C φ̇ + g + τ_f − τ + 𝒥ᵀF) dt − r h)                                                     (X.8)

An arm is touched where |r| > ε on a joint, with ε what the published deviations (`scenario.deviation`) make of the arm's own limits,
all at once and against us, twice: that is the level `harsh`, beyond which the arm is not the one that was described.

    ε = 2 (a τ_max + b (|g| + |τ − g|) + c |φ̇| + |𝒥_z| P + w |𝒥ᵀF|) + f + 6 σ_r                                     (X.9)

a: offset and dry friction; b: masses, gain, friction by load; c: viscous friction; P: a heavier tool, and what the rotors blow onto it;
w: gain and cross-talk of the force sensor. Of friction that the file has the whole f counts, since at rest it may be any part of it;
σ_r is what noise of φ̇ leaves in r.

Source: De Luca and Mattone, "Sensorless robot collision detection and hybrid force/motion control", 2005; the discrete form, 𝒥ᵀF and
the threshold are ours.
"""

from functools import lru_cache

import numpy as np
from numba import njit

from armland.models.arm import ArmModel
from armland.models.friction import SOFT_RAD_S
from armland.records import Record, Records
from armland.rotations import Array
from armland.scenario import Scenario
from armland.scenario.deviation import LEVELS, rows

BANDWIDTH_RAD_S = 30.0
"""K: a contact is known after a thirtieth of a second, and white noise of φ̇ of 1e-3 rad/s makes 0.03 N·m per kg·m² of it."""

PERIOD = 5
"""Ticks of a step: the lag is seven of them, and it costs a fifth."""

CLEAR_SIGMA = 6.0
"""Standard deviations of r by which noise alone touches no arm."""


@lru_cache
def told_layout(joints: int) -> np.dtype:
    """What the observer of an arm with `joints` joints is told."""
    each = [(name, "f8", (joints,)) for name in ("friction", "damping", "steady")]  # N·m, N·m·s/rad, N·m
    scalars = [(name, "f8") for name in ("tick_s", "gain", "share", "viscous", "load", "felt", "noise")]
    return np.dtype([("period", "i8"), *scalars, *each])


@lru_cache
def kept_layout(joints: int) -> np.dtype:
    """What it keeps; zeros at first, and where it shall begin anew."""
    each = [(name, "f8", (joints,)) for name in ("r", "qd", "static", "impulse", "reaction")]
    ratios = [("ratio", "f8"), ("peak", "f8")]  # largest |r| over ε of a joint: now, and of the flight so far
    return np.dtype([("begun", "i8"), *ratios, *each])


def told(scenario: Scenario, arm: ArmModel, weight: float) -> Records:
    """The record (1,) of `told_layout`.

    Args:
        scenario: as the controller believes it.
        arm: the controller's model.
        weight: of all that flies, N: what the rotors may blow onto the tool is a share of it.
    """
    most = {row.path: LEVELS["harsh"] * row.told.high for row in rows()}
    # Of a joint without a limit no share of it is known.
    limits = np.where(np.isfinite(arm.tau_max), arm.tau_max, 0.0)
    p: Records = np.zeros(1, told_layout(arm.joints))
    p["tick_s"], p["period"], step = 1.0 / scenario.run.rate_hz, PERIOD, PERIOD / scenario.run.rate_hz
    p["gain"] = -np.expm1(-BANDWIDTH_RAD_S * step) / step
    p["friction"], p["damping"] = arm.friction, arm.damping
    p["steady"] = (most["arm.torque"] + most["arm.coulomb"]) * limits + arm.friction
    p["share"] = most["arm.inertia"] + most["arm.torque_gain"] + most["arm.load_friction"]
    p["viscous"] = most["arm.viscous_nms"]
    gravity = float(np.linalg.norm(scenario.environment.gravity_mps2))
    p["load"] = most["wrench.tool_kg"] * gravity + most["air.downwash"] * weight
    p["felt"] = most["wrench.gain"] + 2.0 * most["wrench.cross"]
    # A sample enters by its change and is forgotten by the low pass: a variance of 2 K² σ²/(2 − K h).
    low_pass = np.sqrt(2.0 / (2.0 - p["gain"] * step))
    p["noise"] = CLEAR_SIGMA * p["gain"] * low_pass * scenario.sensors.joint_velocity_rad_s
    return p


@njit(cache=True)
def drive(tau: Array, force: Array, touches: bool, arm: Record, p: Record, s: Record) -> None:
    """Note what acts from this tick's sample to the next one's.

    Args:
        tau: (n,), N·m, as sent.
        force: F (3,), N, D, of the end effector on what it touches.
        touches: whether it is known to touch something: then F is no contact that nobody expects.
        arm: of `models.chain.state_layout`.
        p: of `told_layout`.
        s: of `kept_layout`, updated.
    """
    for i in range(tau.shape[0]):
        s.impulse[i] += tau[i] * p.tick_s
        if touches:
            felt = 0.0
            for k in range(3):
                felt += arm.jacobian[k, i] * force[k]
            s.impulse[i] -= felt * p.tick_s
            s.reaction[i] += abs(felt) * p.tick_s


@njit(cache=True)
def observe(qd: Array, arm: Record, p: Record, s: Record) -> None:
    """One step: bring r up to date with the impulse noted since the step before, and `ratio` with it.

    Args:
        qd: φ̇ (n,), rad/s.
        arm: of `models.chain.state_layout`, its velocity terms included.
        p: of `told_layout`.
        s: of `kept_layout`, updated.

    Source: (X.8), (X.9).
    """
    n, step, ratio = qd.shape[0], p.tick_s * p.period, 0.0
    for i in range(n):
        known = arm.coriolis[i] + arm.gravity[i] + p.damping[i] * qd[i]
        if p.friction[i] > 0.0:
            known += p.friction[i] * np.tanh(qd[i] / SOFT_RAD_S)
        if s.begun:
            change, square = 0.0, 0.0
            for k in range(n):
                change += arm.mass_matrix[i, k] * (qd[k] - s.qd[k])
                square += arm.mass_matrix[i, k] ** 2
            missed = change + 0.5 * step * (known + s.static[i]) - s.impulse[i]
            s.r[i] += p.gain * (missed - s.r[i] * step)  # (X.8)
            ratio = max(ratio, abs(s.r[i]) / doubt(i, qd[i], np.sqrt(square), arm, p, s))
        else:
            s.r[i] = 0.0
        s.static[i] = known
    for i in range(n):
        s.qd[i], s.impulse[i], s.reaction[i] = qd[i], 0.0, 0.0
    s.begun, s.ratio, s.peak = 1, ratio, max(ratio, s.peak)


@njit(cache=True)
def doubt(i: int, rate: float, inertia: float, arm: Record, p: Record, s: Record) -> float:
    """ε, N·m, of joint `i`, at the end of a step.

    Args:
        i: joint, from 0.
        rate: its velocity, rad/s.
        inertia: length of its row of M, kg·m².
        arm: of `models.chain.state_layout`.
        p: of `told_layout`.
        s: of `kept_layout`, with the step's impulse.
    """
    step = p.tick_s * p.period
    beyond = abs(s.impulse[i] / step - arm.gravity[i])
    uncertain = p.share * (abs(arm.gravity[i]) + beyond) + p.viscous * abs(rate) + p.load * abs(arm.jacobian[2, i])
    return p.steady[i] + uncertain + p.felt * s.reaction[i] / step + p.noise * inertia  # (X.9)
