"""The map of an arm's reach holds the place that is flown; where the one that is asked for is bad, one that works is next to it."""

import numpy as np
import pytest

from armland.experiments import reach as module
from armland.experiments.reach import Reach, Spot, reach
from armland.mission.plan import plan
from armland.scenario import load_scenario
from armland.view.tables.reach import catch_map, cradle_map

FAR = {"place": {"catch_m": [0.62, 0.0, 0.95], "put_down_m": [0.68, 0.0, 0.791]}}
"""Too high for the LWR."""


@pytest.fixture
def mapless(monkeypatch):
    monkeypatch.setattr(module, "everywhere", lambda bench: [])


def test_place_that_works_needs_no_other(mapless):
    found = reach(load_scenario("landing"))
    assert (found.refusal, found.nearest, found.lands) == ("", None, True)


def test_place_that_does_not_work_is_told_with_one_that_does(mapless):
    asked = load_scenario("landing", FAR)
    found = reach(asked)
    assert "out of reach" in found.refusal
    assert found.nearest is not None
    assert plan(found.nearest, "landing").scenario.place.catch_m == found.nearest.place.catch_m
    assert np.linalg.norm(np.subtract(found.nearest.place.catch_m, asked.place.catch_m)) < 0.25
    assert found.result()["nearest"]["catch_m"] == list(found.nearest.place.catch_m)


SPOTS = [Spot(0.4, 0.8, 0.5, 0.0, 0.1), Spot(0.52, 0.8, 0.6, 0.0, 0.9), Spot(0.41, 1.0, 0.3, 180.0, 0.2)]


def test_maps_have_a_mark_for_each_place_and_one_for_the_best():
    assert catch_map(SPOTS) == [
        "  1.0 |  o   . ",
        "  0.9 |  .   . ",
        "  0.8 |  o   O ",
        "        0.4 0.5",
    ]
    assert cradle_map(SPOTS) == ["    0 |  .   .   o   O ", "  180 |  o   .   .   . ", "        0.3 0.4 0.5 0.6"]


def test_arm_without_any_place_does_not_land():
    assert not Reach(load_scenario("landing"), "too weak", None, [], 0.6).lands


@pytest.mark.slow
def test_map_holds_the_place_that_is_flown():
    spots = reach(load_scenario("landing")).spots
    assert any(abs(s.radius_m - 0.62) < 0.06 and abs(s.height_m - 0.86) < 0.06 and s.heading_deg == 0.0 for s in spots)
    assert {s.heading_deg for s in spots} == {0.0, 180.0}
