"""The supervisor: finds faults, looks up who stops and who holds, and cuts the command. It may only reduce authority.

The fault table says for each fault and each kind of phase in which final phase the mission ends; what arm, UAV and magnet do
there stands in `finals.FINALS`. Kinds of phases: `ground` (nobody flies on the ground's word), `flight` (the UAV flies guided,
nothing touches), `touch` (the magnet works on the plate, the rotors carry), `held` (the arm carries), `cradle` (the rails carry).

| limit, in this order | what is cut |
|---|---|
| joint position | torque beyond gravity's that drives a joint towards its near end is replaced by a damper |
| joint speed | a damper is added to a joint that is too fast |
| torque | kept within the joint's limit |
| torque rate, N·m/s | last in the chain: whatever was decided, the torque cannot jump |
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.control.balance import capture_angle
from armland.mission.records import Limit
from armland.records import Record
from armland.rotations import Array

FAULTS = (
    "none",
    "non_finite",
    "arm_stale",
    "uav_silent",
    "camera_stale",
    "wrench_stale",
    "wrench_drift",
    "magnet_coil",
    "overload",
    "rotor_lost",
    "uav_tilt",
    "slip",
    "near_limit",
)
"""What the supervisor can find, the gravest first."""

KINDS = ("ground", "flight", "touch", "held", "cradle")

FAULT_TABLE: dict[str, dict[str, str]] = {
    "non_finite": {"ground": "refused", "flight": "abort", "touch": "abort", "held": "holding", "cradle": "secured"},
    "arm_stale": {
        "ground": "braked_free",
        "flight": "braked_free",
        "touch": "braked_free",
        "held": "braked_held",
        "cradle": "braked_down",
    },
    "uav_silent": {"ground": "refused", "flight": "abort", "touch": "abort", "held": "holding", "cradle": "-"},
    "camera_stale": {"ground": "-", "flight": "abort", "touch": "abort", "held": "-", "cradle": "-"},
    "wrench_stale": {"ground": "refused", "flight": "abort", "touch": "abort", "held": "holding", "cradle": "secured"},
    "wrench_drift": {"ground": "refused", "flight": "abort", "touch": "abort", "held": "holding", "cradle": "secured"},
    "magnet_coil": {"ground": "refused", "flight": "abort", "touch": "abort", "held": "holding", "cradle": "-"},
    "slip": {"ground": "-", "flight": "-", "touch": "-", "held": "let_fly", "cradle": "-"},
    "overload": {"ground": "-", "flight": "abort", "touch": "abort", "held": "holding", "cradle": "secured"},
    "rotor_lost": {"ground": "-", "flight": "-", "touch": "balancing", "held": "balancing", "cradle": "-"},
    "uav_tilt": {"ground": "-", "flight": "abort", "touch": "abort", "held": "hanging", "cradle": "secured"},
    "near_limit": {"ground": "refused", "flight": "abort", "touch": "abort", "held": "holding", "cradle": "secured"},
}
"""Fault × kind of phase -> final phase; `-` where the fault does not matter there."""

(
    NONE,
    NON_FINITE,
    ARM_STALE,
    UAV_SILENT,
    CAMERA_STALE,
    WRENCH_STALE,
    WRENCH_DRIFT,
    MAGNET_COIL,
    OVERLOAD,
    ROTOR_LOST,
    UAV_TILT,
    SLIP,
    NEAR_LIMIT,
) = range(len(FAULTS))

DEBOUNCE_TICKS = (0, 20, 1, 1, 1, 1, 300, 20, 3, 5, 40, 100, 20)
"""Ticks for which each fault's sign must be seen. Ages are debounced by themselves."""

L_POSITION, L_SPEED, L_TORQUE, L_RATE, L_SINGULAR, L_FORCE, L_FINITE = (
    Limit.JOINT_POSITION,
    Limit.JOINT_SPEED,
    Limit.JOINT_TORQUE,
    Limit.TORQUE_RATE,
    Limit.SINGULAR,
    Limit.HINGE_FORCE,
    Limit.NON_FINITE,
)

CAUGHT_S = 0.2
"""Time for which a UAV that was caught may lean as in flight."""

DAMPER = 20.0
"""N·m·s/rad that replaces a torque which is cut."""


def fault_rows(kinds: tuple[str, ...], names: tuple[str, ...]) -> np.ndarray:
    """Final phase (faults, phases) by index for each fault in each phase; −1 where the fault does not matter.

    Args:
        kinds: kind of each phase, `` for final ones.
        names: name of each phase.
    """
    rows = np.full((len(FAULTS), len(kinds)), -1, dtype=np.int64)
    for f, fault in enumerate(FAULTS):
        for k, kind in enumerate(kinds):
            target = FAULT_TABLE.get(fault, {}).get(kind, "-")
            if target != "-":
                rows[f, k] = names.index(target)
    return rows


@njit(cache=True)
def find_fault(
    bad: int,
    magnet_on: bool,
    expected: float,
    m: Record,
    e: Record,
    h: Record,
    p: Record,
    s: Record,
    debounce: NDArray[np.int64],
    matters: NDArray[np.int64],
) -> int:
    """The gravest fault whose sign has been seen long enough and that matters in this phase; 0: none.

    Args:
        bad: numbers in the measurement that were not finite.
        magnet_on: whether the magnet has been on for longer than its current takes to rise.
        expected: vertical hinge force that load and thrust explain, N; NaN where nothing is known.
        m: measurement.
        e: estimate.
        h: health.
        p: parameters.
        s: memory.
        debounce: ticks for each fault.
        matters: (faults,) −1 where the fault does not matter.
    """
    force = np.sqrt(e.hinge_force[0] ** 2 + e.hinge_force[1] ** 2 + e.hinge_force[2] ** 2)
    apart = 0.0
    for i in range(3):
        apart += (e.plate[i] - e.r[i]) ** 2
    up = 1.0 - 2.0 * (e.quat[1] ** 2 + e.quat[2] ** 2)
    signs = np.zeros(len(FAULTS), np.bool_)
    signs[NON_FINITE] = bad > 0
    signs[ARM_STALE] = m.tick - m.arm_tick > p.arm_age
    signs[UAV_SILENT] = m.tick - m.uav_tick > p.uav_age
    signs[CAMERA_STALE] = s.seen == 1 and e.plate_age > p.camera_age
    signs[WRENCH_STALE] = m.tick - m.wrench_tick > p.wrench_age
    signs[WRENCH_DRIFT] = abs(e.hinge_force[2] - expected) > p.free_tolerance
    signs[MAGNET_COIL] = magnet_on and m.magnet_fault == 1
    signs[SLIP] = e.plate_valid == 1 and apart > p.slip**2
    signs[OVERLOAD] = force > p.hinge_max
    # Touching the rails tilts it too, and when it is caught it still leans from its flight.
    early = m.tick - s.caught < CAUGHT_S / p.tick_s
    most = p.capture_max * (2.0 if early or e.r[2] < p.down + p.near else 1.0)
    signs[ROTOR_LOST] = s.held == 1 and capture_angle(e.quat, e.omega, p.fall_rate) > most
    signs[UAV_TILT] = up < np.cos(p.tilt_max)
    signs[NEAR_LIMIT] = h.joint_margin < p.joint_margin or s.sigma < p.sigma_min
    for f in range(1, len(FAULTS)):
        s.counts[f] = s.counts[f] + 1 if signs[f] else 0
        if matters[f] >= 0 and s.counts[f] >= debounce[f]:
            return f
    return 0


@njit(cache=True)
def limit(bad: int, gravity: Array, m: Record, e: Record, p: Record, s: Record, c: Record, h: Record) -> None:
    """Cut the joint torques and say so in the health message; the order is that of the module's table.

    Args:
        bad: numbers in the measurement that were not finite.
        gravity: torques (n,), N·m, that hold the arm at rest.
        m: measurement.
        e: estimate.
        p: parameters.
        s: memory.
        c: command, cut.
        h: health, written.
    """
    n = m.q.shape[0]
    h.tick, c.tick = m.tick, m.tick
    h.flags = L_FINITE if bad else 0
    h.torque_ratio = h.speed_ratio = 0.0
    h.joint_margin, h.sigma_min = np.inf, s.sigma
    step = p.torque_rate * p.tick_s
    for i in range(n):
        asked = c.tau[i]
        h.torque_ratio = max(h.torque_ratio, abs(asked) / p.tau_max[i])
        h.speed_ratio = max(h.speed_ratio, abs(m.qd[i]) / p.qd_max[i])
        low, high = m.q[i] - p.q_min[i], p.q_max[i] - m.q[i]
        h.joint_margin = min(h.joint_margin, min(low, high))
        if min(low, high) < p.joint_margin:
            h.flags |= L_POSITION
            # Beyond what holds it at rest.
            outwards = (asked - gravity[i]) * (1.0 if high < low else -1.0)
            if outwards > 0.0:
                asked = gravity[i] - DAMPER * m.qd[i]
        if abs(m.qd[i]) > p.speed_share * p.qd_max[i]:
            h.flags |= L_SPEED
            asked -= DAMPER * m.qd[i]
        if abs(asked) > p.tau_max[i]:
            h.flags |= L_TORQUE
            asked = min(max(asked, -p.tau_max[i]), p.tau_max[i])
        if s.started and abs(asked - s.tau[i]) > step:
            h.flags |= L_RATE
            asked = s.tau[i] + min(max(asked - s.tau[i], -step), step)
        s.tau[i] = c.tau[i] = asked
    if s.sigma < p.sigma_min:
        h.flags |= L_SINGULAR
    force = np.sqrt(e.hinge_force[0] ** 2 + e.hinge_force[1] ** 2 + e.hinge_force[2] ** 2)
    if force > p.hinge_max:
        h.flags |= L_FORCE
    s.started = 1
