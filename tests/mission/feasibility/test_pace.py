"""Moves that are too fast for an arm's joints take longer, and no others; what would take far longer is refused."""

import re

import numpy as np
import pytest

from armland.errors import WorkspaceError
from armland.mission.feasibility.pace import SHARE, following, joint_speeds, paced
from armland.mission.missions.landing import LANDING, PHASES
from armland.mission.reference.septic import septic
from armland.models.parameters import arm_model
from armland.models.posture import lead, pose
from armland.scenario import load_scenario

SLOW = 0.7
"""rad/s, of each joint; the LWR's own turn at 1.9 rad/s and more."""


WEIGHT_N, DAMPING, FROM_IT = 4.5, 80.0, 3
"""Of the AR.Drone; N·m·s/rad of the elbow of an arm whose gears are stiff to turn, and which joint that is."""


def slow(speed=SLOW):
    scenario = load_scenario("landing", {"arm": {"joint_speed_rad_s": [speed] * 7}}).believed()
    return scenario, arm_model(scenario)


def durations(phases):
    return {p.name: p.duration_s for p in phases}


def fastest(arm, scenario, q, duration):
    """Largest joint speed of the move from below the catch to the standoff, by differences of poses at 100 Hz."""
    catch, place = np.array(scenario.place.catch_m), scenario.place
    q, qs = lead(arm, q, catch - [0.0, 0.0, place.wait_below_m]), []
    for t in np.arange(0.0, duration, 0.01):
        s, _, _ = septic(t / duration, duration)
        z = -place.wait_below_m + s * (place.wait_below_m - place.standoff_m)
        q = pose(arm, q, catch + [0.0, 0.0, z])
        qs.append(q)
    return np.abs(np.diff(qs, axis=0)).max() / 0.01


def test_arm_that_is_fast_enough_keeps_the_missions_times(landing_plan):
    assert landing_plan.phases == PHASES


def test_slow_arm_moves_as_slowly_as_its_joints_need(landing_plan):
    scenario, arm = slow()
    made, own = durations(paced(PHASES, LANDING, arm, landing_plan.home, scenario, WEIGHT_N)), durations(PHASES)
    allowed = SHARE * scenario.limits.joint_speed_share * SLOW
    assert fastest(arm, scenario, landing_plan.home, own["approach"]) > allowed
    assert fastest(arm, scenario, landing_plan.home, made["approach"]) == pytest.approx(allowed, rel=0.1)
    assert made["carry"] == own["carry"]


def test_phase_that_takes_longer_times_out_later(landing_plan):
    scenario, arm = slow()
    made = paced(PHASES, LANDING, arm, landing_plan.home, scenario, WEIGHT_N)
    left = [p.timeout_s - p.duration_s for p in made]
    np.testing.assert_allclose(left, [p.timeout_s - p.duration_s for p in PHASES])


def test_arm_that_is_far_too_slow_is_refused(landing_plan):
    scenario, arm = slow(0.05)
    with pytest.raises(
        WorkspaceError, match=r"in the phase approach joint \w+ would have to turn at \d+\.\d times the 0\.05 rad/s"
    ):
        paced(PHASES, LANDING, arm, landing_plan.home, scenario, WEIGHT_N)


def test_joint_speeds_give_the_velocity_and_hold_the_attitude(landing_plan):
    arm = landing_plan.arm
    arm.update(landing_plan.home, np.zeros(arm.joints))
    velocity = np.array([0.1, -0.2, 0.3])
    np.testing.assert_allclose(arm.jacobian @ joint_speeds(arm, velocity), [*velocity, 0.0, 0.0, 0.0], atol=1e-6)


def stiff_to_turn(landing_plan, damping):
    arm = arm_model(landing_plan.scenario)
    arm.model.dof_damping[:] = np.where(np.arange(arm.joints) == FROM_IT, damping, 0.0)
    return landing_plan.scenario, arm


def needed(scenario, arm, q, duration):
    """Largest torque of the damped joint that follows the UAV in the move up to the standoff, N·m, by differences of poses."""
    catch, place = np.array(scenario.place.catch_m), scenario.place
    q = lead(arm, q, catch - [0.0, 0.0, place.wait_below_m])
    most, before = 0.0, q
    for t in np.arange(0.01, duration, 0.01):
        s, _, _ = septic(t / duration, duration)
        q = pose(arm, q, catch + [0.0, 0.0, -place.wait_below_m + s * (place.wait_below_m - place.standoff_m)])
        fast = abs(q - before)[FROM_IT] / 0.01 + following(arm, scenario.bounds.uav_speed_mps)[FROM_IT]
        turning = arm.damping[FROM_IT] * fast
        most, before = max(most, turning + abs(arm.gravity[FROM_IT])), q
    return most


def test_damped_joint_turns_as_slowly_as_its_torque_needs(landing_plan):
    """Without the stretch the same move asks for more than the joint has."""
    scenario, arm = stiff_to_turn(landing_plan, DAMPING)
    made, own = durations(paced(PHASES, LANDING, arm, landing_plan.home, scenario, WEIGHT_N)), durations(PHASES)
    most = arm.tau_max[FROM_IT]
    assert needed(scenario, arm, landing_plan.home, own["approach"]) > most
    assert needed(scenario, arm, landing_plan.home, made["approach"]) < most
    scenario, free = stiff_to_turn(landing_plan, 0.0)
    assert paced(PHASES, LANDING, free, landing_plan.home, scenario, WEIGHT_N) == PHASES


def test_arm_too_damped_to_follow_the_uav_is_refused(landing_plan):
    scenario, arm = stiff_to_turn(landing_plan, 10.0 * DAMPING)
    with pytest.raises(WorkspaceError, match=r"joint \w+ has 800 N·m·s/rad of damping, and its \d+ N·m cannot"):
        paced(PHASES, LANDING, arm, landing_plan.home, scenario, WEIGHT_N)


def heavy_to_quicken(landing_plan, armature, torque):
    arm = arm_model(landing_plan.scenario)
    arm.model.dof_armature[FROM_IT] += armature
    arm.tau_max[FROM_IT] = torque
    arm.update(landing_plan.home, np.zeros(arm.joints))
    return landing_plan.scenario, arm


def quickening(scenario, arm, q, duration):
    """Largest torque of the joint that gains speed in the move up to the standoff and as station keeping brakes the UAV, N·m, by
    differences of poses.
    """
    brakes = scenario.control.station.k_velocity * scenario.bounds.uav_speed_mps
    catch, place = np.array(scenario.place.catch_m), scenario.place
    q, qs = lead(arm, q, catch - [0.0, 0.0, place.wait_below_m]), []
    for t in np.arange(0.0, duration, 0.01):
        s, _, _ = septic(t / duration, duration)
        q = pose(arm, q, catch + [0.0, 0.0, -place.wait_below_m + s * (place.wait_below_m - place.standoff_m)])
        qs.append(q)
    gained, most = np.diff(qs, 2, axis=0) / 1e-4, 0.0
    for q, qdd in zip(qs[1:], gained, strict=False):
        arm.update(q, np.zeros(arm.joints))
        follows = np.linalg.norm([(arm.mass_matrix @ joint_speeds(arm, brakes * axis))[FROM_IT] for axis in np.eye(3)])
        most = max(most, abs(arm.mass_matrix @ qdd + arm.gravity)[FROM_IT] + follows)
    return most


def test_heavy_armature_is_quickened_as_slowly_as_its_torque_needs(landing_plan):
    """Without the stretch the same move asks for more than the joint has; a light one keeps the mission's times."""
    scenario, arm = heavy_to_quicken(landing_plan, 30.0, 110.0)
    made, own = durations(paced(PHASES, LANDING, arm, landing_plan.home, scenario, WEIGHT_N)), durations(PHASES)
    assert made["approach"] > own["approach"]
    assert quickening(scenario, arm, landing_plan.home, own["approach"]) > 110.0
    assert quickening(scenario, arm, landing_plan.home, made["approach"]) < 110.0
    scenario, light = heavy_to_quicken(landing_plan, 0.0, 110.0)
    assert paced(PHASES, LANDING, light, landing_plan.home, scenario, WEIGHT_N) == PHASES


def test_refusal_of_a_heavy_armature_names_a_torque_that_works(landing_plan):
    scenario, arm = heavy_to_quicken(landing_plan, 60.0, 110.0)
    with pytest.raises(
        WorkspaceError, match=r"moves 6\d\.?\d* kg·m², 6\d\.?\d* of it armature, and its 110 N·m cannot"
    ) as refusal:
        paced(PHASES, LANDING, arm, landing_plan.home, scenario, WEIGHT_N)
    named = float(re.search(r"at least (\S+) N·m", str(refusal.value))[1])
    scenario, arm = heavy_to_quicken(landing_plan, 60.0, 1.1 * named)
    assert durations(paced(PHASES, LANDING, arm, landing_plan.home, scenario, WEIGHT_N))["approach"] > 0.0


def test_following_bounds_the_joint_speeds_of_all_directions(landing_plan):
    arm = landing_plan.arm
    arm.update(landing_plan.home, np.zeros(arm.joints))
    bound, rng = following(arm, 0.15), np.random.default_rng(0)
    ways = rng.normal(size=(2000, 3))
    found = np.array([np.abs(joint_speeds(arm, 0.15 * w / np.linalg.norm(w))) for w in ways]).max(axis=0)
    assert (found <= bound + 1e-9).all()
    np.testing.assert_allclose(found, bound, rtol=0.05)
