"""UAVs that magnet or rotors cannot carry are refused, with the mass that they could."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.mission.belief import flyer
from armland.mission.feasibility.weight import check_hinged_thrust, check_weight, flies_on
from armland.scenario import load_scenario


def checked(overrides, takes_off=False, trial=False):
    scenario = load_scenario("landing", overrides)
    check_weight(scenario, flyer(scenario), takes_off and flies_on(scenario), trial)


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        ({"uav": {"extra_mass_kg": 0.3}}, r"the UAV weighs 8\.\d+ N; its rotors give 7\.44 N"),
        ({"magnet": {"rating_n": 8.0}}, r"the magnet may be loaded with 4\.8 N"),
    ],
)
def test_what_is_too_heavy_is_refused(overrides, words):
    checked({})
    with pytest.raises(ConfigurationError, match=words):
        checked(overrides)


def test_mass_that_is_named_as_carried_is_carried_and_a_little_more_is_not():
    with pytest.raises(ConfigurationError) as refusal:
        checked({"uav": {"extra_mass_kg": 1.0}})
    most = float(str(refusal.value).split("at most ")[1].split(" kg")[0])
    own = flyer(load_scenario("landing")).mass
    checked({"uav": {"extra_mass_kg": most - own - 1e-3}})
    with pytest.raises(ConfigurationError):
        checked({"uav": {"extra_mass_kg": most - own + 1e-3}})


def test_weight_follows_gravity():
    moon = load_scenario("landing", {"environment": {"gravity_mps2": [0.0, 0.0, -1.62]}})
    assert flyer(moon).weight == pytest.approx(flyer(load_scenario("landing")).weight * 1.62 / 9.81)
    checked({"environment": {"gravity_mps2": [0.0, 0.0, -1.62]}, "uav": {"extra_mass_kg": 1.0}})


def test_weight_that_no_speed_of_this_kind_carries_is_refused():
    own = flyer(load_scenario("landing")).mass
    heavy = {"uav": {"extra_mass_kg": 7.44 / 9.81 * 1.001 - own}, "place": {"fly_on": True}}
    with pytest.raises(ConfigurationError, match=r"at 0\.00 m/s its rotors carry 7\.440 N: at most 0\.7584 kg"):
        checked(heavy, takes_off=True)
    # At 0.6 m/s it may fly, and for a study anything may.
    checked({**heavy, "place": {"fly_on": True, "takeoff_velocity_mps": [0.0, -0.6, 0.0]}}, takes_off=True)
    checked(heavy, takes_off=True, trial=True)
    # Landing it needs a hover with room for control.
    with pytest.raises(ConfigurationError, match=r"of which 6\.41 N may go into hovering"):
        checked(heavy)


def test_all_that_is_too_weak_is_named_at_once():
    with pytest.raises(ConfigurationError) as refusal:
        checked({"uav": {"extra_mass_kg": 0.5}, "magnet": {"rating_n": 8.0}})
    assert np.all([word in str(refusal.value) for word in ("magnet", "rotors")])


def test_thrust_on_the_hinge_lies_within_what_the_rotors_give():
    check_hinged_thrust(load_scenario("paper", {"control": {"thrust_n": 7.44}}))
    with pytest.raises(
        ConfigurationError, match=r"control.thrust_n = 7.5 N is beyond the rotors, which give 0.36 to 7.44 N"
    ):
        check_hinged_thrust(load_scenario("paper", {"control": {"thrust_n": 7.5}}))
