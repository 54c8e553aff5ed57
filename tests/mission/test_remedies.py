"""What a mission that was given up says: fault, what holds now, and what helps."""

from armland.mission.finals import FINALS
from armland.mission.landing_procedure import LANDING
from armland.mission.remedies import REMEDIES, STANDING, TIMEOUTS, stopped
from armland.mission.supervisor import FAULTS
from armland.mission.takeoff_procedure import TAKEOFF


def test_every_fault_has_a_remedy_and_every_end_a_description():
    assert set(REMEDIES) == set(FAULTS[1:])
    assert set(STANDING) == {p.name for p in FINALS}


def test_every_phase_that_can_run_out_of_time_into_an_end_says_why():
    for mission in (LANDING, TAKEOFF):
        ends = {p.name for p in mission if p.final}
        for p in mission:
            if not p.final and (p.on_timeout in ends or any(g.target in ends - {"done"} for g in p.guards)):
                assert p.name in TIMEOUTS


def test_description_of_an_end_fits_what_is_commanded_there():
    for p in FINALS:
        text = STANDING[p.name]
        assert ("brakes are on" in text) == (p.arm == "brake")
        assert (p.magnet == "on") == any(word in text for word in ("by the magnet", "magnet on", "magnet holds")), (
            p.name
        )


def test_sentence_names_phase_fault_state_and_remedy():
    text = stopped("holding", "carry", "uav_silent")
    for part in ("holding after carry", "uav_silent", STANDING["holding"], "restore the link"):
        assert part in text


def test_time_out_says_what_was_missing():
    assert "camera" in stopped("refused", "self_test", "none")
    assert "none" not in stopped("refused", "self_test", "none")
