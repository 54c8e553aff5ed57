"""The Dormand–Prince pair against scipy's table and against an equation with a known solution."""

import numpy as np
import pytest
from scipy.integrate import RK45

from armland.experiments.proof.dormand_prince import ERROR, STAGES, TIMES, excess, next_step, stage


def advance(y, t, h, rate):
    slopes, out = np.empty((7, len(y))), np.empty(len(y))
    slopes[0] = rate(t, y)
    for i in range(1, 7):
        stage(y, slopes, i, h, out)
        slopes[i] = rate(t + TIMES[i] * h, out)
    return out, slopes


def oscillator(t, y):
    """ÿ = −y + cos 2t, solved by y = cos t + (cos t − cos 2t)/3 from y = 1, ẏ = 0."""
    return np.array([y[1], -y[0] + np.cos(2.0 * t)])


def error_after(steps, time=2.0):
    y, h = np.array([1.0, 0.0]), time / steps
    for k in range(steps):
        y, _ = advance(y, k * h, h, oscillator)
    return abs(y[0] - np.cos(time) - (np.cos(time) - np.cos(2.0 * time)) / 3.0)


def test_table_is_that_of_scipy():
    np.testing.assert_allclose(STAGES[:6, :5], RK45.A, atol=1e-15)
    np.testing.assert_allclose(STAGES[6], RK45.B, atol=1e-15)
    np.testing.assert_allclose(np.abs(ERROR), np.abs(RK45.E), atol=1e-15)
    np.testing.assert_allclose(STAGES.sum(axis=1), TIMES, atol=1e-14)


def test_order_is_five():
    orders = np.log2([error_after(n) / error_after(2 * n) for n in (8, 16, 32)])
    assert orders.min() > 4.7


def test_estimated_error_bounds_the_step_that_was_made():
    y = np.array([1.0, 0.0])
    for h in (0.05, 0.1, 0.2):
        out, slopes = advance(y, 0.0, h, oscillator)
        estimated = excess(y, out, slopes, h, 0.0, 1.0)
        fine = y
        for k in range(100):
            fine, _ = advance(fine, k * h / 100, h / 100, oscillator)
        assert np.abs(out - fine).max() < estimated < 100.0 * h**5


def test_next_step_aims_at_what_is_allowed():
    assert next_step(1.0, 0.0) == 5.0
    assert next_step(1.0, 1e9) == pytest.approx(0.2)
    # Fifth order: 32 times the allowed error asks for half the step.
    assert next_step(1.0, 32.0) == pytest.approx(0.45)
