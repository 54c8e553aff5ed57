"""Missions as data: guards, time-outs, and the contradictions that are refused."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.mission.bounds import thresholds, tuned
from armland.mission.landing_procedure import LANDING
from armland.mission.landing_scenario import Landing
from armland.mission.phase_table import compile_table, next_phase
from armland.mission.phases import SIGNAL, SIGNALS, Condition, Guard, Phase, check
from armland.mission.takeoff_procedure import TAKEOFF

TICK_S = 1e-3

FAR = Condition("offset", ">", "far_m")
NEAR = Condition("offset", "<", "near_m")
BOUNDS = {"near_m": 0.004, "far_m": 0.015}


def mission(*guards, **changes):
    begin = Phase(
        "begin", arm="hold", uav="station", guards=guards or (Guard("end", (NEAR,), 0.003),), on_timeout="lost"
    )
    finals = Phase("end", arm="hold", uav="off", final=True), Phase("lost", arm="hold", uav="off", final=True)
    return begin._replace(**changes), *finals


def follow(table, offsets, elapsed=0.0):
    """Phases after each tick for a row of offsets, m."""
    counts, signals, phase, out = np.zeros(len(table.guards), np.int64), np.zeros(len(SIGNALS)), 0, []
    for offset in offsets:
        signals[SIGNAL["offset"]] = offset
        phase = next_phase(phase, elapsed, signals, table.phases, table.guards, table.conditions, counts)
        out.append(table.names[phase])
    return out


@pytest.mark.parametrize("phases", [LANDING, TAKEOFF])
def test_both_missions_are_free_of_contradictions(phases):
    landing = Landing()
    assert check(tuned(phases, landing, 5.2), thresholds(landing)) == []


def test_guard_opens_after_it_has_held_long_enough():
    table = compile_table(mission(), BOUNDS, TICK_S)
    assert follow(table, [0.001] * 4) == ["begin", "begin", "end", "end"]


def test_guard_counts_anew_after_an_interruption():
    table = compile_table(mission(), BOUNDS, TICK_S)
    assert follow(table, [0.001, 0.001, 0.02, 0.001, 0.001]) == ["begin"] * 5


def test_signal_that_is_not_a_number_opens_nothing():
    table = compile_table(mission(Guard("end", (NEAR,)), Guard("lost", (FAR,))), BOUNDS, TICK_S)
    assert follow(table, [np.nan] * 5) == ["begin"] * 5


def test_first_guard_goes_before_the_second():
    table = compile_table(mission(Guard("lost", (NEAR,)), Guard("end", (NEAR,))), BOUNDS, TICK_S)
    assert follow(table, [0.001]) == ["lost"]


@pytest.mark.parametrize(("elapsed", "expected"), [(9.9, "begin"), (10.1, "lost")])
def test_time_out(elapsed, expected):
    assert follow(compile_table(mission(), BOUNDS, TICK_S), [0.02], elapsed) == [expected]


def test_final_phase_has_no_time_out():
    table = compile_table(mission(Guard("end", (NEAR,))), BOUNDS, TICK_S)
    assert follow(table, [0.001, 0.02], elapsed=5.0)[-1] == "end"
    counts = np.zeros(len(table.guards), np.int64)
    assert next_phase(1, 1e9, np.zeros(len(SIGNALS)), table.phases, table.guards, table.conditions, counts) == 1


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
        ((*mission(), *mission()[1:2]), BOUNDS, "'end' stands there twice"),
        ((*mission(), Phase("island", arm="hold", uav="off", on_timeout="end")), BOUNDS, "'island' is never reached"),
        (mission(Guard("begin", (NEAR,)), on_timeout="begin"), BOUNDS, "'begin' leads to no end"),
    ],
)
def test_contradictions_are_refused(phases, bounds, words):
    with pytest.raises(ConfigurationError, match=words):
        compile_table(phases, bounds, TICK_S)


def test_all_contradictions_are_named_at_once():
    with pytest.raises(ConfigurationError) as refusal:
        compile_table(mission(held=True, duration_s=11.0), BOUNDS, TICK_S)
    assert str(refusal.value).count("\n") == 2
