"""The campaign of a study: its seeds are shared, and what a flight refuses is refused before anything flies, all of it by name."""

import pytest

from armland.errors import ConfigurationError
from armland.experiments.study.flights import campaign_of_study
from armland.scenario import load_scenario


@pytest.fixture(scope="module")
def landing():
    return load_scenario("landing")


def test_each_change_is_flown_with_the_same_seeds(made, landing):
    campaign = campaign_of_study(made({"fast": {"camera.rate_hz": 60}}), landing, "landing", 3, 17)
    tasks = list(campaign.schedule.tasks())
    assert [(t.point, t.seed) for t in tasks] == [(0, 17), (1, 17), (0, 18), (1, 18), (0, 19), (1, 19)]
    assert [t.values for t in tasks[:2]] == [{}, {"camera.rate_hz": 60}]
    assert campaign.bounds["touchdown.speed_mps"] > 0.0


def test_what_the_scenario_or_a_flight_refuses_is_named_with_its_change(made, landing):
    with pytest.raises(ConfigurationError, match=r"camera\.rate_hz"):
        campaign_of_study(made({"odd": {"camera.rate_hz": 0}}), landing, "landing", 1, 1)
    # That no place is within reach is known when a flight is prepared, and not before.
    far = {"place.catch_m": [2.5, 0.0, 0.9]}
    with pytest.raises(ConfigurationError, match="--only flies the others: 1 problem\n  far: "):
        campaign_of_study(made({"fast": {"camera.rate_hz": 60}, "far": far}), landing, "landing", 1, 1)
