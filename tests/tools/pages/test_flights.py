"""Every cell of the fault table provoked in the plant, by continuing the fault-free mission of the same seed from the phase's begin.

Each trial has three controls: without the failure the mission succeeds; with the supervisor blind to the fault it comes out
differently; and what every trial must show (`flights.unsafe`) is itself shown to fail where it should.
"""

from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest

from armland.experiments.episode import fly
from armland.mission.supervisor.remedies import REMEDIES
from pages.flights import SEED, branches, fly_trial, unsafe
from pages.trials import PHASES, PROVOKED, all_trials, failure, trial

PAGE = Path(__file__).parents[3] / "docs" / "faults.md"

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


# A flight has 25 MB of ticks.
@lru_cache(maxsize=12)
def flown(t):
    return fly_trial(t)


@pytest.fixture(scope="module", params=TRIALS)
def flight(request):
    """Each trial, flown once for all tests that look at it."""
    return flown(request.param)


@pytest.fixture(scope="module")
def page():
    return {line.split(" | ")[0].strip("| "): line for line in PAGE.read_text(encoding="utf-8").splitlines()}


@pytest.mark.parametrize("mission", ["landing", "takeoff"])
def test_without_a_failure_the_mission_succeeds(mission):
    base = branches(mission)
    assert base.names[int(base.ticks["mission"]["phase"][-1])] == "done"
    assert not base.ticks["mission"]["fault"].any()


def test_mission_that_is_continued_is_byte_for_byte_the_one_flown_through(landed):
    base = branches("landing")
    assert landed.ticks.tobytes() == base.ticks.tobytes()
    for start in (PHASES["landing"]["held"], "done"):
        never = failure(start, 3000.0, kind="link_loss")
        assert base.fly((never,))[0].tobytes() == base.ticks.tobytes()
    fault = failure(PHASES["landing"]["held"], kind="link_loss")
    whole = fly(base.run.scenario.replaced({"faults": [fault.model_dump()]}), "landing", SEED)
    assert base.fly((fault,))[0].tobytes() == whole.ticks.tobytes()
    assert whole.result["never_acted"] == []


@pytest.mark.slow
def test_takeoff_that_is_continued_is_byte_for_byte_the_one_flown_through(taken_off):
    base = branches("takeoff")
    assert taken_off.ticks.tobytes() == base.ticks.tobytes()
    never = failure(PHASES["takeoff"]["held"], 3000.0, kind="link_loss")
    assert base.fly((never,))[0].tobytes() == base.ticks.tobytes()


def test_fault_ends_safely(flight):
    t = flight.trial
    assert flight.found[-1] == t.found
    assert unsafe(flight) == []
    assert flight.ends == t.ends
    assert flight.judgement.state in t.states


def test_page_says_what_the_trial_shows(flight, page):
    """Other processors round differently."""
    from pages.faults import row

    written, now = (line.strip("| ").split(" | ") for line in (page[flight.trial.name], row(flight)))
    assert written[1:5] == now[1:5], "run: make pages"
    for a, b, tolerance in zip(written[5:], now[5:], (0.3, 0.2, 15.0, 2.0, 5.0), strict=True):
        assert float(a) == pytest.approx(float(b), rel=0.25, abs=tolerance)


@pytest.mark.parametrize("t", [t for t in all_trials() if t.name in QUICK], ids=lambda t: t.name)
def test_reason_names_fault_state_and_remedy(t):
    judgement = flown(t).judgement
    assert f"ended in {t.ends[-1]}" in judgement.reason
    assert t.found in judgement.reason
    assert REMEDIES[t.found][1] in judgement.reason
    where = {"held": "held by the arm", "flying": "the UAV flies", "standing": "stands on the cradle"}
    assert where[judgement.state] in judgement.reason


BLIND = {
    "non_finite": ("landing", "touch", ("non_finite", "wrench_stale")),
    "arm_stale": ("landing", "held", ("arm_stale",)),
    "uav_silent": ("landing", "held", ("uav_silent",)),
    # Elsewhere the phase runs out of time, too.
    "camera_stale": ("takeoff camera after the end", ("camera_stale",)),
    "wrench_stale": ("landing", "touch", ("wrench_stale",)),
    "wrench_drift": ("landing", "held", ("wrench_drift",)),
    "magnet_coil": ("landing", "touch", ("magnet_coil",)),
    "overload": ("landing", "held", ("overload",)),
    "rotor_lost": ("landing", "held", ("rotor_lost",)),
    "uav_tilt": ("landing", "ground", ("uav_tilt",)),
    "slip": ("landing", "held", ("slip",)),
    "near_limit": ("landing", "touch", ("near_limit",)),
    "encoder_frozen": ("landing", "held", ("encoder_frozen",)),
    "camera_leap": ("landing", "flight", ("camera_leap",)),
    "camera_noise": ("takeoff", "ground", ("camera_noise",)),
    "wrench_wrong": ("landing", "ground", ("wrench_wrong", "wrench_drift")),
    # In the air the UAV that hangs on it is taken for one that is too weak to rise; on the cradle the arm tears it off.
    "magnet_stuck": ("landing", "cradle", ("magnet_stuck",)),
    "arm_blocked": ("landing", "flight", ("arm_blocked",)),
    # A flying UAV falls either way; one on the magnet need not be let go.
    "thrust_lost": ("takeoff", "held", ("thrust_lost",)),
    "thrust_short": ("takeoff", "flight", ("thrust_short",)),
    "link_late": ("landing", "flight", ("link_late",)),
}
"""Fault -> cell, or name of the trial, in which its loss is seen, and to what the supervisor is blind; NaN from a device is also a
stale device."""


def blinded(fault):
    """Trial of `BLIND` as flown by the supervisor, and by one that is blind to it."""
    *where, blind_to = BLIND[fault]
    t = trial(where[0], fault, where[1]) if len(where) == 2 else next(t for t in all_trials() if t.name == where[0])
    return flown(t), fly_trial(t, blind_to)


@pytest.mark.slow
@pytest.mark.parametrize("fault", [f for f in PROVOKED if f != "power_lost"])  # Silence leads where it leads.
def test_blind_to_the_fault_the_same_failure_comes_out_differently(fault):
    seen, blind = blinded(fault)
    assert not set(BLIND[fault][-1]) & set(blind.found)
    assert blind.ends != seen.ends or blind.reaction_s > 5.0 * seen.reaction_s


@pytest.mark.slow
@pytest.mark.parametrize("fault", ["thrust_lost", "thrust_short", "link_late"])
def test_blind_to_what_keeps_it_from_flying_the_uav_is_lost(fault):
    seen, blind = blinded(fault)
    assert seen.judgement.state != "lost"
    assert unsafe(seen) == []
    assert blind.judgement.state == "lost"


@pytest.mark.slow
def test_blind_to_a_magnet_that_sticks_the_arm_tears_at_it():
    seen, blind = blinded("magnet_stuck")
    assert seen.force_n < 25.0
    assert blind.force_n > 90.0


@pytest.mark.slow
def test_blind_to_a_dead_encoder_the_arm_runs_into_the_floor():
    t = trial("landing", "arm_stale", "held")
    assert "arm_touched_floor" in fly_trial(t, ("arm_stale",)).judgement.limits_violated
    assert "arm_touched_floor" not in flown(t).judgement.limits_violated


@pytest.mark.slow
def test_blind_to_an_arm_that_is_flung_it_hits_the_cradle():
    t = trial("landing", "near_limit", "touch")
    assert "arm_touched_cradle" in fly_trial(t, ("near_limit", "overload")).judgement.limits_violated
    assert "arm_touched_cradle" not in flown(t).judgement.limits_violated


@pytest.mark.slow
def test_blind_to_a_silent_link_the_uav_is_let_go_with_its_rotors_running():
    t = trial("landing", "uav_silent", "held")
    blind, seen = fly_trial(t, ("uav_silent",)).ticks[-1], flown(t).ticks[-1]
    assert blind["command"]["magnet"] == 0
    assert blind["truth"]["rotor_thrust"].sum() > 1.0
    assert seen["command"]["magnet"] == 1


@pytest.mark.slow
def test_blind_to_slip_the_uav_falls_off():
    t = trial("landing", "slip", "held")
    blind, seen = fly_trial(t, ("slip", "rotor_lost")), flown(t)
    assert any("fell" in line for line in unsafe(blind))
    assert blind.sink_mps > 1.5 * seen.sink_mps


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
    ticks = flight.ticks.copy()
    change(ticks)
    with np.errstate(invalid="ignore"):
        assert any(word in line for line in unsafe(flight._replace(ticks=ticks)))
