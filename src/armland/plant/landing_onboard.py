"""The UAV on board: attitude loop around the set-point that arrived last, and what it does where none arrives; compiled.

| symbol | name | unit |
|---|---|---|
| q_d, f_T | set-point (4,) and thrust as they arrive over the link | 1, N |

A UAV whose link is silent for longer than its watchdog helps itself: flying, it hovers by its own position estimate (optical
flow and sonar) and climbs away; held, it stays level with the thrust it has; on the cradle it lets the rotors run down.
A held UAV stops all its rotors where one of them gives less than its due: the arm carries it.
"""

import numpy as np
from numba import njit

from armland.control.attitude import AttitudeMemory, CascadeGains, cascade
from armland.control.station_keeping import StationGains, StationReference, keep_station
from armland.mission.records import UavMode
from armland.models.uav import allocate
from armland.records import Record
from armland.rotations import Array

RING = 1024
"""Length of the link's delay lines in ticks."""

DERIVATIVE_LAG_S = 0.01
"""Low pass of the cascade's derivative, s."""

RUN_DOWN = 3.0
"""N/s at which a UAV without link that stands on the cradle takes its thrust back."""

WATCHED_N = 0.3
"""Thrust from which on a rotor is watched, N."""

WEAK_SAMPLES = 2
"""Samples in a row that make a weak rotor a lost one."""

AUTONOMOUS, GUIDED, HELD, CAUGHT = UavMode.AUTONOMOUS, UavMode.GUIDED, UavMode.HELD, UavMode.CAUGHT
LANDED, OFF = UavMode.LANDED, UavMode.OFF


@njit(cache=True)
def fly(tick: int, p: Record, s: Record, t: Record, noise: Array) -> None:
    """One sample on board: fill `rotor_asked` from what has arrived over the link, or by the UAV's own means.

    Args:
        tick: present tick.
        p: `landing_devices.PARAMETERS`.
        s: `landing_devices.STATE`, updated.
        t: truth, of which the UAV's own position estimate is made.
        noise: standard normal numbers (3,), for that.
    """
    sent = tick - p.uplink
    if sent >= 0 and s.sent[sent % RING] == sent:
        s.heard = tick
        for i in range(6):
            s.arrived[i] = s.up[sent % RING, i]
    silent = tick - s.heard > p.watchdog
    mode = int(s.arrived[5])
    q_d = s.arrived[:4].copy()
    if s.deaf or mode == AUTONOMOUS or (silent and mode in (GUIDED, CAUGHT)):
        q_d = _hover(p, s, t, noise, p.climb if silent else 0.0)
    else:
        s.hovering = 0
        if mode == OFF:
            s.thrust = 0.0
        elif silent and mode == LANDED:
            s.thrust = max(s.thrust - RUN_DOWN * p.onboard_s, 0.0)
        elif not silent:
            s.thrust = s.arrived[4]
    if _watch(mode, p, s) or s.thrust <= 0.0:
        for k in range(4):
            s.rotor_asked[k] = 0.0
        return
    rotor = allocate(s.thrust, _attitude(q_d, p, s), p.mixer_inverse, p.rotor_min, p.rotor_max)
    for k in range(4):
        s.rotor_asked[k] = rotor[k]


@njit(cache=True)
def _watch(mode: int, p: Record, s: Record) -> bool:
    # Each motor's speed is known on board. Held, a UAV with a lost rotor stops the others: all four run down alike, and what
    # tips it over is no more than what came before. Flying, it has no better choice than to go on.
    weak = False
    for k in range(4):
        weak = weak or (s.rotor_due[k] > WATCHED_N and s.rotor[k] < p.watch * s.rotor_due[k])
    s.weak = s.weak + 1 if weak else 0
    s.cut = 1 if mode in (HELD, CAUGHT) and (s.cut or s.weak >= WEAK_SAMPLES) else 0
    return bool(s.cut)


@njit(cache=True)
def _hover(p: Record, s: Record, t: Record, noise: Array, climb: float) -> Array:
    # Own position estimate: the true one and white noise, in the UAV's own idea of the axes.
    position = np.empty(3)
    for i in range(3):
        position[i] = t.r_cm[i] + p.hover_noise * noise[i]
    if not s.hovering:
        s.hovering = 1
        s.heading = 2.0 * np.arctan2(s.imu[3], s.imu[0])
        for i in range(3):
            s.anchor[i] = t.r_cm[i] + (climb if i == 2 else 0.0)
    anchor, own = np.empty(3), 2.0 * np.arctan2(p.imu_bias[3], p.imu_bias[0])
    c, d = np.cos(own), np.sin(own)
    for i in range(3):
        anchor[i] = s.anchor[i] + s.away[i]
    e, v = anchor - position, t.v_cm + 0.0
    turned = np.array([c * e[0] - d * e[1], d * e[0] + c * e[1], e[2]])
    moving = np.array([c * v[0] - d * v[1], d * v[0] + c * v[1], v[2]])
    gains = StationGains(p.mass, 9.81, p.onboard_s, 0.8, 2.2, 1.0, 0.5, 5.0, 0.4, 1.4, 7.0)
    still = np.zeros(3)
    reference = StationReference(turned, still, still, s.heading)
    thrust, q_d, integral = keep_station(still, moving, s.imu[:4].copy(), reference, still, gains, s.integral.copy())
    s.thrust = thrust
    for i in range(3):
        s.integral[i] = integral[i]
    return q_d


@njit(cache=True)
def _attitude(q_d: Array, p: Record, s: Record) -> Array:
    # PD times (1 + lead s): the derivative on the rate makes up for the rotors' lag.
    still, unlimited = np.zeros(3), np.full(3, 1e9)
    k_rate = p.kd + p.kp * p.lead
    gains = CascadeGains(
        p.kp / k_rate, unlimited, k_rate, still, p.kd * p.lead, unlimited, DERIVATIVE_LAG_S, p.onboard_s
    )
    memory = AttitudeMemory(still, s.rate.copy())
    torque, memory = cascade(s.imu[:4].copy(), s.imu[4:].copy(), q_d, still, still, gains, memory)
    for i in range(3):
        s.rate[i] = memory.rate[i]
    return torque
