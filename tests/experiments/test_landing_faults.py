"""Every cell of the fault table provoked in the plant, by continuing the fault-free mission of the same seed from the phase's begin.

Each trial has three controls: without the failure the mission succeeds; with the supervisor blind to the fault it comes out
differently; and what every trial must show (`fault_flight.unsafe`) is itself shown to fail where it should.
"""

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from armland.experiments.fault_flight import branches, fly_trial, unsafe
from armland.experiments.fault_trials import (
    CELLS,
    OPEN,
    PHASES,
    all_trials,
    allowed_ends,
    cells,
    extras,
    failure,
    trial,
)
from armland.experiments.landing import fly_landing, fly_takeoff
from armland.mission.failures import FAILURES
from armland.mission.landing_procedure import LANDING
from armland.mission.landing_scenario import landing_scenario
from armland.mission.supervisor import FAULT_TABLE, FAULTS, KINDS
from armland.mission.takeoff_procedure import TAKEOFF
from armland.view.fault_page import row

PAGE = Path(__file__).parents[2] / "docs" / "faults.md"

QUICK = {
    "landing uav_silent held",
    "landing arm_stale held",
    "landing slip held",
    "landing near_limit touch",
    "takeoff non_finite grip",
    "takeoff arm_stale touch",
    "landing link, then encoders",
}
"""One for each kind of reaction; the others run with the slow tests."""

TRIALS = [
    pytest.param(t, id=t.name.replace(" ", "-"), marks=() if t.name in QUICK else pytest.mark.slow)
    for t in all_trials()
]


@cache
def flown(t):
    return fly_trial(t)


@pytest.fixture(scope="module")
def page():
    return {line.split(" | ")[0].strip("| "): line for line in PAGE.read_text(encoding="utf-8").splitlines()}


def test_every_cell_of_the_fault_table_has_a_trial():
    for mission, phases in (("landing", LANDING), ("takeoff", TAKEOFF)):
        assert {p.kind for p in phases if not p.final} == set(PHASES[mission])
        for kind, phase in PHASES[mission].items():
            assert {p.name: p.kind for p in phases}[phase] == kind
    there = {(m, f, k) for m, f, k in cells()}
    assert {f for _, f, _ in there} == set(FAULT_TABLE) == set(FAULTS[1:])
    assert {k for _, _, k in there} == set(KINDS)
    names = {t.name for t in all_trials()}
    assert len(names) == len(all_trials())
    assert {f"{m} {f} {k}" for m, f, k in there - set(OPEN)} <= names
    assert set(CELLS) <= there


def test_every_cell_but_dashes_is_provoked_to_the_end_that_the_table_names():
    for mission, fault, kind in cells():
        if (mission, fault, kind) in OPEN or FAULT_TABLE[fault][kind] == "-":
            continue
        t = trial(mission, fault, kind)
        if (mission, fault, kind) in UNSEEN:
            continue
        assert (t.end, t.found in (fault, "slip")) == (FAULT_TABLE[fault][kind], True)


UNSEEN = {("takeoff", "magnet_coil", "touch"): "the magnet is off by then: nothing can be seen of its coil"}


def test_every_way_to_fail_of_the_plant_is_used():
    used = {f.kind for t in all_trials() for f in t.faults}
    # What remains is the physical twist of a UAV, which no means of this arm can undo.
    assert set(FAILURES) - used == {"twist"}


@pytest.mark.parametrize("mission", ["landing", "takeoff"])
def test_without_a_failure_the_mission_succeeds(mission):
    base = branches(mission)
    assert base.setup.table.names[int(base.records["mission"]["phase"][-1])] == "done"
    assert not base.records["mission"]["fault"].any()


@pytest.mark.slow
@pytest.mark.parametrize("mission", ["landing", "takeoff"])
def test_mission_that_is_continued_is_byte_for_byte_the_one_flown_through(mission):
    base, fly = branches(mission), fly_landing if mission == "landing" else fly_takeoff
    assert fly(base.scenario).records.tobytes() == base.records.tobytes()
    phase = PHASES[mission]["held"]
    for start in (PHASES[mission]["ground"], phase, "done"):
        never = failure(start, 1e5, kind="link_loss")
        assert base.fly((never,))[0].tobytes() == base.records.tobytes()
    fault = failure(phase, kind="link_loss")
    whole = fly(landing_scenario("landing", {"seed": 1, "faults": [fault.model_dump()]}))
    assert base.fly((fault,))[0].tobytes() == whole.records.tobytes()


@pytest.mark.parametrize("t", TRIALS)
def test_fault_ends_safely(t, page):
    flight = flown(t)
    assert unsafe(flight) == []
    assert flight.ends == allowed_ends(t)
    assert flight.judgement.state in t.states
    assert flight.found[-1] == t.found
    _is_on_the_page(flight, page)


def _is_on_the_page(flight, page):
    """What stands in docs/faults.md is what the flight shows; other processors round differently."""
    written, now = (line.strip("| ").split(" | ") for line in (page[flight.trial.name], row(flight)))
    assert written[1:5] == now[1:5], "run: python -m armland.view.fault_page > docs/faults.md"
    for a, b, tolerance in zip(written[5:], now[5:], (0.3, 0.2, 15.0, 2.0, 5.0), strict=True):
        assert float(a) == pytest.approx(float(b), rel=0.25, abs=tolerance)


@pytest.mark.parametrize("t", [t for t in all_trials() if t.name in QUICK], ids=lambda t: t.name)
def test_reason_names_fault_state_and_remedy(t):
    from armland.mission.remedies import REMEDIES, STANDING

    reason, end = flown(t).judgement.reason, allowed_ends(t)[-1]
    assert t.found in reason
    assert STANDING[end] in reason
    assert REMEDIES[t.found][1] in reason


BLIND = {
    "non_finite": ("landing", "touch", ("non_finite", "wrench_stale")),
    "arm_stale": ("landing", "held", ("arm_stale",)),
    "uav_silent": ("landing", "held", ("uav_silent",)),
    "camera_stale": ("takeoff", "touch", ("camera_stale",)),
    "wrench_stale": ("landing", "touch", ("wrench_stale",)),
    "wrench_drift": ("landing", "held", ("wrench_drift",)),
    "magnet_coil": ("landing", "touch", ("magnet_coil",)),
    "overload": ("landing", "held", ("overload",)),
    "rotor_lost": ("landing", "held", ("rotor_lost",)),
    "uav_tilt": ("takeoff", "touch", ("uav_tilt",)),
    "slip": ("landing", "held", ("slip",)),
    "near_limit": ("landing", "touch", ("near_limit",)),
}
"""Fault -> cell in which its loss is seen, and to what the supervisor is blind; NaN from a device is also a stale device."""


@pytest.mark.slow
@pytest.mark.parametrize("fault", FAULTS[1:])
def test_blind_to_the_fault_the_same_failure_comes_out_differently(fault):
    mission, kind, blind_to = BLIND[fault]
    t = trial(mission, fault, kind)
    seen, blind = flown(t), fly_trial(t, blind_to)
    assert not set(blind_to) & set(blind.found)
    assert blind.ends != seen.ends or blind.reaction_s > 10.0 * seen.reaction_s


@pytest.mark.slow
def test_blind_to_a_dead_encoder_the_arm_runs_into_the_floor():
    t = trial("landing", "arm_stale", "held")
    assert "arm_touched_floor" in fly_trial(t, ("arm_stale",)).judgement.limits_violated
    assert "arm_touched_floor" not in flown(t).judgement.limits_violated


@pytest.mark.slow
def test_blind_to_an_arm_that_is_flung_the_uav_is_lost():
    t = trial("landing", "near_limit", "touch")
    assert any("fell" in line for line in unsafe(fly_trial(t, ("near_limit", "overload"))))


@pytest.mark.slow
def test_blind_to_a_silent_link_the_uav_is_let_go_with_its_rotors_running():
    t = trial("landing", "uav_silent", "held")
    blind, seen = fly_trial(t, ("uav_silent",)).records[-1], flown(t).records[-1]
    assert blind["command"]["magnet"] == 0
    assert blind["truth"]["rotor_thrust"].sum() > 1.0
    assert seen["command"]["magnet"] == 1


@pytest.mark.slow
def test_blind_to_slip_the_uav_falls_off():
    t = trial("landing", "slip", "held")
    assert any("fell" in line for line in unsafe(fly_trial(t, ("slip", "rotor_lost"))))
    assert not any("fell" in line for line in unsafe(flown(t)))


@pytest.mark.parametrize(
    ("change", "word"),
    [
        (lambda r: r["command"]["tau"].__setitem__((5000, 2), np.nan), "finite"),
        (lambda r: r["command"]["tau"].__setitem__((5000, 2), 1e4), "limit"),
        (lambda r: r["command"]["tau"].__setitem__((5000, 2), r["command"]["tau"][4999, 2] + 2.0), "jumped"),
        (lambda r: r["command"]["tau"].__setitem__(slice(-100, None), 0.0), "no torque"),
        (lambda r: r["command"]["magnet"].__setitem__(slice(-100, None), 0), "magnet"),
        (lambda r: r["command"]["brake"].__setitem__(slice(-100, None), 0), "brakes"),
        (lambda r: r["truth"]["ee"].__setitem__((-5, 2), 0.0), "rest"),
    ],
)
def test_what_every_trial_must_show_can_fail(change, word):
    flight = flown(trial("landing", "arm_stale", "held"))
    records = flight.records.copy()
    change(records)
    with np.errstate(invalid="ignore"):
        assert any(word in line for line in unsafe(flight._replace(records=records)))


def test_extras_cover_both_directions_of_the_link_and_every_device():
    faults = [f for t in extras() for f in t.faults]
    assert {"uplink_loss", "downlink_loss", "link_loss", "unreachable", "rotor_loss"} <= {f.kind for f in faults}
    assert {f.device for f in faults if f.kind == "non_finite"} == {"encoders", "attitude", "camera"}
    assert sum(len(t.faults) > 1 for t in extras()) >= 5
