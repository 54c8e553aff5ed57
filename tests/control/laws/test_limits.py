"""Actuator limits: balance of forces and moments on the body, and what happens without them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog
from scipy.spatial.transform import Rotation

from armland.control.design.gains import Wanted, rule
from armland.control.design.margins import Delays
from armland.control.laws.exact import Reference, exact_law
from armland.control.laws.limits import feasible, takeover
from armland.control.laws.rigid_body import UavParameters
from armland.models.airframe.allocation import allocation_layout, tell_allocation
from armland.models.uav import mixer

LOW, HIGH = 0.09, 1.86
POSITION = np.array([[0.127, 0.127, 0.02], [-0.127, 0.127, 0.02], [-0.127, -0.127, 0.02], [0.127, -0.127, 0.02]])
MIXER = mixer(POSITION, 0.02)
TOLD = np.zeros(1, np.dtype(allocation_layout()))
tell_allocation(TOLD, np.vstack([MIXER, np.zeros((2, 4))]), LOW, HIGH)
ROTORS = TOLD[0]
UAV = UavParameters(0.48, np.diag([0.006, 0.007, 0.012]), np.array([0.0, 0.0, -0.06]))
STILL = Reference(np.array([1.0, 0.0, 0.0, 0.0]), *np.zeros((5, 3)))

vectors = st.tuples(*[st.floats(-1.0, 1.0)] * 3).map(np.array)


def rotors_can(wrench):
    return linprog(np.zeros(4), A_eq=MIXER, b_eq=wrench, bounds=[(LOW - 1e-9, HIGH + 1e-9)] * 4, method="highs").success


@settings(max_examples=40, deadline=None)
@given(st.floats(-2.0, 9.0), vectors)
def test_x4_what_is_given_is_what_rotors_can_give_and_all_of_it_if_they_can(thrust, torque):
    torque = 0.4 * torque
    f_T, tau = feasible(thrust, torque, ROTORS)
    assert rotors_can(np.append(f_T, tau))
    if np.abs(np.append(f_T, tau) - np.append(thrust, torque)).max() > 1e-6:
        assert not rotors_can(np.append(thrust, torque))


def test_x4_attitude_comes_before_thrust_and_thrust_before_yaw():
    f_T, tau = feasible(7.4, np.array([0.2, -0.1, 0.0]), ROTORS)
    np.testing.assert_allclose(tau, [0.2, -0.1, 0.0], atol=1e-9)
    assert f_T < 7.0
    f_T, tau = feasible(4.0, np.array([0.2, -0.1, 0.1]), ROTORS)
    np.testing.assert_allclose([f_T, *tau[:2]], [4.0, 0.2, -0.1], atol=1e-9)
    assert tau[2] < 0.1


@settings(max_examples=100, deadline=None)
@given(vectors, st.floats(-3.0, 3.0), vectors, vectors)
def test_x4_rotors_and_arm_together_make_what_was_asked(axis, lost_thrust, lost_torque, slant):
    R = Rotation.from_rotvec(axis).as_matrix()
    lever = np.array([0.0, 0.0, -0.06]) + 0.03 * slant
    force, left = takeover(R, lost_thrust, lost_torque, lever, 1e6)
    moment = np.cross(lever, R.T @ force)
    np.testing.assert_allclose(moment + left, lost_torque, atol=1e-9)
    # What is left lies along the lever, where no force can turn the body.
    np.testing.assert_allclose(np.cross(left, lever), 0.0, atol=1e-8)
    # Beyond the thrust the force is the shortest of all that make this moment.
    push = R.T @ force - [0.0, 0.0, lost_thrust]
    wanted = lost_torque - np.cross(lever, [0.0, 0.0, lost_thrust])
    cross = np.array([np.cross(lever, e) for e in np.eye(3)]).T
    np.testing.assert_allclose(push, np.linalg.lstsq(cross, wanted, rcond=1e-9)[0], rtol=1e-7, atol=1e-7)


def test_x4_yaw_and_a_body_without_lever_stay_with_the_rotors():
    force, left = takeover(np.eye(3), 0.0, np.array([0.0, 0.0, 0.1]), UAV.lever, 5.0)
    np.testing.assert_array_equal(force, 0.0)
    np.testing.assert_array_equal(left, [0.0, 0.0, 0.1])
    force, left = takeover(np.eye(3), 0.5, np.array([0.1, 0.0, 0.0]), np.zeros(3), 5.0)
    np.testing.assert_array_equal(force, [0.0, 0.0, 0.5])
    np.testing.assert_array_equal(left, [0.1, 0.0, 0.0])


def test_x4_push_stops_at_its_limit_and_keeps_its_direction():
    lost = np.array([0.12, -0.09, 0.0])
    small, left = takeover(np.eye(3), 0.4, lost, UAV.lever, 1.0)
    whole, none = takeover(np.eye(3), 0.4, lost, UAV.lever, 100.0)
    np.testing.assert_allclose(none, 0.0, atol=1e-9)
    assert np.linalg.norm(whole[:2]) == pytest.approx(0.15 / 0.06)
    np.testing.assert_allclose(small, [*(whole[:2] / 2.5), 0.4], atol=1e-9)
    np.testing.assert_allclose(left, 0.6 * lost, atol=1e-9)


def swing(limit, weak=0.4, duration=0.6, dt=1e-3):
    """Largest tilt, rad, and pivot error, m, of a body whose rotors are too weak for a torque of 0.12 N·m over 0.15 s."""
    gains = rule(Wanted(40.0, 1.0), Wanted(15.0, 1.0), UAV, Delays(0.0, 0.0, 0.0)).gains
    phi, rate, y, v = 0.0, 0.0, 0.0, 0.0
    worst, weaker = np.zeros(2), TOLD.copy()
    tell_allocation(weaker, np.vstack([MIXER, np.zeros((2, 4))]), LOW, weak)
    for i in range(round(duration / dt)):
        R = Rotation.from_rotvec([phi, 0.0, 0.0]).as_matrix()
        q, pivot = np.array([np.cos(phi / 2), np.sin(phi / 2), 0.0, 0.0]), R @ UAV.lever - UAV.lever
        pivot[1] += y
        r = np.array([0.0, pivot[1], 0.0])
        delta_tau, force = exact_law(
            q, np.array([rate, 0.0, 0.0]), r, np.array([0.0, v, 0.0]), STILL, 2.35, np.zeros(3), UAV, gains
        )
        f_T, tau = feasible(2.35, delta_tau, weaker[0])
        extra, _ = takeover(R, 2.35 - f_T, delta_tau - tau, UAV.lever, limit)
        force = force + extra
        moment = tau[0] + np.cross(UAV.lever, R.T @ force)[0] + (0.12 if i * dt < 0.15 else 0.0)
        rate += dt * moment / 0.006
        v += dt * (force[1] + f_T * R[1, 2]) / 0.48
        phi, y = phi + dt * rate, y + dt * v
        worst = np.maximum(worst, [abs(phi), abs(r[1])])
        if abs(phi) > 1.5:
            break
    return worst


def test_x4_arm_holds_a_body_that_its_rotors_cannot():
    strong, alone, little, helped = swing(0.0, weak=HIGH), swing(0.0), swing(1.0), swing(5.0)
    assert strong[0] < 0.1
    assert alone[0] > 0.8
    assert helped[0] < 0.25 * alone[0]
    assert helped[0] < little[0] < alone[0]
    # The price that the module states: limit/(K₁K₂ + k₃) of position.
    assert helped[1] < 5.0 / (0.48 * 40.0**2)


def test_x4_push_turns_the_body_the_way_that_the_lost_torque_would():
    """A roll to the left that the rotors do not give: the arm pulls the pivot, below the CM, to the right of it."""
    force, _ = takeover(np.eye(3), 0.0, np.array([0.1, 0.0, 0.0]), UAV.lever, 5.0)
    assert np.cross(UAV.lever, force)[0] == pytest.approx(0.1, rel=1e-6)
    assert force[1] > 0.0
    # In the world's axes, whatever the body's attitude.
    turned, _ = takeover(
        Rotation.from_euler("z", 90, degrees=True).as_matrix(), 0.0, np.array([0.1, 0, 0]), UAV.lever, 5.0
    )
    np.testing.assert_allclose(turned, [-force[1], 0.0, 0.0], atol=1e-9)


@pytest.mark.parametrize("lever", [(0.03, 0.0, -0.06), (0.02, -0.05, 0.01), (-0.06, 0.02, 0.0)])
def test_x4_limit_is_of_the_whole_push_whatever_way_the_lever_points(lever):
    """A moment across the lever that would take 5 N: with 2 N two fifths of it are made."""
    lever = np.array(lever)
    across = np.cross(lever, [0.3, 0.5, 0.7])
    lost = across / np.linalg.norm(across) * 5.0 * np.linalg.norm(lever)
    for limit, size in ((2.0, 2.0), (5.5, 5.0)):
        force, left = takeover(np.eye(3), 0.0, lost, lever, limit)
        assert np.linalg.norm(force) == pytest.approx(size, rel=1e-9)
        np.testing.assert_allclose(left, (1.0 - size / 5.0) * lost, atol=1e-9)
