"""Joints off the chain, locked joints, and bodies that move as one, against MuJoCo's own model of the whole file."""

import mujoco
import numpy as np
import pytest

from armland.errors import ConfigurationError, ModelError
from armland.models.arm_file.reading import read_arm
from armland.models.arm_file.table import Asked


def gravity(model, q):
    data = mujoco.MjData(model)
    data.qpos[: len(q)] = q
    mujoco.mj_forward(model, data)
    return data.qfrc_bias[: len(q)].copy()


WRIST = """
<mujoco><compiler angle="radian"/><worldbody><body name="base">{links}</body></worldbody></mujoco>
"""
LINK = (
    '<body name="l{i}" pos="{x} 0 0.1" quat="1 0.2 {x} 0">'
    '<inertial pos="0 0.02 0.1" mass="{m}" diaginertia="0.02 0.02 0.01"/>{joints}'
)


def branched(extra="", twice="", count=6):
    """An MJCF of `count` turning links; `extra` stands in link 3, `twice` is a second joint of link 4."""
    head, tail = "", ""
    for i in range(1, count + 1):
        axis = ("0 0 1", "0 1 0", "1 0 0")[i % 3]
        joints = f'<joint name="j{i}" axis="{axis}" range="-2 2" limited="true" actuatorfrcrange="-90 90"/>'
        joints += twice if i == 4 else ""
        head += LINK.format(i=i, x=0.05 * i, m=4.0 / i, joints=joints) + (extra if i == 3 else "")
        tail += "</body>"
    return WRIST.format(links=head + '<site name="tool0" pos="0 0 0.1" euler="0.3 0 0"/>' + tail)


BRANCH = """<body name="side" pos="0.1 0 0" euler="0.4 0 0"><inertial pos="0.1 0 0" mass="0.7" diaginertia="0.003 0.002 0.002"/>
<joint name="flap" axis="1 1 0" pos="0 0.05 0" range="-1 1" limited="true" ref="0.2"/>
<body name="leaf" pos="0 0.1 0"><inertial pos="0 0 0.1" mass="0.3" diaginertia="0.001 0.001 0.001"/>
<joint name="leaf_slide" type="slide" axis="0 0 1" range="-1 1" limited="true"/></body></body>"""


@pytest.mark.parametrize("lock", [{}, {"flap": 0.7, "leaf_slide": -0.3}])
def test_branch_that_stands_still_weighs_and_turns_as_in_mujoco(tmp_path, lock):
    path = tmp_path / "branched.xml"
    path.write_text(branched(BRANCH), encoding="utf-8")
    file = read_arm(path, Asked(armature=0.0, lock=tuple(lock.items())))
    whole, ours = mujoco.MjModel.from_xml_path(str(path)), file.spec().compile()
    order = [whole.joint(f"j{i}").dofadr[0] for i in range(1, 7)]
    rng, free = np.random.default_rng(2), mujoco.MjData(whole)
    for q in rng.uniform(-2.0, 2.0, (10, 6)):
        free.qpos[:] = whole.qpos0
        for name, value in lock.items():
            free.qpos[whole.joint(name).qposadr[0]] = value
        free.qpos[order] = q
        mujoco.mj_forward(whole, free)
        np.testing.assert_allclose(gravity(ours, q), free.qfrc_bias[order], atol=1e-9)
        M, m = np.zeros((whole.nv, whole.nv)), np.zeros((6, 6))
        mujoco.mj_fullM(whole, free, M)
        data = mujoco.MjData(ours)
        data.qpos[:] = q
        mujoco.mj_forward(ours, data)
        mujoco.mj_fullM(ours, data, m)
        np.testing.assert_allclose(m, M[np.ix_(order, order)], atol=1e-9)
        np.testing.assert_allclose(data.site(file.frame).xpos, free.site("tool0").xpos, atol=1e-12)
        np.testing.assert_allclose(data.site(file.frame).xmat, free.site("tool0").xmat, atol=1e-12)
    said = " ".join(file.chain.notes)
    assert "flap" in said
    assert "leaf_slide" in said


def test_locked_joint_between_two_of_one_body_turns_what_comes_after(tmp_path):
    """A body with two joints, the first locked at 0.6: MuJoCo with that joint held there is the oracle."""
    path = tmp_path / "twice.xml"
    twice = '<joint name="second" axis="0 1 1" pos="0 0.03 0" range="-2 2" limited="true" actuatorfrcrange="-90 90"/>'
    path.write_text(branched(twice=twice), encoding="utf-8")
    file = read_arm(path, Asked(armature=0.0, lock=(("j4", 0.6),)))
    assert [j.name for j in file.chain.joints] == ["j1", "j2", "j3", "second", "j5", "j6"]
    whole, ours = mujoco.MjModel.from_xml_path(str(path)), file.spec().compile()
    order = [whole.joint(j.name).dofadr[0] for j in file.chain.joints]
    held, data = mujoco.MjData(whole), mujoco.MjData(ours)
    for q in np.random.default_rng(5).uniform(-2.0, 2.0, (10, 6)):
        held.qpos[order], held.qpos[whole.joint("j4").qposadr[0]], data.qpos[:] = q, 0.6, q
        mujoco.mj_forward(whole, held)
        mujoco.mj_forward(ours, data)
        np.testing.assert_allclose(data.site(file.frame).xpos, held.site("tool0").xpos, atol=1e-12)
        np.testing.assert_allclose(data.qfrc_bias, held.qfrc_bias[order], atol=1e-9)


def test_rail_stands_still_where_it_is_told(arm):
    for asked, y in (({}, 0.0), ({"lock": (("rail", 0.4),)}, 0.4)):
        file = arm("rail.urdf", **asked)
        assert file.chain.links[0].pose.pos[1] == pytest.approx(y)
        assert [j.name for j in file.chain.joints] == [f"j{i}" for i in range(1, 8)]
        assert any("rail" in note for note in file.chain.notes)


DRIVING = """<link name="{0}"/><joint name="{1}" type="{2}"><parent link="{3}"/><child link="{0}"/><axis xyz="{4}"/>
<limit lower="-3" upper="3" effort="500" velocity="1"/></joint>"""


@pytest.mark.parametrize("order", ["xyt", "txy", "xty"])
@pytest.mark.parametrize("count", [5, 6])
def test_base_that_drives_stands_still_where_the_arm_is_enough_without_it(changed, order, count):
    """Two ways and a turn about the vertical before a rail's arm of 7 joints; with two of those locked too few are left without it."""
    axes = {"x": "1 0 0", "y": "0 1 0", "t": "0 0 1"}
    links = [f"b{i}" for i in range(3)]
    parts = "".join(
        DRIVING.format(link, f"drive_{way}", "revolute" if way == "t" else "prismatic", before, axes[way])
        for link, before, way in zip(links, ["floor", *links], order, strict=False)
    )
    fixed = '<link name="floor"/>' + parts
    text = fixed + '<joint name="on" type="fixed"><parent link="b2"/><child link="base"/></joint></robot>'
    lock = tuple((f"j{i}", 0.0) for i in range(1, 8 - count))
    chain = read_arm(changed("ok.urdf", ("</robot>", text)), Asked(lock=lock)).chain
    arm = [f"j{i}" for i in range(8 - count, 8)]
    assert [j.name for j in chain.joints] == (arm if count == 6 else ["drive_t", *arm])
    assert all(f"drive_{way}" in " ".join(chain.notes) for way in "xy")


def test_gripper_is_named_with_where_it_stands(arm):
    (note,) = (n for n in arm("gripper.urdf").chain.notes if "not on the chain" in n)
    assert "grip_l = 0 m" in note
    assert "--lock NAME=VALUE" in note
    heavier, plain = (sum(k.inertial.mass for k in arm(f).chain.links[1:]) for f in ("gripper.urdf", "ok.urdf"))
    assert heavier > plain


@pytest.mark.parametrize(
    ("lock", "words"),
    [
        ({"nobody": 0.0}, r"arm\.lock: the arm has no joint 'nobody'; its joints are: rail, j1"),
        ({"rail": 3.0}, r"arm\.lock\.rail = 3 lies outside the joint's range, -1 to 1"),
        ({"j1": 0.0, "j2": 0.0}, r"has 5 joints|has 6 joints"),
    ],
)
def test_lock_that_cannot_be_is_refused(arm, lock, words):
    if len(lock) == 2:
        lock = lock | {"rail": 0.0}
    with pytest.raises(ConfigurationError, match=words):
        arm("rail.urdf", lock=tuple(lock.items()))


def test_joint_that_mimics_another_on_the_chain_is_refused(changed):
    path = changed(
        "ok.urdf", ('<joint name="j3" type="revolute">', '<joint name="j3" type="revolute"><mimic joint="j2"/>')
    )
    with pytest.raises(ModelError, match=r"joint 'j3' mimics 'j2', and no motor drives it.*--lock j3=0"):
        read_arm(path)
    assert len(read_arm(path, Asked(lock=(("j3", 0.0),))).rows) == 6


def test_what_else_stands_in_the_world_is_left_behind(changed):
    scene = '<body name="table"><geom type="box" size="1 1 1"/></body></worldbody>'
    file = read_arm(changed("ok.xml", ("</worldbody>", scene)))
    assert any("left behind" in note and "table" in note for note in file.chain.notes)
    assert "table" not in " ".join(b.name for b in file.spec().bodies)


def test_small_part_with_an_impossible_inertia_does_not_matter_and_a_link_does(changed):
    part = (
        '<link name="eye"><inertial><mass value="{m}"/><inertia ixx="0.01" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial>'
        '</link><joint name="on" type="fixed"><parent link="l3"/><child link="eye"/></joint></robot>'
    )
    assert len(read_arm(changed("ok.urdf", ("</robot>", part.format(m=0.05)))).rows) == 7
    with pytest.raises(ModelError, match="link 'eye': no rigid body"):
        read_arm(changed("ok.urdf", ("</robot>", part.format(m=1.0))))


HAND = """<link name="hand"><inertial><mass value="0.3"/><inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/>
</inertial><visual><geometry><mesh filename="hand.stl"/></geometry></visual></link>
<joint name="hand_fixed" type="fixed"><parent link="l7"/><child link="hand"/></joint>
<link name="finger"><inertial><mass value="0.1"/><inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><mesh filename="finger.stl"/></geometry></visual></link>
<joint name="jaw" type="prismatic"><parent link="PARENT"/><child link="finger"/><axis xyz="0 1 0"/>
<limit lower="0" upper="0.04" effort="20" velocity="0.1"/></joint>
</robot>"""
"""A gripper of meshes: a hand that is fixed to the last link, and a finger that slides on it or on the link itself."""


@pytest.mark.parametrize(("carrier", "seen"), [("hand", ["l7.stl"]), ("l7", ["l7.stl", "hand.stl"])])
def test_meshes_of_a_gripper_are_not_looked_at_and_its_mass_counts(arms, tmp_path, carrier, seen):
    """The tool takes its place; what has no finger, as a flange that is fixed, stays."""
    text = (arms / "ok.urdf").read_text("utf-8").replace("</robot>", HAND.replace("PARENT", carrier))
    part = '<link name="l7"><visual><geometry><mesh filename="l7.stl"/></geometry></visual>'
    (tmp_path / "arm.urdf").write_text(text.replace('<link name="l7">', part))
    made = read_arm(tmp_path / "arm.urdf", Asked("tool0")).chain
    assert sorted(m.file.rpartition("/")[2] for m in made.links[-1].meshes) == sorted(seen)
    assert made.links[-1].inertial.mass == pytest.approx(0.9)
    (note,) = [n for n in made.notes if n.startswith("the meshes of the gripper")]
    assert ("hand" in note.partition(": ")[2]) == (carrier == "hand")
