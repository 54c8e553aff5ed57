"""The page of deviations that are too large: what it flies, what it counts, and that what is named is true."""

import pytest

from armland.mission.supervisor.table import FAULTS
from pages.deviations import BLOWN, MISSIONS, cases, markdown, record, true_of
from pages.truth import NONE

GOOD = {
    "mission": "landing",
    "what": "camera.noise",
    "size": 8.0,
    "seed": 1,
    "success": True,
    "state": "standing",
    "names": [],
}
ENDED = GOOD | {"success": False, "state": "flying", "reason": "ended", "names": ["camera_noise"]}


def test_every_row_gust_and_push_is_flown_in_both_missions():
    flown = {(c.mission, c.what) for c in cases()}
    for mission in MISSIONS:
        for what in ("uav.mass", "air.wind_mps", "link.burst", *(f"gust.{p}" for p in BLOWN[mission])):
            assert (mission, what) in flown


def test_names_that_are_true_are_names():
    for c in cases():
        assert true_of(c.what) <= {NONE, *FAULTS}


def test_page_counts_what_is_true_what_is_lost_and_which_rule_was_in_the_way():
    false = ENDED | {"seed": 2, "names": ["magnet_stuck"], "blind": GOOD}
    lost = ENDED | {"seed": 3, "names": [], "state": "lost", "reason": "fell; now it lies there"}
    saved = ENDED | {"seed": 4, "blind": GOOD | {"success": False, "state": "lost"}}
    page = markdown([GOOD, ENDED, false, lost, saved])
    assert "5 flights, 1 reach their goal. Of the 4 that do not, **3 say truly why**, 1 lose the UAV" in page
    assert "1 more would lose it, and 1 would reach the goal" in page
    assert page.count("- landing camera.noise at 8, seed 2: magnet_stuck.") == 2
    assert "- landing camera.noise at 8, seed 3: none; fell." in page


@pytest.mark.slow
@pytest.mark.parametrize(
    ("what", "name"), [("camera.noise", "camera_noise"), ("link.up_ms", "link_late"), ("uav.thrust", "thrust_lost")]
)
def test_deviation_that_ends_a_landing_is_named(what, name):
    """At eight times the published range."""
    case = max((c for c in cases() if (c.mission, c.what) == ("landing", what)), key=lambda c: (c.size, c.seed % 2))
    flight = record(case)
    assert (flight["success"], flight["names"]) == (False, [name])
