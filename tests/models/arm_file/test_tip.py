"""The end effector: found where it is plain, asked for where it is not, and its axes."""

import numpy as np
import pytest

from armland.errors import ModelError
from armland.models.arm_file.reading import read_arm, read_tree
from armland.models.arm_file.table import Asked
from armland.models.arm_file.tip import farther, further_out, tip
from armland.rotations import matrix


@pytest.mark.parametrize("name", ["ok.urdf", "ok.xml", "gripper.urdf", "rail.urdf"])
def test_plain_one_is_chosen_and_said(arm, name):
    file = arm(name)
    assert file.chain.tip.label == "tool0"
    assert any("'tool0', chosen" in n and "--ee" in n for n in file.chain.notes)
    assert not any("chosen" in n for n in arm(name, ee="tool0").chain.notes)


def test_sideways_frame_is_said_with_the_axis_that_points_out(arm):
    """README's `flange`: turned by −90° about y, so that x points out along the last joint."""
    (note,) = (n for n in arm("t6_flange_x.urdf", ee="flange").chain.notes if "sideways" in n)
    assert "--ee 'flange:x'" in note
    assert not any("sideways" in n for n in arm("t6_flange_x.urdf", ee="flange:x").chain.notes)
    assert not any("sideways" in n for n in arm("ok.urdf", ee="tool0").chain.notes)


def test_axis_that_points_out_is_taken_where_nobody_chose(changed):
    path = changed(
        "t6_flange_x.urdf",
        ('<link name="tool0"/>', ""),
        (
            '<joint name="flange" type="fixed"><parent link="l7"/>'
            '<child link="tool0"/><origin xyz="0 0 0.07"/></joint>',
            "",
        ),
    )
    assert read_arm(path).chain.tip.label == "flange:x"


@pytest.mark.parametrize("axis", ["x", "-x", "y", "-y", "z", "-z"])
def test_axis_after_the_colon_becomes_the_tools(arm, axis):
    plain, turned = (matrix(arm("ok.urdf", ee=e).chain.ee.quat) for e in ("tool0", f"tool0:{axis}"))
    wanted = plain[:, "xyz".index(axis[-1])] * (-1.0 if axis[0] == "-" else 1.0)
    np.testing.assert_allclose(turned[:, 2], wanted, atol=1e-12)
    assert np.linalg.det(turned) == pytest.approx(1.0)


@pytest.mark.parametrize("mount", ["z+0.03", "+z + 0.03", "Z+.03", "x+0.03", "-y+0.03"])
def test_length_after_the_axis_mounts_the_tool_further_out(arm, mount):
    axis = mount.lower().replace(" ", "").lstrip("+").partition("+")[0]
    there, further = (arm("ok.urdf", ee=e).chain.ee for e in (f"tool0:{axis}", f"tool0:{mount}"))
    np.testing.assert_allclose(further.pos - there.pos, 0.03 * matrix(there.quat)[:, 2], atol=1e-12)
    np.testing.assert_allclose(further.quat, there.quat, atol=1e-12)


@pytest.mark.parametrize(
    ("ee", "match"), [("tool0:z+80", "at most 1 m"), ("tool0:z+", "length in metres"), ("tool0:w+0.1", "x, -x")]
)
def test_mount_that_cannot_be_is_refused(arm, ee, match):
    with pytest.raises(ModelError, match=match):
        arm("ok.urdf", ee=ee)


@pytest.mark.parametrize(
    ("label", "wanted"),
    [
        ("link7", "link7:z+0.107"),
        ("flange:x", "flange:x+0.107"),
        ("a:b:-y+0.1", "a:b:-y+0.207"),
        ("a:b", "a:b:z+0.107"),
    ],
)
def test_further_out_is_said_as_it_is_asked_for(label, wanted):
    assert farther(label, 0.107) == wanted


def test_turned_and_sideways_cancel(arm):
    """x of the flange is z of the tool's frame: the same direction in the last link."""
    R = [matrix(arm("t6_flange_x.urdf", ee=e).chain.ee.quat)[:, 2] for e in ("flange:x", "tool0")]
    np.testing.assert_allclose(*R, atol=1e-6)


FLANGE = '<child link="tool0"/><origin xyz="0 0 0.07"/></joint>'


def beyond(changed, own, further, ee=None):
    """What lies further out than `tool0`, or than `ee`, of an arm with a frame more."""
    more = f'<link name="more"/><joint name="m" type="fixed"><parent link="l7"/><child link="more"/><origin {further}/></joint>'
    path = changed("t6_flange_x.urdf", (FLANGE, f'<child link="tool0"/><origin {own}/></joint>{more}'))
    tree = read_tree(path)
    return further_out(tree, tip(tree, ee))


def test_next_frame_along_the_tools_axis_is_told_with_its_distance(changed):
    name, gain = beyond(changed, 'xyz="0 0 0.03"', 'xyz="0.01 0 0.055"')
    assert name == "more"
    assert gain == pytest.approx(0.025)
    # Turned, too, by the axis that points out; nothing less than 5 mm counts, and nothing further in.
    assert beyond(changed, 'xyz="0 0 0.03"', 'xyz="0 0 0.055" rpy="0 -1.5707963 0"')[0] == "more:x"
    assert beyond(changed, 'xyz="0 0 0.08"', 'xyz="0 0 0.082"') is None
    assert beyond(changed, 'xyz="0 0 0.08"', 'xyz="0 0 0.02"') is None


def test_out_is_where_the_tool_goes_even_back_into_the_arm(changed):
    """A user whose tool points into the arm is told of frames that way."""
    name, gain = beyond(changed, 'xyz="0 0 0.08"', 'xyz="0 0 0.1"', ee="tool0:-z")
    assert name != "more"
    assert gain > 0.0


@pytest.mark.parametrize(
    ("ee", "words"),
    [
        ("gripper", r"no frame 'gripper'; its frames are: base, l1"),
        ("tool0:w", r"one of x, -x, y, -y, z, -z"),
        ("l2", r"has 2 joints"),
    ],
)
def test_end_effector_that_cannot_be_is_refused(arm, ee, words):
    with pytest.raises(ModelError, match=words):
        arm("ok.urdf", ee=ee)


def test_two_hands_are_asked_for_by_name(changed):
    """A second arm on the same base: neither end stands out."""
    text = changed("ok.urdf").read_text("utf-8")
    inner = text[text.index('<link name="l1">') : text.index("</robot>")]
    for i in range(1, 8):
        inner = inner.replace(f'"l{i}"', f'"r{i}"').replace(f'"j{i}"', f'"k{i}"')
    inner = inner.replace('"tool0"', '"right_tool"').replace('name="flange"', 'name="right"')
    both = text.replace('"tool0"', '"left_tool"').replace("</robot>", inner + "</robot>")
    path = changed("ok.urdf")
    path.write_text(both, encoding="utf-8")
    with pytest.raises(ModelError, match=r"not plain; name it with --ee, e\.g\. one of: left_tool, right_tool"):
        read_arm(path)
    file = read_arm(path, Asked("right_tool"))
    assert [j.name for j in file.chain.joints] == [f"k{i}" for i in range(1, 8)]
    assert any("not on the chain" in n and "j1 = 0 rad" in n for n in file.chain.notes)


def test_fingers_hold_no_end_effector(changed):
    """A seventh joint called gripper behind six: the chain ends before it."""
    path = changed(
        "ok.urdf",
        ('name="j7"', 'name="gripper"'),
        ('<link name="tool0"/>', ""),
        (
            '<joint name="flange" type="fixed"><parent link="l7"/><child link="tool0"/><origin xyz="0 0 0.07"/></joint>',
            "",
        ),
    )
    file = read_arm(path)
    assert [j.name for j in file.chain.joints] == [f"j{i}" for i in range(1, 7)]
    assert file.chain.tip.label.startswith("l6")
