"""Figures of a flight against records made by hand."""

import numpy as np
import pytest

from armland.experiments.episode import prepare
from armland.experiments.judge.figures import MEASURES, bounds, capture, release, rest, steady, touchdown
from armland.rotations import from_rotation_vector


def test_capture_is_the_last_time_that_pads_touch_in_flight(ticks, brief):
    t = ticks["truth"]
    t["touching"][300:310] = 2  # a first try that missed
    t["r"][999, 0] = 0.683
    t["v"][997] = [0.0, 0.03, -0.04]
    t["touching"][1005] = 0  # pads bounce
    t["plate_quat"][999] = from_rotation_vector(np.array([0.0, np.deg2rad(4.0), 0.0]))
    assert capture(ticks, brief) == {
        "offset_m": pytest.approx(0.002),
        "relative_speed_mps": pytest.approx(0.05),
        "tilt_deg": pytest.approx(4.0),
    }


def test_touchdown_is_before_the_rails_bear(ticks, brief):
    ticks["truth"]["quat"][1998] = from_rotation_vector(np.array([np.deg2rad(2.0), 0.0, 0.0]))
    found = touchdown(ticks, brief)
    assert (found["speed_mps"], found["tilt_deg"]) == (pytest.approx(0.1), pytest.approx(2.0))


def test_release_at_the_tick_in_which_the_magnet_was_switched_off(ticks, brief):
    t = ticks["truth"]
    t["hinge_force"][2499], t["hinge_force"][2500:] = [0.3, 0.0, 0.4], [9.0, 0.0, 0.0]
    t["touching"][2500:2600] = 4  # sticks for a while
    t["v"][2600] = [0.0, 0.02, 0.0]
    t["r"][3000, 2] -= 0.015
    assert release(ticks, brief) == {
        "hinge_force_n": pytest.approx(0.5),
        "speed_mps": pytest.approx(0.02),
        "drop_m": pytest.approx(0.015),
    }


def test_steady_flight_counts_the_speed_that_was_given_as_none(ticks, brief):
    ticks["truth"]["v"][-500:] = [0.3, 0.0, 0.04]
    assert steady(ticks, brief)["speed_mps"] == pytest.approx(np.hypot(0.3, 0.04))
    assert steady(ticks, brief._replace(given=np.array([0.3, 0.0, 0.0])))["speed_mps"] == pytest.approx(0.04)


def test_what_never_came_has_no_figures(ticks, brief):
    none = ticks[:900]
    for measure in (capture, touchdown, release):
        assert set(measure(none, brief).values()) == {None}
    assert rest(ticks, brief) == {"speed_mps": 0.0, "touching": 0.0}
    assert set(MEASURES) == {"capture", "touchdown", "rest", "release", "steady", "tracking"}


def test_bounds_are_the_missions_criteria_and_the_limits_that_there_are(brief):
    assert bounds(brief) == {
        "touchdown.speed_mps": 0.15,
        "touchdown.offset_m": 0.01,
        "rest.speed_mps": 0.01,
        "hinge_force_max_n": 106.2,
        "magnet_pull_max_n": 60.0,
        "magnet_shear_max_ratio": 0.6,
        "fall_m": 0.1,
        "joint_torque_max_ratio": 1.0,
    }
    assert bounds(brief._replace(criteria=(), limits={}, hold=None)) == {}


def test_bounds_of_a_landing_are_its_criteria(landing_scenario):
    found = bounds(prepare(landing_scenario, "landing").brief)
    assert found["touchdown.speed_mps"] == 0.15
    assert found["hinge_force_max_n"] == pytest.approx(0.6 * 177.0)
    assert all(np.isfinite(v) for v in found.values())
