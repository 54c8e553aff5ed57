"""Every cell of the fault table has a trial, and every way to fail of the plant is used."""

from armland.mission.registry import MISSIONS
from armland.mission.supervisor.table import FAULT_TABLE, FAULTS
from armland.mission.table.phases import KINDS
from armland.scenario.faults import FAILURES
from pages.trials import CELLS, EXTRAS, OPEN, OTHERWISE, PHASES, PROVOKED, all_trials, cells, trial


def test_every_cell_of_the_fault_table_has_a_trial(landing_scenario):
    for mission, phases in PHASES.items():
        flown = MISSIONS[mission].phases(landing_scenario)
        assert {p.kind for p in flown if not p.final} == set(phases)
        for kind, phase in phases.items():
            assert {p.name: p.kind for p in flown}[phase] == kind
    there = {(m, f, k) for m, f, k in cells()}
    # A law that fails is no failure of the plant, and on the hinge the paper's experiments have no other fault.
    assert (
        {f for _, f, _ in there}
        == set(PROVOKED)
        == set(FAULT_TABLE) - {"law_failed"}
        == set(FAULTS[1:]) - {"law_failed"}
    )
    assert {k for _, _, k in there} == set(KINDS) - {"hinge"}
    names = {t.name for t in all_trials()}
    assert len(names) == len(all_trials()) == 258
    assert {f"{m} {f} {k}" for m, f, k in there - set(OPEN)} <= names
    assert set(CELLS) <= there


def test_every_cell_but_dashes_is_provoked_to_the_end_that_the_table_names():
    for mission, fault, kind in cells():
        if (mission, fault, kind) in OPEN or FAULT_TABLE[fault][kind] == "-":
            continue
        t = trial(mission, fault, kind)
        as_told = (t.end, t.found in (fault, "slip")) == (FAULT_TABLE[fault][kind], True)
        assert as_told == ((mission, fault, kind) not in OTHERWISE), t.name


def test_every_way_to_fail_of_the_plant_is_used():
    used = {f.kind for t in all_trials() for f in t.faults}
    # What remains is the physical twist of a UAV, which no means of this arm can undo.
    assert set(FAILURES) - used == {"twist"}


def test_extras_cover_both_directions_of_the_link_and_every_device():
    faults = [f for t in EXTRAS for f in t.faults]
    assert {"uplink_loss", "downlink_loss", "link_loss", "unreachable", "rotor_loss"} <= {f.kind for f in faults}
    assert {f.device for f in faults if f.kind == "non_finite"} == {"encoders", "attitude", "camera"}
    assert sum(len(t.faults) > 1 for t in EXTRAS) >= 5
