"""What the controller takes for true of UAV and rotors."""

import numpy as np
import pytest

from armland.mission.belief import flyer, hinged, rotors_of
from armland.models.parameters import plate_mass
from armland.scenario import load_scenario


def test_flyer_carries_its_plate_and_a_hinged_uav_does_not():
    scenario = load_scenario("landing")
    assert flyer(scenario).mass - hinged(scenario).mass == pytest.approx(plate_mass(scenario))
    assert hinged(scenario).mass == pytest.approx(0.480)
    np.testing.assert_allclose(flyer(scenario).body.lever, [0.0, 0.0, -0.06])


def test_weight_is_that_of_the_believed_gravity():
    scenario = load_scenario("landing", {"environment": {"gravity_mps2": [0.0, 3.0, -4.0]}})
    assert flyer(scenario).weight == pytest.approx(5.0 * flyer(scenario).mass)


def test_rotors_give_their_static_thrust_together():
    assert rotors_of(load_scenario("landing")).static == pytest.approx(4 * 1.86)
