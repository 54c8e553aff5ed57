from pathlib import Path

import pytest

from armland.records import MESSAGES, Limit, UavMode
from pages.messages import records_markdown

PAGE = Path(__file__).parents[3] / "docs" / "records.md"


def test_page_is_up_to_date() -> None:
    text = PAGE.read_text("utf-8")
    assert text == records_markdown(), "run: make pages"


def test_page_has_every_field() -> None:
    fields = [f"| `{field.name}` | " for fields in MESSAGES.values() for field in fields]
    found = [line for line in records_markdown().splitlines() if line.startswith("| `")]
    assert len(found) == len(fields)
    assert all(line.startswith(field) for line, field in zip(found, fields, strict=True))


@pytest.mark.parametrize("names", [UavMode, Limit])
def test_page_has_every_number(names: type) -> None:
    page = records_markdown()
    numbers = [name for name in vars(names) if name.isupper()]
    assert numbers
    assert [name for name in numbers if f"| {getattr(names, name)} | `{name}` |" not in page] == []
