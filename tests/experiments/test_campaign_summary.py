"""The summary of a campaign: counts, spreads, the seed of the worst flight, and bounds that can fail."""

from dataclasses import replace

import pytest

from armland.experiments.campaign_summary import summarise
from armland.experiments.landing import LandingOutcome
from armland.experiments.landing_judge import PhaseTime

NOTHING = {"speed_mps": None, "tilt_deg": None, "offset_m": None}


def outcome(seed, speed=0.02, success=True, reason="landed", **more):
    touchdown = {"speed_mps": speed, "tilt_deg": 0.2, "offset_m": 0.002}
    capture = {"offset_m": 0.001, "relative_speed_mps": 0.12, "tilt_deg": 1.0}
    whole = LandingOutcome(
        success, reason, [PhaseTime("done", 0.0, 17.0)], 0, capture, touchdown, 27.0, 0.3, [], 20.0, seed=seed
    )
    return replace(whole, **more)


def spread(summary, name):
    (found,) = (s for s in summary.spreads if s.name.startswith(name))
    return found


def test_counts_and_interval():
    flights = [outcome(i) for i in range(8)] + [outcome(8, success=False, reason="lost"), outcome(9, retries=2)]
    summary = summarise(flights, 106.0)
    assert (summary.flights, summary.successes, summary.retries) == (10, 9, 2)
    assert summary.reasons == {"lost": 1}
    # Wilson's interval of 9 in 10, worked by hand: (p + z²/2n ± z √(p(1−p)/n + z²/4n²)) / (1 + z²/n).
    assert summary.interval == pytest.approx((0.5958, 0.9821), abs=1e-3)


def test_worst_flight_is_named_and_its_bound_can_fail():
    summary = summarise([outcome(1), outcome(2, speed=0.2), outcome(3)], 106.0)
    worst = spread(summary, "touchdown speed")
    assert (worst.worst, worst.worst_seed, worst.median) == (0.2, 2, 0.02)
    assert not worst.holds
    assert spread(summary, "touchdown tilt").holds
    assert not spread(summarise([outcome(1)], 20.0), "hinge force max").holds


def test_figures_that_no_flight_has_are_left_out():
    flights = [outcome(1, touchdown=NOTHING, release={"speed_mps": 0.01, "drop_m": 0.002, "hinge_force_n": 0.1})]
    names = [s.name for s in summarise(flights, 106.0).spreads]
    assert not any(n.startswith("touchdown") for n in names)
    assert "release drop [mm]" in names


def test_limits_are_counted_by_flight():
    flights = [outcome(1, limits_violated=["torque_rate"]), outcome(2, limits_violated=["torque_rate", "singularity"])]
    assert summarise(flights, 106.0).violated == {"torque_rate": 2, "singularity": 1}


def test_result_is_plain_data():
    import json

    assert json.loads(json.dumps(summarise([outcome(1)], 106.0).result()))["spreads"][0]["worst_seed"] == 1
