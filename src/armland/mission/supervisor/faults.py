"""The signs of faults: which of them shows, and for how long it must; compiled.

| symbol | name | unit |
|---|---|---|
| F, F_z | `estimate.hinge_force`, what load and thrust explain of its vertical part | N, deck |
| ξ | capture point (B.2), at which a held UAV counts as falling | rad |
"""

from functools import lru_cache

import numpy as np
from numba import njit

from armland.control.laws.balance import capture_angle
from armland.mission.supervisor.table import FAULT, FAULTS
from armland.mission.table.arrays import FAULT_ROWS
from armland.records import Record

COUNT = len(FAULTS)
NON_FINITE, ARM_STALE, UAV_SILENT = FAULT["non_finite"], FAULT["arm_stale"], FAULT["uav_silent"]
CAMERA_STALE, WRENCH_STALE, WRENCH_DRIFT = FAULT["camera_stale"], FAULT["wrench_stale"], FAULT["wrench_drift"]
MAGNET_COIL, OVERLOAD, ROTOR_LOST = FAULT["magnet_coil"], FAULT["overload"], FAULT["rotor_lost"]
UAV_TILT, SLIP, NEAR_LIMIT, LAW_FAILED = FAULT["uav_tilt"], FAULT["slip"], FAULT["near_limit"], FAULT["law_failed"]

SEEN_S = 0.15
"""Age, since the exposure, up to which an image says where the plate is on the magnet: its delay and two images lost."""

LOAD_LEFT = 0.3
"""A load of which less than this share is felt is gone."""

JOLT_MPS, JOLTED_S = 0.1, 0.4
"""Speed of the end effector against its reference that no healthy flight makes once the UAV is held; time for which a UAV leans
that was struck so by way of the arm, and rights itself."""

CAUGHT_S = 0.15
"""Time constant with which a UAV rights itself that was caught while it leant, as in flight it may."""


@lru_cache
def watch_layout() -> np.dtype:
    """What the search for faults is told."""
    return np.dtype(
        [
            ("tick_s", "f8"),
            ("uav_age", "i8"),  # ticks
            ("camera_age", "f8"),  # s
            ("arm_age", "i8"),  # ticks
            ("wrench_age", "i8"),  # ticks
            ("unexplained", "f8"),  # N, hinge force that load and thrust need not explain
            ("load_gone", "f8"),  # N, least load that can be missed
            ("hinge_max", "f8"),  # N
            ("tilt_max", "f8"),  # rad
            ("fall_rate", "f8"),  # rad/s
            ("capture_max", "f8"),  # rad, capture point at which a held UAV counts as falling
            ("tip", "f8"),  # rad per m/s²: how far the arm's acceleration tilts the UAV on its hinge
            ("down", "f8"),  # m, height of the pivot when the UAV stands on the cradle
            ("near", "f8"),  # m, height above it at which the rails may touch
            ("joint_margin", "f8"),  # rad
            ("sigma_min", "f8"),
            ("speed_share", "f8"),
        ]
    )


@lru_cache
def seen_layout() -> np.dtype:
    """What the search for faults remembers."""
    return np.dtype(
        [
            ("counts", "i8", (FAULT_ROWS,)),  # ticks for which each fault's sign has been seen
            ("caught", "i8"),  # tick at which the UAV was held first
            ("jolted", "i8"),  # tick at which the end effector last missed its reference by a jolt
            ("tip", "f8"),  # rad, that the arm's acceleration explains
        ]
    )


@njit(cache=True)
def note_jolts(now: int, e: Record, refer: Record, p: Record, s: Record) -> None:
    """Remember what makes a UAV lean that has lost no rotor: that the end effector was struck, and how hard it accelerates.

    Args:
        now: present tick.
        e: estimate.
        refer: what the reference keeps: v, m/s, and a, m/s², of the tick before.
        p: `watch_layout`.
        s: `seen_layout`, written.
    """
    missed, asked = 0.0, 0.0
    for i in range(3):
        missed += (refer.v[i] - e.v[i]) ** 2
        asked += refer.a[i] ** 2
    s.tip = p.tip * np.sqrt(asked)
    if missed > JOLT_MPS**2:
        s.jolted = now


@njit(cache=True)
def find_fault(expected: float, magnet_on: bool, phase: int, b: Record) -> int:
    """The gravest fault whose sign has been seen long enough and that matters in this phase; 0: none.

    Args:
        expected: vertical hinge force that load and thrust explain, N; NaN where nothing is known.
        magnet_on: whether the magnet has been on for longer than its current takes to rise.
        phase: index.
        b: board; measurement and estimate are those of the present tick.
    """
    m, e, s = b.tick.measurement, b.tick.estimate, b.kept.decide.seen
    signs = np.zeros(FAULT_ROWS, np.bool_)
    _device_signs(magnet_on, m, e, b.told.decide.watch, b.kept.estimate, signs)
    _load_signs(expected, b.table.phases[phase].force, m, e, b.told.decide.watch, b.kept.estimate, signs)
    _attitude_signs(m, e, b.told.decide.watch, b.kept.estimate, b.kept.decide, signs)
    p, health = b.told.decide.watch, b.kept.limit
    sigma = b.kept.estimate.sigma
    signs[NEAR_LIMIT] = (
        health.joint_margin < p.joint_margin or sigma < p.sigma_min or health.speed_ratio > p.speed_share
    )
    signs[LAW_FAILED] = b.kept.act.law.failed != 0
    for f in range(1, COUNT):
        s.counts[f] = s.counts[f] + 1 if signs[f] else 0
        if b.table.faults[f, phase] >= 0 and s.counts[f] >= b.table.debounce[f]:
            return f
    return 0


@njit(cache=True)
def _device_signs(magnet_on: bool, m: Record, e: Record, p: Record, known: Record, signs: np.ndarray) -> None:
    signs[NON_FINITE] = known.bad > 0
    signs[ARM_STALE] = m.tick - m.arm_tick > p.arm_age
    # Both directions: what it says arrives, and it has heard what was said to it.
    signs[UAV_SILENT] = m.tick - min(m.uav_tick, m.uav_heard) > p.uav_age
    signs[CAMERA_STALE] = known.seen == 1 and e.plate_age > p.camera_age
    signs[WRENCH_STALE] = m.tick - m.wrench_tick > p.wrench_age
    signs[MAGNET_COIL] = magnet_on and m.magnet_fault == 1


@njit(cache=True)
def _load_signs(
    expected: float, force_max: float, m: Record, e: Record, p: Record, known: Record, signs: np.ndarray
) -> None:
    force = np.sqrt(e.hinge_force[0] ** 2 + e.hinge_force[1] ** 2 + e.hinge_force[2] ** 2)
    signs[WRENCH_DRIFT] = abs(e.hinge_force[2] - expected) > p.unexplained
    signs[OVERLOAD] = force > min(force_max, p.hinge_max)
    if signs[UAV_SILENT]:
        # It could not be given its thrust back: it is better off lying on the magnet.
        signs[SLIP] = False
    elif (m.tick - known.grip_tick) * p.tick_s < SEEN_S:
        # One image errs by as much now and then, and stands for longer where the next one is lost.
        signs[SLIP] = known.grip_far >= 2
    else:
        # Nobody sees it: what the arm should carry is not there.
        signs[SLIP] = expected > p.load_gone and force < LOAD_LEFT * expected


@njit(cache=True)
def _attitude_signs(m: Record, e: Record, p: Record, known: Record, kept: Record, signs: np.ndarray) -> None:
    s = kept.seen
    up = 1.0 - 2.0 * (e.quat[1] ** 2 + e.quat[2] ** 2)
    # Touching the rails tilts it too, and when it is caught it still leans from its flight.
    since = (m.tick - s.caught) * p.tick_s
    most = p.capture_max * (2.0 if e.r[2] < p.down + p.near else 1.0)
    most += s.tip + max(p.tilt_max - most, 0.0) * np.exp(-since / CAUGHT_S)
    struck = m.tick - s.jolted < JOLTED_S / p.tick_s
    # A plate that slides off tilts the UAV as well: with its rotors stopped it would fall.
    on = known.grip_far == 0 and not signs[SLIP]
    signs[ROTOR_LOST] = kept.held == 1 and on and not struck and capture_angle(e.quat, e.omega, p.fall_rate) > most
    signs[UAV_TILT] = up < np.cos(p.tilt_max)
