"""Where the arm may have to follow the UAV: all around the station, and from below the plate."""

import numpy as np
import pytest

from armland.errors import WorkspaceError
from armland.mission.landing_scenario import landing_scenario
from armland.mission.landing_setup import UPRIGHT, set_up
from armland.mission.tracking_reach import check_tracking, tracked_points


def scenario(**overrides):
    return landing_scenario("landing", overrides)


def test_points_span_the_box_about_the_catch_and_reach_below_it_by_the_standoff():
    landing = scenario(bounds={"uav_error_m": 0.05}, place={"standoff_m": 0.03}).landing
    away = tracked_points(landing) - landing.place.catch_m
    np.testing.assert_allclose(away.max(axis=0), [0.05, 0.05, 0.05])
    np.testing.assert_allclose(away.min(axis=0), [-0.05, -0.05, -0.08])
    # The arm is led from point to point: no way is longer than the box.
    assert np.linalg.norm(np.diff(away, axis=0), axis=1).max() < 0.05


def test_what_is_refused_at_one_bound_is_accepted_at_a_tighter_one():
    place = {"catch_m": [0.62, 0.0, 0.9]}
    with pytest.raises(WorkspaceError, match=r"uav_error_m = 0.06 m .* out of reach by \d+ mm"):
        set_up(scenario(place=place))
    assert set_up(scenario(place=place, bounds={"uav_error_m": 0.03})).mission == "landing"
    # A take-off follows nobody.
    assert set_up(scenario(place=place), "takeoff").mission == "takeoff"


SHOULDER_M, UPPER_ARM_M, FOREARM_M, WRIST_M = 0.3105, 0.400, 0.390, 0.078
"""Link lengths of the LWR 4+."""


@pytest.mark.parametrize("axis", [0, 2])
def test_arm_reaches_as_far_as_its_two_long_links(axis):
    """With the hand upright, shoulder, elbow and wrist are a triangle: the wrist is at most both links away."""
    setup, tool = set_up(scenario()), scenario().demonstrator.tool.length_m
    seen = set()
    for step in np.arange(0.0, 0.09, 0.0073):
        catch = np.array([0.62, 0.0, 0.86])
        catch[axis] += step
        landing = scenario(place={"catch_m": catch.tolist()}).landing
        wrist = tracked_points(landing) - [0.0, 0.0, tool + WRIST_M] - [0.0, 0.0, SHOULDER_M]
        reachable = bool(np.linalg.norm(wrist, axis=1).max() < UPPER_ARM_M + FOREARM_M)
        seen.add(reachable)
        if reachable:
            check_tracking(setup.arm, setup.home, UPRIGHT, landing)
        else:
            with pytest.raises(WorkspaceError, match="out of reach by"):
                check_tracking(setup.arm, setup.home, UPRIGHT, landing)
    assert seen == {True, False}
