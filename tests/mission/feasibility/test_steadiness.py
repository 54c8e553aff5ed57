"""The attitude of a light wrist is held as softly as the loop's delay needs, and a heavy one's as it was."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.mission.feasibility.steadiness import DELAY_S, SHARE, TICKS, steadied, stopping, swinging
from armland.mission.missions.landing import LANDING
from armland.models.parameters import arm_model
from armland.scenario import load_scenario

RATE_HZ = 1000.0


def grows(rate, delay_s, step_s=1e-5, time_s=0.4):
    """Whether ω˙(t) = −r ω(t − T) grows from a small push, step by step."""
    late = round(delay_s / step_s)
    omega = np.zeros(round(time_s / step_s) + late)
    omega[: late + 1] = 1.0
    for k in range(late, len(omega) - 1):
        omega[k + 1] = omega[k] - step_s * rate * omega[k - late]
    tenth = len(omega) // 10
    return np.abs(omega[-tenth:]).max() > np.abs(omega[tenth : 2 * tenth]).max()


def test_rate_at_which_it_swings_is_that_of_the_delayed_loop():
    rate, delay = swinging(RATE_HZ), TICKS / RATE_HZ + DELAY_S
    assert grows(1.05 * rate, delay)
    assert not grows(0.95 * rate, delay)
    assert not grows(SHARE * rate, delay)


def test_rate_is_that_at_which_a_turning_joint_is_stopped(landing_plan):
    """No joint motion loses more of its energy by the attitude's damping than the largest rate says, and one loses as much."""
    arm = landing_plan.arm
    arm.update(landing_plan.home, np.zeros(arm.joints))
    M, turn = arm.mass_matrix, arm.jacobian[3:]
    rate, rng = stopping(arm, 7.0), np.random.default_rng(0)
    lost = [7.0 * (turn @ v) @ (turn @ v) / (v @ M @ v) for v in rng.normal(size=(20000, arm.joints))]
    assert max(lost) <= rate * (1.0 + 1e-9)
    v = np.linalg.solve(M, turn.T) @ np.linalg.eigh(turn @ np.linalg.solve(M, turn.T))[1][:, -1]
    assert 7.0 * (turn @ v) @ (turn @ v) / (v @ M @ v) == pytest.approx(rate)


def light(**more):
    """The LWR with joints whose rotors weigh next to nothing."""
    scenario = load_scenario("landing", {"arm": {"inertia_scale": 0.02}, **more}).believed()
    return scenario, arm_model(scenario)


def test_arm_of_the_landing_keeps_its_gains(landing_plan):
    scenario = landing_plan.scenario
    assert steadied(scenario, LANDING, landing_plan.arm, landing_plan.home) is scenario


def test_light_wrist_gets_gains_that_stop_it_in_time(landing_plan):
    scenario, arm = light()
    made = steadied(scenario, LANDING, arm, landing_plan.home)
    arm.update(landing_plan.home, np.zeros(arm.joints))
    assert stopping(arm, scenario.control.orientation_kd) > SHARE * swinging(RATE_HZ)
    assert stopping(arm, made.control.orientation_kd) <= SHARE * swinging(RATE_HZ) * (1.0 + 1e-9)
    own, new = scenario.control, made.control
    assert new.orientation_kp / new.orientation_kd == pytest.approx(own.orientation_kp / own.orientation_kd)


def test_gains_that_swing_are_refused_where_the_user_set_them(landing_plan):
    _, arm = light()
    scenario, _ = light(control={"orientation_kd": 70.0})
    with pytest.raises(
        ConfigurationError, match=r"orientation_kd = 70 .* it swings.* at most \d+\.\d\d leaves a margin"
    ):
        steadied(scenario, LANDING, arm, landing_plan.home)
