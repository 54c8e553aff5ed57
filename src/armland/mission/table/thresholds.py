"""The numbers behind the words of a mission's table: thresholds, shares of the weight, largest hinge forces."""

from armland.mission.table.mission import Mission
from armland.scenario import Scenario

RETREAT_SHARE = 0.8
"""Of `place.withdraw_m`: displacement at which the arm has drawn back."""


def thresholds_of(mission: Mission, scenario: Scenario) -> dict[str, float]:
    """The thresholds that a mission's tables may name, in the units of their signals: all keys of `bounds`, and its own."""
    return {
        "half": 0.5,
        "almost_one": 0.999,
        "retreat_m": RETREAT_SHARE * scenario.place.withdraw_m,
        "retries_allowed": scenario.bounds.retries + 0.5,
        **{name: float(value) for name, value in scenario.bounds},
        **mission.thresholds(scenario),
    }


def shares_of(scenario: Scenario, weight: float) -> dict[str, float]:
    """The words of `phases.SHARES` as fractions of the UAV's `weight`, N."""
    test = 1.0 + scenario.bounds.pull_test_n / weight
    return {"none": 0.0, "carry": scenario.control.thrust.carry_share, "whole": 1.0, "test": test}


def loads_of(scenario: Scenario) -> dict[str, float]:
    """The words of `phases.LOADS` in N."""
    return {"carried": scenario.limits.carried_n, "impact": scenario.limits.impact_n}
