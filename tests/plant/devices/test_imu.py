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


def falling(b, k, velocity, noise=0.0):
    """Specific force that is read at tick `k` of a UAV that moves at `velocity` (3,), m/s, W."""
    b.put("quat", TURN.as_quat(scalar_first=True))
    b.put("v_cm", velocity)
    return b.read(k, noise)["uav_force"][0].copy()


def test_specific_force_is_the_mean_acceleration_less_gravity_along_the_bodys_axes(bench):
    """At rest it is gravity's opposite; in free fall nothing."""
    b = bench()
    period = b.told["imu"]["period"][0]
    np.testing.assert_allclose(falling(b, 0, [0.0, 0.0, 0.0]), TURN.inv().apply([0.0, 0.0, 9.81]), atol=1e-9)
    np.testing.assert_allclose(falling(b, period, [0.0, 0.0, -9.81e-3 * period]), 0.0, atol=1e-9)
    push = np.array([1.0, -2.0, 0.5])
    force = falling(b, 2 * period, np.array([0.0, 0.0, -9.81e-3 * period]) + push * 1e-3 * period)
    np.testing.assert_allclose(force, TURN.inv().apply(push + [0.0, 0.0, 9.81]), atol=1e-9)


def test_accelerometers_have_a_bias_and_noise(bench):
    b = bench(sensors={"acceleration_mps2": 0.05})
    b.told["imu"]["force_bias"] = [0.1, 0.2, 0.3]
    still = TURN.inv().apply([0.0, 0.0, 9.81])
    np.testing.assert_allclose(falling(b, 0, [0.0] * 3, noise=1.0) - still, [0.15, 0.25, 0.35], atol=1e-9)


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
