"""What a mission that was given up says: fault, what is so now, and what helps."""

import numpy as np
import pytest

from armland.mission.registry import MISSIONS
from armland.mission.supervisor.ends import FINALS, HINGED_FINALS
from armland.mission.supervisor.remedies import LEARNT, REMEDIES, STANDING, UNMET, learnt_values, stopped
from armland.mission.supervisor.table import FAULTS
from armland.mission.table.phases import SIGNAL
from armland.records import layout
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


def test_time_out_names_the_signals_that_did_not_come():
    bits = 1 << SIGNAL["uav_seen"] | 1 << SIGNAL["bias_known"]
    text = stopped("refused", "self_test", "none", "so", MISSIONS["landing"].timeouts, unmet=bits)
    assert "(the UAV was not seen, the force sensor's zero did not settle)" in text
    assert "magnet did not" not in text


def test_every_signal_has_words_for_where_it_does_not_come():
    assert UNMET.keys() == SIGNAL.keys()


def learnt(**values):
    """What was learnt, with fields of the estimate set."""
    estimate = np.zeros(1, layout("estimate", 7))
    for name, value in values.items():
        estimate[name] = value
    return learnt_values(estimate[0])


@pytest.mark.parametrize(
    ("fault", "values", "words"),
    [
        ("camera_noise", {"camera_noise": 5.8}, "5.8 times"),
        ("link_late", {"uplink": 0.12, "downlink": 0.09}, "120 ms up and 90 ms down"),
        ("thrust_lost", {"hover": 6.9, "weight": 5.18}, "asked for 6.90 N; its weight was learnt as 5.18 N"),
        ("thrust_short", {"hover": 6.9, "weight": 5.18}, "6.90 N was learnt to carry its 5.18 N"),
        (
            "wrench_drift",
            {"hinge_force": [3.0, 0.0, -4.0], "weight": 5.2},
            "5.0 N were felt; the UAV's weight was learnt as 5.20 N",
        ),
        ("overload", {"hinge_force": [0.0, 0.0, 70.0]}, "70.0 N were felt"),
    ],
)
def test_sentence_says_what_was_learnt_of_the_cause(fault, values, words):
    assert fault in LEARNT
    assert words in stopped("abort", "guide", fault, "so", {}, learnt(**values))
    assert words not in stopped("abort", "guide", fault, "so", {})


@pytest.mark.parametrize(("ratio", "said"), [(1.5, False), (3.0, True)])
def test_time_out_says_that_the_camera_errs_where_it_does(ratio, said):
    text = stopped("abort", "miss", "none", "so", MISSIONS["landing"].timeouts, learnt(camera_noise=ratio))
    assert ("the camera errs 3.0 times what it claims" in text) == said
