"""Values that a user sets and that cannot work: refused with the bound, accepted just beyond it."""

import pytest

from armland.errors import ConfigurationError
from armland.mission.belief import flyer
from armland.mission.feasibility.by_hand import check_by_hand
from armland.scenario import load_scenario


def check(**onboard):
    scenario = load_scenario("landing", {"onboard": onboard})
    check_by_hand(scenario, flyer(scenario))


@pytest.mark.parametrize(
    ("good", "bad", "words"),
    [
        (
            {"hover": {"thrust_max_n": 5.46}},
            {"hover": {"thrust_max_n": 5.4}},
            r"thrust_max_n = 5.4 N lets a UAV of 5.18 N sink",
        ),
        (
            {"hover": {"lift_min_n": 4.39}},
            {"hover": {"lift_min_n": 4.5}},
            r"lift_min_n = 4.5 N lets a UAV of 5.18 N rise",
        ),
        ({"kp_nm": [0.29, 0.29, 0.1]}, {"kp_nm": [0.28, 0.29, 0.1]}, r"0.28 N·m/rad in roll .* above m g l = 0.283"),
    ],
)
def test_bounds(good, bad, words):
    check(**good)
    with pytest.raises(ConfigurationError, match=words):
        check(**bad)
