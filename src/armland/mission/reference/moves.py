"""The arm's reference by phase: hold, join, track, close, move, back off, give way, run up, leave, flee; compiled.

| symbol | name | unit |
|---|---|---|
| r_d, ṙ_d, r̈_d | `reference.r`, `.v`, `.a` (3,) of the end effector point | m, m/s, m/s², deck |
| r₀, v₀ | `kept.r0`, `.v0` (3,): the reference when the phase began | m, m/s, deck |
| s(u) | septic from 0 to 1 | 1 |
| p | `kept.p` (3,): the plate's pivot, smoothed by `track` | m, deck |
| p₀ | `kept.p0` (3,): the same when the phase began | m, deck |

No reference jumps: a velocity v₀ at the beginning of a phase decays with the time constant T = `coast`, s, as
r₀ + v₀ T (1 − e^(−t/T)).
"""

import numpy as np
from numba import njit

from armland.mission.reference.launch import leave, run_up
from armland.mission.reference.septic import PEAK, septic
from armland.mission.table.phases import ARM
from armland.records import Record

NOD_M = 0.006
"""How far the arm nods on each axis: enough to weigh a tool of 0.3 kg, a quarter of the room around it."""

FLOOR_M = 0.05
"""Height above its lowest place over which the arm that draws away from the plate comes to rest."""

NEAR_M = 0.1
"""Gap up to which a plate may slide over the arm that stands still."""

LEAST_LEFT = 0.3
"""Least share of the arm's speed with which it draws away from a plate."""

LOWER_S = 0.3
"""Time in which a steady descent begins."""

HOLD, JOIN, TRACK, CLOSE, MOVE, BACK_OFF, YIELD, BRAKE, LAUNCH, LEAVE, BALANCE, FOLLOW, LOWER, NOD, FLEE = range(
    len(ARM)
)


@njit(cache=True)
def move(mode: int, elapsed: float, duration: float, phase: int, e: Record, p: Record, s: Record, r: Record) -> float:
    """Fill the reference of one tick; returns the progress of the phase's move, 0 to 1.

    Args:
        mode: index into `ARM`; of those that follow neither path nor balance.
        elapsed: time in the phase, s.
        duration: of its move, s.
        phase: index, for the target.
        e: estimate.
        p: what the reference is told.
        s: what it keeps.
        r: reference, written.
    """
    u = elapsed / duration if duration > 0.0 else 1.0
    T = duration if duration > 0.0 else 1.0
    if mode == TRACK:
        _to_plate(1.0, 0.0, 0.0, p, s, r)
    elif mode == JOIN:
        # The blend ends on the plate's motion, whatever that is by then.
        b, b_dot, b_ddot = septic(u, T)
        _to_plate(b, b_dot, b_ddot, p, s, r)
    elif mode == CLOSE:
        _close(u, T, p, s, r)
    elif mode == FLEE:
        _flee(elapsed, T, phase, p, s, r)
    elif mode == LAUNCH:
        _run_up(elapsed, p, s, r)
    elif mode == LEAVE:
        _leave(elapsed, p, s, r)
    else:
        _rest(elapsed, p, s, r)
        if mode in (MOVE, LOWER):
            _add_move(u, T, phase, p, s, r)
        elif mode == NOD:
            _nod(u, T, r)
        if mode == LOWER:
            _feel(elapsed - 0.5 * T, p, r)
        elif mode == BACK_OFF:
            _lower(u, T, room_below(s, p), r)
        elif mode == YIELD:
            _give_way(e, p, s, r)
    return float(min(max(u, 0.0), 1.0))


@njit(cache=True)
def begin(mode: int, before: int, switched: bool, e: Record, s: Record) -> None:
    """Set r₀ and v₀, from which a phase's reference begins.

    In general they continue the last reference. Where the law changes they are the arm's position and velocity, so that the new law
    begins without a force. Where the arm begins to give way they are its position, at rest.

    Args:
        mode: index into `ARM` of the phase that begins.
        before: of the one that ends.
        switched: whether the UAV is held in one of the two only.
        e: estimate.
        s: what the reference keeps, written.
    """
    s.falls = max(-e.plate_v[2], 0.0)
    for i in range(3):
        s.r0[i], s.v0[i] = s.r[i], s.v[i]
        if mode == YIELD and before == YIELD:
            s.r0[i] -= s.yielded[i]
        elif mode == YIELD:
            s.r0[i], s.v0[i], s.yielded[i] = e.r[i], 0.0, 0.0
        elif switched:
            s.r0[i], s.v0[i] = e.r[i], e.v[i]
        s.p0[i], s.pv0[i] = s.p[i], s.pv[i]


@njit(cache=True)
def _to_plate(b: float, b_dot: float, b_ddot: float, p: Record, s: Record, r: Record) -> None:
    for i in range(3):
        apart = s.p[i] - (p.standoff if i == 2 else 0.0) - s.r0[i]
        r.r[i] = s.r0[i] + b * apart
        r.v[i] = b_dot * apart + b * s.pv[i]
        r.a[i] = b_ddot * apart + 2.0 * b_dot * s.pv[i] + b * s.pa[i]


@njit(cache=True)
def _close(u: float, duration: float, p: Record, s: Record, r: Record) -> None:
    b, b_dot, b_ddot = septic(u, duration)
    reach = p.standoff + p.beyond
    for i in range(3):
        down = 1.0 if i == 2 else 0.0
        r.r[i] = s.p[i] - down * (p.standoff - b * reach)
        r.v[i] = s.pv[i] + down * b_dot * reach
        r.a[i] = s.pa[i] + down * b_ddot * reach


@njit(cache=True)
def _flee(elapsed: float, duration: float, phase: int, p: Record, s: Record, r: Record) -> None:
    # At first along with the plate, so that it does not slide over the arm while that is near, and down from it; then to above where
    # it waits, away from the rails; no lower than that.
    # A plate that comes down leaves the arm less speed to get away from it.
    left = max(p.flees_mps - s.falls, LEAST_LEFT * p.flees_mps)
    lasts, fade = max(duration, PEAK * p.flees / left), np.exp(-elapsed / p.coast)
    b, b_dot, b_ddot = septic((elapsed - 0.5 * duration) / duration, duration)
    # From one that is still far it draws away as it is: along with that it might come to the rails.
    along = 1.0 if s.p0[2] - s.r0[2] < NEAR_M else 0.0
    for i in range(3):
        more = s.v0[i] - along * s.pv0[i]
        r.r[i] = s.r0[i] + along * (s.p[i] - s.p0[i]) + more * p.coast * (1.0 - fade)
        r.v[i] = along * s.pv[i] + more * fade
        r.a[i] = along * s.pa[i] - more / p.coast * fade
        if i < 2:
            apart, v = p.targets[phase, i] - r.r[i], r.v[i]
            r.r[i] += b * apart
            r.v[i] += b_dot * apart - b * v
            r.a[i] += b_ddot * apart - 2.0 * b_dot * v - b * r.a[i]
    _lower(elapsed / lasts, lasts, p.flees, r)
    over = r.r[2] - p.floor
    if over < FLOOR_M:
        share = max(over + FLOOR_M, 0.0) / (2.0 * FLOOR_M)
        r.r[2] = p.floor + share * share * FLOOR_M
        r.a[2] = share * r.a[2] + (r.v[2] ** 2 / (2.0 * FLOOR_M) if share > 0.0 else 0.0)
        r.v[2] *= share


@njit(cache=True)
def _run_up(elapsed: float, p: Record, s: Record, r: Record) -> None:
    # The displacement that lies before the run-up's begin has its speed already.
    along, speed, rise = run_up(elapsed, p.launch_s)
    for i in range(3):
        more = p.launch[i] - s.v0[i]
        r.r[i] = s.r0[i] + s.v0[i] * elapsed + more * along
        r.v[i] = s.v0[i] + more * speed
        r.a[i] = more * rise


@njit(cache=True)
def _leave(elapsed: float, p: Record, s: Record, r: Record) -> None:
    along, speed, rise = leave(elapsed, p.launch_s, p.leave_s)
    for i in range(3):
        r.r[i], r.v[i], r.a[i] = s.r0[i] + s.v0[i] * along, s.v0[i] * speed, s.v0[i] * rise
    _lower(elapsed / p.leave_s, p.leave_s, room_below(s, p), r)


@njit(cache=True)
def _rest(elapsed: float, p: Record, s: Record, r: Record) -> None:
    fade = np.exp(-elapsed / p.coast)
    for i in range(3):
        r.r[i] = s.r0[i] + s.v0[i] * p.coast * (1.0 - fade)
        r.v[i] = s.v0[i] * fade
        r.a[i] = -s.v0[i] / p.coast * fade


@njit(cache=True)
def _add_move(u: float, duration: float, phase: int, p: Record, s: Record, r: Record) -> None:
    b, b_dot, b_ddot = septic(u, duration)
    for i in range(3):
        apart = p.targets[phase, i] - s.r0[i] - s.v0[i] * p.coast
        r.r[i] += b * apart
        r.v[i] += b_dot * apart
        r.a[i] += b_ddot * apart


@njit(cache=True)
def room_below(s: Record, p: Record) -> float:
    """How far, m, the arm may draw back downwards: `depth`, and not below the lowest place that it was asked to reach."""
    return float(min(p.depth, max(s.r0[2] - p.lowest, 0.0)))


@njit(cache=True)
def _lower(u: float, duration: float, depth: float, r: Record) -> None:
    b, b_dot, b_ddot = septic(u, duration)
    r.r[2] -= b * depth
    r.v[2] -= b_dot * depth
    r.a[2] -= b_ddot * depth


@njit(cache=True)
def _nod(u: float, duration: float, r: Record) -> None:
    # Along (1, 1, 1) by `NOD_M` on each axis, and back.
    half = 0.5 * duration
    out = u < 0.5
    b, b_dot, b_ddot = septic(2.0 * u if out else 2.0 * u - 1.0, half)
    for i in range(3):
        r.r[i] += NOD_M * (b if out else 1.0 - b)
        r.v[i] += NOD_M * (b_dot if out else -b_dot)
        r.a[i] += NOD_M * (b_ddot if out else -b_ddot)


@njit(cache=True)
def _feel(elapsed: float, p: Record, r: Record) -> None:
    # Downwards at `lower` from half of the move on, its speed blended in over `LOWER_S`, to twice the searched depth and no further.
    if elapsed <= 0.0:
        return
    t = min(elapsed, LOWER_S)
    depth = p.lower * (0.5 * t * t / LOWER_S + max(elapsed - LOWER_S, 0.0))
    r.r[2] -= min(depth, 2.0 * p.search)
    if depth < 2.0 * p.search:
        r.v[2] -= p.lower * t / LOWER_S
        r.a[2] -= p.lower / LOWER_S if elapsed < LOWER_S else 0.0


@njit(cache=True)
def _give_way(e: Record, p: Record, s: Record, r: Record) -> None:
    # Where the hinge's force pushes, the reference follows, within bounds.
    for i in range(3):
        v = -p.give_way * e.hinge_force[i]
        s.yielded[i] = min(max(s.yielded[i] + v * p.tick_s, -p.give_way_max), p.give_way_max)
        r.r[i] += s.yielded[i]
