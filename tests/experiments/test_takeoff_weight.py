"""Take-offs with speed in the plant, and the study of the take-off weight."""

import numpy as np
import pytest

from armland.experiments.landing import fly_takeoff, run
from armland.experiments.takeoff_weight import FLOWN, flies_off, flown_limit, study
from armland.mission.landing_scenario import landing_scenario
from armland.mission.landing_setup import set_up
from armland.plant.landing import LandingPlant

STATIC = 4.0 * 1.86


@pytest.mark.parametrize("velocity", [(0.5, 0.0, 0.0), (0.0, -0.6, 0.0), (0.0, 0.0, 0.5)])
def test_takes_off_at_the_speed_that_was_asked_for(velocity):
    outcome = fly_takeoff(landing_scenario("landing", {"place": {"takeoff_velocity_mps": list(velocity)}}), 1)
    assert outcome.success, outcome.reason
    assert outcome.state == "flying"
    assert outcome.release["speed_mps"] == pytest.approx(np.linalg.norm(velocity), rel=0.1)
    assert outcome.release["hinge_force_n"] < 1.0
    assert outcome.release["drop_m"] < 0.03
    truth, phase = outcome.records["truth"], outcome.records["mission"]["phase"]
    begin = int(next(p.start_s for p in outcome.phases if p.name == "leave") * 1000)
    assert len(np.unique(phase)) > 8
    # Once apart, plate and magnet stay apart.
    apart = begin + int(np.argmax(truth["touching"][begin:] == 0))
    assert not truth["touching"][apart + 20 :].any()
    assert not truth["foul"].any()


def test_a_harder_contact_would_rattle_on_the_way():
    # What the softness of the magnet's contacts is for: without it the hinge is never free of force at speed.
    loaded = landing_scenario("landing", {"place": {"takeoff_velocity_mps": [0.5, 0.0, 0.0]}})
    setup = set_up(loaded, "takeoff")
    plant = LandingPlant(loaded, setup.home, "cradle")
    pads = [plant.scene.model.pair(f"magnet_{i + 1}").id for i in range(4)]
    plant.scene.model.pair_solimp[pads, :2] = 0.9999
    records, _ = run(setup, plant)
    assert setup.table.names[int(records["mission"]["phase"][-1])] == "holding"


def test_a_heavy_uav_is_not_taken_for_a_drifting_sensor_while_its_weight_is_found_out():
    outcome = fly_takeoff(landing_scenario("landing", {"extra_mass_kg": 0.1}), 1)
    assert outcome.success, outcome.reason


def test_a_sensor_that_drifts_meanwhile_is_found():
    fault = {"kind": "wrench_drift", "phase": "hand_back", "after_s": 0.05, "size": 12.0}
    outcome = fly_takeoff(landing_scenario("landing", {"faults": [fault]}), 1)
    assert (outcome.fault, outcome.end, outcome.state) == ("wrench_drift", "holding", "held")


def test_a_uav_too_heavy_at_rest_flies_with_the_arms_speed_and_sinks_without():
    weight = 1.0008 * STATIC
    assert flies_off(landing_scenario(), (0.0, -0.6, 0.0), weight)
    assert not flies_off(landing_scenario(), (0.0, 0.0, 0.0), weight)


def test_theory_is_bracketed_monotone_and_says_what_it_would_take():
    found = study(landing_scenario(), flights=False)
    assert found.hover_inflow_mps == pytest.approx(4.92, abs=0.01)
    assert all(0.4 < v < 1.0 for v in found.arm_speed_mps.values())
    for name in ("constant rotor speed", "constant power"):
        kept, free, best = found.sustained[name], found.sustained[f"{name}, no drag"], found.most[name][0]
        assert 1.0 < kept < free < 1.005 < best
        speeds = [found.speed_for_gain[f"{name}, no drag"][g] for g in ("0.05", "0.1", "0.2")]
        assert speeds == sorted(speeds)
        assert found.speed_for_gain[name]["0.2"] is None
        for height in ("0.03", "0.5"):
            thrown = found.thrown[f"{name}, {height} m"]
            assert thrown["from rest"] < thrown["thrown"] < best
    assert "no practical size" in found.verdict
    assert not found.flights


@pytest.mark.slow
def test_flights_find_theirs_near_theory():
    scenario = landing_scenario()
    for _, direction, speed in FLOWN[:3]:
        velocity = (speed, 0.0, 0.0) if direction == "forward" else (0.0, -speed, 0.0)
        about = 1.0 if speed == 0.0 else 1.0016 * (speed / 0.6) ** 2 + 1.0 - (speed / 0.6) ** 2
        flown, half, inside = flown_limit(scenario, velocity, about, lambda: None)
        assert inside
        assert abs(flown - about) < 1e-3
        assert half < 3e-4
