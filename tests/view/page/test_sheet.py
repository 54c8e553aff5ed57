"""What the template makes of a page: cells, groups, marks, pictures, what is folded away."""

import re

import pytest

from armland.view.page.again import Again
from armland.view.page.grid import Cell, Grid, holds
from armland.view.page.merits import Tile
from armland.view.page.pictures import Drawing
from armland.view.page.sheet import Piece, Section, Sheet, Still, Verdict, html, settings_grid, write_page

GRID = Grid(
    "Rows & columns",
    ("what", "found"),
    [(Cell("group <one>", "group"), ""), ("a", Cell("7", share=0.25)), ("b", holds(False)), ("c", holds(None))],
)


@pytest.fixture
def sheet() -> Sheet:
    return Sheet(
        "run & seed",
        "of <something>",
        Verdict("failure", False, "it fell"),
        [Tile("speed", "0.2 m/s", "at most 0.15 m/s", "bad"), Tile("duration", "16 s", "", "")],
        [
            Section("Pictures", stills=[Still("data:image/jpeg;base64,AAAA", "close", "1 to 2 s")]),
            Section("Phases", ["First."], bar=[Piece("long", 80.0, "8 s"), Piece("short", 2.0, "0.2 s")]),
            Section("Curves", drawings=[Drawing("Over time", "What it shows.", '<svg viewBox="0 0 1 1"></svg>')]),
            Section("Numbers", grids=[GRID], unfolded=[("A file", "x = '<b>'")]),
        ],
        Again("armland land --set 'a=\"b\"'", "base = 1"),
    )


def test_page_is_well_formed_and_says_everything(sheet, taken_apart) -> None:
    found = taken_apart(html(sheet))
    assert found.open == []
    for words in (
        "run & seed",
        "of <something>",
        "failure",
        "it fell",
        "0.2 m/s",
        "at most 0.15 m/s : exceeded",
        "First.",
    ):
        assert words.replace(" :", ":") in found.text.replace(" :", ":")
    assert "armland land --set 'a=\"b\"'" in found.text
    assert "save it first" in found.text
    assert "x = '<b>'" in found.text


def test_bar_has_a_piece_for_each_phase_and_words_where_there_is_room(sheet, taken_apart) -> None:
    page = html(sheet)
    assert re.findall(r"flex-grow:([\d.]+)", page) == ["80.000", "2.000"]
    assert taken_apart(page).text.count("short") == 0


def test_cells_carry_marks_bars_and_groups(sheet) -> None:
    page = html(sheet)
    assert 'colspan="2">group &lt;one&gt;' in page
    assert "width:25%" in page
    assert '<span class="bad">fails</span>' in page
    assert ">not judged<" in re.sub(r"\s*\n\s*", "", page)
    assert "<caption>Rows &amp; columns</caption>" in page


def test_caption_that_only_repeats_the_title_is_for_readers_aloud(sheet) -> None:
    same = sheet._replace(sections=[Section("Rows & columns", grids=[GRID])])
    assert '<caption class="same">' in html(same)


def test_page_without_a_command_or_tiles_has_none(sheet, taken_apart) -> None:
    found = taken_apart(html(sheet._replace(again=None, tiles=[])))
    assert "Do it again" not in found.text
    assert not any(t == "dl" for t, _ in found.tags)


def test_file_is_written_into_a_new_folder(sheet, tmp_path) -> None:
    path = write_page(tmp_path / "new", sheet)
    assert path == tmp_path / "new" / "report.html"
    assert path.read_text(encoding="utf-8") == html(sheet)


def test_settings_are_words() -> None:
    grid = settings_grid("Configuration", {"seed": 7, "law": "exact"})
    assert [tuple(r) for r in grid.rows] == [("seed", "7"), ("law", "exact")]
    assert grid.left == (0, 1)
