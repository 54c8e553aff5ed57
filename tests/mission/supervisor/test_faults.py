"""Signs of faults with their debouncing, on a healthy moment in which one thing goes wrong."""

import numpy as np
import pytest

from armland.mission.supervisor.faults import find_fault, note_jolts
from armland.mission.supervisor.table import FAULT, FAULTS
from armland.rotations import from_rotation_vector

ALL = "carry"
"""Phase whose fault row the tests replace by one in which all matters."""

LONG = 310
"""Ticks after which the sign that must be seen for longest, 0.3 s, has been seen for long enough."""


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
    assert find(bench, LONG) == "none"


@pytest.mark.parametrize("fault", FAULTS[1:])
def test_fault_is_found_after_its_debouncing_and_not_before(bench, fault):
    arguments = provoke(bench, fault)
    needed = debounce(bench, fault)
    assert needed == 1 or find(bench, needed - 1, **arguments) == "none"
    assert find(bench, 1, **arguments) == fault


@pytest.mark.parametrize("fault", FAULTS[1:])
def test_fault_that_does_not_matter_is_let_pass(bench, fault):
    matters = [f for f in FAULTS[1:] if f != fault]
    assert find(bench, LONG, matters, **provoke(bench, fault)) == "none"


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
    assert find(bench, LONG, ["slip"]) == "none"
    bench.m["uav_heard"] = 1000
    assert find(bench, LONG, ["slip"]) == "slip"


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
    assert find(bench, LONG) == "none"


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


def lean_by(bench, angle, axis=0):
    """Let the capture point (B.2) of a UAV at rest be at `angle`, rad."""
    bench.e["quat"][0] = from_rotation_vector(np.arcsin(angle) * np.eye(3)[axis])


@pytest.mark.parametrize(
    ("above", "share", "found"),
    [(0.005, 1.8, "none"), (0.005, 2.2, "rotor_lost"), (0.015, 1.8, "rotor_lost"), (-0.015, 1.8, "none")],
)
def test_uav_near_the_rails_may_lean_twice_as_far(bench, above, share, found):
    """Where they touch it they tilt it as well."""
    watch = bench.told["decide"]["watch"][0]
    bench.e["r"][0, 2] = watch["down"] + above
    lean_by(bench, share * watch["capture_max"])
    assert find(bench, 10) == found


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize(("share", "found"), [(0.9, "none"), (1.1, "rotor_lost")])
def test_lean_of_a_uav_that_was_caught_must_be_down_to_an_e_th_after_its_time(bench, axis, share, found):
    watch = bench.told["decide"]["watch"][0]
    bench.kept["decide"]["seen"]["caught"] = 1000 - 150
    most = watch["capture_max"] + (watch["tilt_max"] - watch["capture_max"]) / np.e
    lean_by(bench, share * most, axis)
    assert find(bench, 10) == found


@pytest.mark.parametrize(("ago", "found"), [(390, "none"), (410, "rotor_lost")])
def test_uav_that_was_struck_has_its_time_to_right_itself_and_no_longer(bench, ago, found):
    lean_by(bench, 0.1)
    bench.kept["decide"]["seen"]["jolted"] = 1000 - ago
    assert find(bench, 10) == found


@pytest.mark.parametrize(
    ("wanted", "moves", "struck"),
    [
        ((0.5, -0.4, 0.3), (0.5, -0.4, 0.3), False),
        ((0.3, 0.0, 0.0), (0.25, 0.05, 0.05), False),
        ((0.0, 0.06, 0.06), (0.06, 0.0, 0.0), True),
        ((0.05, 0.0, 0.0), (0.0, -0.05, 0.05), False),
        ((0.0, 0.0, 0.06), (0.0, 0.0, -0.06), True),
    ],
)
def test_arm_is_struck_where_it_misses_the_speed_that_it_should_have(bench, wanted, moves, struck):
    """By more than 0.1 m/s, whatever the direction; speed alone is no jolt."""
    seen, refer = bench.kept["decide"]["seen"], bench.kept["refer"]
    refer["v"], bench.e["v"], seen["jolted"] = wanted, moves, -1
    note_jolts(77, bench.e[0], refer[0], bench.told["decide"]["watch"][0], seen[0])
    assert seen["jolted"][0] == (77 if struck else -1)


def test_lean_that_is_explained_grows_with_the_whole_acceleration(bench):
    seen, watch = bench.kept["decide"]["seen"], bench.told["decide"]["watch"][0]
    bench.kept["refer"]["a"] = [1.0, -2.0, 2.0]
    note_jolts(0, bench.e[0], bench.kept["refer"][0], watch, seen[0])
    assert seen["tip"][0] == pytest.approx(3.0 * watch["tip"])


@pytest.mark.parametrize(
    ("turn", "found"), [((0, 0.6, 0), "uav_tilt"), ((-0.6, 0, 0), "uav_tilt"), ((0, 0, 2.0), "none")]
)
def test_tilt_is_seen_about_both_axes_and_heading_is_none(bench, turn, found):
    bench.e["quat"][0] = from_rotation_vector(np.array(turn, float))
    assert find(bench, 100, held=0) == found
    # Half of the largest tilt is none.
    bench.e["quat"][0] = from_rotation_vector(0.4 * np.array(turn, float) * [1, 1, 0])
    assert find(bench, 100, held=0) == "none"


def test_joint_near_its_end_is_near_its_limit(bench):
    limit, margin = bench.kept["limit"], bench.told["decide"]["watch"]["joint_margin"][0]
    limit["joint_margin"] = 1.1 * margin
    assert find(bench, 100) == "none"
    limit["joint_margin"] = 0.9 * margin
    assert find(bench, 100) == "near_limit"


@pytest.mark.parametrize(
    ("force", "expected", "found"),
    [(5.0, 5.0, "none"), (5.0, 2.0, "wrench_drift"), (2.0, 5.0, "wrench_drift"), (5.0, np.nan, "none")],
)
def test_force_drifts_where_it_is_not_the_one_that_is_explained(bench, force, expected, found):
    bench.e["hinge_force"][0, 2] = force
    assert find(bench, LONG, ["wrench_drift"], expected=expected) == found


@pytest.mark.parametrize("direction", [(2.0, 1.0, 2.0), (-1.0, 2.0, -2.0), (0.0, 0.0, 3.0)])
def test_overload_counts_the_whole_force(bench, direction):
    most = bench.told["decide"]["watch"]["hinge_max"][0]
    for share, found in ((0.95, "none"), (1.05, "overload")):
        bench.e["hinge_force"] = share * most / 3.0 * np.array(direction)
        assert find(bench, 10, ["overload"]) == found


@pytest.mark.parametrize("size", [3, 4])
def test_load_is_gone_whatever_the_direction_of_what_is_left(bench, size):
    """Of 5 N less than three tenths: 1.2 N are left in the first case, 1.6 N in the second."""
    bench.kept["estimate"]["grip_tick"] = 0
    bench.e["hinge_force"] = size * 0.4 / 3.0 * np.array([-2.0, 1.0, 2.0])
    assert find(bench, 100, ["slip"], expected=5.0) == ("slip" if size == 3 else "none")


def test_plate_that_was_never_seen_is_not_missed(bench):
    bench.e["plate_age"], bench.kept["estimate"]["seen"] = 60.0, 0
    assert find(bench, 10) == "none"
    bench.kept["estimate"]["seen"] = 1
    assert find(bench, 10) == "camera_stale"


def test_coil_that_carries_nothing_is_a_fault_only_where_it_was_asked_to(bench):
    bench.m["magnet_fault"] = 1
    assert find(bench, 100) == "none"
    assert find(bench, 100, magnet_on=True) == "magnet_coil"


@pytest.mark.parametrize(
    ("clock", "limit", "fault"),
    [
        ("arm_tick", "arm_age", "arm_stale"),
        ("uav_tick", "uav_age", "uav_silent"),
        ("uav_heard", "uav_age", "uav_silent"),
        ("wrench_tick", "wrench_age", "wrench_stale"),
    ],
)
def test_device_is_silent_from_one_tick_beyond_its_age(bench, clock, limit, fault):
    age = int(bench.told["decide"]["watch"][limit][0])
    bench.m[clock] = 1000 - age
    assert find(bench) == "none"
    bench.m[clock] = 1000 - age - 1
    assert find(bench) == fault


def test_uav_that_is_not_held_has_lost_no_rotor_and_one_on_the_arm_has(bench):
    lean_by(bench, 0.1)
    assert find(bench, 10, held=0) == "none"
    assert find(bench, 10, held=1) == "rotor_lost"


def test_graver_fault_goes_before_the_other(bench):
    bench.m["wrench_tick"], bench.kept["estimate"]["sigma"] = 0, 0.0
    assert find(bench, 100) == "wrench_stale"
    bench.m["arm_tick"] = 0
    assert find(bench, 100) == "arm_stale"
