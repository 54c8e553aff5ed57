"""What is commanded in the ends of a mission."""

from armland.mission.registry import MISSIONS
from armland.mission.supervisor.ends import FINALS, HINGED_FINALS, TAKEOFF_FINALS
from armland.scenario import load_scenario


def test_all_ends_are_final_and_lead_on_by_graver_faults_only():
    for p in (*FINALS, *TAKEOFF_FINALS, *HINGED_FINALS):
        assert p.final
        assert not p.guards


def test_no_phase_allows_more_force_where_nothing_may_touch():
    scenario = load_scenario("landing")
    for name in ("landing", "takeoff"):
        for p in MISSIONS[name].phases(scenario):
            if p.kind == "flight" and not p.final:
                assert p.load == "carried", p.name


def test_no_end_is_held_by_a_law_that_may_have_failed():
    assert not any(p.held for p in (*FINALS, *TAKEOFF_FINALS))
    assert not next(p for p in HINGED_FINALS if p.name == "resting").held
