"""Margins against hand-worked loops, and against the nonlinear law and body: linearised by differences, delay by Padé."""

from math import factorial

import numpy as np
import pytest
from scipy.signal import tf2ss
from scipy.spatial.transform import Rotation

from armland.control.design.margins import (
    Delays,
    Loop,
    attitude_loops,
    margins,
    onboard_loops,
    pendulum,
    position_loop,
    stable,
)
from armland.control.laws.exact import Reference, exact_law
from armland.control.laws.rigid_body import BacksteppingGains, ExactGains, UavParameters

G = 9.81
UAV = UavParameters(0.48, np.diag([0.006, 0.007, 0.012]), np.array([0.0, 0.0, -0.06]))
PUBLISHED = BacksteppingGains(
    np.array([1.0, 1.0, 1.0, 30.0, 30.0, 30.0]), np.array([1.0, 1.0, 1.0, 30.0, 30.0, 30.0]), 35.0
)
SOFT = ExactGains(
    np.array([32.0, 30.0, 23.0, 32.0, 28.0, 30.0]), np.array([0.07, 0.08, 0.1, 23.0, 25.0, 24.0]), 0.1, 40.0
)
STILL = Reference(np.array([1.0, 0.0, 0.0, 0.0]), *np.zeros((5, 3)))
THRUST = 2.35


def test_integrator_with_delay_by_hand():
    """L = k e^(−sT)/s: |L| = 1 at k with the phase −π/2 − kT; phase −π at π/(2T)."""
    k, T = 4.0, 0.1
    m = margins(Loop((np.array([k]),), (T,), np.array([1.0, 0.0])))
    assert m.phase == pytest.approx(np.pi / 2 - k * T, rel=1e-4)
    assert m.delay == pytest.approx(np.pi / (2 * k) - T, rel=1e-4)
    assert m.gain_up == pytest.approx(np.pi / (2 * k * T), rel=1e-4)
    assert m.gain_down == 0.0
    late = margins(Loop((np.array([k]),), (0.5,), np.array([1.0, 0.0])))
    assert late.delay == pytest.approx(np.pi / (2 * k) - 0.5, rel=1e-4)
    assert late.sensitivity == np.inf
    assert np.isnan([late.phase, late.gain_up, late.gain_down]).all()


def test_three_lags_by_hand():
    """L = k/(s + 1)³: phase −π at √3, where |L| = k/8; |L| = 1 at √(k^⅔ − 1)."""
    m = margins(Loop((np.array([4.0]),), (0.0,), np.poly([-1.0, -1.0, -1.0])))
    at = np.sqrt(4.0 ** (2 / 3) - 1.0)
    assert m.gain_up == pytest.approx(2.0, rel=1e-4)
    assert m.phase == pytest.approx(np.pi - 3.0 * np.arctan(at), rel=1e-4)
    assert m.delay == pytest.approx(m.phase / at, rel=1e-4)
    assert not stable(Loop((np.array([8.1]),), (0.0,), np.poly([-1.0, -1.0, -1.0])))


def test_pendulum_may_lose_gain_down_to_its_falling_torque():
    kp, kd = np.array([0.5, 0.5, 0.5]), np.array([0.08, 0.08, 0.08])
    roll, pitch, yaw = (margins(loop) for loop in onboard_loops(kp, kd, UAV, Delays(0.0025, 0.0, 0.05)))
    fall = 0.48 * G * 0.06
    assert pendulum(0, UAV) == pytest.approx((0.006 + 0.48 * 0.06**2, fall))
    assert roll.gain_down == pytest.approx(fall / 0.5)
    assert pitch.gain_down == pytest.approx(fall / 0.5)
    assert yaw.gain_down == 0.0


def test_no_delay_is_short_enough_for_a_pendulum_that_falls():
    kp, kd = np.full(3, 0.25), np.full(3, 0.08)
    assert margins(onboard_loops(kp, kd, UAV, Delays(0.0025, 0.0, 0.05))[0]).delay == -np.inf


def test_stability_is_that_of_the_poles():
    rng = np.random.default_rng(4)
    verdicts = []
    for _ in range(300):
        roots = np.append(rng.normal(size=2), rng.normal(-1.0, 2.0) + 1j * rng.uniform(0.1, 5.0) * np.array([1, -1]))
        closed = np.poly(roots * 3.0).real
        opened = np.poly(rng.normal(size=4))
        loop = Loop(((closed - opened)[1:],), (0.0,), opened)
        verdicts.append(stable(loop))
        assert verdicts[-1] == (np.roots(closed).real.max() < 0.0)
    assert {True, False} == set(verdicts)


def pade(T, order=8):
    """State space of e^(−sT), Padé's approximation."""
    c = [
        factorial(2 * order - k)
        * factorial(order)
        / (factorial(2 * order) * factorial(k) * factorial(order - k))
        * T**k
        for k in range(order, -1, -1)
    ]
    signs = (-1.0) ** np.arange(order, -1, -1)
    return tf2ss(signs * c, c)


def body_rates(x, torque, uav):
    """ẋ of x = (rotation vector, ω, pivot r, v of CM) by Newton and Euler, and the law's torque; its force acts at once."""
    R = Rotation.from_rotvec(x[:3])
    delta_tau, force = exact_law(
        R.as_quat(scalar_first=True), x[3:6], x[6:9], x[9:], STILL, THRUST, np.zeros(3), uav[0], uav[1]
    )
    hinge = np.cross(uav[0].lever, R.inv().apply(force))
    omega_dot = np.linalg.solve(uav[0].inertia, torque + hinge - np.cross(x[3:6], uav[0].inertia @ x[3:6]))
    v_dot = (THRUST * R.apply([0.0, 0.0, 1.0]) + force) / uav[0].mass - [0.0, 0.0, G]
    # At small angles the rotation vector's rate is ω.
    return np.concatenate((x[3:6], omega_dot, x[9:] + R.apply(np.cross(x[3:6], uav[0].lever)), v_dot)), delta_tau


def closed_loop_pole(gains, uav, delay, lag, factor=1.0):
    """Largest real part of the poles of the linearised body under `factor` · e^(−s delay)/(lag s + 1) · its torque."""
    h = 1e-6
    jacobian = np.empty((15, 12))
    for i in range(12):
        dx = h * np.eye(12)[i]
        a, b = (np.concatenate(body_rates(s * dx, np.zeros(3), (uav, gains))) for s in (1.0, -1.0))
        jacobian[:, i] = (a - b) / (2 * h)
    A, C = jacobian[:12], jacobian[12:]
    B = np.zeros((12, 3))
    B[3:6] = np.linalg.inv(uav.inertia)
    for channel in range(3):
        Ad, Bd, Cd, Dd = pade(delay) if delay else (np.zeros((0, 0)), np.zeros((0, 1)), np.zeros((1, 0)), np.eye(1))
        if lag:
            n = len(Ad)
            Ad = np.block([[Ad, np.zeros((n, 1))], [Cd / lag, np.array([[-1.0 / lag]])]])
            Bd, Cd, Dd = np.vstack((Bd, Dd / lag)), np.append(np.zeros(n), 1.0)[None], np.zeros((1, 1))
        b, c = B[:, channel : channel + 1], factor * C[channel : channel + 1]
        A = np.block([[A + b @ Dd @ c, b @ Cd], [Bd @ c, Ad]])
        B, C = np.pad(B, ((0, len(Ad)), (0, 0))), np.pad(C, ((0, 0), (0, len(Ad))))
    return np.linalg.eigvals(A).real.max()


@pytest.mark.parametrize("lag", [0.0, 0.05])
@pytest.mark.parametrize("gains", [PUBLISHED, SOFT], ids=["published", "soft"])
def test_delay_margin_is_where_the_linearised_law_loses_stability(gains, lag):
    longest = min(margins(loop).delay for loop in attitude_loops(gains, UAV, Delays(0.0, 0.0, lag)))
    assert closed_loop_pole(gains, UAV, 0.99 * longest, lag) < 0.0 < closed_loop_pole(gains, UAV, 1.01 * longest, lag)


def test_excess_delay_leads_to_the_same_limit():
    longest = min(margins(loop).delay for loop in attitude_loops(PUBLISHED, UAV, Delays(0.0, 0.0, 0.05)))
    late = min(margins(loop).delay for loop in attitude_loops(PUBLISHED, UAV, Delays(0.03, 0.0, 0.05)))
    assert 0.03 + late == pytest.approx(longest, rel=1e-3)


def test_gain_margins_are_where_the_linearised_law_loses_stability():
    loops = [margins(loop) for loop in attitude_loops(SOFT, UAV, Delays(0.02, 0.0, 0.01))]
    up, down = min(m.gain_up for m in loops), max(m.gain_down for m in loops)
    assert closed_loop_pole(SOFT, UAV, 0.02, 0.01, 0.99 * up) < 0.0 < closed_loop_pole(SOFT, UAV, 0.02, 0.01, 1.01 * up)
    assert closed_loop_pole(SOFT, UAV, 0.02, 0.01, 1.01 * down) < 0.0
    assert closed_loop_pole(SOFT, UAV, 0.02, 0.01, 0.99 * down) > 0.0


def test_without_the_pendulum_the_loop_would_be_judged_wrongly():
    """Negative control: with the lever left out, the limits found are not those of the body on its hinge."""
    free = UAV._replace(lever=np.zeros(3))
    wrong = [margins(loop) for loop in attitude_loops(SOFT, free, Delays(0.0, 0.0, 0.0))]
    assert closed_loop_pole(SOFT, UAV, 0.99 * min(m.delay for m in wrong), 0.0) > 0.0
    assert max(m.gain_down for m in wrong) == 0.0
    assert closed_loop_pole(SOFT, UAV, 0.0, 0.0, 0.1) > 0.0


def test_products_of_inertia_and_a_slanted_lever_move_the_limit_by_little():
    uav = UAV._replace(
        inertia=UAV.inertia + np.array([[0.0, 0.0004, -0.0003], [0.0004, 0.0, 0.0002], [-0.0003, 0.0002, 0.0]]),
        lever=np.array([0.004, -0.007, -0.06]),
    )
    for gains in (PUBLISHED, SOFT):
        longest = min(margins(loop).delay for loop in attitude_loops(gains, uav, Delays(0.0, 0.0, 0.05)))
        assert (
            closed_loop_pole(gains, uav, 0.9 * longest, 0.05) < 0.0 < closed_loop_pole(gains, uav, 1.1 * longest, 0.05)
        )


def swing(kp, kd, delay, feed_forward, lag=0.05, duration=4.0, dt=5e-4):
    """Growth of the tilt of a pendulum on a fixed pivot (Lagrange), under a PD and a feed-forward through delay lines."""
    m, J, height = 0.48, 0.006, 0.06
    phi, rate, rotor = 0.05, 0.0, 0.0
    lines = np.zeros((2, round(duration / dt) + 1))
    tilt = np.empty(lines.shape[1])
    lines[1, 0] = -height * m * G * np.sin(phi)
    for i in range(lines.shape[1]):
        turning = (rotor + m * G * height * np.sin(phi)) / (J + m * height**2)
        # Moment of the hinge's force about the CM: what turns the body beyond the rotors.
        lines[:, i] = -kp * phi - kd * rate, rotor - J * turning
        sent = i - round(delay / dt)
        asked = lines[0, sent] if sent >= 0 else 0.0
        if feed_forward is not None and i >= round(feed_forward / dt):
            asked += lines[1, i - round(feed_forward / dt)]
        rotor += dt / lag * (asked - rotor)
        rate += dt * turning
        phi += dt * rate
        tilt[i] = phi
        if abs(phi) > 1.0:
            return np.inf
    third = len(tilt) // 3
    return np.abs(tilt[2 * third :]).max() / np.abs(tilt[third : 2 * third]).max()


@pytest.mark.parametrize(("kp", "kd", "feed_forward"), [(0.5, 0.08, None), (0.5, 0.08, 0.03), (1.0, 0.12, None)])
def test_x6_onboard_margin_is_that_of_a_pendulum_with_delay_lines(kp, kd, feed_forward):
    (loop, *_) = onboard_loops(np.full(3, kp), np.full(3, kd), UAV, Delays(0.0025, 0.0, 0.05), feed_forward)
    more = margins(loop).delay
    assert more > 0.0
    shifted = (None if feed_forward is None else feed_forward + f * more for f in (0.85, 1.15))
    short, long = (swing(kp, kd, 0.0025 + f * more, s) for f, s in zip((0.85, 1.15), shifted, strict=True))
    assert short < 1.0 < long


def test_x6_feed_forward_of_the_attitude_received_costs_most_of_the_margin():
    kp, kd, board = np.full(3, 0.5), np.full(3, 0.08), Delays(0.0025, 0.0, 0.05)
    apart, together = (margins(onboard_loops(kp, kd, UAV, board, late)[0]) for late in (None, 0.0325))
    assert apart.sensitivity < 2.5 < 5.0 < together.sensitivity
    assert together.delay < 0.3 * apart.delay


def test_eq33_position_bears_the_delay_of_a_spring_and_damper_by_hand():
    """Published: (44.4 s + 935)/(0.48 s²): |L| = 1 where 0.48² w⁴ = 44.4² w² + 935²."""
    w = np.sqrt((44.4**2 + np.sqrt(44.4**4 + 4.0 * 0.48**2 * 935.0**2)) / (2.0 * 0.48**2))
    phase = np.arctan(44.4 * w / 935.0)
    m = margins(position_loop(PUBLISHED, UAV, Delays(0.0, 0.0015, 0.0)))
    assert m.delay == pytest.approx(phase / w - 0.0015, rel=1e-4)
    assert m.phase == pytest.approx(phase - 0.0015 * w, rel=1e-4)


def test_eq33_position_loop_is_that_of_x_whatever_the_other_axes_have():
    k1, k2 = PUBLISHED.k1.copy(), PUBLISHED.k2.copy()
    k1[4:], k2[4:] = [50.0, 70.0], [60.0, 80.0]
    found = position_loop(PUBLISHED._replace(k1=k1, k2=k2), UAV, Delays(0.0, 0.0015, 0.0))
    np.testing.assert_allclose(found.numerators[0], [44.4, 935.0])
    np.testing.assert_allclose(found.denominator, [0.48, 0.0, 0.0])
