"""Motors: limits of the arm's file, gain and offset."""

import numpy as np

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


def test_joint_without_a_limit_in_its_file_has_none(bench, paper, tmp_path):
    from armland.models.description import ASSETS

    text = (ASSETS / "lwr4.xml").read_text("utf-8").replace(' actuatorfrcrange="-38 38"', "")
    (tmp_path / "arm.xml").write_text(text, encoding="utf-8")
    b = bench(arm={"file": str(tmp_path / "arm.xml")})
    b.act(0, tau=np.full(7, 500.0))
    assert b.ctrl[0] == 176.0
    assert (b.ctrl[5:] == 500.0).all()
