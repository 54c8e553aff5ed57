"""The spread: what its ranges make of a scenario, what its figures measure, and what the demonstrator from data gives."""

import numpy as np
import pytest

from armland.experiments import spread as module
from armland.experiments.paper import metrics_of, prepare, resting, run_experiments
from armland.experiments.spread import (
    E1_LARGEST,
    E2_LARGEST,
    PAPER,
    RATIO,
    Demonstrator,
    calibrated,
    figures_of,
    merged,
)
from armland.scenario import load_scenario


@pytest.fixture(scope="module")
def from_data():
    """Flies E1 to E3 of `paper_bench` with changes; each once."""
    known = {}

    def fly(**changes):
        if repr(changes) not in known:
            scenario = load_scenario("paper_bench").replaced(changes)
            known[repr(changes)] = run_experiments(prepare(scenario, ["E1", "E2", "E3"]))
        return known[repr(changes)]

    return fly


def test_every_calibrated_value_has_a_knob_that_moves_all_its_axes(paper_scenario):
    knobs = calibrated()
    assert [k.name for k in knobs][:2] == ["onboard.kp_nm", "onboard.kd_nms"]
    assert len(knobs) == 7
    low, high = (paper_scenario.replaced(merged(knobs, np.full(7, u))) for u in (0.0, 1.0))
    assert low.onboard.kp_nm == pytest.approx((0.29, 0.29, 0.2175))
    assert high.link.torque_limit_nm == pytest.approx((0.34, 0.34, 0.34 * 2.0 / 3.0))
    assert (low.control.thrust_n, high.control.thrust_n) == (0.5, 4.7)


def test_figures_are_those_of_the_flights(reproduced, paper_scenario):
    outcome = reproduced[0]
    figures = figures_of(outcome, paper_scenario.link.torque_limit_nm)
    assert list(figures) == list(PAPER)
    assert figures[E1_LARGEST] == outcome.metrics["E1"].attitude_max_deg
    assert figures["E2's overshoot over E1's, x"] == pytest.approx(0.235, abs=0.005)
    assert figures["E2: swing at rest (°)"] == resting(outcome.episodes["E2"]).swing_deg > 1.0
    # The UAV's limit is what the law runs into; without one it is never reached.
    assert figures["E2: share of time at the torque limit"] == pytest.approx(0.90, abs=0.01)
    assert figures_of(outcome, (10.0, 10.0, 10.0))["E2: share of time at the torque limit"] == 0.0


@pytest.mark.parametrize(("thrust", "ratio"), [(0.5, 0.27), (4.7, 0.99)])
def test_ratio_of_the_z_errors_follows_the_thrust(paper_scenario, thrust, ratio):
    flown = run_experiments(prepare(paper_scenario.replaced({"control": {"thrust_n": thrust}}), ["E2", "E3"]))
    assert flown.metrics["E3"].position_rms_m[2] / flown.metrics["E2"].position_rms_m[2] == pytest.approx(
        ratio, abs=0.01
    )


def test_bias_of_the_landing_takes_the_better_z_away(reproduced, paper_scenario):
    bias = load_scenario("landing").imperfections.force_bias_n
    biased = module._biased_ratio(paper_scenario, bias)
    without = figures_of(reproduced[0], paper_scenario.link.torque_limit_nm)[RATIO]
    assert without < 0.5 < biased


def test_demonstrator_from_data_misses_both_published_angles(from_data):
    """What comes out, not what was hoped for: E1 two thirds as far as published, and E2 not less but more than twice as far as E1."""
    outcome = from_data()
    assert outcome.metrics["E1"].attitude_max_deg == pytest.approx(5.98, abs=0.02)
    assert outcome.metrics["E2"].attitude_max_deg > 2.0 * outcome.metrics["E1"].attitude_max_deg
    failed = {v.claim.partition(" in")[0] for v in outcome.verdicts if not v.holds}
    assert failed >= {"E1 deviates up to 9.2°", "E2 deviates up to 6.8°"}


@pytest.mark.parametrize(
    "change",
    [{"uplink_delay_ms": 0.0, "downlink_delay_ms": 0.0}, {"torque_limit_nm": (0.03, 0.03, 0.02)}],
    ids=["no delay", "limit"],
)
def test_delay_is_what_makes_e2_worse_and_a_low_limit_hides_it(from_data, change):
    flown = from_data(link=change).metrics
    assert flown["E2"].attitude_max_deg < 0.7 * flown["E1"].attitude_max_deg


def test_points_whose_uav_falls_are_told_apart():
    def point(e1, e2):
        return dict.fromkeys(PAPER, 0.0) | {E1_LARGEST: e1, E2_LARGEST: e2}

    found = Demonstrator("fitted", point(9.1, 6.8), [point(5.0, 8.0), point(170.0, 8.0), point(5.0, 50.0)], {})
    assert found.standing == [point(5.0, 8.0)]


@pytest.mark.slow
def test_whole_spread_is_flown_and_repeats(paper_scenario):
    told = []
    found = module.spread(paper_scenario, load_scenario("paper_bench"), 2, 1.0, lambda *what: told.append(what))
    assert [d.name for d in found.demonstrators] == ["fitted", "bench"]
    assert all(len(d.samples) == 2 and 0.0 <= min(d.holds.values()) <= 1.0 for d in found.demonstrators)
    assert found.demonstrators[0].samples[0] != found.demonstrators[0].samples[1]
    assert len(found.sensitivity) == 15
    assert told[-1] == ("one at a time", 15, 15)
    central, nominal = found.demonstrators[0].central, run_experiments(prepare(paper_scenario, ["E1"]))
    assert central[E1_LARGEST] == metrics_of(nominal.episodes["E1"]).attitude_max_deg
    assert found.result()["paper"][E2_LARGEST] == "6.8"
