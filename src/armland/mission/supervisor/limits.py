"""The last stage of a tick: cuts the joint torques and says so in the health message; compiled.

| limit, in this order | what is cut |
|---|---|
| joint position | torque beyond gravity's that drives a joint towards its near end is replaced by a damper |
| joint speed | a damper is added to a joint that is too fast |
| torque | kept within the joint's limit |
| torque rate, N·m/s | last in the chain: whatever was decided, the torque cannot jump |
"""

from functools import lru_cache

import numpy as np
from numba import njit

from armland.linking import linked, named
from armland.records import Limit, Record

L_POSITION, L_SPEED, L_TORQUE, L_RATE = Limit.JOINT_POSITION, Limit.JOINT_SPEED, Limit.JOINT_TORQUE, Limit.TORQUE_RATE
L_SINGULAR, L_FORCE, L_FINITE, L_STALE = Limit.SINGULAR, Limit.HINGE_FORCE, Limit.NON_FINITE, Limit.UAV_STALE

DAMPER = 20.0
"""N·m·s/rad that replaces a torque which is cut."""


@lru_cache
def told_layout(joints: int) -> np.dtype:
    """What the limits are told, for an arm with `joints` joints. Infinite ones cut nothing."""
    return np.dtype(
        [
            ("tick_s", "f8"),
            ("q_min", "f8", (joints,)),  # rad
            ("q_max", "f8", (joints,)),  # rad
            ("qd_max", "f8", (joints,)),  # rad/s
            ("tau_max", "f8", (joints,)),  # N·m
            ("joint_margin", "f8"),  # rad
            ("speed_share", "f8"),  # of qd_max
            ("torque_rate", "f8", (joints,)),  # N·m/s
            ("sigma_min", "f8"),
            ("hinge_max", "f8"),  # N
            ("uav_age", "i8"),  # ticks
        ]
    )


@lru_cache
def kept_layout(joints: int) -> np.dtype:
    """What the limits keep from tick to tick."""
    return np.dtype(
        [
            ("started", "i8"),
            ("tau", "f8", (joints,)),  # N·m, as cut last
            ("joint_margin", "f8"),  # rad, smallest distance to a range's end
            ("speed_ratio", "f8"),  # largest joint speed over its limit
        ]
    )


@linked(lambda n: (named("board", n),))
@njit(cache=True)
def limit(b: Record) -> None:
    """Cut `command.tau` (n,), N·m, in the order of the module's table, and fill `health`.

    Args:
        b: board.
    """
    m, e, c, h = b.tick.measurement, b.tick.estimate, b.tick.command, b.tick.health
    p, s = b.told.limit, b.kept.limit
    sigma = b.kept.estimate.sigma
    h.tick, c.tick, h.flags = m.tick, m.tick, L_FINITE if b.kept.estimate.bad else 0
    h.torque_ratio = h.speed_ratio = 0.0
    h.joint_margin, h.sigma_min, h.uav_age = np.inf, sigma, (m.tick - m.uav_tick) * p.tick_s
    for i in range(m.q.shape[0]):
        _cut(i, m, b.arm.gravity[i], p, s, c, h)
    force = np.sqrt(e.hinge_force[0] ** 2 + e.hinge_force[1] ** 2 + e.hinge_force[2] ** 2)
    h.flags |= L_SINGULAR if sigma < p.sigma_min else 0
    h.flags |= L_FORCE if force > p.hinge_max else 0
    h.flags |= L_STALE if m.tick - m.uav_tick > p.uav_age else 0
    s.started, s.joint_margin, s.speed_ratio = 1, h.joint_margin, h.speed_ratio


@njit(cache=True)
def _cut(i: int, m: Record, gravity: float, p: Record, s: Record, c: Record, h: Record) -> None:
    asked = c.tau[i]
    h.torque_ratio = max(h.torque_ratio, abs(asked) / p.tau_max[i])
    h.speed_ratio = max(h.speed_ratio, abs(m.qd[i]) / p.qd_max[i])
    low, high = m.q[i] - p.q_min[i], p.q_max[i] - m.q[i]
    h.joint_margin = min(h.joint_margin, min(low, high))
    if min(low, high) < p.joint_margin:
        h.flags |= L_POSITION
        # Beyond what holds it at rest.
        outwards = (asked - gravity) * (1.0 if high < low else -1.0)
        if outwards > 0.0:
            asked = gravity - DAMPER * m.qd[i]
    if abs(m.qd[i]) > p.speed_share * p.qd_max[i]:
        h.flags |= L_SPEED
        asked -= DAMPER * m.qd[i]
    if abs(asked) > p.tau_max[i]:
        h.flags |= L_TORQUE
        asked = min(max(asked, -p.tau_max[i]), p.tau_max[i])
    step = p.torque_rate[i] * p.tick_s
    if s.started and abs(asked - s.tau[i]) > step:
        h.flags |= L_RATE
        asked = s.tau[i] + min(max(asked - s.tau[i], -step), step)
    s.tau[i] = c.tau[i] = asked
