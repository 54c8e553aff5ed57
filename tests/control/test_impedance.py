"""Impedance (6), orientation PD, elbow and range fields: as springs and dampers whose energy and directions are known."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from armland.control.impedance import elbow_field, impedance, orientation_pd, range_field
from armland.models.arm import ArmModel
from armland.models.description import ASSETS

ELBOW = 3
STEP = 1e-6


@pytest.fixture(scope="module")
def arm():
    return ArmModel.load(ASSETS / "lwr4.xml", "flange")


def test_eq6_mass_under_impedance_swings_like_a_damped_oscillator():
    """A point mass on the force alone, against the closed solution, each axis with its own K and D."""
    mass, K, D = 2.0, np.array([800.0, 200.0, 50.0]), np.array([20.0, 10.0, 4.0])
    x0 = np.array([0.1, -0.2, 0.05])

    def rate(_, state):
        return np.concatenate([state[3:], impedance(state[:3], state[3:], K, D) / mass])

    times = np.linspace(0.0, 1.0, 50)
    found = solve_ivp(rate, (0.0, 1.0), np.concatenate([x0, np.zeros(3)]), t_eval=times, rtol=1e-9, atol=1e-12)
    decay, swing = D / (2.0 * mass), np.sqrt(K / mass - (D / (2.0 * mass)) ** 2)
    t = times[:, None]
    expected = x0 * np.exp(-decay * t) * (np.cos(swing * t) + decay / swing * np.sin(swing * t))
    np.testing.assert_allclose(found.y[:3].T, expected, atol=1e-7)


def test_eq6_without_damping_energy_stays_and_with_it_falls():
    K, mass = np.array([800.0, 200.0, 50.0]), 2.0

    def energy_after(D):
        x, v = np.array([0.1, -0.2, 0.05]), np.zeros(3)
        for _ in range(2000):
            # Velocity first, then position: exact in energy on average.
            v = v + 1e-4 * impedance(x, v, K, D) / mass
            x = x + 1e-4 * v
        return 0.5 * mass * v @ v + 0.5 * x @ (K * x)

    start = 0.5 * np.array([0.1, -0.2, 0.05]) ** 2 @ K
    assert energy_after(np.zeros(3)) == pytest.approx(start, rel=1e-2)
    assert energy_after(np.full(3, 20.0)) < 0.2 * start


def test_orientation_pd_turns_the_short_way_to_where_it_should_be():
    """ω̇ = τ, closed loop over 5 s from random orientations: it arrives, and the first torque points along the error."""
    for start, goal in zip(Rotation.random(10, rng=1), Rotation.random(10, rng=2), strict=True):
        error = (goal * start.inv()).as_rotvec()
        torque = orientation_pd(start.as_matrix(), goal.as_matrix(), np.zeros(3), 25.0, 7.0)
        np.testing.assert_allclose(torque, 25.0 * error, atol=1e-9)
        R, omega = start, np.zeros(3)
        for _ in range(2500):
            omega = omega + 2e-3 * orientation_pd(R.as_matrix(), goal.as_matrix(), omega, 25.0, 7.0)
            R = Rotation.from_rotvec(2e-3 * omega) * R
        assert (goal * R.inv()).magnitude() < 1e-4


def test_orientation_pd_brakes_every_turn():
    omega = np.array([0.3, -0.2, 0.9])
    np.testing.assert_allclose(orientation_pd(np.eye(3), np.eye(3), omega, 25.0, 7.0), -7.0 * omega)


def random_states(arm, count):
    rng = np.random.default_rng(4)
    for _ in range(count):
        yield rng.uniform(arm.q_min, arm.q_max)


def height(arm, q):
    arm.update(q, np.zeros(arm.joints))
    return arm.anchor[ELBOW, 2]


def test_elbow_field_is_the_weight_of_a_load_at_the_elbow(arm):
    """τ₀ = −∂(F z_elbow)/∂q by finite differences."""
    for q in random_states(arm, 20):
        gradient = [(height(arm, q + STEP * e) - height(arm, q - STEP * e)) / (2.0 * STEP) for e in np.eye(arm.joints)]
        arm.update(q, np.zeros(arm.joints))
        field = elbow_field(arm.axis, arm.anchor, ELBOW, 5.0)
        np.testing.assert_allclose(field, -5.0 * np.array(gradient), atol=1e-8)
        # The elbow's own joint and those beyond it do not move it.
        np.testing.assert_array_equal(field[ELBOW:], 0.0)


def test_range_field_is_a_spring_that_begins_at_the_margin():
    low, high = np.array([-2.0, -2.0, -2.0, -2.0]), np.array([2.0, 2.0, 2.0, 2.0])
    q = np.array([-1.9, 1.85, 0.0, 1.75])
    np.testing.assert_allclose(range_field(q, low, high, 0.25, 20.0), [20.0 * 0.15, -20.0 * 0.10, 0.0, 0.0], atol=1e-12)


def test_range_field_of_an_endless_joint_is_nothing():
    ends = np.array([np.inf])
    assert range_field(np.array([50.0]), -ends, ends, 0.25, 20.0)[0] == 0.0


def test_range_field_does_no_work_around_a_loop():
    """It has a potential: along a path out of the range and back the work is zero."""
    low, high = np.full(2, -1.0), np.full(2, 1.0)
    angles = np.linspace(0.0, 2.0 * np.pi, 4001)
    path = 1.2 * np.column_stack([np.cos(angles), np.sin(angles)])
    middle, way = 0.5 * (path[1:] + path[:-1]), np.diff(path, axis=0)
    work = sum(range_field(q, low, high, 0.25, 20.0) @ d for q, d in zip(middle, way, strict=True))
    assert work == pytest.approx(0.0, abs=1e-6)
