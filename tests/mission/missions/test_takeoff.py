"""The take-off with and without a speed: which phases, which points."""

import pytest

from armland.mission.registry import MISSIONS
from armland.scenario import load_scenario

TAKEOFF = MISSIONS["takeoff"]


def names(**place):
    return [p.name for p in TAKEOFF.phases(load_scenario("landing", {"place": place}))]


def test_run_up_comes_between_hand_over_and_release():
    plain, thrown = names(), names(takeoff_velocity_mps=[0.3, 0.0, 0.0])
    assert "launch" not in plain
    assert thrown.index("hand_back") < thrown.index("launch") < thrown.index("release") < thrown.index("leave")


@pytest.mark.parametrize(("speed", "last"), [([0.0, 0.0, 0.0], "catch_m"), ([0.3, 0.0, 0.0], "launch_m")])
def test_arm_visits_where_it_lets_go(speed, last):
    points = TAKEOFF.points(load_scenario("landing", {"place": {"takeoff_velocity_mps": speed}}))
    assert points[-1].place == last
    assert points[0].above < 0.0


def test_uav_that_cannot_hover_is_let_go_with_the_force_that_its_rotors_leave():
    """Its hinge never comes free of force: the hand-over's bound is the looser one, and it flies on at the end."""
    phases = {
        fly_on: {
            p.name: p
            for p in TAKEOFF.phases(
                load_scenario("landing", {"place": {"takeoff_velocity_mps": [0.3, 0.0, 0.0], "fly_on": fly_on}})
            )
        }
        for fly_on in (False, True)
    }
    bound = {k: phases[k]["hand_back"].guards[0].conditions[0].threshold for k in phases}
    assert bound == {False: "force_light_n", True: "force_balanced_n"}
    assert phases[True]["done"].uav == "cruise"
