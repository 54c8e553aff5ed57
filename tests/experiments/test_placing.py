"""A foreign arm for which the scenario's places do not work moves them; the arm they are made for, and a user's own, do not."""

import numpy as np
import pytest

from armland.errors import ConfigurationError, WorkspaceError
from armland.experiments.episode import fly_prepared, prepare
from armland.experiments.placing import placed
from armland.mission.registry import MISSIONS
from armland.scenario import load_scenario

LANDING = MISSIONS["landing"]
TOO_FAR = WorkspaceError("too far")


@pytest.fixture(scope="module")
def six_axis(pytestconfig):
    file = str(pytestconfig.rootpath / "examples" / "six_axis.urdf")
    other = {"file": file, "ee": None, "elbow_joint": None, "home_rad": None}
    return load_scenario("landing", {"arm": other, "place": {"home_deg": None}})


def test_places_of_the_arm_that_they_are_made_for_stay():
    flight = prepare(load_scenario("landing"), "landing")
    assert flight.moved == ""
    assert flight.scenario.place.catch_m == (0.62, 0.0, 0.86)
    with pytest.raises(WorkspaceError, match=r"out of reach .* This arm could catch at place\.catch_m"):
        prepare(load_scenario("landing", {"place": {"catch_m": [0.62, 0.0, 0.95]}}), "landing")


@pytest.fixture(scope="module")
def moved(six_axis):
    return prepare(six_axis, "landing")


@pytest.mark.slow
def test_foreign_arm_lands_where_it_can_and_says_why(moved):
    place = moved.scenario.place
    assert moved.moved.startswith(f"place.catch_m = {list(place.catch_m)} with place.put_down_m = ")
    assert "chosen, because the arm cannot" in moved.moved
    assert moved.plan.scenario.place == place
    assert not np.allclose(place.catch_m, (0.62, 0.0, 0.86))


@pytest.mark.slow
@pytest.mark.slow
def test_what_was_found_is_flown(moved):
    assert fly_prepared(moved).result["success"]


@pytest.mark.slow
def test_two_places_that_the_user_set_are_refused_with_others(six_axis):
    wanted = {"place": {"catch_m": [0.62, 0.0, 0.86], "put_down_m": [0.68, 0.0, 0.701]}}
    his = load_scenario("landing", {"arm": six_axis.arm.model_dump(), "place": {**wanted["place"], "home_deg": None}})
    with pytest.raises(WorkspaceError, match=r"could catch at place\.catch_m = \["):
        prepare(his, "landing")


@pytest.mark.slow
def test_places_at_which_the_plant_objects_are_passed_over(six_axis):
    tried = []

    def make(one):
        tried.append(one.place.catch_m)
        if len(tried) < 2:
            raise ConfigurationError("the UAV would start inside the arm")
        return one

    one, line = placed(six_axis, LANDING, TOO_FAR, make)
    assert one.place.catch_m == tried[1] != tried[0]
    assert line.endswith("chosen, because too far")
