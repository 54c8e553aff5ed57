"""What of an MJCF is the robot, and how the rest is left behind."""

import numpy as np
import pytest

from armland.errors import ModelError
from armland.models.arm_file.reading import read_arm, read_tree
from armland.models.arm_file.tree import Value


def test_default_classes_are_named_as_the_source(changed):
    path = changed(
        "ok.xml", ("<worldbody>", '<default><joint frictionloss="0.3" armature="0.2"/></default><worldbody>')
    )
    row = read_arm(path).rows[0]
    assert (row.friction, row.armature) == (Value(0.3, "default class"), Value(0.2, "default class"))
    assert row.damping == Value(0.2, "file")


def test_included_files_are_read(changed, tmp_path):
    body = tmp_path / "arm.xml"
    path = changed("ok.xml")
    text = path.read_text("utf-8")
    inner = text[text.index("<worldbody>") : text.index("</mujoco>")]
    body.write_text(f"<mujocoinclude>{inner}</mujocoinclude>", encoding="utf-8")
    path.write_text(text.replace(inner, '<include file="arm.xml"/>'), encoding="utf-8")
    assert [r.torque.number for r in read_arm(path).rows] == [200.0, 200.0, 120.0, 120.0, 100.0, 40.0, 40.0]
    body.unlink()
    alone = path.rename(tmp_path / "alone.xml")
    with pytest.raises(ModelError, match=r"included file 'arm\.xml' cannot be read"):
        read_arm(alone)


def test_what_this_mujoco_does_not_know_is_left_behind(changed):
    path = changed(
        "ok.xml",
        ('<joint name="j1"', '<joint tomorrow="1" name="j1"'),
        ('<compiler angle="radian"/>', '<compiler angle="radian" coming="true"/>'),
    )
    assert len(read_arm(path).rows) == 7


def test_body_whose_mass_is_in_a_missing_mesh_is_refused_by_name(changed):
    inertial = '<inertial pos="0 0 0.04" mass="1.6" diaginertia="0.00552 0.00552 0.00331"/>'
    pairs = (
        (inertial, '<geom type="mesh" mesh="six"/>'),
        ("<worldbody>", '<asset><mesh name="six" file="six.stl"/></asset><worldbody>'),
    )
    with pytest.raises(ModelError, match=r"body 'l6' has no <inertial>, and the mesh 'six'"):
        read_arm(changed("ok.xml", *pairs))


def test_mass_may_come_from_shapes(changed):
    """A solid cylinder of 0.05 m radius and 0.2 m length at 1000 kg/m³ weighs 1.571 kg."""
    inertial = '<inertial pos="0 0 0.04" mass="1.6" diaginertia="0.00552 0.00552 0.00331"/>'
    file = read_arm(changed("ok.xml", (inertial, '<geom type="cylinder" size="0.05 0.1"/>')))
    link = next(k for k in file.chain.links if k.name == "l6")
    assert link.inertial.mass == pytest.approx(1000.0 * np.pi * 0.05**2 * 0.2)
    assert [s.kind for s in link.shapes] == ["cylinder"]


@pytest.mark.parametrize(
    ("mesh", "ring", "mass"),
    [
        # A ring that weighs nothing is no other source of the body's mass.
        ('mass="0.6"', 'mass="0"', 0.6),
        ("", 'density="0"', 1000.0 * 0.1**3 / 6.0),
        # A mass that is said counts beside what a shape weighs; one that is not may be that shape, drawn.
        ('mass="0.6"', 'mass="0.2"', 0.8),
        ("", 'mass="0.2"', 0.2),
    ],
)
def test_mass_comes_from_a_mesh_where_no_shape_has_it_or_the_mesh_says_it(changed, mesh, ring, mass):
    """A corner of a cube of 0.1 m weighs a sixth of it."""
    inertial = '<inertial pos="0 0 0.04" mass="1.6" diaginertia="0.00552 0.00552 0.00331"/>'
    path = changed(
        "ok.xml",
        (
            inertial,
            f'<geom type="mesh" mesh="six" {mesh}/><geom type="cylinder" size="0.03 0.01" {ring}/>',
        ),
        (
            "<worldbody>",
            '<asset><mesh name="six" vertex="0 0 0 0.1 0 0 0 0.1 0 0 0 0.1"/></asset><worldbody>',
        ),
    )
    link = next(k for k in read_arm(path).chain.links if k.name == "l6")
    assert link.inertial.mass == pytest.approx(mass)


def test_body_without_anything_is_refused(changed):
    inertial = '<inertial pos="0 0 0.04" mass="1.6" diaginertia="0.00552 0.00552 0.00331"/>'
    with pytest.raises(ModelError, match=r"link 'l6', which joint 'j6' moves, has no mass"):
        read_arm(changed("ok.xml", (inertial, "")))


@pytest.mark.parametrize("moments", ["0.01 0.003 0.003", "0.003 -0.003 0.003"])
def test_impossible_inertia_is_refused_and_rounding_is_not(changed, moments):
    old = 'diaginertia="0.00310 0.00310 0.00186"'
    with pytest.raises(ModelError, match="link 'l7': no rigid body"):
        read_arm(changed("ok.xml", (old, f'diaginertia="{moments}"')))
    file = read_arm(changed("ok.xml", (old, 'diaginertia="0.00615 0.0031 0.0030"')))
    assert file.chain.links[-1].inertial.moments.max() == pytest.approx(0.0062, rel=1e-3)


def test_nameless_joint_and_body_get_a_name(changed):
    path = changed("ok.xml", ('<joint name="j3" ', "<joint "))
    assert [j.name for j in read_tree(path).joints()][2] == "l3/joint"
    nameless = changed("ok.xml", ('<body name="l3" ', "<body "))
    assert len(read_arm(nameless).rows) == 7


def test_numbers_that_mjcf_has_no_word_for(changed):
    numeric = '<custom><numeric name="joint_speed_rad_s" data="1 2 3 1 2 3 1"/></custom><worldbody>'
    assert [r.speed for r in read_arm(changed("ok.xml", ("<worldbody>", numeric))).rows][:2] == [
        Value(1.0, "file"),
        Value(2.0, "file"),
    ]


def test_error_of_mujoco_is_one_sentence_with_the_files_name(changed):
    with pytest.raises(ModelError, match=r"ok\.xml' cannot be read: ") as refusal:
        read_arm(changed("ok.xml", ('name="j2"', 'name="j1"')))
    assert "\n" not in str(refusal.value)
