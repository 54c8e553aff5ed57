"""Hardware that is exchanged: what is set follows from the scenario's own, and the scenario takes it."""

import pytest

from armland.experiments.campaign.description import changes
from armland.experiments.study.sensors import SENSORS
from armland.models.parameters import arm_file
from armland.scenario import load_scenario


@pytest.fixture(scope="module")
def landing():
    return load_scenario("landing")


@pytest.fixture(scope="module")
def of(landing):
    return lambda name: next(c for c in SENSORS.changes if c.name == name).of(landing)


def test_joints_are_as_fast_as_is_said_of_the_arm_that_there_is(landing, of):
    rated = [row.speed.number for row in arm_file(landing).rows]
    assert of("joints x 0.5") == {"arm.joint_speed_rad_s": [0.5 * speed for speed in rated]}
    assert of("joints x 1.5")["arm.joint_speed_rad_s"][6] == pytest.approx(1.5 * 3.14)
    assert of("joints x 1.5")["control.approach.track_max_mps"] > landing.control.approach.track_max_mps


def test_stronger_rotors_are_asked_for_more_by_the_uavs_own_hover_too(landing, of):
    found = of("rotors +20 %")
    assert found["rotors.max_thrust_n"] == pytest.approx(1.2 * landing.rotors.max_thrust_n)
    assert found["onboard.hover.thrust_max_n"] == pytest.approx(1.2 * landing.onboard.hover.thrust_max_n)


def test_thresholds_of_a_larger_plate_keep_its_pads_covered(landing, of):
    wide = of("plate 30 mm")
    covered = wide["plate.radius_m"] - landing.magnet.pad_radius_m
    assert wide["bounds.align_offset_m"] < wide["bounds.lost_offset_m"] < covered
    # The usual ones, of a plate that covers 7 mm, use no smaller share of it.
    usual = landing.bounds.align_offset_m / (landing.plate.radius_m - landing.magnet.pad_radius_m)
    assert wide["bounds.align_offset_m"] / covered <= usual


def test_every_exchange_is_one_that_the_scenario_takes_and_differs_from_it(landing):
    tables = landing.model_dump(mode="json")
    for change in SENSORS.changes:
        changed = landing.replaced(changes(tables, change.of(landing)))
        assert changed.model_dump() != landing.model_dump(), change.name
    assert len({c.name for c in SENSORS.changes}) == len(SENSORS.changes)
