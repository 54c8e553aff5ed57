"""Attitude and null space are held as softly as the loop's delay needs, and as firmly as the arm's weight and inertia need."""

from pathlib import Path

import numpy as np
import pytest

from armland.cli.options import load
from armland.errors import ConfigurationError
from armland.experiments.episode import fly
from armland.mission.feasibility.steadiness import (
    BORNE_KG,
    DELAY_S,
    SHARE,
    STOPS,
    TICKS,
    WRONG,
    drifting,
    moved_mass,
    self_inertia,
    steadied,
    stopping,
    swinging,
)
from armland.mission.missions.landing import LANDING
from armland.models.operational import null_space_torque
from armland.models.parameters import arm_model
from armland.scenario import load_scenario

RATE_HZ = 1000.0

DATA = Path(__file__).parents[2] / "data"


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


def heavy(**more):
    """The LWR with four times its weight and inertia."""
    scenario = load_scenario("landing", {"arm": {"inertia_scale": 4.0}, **more}).believed()
    return scenario, arm_model(scenario)


def test_heavier_arm_tilts_as_little_by_masses_that_are_wrong(landing_plan):
    scenario, arm = heavy()
    made, share = steadied(scenario, LANDING, arm, landing_plan.home).control, moved_mass(arm) / BORNE_KG
    assert moved_mass(arm) == pytest.approx(4.0 * 13.55)
    assert made.orientation_kp == pytest.approx(share * scenario.control.orientation_kp)
    assert made.orientation_kd == pytest.approx(share * scenario.control.orientation_kd)
    assert stopping(arm, made.orientation_kd) < SHARE * swinging(RATE_HZ)


def test_null_space_of_a_heavier_arm_comes_to_rest_as_soon(landing_plan):
    """Where the damping alone acts, projected as in flight, a motion that leaves the end effector at rest is stopped at the rate."""
    scenario, arm = heavy()
    damping = steadied(scenario, LANDING, arm, landing_plan.home).control.null_space_damping_nms
    assert damping > scenario.control.null_space_damping_nms
    arm.update(landing_plan.home, np.zeros(arm.joints))
    qd = np.linalg.svd(arm.jacobian)[2][6]
    M, J = arm.mass_matrix, arm.jacobian
    lambda_ee = np.linalg.inv(J @ np.linalg.solve(M, J.T))
    qdd = np.linalg.solve(M, null_space_torque(-damping * qd, np.linalg.cholesky(M), J, lambda_ee))
    np.testing.assert_allclose(J @ qdd, 0.0, atol=1e-9)
    assert -qd @ M @ qdd / (qd @ M @ qd) >= 0.9 * STOPS
    assert qd @ M @ qd == pytest.approx(self_inertia(arm))


def test_torque_of_wrong_weights_is_what_lifting_them_along_the_null_space_takes(landing_plan):
    """Each link's weight times how far its centre of mass rises with the null space's motion, by finite differences."""
    _, arm = heavy()
    arm.update(landing_plan.home, np.zeros(arm.joints))
    free, step = np.linalg.svd(arm.jacobian)[2][6], 1e-5
    heights = []
    for q in (landing_plan.home - step * free, landing_plan.home + step * free):
        arm.update(q, np.zeros(arm.joints))
        heights.append(arm.data.xipos[:, 2].copy())
    rise = (heights[1] - heights[0]) / (2.0 * step)
    arm.update(landing_plan.home, np.zeros(arm.joints))
    expected = WRONG * np.linalg.norm(9.81 * arm.model.body_mass * rise)
    assert drifting(arm) == pytest.approx(expected, rel=1e-4)


def test_what_the_user_set_stays(landing_plan):
    scenario, arm = heavy(control={"orientation_kd": 7.0, "null_space_damping_nms": 2.0})
    assert steadied(scenario, LANDING, arm, landing_plan.home) is scenario


def octo25(*settings):
    """A landing of 25 kg on an arm of 118 kg."""
    told = {"uav": "octo25", "arm": str(DATA / "arms" / "heavy.xml"), "deviation": "published", "settings": settings}
    return fly(load("landing", told), "landing", 140018).result


@pytest.mark.slow
def test_heavy_arm_lands_with_what_the_rule_makes_and_not_with_the_lwrs():
    assert octo25()["success"]
    lwrs = octo25("control.orientation_kp=25", "control.orientation_kd=7", "control.null_space_damping_nms=2")
    assert not lwrs["success"]
    assert "near_limit" in lwrs["reason"]


@pytest.mark.slow
def test_elbow_of_an_arm_of_26_kg_stays_out_of_the_cradle_by_its_damping():
    told = {"arm": str(DATA.parents[1] / "examples" / "seven_axis.urdf"), "deviation": "published"}
    assert fly(load("landing", told), "landing", 8).result["success"]
    lwrs = fly(load("landing", told | {"settings": ("control.null_space_damping_nms=2",)}), "landing", 8).result
    assert "link_5_in_cradle" in lwrs["reason"]
