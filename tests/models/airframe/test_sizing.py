"""Values by rule from a UAV's size: the AR.Drone keeps its own, the user's always win, physics scales as it should."""

import numpy as np
import pytest

from armland.control.design.gains import Wanted, exact_gains
from armland.errors import ConfigurationError
from armland.models.airframe.sizing import RULES, at, size_of, sized
from armland.models.parameters import uav_parameters
from armland.scenario import load_scenario


def other(factor, **more):
    """The AR.Drone times `factor` in mass and inertia."""
    inertia = (factor * np.diag([0.006, 0.007, 0.012])).tolist()
    return load_scenario("landing", {"uav": {"mass_kg": factor * 0.48, "inertia_kgm2": inertia}, **more})


@pytest.mark.parametrize("name", ["landing", "paper", "compare"])
def test_the_ar_drone_keeps_its_values(name):
    scenario = load_scenario(name)
    assert sized(scenario).model_dump() == scenario.model_dump()
    assert sized(scenario).sized


def test_a_load_and_a_wrong_belief_make_no_other_uav_of_what_is_built():
    loaded = load_scenario("landing", {"uav": {"extra_mass_kg": 0.1}})
    assert sized(loaded).model_dump() == loaded.model_dump()
    wrong = sized(load_scenario("landing", {"belief": {"uav": {"mass_kg": 0.576}}}))
    assert wrong.rotors == loaded.rotors
    assert wrong.limits.unexplained_n == pytest.approx(1.2 * 2.5)


@pytest.mark.parametrize("mass", [0.384, 0.48, 0.576])
def test_its_own_hover_may_ask_for_what_the_rotors_give_whatever_it_is_thought_to_weigh(mass):
    """As large a share of it as the ceiling of the thrust that is commanded; 1.35 times too small a weight would let it sink."""
    s = sized(load_scenario("landing", {"belief": {"uav": {"mass_kg": mass}}}))
    assert s.onboard.hover.thrust_max_n == pytest.approx(
        s.control.thrust.ceiling * 4.0 * s.rotors.max_thrust_n, rel=2e-3
    )
    strong = sized(load_scenario("landing", {"airframe": "crazyflie", "rotors": {"max_thrust_n": 0.25}}))
    assert strong.onboard.hover.thrust_max_n == pytest.approx(0.94, rel=2e-3)


def test_attitude_loops_have_the_same_poles():
    """k_p/J and k_d/J are the square of a frequency and a damping: of all UAVs of one rotor lag."""
    big, small = sized(other(7.0)), load_scenario("landing")
    for name in ("kp_nm", "kd_nms"):
        np.testing.assert_allclose(getattr(big.onboard, name), 7.0 * np.array(getattr(small.onboard, name)), rtol=1e-12)
    slow = sized(other(1.0, rotors={"time_constant_s": 0.1}))
    np.testing.assert_allclose(slow.onboard.kp_nm, 0.25 * np.array(small.onboard.kp_nm))
    assert slow.onboard.lead_s == pytest.approx(0.1)
    # No faster than the samples bear, however quick the rotors are.
    quick = sized(other(1.0, rotors={"time_constant_s": 0.005}))
    np.testing.assert_allclose(quick.onboard.kp_nm, 4.0 * np.array(small.onboard.kp_nm))


@pytest.mark.parametrize("inertia", [(0.0031, 0.0031, 0.0031), (0.006, 0.024, 0.028), (0.02, 0.005, 0.024)])
def test_cubes_and_slender_bodies_get_gains_that_the_law_can_have(inertia):
    scenario = sized(load_scenario("landing", {"uav": {"mass_kg": 0.83, "inertia_kgm2": np.diag(inertia).tolist()}}))
    body, wanted = uav_parameters(scenario), Wanted(8.0, 1.0)
    gains = exact_gains(wanted, np.array(scenario.onboard.kp_nm), np.array(scenario.onboard.kd_nms), body)
    k1, k2, k3 = gains.k1[:3] / 4.0, gains.k2[:3], gains.k3_attitude / 4.0
    np.testing.assert_allclose(k1 * k2 + k3, scenario.onboard.kp_nm)
    assert min(k3, *k1, *k2) > 0.0
    # In proportion to each axis's own inertia alone no k3 serves them all.
    share = np.array(inertia) / [0.006, 0.007, 0.012]
    with pytest.raises(ConfigurationError, match="leave no gains"):
        exact_gains(wanted, share * [0.4, 0.4, 0.3], share * [0.056, 0.056, 0.06], body)


def test_rotors_nearer_by_four_lag_half_as_long_and_the_loop_follows():
    """The time of falling a length goes with its root; wider rotors lag no more than the AR.Drone's."""
    near, wide = (sized(other(1.0, rotors={"place_m": placed(reach)})) for reach in (0.25, 4.0))
    assert near.rotors.time_constant_s == near.onboard.lead_s == pytest.approx(0.025)
    np.testing.assert_allclose(near.onboard.kp_nm, 4.0 * np.array(wide.onboard.kp_nm))
    assert wide.rotors.time_constant_s == 0.05
    assert sized(other(1.0, rotors={"place_m": placed(0.25), "time_constant_s": 0.05})).onboard.lead_s == 0.05


def placed(share):
    """The AR.Drone's rotors at a share of their distance from the middle."""
    d = share * 0.127
    return [[d, -d, 0.03], [-d, -d, 0.03], [-d, d, 0.03], [d, d, 0.03]]


def test_forces_over_weight_and_times_are_kept():
    big = sized(other(5.0))
    for key in ("limits.unexplained_n", "bounds.pull_test_n", "control.thrust.rate_nps", "onboard.hover.lift_min_n"):
        assert at(big, key) == pytest.approx(5.0 * at(load_scenario("landing"), key))
    # Frequency and damping of what comes down on the buffers: k/m and c/m.
    assert big.cradle.stiffness_npm / 5.0 == pytest.approx(1e4)
    assert big.cradle.mass_kg == pytest.approx(1.5)


def test_what_the_user_sets_is_kept():
    kept = sized(other(5.0, limits={"unexplained_n": 3.0}, onboard={"kp_nm": [9.0, 9.0, 5.0]}))
    assert kept.limits.unexplained_n == 3.0
    assert kept.onboard.kp_nm == (9.0, 9.0, 5.0)
    assert kept.limits.load_gone_n == pytest.approx(10.0)
    changed = sized(load_scenario("landing").replaced({"uav": {"mass_kg": 2.4}, "bounds": {"pull_test_n": 2.5}}))
    assert changed.bounds.pull_test_n == 2.5


def test_skids_and_marker_are_as_far_below_the_pivot_whatever_the_lever():
    """The cradle, the arm below it and the camera's distance stay what they are."""
    own, long = (sized(load_scenario("landing", o)) for o in ({}, {"uav": {"lever_m": [0.0, 0.0, -0.2]}}))
    for place in (lambda s: s.skids.z_m, lambda s: s.camera.marker_m[2]):
        assert place(long) + 0.2 == pytest.approx(place(own) + 0.06)


def test_once_is_enough():
    once = sized(other(5.0))
    assert sized(once.with_seed(7)).limits == once.limits


def test_rules_name_keys_that_there_are():
    scenario, size = load_scenario("landing"), size_of(load_scenario("landing"))
    for rule in RULES:
        at(scenario, rule.key)
        assert np.all(np.equal(rule.factor(size), 1.0)), rule.key


@pytest.mark.parametrize("factor", [0.25, 4.0, 50.0])
def test_magnet_is_as_large_as_its_rating_and_the_plate_covers_it(factor):
    scenario, own = sized(other(factor)), load_scenario("landing")
    grown = scenario.magnet.rating_n / own.magnet.rating_n
    assert scenario.magnet.pad_radius_m == pytest.approx(own.magnet.pad_radius_m * grown**0.25)
    beyond = scenario.plate.radius_m - scenario.magnet.pad_radius_m
    assert beyond == pytest.approx(own.plate.radius_m - own.magnet.pad_radius_m)
