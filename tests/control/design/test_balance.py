"""Gains of the balance: the poles that they place, and the margins with and without prediction."""

import numpy as np
import pytest

from armland.control.design.balance import POLES, balance_gains, fall_rate
from armland.control.design.gains import MAX_SENSITIVITY
from armland.control.design.margins import Loop, margins
from armland.control.laws.rigid_body import UavParameters
from armland.errors import ConfigurationError
from armland.mission.reference.balance import OBSERVED

UAV = UavParameters(0.48, np.diag([0.006, 0.007, 0.012]), np.array([0.0, 0.0, -0.06]))
RATE = fall_rate(UAV)
LINK_S, ARM_S = 0.0175, 0.004


def balance_loop(gains, rate, delay, arm=0.0, predicts=True, pole=None):
    """Loop of (B.1) under (B.3), broken at u; with the observer (B.6) where it has a `pole`, 1/s.

    Args:
        gains: of `balance_gains`.
        rate: ω₀, rad/s.
        delay: T of (B.5), s.
        arm: by which the arm's push is later than (B.5) takes it to be, s.
        predicts: with (B.5), or with attitude and rates as they arrive.
    """
    k, w2 = gains, rate**2
    pivot = -np.polymul([k.speed, k.position], [1.0, 0.0, -w2]).astype(np.float64)
    denominator = np.array([1.0, 0.0, -w2, 0.0, 0.0])
    if not predicts:
        plain = np.array([k.tilt_rate, k.tilt, 0.0, 0.0]) * w2 / 9.81
        return Loop((pivot, plain), (0.0, arm + delay), denominator)
    carried, step = np.array([delay, 1.0]), k.tilt_rate + 0.5 * delay * k.tilt
    late = np.polyadd(np.array([k.tilt_rate, 0.0]), (k.tilt + step * w2 * delay) * carried)
    body = np.polymul(late, [1.0, 0.0, 0.0]).astype(np.float64) * w2 / 9.81
    known = step * w2 / 9.81 * np.array([1.0, 0.0, -w2, 0.0])
    parts, delays = [pivot, body, known, -known], [0.0, arm + delay, 0.0, delay]
    if pole is not None:
        # By (B.1) θ − θ̈/ω₀² is u/g, an `arm` later than (B.6) takes it to be: θ₀ = p²/(s + p)² e^(−sT) (e^(−s arm) − 1) u/g.
        slow = np.array([1.0, 2.0 * pole, pole**2])
        found = (k.tilt + step * w2 * delay) / 9.81 * pole**2 * denominator
        parts = [np.polymul(p, slow).astype(np.float64) for p in parts] + [found, -found]
        delays, denominator = [*delays, delay + arm, delay], np.polymul(denominator, slow).astype(np.float64)
    return Loop(tuple(parts), tuple(delays), denominator)


def test_fall_rate_is_that_of_a_compound_pendulum():
    """ω₀² = m g l/(J + m l²), of the mean inertia."""
    swung = 0.5 * (0.006 + 0.007) + 0.48 * 0.06**2
    assert fall_rate(UAV) == pytest.approx(np.sqrt(0.48 * 9.81 * 0.06 / swung))


def test_b4_places_the_poles():
    gains, w2 = balance_gains(RATE), RATE**2
    k = np.array(gains)
    closed = np.array([[0, 1, 0, 0], k[[0, 1, 2, 3]], [0, 0, 0, 1], [0, 0, w2, 0] - w2 / 9.81 * k], dtype=float)
    # A double pole is found to the root of the machine's precision.
    np.testing.assert_allclose(np.sort(np.linalg.eigvals(closed)), np.sort(-RATE * np.array(POLES)), rtol=1e-5)
    assert min(gains) > 0.0


def test_margins_need_the_prediction():
    gains = balance_gains(RATE)
    assert margins(balance_loop(gains, RATE, LINK_S, ARM_S)).sensitivity < MAX_SENSITIVITY
    assert not np.isfinite(margins(balance_loop(gains, RATE, LINK_S, ARM_S, predicts=False)).sensitivity)


def test_margins_bear_the_observer():
    gains = balance_gains(RATE)
    alone = margins(balance_loop(gains, RATE, LINK_S, ARM_S)).sensitivity
    observed = margins(balance_loop(gains, RATE, LINK_S, ARM_S, pole=OBSERVED * RATE)).sensitivity
    assert alone < observed < MAX_SENSITIVITY
    # An arm that is as late as (B.6) takes it to be makes it invisible.
    exact = margins(balance_loop(gains, RATE, LINK_S, 0.0, pole=OBSERVED * RATE)).sensitivity
    assert exact == pytest.approx(margins(balance_loop(gains, RATE, LINK_S)).sensitivity, rel=1e-3)


def test_a_body_that_hangs_needs_no_balancing():
    with pytest.raises(ConfigurationError, match="below"):
        fall_rate(UAV._replace(lever=np.array([0.0, 0.0, 0.06])))


@pytest.mark.parametrize("delay", [0.0, 0.0175, 0.03])
def test_b5_loop_is_what_the_equations_make_of_a_push(delay):
    """L(s) put together term by term from (B.1), (B.3) and (B.5), at some complex frequencies."""
    k, w2, g = balance_gains(RATE), RATE**2, 9.81
    loop = balance_loop(k, RATE, delay)
    for s in (1.0 + 3.0j, 20.0j, -2.0 + 7.0j, 60.0j):
        x, tilt, late = 1.0 / s**2, -w2 / g / (s**2 - w2), np.exp(-s * delay)
        carried = (1.0 + s * delay) * tilt * late
        change = w2 * (delay * carried - (s * x - s * x * late) / g)
        push = k.position * x + k.speed * s * x + k.tilt * (carried + 0.5 * delay * change)
        push += k.tilt_rate * (s * tilt * late + change)
        numerator = sum(np.polyval(n, s) * np.exp(-s * t) for n, t in zip(loop.numerators, loop.delays, strict=True))
        assert numerator / np.polyval(loop.denominator, s) == pytest.approx(-push, rel=1e-9)
