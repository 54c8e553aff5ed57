"""Missions as data: guards, time-outs, tables of one size."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.mission.decide import kept_layout
from armland.mission.table.arrays import CONDITIONS, GUARDS, PHASES, compile_table, next_phase, unmet
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


@pytest.mark.parametrize(
    ("offset", "speed", "missing"), [(0.02, 0.0, ["offset"]), (0.001, np.nan, ["uav_speed"]), (0.001, 0.0, [])]
)
def test_what_a_phase_waits_for_in_vain_is_named_by_its_first_guard(offset, speed, missing):
    bounds = {**BOUNDS, "fast_mps": 0.5}
    phases = mission(Guard("end", (NEAR, Condition("uav_speed", "<", "fast_mps"))), Guard("lost", (FAR,)))
    table, kept = compiled(phases, bounds), np.zeros(1, kept_layout())
    kept["signals"][0, SIGNAL["offset"]], kept["signals"][0, SIGNAL["uav_speed"]] = offset, speed
    bits = unmet(0, kept[0], table[0])
    assert [name for name, i in SIGNAL.items() if bits >> i & 1] == missing


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


def test_guard_opens_where_all_its_conditions_hold_and_not_where_one_does():
    """Two signals, in both orders: the tilt alone, the offset alone, both."""
    table = compile_table(mission(Guard("end", (NEAR, Condition("tilt", ">", "far_m")))), BOUNDS, SHARES, LOADS, TICK_S)
    for offset, tilt, opens in ((0.001, 0.0, False), (0.1, 1.0, False), (0.001, 1.0, True)):
        kept = np.zeros(1, kept_layout())
        kept["signals"][0, SIGNAL["offset"]], kept["signals"][0, SIGNAL["tilt"]] = offset, tilt
        assert (next_phase(0, 0.0, kept[0], table[0]) == 1) == opens


@pytest.mark.parametrize(("offset", "opens"), [(0.004, None), (0.0039, "end"), (0.015, None), (0.0151, "lost")])
def test_threshold_itself_opens_nothing(offset, opens):
    guards = Guard("end", (NEAR,)), Guard("lost", (FAR,))
    assert follow(mission(*guards), [offset]) == [opens or "begin"]


def test_guards_count_on_their_own():
    """One that holds now and then does not disturb one that holds throughout."""
    guards = Guard("lost", (NEAR,), 0.003), Guard("end", (Condition("offset", "<", "far_m"),), 0.005)
    assert follow(mission(*guards), [0.001, 0.01, 0.001, 0.01, 0.001]) == ["begin"] * 4 + ["end"]


def test_each_phase_has_its_own_guards_and_words():
    first = Phase(
        "a",
        arm="join",
        uav="ramp",
        magnet="on",
        link="held",
        held=True,
        observe=True,
        guards=(Guard("b", (NEAR,)),),
        on_timeout="end",
    )
    second = Phase(
        "b",
        arm="move",
        uav="level",
        free=True,
        duration_s=2.0,
        timeout_s=7.0,
        guards=(Guard("end", (FAR,)), Guard("a", (NEAR, FAR))),
        on_timeout="end",
    )
    end = Phase("end", arm="hold", uav="off", final=True)
    far = {"near_m": 0.02, "far_m": 0.015}
    table = compile_table((first, second, end), far, SHARES, LOADS, TICK_S)
    a, b, last = table["phases"][0, :3]
    assert (a["held"], a["free"], a["observe"], a["final"]) == (1, 0, 1, 0)
    assert (b["held"], b["free"], b["observe"], b["duration"], b["timeout"]) == (0, 1, 0, 2.0, 7.0)
    assert (a["first"], a["end"], b["first"], b["end"], last["first"], last["end"]) == (0, 1, 1, 3, 3, 3)
    assert [int(g["target"]) for g in table["guards"][0, :3]] == [1, 2, 0]
    assert [(int(g["first"]), int(g["end"])) for g in table["guards"][0, :3]] == [(0, 1), (1, 2), (2, 4)]
    # An end that is timed out stays where it is.
    assert (int(a["on_timeout"]), int(last["on_timeout"])) == (2, 2)
    conditions = table["conditions"][0, :4]
    np.testing.assert_array_equal(conditions["sign"], [-1.0, 1.0, -1.0, 1.0])
    np.testing.assert_array_equal(conditions["threshold"], [0.02, 0.015, 0.02, 0.015])


@pytest.mark.parametrize(("name", "miss"), [("miss", 1), ("other", -1)])
def test_phase_that_counts_as_a_retry_is_the_one_of_that_name(name, miss):
    lost = Phase(name, arm="hold", uav="off", on_timeout="end")
    begin = Phase("begin", arm="hold", uav="off", guards=(Guard(name, (FAR,)),), on_timeout="end")
    end = Phase("end", arm="hold", uav="off", final=True)
    assert compiled((begin, lost, end))["miss"][0] == miss


def test_table_has_room_for_as_many_as_it_says_and_faults_matter_nowhere_yet():
    end = Phase("end", arm="hold", uav="off", final=True)
    chain = tuple(
        Phase(f"p{i}", arm="hold", uav="off", on_timeout=f"p{i + 1}" if i < PHASES - 2 else "end")
        for i in range(PHASES - 1)
    )
    assert len(chain) + 1 == PHASES
    assert (compiled((*chain, end))["faults"] == -1).all()
    compiled(mission(*(Guard("end", (NEAR,)) for _ in range(GUARDS))))
    assert CONDITIONS % 40 == 0
    compiled(mission(*(Guard("end", (NEAR,) * (CONDITIONS // 40)) for _ in range(40))))
