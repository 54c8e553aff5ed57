"""What a mission that was given up says: fault, what is so now, and what helps."""

from armland.mission.registry import MISSIONS
from armland.mission.supervisor.ends import FINALS, HINGED_FINALS
from armland.mission.supervisor.remedies import REMEDIES, STANDING, stopped
from armland.mission.supervisor.table import FAULTS
from armland.scenario import load_scenario


def test_every_fault_has_a_remedy_and_every_end_a_description():
    assert set(REMEDIES) == set(FAULTS[1:])
    assert set(STANDING) == {p.name for p in (*FINALS, *HINGED_FINALS)}


def test_every_phase_that_can_run_out_of_time_into_an_end_says_why():
    scenario = load_scenario("landing", {"place": {"takeoff_velocity_mps": [0.3, 0.0, 0.0]}})
    for mission in (MISSIONS["landing"], MISSIONS["takeoff"]):
        phases = mission.phases(scenario)
        ends = {p.name for p in phases if p.final}
        for p in phases:
            leads_to_safety = p.on_timeout in ends - {"done"} or any(g.target in ends - {"done"} for g in p.guards)
            if not p.final and leads_to_safety:
                assert p.name in mission.timeouts, p.name


def test_description_of_an_end_fits_what_is_commanded_there():
    for p in FINALS:
        text = STANDING[p.name]
        assert ("brakes are on" in text) == (p.arm == "brake")
        assert (p.magnet == "on") == any(word in text for word in ("by the magnet", "magnet on", "magnet holds")), (
            p.name
        )


def test_sentence_names_phase_fault_state_and_remedy():
    text = stopped("holding", "carry", "uav_silent", "the UAV has fallen", MISSIONS["landing"].timeouts)
    for part in ("holding after carry", "uav_silent", "now the UAV has fallen", "restore the link"):
        assert part in text
    # What was meant is not claimed to be so.
    assert STANDING["holding"] not in text


def test_time_out_says_what_was_missing():
    text = stopped("refused", "self_test", "none", "the arm holds still", MISSIONS["takeoff"].timeouts)
    assert "camera" in text
    assert "none" not in text
