"""The exact law (X.1) against Newton–Euler written with scipy and NumPy alone."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from armland.control.laws.backstepping import paper_law
from armland.control.laws.exact import Reference, exact_law, exact_lyapunov
from armland.control.laws.rigid_body import BacksteppingGains, ExactGains, UavParameters, drift, inertial, input_for
from armland.models.environment import DOWN

G = 9.81
INERTIA = np.array([[0.006, 0.0004, -0.0003], [0.0004, 0.007, 0.0002], [-0.0003, 0.0002, 0.012]])
UAV = UavParameters(0.48, INERTIA, np.array([0.004, -0.007, -0.06]))
K1, K2 = np.array([1.3, 0.7, 2.1, 20.0, 35.0, 28.0]), np.array([0.4, 0.9, 0.6, 12.0, 31.0, 18.0])
PUBLISHED = BacksteppingGains(
    np.array([1.0, 1.0, 1.0, 30.0, 30.0, 30.0]), np.array([1.0, 1.0, 1.0, 30.0, 30.0, 30.0]), 35.0
)
APART = ExactGains(K1, K2, 3.0, 40.0)


def unit(x):
    return x / np.linalg.norm(x)


def states(count, seed=3):
    """Random (q, omega, r, v), moving reference, thrust, tau_att over the whole sphere of attitudes."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        q, q_d = unit(rng.normal(size=4)), unit(rng.normal(size=4))
        omega, r, v, omega_d, omega_dot_d, r_d, v_d, a_d, tau_att = rng.normal(size=(9, 3))
        reference = Reference(q_d, omega_d, 3.0 * omega_dot_d, 0.1 * r_d, 0.3 * v_d, 2.0 * a_d)
        yield q, 2.0 * omega, 0.1 * r, 0.5 * v, reference, rng.uniform(0.0, 6.0), 0.2 * tau_att


def matrix(q):
    return Rotation.from_quat(q, scalar_first=True).as_matrix()


def quaternion_rate(q, omega):
    """q̇ = ½ q ⊗ (0, ω)."""
    return 0.5 * np.concatenate(([-q[1:] @ omega], q[0] * omega + np.cross(q[1:], omega)))


def rigid_body(q, omega, v, delta_tau, force, thrust, tau_att, uav=UAV):
    """(q̇, ω̇, ṙ of the pivot, v̇ of the centre of mass) by Newton and Euler."""
    R = matrix(q)
    momentum = uav.inertia @ omega
    moment = tau_att + delta_tau + np.cross(uav.lever, R.T @ force)
    omega_dot = np.linalg.solve(uav.inertia, moment - np.cross(omega, momentum))
    v_dot = (thrust * R[:, 2] + force) / uav.mass - np.array([0.0, 0.0, G])
    return quaternion_rate(q, omega), omega_dot, v + R @ np.cross(omega, uav.lever), v_dot


def moved(x, dx, h):
    return [a + h * b for a, b in zip(x, dx, strict=True)]


def slope(function, x, dx, h):
    """Derivative of `function(*x)` along dx by an eighth-order central difference."""
    weights = {1: 4 / 5, 2: -1 / 5, 3: 4 / 105, 4: -1 / 280}
    return sum(w * (function(*moved(x, dx, k * h)) - function(*moved(x, dx, -k * h))) for k, w in weights.items()) / h


def step(q, omega, reference):
    """A difference step that keeps the sign of η_e, and small against the motion."""
    return min(4e-3, 0.02 * abs(q @ reference.q_d)) / (1.0 + np.linalg.norm(omega) + np.linalg.norm(reference.omega_d))


def true_rate(q, omega, r, v, reference, u, thrust, tau_att, gains):
    """V̇₂ along the true motion of body and reference under the input u."""
    body_rate = rigid_body(q, omega, v, *u, thrust, tau_att)
    q_d, omega_d, omega_dot_d, _, v_d, a_d = reference
    reference_rate = quaternion_rate(q_d, omega_d), omega_dot_d, v_d, a_d

    def v2(q, omega, r, v, q_d, omega_d, r_d, v_d):
        now = reference._replace(q_d=q_d, omega_d=omega_d, r_d=r_d, v_d=v_d)
        return exact_lyapunov(q, omega, r, v, now, UAV, gains)[0]

    x = q, omega, r, v, q_d, omega_d, reference.r_d, v_d
    return slope(v2, x, (*body_rate, *reference_rate), step(q, omega, reference))


@pytest.mark.parametrize("gains", [PUBLISHED, BacksteppingGains(K1, K2, 7.0), APART])
def test_x1_lyapunov_rate_is_an_identity_on_the_true_kinematics(gains):
    signs = set()
    for q, omega, r, v, reference, thrust, tau_att in states(100):
        u = exact_law(q, omega, r, v, reference, thrust, tau_att, UAV, gains)
        v2, v2_rate = exact_lyapunov(q, omega, r, v, reference, UAV, gains)
        signs.add(np.sign(q @ reference.q_d))
        assert v2 > 0.0 > v2_rate
        rate = true_rate(q, omega, r, v, reference, u, thrust, tau_att, gains)
        assert rate == pytest.approx(v2_rate, rel=1e-9, abs=1e-9 * v2)
    assert signs == {-1.0, 1.0}


@pytest.mark.parametrize("left_out", ["omega_d", "omega_dot_d", "v_d", "a_d", "lever"])
def test_x1_identity_needs_every_part_of_the_reference_and_the_lever(left_out):
    gaps = []
    for q, omega, r, v, reference, thrust, tau_att in states(20):
        told, uav = reference, UAV
        if left_out == "lever":
            uav = UAV._replace(lever=np.zeros(3))
        else:
            told = reference._replace(**{left_out: np.zeros(3)})
        u = exact_law(q, omega, r, v, told, thrust, tau_att, uav, PUBLISHED)
        v2_rate = exact_lyapunov(q, omega, r, v, reference, UAV, PUBLISHED)[1]
        gaps.append(true_rate(q, omega, r, v, reference, u, thrust, tau_att, PUBLISHED) / v2_rate - 1.0)
    assert np.median(np.abs(gaps)) > 1e-5


@pytest.mark.parametrize("moving", [True, False])
def test_x1_identity_does_not_hold_for_the_law_of_the_paper(moving):
    gaps = []
    for q, omega, r, v, reference, thrust, tau_att in states(20):
        rest = reference if moving else Reference(reference.q_d, *np.zeros((2, 3)), reference.r_d, *np.zeros((2, 3)))
        u = paper_law(q, omega, r, v, rest.q_d, rest.r_d, thrust, tau_att, UAV, PUBLISHED)
        v2_rate = exact_lyapunov(q, omega, r, v, rest, UAV, PUBLISHED)[1]
        gaps.append(true_rate(q, omega, r, v, rest, u, thrust, tau_att, PUBLISHED) / v2_rate - 1.0)
    assert np.median(np.abs(gaps)) > 1e-3


def test_x1_from_the_closed_loop_that_it_must_make():
    """Second derivation: α as the twist of a body whose pivot moves as wanted, α̇ by differences, u from M_uav ż₂."""
    gains = APART
    k3 = np.repeat([gains.k3_attitude, gains.k3_position], 3)

    def alpha(q, r, q_d, omega_d, r_d, v_d):
        R, R_d = matrix(q), matrix(q_d)
        q_e = (Rotation.from_matrix(R_d).inv() * Rotation.from_matrix(R)).as_quat(canonical=True, scalar_first=True)
        twist = R.T @ R_d @ omega_d - 0.5 * gains.k1[:3] * q_e[1:]
        pivot_velocity = v_d + gains.k1[3:] * (r_d - r)
        return np.concatenate((twist, pivot_velocity - R @ np.cross(twist, UAV.lever))), q_e

    for q, omega, r, v, reference, thrust, tau_att in states(50):
        q_d, omega_d, omega_dot_d, r_d, v_d, a_d = reference
        q_dot, omega_free, r_dot, v_free = rigid_body(q, omega, v, np.zeros(3), np.zeros(3), thrust, tau_att)
        x = q, r, q_d, omega_d, r_d, v_d
        dx = q_dot, r_dot, quaternion_rate(q_d, omega_d), omega_dot_d, v_d, a_d
        alpha_dot = slope(lambda *x: alpha(*x)[0], x, dx, step(q, omega, reference))
        virtual, q_e = alpha(*x)
        gradient = np.concatenate((0.5 * q_e[1:], r - r_d))
        # B̄ maps a force at the pivot to the CM: column i is the moment of a unit force along the world's axis i.
        B = np.eye(6)
        B[:3, 3:] = np.array([np.cross(UAV.lever, matrix(q).T @ e) for e in np.eye(3)]).T
        M = np.block([[UAV.inertia, np.zeros((3, 3))], [np.zeros((3, 3)), UAV.mass * np.eye(3)]])
        z2 = np.concatenate((omega, v)) - virtual
        wanted = M @ alpha_dot - gains.k2 * z2 - B @ (k3 * gradient)
        u = np.linalg.solve(B, wanted - M @ np.concatenate((omega_free, v_free)))
        law = np.concatenate(exact_law(q, omega, r, v, reference, thrust, tau_att, UAV, gains))
        np.testing.assert_allclose(law, u, rtol=1e-8, atol=1e-8 * np.linalg.norm(u))


def test_x1_without_lever_and_motion_is_the_law_of_the_paper():
    uav = UAV._replace(lever=np.zeros(3))
    for q, omega, r, v, reference, thrust, tau_att in states(20):
        rest = Reference(reference.q_d, *np.zeros((2, 3)), reference.r_d, *np.zeros((2, 3)))
        exact = exact_law(q, omega, r, v, rest, thrust, tau_att, uav, PUBLISHED)
        paper = paper_law(q, omega, r, v, rest.q_d, rest.r_d, thrust, tau_att, uav, PUBLISHED)
        np.testing.assert_allclose(exact, paper, rtol=1e-12, atol=1e-11)


def test_x1_does_not_see_the_sign_of_a_quaternion():
    for q, omega, r, v, reference, thrust, tau_att in states(20):
        one = exact_law(q, omega, r, v, reference, thrust, tau_att, UAV, APART)
        other = reference._replace(q_d=-reference.q_d)
        np.testing.assert_allclose(exact_law(-q, omega, r, v, reference, thrust, tau_att, UAV, APART), one, atol=1e-10)
        np.testing.assert_allclose(exact_law(q, omega, r, v, other, thrust, tau_att, UAV, APART), one, atol=1e-10)


def test_x6_one_k3_is_two_equal_ones():
    one, equal = BacksteppingGains(K1, K2, 7.0), ExactGains(K1, K2, 7.0, 7.0)
    for q, omega, r, v, reference, thrust, tau_att in states(5):
        laws = [exact_law(q, omega, r, v, reference, thrust, tau_att, UAV, gains) for gains in (one, equal)]
        np.testing.assert_array_equal(*laws)
        proofs = [exact_lyapunov(q, omega, r, v, reference, UAV, gains) for gains in (one, equal)]
        assert proofs[0] == proofs[1]


def smooth_reference(t):
    """A consistent reference: two turns about fixed axes, one after the other, and a sine of the pivot."""
    a, b = np.array([0.0, 0.6, 0.8]), np.array([1.0, 0.0, 0.0])
    x, xd, xdd = 0.3 * np.sin(3.0 * t), 0.9 * np.cos(3.0 * t), -2.7 * np.sin(3.0 * t)
    y, yd, ydd = 0.2 * np.cos(5.0 * t), -np.sin(5.0 * t), -5.0 * np.cos(5.0 * t)
    first, second = Rotation.from_rotvec(x * a), Rotation.from_rotvec(y * b)
    inner = second.inv().apply(a)
    omega, omega_dot = inner * xd + b * yd, inner * xdd - np.cross(b * yd, inner * xd) + b * ydd
    r = np.array([0.1, 0.2, 0.05])
    q = (first * second).as_quat(scalar_first=True)
    return Reference(q, omega, omega_dot, r * np.sin(4.0 * t), 4.0 * r * np.cos(4.0 * t), -16.0 * r * np.sin(4.0 * t))


def follow(law, start, duration):
    """Integrate body, pivot and the promised energy loss under `law(t, q, omega, r, v)`."""

    def rate(t, x):
        u = law(t, x[:4], x[4:7], x[7:10], x[10:13])
        loss = exact_lyapunov(x[:4], x[4:7], x[7:10], x[10:13], smooth_reference(t), UAV, PUBLISHED)[1]
        return np.concatenate((*rigid_body(x[:4], x[4:7], x[10:13], *u, 3.0, np.zeros(3)), [loss]))

    run = solve_ivp(rate, (0.0, duration), start, method="DOP853", rtol=1e-8, atol=1e-10)
    return run.t, np.ascontiguousarray(run.y.T)


def test_x1_follows_a_moving_reference_where_the_paper_lags():
    start = np.concatenate((unit(np.array([0.9, 0.2, -0.3, 0.1])), [1.0, -1.0, 0.5], [0.1, 0.0, 0.2], np.zeros(4)))

    def exact(t, q, omega, r, v):
        return exact_law(q, omega, r, v, smooth_reference(t), 3.0, np.zeros(3), UAV, PUBLISHED)

    def paper(t, q, omega, r, v):
        reference = smooth_reference(t)
        return paper_law(q, omega, r, v, reference.q_d, reference.r_d, 3.0, np.zeros(3), UAV, PUBLISHED)

    t, path = follow(exact, start, 0.6)
    energy = [
        exact_lyapunov(x[:4], x[4:7], x[7:10], x[10:13], smooth_reference(at), UAV, PUBLISHED)[0]
        for at, x in zip(t, path, strict=True)
    ]
    np.testing.assert_allclose(np.array(energy) - energy[0], path[:, 13], atol=1e-7 * energy[0])
    assert (np.diff(energy) < 0.0).all()
    assert np.linalg.norm(path[-1, 7:10] - smooth_reference(t[-1]).r_d) < 1e-4
    t, path = follow(paper, start, 0.6)
    assert np.linalg.norm(path[-1, 7:10] - smooth_reference(t[-1]).r_d) > 1e-2


def test_eq13_power_at_the_pivot_is_force_times_the_pivots_velocity():
    for q, omega, _, v, _, thrust, tau_att in states(50):
        R, rng = matrix(q), np.random.default_rng(7)
        delta_tau, force = rng.normal(size=(2, 3))
        load = drift(R, omega, thrust, tau_att, UAV, DOWN)
        # input_for inverts B̄, so feeding B̄u through it must return u.
        lifted = np.concatenate((delta_tau + np.cross(UAV.lever, R.T @ force), force))
        np.testing.assert_allclose(np.concatenate(input_for(lifted, R, UAV)), [*delta_tau, *force], atol=1e-14)
        power = np.concatenate((omega, v)) @ (load + lifted)
        pivot_velocity = v + R @ np.cross(omega, UAV.lever)
        given = omega @ (tau_att + delta_tau) + force @ pivot_velocity + v @ (thrust * R[:, 2]) - UAV.mass * G * v[2]
        assert power == pytest.approx(given, abs=1e-12)


def test_eq13_mass_matrix_gives_the_kinetic_energy():
    _, omega, _, v, _, _, _ = next(states(1))
    nu = np.concatenate((omega, v))
    energy = 0.5 * omega @ UAV.inertia @ omega + 0.5 * UAV.mass * v @ v
    assert 0.5 * nu @ inertial(nu, UAV) == pytest.approx(energy, rel=1e-14)
