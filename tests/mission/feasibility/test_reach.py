"""Places that the arm cannot visit or carry at are refused before anything moves."""

import numpy as np
import pytest

from armland.errors import ConfigurationError, WorkspaceError
from armland.mission.feasibility.reach import point, targets
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
    np.testing.assert_allclose(found[landing_plan.number("guide")], place.catch_m)


def test_arm_that_is_too_weak_for_the_weight_is_refused():
    heavy = {"uav": {"extra_mass_kg": 20.0}, "rotors": {"max_thrust_n": 60.0}, "magnet": {"rating_n": 1000.0}}
    with pytest.raises(ConfigurationError, match=r"joint A\d would need \d+ N·m to carry a UAV of 20\d\.\d N"):
        plan(load_scenario("landing", heavy), "takeoff")
