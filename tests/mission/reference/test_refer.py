"""The stage that fills the reference: which part of it a phase is given, and what begins with the phase."""

import numpy as np
import pytest

from armland.mission.reference.moves import BALANCE, FOLLOW
from armland.mission.reference.refer import begin_reference, refer
from armland.rotations import from_rotation_vector

PATH = np.arange(36.0).reshape(4, 9)


def reference(bench, phase, elapsed=0.0, path=PATH):
    bench.enter(phase)
    bench.tick.mission["elapsed"] = elapsed
    refer(bench.b, path)
    return bench.tick.reference[0]


def test_reference_is_remembered_for_the_phase_that_comes_next(bench):
    """What the tick says is what the next phase begins with."""
    bench.kept["refer"]["r0"], bench.kept["refer"]["v0"] = [0.6, 0.1, 0.7], [0.05, 0.0, -0.02]
    r, kept = reference(bench, "guide", 0.02), bench.kept["refer"]
    for name in ("r", "v", "a"):
        np.testing.assert_array_equal(kept[name][0], r[name])
    assert np.abs(r["v"]).max() > 0.0
    begin_reference(bench.plan.number("guide"), bench.plan.number("approach"), bench.b)
    np.testing.assert_array_equal(kept["r0"][0], r["r"])
    np.testing.assert_array_equal(kept["v0"][0], r["v"])


def test_reference_says_its_tick_and_the_attitude_that_is_asked_of_the_uav(bench):
    q_d = from_rotation_vector(np.array([0.1, 0.2, -0.3]))
    bench.kept["act"]["q_d"] = q_d
    r = reference(bench, "guide")
    np.testing.assert_array_equal(r["quat"], q_d)
    assert r["tick"] == 1000


def test_progress_is_the_moves_share_of_its_time(bench):
    row = bench.enter("carry")
    reference(bench, "carry", 0.25 * row["duration"])
    assert bench.tick.mission["progress"][0] == bench.kept["refer"]["progress"][0] == pytest.approx(0.25)


@pytest.mark.parametrize(("tick", "row", "progress"), [(0, 0, 0.0), (2, 2, 2 / 3), (9, 3, 1.0)])
def test_mission_with_a_path_follows_it_by_its_tick(bench, tick, row, progress):
    bench.enter("guide")["arm"] = FOLLOW
    bench.m["tick"] = tick
    r = reference(bench, "guide", 77.0)
    np.testing.assert_array_equal(np.concatenate([r["r"], r["v"], r["a"]]), PATH[row])
    assert bench.tick.mission["progress"][0] == pytest.approx(progress)


def test_arm_that_joins_begins_to_track_where_the_plate_is(bench):
    """Without an acceleration, and with the plate's own speed; other phases leave the filter alone."""
    e, s = bench.e, bench.kept["refer"]
    p = bench.told["refer"]
    p["room"] = [[-10.0] * 3, [10.0] * 3]
    e["plate"], e["plate_v"], s["p"], s["pv"], s["pa"] = [0.7, 0.1, 0.9], [0.1, 0.0, -0.1], 9.0, 9.0, 9.0
    begin_reference(bench.plan.number("approach"), bench.plan.number("align"), bench.b)
    np.testing.assert_array_equal(s["p"], 9.0)
    begin_reference(bench.plan.number("guide"), bench.plan.number("approach"), bench.b)
    np.testing.assert_array_equal([s["p"][0], s["pv"][0], s["pa"][0]], [[0.7, 0.1, 0.9], [0.1, 0.0, -0.1], [0, 0, 0]])


def test_plate_is_tracked_whatever_the_arm_does(bench):
    middle = bench.plan.scenario.place.catch_m
    bench.kept["refer"]["p"], bench.kept["refer"]["pv"], bench.e["plate"] = middle, 0.0, np.array(middle) + 0.02
    reference(bench, "guide")
    assert (bench.kept["refer"]["pv"] > 0.0).all()


def test_balance_begins_with_the_pivots_speed(bench):
    bench.e["v"], bench.kept["refer"]["balance"]["sway"] = [0.2, -0.1, 0.0], 9.0
    begin_reference(bench.plan.number("carry"), bench.plan.number("holding"), bench.b)
    np.testing.assert_array_equal(bench.kept["refer"]["balance"]["sway"], 9.0)
    begin_reference(bench.plan.number("holding"), bench.plan.number("balancing"), bench.b)
    np.testing.assert_array_equal(bench.kept["refer"]["balance"]["sway"], 0.0)
    np.testing.assert_array_equal(bench.kept["refer"]["balance"]["sway_v"][0], [0.2, -0.1])


@pytest.mark.parametrize(("before", "after", "anew"), [("carry", "holding", True), ("guide", "approach", False)])
def test_reference_begins_at_the_arm_where_the_law_changes(bench, before, after, anew):
    """A UAV that is held no more, or from now on: the law that comes begins without a force."""
    bench.e["r"], bench.e["v"], bench.kept["refer"]["r"], bench.kept["refer"]["v"] = 0.4, 0.2, 0.5, 0.1
    begin_reference(bench.plan.number(before), bench.plan.number(after), bench.b)
    np.testing.assert_array_equal(bench.kept["refer"]["r0"], 0.4 if anew else 0.5)
    np.testing.assert_array_equal(bench.kept["refer"]["v0"], 0.2 if anew else 0.1)


@pytest.mark.parametrize(("age", "pushes"), [(20, True), (400, False)])
def test_balance_is_told_how_old_the_attitude_is(bench, age, pushes):
    """A tilt that is too old is not balanced by: the pivot, at rest, stays at rest."""
    assert bench.enter("balancing")["arm"] == BALANCE
    bench.e["r"], bench.e["v"], bench.e["tick"] = [0.6, 0.0, 0.9], 0.0, 1000
    bench.kept["refer"]["r"] = bench.e["r"]
    begin_reference(bench.plan.number("holding"), bench.plan.number("balancing"), bench.b)
    bench.e["quat"][0], bench.m["uav_tick"] = from_rotation_vector(np.array([0.0, 0.03, 0.0])), 1000 - age
    r = reference(bench, "balancing", 0.001)
    assert (r["a"][0] > 0.1) == pushes
    np.testing.assert_allclose(r["r"][:2], [0.6, 0.0], atol=1e-4)
