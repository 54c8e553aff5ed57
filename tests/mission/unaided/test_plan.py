"""The plan of a landing without an arm: the same belief and criteria as the arm's, and what is refused."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.mission.plan import plan
from armland.mission.unaided.decide import PHASES
from armland.mission.unaided.plan import unaided_plan
from armland.scenario import load_scenario

WINDY = {"air": {"wind_mps": 8.0, "turbulence": "by_wind"}}


@pytest.fixture(scope="module")
def calm():
    # Not with the settings of the method: those are tuned.
    return unaided_plan(load_scenario("landing"), "unassisted")


def test_criteria_are_those_of_the_arm_but_for_the_place(calm, landing_plan):
    own, arms = ({c.name: c.bound for c in p.mission.criteria} for p in (calm, landing_plan))
    assert own.keys() == arms.keys()
    assert {name for name in own if own[name] != arms[name]} == {"placed"}
    # In the middle of a pad of 1 m the skids, 0.38 m long and 0.31 m apart, stand as a whole.
    assert own["placed"] + 0.19 < load_scenario("unassisted").pad.half_m


def test_wind_widens_both_alike():
    own = unaided_plan(load_scenario("unassisted", WINDY), "unassisted").mission.criteria
    arms = plan(load_scenario("landing", WINDY), "landing").mission.criteria
    for name in ("touchdown_speed", "touchdown_tilt", "rest"):
        assert next(c.bound for c in own if c.name == name) == next(c.bound for c in arms if c.name == name)


def test_estimator_is_told_what_the_arms_is(calm, landing_plan):
    own, arms = calm.told["estimate"], landing_plan.told["estimate"]
    for name in (
        "mass",
        "weight",
        "lever",
        "uplink",
        "rotor_gain",
        "drag",
        "camera",
        "filter",
        "deck",
        "windy",
        "gravity",
    ):
        assert own[name].tobytes() == arms[name].tobytes(), name


def test_station_keeping_is_told_what_the_arms_is(calm, landing_plan):
    own, arms = calm.told["act"]["uav"], landing_plan.told["act"]["uav"]
    differ = {name for name in own.dtype.names if own[name].tobytes() != arms[name].tobytes()}
    assert differ == {"station"}


def test_phases_are_those_of_the_compiled_machine(calm):
    assert calm.names == PHASES
    assert [p.name for p in calm.phases if p.final] == ["done", "away"]


def test_another_seed_is_the_same_plan(calm):
    other = calm.again(77)
    assert other.scenario.run.seed == 77
    assert other.told.tobytes() == calm.told.tobytes()


def test_a_uav_too_heavy_to_fly_is_refused():
    with pytest.raises(ConfigurationError, match=r"weigh|thrust|lift"):
        unaided_plan(load_scenario("unassisted", {"uav": {"mass_kg": 1.2}}), "unassisted")


def test_keys_that_no_mission_uses_are_refused():
    with pytest.raises(ConfigurationError, match="trajectory"):
        unaided_plan(
            load_scenario("unassisted", {"trajectory": {"moves": [{"to_m": [0.1, 0.0, 0.0], "duration_s": 1.0}]}}),
            "unassisted",
        )


def test_home_is_of_nothing(calm):
    assert calm.home.shape == (0,)
    assert calm.thresholds == {}
    np.testing.assert_array_equal(calm.told["descent"]["timed"], 1)
