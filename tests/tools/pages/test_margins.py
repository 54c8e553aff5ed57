import re
import tomllib
from pathlib import Path

import pytest

from armland.scenario import load_scenario
from armland.scenario.deviation import LEVELS, rows
from pages.margins import BEGIN, told_by, with_deviations

PAGE = Path(__file__).parents[3] / "docs" / "margins.md"


def test_page_is_up_to_date() -> None:
    text = PAGE.read_text("utf-8")
    assert text == with_deviations(text), "run: make pages"


def test_a_row_that_is_gone_is_noticed() -> None:
    text = PAGE.read_text("utf-8")
    # The last one: above it stands what was measured.
    line = [line for line in text.splitlines() if line.startswith("| `deviation.uav.mass`")][-1]
    assert with_deviations(text.replace(f"{line}\n", "")) == text


def test_page_without_its_mark_is_refused() -> None:
    with pytest.raises(ValueError, match="lacks the line"):
        with_deviations(PAGE.read_text("utf-8").replace(BEGIN, ""))


@pytest.mark.parametrize("row", list(rows()), ids=lambda row: row.path)
def test_every_row_says_what_differs_and_who_says_so(row) -> None:
    what, source = told_by(row)
    assert what
    assert source.startswith("assumption") or re.search(r"\d|the same", source)
    assert "(" not in source or ")" in source


def test_row_without_a_source_is_refused() -> None:
    row = next(rows())
    with pytest.raises(ValueError, match="neither"):
        told_by(row._replace(meaning="share of everything"))


def test_example_of_the_page_is_a_scenario(tmp_path) -> None:
    (example,) = re.findall(r"```toml\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
    assert "deviation" in tomllib.loads(example)
    (tmp_path / "mine.toml").write_text(example, encoding="utf-8")
    found = load_scenario(str(tmp_path / "mine.toml")).deviation
    assert (found.uav.mass.low, found.uav.mass.high, found.link.down_ms.ends) == (-0.1, 0.1, True)


def test_page_has_every_level() -> None:
    assert [name for name in LEVELS if f"| `{name}` |" not in PAGE.read_text("utf-8")] == []
