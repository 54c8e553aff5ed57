"""Onboard attitude controllers in closed loop with a rigid body written with scipy and NumPy alone."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from armland.control.laws.attitude import (
    AttitudeMemory,
    CascadeGains,
    GeometricGains,
    QuaternionPdGains,
    cascade,
    feed_forward,
    geometric,
    initial_memory,
    quaternion_pd,
)

INERTIA = np.array([[0.006, 0.0004, -0.0003], [0.0004, 0.007, 0.0002], [-0.0003, 0.0002, 0.012]])
KP, KD = np.array([1.0, 1.2, 0.8]), np.array([0.12, 0.14, 0.16])
PD = QuaternionPdGains(KP, KD)
GEOMETRIC = GeometricGains(KP, KD, INERTIA)
CASCADE = CascadeGains(
    k_angle=np.array([6.0, 6.0, 4.0]),
    rate_limit=np.array([4.0, 4.0, 2.0]),
    kp=np.array([0.12, 0.14, 0.2]),
    ki=np.array([0.3, 0.3, 0.3]),
    kd=np.array([5e-4, 5e-4, 0.0]),
    torque_limit=np.array([0.34, 0.34, 0.1]),
    filter_time=0.004,
    period=1e-3,
)
ALL = [(quaternion_pd, PD), (geometric, GEOMETRIC), (cascade, CASCADE)]
UPRIGHT, REST = np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3)


def torque_of(controller, gains, q, omega, q_d, omega_d=REST, omega_dot_d=REST):
    return controller(q, omega, q_d, omega_d, omega_dot_d, gains, initial_memory(omega))[0]


def turn(axis, degrees):
    return Rotation.from_rotvec(degrees * np.asarray(axis), degrees=True).as_quat(scalar_first=True)


def attitudes(count, seed=4):
    rng = np.random.default_rng(seed)
    for q in Rotation.random(count, rng=rng).as_quat(scalar_first=True):
        yield q, rng.normal(size=3)


def matrix(q):
    return Rotation.from_quat(q, scalar_first=True).as_matrix()


def quaternion_rate(q, omega):
    return 0.5 * np.concatenate(([-q[1:] @ omega], q[0] * omega + np.cross(q[1:], omega)))


def body_rate(x, torque):
    """Euler's equation of x = (q, ω)."""
    q, omega = x[:4], x[4:7]
    omega_dot = np.linalg.solve(INERTIA, torque - np.cross(omega, INERTIA @ omega))
    return np.concatenate((quaternion_rate(q, omega), omega_dot))


def tilt(q, q_d=UPRIGHT):
    return np.degrees(2.0 * np.arccos(min(1.0, abs(q @ q_d) / np.linalg.norm(q))))


def flown(controller, gains, x, seconds, q_d=UPRIGHT, disturbance=REST, rotor_limit=None, memory=None):
    """Run the controller at its period, the body by the midpoint rule; the path (ticks, 7) and the torques."""
    h, memory = 1e-3, memory or initial_memory(x[4:7])
    path, torques = [x], []
    for _ in range(round(seconds / h)):
        torque, memory = controller(x[:4].copy(), x[4:7].copy(), q_d, REST, REST, gains, memory)
        if rotor_limit is not None:
            torque = np.clip(torque, -rotor_limit, rotor_limit)
        acting = torque + disturbance
        x = x + h * body_rate(x + 0.5 * h * body_rate(x, acting), acting)
        x[:4] /= np.linalg.norm(x[:4])
        path.append(x)
        torques.append(torque)
    return np.array(path), np.array(torques)


@pytest.mark.parametrize(("controller", "gains"), ALL)
@pytest.mark.parametrize("axis", np.eye(3).tolist())
def test_torque_drives_the_error_back(controller, gains, axis):
    for sign in (1.0, -1.0):
        torque = torque_of(controller, gains, turn(axis, sign * 5.0), REST, UPRIGHT)
        assert sign * torque @ axis < -1e-3
        torque = torque_of(controller, gains, UPRIGHT, sign * np.array(axis), UPRIGHT)
        assert sign * torque @ axis < -1e-3


@pytest.mark.parametrize(("controller", "gains"), ALL[:2])
def test_small_errors_meet_the_stated_stiffness_and_damping(controller, gains):
    angle = np.array([2e-4, -1e-4, 3e-4])
    q = Rotation.from_rotvec(angle).as_quat(scalar_first=True)
    np.testing.assert_allclose(torque_of(controller, gains, q, REST, UPRIGHT), -KP * angle, rtol=1e-6, atol=1e-7)
    omega = 1e-6 * np.array([1.0, 2.0, -1.0])
    np.testing.assert_allclose(torque_of(controller, gains, UPRIGHT, omega, UPRIGHT), -KD * omega, rtol=1e-4)


@pytest.mark.parametrize(("controller", "gains"), ALL)
def test_torque_does_not_see_the_sign_of_a_quaternion(controller, gains):
    for (q, omega), (q_d, omega_d) in zip(attitudes(20), attitudes(20, seed=8), strict=True):
        one = torque_of(controller, gains, q, omega, q_d, omega_d)
        np.testing.assert_allclose(torque_of(controller, gains, -q, omega, q_d, omega_d), one, atol=1e-14)
        np.testing.assert_allclose(torque_of(controller, gains, q, omega, -q_d, omega_d), one, atol=1e-14)


@pytest.mark.parametrize(("controller", "gains"), ALL)
def test_torque_depends_on_the_relative_attitude_only(controller, gains):
    carry = Rotation.from_rotvec([0.4, -1.0, 2.0])
    for (q, omega), (q_d, omega_d) in zip(attitudes(20), attitudes(20, seed=8), strict=True):
        moved, moved_d = (
            (carry * Rotation.from_quat(a, scalar_first=True)).as_quat(scalar_first=True) for a in (q, q_d)
        )
        one = torque_of(controller, gains, q, omega, q_d, omega_d)
        np.testing.assert_allclose(torque_of(controller, gains, moved, omega, moved_d, omega_d), one, atol=1e-12)


@pytest.mark.parametrize(
    ("controller", "gains"),
    [
        (quaternion_pd, PD),
        (geometric, GEOMETRIC._replace(inertia=np.zeros((3, 3)))),
        (cascade, CASCADE._replace(rate_limit=np.full(3, 1e3), torque_limit=np.full(3, 1e3))),
    ],
)
def test_no_damping_of_a_body_that_turns_with_its_reference(controller, gains):
    for (q, _), (q_d, omega_d) in zip(attitudes(20), attitudes(20, seed=8), strict=True):
        omega = matrix(q).T @ matrix(q_d) @ omega_d
        moving = torque_of(controller, gains, q, omega, q_d, omega_d)
        np.testing.assert_allclose(moving, torque_of(controller, gains, q, REST, q_d), atol=1e-13)


@pytest.mark.parametrize(("controller", "gains"), ALL)
def test_no_torque_at_rest_on_the_reference(controller, gains):
    for q, _ in attitudes(10):
        torque, memory = controller(q, REST, q, REST, REST, gains, initial_memory(REST))
        np.testing.assert_allclose(torque, 0.0, atol=1e-15)
        np.testing.assert_allclose(memory.integral, 0.0, atol=1e-15)


@pytest.mark.parametrize(("controller", "gains"), ALL[:2])
def test_converges_from_any_attitude(controller, gains):
    for (q, omega), (q_d, _) in zip(attitudes(8), attitudes(8, seed=8), strict=True):

        def rate(_, x, q_d=q_d):
            return body_rate(x, torque_of(controller, gains, x[:4], x[4:7], q_d))

        run = solve_ivp(rate, (0.0, 3.0), np.concatenate((q, omega)), method="RK45", rtol=1e-6, atol=1e-9)
        assert tilt(run.y[:4, -1], q_d) < 0.1
        assert np.linalg.norm(run.y[4:, -1]) < 1e-2


def test_cascade_converges_from_any_attitude():
    for q, omega in attitudes(3):
        path, torques = flown(cascade, CASCADE, np.concatenate((q, omega)), 3.0)
        assert tilt(path[-1, :4]) < 0.5
        assert np.linalg.norm(path[-1, 4:]) < 2e-2
        assert (np.abs(torques) <= CASCADE.torque_limit).all()


def test_pd_takes_the_short_way_round():
    """Unwinding control: from −q next to the reference a law without sgn would turn by almost 360°."""
    start = np.concatenate((-turn([1.0, 0.0, 0.0], 20.0), REST))
    path, _ = flown(quaternion_pd, PD, start, 1.0)
    assert max(tilt(x[:4]) for x in path) < 20.1
    half_turn = torque_of(quaternion_pd, PD, turn([0.0, 1.0, 0.0], 179.9), REST, UPRIGHT)
    np.testing.assert_allclose(half_turn, [0.0, -2.0 * KP[1], 0.0], atol=1e-5)


def geometric_energy(q, omega, q_d, omega_d):
    """Ψ + ½ ω_eᵀJω_e with Ψ = ½ tr(G(I − R_e)) and G such that the stiffness at rest is KP."""
    G = np.diag(np.linalg.solve(0.5 * (np.ones((3, 3)) - np.eye(3)), KP))
    R_e = matrix(q_d).T @ matrix(q)
    omega_e = omega - R_e.T @ omega_d
    return 0.5 * np.trace(G @ (np.eye(3) - R_e)) + 0.5 * omega_e @ INERTIA @ omega_e


@pytest.mark.parametrize("feed_forward", [True, False])
def test_geometric_energy_falls_by_the_damping_alone(feed_forward):
    gains = GEOMETRIC if feed_forward else GEOMETRIC._replace(inertia=np.zeros((3, 3)))
    gaps = []
    for (q, omega), (q_d, omega_d) in zip(attitudes(50), attitudes(50, seed=8), strict=True):
        omega_dot_d, h = np.array([3.0, -2.0, 1.0]), 1e-3
        torque = torque_of(geometric, gains, q, omega, q_d, omega_d, omega_dot_d)
        x = np.concatenate((q, omega, q_d, omega_d))
        dx = np.concatenate((body_rate(x, torque), quaternion_rate(q_d, omega_d), omega_dot_d))
        ahead, behind = ([np.split(x + s * k * h * dx, (4, 7, 11)) for k in (1.0, 2.0)] for s in (1.0, -1.0))
        near, far = (geometric_energy(*a) - geometric_energy(*b) for a, b in zip(ahead, behind, strict=True))
        omega_e = omega - (matrix(q_d).T @ matrix(q)).T @ omega_d
        gaps.append(abs((8.0 * near - far) / (12.0 * h) + omega_e @ (KD * omega_e)))
    assert max(gaps) < 1e-8 if feed_forward else np.median(gaps) > 1e-3


def test_geometric_is_eulers_equation_on_a_moving_reference():
    for q, omega in attitudes(10):
        omega_dot = np.array([3.0, -2.0, 1.0])
        torque = torque_of(geometric, GEOMETRIC, q, omega, q, omega, omega_dot)
        np.testing.assert_allclose(torque, INERTIA @ omega_dot + np.cross(omega, INERTIA @ omega), atol=1e-14)


@pytest.mark.parametrize("degrees", [30.0, 90.0, 150.0])
def test_geometric_error_about_one_axis_is_the_sine(degrees):
    torque = torque_of(geometric, GEOMETRIC, turn([0.0, 0.0, 1.0], degrees), REST, UPRIGHT)
    np.testing.assert_allclose(torque, [0.0, 0.0, -KP[2] * np.sin(np.radians(degrees))], atol=1e-14)


@pytest.mark.parametrize(("controller", "gains"), ALL[:2])
def test_cascade_takes_over_from_a_controller_without_memory(controller, gains):
    wound_up = AttitudeMemory(np.array([1.0, 2.0, 3.0]), np.array([4.0, 5.0, 6.0]))
    q, omega = turn([1.0, 0.0, 0.0], 9.0), np.array([0.1, 0.2, -0.3])
    _, handed_over = controller(q, omega, UPRIGHT, REST, REST, gains, wound_up)
    torque, _ = cascade(q, omega, UPRIGHT, REST, REST, CASCADE, handed_over)
    np.testing.assert_array_equal(torque, torque_of(cascade, CASCADE, q, omega, UPRIGHT))


def test_cascade_leaves_the_memory_that_it_was_given_alone():
    memory = initial_memory(np.ones(3))
    cascade(turn([1.0, 0.0, 0.0], 9.0), REST, UPRIGHT, REST, REST, CASCADE, memory)
    np.testing.assert_array_equal(memory.integral, np.zeros(3))
    np.testing.assert_array_equal(memory.rate, np.ones(3))


@pytest.mark.parametrize("integrates", [True, False])
def test_cascade_integrator_removes_a_constant_disturbance(integrates):
    gains = CASCADE if integrates else CASCADE._replace(ki=np.zeros(3))
    start = np.concatenate((UPRIGHT, REST))
    path, _ = flown(cascade, gains, start, 3.0, disturbance=np.array([0.05, -0.05, 0.02]))
    assert tilt(path[-1, :4]) < 0.1 if integrates else tilt(path[-1, :4]) > 3.0


def test_cascade_anti_windup_spares_the_overshoot():
    """Held at the rotors' limit by a load for 1 s; without the limit in its gains the integrator winds up meanwhile."""
    limit, load = CASCADE.torque_limit, np.array([0.4, 0.0, 0.0])
    unaware = CASCADE._replace(torque_limit=np.full(3, np.inf))
    wound = {}
    for name, gains in (("aware", CASCADE), ("unaware", unaware)):
        memory, q, omega = initial_memory(REST), turn([1.0, 0.0, 0.0], 40.0), REST
        for _ in range(1000):
            torque, memory = cascade(q, omega, UPRIGHT, REST, REST, gains, memory)
            assert (np.clip(torque, -limit, limit) + load)[0] > 0.0
        path, _ = flown(cascade, gains, np.concatenate((q, omega)), 2.0, rotor_limit=limit, memory=memory)
        wound[name] = abs(memory.integral[0]), -min(2.0 * np.degrees(np.arcsin(path[:, 1])))
    assert wound["aware"][0] < limit[0]
    assert wound["unaware"][0] > 2.0 * limit[0]
    assert wound["unaware"][1] > 2.0 * wound["aware"][1] + 5.0


def test_cascade_integrates_again_as_soon_as_the_error_turns():
    memory = AttitudeMemory(np.array([-2.0, 0.0, 0.0]), np.zeros(3))
    q = turn([1.0, 0.0, 0.0], -10.0)
    torque, after = cascade(q, REST, UPRIGHT, REST, REST, CASCADE, memory)
    assert torque[0] == -CASCADE.torque_limit[0]
    assert after.integral[0] > memory.integral[0]


def test_cascade_limits_the_rate_it_asks_for():
    gains = CASCADE._replace(ki=np.zeros(3), torque_limit=np.full(3, 10.0))
    start = np.concatenate((turn([1.0, 0.0, 0.0], 170.0), REST))
    path, _ = flown(cascade, gains, start, 1.0)
    assert -gains.rate_limit[0] * 1.001 < path[:, 4].min() < -0.95 * gains.rate_limit[0]


def test_cascade_derivative_sees_the_body_and_not_a_jump_of_the_reference():
    gains = CASCADE._replace(torque_limit=np.full(3, 10.0), rate_limit=np.full(3, 100.0))
    jump = turn([1.0, 0.0, 0.0], -60.0)
    with_d = torque_of(cascade, gains, UPRIGHT, REST, jump)
    without_d = torque_of(cascade, gains._replace(kd=np.zeros(3)), UPRIGHT, REST, jump)
    np.testing.assert_array_equal(with_d, without_d)


def test_cascade_derivative_is_the_angular_acceleration_after_the_filter_has_settled():
    gains = CASCADE._replace(k_angle=np.zeros(3), kp=np.zeros(3), ki=np.zeros(3), torque_limit=np.full(3, 10.0))
    acceleration, memory = np.array([20.0, -10.0, 5.0]), initial_memory(REST)
    settled = []
    for tick in range(1, 41):
        omega = acceleration * tick * gains.period
        torque, memory = cascade(UPRIGHT, omega, UPRIGHT, REST, REST, gains, memory)
        settled.append(torque[0] / (-gains.kd[0] * acceleration[0]))
    # One time constant, counted in samples of a backward difference, leaves (τ/(τ + T))^n of the step.
    remaining = gains.filter_time / (gains.filter_time + gains.period)
    np.testing.assert_allclose(settled, 1.0 - remaining ** np.arange(1, 41), rtol=1e-9)


def test_x6_feed_forward_cancels_the_moment_of_a_force_at_the_pivot():
    lever, limit = np.array([0.01, -0.02, -0.06]), np.full(3, 5.0)
    for turn, force in zip(Rotation.random(10, rng=3), np.random.default_rng(3).normal(size=(10, 3)), strict=True):
        R = turn.as_matrix()
        torque = feed_forward(R, force, lever, limit)
        np.testing.assert_allclose(torque + np.cross(lever, R.T @ force), 0.0, atol=1e-12)
    clipped = feed_forward(np.eye(3), np.array([100.0, -100.0, 0.0]), lever, np.array([0.1, 0.2, 0.3]))
    np.testing.assert_array_equal(np.abs(clipped), [0.1, 0.2, 0.3])
