"""Gains of an experiment: given, or by rule for ground and board."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.mission.tuning import DERIVATIVE_LAG_S, designed, fitted, tuned
from armland.scenario import load_scenario


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


def test_low_pass_on_board_is_the_one_that_the_rule_reckons_with():
    from armland.plant.devices import attitude

    assert DERIVATIVE_LAG_S == attitude.DERIVATIVE_LAG_S


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
