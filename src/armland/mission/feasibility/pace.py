"""How long the moves of a slow arm take: each phase's move is as fast as the mission has it, or as slow as the arm's joints need.

| symbol | name | unit |
|---|---|---|
| ẋ = s'(u) (b − a)/T | velocity of the end effector in a move from a to b that takes T, `reference.septic` (3,) | m/s |
| q̇ = 𝒥⁺ẋ | joint speeds of least length that give it, the attitude held (n,) | rad/s |
| d, f | damping and dry friction of each joint, as the arm's file has them (n,) | N·m·s/rad, N·m |
| v | `bounds.uav_speed_mps`, at which the arm follows the UAV while it joins it | m/s |

Torque bounds the speed as well: d q̇ may take what weight, friction and following the UAV leave of it. A joint with 100 N·m·s/rad
and 50 N·m turns at no more than 0.4 rad/s, however fast its file says that it is.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from armland.errors import WorkspaceError
from armland.mission.feasibility.way import AT_ONCE, ON_THE_WAY, sinking
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
"""Of a joint's torque that counts as left where nothing is."""

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
    q, times = home, {}
    for phase in (p for p in phases if p.name in mission.moves and p.duration_s > 0.0):
        a, b = (_point(at, scenario) for at in mission.moves[phase.name])
        q = lead(arm, q, a)
        task = _Task(a, b, phase.duration_s, weight if phase.held else 0.0, phase.arm == "join")
        seen = np.array([*_shares(arm, q, task, scenario)])
        kind, worst = np.unravel_index(int(seen.max(axis=0).argmax()), seen.shape[1:])
        most = float(seen.max())
        if most > SHARE * SLOWEST:
            raise WorkspaceError(
                f"in the phase {phase.name} joint {arm.joint_names[worst]} {_told(int(kind), int(worst), most, arm, scenario)}"
            )
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


def _told(kind: int, joint: int, most: float, arm: ArmModel, scenario: Scenario) -> str:
    until = f"up to {SHARE * SLOWEST:g} times the move is made slower"
    if kind == 0:
        return (
            f"would have to turn at {most:.1f} times the {scenario.limits.joint_speed_share * arm.qd_max[joint]:.2f} rad/s that "
            f"limits.joint_speed_share leaves it; {until}"
        )
    torque, damping = arm.tau_max[joint], arm.damping[joint]
    return (
        f"has {damping:g} N·m·s/rad of damping, and its {torque:.0f} N·m cannot turn against that as fast as joining a UAV takes that "
        f"flies at up to bounds.uav_speed_mps = {scenario.bounds.uav_speed_mps:g}, with its weight and friction; {until}. "
        f"What works is more of arm.torque_limits_nm, or a file with less damping"
    )


def _shares(arm: ArmModel, q: Array, task: _Task, scenario: Scenario) -> Iterator[Array]:
    # Of the allowed joint speeds, and of the torque that is left for damping (2, n), along a move, the null space sunk as the
    # controller lets it.
    body, how, way = body_of(arm), sinking(arm, scenario), task.end - task.start
    q = q.copy()
    for k, u in enumerate(FRACTIONS):
        s, rate, _ = septic(float(u), task.duration)
        sink(body, q, task.start + s * way, how, ON_THE_WAY if k else AT_ONCE)
        arm.update(q, np.zeros(arm.joints))
        speeds = np.abs(joint_speeds(arm, rate * way))
        taken = np.abs(arm.gravity + task.weight * arm.jacobian[2]) + arm.friction
        if task.follows:
            taken += arm.damping * following(arm, scenario.bounds.uav_speed_mps)
        left = np.maximum(TORQUE * arm.tau_max - taken, LEAST * arm.tau_max)
        yield np.array([speeds / (scenario.limits.joint_speed_share * arm.qd_max), arm.damping * speeds / left])


def following(arm: ArmModel, speed: float) -> Array:
    """Joint speeds (n,), rad/s, each the largest with which the end effector moves at `speed`, m/s, in any direction."""
    return np.asarray(np.linalg.norm([joint_speeds(arm, speed * axis) for axis in np.eye(3)], axis=0))


def joint_speeds(arm: ArmModel, velocity: Array) -> Array:
    """Joint speeds of least length (n,), rad/s, that move the end effector at `velocity` (3,), m/s, in the arm's present pose."""
    J = arm.jacobian
    return np.asarray(J.T @ np.linalg.solve(J @ J.T + 1e-9 * np.eye(6), np.append(velocity, np.zeros(3))))


def downwards(arm: ArmModel, home: Array, speeds: Array) -> float:
    """Speed, m/s, with which the end effector may go down where the arm waits, its joints turning at up to `SHARE` of `speeds`.

    Args:
        arm: the arm model (its state is overwritten).
        home: where it waits (n,), rad.
        speeds: at which the supervisor stops the arm (n,), rad/s.
    """
    arm.update(home, np.zeros(arm.joints))
    return float(SHARE / np.max(np.abs(joint_speeds(arm, np.array([0.0, 0.0, -1.0]))) / speeds))
