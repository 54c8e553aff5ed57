"""A rotor lost entirely while the UAV is held: the arm balances it, or sets it down where the rails are near."""

import numpy as np
import pytest

from armland.experiments.landing import fly_landing, fly_takeoff
from armland.experiments.landing_judge import tilt_deg
from armland.mission.finals import FINALS
from armland.mission.landing_procedure import LANDING
from armland.mission.landing_scenario import landing_scenario

TAKEOFF = ("lift", "carry_up", "hand_back")


def lose(phase, rotor=1, after_s=0.05, more=(), **overrides):
    fault = {"kind": "rotor_loss", "phase": phase, "after_s": after_s, "rotor": rotor}
    scenario = landing_scenario("landing", {"faults": [fault, *more], **overrides})
    return (fly_takeoff if phase in TAKEOFF else fly_landing)(scenario, 1)


def since(outcome):
    """Truth from the begin of the last phase."""
    return outcome.records["truth"][round(1000 * outcome.phases[-1].start_s) :]


def check_held(outcome, tilt=8.0, state="held"):
    truth = since(outcome)
    assert (outcome.fault, outcome.end, outcome.state) == ("rotor_lost", "balancing", state)
    assert outcome.limits_violated == []
    assert truth["touching"].min() == 4
    assert tilt_deg(truth["quat"]).max() < tilt
    assert outcome.hinge_force_max_n < 40.0
    assert np.linalg.norm(truth["v"][-250:], axis=1).max() < 0.03


@pytest.mark.parametrize("phase", ["hand_over", "lift"])
def test_uav_stays_on_the_arm(phase):
    check_held(lose(phase), state="standing" if phase == "lift" else "held")


@pytest.mark.slow
@pytest.mark.parametrize("rotor", [1, 2, 3, 4])
@pytest.mark.parametrize("phase", ["capture", "hand_over", "carry", "set_down", *TAKEOFF])
def test_uav_stays_on_the_arm_whichever_rotor_is_lost(phase, rotor):
    # At the begin of the lift the rails are still near.
    check_held(lose(phase, rotor), state="standing" if phase == "lift" else "held")


def test_topples_without_balancing(monkeypatch):
    # The same end, but the arm holds still.
    end = next(p for p in FINALS if p.name == "balancing")._replace(arm="hold")
    phases = tuple(end if p.name == "balancing" else p for p in LANDING)
    monkeypatch.setattr("armland.mission.landing_setup.LANDING", phases)
    outcome = lose("carry")
    assert tilt_deg(since(outcome)["quat"]).max() > 40.0
    assert outcome.state == "lost"


@pytest.mark.slow
@pytest.mark.parametrize("rotor", [1, 3])
@pytest.mark.parametrize(("phase", "after_s"), [("set_down", 0.9), ("set_down", 1.2), ("lift", 0.5), ("lift", 0.65)])
def test_uav_near_the_rails_is_set_down(phase, after_s, rotor):
    outcome = lose(phase, rotor, after_s)
    truth = since(outcome)
    # Just above the rails it may be down before it has tilted at all.
    assert outcome.end in ("balancing", "done")
    assert outcome.state == "standing"
    assert outcome.limits_violated == []
    assert tilt_deg(truth["quat"])[-250:].max() < 0.5


@pytest.mark.slow
@pytest.mark.parametrize("rotor", [1, 3])
def test_ground_alone_saves_it_where_the_arm_carries_half(rotor):
    check_held(lose("carry", rotor, onboard_rotor_watch=0.0), tilt=12.0)


@pytest.mark.slow
def test_begin_of_the_hand_over_needs_the_watch_on_board():
    outcome = lose("hand_over", onboard_rotor_watch=0.0)
    assert tilt_deg(since(outcome)["quat"]).max() > 40.0


def test_lost_in_flight_the_uav_falls_beside_an_arm_that_draws_back():
    outcome = lose("guide")
    assert (outcome.end, outcome.state) == ("abort", "lost")
    assert outcome.limits_violated == []
