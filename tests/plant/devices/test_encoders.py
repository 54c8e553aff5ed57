"""Joint encoders: what they read too much, how finely, and when they are silent."""

import numpy as np
import pytest

Q = np.array([0.1, -0.2, 0.3, -0.4, 0.5, -0.6, 0.7])


def read(b, k=0, noise=0.0):
    b.put("at_q", Q, "encoders")
    b.put("at_qd", 2.0 * Q, "encoders")
    return b.read(k, noise)


def test_joints_are_read_as_they_are(bench):
    m = read(bench(), 5)
    np.testing.assert_array_equal(m["q"][0], Q)
    np.testing.assert_array_equal(m["qd"][0], 2.0 * Q)
    assert m["arm_tick"] == 5


def test_noise_has_its_size(bench):
    b = bench(sensors={"joint_position_rad": 1e-3, "joint_velocity_rad_s": 0.2})
    m = read(b, noise=2.0)
    np.testing.assert_allclose(m["q"][0] - Q, 2e-3)
    np.testing.assert_allclose(m["qd"][0] - 2.0 * Q, 0.4)


def test_offset_shows_in_its_joint_alone(bench):
    b = bench()
    b.told["encoders"]["offset"][0, 3] = 0.02
    np.testing.assert_allclose(read(b)["q"][0] - Q, [0, 0, 0, 0.02, 0, 0, 0], atol=1e-15)


def test_resolution_rounds_to_whole_steps(bench):
    b = bench()
    b.told["encoders"]["resolution"] = 0.03
    q = read(b)["q"][0]
    assert q == pytest.approx(0.03 * np.round(Q / 0.03))
    assert np.abs(q - Q).max() > 0.005


def test_truth_keeps_what_the_encoder_gets_wrong(bench):
    b = bench()
    b.told["encoders"]["offset"] = 0.1
    read(b)
    np.testing.assert_array_equal(b.t["q"][0], Q)


def test_encoder_before_a_soft_gear_reads_its_wind_up(bench):
    """q + τ/K: 50 N·m on 20 kN·m/rad are 2.5 mrad, in the joint that bears them."""
    b = bench()
    b.told["encoders"]["compliance"] = 5e-5
    b.put("at_tau", [50.0, 0.0, 0.0, -20.0, 0.0, 0.0, 0.0], "encoders")
    np.testing.assert_allclose(read(b)["q"][0] - Q, [2.5e-3, 0.0, 0.0, -1e-3, 0.0, 0.0, 0.0], atol=1e-15)
