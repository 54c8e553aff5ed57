"""Sensors say where things are and how they move, in the frames that they claim."""

import mujoco
import numpy as np
import pytest

from armland.plant.scene.composition import build_scene
from armland.rotations import matrix


@pytest.fixture(scope="module", params=["hinged", "free"])
def moving(request, landing):
    """A scene of either kind in a tumbling state; `of(name, size)` reads a sensor."""
    scene = build_scene(landing(), request.param)
    data, rng = mujoco.MjData(scene.model), np.random.default_rng(2)
    data.qpos[scene.joint_qpos] = rng.uniform(-0.5, 0.5, 7)
    data.qvel[:] = rng.uniform(-1.0, 1.0, scene.model.nv)
    if request.param == "free":
        data.qpos[scene.uav_qpos] = [0.4, 0.5, 1.5, 0.5, -0.5, 0.5, 0.5]
    mujoco.mj_forward(scene.model, data)
    return scene, data, lambda name, size=3: data.sensordata[scene.sensor[name] :][:size].copy()


def test_pivot_and_centre_of_mass_are_a_lever_apart(moving):
    scene, _, of = moving
    R = matrix(of("quat", 4))
    np.testing.assert_allclose(of("r") - of("r_cm"), R @ scene.lever, atol=1e-12)
    np.testing.assert_allclose(of("v") - of("v_cm"), R @ np.cross(of("gyro"), scene.lever), atol=1e-9)
    assert np.abs(of("v") - of("v_cm")).max() > 1e-3


def test_velocity_of_the_end_effector_is_its_jacobian_times_joint_speeds(moving):
    scene, data, of = moving
    J, site = np.zeros((3, scene.model.nv)), scene.model.site("armland_ee").id
    mujoco.mj_jacSite(scene.model, data, J, None, site)
    np.testing.assert_allclose(of("ee_vel"), J @ data.qvel, atol=1e-12)
    np.testing.assert_allclose(matrix(of("ee_quat", 4)), data.site_xmat[site].reshape(3, 3), atol=1e-12)


def test_joints_are_read_in_their_order(moving):
    scene, data, of = moving
    first = scene.model.joint(int(scene.model.dof_jntid[scene.joint_dof[0]])).name
    np.testing.assert_array_equal(of(f"q_{first}", 7), data.qpos[scene.joint_qpos])
    np.testing.assert_array_equal(of(f"qd_{first}", 7), data.qvel[scene.joint_dof])
