"""Distances of the arm to what is around it, against distances worked out by hand."""

import numpy as np
import pytest

from armland.mission.feasibility.obstacles import CRADLE_M, FLOOR_M, Obstacles
from armland.models.parameters import arm_model
from armland.models.posture import lead
from armland.scenario import load_scenario

AWAY = np.array([0.0, 0.0, 50.0])


@pytest.fixture(scope="module")
def scenario():
    return load_scenario("landing").believed()


@pytest.fixture(scope="module")
def arm(scenario):
    return arm_model(scenario)


@pytest.fixture
def around(scenario):
    made = Obstacles(scenario)
    made.put_cradle(np.array(scenario.place.put_down_m), 0.0)
    return made


def at(arm, scenario, point):
    return lead(arm, np.deg2rad(scenario.place.home_deg), np.array(point), 25)


def test_arm_of_the_landing_is_clear_where_it_is_caught_and_in_the_cradle(arm, scenario, around):
    for point in (scenario.place.catch_m, scenario.place.put_down_m):
        assert around.nearest(at(arm, scenario, point), np.array(point)).room > 0.02


def test_arm_beside_the_slots_middle_meets_a_rail(arm, scenario, around):
    """Rails 0.25 m apart, links 0.12 m wide: in the middle of the slot 65 mm are left, 60 mm beside it the arm is too near."""
    near = around.nearest(at(arm, scenario, [0.62, -0.06, 0.86]), AWAY)
    assert near.other == "the cradle"
    assert near.room < 0.0
    # The cradle aside by as much, the same pose is clear.
    around.put_cradle(np.array(scenario.place.put_down_m) - [0.0, 0.06, 0.0], 0.0)
    assert around.nearest(at(arm, scenario, [0.62, -0.06, 0.86]), AWAY).room > near.room + 0.02


def test_slack_is_taken_off_the_clearance(arm, scenario, around):
    q = at(arm, scenario, [0.62, -0.05, 0.86])
    tight, loose = around.nearest(q, AWAY), around.nearest(q, AWAY, slack=0.008)
    assert tight.clearance == CRADLE_M
    assert loose.room - tight.room == pytest.approx(0.008, abs=1e-6)


def test_elbow_that_hangs_to_the_floor_is_told_with_its_distance(arm, scenario, around):
    """Stretched level and down: the capsule of 60 mm about the forearm ends below the floor."""
    q = np.zeros(arm.joints)
    q[1] = np.deg2rad(118.0)
    arm.update(q, np.zeros(arm.joints))
    near = around.nearest(q, AWAY)
    assert near.other == "the floor"
    lowest = arm.anchor[-2:, 2].min() - 0.06 - FLOOR_M
    assert near.room == pytest.approx(lowest, abs=0.05)
    assert near.room < 0.0


def test_any_place_that_is_too_tight_will_do_where_it_is_asked_for(arm, scenario, around):
    q = at(arm, scenario, [0.62, -0.06, 0.86])
    assert around.nearest(q, AWAY, any_will_do=True).room < 0.0
    clear = at(arm, scenario, scenario.place.catch_m)
    assert around.nearest(clear, AWAY, any_will_do=True) == around.nearest(clear, AWAY)


def test_uav_that_is_held_too_low_meets_the_arm(arm, scenario, around):
    q = at(arm, scenario, scenario.place.catch_m)
    held = around.nearest(q, np.array(scenario.place.catch_m))
    sunk = around.nearest(q, np.array(scenario.place.catch_m) - [0.1, 0.0, 0.25])
    assert held.room > 0.0 > sunk.room
    assert sunk.other == "the UAV"
