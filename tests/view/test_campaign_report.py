"""Table and page of a campaign: the verdict, the worst seeds, bounds that fail, and one panel per figure."""

import numpy as np
import pytest

from armland.experiments.campaign_summary import summarise
from armland.experiments.landing import LandingOutcome
from armland.experiments.landing_judge import PhaseTime
from armland.view.campaign_report import campaign_page, draw_campaign, print_campaign


def outcome(seed, speed, success=True):
    touchdown = {"speed_mps": speed, "tilt_deg": 0.2, "offset_m": 0.002}
    capture = {"offset_m": 0.001, "relative_speed_mps": 0.12, "tilt_deg": 1.0}
    reason = "landed" if success else "touchdown at [too] high a speed"
    return LandingOutcome(
        success, reason, [PhaseTime("done", 0.0, 17.0)], 0, capture, touchdown, 27.0, 0.3, [], 20.0, seed=seed
    )


@pytest.fixture
def printed(capsys, monkeypatch, tmp_path):
    monkeypatch.setenv("COLUMNS", "200")

    def of(outcomes):
        print_campaign(summarise(outcomes, 106.0), "landing", tmp_path)
        return capsys.readouterr().out

    return of


def test_verdict_comes_first(printed):
    assert printed([outcome(1, 0.02), outcome(2, 0.03)]).startswith("2 of 2 landings succeed (95 % interval")


def test_failures_are_shown_with_reason_and_bound(printed):
    text = printed([outcome(1, 0.02), outcome(7, 0.3, success=False)])
    assert text.startswith("1 of 2 landings succeed")
    assert "1 failed: touchdown at [too] high a speed" in text
    (line,) = (line for line in text.splitlines() if "touchdown speed" in line)
    assert "fails" in line
    assert " 7 " in line
    assert "≤ 0.15" in line


def test_page_has_a_panel_for_each_figure_and_shows_every_flight():
    page = campaign_page([outcome(i, 0.01 * i) for i in range(1, 6)], 106.0)
    (panel,) = (a for a in page.axes if a.get_xlabel().startswith("touchdown speed"))
    shown = np.concatenate([line.get_xdata() for line in panel.lines[:2]])
    np.testing.assert_allclose(np.sort(shown), [0.01, 0.02, 0.03, 0.04, 0.05])
    assert not any(a.get_xlabel().startswith("release") for a in page.axes)


def test_files_repeat_byte_for_byte(tmp_path):
    flights = [outcome(1, 0.02), outcome(2, 0.03)]
    first = [p.read_bytes() for p in draw_campaign(tmp_path / "a", flights, 106.0, "landing")]
    second = [p.read_bytes() for p in draw_campaign(tmp_path / "b", flights, 106.0, "landing")]
    assert first == second
