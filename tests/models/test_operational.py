"""Operational-space inertia (4) and null space: exact where regular, finite and continuous where singular."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.linalg import cho_factor, cho_solve

from armland.models.operational import (
    PIVOT_THRESHOLD,
    cholesky,
    null_space_torque,
    operational_inertia,
    smallest_singular_value,
)


def random_definite(rng, n):
    A = rng.normal(size=(n, n))
    return A @ A.T + 0.1 * np.eye(n)


def inertia(M, J):
    out = np.empty((6, 6))
    return out, operational_inertia(M, np.ascontiguousarray(J), np.zeros_like(M), out)


def test_cholesky_factor_multiplies_back():
    rng = np.random.default_rng(1)
    for n in (3, 6, 7):
        A, L = random_definite(rng, n), np.zeros((n, n))
        assert cholesky(A, L) > 0.0
        np.testing.assert_allclose(L @ L.T, A, atol=1e-12)
        np.testing.assert_array_equal(np.triu(L, 1), 0.0)


def test_cholesky_of_an_indefinite_matrix_returns_a_pivot_that_is_not_positive():
    assert cholesky(np.diag([1.0, -2.0, 1.0]), np.zeros((3, 3))) == -2.0


@pytest.mark.parametrize("joints", [6, 7, 9])
def test_eq4_lambda_inverts_the_mobility(joints):
    """Against a factorisation of M and an inverse by LAPACK."""
    rng = np.random.default_rng(joints)
    for _ in range(50):
        M, J = random_definite(rng, joints), rng.normal(size=(6, joints))
        mobility = J @ cho_solve(cho_factor(M), J.T)
        if np.linalg.eigvalsh(mobility)[0] < PIVOT_THRESHOLD:
            continue
        got, pivot = inertia(M, J)
        assert pivot > PIVOT_THRESHOLD
        expected = np.linalg.inv(mobility)
        np.testing.assert_allclose(got, expected, atol=1e-9 * np.abs(expected).max())
        np.testing.assert_array_equal(got, got.T)


def stretch(bench):
    """Λ along a path through a singularity: the elbow goes through straight, the wrist is straight throughout."""
    arm = bench("lwr4", tool=True).arm
    q = np.array([0.2, 0.7, 0.1, 0.0, 0.3, 0.0, -0.2])
    for bend in np.linspace(-0.2, 0.2, 2001):
        q[3] = bend
        arm.update(q, np.zeros(7))
        yield arm


def test_eq4_lambda_is_finite_symmetric_and_bounded_through_a_singularity(bench):
    for arm in stretch(bench):
        assert np.isfinite(arm.lambda_ee).all()
        np.testing.assert_array_equal(arm.lambda_ee, arm.lambda_ee.T)
        eigenvalues = np.linalg.eigvalsh(arm.lambda_ee)
        assert eigenvalues[0] > 0.0
        assert eigenvalues[-1] < 10.0 / PIVOT_THRESHOLD


def largest_step(values):
    return max(np.abs(b - a).max() for a, b in pairwise(values))


def test_eq4_lambda_is_continuous_through_a_singularity(bench):
    """A path of 2001 points and one of 201: the largest step falls with the spacing. A jump would stay as it is."""
    fine = [arm.lambda_ee.copy() for arm in stretch(bench)]
    coarse = fine[::10]
    assert largest_step(fine) < 0.2 * largest_step(coarse)
    assert largest_step(fine) < 1.0


def test_eq4_without_damping_lambda_explodes_at_a_singularity(bench):
    """Negative control: the plain inverse of the mobility on the same path."""
    undamped = []
    for arm in stretch(bench):
        mobility = arm.jacobian @ np.linalg.solve(arm.mass_matrix, arm.jacobian.T)
        undamped.append(np.linalg.pinv(mobility, rcond=0.0))
    assert max(np.abs(x).max() for x in undamped) > 1e4 / PIVOT_THRESHOLD


def test_eq4_damping_begins_and_grows_without_a_step():
    """A single pivot p from twice the threshold down to nothing: Λ is 1/p above it, then bends smoothly to its bound."""
    pivots = np.linspace(2.0 * PIVOT_THRESHOLD, 0.0, 4001)
    values = []
    for pivot in pivots:
        got, smallest = inertia(np.eye(6), np.diag([1.0, 1.0, np.sqrt(pivot), 1.0, 1.0, 1.0]))
        assert smallest == pytest.approx(pivot, abs=1e-15)
        values.append(got[2, 2])
    values = np.array(values)
    undamped = pivots >= PIVOT_THRESHOLD
    np.testing.assert_allclose(values[undamped], 1.0 / pivots[undamped], rtol=1e-9)
    # The steepest slope of 1/p above the threshold is its square: below it is no steeper than that.
    assert np.abs(np.diff(values)).max() < 1.1 * (2.0 / 4000 / PIVOT_THRESHOLD)
    assert values.max() < 2.0 / PIVOT_THRESHOLD
    assert values[-1] == pytest.approx(1.0 / PIVOT_THRESHOLD)


def test_null_space_torque_does_not_accelerate_the_end_effector(bench, states):
    """ẍ of Pinocchio's forward dynamics is the same with and without τ_nsp; a plain projector (I − 𝒥⁺𝒥) is not."""
    at = bench("lwr4", tool=True)
    arm, twin = at.arm, at.twin
    rng = np.random.default_rng(3)
    tried = 0
    for q, qd in states(arm, 60, seed=8):
        arm.update(q, qd)
        M, J = arm.mass_matrix, arm.jacobian
        if np.linalg.eigvalsh(J @ np.linalg.solve(M, J.T))[0] < PIVOT_THRESHOLD:
            continue
        tau0, hold = rng.normal(scale=10.0, size=7), arm.bias.copy()
        tau = null_space_torque(tau0, np.linalg.cholesky(M), J, arm.lambda_ee)
        qdd0, before = twin.acceleration(q, qd, hold)
        qdd, after = twin.acceleration(q, qd, hold + tau)
        np.testing.assert_allclose(after, before, atol=1e-8)
        assert np.abs(qdd - qdd0).max() > 1e-3
        plain = (np.eye(7) - np.linalg.pinv(J) @ J) @ tau0
        _, disturbed = twin.acceleration(q, qd, hold + plain)
        assert np.abs(disturbed - before).max() > 1e-3
        tried += 1
    assert tried >= 10


def test_null_space_projection_twice_is_once(bench, states):
    arm = bench("lwr4").arm
    tau0 = np.linspace(-5.0, 5.0, 7)
    tried = 0
    for q, qd in states(arm, 40, seed=9):
        arm.update(q, qd)
        M, J, out = arm.mass_matrix, arm.jacobian, arm.lambda_ee
        if np.linalg.eigvalsh(J @ np.linalg.solve(M, J.T))[0] < PIVOT_THRESHOLD:
            continue
        L = np.linalg.cholesky(M)
        once = null_space_torque(tau0, L, J, out)
        np.testing.assert_allclose(null_space_torque(once, L, J, out), once, atol=1e-9)
        tried += 1
    assert tried >= 10


def test_arm_of_six_joints_has_no_null_space(bench, states):
    arm = bench("six joints").arm
    tried = 0
    for q, qd in states(arm, 200, seed=10):
        arm.update(q, qd)
        M, J = arm.mass_matrix, arm.jacobian
        if np.linalg.eigvalsh(J @ np.linalg.solve(M, J.T))[0] < PIVOT_THRESHOLD:
            continue
        np.testing.assert_allclose(
            null_space_torque(np.ones(6), np.linalg.cholesky(M), J, arm.lambda_ee), 0.0, atol=1e-9
        )
        tried += 1
    assert tried >= 3


def test_smallest_singular_value_against_a_decomposition() -> None:
    rng = np.random.default_rng(5)
    for _ in range(200):
        J = rng.normal(size=(6, 7)) * rng.uniform(0.05, 2.0, size=(6, 1))
        exact = np.linalg.svd(J, compute_uv=False)[-1]
        assert exact * (1.0 - 1e-12) <= smallest_singular_value(J) <= exact * 1.02
    assert smallest_singular_value(np.zeros((6, 7))) == 0.0
