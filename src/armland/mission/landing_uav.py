"""The UAV's part of a landing, as the ground sees it: station keeping, thrust ramp, and which command acts by now; compiled.

| symbol | name | unit |
|---|---|---|
| f_T | `memory.thrust` as commanded, `memory.acting` as it acts | N |
| T_h | `memory.hover`: the command that carries the weight, learnt while the UAV keeps its station | N |
| F | `estimate.hinge_force` (3,) | N, world |

Hand-over: the thrust ramps between shares of T_h. On the way down it waits while the hinge's force is behind what the
missing thrust must leave to the arm: a UAV that nobody carries is not let down.
"""

import numpy as np
from numba import njit

from armland.control.station_keeping import StationGains, StationReference, attitude_of, keep_station
from armland.mission.landing_state import RING
from armland.mission.phases import LINK, UAV
from armland.mission.records import UavMode
from armland.records import Record
from armland.rotations import Array, conjugate, cross, matrix, multiply

AUTONOMOUS, STATION, LEVEL, RAMP, BALANCE, OFF, RUN_UP, CRUISE = range(len(UAV))
MODE_AUTONOMOUS, MODE_OFF = UavMode.AUTONOMOUS, UavMode.OFF
MODES = (UavMode.GUIDED, UavMode.HELD, UavMode.LANDED, UavMode.CAUGHT)
"""By index into `phases.LINK`."""
HELD = LINK.index("held")

BALANCE_RATE = 1.5
"""N/s of thrust per N of hinge force while the hinge is freed of force."""

HOVER_S = 1.0
"""Time constant with which T_h follows the station keeping, s."""


@njit(cache=True)
def thrust_in_force(tick: int, p: Record, s: Record) -> float:
    """Thrust that acts now as far as the ground knows: the command of one uplink ago behind the rotors' lag, N."""
    s.acting += p.rotor_gain * (s.thrust_log[(tick - p.uplink) % RING] - s.acting)
    return float(s.acting)


@njit(cache=True)
def command_uav(
    tick: int, what: int, share: float, link: int, align: Array, e: Record, p: Record, s: Record, c: Record
) -> None:
    """Fill mode, attitude set-point and thrust of the command.

    Args:
        tick: present tick.
        what: index into `UAV`.
        share: of the weight that the rotors shall carry at the end of a ramp.
        link: index into `LINK`.
        align: δ (4,), q_wb = δ ⊗ q_imu: set-points travel in the UAV's own idea of the world.
        e: estimate.
        p: parameters.
        s: memory.
        c: command, written.
    """
    c.uav_mode = MODES[link]
    blind = not e.plate_valid and (what == STATION or (what == CRUISE and not p.fly_on))
    if what == AUTONOMOUS or blind:
        c.uav_mode = MODE_AUTONOMOUS
        s.thrust = s.hover
        _level(p, s)
    elif what == STATION:
        if tick % p.station_period == 0:
            _keep(p.station - p.lever, np.zeros(3), e, p, s)
    elif what == CRUISE:
        if tick % p.station_period == 0 or s.cruising == 0:
            _cruise(tick, e, p, s)
    elif what == RAMP:
        _ramp(share * s.hover, link == HELD, e, p, s)
        _level(p, s)
        if share == 0.0 and s.thrust <= p.thrust_min:
            s.thrust, c.uav_mode = 0.0, MODE_OFF
    elif what == RUN_UP:
        # The thrust that carried the weight at rest: what the arm pushes with is not to be balanced.
        _against_drag(e.v, p, s)
    elif what == BALANCE:
        step = min(max(BALANCE_RATE * e.hinge_force[2], -p.thrust_rate), p.thrust_rate) * p.tick_s
        s.thrust = min(max(s.thrust + step, p.thrust_min), p.thrust_max)
        s.hover = s.thrust
        # What carries the weight now is where the station keeping takes over.
        s.integral[0] = s.integral[1] = 0.0
        s.integral[2] = s.thrust / p.mass - 9.81
        _level(p, s)
    elif what == OFF:
        s.thrust, c.uav_mode = 0.0, MODE_OFF
    quat = multiply(conjugate(align), s.q_d)
    for i in range(4):
        c.uav_quat[i] = quat[i]
    c.thrust = s.thrust
    s.thrust_log[tick % RING] = s.thrust


@njit(cache=True)
def _level(p: Record, s: Record) -> None:
    s.q_d[0], s.q_d[1], s.q_d[2], s.q_d[3] = np.cos(0.5 * p.heading), 0.0, 0.0, np.sin(0.5 * p.heading)


@njit(cache=True)
def _against_drag(v: Array, p: Record, s: Record) -> None:
    # Tilted so that the thrust holds the drag at velocity v: the hinge is then free of force at a constant speed.
    force = np.array([p.drag * v[0], p.drag * v[1], p.weight])
    q_d = attitude_of(force, p.heading)
    for i in range(4):
        s.q_d[i] = q_d[i]


@njit(cache=True)
def _cruise(tick: int, e: Record, p: Record, s: Record) -> None:
    if p.fly_on:
        # Too heavy to hover: all that the rotors give, and the tilt that keeps the speed by itself.
        s.thrust = p.thrust_max
        _against_drag(p.launch, p, s)
        s.cruising = tick
        return
    if s.cruising == 0:
        s.cruising = tick
        R = matrix(e.quat)
        for i in range(3):
            s.anchor[i] = e.plate[i] - (R[i, 0] * p.lever[0] + R[i, 1] * p.lever[1] + R[i, 2] * p.lever[2])
    _keep(s.anchor + p.launch * ((tick - s.cruising) * p.tick_s), p.launch + 0.0, e, p, s)


@njit(cache=True)
def _keep(place: Array, moving: Array, e: Record, p: Record, s: Record) -> None:
    # At `place` (3,), m, of the centre of mass, which moves at `moving` (3,), m/s.
    R = matrix(e.quat)
    position = e.plate - R @ p.lever
    velocity = e.plate_v - R @ cross(e.omega, p.lever)
    period = p.station_period * p.tick_s
    gains = StationGains(p.mass, 9.81, period, 1.2, 3.0, 1.2, 0.3, 3.0, 0.3, p.thrust_min, p.thrust_max)
    reference = StationReference(place, moving, np.zeros(3), p.heading)
    wind = moving * (-p.drag / p.mass)
    thrust, q_d, integral = keep_station(position, velocity, e.quat, reference, wind, gains, s.integral.copy())
    s.thrust = thrust
    for i in range(3):
        s.integral[i] = integral[i]
    for i in range(4):
        s.q_d[i] = q_d[i]
    s.hover += period / HOVER_S * (p.mass * (9.81 + integral[2]) - s.hover)


@njit(cache=True)
def _ramp(target: float, held: bool, e: Record, p: Record, s: Record) -> None:
    step = p.thrust_rate * p.tick_s
    if held and target < s.thrust:
        # By now the arm must carry what the rotors no longer do.
        expected = p.weight * (1.0 - e.thrust / max(s.hover, 1e-3))
        step *= min(max(1.0 - (expected - e.hinge_force[2]) / p.force_slack, 0.0), 1.0)
    s.thrust += min(max(target - s.thrust, -step), step)


@njit(cache=True)
def land_rotors(s: Record) -> None:
    """Begin a mission on the cradle: no thrust acts."""
    s.thrust = s.acting = 0.0
    for i in range(RING):
        s.thrust_log[i] = 0.0
