"""What the failures of `table` do around the devices, compiled: they change the measurement behind one, or push a body."""

import numpy as np
from numba import njit

from armland.records import Record
from armland.rotations import Array, from_rotation_vector, multiply
from armland.scenario.faults import DEVICES, FAILURES

NON_FINITE, ATTITUDE_OFFSET, PUSH = (FAILURES.index(n) for n in ("non_finite", "attitude_offset", "push"))
ENCODERS, WRENCH, ATTITUDE, CAMERA = (DEVICES.index(n) for n in ("encoders", "wrench", "attitude", "camera"))


@njit(cache=True)
def corrupt(told: Record, kept: Record, m: Record) -> None:
    """Put into the measurement `m` what devices that fail would write; from the tick after `act` on."""
    for i in range(told.count):
        row = told.row[i]
        if not kept.acting[i]:
            continue
        if row.kind == NON_FINITE:
            _lose(row.device, m)
        elif row.kind == ATTITUDE_OFFSET and m.uav_tick != kept.turned:
            # The sample stays in the measurement until the next one arrives.
            kept.turned = m.uav_tick
            turn = np.empty(3)
            for j in range(3):
                turn[j] = row.size * row.direction[j]
            quat = multiply(from_rotation_vector(turn), m.uav_quat)
            for j in range(4):
                m.uav_quat[j] = quat[j]


@njit(cache=True)
def _lose(device: int, m: Record) -> None:
    if device == ENCODERS:
        _fill(m.q)
        _fill(m.qd)
    elif device == WRENCH:
        _fill(m.wrench)
    elif device == ATTITUDE:
        _fill(m.uav_quat)
        _fill(m.uav_rate)
        _fill(m.uav_force)
    else:
        _fill(m.camera_position)


@njit(cache=True)
def _fill(a: Array) -> None:
    for i in range(a.shape[0]):
        a[i] = np.nan


@njit(cache=True)
def push(told: Record, kept: Record, xfrc: Array) -> None:
    """Add the pushes of this tick, after all others have written their rows.

    Args:
        told: of `table.told_layout`.
        kept: of `table.kept_layout`.
        xfrc: MuJoCo's `xfrc_applied` (nbody, 6), N, N·m, W, written.
    """
    for i in range(told.count):
        row = told.row[i]
        if row.kind == PUSH and row.alone:
            for j in range(6):
                xfrc[row.body, j] = 0.0
    for i in range(told.count):
        row = told.row[i]
        if row.kind == PUSH and kept.acting[i]:
            for j in range(3):
                xfrc[row.body, j] += row.size * row.direction[j]
