"""A rotor lost entirely while the UAV is held: the arm balances it, or sets it down where the rails are near."""

import numpy as np
import pytest

from armland.experiments.landing import fly_landing, fly_takeoff
from armland.experiments.landing_judge import tilt_deg
from armland.mission.finals import FINALS
from armland.mission.landing_scenario import landing_scenario

TAKEOFF = ("lift", "carry_up", "hand_back")


def lose(phase, rotor=1, after_s=0.05, more=(), **overrides):
    fault = {"kind": "rotor_loss", "phase": phase, "after_s": after_s, "rotor": rotor}
    scenario = landing_scenario("landing", {"faults": [fault, *more], **overrides})
    return (fly_takeoff if phase in TAKEOFF else fly_landing)(scenario, 1)


def since(outcome):
    """Truth from the begin of the last phase."""
    return outcome.records["truth"][round(1000 * outcome.phases[-1].start_s) :]


def check_held(outcome):
    truth = since(outcome)
    assert (outcome.fault, outcome.end, outcome.state) == ("rotor_lost", "balancing", "held")
    assert outcome.limits_violated == []
    assert truth["touching"].min() == 4
    assert tilt_deg(truth["quat"]).max() < 8.0
    assert outcome.hinge_force_max_n < 30.0
    assert np.linalg.norm(truth["v"][-250:], axis=1).max() < 0.03


@pytest.mark.parametrize("phase", ["hand_over", "lift"])
def test_uav_stays_on_the_arm(phase):
    check_held(lose(phase))


@pytest.mark.slow
@pytest.mark.parametrize("rotor", [1, 2, 3, 4])
@pytest.mark.parametrize("phase", ["capture", "hand_over", "carry", "set_down", *TAKEOFF])
def test_uav_stays_on_the_arm_whichever_rotor_is_lost(phase, rotor):
    check_held(lose(phase, rotor))


def test_topples_without_balancing(monkeypatch):
    # The same end, but the arm holds still.
    end = next(p for p in FINALS if p.name == "balancing")._replace(arm="hold")
    from armland.mission import landing_procedure

    phases = tuple(end if p.name == "balancing" else p for p in landing_procedure.LANDING)
    monkeypatch.setattr("armland.mission.landing_setup.LANDING", phases)
    outcome = lose("carry")
    assert tilt_deg(since(outcome)["quat"]).max() > 40.0


def test_uav_in_flight_is_not_balanced():
    outcome = lose("align")
    assert outcome.end == "abort"
    assert "arm_touched_uav" not in outcome.limits_violated
