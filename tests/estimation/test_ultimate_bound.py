"""Bounds of what the disturbance observer leaves, by hand and by the worst noise; flown in `test_disturbance`."""

import numpy as np
import pytest

from armland.control.laws.rigid_body import UavParameters
from armland.estimation.disturbance import kept_layout, observe_force, told, ultimate_bound

UAV = UavParameters(0.48, np.diag([0.006, 0.007, 0.012]), np.array([0.0, 0.0, -0.06]))
NO_LEVER = UAV._replace(lever=np.zeros(3))
K1, K2, K3_ATTITUDE, K3_POSITION = np.array([8.0, 9.0, 10.0, 20.0, 25.0, 30.0]), np.full(6, 0.5), 3.0, 40.0
K2[3:] = 12.0
GAINS = K1, K2, K3_ATTITUDE, K3_POSITION


def test_ultimate_bound_scales_with_the_errors_and_ends_at_half_a_turn():
    one, two = ultimate_bound(0.1, 0.001, UAV, *GAINS), ultimate_bound(0.2, 0.002, UAV, *GAINS)
    np.testing.assert_allclose(two, np.multiply(one, 2.0), rtol=0.02)
    assert ultimate_bound(0.0, 0.0, UAV, *GAINS) == (0.0, 0.0, 0.0, 0.0)
    assert ultimate_bound(10.0, 50.0, UAV, *GAINS).attitude == pytest.approx(np.pi)


def test_ultimate_bound_of_a_force_alone_without_a_lever_by_hand():
    """Position and attitude then do not couple: √(2W) = |d̃_f|/√m / min(K₁, K₂/m), of the slowest axis."""
    found = ultimate_bound(0.3, 0.0, NO_LEVER, *GAINS)
    size = 0.3 / np.sqrt(0.48) / min(20.0, 12.0 / 0.48)
    np.testing.assert_allclose(found, [0.0, size / np.sqrt(0.48), 0.0, size / np.sqrt(K3_POSITION)], rtol=1e-9)


def test_ultimate_bound_of_a_moment_alone_without_a_lever_by_hand():
    """λ = K₁(1 + |η_e|)/8 of the attitude, and near the goal (1 + |η_e|) is nearly 2: K₁/4."""
    found = ultimate_bound(0.0, 1e-3, NO_LEVER, *GAINS)
    size = 1e-3 / np.sqrt(0.006) / min(8.0 / 4.0, 0.5 / 0.012)
    np.testing.assert_allclose(found.omega, size / np.sqrt(0.006), rtol=1e-4)
    np.testing.assert_allclose(found.attitude, 2.0 * size / np.sqrt(K3_ATTITUDE), rtol=1e-4)
    assert found.velocity == found.position == 0.0


def test_ultimate_bound_with_a_lever_solves_the_coupled_decay():
    """λ_a s_a = driven + c s_p, λ_p s_p = driven + c s_a with c = |ρ| √(k₃/J)."""
    c = 0.06 * np.sqrt(K3_POSITION / 0.006)
    found = ultimate_bound(0.1, 1e-4, UAV._replace(lever=np.array([0.0, 0.0, -0.006])), *GAINS)
    c *= 0.1
    size = np.linalg.solve([[2.0, -c], [-c, 20.0]], [1e-4 / np.sqrt(0.006), 0.1 / np.sqrt(0.48)])
    assert size[0] < np.linalg.norm([1e-4 / np.sqrt(0.006), 0.1 / np.sqrt(0.48)]) / 2.0
    np.testing.assert_allclose(found.position, size[1] / np.sqrt(K3_POSITION), rtol=1e-3)
    np.testing.assert_allclose(found.omega, size[0] / np.sqrt(0.006), rtol=1e-3)


def test_error_of_the_estimate_is_bounded_by_the_worst_noise_and_the_worst_ramp():
    """Momentum wrong by ±n, switched once: the response −K(δ − Ke^(−Kt)) collects 2Kn. A ramp of d₁ lags by d₁/K."""
    K, n, dt = 20.0, 1e-3, 1e-4
    p = told(1.0, K, 1e9, dt)
    wrong, ramp = np.where(np.arange(10_000) < 5000, -n, n), 3.0 * dt * np.arange(10_000)
    for momentum, worst in ((wrong, 2.0 * K * n), (np.cumsum(ramp) * dt, None)):
        s, found = np.zeros(1, kept_layout()), []
        for x in momentum:
            observe_force(np.eye(3), 0.0, np.zeros(3), np.array([x, 0.0, 0.0]), (0.0, 0.0, 0.0), True, p[0], s[0])
            found.append(s["force"][0, 0])
        if worst is not None:
            assert 0.95 * worst < np.abs(found).max() < 1.001 * worst
        else:
            assert ramp[-1] - found[-1] == pytest.approx(3.0 / K, rel=1e-2)


def test_ultimate_bound_of_the_attitude_is_the_fixed_point_of_what_it_knows_of_the_attitude():
    """Where it is large, λ = K₁(1 + |η_e|)/8 with 1 − |η_e| = W_a/k₃: solved by bisection, from the attitude's angle."""
    moment = 0.15
    found = ultimate_bound(0.0, moment, NO_LEVER, *GAINS)

    def too_small(angle):
        eta = np.cos(0.5 * angle)
        return 8.0 * (1.0 + eta) / 8.0 * np.sqrt(2.0 * K3_ATTITUDE * (1.0 - eta)) < moment / np.sqrt(0.006)

    low, high = 0.0, np.pi
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if too_small(middle) else (low, middle)
    assert 1.0 < found.attitude < 2.5
    assert found.attitude == pytest.approx(low, rel=1e-6)
