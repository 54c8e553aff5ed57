"""The fault table: complete, leading to ends only, and never to a graver loss of authority than needed."""

import pytest

from armland.mission.missions.landing import PHASES as LANDING
from armland.mission.missions.takeoff import PHASES as TAKEOFF
from armland.mission.registry import MISSIONS
from armland.mission.supervisor.ends import FINALS, HINGED_FINALS
from armland.mission.supervisor.table import (
    DEBOUNCE_S,
    ESCALATION,
    FAULT,
    FAULT_TABLE,
    FAULTS,
    GRAVITY_OF,
    debounce_ticks,
    fault_rows,
)
from armland.mission.table.arrays import FAULT_ROWS, PHASES
from armland.mission.table.phases import KINDS
from armland.scenario import load_scenario


def test_table_has_every_fault_and_every_kind_and_leads_to_ends_only():
    ends = {p.name for p in (*FINALS, *HINGED_FINALS) if p.name != "done"} | {"-"}
    assert set(FAULT_TABLE) == set(FAULTS[1:])
    for row in FAULT_TABLE.values():
        assert set(row) == set(KINDS)
        assert set(row.values()) <= ends


@pytest.mark.parametrize("phases", [LANDING, TAKEOFF])
def test_every_phase_has_a_row(phases):
    rows, names = fault_rows(phases), [p.name for p in phases]
    for k, phase in enumerate(phases):
        assert phase.kind in KINDS or (phase.final and phase.kind == "end")
        expected = (
            ESCALATION.get(phase.name, {})
            if phase.kind == "end"
            else {f: r[phase.kind] for f, r in FAULT_TABLE.items()}
        )
        found = {f: names[rows[i, k]] for i, f in enumerate(FAULTS) if rows[i, k] >= 0}
        assert found == {f: end for f, end in expected.items() if end != "-"}


def test_second_fault_only_leads_to_graver_ends_so_there_is_no_cycle():
    assert {p.name for p in (*FINALS, *HINGED_FINALS)} == set(GRAVITY_OF)
    for end, row in ESCALATION.items():
        for fault, worse in row.items():
            assert fault in FAULTS[1:]
            assert GRAVITY_OF[worse] > GRAVITY_OF[end]


def test_an_arm_that_cannot_be_felt_is_braked_wherever_it_is():
    braked = {p.name for p in FINALS if p.arm == "brake"}
    assert set(FAULT_TABLE["arm_stale"].values()) <= braked | {"-"}
    assert {p.name for p in FINALS if p.name not in braked} == {
        e for e, row in ESCALATION.items() if "arm_stale" in row
    }
    assert {ESCALATION[e]["arm_stale"] for e in ESCALATION if "arm_stale" in ESCALATION[e]} <= braked


def test_refused_take_off_leaves_the_rotors_off():
    for name in ("refused", "braked_refused"):
        assert next(p for p in TAKEOFF if p.name == name).uav == "off"
        assert next(p for p in LANDING if p.name == name).uav == "autonomous"


def test_no_end_lets_a_held_uav_go_without_its_thrust():
    for fault, row in FAULT_TABLE.items():
        end = next((p for p in FINALS if p.name == row["held"]), None)
        assert end is None or end.magnet == "on" or end.uav == "autonomous", fault


def test_no_end_stops_a_flying_uav():
    for fault, row in FAULT_TABLE.items():
        end = next((p for p in FINALS if p.name == row["flight"]), None)
        # One whose plate sticks, or that lies on the arm, does not fly: it stays there with the thrust that it has.
        flown_on = ("level", "on") if fault in ("magnet_stuck", "thrust_short") else ("autonomous", "off")
        assert end is None or (end.uav, end.magnet) == flown_on, fault


def test_uav_without_power_is_kept_where_the_arm_has_or_may_have_it_and_made_room_for_where_it_has_not():
    row = FAULT_TABLE["power_lost"]
    assert (row["held"], row["flight"], row["touch"]) == ("holding", "abort", "holding")


def test_arm_that_something_drives_to_its_limits_while_it_holds_is_braked():
    assert ESCALATION["holding"]["near_limit"] == FAULT_TABLE["near_limit"]["held"] == "braked_held"


def test_blind_camera_matters_only_where_the_arm_goes_by_it():
    for fault in ("camera_stale", "camera_leap", "camera_noise"):
        assert FAULT_TABLE[fault] == FAULT_TABLE["camera_stale"]
        assert FAULT_TABLE[fault]["held"] == FAULT_TABLE[fault]["cradle"] == "-"


def test_frozen_encoder_leads_where_a_stale_arm_leads_from_every_end():
    assert FAULT_TABLE["encoder_frozen"] == FAULT_TABLE["arm_stale"]
    for end, row in ESCALATION.items():
        assert row.get("encoder_frozen") == row.get("arm_stale"), end


def test_graver_of_two_that_show_together_stands_first():
    """A frozen joint is no stale arm, a UAV without power is silent too, a sensor that is wrong drifts, a stuck plate pulls."""
    for first, second in (
        ("encoder_frozen", "arm_stale"),
        ("power_lost", "uav_silent"),
        ("wrench_wrong", "wrench_drift"),
        ("magnet_stuck", "overload"),
        ("arm_blocked", "near_limit"),
        ("thrust_lost", "uav_tilt"),
    ):
        assert FAULT[first] < FAULT[second]


def test_what_is_told_apart_by_time_is_debounced_in_that_order():
    ticks = debounce_ticks(1e-3)
    for first, second in (
        ("power_lost", "uav_silent"),
        ("magnet_stuck", "wrench_drift"),
        ("encoder_frozen", "near_limit"),
        ("wrench_wrong", "wrench_drift"),
        ("rotor_lost", "slip"),
    ):
        assert ticks[FAULT[first]] < ticks[FAULT[second]]


def test_no_end_leaves_the_arm_without_stiffness():
    for end in FINALS:
        assert end.arm in ("hold", "back_off", "yield", "brake", "balance")


def test_hinged_uav_rests_where_its_law_fails_and_nothing_else_matters():
    phases = MISSIONS["E1"].phases(load_scenario("paper"))
    rows, names = fault_rows(phases), [p.name for p in phases]
    for k, phase in enumerate(phases):
        found = {f: names[rows[i, k]] for f, i in FAULT.items() if rows[i, k] >= 0}
        assert found == ({"law_failed": "resting"} if phase.kind == "hinge" else {}), phase.name


def test_law_that_fails_leads_to_a_safe_end_wherever_one_flies():
    for phases in (LANDING, TAKEOFF):
        rows = fault_rows(phases)
        for k, phase in enumerate(phases):
            if phase.held:
                assert phases[rows[FAULT["law_failed"], k]].name in ("abort", "holding")
                assert not phases[rows[FAULT["law_failed"], k]].held


def test_rows_have_the_size_of_every_mission_and_nothing_outside_it():
    rows = fault_rows(LANDING)
    assert rows.shape == (FAULT_ROWS, PHASES)
    assert (rows[0] == -1).all()
    assert (rows[:, len(LANDING) :] == -1).all()


@pytest.mark.parametrize("rate", [200, 1000, 4000])
def test_debouncing_is_a_time_and_not_a_number_of_ticks(rate):
    ticks = debounce_ticks(1.0 / rate)
    for fault, i in FAULT.items():
        if i:
            assert ticks[i] >= 1
            assert ticks[i] == pytest.approx(DEBOUNCE_S.get(fault, 0.0) * rate, abs=1.0)
    assert ticks[0] == 0
