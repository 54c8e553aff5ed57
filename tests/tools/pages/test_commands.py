from pathlib import Path

from armland.cli.app import app
from pages.commands import commands_markdown

PAGE = Path(__file__).parents[3] / "docs" / "cli.md"


def test_page_is_up_to_date() -> None:
    assert PAGE.read_text("utf-8") == commands_markdown(), "run: PYTHONPATH=tools python -m pages.commands"


def test_page_has_every_command_with_its_options() -> None:
    text = commands_markdown()
    names = [command.name or command.callback.__name__.replace("_", "-") for command in app.registered_commands]
    assert len(names) > 10
    assert [name for name in names if f"\n## armland {name}\n" not in text or f"(#armland-{name})" not in text] == []
    land = text.partition("## armland land\n")[2].partition("\n## ")[0]
    for row in (
        "| `--seed N` |",
        "| `--set KEY=VALUE` |",
        "| `--sea 0-4 or tank or usv` |",
        "| `--out FOLDER` |",
        "| `SCENARIO` |",
    ):
        assert f"\n{row}" in land
    assert "- `armland land --seed 7 --json | jq .reason` prints the result alone.\n" in land
