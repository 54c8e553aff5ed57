"""Arm dynamics on a moving base against Pinocchio's inverse dynamics with a free flyer of prescribed twist and acceleration."""

import numpy as np
import pinocchio as pin
import pytest
from numba import njit

from armland.models.chain import feel, refresh
from armland.models.environment import carry_along, environment_layout, on_land


@njit
def evaluate(views, environment, state):
    feel(views, environment[0])
    refresh(views, state[0], True)
    carry_along(views, environment[0], state[0])


def moving(rng):
    e = np.zeros(1, environment_layout())
    e["base_quat"][0, 0], e["moves"], e["gravity"] = 1.0, 1, rng.normal(size=3) * 5.0
    for name in ("base_omega", "base_a", "base_alpha"):
        e[name] = rng.normal(size=3)
    return e


def on_free_flyer(twin):
    base = pin.Model()
    joint = base.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "deck")
    frame = base.addFrame(pin.Frame("deck", joint, 0, pin.SE3.Identity(), pin.FrameType.OP_FRAME))
    whole = pin.appendModel(base, twin.model, frame, pin.SE3.Identity())
    return whole, whole.createData()


@pytest.mark.parametrize("tool", [False, True], ids=["bare", "tool"])
def test_x5_torques_on_a_moving_base_agree_with_pinocchio(bench, arm_name, states, tool):
    """g + h_b and C φ̇ at random twists, accelerations and configurations, for all arms: 1e-9 N·m."""
    arm, twin = bench(arm_name, tool).arm, bench(arm_name, tool).twin
    model, data = on_free_flyer(twin)
    kept, rng = arm.views.gravity.copy(), np.random.default_rng(3)
    try:
        for q, qd in states(arm, 20, seed=5):
            e = moving(rng)
            arm.qpos[:], arm.qvel[:] = q, qd
            evaluate(arm.views, e, arm.state)
            ours = arm.state["gravity"][0] + arm.state["coriolis"][0]
            model.gravity.linear[:] = e["gravity"][0]
            v = np.concatenate([np.zeros(3), e["base_omega"][0], qd])
            a = np.concatenate([e["base_a"][0], e["base_alpha"][0], np.zeros(len(qd))])
            place = np.concatenate([pin.neutral(model)[:7], twin.configuration(q)])
            np.testing.assert_allclose(ours, pin.rnea(model, data, place, v, a)[6:], atol=1e-9)
            # Negative control: the acceleration of the base's origin is not all that its motion does.
            feel(arm.views, e[0])
            arm.refresh(velocity_terms=True)
            assert np.abs(arm.state["gravity"][0] + arm.state["coriolis"][0] - ours).max() > 1e-3
    finally:
        arm.views.gravity[:] = kept


def test_an_arm_that_is_not_told_feels_gravity_alone(bench):
    arm, e = bench("lwr4", True).arm, moving(np.random.default_rng(1))
    kept = arm.views.gravity.copy()
    try:
        feel(arm.views, e[0], False)
        np.testing.assert_array_equal(arm.views.gravity, e["gravity"][0])
        feel(arm.views, e[0])
        np.testing.assert_allclose(arm.views.gravity, e["gravity"][0] - e["base_a"][0])
    finally:
        arm.views.gravity[:] = kept


def test_on_land_nothing_is_added(bench, states):
    arm = bench("lwr4", tool=True).arm
    for q, qd in states(arm, 5):
        arm.update(q, qd)
        before = arm.gravity.copy()
        evaluate(arm.views, on_land(), arm.state)
        np.testing.assert_array_equal(arm.gravity, before)
