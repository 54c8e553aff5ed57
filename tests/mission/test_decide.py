"""Signals, the force that is explained, and what begins with a phase."""

import numpy as np
import pytest

from armland.mission.decide import decide, enter, fill_signals, load_expected
from armland.mission.supervisor.table import FAULT
from armland.mission.table.phases import SIGNAL
from armland.rotations import from_rotation_vector


def signals(bench, elapsed=0.7):
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
    bench.kept["estimate"]["load"]["contact"] = 1
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
    }
    for name, value in expected.items():
        assert found[name] == pytest.approx(value), name


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
    force = load_expected(bench.enter(phase), elapsed, bench.e[0], bench.told["decide"][0], weight)
    if expected is None:
        assert np.isnan(force)
    else:
        assert force == pytest.approx(expected * weight)


def test_while_the_hinge_is_freed_the_thrust_that_was_asked_for_explains_the_force(cradle_bench):
    bench, weight = cradle_bench, cradle_bench.told["decide"]["weight"][0]
    bench.e["thrust"] = 0.8 * weight
    row = bench.enter("hand_back")
    # The command that carries the weight is being found out: it says nothing.
    assert load_expected(row, 0.1, bench.e[0], bench.told["decide"][0], 1.0) == pytest.approx(0.2 * weight)


def test_capture_begins_without_a_disturbance_and_with_the_arms_own_motion(bench):
    bench.enter("close")
    bench.kept["estimate"]["observer"]["force"], bench.kept["estimate"]["observer"]["begun"] = 1.0, 1
    bench.kept["act"]["force"], bench.kept["refer"]["r"], bench.e["r"], bench.e["v"] = 2.0, 0.5, 0.6, 0.1
    enter(bench.plan.number("capture"), 1000, bench.b)
    np.testing.assert_array_equal(bench.kept["estimate"]["observer"]["force"], 0.0)
    np.testing.assert_array_equal(bench.kept["act"]["force"], 0.0)
    assert bench.kept["estimate"]["observer"]["begun"][0] == 0
    assert bench.kept["decide"]["seen"]["caught"][0] == 1000
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


@pytest.mark.parametrize(("phase", "held"), [("guide", 0), ("carry", 1), ("holding", 1), ("balancing", 0), ("done", 0)])
def test_uav_hangs_on_the_arm_in_the_phases_that_hold_it_and_the_ends_that_keep_it(bench, phase, held):
    bench.enter(phase)
    bench.kept["decide"]["begin"] = 1000
    decide(bench.b)
    assert bench.kept["decide"]["held"][0] == held
