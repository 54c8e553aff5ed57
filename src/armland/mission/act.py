"""The stage that acts: what arm and UAV are asked for by the phase, the law of the held UAV and its proof; compiled.

| symbol | name | unit |
|---|---|---|
| F_EE, Δτ_att | `command.force`, `.delta_tau` (3,) | N, D; N·m, body |
| ẍ | acceleration of the end effector (6,), by the law or by (6) | m/s², rad/s², D |
| τ_j | `command.tau` (n,) | N·m |

Held: a row of `control.laws.table`. Free: r̈ = r̈_d − k e − d ė in operational space, the classical impedance (6) with K_d = Λ k,
D_d = Λ d and Λ r̈_d fed forward. Balancing: as free, with the load's force fed forward and the tool leant along.
"""

from functools import lru_cache

import numpy as np
from numba import njit

from armland.control.laws.balance import fall, lean_of
from armland.control.laws.impedance import impedance
from armland.control.laws.realisation import arm_torque, end_effector_rate, orientation_torque
from armland.control.laws.realisation import told_layout as realisation_told
from armland.control.laws.table import end_effector_acceleration, held_law, held_lyapunov
from armland.control.laws.table import kept_layout as law_kept
from armland.control.laws.table import told_layout as law_told
from armland.linking import MATRIX, head, linked, named
from armland.mission.estimate import RING
from armland.mission.load import observe
from armland.mission.reference import riding
from armland.mission.reference.moves import BALANCE, BRAKE
from armland.mission.reference.riding import ride
from armland.mission.uav import HINGED, command_uav
from armland.mission.uav import told_layout as uav_told
from armland.records import Record
from armland.rotations import Array, from_rotation_vector, matrix, rotation_error

PROOF_PERIOD = 5
"""Ticks between evaluations of V₂ for the record: as often as the UAV is heard of, at a fifth of the cost."""


@lru_cache
def told_layout(joints: int) -> np.dtype:
    """What acting is told, for an arm with `joints` joints."""
    return np.dtype(
        [
            ("uav", uav_told()),
            ("law", law_told()),
            ("realisation", realisation_told(joints)),
            ("stiffness", "f8", (3,)),  # 1/s², position error to acceleration while nothing is held
            ("damping", "f8", (3,)),  # 1/s
            ("lean_stiffness", "f8"),  # 1/s², likewise of the tool that leans
            ("lean_damping", "f8"),  # 1/s
        ]
    )


@lru_cache
def kept_layout() -> np.dtype:
    """What acting keeps from tick to tick."""
    return np.dtype(
        [
            ("magnet", "i8"),  # as commanded last
            ("force", "f8", (3,)),  # N, of the law, asked last [D]
            ("thrust", "f8"),  # N, commanded
            ("hover", "f8"),  # N, command that carries the weight
            ("integral", "f8", (3,)),  # m/s², of the station keeping
            (
                "hovered",
                "f8",
                (2,),
            ),  # m/s², horizontal, that held the UAV against the wind while it kept its station [D]
            ("freed", "i8"),  # 1 from the balance on the hinge until the station keeping begins
            ("short", "f8"),  # N, that a UAV which was caught leaves to the arm and should not
            ("falls_short", "i8"),  # 1 while that is learnt
            ("before", "f8"),  # N, `hover` before that
            ("alone", "i8"),  # ticks for which the UAV has been told to hover by itself
            ("step", "f8", (3,)),  # m, from where it began to do so to where it shall [D]
            ("lost", "f8", (3,)),  # m, pivot of a UAV that is looked for, as it was reckoned then [D]
            ("begun", "f8"),  # s, for how long it had hovered by itself when that began
            ("sought", "i8"),  # 1 where it is looked for
            ("asked", "f8", (3,)),  # m, where a UAV that leans is asked to be, less what it goes along aside [D]
            ("above", "f8"),  # m, of which above its station
            ("trim", "f8", (3,)),  # m/s², that its own hover asks for beyond gravity [D]
            ("trimmed", "i8"),  # the sample of which that was learnt last; 0: none yet
            ("anchor", "f8", (3,)),  # m, where the centre of mass was when it began to fly on [D]
            ("cruising", "i8"),  # tick of that; 0: not yet
            ("q_d", "f8", (4,)),  # set-point, D<-B
            ("ride", riding.kept_layout()),
            ("law", law_kept()),
        ]
    )


@linked(lambda n: (named("board", n), MATRIX))
@njit(cache=True)
def act(b: Record, path: Array) -> None:
    """Fill the command of the tick, and the proof.

    Args:
        b: board, whose estimate, mission and reference are those of the tick.
        path: (k, 9), m, m/s, m/s², deck, of which the law's feed-forward looks ahead.
    """
    m, c, s = b.tick.measurement, b.tick.command, b.kept.act
    row = b.table.phases[b.kept.decide.phase]
    c.magnet, c.brake = row.magnet, 1 if row.arm == BRAKE else 0
    if m.tick % PROOF_PERIOD == 0:
        prove(row.held == 1, b)
    acceleration = hold(row, b, path) if row.held else move_free(b)
    torque_arm(row.arm, acceleration, b)
    if b.environment.moves:
        uav = b.told.act.uav
        ride(uav.station, uav.rides, uav.lags, uav.ahead, uav.tick_s, b.environment, s.ride)
    command_uav(row, b.kept.estimate.filter.align.quat, b)
    s.magnet = c.magnet
    b.kept.estimate.thrust_log[m.tick % RING] = s.thrust


@njit(cache=True)
def prove(held: bool, b: Record) -> None:
    """V₂, J, and the rate, W, that the law in use promises, into `proof`; NaN where nothing is held or no law promises it."""
    proof = b.tick.proof
    if held:
        held_lyapunov(b.tick.estimate, b.tick.reference, b.told.act.law, b.kept.act.law, proof)
    else:
        proof.tick, proof.v2, proof.v2_rate = b.tick.estimate.tick, np.nan, np.nan


@njit(cache=True)
def hold(row: Record, b: Record, path: Array) -> Array:
    """Force, torque and thrust by the law of the held UAV; returns the acceleration (6,), m/s², rad/s², D, for the arm.

    Args:
        row: phase.
        b: board.
        path: (k, 9), m, m/s, m/s², D, of which the law's feed-forward looks ahead.
    """
    e, r, p, s = b.tick.estimate, b.tick.reference, b.told.act, b.kept.act
    # Whether it may learn is the present phase's to say: it observes after that has been decided.
    observe(b, row.observe == 1)
    coming, ahead = min(r.tick + p.law.preview, path.shape[0] - 1), np.empty(3)
    for i in range(3):
        ahead[i] = path[coming, 6 + i]
    thrust = p.uav.hinged if row.uav == HINGED else e.thrust
    held_law(thrust, ahead, e, r, b.environment, p.law, s.law, head(b.tick.command))
    for i in range(3):
        s.force[i] = b.tick.command.force[i]
    return end_effector_acceleration(r, p.law, s.law)


@njit(cache=True)
def move_free(b: Record) -> Array:
    """Acceleration (6,), m/s², rad/s², D, of an end effector that carries nothing (6); no force and no torque are asked for."""
    e, r, c, p = b.tick.estimate, b.tick.reference, b.tick.command, b.told.act
    out, away, rate, stiffness, damping = np.zeros(6), np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    for i in range(3):
        c.force[i] = c.delta_tau[i] = 0.0
        e.disturbance[i] = b.kept.estimate.observer.force[i]
        away[i], rate[i] = e.r[i] - r.r[i], e.v[i] - r.v[i]
        stiffness[i], damping[i] = p.stiffness[i], p.damping[i]
    back = impedance(away, rate, stiffness, damping)
    for i in range(3):
        out[i] = r.a[i] + back[i]
    return out


@njit(cache=True)
def torque_arm(mode: int, acceleration: Array, b: Record) -> None:
    """Fill the joint torques of the command, and the end effector's torque.

    Args:
        mode: index into `ARM`.
        acceleration: (6,), m/s², rad/s², D, of the end effector.
        b: board.
    """
    m, c, p = b.tick.measurement, b.tick.command, b.told.act
    omega = end_effector_rate(m.qd, b.arm)
    torque = orientation_torque(omega, b.arm, p.realisation)
    if mode == BALANCE:
        load_force(b)
        lean = lean_acceleration(omega, b.arm.rotation, p, b.kept.refer.balance)
        for i in range(3):
            torque[i], acceleration[3 + i] = 0.0, lean[i]
    wrench = np.empty(6)
    for i in range(3):
        c.torque[i] = torque[i]
        wrench[i] = b.kept.estimate.mu[i] + c.force[i]
        wrench[3 + i] = b.kept.estimate.mu[3 + i] + torque[i]
    if mode == BRAKE:
        # What the last good sample says that holds it, should a brake let go; no law runs on it.
        for i in range(m.q.shape[0]):
            c.tau[i] = b.arm.gravity[i]
    else:
        arm_torque(m.q, m.qd, acceleration, wrench, b.told.estimate.velocity_terms == 1, b.arm, p.realisation, c.tau)


@njit(cache=True)
def load_force(b: Record) -> None:
    """Force (3,), N, D, of the command that holds up and swings a UAV at rest on its hinge: m (u + l θ̈) and its weight left."""
    e, c, s = b.tick.estimate, b.tick.command, b.kept.refer.balance
    mass, rate = b.told.estimate.body_mass, b.told.refer.balance.fall_rate
    x, y, _, _ = lean_of(e.quat, e.omega)
    lever, g = -b.told.estimate.lever[2], b.told.act.uav.gravity
    for i in range(2):
        tilt = x if i == 0 else y
        c.force[i] = mass * (s.sway_a[i] + lever * fall(tilt, s.sway_a[i], rate, g))
    c.force[2] = max(b.told.estimate.weight * b.kept.estimate.felt - e.thrust, 0.0)


@njit(cache=True)
def lean_acceleration(omega: Array, rotation: Array, p: Record, s: Record) -> Array:
    """Angular acceleration (3,), rad/s², D, that leads the tool along φ of `reference.balance`.

    Args:
        omega: of the end effector (3,), rad/s, D.
        rotation: D<-E (3, 3).
        p: what acting is told.
        s: what balancing keeps.
    """
    tilt, R_d, out = matrix(from_rotation_vector(s.lean)), np.zeros((3, 3)), np.empty(3)
    for i in range(3):
        for k in range(3):
            for j in range(3):
                R_d[i, k] += tilt[i, j] * p.realisation.R_d[j, k]
    away = rotation_error(rotation, R_d)
    for i in range(3):
        out[i] = s.lean_a[i] + p.lean_stiffness * away[i] + p.lean_damping * (s.lean_v[i] - omega[i])
    return out
