"""Rotors that move through the air: against the quartic's roots, a blade element integrated by hand, power balance, limits."""

import numpy as np
import pytest
from scipy.optimize import brentq

from armland.models.inflow import (
    SLOWEST,
    Rotors,
    advance_of,
    disc_of,
    factor_at_power,
    factor_at_speed,
    small_gain,
    sustained,
)

DISC, K = disc_of(0.1, 1.225), 0.7
M = advance_of(K, 0.115)
ONE = 1.86
V_H = np.sqrt(ONE / DISC)
FOUR = Rotors(4, 4.0 * ONE, DISC, K, M)
STATES = [(x, c) for x in (0.0, 0.1, 0.5, 1.0, 3.0) for c in (-0.4, -0.1, 0.0, 0.2, 1.0, 2.0)]


def at_speed(in_plane, axial, slope=K, advance=M):
    return factor_at_speed(ONE, in_plane, axial, DISC, slope, advance)


def induced(thrust, in_plane, axial, disc):
    """v_i, m/s: the positive root of the quartic that (I.1) is."""
    v_h = np.sqrt(thrust / disc)
    x, c = in_plane / v_h, max(axial / v_h, SLOWEST)
    (root,) = [
        r.real for r in np.roots([1.0, 2.0 * c, x * x + c * c, 0.0, -1.0]) if abs(r.imag) < 1e-9 and r.real > 0.0
    ]
    return root * v_h


def test_hover_is_the_limit_of_everything():
    assert pytest.approx(4.916, abs=1e-3) == V_H
    assert induced(ONE, 0.0, 0.0, DISC) == pytest.approx(V_H, rel=1e-12)
    assert at_speed(0.0, 0.0) == pytest.approx(1.0, abs=1e-12)
    assert factor_at_power(ONE, 0.0, 0.0, DISC) == pytest.approx(1.0, abs=1e-12)
    assert sustained(FOUR, 0.0, 0.22) == pytest.approx(FOUR.static, rel=1e-9)


def test_far_forward_flight_sees_the_air_mass_of_a_wing():
    v = 20.0 * V_H
    assert induced(ONE, v, 0.0, DISC) == pytest.approx(V_H**2 / v, rel=1e-4)


@pytest.mark.parametrize(("x", "c"), STATES)
def test_i3_keeps_the_power(x, c):
    thrust = ONE * factor_at_power(ONE, x * V_H, c * V_H, DISC)
    power = thrust * (induced(thrust, x * V_H, c * V_H, DISC) + c * V_H)
    # (I.1) at the new thrust has its own v_h: only where it stays above the vortex ring's bound is it the same branch.
    if c * V_H > -0.5 * np.sqrt(thrust / DISC):
        assert power == pytest.approx(ONE * V_H, rel=1e-8)


@pytest.mark.parametrize(("x", "c"), [s for s in STATES if s[1] < 2.0])
def test_i2_is_where_momentum_and_blade_agree(x, c):
    def apart(thrust):
        inflow = (induced(thrust, x * V_H, c * V_H, DISC) + c * V_H) / V_H
        return 1.0 + K * (1.0 - inflow) + M * x * x - thrust / ONE

    if c > -0.4 or x > 0.1:
        assert at_speed(x * V_H, c * V_H) == pytest.approx(brentq(apart, 0.05 * ONE, 5.0 * ONE) / ONE, rel=1e-7)


def blade_thrust(inflow, advance, radius=0.1, omega=434.0, theta=0.35, chord=0.02, slope=5.0, blades=2):
    """A straight, untwisted blade element by element and around the disc, small angles."""
    r, psi = np.linspace(0.0, radius, 2001), np.linspace(0.0, 2.0 * np.pi, 181)[:-1]
    speed = omega * r[None, :] + advance * np.sin(psi)[:, None]
    element = 0.5 * 1.225 * slope * chord * (theta * speed**2 - inflow * speed)
    return blades * np.trapezoid(element, r, axis=1).mean()


def test_slope_and_advance_are_those_of_a_blade_element():
    hover = brentq(lambda v: blade_thrust(v, 0.0) - DISC * v * v, 0.5, 20.0)
    ratio, solidity = hover / 43.4, 2 * 0.02 / (np.pi * 0.1)
    h = 1e-4
    slope = (
        -(blade_thrust(hover * (1 + h), 0.0) - blade_thrust(hover * (1 - h), 0.0)) / (2 * h) / blade_thrust(hover, 0)
    )
    assert slope == pytest.approx(solidity * 5.0 / (8.0 * ratio), rel=1e-5)
    gain = blade_thrust(hover, 2.0) / blade_thrust(hover, 0.0) - 1.0
    assert gain == pytest.approx(advance_of(slope, ratio) * (2.0 / hover) ** 2, rel=1e-4)


@pytest.mark.parametrize(("thrust", "expected"), [(at_speed, -K / (2.0 + K)), (None, -1.0 / 3.0)])
def test_climb_costs_thrust_at_the_rate_worked_by_hand(thrust, expected):
    thrust = thrust or (lambda x, n: factor_at_power(ONE, x, n, DISC))
    h = 1e-4 * V_H
    assert (thrust(0.0, h) - thrust(0.0, -h)) / (2.0 * h) * V_H == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize("power", [False, True])
@pytest.mark.parametrize("drag", [0.0, 0.22])
def test_gain_at_small_speed_is_the_series(power, drag):
    v = 0.2
    gain = sustained(FOUR, v, drag, power) / FOUR.static - 1.0
    assert gain == pytest.approx(small_gain(FOUR, v, drag, power), rel=0.01)


@pytest.mark.parametrize("speed", [0.5, 3.0, 7.0])
def test_level_flight_balances_drag_and_weight(speed):
    def apart(tilt):
        t = at_speed(speed * np.cos(tilt), speed * np.sin(tilt)) * FOUR.static
        return t * np.sin(tilt) - 0.22 * speed

    tilt = brentq(apart, 0.0, 0.8)
    thrust = at_speed(speed * np.cos(tilt), speed * np.sin(tilt)) * FOUR.static
    assert sustained(FOUR, speed, 0.22) == pytest.approx(thrust * np.cos(tilt), rel=1e-9)


def test_drag_eats_the_gain_at_last():
    assert sustained(FOUR, 12.0, 0.22) < sustained(FOUR, 7.0, 0.22) < sustained(FOUR, 7.0, 0.0)
    assert sustained(FOUR, 100.0, 0.5) == 0.0


def test_a_rotor_in_fast_climb_gives_nothing_and_never_pulls():
    assert at_speed(0.0, 3.0 * V_H) == 0.0
    assert factor_at_speed(0.0, 1.0, 1.0, DISC, K, M) == 1.0


def test_the_vortex_ring_counts_as_its_border():
    assert at_speed(0.3, -2.0 * V_H) == at_speed(0.3, -0.5 * V_H)
