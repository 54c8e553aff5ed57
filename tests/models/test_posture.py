"""Home poses and reachability: what is found holds the end effector upright, what is refused says how far or which joint."""

import numpy as np
import pytest

from armland.errors import ConfigurationError, WorkspaceError
from armland.models.parameters import arm_model
from armland.models.posture import REACHED_M, check_path, home_poses, lead, pose, upright
from armland.scenario import load_scenario

START = np.array([0.58, 0.0, 0.74])
ELBOW = 3


@pytest.fixture(scope="module")
def arm():
    return arm_model(load_scenario("paper"))


@pytest.fixture(scope="module")
def homes(arm):
    return home_poses(arm, START, None, ELBOW)


def place(arm, q):
    arm.update(q, np.zeros(arm.joints))
    return arm.position.copy(), arm.rotation.copy()


def follow(arm, q, points, R_d=None):
    R_d = upright(place(arm, q)[1]) if R_d is None else R_d
    return check_path(arm, q, R_d, points, np.linspace(0.0, 2.0, len(points)))


def line(start, way, count=21):
    return start + np.linspace(0.0, 1.0, count)[:, None] * np.asarray(way)


def test_home_poses_hold_the_end_effector_upright_where_it_is_wanted(arm, homes):
    for home in homes:
        position, R = place(arm, home.q)
        np.testing.assert_allclose(position, START, atol=1e-4)
        assert np.arccos(min(R[2, 2], 1.0)) < 1e-3
        assert (home.q > arm.q_min + 0.09).all()
        assert (home.q < arm.q_max - 0.09).all()


def test_best_home_pose_lets_the_elbow_hang_and_is_far_from_singular(arm, homes):
    place(arm, homes[0].q)
    heights = []
    for home in homes:
        place(arm, home.q)
        heights.append(arm.anchor[ELBOW, 2])
    place(arm, homes[0].q)
    assert np.linalg.svd(arm.jacobian, compute_uv=False)[-1] > 0.05
    assert heights[0] < np.median(heights) + 1e-9


def test_search_gives_the_same_pose_again(arm, homes):
    np.testing.assert_array_equal(home_poses(arm, START, None, ELBOW)[0].q, homes[0].q)


def test_pose_given_as_home_is_kept(arm, homes):
    """From a pose that already does what is asked the search does not wander off."""
    again = home_poses(arm, START, homes[0].q, ELBOW)[0]
    np.testing.assert_allclose(again.q, homes[0].q, atol=1e-3)
    # Without a start point the home pose's own stays.
    position, _ = place(arm, home_poses(arm, None, homes[0].q, ELBOW)[0].q)
    np.testing.assert_allclose(position, START, atol=1e-3)


def test_unreachable_start_is_refused_with_the_distance(arm):
    """Base to flange the arm is 0.61 m + 0.39 m + 0.18 m long: at 3 m along x more than a metre is missing."""
    with pytest.raises(WorkspaceError) as refusal:
        home_poses(arm, np.array([3.0, 0.0, 0.7]), None, ELBOW)
    message = str(refusal.value)
    assert "(3.000, 0.000, 0.700) m" in message
    missing = float(message.split("misses it by ")[1].split(" mm")[0])
    assert 1000.0 < missing < 3000.0
    assert isinstance(refusal.value, ConfigurationError)


def test_path_within_reach_passes_with_its_joint_margin(arm, homes):
    margin = follow(arm, homes[0].q, line(START, [0.1, 0.15, -0.06]))
    gap = np.minimum(homes[0].q - arm.q_min, arm.q_max - homes[0].q).min()
    assert 0.0 < margin <= gap + 1e-3


def test_path_out_of_reach_is_refused_with_time_and_distance(arm, homes):
    """Straight out along x: the refusal names the first point that cannot be reached."""
    with pytest.raises(WorkspaceError) as refusal:
        follow(arm, homes[0].q, line(START, [2.0, 0.0, 0.0]))
    message = str(refusal.value)
    time = float(message.split("t = ")[1].split(" s")[0])
    x = float(message.split("(")[1].split(",")[0])
    assert x == pytest.approx(START[0] + time, abs=0.01)
    assert 0.58 < x < 1.3
    assert "out of reach by" in message


def test_path_that_needs_a_joint_beyond_its_range_names_it(arm, homes):
    """A move sideways that the arm can make; with every range closed to 0.02 rad about the home pose it cannot."""
    model = arm_model(load_scenario("paper"))
    sideways = line(START, [0.0, 0.25, 0.0])
    follow(model, homes[0].q, sideways)
    for joint in range(model.joints):
        model.q_min[joint] = max(model.q_min[joint], homes[0].q[joint] - 0.02)
        model.q_max[joint] = min(model.q_max[joint], homes[0].q[joint] + 0.02)
    with pytest.raises(WorkspaceError, match=r"joint (A\d|E1) is at the end of its range, -?\d+° to -?\d+°"):
        follow(model, homes[0].q, sideways)


@pytest.mark.parametrize("axis", range(3))
def test_upright_keeps_the_heading_and_points_up(axis):
    rng = np.random.default_rng(axis)
    A = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    R = upright(A * np.sign(np.linalg.det(A)))
    np.testing.assert_allclose(R.T @ R, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(R[:, 2], [0.0, 0.0, 1.0], atol=1e-12)
    assert np.linalg.det(R) == pytest.approx(1.0)


def test_pose_and_lead_hold_the_end_effector_upright_there(arm, homes):
    rng = np.random.default_rng(3)
    q = lead(arm, homes[0].q, START)
    for _ in range(10):
        point = START + rng.uniform(-0.08, 0.08, size=3)
        for found in (pose(arm, q, point), lead(arm, q, point)):
            position, R = place(arm, found)
            np.testing.assert_allclose(position, point, atol=1e-8)
            np.testing.assert_allclose(R, np.eye(3), atol=1e-7)
            assert (found >= arm.q_min).all()
            assert (found <= arm.q_max).all()


def test_pose_takes_the_shortest_step_in_joint_space(arm, homes):
    """Of all joint motions that make a small displacement the shortest has no part in the Jacobian's null space."""
    q = lead(arm, homes[0].q, START)
    moved = pose(arm, q, START + [1e-4, -2e-4, 1e-4]) - q
    place(arm, q)
    null = np.linalg.svd(arm.jacobian)[2][6:]
    assert np.abs(null @ moved).max() < 1e-3 * np.linalg.norm(moved)


def test_pose_out_of_reach_ends_as_near_as_it_can(arm, homes):
    q = lead(arm, homes[0].q, START)
    position, _ = place(arm, pose(arm, q, START + [2.0, 0.0, 0.0]))
    assert np.linalg.norm(position - START - [2.0, 0.0, 0.0]) > REACHED_M
    assert position[0] > START[0] + 0.1


def test_lead_stays_on_its_branch_where_one_leap_may_not(arm, homes):
    """There and back again: the joints return to where they were."""
    q = lead(arm, homes[0].q, START)
    there = lead(arm, q, START + [-0.15, 0.2, 0.05])
    np.testing.assert_allclose(lead(arm, there, START), q, atol=2e-2)
