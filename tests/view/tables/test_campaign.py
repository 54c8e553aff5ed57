"""Table of a campaign: the verdict, the worst seeds, bounds that fail."""

import pytest

from armland.experiments.campaign.summary import summarise
from armland.view.tables.campaign import print_campaign

BOUNDS = {"touchdown.speed_mps": 0.15, "hinge_force_max_n": 106.0}


@pytest.fixture
def printed(capsys, monkeypatch, tmp_path):
    monkeypatch.setenv("COLUMNS", "200")

    def of(rows):
        print_campaign(summarise(rows, BOUNDS), rows, "landing", tmp_path)
        return capsys.readouterr().out

    return of


def test_verdict_comes_first(printed, make_row):
    assert printed([make_row(1, 0.02), make_row(2, 0.03)]).startswith("2 of 2 landings succeed (95 % interval")


def test_failures_are_shown_with_reason_and_bound(printed, make_row):
    text = printed([make_row(1, 0.02), make_row(7, 0.3, success=False)])
    assert text.startswith("1 of 2 landings succeed")
    assert "1 failed (seed 7): touchdown at [too] high a speed" in text
    (line,) = (line for line in text.splitlines() if "touchdown speed" in line)
    assert "fails" in line
    assert " 7 " in line
    assert "≤ 0.15" in line
