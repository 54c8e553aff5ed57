"""On a landing the camera sees the whole marker until contact; with the skids nearer, or the marker behind the plate, it does not."""

import pytest

from armland.experiments.landing_sight import by_distance, landing_sight
from armland.mission.landing_scenario import landing_scenario
from armland.plant.landing_scene import LandingGear, Skids


@pytest.fixture(scope="module")
def scenario():
    return landing_scenario("landing", {"seed": 2})


def test_camera_sees_the_whole_marker_from_the_start_to_the_contact(scenario):
    seen = landing_sight(scenario)
    assert min(g.sight.seen for g in seen) == 1.0
    assert {g.phase for g in seen} >= {"guide", "approach", "align", "close", "capture"}
    bands = by_distance(seen)
    assert bands[0].near_m < 0.135 < 0.4 < bands[-1].far_m
    assert sum(b.exposures for b in bands) == len(seen)


def test_nearer_skids_hide_a_part_of_it(scenario):
    worst = min(landing_sight(scenario, LandingGear(skids=Skids(x=0.10))), key=lambda g: g.sight.seen)
    assert worst.sight.seen < 0.95
    assert any("skid_1" in name for name in worst.sight.hidden_by)
