"""Where the arm may have to follow the UAV: all around the station, and from below the plate."""

import numpy as np
import pytest

from armland.errors import WorkspaceError
from armland.mission.feasibility.tracking import check_tracking, tracked_points
from armland.mission.plan import plan
from armland.models.posture import UPRIGHT
from armland.scenario import load_scenario


def scenario(**overrides):
    return load_scenario("landing", overrides)


def test_points_span_the_box_about_the_catch_and_reach_below_it_by_the_standoff():
    wanted = scenario(bounds={"uav_error_m": 0.05}, place={"standoff_m": 0.03})
    away = tracked_points(wanted) - wanted.place.catch_m
    np.testing.assert_allclose(away.max(axis=0), [0.05, 0.05, 0.05])
    np.testing.assert_allclose(away.min(axis=0), [-0.05, -0.05, -0.08])
    # The arm is led from point to point: no step is longer than the box.
    assert np.linalg.norm(np.diff(away, axis=0), axis=1).max() < 0.05


def test_what_is_refused_at_one_bound_is_accepted_at_a_tighter_one():
    place = {"catch_m": [0.62, 0.0, 0.9]}
    with pytest.raises(WorkspaceError, match=r"uav_error_m = 0.06 m .* out of reach by \d+ mm"):
        plan(scenario(place=place), "landing")
    assert plan(scenario(place=place, bounds={"uav_error_m": 0.03}), "landing").mission.name == "landing"
    # A take-off follows nobody.
    assert plan(scenario(place=place), "takeoff").mission.name == "takeoff"


SHOULDER_M, UPPER_ARM_M, FOREARM_M, WRIST_M = 0.3105, 0.400, 0.390, 0.078
"""Link lengths of the LWR 4+."""


@pytest.mark.parametrize("axis", [0, 2])
def test_arm_reaches_as_far_as_its_two_long_links(axis, landing_plan):
    """With the hand upright, shoulder, elbow and wrist are a triangle: the wrist is at most both links away."""
    tool = scenario().tool.length_m
    seen = set()
    for step in np.arange(0.0, 0.09, 0.0073):
        catch = np.array([0.62, 0.0, 0.86])
        catch[axis] += step
        wanted = scenario(place={"catch_m": catch.tolist()})
        wrist = tracked_points(wanted) - [0.0, 0.0, tool + WRIST_M] - [0.0, 0.0, SHOULDER_M]
        reachable = bool(np.linalg.norm(wrist, axis=1).max() < UPPER_ARM_M + FOREARM_M)
        seen.add(reachable)
        if reachable:
            check_tracking(landing_plan.arm, landing_plan.home, UPRIGHT, wanted)
        else:
            with pytest.raises(WorkspaceError, match="out of reach by"):
                check_tracking(landing_plan.arm, landing_plan.home, UPRIGHT, wanted)
    assert seen == {True, False}
