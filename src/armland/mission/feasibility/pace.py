"""How long the moves of a slow arm take: each phase's move is as fast as the mission has it, or as slow as the arm's joints need.

| symbol | name | unit |
|---|---|---|
| ẋ = s'(u) (b − a)/T | velocity of the end effector in a move from a to b that takes T, `reference.septic` (3,) | m/s |
| q̇ = 𝒥⁺ẋ | joint speeds of least length that give it, the attitude held (n,) | rad/s |
"""

from collections.abc import Iterator

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

FRACTIONS = np.linspace(0.2, 0.8, 7)
"""Of a move's time at which its joint speeds are looked at: outside it has less than a quarter of its largest speed."""


def paced(
    phases: tuple[Phase, ...], mission: Mission, arm: ArmModel, home: Array, scenario: Scenario
) -> tuple[Phase, ...]:
    """The phases, those with a move that is too fast for the arm stretched, time-out included.

    Args:
        phases: of the mission.
        mission: whose `moves` say from where to where.
        arm: the arm model (its state is overwritten).
        home: joint positions (n,), rad, at the mission's first way point.
        scenario: believed.

    Raises:
        WorkspaceError: a move that would take more than `SLOWEST` times as long; names joint and speed.
    """
    q, times = home, {}
    for phase in (p for p in phases if p.name in mission.moves and p.duration_s > 0.0):
        a, b = (_point(at, scenario) for at in mission.moves[phase.name])
        q = lead(arm, q, a)
        shares = np.array([*_shares(arm, q, (a, b), phase.duration_s, scenario)])
        worst, most = int(shares.max(axis=0).argmax()), float(shares.max())
        if most > SHARE * SLOWEST:
            raise WorkspaceError(
                f"in the phase {phase.name} joint {arm.joint_names[worst]} would have to turn at {most:.1f} times the "
                f"{scenario.limits.joint_speed_share * arm.qd_max[worst]:.2f} rad/s that limits.joint_speed_share leaves it; up to "
                f"{SHARE * SLOWEST:g} times the move is made slower"
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


def _shares(arm: ArmModel, q: Array, ends: tuple[Array, Array], duration: float, scenario: Scenario) -> Iterator[Array]:
    # Of the allowed joint speeds (n,) along a move, the null space sunk as the controller lets it.
    (a, b), body, how = ends, body_of(arm), sinking(arm, scenario)
    q = q.copy()
    for k, u in enumerate(FRACTIONS):
        s, rate, _ = septic(float(u), duration)
        sink(body, q, a + s * (b - a), how, ON_THE_WAY if k else AT_ONCE)
        arm.update(q, np.zeros(arm.joints))
        yield np.abs(joint_speeds(arm, rate * (b - a))) / (scenario.limits.joint_speed_share * arm.qd_max)


def joint_speeds(arm: ArmModel, velocity: Array) -> Array:
    """Joint speeds of least length (n,), rad/s, that move the end effector at `velocity` (3,), m/s, in the arm's present pose."""
    J = arm.jacobian
    return np.asarray(J.T @ np.linalg.solve(J @ J.T + 1e-9 * np.eye(6), np.append(velocity, np.zeros(3))))
