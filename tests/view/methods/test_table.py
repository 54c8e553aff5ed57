"""The table of methods on the terminal: what stands in it, and that nothing is cut off."""

import numpy as np
import pytest

from armland.experiments.methods.comparison import FIGURES, Flights, Rate
from armland.view.methods.figure import methods_page
from armland.view.methods.table import against, percent, print_methods


def flights(name, success, speed):
    n = len(success)
    good = np.array(success, bool)
    figures = {key: np.full(n, speed) for key in FIGURES}
    reasons = {"tilt of the UAV then": int((~good).sum())} if (~good).any() else {}
    return Flights(name, np.arange(n), good, good, ~good, figures, {"touchdown.speed_mps": 0.25}, reasons)


@pytest.fixture
def two():
    return [flights("arm", [1, 1, 1, 1, 0], 0.04), flights("unassisted-untimed", [1, 0, 0, 0, 0], 0.2)]


def test_rates_have_as_many_digits_as_flights_give():
    assert percent(Rate(3, 4, 0.30, 0.954)) == "75 [30, 95]"
    assert percent(Rate(999, 1000, 0.9943, 0.9998)) == "99.9 [99.4, 100.0]"


def test_a_method_against_the_first_in_words(two):
    text = against(two[0], two[1], "success", "keeps all criteria")
    assert text.startswith("unassisted-untimed keeps all criteria -60.0 %")
    assert "over 5 seeds: 0 only it, 3 only arm, McNemar p = 0.25" in text


def test_table_says_all(two, capsys, tmp_path):
    print_methods(two, "calm air, 5 flights of each", tmp_path)
    text = capsys.readouterr().out
    for words in (
        "calm air",
        "arm",
        "unassisted-untimed",
        "80 [",
        "20 [",
        "0.04 / 0.04",
        "speed (m/s) ≤ 0.25",
        "4 x tilt",
    ):
        assert words in text


def test_figure_shows_each_method_and_each_bound(two):
    page = methods_page(two, "calm air")
    rates, *spreads = page.axes
    assert [t.get_text() for t in rates.get_yticklabels()] == ["arm", "unassisted-untimed"]
    assert len(spreads) == len(FIGURES)
    # The curve ends at the share of flights that touched down; the bound is the dashed line.
    steps = spreads[0].get_lines()
    assert [float(line.get_ydata()[-1]) for line in steps[:2]] == [100.0, 100.0]
    assert float(steps[2].get_xdata()[0]) == 0.25


def test_a_method_that_never_touched_down_is_no_good_one():
    never = flights("b", [0, 0], np.nan)
    page = methods_page([flights("a", [1, 1], 0.1), never], "calm air")
    assert len(page.axes[1].get_lines()) == 2
