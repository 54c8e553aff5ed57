"""The composed scene: what hangs where, with which mass, and that any arm takes the place of the LWR."""

from pathlib import Path

import mujoco
import numpy as np
import pytest

from armland.errors import ModelError
from armland.models.description import ASSETS
from armland.models.parameters import arm_model
from armland.plant.scene import build_scene

G = 9.81
SIX_AXIS = Path(__file__).parents[1] / "data" / "six_axis.urdf"
LWR = (ASSETS / "lwr4.xml").read_text("utf-8")
UAV = (ASSETS / "ardrone2.xml").read_text("utf-8")


@pytest.fixture
def six_axis(paper):
    return paper(arm={"file": str(SIX_AXIS), "ee": "tool0", "elbow_joint": "elbow"})


@pytest.fixture
def with_arm(paper, tmp_path):
    def scenario(text):
        path = tmp_path / "arm.xml"
        path.write_text(text, encoding="utf-8")
        return paper(arm={"file": str(path), "ee": "flange"})

    return scenario


def level(scene, q):
    """Data at joint positions q at rest, UAV level: its swivel and tilts undo the end effector's attitude."""
    data = mujoco.MjData(scene.model)
    data.qpos[scene.joint_qpos] = q
    mujoco.mj_kinematics(scene.model, data)
    E = data.body("uav/uav").xmat.reshape(3, 3).T
    data.qpos[scene.hinge_qpos] = [
        np.arctan2(-E[0, 1], E[1, 1]),
        np.arcsin(E[2, 1]),
        np.arctan2(-E[2, 0], E[2, 2]),
    ]
    mujoco.mj_forward(scene.model, data)
    return data


def test_uav_hangs_on_the_hinge_with_the_papers_mass_inertia_and_lever(paper):
    scene = build_scene(paper())
    body = scene.model.body("uav/uav")
    assert body.mass[0] == pytest.approx(0.480)
    np.testing.assert_allclose(np.sort(body.inertia), [0.006, 0.007, 0.012])
    data = level(scene, np.linspace(-0.5, 0.5, 7))
    np.testing.assert_allclose(data.site("uav/pivot").xpos, data.site("armland_ee").xpos, atol=1e-12)
    np.testing.assert_allclose(data.body("uav/uav").xmat.reshape(3, 3), np.eye(3), atol=1e-9)
    np.testing.assert_allclose(data.body("uav/uav").xipos - data.site("armland_ee").xpos, [0, 0, 0.06], atol=1e-9)


def test_pivot_stays_on_the_end_effector_however_the_hinge_turns(paper):
    """The hinge carries no translation: three axes through the pivot."""
    scene = build_scene(paper())
    rng = np.random.default_rng(2)
    data = mujoco.MjData(scene.model)
    for _ in range(20):
        data.qpos[:] = rng.uniform(-0.7, 0.7, scene.model.nq)
        mujoco.mj_kinematics(scene.model, data)
        np.testing.assert_allclose(data.site("uav/pivot").xpos, data.site("armland_ee").xpos, atol=1e-12)


@pytest.mark.parametrize("arm", ["lwr4", "six axes"])
def test_arm_carries_itself_and_the_uav(paper, six_axis, arm):
    """Plant against the controller's own model: bias torque at rest = g of arm and tool + 𝒥ᵀ m g of the UAV above the pivot."""
    scenario = paper() if arm == "lwr4" else six_axis
    scene, model = build_scene(scenario), arm_model(scenario)
    rng = np.random.default_rng(3)
    for _ in range(10):
        q = rng.uniform(-1.0, 1.0, model.joints)
        data = level(scene, q)
        model.update(q, np.zeros(model.joints))
        carried = model.gravity + model.jacobian[2] * 0.480 * G
        np.testing.assert_allclose(data.qfrc_bias[scene.joint_dof], carried, atol=1e-9)


@pytest.mark.parametrize("arm", ["lwr4", "six axes"])
def test_hinge_range_is_in_degrees_whatever_unit_the_arms_file_uses(paper, six_axis, arm):
    """The LWR's file counts in degrees, a URDF in radians."""
    scenario = paper() if arm == "lwr4" else six_axis
    model = build_scene(scenario).model
    for name in ("uav/hinge_x", "uav/hinge_y"):
        np.testing.assert_allclose(model.joint(name).range, np.deg2rad([-45.0, 45.0]))
        assert model.jnt_limited[model.joint(name).id]
    assert not model.jnt_limited[model.joint("uav/swivel").id]


def test_hinge_takes_friction_and_damping_from_the_scenario(paper):
    scene = build_scene(paper(hinge={"friction_nm": 0.0123, "damping_nms": 0.0456}))
    dofs = [scene.model.joint(f"uav/{n}").dofadr[0] for n in ("swivel", "hinge_x", "hinge_y")]
    np.testing.assert_allclose(scene.model.dof_frictionloss[dofs], 0.0123)
    np.testing.assert_allclose(scene.model.dof_damping[dofs], 0.0456)


def test_motors_drive_each_arm_joint_one_to_one_and_nothing_else(six_axis):
    """A unit torque accelerates as the mass matrix says; the hinge has no motor."""
    scene = build_scene(six_axis)
    model = scene.model
    assert model.nu == 6
    model.dof_frictionloss[:] = 0.0
    data = level(scene, np.linspace(-0.4, 0.6, 6))
    M = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, M)
    at_rest = data.qacc.copy()
    for i in range(6):
        data.ctrl[:] = 0.0
        data.ctrl[i] = 1.0
        mujoco.mj_forward(model, data)
        push = M @ (data.qacc - at_rest)
        expected = np.zeros(model.nv)
        expected[scene.joint_dof[i]] = 1.0
        np.testing.assert_allclose(push, expected, atol=1e-9)


def test_reflected_inertia_is_added_only_where_the_file_has_none(paper, six_axis):
    for scenario, joints in ((six_axis, 6), (paper(arm={"default_armature_kgm2": 0.05}), 7)):
        scene = build_scene(scenario)
        np.testing.assert_allclose(scene.model.dof_armature[scene.joint_dof], np.full(joints, 0.1))
        np.testing.assert_array_equal(scene.model.dof_armature[-3:], 0.0)


def test_nothing_in_the_scene_collides(paper):
    """The hinge holds the UAV; the shapes are for the eye."""
    model = build_scene(paper()).model
    assert not (model.geom_contype.any() and model.geom_conaffinity.any())


def test_shapes_weigh_nothing(paper):
    """Total mass by hand: the links of the arm's file, sensor, tool and UAV."""
    model = build_scene(paper()).model
    links = 1.3 + 2.35 + 2.8 + 2.35 + 2.35 + 1.8 + 1.1 + 0.25
    assert model.body_mass.sum() == pytest.approx(links + 0.25 + 0.30 + 0.480)


def test_arm_file_may_bring_its_own_actuators_sensors_and_keyframes(with_arm, paper):
    """What a published MJCF holds besides the arm neither breaks the scene nor changes its motion."""
    extras = (
        '<actuator><position name="p" joint="A1" kp="100"/></actuator>'
        '<sensor><jointpos name="own" joint="A1"/></sensor>'
        '<keyframe><key name="home" qpos="0 0 0 0 0 0 0"/></keyframe></mujoco>'
    )
    plain, rich = build_scene(paper()), build_scene(with_arm(LWR.replace("</mujoco>", extras)))
    assert rich.model.nu == 7
    a, b = level(plain, np.full(7, 0.3)), level(rich, np.full(7, 0.3))
    np.testing.assert_allclose(a.qacc, b.qacc, atol=1e-12)


def test_uav_file_without_its_sites_is_refused_by_their_names(paper, tmp_path):
    path = tmp_path / "uav.xml"
    path.write_text(UAV.replace('name="pivot"', 'name="foot"').replace('name="rotor_3"', 'name="r3"'), encoding="utf-8")
    with pytest.raises(ModelError, match="lacks pivot, rotor_3"):
        build_scene(paper(uav={"file": str(path)}))


def test_missing_arm_file_is_refused_by_name(paper):
    with pytest.raises(ModelError, match=r"'nowhere\.xml' does not exist"):
        build_scene(paper(arm={"file": "nowhere.xml"}))


def test_scene_steps_at_the_base_rate(paper):
    assert build_scene(paper(run={"rate_hz": 2000})).model.opt.timestep == pytest.approx(5e-4)
