"""The table of what differs: each row changes the plant or the belief, and the page counts."""

import pytest

from armland.scenario import load_scenario
from pages.differences import FIRST, differences, markdown, missing

GOOD = {"row": "mass + 20 %", "seed": FIRST, "success": True, "state": "standing", "reason": "landed"}


@pytest.mark.parametrize("row", [row for row in differences() if row != "nothing"])
def test_row_is_a_scenario_that_differs(row):
    assert load_scenario("landing", differences()[row]) != load_scenario("landing", differences()["nothing"])


def test_page_counts_and_says_why():
    lost = {
        **GOOD,
        "seed": FIRST + 1,
        "success": False,
        "state": "lost",
        "reason": "ended in abort after guide: thrust_lost, it sinks (a); now",
    }
    page = markdown([GOOD, lost])
    assert "| mass + 20 % | 1 of 2 | 9.5 to 90.5 % | 1 | ended in abort after guide: thrust_lost |" in page
    assert "link of" not in page.partition("|---|")[2]


def test_what_is_there_is_not_flown_again():
    assert missing([GOOD], 2, "mass + 20 %") == [("mass + 20 %", FIRST + 1)]
    assert len(missing([], 2, "mass*")) == 6
