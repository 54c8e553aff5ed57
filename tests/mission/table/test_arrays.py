"""Missions as data: guards, time-outs, tables of one size."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.mission.decide import kept_layout
from armland.mission.table.arrays import CONDITIONS, GUARDS, PHASES, compile_table, next_phase
from armland.mission.table.phases import SIGNAL, Condition, Guard, Phase

TICK_S = 1e-3
SHARES, LOADS = {"none": 0.0, "carry": 0.5, "whole": 1.0, "test": 1.2}, {"carried": 20.0, "impact": 60.0}

FAR = Condition("offset", ">", "far_m")
NEAR = Condition("offset", "<", "near_m")
BOUNDS = {"near_m": 0.004, "far_m": 0.015}


def mission(*guards, **changes):
    begin = Phase(
        "begin", arm="hold", uav="station", guards=guards or (Guard("end", (NEAR,), 0.003),), on_timeout="lost"
    )
    finals = Phase("end", arm="hold", uav="off", final=True), Phase("lost", arm="hold", uav="off", final=True)
    return begin._replace(**changes), *finals


def compiled(phases, bounds=BOUNDS):
    return compile_table(phases, bounds, SHARES, LOADS, TICK_S)


def follow(phases, offsets, elapsed=0.0):
    """Phases after each tick for a row of offsets, m."""
    table, kept, phase, out = compiled(phases), np.zeros(1, kept_layout()), 0, []
    for offset in offsets:
        kept["signals"][0, SIGNAL["offset"]] = offset
        phase = next_phase(phase, elapsed, kept[0], table[0])
        out.append(phases[phase].name)
    return out


def test_guard_opens_after_it_has_held_long_enough():
    assert follow(mission(), [0.001] * 4) == ["begin", "begin", "end", "end"]


def test_guard_counts_anew_after_an_interruption():
    assert follow(mission(), [0.001, 0.001, 0.02, 0.001, 0.001]) == ["begin"] * 5


def test_signal_that_is_not_a_number_opens_nothing():
    assert follow(mission(Guard("end", (NEAR,)), Guard("lost", (FAR,))), [np.nan] * 5) == ["begin"] * 5


def test_first_guard_goes_before_the_second():
    assert follow(mission(Guard("lost", (NEAR,)), Guard("end", (NEAR,))), [0.001]) == ["lost"]


@pytest.mark.parametrize(("elapsed", "expected"), [(9.9, "begin"), (10.1, "lost")])
def test_time_out(elapsed, expected):
    assert follow(mission(), [0.02], elapsed) == [expected]


def test_final_phase_has_no_time_out():
    assert follow(mission(Guard("end", (NEAR,))), [0.001, 0.02], elapsed=5.0)[-1] == "end"
    kept = np.zeros(1, kept_layout())
    assert next_phase(1, 1e9, kept[0], compiled(mission())[0]) == 1


def test_words_become_the_scenarios_numbers():
    row = compiled(mission(share="test", load="impact"))["phases"][0, 0]
    assert (row["share"], row["force"]) == (1.2, 60.0)


def test_a_guard_holds_for_a_tick_at_least_and_for_its_time_at_any_rate():
    guards = Guard("end", (NEAR,), 0.0), Guard("end", (NEAR,), 0.1)
    fine, coarse = (compile_table(mission(*guards), BOUNDS, SHARES, LOADS, t)["guards"][0] for t in (1e-3, 5e-3))
    assert [int(g["hold"]) for g in fine[:2]] == [1, 100]
    assert [int(g["hold"]) for g in coarse[:2]] == [1, 20]


def test_all_tables_have_one_type_and_a_larger_one_is_refused():
    assert compiled(mission()).dtype == compiled(mission(Guard("end", (NEAR,)), Guard("lost", (FAR,)))).dtype
    for many, what in ((GUARDS, "guards"), (CONDITIONS, "conditions")):
        rows = tuple(Guard("end", (NEAR,) * (1 if what == "guards" else 2)) for _ in range(many + 1))
        with pytest.raises(ConfigurationError, match=what):
            compiled(mission(*rows))
    chain = tuple(
        Phase(f"p{i}", arm="hold", uav="off", on_timeout=f"p{i + 1}" if i < PHASES else "end")
        for i in range(PHASES + 1)
    )
    with pytest.raises(ConfigurationError, match=f"{PHASES + 2} phases, where a table has room for {PHASES}"):
        compiled((*chain, Phase("end", arm="hold", uav="off", final=True)))
