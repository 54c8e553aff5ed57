from pathlib import Path

from armland.records import MESSAGES, Flag
from armland.view.messages import records_markdown

PAGE = Path(__file__).parents[2] / "docs" / "records.md"


def test_page_is_up_to_date() -> None:
    text = PAGE.read_text("utf-8")
    assert text == records_markdown(), "run: python -m armland.view.messages > docs/records.md"


def test_page_has_every_field_and_flag() -> None:
    page = records_markdown()
    fields = sum(len(fields) for fields in MESSAGES.values())
    flags = [name for name in vars(Flag) if name.isupper()]
    assert sum(line.startswith("| `") for line in page.splitlines()) == fields
    assert [name for name in flags if f"| {getattr(Flag, name)} | `{name}` |" not in page] == []
