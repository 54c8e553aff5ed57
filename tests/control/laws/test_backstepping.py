"""The law of the paper and its proof, against a vector field written with scipy and NumPy alone."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import block_diag
from scipy.spatial.transform import Rotation

from armland.control.laws import backstepping
from armland.control.laws.lyapunov import error_gradient
from armland.control.laws.rigid_body import BacksteppingGains, UavParameters

G = 9.81
INERTIA = np.array([[0.006, 0.0004, -0.0003], [0.0004, 0.007, 0.0002], [-0.0003, 0.0002, 0.012]])
UAV = UavParameters(0.48, INERTIA, np.array([0.004, -0.007, -0.06]))
PUBLISHED = BacksteppingGains(
    np.array([1.0, 1.0, 1.0, 30.0, 30.0, 30.0]), np.array([1.0, 1.0, 1.0, 30.0, 30.0, 30.0]), 35.0
)
UNEQUAL = BacksteppingGains(
    np.array([1.3, 0.7, 2.1, 20.0, 35.0, 28.0]), np.array([0.4, 0.9, 0.6, 12.0, 31.0, 18.0]), 7.0
)


def states(count, seed=2):
    """Random (q, omega, r, v, q_d, r_d, thrust, tau_att) over the whole sphere of attitudes."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        q, q_d = rng.normal(size=(2, 4))
        q, q_d = q / np.linalg.norm(q), q_d / np.linalg.norm(q_d)
        omega, r, v, r_d, tau_att = rng.normal(size=(5, 3)) * np.array([[2.0], [0.3], [0.5], [0.3], [0.2]])
        yield q, omega, r, v, q_d, r_d, rng.uniform(0.0, 6.0), tau_att


def matrix(q):
    return Rotation.from_quat(q, scalar_first=True).as_matrix()


def S(a):
    return np.array([np.cross(a, e) for e in np.eye(3)]).T


def product(a, b):
    """Hamilton product, as matrix times vector."""
    return np.block([[a[0], -a[None, 1:]], [a[1:, None], a[0] * np.eye(3) + S(a[1:])]]) @ b


def uav_matrices(q, omega, thrust, tau_att, uav):
    """M_uav, a_uav and B̄ of (13)."""
    R, e3 = matrix(q), np.array([0.0, 0.0, 1.0])
    M = block_diag(uav.inertia, uav.mass * np.eye(3))
    moment = tau_att - np.cross(omega, uav.inertia @ omega)
    a = np.concatenate((moment, thrust * R @ e3 - uav.mass * G * e3))
    return M, a, np.block([[np.eye(3), S(uav.lever) @ R.T], [np.zeros((3, 3)), np.eye(3)]])


def field(q, omega, v, u, thrust, tau_att, uav):
    """(q̇, ω̇, ṙ, v̇) on the kinematics that the paper uses: the pivot moves with v."""
    M, a, B = uav_matrices(q, omega, thrust, tau_att, uav)
    nu_dot = np.linalg.solve(M, a + B @ u)
    return 0.5 * product(q, np.concatenate(([0.0], omega))), nu_dot[:3], v, nu_dot[3:]


def printed_gradient(q, r, q_d, r_d, factor):
    """Qᵀz₁ in the reduced form (31); the published text has factor = 1."""
    q_e = product(q_d * [1, -1, -1, -1], q)
    return np.concatenate((factor * (1.0 if q_e[0] >= 0.0 else -1.0) * q_e[1:], r - r_d))


def slope(function, state, rate, q_d):
    """Derivative of `function(q, omega, r, v)` along `rate`, free of truncation error.

    V₂ is a quadratic polynomial of (q, ω, r, v) as long as η_e keeps its sign, so that a central difference is exact
    for any step that does not cross the switch.
    """
    eta = abs(q_d @ state[0])
    h = min(1e-2, 0.1 * eta / (1e-9 + np.linalg.norm(rate[0])))
    ahead, behind = ([x + s * h * dx for x, dx in zip(state, rate, strict=True)] for s in (1.0, -1.0))
    return (function(*ahead) - function(*behind)) / (2.0 * h)


@pytest.mark.parametrize("gains", [PUBLISHED, UNEQUAL])
def test_eq30_lyapunov_rate_is_an_identity_on_the_whole_sphere(gains):
    signs = set()
    for q, omega, r, v, q_d, r_d, thrust, tau_att in states(300):
        u = np.concatenate(backstepping.paper_law(q, omega, r, v, q_d, r_d, thrust, tau_att, UAV, gains))
        rate = slope(
            lambda *x, q_d=q_d, r_d=r_d: backstepping.lyapunov(*x, q_d, r_d, UAV, gains)[0],
            (q, omega, r, v),
            field(q, omega, v, u, thrust, tau_att, UAV),
            q_d,
        )
        v2, v2_rate = backstepping.lyapunov(q, omega, r, v, q_d, r_d, UAV, gains)
        signs.add(np.sign(q_d @ q))
        assert v2 > 0.0 > v2_rate
        assert rate == pytest.approx(v2_rate, rel=1e-9, abs=1e-9)
    assert signs == {-1.0, 1.0}


@pytest.mark.parametrize(("factor", "holds"), [(0.5, True), (1.0, False)])
def test_eq30_fails_with_eq31_as_printed(factor, holds):
    gains = UNEQUAL
    for q, omega, r, v, q_d, r_d, thrust, tau_att in states(50):

        def alpha(q, r, q_d=q_d, r_d=r_d):
            return -gains.k1 * printed_gradient(q, r, q_d, r_d, factor)

        def v2(q, omega, r, v, q_d=q_d, r_d=r_d):
            z1 = np.concatenate(([1.0 - abs(q_d @ q)], product(q_d * [1, -1, -1, -1], q)[1:], r_d - r))
            z2 = np.concatenate((omega, v)) - alpha(q, r, q_d, r_d)
            return 0.5 * gains.k3 * z1 @ z1 + 0.5 * z2 @ block_diag(UAV.inertia, UAV.mass * np.eye(3)) @ z2

        M, a, B = uav_matrices(q, omega, thrust, tau_att, UAV)
        q_dot = 0.5 * product(q, np.concatenate(([0.0], omega)))
        alpha_dot = slope(lambda q, omega, r, v: alpha(q, r), (q, omega, r, v), (q_dot, 0.0, v, 0.0), q_d)
        gradient = printed_gradient(q, r, q_d, r_d, factor)
        z2 = np.concatenate((omega, v)) - alpha(q, r)
        u = np.linalg.solve(B, -gains.k2 * z2 - a + M @ alpha_dot - gains.k3 * gradient)
        rate = slope(v2, (q, omega, r, v), field(q, omega, v, u, thrust, tau_att, UAV), q_d)
        target = -gains.k3 * gradient @ (gains.k1 * gradient) - z2 @ (gains.k2 * z2)
        gap = abs(rate - target) / (1.0 + abs(target))
        assert gap < 1e-9 if holds else gap > 1e-6
        law = np.concatenate(backstepping.paper_law(q, omega, r, v, q_d, r_d, thrust, tau_att, UAV, gains))
        assert np.allclose(law, u, rtol=1e-9, atol=1e-9) == holds


def test_eq30_energy_balance_of_an_integrated_closed_loop():
    q, omega, r, v, q_d, r_d, thrust, tau_att = next(states(1, seed=5))
    gains = PUBLISHED

    def closed_loop(_, x):
        state = x[:4], x[4:7], x[7:10], x[10:13]
        u = np.concatenate(backstepping.paper_law(*state, q_d, r_d, thrust, tau_att, UAV, gains))
        rate = field(state[0], state[1], state[3], u, thrust, tau_att, UAV)
        return np.concatenate((*rate, [backstepping.lyapunov(*state, q_d, r_d, UAV, gains)[1]]))

    start = np.concatenate((q, omega, r, v, [0.0]))
    run = solve_ivp(closed_loop, (0.0, 0.5), start, method="DOP853", rtol=1e-10, atol=1e-12)
    path = np.ascontiguousarray(run.y.T)
    energy = np.array([backstepping.lyapunov(x[:4], x[4:7], x[7:10], x[10:13], q_d, r_d, UAV, gains)[0] for x in path])
    np.testing.assert_allclose(energy - energy[0], run.y[13], rtol=1e-8, atol=1e-8 * energy[0])
    assert (np.diff(energy) < 0.0).all()
    assert np.linalg.norm(run.y[7:10, -1] - r_d) < 1e-2 * np.linalg.norm(r - r_d)


def test_eq17_gradient_is_that_of_half_the_squared_error():
    """½ z₁ᵀz₁ along each direction in which the body can move, z₁ by products of quaternions."""
    h = 1e-3
    for q, _, r, _, q_d, r_d, _, _ in states(20):
        q_e = product(q_d * [1, -1, -1, -1], q)

        def half_square(t, nu, q_e=q_e, r=r, r_d=r_d):
            turn = Rotation.from_rotvec(t * nu[:3]).as_quat(scalar_first=True)
            moved, away = product(q_e, turn), r_d - r - t * nu[3:]
            return 0.5 * ((1.0 - abs(moved[0])) ** 2 + moved[1:] @ moved[1:] + away @ away)

        slopes = [
            (8.0 * (half_square(h, nu) - half_square(-h, nu)) - half_square(2 * h, nu) + half_square(-2 * h, nu))
            / (12 * h)
            for nu in np.eye(6)
        ]
        np.testing.assert_allclose(error_gradient(q_e, r_d - r), slopes, atol=1e-11)


def test_eq33_apparent_gravity_shifts_the_support_and_nothing_else():
    """On a deck that accelerates the arm carries m(a − g) more: the law's force changes by −m(γ − g), its torque by what that makes."""
    q, omega, r, v, q_d, r_d, thrust, tau_att = next(states(1))
    gamma, lever_force = np.array([0.4, -0.7, -10.6]), -UAV.mass * np.array([0.4, -0.7, -10.6 + G])
    args = q, omega, r, v, q_d, r_d, thrust, tau_att, UAV, UNEQUAL
    on_land, on_deck = backstepping.paper_law(*args), backstepping.paper_law(*args, tuple(gamma))
    np.testing.assert_allclose(on_deck[1] - on_land[1], lever_force, atol=1e-12)
    np.testing.assert_allclose(on_deck[0] - on_land[0], -np.cross(UAV.lever, matrix(q).T @ lever_force), atol=1e-12)
    support = backstepping.support_force(q, thrust, UAV, tuple(gamma)) - backstepping.support_force(q, thrust, UAV)
    np.testing.assert_allclose(support, lever_force, atol=1e-12)


def test_eq22_rate_of_alpha_is_the_one_inside_the_law():
    gains = UNEQUAL
    for q, omega, r, v, q_d, r_d, thrust, tau_att in states(50):
        M, a, B = uav_matrices(q, omega, thrust, tau_att, UAV)
        u = np.concatenate(backstepping.paper_law(q, omega, r, v, q_d, r_d, thrust, tau_att, UAV, gains))
        gradient = printed_gradient(q, r, q_d, r_d, 0.5)
        z2 = np.concatenate((omega, v)) + gains.k1 * gradient
        inside = np.linalg.solve(M, B @ u + a + gains.k2 * z2 + gains.k3 * gradient)
        h = 1e-4 * abs(q_d @ q)
        alpha = [
            -gains.k1
            * printed_gradient(
                product(q, Rotation.from_rotvec(s * h * omega).as_quat(scalar_first=True)), r + s * h * v, q_d, r_d, 0.5
            )
            for s in (1.0, -1.0)
        ]
        np.testing.assert_allclose(inside, (alpha[0] - alpha[1]) / (2.0 * h), rtol=1e-6, atol=1e-7)


def test_eq33_force_is_the_lower_half_of_eq29():
    for q, omega, r, v, q_d, r_d, thrust, tau_att in states(100):
        _, force = backstepping.paper_law(q, omega, r, v, q_d, r_d, thrust, tau_att, UAV, UNEQUAL)
        split = backstepping.impedance_force(r_d - r, v, UAV, UNEQUAL) + backstepping.support_force(q, thrust, UAV)
        np.testing.assert_allclose(split, force, rtol=1e-9, atol=1e-9)


def test_eq33_published_gains_give_935_newton_per_metre_and_44_newton_seconds():
    z = np.array([0.0, 0.0, 1.0])
    np.testing.assert_allclose(backstepping.impedance_force(z, 0.0 * z, UAV, PUBLISHED), 935.0 * z)
    np.testing.assert_allclose(backstepping.impedance_force(0.0 * z, z, UAV, PUBLISHED), -44.4 * z)


def test_eq33_support_carries_what_the_thrust_leaves():
    upright, half_weight = np.array([1.0, 0.0, 0.0, 0.0]), 0.5 * UAV.mass * G
    np.testing.assert_allclose(backstepping.support_force(upright, half_weight, UAV), [0.0, 0.0, half_weight])
    tilted_to_x = Rotation.from_euler("y", 30.0, degrees=True).as_quat(scalar_first=True)
    np.testing.assert_allclose(backstepping.support_force(tilted_to_x, 2.0, UAV)[0], -1.0)


def test_eq29_holds_the_uav_still_at_the_reference():
    q, _, r, _, _, _, thrust, tau_att = next(states(1))
    rest = np.zeros(3)
    u = np.concatenate(backstepping.paper_law(q, rest, r, rest, q, r, thrust, tau_att, UAV, PUBLISHED))
    _, omega_dot, _, v_dot = field(q, rest, rest, u, thrust, tau_att, UAV)
    np.testing.assert_allclose(omega_dot, 0.0, atol=1e-12)
    np.testing.assert_allclose(v_dot, 0.0, atol=1e-12)


def test_eq29_does_not_see_the_sign_of_a_quaternion():
    for q, omega, r, v, q_d, r_d, thrust, tau_att in states(20):
        rest = r_d, thrust, tau_att, UAV, PUBLISHED
        one = backstepping.paper_law(q, omega, r, v, q_d, *rest)
        np.testing.assert_allclose(backstepping.paper_law(-q, omega, r, v, q_d, *rest), one, atol=1e-12)
        np.testing.assert_allclose(backstepping.paper_law(q, omega, r, v, -q_d, *rest), one, atol=1e-12)
