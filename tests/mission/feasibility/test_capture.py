"""Thresholds at which no capture holds are refused by closed forms."""

import pytest

from armland.errors import ConfigurationError
from armland.mission.belief import flyer
from armland.mission.feasibility.capture import check_capture, grip_of
from armland.scenario import load_scenario


def checked(overrides):
    scenario = load_scenario("landing", overrides)
    check_capture(scenario, flyer(scenario).mass)


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        ({"bounds": {"align_offset_m": 0.0075, "lost_offset_m": 0.01}}, "it must be below 0.007 m"),
        ({"bounds": {"align_speed_mps": 0.5}}, "carries the plate off the magnet"),
        ({"bounds": {"align_tilt_deg": 30.0}}, "must be below limits.tilt_deg = 30"),
    ],
)
def test_refusals(overrides, words):
    checked({})
    with pytest.raises(ConfigurationError, match=words):
        checked(overrides)


def test_a_larger_plate_covers_the_magnet_further():
    wide = {"bounds": {"align_offset_m": 0.0075, "lost_offset_m": 0.01}, "plate": {"radius_m": 0.03}}
    checked(wide)
    assert grip_of(load_scenario("landing", wide)).plate_radius == 0.03


def test_closing_by_a_longer_gap_leaves_less_lateral_speed():
    def bound(standoff):
        with pytest.raises(ConfigurationError) as refusal:
            checked({"bounds": {"align_speed_mps": 0.5}, "place": {"standoff_m": standoff}})
        return float(str(refusal.value).rpartition("below ")[2].split(" m/s")[0])

    assert bound(0.03) != bound(0.15)
