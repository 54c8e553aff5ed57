"""The page of a flight says what its result and its log say."""

import json
import re

import pytest

from armland.runtime.log import Log
from armland.view.page import flight as module
from armland.view.page.flight import flight_sheet
from armland.view.page.sheet import html
from armland.view.report import result_of


def titles(sheet) -> list[str]:
    return [s.title for s in sheet.sections]


@pytest.fixture(scope="module")
def result(landing_log) -> dict:
    return result_of([landing_log])


@pytest.fixture(scope="module")
def sheet(landing_log, result):
    return flight_sheet(landing_log, result, pictures=False)


def test_verdict_comes_first_and_sections_in_their_order(sheet, landing_page) -> None:
    assert (sheet.verdict.word, sheet.verdict.reason) == ("success", "landed")
    assert re.findall(r"<h2[^>]*>([^<]*)", landing_page) == ["success", "Do it again", *titles(sheet)]
    assert len(titles(sheet)) == 9


def test_figures_are_those_of_the_result(sheet, result) -> None:
    (grid,) = sheet.sections[titles(sheet).index("Figures")].grids
    rows = {r[0] if isinstance(r[0], str) else r[0].text: r for r in grid.rows}
    assert float(rows["hinge force max [N]"][1]) == pytest.approx(result["hinge_force_max_n"], abs=0.05)
    speeds = [r for r in grid.rows if r[0] == "speed [m/s]"]
    assert float(speeds[0][1]) == pytest.approx(result["touchdown"]["speed_mps"], abs=5e-4)
    assert speeds[0][2] == "at most 0.15"
    assert [r[3].text for r in grid.rows if r[3]].count("fails") == 0


def test_limits_count_the_ticks(sheet, landing_log) -> None:
    grid = sheet.sections[titles(sheet).index("Limits")].grids[0]
    rows = {r[0]: r for r in grid.rows}
    flags = landing_log.messages["health"]["flags"]
    assert int(rows["torque rate"][2]) == int((flags & 16 != 0).sum()) > 0
    speed = landing_log.messages["health"]["speed_ratio"].max()
    assert rows["joint speed, of the limit"][1].share == pytest.approx(speed)


def test_page_is_one_whole_file_that_loads_nothing(landing_page, taken_apart) -> None:
    found = taken_apart(landing_page)
    assert found.open == []
    assert len(set(found.ids)) == len(found.ids)
    for tag, attributes in found.tags:
        assert tag not in ("script", "iframe", "link", "object")
        for name in ("src", "href", "xlink:href"):
            assert attributes.get(name, "#").startswith(("#", "data:"))
    assert "http" not in re.sub(r'xmlns(:\w+)?="[^"]*"|http-equiv', "", landing_page)
    assert "prefers-color-scheme: dark" in landing_page
    assert "@media print" in landing_page
    assert len(landing_page) < 1_000_000


def test_tables_and_figures_have_names(landing_page, taken_apart) -> None:
    tags = taken_apart(landing_page).tags
    assert sum(t == "table" for t, _ in tags) == sum(t == "caption" for t, _ in tags) > 5
    assert all(a.get("scope") for t, a in tags if t == "th")
    pictures = [a for _, a in tags if a.get("role") == "img"]
    assert pictures
    assert all(len(a["aria-label"]) > 40 for a in pictures)


def test_what_stands_in_a_log_is_no_markup(landing_log, result, taken_apart) -> None:
    evil = '<script>alert(1)</script>"><b>'
    spoilt = Log(landing_log.ticks, {**landing_log.metadata, "law": evil}, {"scenario.toml": evil.encode()}, True)
    page = html(flight_sheet(spoilt, {**result, "reason": evil}, pictures=False))
    assert "<script" not in page
    found = taken_apart(page)
    assert found.text.count("alert(1)") >= 3


def test_failure_says_what_the_supervisor_did(failed_log, taken_apart) -> None:
    result = result_of([failed_log])
    sheet = flight_sheet(failed_log, result, pictures=False)
    assert sheet.verdict.word == "failure"
    text = taken_apart(html(sheet)).text
    assert "It found 1 fault." in text
    assert "fault rotor_lost" in text
    assert "led to balancing: the arm balances the UAV upright" in text
    assert "look at its motors" in text
    assert "belief" not in sheet.again.command or "belief.uav.mass_kg=0.5" in sheet.again.command
    grids = {g.caption: g for g in sheet.sections[titles(sheet).index("Plant against belief")].grids}
    assert [tuple(r) for r in grids["Set beliefs"].rows] == [("uav.mass_kg", "by its file", "0.5")]


def test_film_strip_is_there_or_says_why_not(landing_log, result, monkeypatch) -> None:
    monkeypatch.setenv("MUJOCO_GL", "disable")
    strip = module.strip(landing_log)
    assert strip.stills == ()
    assert "There is no film strip: no OpenGL" in strip.text[0]
    gone = json.loads(landing_log.metadata["scenario"])
    gone["arm"]["file"] = "/no/such/arm.urdf"
    lost = Log(landing_log.ticks, {**landing_log.metadata, "scenario": json.dumps(gone)}, {}, True)
    assert "cannot be composed here" in module.strip(lost).text[0]


@pytest.mark.slow
def test_film_strip_has_a_picture_of_each_phase(landing_log, result, taken_apart) -> None:
    strip = module.strip(landing_log)
    if not strip.stills:
        pytest.skip(strip.text[0])
    assert [s.name.replace(" ", "_") for s in strip.stills] == [p["name"] for p in result["phases"]]
    page = html(flight_sheet(landing_log, result))
    assert len(page) < 3_000_000
    images = [a for t, a in taken_apart(page).tags if t == "img"]
    assert len(images) == len(strip.stills)
    assert all(a["alt"] and a["src"].startswith("data:image/jpeg") for a in images)
