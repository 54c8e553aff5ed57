"""Compiled steps to upright poses: they agree with the search in Python, keep within the ranges, and sink the null space."""

import numpy as np
import pytest

from armland.control.laws import realisation
from armland.control.laws.nullspace import null_space_wish
from armland.models.nearby import CAUTION, Sinking, body_of, reached, sink
from armland.models.parameters import arm_model
from armland.models.posture import UPRIGHT, pose
from armland.scenario import load_scenario

BELOW = np.array([0.62, 0.0, 0.62])
HOW = Sinking(
    elbow=3,
    pull=5.0,
    margin=0.25,
    stiffness=20.0,
    gain=0.04,
    longest=0.1,
    posture=np.zeros(7),
    drawn=np.zeros((7, 7)),
)


@pytest.fixture(scope="module")
def scenario():
    return load_scenario("landing")


@pytest.fixture(scope="module")
def arm(scenario):
    return arm_model(scenario)


@pytest.fixture
def home(scenario):
    return np.deg2rad(scenario.place.home_deg)


def held(arm, q):
    arm.update(q, np.zeros(arm.joints))
    return arm.position.copy(), arm.rotation.copy()


def swivelled(arm, q):
    """Upright below the catch with the elbow turned up about the line from shoulder to wrist."""
    q = pose(arm, q, BELOW)
    for _ in range(12):
        arm.update(q, np.zeros(arm.joints))
        along = np.linalg.svd(arm.jacobian)[2][-1]
        rise = np.cross(arm.axis, arm.anchor[3] - arm.anchor)[:3, 2] @ along[:3]
        q = pose(arm, q + 0.1 * np.sign(rise) * along, BELOW)
    return q


def test_pose_is_the_one_that_the_search_in_python_finds(arm, home):
    wanted = pose(arm, home, BELOW)
    q = home.copy()
    assert reached(body_of(arm), q, BELOW, 40, 0.0)
    np.testing.assert_allclose(q, wanted, atol=1e-3)
    position, R = held(arm, q)
    np.testing.assert_allclose(position, BELOW, atol=1e-6)
    np.testing.assert_allclose(R, np.eye(3), atol=1e-6)


def test_far_starts_reach_upright_poses_within_the_ranges_or_say_that_they_do_not(arm):
    rng, found = np.random.default_rng(0), 0
    for _ in range(50):
        q = rng.uniform(arm.q_min, arm.q_max)
        if reached(body_of(arm), q, BELOW, 60, CAUTION):
            found += 1
            position, R = held(arm, q)
            np.testing.assert_allclose(position, BELOW, atol=2e-4)
            np.testing.assert_allclose(R, np.eye(3), atol=1e-3)
        assert (q >= arm.q_min).all()
        assert (q <= arm.q_max).all()
    assert found > 10


def test_point_beyond_the_arm_is_not_reached(arm, home):
    assert not reached(body_of(arm), home, np.array([1.5, 0.0, 0.6]), 60, CAUTION)


def test_sunk_arm_has_nothing_left_of_the_controllers_wish(arm, scenario, home):
    """N τ₀ of `control.laws.nullspace`, an independent implementation, is gone; at the start it was not."""
    told = realisation.told(scenario, arm, UPRIGHT)[0]

    def left(q):
        arm.update(q, np.zeros(arm.joints))
        wish = null_space_wish(q, np.zeros(arm.joints), arm.state[0], told)
        return np.linalg.norm(wish - np.linalg.pinv(arm.jacobian) @ (arm.jacobian @ wish))

    q = swivelled(arm, home)
    before = left(q)
    assert sink(body_of(arm), q, BELOW, HOW, 400)
    assert left(q) < 0.05
    assert before > 5.0 * left(q)
    np.testing.assert_allclose(held(arm, q)[0], BELOW, atol=2e-4)


def test_arm_that_is_drawn_to_a_posture_stays_where_the_controllers_wish_has_it(arm, home):
    """Elbow turned up, and drawn there: from a pose that has sunk it comes back, to where N τ₀ of the controller is gone."""
    scenario = load_scenario("landing", {"control": {"posture_rad_s": 6.0}})
    up, q, still = swivelled(arm, home), home.copy(), np.zeros(arm.joints)
    told = realisation.told(scenario, arm, UPRIGHT, up)[0]
    arm.update(up, still)
    drawn = HOW._replace(posture=up, drawn=36.0 * arm.mass_matrix)
    assert sink(body_of(arm), q, BELOW, HOW, 400)
    assert np.abs(q - up).max() > 0.3
    assert sink(body_of(arm), q, BELOW, drawn, 20)
    np.testing.assert_allclose(q, up, atol=0.05)
    arm.update(q, still)
    wish = null_space_wish(q, still, arm.state[0], told)
    stiffest = np.linalg.eigvalsh(36.0 * arm.mass_matrix)[-1]
    assert np.linalg.norm(wish - np.linalg.pinv(arm.jacobian) @ (arm.jacobian @ wish)) < 2e-3 * stiffest


def test_elbow_sinks_and_does_not_without_its_pull(arm, home):
    start = swivelled(arm, home)

    def height(pull):
        q = start.copy()
        assert sink(body_of(arm), q, BELOW, HOW._replace(pull=pull, stiffness=0.0), 400)
        held(arm, q)
        return arm.anchor[3, 2]

    assert height(5.0) < height(0.0) - 0.005
