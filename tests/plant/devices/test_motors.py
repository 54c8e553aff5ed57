"""Motors: limits of the arm's file, gain and offset."""

import numpy as np
import pytest

LIMITS = np.array([176.0, 176.0, 100.0, 100.0, 100.0, 38.0, 38.0])


def test_torque_is_limited_at_the_motor(bench):
    b = bench()
    b.act(0, tau=np.full(7, 1e4))
    np.testing.assert_array_equal(b.ctrl, LIMITS)
    b.act(1, tau=np.full(7, -1e4))
    np.testing.assert_array_equal(b.ctrl, -LIMITS)
    b.act(2, tau=np.arange(7.0))
    np.testing.assert_array_equal(b.ctrl, np.arange(7.0))


def test_gain_and_offset_act_on_their_joint(bench):
    b = bench()
    b.told["motors"]["gain"][0, 1], b.told["motors"]["offset"][0, 4] = 0.9, -0.5
    b.act(0, tau=np.full(7, 10.0))
    np.testing.assert_allclose(b.ctrl, [10.0, 9.0, 10.0, 10.0, 9.5, 10.0, 10.0])


def test_joint_without_a_limit_in_its_file_has_the_one_of_the_arms_rule(bench, landing_scenario, tmp_path):
    from armland.models.arm import ArmModel
    from armland.models.description import ASSETS

    text = (ASSETS / "lwr4.xml").read_text("utf-8").replace(' actuatorfrcrange="-38 38"', "")
    (tmp_path / "arm.xml").write_text(text, encoding="utf-8")
    b = bench(arm={"file": str(tmp_path / "arm.xml")})
    b.act(0, tau=np.full(7, 500.0))
    assert b.ctrl[0] == 176.0
    ruled = ArmModel.load(tmp_path / "arm.xml", "flange", landing_scenario.tool).tau_max
    np.testing.assert_allclose(b.ctrl, ruled)
    assert (ruled[5:] < 38.0).all()


@pytest.mark.parametrize("delay", [0, 1, 20])
def test_torque_is_given_exactly_that_many_ticks_later(bench, delay):
    b = bench()
    b.told["motors"]["delay"] = delay
    for k in range(60):
        b.act(k, tau=np.full(7, 0.5 * k))
        np.testing.assert_array_equal(b.ctrl, 0.5 * max(k - delay, 0))


def test_noise_of_the_torque_has_its_size_and_stays_within_the_limit(bench):
    b = bench()
    b.told["motors"]["sigma"], b.told["motors"]["odd"] = 0.5, 1
    b.act(0, noise=2.0, tau=np.full(7, 10.0))
    np.testing.assert_allclose(b.ctrl, 11.0)
    b.act(1, noise=2.0, tau=LIMITS.copy())
    np.testing.assert_array_equal(b.ctrl, LIMITS)


@pytest.mark.parametrize(("speed", "share"), [(1.0, 0.99), (-1.0, 1.01), (0.0, 1.0)])
def test_load_rubs_against_the_motion_and_not_at_rest(bench, speed, share):
    """1 % of the torque, against the joint's speed: it brakes a torque that drives and adds to one that holds back."""
    b = bench()
    b.told["motors"]["load"], b.told["motors"]["odd"] = 0.01, 1
    b.put("at_qd", np.full(7, speed), "motors")
    b.act(0, tau=np.full(7, 20.0))
    np.testing.assert_allclose(b.ctrl, 20.0 * share)
