"""Gains of an experiment: given, or by rule for ground and board."""

import numpy as np
import pytest

from armland.control.design.gains import DERIVATIVE_LAG_S
from armland.errors import ConfigurationError
from armland.mission.tuning import designed, fitted, tuned
from armland.scenario import load_scenario
from armland.scenario.control import Poles


def test_experiment_without_a_rule_keeps_the_scenarios_gains():
    scenario = load_scenario("compare")
    assert tuned(scenario, "E1").control == scenario.control


def test_rule_sets_ground_and_board_to_the_same_design():
    scenario = load_scenario("compare")
    rule = scenario.experiments["split"].rule
    found = tuned(scenario, "split")
    design = designed(scenario, rule, True, scenario.experiments["split"].onboard)
    np.testing.assert_allclose(found.onboard.kp_nm, design.kp)
    np.testing.assert_allclose(found.control.k1, design.gains.k1)
    assert found.control.k3_attitude == design.gains.k3_attitude


def test_poles_that_the_delays_do_not_allow_are_refused():
    fast = {"experiments": {"split": {"rule": {"attitude_rad_s": 200.0}}}}
    with pytest.raises(ConfigurationError, match="bandwidth"):
        tuned(load_scenario("compare", fast), "split")


def test_what_flies_has_the_rows_controller_and_nothing_else_that_is_believed():
    scenario = load_scenario(
        "compare", {"belief": {"onboard": {"kp_nm": [0.5, 0.5, 0.4], "rate_hz": 250}, "uav": {"mass_kg": 0.6}}}
    )
    plain = fitted(scenario, tuned(scenario.believed(), "E1"), "E1")
    assert (plain.onboard, plain.uav) == (scenario.onboard, scenario.uav)
    believed = tuned(scenario.believed(), "split")
    ruled = fitted(scenario, believed, "split")
    assert ruled.onboard.controller == "cascade"
    # The rule's gains come from the believed mass: whoever sets them on board knows no better.
    assert ruled.onboard.kp_nm == believed.onboard.kp_nm != tuned(scenario, "split").onboard.kp_nm
    assert ruled.onboard.rate_hz == scenario.onboard.rate_hz


def delays_of(monkeypatch, which, overrides=None, **arguments):
    """Delays, and what else a rule is given in s, of what `designed` asks a rule for."""
    asked = []
    monkeypatch.setattr(f"armland.mission.tuning.{which}", lambda *given: asked.append(given))
    scenario = load_scenario("landing", overrides)
    designed(
        scenario, Poles(position_rad_s=4.0, position_damping=0.9, attitude_rad_s=8.0, attitude_damping=0.7), **arguments
    )
    ((position, attitude, _, delays, *rest),) = asked
    assert (tuple(position), tuple(attitude)) == ((4.0, 0.9), (8.0, 0.7))
    return delays, rest


def test_torque_over_the_link_is_late_by_both_ways_and_half_of_each_period(monkeypatch):
    """25 ms up, 12 ms down, half of the link's 5 ms and half of the 5 ms on board; through the arm a tick and a half."""
    delays, _ = delays_of(monkeypatch, "rule", on_board=False)
    np.testing.assert_allclose(delays, [0.025 + 0.012 + 0.0025 + 0.0025, 0.0015, 0.05])


@pytest.mark.parametrize(("lead", "left"), [(0.05, 0.01), (0.03, 0.03), (0.08, 0.01)])
def test_feedback_on_board_is_late_by_its_period_and_the_lag_that_its_lead_leaves(monkeypatch, lead, left):
    """The cascade makes up for the rotors' 50 ms by its lead, behind a low pass of 10 ms; the feed-forward travels."""
    onboard = load_scenario("landing", {"onboard": {"lead_s": lead}}).onboard
    delays, (travel,) = delays_of(monkeypatch, "onboard_rule", onboard=onboard)
    np.testing.assert_allclose(delays, [0.005, 0.0015, left])
    assert travel == pytest.approx(0.025 + 0.012 + 0.0025)


def test_controller_without_a_lead_has_all_of_the_rotors_lag(monkeypatch):
    onboard = load_scenario("landing", {"onboard": {"controller": "quaternion_pd", "lead_s": 0.0}}).onboard
    delays, _ = delays_of(monkeypatch, "onboard_rule", onboard=onboard)
    assert delays.rotor_lag == pytest.approx(0.05)


def test_controller_that_is_not_named_is_a_cascade_that_makes_up_for_the_lag(monkeypatch):
    delays, _ = delays_of(monkeypatch, "onboard_rule", {"rotors": {"time_constant_s": 0.08}})
    assert delays.rotor_lag == pytest.approx(DERIVATIVE_LAG_S)
