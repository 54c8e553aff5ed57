"""The arm model against Pinocchio reading the same file, and against what any mechanism must satisfy."""

import mujoco
import numpy as np
import pinocchio as pin
import pytest

from armland.models.arm import ArmModel
from armland.models.arm_file.reading import read_arm
from armland.models.arm_file.table import Asked
from armland.models.description import mark_end_effector, read_spec
from armland.models.operational import PIVOT_THRESHOLD
from armland.rotations import from_rotation_vector, matrix

STEP = 1e-5
"""Step of finite differences along q; central, so the error is of order STEP²."""


def deviation(bench, name, states, tool):
    """Largest deviations from Pinocchio over random states: M, bias, gravity, Jacobian, pose."""
    arm, twin = bench(name, tool).arm, bench(name, tool).twin
    worst = np.zeros(5)
    for q, qd in states(arm, 50):
        arm.update(q, qd)
        position, rotation = twin.pose(q)
        worst = np.maximum(
            worst,
            [
                np.abs(arm.mass_matrix - twin.mass_matrix(q)).max(),
                np.abs(arm.bias - twin.bias(q, qd)).max(),
                np.abs(arm.gravity - twin.gravity(q)).max(),
                np.abs(arm.jacobian - twin.jacobian(q)).max(),
                max(np.abs(arm.position - position).max(), np.abs(arm.rotation - rotation).max()),
            ],
        )
    return worst


@pytest.mark.parametrize("tool", [False, True], ids=["bare", "tool"])
def test_eq1_mass_matrix_bias_gravity_and_jacobian_agree_with_pinocchio(bench, arm_name, states, tool):
    assert deviation(bench, arm_name, states, tool).max() < 1e-9


def test_eq3_velocity_terms_agree_with_pinocchio(bench, arm_name, states):
    """C φ̇ and 𝒥̇ φ̇, which only some laws need."""
    arm, twin = bench(arm_name, tool=True).arm, bench(arm_name, tool=True).twin
    for q, qd in states(arm, 50, seed=11):
        arm.qpos[:], arm.qvel[:] = q, qd
        arm.refresh(velocity_terms=True)
        np.testing.assert_allclose(arm.state["coriolis"][0], twin.bias(q, qd) - twin.gravity(q), atol=1e-9)
        np.testing.assert_allclose(arm.state["acceleration_bias"][0], twin.acceleration_bias(q, qd), atol=1e-9)


def test_eq1_comparison_notices_the_tool(bench, states):
    """Negative control: the arm without tool against Pinocchio with it."""
    arm, twin = bench("lwr4").arm, bench("lwr4", tool=True).twin
    q, qd = next(states(arm, 1))
    arm.update(q, qd)
    for ours, theirs in (
        (arm.mass_matrix, twin.mass_matrix(q)),
        (arm.bias, twin.bias(q, qd)),
        (arm.gravity, twin.gravity(q)),
        (arm.jacobian, twin.jacobian(q)),
    ):
        assert np.abs(ours - theirs).max() > 1e-3


def test_arm_reads_ranges_and_torque_limits(bench):
    arm = bench("fixed frames between").arm
    moving = [i for i, kind in enumerate("FRRFRFRRFFRFF") if kind == "R"]
    assert arm.joint_names == tuple(f"joint_{i}" for i in moving)
    np.testing.assert_allclose(arm.q_min, [-2.0 - 0.1 * i for i in moving])
    np.testing.assert_allclose(arm.q_max, [1.5 + 0.1 * i for i in moving])
    np.testing.assert_allclose(arm.tau_max, [50.0 + i for i in moving])
    endless = bench("slide and endless joint").arm
    # What the file does not name is neither zero nor infinite.
    np.testing.assert_allclose([endless.q_min[2], endless.q_max[2]], [-2.0 * np.pi, 2.0 * np.pi])
    assert 50.0 < endless.tau_max[2] < 1000.0


def test_eq1_mass_matrix_is_symmetric_and_positive_definite(bench, arm_name, states):
    arm = bench(arm_name, tool=True).arm
    for q, qd in states(arm, 50, seed=1):
        arm.update(q, qd)
        np.testing.assert_array_equal(arm.mass_matrix, arm.mass_matrix.T)
        assert np.linalg.eigvalsh(arm.mass_matrix)[0] > 1e-6


def velocity_torque(arm, q, qd):
    arm.update(q, qd)
    return arm.bias - arm.gravity


def christoffel_times(arm, q, qd, b):
    """C(φ, φ̇) b with C of Christoffel symbols, by polarising the velocity-product torque."""
    return 0.5 * (velocity_torque(arm, q, qd + b) - velocity_torque(arm, q, qd) - velocity_torque(arm, q, b))


def test_eq1_mass_matrix_rate_less_twice_coriolis_is_skew_symmetric(bench, arm_name, states):
    """bᵀ(Ṁ − 2C)b = 0 for any b, Ṁ by finite differences: the arm makes no energy of its own."""
    arm = bench(arm_name).arm
    rng = np.random.default_rng(7)
    for q, qd in states(arm, 10, seed=2):
        b = rng.normal(size=arm.joints)
        ahead, behind = (_mass(arm, q + sign * STEP * qd) for sign in (1, -1))
        rate = (ahead - behind) / (2.0 * STEP)
        coriolis = christoffel_times(arm, q, qd, b)
        assert b @ rate @ b - 2.0 * b @ coriolis == pytest.approx(0.0, abs=1e-6 * (1.0 + abs(b @ rate @ b)))
        # Negative control: for b other than φ̇ the torque C(φ, b) b alone does not balance Ṁ.
        assert abs(b @ rate @ b - 2.0 * b @ velocity_torque(arm, q, b)) > 1e-6


def _mass(arm, q):
    arm.update(q, np.zeros(arm.joints))
    return arm.mass_matrix.copy()


def potential_energy(arm, q):
    """Σ m g z over the bodies' centres of mass."""
    data = mujoco.MjData(arm.model)
    data.qpos[:] = q
    mujoco.mj_kinematics(arm.model, data)
    return float(arm.model.body_mass @ data.xipos[:, 2]) * 9.81


def test_eq1_gravity_is_the_gradient_of_potential_energy(bench, arm_name, states):
    arm = bench(arm_name, tool=True).arm
    for q, qd in states(arm, 10, seed=3):
        gradient = [
            (potential_energy(arm, q + STEP * e) - potential_energy(arm, q - STEP * e)) / (2.0 * STEP)
            for e in np.eye(arm.joints)
        ]
        arm.update(q, qd)
        np.testing.assert_allclose(arm.gravity, gradient, atol=1e-6)


def test_jacobian_is_the_derivative_of_the_end_effector_pose(bench, arm_name, states):
    arm = bench(arm_name, tool=True).arm
    still = np.zeros(arm.joints)
    for q, _ in states(arm, 10, seed=4):
        for i, e in enumerate(np.eye(arm.joints)):
            arm.update(q + STEP * e, still)
            p1, R1 = arm.position.copy(), arm.rotation.copy()
            arm.update(q - STEP * e, still)
            turn = R1 @ arm.rotation.T
            spin = 0.5 * np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
            difference = np.concatenate([p1 - arm.position, spin]) / (2.0 * STEP)
            arm.update(q, still)
            np.testing.assert_allclose(arm.jacobian[:, i], difference, atol=1e-8)


def test_stretched_arm_weighs_what_identified_models_say(bench):
    """Identified LWR models agree on about 47 N·m on A2 and 13 N·m on A3, arm stretched out horizontally, no tool."""
    arm = bench("lwr4").arm
    q = np.zeros(7)
    q[1] = np.pi / 2
    arm.update(q, np.zeros(7))
    torque = dict(zip(arm.joint_names, np.abs(arm.gravity), strict=True))
    assert 44.0 <= torque["A2"] <= 48.0
    assert torque["A3"] == pytest.approx(13.0, abs=0.5)
    assert torque["A1"] == pytest.approx(0.0, abs=1e-9)


def mobility(arm):
    return arm.jacobian @ np.linalg.inv(arm.mass_matrix) @ arm.jacobian.T


def regular(arm):
    """Whether Λ needs no damping here; the smallest eigenvalue is below every pivot."""
    return np.linalg.eigvalsh(mobility(arm))[0] > 1.5 * PIVOT_THRESHOLD


def test_eq4_pseudo_kinetic_energy_matrix_is_the_inverse_of_the_mobility(bench, arm_name, states):
    arm = bench(arm_name, tool=True).arm
    compared = 0
    for q, qd in states(arm, 300, seed=5):
        arm.update(q, qd)
        if regular(arm):
            inverse = np.linalg.inv(mobility(arm))
            np.testing.assert_allclose(arm.lambda_ee, inverse, rtol=1e-8, atol=1e-8 * np.abs(inverse).max())
            compared += 1
    assert compared >= 10


def test_eq3_coriolis_wrench_holds_the_twist(bench, arm_name, states):
    """Under τ = g + 𝒥ᵀ μ ẋ an arm that moves with φ̇ = 𝒥̄ ẋ keeps its twist; the acceleration is Pinocchio's."""
    at = bench(arm_name, tool=True)
    arm, twin = at.arm, at.twin
    rng = np.random.default_rng(8)
    tried = 0
    for q, qd in states(arm, 200, seed=6):
        arm.update(q, qd)
        if not regular(arm):
            continue
        twist = rng.normal(scale=[0.5, 0.5, 0.5, 1.0, 1.0, 1.0])
        qd = np.linalg.solve(arm.mass_matrix, arm.jacobian.T @ arm.lambda_ee @ twist)
        arm.update(q, qd)
        np.testing.assert_allclose(arm.jacobian @ qd, twist, atol=1e-9)
        wrench = arm.coriolis_wrench(twist)
        _, acceleration = twin.acceleration(q, qd, arm.gravity + arm.jacobian.T @ wrench)
        np.testing.assert_allclose(acceleration, 0.0, atol=1e-7 * (1.0 + np.abs(qd).max() ** 2))
        # Negative control: without the wrench the twist changes.
        _, drifting = twin.acceleration(q, qd, arm.gravity)
        assert np.abs(drifting).max() > 1e-3
        tried += 1
    assert tried >= 5


def test_eq3_rate_of_the_pseudo_kinetic_energy_matrix_less_twice_mu_is_skew_symmetric(bench, arm_name, states):
    """xᵀ(Λ̇ − 2μ)x = 0 for any twist x and any φ̇, Λ̇ by finite differences."""
    arm = bench(arm_name).arm
    rng = np.random.default_rng(9)
    tried = 0
    for q, qd in states(arm, 200, seed=7):
        arm.update(q, qd)
        if not regular(arm):
            continue
        x = rng.normal(size=6)
        power = x @ arm.coriolis_wrench(x)
        arm.update(q + STEP * qd, qd)
        ahead = x @ arm.lambda_ee @ x
        arm.update(q - STEP * qd, qd)
        rate = (ahead - x @ arm.lambda_ee @ x) / (2.0 * STEP)
        assert rate == pytest.approx(2.0 * power, abs=1e-5 * (1.0 + abs(rate)))
        tried += 1
    assert tried >= 5


def test_coriolis_wrench_leaves_the_model_as_it_was(bench, states):
    arm = bench("lwr4").arm
    q, qd = next(states(arm, 1))
    arm.update(q, qd)
    before = arm.bias.copy(), arm.mass_matrix.copy(), arm.jacobian.copy()
    arm.coriolis_wrench(np.ones(6))
    for then, now in zip(before, (arm.bias, arm.mass_matrix, arm.jacobian), strict=True):
        np.testing.assert_array_equal(then, now)


def test_default_armature_adds_to_the_mass_matrix_where_there_is_none(bench, states):
    file = read_arm(bench("six joints").path, Asked("tip", armature=0.1))
    spec = file.spec()
    mark_end_effector(spec, file.frame, None)
    spec.joints[2].armature = 0.03
    arm, bare = ArmModel(spec), bench("six joints").arm
    q, qd = next(states(bare, 1))
    arm.update(q, qd)
    bare.update(q, qd)
    added = [0.1, 0.1, 0.03, 0.1, 0.1, 0.1]
    np.testing.assert_allclose(arm.mass_matrix - bare.mass_matrix, np.diag(added), atol=1e-12)


def test_scaled_model_scales_masses_and_inertias_but_not_lengths(bench, states):
    spec = read_spec(bench("lwr4").path)
    mark_end_effector(spec, "flange", None)
    heavy, arm = ArmModel(spec, inertia_scale=1.2), bench("lwr4").arm
    for q, qd in states(arm, 5):
        arm.update(q, qd)
        heavy.update(q, qd)
        np.testing.assert_allclose(heavy.mass_matrix, 1.2 * arm.mass_matrix, rtol=1e-12, atol=1e-13)
        np.testing.assert_allclose(heavy.bias, 1.2 * arm.bias, rtol=1e-9, atol=1e-12)
        np.testing.assert_allclose(heavy.gravity, 1.2 * arm.gravity, rtol=1e-9, atol=1e-12)
        np.testing.assert_array_equal(heavy.jacobian, arm.jacobian)


def test_end_effector_turns_with_the_last_joint(bench):
    """A hand-worked pose: stretched upwards, the LWR's flange is at 0.11 + 0.2005 + 0.2 + 0.2 + 0.2 + 0.19 + 0.078 m."""
    arm = bench("lwr4").arm
    q = np.zeros(7)
    q[6] = 0.7
    arm.update(q, np.zeros(7))
    np.testing.assert_allclose(arm.position, [0.0, 0.0, 1.1785], atol=1e-12)
    np.testing.assert_allclose(arm.rotation, matrix(from_rotation_vector(np.array([0.0, 0.0, 0.7]))), atol=1e-12)


def test_pinocchio_reads_the_reflected_inertia(bench):
    """The comparison covers the armature: Pinocchio has it from the same file."""
    model = bench("lwr4").twin.model
    assert isinstance(model, pin.Model)
    np.testing.assert_allclose(model.armature, 0.1)
