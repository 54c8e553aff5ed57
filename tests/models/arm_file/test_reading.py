"""Every oddity of `tests/data/arms`: it reads as the healthy arm does, or is refused by one sentence that says what would work."""

import time

import numpy as np
import pytest

from armland.errors import ModelError
from armland.models.arm import ArmModel
from armland.models.arm_file.formats.urdf import GREY
from armland.models.arm_file.reading import read_arm
from armland.models.description import ASSETS

SAME = {
    # All that these files say besides the arm, or in another order, changes nothing of it.
    "urdf": (
        *("name_clash_floor", "package_mesh", "space_names", "t13_shuffled", "t21_bom", "t27_transmission"),
        *("t28_scale_mesh_only", "t6_flange_x", "name_clash_world"),
    ),
    "xml": (
        *("actuator_limits", "position_servos", "default_motor_ctrlrange", "contact_disabled", "gravity_off"),
        *("gravity_flag_off", "floor", "camera_overview", "keyframe", "keyframe_ctrl", "t18_meshes_missing"),
    ),
}
CASES = [(name, kind) for kind, names in SAME.items() for name in names]

REFUSED = {
    "no_inertial_link3.urdf": ("'l3'", "no mass", "<inertial>"),
    "t3_unbalanced.urdf": ("'l7'", "0.003, 0.003, 0.01", "balanceinertia"),
    "xacro.urdf": ("not been expanded", "xacro FILE.xacro -o arm.urdf"),
    "t19_one_limit_reversed.urdf": ("'j4'", "reversed", "2.1", "-2.1"),
    "revrange.urdf": ("'joint_1'", "reversed", "6.283", "-6.283"),
}


def behaviour(file, count=20):
    """Mass matrix, gravity torque and pose of an arm at random positions, and its limits."""
    spec = file.spec()
    site = spec.site(file.frame)
    site.name = "armland_ee"
    model, rng = ArmModel(spec, rows=file.rows), np.random.default_rng(3)
    out = [model.q_min, model.q_max, model.tau_max]
    for q in rng.uniform(model.q_min, model.q_max, (count, model.joints)):
        model.update(q, np.zeros(model.joints))
        out += [model.mass_matrix.ravel(), model.gravity.copy(), model.position.copy(), model.rotation.ravel()]
    return np.concatenate([np.ravel(x).copy() for x in out])


@pytest.mark.parametrize(("name", "kind"), CASES)
def test_oddity_reads_as_the_healthy_arm(arm, name, kind):
    np.testing.assert_allclose(behaviour(arm(f"{name}.{kind}")), behaviour(arm(f"ok.{kind}")), atol=1e-9)


def test_comparison_notices_another_arm(arm):
    """Negative control: a weaker arm and a shorter one are not the same."""
    for other in ("weak.urdf", "small.urdf"):
        assert np.abs(behaviour(arm(other)) - behaviour(arm("ok.urdf"))).max() > 0.05


def test_both_formats_say_the_same_of_one_arm(arm):
    np.testing.assert_allclose(behaviour(arm("ok.xml")), behaviour(arm("ok.urdf")), atol=1e-4)


@pytest.mark.parametrize("name", REFUSED)
def test_refusal_names_what_is_wrong_and_what_would_work(arm, name):
    with pytest.raises(ModelError) as refusal:
        arm(name)
    message = str(refusal.value)
    assert name in message
    assert "\n" not in message
    for words in REFUSED[name]:
        assert words in message


def test_every_file_of_the_folder_reads_or_is_refused_and_none_takes_long(arms):
    refused = set()
    for path in sorted(arms.iterdir()):
        start = time.perf_counter()
        try:
            file = read_arm(path)
        except ModelError:
            refused.add(path.name)
            continue
        assert len(file.rows) == len(file.chain.joints) >= 6
        assert time.perf_counter() - start < 5.0
    assert refused == set(REFUSED)


@pytest.mark.parametrize(
    "name", ["t5_pedestal.urdf", "t5_tilted10.urdf", "t5_wall.urdf", "world_link_pose.urdf", "wall.urdf"]
)
def test_mounts_move_the_arm_and_change_nothing_else(arm, name):
    mounted, plain = (file.spec().compile() for file in (arm(name), arm("ok.urdf")))
    np.testing.assert_allclose(mounted.body_mass[-7:], plain.body_mass[-7:])
    np.testing.assert_allclose(mounted.body_inertia[-7:], plain.body_inertia[-7:])
    assert np.abs(behaviour(arm(name)) - behaviour(arm("ok.urdf"))).max() > 0.05


def test_pedestal_stands_where_its_joint_says(arm):
    """Worked by hand: the stand carries the base 0.2 m up and turned by a quarter, so the first axis is 0.54 m up."""
    base, first = arm("t5_pedestal.urdf").chain.links[:2]
    np.testing.assert_allclose(base.pose.pos, [0.0, 0.0, 0.2])
    np.testing.assert_allclose(base.pose.quat, np.sqrt([0.5, 0.0, 0.0, 0.5]), atol=1e-6)
    np.testing.assert_allclose(first.pose.pos, [0.0, 0.0, 0.34])


def test_floating_base_stands_and_is_said(arm):
    file = arm("t23_floating_base.urdf")
    assert any("floating base" in note and "float" in note for note in file.chain.notes)
    np.testing.assert_allclose(behaviour(file), behaviour(arm("ok.urdf")), atol=1e-9)


def test_arm_that_comes_with_armland_keeps_every_bit(arm):
    """Its flights are recorded: the reader may not round what its file says."""
    import mujoco

    ours, plain = read_arm(ASSETS / "lwr4.xml").spec().compile(), mujoco.MjModel.from_xml_path(str(ASSETS / "lwr4.xml"))
    for field in (
        "body_pos",
        "body_quat",
        "body_mass",
        "body_inertia",
        "body_ipos",
        "body_iquat",
        "jnt_range",
        "jnt_axis",
    ):
        np.testing.assert_array_equal(getattr(ours, field), getattr(plain, field))
    for field in ("jnt_actfrcrange", "dof_damping", "dof_frictionloss", "dof_armature"):
        np.testing.assert_array_equal(getattr(ours, field), getattr(plain, field))


def test_file_of_another_kind_is_refused(tmp_path):
    for text, words in (
        ("<sdf/>", "export URDF or MJCF"),
        ("<mujocoinclude/>", "give the file that includes it"),
        ("<mujoco><body/></mujoco>", "no <body> in its <worldbody>.*give the file that includes it"),
        ("<mujoco><worldbody/></mujoco>", "no <body> in its <worldbody>"),
        ("<a/>", "known are <robot>"),
        ("", "not well-formed"),
    ):
        path = tmp_path / "arm.xml"
        path.write_text(text, encoding="utf-8")
        with pytest.raises(ModelError, match=words):
            read_arm(path)
    with pytest.raises(ModelError, match="does not exist"):
        read_arm(tmp_path / "nowhere.urdf")


def test_changed_file_is_read_anew(changed):
    path = changed("ok.urdf")
    before = read_arm(path).rows[0].torque.number
    path.write_text(path.read_text("utf-8").replace('effort="200"', 'effort="150"'), encoding="utf-8")
    import os

    os.utime(path, ns=(1, 1))
    assert (before, read_arm(path).rows[0].torque.number) == (200.0, 150.0)


def test_colour_that_nobody_can_read_is_no_reason_to_refuse_an_arm(changed):
    shape = (
        '<visual><geometry><box size="0.1 0.1 0.1"/></geometry><material><color rgba="0.1 0.2 0.3 0 1"/></material></visual>'
        '<inertial><origin xyz="0 0 0.04"/><mass value="5"/>'
    )
    file = read_arm(changed("ok.urdf", ('<inertial><origin xyz="0 0 0.04"/><mass value="5"/>', shape)))
    (seen,) = (s for link in file.chain.links for s in link.shapes if s.kind == "box")
    np.testing.assert_allclose(seen.rgba, GREY)
