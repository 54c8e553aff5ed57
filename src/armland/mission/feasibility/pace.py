"""How long the moves of a slow arm take: each phase's move is as fast as the mission has it, or as slow as the arm's joints need.

| symbol | name | unit |
|---|---|---|
| ẋ = s'(u) (b − a)/T | velocity of the end effector in a move from a to b that takes T, `reference.septic` (3,) | m/s |
| q̇ = 𝒥⁺ẋ | joint speeds of least length that give it, the attitude held (n,) | rad/s |
| q̈ = 𝒥⁺(ẍ − 𝒥̇q̇) | joint accelerations of least length, likewise (n,) | rad/s² |
| d, f | damping and dry friction of each joint, as the arm's file has them (n,) | N·m·s/rad, N·m |
| a = \\|M q̈ + C q̇\\| | torque that the move's acceleration takes, armature included (n,) | N·m |
| L | torque that weight, friction and following the UAV leave (n,) | N·m |
| v | `bounds.uav_speed_mps`, at which the arm follows the UAV while it joins it | m/s |

Torque bounds the speed as well: a move k times as long takes a/k² + d q̇/k of L. A joint with 100 N·m·s/rad
and 50 N·m turns at no more than 0.4 rad/s, and one with 1 kg·m² of armature and 1 N·m gains no more than 1 rad/s in a second,
however fast its file says that it is.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from armland.errors import WorkspaceError
from armland.mission.feasibility.way import AT_ONCE, ON_THE_WAY, drawn, sinking
from armland.mission.reference.septic import septic
from armland.mission.table.mission import At, Mission
from armland.mission.table.phases import Phase
from armland.models.arm import ArmModel
from armland.models.nearby import body_of, sink
from armland.models.posture import lead
from armland.rotations import Array
from armland.scenario import Scenario

SHARE = 0.8
"""Of the joint speeds at which the supervisor stops the arm that a move may use: the rest is for following the UAV, and for control."""

SLOWEST = 4.0
"""How many times longer than the mission has it a move may take; the UAV and the magnet would wait too long."""

LEAST = 0.01
"""Share of a joint's torque that counts as left where nothing is."""

TORQUE = 0.95
"""Of the joints' torque limits that a move may take: what gravity, gain and zero of the torque err by."""

FRACTIONS = np.linspace(0.2, 0.8, 7)
"""Of a move's time at which its joint speeds are looked at: outside it has less than a quarter of its largest speed."""


def paced(
    phases: tuple[Phase, ...], mission: Mission, arm: ArmModel, home: Array, scenario: Scenario, weight: float
) -> tuple[Phase, ...]:
    """The phases, those with a move that is too fast for the arm stretched, time-out included.

    Args:
        phases: of the mission.
        mission: whose `moves` say from where to where.
        arm: the arm model (its state is overwritten).
        home: joint positions (n,), rad, at the mission's first way point.
        scenario: believed.
        weight: of the UAV that a held phase carries, N.

    Raises:
        WorkspaceError: a move that would take more than `SLOWEST` times as long; names joint and speed or torque.
    """
    q, times, posture = home, {}, home if scenario.control.posture_rad_s > 0.0 else None
    for phase in (p for p in phases if p.name in mission.moves and p.duration_s > 0.0):
        a, b = (_point(at, scenario) for at in mission.moves[phase.name])
        q = lead(arm, q, a)
        task = _Task(a, b, phase.duration_s, weight if phase.held else 0.0, phase.arm == "join", posture)
        most, told = max(_needs(arm, q, task, scenario), key=lambda need: need[0])
        if most > SHARE * SLOWEST:
            raise WorkspaceError(f"in the phase {phase.name} joint {told}")
        times[phase.name] = phase.duration_s * max(most / SHARE, 1.0)
        q = lead(arm, q, b)
    return tuple(
        p._replace(duration_s=times[p.name], timeout_s=p.timeout_s + times[p.name] - p.duration_s)
        if p.name in times
        else p
        for p in phases
    )


def _point(at: At, scenario: Scenario) -> Array:
    return np.array(getattr(scenario.place, at.place)) + [0.0, 0.0, at.height(scenario)]


class _Task(NamedTuple):
    start: Array  # (3,) m, D
    end: Array  # (3,) m, D
    duration: float  # s
    weight: float  # N, carried
    follows: bool  # whether the arm follows the UAV meanwhile
    posture: Array | None  # (n,) rad, to which the null space is drawn


class _Demand(NamedTuple):
    # What a move asks of the joints at one time, (n,) each, rad/s and N·m.
    speed: Array
    held: Array  # by weight and friction
    following: Array  # by following the UAV
    turning: Array  # by damping
    gaining: Array  # by acceleration

    def torque(self, tau_max: Array) -> Array:
        # How many times longer the move has to take for the joints' torque, times SHARE (n,).
        left = SHARE * np.maximum(TORQUE * tau_max - self.held - self.following, LEAST * tau_max)
        return SHARE * (self.turning + np.sqrt(self.turning**2 + 4.0 * left * self.gaining)) / (2.0 * left)

    def least(self) -> Array:
        # Torque limits of which the slowest move may be made (n,), N·m.
        move = self.turning / SLOWEST + self.gaining / SLOWEST**2
        return (self.held + self.following + move / SHARE) / TORQUE


def _needs(arm: ArmModel, q: Array, task: _Task, scenario: Scenario) -> Iterator[tuple[float, str]]:
    # How many times longer than it is each point of a move would have it, times SHARE, and what is said of it.
    rated = scenario.limits.joint_speed_share * arm.qd_max
    for demand in _demands(arm, q, task, scenario):
        shares = demand.speed / rated
        j = int(shares.argmax())
        yield float(shares[j]), _too_fast(j, float(shares[j]), arm, scenario)
        shares = demand.torque(arm.tau_max)
        j = int(shares.argmax())
        yield float(shares[j]), _too_weak(j, demand, arm, scenario)


UNTIL = f"up to {SHARE * SLOWEST:g} times the move is made slower"


def _too_fast(joint: int, most: float, arm: ArmModel, scenario: Scenario) -> str:
    return (
        f"{arm.joint_names[joint]} would have to turn at {most:.1f} times the "
        f"{scenario.limits.joint_speed_share * arm.qd_max[joint]:.2f} rad/s that limits.joint_speed_share leaves it; {UNTIL}"
    )


def _too_weak(joint: int, demand: _Demand, arm: ArmModel, scenario: Scenario) -> str:
    speed, damping = scenario.bounds.uav_speed_mps, arm.damping[joint]
    torque, most = arm.tau_max[joint], f"at least {demand.least()[joint]:.2g} N·m"
    joining = f"joining a UAV takes that flies at up to bounds.uav_speed_mps = {speed:g}, with its weight and friction; {UNTIL}. "
    if demand.turning[joint] > demand.gaining[joint]:
        return (
            f"{arm.joint_names[joint]} has {damping:g} N·m·s/rad of damping, and its {torque:.0f} N·m cannot turn against that as fast "
            f"as {joining}What works is {most}, arm.torque_limits_nm, or a file with less damping"
        )
    return (
        f"{arm.joint_names[joint]} moves {arm.mass_matrix[joint, joint]:.3g} kg·m², {arm.model.dof_armature[joint]:.3g} of it "
        f"armature, and its {torque:.3g} N·m cannot quicken that as fast as {joining}What works is {most}, arm.torque_limits_nm, "
        f"or a file with less armature"
    )


def _demands(arm: ArmModel, q: Array, task: _Task, scenario: Scenario) -> Iterator[_Demand]:
    # Along a move, the null space sunk as the controller lets it.
    body, how, way = body_of(arm), sinking(arm, scenario), task.end - task.start
    if task.posture is not None:
        how = drawn(how, arm, scenario, task.posture)
    q, still = q.copy(), np.zeros(arm.joints)
    for k, u in enumerate(FRACTIONS):
        s, rate, second = septic(float(u), task.duration)
        sink(body, q, task.start + s * way, how, ON_THE_WAY if k else AT_ONCE)
        arm.update(q, still)
        qd = joint_speeds(arm, rate * way)
        yield _Demand(
            speed=np.abs(qd),
            held=np.abs(arm.gravity + task.weight * arm.jacobian[2]) + arm.friction,
            following=_following_torque(arm, scenario) if task.follows else still,
            turning=arm.damping * np.abs(qd),
            gaining=_gaining(arm, q, qd, second * way, task.weight),
        )


def _following_torque(arm: ArmModel, scenario: Scenario) -> Array:
    # What it takes to go as fast as the UAV, and to gain speed as fast as station keeping brakes it (n,), N·m.
    speed = scenario.bounds.uav_speed_mps
    gained = [
        arm.mass_matrix @ joint_speeds(arm, speed * scenario.control.station.k_velocity * axis) for axis in np.eye(3)
    ]
    return np.asarray(arm.damping * following(arm, speed) + np.linalg.norm(gained, axis=0))


def _gaining(arm: ArmModel, q: Array, qd: Array, acceleration: Array, weight: float) -> Array:
    # M q̈ + C q̇ with the UAV's mass at the end effector (n,), N·m; the arm is left with 𝒥̇q̇ evaluated.
    arm.update(q, qd)
    arm.refresh(velocity_terms=True)
    mass = weight / float(np.linalg.norm(arm.model.opt.gravity))
    bias = arm.state["acceleration_bias"][0]
    qdd = _least(arm, np.append(acceleration, np.zeros(3)) - bias)
    return np.abs(arm.mass_matrix @ qdd + arm.state["coriolis"][0] + mass * arm.jacobian[:3].T @ acceleration)


def following(arm: ArmModel, speed: float) -> Array:
    """Joint speeds (n,), rad/s, each the largest with which the end effector moves at `speed`, m/s, in any direction."""
    return np.asarray(np.linalg.norm([joint_speeds(arm, speed * axis) for axis in np.eye(3)], axis=0))


def joint_speeds(arm: ArmModel, velocity: Array) -> Array:
    """Joint speeds of least length (n,), rad/s, that move the end effector at `velocity` (3,), m/s, in the arm's present pose."""
    return _least(arm, np.append(velocity, np.zeros(3)))


def _least(arm: ArmModel, twist: Array) -> Array:
    J = arm.jacobian
    return np.asarray(J.T @ np.linalg.solve(J @ J.T + 1e-9 * np.eye(6), twist))


def downwards(arm: ArmModel, home: Array, speeds: Array) -> float:
    """Speed, m/s, with which the end effector may go down where the arm waits, its joints turning at up to `SHARE` of `speeds`.

    Args:
        arm: the arm model (its state is overwritten).
        home: where it waits (n,), rad.
        speeds: at which the supervisor stops the arm (n,), rad/s.
    """
    arm.update(home, np.zeros(arm.joints))
    return float(SHARE / np.max(np.abs(joint_speeds(arm, np.array([0.0, 0.0, -1.0]))) / speeds))
