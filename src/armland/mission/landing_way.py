"""The arm's way through a landing or a take-off: its points, the pose from which it begins, and whether the arm can go and carry."""

from itertools import pairwise

import numpy as np

from armland.errors import ConfigurationError, WorkspaceError
from armland.mission.landing_scenario import Landing, LandingScenario
from armland.mission.launch import pose
from armland.mission.launch_procedure import gives_speed
from armland.mission.phases import Phase
from armland.mission.tracking_reach import check_tracking, out_of_reach
from armland.models.arm import ArmModel
from armland.models.workspace import check_path, home_poses
from armland.rotations import Array

UPRIGHT = np.eye(3)
"""End effector's orientation: pointing up, its x axis along the world's, so that the camera looks beside the UAV's nose."""

BRANCHES, MARGIN_RAD = 16, 0.2
"""Where no home is given: poses that are tried at most, and the distance to all joints' ends that is good enough."""


def way_points(landing: Landing, mission: str) -> list[Array]:
    """End effector positions (3,) m that a mission visits, in order."""
    place = landing.place
    catch, down = np.array(place.catch_m), np.array(place.put_down_m)
    e = np.array([0.0, 0.0, 1.0])
    wait, above = catch - place.wait_below_m * e, down + place.above_m * e
    if mission == "takeoff" and gives_speed(landing):
        return [down - place.withdraw_m * e, down, above, np.array(place.launch_m)]
    if mission == "takeoff":
        return [down - place.withdraw_m * e, down, above, catch, catch - place.withdraw_m * e]
    return [wait, catch, above, down, down - place.withdraw_m * e]


def survey(arm: ArmModel, scenario: LandingScenario, mission: str, weight: float) -> Array:
    """Joint positions (n,) at the mission's first way point.

    Raises:
        WorkspaceError: a way point, or where the arm follows the UAV, out of reach.
        ConfigurationError: joint torques beyond their limits.
    """
    landing = scenario.landing
    points = way_points(landing, mission)
    fine = np.concatenate([np.linspace(a, b, 20) for a, b in pairwise(points)])
    if landing.place.home_deg is not None:
        near = [np.deg2rad(landing.place.home_deg)]
    else:
        near = [p.q for p in home_poses(arm, np.array(landing.place.catch_m), None, arm.joints // 2)[:BRANCHES]]
    best, widest, refusal = near[0], -np.inf, WorkspaceError("")
    for start in near:
        # From the pose that is known the arm is led to the first way point: no other branch of the kinematics comes in.
        arm.update(start, np.zeros(arm.joints))
        q = start
        for point in np.linspace(arm.position.copy(), points[0], 25):
            q = pose(arm, q, point)
        try:
            margin = check_path(arm, q, UPRIGHT, fine, np.arange(len(fine), dtype=float))
        except WorkspaceError as e:
            refusal = e
            continue
        if margin > widest:
            best, widest = q, margin
        if margin > MARGIN_RAD:
            break
    if widest < 0.0:
        raise WorkspaceError(
            f"the arm cannot follow the {mission}'s way: {out_of_reach(refusal)}; the way is given by place.catch_m = "
            f"{landing.place.catch_m}, put_down_m = {landing.place.put_down_m}, wait_below_m, above_m and withdraw_m"
        ) from refusal
    _check_torque(arm, best, fine, weight)
    if mission == "landing":
        check_tracking(arm, best, UPRIGHT, landing)
    return best


def _check_torque(arm: ArmModel, q: Array, points: Array, weight: float) -> None:
    for point in points[::4]:
        q = pose(arm, q, point)
        # Half again as much as at rest, for what it takes to move it.
        needed = np.abs(arm.gravity + 1.5 * weight * arm.jacobian[2])
        worst = int((needed / arm.tau_max).argmax())
        if needed[worst] > 0.9 * arm.tau_max[worst]:
            raise ConfigurationError(
                f"joint {arm.joint_names[worst]} would need {needed[worst]:.0f} N·m to carry a UAV of {weight:.1f} N at "
                f"({', '.join(f'{x:.2f}' for x in point)}) m; 0.9 of its limit is {0.9 * arm.tau_max[worst]:.0f} N·m"
            )


def targets(landing: Landing, phases: tuple[Phase, ...]) -> Array:
    """End effector positions (phases, 3) m at which the phases that move end."""
    place, up = landing.place, np.array([0.0, 0.0, 1.0])
    catch, down = np.array(place.catch_m), np.array(place.put_down_m)
    known = {
        "carry": down + place.above_m * up,
        # A little further than the rails, so that it arrives there with speed.
        "set_down": down - 0.004 * up,
        "reach": down - 0.02 * up,
        # A little further than the plate's face, so that all pads touch.
        "touch": down + 0.001 * up,
        "lift": down + place.above_m * up,
        "carry_up": catch,
    }
    return np.array([known.get(p.name, catch) for p in phases])
