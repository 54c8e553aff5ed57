"""Peaks of a touchdown by closed forms, beside an integrated one and a flown one, and the speed of lowering that follows."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from armland.errors import ConfigurationError
from armland.experiments.episode import fly
from armland.mission.feasibility.touchdown import LOWER_MPS, YIELDING, Blow, apparent_mass, gently, swinging, touchdown
from armland.mission.plan import plan
from armland.models.airframe.sizing import sized
from armland.scenario import load_scenario


@pytest.fixture(scope="module")
def blow(landing_scenario):
    made = plan(landing_scenario, "landing")
    gently(made.scenario, made.arm, made.home)
    return touchdown(landing_scenario, apparent_mass(made.arm))


@pytest.mark.parametrize(("stiffness", "damping"), [(1e4, 25.0), (1e4, 0.0), (3e3, 60.0)])
def test_pull_is_that_of_a_mass_on_a_damped_spring(stiffness, damping, landing_scenario):
    scenario = landing_scenario.replaced({"cradle": {"stiffness_npm": stiffness, "damping_nspm": damping}})
    mass, k, c = 7.0, 4.0 * stiffness, 4.0 * damping
    path = solve_ivp(
        lambda _, x: [x[1], -(k * x[0] + c * x[1]) / mass], (0.0, 0.1), [0.0, 1.0], max_step=1e-4, rtol=1e-9
    )
    # The spring's force where the mass stands still.
    assert touchdown(scenario, np.diag([9.0, 9.0, mass])).pull == pytest.approx(k * path.y[0].max(), rel=1e-3)


def test_shear_follows_from_the_apparent_mass_between_the_axes(landing_scenario):
    apparent = np.array([[11.0, 0.0, 3.0], [0.0, 5.0, 4.0], [3.0, 4.0, 10.0]])
    found = touchdown(landing_scenario, apparent)
    assert found.shear == pytest.approx(0.5 * found.pull)
    assert touchdown(landing_scenario, np.diag([11.0, 5.0, 10.0])).shear == 0.0


def test_speed_is_one_at_which_pull_and_shear_take_the_magnets_share():
    assert Blow(600.0, 0.0).speed(100.0, 0.6, 0.2) == pytest.approx(0.1)
    v = Blow(500.0, 300.0).speed(100.0, 0.6, 0.2)
    assert 0.6 * 0.2 * (100.0 - 500.0 * v) == pytest.approx(300.0 * v)


def test_flown_peaks_are_near(blow, landing_scenario):
    flown = fly(landing_scenario, "landing", 1)
    force = flown.ticks["truth"]["hinge_force"][flown.ticks["truth"]["cradle_force"][:, 2] > 0.5]
    assert LOWER_MPS * blow.pull == pytest.approx(-force[:, 2].min(), rel=0.2)
    assert LOWER_MPS * blow.shear == pytest.approx(np.linalg.norm(force[:, :2], axis=1).max(), rel=0.3)


def test_weaker_magnet_is_lowered_more_slowly_and_a_strong_one_no_faster(blow, landing_scenario):
    weak = plan(
        landing_scenario.replaced({"magnet": {"rating_n": 60.0}}), "landing"
    ).scenario.control.approach.lower_mps
    assert weak == pytest.approx(0.8 * blow.speed(60.0, 0.6, 0.2))
    assert weak < 0.02
    strong = landing_scenario.replaced({"magnet": {"rating_n": 900.0}})
    assert plan(strong, "landing").scenario.control.approach.lower_mps == LOWER_MPS


def test_speed_that_is_set_is_taken_or_refused_with_what_would_do(landing_scenario):
    weak = landing_scenario.replaced({"magnet": {"rating_n": 60.0}, "control": {"approach": {"lower_mps": 0.03}}})
    with pytest.raises(
        ConfigurationError, match=r"may be at most (0\.0\d\d) m/s, or the rating at least (\d+) N"
    ) as refusal:
        plan(weak, "landing")
    most = float(str(refusal.value).split("at most ")[1].split(" ")[0])
    slow = weak.replaced({"control": {"approach": {"lower_mps": most - 1e-3}}})
    assert plan(slow, "landing").scenario.control.approach.lower_mps == most - 1e-3
    rating = float(str(refusal.value).split("at least ")[1].split(" ")[0])
    plan(weak.replaced({"magnet": {"rating_n": rating + 1.0}}), "landing")


@pytest.mark.slow
def test_magnet_whose_shear_failed_at_the_usual_speed_lands(landing_scenario):
    weak = landing_scenario.replaced({"magnet": {"rating_n": 60.0}, "deviation": {"level": "published"}})
    assert fly(weak, "landing", 1).result["success"]


@pytest.mark.parametrize(("apparent", "stiffness"), [(7.7, 4e4), (7.7, 2.5e3), (30.0, 4e4)])
def test_rate_of_giving_way_is_where_the_arm_begins_to_swing(apparent, stiffness):
    """The poles of an arm led by a double pole against a spring, its reference drawn back by the spring's force."""
    pole, mass = 25.0, np.diag([0.1, 0.1, apparent])
    limit = swinging(mass, stiffness, pole)
    for share, swings in ((0.45, False), (0.99, False), (1.01, True)):
        g = share * limit
        poles = np.roots([1.0, 2.0 * pole, pole**2 + stiffness / apparent, g * stiffness * pole**2])
        assert (poles.real.max() > 0.0) == swings
    # Sideways the skids stick: a spring as stiff as you like.
    stiff = np.roots(
        [1.0, 2.0 * pole, pole**2 + 1e9 / apparent, 1e9 * pole**2 * swinging(apparent * np.eye(3), 1e9, pole)]
    )
    assert abs(stiff.real).min() < 1e-2


def test_arm_under_a_light_uav_gives_way_as_it_can_follow():
    made = plan(sized(load_scenario("landing", {"airframe": "crazyflie"})), "landing")
    given, approach = made.scenario, made.scenario.control.approach
    limit = swinging(apparent_mass(made.arm), 4.0 * given.cradle.stiffness_npm, given.control.free_rad_s)
    assert approach.give_way_mpns <= YIELDING * limit
    # By its weight alone it would be drawn back faster than it can follow.
    assert limit < 3e-3 * 0.48 / 0.0379
    own = load_scenario("landing", {"airframe": "crazyflie", "control": {"approach": {"give_way_mpns": 0.02}}})
    assert plan(sized(own), "landing").scenario.control.approach.give_way_mpns == 0.02
