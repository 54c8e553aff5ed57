"""Attitude and rates on board: noise that is a rotation, a wrong idea of the axes, a gyro's bias, and its own rate."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

TURN = Rotation.from_rotvec([0.3, -0.5, 0.9])


def sampled(b, k=0, noise=0.0):
    b.put("quat", TURN.as_quat(scalar_first=True))
    b.put("gyro", [0.1, 0.2, 0.3])
    m = b.read(k, noise)
    return Rotation.from_quat(m["uav_quat"][0], scalar_first=True), m["uav_rate"][0].copy()


def test_attitude_noise_is_a_rotation_of_its_size(bench):
    attitude, rate = sampled(bench(sensors={"attitude_rad": 2e-3, "rate_rad_s": 5.0}), noise=1.0)
    np.testing.assert_allclose((TURN.inv() * attitude).as_rotvec(), 2e-3, rtol=1e-9)
    np.testing.assert_allclose(rate - [0.1, 0.2, 0.3], 5.0)


def test_wrong_axes_turn_the_attitude_about_the_worlds(bench):
    b, wrong = bench(), Rotation.from_rotvec([0.0, 0.0, 0.17])
    b.told["imu"]["bias"] = wrong.as_quat(scalar_first=True)
    attitude, _ = sampled(b)
    assert (wrong * TURN * attitude.inv()).magnitude() < 1e-12


def test_gyro_bias_shows_in_the_rates_alone(bench):
    b = bench()
    b.told["imu"]["rate_bias"] = [0.01, -0.02, 0.03]
    attitude, rate = sampled(b)
    np.testing.assert_allclose(rate, [0.11, 0.18, 0.33])
    assert (TURN * attitude.inv()).magnitude() < 1e-12


def test_drawn_heading_error_is_what_the_uav_reports(waiting):
    led = waiting(imperfections={"heading_error_deg": 10.0})
    ticks = led.step(400)
    quats = [
        Rotation.from_quat(ticks[m][q][-1], scalar_first=True)
        for m, q in (("measurement", "uav_quat"), ("truth", "quat"))
    ]
    drawn = Rotation.from_quat(led.sim.drawn.imu_bias, scalar_first=True).magnitude()
    assert (quats[0] * quats[1].inv()).magnitude() == pytest.approx(drawn, abs=5e-3)
    assert drawn > 0.01
