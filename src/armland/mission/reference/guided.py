"""Where the ground keeps a flying UAV: takes over from its own hover, holds its station against gusts, flies on; compiled.

| symbol | name | unit |
|---|---|---|
| i | `kept.integral` (3,): what the station keeping has learnt | m/s², D |
| t | `kept.trim` (3,): acceleration that the UAV's own hover asks for beyond gravity | m/s², D |
| d | disturbance (3,) of the pose filter | m/s², D |
| T_h | `kept.hover`: command that carries the weight, m (g + i_z − d_z) | N |

A UAV that hovers by itself says what it asks of its rotors: t = Σ T/m R e₃ − g. The station keeping begins with i = t + d, whose
command i − d is the UAV's own, so that nothing sags at the take-over. It reckons where the UAV will be when the command acts.
"""

import numpy as np
from numba import njit

from armland.control.laws.station_keeping import StationGains, StationReference, attitude_of, keep_station
from armland.models.environment import apparent_gravity
from armland.records import MOST_ROTORS, Record
from armland.rotations import Array, cross, matrix, turned

ALONE_S = 0.2
"""Time after which a UAV that was told to hover by itself surely does, and has said what it asks of its rotors."""

TRIM_S = 0.4
"""Time constant with which its trim is learnt: shorter than the self-test, longer than its own oscillations."""

SEEN_S, FADE_S = 0.15, 0.1
"""Age of the newest image from which on the gust that it showed is forgotten, and the time constant of that: gusts end unseen."""

CAUGHT_S, SHORT_S = 0.3, 0.1
"""Time after which a UAV that was caught rests on the magnet; time constant with which it is felt what its rotors fail to carry."""

MOST_HOVER = 2.0
"""Command over the weight beyond which no rotors' loss is learnt: half the thrust is lost, or the sensor drifts."""

LEAST_SHARE = 0.4
"""Of the weight: a UAV that asks for less does not hover."""


@njit(cache=True)
def learn_trim(b: Record) -> None:
    """Learn from a UAV that hovers by itself what it asks of its rotors: that carries its weight and holds against the wind.

    Args:
        b: board; what acting keeps of the trim and `hover` are updated.
    """
    m, e, p, s = b.tick.measurement, b.tick.estimate, b.told.act.uav, b.kept.act
    if s.alone * p.tick_s < ALONE_S or m.uav_tick == s.trimmed:
        return
    total = 0.0
    for i in range(MOST_ROTORS):
        total += m.uav_rotors[i]
    if total < LEAST_SHARE * p.weight:
        return
    # By itself it hovers in W: what the deck does is none of its doing.
    R, gravity = matrix(e.quat), b.environment.gravity
    gain = min((m.uav_tick - s.trimmed) * p.tick_s / TRIM_S, 1.0) if s.trimmed > 0 else 1.0
    for i in range(3):
        s.trim[i] += gain * (total / p.mass * R[i, 2] + gravity[i] - s.trim[i])
    s.trimmed = m.uav_tick
    s.hover = p.mass * (p.gravity + s.trim[2])


@njit(cache=True)
def learn_shortfall(b: Record) -> None:
    """Learn from the arm below a UAV that the magnet has caught what its rotors fail to carry, before it is let go or handed over.

    What the pose filter has seen of it until the catch counts at once. Then F_z − W (1 − f_T/T_h) is what the arm carries and should
    not; it is learnt once it is more than the sensor's zero can drift.

    Args:
        b: board; what acting keeps of `short`, `hover` and the integral are updated.
    """
    e, p, s, decide = b.tick.estimate, b.told.act.uav, b.kept.act, b.kept.decide
    since = b.tick.measurement.tick - decide.begin
    if since * p.tick_s < CAUGHT_S:
        s.short, s.falls_short, s.before = 0.0, 0, s.hover
        seen = p.mass * (p.gravity + s.integral[2] - _gust(b.kept.estimate.plate.bias, 2, p))
        if since == 0 and seen - s.hover > p.shortfall:
            s.hover, s.before, s.integral[2] = seen, seen, seen / p.mass - p.gravity
        return
    weight, felt = b.kept.estimate.weight, b.kept.estimate.felt
    missing = e.hinge_force[2] - weight * (felt - e.thrust / max(s.hover, 1e-3))
    s.short += p.tick_s / SHORT_S * (missing - s.short)
    s.falls_short = 1 if s.short > p.shortfall else s.falls_short
    if s.falls_short:
        more = min(p.tick_s / (2.0 * SHORT_S) * s.hover * missing / weight, MOST_HOVER * weight - s.hover)
        s.hover += more
        s.integral[2] += more / p.mass


@njit(cache=True)
def keep_shortfall(p: Record, s: Record) -> None:
    """Forget at the let-go what was not learnt to its end: the sensor drifts, and the rotors give what they did before.

    Args:
        p: what commanding the UAV is told.
        s: what acting keeps; `hover` and the integral are written.
    """
    if s.falls_short and abs(s.short) > p.shortfall:
        s.integral[2] -= (s.hover - s.before) / p.mass
        s.hover = s.before
    s.falls_short = 0


@njit(cache=True)
def take_over(bias: Array, p: Record, s: Record) -> None:
    """Let the station keeping begin where the UAV's own hover ends, or where the hinge was freed of force.

    What the pose filter knows of the wind is cancelled beside the integral, so the integral begins without it. What leans and lifts
    the UAV on the hinge holds against the wind alone, and the filter has learnt that wind meanwhile, too: a UAV that leans and does
    not move. Counted twice, it would fly off against the wind.

    Args:
        bias: disturbance (3,) of the pose filter, m/s², D.
        p: what commanding the UAV is told.
        s: what acting keeps; `integral` is written, in the first tick of the station keeping alone.
    """
    if s.alone > 0 and s.trimmed > 0:
        _begin(s.trim, bias, p, s)
        if p.sight.leans:
            s.hovered[0], s.hovered[1] = s.trim[0], s.trim[1]
    elif s.alone == 0 and s.freed:
        _begin(s.integral, bias, p, s)
    s.freed = 0


@njit(cache=True)
def _begin(held: Array, bias: Array, p: Record, s: Record) -> None:
    # The integral with which the command is the one that holds by `held` (3,), m/s², D.
    for i in range(3):
        s.integral[i] = min(max(held[i] + _gust(bias, i, p), -p.integral_max), p.integral_max)


@njit(cache=True)
def _gust(bias: Array, i: int, p: Record) -> float:
    # Disturbance, m/s², that is cancelled on axis `i`, of the pose filter's `bias` (3,).
    return float(min(max(p.gust_share * bias[i], -p.gust_max), p.gust_max))


@njit(cache=True)
def cruise(tick: int, b: Record) -> None:
    """Fly on at the velocity that the take-off gave, from where the UAV was when the arm let go.

    Args:
        tick: present one.
        b: board; thrust, set-point and integral that acting keeps are written.
    """
    e, p, s = b.tick.estimate, b.told.act.uav, b.kept.act
    if p.fly_on:
        # Too heavy to hover: all that the rotors give, and the tilt that keeps the speed by itself.
        s.thrust = p.thrust_max
        lean_against_drag(p.launch, p, s)
        s.cruising = tick
        return
    if s.cruising == 0:
        s.cruising = tick
        lever = turned(matrix(e.quat), p.lever)
        for i in range(3):
            s.anchor[i] = e.plate[i] - lever[i] - s.ride.aside[i]
    since, still, place, moving = (tick - s.cruising) * p.tick_s, np.zeros(3), np.empty(3), np.empty(3)
    for i in range(3):
        place[i], moving[i] = s.anchor[i] + p.launch[i] * since, p.launch[i]
    keep(place, still, moving, b)


@njit(cache=True)
def lean_against_drag(v: Array, p: Record, s: Record) -> None:
    """Tilt the set-point so that the thrust holds the drag at a velocity: the hinge is then free of force at a constant speed.

    Args:
        v: velocity (3,), m/s, D.
        p: what commanding the UAV is told.
        s: what acting keeps; `q_d` is written.
    """
    q_d = attitude_of(np.array([p.drag * v[0], p.drag * v[1], p.weight]), p.heading)
    for i in range(4):
        s.q_d[i] = q_d[i]


@njit(cache=True)
def keep(place: Array, lever: Array, moving: Array, b: Record) -> None:
    """Keep the UAV's centre of mass at `place` − `lever`, which moves; on a deck that moves beside it, see `riding`.

    Args:
        place: (3,), m, D.
        lever: (3,), m, D.
        moving: velocity (3,), m/s, D.
        b: board; thrust, set-point, integral and hover thrust that acting keeps are written.
    """
    e, p, s = b.tick.estimate, b.told.act.uav, b.kept.act
    R, fade = matrix(e.quat), np.exp(-max(e.plate_age - p.fades, 0.0) / FADE_S)
    arm, swing = turned(R, p.lever), turned(R, cross(e.omega, p.lever))
    wanted, position, velocity, wind, held = np.empty(3), np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    going = moving + s.ride.aside_v
    for i in range(3):
        held[i], wanted[i], position[i], velocity[i] = (
            s.integral[i],
            place[i] - lever[i] + s.ride.aside[i],
            e.plate[i] - arm[i],
            e.plate_v[i] - swing[i],
        )
        wind[i] = moving[i] * (-p.drag / p.mass)
        wind[i] += fade * _gust(b.kept.estimate.plate.bias, i, p)
    # Where the UAV will be, and where it shall be, when the command acts.
    ahead = b.kept.estimate.uplink * p.tick_s
    for i in range(3):
        wanted[i] += (going[i] + 0.5 * s.ride.aside_a[i] * ahead) * ahead
        going[i] += s.ride.aside_a[i] * ahead
        coming = min(max(e.plate_a[i], -p.coming_max), p.coming_max)
        position[i] += (velocity[i] + 0.5 * coming * ahead) * ahead
        velocity[i] += coming * ahead
    period = p.period * p.tick_s
    rates = (p.k_position, p.k_velocity, p.k_integral, p.speed_max, p.integral_max, p.tilt_max)
    gains = StationGains(p.mass, period, *rates, p.lift_min, p.thrust_max, p.vertical)
    gravity = apparent_gravity(b.environment, position, velocity)
    reference = StationReference(wanted, going, s.ride.aside_lead.copy(), p.heading)
    thrust, q_d, integral = keep_station(position, velocity, e.quat, reference, wind, gains, held, gravity)
    s.thrust = thrust
    for i in range(3):
        s.integral[i] = integral[i]
    for i in range(4):
        s.q_d[i] = q_d[i]
    s.hover += period / p.hover_s * (p.mass * (p.gravity + integral[2] - wind[2]) - s.hover)
    for i in range(2):
        s.hovered[i] += period / p.hover_s * (integral[i] - wind[i] - s.hovered[i])
