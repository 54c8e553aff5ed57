"""The judge's Jacobian against a wrist worked by hand, a slide, and MuJoCo's of the arm that is flown."""

import mujoco
import numpy as np
import pytest

from armland.experiments.judge.singularity import Screws, jacobians, screws_of, smallest_singular_values
from armland.plant.scene.composition import build_scene


def test_wrist_is_singular_where_its_outer_axes_coincide(brief):
    middle = np.array([0.0, 0.2, 1.0, 0.5 * np.pi])
    q = np.zeros((4, 7))
    q[:, 1] = middle - 0.5 * np.pi
    np.testing.assert_allclose(smallest_singular_values(q, brief.screws), np.sqrt(1.0 - np.cos(middle)), atol=1e-12)


def test_slide_shifts_the_joints_behind_it():
    screws = Screws(
        [0, 1], [False, True], [0.0, 0.0], [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], [[1.0, 0, 0], [0, 0, 1.0]], [3.0, 0, 0]
    )
    found = jacobians(np.array([[0.5, 0.5 * np.pi]]), screws)[0]
    # The hinge stands at 1.5 m, and the end effector 2 m beside it along y.
    np.testing.assert_allclose(found[:, 0], [1, 0, 0, 0, 0, 0], atol=1e-12)
    np.testing.assert_allclose(found[:, 1], [-2, 0, 0, 0, 0, 1], atol=1e-12)


@pytest.mark.parametrize("bond", ["free", "hinged"])
def test_jacobian_is_the_plants(landing_scenario, bond):
    scene = build_scene(landing_scenario, bond)
    data, q = mujoco.MjData(scene.model), np.random.default_rng(3).uniform(-1.5, 1.5, (5, 7))
    found = jacobians(q, screws_of(scene))
    for at, J in zip(q, found, strict=True):
        data.qpos[scene.joint_qpos] = at
        mujoco.mj_forward(scene.model, data)
        linear, angular = np.zeros((2, 3, scene.model.nv))
        mujoco.mj_jacSite(scene.model, data, linear, angular, scene.model.site("armland_ee").id)
        np.testing.assert_allclose(J, np.vstack([linear, angular])[:, scene.joint_dof], atol=1e-12)


def test_flown_arm_is_as_far_from_a_singularity_as_the_controller_says(landed, landing_scenario):
    screws = screws_of(build_scene(landing_scenario, "free"))
    found = smallest_singular_values(landed.ticks["truth"]["q"][::500], screws)
    np.testing.assert_allclose(found, landed.ticks["health"]["sigma_min"][::500], atol=2e-3)
