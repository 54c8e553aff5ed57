"""Samples that cannot be used: replaced by the last good ones, and their device's clock stands still."""

import numpy as np
import pytest

from armland.mission.screening import screened
from armland.records import layout
from armland.rotations import from_rotation_vector

LEAP, ATTITUDE_LEAP = 0.05, 0.15


def screen(m, good, held=False, joint_leap=LEAP, attitude_leap=ATTITUDE_LEAP, same=None):
    same = np.zeros(7, np.int64) if same is None else same
    return screened(m[0], good[0], same, held, joint_leap, attitude_leap, 1e-3)


def measurement(tick=100):
    m = np.zeros(1, layout("measurement", 7))
    m["uav_quat"][0, 0] = 1.0
    for name in ("tick", "arm_tick", "wrench_tick", "uav_tick"):
        m[name] = tick
    return m


@pytest.mark.parametrize(
    ("field", "clock"), [("q", "arm_tick"), ("qd", "arm_tick"), ("wrench", "wrench_tick"), ("uav_rate", "uav_tick")]
)
def test_sample_that_is_no_number_keeps_the_last_one_and_stops_its_clock_alone(field, clock):
    good, m = np.zeros(1, layout("measurement", 7)), measurement()
    m[field] = 0.01
    assert screen(m, good) == 0
    m = measurement(101)
    m[field][0, 1] = np.nan
    assert screen(m, good) == 1
    assert m[field][0, 1] == 0.01
    for name in ("arm_tick", "wrench_tick", "uav_tick"):
        assert m[name][0] == (100 if name == clock else 101)


@pytest.mark.parametrize(("step", "bad"), [(0.5 * LEAP, 0), (2.0 * LEAP, 1), (-2.0 * LEAP, 1)])
def test_joint_that_leaps_is_not_believed(step, bad):
    good, m = np.zeros(1, layout("measurement", 7)), measurement()
    m["q"] = 1.0
    assert screen(m, good) == 0
    m = measurement(101)
    m["q"] = 1.0
    m["q"][0, 3] += step
    assert screen(m, good) == bad
    assert m["q"][0, 3] == (1.0 if bad else 1.0 + step)
    assert m["arm_tick"][0] == (100 if bad else 101)


@pytest.mark.parametrize(
    ("held", "turn", "rate", "believed"),
    [(True, 0.8, 0.0, False), (False, 0.8, 0.0, True), (True, 0.05, 0.0, True), (True, 0.8, 100.0, True)],
)
def test_attitude_that_leaps_is_not_believed_of_a_uav_that_is_held(held, turn, rate, believed):
    good, m = np.zeros(1, layout("measurement", 7)), measurement()
    assert screen(m, good) == 0
    # It stays there: a sample that was not believed does not become true by being repeated.
    for tick in (105, 110, 115):
        m = measurement(tick)
        m["uav_quat"][0], m["uav_rate"][0, 0] = from_rotation_vector(np.array([turn, 0.0, 0.0])), rate
        screen(m, good, held)
        assert (m["uav_tick"][0] == tick) == believed
        assert (m["uav_quat"][0, 1] > 0.0) == believed


def test_leaps_do_not_matter_where_nobody_looks_for_them():
    good, m = np.zeros(1, layout("measurement", 7)), measurement()
    assert screen(m, good) == 0
    m = measurement(101)
    m["q"], m["uav_quat"][0] = 2.0, from_rotation_vector(np.array([2.0, 0.0, 0.0]))
    assert screen(m, good, True, np.inf, np.inf) == 0
    assert m["uav_tick"][0] == 101


@pytest.mark.parametrize("field", ["camera_position", "camera_quat"])
def test_image_that_is_no_number_has_not_arrived(field):
    good, m = np.zeros(1, layout("measurement", 7)), measurement()
    m["camera_fresh"] = 1
    assert screen(m, good) == 0
    assert m["camera_fresh"][0] == 1
    m[field][0, 1] = np.nan
    assert screen(m, good) == 1
    assert m["camera_fresh"][0] == 0


def test_first_sample_that_is_no_number_becomes_a_finite_one():
    good, m = np.zeros(1, layout("measurement", 7)), measurement()
    good["uav_quat"][0, 0] = 1.0
    m["q"], m["uav_quat"] = np.nan, np.inf
    assert screen(m, good) == 11
    np.testing.assert_array_equal(m["q"], 0.0)
    np.testing.assert_array_equal(m["uav_quat"][0], [1.0, 0.0, 0.0, 0.0])


def test_first_sample_leaps_from_nowhere_even_at_tick_zero():
    """Before the first sample nothing is known; from the second on it is, whatever the tick that it began with."""
    good, m = np.zeros(1, layout("measurement", 7)), measurement(0)
    good["uav_quat"][0, 0] = 1.0
    m["q"] = 1.0
    assert screen(m, good) == 0
    m = measurement(1)
    m["q"] = 1.0 + 2.0 * LEAP
    assert screen(m, good) == 7
    assert good["tick"][0] == 2


@pytest.mark.parametrize("field", ["camera_position", "camera_quat"])
@pytest.mark.parametrize("value", [np.inf, -np.inf, np.nan])
def test_image_with_an_endless_number_has_not_arrived_either(field, value):
    good, m = np.zeros(1, layout("measurement", 7)), measurement()
    m["camera_fresh"], m["camera_position"], m["camera_quat"] = 1, [0.3, -0.2, 0.5], [0.5, -0.5, 0.5, 0.5]
    assert screen(m, good) == 0
    m[field][0, 2] = value
    assert screen(m, good) == 1
    assert m["camera_fresh"][0] == 0


@pytest.mark.parametrize(("turn", "believed"), [(0.9, True), (1.1, False), (-1.1, False)])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_attitude_may_leap_by_its_bound_in_radians_whichever_sign_its_quaternion_has(turn, sign, believed):
    good, m = np.zeros(1, layout("measurement", 7)), measurement()
    assert screen(m, good) == 0
    m = measurement(101)
    m["uav_quat"][0] = sign * from_rotation_vector(np.array([0.0, turn * ATTITUDE_LEAP, 0.0]))
    screen(m, good, True)
    assert (m["uav_tick"][0] == 101) == believed


@pytest.mark.parametrize(("ticks", "believed"), [(5, False), (20, False), (30, True)])
def test_attitude_may_go_as_far_as_twice_its_rates_explain(ticks, believed):
    """0.4 rad at 5 rad/s about an axis aslant: 0.15 rad may leap, and 0.01 rad a tick are explained."""
    good, m = np.zeros(1, layout("measurement", 7)), measurement()
    m["uav_rate"] = [3.0, 0.0, -4.0]
    assert screen(m, good) == 0
    m = measurement(100 + ticks)
    m["uav_rate"] = [1.0, 0.0, 0.0]
    m["uav_quat"][0] = from_rotation_vector(np.array([0.0, 0.0, 0.4]))
    screen(m, good, True)
    assert (m["uav_tick"][0] == 100 + ticks) == believed


def test_joint_that_repeats_one_reading_at_rest_is_counted_and_its_neighbours_are_not():
    """Frozen: the same to the last digit, and no speed. One that stands still by chance, or moves through, begins anew."""
    good, same = np.zeros(1, layout("measurement", 7)), np.zeros(7, np.int64)
    for k in range(5):
        m = measurement(100 + k)
        m["q"], m["qd"] = 1e-4 * k, 1e-3
        m["q"][0, 2], m["qd"][0, 2] = 0.3, 0.0
        m["q"][0, 4] = 0.3
        screen(m, good, same=same, joint_leap=1.0)
    np.testing.assert_array_equal(same, [0, 0, 4, 0, 0, 0, 0])
    m["arm_tick"], m["q"][0, 2] = 110, 0.3 + 1e-9
    screen(m, good, same=same, joint_leap=1.0)
    assert not same.any()


def test_sample_that_is_seen_again_is_not_counted_again():
    good, same = np.zeros(1, layout("measurement", 7)), np.zeros(7, np.int64)
    for k in range(5):
        m = measurement(100)
        m["tick"] = 100 + k
        screen(m, good, same=same)
    assert same.max() <= 1


def test_stamp_from_the_future_is_one_of_now():
    good, m = np.zeros(1, layout("measurement", 7)), measurement(100)
    m["uav_tick"] = 130
    assert screen(m, good) == 0
    assert m["uav_tick"] == 100
