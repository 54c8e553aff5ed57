"""The phases of a landing without an arm, and what leads from one to the next; compiled.

| phase | the UAV | until |
|---|---|---|
| `find` | hovers by itself | the camera knows where it is |
| `guide` | keeps its station high above the pad | it is on it |
| `ready` | comes down to where it waits, and waits | the unrest that is expected is small, or patience is over |
| `descend` | comes down along with the pad | it is so low that the rotors can be stopped |
| `settle` | rotors stop | a second later |
| `done`, `away` | stands; flies by itself | |
"""

import numpy as np
from numba import njit

from armland.control.laws.unaided.quiet import unrest
from armland.models.environment import apparent_gravity
from armland.records import Record
from armland.rotations import matrix

PHASES = ("find", "guide", "ready", "descend", "settle", "done", "away")
FIND, GUIDE, READY, DESCEND, SETTLE, DONE, AWAY = range(len(PHASES))

HELD_S, SETTLE_S, GUIDE_S = 0.3, 1.0, 10.0
"""For how long what ends a phase must hold; after which a UAV whose rotors stopped has come down; longest search for the station."""

UNDER_M = 0.1
"""How far below standing the station goes: the UAV must come down although its height is known to some millimetres."""

MEAN_S = 6.0
"""Time constant of the deck's mean tilt, against which it swings."""

UNSEEN_S = 0.4
"""Age of an image beyond which nobody descends; lower than `LOW_M` the UAV comes down all the same."""

LOW_M = 0.06

STOPPED, TOUCHED_S = 0.3, 0.08
"""Share of the descent's speed, and time: one that sinks no faster for so long, low above the pad, has touched it, whatever its height
is believed to be."""

PRESSED_M = 0.03
"""Height, as it is believed, below which a UAV that a rope pulls down stands on the pad."""


@njit(cache=True)
def decide(b: Record) -> None:
    """Choose the phase of the tick, and the height that is asked for; fills the message `mission`.

    Args:
        b: `unaided.board`.
    """
    m, p, s = b.tick.measurement, b.told.descent, b.kept.descent
    _look(b)
    before = s.phase
    s.phase = _next(b)
    if s.phase != before:
        s.begin, s.since = m.tick, -1
    _lower(p, s)
    out = b.tick.mission
    out.tick, out.phase, out.retries = m.tick, s.phase, s.retries
    out.elapsed, out.progress = (m.tick - s.begin) * p.tick_s, s.unrest


@njit(cache=True)
def height_of(b: Record) -> float:
    """Height of the skids above the pad, m, as the ground knows it; `b`: `unaided.board`."""
    return float(b.tick.estimate.plate[2] - b.told.descent.stand[2])


@njit(cache=True)
def _next(b: Record) -> int:
    e, p, s = b.tick.estimate, b.told.descent, b.kept.descent
    elapsed, height, seen = (b.tick.measurement.tick - s.begin) * p.tick_s, height_of(b), e.plate_age < UNSEEN_S
    aside = np.hypot(e.plate[0] - p.stand[0], e.plate[1] - p.stand[1])
    if s.phase == FIND:
        if _holds(e.plate_valid == 1, HELD_S, b):
            return GUIDE
        return AWAY if elapsed > p.find_s else FIND
    if s.phase == GUIDE:
        there = seen and aside < p.align and abs(height - p.wait) < p.align and _speed(b) < p.speed
        return READY if _holds(there, HELD_S, b) or (seen and elapsed > GUIDE_S) else GUIDE
    if s.phase == READY:
        if not seen and elapsed > UNSEEN_S:
            return GUIDE
        there = seen and aside < p.align and height - p.ready < 0.5 * p.align
        calm = p.timed == 0 or s.unrest < p.quiet or elapsed > p.patience
        return DESCEND if there and calm else READY
    if s.phase == DESCEND:
        # Pulled down, it is pressed on the pad, and nothing is in haste: its height must be beyond doubt.
        pulled = p.pull > 0.0 and seen and height > PRESSED_M
        stopped = height < LOW_M and e.plate_v[2] > -STOPPED * p.sink
        if p.pull == 0.0 and (height < p.cut or _holds(stopped, TOUCHED_S, b)):
            return SETTLE
        if s.place < -0.9 * UNDER_M and not pulled:
            return SETTLE
        if height > LOW_M and (aside > p.give_up or not seen):
            s.retries += 1
            return AWAY if s.retries > p.retries else GUIDE
    if s.phase == SETTLE and elapsed > SETTLE_S:
        return DONE
    return int(s.phase)


@njit(cache=True)
def _holds(met: bool, for_s: float, b: Record) -> bool:
    s, tick = b.kept.descent, b.tick.measurement.tick
    if not met:
        s.since = -1
        return False
    if s.since < 0:
        s.since = tick
    return bool((tick - s.since) * b.told.descent.tick_s >= for_s)


@njit(cache=True)
def _speed(b: Record) -> float:
    # Against the station, which goes along with the deck.
    v, w = b.tick.estimate.plate_v, b.kept.act.ride.aside_v
    return float(np.sqrt((v[0] - w[0]) ** 2 + (v[1] - w[1]) ** 2 + (v[2] - w[2]) ** 2))


@njit(cache=True)
def _lower(p: Record, s: Record) -> None:
    # The height that is asked for falls no faster than the descent, and comes back at once.
    goal = p.wait
    if s.phase == READY:
        goal = p.ready
    elif s.phase == DESCEND:
        goal = -UNDER_M
    elif s.phase in (SETTLE, DONE):
        goal = s.place
    before = s.place
    s.place = max(goal, s.place - p.sink * p.tick_s)
    s.sinking = p.sink if s.place < before else 0.0


@njit(cache=True)
def _look(b: Record) -> None:
    # U of (Q.2) at the touchdown to which a descent would lead that begins now.
    p, s, env, ride = b.told.descent, b.kept.descent, b.environment, b.kept.act.ride
    tilt, rate, error = np.zeros(2), np.zeros(2), _speed(b)
    rise, push, omega = 0.0, 0.0, 0.0
    if env.moves:
        R, still = matrix(env.base_quat), np.zeros(3)
        gain = p.tick_s / MEAN_S if s.known else 1.0
        s.known = 1
        gamma = apparent_gravity(env, p.stand, still)
        for i in range(2):
            s.mean_tilt[i] += gain * (R[i, 2] - s.mean_tilt[i])
            tilt[i] = R[i, 2] - s.mean_tilt[i]
        # ṅ = R (ω × e₃)
        for i in range(2):
            rate[i] = R[i, 0] * env.base_omega[1] - R[i, 1] * env.base_omega[0]
        for i in range(3):
            carried = env.base_v[i]
            carried += (
                env.base_omega[(i + 1) % 3] * p.stand[(i + 2) % 3] - env.base_omega[(i + 2) % 3] * p.stand[(i + 1) % 3]
            )
            rise += R[2, i] * carried
            push += R[2, i] * (env.gravity[i] - gamma[i])
        omega = np.sqrt(ride.push2 / max(ride.speed2, 1e-9))
    ahead = max(height_of(b), 0.0) / p.sink
    s.unrest = unrest(tilt, rate, (rise, push), error, (omega, ahead))
