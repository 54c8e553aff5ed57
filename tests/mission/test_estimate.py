"""The estimate of a tick: arm point, thrust that acts, torque on board, and which parts are filled by which device."""

import numpy as np
import pytest

from armland.mission.estimate import (
    SINGULARITY_PERIOD,
    acting_thrust,
    estimate,
    estimate_arm,
    learn_uplink,
    predict_torque,
    screen,
    watch_downlink,
)
from armland.mission.reference.moves import LAUNCH
from armland.rotations import from_rotation_vector


def test_velocity_of_the_end_effector_is_the_rate_of_its_position(bench, landing_plan):
    arm, h = landing_plan.arm, 1e-6
    rng = np.random.default_rng(1)
    q, qd = landing_plan.home + rng.normal(scale=0.05, size=7), rng.normal(scale=0.3, size=7)
    places = []
    for shift in (-h, h, 0.0):
        arm.update(q + shift * qd, qd)
        places.append(arm.position.copy())
    bench.m["qd"] = qd
    estimate_arm(bench.m[0], arm.state[0], bench.e[0])
    np.testing.assert_array_equal(bench.e["r"][0], places[2])
    np.testing.assert_allclose(bench.e["v"][0], (places[1] - places[0]) / (2.0 * h), atol=1e-8)


@pytest.mark.parametrize(("fused", "valid"), [(0, 1), (1, 0)])
def test_attitude_is_as_received_or_by_the_filter_which_vouches_for_nothing_unseen(bench, fused, valid):
    bench.told["estimate"]["fused"], bench.kept["estimate"]["seen"] = fused, 0
    bench.m["uav_quat"][0] = from_rotation_vector(np.array([0.1, 0.0, 0.0]))
    bench.kept["estimate"]["filter"]["align"]["quat"][0, 0] = 1.0
    estimate(bench.b)
    np.testing.assert_allclose(bench.e["quat"][0], bench.m["uav_quat"][0], atol=1e-12)
    assert bench.e["plate_valid"][0] == valid
    assert bench.kept["estimate"]["seen"][0] == valid


def test_smallest_singular_value_is_evaluated_now_and_then(bench):
    bench.kept["estimate"]["sigma"], bench.m["tick"] = -1.0, SINGULARITY_PERIOD * 50 + 1
    estimate(bench.b)
    assert bench.kept["estimate"]["sigma"][0] == -1.0
    bench.m["tick"] = SINGULARITY_PERIOD * 51
    estimate(bench.b)
    found = np.linalg.svd(bench.board["arm"]["jacobian"][0], compute_uv=False)[-1]
    assert bench.kept["estimate"]["sigma"][0] == pytest.approx(found)


def test_screening_looks_for_leaps_of_a_held_uav(bench):
    screen(bench.b)
    assert bench.kept["estimate"]["bad"][0] == 0
    bench.m["uav_quat"][0] = from_rotation_vector(np.array([0.5, 0.0, 0.0]))
    bench.kept["decide"]["held"] = 1
    screen(bench.b)
    assert bench.kept["estimate"]["bad"][0] == 4


def test_thrust_that_acts_is_late_by_link_and_rotors(bench):
    p, s = bench.told["estimate"], bench.kept["estimate"]
    s["thrust_log"], s["acting"] = 5.0, 5.0
    lag = bench.plan.scenario.link.uplink_delay_ms * 1e-3 + bench.plan.scenario.rotors.time_constant_s
    for tick in range(600):
        s["thrust_log"][0, tick % 256] = 5.0 - 3.0 * tick * 1e-3
        acting = acting_thrust(tick, p[0], s[0])
    assert acting == pytest.approx(5.0 - 3.0 * (0.599 - lag), abs=0.02)


def test_torque_on_board_turns_the_uav_back_to_its_set_point(bench):
    p, q_d = bench.told["estimate"], np.array([1.0, 0.0, 0.0, 0.0])
    bench.e["quat"][0], bench.e["omega"] = from_rotation_vector(np.array([0.01, -0.02, 0.03])), [0.1, 0.2, 0.3]
    predict_torque(q_d, p[0], bench.e[0])
    kp, kd = np.array(bench.plan.scenario.onboard.kp_nm), np.array(bench.plan.scenario.onboard.kd_nms)
    np.testing.assert_allclose(bench.e["tau_att"][0], -kp * [0.01, -0.02, 0.03] - kd * [0.1, 0.2, 0.3], rtol=1e-3)


def test_smallest_singular_value_is_known_from_the_first_tick_on(bench):
    bench.kept["estimate"]["sigma"], bench.m["tick"], bench.kept["limit"]["started"] = -1.0, 7, 0
    estimate(bench.b)
    assert bench.kept["estimate"]["sigma"][0] > 0.0


@pytest.mark.parametrize(("phase", "learns"), [("guide", True), ("align", False), ("carry", False)])
def test_bias_of_the_force_is_learnt_in_the_phases_that_touch_nothing(bench, phase, learns):
    bench.enter(phase)
    # Within what the tool's weight makes plausible.
    bench.m["wrench"][0, 2] = 0.30 * 9.81
    estimate(bench.b)
    assert (bench.kept["estimate"]["wrench"]["count"][0] == 1) == learns


@pytest.mark.parametrize(("magnet", "counts"), [(0, True), (1, False), (2, True)])
def test_release_is_counted_while_the_magnet_is_off(bench, magnet, counts):
    bench.kept["act"]["magnet"], bench.kept["decide"]["retreat"] = magnet, 1.0
    bench.m["wrench"][0, 2] = 0.30 * 9.81
    held = bench.kept["estimate"]["contact"]["held"]
    held["active"], held["count"] = 1, 5
    estimate(bench.b)
    # Of a magnet that is on it begins anew.
    assert held["count"][0] == (6 if counts else 1)


@pytest.mark.parametrize("held", [1, 0])
def test_filter_is_told_of_the_push_of_a_run_up(bench, held):
    """The reference's acceleration while the arm holds the UAV, less its drag; let go, the drag at the speed it was given."""
    row, p = bench.enter("carry"), bench.told["estimate"]
    row["arm"], row["held"] = LAUNCH, held
    bench.kept["refer"]["a"], bench.kept["refer"]["v"], p["launch"] = [1.5, 0.0, 0.0], [0.4, 0.0, 0.0], [0.6, 0.0, 0.0]
    estimate(bench.b)
    rate = p["drag"][0] / p["mass"][0]
    told = bench.kept["estimate"]["filter"]["push"][0, 1000]
    np.testing.assert_allclose(told, [1.5 - rate * 0.4 if held else -rate * 0.6, 0.0, -9.81], atol=1e-12)


def test_plate_that_was_seen_once_stays_one_that_was_seen(bench):
    bench.told["estimate"]["fused"], bench.kept["estimate"]["seen"] = 1, 1
    estimate(bench.b)
    assert bench.e["plate_valid"][0] == 0
    assert bench.kept["estimate"]["seen"][0] == 1


def test_thrust_is_remembered_for_as_long_as_it_travels(bench):
    """A single command of 1 N at tick 2000 acts from 25 ticks later on, by the rotors' gain, and no tick before."""
    p, s = bench.told["estimate"], bench.kept["estimate"]
    s["thrust_log"], s["acting"] = 0.0, 0.0
    s["thrust_log"][0, 2000 % 256] = 1.0
    assert acting_thrust(2024, p[0], s[0]) == 0.0
    assert acting_thrust(2025, p[0], s[0]) == pytest.approx(1.0 - np.exp(-0.02))


def learnt_uplink(bench, late, seconds=4.0, period=5):
    """Delay in ticks that is learnt of a UAV whose newest command is `late()` ticks old in each of its samples."""
    p, s, m = bench.told["estimate"], bench.kept["estimate"], bench.m
    for tick in range(1000, 1000 + round(seconds * 1000), period):
        m["uav_tick"], m["uav_echo"] = tick, tick - late()
        # Between samples the same one is seen again: it says nothing new.
        for _ in range(2):
            learn_uplink(m[0], p[0], s[0])
    return float(s["uplink"][0])


@pytest.mark.parametrize("late", [0, 25, 100, 255])
def test_delay_of_the_uplink_is_learnt_from_the_echoes(bench, late):
    """Within e⁻⁸ of the difference after eight time constants of 0.5 s."""
    assert learnt_uplink(bench, lambda: late) == pytest.approx(late, abs=0.12)


def test_delay_of_the_uplink_is_learnt_with_its_time_constant(bench):
    bench.kept["estimate"]["uplink"], bench.kept["estimate"]["echoed"] = 25.0, 995
    assert learnt_uplink(bench, lambda: 100, 0.5) == pytest.approx(25.0 + 75.0 * (1.0 - np.exp(-1.0)), abs=0.5)


def test_delay_that_jitters_is_learnt_as_its_mean(bench):
    """Uniform from 25 to 45 ticks: the mean to within four deviations of a filter of gain g, σ √(g/2)."""
    rng = np.random.default_rng(1)
    sigma = np.sqrt((21**2 - 1) / 12.0)
    found = learnt_uplink(bench, lambda: 25 + int(rng.integers(0, 21)))
    assert found == pytest.approx(35.0, abs=4.0 * sigma * np.sqrt(0.5 * 5e-3 / 0.5) + 0.01)


@pytest.mark.parametrize(("late", "found"), [(5000, 255.0), (-50, 0.0)])
def test_delay_of_the_uplink_stays_within_what_the_log_holds(bench, late, found):
    """Stamps of another clock may say anything."""
    assert learnt_uplink(bench, lambda: late, seconds=8.0) == pytest.approx(found, abs=0.1)


def test_delay_of_the_uplink_is_as_believed_where_it_may_not_be_learnt_or_nothing_was_heard(bench):
    bench.kept["estimate"]["uplink"] = 25.0
    bench.told["estimate"]["learns"] = 0
    assert learnt_uplink(bench, lambda: 100) == 25.0
    bench.told["estimate"]["learns"] = 1
    bench.kept["estimate"]["echoed"] = 0
    assert learnt_uplink(bench, lambda: 10**6) == 25.0


def test_thrust_acts_after_the_delay_that_was_learnt(bench):
    p, s = bench.told["estimate"], bench.kept["estimate"]
    learnt_uplink(bench, lambda: 100)
    s["thrust_log"], s["acting"] = 0.0, 0.0
    s["thrust_log"][0, 2000 % 256] = 1.0
    assert acting_thrust(2099, p[0], s[0]) == 0.0
    assert acting_thrust(2100, p[0], s[0]) > 0.0


@pytest.mark.parametrize("late", [12, 100, 400])
def test_delay_of_the_downlink_is_learnt_from_the_stamps(bench, late):
    """And when the newest sample came: one that is seen again is no new one."""
    p, s, m = bench.told["estimate"], bench.kept["estimate"], bench.m
    for tick in range(1000, 5000):
        m["tick"], m["uav_tick"] = tick, (tick - late) // 5 * 5
        watch_downlink(m[0], p[0], s[0])
    m["tick"] = 6000
    watch_downlink(m[0], p[0], s[0])
    assert s["downlink"][0] == pytest.approx(late, abs=5.0)
    assert s["arrived"][0] in range(4995, 5000)
