"""The UAV's part of a tick, as the ground sees it: station keeping, thrust ramp, flying on; compiled.

| symbol | name | unit |
|---|---|---|
| f_T | `kept.thrust` as commanded | N |
| T_h | `kept.hover`: the command that carries the weight, learnt while the UAV keeps its station | N |
| F | `estimate.hinge_force` (3,) | N, D |
| q_d | `kept.q_d` (4,): attitude set-point | 1, D<-B |

Hand-over: the thrust ramps between fractions of T_h. On the way down it waits while the hinge's force is behind what the
missing thrust must leave to the arm: a UAV that nobody carries is not let down.
"""

from functools import lru_cache

import numpy as np
from numba import njit

from armland.control.laws.station_keeping import attitude_of
from armland.mission.reference.guided import (
    cruise,
    keep,
    keep_shortfall,
    lean_against_drag,
    learn_shortfall,
    learn_trim,
    take_over,
)
from armland.mission.reference.riding import deck_ahead
from armland.mission.reference.riding import told_layout as riding_told
from armland.mission.reference.view import in_view, seek
from armland.mission.reference.view import told_layout as view_told
from armland.mission.table.phases import LINK, UAV
from armland.records import Record, UavMode
from armland.rotations import Array, conjugate, matrix, multiply, turned

AUTONOMOUS, STATION, LEVEL, RAMP, BALANCE, OFF, RUN_UP, CRUISE, HINGED = range(len(UAV))
MODE_AUTONOMOUS, MODE_OFF = UavMode.AUTONOMOUS, UavMode.OFF
MODES = (UavMode.GUIDED, UavMode.HELD, UavMode.LANDED, UavMode.CAUGHT, UavMode.HINGED)
"""By index into `phases.LINK`."""
HELD, CAUGHT = LINK.index("held"), LINK.index("caught")

RECKONED_S = 0.5
"""How long the station is kept by reckoning alone: a UAV that has left the camera's view comes back into it, and the error of its
velocity stays below 0.3 m/s in a gust that ends meanwhile. Then it hovers by itself. Where wind is expected its accelerometers say
when a gust ends, and it is reckoned for as long as the pose filter does."""

AGREE = 3
"""Images beyond the first that must fit each other before a UAV in wind is guided by them: speed and gust are not known from two, and
of few an outlier is believed."""

LEANT_MPS2 = 2.0
"""Largest horizontal acceleration that a UAV on the hinge holds against by leaning: 11 degrees; more where more wind is expected."""

SEATS_S = 0.25
"""Time for which a UAV that was caught in wind lies on the magnet with some of its weight before the pull test."""


@lru_cache
def told_layout() -> np.dtype:
    """What commanding the UAV is told."""
    return np.dtype(
        [
            ("tick_s", "f8"),
            ("mass", "f8"),  # kg, that flies: plate included
            ("weight", "f8"),  # N, of all that flies
            ("gravity", "f8"),  # m/s²
            ("lever", "f8", (3,)),  # m, CM to pivot [B]
            ("drag", "f8"),  # N·s/m, horizontal
            ("station", "f8", (3,)),  # m, pivot [D]
            ("heading", "f8"),  # rad
            ("thrust_rate", "f8"),  # N/s
            ("thrust_max", "f8"),  # N
            ("thrust_min", "f8"),  # N
            ("lift_min", "f8"),  # N, of the station keeping
            ("shortfall", "f8"),  # N, hinge force of a caught UAV from which on its rotors' loss is learnt
            ("force_slack", "f8"),  # N, hinge force behind its expectation that stops the ramp
            ("balance_rate", "f8"),  # 1/s, N/s of thrust per N of hinge force while the hinge is freed of force
            ("hinged", "f8"),  # N, thrust on the hinge
            ("launch", "f8", (3,)),  # m/s, velocity that a take-off gives to the UAV [D]
            ("fly_on", "i8"),  # 1 where the UAV keeps it with all its thrust
            ("period", "i8"),  # ticks, of the station keeping
            ("hover_s", "f8"),  # s, time constant with which T_h follows it
            *((f"k_{name}", "f8") for name in ("position", "velocity", "integral")),  # 1/s, 1/s, 1/s²
            ("vertical", "f8"),  # of the two upwards over sideways
            ("speed_max", "f8"),  # m/s
            ("integral_max", "f8"),  # m/s²
            ("tilt_max", "f8"),  # rad
            ("reckoned", "f8"),  # s, for which the station is kept by reckoning alone
            ("astray", "f8"),  # m, standard deviation of the reckoned place beyond which it is not kept
            ("fades", "f8"),  # s, age of the newest image from which on the gust that it showed is forgotten
            ("leant", "f8"),  # m/s², largest horizontal acceleration that a UAV on the hinge holds against by leaning
            ("gust_share", "f8"),  # of the disturbance in the plate filter
            ("gust_max", "f8"),  # m/s²
            ("coming_max", "f8"),  # m/s², of the acceleration that is carried on over the uplink's delay
            *riding_told(),
            ("sight", view_told()),
        ]
    )


@njit(cache=True)
def command_uav(row: Record, align: Array, b: Record) -> None:
    """Fill mode, attitude set-point and thrust of the command.

    Args:
        row: phase.
        align: δ (4,), quaternion, 1, q_wb = δ ⊗ q_imu: set-points travel in the UAV's own idea of the world.
        b: board.
    """
    tick, e, c = b.tick.measurement.tick, b.tick.estimate, b.tick.command
    p, s, what = b.told.act.uav, b.kept.act, row.uav
    c.uav_mode = MODES[row.link]
    learn_trim(b)
    blind = unseen(e, b.kept.estimate, p) and (what == STATION or (what == CRUISE and not p.fly_on))
    if what == AUTONOMOUS or blind:
        c.uav_mode = MODE_AUTONOMOUS
        s.thrust = s.hover
        _level(p, s)
        if what == STATION or (row.seeks == 1 and p.sight.leans and unseen(e, b.kept.estimate, p)):
            seek(s.alone * p.tick_s, e, b.kept.estimate.seen == 1, p, s)
    elif what == STATION:
        keep_shortfall(p, s)
        take_over(b.kept.estimate.plate.bias, p, s)
        if tick % p.period == 0:
            keep(in_view(e, row.seeks == 1, p, s), p.lever, np.zeros(3), b)
    elif what == CRUISE:
        if tick % p.period == 0 or s.cruising == 0:
            cruise(tick, b)
    elif what == RAMP:
        if row.link == CAUGHT:
            learn_shortfall(b)
        _relieve(tick, row, b)
        if row.share == 0.0 and s.thrust <= p.thrust_min:
            s.thrust, c.uav_mode = 0.0, MODE_OFF
    elif what == RUN_UP:
        # The thrust that carried the weight at rest: what the arm pushes with is not to be balanced.
        lean_against_drag(e.v, p, s)
    elif what == BALANCE:
        _free_of_force(e, p, s)
    elif what == OFF:
        s.thrust, c.uav_mode = 0.0, MODE_OFF
    elif what == HINGED:
        # What the law made of it: the rotors may not give what was asked for.
        s.thrust = c.thrust if row.held else p.hinged
    s.alone = s.alone + 1 if c.uav_mode == MODE_AUTONOMOUS else 0
    s.sought = s.sought if s.alone > 0 else 0
    # What is kept on the deck must turn with it; where the thrust of one that flies points to is decided in W.
    send(to_own(align, what not in (STATION, CRUISE), p, b.environment, s.ride), s, c)


@njit(cache=True)
def unseen(e: Record, known: Record, p: Record) -> bool:
    """Whether a UAV has not been seen for too long, or reckoned too badly since, to be guided.

    Args:
        e: estimate.
        known: what the estimate keeps.
        p: what commanding the UAV is told.
    """
    sigma = known.plate.sigma_position
    lost = known.seen == 0 or e.plate_age > p.reckoned or max(sigma[0], sigma[1], sigma[2]) > p.astray
    return bool(lost or (p.sight.leans == 1 and known.filter.fused < AGREE))


@njit(cache=True)
def to_own(align: Array, stands: bool, p: Record, environment: Record, ride: Record) -> Array:
    """Rotation (4,), scalar first, from the deck, as it will be for one that `stands` on it, into the UAV's own idea of the inertial
    frame, in which it holds its attitude; `align` (4,) is δ, `p`, `environment` and `ride` are those of the board.
    """
    if environment.moves:
        level = deck_ahead(p.ahead * p.lags[0], environment, ride) if stands else environment.base_quat.copy()
        return multiply(level, conjugate(align))
    return conjugate(align)


@njit(cache=True)
def send(own: Array, s: Record, c: Record) -> None:
    """Put thrust, set-point and step of `s` into the command `c` as they travel: in the UAV's own idea of the world, to which
    `own` (4,) turns.
    """
    quat, step = multiply(own, s.q_d), turned(matrix(own), s.step)
    for i in range(3):
        c.uav_step[i] = step[i] if s.sought else 0.0
    for i in range(4):
        c.uav_quat[i] = quat[i]
    c.thrust = s.thrust


@njit(cache=True)
def _level(p: Record, s: Record) -> None:
    s.q_d[0], s.q_d[1], s.q_d[2], s.q_d[3] = np.cos(0.5 * p.heading), 0.0, 0.0, np.sin(0.5 * p.heading)


@njit(cache=True)
def _relieve(tick: int, row: Record, b: Record) -> None:
    # Thrust and attitude of a UAV on the magnet.
    p, s = b.told.act.uav, b.kept.act
    windy = row.link == CAUGHT and p.sight.leans
    if windy and (tick - b.kept.decide.begin) * p.tick_s < SEATS_S:
        # A gust that lifts tears at a plate that touches with an edge: its weight lays it flat before it is pulled.
        s.thrust = min(s.thrust, (2.0 - row.share) * s.hover)
    else:
        _ramp(row.share * s.hover, row.link == HELD, b.kept.estimate, b.tick.estimate, p, s)
    if windy:
        # Levelled at once it would lift more by a third: no wind blows down through the rotors then.
        _lean(p, s)
    else:
        _level(p, s)


@njit(cache=True)
def _lean(p: Record, s: Record) -> None:
    # As it has held against the wind.
    q_d = attitude_of(np.array([s.hovered[0], s.hovered[1], p.gravity]), p.heading)
    for i in range(4):
        s.q_d[i] = q_d[i]


@njit(cache=True)
def _free_of_force(e: Record, p: Record, s: Record) -> None:
    step = min(max(p.balance_rate * e.hinge_force[2], -p.thrust_rate), p.thrust_rate) * p.tick_s
    s.thrust = min(max(s.thrust + step, p.thrust_min), p.thrust_max)
    s.hover, s.freed = s.thrust, 1
    # What carries the weight and leans against the wind now is where the station keeping takes over.
    for i in range(2):
        s.integral[i] += p.balance_rate * e.hinge_force[i] / p.mass * p.tick_s
        s.integral[i] = min(max(s.integral[i], -p.leant), p.leant)
        s.hovered[i] = s.integral[i]
    s.integral[2] = s.thrust / p.mass - p.gravity
    lean = np.array([s.integral[0], s.integral[1], p.gravity])
    q_d = attitude_of(lean, p.heading)
    for i in range(4):
        s.q_d[i] = q_d[i]


@njit(cache=True)
def _ramp(target: float, held: bool, known: Record, e: Record, p: Record, s: Record) -> None:
    step = p.thrust_rate * p.tick_s
    if held and target < s.thrust:
        # By now the arm must carry what the rotors no longer do.
        expected = known.weight * (known.felt - e.thrust / max(s.hover, 1e-3))
        step *= min(max(1.0 - (expected - e.hinge_force[2]) / p.force_slack, 0.0), 1.0)
    s.thrust += min(max(target - s.thrust, -step), step)
