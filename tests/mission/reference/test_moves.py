"""The arm's references: without jumps, each the rate of the one before it, ending where the phase says."""

import numpy as np
import pytest

from armland.mission.reference.moves import (
    BACK_OFF,
    CLOSE,
    FLEE,
    FLOOR_M,
    HOLD,
    JOIN,
    LAUNCH,
    LEAVE,
    LOWER,
    LOWER_S,
    MOVE,
    NEAR_M,
    NOD,
    NOD_M,
    TRACK,
    YIELD,
    begin,
    move,
)
from armland.mission.reference.refer import kept_layout, told_layout
from armland.records import layout

ALL = [HOLD, JOIN, TRACK, CLOSE, MOVE, BACK_OFF, YIELD, LAUNCH, LEAVE, LOWER, NOD, FLEE]


@pytest.fixture
def made():
    """What the reference is told and keeps, an estimate and an empty reference."""
    p, s = np.zeros(1, told_layout()), np.zeros(1, kept_layout())
    p["tick_s"], p["coast"], p["standoff"], p["beyond"], p["depth"] = 1e-3, 0.06, 0.03, 0.006, 0.06
    p["targets"][0, 1] = [0.7, 0.1, 0.8]
    p["flees"], p["flees_mps"], p["floor"] = 0.15, np.inf, 0.4
    p["launch"], p["launch_s"], p["leave_s"] = [0.5, -0.2, 0.1], 0.6, 0.35
    p["give_way"], p["give_way_max"], p["lower"], p["search"] = 3e-3, 4e-3, 0.03, 0.015
    s["r0"], s["v0"] = [0.6, 0.0, 0.7], [0.05, -0.02, 0.1]
    s["p"], s["pv"] = [0.62, 0.01, 0.86], [0.02, 0.01, -0.01]
    return p, s, np.zeros(1, layout("estimate", 7)), np.zeros(1, layout("reference", 7))


def at(made, mode, t, duration=1.5):
    """Position, velocity, acceleration and progress `t` s into a phase; the plate moves on by its own speed and acceleration."""
    p, s, e, r = made
    s, r = s.copy(), r.copy()
    s["p"] += (t - 0.7) * s["pv"] + 0.5 * (t - 0.7) ** 2 * s["pa"]
    s["pv"] += (t - 0.7) * s["pa"]
    progress = move(mode, t, duration, 1, e[0], p[0], s[0], r[0])
    return r["r"][0], r["v"][0], r["a"][0], progress


@pytest.mark.parametrize("mode", ALL)
def test_velocity_and_acceleration_are_the_rates_of_what_comes_before(made, mode):
    h = 1e-5
    for t in (0.1, 0.7, 1.3):
        ahead, here, behind = at(made, mode, t + h), at(made, mode, t), at(made, mode, t - h)
        np.testing.assert_allclose((ahead[0] - behind[0]) / (2.0 * h), here[1], atol=1e-5)
        np.testing.assert_allclose((ahead[1] - behind[1]) / (2.0 * h), here[2], atol=1e-4)


@pytest.mark.parametrize("mode", [JOIN, TRACK, CLOSE])
def test_acceleration_of_the_plate_is_the_arms_as_well(made, mode):
    made[1]["pa"] = [0.3, -0.2, 0.4]
    test_velocity_and_acceleration_are_the_rates_of_what_comes_before(made, mode)
    np.testing.assert_allclose(at(made, mode, 1.6)[2], [0.3, -0.2, 0.4], atol=1e-12)


@pytest.mark.parametrize("mode", [JOIN, CLOSE, MOVE, BACK_OFF, LAUNCH, LEAVE, NOD])
def test_jerk_does_not_step_within_a_phase(made, mode):
    """C³: no jump of the third derivative beyond what the fourth makes of a step of time; the plate at rest."""
    made[1]["pv"] = 0.0
    h = 1e-3
    t = np.arange(0.05, 1.6, h)
    a = np.array([at(made, mode, x)[2] for x in t])
    jerk = np.diff(a, axis=0) / h
    # The snap of a septic is at most 840 d/T⁴; here d < 0.6 m and T > 0.35 s for the fastest axis.
    assert np.abs(np.diff(jerk, axis=0)).max() < 840.0 * 0.06 / 0.35**4 * h * 2.0 + 5e-2


@pytest.mark.parametrize("mode", [HOLD, MOVE, BACK_OFF, YIELD, LAUNCH, LEAVE, LOWER, NOD])
def test_reference_begins_where_the_last_one_was_at_its_speed(made, mode):
    r, v, _, _ = at(made, mode, 0.0)
    np.testing.assert_allclose(r, made[1]["r0"][0])
    np.testing.assert_allclose(v, made[1]["v0"][0])


def test_arm_that_holds_comes_to_rest_within_a_few_coasting_times(made):
    r, v, _, _ = at(made, HOLD, 1.0)
    np.testing.assert_allclose(v, 0.0, atol=1e-6)
    np.testing.assert_allclose(r, made[1]["r0"][0] + 0.06 * made[1]["v0"][0], atol=1e-7)


def test_move_ends_at_its_target(made):
    r, v, _, progress = at(made, MOVE, 1.5)
    np.testing.assert_allclose(r, [0.7, 0.1, 0.8], atol=1e-9)
    np.testing.assert_allclose(v, 0.0, atol=1e-9)
    assert progress == 1.0


@pytest.mark.parametrize(("t", "duration", "progress"), [(0.375, 1.5, 0.25), (3.0, 1.5, 1.0), (0.1, 0.0, 1.0)])
def test_progress_is_the_share_of_the_moves_time_that_has_gone_by(made, t, duration, progress):
    assert at(made, MOVE, t, duration)[3] == pytest.approx(progress)


def test_run_up_ends_at_the_speed_that_the_uav_is_given_whatever_it_began_with(made):
    p, s, _, _ = made
    r, v, a, _ = at(made, LAUNCH, 1.0)
    np.testing.assert_allclose(v, [0.5, -0.2, 0.1], atol=1e-12)
    np.testing.assert_allclose(a, 0.0, atol=1e-12)
    # Of the run-up's 0.6 s the change of speed counts half.
    np.testing.assert_allclose(r - s["r0"][0], s["v0"][0] + (p["launch"][0] - s["v0"][0]) * 0.7, atol=1e-12)


def test_arm_that_leaves_sinks_by_the_depth_and_comes_to_rest(made):
    _, s, _, _ = made
    r, v, _, _ = at(made, LEAVE, 3.0)
    np.testing.assert_allclose(v, 0.0, atol=1e-12)
    # On at its speed for half of the way down, then half a run-up more.
    wanted = s["v0"][0] * (0.5 * 0.35 + 0.5 * 0.6) - [0.0, 0.0, 0.06]
    np.testing.assert_allclose(r - s["r0"][0], wanted, atol=1e-12)


@pytest.mark.parametrize("mode", [HOLD, MOVE, BACK_OFF, LOWER])
def test_only_an_arm_that_yields_follows_the_hinges_force(made, mode):
    calm = at(made, mode, 0.5)
    made[2]["hinge_force"] = [5.0, -4.0, 3.0]
    np.testing.assert_array_equal(at(made, mode, 0.5)[0], calm[0])
    assert not np.array_equal(at(made, YIELD, 0.5)[0], calm[0])


def test_joining_ends_on_the_plates_motion_below_it(made):
    s = made[1]
    r, v, _, _ = at(made, JOIN, 1.5)
    np.testing.assert_allclose(r, s["p"][0] + 0.8 * s["pv"][0] - [0, 0, 0.03], atol=1e-12)
    np.testing.assert_allclose(v, s["pv"][0], atol=1e-12)


def test_closing_begins_at_the_standoff_and_ends_beyond_the_face(made):
    made[1]["pv"] = 0.0
    assert at(made, CLOSE, 0.0, 1.0)[0][2] == pytest.approx(0.83)
    assert at(made, CLOSE, 1.0, 1.0)[0][2] == pytest.approx(0.866)


def test_arm_that_flees_goes_along_with_the_plate_and_down_from_it_and_then_to_where_it_waits(made):
    """The gap that there was grows by the depth, and nothing slides over the arm while it is near, whatever the plate does."""
    _, s, *_ = made
    s["p"], s["pv"], s["pa"] = [0.62, 0.01, 0.86], [0.3, -0.2, 0.1], [0.5, 0.5, -0.5]
    s["p0"], s["pv0"] = s["p"] - 0.7 * s["pv"] + 0.5 * 0.49 * s["pa"], s["pv"] - 0.7 * s["pa"]
    s["v0"] = s["pv0"]
    for t in (0.0, 0.2, 0.6, 1.5):
        plate = s["p"][0] + (t - 0.7) * s["pv"][0] + 0.5 * (t - 0.7) ** 2 * s["pa"][0]
        apart = plate - at(made, FLEE, t, 0.6)[0]
        if t < 0.3:
            np.testing.assert_allclose(apart[:2], (s["p0"] - s["r0"])[0, :2], atol=1e-12)
    np.testing.assert_allclose(at(made, FLEE, t, 0.6)[0][:2], [0.7, 0.1], atol=1e-12)
    assert apart[2] - (s["p0"] - s["r0"])[0, 2] == pytest.approx(0.15)


def test_arm_that_flees_from_a_plate_that_is_still_far_does_not_go_along(made):
    """Negative control: of a near one it takes the speed at once."""
    p, s, *_ = made
    s["pv"] = s["pv0"] = [0.4, 0.0, 0.0]
    s["v0"] = 0.0
    for far, moves in ((NEAR_M + 0.01, 0.0), (NEAR_M - 0.01, 0.4)):
        s["p0"] = s["r0"] + [0.0, 0.0, far]
        s["p"] = s["p0"] + 0.7 * s["pv"]
        away = at(made, FLEE, 0.29, 0.6)[0][0] - 0.6
        assert away == pytest.approx(moves * (0.29 - p["coast"][0]), abs=5e-3)


@pytest.mark.parametrize(("falls", "most"), [(0.0, 0.5), (0.3, 0.5), (0.3, 0.8)])
def test_arm_that_flees_from_a_plate_that_comes_down_is_no_faster_than_its_joints_allow(made, falls, most):
    """Negative control: without a bound it is faster."""
    p, s, e, _ = made
    s["pv"] = s["pv0"] = s["v0"] = [0.0, 0.0, -falls]
    s["p0"] = s["p"] - 0.7 * s["pv"]
    e["plate_v"] = s["pv"]
    begin(FLEE, TRACK, False, e[0], s[0])
    s["r0"], s["v0"], s["p0"] = [0.6, 0.0, 0.7], s["pv"], s["p"] - 0.7 * s["pv"]
    p["floor"] = -9.0

    def fastest():
        return max(-at(made, FLEE, t, 0.3)[1][2] for t in np.linspace(0.0, 3.0, 301))

    assert fastest() > most
    p["flees_mps"] = most
    assert fastest() <= most + 1e-3


@pytest.mark.parametrize("falls", [-0.05, -0.3, -3.0])
def test_arm_that_flees_comes_to_rest_where_it_may_go_no_lower(made, falls):
    p, s, *_ = made
    p["floor"], s["pv"], s["v0"], s["p0"], s["r0"] = 0.6, [0.0, 0.0, falls], 0.0, s["p"], s["p"] - [0.0, 0.0, 0.05]
    low = min(at(made, FLEE, t, 0.6)[0][2] for t in np.linspace(0.7, 5.0, 50))
    assert 0.6 <= low < 0.6 + FLOOR_M
    h, t = 1e-5, 0.75
    ahead, here, behind = (at(made, FLEE, x, 0.6) for x in (t + h, t, t - h))
    np.testing.assert_allclose((ahead[0] - behind[0]) / (2.0 * h), here[1], atol=1e-4)


def test_backing_off_goes_down_by_the_depth(made):
    made[1]["v0"] = 0.0
    np.testing.assert_allclose(at(made, BACK_OFF, 1.5)[0] - made[1]["r0"][0], [0.0, 0.0, -0.06], atol=1e-12)


def test_arm_gives_way_to_where_the_hinge_pushes_and_no_further_than_its_bound(made):
    p, s, e, r = made
    s["v0"] = 0.0
    e["hinge_force"][0] = [2.0, 0.0, -1.0]
    for _ in range(100):
        move(YIELD, 0.1, 0.0, 1, e[0], p[0], s[0], r[0])
    # The force of the end effector on the UAV is opposite to what pushes the arm.
    np.testing.assert_allclose(s["yielded"][0], [-100 * 1e-3 * 3e-3 * 2.0, 0.0, 100 * 1e-3 * 3e-3], rtol=1e-9)
    for _ in range(1500):
        move(YIELD, 0.1, 0.0, 1, e[0], p[0], s[0], r[0])
    np.testing.assert_allclose(r["r"][0] - s["r0"][0], [-4e-3, 0.0, 4e-3], rtol=1e-9)


def test_phase_begins_where_the_last_reference_was(made):
    _, s, e, _ = made
    s["r"], s["v"], e["r"], e["v"] = 0.5, 0.1, 0.4, 0.2
    begin(MOVE, HOLD, False, e[0], s[0])
    np.testing.assert_array_equal([s["r0"][0], s["v0"][0]], [[0.5] * 3, [0.1] * 3])


@pytest.mark.parametrize(("mode", "switched", "speed"), [(YIELD, False, 0.0), (HOLD, True, 0.2)])
def test_phase_begins_where_the_arm_is_if_the_law_changes_or_it_gives_way(made, mode, switched, speed):
    """So the new law begins without a force."""
    _, s, e, _ = made
    s["r"], s["v"], s["yielded"], e["r"], e["v"] = 0.5, 0.1, 0.003, 0.4, 0.2
    begin(mode, HOLD, switched, e[0], s[0])
    np.testing.assert_array_equal([s["r0"][0], s["v0"][0]], [[0.4] * 3, [speed] * 3])


def test_arm_that_goes_on_giving_way_keeps_what_it_has_given(made):
    _, s, e, _ = made
    s["r"], s["yielded"] = 0.5, 0.003
    begin(YIELD, YIELD, False, e[0], s[0])
    np.testing.assert_allclose(s["r0"][0], 0.497)
    np.testing.assert_array_equal(s["yielded"][0], 0.003)


def test_arm_that_feels_for_the_cradle_moves_as_one_that_does_not_until_half_way(made):
    for t in (0.0, 0.3, 0.75):
        for felt, moved in zip(at(made, LOWER, t), at(made, MOVE, t), strict=True):
            np.testing.assert_array_equal(felt, moved)


def test_arm_feels_for_the_cradle_downwards_alone_at_its_speed(made):
    """Blended in over `LOWER_S`, in which it covers half of what it would at full speed."""
    since = 0.5
    felt, moved = at(made, LOWER, 0.75 + since), at(made, MOVE, 0.75 + since)
    np.testing.assert_allclose(felt[0] - moved[0], [0.0, 0.0, -0.03 * (since - 0.5 * LOWER_S)], atol=1e-12)
    np.testing.assert_allclose(felt[1] - moved[1], [0.0, 0.0, -0.03], atol=1e-12)
    np.testing.assert_allclose(felt[2], moved[2], atol=1e-12)


@pytest.mark.parametrize("t", [2.5, 4.5, 60.0])
def test_arm_feels_for_the_cradle_no_deeper_than_twice_the_search(made, t):
    """From as far above the believed place to as far below: it passes every place where the cradle may be, and rests there."""
    r, v, a, _ = at(made, LOWER, t)
    np.testing.assert_allclose(r, [0.7, 0.1, 0.8 - 0.03], atol=1e-9)
    np.testing.assert_allclose(v, 0.0, atol=1e-9)
    np.testing.assert_allclose(a, 0.0, atol=1e-9)


def test_cradle_anywhere_in_the_band_is_met_no_faster_than_the_descent(made):
    """Once the move is over, it is the descent's speed alone that meets the rails."""
    t = np.arange(1.5, 3.0, 1e-3)
    speed = np.array([at(made, LOWER, x)[1] for x in t])
    assert np.abs(speed).max() <= 0.03 + 1e-6
    assert (speed[:, 2] <= 1e-6).all()


def test_arm_that_nods_goes_out_by_its_way_on_each_axis_and_back(made):
    made[1]["v0"] = 0.0
    start = made[1]["r0"][0]
    np.testing.assert_allclose(at(made, NOD, 0.25, 0.5)[0] - start, NOD_M, atol=1e-12)
    for t in (0.5, 0.9):
        r, v, a, _ = at(made, NOD, t, 0.5)
        np.testing.assert_allclose(r, start, atol=1e-12)
        np.testing.assert_allclose([v, a], 0.0, atol=1e-9)
    assert max(np.abs(at(made, NOD, t, 0.5)[0] - start).max() for t in np.linspace(0.0, 0.5, 51)) <= NOD_M + 1e-12
