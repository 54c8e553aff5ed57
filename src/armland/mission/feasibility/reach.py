"""Where a mission of way points takes the arm: the pose from which it begins, whether it can go there, carry, and follow the UAV."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from armland.control.laws.realisation import elbow_of
from armland.errors import ConfigurationError, ModelError, MountingError, WorkspaceError
from armland.mission.feasibility.obstacles import Obstacles
from armland.mission.feasibility.way import Stop, check_clear, stops
from armland.mission.table.mission import At, Mission
from armland.mission.table.phases import Phase
from armland.models.arm import ArmModel
from armland.models.arm_file.reading import read_tree
from armland.models.arm_file.tip import farther, others
from armland.models.description import resolve
from armland.models.parameters import arm_file
from armland.models.posture import UPRIGHT, check_path, home_poses, lead, pose
from armland.rotations import Array
from armland.scenario import Scenario

BRANCHES, MARGIN_RAD = 16, 0.2
"""Where no home is given: poses that are tried at most, and the distance to all joints' ends that is good enough."""

CLEAR_EVERY = 4
"""Of the points of the path, those at which the arm must be clear of what is around."""

STEPS = 4
"""Points from the catch to each end of the box about it in which the arm follows the UAV."""

UP = np.array([0.0, 0.0, 1.0])


def point(at: At, scenario: Scenario) -> Array:
    """The end effector position (3,), m, deck, that `at` means."""
    return np.array(getattr(scenario.place, at.place)) + at.height(scenario) * UP


def targets(mission: Mission, phases: tuple[Phase, ...], scenario: Scenario) -> Array:
    """End effector positions (phases, 3), m, deck, at which the phases that move end."""
    return np.array([point(mission.targets.get(p.name, At("catch_m")), scenario) for p in phases])


def survey(
    arm: ArmModel, scenario: Scenario, mission: Mission, weight: float, obstacles: Obstacles | None = None
) -> Array:
    """Joint positions (n,) rad at the mission's first way point.

    Args:
        arm: the arm model (its state is overwritten).
        scenario: believed.
        mission: one with way points.
        weight: of all that flies, N.
        obstacles: what is around the scenario's arm; made here if absent.

    Raises:
        WorkspaceError: a way point, or where the arm follows the UAV, out of reach; joint torques beyond their limits; a pose on the
            way in which the arm comes too near to floor, cradle, UAV or itself.
        ConfigurationError: a home of the wrong length.
    """
    points = [point(at, scenario) for at in mission.points(scenario)]
    fine = np.concatenate([np.linspace(a, b, 20) for a, b in pairwise(points)])
    around = Obstacles(scenario) if obstacles is None else obstacles
    check_beside(scenario, around)
    around.put_cradle(np.array(scenario.place.put_down_m), scenario.cradle.heading_deg)
    way = Way(scenario, mission, weight, fine, stops(fine[::CLEAR_EVERY], scenario, mission.start), around)
    best, widest, refusal = np.zeros(arm.joints), -np.inf, _Refusal(-1, WorkspaceError(""))
    for start in _starts(arm, scenario):
        # From the pose that is known the arm is led to the first way point: no other branch of the kinematics comes in.
        q = lead(arm, start, points[0], 25)
        margin, found = _tried(arm, q, way)
        if found is not None:
            refusal = max(refusal, found, key=lambda r: r.stage)
            continue
        if margin > widest:
            best, widest = q, margin
        if margin > MARGIN_RAD:
            break
    if widest < 0.0:
        raise refusal.error
    return best


def check_beside(scenario: Scenario, around: Obstacles) -> None:
    """Refuse an arm of which something that is fixed to its last link, as a gripper, is where the tool holds the UAV.

    Raises:
        MountingError: what it is, and another end effector of the file that works, if there is one.
    """
    near = around.held()
    if near.room >= 0.0:
        return
    distance = 1e3 * (near.room + near.clearance)
    how = f"{-distance:.0f} mm inside" if distance < 0.0 else f"within {distance:.0f} mm of"
    tip = arm_file(scenario).chain.tip
    # The same frame with another axis before other frames.
    ends = sorted(others(read_tree(resolve(scenario.arm.file)), tip), key=lambda e: _frame(e) != _frame(tip.label))
    ends.append(farther(tip.label, np.ceil(1e3 * around.outermost() - 1e-6) / 1e3))
    found = next((e for e in ends if _clear(scenario, e)), None)
    works = (
        f"--ee '{found}' mounts the tool clear of it, and so does"
        if found
        else "what works is a frame at its outer end, or"
    )
    raise MountingError(
        f"{near.link} is {how} the UAV in whatever pose the tool holds it: the tool ends {1e3 * scenario.tool.length_m:.0f} mm out "
        f"from the end effector {tip.label!r}, and {1e3 * near.clearance:.0f} mm are kept; {works} a file without it",
        found,
    )


def _frame(end: str) -> str:
    return end.partition(":")[0]


def _clear(scenario: Scenario, ee: str) -> bool:
    try:
        return Obstacles(scenario.replaced({"arm": {"ee": ee}})).held().room >= 0.0
    except ModelError:
        return False


class Way(NamedTuple):
    """What is asked of an arm."""

    scenario: Scenario
    mission: Mission
    weight: float  # N
    fine: Array  # (k, 3) m
    stops: list[Stop]
    obstacles: Obstacles


class _Refusal(NamedTuple):
    stage: int  # How far the arm came: of several refusals the one of the pose that came farthest is told
    error: WorkspaceError


def _tried(arm: ArmModel, q: Array, way: Way) -> tuple[float, _Refusal | None]:
    # Smallest margin to the joints' ends on the path from a pose, or what refuses it.
    scenario, name, stage = way.scenario, way.mission.name, 0
    try:
        margin = _on_path(arm, q, way)
        stage = 1
        _check_torque(arm, q, way.fine, way.weight)
        try:
            check_clear(arm, q, way.stops, scenario, way.obstacles)
        except WorkspaceError as e:
            # What is out of reach is told before what is too near.
            stage = 2
            if way.mission.start == "air":
                check_tracking(arm, q, scenario)
            stage = 3
            raise WorkspaceError(f"the arm cannot do the {name} with {_places(scenario)}: {e}") from e
        stage = 2
        if way.mission.start == "air":
            check_tracking(arm, q, scenario)
    except WorkspaceError as e:
        return -np.inf, _Refusal(stage, e)
    return margin, None


def _on_path(arm: ArmModel, q: Array, way: Way) -> float:
    try:
        return check_path(arm, q, UPRIGHT, way.fine)
    except WorkspaceError as e:
        raise WorkspaceError(
            f"the arm cannot follow the {way.mission.name}'s path: {e}; the path is given by {_places(way.scenario)}, wait_below_m, "
            "above_m and withdraw_m"
        ) from e


def _places(scenario: Scenario) -> str:
    return f"place.catch_m = {scenario.place.catch_m}, put_down_m = {scenario.place.put_down_m}"


def _starts(arm: ArmModel, scenario: Scenario) -> list[Array]:
    home = scenario.place.home_deg
    if home is None:
        at = np.array(scenario.place.catch_m)
        return [p.q for p in home_poses(arm, at, None, elbow_of(scenario, arm))[:BRANCHES]]
    if len(home) != arm.joints:
        raise ConfigurationError(f"place.home_deg has {len(home)} values; the arm has {arm.joints} joints")
    return [np.deg2rad(home)]


def _check_torque(arm: ArmModel, q: Array, points: Array, weight: float) -> None:
    for place in points[::4]:
        q = pose(arm, q, place)
        # Half again as much as at rest, for what it takes to move it.
        needed = np.abs(arm.gravity + 1.5 * weight * arm.jacobian[2])
        worst = int((needed / arm.tau_max).argmax())
        if needed[worst] > 0.9 * arm.tau_max[worst]:
            raise WorkspaceError(
                f"joint {arm.joint_names[worst]} would need {needed[worst]:.0f} N·m to carry a UAV of {weight:.1f} N at "
                f"({', '.join(f'{x:.2f}' for x in place)}) m; 0.9 of its limit is {0.9 * arm.tau_max[worst]:.0f} N·m"
            )


def tracked_points(scenario: Scenario) -> Array:
    """End effector positions (k, 3) m from the catch to the ends of the box about it, and back.

    The arm approaches once the UAV is within `bounds.uav_error_m` of its station, and follows it there from `place.standoff_m`
    below the plate up to the plate.
    """
    catch, error = np.array(scenario.place.catch_m), scenario.bounds.uav_error_m
    out = []
    for axis in np.eye(3):
        for sign in (-1.0, 1.0):
            end = catch + sign * error * axis
            if axis[2] and sign < 0.0:
                end[2] -= scenario.place.standoff_m
            there = np.linspace(catch, end, STEPS)
            out += [there, there[::-1]]
    return np.concatenate(out)


def check_tracking(arm: ArmModel, q: Array, scenario: Scenario) -> None:
    """Refuse a catch about which the arm could not follow the UAV.

    Args:
        arm: the arm model (its state is overwritten).
        q: joint positions (n,) rad with the end effector below the catch, where the arm waits.
        scenario: believed.

    Raises:
        WorkspaceError: names the point, the distance that remains and the joint at its limit.
    """
    points, place = tracked_points(scenario), scenario.place
    rise = np.linspace(np.array(place.catch_m) - place.wait_below_m * UP, points[0], 8)
    try:
        check_path(arm, q, UPRIGHT, np.concatenate([rise, points]))
    except WorkspaceError as refusal:
        raise WorkspaceError(
            f"the arm must follow the UAV within bounds.uav_error_m = {scenario.bounds.uav_error_m:g} m about "
            f"place.catch_m = {place.catch_m}: {refusal}; move the catch or lower the bound"
        ) from refusal
