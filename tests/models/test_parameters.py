"""From a scenario to models: the UAV's body from its file or its section, the plate's mass, the arm's deliberate error."""

import numpy as np
import pytest

from armland.errors import ModelError
from armland.models.description import ASSETS
from armland.models.parameters import arm_model, plate_mass, rotor_effect, uav_parameters
from armland.scenario import load_scenario


@pytest.fixture(scope="module")
def scenario():
    return load_scenario("landing")


def test_body_is_the_files_unless_the_section_says_otherwise(scenario):
    mass, inertia, lever = uav_parameters(scenario)
    assert mass == 0.48
    np.testing.assert_allclose(inertia, np.diag([0.006, 0.007, 0.012]), atol=1e-15)
    np.testing.assert_allclose(lever, [0.0, 0.0, -0.06])
    told = {"mass_kg": 0.6, "lever_m": [0.0, 0.01, -0.07], "extra_mass_kg": 0.05}
    mass, inertia, lever = uav_parameters(scenario.replaced({"uav": told}))
    assert mass == pytest.approx(0.65)
    np.testing.assert_allclose(lever, [0.0, 0.01, -0.07])
    np.testing.assert_allclose(np.diag(inertia), [0.006, 0.007, 0.012])


def test_inertia_is_in_body_axes_and_places_count_from_the_centre_of_mass(scenario, tmp_path):
    """The same UAV described in a frame whose origin lies elsewhere, its inertia along other axes."""
    text = (ASSETS / "ardrone2.xml").read_text(encoding="utf-8")
    text = text.replace('<inertial pos="0 0 0"', '<inertial pos="0 0 0" euler="0 0 90"').replace(
        '<site name="cm"/>', '<site name="cm" pos="0 0 0.01"/>'
    )
    file = tmp_path / "other.xml"
    file.write_text(text, encoding="utf-8")
    body = uav_parameters(scenario.replaced({"uav": {"file": str(file)}}))
    np.testing.assert_allclose(body.inertia, np.diag([0.007, 0.006, 0.012]), atol=1e-12)
    np.testing.assert_allclose(body.lever, [0.0, 0.0, -0.07])


def test_file_without_what_is_needed_is_refused_with_what_is_missing(scenario, tmp_path):
    text = (ASSETS / "ardrone2.xml").read_text(encoding="utf-8")
    file = tmp_path / "bad.xml"
    file.write_text(
        text.replace('name="rotor_3"', 'name="third"').replace('name="pivot"', 'name="p"'), encoding="utf-8"
    )
    with pytest.raises(ModelError, match=r"has the rotors rotor 1, 2, 4; it lacks 3: number them from 1 on"):
        rotor_effect(scenario.replaced({"uav": {"file": str(file)}}))


def test_plate_is_a_disc_of_steel_unless_its_mass_is_given(scenario):
    assert plate_mass(scenario) == pytest.approx(7850.0 * np.pi * 0.022**2 * 0.004)
    assert plate_mass(scenario.replaced({"plate": {"mass_kg": 0.03}})) == 0.03


def test_factor_on_the_arms_inertia_is_on_all_of_it(scenario):
    right, heavy = arm_model(scenario), arm_model(scenario.replaced({"arm": {"inertia_scale": 1.2}}))
    np.testing.assert_allclose(heavy.mass_matrix, 1.2 * right.mass_matrix, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(heavy.gravity, 1.2 * right.gravity, atol=1e-9)
