"""What the commanded torques do to the arm, by Pinocchio's forward dynamics: (35) with its switches, and (X.2).

The torques act on the arm alone, without the UAV, in random states around a home pose. Then the end effector accelerates by Λ⁻¹
times the wrench that is wanted, beyond what it does under gravity compensation alone; the null-space torque must not show.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from armland.control.laws.realisation import elbow_of, held_acceleration
from armland.control.laws.rigid_body import UavParameters
from armland.errors import ConfigurationError
from armland.models.environment import DOWN
from armland.scenario import load_scenario

R_E, R_A = np.array([0.01, -0.02, 0.03]), np.array([0.4, -0.3, 0.2])


def test_eq35_is_the_laws_force_and_the_orientation_controller(bench, states):
    for q, qd in states:
        found = bench.run(q=q, qd=qd, r_e=R_E)
        twist = bench.arm.jacobian @ qd
        turn = (Rotation.from_matrix(bench.R_d) * Rotation.from_matrix(bench.arm.rotation).inv()).as_rotvec()
        expected = np.concatenate([found.force, 25.0 * turn - 7.0 * twist[3:]])
        np.testing.assert_allclose(bench.wrench(found, q, qd), expected, atol=1e-6)


def test_eq35_reference_acceleration_is_added_and_nothing_else(bench, dynamics, states):
    for q, qd in states:
        without, with_ = (bench.run(q=q, qd=qd, r_a=R_A, acceleration=a) for a in ("none", "reference"))
        more = dynamics.acceleration(q, qd, with_.tau) - dynamics.acceleration(q, qd, without.tau)
        np.testing.assert_allclose(more, [*R_A, 0.0, 0.0, 0.0], atol=1e-8)


def test_x2_with_velocity_terms_the_end_effector_has_just_the_acceleration_that_is_implied(bench, dynamics, states):
    """Beyond the wrench's own share: Λ r̈_p with C φ̇ and 𝒥̇ φ̇ made up for; without them the drift would remain."""
    for q, qd in states:
        qd = 5.0 * qd
        found = bench.run("exact", q=q, qd=qd, r_e=R_E, acceleration="implied")
        twist, turn = bench.arm.jacobian @ qd, Rotation.from_matrix(bench.arm.rotation).inv()
        torque = 25.0 * (Rotation.from_matrix(bench.R_d) * turn).as_rotvec() - 7.0 * twist[3:]
        pushed = dynamics.mobility(q) @ np.concatenate([found.force, torque])
        acceleration = dynamics.acceleration(q, qd, found.tau) - pushed
        np.testing.assert_allclose(acceleration, [*found.implied, 0.0, 0.0, 0.0], atol=1e-7)
        assert np.abs(dynamics.acceleration(q, qd, dynamics.gravity(q))).max() > 0.02


def test_eq35_mu_times_the_desired_twist_is_a_wrench_like_any_other(bench, states):
    q, qd = states[0]
    mu = np.array([1.0, -2.0, 0.5, 0.1, 0.2, -0.1])
    more = bench.wrench(bench.run(q=q, qd=qd, mu=mu), q, qd) - bench.wrench(bench.run(q=q, qd=qd), q, qd)
    np.testing.assert_allclose(more, mu, atol=1e-6)


def test_null_space_pulls_the_elbow_down_and_does_not_move_the_end_effector(bench, dynamics):
    found, q = bench.run(), bench.home
    null = found.tau - dynamics.gravity(q) - dynamics.jacobian(q).T @ bench.wrench(found)
    assert np.abs(null).max() > 0.05
    qdd = np.linalg.solve(bench.arm.mass_matrix, null)
    np.testing.assert_allclose(dynamics.jacobian(q) @ qdd, 0.0, atol=1e-9)
    elbow, arm = int(bench.act["elbow"][0]), bench.arm
    raises = np.cross(arm.axis[:elbow], arm.anchor[elbow] - arm.anchor[:elbow])[:, 2]
    assert raises @ qdd[:elbow] < 0.0


def test_x2_held_acceleration_is_that_of_an_integrated_bodys_pivot():
    """A body that turns steadily under a constant force, by DOP853; its pivot's velocity differentiated."""
    uav = UavParameters(0.48, np.diag([0.006, 0.007, 0.012]), np.array([0.004, -0.007, -0.06]))
    rng, h = np.random.default_rng(4), 2e-3
    for turn in Rotation.random(5, rng=rng):
        omega, v, force = rng.normal(size=(3, 3))
        start = Rotation.from_matrix(turn.as_matrix())

        def pivot_velocity(t, start=start, omega=omega, v=v, force=force):
            fall = solve_ivp(lambda *_: force / 0.48 + DOWN, (0.0, t), v, method="DOP853", rtol=1e-12).y[:, -1]
            return fall + (start * Rotation.from_rotvec(omega * t)).apply(np.cross(omega, uav.lever))

        near, far = (pivot_velocity(s * h) - pivot_velocity(-s * h) for s in (1.0, 2.0))
        found = held_acceleration(turn.as_matrix(), omega, force, uav, DOWN)
        np.testing.assert_allclose(found, (8.0 * near - far) / (12.0 * h), rtol=1e-7, atol=1e-7)


def test_elbow_is_the_one_that_is_named_or_the_middle_one(bench):
    scenario = load_scenario("paper")
    assert bench.arm.joint_names[elbow_of(scenario, bench.arm)] == "A3"
    assert elbow_of(scenario.replaced({"arm": {"elbow_joint": None}}), bench.arm) == 3
    with pytest.raises(ConfigurationError, match=r"no joint 'elbow'; its joints are: A1"):
        elbow_of(scenario.replaced({"arm": {"elbow_joint": "elbow"}}), bench.arm)
