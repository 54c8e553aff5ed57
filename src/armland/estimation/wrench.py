"""Force-torque sensor without its bias and without the tool: what the end effector puts on the UAV; compiled.

| symbol | name | unit, frame |
|---|---|---|
| w | `measured` (6,): force, torque of the flange on the tool, torque about the sensor's origin | N, N·m, sensor |
| m_t, c | `mass`, `com` (3,): the tool beyond the sensor | kg, m, sensor |
| R | `R` (3, 3) D<-sensor | 1 |
| a − γ | `lifted` (3,): acceleration of the tool's centre of mass less apparent gravity | m/s², D |
| β | `bias` (6,), of which `target` is the newest estimate | N, N·m, sensor |

Balance of the tool: w = β + (f_t, c × f_t) + w_EE with f_t = m_t Rᵀ(a − γ) (W.1), where w_EE is what the end effector puts
on what it carries. The tool's own angular momentum is neglected: with a radius of gyration of 3 cm it has 3e-4 kg·m².

β is learnt while the caller knows the end effector to be free, from the means of whole blocks. A block counts only when the next one
is complete, so a contact that is noticed within one block is not learnt. The β that is subtracted follows its estimate at a limited
rate, so the output never jumps because of β.
"""

from functools import lru_cache

import numpy as np
from numba import njit

from armland.records import Record, Records
from armland.rotations import Array, cross
from armland.scenario import Scenario

LEAST_N, LEAST_NM = 1e-3, 1e-4
"""Noise that a sensor has at least: below it the filter would trust one reading for ever."""


@lru_cache
def told_layout() -> np.dtype:
    """What `compensate` is told."""
    return np.dtype(
        [
            ("tick_s", "f8"),
            ("mass", "f8"),
            ("com", "f8", (3,)),
            ("block", "i8"),  # ticks
            ("gain", "f8"),  # of a block, once the first ones have been averaged
            ("rate", "f8", (6,)),  # N/s, N·m/s
            ("plausible", "f8", (6,)),  # N, N·m
            ("sigma", "f8", (6,)),  # of one reading, as it comes out of the sensor's filter
            ("correlation", "f8"),  # variance of a long mean over that of independent readings
            ("drift", "f8", (6,)),  # N/√s, N·m/√s
        ]
    )


@lru_cache
def kept_layout() -> np.dtype:
    """What it keeps; zeros at first."""
    return np.dtype(
        [
            ("bias", "f8", (6,)),
            ("target", "f8", (6,)),
            ("variance", "f8", (6,)),  # of the target
            ("sum", "f8", (6,)),
            ("waiting", "f8", (6,)),
            ("count", "i8"),
            ("has_waiting", "i8"),
            ("blocks", "i8"),
            ("implausible", "i8"),  # 1: free, says the caller, but the reading is far from the bias
        ]
    )


def told(scenario: Scenario) -> Records:
    """The record (1,) of `told_layout` for the tool, the sensor and the settings of a scenario, as the controller believes it."""
    b, sensors, tool, tick_s = scenario.estimation.wrench, scenario.sensors, scenario.tool, 1.0 / scenario.run.rate_hz
    p: Records = np.zeros(1, told_layout())
    p["tick_s"], p["mass"], p["com"] = tick_s, tool.tool_mass_kg, (0.0, 0.0, tool.tool_com_m)
    p["block"], p["gain"] = round(b.block_s / tick_s), b.gain
    p["rate"], p["plausible"] = _both(b.rate_nps, b.rate_nmps), _both(b.plausible_n, b.plausible_nm)
    p["drift"] = _both(b.drift_n, b.drift_nm)
    # A first-order low pass keeps the mean of white noise but narrows a single reading to √(g/(2 − g)).
    low_pass = 1.0 - np.exp(-2.0 * np.pi * sensors.force_filter_hz * tick_s)
    share = low_pass / (2.0 - low_pass)
    p["sigma"] = np.sqrt(share) * _both(max(sensors.force_n, LEAST_N), max(sensors.torque_nm, LEAST_NM))
    p["correlation"] = 1.0 / share
    return p


def _both(force: float, torque: float) -> Array:
    return np.repeat([force, torque], 3)


@njit(cache=True)
def compensate(
    measured: Array,
    R: Array,
    lifted: Array,
    free: bool,
    p: Record,
    s: Record,
    external: Array,
    sigma: Array,
) -> None:
    """One tick: the wrench of the end effector on the UAV, and the bias a little better known where the end effector is free.

    Args:
        measured: (6,), N, N·m, sensor.
        R: (3, 3), D<-sensor.
        lifted: a − γ (3,), m/s², D, of the tool's centre of mass; at rest on land (0, 0, 9.81).
        free: whether the end effector is known to touch nothing.
        p: of `told_layout`.
        s: of `kept_layout`, updated.
        external: receives w_EE (6,) about the sensor's origin, N, N·m, sensor.
        sigma: receives the standard deviations (6,), N, N·m, of `external`: noise of the reading and of the bias's estimate.
    """
    weight = np.zeros(3)
    for i in range(3):
        for k in range(3):
            weight[i] += p.mass * R[k, i] * lifted[k]
    turn = cross(p.com, weight)
    s.implausible = 0
    for i in range(6):
        tool = weight[i] if i < 3 else turn[i - 3]
        external[i] = measured[i] - tool  # (W.1)
        if free and not abs(external[i] - s.bias[i]) <= p.plausible[i]:
            s.implausible = 1
    _learn(external, free and s.implausible == 0, p, s)
    for i in range(6):
        external[i] -= s.bias[i]
        sigma[i] = np.sqrt(p.sigma[i] ** 2 + s.variance[i])


@njit(cache=True)
def _learn(reading: Array, free: bool, p: Record, s: Record) -> None:
    for i in range(6):
        s.variance[i] += p.drift[i] ** 2 * p.tick_s
    if not free:
        # What has not been learnt by now may already hold a contact.
        s.count = s.has_waiting = 0
        for i in range(6):
            s.sum[i] = 0.0
        return
    for i in range(6):
        step = p.rate[i] * p.tick_s
        s.bias[i] += min(max(s.target[i] - s.bias[i], -step), step)
        s.sum[i] += reading[i]
    s.count += 1
    if s.count < p.block:
        return
    if s.has_waiting:
        s.blocks += 1
        gain = max(1.0 / s.blocks, p.gain)
        for i in range(6):
            s.target[i] += gain * (s.waiting[i] - s.target[i])
            block = p.sigma[i] ** 2 * p.correlation / p.block
            s.variance[i] = (1.0 - gain) ** 2 * s.variance[i] + gain**2 * block
    for i in range(6):
        s.waiting[i] = s.sum[i] / p.block
        s.sum[i] = 0.0
    s.count, s.has_waiting = 0, 1
