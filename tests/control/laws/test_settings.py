"""What the laws are told of a scenario: switches by their index, limits, and how far a fed-forward torque looks ahead."""

import numpy as np
import pytest

from armland.control.laws.rigid_body import ExactGains
from armland.control.laws.settings import preview, row_of, told
from armland.control.laws.table import ACCELERATIONS, EXTRA_TORQUES, SUPPORTS
from armland.errors import ConfigurationError
from armland.models.parameters import uav_parameters
from armland.scenario import load_scenario
from armland.scenario.control import Experiment

GAINS = ExactGains(np.full(6, 2.0), np.full(6, 3.0), 7.0, 35.0)


@pytest.mark.parametrize(
    ("link", "onboard", "rotors", "rate", "ticks"),
    [(25.0, 250, 0.05, 1000, 77), (10.0, 250, 0.05, 1000, 62), (25.0, 50, 0.05, 1000, 85), (26.0, 250, 0.02, 500, 24)],
)
def test_torque_looks_ahead_by_uplink_half_a_cycle_on_board_and_the_rotors_lag(link, onboard, rotors, rate, ticks):
    scenario = load_scenario(
        "paper",
        {
            "link": {"uplink_delay_ms": link, "rate_hz": 50},
            "onboard": {"rate_hz": onboard},
            "rotors": {"time_constant_s": rotors},
            "run": {"rate_hz": rate},
            "control": {"station": {"rate_hz": 50}},
        },
    )
    # The last: 26 ms, 2 ms and 20 ms are 24 ticks of 2 ms.
    assert preview(scenario) == ticks


def test_law_is_told_body_gains_rotors_and_limits():
    scenario = load_scenario("paper", {"control": {"takeover_limit_n": 4.5}, "tool": {"tool_mass_kg": 0.4}})
    body = uav_parameters(scenario)
    p = told(scenario, Experiment(), row_of("exact"), body, GAINS)[0]
    assert (p["mass"], p["k3_attitude"], p["k3"], p["tool_mass"]) == (body.mass, 7.0, 35.0, 0.4)
    np.testing.assert_array_equal(p["inertia"], body.inertia)
    np.testing.assert_array_equal(p["lever"], body.lever)
    np.testing.assert_array_equal([p["k1"], p["k2"]], [GAINS.k1, GAINS.k2])
    rotors = p["allocation"]
    np.testing.assert_allclose(rotors["mixer"] @ rotors["mixer_inverse"], np.eye(4), atol=1e-12)
    assert (rotors["low"], rotors["high"]) == (scenario.rotors.min_thrust_n, scenario.rotors.max_thrust_n)
    assert (p["takeover_limit"], p["attitude"]) == (4.5, 1)
    np.testing.assert_array_equal(p["torque_limit"], scenario.link.torque_limit_nm)


@pytest.mark.parametrize(
    ("switch", "words"),
    [
        ("extra_torque", EXTRA_TORQUES),
        ("acceleration", ACCELERATIONS),
        ("support", SUPPORTS),
        ("limits", (False, True)),
    ],
)
def test_switches_are_told_by_their_place_in_the_table(switch, words):
    scenario = load_scenario("paper")
    for i, word in enumerate(words):
        p = told(scenario, Experiment(**{switch: word}), row_of("paper"), uav_parameters(scenario), GAINS)
        assert p["limited" if switch == "limits" else switch][0] == i


@pytest.mark.parametrize(("name", "number"), [("classical", 0), ("paper", 1), ("exact", 2)])
def test_row_of_the_package_has_no_law_of_a_user(name, number):
    assert row_of(name) == (name, number, None)


@pytest.mark.parametrize("change", [{"k3_position": -1.0}, {"k3_attitude": 0.0}, {"k1": np.zeros(6)}])
def test_gains_without_a_proof_are_refused_for_any_row(change):
    scenario = load_scenario("paper")
    with pytest.raises(ConfigurationError, match="above 0"):
        told(scenario, Experiment(), row_of("paper"), uav_parameters(scenario), GAINS._replace(**change))
