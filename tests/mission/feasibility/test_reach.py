"""Places that the arm cannot visit, carry at or follow the UAV to are refused before anything moves."""

import numpy as np
import pytest

from armland.errors import ConfigurationError, WorkspaceError
from armland.mission.feasibility.reach import check_tracking, point, survey, targets, tracked_points
from armland.mission.plan import plan
from armland.mission.registry import MISSIONS
from armland.mission.table.mission import At
from armland.scenario import load_scenario


@pytest.mark.parametrize(
    ("overrides", "refusal", "words"),
    [
        (
            {"place": {"catch_m": [1.2, 0.0, 0.86]}},
            WorkspaceError,
            "cannot follow the landing's path: .* out of reach by",
        ),
        ({"place": {"home_deg": [0.0, 1.0]}}, ConfigurationError, "home_deg has 2 values; the arm has 7 joints"),
    ],
)
def test_refusals(overrides, refusal, words):
    with pytest.raises(refusal, match=words):
        plan(load_scenario("landing", overrides), "landing")


def test_points_are_places_raised_by_other_places():
    scenario = load_scenario("landing", {"place": {"above_m": 0.07, "put_down_m": [0.6, 0.1, 0.7]}})
    np.testing.assert_allclose(point(At("put_down_m", 1.0, "above_m"), scenario), [0.6, 0.1, 0.77])
    np.testing.assert_allclose(point(At("put_down_m", -0.004), scenario), [0.6, 0.1, 0.696])


def test_landing_begins_below_the_catch_and_ends_below_the_cradle(landing_plan):
    arm, place = landing_plan.arm, landing_plan.scenario.place
    arm.update(landing_plan.home, np.zeros(7))
    np.testing.assert_allclose(arm.position, np.array(place.catch_m) - [0, 0, place.wait_below_m], atol=1e-4)
    np.testing.assert_allclose(arm.rotation, np.eye(3), atol=1e-3)
    last = MISSIONS["landing"].points(landing_plan.scenario)[-1]
    np.testing.assert_allclose(
        point(last, landing_plan.scenario), np.array(place.put_down_m) - [0, 0, place.withdraw_m]
    )


def test_phases_that_move_have_targets_and_the_others_the_catch(landing_plan):
    found = targets(landing_plan.mission, landing_plan.phases, landing_plan.scenario)
    place = landing_plan.scenario.place
    np.testing.assert_allclose(found[landing_plan.number("carry")], np.array(place.put_down_m) + [0, 0, place.above_m])
    np.testing.assert_allclose(found[landing_plan.number("align")], place.catch_m)


def test_arm_that_is_too_weak_for_the_weight_is_refused():
    heavy = {"uav": {"extra_mass_kg": 20.0}, "rotors": {"max_thrust_n": 60.0}, "magnet": {"rating_n": 1000.0}}
    with pytest.raises(ConfigurationError, match=r"joint A\d would need \d+ N·m to carry a UAV of 20\d\.\d N"):
        plan(load_scenario("landing", heavy), "takeoff")


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
            check_tracking(landing_plan.arm, landing_plan.home, wanted)
        else:
            with pytest.raises(WorkspaceError, match="out of reach by"):
                check_tracking(landing_plan.arm, landing_plan.home, wanted)
    assert seen == {True, False}


def test_load_counts_half_again_at_its_lever(takeoff_plan):
    """Where the arm is refused, a hundred newtons more are 150 N times the way from the shoulder out to the load."""
    told = {}
    for weight in (300.0, 400.0):
        with pytest.raises(ConfigurationError) as refusal:
            survey(takeoff_plan.arm, takeoff_plan.scenario, takeoff_plan.mission, weight)
        words = str(refusal.value)
        place = np.array([float(x) for x in words.split(" at (")[1].split(")")[0].split(",")])
        told[weight] = words.split()[1], float(words.split("would need ")[1].split(" ")[0]), place
    (joint, less, place), (other, more, there) = told[300.0], told[400.0]
    assert joint == other == "A2"
    np.testing.assert_array_equal(place, there)
    assert more - less == pytest.approx(150.0 * np.hypot(*place[:2]), rel=0.03)
    # Nine tenths of its 176 N·m.
    assert "0.9 of its limit is 158 N·m" in words
