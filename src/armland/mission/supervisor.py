"""The supervisor: finds faults, looks up who stops and who holds, and cuts the command. It may only reduce authority.

The fault table says for each fault and each kind of phase in which final phase the mission ends; what arm, UAV and magnet do
there stands in `finals.FINALS`. Kinds of phases: `ground` (nobody flies on the ground's word), `flight` (the UAV flies guided,
nothing touches), `touch` (the magnet works on the plate, the rotors carry), `held` (the arm carries), `cradle` (the rails carry,
the landing is nearly over), `grip` (the rails carry, the take-off has hardly begun).
A fault that comes when the mission has ended already may lead on to a graver end, see `ESCALATION`.

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
from armland.mission.phases import Phase
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

KINDS = ("ground", "flight", "touch", "held", "cradle", "grip")

FAULT_TABLE: dict[str, dict[str, str]] = {
    fault: dict(zip(KINDS, row.split(), strict=True))
    for fault, row in {
        #              ground         flight      touch       held        cradle      grip
        "non_finite": "refused        abort       abort       holding     secured     secured",
        "arm_stale": " braked_refused braked_free braked_free braked_held braked_down braked_down",
        "uav_silent": "refused        abort       abort       holding     secured     secured",
        "camera_stale": "refused      abort       abort       -           -           secured",
        "wrench_stale": "refused      abort       abort       holding     secured     secured",
        "wrench_drift": "refused      abort       -           holding     secured     secured",
        "magnet_coil": "refused       -           abort       holding     -           secured",
        "overload": "  refused        abort       abort       holding     secured     secured",
        "rotor_lost": "-              -           balancing   balancing   -           -",
        "uav_tilt": "  refused        abort       abort       -           secured     secured",
        "slip": "      -              -           -           let_fly     -           -",
        "near_limit": "braked_refused braked_free braked_free braked_held braked_down braked_down",
    }.items()
}
"""Fault × kind of phase -> final phase; `-` where the fault does not matter there.

Near a joint's end, near a singularity and beyond the joints' speed no law of the end effector is defined: the brakes are.
"""

ESCALATION: dict[str, dict[str, str]] = {
    "done": {"arm_stale": "braked_down"},
    "refused": {"arm_stale": "braked_refused"},
    "abort": {"arm_stale": "braked_free"},
    "let_fly": {"arm_stale": "braked_free"},
    "holding": {"arm_stale": "braked_held", "rotor_lost": "balancing", "slip": "let_fly"},
    "balancing": {"arm_stale": "braked_held"},
    "secured": {"arm_stale": "braked_down"},
    "braked_held": {"slip": "braked_free"},
}
"""Final phase × second fault -> graver final phase; whatever is not here changes nothing."""

GRAVITY_OF = {
    "done": 0,
    "refused": 1,
    "abort": 1,
    "holding": 1,
    "secured": 1,
    "balancing": 2,
    "let_fly": 2,
    "braked_refused": 3,
    "braked_held": 3,
    "braked_down": 3,
    "braked_free": 4,
}
"""How little authority each end leaves the ground: over arm, UAV and grip; over arm and one of them; over grip and UAV with the
arm braked; over nothing. Escalation only ever goes up, so it ends."""

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

DEBOUNCE_TICKS = (0, 20, 1, 1, 1, 1, 300, 20, 3, 5, 40, 50, 20)
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

SEEN_S = 0.15
"""Age, since the exposure, up to which an image says where the plate is on the magnet: its delay and two images lost."""

LOAD_N, LOAD_LEFT = 2.0, 0.3
"""A load of this much, of which less than that share is felt, is gone."""

JOLTED_S = 0.4
"""Time for which a UAV leans that was struck by way of the arm, and rights itself."""

CAUGHT_S = 0.15
"""Time constant with which a UAV rights itself that was caught while it leant, as in flight it may."""

DAMPER = 20.0
"""N·m·s/rad that replaces a torque which is cut."""


def fault_rows(phases: tuple[Phase, ...]) -> np.ndarray:
    """Final phase (faults, phases) by index for each fault in each phase; −1 where the fault does not matter.

    Args:
        phases: of a mission, its ends included.
    """
    names = [p.name for p in phases]
    rows = np.full((len(FAULTS), len(phases)), -1, dtype=np.int64)
    for f, fault in enumerate(FAULTS):
        for k, p in enumerate(phases):
            row = ESCALATION.get(p.name, {}) if p.kind == "end" else FAULT_TABLE.get(fault, {})
            target = row.get(fault if p.kind == "end" else p.kind, "-")
            if target != "-" and (p.sight or fault != "camera_stale"):
                rows[f, k] = names.index(target)
    return rows


@njit(cache=True)
def find_fault(
    bad: int,
    magnet_on: bool,
    expected: float,
    force_max: float,
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
        force_max: largest hinge force of the phase, N; the magnet's share counts where that is less.
        m: measurement.
        e: estimate.
        h: health.
        p: parameters.
        s: memory.
        debounce: ticks for each fault.
        matters: (faults,) −1 where the fault does not matter.
    """
    force = np.sqrt(e.hinge_force[0] ** 2 + e.hinge_force[1] ** 2 + e.hinge_force[2] ** 2)
    up = 1.0 - 2.0 * (e.quat[1] ** 2 + e.quat[2] ** 2)
    signs = np.zeros(len(FAULTS), np.bool_)
    signs[NON_FINITE] = bad > 0
    signs[ARM_STALE] = m.tick - m.arm_tick > p.arm_age
    # Both ways: what it says arrives, and it has heard what was said to it.
    signs[UAV_SILENT] = m.tick - min(m.uav_tick, m.uav_heard) > p.uav_age
    signs[CAMERA_STALE] = s.seen == 1 and e.plate_age > p.camera_age
    signs[WRENCH_STALE] = m.tick - m.wrench_tick > p.wrench_age
    signs[WRENCH_DRIFT] = abs(e.hinge_force[2] - expected) > p.free_tolerance
    signs[MAGNET_COIL] = magnet_on and m.magnet_fault == 1
    if signs[UAV_SILENT]:
        # It could not be given its thrust back: it is better off lying on the magnet.
        signs[SLIP] = False
    elif (m.tick - s.grip_tick) * p.tick_s < SEEN_S:
        # One image errs by as much now and then, and stands for longer where the next one is lost.
        signs[SLIP] = s.grip_far >= 2
    else:
        # Nobody sees it: what the arm should carry is not there.
        signs[SLIP] = expected > LOAD_N and force < LOAD_LEFT * expected
    signs[OVERLOAD] = force > min(force_max, p.hinge_max)
    # Touching the rails tilts it too, and when it is caught it still leans from its flight.
    since = (m.tick - s.caught) * p.tick_s
    most = p.capture_max * (2.0 if e.r[2] < p.down + p.near else 1.0)
    most += s.tip + max(p.tilt_max - most, 0.0) * np.exp(-since / CAUGHT_S)
    struck = m.tick - s.jolted < JOLTED_S / p.tick_s
    # A plate that slides off tilts the UAV as well: with its rotors stopped it would fall.
    on = s.grip_far == 0 and not signs[SLIP]
    signs[ROTOR_LOST] = s.held == 1 and on and not struck and capture_angle(e.quat, e.omega, p.fall_rate) > most
    signs[UAV_TILT] = up < np.cos(p.tilt_max)
    signs[NEAR_LIMIT] = h.joint_margin < p.joint_margin or s.sigma < p.sigma_min or h.speed_ratio > p.speed_share
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
