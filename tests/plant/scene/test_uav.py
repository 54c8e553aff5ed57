"""The UAV in the scene: what hangs where, with which mass, whichever arm carries it, and what a scenario's numbers change."""

from pathlib import Path

import mujoco
import numpy as np
import pytest

from armland.errors import ModelError
from armland.models.airframe.sizing import sized
from armland.models.description import ASSETS
from armland.models.parameters import arm_model
from armland.plant.scene.composition import build_scene
from armland.plant.scene.uav import set_stops
from armland.plant.simulator import level_hinge
from armland.scenario import load_scenario

G = 9.81
SIX_AXIS = Path(__file__).parents[2] / "data" / "six_axis.urdf"
UAV = (ASSETS / "ardrone2.xml").read_text("utf-8")


@pytest.fixture
def six_axis(paper):
    return paper(arm={"file": str(SIX_AXIS), "ee": "tool0", "elbow_joint": "elbow"})


def level(scene, q):
    """Data at joint positions q at rest, UAV level."""
    data = mujoco.MjData(scene.model)
    data.qpos[scene.joint_qpos] = q
    mujoco.mj_kinematics(scene.model, data)
    data.qpos[scene.hinge_qpos] = level_hinge(data.body("uav/uav").xmat.reshape(3, 3))
    mujoco.mj_forward(scene.model, data)
    return data


def test_uav_hangs_on_the_hinge_with_the_papers_mass_inertia_and_lever(paper):
    scene = build_scene(paper(), "hinged")
    body = scene.model.body("uav/uav")
    assert body.mass[0] == pytest.approx(0.480)
    np.testing.assert_allclose(np.sort(body.inertia), [0.006, 0.007, 0.012])
    data = level(scene, np.linspace(-0.5, 0.5, 7))
    np.testing.assert_allclose(data.site("uav/pivot").xpos, data.site("armland_ee").xpos, atol=1e-12)
    np.testing.assert_allclose(data.body("uav/uav").xmat.reshape(3, 3), np.eye(3), atol=1e-9)
    np.testing.assert_allclose(data.body("uav/uav").xipos - data.site("armland_ee").xpos, [0, 0, 0.06], atol=1e-9)


def test_pivot_stays_on_the_end_effector_however_the_hinge_turns(paper):
    """The hinge carries no translation: three axes through the pivot."""
    scene = build_scene(paper(), "hinged")
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
    scene, model = build_scene(scenario, "hinged"), arm_model(scenario)
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
    model = build_scene(scenario, "hinged").model
    for name in ("uav/hinge_x", "uav/hinge_y"):
        np.testing.assert_allclose(model.joint(name).range, np.deg2rad([-30.0, 30.0]))
        assert model.jnt_limited[model.joint(name).id]
    assert not model.jnt_limited[model.joint("uav/swivel").id]


def test_hinge_takes_friction_and_damping_from_the_scenario(paper):
    scene = build_scene(paper(hinge={"friction_nm": 0.0123, "damping_nms": 0.0456}), "hinged")
    dofs = [scene.model.joint(f"uav/{n}").dofadr[0] for n in ("swivel", "hinge_x", "hinge_y")]
    np.testing.assert_allclose(scene.model.dof_frictionloss[dofs], 0.0123)
    np.testing.assert_allclose(scene.model.dof_damping[dofs], 0.0456)


def test_shapes_weigh_nothing(paper):
    """Total mass by hand: the links of the arm's file, sensor, tool and UAV."""
    model = build_scene(paper(), "hinged").model
    links = 1.3 + 2.35 + 2.8 + 2.35 + 2.35 + 1.8 + 1.1 + 0.25
    assert model.body_mass.sum() == pytest.approx(links + 0.25 + 0.30 + 0.480)


def test_uav_file_without_its_sites_is_refused_by_their_names(paper, tmp_path):
    path = tmp_path / "uav.xml"
    path.write_text(UAV.replace('name="pivot"', 'name="foot"').replace('name="rotor_3"', 'name="r3"'), encoding="utf-8")
    with pytest.raises(ModelError, match="rotor 1, 2, 4; it lacks 3"):
        build_scene(paper(uav={"file": str(path)}), "hinged")


def test_missing_arm_file_is_refused_by_name(paper):
    with pytest.raises(ModelError, match=r"'nowhere\.xml' does not exist"):
        build_scene(paper(arm={"file": "nowhere.xml"}), "hinged")


J = [[0.008, 0.0, 0.001], [0.0, 0.009, 0.0], [0.001, 0.0, 0.014]]


def inertia_of(model):
    R = np.zeros(9)
    mujoco.mju_quat2Mat(R, model.body("uav/uav").iquat)
    return R.reshape(3, 3) @ np.diag(model.body("uav/uav").inertia) @ R.reshape(3, 3).T


@pytest.mark.parametrize("bond", ["hinged", "free"])
def test_numbers_of_the_scenario_replace_those_of_the_file(landing, bond):
    numbers = {"mass_kg": 0.6, "inertia_kgm2": J, "lever_m": [0.01, 0.0, -0.07]}
    scene = build_scene(landing(uav=numbers), bond)
    assert scene.model.body("uav/uav").mass[0] == pytest.approx(0.6)
    np.testing.assert_allclose(inertia_of(scene.model), J, atol=1e-12)
    np.testing.assert_allclose(scene.lever, [0.01, 0.0, -0.07], atol=1e-15)


@pytest.mark.parametrize("bond", ["hinged", "free"])
def test_numbers_that_are_absent_are_those_of_the_file(landing, bond):
    scene = build_scene(landing(), bond)
    assert scene.model.body("uav/uav").mass[0] == 0.480
    np.testing.assert_allclose(inertia_of(scene.model), np.diag([0.006, 0.007, 0.012]), atol=1e-15)
    np.testing.assert_allclose(scene.lever, [0.0, 0.0, -0.06], atol=1e-15)


def test_load_is_carried_at_the_centre_of_mass(landing):
    plain, laden = (build_scene(landing(uav={"extra_mass_kg": m}), "free") for m in (0.0, 0.2))
    assert laden.uav_mass - plain.uav_mass == pytest.approx(0.2)
    np.testing.assert_allclose(inertia_of(laden.model), inertia_of(plain.model), atol=1e-12)


def test_plate_is_of_solid_steel_unless_it_has_a_mass(landing):
    steel, given = (
        build_scene(landing(plate=p), "free").model.body("uav/plate").mass[0] for p in ({}, {"mass_kg": 0.06})
    )
    assert steel == pytest.approx(7850.0 * np.pi * 0.022**2 * 0.004)
    assert given == pytest.approx(0.06)


def fastest(model, hinge):
    """Largest rate, rad/s, of a free plate that was thrown at a stop of its hinge with 20 rad/s, within 0.2 s."""
    data, joint = mujoco.MjData(model), model.joint("uav/hinge_x")
    mujoco.mj_resetData(model, data)
    model.opt.gravity[:] = 0.0
    data.qpos[model.joint("uav/free").qposadr[0] + 2] = 5.0
    data.qpos[joint.qposadr] = 0.98 * np.radians(hinge.range_deg)
    data.qvel[joint.dofadr] = 20.0
    out = 0.0
    for _ in range(round(0.2 / model.opt.timestep)):
        mujoco.mj_step(model, data)
        out = max(out, float(np.abs(data.qvel[joint.dofadr]).max()))
        if not np.isfinite(out) or out > 1e4:
            return np.inf
    return out


@pytest.mark.parametrize("name", ["ardrone2", "hexa10", "octo25"])
def test_stops_of_the_hinge_give_a_free_plate_no_energy(name):
    scenario = sized(load_scenario("landing", {"airframe": name}))
    model = build_scene(scenario, "free").model
    assert fastest(model, scenario.hinge) <= 20.1


def test_stops_with_the_ar_drones_ratio_would_tear_a_heavy_uavs_plate_about(monkeypatch):
    scenario = sized(load_scenario("landing", {"airframe": "octo25"}))
    model = build_scene(scenario, "free").model
    monkeypatch.setattr("armland.plant.scene.uav.TRIED_NMS", scenario.hinge.stop_nms)
    set_stops(model, scenario.hinge)
    assert fastest(model, scenario.hinge) > 100.0
