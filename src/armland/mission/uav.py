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

from armland.control.laws.station_keeping import StationGains, StationReference, attitude_of, keep_station
from armland.mission.table.phases import LINK, UAV
from armland.models.environment import apparent_gravity
from armland.records import Record, UavMode
from armland.rotations import Array, conjugate, cross, matrix, multiply, turned

AUTONOMOUS, STATION, LEVEL, RAMP, BALANCE, OFF, RUN_UP, CRUISE, HINGED = range(len(UAV))
MODE_AUTONOMOUS, MODE_OFF = UavMode.AUTONOMOUS, UavMode.OFF
MODES = (UavMode.GUIDED, UavMode.HELD, UavMode.LANDED, UavMode.CAUGHT, UavMode.HINGED)
"""By index into `phases.LINK`."""
HELD = LINK.index("held")


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
            ("force_slack", "f8"),  # N, hinge force behind its expectation that stops the ramp
            ("balance_rate", "f8"),  # 1/s, N/s of thrust per N of hinge force while the hinge is freed of force
            ("hinged", "f8"),  # N, thrust on the hinge
            ("launch", "f8", (3,)),  # m/s, velocity that a take-off gives to the UAV [D]
            ("fly_on", "i8"),  # 1 where the UAV keeps it with all its thrust
            ("period", "i8"),  # ticks, of the station keeping
            ("hover_s", "f8"),  # s, time constant with which T_h follows it
            ("k_position", "f8"),  # 1/s
            ("k_velocity", "f8"),  # 1/s
            ("k_integral", "f8"),  # 1/s²
            ("speed_max", "f8"),  # m/s
            ("integral_max", "f8"),  # m/s²
            ("tilt_max", "f8"),  # rad
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
    blind = not e.plate_valid and (what == STATION or (what == CRUISE and not p.fly_on))
    if what == AUTONOMOUS or blind:
        c.uav_mode = MODE_AUTONOMOUS
        s.thrust = s.hover
        _level(p, s)
    elif what == STATION:
        if tick % p.period == 0:
            _keep(p.station, p.lever, np.zeros(3), b)
    elif what == CRUISE:
        if tick % p.period == 0 or s.cruising == 0:
            _cruise(tick, b)
    elif what == RAMP:
        _ramp(row.share * s.hover, row.link == HELD, e, p, s)
        _level(p, s)
        if row.share == 0.0 and s.thrust <= p.thrust_min:
            s.thrust, c.uav_mode = 0.0, MODE_OFF
    elif what == RUN_UP:
        # The thrust that carried the weight at rest: what the arm pushes with is not to be balanced.
        _against_drag(e.v, p, s)
    elif what == BALANCE:
        _free_of_force(e, p, s)
        _level(p, s)
    elif what == OFF:
        s.thrust, c.uav_mode = 0.0, MODE_OFF
    elif what == HINGED:
        # What the law made of it: the rotors may not give what was asked for.
        s.thrust = c.thrust if row.held else p.hinged
    quat = multiply(conjugate(align), s.q_d)
    for i in range(4):
        c.uav_quat[i] = quat[i]
    c.thrust = s.thrust


@njit(cache=True)
def _level(p: Record, s: Record) -> None:
    s.q_d[0], s.q_d[1], s.q_d[2], s.q_d[3] = np.cos(0.5 * p.heading), 0.0, 0.0, np.sin(0.5 * p.heading)


@njit(cache=True)
def _free_of_force(e: Record, p: Record, s: Record) -> None:
    step = min(max(p.balance_rate * e.hinge_force[2], -p.thrust_rate), p.thrust_rate) * p.tick_s
    s.thrust = min(max(s.thrust + step, p.thrust_min), p.thrust_max)
    s.hover = s.thrust
    # What carries the weight now is where the station keeping takes over.
    s.integral[0] = s.integral[1] = 0.0
    s.integral[2] = s.thrust / p.mass - p.gravity


@njit(cache=True)
def _against_drag(v: Array, p: Record, s: Record) -> None:
    # Tilted so that the thrust holds the drag at velocity v: the hinge is then free of force at a constant speed.
    q_d = attitude_of(np.array([p.drag * v[0], p.drag * v[1], p.weight]), p.heading)
    for i in range(4):
        s.q_d[i] = q_d[i]


@njit(cache=True)
def _cruise(tick: int, b: Record) -> None:
    e, p, s = b.tick.estimate, b.told.act.uav, b.kept.act
    if p.fly_on:
        # Too heavy to hover: all that the rotors give, and the tilt that keeps the speed by itself.
        s.thrust = p.thrust_max
        _against_drag(p.launch, p, s)
        s.cruising = tick
        return
    if s.cruising == 0:
        s.cruising = tick
        lever = turned(matrix(e.quat), p.lever)
        for i in range(3):
            s.anchor[i] = e.plate[i] - lever[i]
    since, still, place, moving = (tick - s.cruising) * p.tick_s, np.zeros(3), np.empty(3), np.empty(3)
    for i in range(3):
        place[i], moving[i] = s.anchor[i] + p.launch[i] * since, p.launch[i]
    _keep(place, still, moving, b)


@njit(cache=True)
def _keep(place: Array, lever: Array, moving: Array, b: Record) -> None:
    # At `place` − `lever`, m, of the centre of mass, which moves at `moving`, m/s; all (3,).
    e, p, s = b.tick.estimate, b.told.act.uav, b.kept.act
    R = matrix(e.quat)
    arm, swing = turned(R, p.lever), turned(R, cross(e.omega, p.lever))
    wanted, position, velocity, wind, held = np.empty(3), np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    for i in range(3):
        held[i], wanted[i], position[i], velocity[i] = (
            s.integral[i],
            place[i] - lever[i],
            e.plate[i] - arm[i],
            e.plate_v[i] - swing[i],
        )
        wind[i] = moving[i] * (-p.drag / p.mass)
    period = p.period * p.tick_s
    rates = (p.k_position, p.k_velocity, p.k_integral, p.speed_max, p.integral_max, p.tilt_max)
    gains = StationGains(p.mass, period, *rates, p.thrust_min, p.thrust_max)
    gravity = apparent_gravity(b.environment, position, velocity)
    reference = StationReference(wanted, moving, np.zeros(3), p.heading)
    thrust, q_d, integral = keep_station(position, velocity, e.quat, reference, wind, gains, held, gravity)
    s.thrust = thrust
    for i in range(3):
        s.integral[i] = integral[i]
    for i in range(4):
        s.q_d[i] = q_d[i]
    s.hover += period / p.hover_s * (p.mass * (p.gravity + integral[2]) - s.hover)


@njit(cache=True)
def _ramp(target: float, held: bool, e: Record, p: Record, s: Record) -> None:
    step = p.thrust_rate * p.tick_s
    if held and target < s.thrust:
        # By now the arm must carry what the rotors no longer do.
        expected = p.weight * (1.0 - e.thrust / max(s.hover, 1e-3))
        step *= min(max(1.0 - (expected - e.hinge_force[2]) / p.force_slack, 0.0), 1.0)
    s.thrust += min(max(target - s.thrust, -step), step)
