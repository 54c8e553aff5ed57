"""Jumps at η_e = 0 against what the equations give by hand."""

from functools import cache

import numpy as np
import pytest

from armland.experiments.proof.cases import CASES, draw, setting_of
from armland.experiments.proof.jumps import across, sweep
from armland.experiments.proof.subsystem import storage
from armland.rotations import error, multiply
from armland.scenario import load_scenario


@cache
def scenario():
    return load_scenario("paper")


@cache
def setting():
    return setting_of(CASES["paper"], scenario())


def test_remark_1_torque_jumps_by_k1k2_plus_k3_at_half_a_turn():
    s = sweep(setting(), 0, 0.0, np.pi + np.array([-1e-9, 1e-9]))
    # ½(K₁K₂ + k₃) ε on either side, and |ε| = 1: 36 N·m with the paper's gains.
    np.testing.assert_allclose(s.delta_tau, [-18.0, 18.0], rtol=1e-6)
    assert s.v2[0] == pytest.approx(s.v2[1])


@pytest.mark.parametrize("rate", [-10.0, 10.0])
def test_v2_falls_in_a_jump_about_a_principal_axis(rate):
    behind, beyond = sweep(setting(), 0, rate, np.pi + np.sign(rate) * np.array([-1e-9, 1e-9])).v2
    assert beyond - behind == pytest.approx(-abs(rate) * setting().gains.k1[0] * setting().uav.inertia[0, 0], rel=1e-4)


def test_jump_of_v2_from_random_states():
    problems = draw(CASES["paper"], scenario(), 50)
    rise, torque, force = across(problems, setting())
    for problem, found in zip(problems, rise, strict=True):
        eps = error(problem["q_d"], problem["start"][:4])[1:]
        eps /= np.linalg.norm(eps)
        omega = problem["start"][4:7]
        before = np.sign(eps @ omega)
        y = problem["start"].copy()
        y[:4] = multiply(problem["q_d"], np.concatenate([[before * 1e-13], eps]))
        jump = -before * omega @ setting().uav.inertia @ (setting().gains.k1[:3] * eps)
        assert found == pytest.approx(jump / storage(0.0, y, problem, setting())[0], abs=1e-9)
    assert (rise > 0.0).any()
    assert (rise < 0.0).any()
    assert torque.min() > 34.0
    assert force.max() < 1e-9


def test_v2_never_rises_in_a_jump_if_the_inertia_is_that_of_a_ball():
    uav = setting().uav._replace(inertia=0.007 * np.eye(3))
    rise, _, _ = across(draw(CASES["paper"], scenario(), 100), setting()._replace(uav=uav))
    assert rise.max() < 0.0
