"""The disturbance observer on a rigid body written with NumPy alone, free and under the exact law."""

import numpy as np
import pytest
from scipy.signal import lfilter

from armland.control.design.gains import Wanted, rule
from armland.control.design.margins import Delays
from armland.control.laws.exact import Reference, exact_law, exact_lyapunov
from armland.control.laws.lyapunov import error_gradient
from armland.control.laws.rigid_body import ExactGains, UavParameters
from armland.estimation.disturbance import kept_layout, observe_force, observe_moment, told, ultimate_bound
from armland.models.environment import DOWN
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


class Observer:
    """Force and moment observed at every step, as ground and board do it."""

    def __init__(self, start, bandwidth, uav=UAV, limit=1e3, by_axis=False):
        self.uav, self.K, self.p = uav, bandwidth, told(uav.mass, bandwidth, limit, DT, by_axis)
        self.s, self.moment = np.zeros(1, kept_layout()), np.zeros(3)
        self.momentum = uav.inertia @ start[4:7]
        self.see(start, 0.0, np.zeros(3))

    def see(self, x, thrust, force, learns=True, gravity=DOWN):
        R = np.ascontiguousarray(turned(x[:4]))
        observe_force(R, thrust, force, x[10:].copy(), gravity, learns, self.p[0], self.s[0])
        return self.s["force"][0].copy()

    def feel(self, before, after, torque, force):
        omega = 0.5 * (before[4:7] + after[4:7])
        acting = torque + np.cross(self.uav.lever, turned(before[:4]).T @ force)
        impulse = DT * (acting - np.cross(omega, self.uav.inertia @ omega))
        observe_moment(self.uav.inertia @ after[4:7], impulse, DT, self.K, self.momentum, self.moment)
        return self.moment.copy()


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


def estimates(record, observer, told=lambda torque, force: (torque, force)):
    """Estimates (k, 6) at each step of `tumbling`."""
    found = []
    for before, after, torque, force in record:
        torque, force = told(torque, force)
        # The observer has the attitude of now: what acted over the step acted at that of before.
        here = np.concatenate((before[:4], after[4:]))
        found.append(np.concatenate((observer.see(here, THRUST, force), observer.feel(before, after, torque, force))))
    return np.array(found)


def observed(record, K=20.0, told=lambda torque, force: (torque, force), **settings):
    return estimates(record, Observer(record[0][0], K, **settings), told)


def constant(t):
    return SIDE, TWIST


def test_x3_constant_disturbance_is_known_to_one_percent_in_the_stated_time():
    """A first-order low pass: ln(100)/K."""
    K = np.log(100.0) / 0.25
    record = tumbling(0.4, constant, wild=0.3, countered=True)
    found, at = observed(record, K), round(0.25 / DT)
    for part, true in ((slice(0, 3), SIDE), (slice(3, 6), TWIST)):
        gap = np.linalg.norm(found[:, part] - true, axis=1) / np.linalg.norm(true)
        assert gap[at:].max() < 0.0105
        # Negative control: half the time is not enough, and without the observer all of it remains.
        assert gap[at // 2] > 0.05
    assert np.abs(observed(record, 0.0)).max() == 0.0


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
    smooth = []
    # The force's gain makes the low pass exact for the step; on board K is the gain as it is.
    for part, share in ((slice(0, 3), -np.expm1(-20.0 * DT)), (slice(3, 6), 20.0 * DT)):
        smooth.append(lfilter([share], [1.0, share - 1.0], np.array(raw)[:, part], axis=0))
    smooth = np.hstack(smooth)
    found = observed(record)
    assert np.abs(found - smooth)[:, :3].max() < 0.01 * 2.0
    assert np.abs(found - smooth)[:, 3:].max() < 0.02 * 0.05
    # The comparison says something: the estimate is not the disturbance itself.
    truth = np.array([np.concatenate(disturbance(i * DT)) for i in range(len(record))])
    assert np.abs(found - truth)[300:, :3].max() > 0.2 * 2.0


@pytest.mark.parametrize("left_out", ["lever", "inertia", "mass", "force", "torque", "gravity"])
def test_x3_without_a_disturbance_nothing_is_seen_unless_the_model_is_wrong(left_out, monkeypatch):
    record = tumbling(0.3, lambda t: (np.zeros(3), np.zeros(3)))
    right = np.abs(observed(record))
    assert right[:, :3].max() < 0.01
    assert right[:, 3:].max() < 1e-3
    wrong = {"lever": {"lever": np.zeros(3)}, "inertia": {"inertia": 1.3 * INERTIA}, "mass": {"mass": 0.55}}
    told = {"force": lambda t, f: (t, 0.0 * f), "torque": lambda t, f: (0.0 * t, f)}
    if left_out == "gravity":
        monkeypatch.setattr(Observer.see, "__defaults__", (True, (0.0, 0.0, -9.0)))
    uav = UAV._replace(**wrong.get(left_out, {}))
    found = np.abs(observed(record, told=told.get(left_out, lambda t, f: (t, f)), uav=uav))
    assert found[:, :3].max() > 0.2 or found[:, 3:].max() > 0.01


def test_x4_told_what_was_given_the_observer_does_not_wind_up():
    """Half of the torque asked for is not given: told so, it sees nothing; told what was asked, it sees the other half."""
    record = tumbling(0.5, lambda t: (np.zeros(3), np.zeros(3)))
    truthful = observed(record)
    misled = observed(record, told=lambda torque, force: (2.0 * torque, force))
    assert np.abs(truthful[:, 3:]).max() < 1e-3
    assert np.abs(misled[:, 3:]).max() > 0.02


def test_x4_estimate_stops_at_its_limit_and_comes_back_at_once():
    def gust(t):
        return (20.0 * SIDE if t < 0.4 else SIDE), TWIST

    record = tumbling(0.8, gust)
    found = observed(record, limit=3.0)
    assert np.linalg.norm(found[:, :3], axis=1).max() == pytest.approx(3.0)
    # From 3 N it needs ln(1/0.1)/20 s to be within a tenth of the newton that is too much.
    np.testing.assert_allclose(found[round(0.52 / DT), :3], SIDE, atol=0.2)
    unlimited = observed(record, limit=100.0)
    assert np.linalg.norm(unlimited[round(0.52 / DT), :3] - SIDE) > 2.0


def test_x4_limit_by_axis_cuts_each_component_and_no_other():
    slanted = np.array([8.0, -2.0, 5.0])
    record = tumbling(1.0, lambda t: (slanted, TWIST), wild=0.1, countered=True)
    by_axis, by_length = (
        observed(record, 8.0, limit=4.0, by_axis=True)[-1, :3],
        observed(record, 8.0, limit=4.0)[-1, :3],
    )
    np.testing.assert_allclose(by_axis, [4.0, -2.0, 4.0], atol=0.02)
    np.testing.assert_allclose(by_length, 4.0 * slanted / np.linalg.norm(slanted), atol=0.02)


def test_x3_what_is_not_to_be_learnt_is_not_and_leaves_no_kick():
    """Held still by 5 N that nobody tells: not learnt while told not to; from then on the low pass starts from zero."""
    x = REST.copy()
    observer = Observer(x, 20.0, PLAIN)
    hold = np.array([0.0, 0.0, PLAIN.mass * 9.81 - THRUST - 5.0])
    for _ in range(100):
        assert np.abs(observer.see(x, THRUST, hold, learns=False)).max() == 0.0
    assert observer.see(x, THRUST, hold)[2] == pytest.approx(5.0 * -np.expm1(-20.0 * DT), rel=1e-9)


def test_x3_on_a_deck_that_accelerates_the_weight_is_not_taken_for_a_disturbance():
    """At rest on the deck, held by −mγ: with γ nothing is seen, with gravity on land the deck's acceleration is."""
    gamma = (0.5, -0.3, -10.4)
    hold = -PLAIN.mass * np.array(gamma) - [0.0, 0.0, THRUST]
    for gravity, seen in ((gamma, 0.0), (DOWN, PLAIN.mass * np.linalg.norm(np.subtract(gamma, DOWN)))):
        observer = Observer(REST, 20.0, PLAIN)
        for _ in range(1000):
            found = observer.see(REST, THRUST, hold, gravity=gravity)
        assert np.linalg.norm(found) == pytest.approx(seen, abs=1e-6)


def fly(duration, disturbance, K, on=True):
    """States and estimation errors under the exact law, with B̄⁻¹(d̂_τ, d̂_f) taken off its input."""
    x, path, wrong = REST, [], []
    observer, d_f, d_tau = Observer(REST, K, PLAIN), np.zeros(3), np.zeros(3)
    for i in range(round(duration / DT)):
        delta_tau, force = exact_law(x[:4], x[4:7], x[7:10], x[10:], STILL, THRUST, np.zeros(3), PLAIN, WANTED)
        if on:
            delta_tau = delta_tau - d_tau + np.cross(PLAIN.lever, turned(x[:4]).T @ d_f)
            force = force - d_f
        true, before = disturbance(i * DT), x
        x = advanced(x, delta_tau, force, *true, PLAIN)
        d_f, d_tau = observer.see(x, THRUST, force), observer.feel(before, x, delta_tau, force)
        path.append(x)
        wrong.append([*(true[0] - d_f), *(true[1] - d_tau)])
    return np.array(path), np.array(wrong)


def test_x3_side_force_and_torque_leave_no_trace_with_the_observer():
    ((held, _), (pushed, _)) = (fly(1.0, constant, 20.0, on=on) for on in (True, False))
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
        R = turned(x[:4])
        u = u[0] - (d_tau - e_tau) + np.cross(UAV.lever, R.T @ (d_f - e_f)), u[1] - (d_f - e_f)
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

    # |ḋ| ≤ d₁ leaves |d̃| ≤ d₁/K.
    errors = [np.linalg.norm(d) * pulse / bandwidth for d in (SIDE, TWIST)]
    limit = ultimate_bound(*errors, PLAIN, *WANTED)
    path, wrong = fly(2.0, disturbance, bandwidth)
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
    tenth = ultimate_bound(*(e / 10.0 for e in errors), PLAIN, *WANTED)
    assert measured[0][0] > tenth.omega
    assert measured[1][0] > tenth.velocity
