"""The numbers behind the words of a mission's table."""

import pytest

from armland.mission.registry import MISSIONS
from armland.mission.table.thresholds import loads_of, shares_of, thresholds_of
from armland.scenario import load_scenario


def test_every_bound_of_the_scenario_is_a_threshold_of_its_name():
    scenario = load_scenario("landing", {"bounds": {"pull_seen_n": 0.42}})
    found = thresholds_of(MISSIONS["landing"], scenario)
    assert found["pull_seen_n"] == 0.42
    assert set(type(scenario.bounds).model_fields) <= set(found)


def test_retries_are_counted_and_the_retreat_is_most_of_the_withdrawal():
    found = thresholds_of(MISSIONS["landing"], load_scenario("landing", {"bounds": {"retries": 2}}))
    # The third miss is one too many: 3 > 2.5.
    assert 2.0 < found["retries_allowed"] < 3.0
    assert 0.0 < found["retreat_m"] < load_scenario("landing").place.withdraw_m


def test_test_pull_is_a_force_and_not_a_share():
    """A UAV of twice the weight is pulled at by the same force."""
    scenario = load_scenario("landing")
    for weight in (5.0, 10.0):
        assert (shares_of(scenario, weight)["test"] - 1.0) * weight == pytest.approx(scenario.bounds.pull_test_n)


def test_no_newton_of_one_uav_stands_in_a_mission():
    scenario = load_scenario("landing", {"limits": {"carried_n": 40.0, "impact_n": 120.0}})
    assert loads_of(scenario) == {"carried": 40.0, "impact": 120.0}
