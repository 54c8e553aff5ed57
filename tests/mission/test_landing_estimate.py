"""Samples that cannot be used, the plate on the magnet as an image shows it, and the force that is explained."""

import numpy as np
import pytest

from armland.mission.landing import load_expected
from armland.mission.landing_estimate import LEAP, look_at_grip, screened
from armland.mission.landing_scenario import landing_scenario
from armland.mission.landing_setup import set_up
from armland.mission.landing_state import memory_layout
from armland.mission.records import landing_layout
from armland.rotations import conjugate, from_rotation_vector, matrix, multiply

SETUP = set_up(landing_scenario())
MARKER, DOWN = SETUP.filter["marker_offset"][0].copy(), SETUP.filter["marker_quat"][0].copy()


def measurement(tick=100):
    m = np.zeros(1, landing_layout("measurement", 7))
    m["uav_quat"][0, 0] = 1.0
    for name in ("tick", "arm_tick", "wrench_tick", "uav_tick"):
        m[name] = tick
    return m


@pytest.mark.parametrize(
    ("field", "clock"), [("q", "arm_tick"), ("qd", "arm_tick"), ("wrench", "wrench_tick"), ("uav_rate", "uav_tick")]
)
def test_sample_that_is_no_number_keeps_the_last_one_and_stops_its_clock_alone(field, clock):
    good, m = np.zeros(1, landing_layout("measurement", 7)), measurement()
    m[field] = 0.01
    assert screened(m[0], good[0], False) == 0
    m = measurement(101)
    m[field][0, 1] = np.nan
    assert screened(m[0], good[0], False) == 1
    assert m[field][0, 1] == 0.01
    for name in ("arm_tick", "wrench_tick", "uav_tick"):
        assert m[name][0] == (100 if name == clock else 101)


@pytest.mark.parametrize(("step", "bad"), [(0.5 * LEAP, 0), (2.0 * LEAP, 1), (-2.0 * LEAP, 1)])
def test_joint_that_leaps_is_not_believed(step, bad):
    good, m = np.zeros(1, landing_layout("measurement", 7)), measurement()
    m["q"] = 1.0
    assert screened(m[0], good[0], False) == 0
    m = measurement(101)
    m["q"] = 1.0
    m["q"][0, 3] += step
    assert screened(m[0], good[0], False) == bad
    assert m["q"][0, 3] == (1.0 if bad else 1.0 + step)
    assert m["arm_tick"][0] == (100 if bad else 101)


@pytest.mark.parametrize(
    ("held", "turn", "rate", "believed"),
    [(True, 0.8, 0.0, False), (False, 0.8, 0.0, True), (True, 0.05, 0.0, True), (True, 0.8, 100.0, True)],
)
def test_attitude_that_leaps_is_not_believed_of_a_uav_that_is_held(held, turn, rate, believed):
    good, m = np.zeros(1, landing_layout("measurement", 7)), measurement()
    assert screened(m[0], good[0], False) == 0
    # It stays there: a sample that was not believed does not become true by being repeated.
    for tick in (105, 110, 115):
        m = measurement(tick)
        m["uav_quat"][0], m["uav_rate"][0, 0] = from_rotation_vector(np.array([turn, 0.0, 0.0])), rate
        screened(m[0], good[0], held)
        assert (m["uav_tick"][0] == tick) == believed
        assert (m["uav_quat"][0, 1] > 0.0) == believed


def image(plate, arm, uav):
    """What the camera sees of a UAV (attitude `uav`) whose pivot is `plate` from the end effector, world axes."""
    p, m = SETUP.parameters[0], measurement()
    R_e, R_b = matrix(arm), matrix(uav)
    marker = plate - R_b @ p["lever"] + R_b @ MARKER
    m["camera_fresh"], m["camera_capture"] = 1, 77
    m["camera_position"] = R_e.T @ marker - p["camera"]
    m["camera_quat"] = multiply(conjugate(arm), multiply(uav, DOWN))
    return m


@pytest.mark.parametrize("offset", [(0.0, 0.0, 0.0), (0.012, 0.0, 0.0), (0.004, -0.006, 0.003)])
def test_offset_on_the_magnet_depends_on_nothing_but_the_plates_place(offset):
    rng = np.random.default_rng(3)
    s = np.zeros(1, memory_layout(7))
    for _ in range(5):
        arm, uav = from_rotation_vector(rng.normal(0, 0.5, 3)), from_rotation_vector(rng.normal(0, 0.3, 3))
        look_at_grip(image(np.array(offset), arm, uav)[0], SETUP.parameters[0], MARKER, DOWN, s[0])
        assert s["grip_offset"][0] == pytest.approx(np.linalg.norm(offset), abs=1e-12)
        assert s["grip_tick"][0] == 77
    assert s["grip_far"][0] == (5 if np.linalg.norm(offset) > 0.010 else 0)


def test_tick_without_an_image_says_nothing_of_the_grip():
    s = np.zeros(1, memory_layout(7))
    s["grip_offset"], s["grip_tick"] = 0.002, 5
    look_at_grip(measurement()[0], SETUP.parameters[0], MARKER, DOWN, s[0])
    assert (s["grip_offset"][0], s["grip_tick"][0]) == (0.002, 5)


@pytest.mark.parametrize(
    ("phase", "elapsed", "height", "expected"),
    [
        ("guide", 0.5, 0.7, None),
        ("guide", 1.5, 0.7, 0.0),
        ("align", 0.1, 0.8, 0.0),
        ("close", 1.0, 0.8, None),
        ("carry", 0.1, 0.8, 0.5),
        ("set_down", 0.1, 0.75, 0.5),
        ("set_down", 0.1, 0.705, None),
        ("unload", 0.4, 0.7, None),
        ("unload", 0.6, 0.7, 0.0),
        ("withdraw", 0.5, 0.7, None),
        ("withdraw", 1.1, 0.65, 0.0),
    ],
)
def test_force_is_explained_where_arm_cradle_and_rotors_leave_no_doubt(phase, elapsed, height, expected):
    row = SETUP.table.phases[SETUP.table.number(phase)]
    e, s = np.zeros(1, landing_layout("estimate", 7)), np.zeros(1, memory_layout(7))
    weight = SETUP.parameters["weight"][0]
    s["hover"], e["thrust"] = weight, 0.5 * weight
    e["r"][0, 2] = height
    force = load_expected(row, elapsed, e[0], SETUP.parameters[0], s[0])
    if expected is None:
        assert np.isnan(force)
    else:
        assert force == pytest.approx(expected * weight)
