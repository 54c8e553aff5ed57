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
