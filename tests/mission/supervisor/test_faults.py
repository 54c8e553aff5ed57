"""Signs of faults with their debouncing, on a healthy moment in which one thing goes wrong."""

import numpy as np
import pytest

from armland.mission.supervisor.faults import find_fault, note_jolts
from armland.mission.supervisor.table import FAULT, FAULTS
from armland.rotations import from_rotation_vector

ALL = "carry"
"""Phase whose fault row the tests replace by one in which all matters."""


def find(bench, ticks=1, matters=None, expected=np.nan, magnet_on=False, force_max=1e9, held=1):
    """Name of the fault that is found in the last of some ticks."""
    bench.kept["decide"]["held"] = held
    row = bench.enter(ALL)
    row["force"] = force_max
    phase = bench.plan.number(ALL)
    bench.board["table"]["faults"][0, :, phase] = -1
    for fault in FAULTS[1:] if matters is None else matters:
        bench.board["table"]["faults"][0, FAULT[fault], phase] = 0
    for _ in range(ticks):
        found = find_fault(expected, magnet_on, phase, bench.b)
    return FAULTS[found]


def debounce(bench, fault):
    return int(bench.board["table"]["debounce"][0, FAULT[fault]])


def provoke(bench, fault):
    """Let the sign of a fault show; returns the arguments of `find`."""
    watch = bench.told["decide"]["watch"]
    match fault:
        case "non_finite":
            bench.kept["estimate"]["bad"] = 1
        case "arm_stale":
            bench.m["arm_tick"] = 990
        case "uav_silent":
            bench.m["uav_tick"] = 700
        case "camera_stale":
            bench.e["plate_age"] = 0.6
        case "wrench_stale":
            bench.m["wrench_tick"] = 970
        case "wrench_drift":
            bench.e["hinge_force"][0, 2] = 5.0
            return {"expected": 2.0}
        case "magnet_coil":
            bench.m["magnet_fault"] = 1
            return {"magnet_on": True}
        case "overload":
            bench.e["hinge_force"][0, 0] = watch["hinge_max"][0] + 1.0
        case "rotor_lost":
            # One rad/s against the rate of fall: more than the capture angle is still to come.
            bench.e["omega"][0] = [0.0, 1.5 * watch["capture_max"][0] * watch["fall_rate"][0], 0.0]
        case "uav_tilt":
            bench.e["quat"][0] = from_rotation_vector(np.array([0.6, 0.0, 0.0]))
            return {"held": 0}
        case "slip":
            bench.kept["estimate"]["grip_far"] = 2
        case "near_limit":
            bench.kept["estimate"]["sigma"] = 0.02
        case "law_failed":
            bench.kept["act"]["law"]["failed"] = 1
    return {}


def test_healthy_moment_has_no_fault(bench):
    assert find(bench, 1000) == "none"


@pytest.mark.parametrize("fault", FAULTS[1:])
def test_fault_is_found_after_its_debouncing_and_not_before(bench, fault):
    arguments = provoke(bench, fault)
    needed = debounce(bench, fault)
    assert needed == 1 or find(bench, needed - 1, **arguments) == "none"
    assert find(bench, 1, **arguments) == fault


@pytest.mark.parametrize("fault", FAULTS[1:])
def test_fault_that_does_not_matter_is_let_pass(bench, fault):
    matters = [f for f in FAULTS[1:] if f != fault]
    assert find(bench, 1000, matters, **provoke(bench, fault)) == "none"


def test_sign_that_goes_away_is_forgotten(bench):
    bench.e["hinge_force"][0, 0] = 1000.0
    assert find(bench, 2) == "none"
    bench.e["hinge_force"][0, 0] = 0.0
    find(bench, 1)
    bench.e["hinge_force"][0, 0] = 1000.0
    assert find(bench, 2) == "none"


def test_largest_force_follows_the_phase(bench):
    bench.e["hinge_force"][0, 2] = 12.0
    assert find(bench, 10, force_max=20.0) == "none"
    assert find(bench, 10, force_max=5.0) == "overload"


def test_link_that_is_silent_on_the_way_up_is_found_as_well(bench):
    bench.m["uav_heard"] = 700
    assert find(bench) == "uav_silent"


def test_plate_of_a_silent_uav_is_left_where_it_is(bench):
    bench.kept["estimate"]["grip_far"], bench.m["uav_heard"] = 2, 700
    assert find(bench, 1000, ["slip"]) == "none"
    bench.m["uav_heard"] = 1000
    assert find(bench, 1000, ["slip"]) == "slip"


@pytest.mark.parametrize(
    ("age", "force", "expected", "found"),
    [
        (500, 0.2, 2.5, "slip"),
        (500, 1.9, 2.5, "none"),
        (500, 0.2, 0.5, "none"),
        (500, 0.2, np.nan, "none"),
        (50, 0.2, 2.5, "none"),
    ],
)
def test_load_that_is_gone_is_a_slip_only_where_no_image_says_otherwise(bench, age, force, expected, found):
    bench.kept["estimate"]["grip_tick"], bench.e["hinge_force"][0, 2] = 1000 - age, force
    assert find(bench, 100, expected=expected) == found


def test_joint_beyond_its_speed_is_near_its_limit(bench):
    bench.kept["limit"]["speed_ratio"] = 0.95
    assert find(bench, 100) == "near_limit"


def test_one_image_that_is_far_off_is_no_slip(bench):
    bench.kept["estimate"]["grip_far"] = 1
    assert find(bench, 1000) == "none"


@pytest.mark.parametrize(("images", "found"), [(0, "rotor_lost"), (1, "none")])
def test_uav_whose_plate_slides_off_has_lost_no_rotor(bench, images, found):
    bench.e["quat"][0] = [np.cos(0.05), np.sin(0.05), 0.0, 0.0]
    bench.kept["estimate"]["grip_far"] = images
    assert find(bench, 10) == found


def test_held_uav_is_given_time_to_right_itself_after_its_capture(bench):
    bench.e["quat"][0] = from_rotation_vector(np.array([0.1, 0.0, 0.0]))
    bench.kept["decide"]["seen"]["caught"] = 990
    assert find(bench, 10) == "none"
    bench.kept["decide"]["seen"]["caught"] = 0
    assert find(bench, 10) == "rotor_lost"


@pytest.mark.parametrize(("missed", "found"), [(0.2, "none"), (0.05, "rotor_lost")])
def test_uav_that_was_struck_by_way_of_the_arm_has_lost_no_rotor(bench, missed, found):
    bench.e["quat"][0] = from_rotation_vector(np.array([0.1, 0.0, 0.0]))
    bench.kept["refer"]["v"][0, 0] = missed
    bench.kept["decide"]["seen"]["jolted"] = -1000
    note_jolts(
        1000, bench.e[0], bench.kept["refer"][0], bench.told["decide"]["watch"][0], bench.kept["decide"]["seen"][0]
    )
    assert find(bench, 10) == found


def test_lean_that_the_arms_acceleration_explains_is_no_lost_rotor(bench):
    watch, seen = bench.told["decide"]["watch"], bench.kept["decide"]["seen"]
    lean = watch["capture_max"][0] + 0.5 * watch["tip"][0] * 3.0
    bench.e["quat"][0] = from_rotation_vector(np.array([lean, 0.0, 0.0]))
    assert find(bench, 10) == "rotor_lost"
    seen["counts"] = 0
    bench.kept["refer"]["a"][0, 0] = 3.0
    note_jolts(0, bench.e[0], bench.kept["refer"][0], watch[0], seen[0])
    seen["jolted"] = -1000
    assert find(bench, 10) == "none"
