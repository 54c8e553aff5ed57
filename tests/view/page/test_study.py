import pytest

from armland.experiments.campaign.summary import summarise
from armland.experiments.episode import fly, prepare
from armland.experiments.judge.figures import bounds
from armland.runtime.log import Log
from armland.scenario import load_scenario
from armland.view.page import study
from armland.view.page.sheet import Section, html
from armland.view.page.study import campaign_sheet, comparison_sheet, paper_sheet
from armland.view.report import result_of


@pytest.fixture(scope="module")
def flight():
    return prepare(load_scenario("landing", {"run": {"duration_s": 20.0}}), "landing", seed=11)


def test_campaign_says_how_many_and_which_fail(flight, make_row, taken_apart) -> None:
    rows = [make_row(11 + i, 0.02 + 0.001 * i, success=i != 3) for i in range(6)]
    limits = bounds(flight.brief)
    sheet = campaign_sheet(summarise(rows, limits), rows, limits, flight)
    assert sheet.verdict.word == "5 of 6 succeed"
    assert not sheet.verdict.good
    assert sheet.again.command == "armland land --seed 11 --set run.duration_s=20.0 --seeds 6"
    found = taken_apart(html(sheet))
    assert found.open == []
    assert "touchdown at [too] high a speed" in found.text
    assert "armland land --seed 14 --set run.duration_s=20.0" in found.text
    tile = next(t for t in sheet.tiles if t.name == "touchdown speed, worst")
    assert (tile.value, tile.bound, tile.mark) == ("0.025 m/s", "at most 0.15 m/s", "good")


def test_campaign_without_failures_says_so(flight, make_row) -> None:
    rows = [make_row(11 + i, 0.02) for i in range(3)]
    limits = bounds(flight.brief)
    sheet = campaign_sheet(summarise(rows, limits), rows, limits, flight)
    assert sheet.verdict.good
    assert sheet.sections[0].text == ["No flight failed."]


@pytest.fixture(scope="module")
def logs():
    out = []
    for name in ("E1", "E2"):
        episode = fly(load_scenario("paper"), name)
        metadata = {**episode.metadata, "version": "0.1.0", "joints": "7"}
        out.append(Log(episode.ticks, metadata, {"scenario.toml": load_scenario("paper").text.encode()}, True))
    return out


@pytest.mark.slow
def test_paper_page_has_claims_and_figures(logs, monkeypatch, taken_apart) -> None:
    monkeypatch.setattr(study, "strip", lambda log: Section("Film strip"))
    result = result_of(logs)
    sheet = paper_sheet(logs, result)
    held = sum(v["holds"] for v in result["verdicts"])
    assert sheet.verdict.word == f"{held} of {len(result['verdicts'])} claims hold"
    assert sheet.again.command == "armland paper --seed 1"
    found = taken_apart(html(sheet))
    assert found.open == []
    assert len(set(found.ids)) == len(found.ids)
    assert sum(a.get("role") == "img" for _, a in found.tags) == 7
    assert "`" not in " ".join(v[0] for v in sheet.sections[0].grids[0].rows)


def test_comparison_page(taken_apart) -> None:
    def row(law: str, attitude: float) -> dict:
        metrics = {
            "attitude_max_deg": attitude,
            "position_rms_m": [1e-3, 2e-3, 3e-3],
            "position_max_m": [1e-3, 2e-3, 5e-3],
        }
        return {"condition": "model x 1", "law": law, "metrics": metrics, "resting_swing_deg": 0.2}

    verdict = {"claim": "better", "value": 0.3, "bound": [0.0, 0.2], "holds": False}
    result = {"rows": [row("E3", 6.8), row("mine", 0.4)], "verdicts": [verdict]}
    sheet = comparison_sheet(result, load_scenario("compare"), "law.py:mine")
    assert (sheet.verdict.word, sheet.verdict.good) == ("0 of 1 claims hold", False)
    assert sheet.verdict.reason == "Missed: better."
    assert sheet.again.command == "armland paper --compare --law law.py:mine --seed 1"
    assert "1.00/2.00/3.00" in taken_apart(html(sheet)).text
