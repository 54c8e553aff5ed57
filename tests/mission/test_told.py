"""What the stages are told: numbers of the scenarios that come with armland, worked out by hand."""

import numpy as np
import pytest

from armland.control.laws.settings import row_of
from armland.mission.belief import flyer
from armland.mission.feasibility.launch import Launch
from armland.mission.plan import plan
from armland.mission.told import Telling, tell
from armland.models.posture import UPRIGHT
from armland.scenario import load_scenario
from armland.scenario.control import Experiment

MASS, LEVER, G = 0.48, 0.06, 9.81
SWUNG, FALL = 0.0065 + MASS * LEVER**2, MASS * G * LEVER
"""Of the UAV about its pivot, by the mean of its two axes: kg·m², N·m/rad."""


@pytest.fixture(scope="module")
def told(landing_plan):
    return landing_plan.told


def test_estimate_knows_link_rotors_and_leaps(told):
    p = told["estimate"][0]
    assert (p["fused"], p["velocity_terms"], p["coriolis"], p["tool_follows"]) == (1, 1, 0, 1.0)
    # 25 ms of uplink, 50 ms of lag, at 1 kHz.
    assert p["uplink"] == 25
    assert p["rotor_gain"] == pytest.approx(1.0 - np.exp(-0.02))
    # No joint turns at 50 rad/s.
    assert p["joint_leap"] == pytest.approx(0.05)
    assert p["attitude_leap"] == 0.15
    assert p["wrench_age"] == 20
    np.testing.assert_allclose(p["lever"], [0.0, 0.0, -LEVER])
    np.testing.assert_array_equal(p["launch"], 0.0)


def test_deciding_knows_ages_in_its_units_and_shares_of_the_magnets_rating(told, landing_plan):
    p, watch, rating = told["decide"][0], told["decide"]["watch"][0], landing_plan.scenario.magnet.rating_n
    assert p["magnet_ready"] == pytest.approx(0.9 * rating)
    assert p["clear_z"] == pytest.approx(0.711)
    assert (watch["uav_age"], watch["arm_age"], watch["wrench_age"], watch["camera_age"]) == (250, 5, 20, 2.0)
    assert watch["hinge_max"] == pytest.approx(0.6 * rating)
    assert watch["tilt_max"] == pytest.approx(np.pi / 6.0)
    assert watch["thrust_max"] == pytest.approx(0.94 * 4 * 1.86)
    # What a UAV may need in hover, of what its rotors give at most.
    assert watch["hover_max"] == pytest.approx(0.96 * 0.94 * 4 * 1.86 * np.cos(0.3))


def test_balance_knows_its_reach_in_capture_points_and_the_wrist(told):
    b = told["refer"]["balance"][0]
    # The hand's own 78 mm and the tool's 106.4 mm.
    assert b["wrist"] == pytest.approx(0.078 + 0.1064, abs=1e-6)
    assert b["lost"] == pytest.approx(0.11 * FALL / SWUNG / G)
    assert (b["attitude_age"], b["settle"], b["push_max"], b["sway_max"]) == (50, 0.025, 15.0, 0.11)
    assert b["down"] == pytest.approx(0.701)
    assert (b["gains"] > 0.0).all()


def test_station_keeping_knows_what_four_rotors_give(told):
    p = told["act"]["uav"][0]
    assert p["thrust_min"] == pytest.approx(4 * 0.09 + 0.1)
    assert p["thrust_max"] == pytest.approx(0.94 * 4 * 1.86)
    assert (p["period"], p["fly_on"], p["heading"]) == (5, 0, 0.0)
    assert p["weight"] == pytest.approx(p["mass"] * G)


def test_free_arm_has_the_poles_that_are_wanted(told, landing_plan):
    c, act = landing_plan.scenario.control, told["act"]
    np.testing.assert_allclose(act["stiffness"], c.free_rad_s**2)
    np.testing.assert_allclose(act["damping"], 2.0 * c.free_damping * c.free_rad_s)
    assert act["lean_stiffness"][0] == act["stiffness"][0, 0]
    assert act["lean_damping"][0] == act["damping"][0, 0]


def test_limits_are_the_arms_and_the_scenarios(told, landing_plan):
    p, arm, limits = told["limit"][0], landing_plan.arm, landing_plan.scenario.limits
    np.testing.assert_array_equal([p["q_min"], p["q_max"], p["tau_max"]], [arm.q_min, arm.q_max, arm.tau_max])
    np.testing.assert_array_equal(p["qd_max"], [1.92, 1.92, 2.23, 2.23, 2.27, 3.14, 3.14])
    assert (p["joint_margin"], p["speed_share"]) == (0.02, 0.9)
    np.testing.assert_array_equal(p["torque_rate"], [1500.0] * 7)
    assert p["hinge_max"] == pytest.approx(limits.hinge_force_share * landing_plan.scenario.magnet.rating_n)
    assert p["uav_age"] == 250


def test_uav_on_the_hinge_for_good_is_told_that_what_is_asked_is_given(plans):
    p = plans("E1").told
    e, b = p["estimate"][0], p["refer"]["balance"][0]
    assert (e["fused"], e["uplink"], e["rotor_gain"], e["tool_follows"]) == (0, 1, 1.0, 0.0)
    assert np.isinf([e["joint_leap"], e["attitude_leap"], b["fall_rate"]]).all()
    np.testing.assert_array_equal(b["gains"], 0.0)
    assert e["observer"]["gain"] == 0.0
    assert p["limit"]["uav_age"][0] == round(plans("E1").scenario.link.watchdog_ms)
    assert p["act"]["law"]["attitude"][0] == 1
    assert p["act"]["uav"]["hinged"][0] == plans("E1").scenario.control.thrust_n


def test_attitude_of_a_uav_on_the_magnet_is_its_own(told):
    assert told["act"]["law"]["attitude"][0] == 0


LAUNCH = Launch(np.array([0.0, -0.6, 0.0]), np.array([0.4, 0.2, 0.9]), 0.5, 0.35, 2.0)


def telling(made, overrides=None, launch=None, start="cradle"):
    """What a plan was told from, with another scenario and with a run-up that nobody had to search for."""
    scenario = load_scenario("landing", overrides)
    return Telling(
        scenario, made.arm, flyer(scenario), made.arm.qd_max, UPRIGHT, np.zeros((0, 3)),
        Experiment(acceleration="implied", support="none"), row_of("exact"), start, launch,
    )  # fmt: skip


@pytest.mark.parametrize(("acceleration", "coast"), [(2.0, 0.3), (20.0, 0.06)])
def test_speed_of_a_run_up_is_given_up_no_faster_than_it_was_gained(landing_plan, acceleration, coast):
    p = tell(telling(landing_plan, launch=LAUNCH._replace(acceleration=acceleration)))
    assert p["refer"]["coast"][0] == pytest.approx(coast)
    assert (p["refer"]["launch_s"][0], p["refer"]["leave_s"][0]) == (0.5, 0.35)
    for stage in (p["refer"], p["estimate"], p["act"]["uav"]):
        np.testing.assert_array_equal(stage["launch"][0], [0.0, -0.6, 0.0])


@pytest.mark.parametrize(("fly_on", "share"), [(False, 0.94), (True, 1.0)])
def test_uav_that_flies_on_may_give_all_it_has(landing_plan, fly_on, share):
    p = tell(telling(landing_plan, {"place": {"fly_on": fly_on}}, LAUNCH))["act"]["uav"][0]
    assert p["fly_on"] == fly_on
    assert p["thrust_max"] == pytest.approx(share * 4 * 1.86)


@pytest.mark.parametrize(("start", "above"), [("air", 0.0), ("cradle", 0.2)])
def test_station_is_the_catch_and_above_it_for_a_uav_that_takes_off(landing_plan, start, above):
    p = tell(telling(landing_plan, start=start))
    for stage in (p["decide"], p["act"]["uav"]):
        np.testing.assert_allclose(stage["station"][0], [0.62, 0.0, 0.86 + above])


def test_slower_loop_counts_the_same_times_in_fewer_ticks(landing_plan):
    p = tell(telling(landing_plan, {"run": {"rate_hz": 400}}))
    assert (p["estimate"]["uplink"][0], p["decide"]["watch"]["uav_age"][0], p["act"]["uav"]["period"][0]) == (
        10,
        100,
        2,
    )
    assert p["estimate"]["rotor_gain"][0] == pytest.approx(1.0 - np.exp(-0.05))
    assert p["estimate"]["joint_leap"][0] == pytest.approx(0.125)
    assert p["limit"]["tick_s"][0] == p["refer"]["tick_s"][0] == p["decide"]["tick_s"][0] == 0.0025


@pytest.mark.parametrize(("start", "wind", "above"), [("air", 8.0, 0.4), ("air", 0.0, 0.0), ("cradle", 8.0, 0.0)])
def test_uav_waits_higher_in_wind_for_an_arm_that_comes_and_not_above_one_that_has_let_it_go(
    landing_plan, start, wind, above
):
    """A station that a take-off never reached would be none: there the arm goes away."""
    sight = tell(telling(landing_plan, {"forecast": {"wind_mps": wind}}, start=start))["act"]["uav"]["sight"]
    assert sight["above"][0] == above


@pytest.mark.parametrize(("wind", "moves"), [(8.0, False), (0.0, True), (0.0, False)])
def test_uav_that_flies_in_rough_weather_is_asked_for_no_less_than_can_be_braked(wind, moves):
    """What its largest thrust brakes, W − F_min, is no more than what it has beyond its weight, F_max − W."""
    forecast = {"wind_mps": wind, "deck_moves": moves}
    told = plan(load_scenario("landing", {"forecast": forecast}), "landing").told["act"]["uav"][0]
    falls, brakes = told["weight"] - told["lift_min"], told["thrust_max"] - told["weight"]
    if wind or moves:
        assert falls == pytest.approx(brakes)
        assert told["lift_min"] > told["thrust_min"]
    else:
        assert told["lift_min"] == told["thrust_min"]
        assert falls > brakes


def test_null_space_is_told_the_pose_of_the_approach(landing_scenario):
    made = plan(landing_scenario, "landing")
    np.testing.assert_array_equal(made.told["act"]["realisation"]["posture"][0], made.home)
    assert made.told["act"]["realisation"]["posture_rate"][0] == 0.0
    rough = plan(landing_scenario.replaced({"control": {"posture_rad_s": 5.0}}), "landing")
    assert rough.told["act"]["realisation"]["posture_rate"][0] == 5.0
