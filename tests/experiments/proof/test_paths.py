"""Paths against scipy's DOP853, across the change of sign of η_e too, and what their summaries say."""

from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from armland.experiments.proof.cases import CASES, draw, setting_of
from armland.experiments.proof.paths import LOG, NEAR_M, NEAR_RAD, SETTLED, SUMMARY, follow, summarise, survey_paths
from armland.experiments.proof.subsystem import flow, reference_at, storage
from armland.rotations import angle, error, multiply
from armland.scenario import load_scenario


@cache
def scenario():
    return load_scenario("paper")


def path_of(problem, setting, rows=5000):
    log = np.zeros(rows, LOG)
    return log[: follow(problem, setting, log)]


def oracle(problem, setting, times, start=None, begin=0.0):
    """States at `times` by an eighth-order integrator, two decades finer; one side of η_e = 0 only."""

    def rate(t, y):
        out = np.empty(13)
        flow(t, np.ascontiguousarray(y), problem, setting, out)
        return out

    start = problem["start"] if start is None else start
    return solve_ivp(rate, (begin, times[-1]), start, "DOP853", times, rtol=1e-10, atol=1e-12).y.T


def near_half_turn(problem, eta, speed):
    """The problem with its attitude at η_e = `eta` and its body rate `speed` about the error's axis, and across it."""
    problem = problem.copy()
    axis = np.array([2.0, -1.0, 2.0]) / 3.0
    problem["start"][:4] = multiply(problem["q_d"], np.concatenate([[eta], np.sqrt(1.0 - eta**2) * axis]))
    problem["start"][4:7] = speed * axis + np.array([1.0, 4.0, 1.0])
    return problem


@pytest.mark.parametrize("name", list(CASES))
def test_path_is_that_of_an_eighth_order_integrator(name):
    setting = setting_of(CASES[name], scenario())
    for problem in draw(CASES[name], scenario(), 3):
        log = path_of(problem, setting)
        assert not log["jumped"].any()
        np.testing.assert_allclose(log["y"], oracle(problem, setting, log["t"]), rtol=1e-4, atol=2e-5)
        assert log["v2"][-1] <= setting.enough
        assert np.linalg.norm(log["y"][-1, :4]) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize(("eta", "speed"), [(0.005, 20.0), (-0.005, -20.0)])
def test_path_crosses_the_change_of_sign_without_straddling_it(eta, speed):
    setting = setting_of(CASES["paper"], scenario())
    problem = near_half_turn(draw(CASES["paper"], scenario(), 1)[0], eta, speed)
    log = path_of(problem, setting)
    (k,) = np.flatnonzero(log["jumped"])
    before, after = log[k - 1], log[k]
    etas = log["y"][:, :4] @ problem["q_d"]
    np.testing.assert_array_equal(np.sign(etas[:k]), np.sign(eta))
    np.testing.assert_array_equal(np.sign(etas[k:]), -np.sign(eta))
    np.testing.assert_allclose(after["y"], before["y"], atol=1e-7)
    np.testing.assert_allclose(log["y"][: k - 1], oracle(problem, setting, log["t"][: k - 1]), rtol=1e-4, atol=2e-5)
    beyond = oracle(problem, setting, log["t"][k:], after["y"], after["t"])
    np.testing.assert_allclose(log["y"][k:], beyond, rtol=1e-4, atol=2e-5)
    eps, omega = error(problem["q_d"], before["y"][:4])[1:], before["y"][4:7]
    jump = -np.sign(eta) * omega @ setting.uav.inertia @ (setting.gains.k1[:3] * eps)
    assert after["v2"] - before["v2"] == pytest.approx(jump, abs=1e-6)


def test_path_that_starts_on_the_change_of_sign_leaves_it():
    setting = setting_of(CASES["paper"], scenario())
    for speed in (-5.0, 0.0, 5.0):
        problem = near_half_turn(draw(CASES["paper"], scenario(), 1)[0], 0.0, speed)
        assert path_of(problem, setting)["v2"][-1] <= setting.enough


def test_summary_of_a_path():
    setting = setting_of(CASES["exact"], scenario())
    problem, s = draw(CASES["exact"], scenario(), 1)[0], np.zeros(1, SUMMARY)
    log = path_of(problem, setting)
    summarise(log, s[0])
    times = np.linspace(0.0, log["t"][-1], 4001)
    states = oracle(problem, setting, times)
    v2 = np.array([storage(t, y, problem, setting)[0] for t, y in zip(times, states, strict=True)])
    goals = [reference_at(t, problem) for t in times]
    away = [
        angle(error(g.q_d, y[:4])) > NEAR_RAD or np.linalg.norm(g.r_d - y[7:10]) > NEAR_M
        for g, y in zip(goals, states, strict=True)
    ]
    assert s["settled"][0] == pytest.approx(times[np.argmax(v2 <= SETTLED * v2[0])], abs=2e-3)
    assert s["arrived"][0] == pytest.approx(times[len(times) - np.argmax(away[::-1])], abs=2e-3)
    assert s["rise"][0] < 0.0
    assert s["jumps"][0] == 0


def test_summary_tells_a_jump_from_the_flow():
    log, s = np.zeros(4, LOG), np.zeros(1, SUMMARY)
    log["t"], log["v2"], log["jumped"] = [0.0, 1.0, 1.0, 2.0], [10.0, 5.0, 6.0, 6.6], [0, 0, 1, 0]
    log["angle"] = 1.0
    summarise(log, s[0])
    assert s["jump_rise"][0] == pytest.approx(0.2)
    assert s["rise"][0] == pytest.approx(0.1)
    assert np.isnan(s["settled"][0])
    assert np.isnan(s["arrived"][0])


def summaries_of(problems, setting):
    summaries = np.zeros(len(problems), SUMMARY)
    survey_paths(problems, setting, summaries)
    return summaries


def test_v2_rises_under_a_law_that_leaves_rho_out_of_its_input_matrix():
    right = setting_of(CASES["paper"], scenario())
    wrong = right._replace(told_uav=right.uav._replace(lever=np.zeros(3)), horizon=2.0)
    problems = draw(CASES["paper"], scenario(), 30)
    assert summaries_of(problems, right)["rise"].max() < 0.0
    assert np.mean(summaries_of(problems, wrong)["rise"] > 1e-3) > 0.1


def test_states_do_not_arrive_under_a_law_that_leaves_the_gradient_out():
    """Without k₃Qᵀz₁ the attitude creeps home with K₁/4 = 0.25 1/s."""
    right = setting_of(CASES["paper"], scenario())._replace(horizon=2.0)
    wrong = right._replace(told_gains=right.gains._replace(k3=0.0))
    problems = draw(CASES["paper"], scenario(), 30)
    assert np.isfinite(summaries_of(problems, right)["arrived"]).all()
    assert np.isnan(summaries_of(problems, wrong)["arrived"]).all()


def test_a_path_that_does_not_arrive_is_told():
    setting = setting_of(CASES["paper"], scenario())._replace(horizon=0.3)
    summaries = summaries_of(draw(CASES["paper"], scenario(), 5), setting)
    assert np.isnan(summaries["arrived"]).all()
    np.testing.assert_allclose(summaries["end"], 0.3)
