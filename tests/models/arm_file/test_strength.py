"""What holds an arm, against a pendulum worked by hand and against MuJoCo's own gravity torques."""

import mujoco
import numpy as np
import pytest

from armland.models.arm_file import strength

PENDULUM = """
<mujoco><compiler autolimits="true"/><worldbody>
<body><joint name="a" axis="{axis}" range="-180 180"/><inertial pos="{com} 0 0" mass="2" diaginertia="0.1 0.1 0.1"/>
<body pos="0.5 0 0"><joint name="b" axis="0 1 0" range="-180 180"/><inertial pos="0.25 0 0" mass="1" diaginertia="0.1 0.1 0.1"/>
<site name="tip" pos="0.5 0 0"/></body></body></worldbody></mujoco>
"""


@pytest.fixture
def pendulum():
    return lambda axis, com="0.25": mujoco.MjModel.from_xml_string(PENDULUM.format(axis=axis, com=com))


def test_two_links_stretched_out_by_hand(pendulum):
    own, lever = strength.demand(pendulum("0 1 0"), "tip")
    assert own == pytest.approx([9.81 * (2.0 * 0.25 + 0.75), 9.81 * 0.25], rel=0.01)
    assert lever == pytest.approx([1.0, 0.5], rel=0.01)


def test_vertical_axis_needs_nothing_upright_and_all_of_it_on_a_wall(pendulum):
    model = pendulum("0 0 1")
    assert strength.held(model)[0] == pytest.approx(0.0, abs=1e-12)
    assert strength.demand(model, "tip")[0][0] > 5.0


def test_held_is_mujocos_gravity_torque(arm):
    model = arm("ok.urdf").spec().compile()
    data, worst = mujoco.MjData(model), np.zeros(model.nv)
    for q in strength.poses(model):
        data.qpos[:] = q
        mujoco.mj_forward(model, data)
        worst = np.maximum(worst, np.abs(data.qfrc_bias))
    np.testing.assert_allclose(strength.held(model), worst, atol=1e-9)


def test_reach_is_the_length_beyond_the_shoulder(arm):
    """0.42 + 0.40 + 0.13 m, S-R-S."""
    file = arm("ok.urdf")
    assert strength.reach(file.spec().compile(), file.frame) == pytest.approx(0.95, rel=0.01)


def test_poses_are_always_the_same_and_within_the_ranges(arm):
    model = arm("ok.urdf").spec().compile()
    q = strength.poses(model)
    np.testing.assert_array_equal(q, strength.poses(model))
    assert (q >= model.jnt_range[:, 0]).all()
    assert (q <= model.jnt_range[:, 1]).all()
