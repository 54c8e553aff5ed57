"""Capsules along links that have no shape."""

import numpy as np
import pytest

from armland.models.arm_file.shapes import capsule, length
from armland.rotations import matrix


def test_link_without_a_shape_gets_a_capsule_from_joint_to_joint(arm):
    chain = arm("ok.urdf").chain
    third = next(k for k in chain.links if k.name == "l3")
    (shape,) = third.shapes
    assert shape.kind == "capsule"
    assert shape.size[1] == pytest.approx(0.105)
    np.testing.assert_allclose(shape.pose.pos, [0.0, 0.0, 0.105])
    assert length(chain) == pytest.approx(0.21 + 0.21 + 0.2 + 0.2 + 0.06 + 0.07)


def test_radius_goes_with_the_size_of_the_arm(arm):
    radius = {n: arm(f"{n}.urdf").chain.links[3].shapes[0].size[0] for n in ("small", "ok", "big")}
    assert 0.02 <= radius["small"] < radius["ok"] <= radius["big"] <= 0.065


def test_ends_of_a_capsule_are_its_points():
    rng = np.random.default_rng(0)
    for _ in range(20):
        a, b = rng.normal(size=3), rng.normal(size=3)
        shape = capsule(a, b, 0.01)
        axis = matrix(shape.pose.quat)[:, 2] * shape.size[1]
        np.testing.assert_allclose([shape.pose.pos - axis, shape.pose.pos + axis], [a, b], atol=1e-12)
    down = capsule(np.zeros(3), np.array([0.0, 0.0, -1.0]), 0.01)
    np.testing.assert_allclose(matrix(down.pose.quat)[:, 2], [0.0, 0.0, -1.0], atol=1e-12)


def test_too_short_for_a_capsule_is_a_sphere():
    assert capsule(np.zeros(3), np.full(3, 0.01), 0.05).kind == "sphere"
