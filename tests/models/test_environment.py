"""Apparent gravity and moment on a moving deck: against a point and a body that fly straight in the inertial frame, and Pinocchio."""

import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial.transform import Rotation

from armland.models.environment import DOWN, apparent_gravity, apparent_moment, environment_layout, on_land

INERTIA = np.array([[0.006, 0.0004, -0.0003], [0.0004, 0.007, 0.0002], [-0.0003, 0.0002, 0.012]])


def deck(rng, **parts):
    """A random motion of the deck; `parts` are what it has, all of it if none are named."""
    e = np.zeros(1, environment_layout())
    e["gravity"] = Rotation.random(rng=rng).apply(DOWN)
    for name in ("base_v", "base_omega", "base_a", "base_alpha"):
        e[name] = rng.normal(size=3) * parts.get(name, 0.0 if parts else 1.0)
    return e


def test_on_land_it_is_gravity_to_the_last_bit():
    rng = np.random.default_rng(0)
    for _ in range(50):
        r, v, omega = rng.normal(size=(3, 3))
        assert apparent_gravity(on_land()[0], r, v) == DOWN
        R = Rotation.random(rng=rng).as_matrix()
        np.testing.assert_array_equal(apparent_moment(on_land()[0], R, omega, INERTIA), 0.0)
    assert apparent_gravity(on_land((0.1, 0.2, -9.8))[0], r, v) == (0.1, 0.2, -9.8)


def seen_from_deck(e, place):
    """`place` (3,), as a function of time in the inertial frame, as the deck sees it: t -> its position there.

    The inertial frame is the deck's own at t = 0; the deck turns and moves with constant acceleration in it.
    """
    omega, alpha, v, a = (e[name][0] for name in ("base_omega", "base_alpha", "base_v", "base_a"))

    def position(t):
        # To third order in t, which central differences of second order do not see.
        turn = Rotation.from_rotvec(omega * t + 0.5 * alpha * t * t)
        return turn.inv().apply(place(t) - v * t - 0.5 * a * t * t)

    return position


@pytest.mark.parametrize("part", ["base_omega", "base_a", "base_alpha", "all"])
def test_x5_a_point_that_falls_freely_falls_with_gamma_on_the_deck(part):
    """Second derivation: a parabola in the inertial frame, looked at from the deck, differentiated twice."""
    rng = np.random.default_rng(1)
    for _ in range(10):
        e = deck(rng) if part == "all" else deck(rng, **{part: 1.0})
        r, v = rng.normal(size=(2, 3))
        start = v + np.cross(e["base_omega"][0], r) + e["base_v"][0]
        position = seen_from_deck(e, lambda t, r=r, start=start, e=e: r + start * t + 0.5 * e["gravity"][0] * t * t)
        h = 2e-3
        near, far, here = (position(h), position(-h)), (position(2.0 * h), position(-2.0 * h)), position(0.0)
        velocity = (8.0 * (near[0] - near[1]) - far[0] + far[1]) / (12.0 * h)
        acceleration = (16.0 * (near[0] + near[1]) - far[0] - far[1] - 30.0 * here) / (12.0 * h * h)
        np.testing.assert_allclose(velocity, v, atol=1e-8)
        np.testing.assert_allclose(acceleration, apparent_gravity(e[0], r, v), atol=1e-6)


def free_flyer():
    """A deck that flies freely with a body on a six-axis joint: the deck's motion can be prescribed."""
    model = pin.Model()
    base = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "deck")
    joint = model.addJoint(base, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "body")
    model.appendBodyToJoint(joint, pin.Inertia(0.48, np.zeros(3), INERTIA), pin.SE3.Identity())
    return model


def test_x5_pinocchio_needs_the_force_and_moment_that_newton_and_euler_need_on_the_deck():
    """Inverse dynamics of a body on a deck of prescribed twist and acceleration, for random motions of both."""
    model, rng = free_flyer(), np.random.default_rng(2)
    data = model.createData()
    for _ in range(20):
        e, R = deck(rng), Rotation.random(rng=rng)
        r, v, omega, a, alpha = rng.normal(size=(5, 3))
        model.gravity.linear[:] = e["gravity"][0]
        q = np.concatenate([np.zeros(3), [0, 0, 0, 1.0], r, R.as_quat()])
        inward = R.inv()
        twist = np.concatenate([e["base_v"][0], e["base_omega"][0], inward.apply(v), omega])
        # Of a free flyer the linear part is spatial: the point's acceleration less ω × v.
        base = np.concatenate([e["base_a"][0] - np.cross(e["base_omega"][0], e["base_v"][0]), e["base_alpha"][0]])
        body = np.concatenate([inward.apply(a) - np.cross(omega, inward.apply(v)), alpha])
        needed = pin.rnea(model, data, q, twist, np.concatenate([base, body]))[6:]
        force = 0.48 * (a - apparent_gravity(e[0], r, v))
        np.testing.assert_allclose(R.apply(needed[:3]), force, atol=1e-9)
        own = INERTIA @ alpha + np.cross(omega, INERTIA @ omega)
        moment = own - apparent_moment(e[0], R.as_matrix(), omega, INERTIA)
        np.testing.assert_allclose(needed[3:], moment, atol=1e-10)
        assert np.abs(needed[3:] - own).max() > 1e-4


def test_x5_sizes_of_the_terms_on_a_hull_in_sea_state_3():
    """theory.md 8: Euler 0.3, centripetal 0.02, Coriolis 0.06 m/s² at 1 m and 0.2 m/s."""
    e = on_land()
    r, v = np.array([1.0, 0.0, 0.0]), np.array([0.2, 0.0, 0.0])

    def size(**parts):
        one = e.copy()
        for name, value in parts.items():
            one[name] = value
        return np.linalg.norm(np.subtract(apparent_gravity(one[0], r, v), DOWN))

    assert size(base_alpha=[0.0, 0.3, 0.0]) == pytest.approx(0.3)
    assert size(base_omega=[0.0, 0.14, 0.0]) == pytest.approx(np.hypot(0.14**2, 2.0 * 0.14 * 0.2), rel=1e-6)
