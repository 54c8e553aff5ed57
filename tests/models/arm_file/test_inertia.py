"""Inertias that a body can have, nearly has, and cannot have; several bodies as one against a cloud of points."""

import numpy as np
import pytest

from armland.models.arm_file.inertia import extended, impossible, lacking, lumped, principal, raised, tensor
from armland.models.arm_file.tree import Inertial, Pose, here
from armland.rotations import from_rotation_vector, matrix


def cloud(rng, count=6):
    points, masses = rng.normal(scale=0.1, size=(count, 3)), rng.uniform(0.1, 1.0, count)
    return points, masses


def of(points, masses):
    com = masses @ points / masses.sum()
    d = points - com
    total = sum(m * (x @ x * np.eye(3) - np.outer(x, x)) for m, x in zip(masses, d, strict=True))
    moments, quat = principal(total)
    return Inertial(float(masses.sum()), com, quat, moments)


def test_bodies_that_move_as_one_are_their_points_together():
    rng = np.random.default_rng(4)
    parts, world, weights = [], [], []
    for _ in range(3):
        points, masses = cloud(rng)
        at = Pose(rng.normal(size=3), from_rotation_vector(rng.normal(size=3)))
        parts.append((of(points, masses), at))
        world.append(at.pos + points @ matrix(at.quat).T)
        weights.append(masses)
    ours, whole = lumped(parts), of(np.concatenate(world), np.concatenate(weights))
    assert ours.mass == pytest.approx(whole.mass)
    np.testing.assert_allclose(ours.pos, whole.pos, atol=1e-12)
    np.testing.assert_allclose(tensor(ours), tensor(whole), atol=1e-10)


def test_one_body_in_place_keeps_every_bit_and_nothing_is_none():
    one = of(*cloud(np.random.default_rng(1)))
    assert lumped([(one, here()), (one._replace(mass=0.0), here())]) is one
    assert lumped([]) is None


def test_principal_axes_give_the_tensor_back():
    rng = np.random.default_rng(2)
    for _ in range(20):
        body = of(*cloud(rng))
        moments, quat = principal(tensor(body))
        np.testing.assert_allclose(tensor(body._replace(moments=moments, quat=quat)), tensor(body), atol=1e-12)


@pytest.mark.parametrize(
    ("moments", "short"),
    [([1.0, 1.0, 1.0], -1.0), ([1.0, 1.0, 2.0], 0.0), ([1.0, 1.0, 4.0], 0.5), ([-1.0, 1.0, 1.0], 1.0)],
)
def test_what_is_missing_from_the_triangle(moments, short):
    assert lacking(np.array(moments)) == pytest.approx(short)
    assert bool(impossible("l", np.array(moments))) == (short > 0.05)


def test_rounding_is_raised_by_what_is_missing_alike_about_all_axes():
    rounded = np.array([0.0030, 0.0031, 0.00615])
    better = raised(rounded)
    np.testing.assert_allclose(better - rounded, 0.00005, rtol=1e-6)
    assert lacking(better) <= 0.0
    np.testing.assert_array_equal(raised(np.ones(3)), np.ones(3))


def test_point_mass_becomes_a_small_solid():
    point = Inertial(2.0, np.zeros(3), here().quat, np.zeros(3))
    np.testing.assert_allclose(extended(point).moments, 2.0 * 0.03**2)
    solid = point._replace(moments=np.full(3, 0.1))
    assert extended(solid) is solid
