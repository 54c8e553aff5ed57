"""A rotor lost entirely while the UAV is held: the arm balances it, or sets it down where the rails are near."""

import numpy as np
import pytest

from armland.experiments.episode import fly
from armland.experiments.judge.whereabouts import tilt_deg
from armland.mission.registry import MISSIONS
from armland.scenario import load_scenario

TAKEOFF = ("lift", "carry_up", "hand_back")


def lose(phase, rotor=1, after_s=0.05, **overrides):
    fault = {"kind": "rotor_loss", "phase": phase, "after_s": after_s, "rotor": rotor}
    scenario = load_scenario("landing", {"faults": [fault], **overrides})
    return fly(scenario, "takeoff" if phase in TAKEOFF else "landing", 1)


def since(episode):
    """Truth from the begin of the last phase."""
    return episode.ticks["truth"][round(1000 * episode.judgement.phases[-1].start_s) :]


def check_held(episode, tilt=8.0, state="held"):
    truth, j = since(episode), episode.judgement
    assert (j.fault, j.end, j.state) == ("rotor_lost", "balancing", state)
    assert j.limits_violated == []
    assert truth["touching"].min() == 4
    assert tilt_deg(truth["quat"]).max() < tilt
    assert j.hinge_force_max_n < 40.0
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


@pytest.mark.slow
def test_uav_is_balanced_in_wind_with_a_biased_attitude():
    # Of seeds 301 to 348 all are; of 101 to 196 three are not: an angle at which the wind lets it stand, which is not known soon
    # enough, takes the pivot to the end of its reach.
    fault = {"kind": "rotor_loss", "phase": "carry", "after_s": 0.05}
    scenario = load_scenario("landing", {"faults": [fault], "deviation": {"level": "published"}})
    flown = [fly(scenario, "landing", seed).judgement for seed in range(101, 125)]
    assert {(j.fault, j.end) for j in flown} == {("rotor_lost", "balancing")}
    assert sum(j.state == "held" and not j.limits_violated for j in flown) >= 22


def test_leans_on_the_hinges_stops_without_balancing(monkeypatch):
    # The same end, but the arm holds still.
    mission = MISSIONS["landing"]

    def still(scenario):
        return tuple(p._replace(arm="hold") if p.name == "balancing" else p for p in mission.phases(scenario))

    monkeypatch.setitem(MISSIONS, "landing", mission._replace(phases=still))
    episode = lose("carry")
    assert tilt_deg(since(episode)["quat"]).max() > 40.0
    assert tilt_deg(since(episode)["quat"])[-250:].min() > 25.0
    assert episode.judgement.state == "held"


@pytest.mark.slow
@pytest.mark.parametrize("rotor", [1, 3])
@pytest.mark.parametrize(("phase", "after_s"), [("set_down", 0.9), ("set_down", 1.2), ("lift", 0.5), ("lift", 0.65)])
def test_uav_near_the_rails_is_set_down(phase, after_s, rotor):
    episode = lose(phase, rotor, after_s)
    truth, j = since(episode), episode.judgement
    # Just above the rails it may be down before it has tilted at all.
    assert j.end in ("balancing", "done")
    assert j.state == "standing"
    assert j.limits_violated == []
    assert tilt_deg(truth["quat"])[-250:].max() < 0.5


@pytest.mark.slow
@pytest.mark.parametrize("rotor", [1, 3])
def test_without_the_uavs_word_a_lost_rotor_is_a_lean_like_another(rotor):
    j = lose("carry", rotor, onboard={"rotor_watch": 0.0}).judgement
    assert (j.fault, j.state) == ("uav_tilt", "held")


@pytest.mark.slow
def test_begin_of_the_hand_over_needs_the_watch_on_board():
    assert tilt_deg(since(lose("hand_over", onboard={"rotor_watch": 0.0}))["quat"]).max() > 40.0


def test_lost_in_flight_the_uav_falls_and_the_reason_says_so():
    j = lose("guide").judgement
    assert (j.end, j.state) == ("abort", "lost")
    # The arm can only draw back; what falls may strike it and the rails.
    assert {"uav_fell", "uav_touched_cradle"} <= set(j.limits_violated)
    assert j.reason.startswith("limits violated: uav_touched_cradle (in guide at ")
    assert "the UAV is lost: it fell" in j.reason
    assert "flies" not in j.reason
