"""Force-torque sensor: filter, bias, cross-talk, drift and noise, each against a number worked by hand."""

import numpy as np
import pytest

W = np.array([1.0, -2.0, 3.0, -0.4, 0.5, -0.6])


def read(b, k=0, noise=0.0, w=W):
    b.put("at_force", w[:3], "wrench")
    b.put("at_torque", w[3:], "wrench")
    return b.read(k, noise)["wrench"][0].copy()


def test_force_and_torque_are_read_as_they_are(bench):
    b = bench()
    np.testing.assert_array_equal(read(b, 7), W)
    assert b.m["wrench_tick"] == 7


def test_bias_of_the_scenario_sits_on_force_and_torque(bench):
    b = bench(sensors={"force_bias_n": [0.1, 0.2, 0.3], "torque_bias_nm": [0.01, 0.02, 0.03]})
    np.testing.assert_allclose(read(b) - W, [0.1, 0.2, 0.3, 0.01, 0.02, 0.03])


def test_noise_has_the_size_of_its_channel(bench):
    b = bench(sensors={"force_n": 3.0, "torque_nm": 4.0})
    np.testing.assert_allclose(read(b, noise=1.0) - W, [3.0, 3.0, 3.0, 4.0, 4.0, 4.0])


def test_gain_and_cross_talk_mix_the_channels(bench):
    b = bench()
    b.told["wrench"]["gain"][0, 2, 2] = 1.02
    b.told["wrench"]["gain"][0, 0, 4] = 0.5
    np.testing.assert_allclose(read(b) - W, [0.25, 0.0, 0.06, 0.0, 0.0, 0.0], atol=1e-14)


def test_drift_grows_with_time(bench):
    b = bench()
    b.told["wrench"]["drift"][0] = [0.0, 0.0, 2.0, 0.1, 0.0, 0.0]
    np.testing.assert_allclose(read(b, 0) - W, 0.0, atol=1e-15)
    # At 500 ms; the filter lets all through.
    np.testing.assert_allclose(read(b, 500) - W, [0.0, 0.0, 1.0, 0.05, 0.0, 0.0], atol=1e-12)


def test_filter_answers_a_step_like_a_first_order_low_pass(bench):
    """1 − e^(−2π f t) at 20 Hz; the first sample starts the filter where the sensor is."""
    b = bench(sensors={"force_filter_hz": 20.0})
    np.testing.assert_array_equal(read(b, 0, w=np.full(6, 5.0)), 5.0)
    answer = np.array([read(b, k, w=np.full(6, 6.0))[2] for k in range(1, 51)]) - 5.0
    np.testing.assert_allclose(answer, 1.0 - np.exp(-2.0 * np.pi * 20.0 * 1e-3 * np.arange(1, 51)), atol=1e-12)


def test_filter_halves_the_power_at_its_cut_off(bench):
    b = bench(sensors={"force_filter_hz": 20.0})
    out = [read(b, k, w=np.full(6, np.sin(2.0 * np.pi * 20.0 * k * 1e-3)))[0] for k in range(1000)]
    assert np.ptp(out[500:]) / 2.0 == pytest.approx(np.sqrt(0.5), rel=0.02)
