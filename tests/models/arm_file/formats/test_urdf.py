"""What URDF means, and what no URDF can mean. Dynamics are checked against Pinocchio in `tests/models/test_arm.py`."""

import numpy as np
import pytest

from armland.errors import ModelError
from armland.models.arm_file.reading import read_arm, read_tree
from armland.models.arm_file.tree import Value


def first(path):
    return next(j for j in read_tree(path).joints() if j.name == "j1")


@pytest.mark.parametrize(
    ("pair", "words"),
    [
        (('<parent link="l3"/>', '<parent link="nobody"/>'), "joint 'j4' names the link 'nobody', which is not there"),
        (('<child link="l4"/>', '<child link="l3"/>'), "the link 'l3' is the child of two joints"),
        (('name="j4" type="revolute"', 'name="j4" type="screw"'), "joint 'j4' has the type 'screw'; known are fixed"),
        (('<link name="l4">', '<link name="l3">'), "two of its links are called 'l3'; rename one"),
        (('<link name="l4">', "<link>"), "a <link> has no name"),
        (('<parent link="base"/>', '<parent link="l7"/>'), "a loop of the links"),
        (('<mass value="2.7"/>', '<mass value="-2.7"/>'), "link 'l4' has a mass of -2.7 kg"),
        (('<mass value="2.7"/>', '<mass value="two"/>'), "link 'l4': mass = 'two' should be 1 finite number"),
        (
            (
                '<axis xyz="0 0 1"/><limit lower="-2.900" upper="2.900" effort="200"',
                '<axis xyz="0 0 0"/><limit effort="200"',
            ),
            "j1.*axis",
        ),
        (('<parent link="l3"/>', ""), "joint 'j4' lacks <parent link"),
    ],
)
def test_refusal_names_link_or_joint(changed, pair, words):
    with pytest.raises(ModelError, match=words):
        read_arm(changed("ok.urdf", pair))


def test_limits_that_are_written_as_infinite_are_none(changed):
    path = changed("ok.urdf", ('effort="200" velocity="3"', 'effort="inf" velocity=".inf"'))
    assert (first(path).torque, first(path).speed) == (None, None)


def test_limit_tag_without_ends_says_no_range(changed):
    path = changed("ok.urdf", ('lower="-2.900" upper="2.900" effort="200"', 'lower="0" upper="0" effort="200"'))
    assert (first(path).low, first(path).high) == (None, None)
    assert first(path).torque == Value(200.0, "file")
    half = changed("ok.urdf", ('lower="-2.900" upper="2.900" effort="200"', 'upper="2.900" effort="200"'))
    assert (first(half).low, first(half).high) == (Value(0.0, "default"), Value(2.9, "file"))


def test_axis_of_any_length_and_default_axis(changed):
    long = changed(
        "ok.urdf",
        (
            '<axis xyz="0 0 1"/><limit lower="-2.900" upper="2.900" effort="200"',
            '<axis xyz="0 0 5"/><limit effort="200"',
        ),
    )
    np.testing.assert_allclose(first(long).axis, [0.0, 0.0, 1.0])
    none = changed(
        "ok.urdf", ('<axis xyz="0 0 1"/><limit lower="-2.900" upper="2.900" effort="200"', '<limit effort="200"')
    )
    np.testing.assert_allclose(first(none).axis, [1.0, 0.0, 0.0])


def test_primitive_shapes_are_kept_and_meshes_are_not(changed):
    at = '<origin xyz="0 0 0.1"/><geometry>{}</geometry>'
    shapes = "".join(
        f"<{tag}>{at.format(solid)}</{tag}>"
        for tag, solid in (
            ("collision", '<cylinder radius="0.05" length="0.3"/>'),
            ("collision", '<sphere radius="0.07"/>'),
            ("visual", '<box size="0.1 0.2 0.3"/>'),
            ("visual", '<mesh filename="nowhere.stl"/>'),
        )
    )
    tree = read_tree(changed("ok.urdf", ('<link name="l3">', f'<link name="l3">{shapes}')))
    found = next(b for b in tree.bodies if b.name == "l3").shapes
    assert [(s.kind, s.touches) for s in found] == [("cylinder", True), ("sphere", True), ("box", False)]
    np.testing.assert_allclose(found[0].size[:2], [0.05, 0.15])
    np.testing.assert_allclose(found[2].size, [0.05, 0.1, 0.15])


def test_mass_without_inertia_turns_like_a_small_solid(changed):
    tensor = '<inertia ixx="0.00310" iyy="0.00310" izz="0.00186" ixy="0" ixz="0" iyz="0"/>'
    link = read_arm(changed("ok.urdf", (tensor, ""))).chain.links[-1]
    np.testing.assert_allclose(link.inertial.moments, 0.5 * 0.03**2)


def test_balance_that_the_file_asks_for_is_given(arm):
    """The mean of all three, as MuJoCo does it: (0.01 + 0.003 + 0.003) / 3."""
    np.testing.assert_allclose(arm("t3_unbalanced_fixed.urdf").chain.links[-1].inertial.moments, 0.016 / 3.0)
