"""Allocation to any rotors: what they can give is given; what they cannot, against SciPy's solvers, which share no code."""

import numpy as np
import pytest
from scipy.optimize import linprog, lsq_linear

from armland.models.airframe.allocation import (
    PRIORITY,
    allocation_layout,
    inverse_of,
    least_squares,
    share_out,
    tell_allocation,
)
from armland.models.airframe.rotor_set import RotorSet, alternating, effect_of

LOW, HIGH, DRAG = 0.1, 2.0, 0.02


def ring(count, tilt=0.0, reach=0.25):
    """Rotors on a circle, canted about their beams by ± `tilt`, rad, in turns."""
    angle = 2.0 * np.pi * np.arange(count) / count + 0.3
    place = np.stack([reach * np.cos(angle), reach * np.sin(angle), np.zeros(count)], axis=1)
    side = np.sin(tilt) * (-1.0) ** np.arange(count)
    axis = np.stack([-np.sin(angle) * side, np.cos(angle) * side, np.full(count, np.cos(tilt))], axis=1)
    return RotorSet(place, axis, alternating(place))


def told_of(rotors):
    effect, told = effect_of(rotors, DRAG), np.zeros(1, np.dtype(allocation_layout()))
    tell_allocation(told, effect, LOW, HIGH)
    return effect, told[0]


AIRFRAMES = [ring(6), ring(8), ring(4, 0.2), ring(6, 0.3), ring(8, 0.35)]
IDS = ["hexa", "octo", "quad tilted", "hexa tilted", "octo tilted"]


@pytest.mark.parametrize("rotors", AIRFRAMES, ids=IDS)
def test_whatever_the_rotors_can_make_is_made(rotors):
    """Random thrusts within the limits make a wrench that is feasible; it comes out, though not by the same thrusts."""
    g, (effect, told), n, clipped = np.random.default_rng(1), told_of(rotors), rotors.number, 0
    for _ in range(300):
        wrench = effect[:4] @ np.where(g.random(n) < 0.4, g.choice([LOW, HIGH], n), g.uniform(LOW, HIGH, n))
        given = share_out(wrench[0], wrench[1:], told)
        assert (given[n:] == 0.0).all()
        assert (given[:n] >= LOW).all()
        assert (given[:n] <= HIGH).all()
        np.testing.assert_allclose(effect[:4] @ given[:n], wrench, atol=2e-5 * n * HIGH)
        least = np.clip(np.linalg.pinv(effect[:4]) @ wrench, LOW, HIGH)
        clipped += np.abs(effect[:4] @ least - wrench).max() > 1e-3
    # Negative control: without the null space the least squares, cut off at the limits, miss many of them; four rotors have none.
    assert clipped > 20 or n == 4


@pytest.mark.parametrize("rotors", AIRFRAMES, ids=IDS)
def test_bounded_least_squares_against_scipy(rotors):
    g, (effect, _), n = np.random.default_rng(2), told_of(rotors), rotors.number
    for _ in range(60):
        A = np.vstack([g.uniform(0.5, 2.0, 6)[:, None] * effect, 1e-2 * np.eye(n)])
        b = A @ g.uniform(LOW - 1.5, HIGH + 1.5, n)
        expected = lsq_linear(A, b, (LOW, HIGH), method="bvls", tol=1e-14).x
        np.testing.assert_allclose(least_squares(A, b, LOW, HIGH), expected, atol=1e-6)


@pytest.mark.parametrize("rotors", AIRFRAMES, ids=IDS)
def test_roll_and_pitch_come_first_then_thrust_then_yaw(rotors):
    """Torque far beyond the rotors on one axis: a linear programme says how much of it, then how near the thrust, can be had."""
    g, (effect, told), n = np.random.default_rng(3), told_of(rotors), rotors.number
    box = [(LOW, HIGH)] * n
    for _ in range(25):
        wanted = g.uniform(LOW, HIGH) * n
        most = linprog(-effect[1], A_eq=effect[2:3], b_eq=[0.0], bounds=box)
        given = effect[:4] @ share_out(wanted, np.array([10.0, 0.0, g.uniform(-0.01, 0.01)]), told)[:n]
        # (1) weighs: a roll that is wholly out of reach may turn the pitch a little.
        assert given[1] >= -most.fun * 0.98
        # A roll within reach is kept at any thrust and any yaw.
        half = -0.5 * most.fun
        given = effect[:4] @ share_out(3.0 * n * HIGH, np.array([half, 0.0, 1.0]), told)[:n]
        np.testing.assert_allclose(given[1:3], [half, 0.0], atol=4e-3 * abs(most.fun))
        up = linprog(-effect[0], A_eq=effect[1:3], b_eq=[half, 0.0], bounds=box)
        assert given[0] == pytest.approx(-up.fun, rel=1e-2)


def test_heavier_rows_come_first():
    assert PRIORITY[1] == PRIORITY[2] > 10.0 * PRIORITY[0] > 100.0 * PRIORITY[3] > 1000.0 * PRIORITY[4]


@pytest.mark.parametrize("rotors", AIRFRAMES, ids=IDS)
def test_thrusts_are_continuous_in_what_is_asked(rotors):
    _, told = told_of(rotors)
    line = np.linspace(0.0, 1.0, 4001)
    path = np.array([share_out(8.0 + 6.0 * s, np.array([1.5 * s, -0.8 * s, 0.2 * s]), told) for s in line])
    assert np.abs(np.diff(path, axis=0)).max() < 0.02


def test_tilted_rotors_push_sideways_no_more_than_they_must():
    """Eight rotors that lean any way can make all six: thrust and torque then need no lateral force."""
    whole, g = ring(8), np.random.default_rng(4)
    axis = whole.axis + np.append(g.uniform(-0.1, 0.1, (8, 2)), np.zeros((8, 1)), axis=1)
    effect, _ = told_of(whole._replace(axis=axis / np.linalg.norm(axis, axis=1)[:, None]))
    np.testing.assert_allclose(effect[:4] @ inverse_of(effect), np.eye(4), atol=1e-9)
    np.testing.assert_allclose(effect[4:] @ inverse_of(effect), 0.0, atol=1e-9)
    # Negative control: the least squares of thrust and torque alone push sideways.
    assert np.abs(effect[4:] @ np.linalg.pinv(effect[:4])).max() > 1e-2
