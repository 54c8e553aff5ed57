"""Hinge force without the tool, and the disturbance that the momentum of the held UAV shows."""

import numpy as np
import pytest

from armland.mission.load import estimate_load, observe
from armland.rotations import from_rotation_vector, matrix

TURN = np.array([0.2, -0.1, 0.4])


def reading(bench, force, acceleration):
    """The sensor's reading (6,) when the end effector puts `force` (3,), N, deck, on the UAV while the tool accelerates."""
    tool, R = bench.plan.scenario.tool, bench.board["arm"]["rotation"][0]
    tool_force = R.T @ (tool.tool_mass_kg * (acceleration + np.array([0.0, 0.0, 9.81])))
    on_uav = R.T @ force
    torque = np.cross([0.0, 0.0, tool.tool_com_m], tool_force)
    return np.concatenate([tool_force + on_uav, torque])


@pytest.mark.parametrize("follows", [0.0, 1.0])
def test_tool_is_taken_off_the_reading_with_its_inertia_where_it_follows(bench, follows):
    force, a = np.array([1.0, -2.0, 3.0]), np.array([0.5, 0.2, -0.4])
    bench.board["arm"]["rotation"] = matrix(from_rotation_vector(TURN))
    bench.told["estimate"]["tool_follows"], bench.kept["refer"]["a"] = follows, a
    bench.m["wrench"] = reading(bench, force, a)
    estimate_load(False, True, 0.0, bench.b)
    missed = (1.0 - follows) * bench.plan.scenario.tool.tool_mass_kg * a
    np.testing.assert_allclose(bench.e["hinge_force"][0], force + missed, atol=1e-12)


def test_force_that_is_too_old_gives_way_to_nothing(bench):
    bench.m["wrench"] = reading(bench, np.array([1.0, -2.0, 3.0]), np.zeros(3))
    bench.m["wrench_tick"] = 1000 - bench.told["estimate"]["wrench_age"][0] - 1
    estimate_load(False, True, 0.0, bench.b)
    np.testing.assert_array_equal(bench.e["hinge_force"], 0.0)


def test_shares_of_arm_rotors_and_ground_add_up(bench):
    weight = bench.told["estimate"]["weight"][0]
    bench.e["thrust"] = 0.5 * weight
    bench.m["wrench"] = reading(bench, np.array([0.0, 0.0, 0.3 * weight]), np.zeros(3))
    estimate_load(False, True, 0.0, bench.b)
    assert bench.e["arm_share"][0] == pytest.approx(0.3)
    assert bench.e["ground_share"][0] == pytest.approx(0.2)


def push_held_uav(bench, force, seconds, learns=True):
    """A held UAV under a constant `force` (3,), N, while arm and rotors give what the controller believes; its estimate of it."""
    p, mass = bench.told["estimate"], bench.told["estimate"]["body_mass"][0]
    bench.e["thrust"], bench.kept["act"]["force"] = 2.0, [0.3, -0.2, 2.4]
    a = (bench.kept["act"]["force"][0] + [0.0, 0.0, 2.0] + force) / mass + [0.0, 0.0, -9.81]
    for _ in range(round(seconds * 1000)):
        bench.e["v"][0] += a * p["tick_s"][0]
        observe(bench.b, learns)
    return bench.e["disturbance"][0].copy()


def test_observer_finds_a_constant_force_in_its_own_time(bench):
    force = np.array([0.5, -0.3, 0.2])
    bandwidth = bench.plan.scenario.estimation.load_observer_rad_s
    np.testing.assert_allclose(push_held_uav(bench, force, 1.0 / bandwidth), force * (1.0 - np.exp(-1.0)), rtol=0.02)
    np.testing.assert_allclose(push_held_uav(bench, force, 6.0 / bandwidth), force, rtol=0.01)


def test_observer_that_may_not_learn_keeps_what_it_knows(bench):
    bench.kept["estimate"]["observer"]["force"] = 0.1
    np.testing.assert_array_equal(push_held_uav(bench, np.array([0.5, 0.0, 0.0]), 0.3, learns=False), 0.1)
    # What was missed meanwhile is not caught up on.
    assert push_held_uav(bench, np.zeros(3), 0.001)[0] == pytest.approx(0.1, rel=0.05)


def test_no_disturbance_is_none(bench):
    np.testing.assert_allclose(push_held_uav(bench, np.zeros(3), 0.5), 0.0, atol=1e-9)


def test_velocity_of_the_centre_of_mass_counts_and_not_the_pivots(bench):
    """A UAV that swings about a pivot at rest: its momentum changes by ω × ω × ρ, which the model must not take for a force."""
    rate, lever, dt = 2.0, bench.told["estimate"]["lever"][0], 1e-3
    bench.e["omega"] = [rate, 0.0, 0.0]
    mass = bench.told["estimate"]["body_mass"][0]
    for k in range(200):
        R = matrix(from_rotation_vector(np.array([rate * k * dt, 0.0, 0.0])))
        bench.e["quat"][0] = from_rotation_vector(np.array([rate * k * dt, 0.0, 0.0]))
        omega = np.array([rate, 0.0, 0.0])
        # Pivot at rest: the centre of mass is accelerated by −R ω × (ω × ρ).
        a = -R @ np.cross(omega, np.cross(omega, lever))
        bench.e["thrust"], bench.kept["act"]["force"] = 0.0, mass * (a + [0.0, 0.0, 9.81])
        observe(bench.b, True)
    np.testing.assert_allclose(bench.e["disturbance"][0], 0.0, atol=2e-3)
