"""Signals, the force that is explained, and what begins with a phase."""

import numpy as np
import pytest

from armland.mission.decide import SPARE_S, decide, enter, fill_signals, load_expected
from armland.mission.supervisor.table import FAULT
from armland.mission.table.phases import SIGNAL
from armland.rotations import from_rotation_vector, multiply


def signals(bench, elapsed=0.7):
    # No average of the force is taken of a UAV of this size.
    bench.kept["estimate"]["calm"] = bench.e["hinge_force"]
    fill_signals(elapsed, bench.b)
    return {name: bench.kept["decide"]["signals"][0, i] for name, i in SIGNAL.items()}


def test_signals_are_what_their_names_say(bench):
    station, e = bench.told["decide"]["station"][0], bench.e
    e["plate"], e["plate_v"] = station + [0.03, 0.04, 0.0], [0.0, 0.1, 0.0]
    e["r"], e["v"] = station + [0.0, 0.0, -0.02], [0.0, 0.04, 0.08]
    e["quat"][0], e["hinge_force"] = from_rotation_vector(np.array([0.1, 0.0, 0.0])), [3.0, 0.0, -4.0]
    e["thrust"], e["arm_share"], e["ground_share"] = 2.5, 0.3, 0.6
    bench.kept["refer"]["r"], bench.kept["refer"]["progress"] = station, 0.4
    bench.kept["decide"]["grip"], bench.kept["decide"]["retries"] = station, 2
    bench.kept["estimate"]["load"]["contact"], bench.kept["estimate"]["grip"] = 1, [0.003, 0.004, -0.02]
    found = signals(bench)
    expected = {
        "progress": 0.4,
        "elapsed": 0.7,
        "uav_seen": 1.0,
        "uav_error": 0.05,
        "uav_speed": 0.1,
        "offset": 0.05,
        "relative_speed": 0.1,
        "tilt": np.rad2deg(0.1),
        "gap": 0.02,
        "contact": 1.0,
        "pull": 4.0,
        "arm_share": 0.3,
        "ground_share": 0.6,
        "hinge_force": 5.0,
        "retreat": 0.02,
        "arm_error": 0.02,
        "retries": 2.0,
        "rotors": 2.5,
        "image_offset": 0.005,
    }
    for name, value in expected.items():
        assert found[name] == pytest.approx(value), name


def test_spare_thrust_is_what_gusts_have_left_lately_of_what_there_is_in_calm_air(bench):
    told = bench.told["decide"]
    most, weight, tick_s = told["watch"]["thrust_max"][0], told["weight"][0], told["tick_s"][0]
    for asked, left in ((weight, 1.0), (most, 0.0), (0.5 * (most + weight), 0.5)):
        bench.kept["decide"]["pushes"] = bench.kept["act"]["thrust"] = asked
        assert signals(bench)["spare"] == pytest.approx(left)
    bench.kept["decide"]["pushes"], bench.kept["act"]["thrust"] = weight, most
    for _ in range(round(SPARE_S / tick_s)):
        found = signals(bench)["spare"]
    assert found == pytest.approx(np.exp(-1.0), abs=1e-3)


def test_in_wind_the_uavs_error_is_that_to_where_it_was_asked_to_be(bench):
    """Negative control: in calm air it is that to the station."""
    station = bench.told["decide"]["station"][0]
    bench.kept["act"]["asked"] = station + [0.0, 0.0, 0.4]
    bench.e["plate"] = station + [0.0, 0.03, 0.4]
    assert signals(bench)["uav_error"] == pytest.approx(np.hypot(0.4, 0.03))
    bench.told["act"]["uav"]["sight"]["leans"] = 1
    assert signals(bench)["uav_error"] == pytest.approx(0.03)


def test_thrust_left_is_the_distance_to_the_ramps_end(bench):
    bench.enter("carry")
    bench.kept["act"]["thrust"], bench.kept["act"]["hover"] = 3.0, 5.0
    assert signals(bench)["thrust_left"] == pytest.approx(3.0 - bench.row["share"] * 5.0)


@pytest.mark.parametrize(("force", "ready"), [(0.95, 1.0), (0.85, 0.0)])
def test_magnet_is_ready_at_most_of_its_rating(bench, force, ready):
    bench.m["magnet_force"] = force * bench.plan.scenario.magnet.rating_n
    assert signals(bench)["magnet_ready"] == ready


@pytest.mark.parametrize(("blocks", "known"), [(2, 0.0), (3, 1.0)])
def test_bias_is_known_after_three_blocks(bench, blocks, known):
    bench.kept["estimate"]["wrench"]["blocks"] = blocks
    assert signals(bench)["bias_known"] == known


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
def test_force_is_explained_where_arm_cradle_and_rotors_leave_no_doubt(bench, phase, elapsed, height, expected):
    weight = bench.told["decide"]["weight"][0]
    bench.e["thrust"], bench.e["r"][0, 2] = 0.5 * weight, height
    force = load_expected(bench.enter(phase), elapsed, bench.e[0], weight, weight, 1.0, bench.told["decide"][0])
    if expected is None:
        assert np.isnan(force)
    else:
        assert force == pytest.approx(expected * weight)


def test_while_the_hinge_is_freed_the_thrust_that_was_asked_for_explains_the_force(cradle_bench):
    bench, weight = cradle_bench, cradle_bench.told["decide"]["weight"][0]
    bench.e["thrust"] = 0.8 * weight
    row = bench.enter("hand_back")
    # The command that carries the weight is being found out: it says nothing.
    assert load_expected(row, 0.1, bench.e[0], 1.0, weight, 1.0, bench.told["decide"][0]) == pytest.approx(0.2 * weight)


def test_capture_begins_without_a_disturbance_and_with_the_arms_own_motion(bench):
    bench.enter("close")
    bench.kept["estimate"]["observer"]["force"], bench.kept["estimate"]["observer"]["begun"] = 1.0, 1
    bench.kept["act"]["force"], bench.kept["refer"]["r"], bench.e["r"], bench.e["v"] = 2.0, 0.5, 0.6, 0.1
    enter(bench.plan.number("capture"), 1000, bench.b)
    np.testing.assert_array_equal(bench.kept["estimate"]["observer"]["force"], 0.0)
    np.testing.assert_array_equal(bench.kept["act"]["force"], 0.0)
    assert bench.kept["estimate"]["observer"]["begun"][0] == 0
    np.testing.assert_array_equal([bench.kept["refer"]["r0"][0], bench.kept["refer"]["v0"][0]], [[0.6] * 3, [0.1] * 3])


def test_retreat_is_measured_from_where_the_magnet_was_switched_off(bench):
    bench.enter("unload")
    bench.kept["act"]["magnet"], bench.e["r"] = 1, [0.6, 0.1, 0.7]
    enter(bench.plan.number("release"), 1000, bench.b)
    np.testing.assert_array_equal(bench.kept["decide"]["grip"][0], [0.6, 0.1, 0.7])


def test_missed_capture_counts_as_a_retry_and_guards_count_anew(bench):
    bench.enter("close")
    bench.kept["decide"]["held_for"] = 7
    enter(bench.plan.number("miss"), 1000, bench.b)
    assert bench.kept["decide"]["retries"][0] == 1
    assert not bench.kept["decide"]["held_for"].any()


def test_fault_goes_before_a_guard_and_is_remembered(bench):
    bench.enter("guide")
    bench.kept["decide"]["begin"], bench.m["arm_tick"] = 0, 900
    decide(bench.b)
    assert bench.plan.names[bench.tick.mission["phase"][0]] == "braked_free"
    assert bench.tick.mission["fault"][0] == FAULT["arm_stale"]
    assert bench.tick.mission["elapsed"][0] == 0.0


def test_phase_that_takes_too_long_ends_as_its_row_says(bench):
    bench.enter("guide")
    bench.e["plate"] = bench.told["decide"]["station"][0] + 1.0
    bench.kept["decide"]["begin"] = 1000 - round(1000 * bench.row["timeout"]) - 1
    decide(bench.b)
    assert bench.plan.names[bench.tick.mission["phase"][0]] == "abort"
    assert bench.tick.mission["fault"][0] == 0
    assert bench.tick.mission["unmet"][0] >> SIGNAL["uav_error"] & 1
    # What it waited for says nothing of a phase that was left for another reason.
    bench.enter("guide")
    bench.m["arm_tick"] = 900
    decide(bench.b)
    assert bench.tick.mission["unmet"][0] == 0


@pytest.mark.parametrize(("phase", "held"), [("guide", 0), ("carry", 1), ("holding", 1), ("balancing", 0), ("done", 0)])
def test_uav_hangs_on_the_arm_in_the_phases_that_hold_it_and_the_ends_that_keep_it(bench, phase, held):
    bench.enter(phase)
    bench.kept["decide"]["begin"] = 1000
    decide(bench.b)
    assert bench.kept["decide"]["held"][0] == held


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_each_axis_counts_in_the_signals_of_distance_and_speed(bench, axis):
    """Plate, arm, reference and grip are apart along one axis at a time, and move along it."""
    station, e, way = bench.told["decide"]["station"][0], bench.e, np.eye(3)[axis]
    e["plate"], e["plate_v"] = station + 0.04 * way, 0.3 * way
    e["r"], e["v"] = station + 0.01 * way, 0.1 * way
    bench.kept["refer"]["r"], bench.kept["decide"]["grip"] = station + 0.06 * way, station - 0.02 * way
    e["hinge_force"] = -7.0 * way
    found = signals(bench)
    assert found["uav_error"] == pytest.approx(0.04)
    assert found["uav_speed"] == pytest.approx(0.3)
    assert found["relative_speed"] == pytest.approx(0.2)
    assert found["arm_error"] == pytest.approx(0.05)
    assert found["retreat"] == pytest.approx(0.03)
    assert found["hinge_force"] == pytest.approx(7.0)
    assert found["offset"] == pytest.approx(0.03 if axis < 2 else 0.0, abs=1e-12)
    assert found["gap"] == pytest.approx(0.03 if axis == 2 else 0.0, abs=1e-12)
    assert found["pull"] == pytest.approx(7.0 if axis == 2 else 0.0, abs=1e-12)


@pytest.mark.parametrize(
    ("turn", "tilt"), [((0.2, 0, 0), 0.2), ((0, -0.3, 0), 0.3), ((0, 0, 1.0), 0.0), ((3.0, 0, 0), 3.0)]
)
def test_tilt_is_the_angle_of_the_bodys_axis_to_the_vertical(bench, turn, tilt):
    bench.e["quat"][0] = from_rotation_vector(np.array(turn, float))
    assert signals(bench)["tilt"] == pytest.approx(np.rad2deg(tilt), abs=1e-4)


def test_magnet_and_rotors_tell_of_themselves(bench):
    bench.m["magnet_fault"] = 1
    assert signals(bench)["magnet_fault"] == 1.0
    bench.kept["act"]["thrust"], bench.kept["act"]["hover"] = 1.0, 5.0
    bench.enter("carry")
    # Below the end of its ramp as well as above it.
    assert signals(bench)["thrust_left"] == pytest.approx(bench.row["share"] * 5.0 - 1.0)


@pytest.mark.parametrize(
    ("phase", "magnet", "elapsed", "end"),
    [
        ("carry", 1, 0.2, "holding"),
        ("carry", 1, 0.1, "carry"),
        ("carry", 0, 0.2, "carry"),
        ("self_test", 0, 0.2, "refused"),
        ("self_test", 0, 0.05, "refused"),
    ],
)
def test_coil_is_looked_at_once_it_has_had_the_time_to_carry_its_current_or_is_tested(
    bench, phase, magnet, elapsed, end
):
    bench.enter(phase)
    kept = bench.kept["decide"]
    kept["begin"], bench.kept["act"]["magnet"], bench.m["magnet_fault"] = 1000 - round(1000 * elapsed), magnet, 1
    bench.e["r"][0, 2] = 0.8
    for _ in range(25):
        if not bench.row["final"]:
            decide(bench.b)
    assert bench.plan.names[int(kept["phase"][0])] == end


def test_time_in_the_phase_is_told_in_seconds(bench):
    bench.enter("guide")
    bench.kept["decide"]["begin"] = 750
    bench.e["plate"] = bench.told["decide"]["station"][0] + 1.0
    decide(bench.b)
    assert bench.tick.mission["elapsed"][0] == pytest.approx(0.25)
    assert bench.tick.mission["tick"][0] == 1000
    assert bench.kept["decide"]["signals"][0, SIGNAL["elapsed"]] == pytest.approx(0.25)


def test_magnet_that_stays_as_it_is_leaves_the_mark_of_the_last_release(bench):
    bench.kept["decide"]["grip"], bench.e["r"] = 9.0, 0.5
    bench.enter("guide")
    enter(bench.plan.number("approach"), 1000, bench.b)
    np.testing.assert_array_equal(bench.kept["decide"]["grip"], 9.0)
    bench.kept["act"]["magnet"] = 1
    enter(bench.plan.number("carry"), 1000, bench.b)
    np.testing.assert_array_equal(bench.kept["decide"]["grip"], 9.0)


def test_disturbance_is_forgotten_only_where_the_uav_is_caught(bench):
    observer = bench.kept["estimate"]["observer"]
    for before, after, kept in (("guide", "approach", True), ("hand_over", "carry", True), ("close", "capture", False)):
        bench.enter(before)
        observer["force"] = 1.0
        enter(bench.plan.number(after), 1000, bench.b)
        assert observer["force"].all() == kept, before


def test_phase_that_is_no_miss_is_no_retry(bench):
    bench.enter("guide")
    enter(bench.plan.number("approach"), 1234, bench.b)
    assert bench.kept["decide"]["retries"][0] == 0
    assert bench.kept["decide"]["begin"][0] == 1234


@pytest.mark.parametrize(("phase", "elapsed"), [("unload", 0.5), ("withdraw", 1.0), ("guide", 1.0)])
def test_force_counts_as_unexplained_only_after_the_whole_of_its_time(bench, phase, elapsed):
    row, p = bench.enter(phase), bench.told["decide"][0]
    weight = p["weight"]
    assert np.isnan(load_expected(row, elapsed - 0.01, bench.e[0], weight, weight, 1.0, p))
    assert load_expected(row, elapsed + 0.01, bench.e[0], weight, weight, 1.0, p) == 0.0


def test_what_the_rotors_leave_is_by_the_command_that_carries_the_weight(bench):
    """A command of 4 N is said to carry 5 N: at 1 N a quarter is carried; where nothing is known of it, all is."""
    row, p = bench.enter("carry"), bench.told["decide"][0]
    bench.e["thrust"], bench.e["r"][0, 2] = 1.0, 0.8
    assert load_expected(row, 0.1, bench.e[0], 4.0, 5.0, 1.0, p) == pytest.approx(0.75 * 5.0)
    bench.e["thrust"] = 0.0
    assert load_expected(row, 0.1, bench.e[0], 0.0, 5.0, 1.0, p) == pytest.approx(5.0)


@pytest.mark.parametrize(("before", "after", "anew"), [("miss", "guide", True), ("guide", "approach", False)])
def test_zero_of_the_force_sensor_is_learnt_anew_after_a_contact(bench, before, after, anew):
    bench.enter(before)
    bench.kept["estimate"]["wrench"]["blocks"] = 5
    enter(bench.plan.number(after), 1000, bench.b)
    assert bench.kept["estimate"]["wrench"]["blocks"][0] == (0 if anew else 5)


@pytest.mark.parametrize("asked", [(0.0, 0.0, 0.0), (0.1, 0.0, 0.5)])
def test_lean_is_the_angle_to_the_attitude_that_was_asked_for(bench, asked):
    """Of the z axes alone: a heading is no lean, and a UAV that holds against the wind as it shall leans by nothing."""
    q_d = from_rotation_vector(np.array(asked))
    bench.kept["act"]["q_d"] = q_d
    bench.e["quat"][0] = multiply(q_d, from_rotation_vector(np.array([0.0, 0.0, 0.7])))
    assert signals(bench)["lean"] == pytest.approx(0.0, abs=1e-5)
    bench.e["quat"][0] = multiply(q_d, from_rotation_vector(np.array([0.0, np.deg2rad(4.0), 0.0])))
    assert signals(bench)["lean"] == pytest.approx(4.0)
