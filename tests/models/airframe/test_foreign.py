"""UAV files of other people: what their numbers come to by hand, and what is said where they say too little."""

from pathlib import Path

import numpy as np
import pytest

from armland.errors import ModelError
from armland.models.airframe.file import foreign_of, uav_file
from armland.models.airframe.foreign import read_foreign
from armland.models.airframe.sizing import sized
from armland.models.airframe.table import rows_of
from armland.models.parameters import rotor_effect, rotor_set, uav_parameters
from armland.scenario import load_scenario

UAVS = Path(__file__).parents[2] / "data" / "uavs"


def of(name, **overrides):
    return load_scenario("landing", {"airframe": str(UAVS / name), **overrides})


def changed(tmp_path, name, *pairs):
    text = (UAVS / name).read_text(encoding="utf-8")
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    file = tmp_path / name
    file.write_text(text, encoding="utf-8")
    return file


def test_mass_and_inertia_are_those_of_all_that_hangs_on_the_body():
    """A box of 0.3 kg and four discs of 0.05 kg on it, by Steiner."""
    body = uav_parameters(of("motors.xml"))
    assert body.mass == pytest.approx(0.5)
    height = 4 * 0.05 * 0.03 / 0.5
    disc = 0.05 * (3 * 0.05**2 + 0.004**2) / 12.0
    roll = 0.3 * (0.08**2 + 0.04**2) / 12.0 + 0.3 * height**2
    roll += 4 * (disc + 0.05 * (0.1**2 + (0.03 - height) ** 2))
    assert body.inertia[0, 0] == pytest.approx(roll, rel=1e-6)
    np.testing.assert_allclose(read_foreign(UAVS / "motors.xml").place[0], [0.15, -0.1, 0.03 - height], atol=1e-9)


def test_actuators_at_sites_say_thrust_torque_spin_and_axis():
    told = read_foreign(UAVS / "motors.xml")
    # Gain 1, gear 1.5, control up to 2; 0.03 N·m for 1.5 N.
    assert (told.low, told.high) == (0.0, pytest.approx(3.0))
    assert told.drag_torque == pytest.approx(0.02)
    np.testing.assert_array_equal(told.spin, [1.0, 1.0, -1.0, -1.0])
    lean = np.deg2rad(10.0)
    np.testing.assert_allclose(told.axis[3], [0.0, -np.sin(lean), np.cos(lean)], atol=1e-9)
    # The effect of a rotor is the actuator's: force and torque about the centre of mass.
    scenario = sized(of("motors.xml"))
    effect = rotor_effect(scenario)
    np.testing.assert_allclose(effect[3, :3], [-0.02, -0.02, 0.02], atol=1e-9)
    assert scenario.rotors.max_thrust_n == pytest.approx(3.0)
    source = {row.key: row.source for row in rows_of(scenario)}
    assert source["rotors.max_thrust_n"] == source["rotors.spin"] == "motors.xml"
    assert source["uav.lever_m"].startswith("rule")
    # What the user sets lies above the file.
    assert sized(of("motors.xml", rotors={"max_thrust_n": 2.5})).rotors.max_thrust_n == 2.5


def test_propellers_without_mass_stand_where_their_inertia_is():
    scenario = sized(of("props.urdf"))
    np.testing.assert_allclose(rotor_set(scenario).place[0], [0.1, -0.1, 0.01])
    assert scenario.rotors.max_thrust_n == pytest.approx(2.0 * 0.5 * 9.80665 / 4)
    assert scenario.rotors.drag_torque_m == pytest.approx(0.02)


def test_rotors_that_say_a_side_and_no_number_are_found(tmp_path):
    sides = ("front_right_prop", "back_right_prop", "back_left_prop", "prop_fl")
    file = changed(tmp_path, "props.urdf", *((f"prop{i}_link", name) for i, name in enumerate(sides)))
    np.testing.assert_allclose(read_foreign(file).place, read_foreign(UAVS / "props.urdf").place)
    # What holds or guards a rotor is none: then nothing says where they are.
    file = changed(tmp_path, "props.urdf", *((f"prop{i}_link", f"{name}_guard") for i, name in enumerate(sides)))
    assert read_foreign(file).place is None


def test_pivot_by_rule_is_the_papers_and_nearer_where_the_rotors_are():
    wide = foreign_of(of("motors.xml"))
    assert wide.lever[2] == pytest.approx(-0.06)
    near = wide._replace(place=0.5 * wide.place)
    assert near.lever[2] == pytest.approx(-0.06 * 0.5 * np.hypot(0.15, 0.1) / np.hypot(0.127, 0.127), rel=1e-3)


def test_file_without_rotors_says_what_to_add_and_takes_it(tmp_path):
    with pytest.raises(
        ModelError, match=r"mass of its body 'nano', 0\.027 kg, and not where its rotors are"
    ) as refusal:
        rotor_set(of("whole.xml"))
    assert "place_m" in str(refusal.value)
    place = [[0.03, -0.03, 0.0], [-0.03, -0.03, 0.0], [-0.03, 0.03, 0.0], [0.03, 0.03, 0.0]]
    given = sized(of("whole.xml", rotors={"place_m": place}))
    assert rotor_set(given).number == 4
    assert uav_file(given).body("uav").mass == pytest.approx(0.027)


def test_several_bodies_or_rotors_that_differ_are_refused(tmp_path):
    nano = '<body name="nano" pos="0 0 0.1">'
    twin = f'<body name="other"><freejoint/><geom size="0.1"/></body>{nano}'
    # The one at which actuators push is the one that flies; without them nobody can tell.
    assert read_foreign(changed(tmp_path, "whole.xml", (nano, twin))).body == "nano"
    file = changed(tmp_path, "whole.xml", (nano, twin), ('<site name="actuation"/>', ""))
    with pytest.raises(ModelError, match=r"the bodies other, nano could each be the UAV"):
        read_foreign(file)
    unlike = changed(tmp_path, "motors.xml", ('<motor site="d" gear="0 0 1.5', '<motor site="d" gear="0 0 1.2'))
    with pytest.raises(ModelError, match=r"its rotors are not alike: thrusts up to 3, 3, 3, 2\.4 N"):
        read_foreign(unlike)


def test_body_with_rotors_is_the_uav_of_several():
    assert read_foreign(UAVS / "motors.xml").body == "quadrotor"
