"""Impedance (6) and orientation PD: as springs and dampers whose energy and directions are known."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from armland.control.laws.impedance import impedance, orientation_pd


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
