"""Values, their sources, and the rules where a file is silent: never zero, never infinite."""

import numpy as np
import pytest

from armland.errors import ConfigurationError, ModelError
from armland.models.arm_file.reading import read_arm
from armland.models.arm_file.table import FIELDS, Asked, unit
from armland.models.description import ASSETS


def sources(file, field):
    return {getattr(r, field).source for r in file.rows}


def numbers(file, field):
    return [getattr(r, field).number for r in file.rows]


TRUE = [200.0, 200.0, 120.0, 120.0, 100.0, 40.0, 40.0]


@pytest.mark.parametrize(
    ("name", "source"),
    [
        ("ok.urdf", "file"),
        ("ok.xml", "file"),
        ("actuator_limits.xml", "actuator"),
        ("position_servos.xml", "actuator"),
        ("default_motor_ctrlrange.xml", "file"),
    ],
)
def test_torque_limits_are_found_where_they_stand(arm, name, source):
    file = arm(name)
    assert numbers(file, "torque") == TRUE
    assert sources(file, "torque") == {source}


@pytest.mark.parametrize("name", ["no_effort.urdf", "effort_zero.urdf", "continuous_no_limit_tag.urdf"])
def test_torque_that_the_file_does_not_name_is_by_rule_and_holds_the_arm(arm, name):
    """Between what the true limits are and what holds the arm: neither zero nor infinite."""
    file = arm(name)
    assert sources(file, "torque") == {"rule"}
    for ruled, true in zip(numbers(file, "torque"), TRUE, strict=True):
        assert 10.0 <= ruled <= 1.01 * true


def test_rule_of_the_torque_by_hand(arm):
    """Joint 6 alone, stretched: twice the weight of links 6 and 7 and of a quarter of the moving mass 0.2 m away at least."""
    file = arm("no_effort.urdf")
    # Links 6 and 7 weigh 1.6 and 0.5 kg, 0.04 and 0.06 + 0.04 m from joint 6; the end effector is 0.13 m from it.
    own, load = 9.81 * (1.6 * 0.04 + 0.5 * 0.10), 9.81 * 0.25 * 18.5
    assert numbers(file, "torque")[5] == pytest.approx(2.0 * (own + load * 0.2), rel=0.05)


def test_option_counts_before_the_file(arm):
    file = arm("ok.urdf", torque=(10.0,) * 7, speed=(1.0,) * 7, torque_rate=(500.0,) * 7)
    for field, value in (("torque", 10.0), ("speed", 1.0), ("torque_rate", 500.0)):
        assert numbers(file, field) == [value] * 7
        assert sources(file, field) == {"option"}


@pytest.mark.parametrize("field", ["torque", "speed", "torque_rate"])
def test_another_number_of_values_is_refused_with_its_path_and_the_joints(arm, field):
    path = {"torque": "torque_limits_nm", "speed": "joint_speed_rad_s", "torque_rate": "torque_rate_nm_s"}[field]
    with pytest.raises(ConfigurationError, match=rf"arm\.{path} has 3 values; the arm has 7 joints: j1, j2"):
        arm("ok.urdf", **{field: (1.0, 1.0, 1.0)})


def test_what_comes_with_armland_has_its_own_speeds_and_rates():
    rows = read_arm(ASSETS / "lwr4.xml").rows
    assert [r.speed.number for r in rows] == [1.92, 1.92, 2.23, 2.23, 2.27, 3.14, 3.14]
    assert [r.torque_rate.number for r in rows] == [1500.0] * 7


def test_silence_about_speed_and_rate_is_a_rule(arm):
    file = arm("ok.xml")
    assert numbers(file, "speed") == [2.0] * 4 + [2.5] * 3
    assert sources(file, "speed") == {"rule"}
    assert numbers(file, "torque_rate") == [2000.0, 2000.0, 1200.0, 1200.0, 1000.0, 1000.0, 1000.0]
    # A speed of a millimetre an hour is no speed.
    assert sources(arm("novel.urdf"), "speed") == {"rule"}
    assert sources(arm("ok.urdf"), "speed") == {"file"}


@pytest.mark.parametrize("name", ["continuous.urdf", "t4_continuous_with_range.urdf"])
def test_endless_joint_turns_once_each_way_whatever_its_limit_tag_says(arm, name):
    last = arm(name).rows[-1]
    assert (last.low, last.high) == ((pytest.approx(-2.0 * np.pi), "rule"), (pytest.approx(2.0 * np.pi), "rule"))


def test_ranges_in_degrees_are_refused_with_what_they_would_be_in_radians(changed):
    path = changed("ok.urdf", ('lower="-2.900" upper="2.900"', 'lower="-170" upper="170"'))
    with pytest.raises(ModelError, match=r"'j1' reaches 170 rad, 27 turns, as that of 3 of 7 .* 170° are 2.9671 rad"):
        read_arm(path)


def test_range_as_large_as_no_range_is_none(changed):
    path = changed("ok.urdf", ('lower="-2.900" upper="2.900"', 'lower="-10000" upper="10000"'))
    assert read_arm(path).rows[0].high.source == "rule"


def test_armature_is_the_files_or_by_the_arms_size(arm, changed):
    assert numbers(arm("ok.urdf"), "armature") == [0.1] * 7
    assert sources(arm("ok.urdf"), "armature") == {"rule"}
    assert numbers(arm("ok.urdf", armature=0.02), "armature") == [0.02] * 7
    light = changed(
        "ok.urdf", *((f'mass value="{m}"', f'mass value="0.{m.replace(".", "")}"') for m in ("5", "4", "3"))
    )
    assert 0.05 <= read_arm(light).rows[0].armature.number <= 0.1
    assert read_arm(ASSETS / "lwr4.xml").rows[0].armature == (0.1, "default class")


def test_friction_and_damping_are_the_files(arm):
    assert numbers(arm("friction5.urdf"), "friction") == [5.0] * 7
    assert numbers(arm("damping10.urdf"), "damping") == [10.0] * 7
    assert sources(arm("ok.urdf"), "friction") == {"default"}


def test_one_sided_torque_range_is_both_sides(arm):
    """`actuatorfrcrange="0 176"` would divide by zero, and no motor pushes one way only."""
    assert numbers(arm("onesided.xml"), "torque") == [176.0, 176.0, 100.0, 100.0, 100.0, 38.0, 38.0]


def test_motors_commanded_from_minus_one_to_one_say_no_torque(changed):
    """Shares of a torque that the file does not name."""
    pairs = [(f'ctrlrange="-{x} {x}"', 'ctrlrange="-1 1"') for x in ("200", "120", "100", "40")]
    file = read_arm(changed("actuator_limits.xml", *pairs))
    assert sources(file, "torque") == {"rule"}


def test_effort_of_1_for_all_joints_says_no_torque(arm, changed):
    """As programs write it that draw a URDF from a CAD model; asked for, or beside another effort, it counts."""
    pairs = [(f'effort="{x:.0f}"', 'effort="1"') for x in {*TRUE}]
    assert sources(read_arm(changed("ok.urdf", *pairs)), "torque") == {"rule"}
    assert numbers(arm("ok.urdf", torque=(1.0,) * 7), "torque") == [1.0] * 7
    assert numbers(read_arm(changed("ok.urdf", *(p for p in pairs if "120" not in p[0]))), "torque")[2] == 120.0


@pytest.mark.parametrize("name", ["ok.urdf", "ok.xml", "nolimits.xml", "continuous_no_limit_tag.urdf", "novel.urdf"])
def test_no_limit_is_zero_or_infinite(arm, name):
    for row in arm(name).rows:
        assert all(np.isfinite(getattr(row, f).number) for f in FIELDS)
        assert min(row.speed.number, row.torque.number, row.torque_rate.number, row.armature.number) > 0.0
        assert row.low.number < row.high.number


def test_units_of_a_slide_are_those_of_forces():
    assert [unit(f, "slide") for f in ("low", "torque", "damping", "armature")] == ["m", "N", "N·s/m", "kg"]
    assert [unit(f, "hinge") for f in ("low", "torque", "damping", "armature")] == ["rad", "N·m", "N·m·s/rad", "kg·m²"]
    assert Asked().torque is None
