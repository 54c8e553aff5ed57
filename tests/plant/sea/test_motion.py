"""A sum of harmonics: the fast way to its samples, and derivatives against differences."""

import numpy as np
import pytest

from armland.plant.sea.motion import Motion


@pytest.fixture
def motion():
    r = np.random.default_rng(4)
    amplitude = r.standard_normal((30, 6)) + 1j * r.standard_normal((30, 6))
    return Motion(r.uniform(-2.0, 9.0, 30), amplitude, r.standard_normal(6), r.standard_normal(6))


@pytest.mark.parametrize(("first", "count"), [(-1, 1), (-1, 250), (37, 100), (0, 1001)])
def test_samples_are_the_motion_at_the_ticks(motion, first, count):
    times = (np.arange(count) + first) / 1000.0
    np.testing.assert_allclose(motion.sampled(1000.0, first, count), motion.at(times), atol=1e-11)


@pytest.mark.parametrize("derivative", [1, 2])
def test_derivatives_are_the_limits_of_differences(motion, derivative):
    t, h = np.array([0.3, 2.0, 7.1]), 1e-4
    difference = (motion.at(t + h, derivative - 1) - motion.at(t - h, derivative - 1)) / (2.0 * h)
    np.testing.assert_allclose(motion.at(t, derivative), difference, rtol=1e-5, atol=1e-4)


def test_significant_amplitude_is_twice_the_standard_deviation(motion):
    still = motion._replace(drift=np.zeros(6))
    assert still.significant() == pytest.approx(2.0 * still.at(np.arange(0.0, 20000.0, 0.37)).std(axis=0), rel=0.02)
