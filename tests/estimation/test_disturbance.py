"""The disturbance observer on a rigid body written with NumPy alone, free and under the exact law."""

import numpy as np
import pytest
from scipy.signal import lfilter

from armland.control.backstepping import ExactGains, Reference, UavParameters, exact_law, exact_lyapunov
from armland.control.exact import GRAVITY, error_gradient
from armland.control.gains import Wanted, rule
from armland.control.margins import Delays
from armland.estimation.disturbance import (
    ObserverParameters,
    bound,
    compensate,
    error_bound,
    initial_observer,
    observe,
    quietest_bandwidth,
    settling_bandwidth,
)
from armland.rotations import error

DT = 1e-3
INERTIA = np.array([[0.006, 0.0004, -0.0003], [0.0004, 0.007, 0.0002], [-0.0003, 0.0002, 0.012]])
UAV = UavParameters(0.48, INERTIA, np.array([0.004, -0.007, -0.06]))
PLAIN = UavParameters(0.48, np.diag([0.006, 0.007, 0.012]), np.array([0.0, 0.0, -0.06]))
STILL = Reference(np.array([1.0, 0.0, 0.0, 0.0]), *np.zeros((5, 3)))
WANTED = rule(Wanted(20.0, 0.9), Wanted(20.0, 0.9), PLAIN, Delays(0.0, 0.0, 0.0)).gains
REST = np.array([1.0, *np.zeros(12)])
SIDE, TWIST = np.array([0.0, 2.0, 0.0]), np.array([0.03, 0.04, 0.0])
THRUST = 2.35


def parameters(force_bandwidth, moment_bandwidth, uav=UAV, limits=(10.0, 1.0)):
    return ObserverParameters(*uav, GRAVITY, DT, force_bandwidth, moment_bandwidth, *limits)


def S(a):
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


def turned(q):
    eps = S(q[1:])
    return np.eye(3) + 2.0 * q[0] * eps + 2.0 * eps @ eps


def rates(x, torque, force, d_f, d_tau, uav):
    """ẋ of x = (q, ω, pivot r, v of CM) by Newton and Euler."""
    R, omega = turned(x[:4]), S(x[4:7])
    q_dot = 0.5 * np.append(-x[1:4] @ x[4:7], x[0] * x[4:7] + S(x[1:4]) @ x[4:7])
    moment = torque + S(uav.lever) @ R.T @ force - omega @ uav.inertia @ x[4:7] + d_tau
    v_dot = (THRUST * R[:, 2] + force + d_f) / uav.mass - [0.0, 0.0, 9.81]
    return np.concatenate((q_dot, np.linalg.solve(uav.inertia, moment), x[10:] + R @ omega @ uav.lever, v_dot))


def advanced(x, *inputs):
    x = x + DT * rates(x + 0.5 * DT * rates(x, *inputs), *inputs)
    x[:4] /= np.linalg.norm(x[:4])
    return x


def tumbling(duration, disturbance, seed=0, wild=1.0, countered=False):
    """States and inputs of a body that tumbles under random, slowly varying, known inputs, and `disturbance(t)`.

    Countered, the inputs also hold the disturbance off, and the body keeps the pace that `wild` gives it.
    """
    rng = np.random.default_rng(seed)
    x, record = np.array([1.0, 0.0, 0.0, 0.0, *(wild * np.array([2.0, -3.0, 1.5])), *np.zeros(6)]), []
    torque, force = np.zeros(3), np.zeros(3)
    for i in range(round(duration / DT)):
        torque = torque + 0.01 * wild * rng.normal(size=3) - 0.02 * torque
        force = force + 0.2 * rng.normal(size=3) - 0.05 * (force - [0.0, 0.0, 2.0])
        d_f, d_tau = disturbance(i * DT)
        inputs = [torque, force]
        if countered:
            lift = np.array([0.0, 0.0, UAV.mass * 9.81]) - THRUST * turned(x[:4])[:, 2] - d_f
            inputs = [torque - d_tau - np.cross(UAV.lever, turned(x[:4]).T @ lift), lift]
        after = advanced(x, *inputs, d_f, d_tau, UAV)
        record.append((x, after, *inputs))
        x = after
    return record


def estimates(record, p, told=lambda torque, force: (torque, force), every=1, delay=0):
    """Estimates at each step; samples of the UAV come every so many steps, so many steps late, as all that goes with them."""
    memory, found, taken = initial_observer(record[0][0][4:7], record[0][0][10:], p), [], 0
    for i in range(len(record)):
        seen = max(i - delay, 0)
        before, now, torque, force = record[seen]
        elapsed = 0.0
        if i >= delay and (seen + 1) % every == 0:
            elapsed, taken, sampled = (seen + 1 - taken) * DT, seen + 1, now
        elif taken == 0:
            sampled = before if delay else record[0][0]
        torque, force = told(torque, force)
        d_f, d_tau, memory = observe(sampled[:4], sampled[4:7], now[10:], THRUST, torque, force, elapsed, p, memory)
        found.append(np.concatenate((d_f, d_tau)))
    return np.array(found)


def constant(t):
    return SIDE, TWIST


def test_x3_constant_disturbance_is_known_to_one_percent_in_the_stated_time():
    K = settling_bandwidth(0.25)
    assert pytest.approx(4.605 / 0.25, rel=1e-3) == K
    record = tumbling(0.4, constant, wild=0.3, countered=True)
    found = estimates(record, parameters(K, K))
    at = round(0.25 / DT)
    for part, true in ((slice(0, 3), SIDE), (slice(3, 6), TWIST)):
        gap = np.linalg.norm(found[:, part] - true, axis=1) / np.linalg.norm(true)
        assert gap[at:].max() < 0.0105
        # Negative control: half the time is not enough, and without the observer all of it remains.
        assert gap[at // 2] > 0.05
    off = estimates(record, parameters(1e-9, 1e-9))
    assert np.abs(off).max() < 1e-8


def test_x3_estimate_is_the_low_pass_of_what_newton_and_euler_miss():
    """Second derivation: accelerations by differences of the simulated states, then SciPy's filter."""

    def disturbance(t):
        return SIDE * np.sin(7.0 * t), TWIST * np.cos(11.0 * t)

    record = tumbling(0.6, disturbance, seed=1)
    raw = []
    for x, after, torque, force in record:
        R, omega = turned(x[:4]), 0.5 * (x[4:7] + after[4:7])
        d_f = UAV.mass * ((after[10:] - x[10:]) / DT + [0.0, 0.0, 9.81]) - THRUST * R[:, 2] - force
        turning = UAV.inertia @ (after[4:7] - x[4:7]) / DT + np.cross(omega, UAV.inertia @ omega)
        raw.append([*d_f, *(turning - torque - np.cross(UAV.lever, R.T @ force))])
    share = -np.expm1(-20.0 * DT)
    smooth = lfilter([share], [1.0, share - 1.0], np.array(raw), axis=0)
    found = estimates(record, parameters(20.0, 20.0))
    assert np.abs(found - smooth)[:, :3].max() < 0.01 * 2.0
    assert np.abs(found - smooth)[:, 3:].max() < 0.02 * 0.05
    # The comparison says something: the estimate is not the disturbance itself.
    truth = np.array([np.concatenate(disturbance(i * DT)) for i in range(len(record))])
    assert np.abs(found - truth)[300:, :3].max() > 0.2 * 2.0


@pytest.mark.parametrize("left_out", ["lever", "inertia", "mass", "force", "torque"])
def test_x3_without_a_disturbance_nothing_is_seen_unless_the_model_is_wrong(left_out):
    record = tumbling(0.3, lambda t: (np.zeros(3), np.zeros(3)))
    right = np.abs(estimates(record, parameters(20.0, 20.0)))
    assert right[:, :3].max() < 0.01
    assert right[:, 3:].max() < 1e-3
    p, told = parameters(20.0, 20.0), lambda torque, force: (torque, force)
    if left_out == "lever":
        p = p._replace(lever=np.zeros(3))
    elif left_out == "inertia":
        p = p._replace(inertia=1.3 * INERTIA)
    elif left_out == "mass":
        p = p._replace(mass=0.55)
    elif left_out == "force":
        told = lambda torque, force: (torque, 0.0 * force)  # noqa: E731
    else:
        told = lambda torque, force: (0.0 * torque, force)  # noqa: E731
    wrong = np.abs(estimates(record, p, told))
    assert wrong[:, :3].max() > 0.2 or wrong[:, 3:].max() > 0.01


@pytest.mark.parametrize(("every", "delay"), [(5, 0), (5, 30), (40, 60)])
def test_x3_late_and_rare_samples_of_the_uav_give_the_same_in_the_end(every, delay):
    record = tumbling(0.9, constant, wild=0.1, countered=True)
    found = estimates(record, parameters(20.0, 15.0), every=every, delay=delay)
    assert np.linalg.norm(found[-1, 3:] - TWIST) < 0.02 * 0.05
    # Before the first sample has come, nothing is learnt from it.
    assert (found[: delay + every - 1, 3:] == 0.0).all()


def test_x3_samples_that_bunch_are_weighed_by_the_time_between_them():
    """Constant spin-up: samples taken every 10 ms arrive in pairs, after 1 and 19 ms; the known torque explains all."""
    p, torque = parameters(20.0, 50.0, PLAIN), np.array([0.0, 0.0, 0.06])
    memory = initial_observer(np.zeros(3), np.zeros(3), p)
    hold, worst = np.array([0.0, 0.0, 0.48 * 9.81 - THRUST]), 0.0
    rate = 0.0
    for i in range(400):
        elapsed = 0.01 if i % 20 in (0, 1) else 0.0
        rate += 5.0 * elapsed
        args = STILL.q_d, np.array([0.0, 0.0, rate]), np.zeros(3), THRUST, torque, hold, elapsed
        _, d_tau, memory = observe(*args, p, memory)
        worst = max(worst, abs(d_tau[2]))
    assert worst < 1e-9


def test_x3_no_gap_is_too_long_for_the_estimate():
    """With K · gap = 10 a plain Euler step would overshoot ninefold; the mean over the gap is what is learnt."""
    p, torque = parameters(20.0, 20.0, PLAIN), np.zeros(3)
    memory, hold = initial_observer(np.zeros(3), np.zeros(3), p), np.array([0.0, 0.0, 0.48 * 9.81 - THRUST])
    for i in range(1, 2001):
        elapsed = 0.5 if i % 500 == 0 else 0.0
        spin = np.array([0.0, 0.0, 0.05 / 0.012 * DT * i])
        _, d_tau, memory = observe(STILL.q_d, spin, np.zeros(3), THRUST, torque, hold, elapsed, p, memory)
        assert -1e-12 < d_tau[2] < 0.0500001
    assert d_tau[2] == pytest.approx(0.05, rel=1e-4)


def test_x4_told_what_was_given_the_observer_does_not_wind_up():
    """Half of the torque asked for is not given: told so, it sees nothing; told what was asked, it sees the other half."""
    record = tumbling(0.5, lambda t: (np.zeros(3), np.zeros(3)))
    truthful = estimates(record, parameters(20.0, 20.0))
    misled = estimates(record, parameters(20.0, 20.0), lambda torque, force: (2.0 * torque, force))
    assert np.abs(truthful[:, 3:]).max() < 1e-3
    assert np.abs(misled[:, 3:]).max() > 0.02


def test_x4_estimate_stops_at_its_limit_and_comes_back_at_once():
    def gust(t):
        return (20.0 * SIDE if t < 0.4 else SIDE), TWIST

    found = estimates(tumbling(0.8, gust), parameters(20.0, 20.0, limits=(3.0, 0.03)))
    assert np.linalg.norm(found[:, :3], axis=1).max() == pytest.approx(3.0)
    assert np.linalg.norm(found[:, 3:], axis=1).max() == pytest.approx(0.03)
    # From 3 N it needs ln(1/0.1)/20 s to be within a tenth of the newton that is too much.
    np.testing.assert_allclose(found[round(0.52 / DT), :3], SIDE, atol=0.2)
    unlimited = estimates(tumbling(0.8, gust), parameters(20.0, 20.0, limits=(100.0, 1.0)))
    assert np.linalg.norm(unlimited[round(0.52 / DT), :3] - SIDE) > 2.0


def fly(duration, disturbance, p, gains=WANTED, uav=PLAIN, on=True, start=REST):
    """States and estimation errors under the exact law, with the observer's estimates compensated."""
    x, path, wrong = start, [], []
    memory = initial_observer(x[4:7], x[10:], p)
    d_f, d_tau = np.zeros(3), np.zeros(3)
    for i in range(round(duration / DT)):
        u = exact_law(x[:4], x[4:7], x[7:10], x[10:], STILL, THRUST, np.zeros(3), uav, gains)
        if on:
            u = compensate(*u, x[:4], uav.lever, d_f, d_tau)
        true = disturbance(i * DT)
        x = advanced(x, *u, *true, uav)
        d_f, d_tau, memory = observe(x[:4], x[4:7], x[10:], THRUST, *u, DT, p, memory)
        path.append(x)
        wrong.append([*(true[0] - d_f), *(true[1] - d_tau)])
    return np.array(path), np.array(wrong)


def test_x3_side_force_and_torque_leave_no_trace_with_the_observer():
    p = parameters(20.0, 20.0, PLAIN)
    ((held, _), (pushed, _)) = (fly(1.0, constant, p, on=on) for on in (True, False))
    for path, low, high in ((held, 0.0, 1e-5), (pushed, 1e-3, 1.0)):
        assert low <= np.linalg.norm(path[-1, 7:10]) < high
    tilt = [2.0 * np.degrees(np.linalg.norm(path[-1, 1:4])) for path in (held, pushed)]
    assert tilt[0] < 0.01
    assert tilt[1] > 0.5


def test_x3_lyapunov_rate_gains_the_work_of_the_estimation_error():
    """V̇₂ = (30) + z₂ᵀd̃ by differences along the true motion."""
    rng = np.random.default_rng(2)
    gains = ExactGains(
        np.array([1.3, 0.7, 2.1, 20.0, 35.0, 28.0]), np.array([0.4, 0.9, 0.6, 12.0, 31.0, 18.0]), 3.0, 40.0
    )
    for _ in range(50):
        q, (omega, r, v, d_f, d_tau, e_f, e_tau) = rng.normal(size=4), rng.normal(size=(7, 3))
        x = np.concatenate((q / np.linalg.norm(q), omega, 0.1 * r, v))
        u = exact_law(x[:4], x[4:7], x[7:10], x[10:], STILL, THRUST, np.zeros(3), UAV, gains)
        u = compensate(*u, x[:4], UAV.lever, d_f - e_f, d_tau - e_tau)
        dx, h = rates(x, *u, d_f, d_tau, UAV), 1e-6

        def v2(x):
            return exact_lyapunov(x[:4], x[4:7], x[7:10], x[10:], STILL, UAV, gains)

        gradient = error_gradient(error(STILL.q_d, x[:4]), -x[7:10])
        alpha = -gains.k1 * gradient
        z2 = np.concatenate((omega - alpha[:3], v - alpha[3:] - turned(x[:4]) @ np.cross(UAV.lever, alpha[:3])))
        rate = (v2(x + h * dx)[0] - v2(x - h * dx)[0]) / (2.0 * h)
        expected = v2(x)[1] + z2 @ np.concatenate((e_tau, e_f))
        assert rate == pytest.approx(expected, rel=1e-6, abs=1e-5 * v2(x)[0])


@pytest.mark.parametrize(("pulse", "bandwidth"), [(6.0, 20.0), (15.0, 12.0)])
def test_x3_ultimate_bound_holds_and_says_something(pulse, bandwidth):
    def disturbance(t):
        return SIDE * np.sin(pulse * t), TWIST * np.cos(pulse * t)

    p = parameters(bandwidth, bandwidth, PLAIN)
    errors = [error_bound(np.linalg.norm(d) * pulse, 0.0, bandwidth) for d in (SIDE, TWIST)]
    limit = bound(*errors, *PLAIN, *WANTED)
    path, wrong = fly(2.0, disturbance, p)
    path, wrong = path[1000:], wrong[1000:]
    for found, most in ((wrong[:, :3], errors[0]), (wrong[:, 3:], errors[1])):
        assert 0.3 * most < np.linalg.norm(found, axis=1).max() < 1.05 * most
    alpha = np.array([-WANTED.k1 * error_gradient(x[:4], -x[7:10]) for x in path])
    z_omega = path[:, 4:7] - alpha[:, :3]
    z_v = [x[10:] - a[3:] - turned(x[:4]) @ np.cross(PLAIN.lever, a[:3]) for x, a in zip(path, alpha, strict=True)]
    angle = 2.0 * np.arcsin(np.linalg.norm(path[:, 1:4], axis=1))
    measured = (
        (np.linalg.norm(z_omega, axis=1).max(), limit.omega),
        (np.linalg.norm(z_v, axis=1).max(), limit.velocity),
        (angle.max(), limit.attitude),
        (np.linalg.norm(path[:, 7:10], axis=1).max(), limit.position),
    )
    # The attitude is charged with all of its coupling to the position, most of which does it no harm.
    for (found, most), loose in zip(measured, (10.0, 10.0, 20.0, 10.0), strict=True):
        assert found < most < loose * found
    # Negative control: a disturbance ten times as quick is not covered.
    tenth = bound(*(e / 10.0 for e in errors), *PLAIN, *WANTED)
    assert measured[0][0] > tenth.omega
    assert measured[1][0] > tenth.velocity


def test_x3_ultimate_bound_scales_with_the_errors_and_ends_at_half_a_turn():
    one, two = bound(0.1, 0.001, *PLAIN, *WANTED), bound(0.2, 0.002, *PLAIN, *WANTED)
    np.testing.assert_allclose(two, np.multiply(one, 2.0), rtol=0.02)
    assert bound(0.0, 0.0, *PLAIN, *WANTED) == (0.0, 0.0, 0.0, 0.0)
    assert bound(10.0, 50.0, *PLAIN, *WANTED).attitude == pytest.approx(np.pi)


def test_x3_error_bound_meets_the_worst_noise_and_its_rule_the_least_bound():
    """Momentum wrong by ±n, switched once: the filter's impulse response −K(δ − Ke^(−Kt)) collects 2Kn."""
    K, n = 20.0, 1e-3
    p = parameters(K, K, PLAIN)
    hold = np.array([0.0, 0.0, 0.48 * 9.81 - THRUST])
    memory, worst = initial_observer(np.zeros(3), np.array([-n / 0.48, 0.0, 0.0]), p), 0.0
    for i in range(1000):
        v = np.array([(-n if i < 500 else n) / 0.48, 0.0, 0.0])
        d_f, _, memory = observe(STILL.q_d, np.zeros(3), v, THRUST, np.zeros(3), hold, DT, p, memory)
        worst = max(worst, np.linalg.norm(d_f))
    most = error_bound(0.0, n, K)
    assert 0.95 * most < worst < 1.001 * most
    best = quietest_bandwidth(3.0, n)
    assert all(error_bound(3.0, n, best) < error_bound(3.0, n, f * best) for f in (0.8, 1.25))
