"""The page `docs/cli.md`: every command with its arguments, options and examples, from the command line itself.

`PYTHONPATH=tools python -m pages.commands` writes it.
"""

import re
from pathlib import Path
from typing import Any

import typer
from typer.main import get_command

from armland.cli.app import app

PAGE = Path(__file__).parents[2] / "docs" / "cli.md"
HEAD = """\
# Commands

Made from the command line by `make pages`; `--help` behind a command says the same.

{summary} {exits}

| command | does |
|---|---|
{rows}

`armland --install-completion` lets your shell complete commands and options. `--set KEY=VALUE` takes any key of `armland schema`.
"""

KINDS = {
    "SCENARIO <str>": "SCENARIO",
    "<str>": "TEXT",
    "<int range>": "N",
    "<float range>": "X",
    "<int>": "N",
    "<float>": "X",
    "<path>": "FOLDER",
}
"""What typer says of a value -> the same as a reader says it."""


def commands_markdown() -> str:
    """The page as Markdown."""
    commands = get_command(app).commands  # type: ignore[attr-defined]
    texts = {name: command.help.strip() for name, command in commands.items()}
    rows = "\n".join(f"| [`{n}`](#armland-{n}) | {_cell(text.splitlines()[0])} |" for n, text in texts.items())
    exits = next(
        line for c in commands.values() for line in (c.epilog or "").splitlines() if line.startswith("Exit code")
    )
    head = HEAD.format(summary=str(app.info.help), exits=exits, rows=rows)
    return "\n".join([head, *(_section(name, command) for name, command in commands.items())])


def _section(name: str, command: Any) -> str:
    context = typer.Context(command, info_name=f"armland {name}")
    shown = [p for p in command.params if not p.hidden]
    pieces = [re.sub(r"[{}]|\.{3}(?=.)", "", p).upper() for p in command.collect_usage_pieces(context)[1:]]
    lines = [
        f"## armland {name}",
        "",
        command.help.strip(),
        "",
        f"Usage: `{' '.join(['armland', name, *pieces])}` and options",
        "",
    ]
    for kind in ("argument", "option"):
        if rows := [_row(p, context) for p in shown if p.param_type_name == kind]:
            lines += [f"| {kind} | means | if absent |", "|---|---|---|", *rows, ""]
    return "\n".join([*lines, *_examples(command.epilog or "")])


def _row(parameter: Any, context: typer.Context) -> str:
    names = parameter.get_help_record(context)[0].replace("|", " or ")
    for kind, word in KINDS.items():
        names = names.replace(kind, word)
    return f"| `{names}` | {_cell(parameter.help or '')} | {_default(parameter)} |"


def _default(parameter: Any) -> str:
    value = parameter.default
    if parameter.required:
        return "refused"
    if value is None or value is False or callable(value) or value in ([], ()):
        return ""
    return f"`{parameter.opts[0]}`" if value is True else f"`{value}`"


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", " or ")


def _examples(epilog: str) -> list[str]:
    paragraphs = [" ".join(part.split()) for part in epilog.split("\n\n")]
    told = [p for p in paragraphs if p.startswith("`")]
    return ["Examples:", "", *(f"- {p}" for p in told), ""] if told else []


if __name__ == "__main__":
    PAGE.write_text(commands_markdown(), encoding="utf-8")
