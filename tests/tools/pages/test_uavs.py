"""The table of UAVs that were flown counts what landed and took off, and says which seed did not and why."""

import numpy as np
import pytest

from armland.models.parameters import uav_parameters
from pages.uavs import CASES, FIRST, Case, flights, markdown, missing, scenario_of

GOOD = {"case": "`x500`", "mission": "landing", "seed": FIRST, "success": True, "state": "standing", "reason": "landed"}
FIGURES = {"speed": 0.03, "tilt": 0.4, "offset": 6.0}


def test_table_tells_worst_of_what_landed_and_why_the_others_did_not():
    fell = GOOD | {"seed": FIRST + 1, "success": False, "state": "lost", "reason": "it fell (0.3 m); now", "speed": 9.0}
    page = markdown([GOOD | FIGURES, GOOD | FIGURES | {"seed": FIRST + 2, "speed": 0.05}, fell])
    assert "| `x500` | 2 of 3 | 0.050 m/s | 0.4° | 6.0 mm |  | landing 130002 lost: it fell |" in page


def test_what_is_there_is_not_flown_again_and_a_refusal_is_told_once():
    seeds = range(FIRST, FIRST + 12)
    refused = {**GOOD, "mission": "takeoff", "success": False, "state": "refused", "reason": "too heavy"}
    left = [(case.name, case.mission, some) for case, some in missing([GOOD, refused], seeds) if case.name == "`x500`"]
    assert left == [("`x500`", "landing", [*range(FIRST + 1, FIRST + 11)]), ("`x500`", "landing", [FIRST + 11])]


@pytest.mark.parametrize(("wrong", "share"), [("mass", 0.8), ("thrust", 1.2), ("inertia", 0.8)])
def test_what_is_believed_wrongly_is_the_controllers_alone(wrong, share):
    true, scenario = scenario_of(Case("ardrone2")), scenario_of(Case("ardrone2", wrong=wrong, share=share))

    def told(s):
        body = uav_parameters(s)
        return np.array([body.mass, s.rotors.max_thrust_n, *np.diag(body.inertia)])

    np.testing.assert_array_equal(told(scenario), told(true))
    ratio = told(scenario.believed()) / told(true)
    expected = {"mass": [share, 1, 1, 1, 1], "thrust": [1, share, 1, 1, 1], "inertia": [1, 1, share, share, share]}
    np.testing.assert_allclose(ratio, expected[wrong], rtol=1e-9)


def test_refused_uav_is_a_row():
    assert [r["state"] for r in flights(Case("octo25"), [1, 2])] == ["refused"]


def test_cases_are_named_once():
    assert len({(c.name, c.mission) for c in CASES}) == len(CASES)
