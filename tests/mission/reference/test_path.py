"""The desired path: smooth to the third derivative, at rest where it rests, and as fast as the septic must be."""

from itertools import pairwise

import numpy as np
import pytest

from armland.mission.reference.path import follow, legs, sample
from armland.records import layout
from armland.scenario.mission import Trajectory

START = np.array([0.5, -0.1, 0.7])
RATE = 1000
DISTANCE, DURATION = 0.2, 1.5


def trajectory(*moves):
    return Trajectory.model_validate_json(
        '{"moves": ['
        + ", ".join(f'{{"to_m": {list(to)}, "duration_s": {d}, "rest_s": {r}}}' for to, d, r in moves)
        + "]}"
    )


@pytest.fixture
def single():
    path = legs(trajectory(([DISTANCE, 0.0, 0.0], DURATION, 0.5)), START, settle_s=0.25, tail_s=0.5)
    return path, sample(path, RATE)


@pytest.fixture
def several():
    path = legs(
        trajectory(([0.1, 0.0, 0.0], 1.0, 0.3), ([0.1, 0.15, -0.06], 0.7, 0.0), ([0.0, 0.0, 0.0], 2.0, 0.2)),
        START,
        settle_s=0.4,
        tail_s=0.6,
    )
    return path, sample(path, RATE)


def differences(x, order):
    """`order`-th derivative by repeated central differences, row i at tick i + order."""
    for _ in range(order):
        x = (x[2:] - x[:-2]) * (0.5 * RATE)
    return x


def largest_jump(x):
    return np.abs(np.diff(x, axis=0)).max()


def test_moves_are_relative_to_the_start_and_follow_one_another(several):
    path, table = several
    np.testing.assert_allclose([leg.target - START for leg in path], [[0.1, 0, 0], [0.1, 0.15, -0.06], [0, 0, 0]])
    np.testing.assert_allclose([leg.start_s for leg in path], [0.4, 1.7, 2.4])
    np.testing.assert_allclose([leg.end_s for leg in path], [1.7, 2.4, 5.2])
    for one, two in pairwise(path):
        np.testing.assert_array_equal(one.target, two.origin)
    assert len(table) == 5200


def test_velocity_and_acceleration_are_the_derivatives_of_the_position(several):
    _, table = several
    np.testing.assert_allclose(table[1:-1, 3:6], differences(table[:, :3], 1), atol=2e-5)
    np.testing.assert_allclose(table[1:-1, 6:9], differences(table[:, 3:6], 1), atol=2e-4)


def test_rests_are_at_rest_at_the_target(several):
    path, table = several
    times = np.arange(len(table)) / RATE
    np.testing.assert_array_equal(table[times < 0.4, :3], np.tile(START, (400, 1)))
    for leg in path:
        resting = (times >= leg.arrive_s) & (times < leg.end_s)
        np.testing.assert_allclose(table[resting, :3], np.tile(leg.target, (resting.sum(), 1)), atol=1e-12)
        np.testing.assert_allclose(table[resting, 3:], 0.0, atol=1e-12)
        # Already a tick before it arrives it hardly moves: no step into the rest.
        before = table[round(leg.arrive_s * RATE) - 1]
        np.testing.assert_allclose(before[3:], 0.0, atol=1e-3)


def quintic(duration, distance, settle_s, total):
    """The usual minimum-jerk polynomial: C² only, its jerk steps at both ends."""
    s = np.clip((np.arange(total) / RATE - settle_s) / duration, 0.0, 1.0)
    return distance * (10 * s**3 - 15 * s**4 + 6 * s**5)


def test_jerk_is_continuous_where_a_quintics_is_not(single):
    """Largest change of the jerk in a tick, by differences of the position: at most T_s · max|r⃜|, far below a step of 60 d/T³."""
    _, table = single
    step = 60.0 * DISTANCE / DURATION**3
    # Snap of the septic is at most 840 d/T⁴, at its ends.
    assert largest_jump(differences(table[:, 0], 3)) < 1.1 * 840.0 * DISTANCE / DURATION**4 / RATE
    assert largest_jump(differences(table[:, 0], 3)) < 0.02 * step
    other = quintic(DURATION, DISTANCE, 0.25, len(table))
    assert largest_jump(differences(other, 3)) > 0.1 * step


def test_speed_and_acceleration_peak_as_the_septics_do(single):
    """Peak speed 35/16 d/T half way; peak acceleration 84√5/25 d/T² = 7.513 d/T² at s = ½ ± √5/10."""
    _, table = single
    assert table[:, 3].max() == pytest.approx(35.0 / 16.0 * DISTANCE / DURATION, rel=1e-4)
    assert table[:, 6].max() == pytest.approx(7.513 * DISTANCE / DURATION**2, rel=1e-3)
    assert table[:, 6].min() == pytest.approx(-7.513 * DISTANCE / DURATION**2, rel=1e-3)
    half = round((0.25 + 0.5 * DURATION) * RATE)
    assert table[half, 0] == pytest.approx(START[0] + 0.5 * DISTANCE, abs=1e-9)
    assert abs(table[:, 6].argmax() / RATE - (0.25 + DURATION * (0.5 - np.sqrt(5.0) / 10.0))) < 2e-3


def test_motion_is_along_the_straight_line(several):
    path, table = several
    leg = path[1]
    moving = table[round(leg.start_s * RATE) : round(leg.arrive_s * RATE), :3] - leg.origin
    line = leg.target - leg.origin
    across = moving - np.outer(moving @ line / (line @ line), line)
    np.testing.assert_allclose(across, 0.0, atol=1e-12)
    assert (np.diff(moving @ line) >= 0.0).all()


@pytest.mark.parametrize("rate", [200, 1000, 4000])
def test_same_path_at_any_base_rate(single, rate):
    path, table = single
    np.testing.assert_allclose(sample(path, rate)[:: rate // 200], table[:: RATE // 200], atol=1e-12)


@pytest.mark.parametrize(("tick", "row", "progress"), [(0, 0, 0.0), (1000, 1000, 1000 / 5199), (9000, 5199, 1.0)])
def test_reference_is_the_row_of_the_tick_and_holds_the_last_one(several, tick, row, progress):
    _, table = several
    r = np.zeros(1, layout("reference", 7))
    assert follow(table, tick, r[0]) == pytest.approx(progress)
    np.testing.assert_array_equal(np.concatenate([r["r"][0], r["v"][0], r["a"][0]]), table[row])
