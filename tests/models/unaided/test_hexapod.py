"""Six legs: their lengths by hand, their speeds by differences, their pose back from their lengths."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armland.models.unaided.hexapod import attitude, joints_of, leg_rates, legs, pose

MIDDLE = np.array([0.62, 0.0, 0.45])
FEET, HEADS = joints_of(0.55, 0.35, 0.04)
FEET = FEET + [0.62, 0.0, 0.0]
POSES = [
    np.zeros(6),
    np.array([0.05, -0.03, 0.08, 0.1, -0.12, 0.09]),
    np.array([-0.08, 0.06, -0.1, -0.2, 0.15, 0.18]),
]


@pytest.mark.parametrize("x", POSES)
def test_attitude_is_yaw_pitch_roll(x):
    np.testing.assert_allclose(attitude(x), Rotation.from_euler("ZYX", x[3:]).as_matrix(), atol=1e-12)


def test_eq_h1_in_the_neutral_pose_all_legs_are_as_long():
    lengths = legs(np.zeros(6), MIDDLE, FEET, HEADS)
    np.testing.assert_allclose(lengths, lengths[0])
    # Foot and head of a leg are 60° less a pair's angle apart on circles of 0.55 and 0.35 m, 0.41 m above each other.
    apart = np.pi / 3.0 - 0.35
    assert lengths[0] == pytest.approx(np.sqrt(0.55**2 + 0.35**2 - 2 * 0.55 * 0.35 * np.cos(apart) + 0.41**2))


@pytest.mark.parametrize("x", POSES)
def test_eq_h1_is_the_distance_from_foot_to_head(x):
    R = Rotation.from_euler("ZYX", x[3:]).as_matrix()
    ends = MIDDLE + x[:3] + HEADS @ R.T
    np.testing.assert_allclose(legs(x, MIDDLE, FEET, HEADS), np.linalg.norm(ends - FEET, axis=1), atol=1e-12)


@pytest.mark.parametrize("x", POSES)
def test_eq_h2_is_the_derivative(x):
    step = 1e-6
    J = np.stack(
        [
            (legs(x + step * e, MIDDLE, FEET, HEADS) - legs(x - step * e, MIDDLE, FEET, HEADS)) / (2.0 * step)
            for e in np.eye(6)
        ],
        axis=1,
    )
    np.testing.assert_allclose(leg_rates(x, MIDDLE, FEET, HEADS), J, atol=1e-8)


@pytest.mark.parametrize("x", POSES)
def test_pose_comes_back_from_the_lengths(x):
    lengths = legs(x, MIDDLE, FEET, HEADS)
    np.testing.assert_allclose(pose(lengths, np.zeros(6), MIDDLE, FEET, HEADS), x, atol=1e-8)


def test_platform_is_stiff_where_it_stands():
    # No pose in its room is singular: a leg's speed always says which way the platform moves.
    worst = min(np.linalg.svd(leg_rates(x, MIDDLE, FEET, HEADS), compute_uv=False)[-1] for x in POSES)
    assert worst > 0.02
