"""The unrest that is expected at a touchdown: against swings in closed form."""

import numpy as np
import pytest

from armland.control.laws.unaided.quiet import SPEED_MPS, TILT_RAD, ahead_of, unrest

STILL = np.zeros(2)


@pytest.mark.parametrize("ahead", [0.0, 0.3, 1.0, 2.5])
@pytest.mark.parametrize("phase", [0.0, 0.7, 2.9])
def test_eq_q1_is_exact_for_a_swing(ahead, phase):
    omega, amplitude = 1.5, 0.4
    now, rate = amplitude * np.sin(phase), amplitude * omega * np.cos(phase)
    assert ahead_of(now, rate, omega, ahead) == pytest.approx(amplitude * np.sin(omega * ahead + phase), abs=1e-12)


def test_eq_q1_of_a_slow_swing_is_a_straight_line():
    assert ahead_of(0.2, 0.3, 0.0, 2.0) == pytest.approx(0.8)
    assert ahead_of(0.2, 0.3, 1e-4, 2.0) == pytest.approx(0.8, abs=1e-6)


def test_eq_q2_is_one_where_one_part_uses_up_what_a_touchdown_may_have():
    assert unrest(STILL, STILL, (SPEED_MPS, 0.0), 0.0, (1.0, 0.0)) == pytest.approx(1.0)
    assert unrest(np.array([0.0, TILT_RAD]), STILL, (0.0, 0.0), 0.0, (1.0, 0.0)) == pytest.approx(1.0)
    assert unrest(STILL, STILL, (0.0, 0.0), -SPEED_MPS, (1.0, 0.0)) == pytest.approx(1.0)


def test_eq_q2_adds_squares():
    tilt = TILT_RAD * np.array([3.0, 4.0])
    assert unrest(tilt, STILL, (0.0, 0.0), 12.0 * SPEED_MPS, (1.0, 0.0)) == pytest.approx(13.0)


def test_a_pad_that_is_level_now_and_tilted_later_is_no_quiet_one():
    omega = 2.0
    quarter = 0.5 * np.pi / omega
    rate = np.array([3.0 * TILT_RAD * omega, 0.0])
    assert unrest(STILL, rate, (0.0, 0.0), 0.0, (omega, 0.0)) == 0.0
    assert unrest(STILL, rate, (0.0, 0.0), 0.0, (omega, quarter)) == pytest.approx(3.0)
