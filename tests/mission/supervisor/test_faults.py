"""Signs of faults with their debouncing, on a healthy moment in which one thing goes wrong."""

import numpy as np
import pytest

from armland.mission.reference.moves import BACK_OFF, HOLD, MOVE, YIELD
from armland.mission.supervisor.faults import AUTONOMOUS, BALANCE, RAMP, STATION, find_fault
from armland.mission.supervisor.table import FAULT, FAULTS
from armland.rotations import from_rotation_vector

ALL = "carry"
"""Phase whose fault row the tests replace by one in which all matters."""

LONG = 310
"""Ticks after which the sign that must be seen for longest, 0.3 s, has been seen for long enough."""


@pytest.fixture
def bench(bench):
    """The arm is where its reference is, and the sensor's nod has weighed the tool."""
    bench.kept["refer"]["r"] = bench.e["r"]
    bench.kept["estimate"]["nod"]["gain"] = bench.kept["estimate"]["nod"]["followed"] = 1.0
    bench.kept["act"]["hover"], bench.kept["act"]["thrust"] = weight(bench), 0.5 * weight(bench)
    # What the sensor reads of the tool at rest.
    bench.m["wrench"][0, 2] = tool(bench)
    bench.kept["estimate"]["arrived"] = 1000
    # Time stands still here, so each call is a step of the joints' observer.
    bench.board["arm"]["coriolis"], bench.told["estimate"]["momentum"]["period"] = 0.0, 1
    return bench


def tool(bench):
    """Its weight beyond the sensor, N."""
    return float(bench.told["estimate"]["wrench"]["mass"][0] * bench.told["act"]["uav"]["gravity"][0])


def weight(bench):
    """Of all that flies, N."""
    return float(bench.kept["estimate"]["weight"][0])


def bear(bench, pushed=0.0):
    """Let the motors bear the arm's weight, what the sensor feels, and `pushed`, N·m, at the second joint."""
    arm = bench.board["arm"]
    bench.kept["limit"]["tau"] = arm["gravity"] + bench.e["hinge_force"] @ arm["jacobian"][0, :3]
    bench.kept["limit"]["tau"][0, 1] += pushed


def find(bench, ticks=1, matters=None, expected=np.nan, magnet_on=False, force_max=1e9, held=1, uav=None, arm=HOLD):
    """Name of the fault that is found in the last of some ticks."""
    bench.kept["decide"]["held"] = held
    row = bench.enter(ALL)
    row["force"], row["arm"] = force_max, arm
    if uav is not None:
        row["uav"] = uav
    phase = bench.plan.number(ALL)
    bench.board["table"]["faults"][0, :, phase] = -1
    for fault in FAULTS[1:] if matters is None else matters:
        bench.board["table"]["faults"][0, FAULT[fault], phase] = 0
    # No average of the force is taken of a UAV of this size.
    bench.kept["estimate"]["calm"] = bench.e["hinge_force"]
    if not bench.kept["limit"]["tau"].any():
        bear(bench)
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
        case "encoder_frozen":
            bench.kept["estimate"]["same"][0, 3] = 2
        case "power_lost":
            bench.m["uav_tick"], bench.e["hinge_force"][0, 2] = 700, weight(bench)
        case "camera_leap":
            bench.kept["estimate"]["filter"]["leapt"] = 990
        case "camera_noise":
            bench.kept["estimate"]["filter"]["noise"] = 30.0
        case "wrench_wrong":
            bench.kept["estimate"]["nod"]["count"], bench.kept["estimate"]["nod"]["gain"][0, 1] = 460, 0.0
        case "magnet_stuck":
            bench.kept["decide"]["seen"]["off"], bench.kept["decide"]["grip"] = 500, bench.e["r"] + [0.0, 0.0, 0.003]
            bench.e["hinge_force"] = [-20.0, 0.0, 0.0]
            return {"arm": BACK_OFF}
        case "link_late":
            bench.e["uplink"], bench.e["downlink"] = 0.15, 0.1
        case "thrust_short":
            kept = bench.kept["decide"]
            kept["seen"]["off"], kept["seen"]["carried"], kept["retreat"] = 500, 1, 0.12
            bench.e["plate"], bench.e["plate_age"], bench.e["thrust"] = bench.e["r"], 0.05, weight(bench)
            bench.e["hinge_force"][0, 2] = kept["seen"]["short"] = 0.2 * weight(bench)
            return {"arm": MOVE, "held": 0}
        case "arm_blocked":
            bench.kept["refer"]["r"][0, 1] += 0.04
        case "thrust_lost":
            bench.kept["act"]["thrust"], bench.e["plate_v"] = watch["thrust_max"][0], [0.0, 0.0, -0.2]
            return {"uav": STATION, "held": 0}
        case "arm_stale":
            bench.m["arm_tick"] = 990
        case "uav_silent":
            bench.m["uav_tick"] = 700
        case "camera_stale":
            bench.e["plate_age"] = 1.01 * watch["camera_age"][0]
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
            bench.m["uav_weak"] = 1
        case "uav_tilt":
            bench.e["quat"][0] = from_rotation_vector(np.array([0.6, 0.0, 0.0]))
            return {"held": 0}
        case "slip":
            bench.kept["estimate"]["grip_far"] = 3
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
    # A UAV without power is silent as well.
    both = ("power_lost", "uav_silent") if fault == "power_lost" else (fault,)
    matters = [f for f in FAULTS[1:] if f not in both]
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
    assert find(bench, debounce(bench, "uav_silent")) == "uav_silent"


def test_plate_of_a_silent_uav_is_left_where_it_is(bench):
    bench.kept["estimate"]["grip_far"], bench.m["uav_heard"] = 3, 700
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
        (149, 0.2, 2.5, "none"),
        (50, 0.2, 2.5, "none"),
    ],
)
def test_load_that_is_gone_is_a_slip_only_where_no_image_says_otherwise(bench, age, force, expected, found):
    bench.kept["estimate"]["grip_tick"], bench.e["hinge_force"][0, 2] = 1000 - age, force
    assert find(bench, 100, expected=expected) == found


@pytest.mark.parametrize(("far", "slides"), [(1, 0), (0, 1)])
def test_one_image_that_is_far_off_is_a_slip_where_the_load_is_gone_with_it(bench, far, slides):
    bench.kept["estimate"]["grip_far"], bench.kept["estimate"]["grip_slides"] = far, slides
    bench.kept["estimate"]["grip_tick"], bench.e["hinge_force"] = 950, 0.0
    assert find(bench, 100, ["slip"], expected=2.5) == "slip"
    bench.e["hinge_force"][0, 2] = 2.4
    assert find(bench, 100, ["slip"], expected=2.5) == "none"


def test_load_is_missed_before_the_ramp_of_the_rotors_stops_at_its_slack(bench):
    missed, slack = bench.told["decide"]["watch"]["load_missed"][0], bench.told["act"]["uav"]["force_slack"][0]
    assert missed < 0.7 * slack
    bench.kept["estimate"]["grip_tick"], bench.e["hinge_force"] = 0, 0.0
    assert find(bench, 100, ["slip"], expected=1.05 * missed) == "slip"
    assert find(bench, 100, ["slip"], expected=0.95 * missed) == "none"


def test_joint_beyond_its_speed_is_near_its_limit(bench):
    bench.kept["limit"]["speed_ratio"] = 0.95
    assert find(bench, 100) == "near_limit"


@pytest.mark.parametrize("images", [1, 2])
def test_one_or_two_images_that_are_far_off_are_no_slip(bench, images):
    bench.kept["estimate"]["grip_far"] = images
    assert find(bench, LONG) == "none"


@pytest.mark.parametrize(("images", "found"), [(0, "rotor_lost"), (1, "none")])
def test_uav_whose_plate_slides_off_has_lost_no_rotor(bench, images, found):
    bench.m["uav_weak"], bench.kept["estimate"]["grip_far"] = 1, images
    assert find(bench, 10) == found


def test_lean_of_a_held_uav_alone_is_no_lost_rotor(bench):
    """A gust, a blow and a push make a healthy UAV lean and turn; its motors say that nothing is lost."""
    bench.e["quat"][0], bench.e["omega"] = from_rotation_vector(np.array([0.3, 0.0, 0.0])), [2.0, -1.0, 0.0]
    assert find(bench, LONG) == "none"
    bench.m["uav_weak"] = 1
    assert find(bench, 10) == "rotor_lost"


def test_silent_uav_cannot_say_that_a_rotor_is_weak(bench):
    bench.m["uav_weak"], bench.m["uav_tick"] = 1, 700
    assert find(bench, LONG, ["rotor_lost"]) == "none"


@pytest.mark.parametrize(
    ("share", "thrust", "silent", "found"),
    [
        (0.5, 0.5, True, "uav_silent"),
        (0.8, 0.5, True, "uav_silent"),
        (0.9, 0.5, True, "power_lost"),
        (1.0, 0.5, True, "power_lost"),
        # Where the rotors should carry nothing, the whole weight at the hinge says nothing of them.
        (1.0, 0.2, True, "uav_silent"),
        (1.0, 0.5, False, "none"),
    ],
)
def test_silent_uav_whose_rotors_run_has_its_power(bench, share, thrust, silent, found):
    """What the hinge bears tells the two apart: half the weight where the rotors carry the other half, all of it where they stand."""
    bench.e["hinge_force"][0, 2] = share * weight(bench)
    bench.kept["act"]["thrust"] = thrust * weight(bench)
    if silent:
        bench.m["uav_tick"] = 700
    assert find(bench, debounce(bench, "uav_silent")) == found


@pytest.mark.parametrize(
    ("sinks", "age", "seen", "found"),
    [
        (0.7, 0.02, 1, "power_lost"),
        (0.5, 0.02, 1, "uav_silent"),
        # What was seen too long ago, or never, falls by prediction only.
        (0.7, 0.3, 1, "uav_silent"),
        (0.7, 0.02, 0, "uav_silent"),
    ],
)
def test_silent_uav_that_falls_in_flight_has_lost_its_power(bench, sinks, age, seen, found):
    bench.e["plate_v"], bench.e["plate_age"], bench.kept["estimate"]["seen"] = [0.0, 0.0, -sinks], age, seen
    bench.m["uav_tick"] = 700
    assert find(bench, debounce(bench, "uav_silent"), held=0) == found


def test_power_that_is_lost_is_found_before_the_silence_that_comes_with_it(bench):
    """Else the UAV would count as one that still flies by itself."""
    assert debounce(bench, "power_lost") < debounce(bench, "uav_silent")
    arguments = provoke(bench, "power_lost")
    found = [find(bench, **arguments) for _ in range(LONG)]
    assert next(f for f in found if f != "none") == "power_lost"


@pytest.mark.parametrize(("ago", "found"), [(0, "camera_leap"), (199, "camera_leap"), (201, "none")])
def test_leap_of_the_marker_counts_for_its_time(bench, ago, found):
    bench.kept["estimate"]["filter"]["leapt"] = 1000 - ago
    assert find(bench) == found


def test_marker_that_never_leapt_does_not_at_the_begin(bench):
    for name in ("tick", "arm_tick", "wrench_tick", "uav_tick", "uav_heard"):
        bench.m[name] = 10
    assert find(bench) == "none"


@pytest.mark.parametrize(("deviation", "found"), [(2.0, "none"), (4.9, "none"), (5.1, "camera_noise")])
def test_camera_may_err_by_up_to_five_times_what_it_claims(bench, deviation, found):
    bench.kept["estimate"]["filter"]["noise"] = deviation**2
    assert find(bench, LONG) == found


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize(
    ("gain", "found"),
    [
        (1.0, "none"),
        (0.9, "none"),
        (1.1, "none"),
        (0.0, "wrench_wrong"),
        (-1.0, "wrench_wrong"),
        (0.5, "wrench_wrong"),
        (2.0, "wrench_wrong"),
        (np.nan, "wrench_wrong"),
    ],
)
def test_force_sensor_must_feel_the_tool_as_it_is_along_every_axis(bench, axis, gain, found):
    nod = bench.kept["estimate"]["nod"]
    nod["count"], nod["gain"][0, axis] = 460, gain
    assert find(bench, LONG) == found
    # Before the nod has weighed it, nothing is said.
    nod["count"], bench.kept["decide"]["seen"]["counts"] = 440, 0
    assert find(bench, LONG) == "none"


@pytest.mark.parametrize(("followed", "found"), [(1.0, "wrench_wrong"), (0.3, "arm_blocked"), (1.5, "arm_blocked")])
def test_sensor_is_not_blamed_for_a_tool_that_the_arm_did_not_move(bench, followed, found):
    nod = bench.kept["estimate"]["nod"]
    nod["count"], nod["gain"][0], nod["followed"][0, 1] = 460, 0.3, followed
    assert find(bench, LONG) == found
    # A sensor that feels the tool as it should is good enough for any arm.
    nod["gain"][0], bench.kept["decide"]["seen"]["counts"] = 1.0, 0
    assert find(bench, LONG) == "none"


@pytest.mark.parametrize(
    ("change", "found"),
    [
        ({}, "magnet_stuck"),
        # A residual pull that healthy plates come off with, a way that is too short, a current that is not yet gone.
        ({"force": 15.0}, "none"),
        # One that presses the arm down lies on it.
        ({"up": -1.0}, "none"),
        ({"drawn": 0.001}, "none"),
        ({"off": 850}, "none"),
        ({"off": 0}, "none"),
        ({"on": 1}, "none"),
        ({"arm": HOLD}, "none"),
    ],
)
def test_plate_sticks_where_the_arm_draws_back_and_a_force_stays(bench, change, found):
    kept = bench.kept["decide"]
    bench.kept["act"]["magnet"], kept["seen"]["off"] = change.get("on", 0), change.get("off", 700)
    kept["grip"] = bench.e["r"] + np.array([0.0, 0.0, change.get("drawn", 0.003)])
    bench.e["hinge_force"] = change.get("force", 20.0) / 3.0 * np.array([1.0, -2.0, -2.0 * change.get("up", 1.0)])
    assert find(bench, 10, arm=change.get("arm", BACK_OFF)) == found


@pytest.mark.parametrize(
    ("pull", "off", "found"),
    [(-150.0, 700, "magnet_stuck"), (150.0, 700, "overload"), (-150.0, 0, "overload")],
)
def test_force_that_holds_the_arm_back_from_a_magnet_that_is_off_is_a_plate_that_sticks(bench, pull, off, found):
    """Before the arm has come far, where any other force beyond its bound is an overload."""
    kept = bench.kept["decide"]
    bench.kept["act"]["magnet"], kept["seen"]["off"] = 0, off
    kept["grip"] = bench.e["r"] + np.array([0.0, 0.0, 0.001])
    bench.e["hinge_force"] = [0.0, 0.0, pull]
    assert find(bench, 10, arm=BACK_OFF) == found


@pytest.mark.parametrize(
    ("retreat", "gap", "age", "carried", "found"),
    [
        (0.07, 0.005, 0.1, 1, "magnet_stuck"),
        (0.05, 0.005, 0.1, 1, "none"),
        # A healthy UAV stays where it is, or rises.
        (0.07, 0.05, 0.1, 1, "none"),
        (0.07, 0.005, 0.3, 1, "none"),
        # After a capture that was missed a weak UAV may lie on the arm.
        (0.07, 0.005, 0.1, 0, "none"),
    ],
)
def test_plate_sticks_where_it_follows_an_arm_that_goes_down(bench, retreat, gap, age, carried, found):
    """The pull that a flying UAV can bear says nothing: it is too light."""
    kept = bench.kept["decide"]
    bench.kept["act"]["magnet"], kept["seen"]["off"], kept["retreat"] = 0, 700, retreat
    bench.e["plate"], bench.e["plate_age"] = bench.e["r"] + [0.0, 0.0, gap], age
    kept["seen"]["carried"] = carried
    assert find(bench, 10, held=0, arm=MOVE) == found


def test_marker_of_a_uav_that_falls_silently_has_not_leapt(bench):
    bench.kept["estimate"]["filter"]["leapt"], bench.m["uav_tick"] = 990, 700
    assert find(bench, debounce(bench, "uav_silent"), held=0) == "uav_silent"


@pytest.mark.parametrize(("apart", "found"), [(0.02, "none"), (0.04, "arm_blocked")])
def test_arm_far_from_its_reference_is_blocked_in_any_direction(bench, apart, found):
    bench.kept["refer"]["r"] = bench.e["r"] + apart / 3.0 * np.array([2.0, -1.0, 2.0])
    assert find(bench, LONG, ["arm_blocked"]) == found


@pytest.mark.parametrize(("pushed", "found"), [(5.0, "none"), (40.0, "arm_blocked")])
def test_arm_whose_joints_feel_what_nothing_explains_is_blocked(bench, pushed, found):
    bear(bench, pushed)
    assert find(bench, LONG, ["arm_blocked"]) == found


@pytest.mark.parametrize(
    ("share", "sinks", "uav", "found"),
    [
        (1.2, 0.6, STATION, "thrust_lost"),
        # Told less than what carries it, or sinking slowly, it has lost nothing.
        (1.05, 0.6, STATION, "none"),
        (1.2, 0.4, STATION, "none"),
        # One that hovers by itself does not plunge.
        (1.2, 0.6, AUTONOMOUS, "thrust_lost"),
        (1.2, 0.4, AUTONOMOUS, "none"),
    ],
)
def test_uav_that_plunges_with_more_than_its_hover_thrust_has_lost_thrust(bench, share, sinks, uav, found):
    bench.kept["act"]["thrust"], bench.e["plate_v"] = share * weight(bench), [0.0, 0.0, -sinks]
    assert find(bench, LONG, held=0, uav=uav) == found


@pytest.mark.parametrize(("share", "trimmed", "found"), [(1.1, 5, "thrust_lost"), (0.9, 5, "none"), (1.1, 0, "none")])
def test_uav_that_hovers_by_itself_near_all_it_has_is_not_taken_over(bench, share, trimmed, found):
    """Once it has said what its own hover needs."""
    bench.kept["act"]["hover"] = share * bench.told["decide"]["watch"]["hover_max"][0]
    bench.kept["act"]["trimmed"] = trimmed
    assert find(bench, LONG, ["thrust_lost"], held=0, uav=AUTONOMOUS) == found


@pytest.mark.parametrize(("left", "found"), [(0.5, "thrust_lost"), (0.0, "none"), (-0.5, "none")])
def test_uav_is_not_let_go_whose_rotors_would_need_all_they_have_for_what_the_arm_still_carries(bench, left, found):
    bench.kept["act"]["hover"] = bench.told["decide"]["watch"]["hover_max"][0] - 0.2
    bench.e["hinge_force"] = [0.0, 0.0, left]
    # Before, the arm carries a share on purpose.
    assert find(bench, LONG, ["thrust_lost"], uav=RAMP) == "none"
    assert find(bench, LONG, ["thrust_lost"], uav=BALANCE) == found


@pytest.mark.parametrize("gust", [0.0, 1.0])
def test_uav_that_hangs_on_the_arm_may_need_all_its_thrust_for_as_long_as_a_gust_lasts_and_no_longer(bench, gust):
    """Negative control: where no wind is expected it is found at once, and so is one that flies."""
    watch = bench.told["decide"]["watch"]
    watch["gust"], bench.kept["act"]["hover"] = gust, watch["hover_max"][0] + 0.1
    allowed = round(gust / watch["tick_s"][0])
    assert find(bench, allowed + debounce(bench, "thrust_lost") - 1, ["thrust_lost"], uav=BALANCE) == "none"
    # A lull gives back as much as it lasts.
    bench.kept["act"]["hover"] -= 0.2
    assert find(bench, 100, ["thrust_lost"], uav=BALANCE) == "none"
    bench.kept["act"]["hover"] += 0.2
    assert (
        find(bench, min(100, allowed) + debounce(bench, "thrust_lost") + 1, ["thrust_lost"], uav=BALANCE)
        == "thrust_lost"
    )
    bench.kept["act"]["trimmed"] = 1
    assert find(bench, LONG, ["thrust_lost"], held=0, uav=AUTONOMOUS) == "thrust_lost"


def freed_of_force(bench, share=1.0, drifts=0.0):
    """First fault found while the hinge is freed of force: 0.3 s on the rotors give only a share of what they are asked for, or the
    sensor drifts, N/s."""
    W, thrust, rate = weight(bench), 0.7 * weight(bench), float(bench.told["act"]["uav"]["balance_rate"][0])
    for k in range(4000):
        given, drift = (share, 0.001 * drifts * (k - 300)) if k > 300 else (1.0, 0.0)
        force = W - given * thrust + drift
        bench.kept["act"]["hover"] = bench.e["thrust"] = thrust
        bench.e["hinge_force"] = [0.0, 0.0, force]
        found = find(bench, 1, ["wrench_drift", "thrust_lost"], expected=W - thrust, uav=BALANCE if k else RAMP)
        if found != "none":
            return found
        thrust += 0.001 * rate * force
    return "none"


@pytest.mark.parametrize("drifts", [0.8, 1.0, 3.0, 12.0])
def test_force_that_does_not_fall_as_the_thrust_rises_is_a_sensors_drift(bench, drifts):
    assert freed_of_force(bench, drifts=drifts) == "wrench_drift"


@pytest.mark.parametrize(("share", "found"), [(1.0, "none"), (0.9, "none"), (0.7, "thrust_lost"), (0.6, "thrust_lost")])
def test_force_that_leaps_and_falls_as_the_thrust_rises_is_a_loss_of_thrust(bench, share, found):
    assert freed_of_force(bench, share) == found


@pytest.mark.parametrize(("samples", "found"), [(1, "none"), (2, "encoder_frozen")])
def test_encoder_that_reads_the_same_once_is_not_frozen(bench, samples, found):
    bench.kept["estimate"]["same"][0, 6] = samples
    assert find(bench, LONG) == found


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


@pytest.mark.parametrize(("seeks", "limit"), [(0, "camera_age"), (1, "search_age")])
def test_uav_is_looked_for_longer_where_the_phase_says_so(bench, seeks, limit):
    bench.enter(ALL)["seeks"] = seeks
    bench.e["plate_age"] = 0.99 * bench.told["decide"]["watch"][limit][0]
    assert find(bench, 10) == "none"
    bench.e["plate_age"] = 1.01 * bench.told["decide"]["watch"][limit][0]
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
    assert find(bench, debounce(bench, fault)) == fault


def test_weak_rotor_matters_where_the_arm_holds_the_uav(bench):
    bench.m["uav_weak"] = 1
    assert find(bench, 10, held=0) == "none"
    assert find(bench, 10, held=1) == "rotor_lost"


def test_graver_fault_goes_before_the_other(bench):
    bench.m["wrench_tick"], bench.kept["estimate"]["sigma"] = 0, 0.0
    assert find(bench, 100) == "wrench_stale"
    bench.m["arm_tick"] = 0
    assert find(bench, 100) == "arm_stale"


@pytest.mark.parametrize(
    ("slides", "age", "force", "found"),
    [
        (2, 200, 0.0, "slip"),
        (2, 200, 0.7, "none"),  # what is felt says that it is there
        (1, 200, 0.0, "none"),  # a single image errs now and then
        (2, 100, 0.0, "none"),  # the next image will say so
    ],
)
def test_plate_that_slid_out_of_view_has_slipped(bench, slides, age, force, found):
    """Where the rotors still carry the weight, a load that is not felt alone says nothing."""
    known = bench.kept["estimate"]
    known["grip_slides"], known["grip_tick"], bench.e["hinge_force"][0, 2] = slides, 1000 - age, force
    assert find(bench, 100, expected=0.2) == found


@pytest.mark.parametrize(
    ("uplink", "downlink", "late", "arrived", "heard", "found"),
    [
        (0.11, 0.1, 100, 1000, 1000, "link_late"),
        (0.09, 0.09, 90, 1000, 1000, "none"),
        (0.05, 0.27, 270, 1000, 1000, "link_late"),
        # Samples as old that do not come any more, or say that nothing was heard.
        (0.05, 0.27, 270, 900, 1000, "uav_silent"),
        (0.05, 0.27, 270, 1000, 400, "uav_silent"),
    ],
)
def test_link_that_is_slow_is_told_from_one_that_is_dead(bench, uplink, downlink, late, arrived, heard, found):
    bench.e["uplink"], bench.e["downlink"], bench.m["uav_tick"] = uplink, downlink, 1000 - late
    bench.kept["estimate"]["arrived"], bench.m["uav_heard"] = arrived, min(heard, 1000 - late)
    assert find(bench, debounce(bench, "link_late")) == found


@pytest.mark.parametrize("gain", [0.0, -1.0, 0.5, 2.0])
@pytest.mark.parametrize(
    ("change", "found"),
    [
        ({}, "wrench_wrong"),
        ({"near": 0.01}, "none"),  # the plate may touch
        ({"sideways": 1.0}, "none"),  # the tool's weight has no part that way
        ({"fast": 0.1}, "none"),  # something drives the arm
        ({"slow": 1.0}, "none"),  # a zero that drifts, not a bridge that breaks
    ],
)
def test_sensor_that_reads_another_tool_at_once_is_wrong(bench, gain, change, found):
    """(g − 1) of the tool's weight, at once, on an arm that follows its reference and touches nothing."""
    bench.e["plate"] = bench.e["r"] + [0.0, 0.0, change.get("near", 0.2)]
    bench.e["v"][0, 0] = change.get("fast", 0.0)
    ticks, rise = debounce(bench, "wrench_wrong") + 2, max(change.get("slow", 0.0), 1e-3)
    for k in range(round(rise / 1e-3) + ticks):
        leap = (gain - 1.0) * tool(bench) * min((k + 1) * 1e-3 / rise, 1.0) * (0.3 if "slow" in change else 1.0)
        bench.e["hinge_force"] = [change.get("sideways", 0.0) * leap, 0.0, leap]
        answer = find(bench, 1, ["wrench_wrong"], held=0, arm=MOVE)
        if answer != "none":
            break
    assert answer == found


@pytest.mark.parametrize(("dies", "found"), [(False, "none"), (True, "wrench_wrong")])
def test_weight_that_has_just_left_the_magnet_is_no_leap_of_the_sensor(bench, dies, found):
    """A heavy UAV lies on the magnet with three tools' weights and rises off it; the arm then draws away from it."""
    for k in range(400):
        bench.e["plate"] = bench.e["r"] + [0.0, 0.0, 0.002 if k < 200 else 0.2]
        bench.e["hinge_force"] = [0.0, 0.0, 3.0 * tool(bench) if k < 190 else -tool(bench) if dies and k > 250 else 0.0]
        answer = find(bench, 1, ["wrench_wrong"], held=0, arm=MOVE)
        if answer != "none":
            break
    assert answer == found


@pytest.mark.parametrize(("stays", "found"), [(False, "none"), (True, "wrench_wrong")])
def test_plate_that_bounces_off_the_arm_leaves_a_sensor_that_reads_right(bench, stays, found):
    """A plate presses with half the tool's weight until it is seen to have left; what stays then is no plate's."""
    for k in range(300):
        bench.e["plate"] = bench.e["r"] + [0.0, 0.0, 0.002 if k < 200 else 0.2]
        # An image that says so comes late: the plate has gone when it is seen to be near.
        pressed = (-0.5 if stays else 0.0) if k >= 200 else 0.5
        bench.e["hinge_force"] = [0.0, 0.0, pressed * tool(bench)]
        answer = find(bench, 1, ["wrench_wrong"], held=0, arm=MOVE)
        if answer != "none":
            break
    assert answer == found


@pytest.mark.parametrize(
    ("reads", "arm", "found"),
    [
        (0.0, HOLD, "wrench_wrong"),
        (0.0, YIELD, "wrench_wrong"),
        (0.2, HOLD, "none"),
        (-2.0, HOLD, "none"),
        (0.0, BACK_OFF, "none"),
    ],
)
def test_sensor_that_reads_nothing_at_all_is_dead(bench, reads, arm, found):
    """Not even the tool; a plate that sticks pulls the arm that draws back through that reading."""
    bench.m["wrench"][0, 2] = bench.kept["estimate"]["wrench"]["bias"][0, 2] = 1.3
    bench.m["wrench"][0, 2] += reads * tool(bench)
    assert find(bench, 2 * LONG, ["wrench_wrong"], arm=arm) == found


@pytest.mark.parametrize(("arm", "found"), [(HOLD, "wrench_wrong"), (YIELD, "none")])
def test_arm_that_presses_as_hard_as_the_tool_weighs_gives_way_to_it_and_is_not_dead(bench, arm, found):
    """0.2 s of a reading that a dead sensor keeps: seen in `test_sensor_that_reads_nothing_at_all_is_dead`."""
    bench.m["wrench"][0, 2] = bench.kept["estimate"]["wrench"]["bias"][0, 2] = 1.3
    assert find(bench, 200, ["wrench_wrong"], arm=arm) == found


@pytest.mark.parametrize(
    ("thrust", "sinks", "known", "found"),
    [
        (1.0, 0.2, 1, "thrust_lost"),
        (0.95, 0.2, 1, "none"),  # what its rotors can still make up for
        (0.95, 0.6, 1, "thrust_lost"),
        (1.0, 0.2, 0, "none"),  # a speed that nobody vouches for
    ],
)
def test_uav_that_sinks_has_lost_thrust_where_it_has_no_more(bench, thrust, sinks, known, found):
    bench.kept["act"]["thrust"] = thrust * bench.told["decide"]["watch"]["thrust_max"][0]
    bench.e["plate_v"], bench.e["plate_valid"] = [0.0, 0.0, -sinks], known
    assert find(bench, LONG, ["thrust_lost"], held=0, uav=STATION) == found


@pytest.mark.parametrize(
    ("loss", "retreat", "found"), [(0.0, 0.07, "magnet_stuck"), (0.25, 0.07, "none"), (0.25, 0.12, "thrust_short")]
)
def test_uav_that_lies_on_the_arm_is_told_from_a_plate_that_sticks(bench, loss, retreat, found):
    """By F = m a + W (1 − f_T/T_h), which a loss makes larger by its share of the thrust; both follow the arm."""
    kept, W = bench.kept["decide"], weight(bench)
    kept["seen"]["off"], kept["seen"]["carried"], kept["retreat"] = 500, 1, retreat
    bench.e["plate"], bench.e["plate_age"], bench.e["thrust"] = bench.e["r"], 0.05, 1.2 * W
    bench.kept["refer"]["a"][0, 2] = -1.5
    mass = bench.told["estimate"]["mass"][0]
    bench.e["hinge_force"][0, 2] = -1.5 * mass + W - 1.2 * W * (1.0 - loss)
    assert find(bench, LONG, ["magnet_stuck", "thrust_short"], held=0, arm=MOVE) == found


@pytest.mark.parametrize(("heaves", "found"), [(0.6, "none"), (0.0, "thrust_lost")])
def test_deck_that_rises_is_no_uav_that_sinks(bench, heaves, found):
    """Seen from the deck both sink alike: one hovers while the hull rises with 0.6 m/s, the other falls towards a hull at rest."""
    bench.board["environment"]["moves"], bench.board["environment"]["base_v"] = 1, [0.0, 0.0, heaves]
    bench.board["environment"]["base_quat"][0, 0] = 1.0
    bench.kept["act"]["thrust"], bench.e["plate_v"] = 1.2 * weight(bench), [0.0, 0.0, -0.6]
    assert find(bench, LONG, held=0, uav=AUTONOMOUS) == found


@pytest.mark.parametrize(
    ("above", "thrust", "images", "found"),
    [(0.08, 2.0, 3, "slip"), (0.02, 2.0, 3, "none"), (0.08, 0.0, 3, "none"), (0.08, 2.0, 2, "none")],
)
def test_uav_that_is_thrown_off_its_cradle_has_left_the_magnet(bench, above, thrust, images, found):
    """One whose plate has only slid aside still stands; one whose rotors stand still cannot fly."""
    row, known = bench.enter(ALL), bench.kept["estimate"]
    row["final"], bench.kept["act"]["thrust"] = 1, thrust
    known["grip_far"], known["grip"][0, 2] = images, above
    assert find(bench, LONG, matters=("slip",), arm=YIELD) == found


@pytest.mark.parametrize(("held", "found"), [(0, "none"), (1, "uav_tilt")])
def test_tilt_of_a_uav_that_flies_is_against_the_vertical_and_not_against_a_deck_that_leans(bench, held, found):
    """The deck leans by 0.2 rad; the UAV, by 0.4 rad in W, leans by 0.6 rad as seen from there."""
    bench.board["environment"]["moves"] = 1
    bench.board["environment"]["base_quat"] = from_rotation_vector(np.array([0.2, 0.0, 0.0]))
    bench.e["quat"][0] = from_rotation_vector(np.array([-0.6, 0.0, 0.0]))
    assert find(bench, 100, held=held) == found
