from pathlib import Path

import pytest

from armland.mission.records import LANDING_TABLE, Limit, UavMode
from armland.records import PAPER_TABLE, Flag
from armland.view.messages import records_markdown

PAGE = Path(__file__).parents[2] / "docs" / "records.md"


def test_page_is_up_to_date() -> None:
    text = PAGE.read_text("utf-8")
    assert text == records_markdown(), "run: python -m armland.view.messages > docs/records.md"


def test_page_has_every_field() -> None:
    halves = records_markdown().split("## Landing and take-off")
    for half, table in zip(halves, (PAPER_TABLE, LANDING_TABLE), strict=True):
        fields = [f"| `{field.name}` | " for fields in table.messages.values() for field in fields]
        found = [line for line in half.splitlines() if line.startswith("| `")]
        assert len(found) == len(fields)
        assert all(line.startswith(field) for line, field in zip(found, fields, strict=True))


@pytest.mark.parametrize(("names", "half"), [(Flag, 0), (UavMode, 1), (Limit, 1)])
def test_page_has_every_number(names: type, half: int) -> None:
    page = records_markdown().split("## Landing and take-off")[half]
    numbers = [name for name in vars(names) if name.isupper()]
    assert numbers
    assert [name for name in numbers if f"| {getattr(names, name)} | `{name}` |" not in page] == []
