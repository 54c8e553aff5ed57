"""Thresholds at which no capture holds are refused by closed forms."""

import pytest

from armland.errors import ConfigurationError
from armland.mission.belief import flyer
from armland.mission.feasibility.capture import check_capture, grip_of
from armland.models.capture import GATE_M, lateral_speed_bound
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


def test_lateral_speed_is_bounded_at_the_fastest_that_the_move_can_close():
    """Standoff and what lies beyond, 36 mm in a second, at 35/16 of the mean; the plate may come as fast as it drifts."""
    scenario = load_scenario("landing", {"bounds": {"align_speed_mps": 0.5}})
    mass = flyer(scenario).mass
    most = lateral_speed_bound(grip_of(scenario), mass, 35.0 / 16.0 * 0.036 + 0.5, GATE_M)
    with pytest.raises(ConfigurationError, match=rf"it must be below {most:.3f} m/s"):
        check_capture(scenario, mass)


def test_tilt_that_is_aligned_to_must_be_below_the_one_that_is_given_up_at():
    checked({"bounds": {"align_tilt_deg": 29.9}})
    with pytest.raises(ConfigurationError, match="30"):
        checked({"bounds": {"align_tilt_deg": 30.0}})
