"""Brakes: an arm without torque stays where it is while they are on, and falls while they are off."""

import numpy as np
import pytest


@pytest.mark.parametrize(("brake", "stays"), [(1, True), (0, False)])
def test_brake_holds_an_arm_without_torque(waiting, brake, stays):
    led = waiting()
    led.step(50)
    led.step(300, tau=0.0, brake=brake)
    moved = np.abs(led.sim.data.qpos[led.sim.scene.joint_qpos] - led.path(0.0)).max()
    assert (moved < 5e-3) == stays


def test_brake_lets_go_again_and_a_new_run_begins_without(waiting):
    led = waiting()
    dof, friction = led.sim.scene.joint_dof, led.sim.views.dof_frictionloss
    free = friction[dof].copy()
    led.step(5, brake=1)
    assert (friction[dof] == 300.0).all()
    led.step(1, brake=0)
    np.testing.assert_array_equal(friction[dof], free)
    led.step(5, brake=1)
    led.sim.connect()
    np.testing.assert_array_equal(friction[dof], free)


def test_brake_acts_after_its_delay_with_its_own_strength(bench):
    b = bench()
    b.told["brake"]["delay"], b.told["brake"]["hold"] = 10, np.arange(7.0)
    dof, on = b.sim.scene.joint_dof, []
    for k in range(30):
        b.act(k, brake=1 if k >= 5 else 0)
        on.append(bool(b.kept["brake"]["on"][0]))
    assert on.index(True) == 15
    np.testing.assert_array_equal(b.views.dof_frictionloss[dof], np.arange(7.0))


def test_friction_of_a_free_joint_is_the_brakes_to_give(waiting):
    led = waiting()
    led.sim.world["told"]["brake"]["free"] = 7.0
    led.sim.connect()
    assert (led.sim.views.dof_frictionloss[led.sim.scene.joint_dof] == 7.0).all()
