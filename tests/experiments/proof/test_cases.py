"""Random starts, and what a case says of its paths."""

from functools import cache

import numpy as np
import pytest

from armland.experiments.proof.cases import CASES, DISTANCE, OMEGA, PLACE, SPEED, draw, parts, run_case, setting_of
from armland.experiments.proof.paths import NEAR_M
from armland.experiments.proof.subsystem import storage
from armland.scenario import load_scenario


@cache
def scenario():
    return load_scenario("paper")


def test_starts_cover_the_whole_sphere_and_all_that_is_promised():
    p = draw(CASES["paper"], scenario(), 4000)
    y = p["start"]
    np.testing.assert_allclose(np.linalg.norm(y[:, :4], axis=1), 1.0)
    eta = np.abs(np.sum(y[:, :4] * p["q_d"], axis=1))
    # Uniform attitudes: the angle φ of the error has the distribution (φ − sin φ)/π.
    angle = np.sort(2.0 * np.arccos(eta))
    expected = (angle - np.sin(angle)) / np.pi
    assert np.abs(expected - np.arange(1, 4001) / 4000).max() < 0.03
    assert 0.45 < np.mean(np.sum(y[:, :4] * p["q_d"], axis=1) < 0.0) < 0.55
    for values, half in ((y[:, 4:7], OMEGA), (y[:, 7:10] - p["r_d"], DISTANCE), (y[:, 10:], SPEED), (p["r_d"], PLACE)):
        assert 0.99 * half < np.abs(values).max() <= half
    assert p["thrust"].min() < 0.5
    assert p["thrust"].max() > 7.0
    assert not p["amplitude"].any()
    assert draw(CASES["exact"], scenario(), 10)["amplitude"].all()


def test_starts_come_from_the_seed():
    a, b = (draw(CASES["paper"], scenario(), 5) for _ in range(2))
    other = draw(CASES["paper"], load_scenario("paper", {"run": {"seed": 2}}), 5)
    assert a.tobytes() == b.tobytes()
    assert np.abs(a["start"] - other["start"]).min() > 0.0


@pytest.mark.parametrize("name", ["paper", "exact"])
def test_v2_keeps_a_path_at_the_goal_once_it_is_small_enough(name):
    setting, problem = setting_of(CASES[name], scenario()), draw(CASES["paper"], scenario(), 1)[0]
    y = np.concatenate([problem["q_d"], np.zeros(3), problem["r_d"] + [NEAR_M, 0.0, 0.0], np.zeros(3)])
    assert storage(0.0, y, problem, setting)[0] > setting.enough


def test_figures_of_a_case():
    told = []
    case = run_case(CASES["paper"], scenario(), 300, lambda *args: told.append(args))
    figures = case.figures()
    assert told == [(CASES["paper"].title, 250, 300), (CASES["paper"].title, 300, 300)]
    assert figures["states"] == 300
    assert figures["rates_checked"] > 590
    assert figures["not_arrived"] == figures["paths_rising"] == 0
    assert figures["arrived_s"]["median"] == pytest.approx(np.median(case.paths["arrived"]))
    assert figures["settled_s"]["largest"] < figures["arrived_s"]["smallest"]
    assert figures["jump_v2_rising_share"] == np.mean(case.jump_v2 > 0.0)


def test_paths_that_never_arrive_have_no_times():
    # K₁ of the attitude 1000 times smaller: the horizon is too near.
    slow = load_scenario("paper", {"control": {"k1": [1e-3, 1e-3, 1e-3, 30.0, 30.0, 30.0], "k3": 1e-3}})
    figures = run_case(CASES["paper"], slow, 2).figures()
    assert figures["not_arrived"] == 2
    assert figures["arrived_s"]["median"] is None


def test_law_and_proof_know_the_body_that_the_controller_believes_in():
    heavier = scenario().replaced({"belief": {"uav": {"mass_kg": 0.6}}})
    assert parts(scenario())[0].mass == pytest.approx(0.48)
    assert parts(heavier)[0].mass == 0.6
