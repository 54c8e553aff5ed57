"""Quaternions and rotations against scipy's Rotation, an independent implementation."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armland import rotations


def random_quaternion(rng):
    q = rng.normal(size=4)
    return q / np.linalg.norm(q)


def to_scipy(q):
    return Rotation.from_quat(q, scalar_first=True)


@pytest.fixture
def rng():
    return np.random.default_rng(1)


def test_eq18_sign_of_zero_is_plus_one():
    assert [rotations.sgn(x) for x in (-2.0, -1e-300, 0.0, -0.0, 1e-300, 3.0)] == [-1.0, -1.0, 1.0, 1.0, 1.0, 1.0]


def test_cross_and_skew_agree_with_numpy(rng):
    for _ in range(20):
        a, b = rng.normal(size=(2, 3))
        np.testing.assert_allclose(rotations.cross(a, b), np.cross(a, b), atol=1e-15)
        np.testing.assert_allclose(rotations.skew(a) @ b, np.cross(a, b), atol=1e-15)


def test_matrix_turns_body_into_world(rng):
    for _ in range(50):
        q = random_quaternion(rng)
        R = rotations.matrix(q)
        np.testing.assert_allclose(R, to_scipy(q).as_matrix(), atol=1e-14)
        np.testing.assert_allclose(R, rotations.matrix(-q), atol=0.0)
        np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-14)
    quarter_turn_about_z = np.array([np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)])
    np.testing.assert_allclose(rotations.matrix(quarter_turn_about_z) @ [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], atol=1e-15)


def test_product_composes_rotations(rng):
    for _ in range(50):
        a, b = random_quaternion(rng), random_quaternion(rng)
        product = to_scipy(rotations.multiply(a, b))
        assert (product.inv() * to_scipy(a) * to_scipy(b)).magnitude() < 1e-14
        np.testing.assert_allclose(rotations.multiply(a, rotations.conjugate(a)), [1.0, 0.0, 0.0, 0.0], atol=1e-15)


def test_eq15_error_takes_the_desired_into_the_true_attitude(rng):
    for _ in range(50):
        q_d, q = random_quaternion(rng), random_quaternion(rng)
        np.testing.assert_allclose(rotations.multiply(q_d, rotations.error(q_d, q)), q, atol=1e-15)
        R_e = rotations.matrix(rotations.error(q_d, q))
        np.testing.assert_allclose(R_e, rotations.matrix(q_d).T @ rotations.matrix(q), atol=1e-14)


def test_angle_is_scipys_magnitude_for_both_signs(rng):
    for _ in range(50):
        q = random_quaternion(rng)
        assert rotations.angle(q) == pytest.approx(to_scipy(q).magnitude(), abs=1e-14)
        assert rotations.angle(-q) == rotations.angle(q)


@pytest.mark.parametrize("theta", [1e-9, 1e-5, 0.99e-4, 1.01e-4])
def test_angle_keeps_its_digits_when_small(theta):
    q = rotations.from_rotation_vector(theta * np.array([0.6, 0.0, -0.8]))
    assert rotations.angle(q) == pytest.approx(theta, rel=1e-12, abs=0.0)


@pytest.mark.parametrize("theta", [0.0, 1e-12, 0.99e-4, 1.01e-4, 0.3, 3.0, np.pi, 5.0, 20.0])
def test_rotation_vector_against_scipy(rng, theta):
    axis = rng.normal(size=3)
    vector = theta * axis / np.linalg.norm(axis)
    q = rotations.from_rotation_vector(vector)
    assert np.linalg.norm(q) == pytest.approx(1.0, abs=1e-15)
    np.testing.assert_allclose(rotations.matrix(q), Rotation.from_rotvec(vector).as_matrix(), atol=1e-14)


def test_kinematics_of_the_quaternion(rng):
    q, omega = random_quaternion(rng), rng.normal(size=3)
    h = 1e-3
    rate = 0.5 * rotations.multiply(q, np.concatenate(([0.0], omega)))
    ahead, behind = (rotations.multiply(q, rotations.from_rotation_vector(s * h * omega)) for s in (1.0, -1.0))
    np.testing.assert_allclose((ahead - behind) / (2.0 * h), rate, atol=h**2)


@pytest.mark.parametrize("theta", [0.0, 1e-10, 1e-6, 0.5, 2.0, 3.0, np.pi - 1e-4])
def test_rotation_error_is_the_world_vector_that_turns_one_into_the_other(rng, theta):
    for _ in range(20):
        axis = rng.normal(size=3)
        vector = theta * axis / np.linalg.norm(axis)
        R = to_scipy(random_quaternion(rng)).as_matrix()
        R_d = Rotation.from_rotvec(vector).as_matrix() @ R
        np.testing.assert_allclose(rotations.rotation_error(R, R_d), vector, rtol=1e-9, atol=1e-11)


@pytest.mark.parametrize("short_of_pi", [0.0, 1e-12, 5e-10, 2e-9, 1e-7])
def test_rotation_error_stays_finite_and_right_next_to_half_a_turn(rng, short_of_pi):
    axes = [*np.eye(3), *-np.eye(3), *rng.normal(size=(30, 3))]
    for axis in axes:
        R = to_scipy(random_quaternion(rng)).as_matrix()
        R_d = Rotation.from_rotvec((np.pi - short_of_pi) * axis / np.linalg.norm(axis)).as_matrix() @ R
        vector = rotations.rotation_error(R, R_d)
        reached = Rotation.from_rotvec(vector).as_matrix() @ R
        np.testing.assert_allclose(reached, R_d, atol=1e-6)
        assert np.linalg.norm(vector) == pytest.approx(np.pi, abs=2e-7)


def test_quaternion_of_a_matrix_is_scipys_in_all_quarters(rng):
    """Of all rotations, and of those by nearly half a turn about each axis, where one element after the other vanishes."""
    turns = [Rotation.random(rng=rng) for _ in range(50)]
    turns += [Rotation.from_rotvec(3.14 * axis + 1e-3 * rng.normal(size=3)) for axis in np.eye(3)]
    for turn in turns:
        q = rotations.quaternion_of(turn.as_matrix())
        assert (to_scipy(q) * turn.inv()).magnitude() < 1e-7
        assert np.linalg.norm(q) == pytest.approx(1.0)
