"""The UAV on board: attitude loop around the set-point that arrived last, and what it does where none arrives; compiled.

| symbol | name | unit |
|---|---|---|
| q_d, f_T, Δτ | set-point (4,), thrust and extra torque (3,) as they arrive over the link | 1, N, N·m |
| η | `effectiveness`: torque that the rotors make of one N·m of Δτ asked for | 1 |

A UAV whose link is silent for longer than its watchdog helps itself: flying, it hovers by its own position estimate (optical
flow and sonar) and climbs away; held, it stays level with the thrust it has; on the cradle it lets the rotors run down.
A held UAV stops all its rotors where one of them gives less than its due: the arm carries it. A UAV that is hinged on the arm for
good stands level, by what arrived last.
"""

import numpy as np
from numba import njit

from armland.control.laws.station_keeping import StationGains, StationReference, keep_station
from armland.models.airframe.allocation import allocation_layout, share_out, tell_allocation
from armland.models.airframe.slope import slope_layout, tell_slope, torque_share
from armland.plant.devices.attitude import attitude_layout, attitude_torque, find_disturbance, tell_attitude
from armland.plant.devices.link import WEAK_SAMPLES, arrive
from armland.plant.noise import Noise
from armland.plant.scene.composition import Scene
from armland.records import MOST_ROTORS, Record, Records, UavMode
from armland.rotations import Array
from armland.scenario import Scenario

SPEED_CORRELATED_S = 0.3
"""Correlation time of the error of its own velocity. Assumption: optical flow over moving light and shade."""

HEADING_HELD = 0.35
"""Farthest from its present heading, rad, that it hovers by itself towards. Assumption: as autopilots that level a UAV first."""

AUTONOMOUS, GUIDED, HELD, CAUGHT = UavMode.AUTONOMOUS, UavMode.GUIDED, UavMode.HELD, UavMode.CAUGHT
LANDED, OFF, HINGED = UavMode.LANDED, UavMode.OFF, UavMode.HINGED

HOVER = (
    "k_position",
    "k_velocity",
    "k_integral",
    "speed_max",
    "integral_max",
    "tilt_max",
    "lift_min",
    "thrust_max",
)


def told_layout(joints: int) -> np.dtype:
    """What the UAV is told."""
    return np.dtype(
        [
            ("period", "i8"),  # ticks
            ("watchdog", "i8"),  # ticks without a message after which it helps itself
            ("climb", "f8"),  # m, by which it climbs away
            ("run_down", "f8"),  # N a sample
            ("watch", "f8"),  # share of its due thrust below which a rotor counts as lost
            ("watched", "f8"),  # N, thrust from which on a rotor is watched
            ("effectiveness", "f8"),
            ("torque_limit", "f8", (3,)),  # N·m, largest Δτ that it accepts
            ("mass", "f8"),  # kg that it believes
            ("hover_noise", "f8"),  # m
            ("speed_sigma", "f8"),  # m/s, of the velocity that it hovers by, each axis
            ("speed_hold", "f8"),  # share of that error which is left after a sample
            ("speed_bias", "f8", (3,)),  # m/s
            ("trim", "f8"),  # m/s², by which the integral is off at the start
            *((name, "f8") for name in HOVER),
            ("allocation", np.dtype(allocation_layout())),
            *attitude_layout(),
            *slope_layout(),
        ]
    )


def kept_layout(joints: int) -> np.dtype:
    """What the UAV keeps."""
    return np.dtype(
        [
            ("hovering", "i8"),
            ("anchor", "f8", (3,)),  # m, W, where it hovers by itself
            ("heading", "f8"),  # rad
            ("speed_error", "f8", (3,)),  # m/s
            ("integral", "f8", (3,)),  # of the hover's position loop; kept: what it knows of its own thrust
            ("thrust", "f8"),  # N, set-point in use
            ("filtered", "f8", (3,)),  # rate that the attitude loop's derivative has filtered, rad/s
            ("leaning", "f8", (3,)),  # N·m, integral of the attitude loop
            ("torque", "f8", (3,)),  # N·m, that the rotors are believed to give, of the observer
            ("impulse", "f8", (3,)),  # N·m·s, of that and of −ω × L since the last sample
            ("momentum", "f8", (3,)),  # N·m·s, at the last sample
            ("disturbance", "f8", (3,)),  # N·m, that it has found
            ("weak", "i8"),  # samples for which a rotor has given too little
            ("cut", "i8"),  # 1: stopped its rotors itself
        ]
    )


def tell(told: Records, scenario: Scenario, scene: Scene, effect: Array) -> None:
    """Fill `told` (1,); `effect` (6, n), 1 and m, is the rotors', of `models.airframe.rotor_set.effect_of`."""
    o, rate, link, rotors = scenario.onboard, scenario.run.rate_hz, scenario.link, scenario.rotors
    told["period"], told["watchdog"] = rate // o.rate_hz, round(o.watchdog_ms * rate / 1000.0)
    told["watched"] = o.watched_n
    told["climb"], told["watch"], told["run_down"] = o.climb_m, o.rotor_watch, o.run_down_nps * (1.0 / o.rate_hz)
    told["effectiveness"], told["torque_limit"] = link.torque_effectiveness, link.torque_limit_nm
    told["mass"], told["hover_noise"] = scene.uav_mass, scenario.imperfections.hover_noise_m
    told["speed_hold"] = np.exp(-1.0 / (o.rate_hz * SPEED_CORRELATED_S))
    h = o.hover
    told["k_position"], told["k_velocity"], told["k_integral"] = h.k_position, h.k_velocity, h.k_integral
    told["speed_max"], told["integral_max"] = h.speed_max_mps, h.integral_max_mps2
    told["tilt_max"], told["lift_min"], told["thrust_max"] = h.tilt_max_rad, h.lift_min_n, h.thrust_max_n
    tell_allocation(told["allocation"], effect, rotors.min_thrust_n, rotors.max_thrust_n)
    tell_attitude(told, scenario)
    tell_slope(told, scenario, scene.uav_mass * abs(scenario.environment.gravity_mps2[2]), effect.shape[1])


@njit(cache=True)
def fly(k: int, world: Record, noise: Noise, row: int, t: Record) -> None:
    """One sample on board: what the rotors are asked for, from what has arrived over the link, or by the UAV's own means.

    Args:
        k: present tick, one of the UAV's samples.
        world: of `world.world_layout`; what `link`, `onboard` and `rotors.asked` keep is updated.
        noise: of the devices.
        row: of the noise.
        t: truth, of which the UAV's own position estimate is made.
    """
    told, kept = world.told, world.kept
    p, s = told.onboard, kept.onboard
    arrive(k, told.link, kept.link, kept.faults, noise.link[row])
    if kept.faults.unpowered:
        s.hovering = 0
        for i in range(MOST_ROTORS):
            kept.rotors.asked[i] = 0.0
        return
    arrived = kept.link.arrived
    mode, silent = arrived.mode, k - kept.link.heard > p.watchdog
    q_d, extra = np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3)
    if kept.faults.deaf or mode == AUTONOMOUS or (silent and mode in (GUIDED, CAUGHT)):
        q_d = _hover(world, t, noise.hover[row], noise.speed[row], p.climb if silent else 0.0, mode == AUTONOMOUS)
    else:
        s.hovering = 0
        if mode != HINGED:
            q_d = arrived.quat.copy()
        for i in range(3):
            extra[i] = p.effectiveness * min(max(arrived.delta_tau[i], -p.torque_limit[i]), p.torque_limit[i])
        if mode == OFF:
            s.thrust = 0.0
        elif silent and mode == LANDED:
            s.thrust = max(s.thrust - p.run_down, 0.0)
        elif not silent or mode == HINGED:
            s.thrust = arrived.thrust
    asked = kept.rotors.asked
    if _watch(mode, p, s, kept.rotors) or s.thrust <= 0.0:
        for i in range(MOST_ROTORS):
            asked[i] = 0.0
        return
    torque = _torque(mode, q_d, extra, world)
    rotor = share_out(s.thrust, torque, p.allocation)
    for i in range(MOST_ROTORS):
        asked[i] = rotor[i]


@njit(cache=True)
def _torque(mode: int, q_d: Array, extra: Array, world: Record) -> Array:
    told, kept = world.told, world.kept
    p, s = told.onboard, kept.onboard
    torque = attitude_torque(kept.imu.quat, kept.imu.rate, q_d, p, s)
    if mode == LANDED:
        # What the cradle turns is not the rotors' to turn back.
        s.leaning[:] = 0.0
    found = find_disturbance(kept.imu.rate, extra, kept.rotors.asked, told.rotors.mixer, p, s)
    made = torque_share(s.thrust, p)
    for i in range(3):
        torque[i] = made * (torque[i] + extra[i] - found[i])
    return torque


@njit(cache=True)
def _watch(mode: int, p: Record, s: Record, rotors: Record) -> bool:
    # Each motor's speed is known on board. Held, a UAV with a lost rotor stops the others: all run down alike, and what
    # tips it over is no more than what came before. Flying, it has no better choice than to go on.
    weak = False
    for k in range(MOST_ROTORS):
        weak = weak or (rotors.due[k] > p.watched and rotors.static[k] < p.watch * rotors.due[k])
    s.weak = s.weak + 1 if weak else 0
    s.cut = 1 if mode in (HELD, CAUGHT) and (s.cut or s.weak >= WEAK_SAMPLES) else 0
    return bool(s.cut)


@njit(cache=True)
def _near(heading: float, present: float) -> float:
    # After a knock that spins it, a UAV keeps the heading that it has come to: turning back by a quarter turn would take from the
    # rotors what levels it.
    off = np.arctan2(np.sin(heading - present), np.cos(heading - present))
    return heading if abs(off) <= HEADING_HELD else present + (HEADING_HELD if off > 0.0 else -HEADING_HELD)


@njit(cache=True)
def _hover(world: Record, t: Record, noise: Array, speed: Array, climb: float, told: bool) -> Array:
    # Own position estimate: the true one and white noise, in the UAV's own idea of the axes; own velocity: the true one, a bias, and
    # noise that is correlated. Where the ground has told it to hover by itself, it takes the step that it was told.
    kept, bias = world.kept, world.told.imu.bias
    p, s, quat = world.told.onboard, kept.onboard, kept.imu.quat
    if not s.hovering:
        s.hovering = 1
        s.heading = 2.0 * np.arctan2(quat[3], quat[0])
        for i in range(3):
            s.anchor[i] = t.r_cm[i] + (climb if i == 2 else 0.0)
    s.heading = _near(s.heading, 2.0 * np.arctan2(quat[3], quat[0]))
    own, e, v, still = 2.0 * np.arctan2(bias[3], bias[0]), np.empty(3), np.empty(3), np.zeros(3)
    c, d, fresh = np.cos(own), np.sin(own), np.sqrt(1.0 - p.speed_hold**2)
    for i in range(3):
        e[i] = (s.anchor[i] + kept.faults.away[i]) - (t.r_cm[i] + p.hover_noise * noise[i])
    for i in range(3):
        s.speed_error[i] = p.speed_hold * s.speed_error[i] + p.speed_sigma * fresh * speed[i]
        v[i] = t.v_cm[i] + p.speed_bias[i] + s.speed_error[i]
    turned = np.array([c * e[0] - d * e[1], d * e[0] + c * e[1], e[2]])
    moving = np.array([c * v[0] - d * v[1], d * v[0] + c * v[1], v[2]])
    rates = (p.k_position, p.k_velocity, p.k_integral, p.speed_max, p.integral_max, p.tilt_max)
    gains = StationGains(p.mass, p.period_s, *rates, p.lift_min, p.thrust_max, 1.0)
    if told and not kept.faults.deaf:
        turned += kept.link.arrived.step
    reference, g = StationReference(turned, still, still, s.heading), world.environment.gravity
    here = still, moving, quat.copy()
    thrust, q_d, integral = keep_station(*here, reference, still, gains, s.integral.copy(), (g[0], g[1], g[2]))
    s.thrust = thrust
    for i in range(3):
        s.integral[i] = integral[i]
    return q_d
