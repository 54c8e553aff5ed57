"""The first thing that is done with a measurement: what is not finite, or leaps, is replaced by the last good value; compiled."""

import numpy as np
from numba import njit

from armland.records import Record
from armland.rotations import Array

FORGOTTEN_S = 0.1
"""Time over which the rates may explain a turn."""


@njit(cache=True)
def screened(
    m: Record, good: Record, same: Array, held: bool, joint_leap: float, attitude_leap: float, tick_s: float
) -> int:
    """Replace what is not finite, or leaps, by the last good value; returns how many numbers that were.

    A sample that cannot be used counts as not arrived: its device's clock stands still, for the watchdogs to see. Of the UAV's
    attitude a leap counts while it is `held`: there a false tilt would stop its rotors and move the arm.

    Args:
        m: measurement, mended.
        good: the last good one, brought up to date; its tick is one more than that of the last sample, 0 before the first.
        same: (n,), 1, samples in a row in which each joint read the same and no speed at all, updated.
        held: whether the arm holds the UAV.
        joint_leap: rad from one sample to the next that no joint can move.
        attitude_leap: rad beyond what its rates explain that no UAV turns from one sample to the next.
        tick_s: s.
    """
    if m.arm_tick > good.arm_tick:
        for i in range(m.q.shape[0]):
            # A real encoder's last digits are never still while its neighbours' are.
            same[i] = same[i] + 1 if m.q[i] == good.q[i] and m.qd[i] == 0.0 else 0
    # A stamp from the future, by a clock that is ahead, is one of now.
    m.uav_tick = min(m.uav_tick, m.tick)
    if good.tick > 0:
        for i in range(m.q.shape[0]):
            if abs(m.q[i] - good.q[i]) > joint_leap:
                m.q[i] = np.nan
    if held and _turned(m, good, tick_s) > attitude_leap:
        for i in range(4):
            m.uav_quat[i] = np.nan
    arm = kept_finite(m.q, good.q) + kept_finite(m.qd, good.qd)
    wrench = kept_finite(m.wrench, good.wrench)
    uav = kept_finite(m.uav_quat, good.uav_quat) + kept_finite(m.uav_rate, good.uav_rate)
    uav += kept_finite(m.uav_force, good.uav_force)
    m.arm_tick = good.arm_tick = good.arm_tick if arm else m.arm_tick
    m.wrench_tick = good.wrench_tick = good.wrench_tick if wrench else m.wrench_tick
    m.uav_tick = good.uav_tick = good.uav_tick if uav else m.uav_tick
    good.tick = m.tick + 1
    return int(arm + wrench + uav + _camera(m))


@njit(cache=True)
def kept_finite(values: Array, last: Array) -> int:
    """Replace `values` (n,), any unit, that are not finite by those of `last` (n,), same unit; returns how many."""
    bad = 0
    for i in range(values.shape[0]):
        if np.isfinite(values[i]):
            last[i] = values[i]
        else:
            values[i] = last[i]
            bad += 1
    return bad


@njit(cache=True)
def _camera(m: Record) -> int:
    # An image with a number that is none counts as not arrived.
    if not m.camera_fresh:
        return 0
    total = 0.0
    for i in range(3):
        total += m.camera_position[i]
    for i in range(4):
        total += m.camera_quat[i]
    if np.isfinite(total):
        return 0
    m.camera_fresh = 0
    return 1


@njit(cache=True)
def _turned(m: Record, good: Record, tick_s: float) -> float:
    # By how much the attitude is further from the last good one than the rates, as they were and as they are, can have turned it.
    same, rate = 0.0, 0.0
    for i in range(4):
        same += m.uav_quat[i] * good.uav_quat[i]
    for i in range(3):
        rate += max(m.uav_rate[i] ** 2, good.uav_rate[i] ** 2)
    turned = 2.0 * np.arccos(min(abs(same), 1.0))
    # One that stays away for long must not pass for having turned as far as noise may have in that time.
    since = min(tick_s * (m.uav_tick - good.uav_tick), FORGOTTEN_S)
    return float(turned - 2.0 * np.sqrt(rate) * since)
