"""The command as a whole: help with examples, completion, `python -m armland`."""

import os
import re
import subprocess
import sys

import pytest
from typer.main import get_command

from armland.cli.app import app

COMMANDS = sorted(get_command(app).commands)  # type: ignore[attr-defined]


def started(*args: str, **environment: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "armland", *args]
    return subprocess.run(command, env={**os.environ, **environment}, capture_output=True, text=True, check=False)


@pytest.mark.parametrize("name", COMMANDS)
def test_help_of_each_command_has_examples_of_it(armland, name) -> None:
    done = armland(name, "--help")
    assert done.code == 0
    after = done.out.partition("Examples")[2]
    assert re.search(rf"armland {name}\b", after), done.out


def test_help_of_the_whole_has_examples(armland) -> None:
    done = armland("--help")
    assert "armland land" in done.out.partition("Examples")[2]
    assert all(name in done.out for name in COMMANDS)


@pytest.mark.parametrize(
    ("shell", "words", "offered"),
    [
        ("bash", "armland re", {"reach", "render", "replay", "report"}),
        ("bash", "armland land --wind", {"--wind", "--wind-trace"}),
        ("zsh", "armland takeoff-", {"takeoff-weight"}),
        ("fish", "armland doc", {"doctor"}),
    ],
)
def test_shells_complete_commands_and_options(shell, words, offered) -> None:
    place = str(len(words.split()) - 1)
    of_shell = {"_TYPER_COMPLETE_ARGS": words, "_TYPER_COMPLETE_FISH_ACTION": "get-args"}
    done = started(_ARMLAND_COMPLETE=f"complete_{shell}", COMP_WORDS=words, COMP_CWORD=place, **of_shell)
    first = re.findall(r'"([\w-]+)":' if shell == "zsh" else r"^(\S+)", done.stdout, re.MULTILINE)
    assert set(first) == offered, done


def test_module_is_the_command() -> None:
    done = started("--version")
    assert (done.returncode, done.stderr) == (0, "")
    assert re.fullmatch(r"armland \d+\.\d+\.\d+\n", done.stdout)
    usage = started("land", "--no-such-option")
    assert usage.returncode == 2
    assert "Usage: armland land" in usage.stderr
