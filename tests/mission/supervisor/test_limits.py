"""Limits of the joint torques, in their order: they only take away."""

import numpy as np
import pytest

from armland.mission.supervisor.limits import limit
from armland.records import Limit

JOINTS = 7


@pytest.fixture
def bench(bench):
    p = bench.told["limit"]
    p["tau_max"], p["qd_max"], p["q_min"], p["q_max"] = 100.0, 2.0, -2.0, 2.0
    p["torque_rate"], p["speed_share"], p["joint_margin"], p["sigma_min"] = 1500.0, 0.9, 0.02, 0.03
    bench.m["q"], bench.m["qd"], bench.board["arm"]["gravity"] = 0.0, 0.0, 0.0
    return bench


def limited(bench, tau):
    """Torques (n,) and flags that come of asking for `tau`."""
    bench.c["tau"] = tau
    limit(bench.b)
    return bench.c["tau"][0], int(bench.h["flags"][0])


def test_torque_within_all_limits_is_not_touched(bench):
    tau, flags = limited(bench, np.full(JOINTS, 1.0))
    np.testing.assert_array_equal(tau, 1.0)
    assert flags == 0


def test_torque_cannot_jump_and_arrives_in_time(bench):
    tau, flags = limited(bench, np.full(JOINTS, 50.0))
    np.testing.assert_allclose(tau, 1.5)
    assert flags == Limit.TORQUE_RATE
    for _ in range(40):
        tau, _ = limited(bench, np.full(JOINTS, 50.0))
    np.testing.assert_allclose(tau, 50.0)


def test_torque_stays_below_its_limit(bench):
    bench.kept["limit"]["tau"] = 99.5
    tau, flags = limited(bench, np.full(JOINTS, 200.0))
    np.testing.assert_allclose(tau, 100.0)
    assert flags == Limit.JOINT_TORQUE
    assert bench.h["torque_ratio"][0] == 2.0


@pytest.mark.parametrize(("speed", "cut"), [(1.9, True), (-1.9, True), (1.7, False)])
def test_fast_joint_is_damped(bench, speed, cut):
    bench.m["qd"][0, 2] = speed
    tau, flags = limited(bench, np.zeros(JOINTS))
    assert bool(flags & Limit.JOINT_SPEED) == cut
    assert (tau[2] * speed < 0.0) == cut


@pytest.mark.parametrize(
    ("q", "tau", "allowed"), [(1.995, 1.0, False), (1.995, -1.0, True), (-1.995, -1.0, False), (1.9, 1.0, True)]
)
def test_joint_at_its_end_is_driven_back_only(bench, q, tau, allowed):
    bench.m["q"][0, 3] = q
    bench.m["qd"][0, 3] = 0.05 * np.sign(tau)
    given, flags = limited(bench, np.full(JOINTS, tau))
    assert bool(flags & Limit.JOINT_POSITION) == (abs(q) > 1.98)
    assert (given[3] == tau) == allowed


def test_joint_at_its_end_is_still_held_against_its_weight(bench):
    bench.board["arm"]["gravity"][0, 3], bench.m["q"][0, 3] = 5.0, 1.995
    bench.kept["limit"]["tau"][0, 3] = 5.0
    assert limited(bench, np.array([0, 0, 0, 5.0, 0, 0, 0]))[0][3] == 5.0
    # What drives it on beyond that is taken away.
    assert limited(bench, np.array([0, 0, 0, 6.0, 0, 0, 0]))[0][3] == 5.0


def test_rate_goes_last_so_that_no_limit_makes_the_torque_jump(bench):
    """A joint that is too fast and too strongly driven at once: whatever is cut, the torque moves by its rate at most."""
    bench.m["qd"][0, 1] = 1.9
    before = bench.kept["limit"]["tau"][0, 1]
    tau, flags = limited(bench, np.full(JOINTS, 500.0))
    assert flags == Limit.JOINT_SPEED | Limit.JOINT_TORQUE | Limit.TORQUE_RATE
    assert abs(tau[1] - before) <= 1.5 + 1e-12


def test_infinite_limits_cut_nothing_but_the_torque(bench):
    p = bench.told["limit"]
    p["torque_rate"] = p["speed_share"] = p["hinge_max"] = np.inf
    p["joint_margin"] = -np.inf
    bench.m["q"], bench.m["qd"], bench.e["hinge_force"] = 1.999, 100.0, 1e6
    tau, flags = limited(bench, np.full(JOINTS, 90.0))
    np.testing.assert_array_equal(tau, 90.0)
    assert flags == 0
    tau, flags = limited(bench, np.full(JOINTS, 110.0))
    np.testing.assert_array_equal(tau, 100.0)
    assert flags == Limit.JOINT_TORQUE


@pytest.mark.parametrize(
    ("change", "flag"),
    [
        (lambda b: b.kept["estimate"].__setitem__("sigma", 0.02), Limit.SINGULAR),
        (lambda b: b.e["hinge_force"].__setitem__((0, 1), 1e4), Limit.HINGE_FORCE),
        (lambda b: b.m.__setitem__("uav_tick", 0), Limit.UAV_STALE),
        (lambda b: b.kept["estimate"].__setitem__("bad", 2), Limit.NON_FINITE),
    ],
)
def test_health_says_what_is_out_of_its_range(bench, change, flag):
    assert limited(bench, np.zeros(JOINTS))[1] == 0
    change(bench)
    assert limited(bench, np.zeros(JOINTS))[1] == flag


def test_health_tells_margin_speed_and_age(bench):
    bench.m["q"][0, 4], bench.m["qd"][0, 2], bench.m["uav_tick"] = 1.9, -1.0, 960
    limited(bench, np.zeros(JOINTS))
    assert bench.h["joint_margin"][0] == pytest.approx(0.1)
    assert bench.h["speed_ratio"][0] == pytest.approx(0.5)
    assert bench.h["uav_age"][0] == pytest.approx(0.04)


@pytest.mark.parametrize(("speed", "damped"), [(1.9, -38.0), (-1.9, 38.0), (1.85, -37.0), (1.75, 0.0)])
def test_damper_of_a_fast_joint_is_20_nms_per_rad(bench, speed, damped):
    bench.told["limit"]["torque_rate"] = np.inf
    bench.m["qd"][0, 2] = speed
    tau, _ = limited(bench, np.full(JOINTS, 3.0))
    assert tau[2] == pytest.approx(3.0 + damped)
    assert tau[1] == 3.0


@pytest.mark.parametrize("end", [1.0, -1.0])
@pytest.mark.parametrize(
    ("asked", "speed", "given"),
    [(4.0, 0.05, 4.0), (7.0, 0.05, 4.0), (7.0, -0.05, 6.0), (-3.0, 0.05, -3.0), (5.0, 0.05, 5.0)],
)
def test_joint_at_its_end_gets_its_weight_and_a_damper_for_what_drives_it_on(bench, end, asked, speed, given):
    """Of a weight that asks for 5 N·m outwards: less than that is no drive, more becomes 5 N·m less 20 N·m·s/rad."""
    bench.told["limit"]["torque_rate"] = np.inf
    bench.m["q"][0, 3], bench.m["qd"][0, 3], bench.board["arm"]["gravity"][0, 3] = end * 1.99, end * speed, end * 5.0
    tau, flags = limited(bench, np.array([0, 0, 0, end * asked, 0, 0, 0]))
    assert tau[3] == pytest.approx(end * given)
    assert flags == Limit.JOINT_POSITION


def test_health_tells_the_worst_joint_and_the_limits_keep_it(bench):
    """Of several joints the nearest to its end, on either side, and the fastest, in either direction."""
    bench.m["q"][0, :3], bench.m["qd"][0, :3] = [1.7, -1.8, 1.0], [0.5, -1.5, 1.0]
    limited(bench, np.array([10.0, -40.0, 20.0, 0, 0, 0, 0]))
    assert bench.h["joint_margin"][0] == bench.kept["limit"]["joint_margin"][0] == pytest.approx(0.2)
    assert bench.h["speed_ratio"][0] == bench.kept["limit"]["speed_ratio"][0] == pytest.approx(0.75)
    assert bench.h["torque_ratio"][0] == pytest.approx(0.4)
    assert bench.h["tick"][0] == bench.c["tick"][0] == 1000


@pytest.mark.parametrize("direction", [(2.0, -1.0, 2.0), (0.0, 0.0, -3.0)])
def test_hinge_force_is_flagged_by_its_length(bench, direction):
    most = bench.told["limit"]["hinge_max"][0]
    for share, flag in ((0.95, 0), (1.05, Limit.HINGE_FORCE)):
        bench.e["hinge_force"] = share * most / 3.0 * np.array(direction)
        assert limited(bench, np.zeros(JOINTS))[1] == flag


@pytest.mark.parametrize(("late", "flag"), [(0, 0), (1, Limit.UAV_STALE)])
def test_uav_is_stale_from_one_tick_beyond_its_age(bench, late, flag):
    bench.m["uav_tick"] = 1000 - bench.told["limit"]["uav_age"][0] - late
    assert limited(bench, np.zeros(JOINTS))[1] == flag


def test_first_torque_is_not_held_against_one_that_there_was_not(bench):
    bench.kept["limit"]["started"] = 0
    assert (limited(bench, np.full(JOINTS, 50.0))[0] == 50.0).all()
    tau, flags = limited(bench, np.zeros(JOINTS))
    np.testing.assert_allclose(tau, 48.5)
    assert flags == Limit.TORQUE_RATE
