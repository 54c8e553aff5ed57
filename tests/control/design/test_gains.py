"""Gains by rule: what the nonlinear law does with them, by finite differences and by simulation with delay lines."""

import re

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armland.control.design.gains import (
    LEAST_SHARE,
    MAX_SENSITIVITY,
    Wanted,
    exact_gains,
    onboard_rule,
    rule,
)
from armland.control.design.margins import Delays, attitude_loops, margins
from armland.control.laws.backstepping import paper_law
from armland.control.laws.exact import Reference, exact_law, exact_lyapunov
from armland.control.laws.rigid_body import BacksteppingGains, UavParameters
from armland.errors import ConfigurationError, ModelError

G = 9.81
UAV = UavParameters(0.48, np.diag([0.006, 0.007, 0.012]), np.array([0.0, 0.0, -0.06]))
LEVEL = np.array([1.0, 0.0, 0.0, 0.0])
STILL = Reference(LEVEL, *np.zeros((5, 3)))
PUBLISHED = BacksteppingGains(
    np.array([1.0, 1.0, 1.0, 30.0, 30.0, 30.0]), np.array([1.0, 1.0, 1.0, 30.0, 30.0, 30.0]), 35.0
)
ARM = Wanted(40.0, 1.0)
SOFT = Wanted(10.0, 1.0)
BOARD = Delays(0.0025, 0.0015, 0.05)
NO_DELAY = Delays(0.0, 0.0, 0.0)


def S(a):
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


def turned(x):
    """Rotation matrix of q, by Rodrigues."""
    eps = S(x[1:4])
    return np.eye(3) + 2.0 * x[0] * eps + 2.0 * eps @ eps


def rates(x, torque, force, thrust=2.35, uav=UAV):
    """ẋ of x = (q, ω, pivot r, v of CM) by Newton and Euler."""
    R, omega = turned(x), S(x[4:7])
    q_dot = 0.5 * np.append(-x[1:4] @ x[4:7], x[0] * x[4:7] + S(x[1:4]) @ x[4:7])
    moment = torque + S(uav.lever) @ R.T @ force - omega @ uav.inertia @ x[4:7]
    v_dot = (thrust * R[:, 2] + force) / uav.mass - [0.0, 0.0, G]
    return np.concatenate((q_dot, np.linalg.solve(uav.inertia, moment), x[10:] + R @ omega @ uav.lever, v_dot))


def fly(law, start, duration, delay=0.0, lag=0.0, dt=5e-4):
    """States over time; law(x, x as it was `delay` ago) → torque of the rotors, which have a lag, and force at once."""
    x, rotor = np.array(start), np.zeros(3)
    path = []
    for i in range(round(duration / dt)):
        late = i - round(delay / dt)
        asked, force = law(x, path[late - 1] if late > 0 else np.array(start))
        rotor = rotor + (dt / lag if lag else 1.0) * (asked - rotor)
        half = x + 0.5 * dt * rates(x, rotor, force)
        x = x + dt * rates(half, rotor, force)
        x[:4] /= np.linalg.norm(x[:4])
        path.append(x)
        if np.abs(x[4:7]).max() > 100.0:
            break
    return np.array(path)


def tilted(angle, offset=0.0):
    half = 0.5 * angle
    return np.array([np.cos(half), np.sin(half), 0.0, 0.0, *np.zeros(3), 0.0, offset, 0.0, *np.zeros(3)])


def all_over_the_link(gains):
    def law(x, late):
        delta_tau, _ = exact_law(late[:4], late[4:7], late[7:10], late[10:], STILL, 2.35, np.zeros(3), UAV, gains)
        return delta_tau, exact_law(x[:4], x[4:7], x[7:10], x[10:], STILL, 2.35, np.zeros(3), UAV, gains)[1]

    return law


def as_published(x, late):
    """(29) itself, which takes the pivot's velocity for the CM's."""
    u = []
    for y in (late, x):
        v = y[10:] + turned(y) @ np.cross(y[4:7], UAV.lever)
        u.append(paper_law(y[:4], y[4:7], y[7:10], v, LEVEL, np.zeros(3), 2.35, np.zeros(3), UAV, PUBLISHED))
    return u[0][0], u[1][1]


def second_order(t, w, zeta):
    """Decay from 1, at rest, of ẍ + 2ζw ẋ + w² x = 0, integrated by its matrix exponential's eigenvectors."""
    roots = np.roots([1.0, 2.0 * zeta * w, w * w]).astype(complex) + np.array([0.0, 1e-6])
    share = np.array([roots[1], -roots[0]]) / (roots[1] - roots[0])
    return (share[:, None] * np.exp(roots[:, None] * t)).sum(0).real


@pytest.mark.parametrize(("w", "zeta"), [(40.0, 1.0), (25.0, 1.3)])
def test_x1_position_step_is_that_of_the_wanted_poles(w, zeta):
    gains = rule(Wanted(w, zeta), SOFT, UAV, NO_DELAY).gains
    path = fly(all_over_the_link(gains), tilted(0.0, 0.01), 0.3)
    t = 5e-4 * np.arange(1, len(path) + 1)
    assert np.abs(path[:, 8] / 0.01 - second_order(t, w, zeta)).max() < 0.02
    assert np.abs(path[:, 8] / 0.01 - second_order(t, 1.2 * w, zeta)).max() > 0.05


def test_x1_a_larger_share_of_k3_would_take_the_position_off_its_poles():
    """Negative control of the least share: at a low damping ratio k₃ is large, and turns the body with every step."""
    path = fly(all_over_the_link(rule(Wanted(40.0, 0.7), SOFT, UAV, NO_DELAY).gains), tilted(0.0, 0.01), 0.2)
    gap = path[:, 8] / 0.01 - second_order(5e-4 * np.arange(1, len(path) + 1), 40.0, 0.7)
    assert 0.05 < np.abs(gap).max() < 0.15


@pytest.mark.parametrize(("w", "zeta"), [(10.0, 0.7), (12.0, 1.4)])
def test_x1_attitude_step_is_that_of_the_wanted_poles(w, zeta):
    gains = rule(ARM, Wanted(w, zeta), UAV, NO_DELAY).gains
    path = fly(all_over_the_link(gains), tilted(0.05), 0.8)
    t = 5e-4 * np.arange(1, len(path) + 1)
    assert np.abs(2.0 * path[:, 1] / 0.05 - second_order(t, w, zeta)).max() < 0.02
    assert np.abs(2.0 * path[:, 1] / 0.05 - second_order(t, w, 1.2 * zeta)).max() > 0.03


@pytest.mark.parametrize("zeta", [0.3, 0.7, 1.0, 1.5, 3.0])
def test_x1_law_has_the_stiffness_and_damping_of_the_poles_on_every_axis(zeta):
    """Differences of the law itself: torque and force per angle, rate, position, velocity, with the lever out of the way."""
    uav = UAV._replace(lever=np.zeros(3))
    design = rule(ARM, Wanted(10.0, zeta), uav, NO_DELAY)
    h = 1e-6

    def law(angle=0.0, rate=0.0, offset=0.0, velocity=0.0):
        q = Rotation.from_rotvec(angle * np.ones(3)).as_quat(scalar_first=True)
        e = np.ones(3)
        return exact_law(q, rate * e, offset * e, velocity * e, STILL, 0.0, np.zeros(3), uav, design.gains)

    rest = law()
    np.testing.assert_allclose((law(angle=h)[0] - rest[0]) / -h, 0.006 * 10.0**2 * np.ones(3), rtol=1e-4)
    J = np.diag(UAV.inertia)
    np.testing.assert_allclose((law(rate=h)[0] - rest[0]) / -h, 2.0 * zeta * np.sqrt(J * 0.6), rtol=1e-4)
    np.testing.assert_allclose((law(offset=h)[1] - rest[1]) / -h, 0.48 * 40.0**2 * np.ones(3), rtol=1e-4)
    np.testing.assert_allclose((law(velocity=h)[1] - rest[1]) / -h, 2.0 * 0.48 * 40.0 * np.ones(3), rtol=1e-4)


@pytest.mark.parametrize("zeta", [0.5, 0.95, 1.0, 2.0])
def test_eq30_no_other_gains_with_these_poles_promise_a_faster_decay(zeta):
    w, m = 40.0, 0.48
    gains = exact_gains(Wanted(w, zeta), np.full(3, 0.6), np.full(3, 0.1), UAV)
    best = min(gains.k1[3], gains.k2[3] / m)
    for K1 in np.linspace(0.1, 2.0 * zeta * w, 2001)[:-1]:
        K2 = 2.0 * zeta * w * m - m * K1
        k3 = m * w**2 - K1 * K2
        if k3 >= LEAST_SHARE * m * w**2 - 1e-9:
            assert min(K1, K2 / m) <= best + 1e-9
    # Where the decay of the poles is their real part, the proof finds all of it.
    assert zeta > 1.0 - LEAST_SHARE / 2 or best == pytest.approx(zeta * w)
    path = fly(all_over_the_link(gains), tilted(0.0, 0.01), 0.05)
    first, last = (exact_lyapunov(x[:4], x[4:7], x[7:10], x[10:], STILL, UAV, gains)[0] for x in path[[0, -1]])
    assert last < 1.05 * first * np.exp(
        -2.0 * 0.05 * min(best, (gains.k1[:3] / 4.0).min(), (gains.k2[:3] / 0.012).min())
    )


def test_published_position_gains_are_what_the_rule_makes_of_their_poles():
    """935 N/m and 44.4 N·s/m of (33): 44 rad/s and a damping ratio of 1.05, where k₃ gets the least share."""
    w = np.sqrt(935.0 / 0.48)
    gains = exact_gains(Wanted(w, 44.4 / (2.0 * 0.48 * w)), np.full(3, 0.6), np.full(3, 0.12), UAV)
    np.testing.assert_allclose([gains.k1[3], gains.k2[3], gains.k3_position], [30.0, 30.0, 35.0], rtol=0.08)


def delay_margin(gains, uav, delays):
    """Delay, s, that the attitude loops bear beyond `delays`; negative: the excess."""
    return min(margins(loop).delay for loop in attitude_loops(gains, uav, delays))


def test_x6_published_attitude_is_stiff_and_thirty_milliseconds_break_it():
    """k₃ = 35 makes K₁K₂/4 + k₃/4 = 9 N·m/rad on 0.006 kg·m²: 39 rad/s."""
    h = 1e-6
    q = np.array([np.cos(h / 2), np.sin(h / 2), 0.0, 0.0])
    free = UAV._replace(lever=np.zeros(3))
    torque, _ = exact_law(q, *np.zeros((3, 3)), STILL, 0.0, np.zeros(3), free, PUBLISHED)
    assert torque[0] / -h == pytest.approx(9.0, rel=1e-5)
    assert np.sqrt(9.0 / 0.006) == pytest.approx(38.7, abs=0.05)
    longest = delay_margin(PUBLISHED, UAV, NO_DELAY)
    assert longest == pytest.approx(9.9e-3, abs=1e-4)
    assert delay_margin(PUBLISHED, UAV, Delays(0.03, 0.0, 0.0)) == pytest.approx(longest - 0.03, rel=1e-3)
    assert delay_margin(PUBLISHED, UAV, Delays(0.0, 0.0, 0.05)) == pytest.approx(5.1e-3, abs=1e-4)
    for law in (all_over_the_link(PUBLISHED), as_published):
        calm, broken = (fly(law, tilted(0.02), 1.0, delay) for delay in (0.8 * longest, 0.03))
        assert np.abs(calm[-1, 1]) < 0.002
        assert np.abs(broken[:, 4:7]).max() > 100.0


def test_x6_what_the_rule_accepts_at_thirty_milliseconds_settles():
    delays = Delays(0.03, 0.0015, 0.0)
    design = rule(ARM, Wanted(7.0, 1.0), UAV, delays)
    path = fly(all_over_the_link(design.gains), tilted(0.2), 2.5, delay=0.03, dt=1e-3)
    assert np.abs(path[-1, 1]) < 0.002
    assert max(m.sensitivity for m in design.attitude) <= MAX_SENSITIVITY
    assert delay_margin(design.gains, UAV, delays) == min(m.delay for m in design.attitude) > 0.02


@pytest.mark.parametrize("late", [0.0, 0.03, 0.06])
def test_x6_feedback_on_board_settles_at_any_delay_of_the_link(late):
    """PD on board under rotor lag; the force is made with the late attitude, and so is the CM's velocity in it."""
    design = onboard_rule(ARM, Wanted(9.0, 0.7), UAV, BOARD)

    def law(x, old):
        v = x[10:] + turned(x) @ np.cross(x[4:7], UAV.lever) - turned(old) @ np.cross(old[4:7], UAV.lever)
        _, force = exact_law(old[:4], old[4:7], x[7:10], v, STILL, 2.35, np.zeros(3), UAV, design.gains)
        return -design.kp * 2.0 * x[1:4] - design.kd * x[4:7], force

    path = fly(law, tilted(0.1), 2.5, delay=late, lag=0.05, dt=1e-3)
    assert np.abs(path[-1, 1]) < 0.002


def test_x6_onboard_gains_place_the_wanted_pair():
    design = onboard_rule(ARM, Wanted(8.0, 0.6), UAV, Delays(0.0, 0.0015, 0.05))
    for axis, (J, height) in enumerate(((0.006, 0.06), (0.007, 0.06), (0.012, 0.0))):
        swung, fall = J + 0.48 * height**2, 0.48 * G * height
        closed = np.polymul([swung, 0.0, -fall], [0.05, 1.0])
        closed[-2:] += [design.kd[axis], design.kp[axis]]
        pair = 8.0 * (-0.6 + 1j * np.sqrt(1.0 - 0.6**2))
        assert np.abs(np.roots(closed) - pair).min() < 1e-9
        assert np.abs(np.roots(closed) - (-1.0 / 0.05 + 2.0 * 0.6 * 8.0)).min() < 1e-9


def test_x6_onboard_bound_is_where_the_stiffness_is_largest():
    lag, zeta = 0.0525, 0.7
    bound = 1.0 / (3.0 * zeta * lag)
    kp = [onboard_rule(ARM, Wanted(f * bound, zeta), UAV, BOARD).kp[0] for f in (0.96, 0.98, 1.0)]
    assert kp == sorted(kp)
    assert kp[2] / kp[1] < 1.001
    with pytest.raises(ConfigurationError, match=r"not feasible .* or compensate the rotor lag"):
        onboard_rule(ARM, Wanted(1.01 * bound, zeta), UAV, BOARD)


def test_x6_law_counts_on_the_same_pd_as_is_on_board():
    design = onboard_rule(ARM, Wanted(9.0, 0.7), UAV, BOARD)
    free = UAV._replace(lever=np.zeros(3))
    h = 1e-6
    for axis in range(3):
        e = np.eye(3)[axis]
        q = np.array([np.cos(h / 2), *(np.sin(h / 2) * e)])
        turned, _ = exact_law(q, *np.zeros((3, 3)), STILL, 0.0, np.zeros(3), free, design.gains)
        spun, _ = exact_law(LEVEL, h * e, *np.zeros((2, 3)), STILL, 0.0, np.zeros(3), free, design.gains)
        assert -turned[axis] / h == pytest.approx(design.kp[axis], rel=1e-5)
        assert -spun[axis] / h == pytest.approx(design.kd[axis], rel=1e-5)


def named(message, pattern):
    return [float(x) for x in re.search(pattern, message).groups()]


@pytest.mark.parametrize(
    ("make", "attitude", "delays"),
    [
        (rule, Wanted(20.0, 1.0), Delays(0.03, 0.0015, 0.0)),
        (rule, Wanted(15.0, 1.5), BOARD),
        (onboard_rule, Wanted(12.0, 0.7), BOARD),
        (onboard_rule, Wanted(3.0, 0.7), BOARD),
    ],
)
def test_refusal_names_what_would_have_worked(make, attitude, delays):
    with pytest.raises(ConfigurationError) as refusal:
        make(ARM, attitude, UAV, delays)
    low, high = named(str(refusal.value), r"feasible at this delay are ([\d.]+) to ([\d.]+) rad/s")
    assert not low <= attitude.bandwidth <= high
    for bandwidth in (1.01 * low, 0.99 * high):
        make(ARM, attitude._replace(bandwidth=bandwidth), UAV, delays)
    for bandwidth in (0.97 * low, 1.03 * high):
        with pytest.raises(ConfigurationError):
            make(ARM, attitude._replace(bandwidth=bandwidth), UAV, delays)


def test_refusal_names_the_longest_delay():
    with pytest.raises(ConfigurationError) as refusal:
        rule(ARM, Wanted(20.0, 1.0), UAV, Delays(0.03, 0.0015, 0.0))
    (longest,) = named(str(refusal.value), r"at this bandwidth at most ([\d.]+) ms")
    rule(ARM, Wanted(20.0, 1.0), UAV, Delays(0.99e-3 * longest, 0.0015, 0.0))
    with pytest.raises(ConfigurationError):
        rule(ARM, Wanted(20.0, 1.0), UAV, Delays(1.02e-3 * longest, 0.0015, 0.0))


def test_refusal_where_nothing_would_work():
    with pytest.raises(ConfigurationError, match=r"no bandwidth .* at this delay, .* or keep the feedback on board"):
        rule(ARM, Wanted(38.7, 2.15), UAV, Delays(0.03, 0.0015, 0.05))
    with pytest.raises(ConfigurationError, match="or make the feed-forward of reference values"):
        onboard_rule(ARM, Wanted(9.0, 0.7), UAV, BOARD, feed_forward=0.0325)


def test_position_bandwidth_is_held_against_its_own_delay():
    with pytest.raises(ConfigurationError, match=r"position bandwidth 300 .* feasible at this delay are"):
        rule(Wanted(300.0, 1.0), SOFT, UAV, NO_DELAY._replace(position=0.0015))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"attitude": Wanted(-9.0, 0.7)}, "attitude bandwidth is -9.0; it must be a finite number above 0"),
        ({"position": Wanted(40.0, 0.0)}, "position damping is 0.0"),
        ({"position": Wanted(np.nan, 1.0)}, "position bandwidth is nan"),
        ({"delays": Delays(-0.01, 0.0, 0.05)}, r"delays.attitude is -0.01 s; it must be from 0 to 0.5 s"),
        ({"delays": Delays(0.0, 0.0, np.nan)}, "delays.rotor_lag is nan"),
    ],
)
@pytest.mark.parametrize("make", [rule, onboard_rule])
def test_bad_input_is_refused(make, change, message):
    arguments = {"position": ARM, "attitude": SOFT, "uav": UAV, "delays": BOARD} | change
    with pytest.raises(ConfigurationError, match=message):
        make(**arguments)


def test_indefinite_inertia_is_refused():
    with pytest.raises(ModelError, match="all must be above 0"):
        rule(ARM, SOFT, UAV._replace(inertia=np.diag([0.006, -0.007, 0.012])), BOARD)


def test_axes_that_one_k3_cannot_serve_are_refused():
    with pytest.raises(ConfigurationError, match="one k3_attitude serves all axes only if"):
        exact_gains(ARM, np.array([0.5, 0.5, 0.05]), np.full(3, 0.02), UAV)


def test_x6_pendulum_costs_the_board_its_falling_torque():
    """The same poles with the pivot above the CM, where the body hangs, below it, and without a lever arm."""
    fast = BOARD._replace(rotor_lag=0.01)
    hanging, none, standing = (
        onboard_rule(ARM, Wanted(25.0, 0.7), UAV._replace(lever=np.array([0.0, 0.0, z])), fast)
        for z in (0.06, 0.0, -0.06)
    )
    fall = 0.48 * G * 0.06
    np.testing.assert_allclose(standing.kp - hanging.kp, [2.0 * fall, 2.0 * fall, 0.0], atol=1e-12)
    assert standing.kp[2] == none.kp[2]
    assert hanging.attitude[0].gain_down == 0.0 < standing.attitude[0].gain_down


@pytest.mark.parametrize(
    ("zeta", "lag", "late"), [(0.7, 0.01, 0.002), (0.8, 0.012, 0.0025), (0.9, 0.015, 0.002), (1.0, 0.015, 0.003)]
)
def test_x6_bandwidth_at_its_bound_is_accepted_whatever_the_rounding(zeta, lag, late):
    """3ζω(τ + T) is a digit above 1 here, though ω is the bound itself."""
    bound = 1.0 / (3.0 * zeta * (lag + late))
    assert 3.0 * zeta * bound * (lag + late) > 1.0
    assert onboard_rule(ARM, Wanted(bound, zeta), UAV, Delays(late, 0.0015, lag)).kp.min() > 0.0
