"""Points of a mission: places, raised by a length or by another place's key."""

import pytest

from armland.mission.registry import MISSIONS
from armland.mission.table.mission import At
from armland.scenario import load_scenario


@pytest.mark.parametrize(
    ("at", "height"),
    [
        (At("catch_m"), 0.0),
        (At("put_down_m", 0.02), 0.02),
        (At("put_down_m", -0.5, "withdraw_m"), -0.04),
        (At("catch_m", 2.0, "above_m"), 0.14),
    ],
)
def test_height_is_in_metres_or_in_shares_of_another_key(at, height):
    scenario = load_scenario("landing", {"place": {"withdraw_m": 0.08, "above_m": 0.07}})
    assert at.height(scenario) == pytest.approx(height)


@pytest.mark.parametrize("mission", MISSIONS.values(), ids=lambda m: m.name)
def test_what_is_visited_are_keys_of_the_place(mission):
    scenario = load_scenario("paper" if mission.start == "hinged" else "landing")
    for at in (*mission.points(scenario), *mission.targets.values()):
        assert len(getattr(scenario.place, at.place)) == 3
        assert at.of is None or getattr(scenario.place, at.of) > 0.0
