"""Allocation to the rotors: the wrench that comes out, against a linear programme that knows nothing of the formula."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from armland.models.uav import allocate, mixer

LOW, HIGH = 0.09, 1.86
POSITION = np.array([[0.127, 0.127, 0.02], [-0.127, 0.127, 0.02], [-0.127, -0.127, 0.02], [0.127, -0.127, 0.02]])
# Centre of mass off the middle of the rotors: each then carries another share of the thrust.
SHIFTED = POSITION + np.array([0.01, -0.006, 0.0])
DRAG = 0.02
MIXER = mixer(POSITION, DRAG)
INVERSE = np.linalg.inv(MIXER)

thrusts = st.floats(-2.0, 10.0)
torques = st.tuples(*[st.floats(-1.0, 1.0)] * 2, st.floats(-0.2, 0.2)).map(np.array)


def wrench(rotor):
    return MIXER @ rotor


def test_mixer_is_the_moment_of_each_rotor_about_the_centre_of_mass():
    """Force T e₃ at p: moment p × T e₃, and the drag torque against the spin."""
    up = np.array([0.0, 0.0, 1.0])
    for i, (p, spin) in enumerate(zip(SHIFTED, (1, -1, 1, -1), strict=True)):
        column = mixer(SHIFTED, DRAG)[:, i]
        np.testing.assert_allclose(column, [1.0, *(np.cross(p, up) + spin * DRAG * up)], atol=1e-15)


@settings(max_examples=300, deadline=None)
@given(thrusts, torques)
def test_rotors_stay_within_their_limits(thrust, torque):
    rotor = allocate(thrust, torque, INVERSE, LOW, HIGH)
    assert np.isfinite(rotor).all()
    assert (rotor >= LOW).all()
    assert (rotor <= HIGH).all()


@settings(max_examples=300, deadline=None)
@given(st.lists(st.floats(LOW, HIGH), min_size=4, max_size=4).map(np.array), st.sampled_from([POSITION, SHIFTED]))
def test_what_the_rotors_can_give_is_given_exactly(rotor, position):
    """Whatever four thrusts within the limits make up is feasible; those four are the only way to make it."""
    A = mixer(position, DRAG)
    asked = A @ rotor
    np.testing.assert_allclose(allocate(asked[0], asked[1:], np.linalg.inv(A), LOW, HIGH), rotor, atol=1e-9)


def best_in_order(thrust, torque, A):
    """Roll and pitch by the largest common factor, then the nearest thrust, then the most yaw: three linear programmes.

    Unknowns: T (4), factor of roll and pitch, share of yaw, distance to the wanted thrust.
    """
    equal = np.zeros((3, 7))
    equal[0, :4], equal[0, 4] = A[1], -torque[0]
    equal[1, :4], equal[1, 4] = A[2], -torque[1]
    equal[2, :4], equal[2, 5] = A[3], -torque[2]
    above, below = np.zeros((2, 7))
    above[:4], above[6] = 1.0, -1.0
    below[:4], below[6] = -1.0, -1.0
    bounds = [(LOW, HIGH)] * 4 + [(0.0, 1.0)] * 2 + [(0.0, None)]
    for index, sign in ((4, -1.0), (6, 1.0), (5, -1.0)):
        cost = np.zeros(7)
        cost[index] = sign
        found = linprog(cost, np.array([above, below]), [thrust, -thrust], equal, np.zeros(3), bounds, method="highs")
        assert found.success
        value = found.x[index]
        bounds[index] = (max(value - 1e-6, 0.0), value + 1e-6)
    return found.x[:4]


@pytest.mark.parametrize("position", [POSITION, SHIFTED], ids=["centred", "shifted"])
def test_priority_is_roll_and_pitch_then_thrust_then_yaw(position):
    A = mixer(position, DRAG)
    rng = np.random.default_rng(5)
    saturated = 0
    for _ in range(200):
        thrust, torque = rng.uniform(0.0, 8.0), rng.uniform(-1.0, 1.0, size=3) * [0.25, 0.25, 0.03]
        given_wrench = A @ allocate(thrust, torque, np.linalg.inv(A), LOW, HIGH)
        np.testing.assert_allclose(given_wrench, A @ best_in_order(thrust, torque, A), atol=1e-3)
        saturated += np.abs(given_wrench - [thrust, *torque]).max() > 1e-6
    # The comparison says nothing unless many cases are beyond the rotors.
    assert 50 < saturated < 150


def test_yaw_gives_way_before_thrust_and_thrust_before_tilt():
    rotor = allocate(4.0, np.array([0.1, 0.0, 0.2]), INVERSE, LOW, HIGH)
    given_wrench = wrench(rotor)
    np.testing.assert_allclose(given_wrench[:3], [4.0, 0.1, 0.0], atol=1e-12)
    assert 0.0 < given_wrench[3] < 0.2
    # With all rotors nearly flat out, tilt is only possible at less thrust.
    given_wrench = wrench(allocate(4 * HIGH, np.array([0.1, 0.05, 0.0]), INVERSE, LOW, HIGH))
    np.testing.assert_allclose(given_wrench[1:], [0.1, 0.05, 0.0], atol=1e-12)
    assert given_wrench[0] < 4 * HIGH - 0.1


def test_tilt_beyond_the_rotors_keeps_its_direction():
    roll, pitch = wrench(allocate(2.0, np.array([0.9, 0.6, 0.0]), INVERSE, LOW, HIGH))[1:3]
    assert pitch / roll == pytest.approx(2.0 / 3.0)
    assert roll < 0.9


def test_result_is_continuous_in_what_was_asked():
    """Along straight lines through the space of wrenches no rotor jumps: its slope stays bounded by one constant."""
    rng = np.random.default_rng(6)
    steps = 4000
    steepest = 0.0
    for _ in range(20):
        a, b = (np.array([rng.uniform(-1, 9), *rng.uniform(-1, 1, size=3) * [0.6, 0.6, 0.15]]) for _ in range(2))
        line = a + np.linspace(0.0, 1.0, steps)[:, None] * (b - a)
        rotors = np.array([allocate(w[0], w[1:], INVERSE, LOW, HIGH) for w in line])
        demand = np.abs(INVERSE @ (b - a)).max() / steps
        steepest = max(steepest, np.abs(np.diff(rotors, axis=0)).max() / demand)
    assert steepest < 10.0
