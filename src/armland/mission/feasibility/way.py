"""The poses that a held arm really takes on its way: its null space sinks, and there it must be clear of all that is around it.

| symbol | name | unit |
|---|---|---|
| q | joint positions (n,) | rad |
| τ₀ | null-space wish of the controller (n,), `control.laws.nullspace` | N·m |
| N = I − 𝒥⁺𝒥 | projection onto motions that leave the end effector where it is (n, n) | 1 |

The controller lets the arm follow N τ₀ until nothing of it is left: elbow low, joints away from their ends. How fast it gets there
the joints' dry friction says, which nobody knows: an arm may keep the null space in which it began, or sink on its way. Both of
`WAYS` have to be clear. An arm whose null space is drawn to its first pose, `control.posture_rad_s`, goes by that alone.
"""

from typing import NamedTuple

import numpy as np

from armland.control.laws.realisation import elbow_of
from armland.errors import WorkspaceError
from armland.mission.feasibility.obstacles import Near, Obstacles
from armland.mission.feasibility.path import room
from armland.mission.table.mission import Start
from armland.models.arm import ArmModel
from armland.models.nearby import Sinking, body_of, sink
from armland.rotations import Array
from armland.scenario import Scenario

AT_ONCE, ON_THE_WAY = 80, 4
"""Steps along the null space where the arm waits, and at each point of its way."""

WAYS = {
    "": (AT_ONCE, ON_THE_WAY),
    ", its null space held by friction": (0, 0),
}
"""How the null space may go along: what is said of it -> steps where the arm waits, and at each point of its way."""

HELD = {", its null space drawn to where it began": (0, 6)}
"""Likewise, of an arm whose null space is drawn to a posture."""

YIELDING, STEP_RAD = 0.04, 0.1
"""rad per N·m of the wish, and longest step. One over the stiffest push from a joint's end and
the elbow's pull, 25 N·m/rad: steps do not overshoot."""

MARGINS, SIGMAS = 2.0, 1.2
"""Margin to the joints' ends and smallest singular value that a plan leaves, over those at which the supervisor stops the arm."""

AT_THE_ENDS_M = 0.008
"""By how much clearances may be less at the farthest places to which the arm follows the UAV, where it seldom is, m."""


_SHARES = ((0.25, 0.5, 0.75, 1.0), (0.25, 0.5, 0.75, 1.0), (1.0,))
"""Of the way from where the arm waits to the farthest places along each axis."""


class Stop(NamedTuple):
    """A place of the end effector and where the UAV's pivot is then, (3,) m, D."""

    point: Array
    pivot: Array
    slack: float = 0.0
    """By how much the clearances may be less there, m."""


def stops(points: Array, scenario: Scenario, start: Start) -> list[Stop]:
    """Where the UAV is at each of the mission's `points` (k, 3), m, D: on the arm, except where the arm is below its station or the
    cradle; then, of a mission that begins in the air, the farthest places to which the arm follows the UAV, and on the way there from
    where it waits those that are aside: between the rails the wrist may be wider than above them.
    """
    stations = [np.array(scenario.place.catch_m), np.array(scenario.place.put_down_m)]
    out = []
    for point in points:
        above = [s for s in stations if np.hypot(*(s - point)[:2]) < 1e-6 and s[2] > point[2]]
        out.append(Stop(point, min(above, key=lambda s: s[2]) if above else point))
    if start == "air":
        low, high = room(scenario, start)
        catch = stations[0]
        for axis in range(3):
            for end in (low, high):
                there = catch.copy()
                there[axis] = end[axis]
                out += [Stop(points[0] + share * (there - points[0]), there, AT_THE_ENDS_M) for share in _SHARES[axis]]
    return out


def check_clear(arm: ArmModel, q: Array, way: list[Stop], scenario: Scenario, obstacles: Obstacles) -> float:
    """Follow the way with the null space as `WAYS` have it; returns the least room that is left to what is around, m.

    Args:
        arm: the arm model (its state is overwritten).
        q: joint positions (n,), rad, in which the arm begins.
        way: where it goes; the end effector upright at the first of it in `q`.
        scenario: believed.
        obstacles: with the cradle put where the scenario has it.

    Raises:
        WorkspaceError: what comes too near to what, or which of the supervisor's margins is left, and where.
    """
    holds, least = scenario.control.posture_rad_s > 0.0, np.inf
    body, how = body_of(arm), sinking(arm, scenario)
    how = drawn(how, arm, scenario, q) if holds else how
    for told, (first, then) in (HELD if holds else WAYS).items():
        there = q.copy()
        for k, stop in enumerate(way):
            if not sink(body, there, stop.point, how, then if k else first):
                raise WorkspaceError(f"{_where(stop)} the arm{told} is out of reach")
            least = min(least, _checked(arm, there, stop, scenario, obstacles, told))
    return least


def sinking(arm: ArmModel, scenario: Scenario) -> Sinking:
    """How the null space of the scenario's arm sinks where nothing draws it to a posture.

    Raises:
        ConfigurationError: the arm has no joint of the name that `arm.elbow_joint` gives.
    """
    c, none = scenario.control, np.zeros(arm.joints)
    elbow, margin, stiffness = elbow_of(scenario, arm), c.range_margin_rad, c.range_stiffness_nm
    return Sinking(elbow, c.elbow_force_n, margin, stiffness, YIELDING, STEP_RAD, none, np.outer(none, none))


def drawn(how: Sinking, arm: ArmModel, scenario: Scenario, posture: Array) -> Sinking:
    """The same where the null space is drawn to a posture (n,), rad, by `control.posture_rad_s`; the arm's state is overwritten."""
    arm.update(posture, np.zeros(arm.joints))
    return how._replace(posture=posture.copy(), drawn=scenario.control.posture_rad_s**2 * arm.mass_matrix)


def _where(stop: Stop) -> str:
    return f"with the end effector at ({', '.join(f'{x:.2f}' for x in stop.point)}) m"


def _checked(arm: ArmModel, q: Array, stop: Stop, scenario: Scenario, obstacles: Obstacles, told: str) -> float:
    arm.update(q, np.zeros(arm.joints))
    near, limits = obstacles.nearest(q, stop.pivot, stop.slack), scenario.limits
    where = f"{_where(stop)}{told}"
    if near.room < 0.0:
        raise WorkspaceError(f"{where} {_told(near)}")
    gap = np.minimum(q - arm.q_min, arm.q_max - q)
    tight = int(gap.argmin())
    if gap[tight] < MARGINS * limits.joint_margin_rad:
        raise WorkspaceError(
            f"{where} joint {arm.joint_names[tight]} sinks to {gap[tight]:.3f} rad from its range's end; a plan leaves "
            f"{MARGINS:g} times limits.joint_margin_rad, {MARGINS * limits.joint_margin_rad:g} rad"
        )
    sigma = float(np.linalg.svd(arm.jacobian, compute_uv=False)[-1])
    if sigma < SIGMAS * limits.sigma_min:
        raise WorkspaceError(
            f"{where} the arm is near a singularity: smallest singular value {sigma:.3f}; a plan leaves {SIGMAS:g} times "
            f"limits.sigma_min, {SIGMAS * limits.sigma_min:g}"
        )
    return near.room


def _told(near: Near) -> str:
    distance = 1e3 * (near.room + near.clearance)
    return f"{near.link} comes within {distance:.0f} mm of {near.other}; {1e3 * near.clearance:.0f} mm are kept"
