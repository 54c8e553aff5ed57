"""The arm in the scene: motors drive joints one to one, and its inertia may be another than its file says."""

import mujoco
import numpy as np
import pytest

from armland.models.description import ASSETS
from armland.plant.scene.composition import build_scene

LWR = (ASSETS / "lwr4.xml").read_text("utf-8")


@pytest.mark.parametrize("bond", ["hinged", "free"])
def test_motors_drive_each_arm_joint_one_to_one_and_nothing_else(landing, bond):
    """A unit torque accelerates as the mass matrix says; the hinge has no motor."""
    scene = build_scene(landing(), bond)
    model, data = scene.model, mujoco.MjData(scene.model)
    assert model.nu == 7
    model.dof_frictionloss[:] = 0.0
    data.qpos[scene.joint_qpos] = np.linspace(-0.4, 0.6, 7)
    mujoco.mj_forward(model, data)
    M = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, M)
    at_rest = data.qacc.copy()
    for i in range(7):
        data.ctrl[:] = np.eye(7)[i]
        mujoco.mj_forward(model, data)
        np.testing.assert_allclose(M @ (data.qacc - at_rest), np.eye(model.nv)[scene.joint_dof[i]], atol=1e-9)


def test_inertia_scale_makes_the_arm_heavier_and_not_the_uav(landing):
    plain, heavy = (build_scene(landing(arm={"inertia_scale": s}), "free").model for s in (1.0, 1.2))
    for model in (plain, heavy):
        assert model.body("uav/uav").mass[0] == pytest.approx(0.480)
    for name in ("arm/link_3", "armland_tool"):
        np.testing.assert_allclose(heavy.body(name).mass, 1.2 * plain.body(name).mass)
        np.testing.assert_allclose(heavy.body(name).inertia, 1.2 * plain.body(name).inertia)
    np.testing.assert_allclose(heavy.dof_armature[:7], 1.2 * plain.dof_armature[:7])
    # What MuJoCo derives from masses follows.
    assert heavy.body_subtreemass[1] > 1.19 * plain.body_subtreemass[1]


def test_inertia_scale_of_a_hinged_uavs_arm_leaves_the_uav(paper):
    plain, heavy = (build_scene(paper(arm={"inertia_scale": s}), "hinged").model for s in (1.0, 1.2))
    np.testing.assert_array_equal(heavy.body("uav/uav").mass, plain.body("uav/uav").mass)
    np.testing.assert_array_equal(heavy.body("uav/uav").inertia, plain.body("uav/uav").inertia)
    assert heavy.body("arm/link_1").mass[0] == pytest.approx(1.2 * plain.body("arm/link_1").mass[0])


def test_arm_file_may_bring_its_own_actuators_sensors_and_keyframes(paper, tmp_path):
    """What a published MJCF holds besides the arm neither breaks the scene nor changes its motion."""
    extras = (
        '<actuator><position name="p" joint="A1" kp="100"/></actuator>'
        '<sensor><jointpos name="own" joint="A1"/></sensor>'
        '<keyframe><key name="home" qpos="0 0 0 0 0 0 0"/></keyframe></mujoco>'
    )
    (tmp_path / "arm.xml").write_text(LWR.replace("</mujoco>", extras), encoding="utf-8")
    accelerations = []
    for scenario in (paper(), paper(arm={"file": str(tmp_path / "arm.xml")})):
        scene = build_scene(scenario, "hinged")
        data = mujoco.MjData(scene.model)
        data.qpos[scene.joint_qpos] = 0.3
        mujoco.mj_forward(scene.model, data)
        assert scene.model.nu == 7
        accelerations.append(data.qacc.copy())
    np.testing.assert_allclose(*accelerations, atol=1e-12)


def test_reflected_inertia_is_added_only_where_the_file_has_none(paper):
    scene = build_scene(paper(arm={"default_armature_kgm2": 0.05}), "hinged")
    np.testing.assert_allclose(scene.model.dof_armature[scene.joint_dof], 0.1)
    np.testing.assert_array_equal(scene.model.dof_armature[-3:], 0.0)
