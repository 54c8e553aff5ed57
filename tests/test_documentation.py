"""What the documents show is run."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


def blocks(language: str) -> list[tuple[str, str]]:
    """Page and number, and text of each block."""
    return [
        (f"{page.name}-{i}", text)
        for page in PAGES
        for i, text in enumerate(re.findall(rf"```{language}\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL))
    ]


@pytest.mark.parametrize("code", [pytest.param(text, id=name) for name, text in blocks("python")])
def test_snippet_runs(code: str, monkeypatch) -> None:
    monkeypatch.chdir(ROOT)
    namespace: dict[str, object] = {}
    exec(code, namespace)
    assert len(namespace) > 1


@pytest.mark.parametrize("page", ["README.md", "python.md", "own_law.md"])
def test_page_has_a_snippet(page: str) -> None:
    assert any(name.startswith(page) for name, _ in blocks("python"))


def test_commands_in_the_documents_exist_with_their_options() -> None:
    from typer.main import get_command

    from armland.cli.app import app

    commands = get_command(app).commands  # type: ignore[attr-defined]
    shown = [
        (name, call.strip())
        for name, text in blocks("sh")
        for line in text.splitlines()
        for call in line.partition("  #")[0].split(";")
        if call.strip().startswith("armland ")
    ]
    assert shown
    for name, call in shown:
        words = call.split()
        assert words[1] in commands, (name, call)
        known = {o for p in commands[words[1]].params for o in (*p.opts, *p.secondary_opts)}
        assert {w for w in words if re.fullmatch(r"--[a-z-]+", w)} <= known, (name, call)
