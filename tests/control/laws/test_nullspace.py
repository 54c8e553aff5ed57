"""The null space's wishes: fields with a potential, and damping."""

import numpy as np
import pytest

from armland.control.laws.nullspace import elbow_field, null_space_wish, range_field
from armland.control.laws.realisation import told_layout
from armland.models.arm import ArmModel
from armland.models.description import ASSETS

ELBOW = 3
STEP = 1e-6


@pytest.fixture(scope="module")
def arm():
    return ArmModel.load(ASSETS / "lwr4.xml", "flange")


def ranged(q, low, high):
    tau = np.zeros(len(q))
    range_field(q, low, high, 0.25, 20.0, tau)
    return tau


def random_states(arm, count):
    rng = np.random.default_rng(4)
    for _ in range(count):
        yield rng.uniform(arm.q_min, arm.q_max)


def height(arm, q):
    arm.update(q, np.zeros(arm.joints))
    return arm.anchor[ELBOW, 2]


def test_elbow_field_is_the_weight_of_a_load_at_the_elbow(arm):
    """τ₀ = −∂(F z_elbow)/∂q by finite differences."""
    for q in random_states(arm, 20):
        gradient = [(height(arm, q + STEP * e) - height(arm, q - STEP * e)) / (2.0 * STEP) for e in np.eye(arm.joints)]
        arm.update(q, np.zeros(arm.joints))
        field = np.zeros(arm.joints)
        elbow_field(arm.axis, arm.anchor, ELBOW, 5.0, field)
        np.testing.assert_allclose(field, -5.0 * np.array(gradient), atol=1e-8)
        # The elbow's own joint and those beyond it do not move it.
        np.testing.assert_array_equal(field[ELBOW:], 0.0)


def test_range_field_is_a_spring_that_begins_at_the_margin():
    low, high = np.array([-2.0, -2.0, -2.0, -2.0]), np.array([2.0, 2.0, 2.0, 2.0])
    q = np.array([-1.9, 1.85, 0.0, 1.75])
    np.testing.assert_allclose(ranged(q, low, high), [20.0 * 0.15, -20.0 * 0.10, 0.0, 0.0], atol=1e-12)


def test_range_field_becomes_a_wall_in_the_last_third_of_the_margin():
    """Eleven times as stiff from 0.25/3 rad on, without a jump; the same at both ends."""
    low, high = np.array([-1.0]), np.array([1.0])

    def push(gap):
        return ranged(low + gap, low, high)[0]

    third = 0.25 / 3.0
    assert push(third) == pytest.approx(20.0 * 2.0 * third, rel=1e-9)
    assert push(third - 0.01) - push(third) == pytest.approx(20.0 * 11.0 * 0.01, rel=1e-9)
    assert push(third + 0.01) - push(third) == pytest.approx(-20.0 * 0.01, rel=1e-9)
    assert ranged(high - 0.02, low, high)[0] == pytest.approx(-push(0.02), rel=1e-12)


def test_range_field_of_an_endless_joint_is_nothing():
    ends = np.array([np.inf])
    assert ranged(np.array([50.0]), -ends, ends)[0] == 0.0


def test_range_field_does_no_work_around_a_loop():
    """It has a potential: along a path out of the range and back the work is zero."""
    low, high = np.full(2, -1.0), np.full(2, 1.0)
    angles = np.linspace(0.0, 2.0 * np.pi, 4001)
    path = 1.2 * np.column_stack([np.cos(angles), np.sin(angles)])
    middle, steps = 0.5 * (path[1:] + path[:-1]), np.diff(path, axis=0)
    work = sum(ranged(q, low, high) @ d for q, d in zip(middle, steps, strict=True))
    assert work == pytest.approx(0.0, abs=1e-6)


def test_wish_is_both_fields_and_a_damper(arm):
    p, q, qd = np.zeros(1, told_layout(arm.joints)), np.full(7, 0.3), np.linspace(-1.0, 1.0, 7)
    p["q_min"], p["q_max"], p["elbow"], p["elbow_force"] = arm.q_min, arm.q_max, ELBOW, 5.0
    p["null_damping"], p["range_margin"], p["range_stiffness"] = 2.0, 0.25, 20.0
    p["q_max"][0, 2] = 0.4
    arm.update(q, qd)
    still = null_space_wish(q, np.zeros(7), arm.state[0], p[0])
    np.testing.assert_allclose(null_space_wish(q, qd, arm.state[0], p[0]) - still, -2.0 * qd)
    elbow = np.zeros(7)
    elbow_field(arm.axis, arm.anchor, ELBOW, 5.0, elbow)
    expected = elbow + 20.0 * np.where(np.arange(7) == 2, 0.4 - 0.25 - 0.3, 0.0)
    np.testing.assert_allclose(still, expected)


def test_posture_draws_back_as_a_critically_damped_joint_space_of_any_inertia(arm):
    """M⁻¹ of what it adds is ω² (q₀ − q) − 2 ω φ̇; without a bandwidth it adds nothing."""
    rng = np.random.default_rng(6)
    p = np.zeros(1, told_layout(arm.joints))
    p["q_min"], p["q_max"] = -np.inf, np.inf
    home = rng.uniform(-0.5, 0.5, arm.joints)
    p["posture"] = home
    for q in random_states(arm, 5):
        qd = rng.normal(size=arm.joints)
        arm.update(q, qd)
        p["posture_rate"] = 0.0
        without = null_space_wish(q, qd, arm.state[0], p[0])
        p["posture_rate"] = 6.0
        added = null_space_wish(q, qd, arm.state[0], p[0]) - without
        np.testing.assert_allclose(np.linalg.solve(arm.mass_matrix, added), 36.0 * (home - q) - 12.0 * qd, atol=1e-6)
