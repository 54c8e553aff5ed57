"""Take-offs with speed in the plant, and the study of the take-off weight."""

import numpy as np
import pytest

from armland.experiments.episode import fly, fly_prepared, prepare
from armland.experiments.takeoff_weight.study import FLOWN, bisected, flies_off, flown_limit, loaded, study


@pytest.mark.parametrize(
    "velocity",
    [
        (0.5, 0.0, 0.0),
        pytest.param((0.0, -0.6, 0.0), marks=pytest.mark.slow),
        pytest.param((0.0, 0.0, 0.5), marks=pytest.mark.slow),
    ],
)
def test_takes_off_at_the_speed_that_was_asked_for(landing_scenario, velocity):
    episode = fly(landing_scenario.replaced({"place": {"takeoff_velocity_mps": velocity}}), "takeoff", 1)
    j, truth = episode.judgement, episode.ticks["truth"]
    assert j.success, j.reason
    assert j.state == "flying"
    release = j.figures["release"]
    assert release["speed_mps"] == pytest.approx(np.linalg.norm(velocity), rel=0.1)
    assert release["hinge_force_n"] < 1.0
    assert release["drop_m"] < 0.03
    begin = int(next(p.start_s for p in j.phases if p.name == "leave") * 1000)
    # Once apart, plate and magnet stay apart.
    apart = begin + int(np.argmax(truth["touching"][begin:] == 0))
    assert not truth["touching"][apart + 20 :].any()
    assert not truth["foul"].any()


@pytest.mark.slow
def test_a_harder_contact_would_rattle_on_the_way(landing_scenario):
    # What the softness of the magnet's contacts is for: without it the hinge is never free of force at speed.
    flight = prepare(landing_scenario.replaced({"place": {"takeoff_velocity_mps": (0.5, 0.0, 0.0)}}), "takeoff")
    model = flight.simulator.scene.model
    model.pair_solimp[[model.pair(f"magnet_{i + 1}").id for i in range(4)], :2] = 0.9999
    assert fly_prepared(flight).judgement.end == "holding"


def test_a_heavy_uav_is_not_taken_for_a_drifting_sensor_while_its_weight_is_found_out(landing_scenario):
    result = fly(landing_scenario.replaced({"uav": {"extra_mass_kg": 0.1}}), "takeoff", 1).result
    assert result["success"], result["reason"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "size", "found"),
    [("wrench_drift", size, "wrench_drift") for size in (1.0, 3.0, 12.0)]
    + [("thrust_loss", size, "thrust_lost") for size in (0.3, 0.4)],
)
def test_what_drifts_meanwhile_is_told_from_what_is_lost(landing_scenario, kind, size, found):
    fault = {"kind": kind, "phase": "hand_back", "after_s": 0.05, "size": size}
    j = fly(landing_scenario.replaced({"faults": [fault]}), "takeoff", 1).judgement
    assert (j.fault, j.end, j.state) == (found, "holding", "held")


def test_theory_is_bracketed_monotone_and_says_what_it_would_take(landing_scenario):
    found = study(landing_scenario, flights=False)
    assert found.hover_inflow_mps == pytest.approx(4.92, abs=0.01)
    assert all(0.4 < v < 1.0 for v in found.arm_speed_mps.values())
    theory = found.theory
    for name in ("constant rotor speed", "constant power"):
        kept, free, best = theory.sustained[name], theory.sustained[f"{name}, no drag"], theory.most[name][0]
        assert 1.0 < kept < free < 1.005 < best
        speeds = [theory.speed_for_gain[f"{name}, no drag"][g] for g in ("0.05", "0.1", "0.2")]
        assert speeds == sorted(speeds)
        assert theory.speed_for_gain[name]["0.2"] is None
        for height in ("0.03", "0.5"):
            thrown = theory.thrown[f"{name}, {height} m"]
            assert thrown["from rest"] < thrown["thrown"] < best
    assert "no practical size" in found.verdict
    assert not found.flights
    assert set(found.result()) >= {"sustained", "most", "speed_for_gain", "thrown", "flights", "verdict"}


@pytest.mark.slow
def test_flights_find_theirs_near_theory(landing_scenario):
    for _, direction, speed in FLOWN[:3]:
        velocity = (speed, 0.0, 0.0) if direction == "forward" else (0.0, -speed, 0.0)
        about = 1.0 if speed == 0.0 else 1.0016 * (speed / 0.6) ** 2 + 1.0 - (speed / 0.6) ** 2
        flown, half, inside = flown_limit(landing_scenario, velocity, about, lambda _: None)
        assert inside
        assert abs(flown - about) < 1e-3
        assert half < 3e-4


STATIC, EMPTY = 4.0 * 1.86, 0.5277 * 9.81


def test_a_uav_too_heavy_at_rest_flies_with_the_arms_speed_and_sinks_without(landing_scenario):
    weight = 1.0008 * STATIC
    assert flies_off(loaded(landing_scenario, (0.0, -0.6, 0.0), weight, EMPTY))
    assert not flies_off(loaded(landing_scenario, (0.0, 0.0, 0.0), weight, EMPTY))


def test_bisection_finds_the_limit_and_says_whether_it_saw_both_sides():
    tried = []
    found, half, inside = bisected(lambda share: share < 1.0021, 1.0, tried.append)
    assert abs(found - 1.0021) <= half < 3e-4
    assert inside
    assert tried == [1, 2, 3, 4, 5]
    assert bisected(lambda _: True, 1.0, lambda _: None)[2] is False
