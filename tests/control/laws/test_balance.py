"""Balancing: the pendulum on a moved pivot against MuJoCo, poles, margins with and without prediction, and that it holds."""

import mujoco
import numpy as np
import pytest

from armland.control.design.balance import balance_gains, fall_rate
from armland.control.laws.balance import capture_angle, fall, falling, lean_of, observed, predicted, push
from armland.control.laws.rigid_body import UavParameters
from armland.rotations import from_rotation_vector, matrix, multiply

UAV = UavParameters(0.48, np.diag([0.006, 0.007, 0.012]), np.array([0.0, 0.0, -0.06]))
RATE = fall_rate(UAV)
LINK_S, ARM_S = 0.0175, 0.004

CART = """
<mujoco>
  <option timestep="0.0001" gravity="0 0 -9.81"/>
  <worldbody>
    <body>
      <joint name="pivot" type="slide" axis="1 0 0"/>
      <inertial pos="0 0 0" mass="1000" diaginertia="1 1 1"/>
      <body>
        <joint name="hinge" axis="0 1 0"/>
        <inertial pos="0 0 0.06" mass="0.48" diaginertia="0.0065 0.0065 0.012"/>
      </body>
    </body>
  </worldbody>
</mujoco>
"""


class Cart:
    """The UAV on its pivot, in MuJoCo; the pivot is so heavy that it goes as it is pushed."""

    def __init__(self, tilt=0.0, rate=0.0):
        self.model = mujoco.MjModel.from_xml_string(CART)
        self.data = mujoco.MjData(self.model)
        self.data.qpos[1], self.data.qvel[1] = tilt, rate

    def go(self, u, seconds):
        """Push the pivot with `u` m/s²."""
        for _ in range(round(seconds / 1e-4)):
            self.data.qfrc_applied[0] = 1000.0 * u
            mujoco.mj_step(self.model, self.data)


def balanced(tilt, rate, delay_s, gains=None, predicts=True, seconds=4.0, reach=1.0, strongest=15.0):
    """Balance the cart from a tilt and its rate, with measurements `delay_s` old; ways and tilts (k,)."""
    gains, cart = gains or balance_gains(RATE), Cart(tilt, rate)
    late = round(delay_s / 1e-3)
    seen, speed = [(tilt, rate)] * (late + 1), [0.0] * (late + 1)
    way, tilts = [], []
    for _ in range(round(seconds / 1e-3)):
        x, th = cart.data.qpos
        v, om = cart.data.qvel
        seen.append((th, om))
        speed.append(v)
        th, om = seen[-1 - late]
        th += om * delay_s
        if predicts:
            th, om = predicted(th, om, v - speed[-1 - late], delay_s, RATE)
        cart.go(push(th, om, x, v, gains, strongest, reach), 1e-3)
        way.append(cart.data.qpos[0])
        tilts.append(cart.data.qpos[1])
        if abs(tilts[-1]) > 1.0:
            break
    return np.array(way), np.array(tilts)


@pytest.mark.parametrize("u", [0.0, 2.0, -5.0])
def test_b1_is_the_pendulum_of_mujoco(u):
    tilt, step = 0.02, 1e-3
    cart = Cart(tilt)
    cart.go(u, step)
    assert cart.data.qvel[1] / step == pytest.approx(fall(tilt, u, RATE), rel=2e-3, abs=2e-3)


def test_b2_capture_point_grows_by_e_in_one_over_the_rate():
    cart = Cart(1e-4, 1e-3)
    begin = 1e-4 + 1e-3 / RATE
    cart.go(0.0, 1.0 / RATE)
    assert cart.data.qpos[1] + cart.data.qvel[1] / RATE == pytest.approx(np.e * begin, rel=1e-3)


def test_lean_is_the_bodys_axis_and_its_rate():
    quat, omega = from_rotation_vector(np.array([0.3, -0.2, 1.1])), np.array([0.4, -0.7, 0.9])
    axes = [matrix(multiply(quat, from_rotation_vector(omega * dt)))[:2, 2] for dt in (-1e-6, 1e-6)]
    found = lean_of(quat, omega)
    np.testing.assert_allclose(found[:2], matrix(quat)[:2, 2], atol=1e-12)
    np.testing.assert_allclose(found[2:], (axes[1] - axes[0]) / 2e-6, atol=1e-8)
    expected = np.hypot(found[0] + found[2] / RATE, found[1] + found[3] / RATE)
    assert capture_angle(quat, omega, RATE, np.zeros(2)) == pytest.approx(expected)
    assert capture_angle(quat, omega, RATE, matrix(quat)[:2, 2]) == pytest.approx(np.hypot(*found[2:]) / RATE)


def test_b5_predicts_over_the_delay():
    cart, delay, u = Cart(0.05, 0.6), 0.02, -8.0
    carried = 0.05 + 0.6 * delay
    cart.go(u, delay)
    tilt, rate = predicted(carried, 0.6, u * delay, delay, RATE)
    # Without it the rate would be 0.67 rad/s wrong.
    assert rate == pytest.approx(cart.data.qvel[1], abs=0.03)
    assert tilt == pytest.approx(cart.data.qpos[1], abs=1e-3)
    assert abs(0.6 - cart.data.qvel[1]) > 0.5


@pytest.mark.parametrize("pole", [4.0, 8.0])
def test_b6_finds_the_tilt_at_which_a_side_force_lets_it_stand(pole):
    """A side force F at the centre of mass is balanced at θ₀ = −F/(m g); the error decays as (1 + p t/…) e^(−p t)."""
    cart, gains, upright, carried, force = Cart(), balance_gains(RATE), 0.0, 0.0, 0.15
    cart.data.xfrc_applied[2, 0] = force
    true, errors = -force / (0.48 * 9.81), []
    for _ in range(3000):
        (x, tilt), (v, rate) = cart.data.qpos, cart.data.qvel
        upright, carried = observed(upright, carried, tilt, falling(rate, v, RATE), 1e-3, RATE, pole)
        errors.append(upright - true)
        cart.go(push(tilt - true, rate, x, v, gains, 15.0, 1.0), 1e-3)
    t = np.arange(1, 3001) * 1e-3
    # Both poles at −p, from an error that is seen only through what it does to w.
    np.testing.assert_allclose(errors, -true * (1.0 + pole * t) * np.exp(-pole * t), atol=0.03 * abs(true))
    assert errors[-1] == pytest.approx(0.0, abs=1e-3 * abs(true))


def test_stands_up_and_comes_back():
    way, tilts = balanced(0.01, 0.3, LINK_S)
    assert abs(way[-1]) < 1e-3
    assert abs(tilts[-1]) < 1e-3
    assert np.abs(way).max() < 0.06


def test_falls_without_balancing():
    still = balance_gains(RATE)._replace(position=0.0, speed=0.0, tilt=0.0, tilt_rate=0.0)
    _, tilts = balanced(0.01, 0.3, LINK_S, still)
    assert abs(tilts[-1]) > 1.0


def test_does_not_settle_without_prediction():
    _, tilts = balanced(0.01, 0.3, LINK_S + ARM_S, predicts=False)
    _, settled = balanced(0.01, 0.3, LINK_S + ARM_S)
    assert np.abs(tilts[-500:]).max() > 20.0 * np.abs(settled[-500:]).max()


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_push_stops_before_the_end_of_the_reach(side):
    gains, x, v = balance_gains(RATE), 0.0, 0.0
    for _ in range(2000):
        u = push(side * 0.3, side * 1.0, x, v, gains, 15.0, 0.11)
        assert abs(u) <= 15.0
        v += 1e-3 * u
        x += 1e-3 * v
    assert 0.10 < side * x < 0.115


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_push_is_free_to_bring_the_pivot_back_from_beyond_its_reach(side):
    """Beyond the end, but moving inwards: what (B.3) wants is given; moving outwards, it brakes."""
    only = balance_gains(RATE)._replace(position=0.0, speed=0.0, tilt_rate=0.0, tilt=20.0)
    assert push(side * 0.1, 0.0, side * 0.2, -side * 0.1, only, 15.0, 0.11) == pytest.approx(side * 2.0)
    assert push(side * 0.1, 0.0, side * 0.2, side * 0.1, only, 15.0, 0.11) == pytest.approx(-side * 7.5)


def test_b5_carries_tilt_by_half_of_what_the_rate_gains():
    """Constant θ̈ over the delay: θ ends ½ T Δ beyond what the rate alone makes of it."""
    cart, delay, u = Cart(0.05, 0.6), 0.03, -8.0
    cart.go(u, delay)
    tilt, rate = predicted(0.05 + 0.6 * delay, 0.6, u * delay, delay, RATE)
    beyond = cart.data.qpos[1] - (0.05 + 0.6 * delay)
    assert beyond == pytest.approx(0.5 * delay * (rate - 0.6), rel=0.06)
    assert tilt - (0.05 + 0.6 * delay) == pytest.approx(beyond, rel=0.06)
