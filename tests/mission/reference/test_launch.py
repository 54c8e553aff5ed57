"""The run-up: a reference without jumps that gets out of the UAV's path."""

import numpy as np
import pytest

from armland.mission.reference.launch import leave, run_up

LEAVE_S = 0.35
SKID_M, BESIDE_M = 0.035, 0.064
"""Lower edge of the skids below the plate's face, and their distance to the tool."""


@pytest.mark.parametrize("move", [run_up, lambda t, duration: leave(t, duration, 0.35)])
def test_speed_and_acceleration_are_the_rates_of_the_displacement(move):
    h = 1e-5
    for t in (0.05, 0.2, 0.31, 0.6, 0.9):
        ahead, behind, here = move(t + h, 0.5), move(t - h, 0.5), move(t, 0.5)
        assert (ahead[0] - behind[0]) / (2.0 * h) == pytest.approx(here[1], abs=1e-6)
        assert (ahead[1] - behind[1]) / (2.0 * h) == pytest.approx(here[2], abs=1e-5)


def test_run_up_ends_at_speed_after_half_the_distance():
    assert run_up(0.5, 0.5) == pytest.approx((0.25, 1.0, 0.0))
    assert run_up(0.8, 0.5) == pytest.approx((0.55, 1.0, 0.0))


def test_leave_ends_at_rest():
    assert leave(5.0, 0.5, 0.35)[1:] == (0.0, 0.0)


def slip_when_clear(slowed):
    """How far the arm lies behind a UAV at 0.65 m/s when it is `SKID_M` below; `slowed`(t): its speed over the UAV's."""
    t = np.linspace(0.0, 0.6, 6001)
    down = np.array([0.06 * run_up(x, LEAVE_S)[1] for x in t])
    behind = 0.65 * np.cumsum([1.0 - slowed(x) for x in t]) * (t[1] - t[0])
    return behind[np.argmax(down > SKID_M)]


def test_arm_is_below_the_skids_before_it_falls_behind():
    assert slip_when_clear(lambda t: leave(t, 0.25, LEAVE_S)[1]) < 0.1 * BESIDE_M
    # An arm that stops at once would be hit.
    assert slip_when_clear(lambda t: np.exp(-t / 0.06)) > BESIDE_M
