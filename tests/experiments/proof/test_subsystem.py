"""The subsystem's motion against Newton–Euler written with scipy, its moving reference against differences."""

from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armland.control.laws.attitude import initial_memory, quaternion_pd
from armland.experiments.proof.cases import CASES, draw, setting_of
from armland.experiments.proof.subsystem import flow, motion, onboard_torque, reference_at, storage
from armland.scenario import load_scenario


@cache
def scenario():
    return load_scenario("paper")


def matrix(q):
    return Rotation.from_quat(q, scalar_first=True).as_matrix()


@pytest.mark.parametrize("lever_moves", [True, False])
def test_motion_is_that_of_newton_and_euler(lever_moves):
    setting = setting_of(CASES["exact"], scenario())._replace(lever_moves=lever_moves)
    rng, rate = np.random.default_rng(1), np.empty(13)
    for problem in draw(CASES["paper"], scenario(), 20):
        y, (delta_tau, force, tau_att), thrust = problem["start"], rng.normal(size=(3, 3)), rng.uniform(0.0, 7.0)
        motion(y, delta_tau, force, thrust, tau_att, setting, rate)
        q, omega, v, R, uav = y[:4], y[4:7], y[10:], matrix(y[:4]), setting.uav
        moment = tau_att + delta_tau + np.cross(uav.lever, R.T @ force) - np.cross(omega, uav.inertia @ omega)
        turned = Rotation.from_quat(q, scalar_first=True) * Rotation.from_rotvec(1e-6 * omega)
        back = Rotation.from_quat(q, scalar_first=True) * Rotation.from_rotvec(-1e-6 * omega)
        q_a, q_b = (x.as_quat(scalar_first=True) for x in (back, turned))
        q_a, q_b = q_a * np.sign(q_a @ q), q_b * np.sign(q_b @ q)
        np.testing.assert_allclose(rate[:4], (q_b - q_a) / 2e-6, atol=1e-8)
        np.testing.assert_allclose(rate[4:7], np.linalg.solve(uav.inertia, moment), rtol=1e-12)
        pivot = v + R @ np.cross(omega, uav.lever) if lever_moves else v
        np.testing.assert_allclose(rate[7:10], pivot, atol=1e-12)
        np.testing.assert_allclose(
            uav.mass * rate[10:], force + thrust * R[:, 2] - [0.0, 0.0, uav.mass * 9.81], atol=1e-12
        )


def test_onboard_torque_is_the_quaternion_pd():
    setting, still = setting_of(CASES["paper"], scenario()), np.zeros(3)
    for problem in draw(CASES["paper"], scenario(), 20):
        y, q_d = problem["start"], problem["q_d"]
        torque, _ = quaternion_pd(y[:4], y[4:7], q_d, still, still, setting.onboard, initial_memory(still))
        np.testing.assert_allclose(onboard_torque(y, q_d, setting.onboard), torque, atol=1e-13)


def test_each_part_of_a_moving_reference_is_the_rate_of_the_one_before():
    h = 1e-4
    for problem in draw(CASES["exact"], scenario(), 10):
        a, now, b = (reference_at(0.7 + s, problem) for s in (-h, 0.0, h))
        turn = Rotation.from_quat(a.q_d, scalar_first=True).inv() * Rotation.from_quat(b.q_d, scalar_first=True)
        np.testing.assert_allclose(turn.as_rotvec() / (2 * h), now.omega_d, atol=1e-6)
        np.testing.assert_allclose((b.omega_d - a.omega_d) / (2 * h), now.omega_dot_d, atol=1e-6)
        np.testing.assert_allclose((b.r_d - a.r_d) / (2 * h), now.v_d, atol=1e-6)
        np.testing.assert_allclose((b.v_d - a.v_d) / (2 * h), now.a_d, atol=1e-6)


def test_reference_of_the_paper_is_at_rest():
    problem = draw(CASES["paper"], scenario(), 1)[0]
    q_d, *rates, v_d, a_d = (np.asarray(x) for x in reference_at(3.0, problem)[:1] + reference_at(3.0, problem)[1:])
    np.testing.assert_array_equal(q_d, problem["q_d"])
    np.testing.assert_array_equal(rates[2], problem["r_d"])
    assert not np.any([rates[0], rates[1], v_d, a_d])


@pytest.mark.parametrize("name", list(CASES))
def test_goal_is_an_equilibrium(name):
    setting, rate = setting_of(CASES[name], scenario()), np.empty(13)
    problem = draw(CASES["paper"], scenario(), 1)[0]
    y = np.concatenate([problem["q_d"], np.zeros(3), problem["r_d"], np.zeros(3)])
    assert flow(0.0, y, problem, setting, rate) == pytest.approx(1.0)
    np.testing.assert_allclose(rate, 0.0, atol=1e-10)
    np.testing.assert_allclose(storage(0.0, y, problem, setting), 0.0, atol=1e-12)
