"""Landings of somebody else's UAV, each with one oddity, and of those that come with armland. Slow: a UAV flies for seconds."""

from pathlib import Path

import numpy as np
import pytest

from armland.cli.options import load
from armland.errors import ModelError
from armland.experiments.episode import fly, prepare
from armland.scenario import load_scenario

DATA = Path(__file__).parents[1] / "data"
ARMS, UAVS = DATA / "arms", DATA / "uavs"
PUBLISHED = {"deviation": {"level": "published"}}


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("name", ["kg1", "kg2", "kg10", "hexa", "lever20", "payload20", "inertialie"])
def test_lands(name, seed):
    result = fly(load_scenario(UAVS / f"{name}.toml", PUBLISHED), "landing", seed).result
    assert result["success"], result["reason"]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["ardrone2", "crazyflie", "pelican", "x500", "neo11", "m690", "hexa10"])
def test_those_of_armland_land(name):
    result = fly(load_scenario("landing", {"airframe": name, **PUBLISHED}), "landing", 1).result
    assert result["success"], result["reason"]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["tilted20.toml", "octo5_tilted30.toml", "naki.toml", "motors.xml", "props.urdf"])
def test_eight_and_tilted_rotors_and_other_peoples_files_land(name):
    result = fly(load_scenario("landing", {"airframe": str(UAVS / name), **PUBLISHED}), "landing", 1).result
    assert result["success"], result["reason"]


@pytest.mark.slow
def test_arm_of_its_class_lands_a_uav_of_25_kg():
    given = {"uav": "octo25", "arm": str(ARMS / "heavy.xml"), "ee": None, "deviation": "published"}
    result = fly(load("landing", given), "landing", 1).result
    assert result["success"], result["reason"]


@pytest.mark.slow
@pytest.mark.parametrize(("uav", "arm"), [("crazyflie", None), ("octo25", str(ARMS / "heavy.xml"))])
def test_lightest_and_heaviest_take_off(uav, arm):
    """The arm's own stop is above the one's threshold of contact; the other leaves three tools' weights on the sensor."""
    given = {"uav": uav, "arm": arm, "ee": None, "deviation": "published"}
    result = fly(load("landing", given), "takeoff", 501).result
    assert result["success"], result["reason"]


@pytest.mark.slow
def test_light_uav_takes_off_though_the_arm_leaves_more_force_than_a_release_may():
    """0.25 N of the arm's friction stay on the hinge, where the magnet opens below 0.095 N."""
    given = {"uav": "crazyflie", "deviation": "published"}
    episode = fly(load("landing", given), "takeoff", 70003)
    assert episode.result["success"], episode.result["reason"]
    grip = episode.ticks["mission"]["phase"] == 3
    force = np.linalg.norm(episode.ticks["estimate"]["hinge_force"][grip], axis=1)
    assert 0.095 < np.median(force) < 0.3


@pytest.mark.slow
@pytest.mark.parametrize("seed", [130013, 130014])
def test_unrest_of_the_arm_is_no_plate_that_is_touched(seed):
    """The tool's inertia makes more force than the weight of a UAV of 0.04 kg lets a contact have."""
    result = fly(load("landing", {"uav": "crazyflie", "deviation": "published"}), "takeoff", seed).result
    assert result["success"], result["reason"]


def test_three_rotors_are_refused_before_anything_moves():
    with pytest.raises(ModelError, match=r"3 rotors make 3 of the four independently"):
        prepare(load_scenario(UAVS / "tri.toml"), "landing", 1)
