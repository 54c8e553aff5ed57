"""Payload and reach of an arm, checked by what MuJoCo says of a weight at its tip."""

import mujoco
import numpy as np
import pytest

from armland.models.arm import ArmModel
from armland.models.arm_file import strength
from armland.models.arm_file.survey import SHARE, survey
from armland.models.description import ASSETS


@pytest.fixture(scope="module")
def lwr():
    arm = ArmModel.load(ASSETS / "lwr4.xml", "flange")
    return arm, survey(arm, 3)


def worst_share(arm, load):
    """Largest share of a torque limit, over poses, with `load` kg at the end effector, by MuJoCo."""
    model, data, worst = arm.model, mujoco.MjData(arm.model), 0.0
    for q in strength.poses(model):
        data.qpos[:] = q
        mujoco.mj_forward(model, data)
        J = np.zeros((3, model.nv))
        mujoco.mj_jacSite(model, data, J, None, model.site("armland_ee").id)
        worst = max(worst, float((np.abs(data.qfrc_bias + 9.81 * load * J[2]) / arm.tau_max).max()))
    return worst


def test_payload_is_what_uses_the_share_of_the_limits(lwr):
    arm, found = lwr
    assert worst_share(arm, found.anywhere) == pytest.approx(SHARE, rel=1e-6)
    # The vendor's 7 kg, and no more than twice that.
    assert 7.0 < found.anywhere < 14.0


def test_catching_pose_points_upwards_and_carries_more(lwr):
    arm, found = lwr
    arm.update(found.pose, np.zeros(7))
    np.testing.assert_allclose(arm.rotation[:, 2], [0.0, 0.0, 1.0], atol=1e-3)
    assert found.anywhere <= found.catching[0] <= found.catching[1]


def test_mass_and_reach_are_the_arms(lwr):
    _, found = lwr
    assert found.mass == pytest.approx(13.0)
    assert found.reach == pytest.approx(0.868, rel=0.02)


def test_arm_that_cannot_hold_itself_carries_nothing(arms_folder):
    weak = ArmModel.load(arms_folder / "weak.urdf", "tool0")
    assert survey(weak, 3).anywhere == 0.0


@pytest.fixture
def arms_folder():
    from pathlib import Path

    return Path(__file__).parents[2] / "data" / "arms"
