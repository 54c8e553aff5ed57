"""Contradictions of a mission's table, each found and named."""

import re

import numpy as np
import pytest

from armland.mission.registry import MISSIONS
from armland.mission.table.checks import check
from armland.mission.table.phases import Condition, Guard, Phase
from armland.mission.table.thresholds import thresholds_of
from armland.scenario import load_scenario

FAR = Condition("offset", ">", "far_m")
NEAR = Condition("offset", "<", "near_m")
BOUNDS = {"near_m": 0.004, "far_m": 0.015}


def mission(*guards, **changes):
    begin = Phase(
        "begin", arm="hold", uav="station", guards=guards or (Guard("end", (NEAR,), 0.003),), on_timeout="lost"
    )
    finals = Phase("end", arm="hold", uav="off", final=True), Phase("lost", arm="hold", uav="off", final=True)
    return begin._replace(**changes), *finals


@pytest.mark.parametrize(
    ("phases", "bounds", "words"),
    [
        (mission(Guard("end", (FAR, NEAR))), BOUNDS, "offset must be above 0.015 m and below 0.004 m at once"),
        (mission(Guard("away", (NEAR,))), BOUNDS, "unknown phase 'away'"),
        (mission(on_timeout="away"), BOUNDS, "unknown phase 'away'"),
        (mission(duration_s=10.0), BOUNDS, "time-out 10 s is not above its move's duration of 10 s"),
        (mission(held=True), BOUNDS, "the UAV is held, but the magnet is off"),
        (mission(Guard("end", (NEAR,), 11.0)), BOUNDS, "must hold for 11 s, but the phase times out after 10 s"),
        (mission(), {"near_m": np.nan, "far_m": 1.0}, "near_m = nan is not a finite number"),
        (mission(), {"far_m": 1.0}, "unknown signal, relation or threshold"),
        (mission(arm="fly"), BOUNDS, "arm = 'fly' is unknown"),
        (mission(kind="sea"), BOUNDS, "kind = 'sea' is unknown"),
        (mission(share="half"), BOUNDS, "share = 'half' is unknown"),
        ((*mission(), *mission()[1:2]), BOUNDS, "'end' stands there twice"),
        ((*mission(), Phase("island", arm="hold", uav="off", on_timeout="end")), BOUNDS, "'island' is never reached"),
        (mission(Guard("begin", (NEAR,)), on_timeout="begin"), BOUNDS, "'begin' leads to no end"),
    ],
)
def test_contradictions_are_found(phases, bounds, words):
    assert any(re.search(words, line) for line in check(phases, bounds))


def test_all_contradictions_are_named_at_once():
    assert len(check(mission(held=True, duration_s=11.0), BOUNDS)) == 2


@pytest.mark.parametrize("name", MISSIONS)
def test_missions_are_free_of_contradictions(name):
    mission = MISSIONS[name]
    scenario = load_scenario("paper" if mission.start == "hinged" else "landing")
    assert check(mission.phases(scenario), thresholds_of(mission, scenario)) == []


WIDE = {**BOUNDS, "mid_m": 0.01, "low_m": 0.001}


@pytest.mark.parametrize(
    ("conditions", "contradicts"),
    [
        ((("offset", ">", "low_m"), ("offset", "<", "near_m")), False),
        ((("offset", ">", "low_m"), ("offset", ">", "mid_m"), ("offset", "<", "near_m")), True),
        ((("offset", ">", "low_m"), ("offset", "<", "far_m"), ("offset", "<", "low_m")), True),
        ((("offset", ">", "near_m"), ("offset", "<", "near_m")), True),
        ((("offset", ">", "mid_m"), ("tilt", "<", "near_m")), False),
    ],
)
def test_the_tightest_bounds_of_a_signal_count_and_no_other_signals(conditions, contradicts):
    guard = Guard("end", tuple(Condition(*c) for c in conditions))
    lines = check(mission(guard), WIDE)
    assert any("at once" in line for line in lines) == contradicts
    assert bool(lines) == contradicts


@pytest.mark.parametrize(
    "condition", [("altitude", "<", "near_m"), ("offset", "=", "near_m"), ("offset", "<", "nowhere_m")]
)
def test_condition_that_says_nothing_known_is_named(condition):
    lines = check(mission(Guard("end", (Condition(*condition),))), BOUNDS)
    assert len(lines) == 1
    assert f"condition {' '.join(condition)!r}" in lines[0]


@pytest.mark.parametrize(("hold", "fits"), [(9.9, True), (10.0, False)])
def test_guard_must_be_able_to_hold_before_the_time_out(hold, fits):
    assert (check(mission(Guard("end", (NEAR,), hold)), BOUNDS) == []) == fits


@pytest.mark.parametrize(("duration", "fits"), [(9.9, True), (10.0, False)])
def test_time_out_must_leave_time_for_the_move(duration, fits):
    assert (check(mission(duration_s=duration), BOUNDS) == []) == fits


@pytest.mark.parametrize(
    ("magnet", "uav", "fits"), [("on", "level", True), ("off", "hinged", True), ("off", "level", False)]
)
def test_uav_is_held_by_a_magnet_or_by_its_hinge(magnet, uav, fits):
    assert (check(mission(held=True, magnet=magnet, uav=uav), BOUNDS) == []) == fits


def test_end_that_only_a_fault_leads_to_is_no_island_and_needs_no_way_on():
    extra = Phase("safe", arm="brake", uav="autonomous", kind="end", final=True)
    assert check((*mission(), extra), BOUNDS) == []


def test_phase_is_reached_through_guards_and_time_outs_of_others():
    """a → b by a guard, b → c by its time-out, c → end: none of them is an island, and all lead to an end."""
    a = Phase("a", arm="hold", uav="off", guards=(Guard("b", (NEAR,)),), on_timeout="a")
    b = Phase("b", arm="hold", uav="off", on_timeout="c")
    c = Phase("c", arm="hold", uav="off", guards=(Guard("end", (NEAR,)),), on_timeout="b")
    end = Phase("end", arm="hold", uav="off", final=True)
    assert check((a, b, c, end), BOUNDS) == []
    # Without c's guard two of them go round for ever, and the third leads there.
    lines = check((a, b, c._replace(guards=()), end), BOUNDS)
    assert lines == [f"phase {n!r} leads to no end" for n in "abc"]


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_threshold_must_be_a_finite_number_whether_it_is_used_or_not(value):
    lines = check(mission(), {**BOUNDS, "unused": value})
    assert lines == [f"threshold unused = {value} is not a finite number"]
