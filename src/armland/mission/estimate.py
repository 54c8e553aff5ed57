"""What the controller knows at each tick: arm, plate, attitude, hinge force, who carries the weight, disturbance; compiled.

| symbol | name | unit, frame |
|---|---|---|
| r, ṙ | `estimate.r`, `.v` (3,): end effector point | m, m/s, D |
| p, ṗ | `estimate.plate`, `.plate_v` (3,): the hinge's pivot on the UAV | m, m/s, D |
| F | `estimate.hinge_force` (3,): of the end effector on plate and UAV | N, D |
| f_T | `estimate.thrust`: that acts as far as the ground knows | N |
| d̂ | `estimate.disturbance` (3,) | N, D |
"""

from functools import lru_cache

import numpy as np
from numba import njit

from armland.control.laws.attitude import QuaternionPdGains, initial_memory, quaternion_pd
from armland.estimation import contact, deck, disturbance, momentum, wrench
from armland.estimation.plate import layouts
from armland.linking import linked, named
from armland.mission.load import estimate_load
from armland.mission.screening import screened
from armland.mission.sight import MAGNET_ON, estimate_plate, known_push, lift_of, look_at_grip, take_attitude
from armland.models.airframe.slope import slope_layout, torque_share
from armland.models.operational import smallest_singular_value
from armland.records import Record, layout
from armland.rotations import Array

RING = 256
"""Ticks of thrust commands that the ground remembers, to know which one acts."""

UPLINK_S = 0.5
"""Time constant with which the uplink's delay is learnt."""

SINGULARITY_PERIOD = 20
"""Ticks between evaluations of the Jacobian's smallest singular value."""


@lru_cache
def told_layout(joints: int) -> np.dtype:
    """What the estimate is told, for an arm with `joints` joints."""
    return np.dtype(
        [
            ("tick_s", "f8"),
            ("gravity", "f8", (3,)),  # m/s² [W]
            ("fused", "i8"),  # 1: plate and attitude by the pose filter; 0: attitude as received, plate on the arm
            ("velocity_terms", "i8"),  # 1: the arm model evaluates C φ̇ and 𝒥̇ φ̇
            ("carried", "i8"),  # 1: it is told that its base moves
            ("coriolis", "i8"),  # 1: μ ẋ_d is fed forward
            ("joint_leap", "f8"),  # rad, from one sample to the next that no joint can move
            ("attitude_leap", "f8"),  # rad, beyond what its rates explain that no UAV turns
            ("mass", "f8"),  # kg, that flies: plate included
            ("weight", "f8"),  # N, of all that flies
            ("body_mass", "f8"),  # kg, that the hinge carries
            ("lever", "f8", (3,)),  # m, CM to pivot [B]
            ("uplink", "i8"),  # ticks until a thrust command acts on board, as believed
            ("windy", "i8"),  # 1: wind is expected, in which the lift of a held UAV is learnt and not its weight
            ("learns", "i8"),  # 1: uplink and weight are learnt in flight
            ("rotor_gain", "f8"),  # of the rotors' lag, per tick
            ("drag", "f8"),  # N·s/m, horizontal
            ("launch", "f8", (3,)),  # m/s, velocity that a take-off gives to the UAV [D]
            ("camera", "f8", (3,)),  # m, optical centre [E]
            ("slip", "f8"),  # m, offset of a held plate that counts as slipped off
            ("wrench_age", "i8"),  # ticks, of a force that is known
            ("calm_gain", "f8"),  # of the hinge force's average, per tick; 1: none
            (
                "tool_follows",
                "f8",
            ),  # 1: the tool's inertia force at the reference's acceleration is taken off the reading
            ("onboard_kp", "f8", (3,)),  # N·m/rad [B]
            ("onboard_kd", "f8", (3,)),  # N·m·s/rad [B]
            *slope_layout(),
            ("filter", layouts.told_layout()),
            ("wrench", wrench.told_layout()),
            ("contact", contact.told_layout()),
            ("observer", disturbance.told_layout()),
            ("deck", deck.told_layout()),
            ("momentum", momentum.told_layout(joints)),
        ]
    )


NOD = np.dtype(
    [("count", "i8"), *((name, "f8", (3,)) for name in ("a", "f", "aa", "fa", "gain", "vv", "wv", "followed"))]
)
"""Sums over a nod of the tool's acceleration a, m/s², the force f, N, and their products; the force found over the one expected, 1;
sums of v², v the speed asked for, m/s, and of w v, w the speed measured; the share of the nod that the arm made, 1."""


@lru_cache
def kept_layout(joints: int) -> np.dtype:
    """What the estimate keeps from tick to tick, for an arm with `joints` joints."""
    return np.dtype(
        [
            ("good", layout("measurement", joints)),  # last good measurement; its tick one more than the sample's
            ("same", "i8", (joints,)),  # samples in a row in which each joint read the same
            ("nod", NOD),
            ("bad", "i8"),  # numbers of the present measurement that could not be used
            ("sigma", "f8"),  # smallest singular value of the Jacobian
            ("mu", "f8", (6,)),  # N, N·m, μ ẋ_d [D]
            ("seen", "i8"),  # 1 once the plate has been seen
            ("grip", "f8", (3,)),  # m, of the plate's pivot from the end effector, smoothed over the newest images [E]
            ("grip_offset", "f8"),  # m, its size
            ("grip_tick", "i8"),  # that image's exposure
            ("grip_far", "i8"),  # images in a row in which it was too far off
            ("grip_newest", "f8", (3,)),  # m, of the newest image alone [E]
            ("grip_slides", "i8"),  # images in a row, unsmoothed, that show it too far off, each farther the same way
            ("thrust_log", "f8", (RING,)),  # N, commands
            ("acting", "f8"),  # N
            ("uplink", "f8"),  # ticks until a command acts on board, as the UAV's echoes say
            ("echoed", "i8"),  # the sample of which that was learnt last
            ("downlink", "f8"),  # ticks that the UAV's samples are under way, as their stamps say
            ("sample", "i8"),  # the stamp of the newest one
            ("arrived", "i8"),  # tick at which that came
            ("weight", "f8"),  # N, of all that flies, as the force-torque sensor finds it
            ("felt", "f8"),  # what one weighs on the deck over what one weighs at rest; on land 1
            ("calm", "f8", (3,)),  # N, hinge force, averaged [D]
            ("filter", layouts.kept_layout()),
            ("plate", layouts.plate_layout()),
            ("wrench", wrench.kept_layout()),
            ("contact", contact.kept_layout()),
            ("load", contact.load_layout()),
            ("observer", disturbance.kept_layout()),
            ("deck", deck.kept_layout()),
            ("momentum", momentum.kept_layout(joints)),
        ]
    )


@njit(cache=True)
def screen(b: Record) -> None:
    """Screen the measurement of the board `b`, and remember how many of its numbers could not be used; know where the deck is."""
    m, p, s = b.tick.measurement, b.told.estimate, b.kept.estimate
    held = b.kept.decide.held == 1
    if m.deck_known:
        deck.as_sent(m, s.good)
    s.bad = screened(m, s.good, s.same, held, p.joint_leap, p.attitude_leap, p.tick_s)
    if m.deck_known:
        deck.know_deck(m, p.gravity, p.tick_s, p.deck, s.deck, b.environment)
        deck.turn_into_deck(m, b.environment, p.tick_s)


@linked(lambda n: (named("board", n),))
@njit(cache=True)
def estimate(b: Record) -> None:
    """Fill the estimate of the tick, but for the disturbance, from the screened measurement and the arm's state.

    Args:
        b: board; what it keeps is that of the tick before.
    """
    m, e, p, s = b.tick.measurement, b.tick.estimate, b.told.estimate, b.kept.estimate
    row = b.table.phases[b.kept.decide.phase]
    if b.kept.limit.started == 0 or m.tick % SINGULARITY_PERIOD == 0:
        s.sigma = smallest_singular_value(b.arm.jacobian)
    watch_downlink(m, p, s)
    learn_uplink(m, p, s)
    e.thrust = acting_thrust(m.tick, p, s)
    estimate_arm(m, b.arm, e)
    if p.fused:
        push = known_push(row.arm, row.held == 1, b.kept.refer, p)
        estimate_plate(lift_of(row, b.kept.act, p, e), push, b)
        look_at_grip(m, p, s)
    else:
        take_attitude(m, e)
    s.seen = 1 if e.plate_valid else s.seen
    predict_torque(b.kept.act.q_d, p, e)
    estimate_load(row.free == 1, b.kept.act.magnet == MAGNET_ON, b.kept.decide.retreat, b)
    e.camera_noise, e.uplink, e.downlink = np.sqrt(s.filter.noise), s.uplink * p.tick_s, s.downlink * p.tick_s
    e.weight, e.hover = s.weight, b.kept.act.hover


@njit(cache=True)
def acting_thrust(tick: int, p: Record, s: Record) -> float:
    """Thrust that acts now as far as the ground knows, N: the command of one uplink ago behind the rotors' lag.

    Args:
        tick: present tick.
        p: what the estimate is told.
        s: what it keeps; `acting` is written.
    """
    s.acting += p.rotor_gain * (s.thrust_log[(tick - round(s.uplink)) % RING] - s.acting)
    return float(s.acting)


@njit(cache=True)
def watch_downlink(m: Record, p: Record, s: Record) -> None:
    """Learn how long the UAV's samples are under way, from their stamps, and when the newest one came.

    Args:
        m: measurement.
        p: what the estimate is told.
        s: what it keeps; `downlink`, ticks, `sample` and `arrived` are updated.
    """
    if m.uav_tick == s.sample:
        return
    gain = min(max((m.uav_tick - s.sample) * p.tick_s / UPLINK_S, 0.0), 1.0)
    s.downlink += gain * (m.tick - m.uav_tick - s.downlink)
    s.sample, s.arrived = m.uav_tick, m.tick


@njit(cache=True)
def learn_uplink(m: Record, p: Record, s: Record) -> None:
    """Learn how long commands take to the UAV, from those that it sends back with its samples; within what the log holds.

    Args:
        m: measurement.
        p: what the estimate is told.
        s: what it keeps; `uplink`, ticks, is updated.
    """
    if m.uav_tick == s.echoed or m.uav_echo <= 0 or p.learns == 0:
        return
    gain = min((m.uav_tick - s.echoed) * p.tick_s / UPLINK_S, 1.0)
    s.echoed = m.uav_tick
    late = min(max(m.uav_tick - m.uav_echo, 0), RING - 1)
    s.uplink += max(gain, 0.0) * (late - s.uplink)


@njit(cache=True)
def estimate_arm(m: Record, arm: Record, e: Record) -> None:
    """Fill the end effector point (3,), m, and its velocity (3,), m/s, deck, from the arm's joints: v = 𝒥 φ̇."""
    e.tick = m.tick
    for i in range(3):
        e.r[i] = arm.position[i]
        speed = 0.0
        for k in range(m.q.shape[0]):
            speed += arm.jacobian[i, k] * m.qd[k]
        e.v[i] = speed


@njit(cache=True)
def predict_torque(q_d: Array, p: Record, e: Record) -> None:
    """Fill τ_att (3,), N·m, body, of the estimate: what the controller on board makes of the attitude.

    Args:
        q_d: its set-point (4,), quaternion, D<-B, 1.
        p: what the estimate is told.
        e: estimate, written.
    """
    still = np.zeros(3)
    gains = QuaternionPdGains(p.onboard_kp, p.onboard_kd)
    tau_att, _ = quaternion_pd(e.quat, e.omega, q_d, still, still, gains, initial_memory(still))
    made = torque_share(e.thrust, p)
    for i in range(3):
        e.tau_att[i] = made * tau_att[i]
