"""What a UAV that lands by itself is told in each phase: hover by yourself, keep this station, level out, stop; compiled."""

import numpy as np
from numba import njit

from armland.mission.estimate import RING
from armland.mission.reference.guided import keep, learn_trim, take_over
from armland.mission.reference.riding import deck_ahead, ride
from armland.mission.reference.view import seek
from armland.mission.uav import send, to_own, unseen
from armland.mission.unaided.decide import AWAY, DESCEND, DONE, FIND, SETTLE, height_of
from armland.records import Record, UavMode
from armland.rotations import conjugate, from_rotation_vector, matrix, multiply, rotation_error

RAMP_S = 0.5
"""In which the UAV begins to thrust against the rope: at once, it would leap until the rope is taut."""

AUTONOMOUS, GUIDED, OFF = UavMode.AUTONOMOUS, UavMode.GUIDED, UavMode.OFF


@njit(cache=True)
def command(b: Record) -> None:
    """Fill reference and command of the tick.

    Args:
        b: `unaided.board`, whose estimate and mission are those of the tick.
    """
    m, p, s, d, c = b.tick.measurement, b.told.act.uav, b.kept.act, b.kept.descent, b.tick.command
    if b.environment.moves:
        ride(p.station, p.rides, p.lags, p.ahead, p.tick_s, b.environment, s.ride)
    learn_trim(b)
    c.tick, c.uav_mode = m.tick, GUIDED
    if d.phase in (FIND, AWAY):
        c.uav_mode, s.thrust = AUTONOMOUS, s.hover
        _level(p.heading, s)
    elif d.phase in (SETTLE, DONE):
        c.uav_mode, s.thrust = OFF, 0.0
    elif unseen(b.tick.estimate, b.kept.estimate, p) and d.phase != DESCEND:
        # It hovers by itself, and is told to rise into view.
        c.uav_mode, s.thrust = AUTONOMOUS, s.hover
        _level(p.heading, s)
        seek(s.alone * p.tick_s, b.tick.estimate, b.kept.estimate.seen == 1, p, s)
    else:
        _guide(b)
    s.alone = s.alone + 1 if c.uav_mode == AUTONOMOUS else 0
    s.sought = s.sought if s.alone > 0 else 0
    send(to_own(b.kept.estimate.filter.align.quat.copy(), False, p, b.environment, s.ride), s, c)
    b.kept.estimate.thrust_log[m.tick % RING] = s.thrust
    out = b.tick.reference
    out.tick, out.quat = m.tick, s.q_d
    for i in range(3):
        out.r[i], out.v[i] = b.told.descent.stand[i] + s.ride.aside[i], s.ride.aside_v[i]
    out.r[2] += d.place
    out.v[2] -= d.sinking


@njit(cache=True)
def _guide(b: Record) -> None:
    p, s, d, t = b.told.act.uav, b.kept.act, b.kept.descent, b.told.descent
    take_over(b.kept.estimate.plate.bias, p, s)
    if b.tick.measurement.tick % p.period:
        return
    place, moving = t.stand.copy(), np.zeros(3)
    place[2] += d.place
    moving[2] = -d.sinking
    height = s.integral[2]
    keep(place, p.lever, moving, b)
    if d.phase == DESCEND and t.pull > 0.0:
        # The rope has the height; what it pulls with is no error of the thrust.
        ramp = min((b.tick.measurement.tick - d.begin) * t.tick_s / RAMP_S, 1.0)
        s.thrust, s.integral[2] = min(d.carries + ramp * t.pull, p.thrust_max), height
    else:
        d.carries = s.hover
    if d.phase == DESCEND and t.level > 0.0:
        _level_out(min(max(height_of(b) / t.level, 0.0), 1.0), b)


@njit(cache=True)
def _level(heading: float, s: Record) -> None:
    s.q_d[0], s.q_d[1], s.q_d[2], s.q_d[3] = np.cos(0.5 * heading), 0.0, 0.0, np.sin(0.5 * heading)


@njit(cache=True)
def _level_out(share: float, b: Record) -> None:
    # From the attitude that holds against the wind to the pad's own when it is met: in D that is no rotation but the heading.
    p, s, env = b.told.act.uav, b.kept.act, b.environment
    level = np.array([np.cos(0.5 * p.heading), 0.0, 0.0, np.sin(0.5 * p.heading)])
    if env.moves:
        level = multiply(multiply(conjugate(env.base_quat.copy()), deck_ahead(p.ahead * p.lags[0], env, s.ride)), level)
    held = s.q_d.copy()
    q_d = multiply(from_rotation_vector(share * rotation_error(matrix(level), matrix(held))), level)
    for i in range(4):
        s.q_d[i] = q_d[i]
