"""The stage that fills the reference of a tick; compiled. See `moves`, `path`, `track`, `launch`, `balance`."""

from functools import lru_cache

import numpy as np
from numba import njit

from armland.linking import MATRIX, linked, named
from armland.mission.reference.balance import (
    begin_balance,
    refer_balance,
)
from armland.mission.reference.balance import (
    kept_layout as balance_kept,
)
from armland.mission.reference.balance import (
    told_layout as balance_told,
)
from armland.mission.reference.moves import BALANCE, FOLLOW, JOIN, begin, move
from armland.mission.reference.path import follow
from armland.mission.reference.track import begin_track, track
from armland.mission.table.arrays import PHASES
from armland.records import Record
from armland.rotations import Array


@lru_cache
def told_layout() -> np.dtype:
    """What the reference is told."""
    return np.dtype(
        [
            ("tick_s", "f8"),
            ("standoff", "f8"),  # m
            ("beyond", "f8"),  # m, how far beyond the plate's face the arm would close
            ("depth", "f8"),  # m, that the arm backs off
            ("flees", "f8"),  # m, that it draws away from below the plate
            ("flees_mps", "f8"),  # m/s, largest speed downwards with which it does so
            ("floor", "f8"),  # m, height of the end effector below which it then does not [D]
            ("lowest", "f8"),  # m, height of the end effector below which it does not [D]
            ("launch", "f8", (3,)),  # m/s, velocity that a take-off gives to the UAV [D]
            ("launch_s", "f8"),  # s, of the run-up, and of coming to rest
            ("leave_s", "f8"),  # s, in which the arm goes down by the depth
            ("targets", "f8", (PHASES, 3)),  # m, end effector [D], of the phases that move
            ("track", "f8"),  # rad/s, of the filter on the plate's motion
            ("track_max", "f8"),  # m/s², its largest acceleration
            ("track_speed", "f8"),  # m/s, its largest speed, each axis
            ("room", "f8", (2, 3)),  # m, lowest and highest place [D] to which the arm follows the plate
            ("coast", "f8"),  # s, in which the reference comes to rest
            ("give_way", "f8"),  # m/s/N, of a yielding arm
            ("give_way_max", "f8"),  # m
            ("lower", "f8"),  # m/s, of an arm that feels for the cradle
            ("search", "f8"),  # m, above and below its believed place
            ("balance", balance_told()),
        ]
    )


@lru_cache
def kept_layout() -> np.dtype:
    """What the reference keeps from tick to tick."""
    return np.dtype(
        [
            ("r", "f8", (3,)),  # m, of the tick before [D]
            ("v", "f8", (3,)),
            ("a", "f8", (3,)),
            ("progress", "f8"),
            ("r0", "f8", (3,)),  # m, where the phase's reference began [D]
            ("v0", "f8", (3,)),
            ("p", "f8", (3,)),  # m, plate as tracked [D]
            ("pv", "f8", (3,)),
            ("pa", "f8", (3,)),
            ("p0", "f8", (3,)),  # m, where that was when the phase began [D]
            ("pv0", "f8", (3,)),
            ("falls", "f8"),  # m/s, with which it came down then, wherever it was
            ("yielded", "f8", (3,)),  # m
            ("balance", balance_kept()),
        ]
    )


@njit(cache=True)
def begin_reference(before: int, after: int, b: Record) -> None:
    """Begin the reference of phase `after`, which follows phase `before`; both are indices, `b` is the board."""
    old, new = b.table.phases[before], b.table.phases[after]
    begin(new.arm, old.arm, new.held != old.held, b.tick.estimate, b.kept.refer)
    if new.arm == JOIN:
        begin_track(b.tick.estimate, b.told.refer, b.kept.refer)
    elif new.arm == BALANCE:
        begin_balance(b.tick.estimate, b.kept.act.hovered, b.told.refer.balance, b.kept.refer.balance)


@linked(lambda n: (named("board", n), MATRIX))
@njit(cache=True)
def refer(b: Record, path: Array) -> None:
    """Fill the reference of the tick and the progress of the phase's move.

    Args:
        b: board, whose mission message is that of the tick.
        path: (k, 9), m, m/s, m/s², deck: r_d, ṙ_d, r̈_d of each tick, for missions that follow one.
    """
    m, e, r, s = b.tick.measurement, b.tick.estimate, b.tick.reference, b.kept.refer
    row, phase = b.table.phases[b.kept.decide.phase], b.kept.decide.phase
    elapsed = b.tick.mission.elapsed
    r.tick = m.tick
    if row.arm == FOLLOW:
        s.progress = follow(path, m.tick, r)
    else:
        track(e, b.told.refer, s)
        s.progress = move(row.arm, elapsed, row.duration, phase, e, b.told.refer, s, r)
        if row.arm == BALANCE:
            refer_balance(elapsed, m.tick - m.uav_tick, e, b.told.refer, s, r)
    b.tick.mission.progress = s.progress
    for i in range(3):
        s.r[i], s.v[i], s.a[i] = r.r[i], r.v[i], r.a[i]
    for i in range(4):
        r.quat[i] = b.kept.act.q_d[i]
