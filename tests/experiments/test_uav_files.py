"""Landings of somebody else's UAV, each with one oddity, and of those that come with armland. Slow: a UAV flies for seconds."""

from pathlib import Path

import pytest

from armland.errors import ModelError
from armland.experiments.episode import fly, prepare
from armland.scenario import load_scenario

UAVS = Path(__file__).parents[1] / "data" / "uavs"
PUBLISHED = {"deviation": {"level": "published"}}


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("name", ["kg1", "kg2", "kg10", "hexa", "lever20", "payload20", "inertialie"])
def test_lands(name, seed):
    result = fly(load_scenario(UAVS / f"{name}.toml", PUBLISHED), "landing", seed).result
    assert result["success"], result["reason"]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["ardrone2", "x500", "hexa10"])
def test_those_of_armland_land(name):
    result = fly(load_scenario("landing", {"airframe": name, **PUBLISHED}), "landing", 1).result
    assert result["success"], result["reason"]


def test_three_rotors_are_refused_before_anything_moves():
    with pytest.raises(ModelError, match=r"3 rotors make 3 of the four independently"):
        prepare(load_scenario(UAVS / "tri.toml"), "landing", 1)
