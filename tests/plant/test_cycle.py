"""The two calls of a cycle: what they answer, and that the measurement carries the magnet's report."""

import numpy as np
import pytest

from armland.plant.cycle import APPLIED, NOT_FINITE
from armland.records import UavMode


def test_finite_cycle_is_applied(bench):
    b = bench()
    b.act(0)
    assert b.answer == APPLIED


@pytest.mark.parametrize("where", ["tau", "thrust", "uav_quat", "delta_tau"])
def test_command_that_is_not_finite_is_not_applied(bench, where):
    b = bench()
    b.act(0, tau=1.0)
    b.act(1, **{"tau": 2.0, where: np.inf})
    assert b.answer == NOT_FINITE
    np.testing.assert_array_equal(b.ctrl, 1.0)


@pytest.mark.parametrize("where", ["quat", "r", "omega"])
def test_state_that_is_not_finite_is_noticed(bench, where):
    b = bench()
    b.t[where][0, 1] = np.nan
    b.act(0)
    assert b.answer == NOT_FINITE


def test_measurement_reports_the_magnet(bench_in_air):
    b = bench_in_air()
    b.kept["magnet"]["report"], b.kept["magnet"]["fault"], b.kept["magnet"]["touching"] = 170.0, 1, 3
    b.read(0)
    assert (b.m["magnet_force"], b.m["magnet_fault"], b.t["touching"]) == (170.0, 1, 3)


def test_devices_that_are_not_fitted_do_nothing(bench):
    b = bench()
    b.act(0, magnet=1, uav_mode=UavMode.HINGED)
    b.read(1)
    assert b.m["camera_fresh"] == 0
    assert b.kept["magnet"]["current"] == 0.0
