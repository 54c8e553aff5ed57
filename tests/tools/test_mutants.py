"""The script that tries changes: a test that notices one kills it, one that does not lets it survive."""

import importlib.util
import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TOOLS = ROOT / "tools"

CODE = "def force(a, b):\n    return a - b\n\n\ndef idle(a):\n    return a + 0.0\n"
STRICT = """
from armland.control.made_up import force


def test_force():
    assert force(3.0, 2.0) == 1.0


def test_that_fails_as_it_is():
    assert force(3.0, 2.0) == 5.0
"""
IDLE = "control/made_up.py:idle: a + 0.0 -> "


@pytest.fixture
def tree(tmp_path):
    """A small working tree with the script in it."""
    for folder in ("src/armland/control", "tests/control", "tools"):
        (tmp_path / folder).mkdir(parents=True)
    for name in ("mutants.py", "changes.py", "interpreted.py"):
        (tmp_path / "tools" / name).write_text((TOOLS / name).read_text("utf-8"), encoding="utf-8")
    for folder in ("src/armland", "src/armland/control"):
        (tmp_path / folder / "__init__.py").write_text("")
    (tmp_path / "pyproject.toml").write_text('[tool.pytest.ini_options]\nmarkers = ["slow: x"]\n')
    (tmp_path / "src/armland/control/made_up.py").write_text(CODE)
    return tmp_path


def run(tree, *arguments):
    environment = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "PYTEST_ADDOPTS")}
    command = [sys.executable, str(tree / "tools" / "mutants.py"), "--jobs", "1", *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=300, env=environment, check=False)


def listed(*changes):
    return "".join(f'[[equivalent]]\nchange = "{change}"\nreason = "because nothing is added"\n' for change in changes)


def test_noticed_changes_die_and_the_others_are_named(tree) -> None:
    (tree / "tests/control/test_made_up.py").write_text(STRICT)
    (tree / "src/armland/estimation").mkdir()
    (tree / "src/armland/estimation/broken.py").write_text("def f(a):\n    return -a\n")
    (tree / "tests/estimation").mkdir()
    (tree / "tests/estimation/test_broken.py").write_text("def test_broken():\n    assert False\n")
    done = run(tree)
    assert done.returncode == 1, done.stderr
    assert "7 changes: 3 noticed, 0 equivalent, 4 unnoticed" in done.stdout
    assert f"survived  control/made_up.py:6  {IDLE}(a - 0.0)" in done.stdout
    assert "made_up.py:force" not in done.stdout
    # Tests that fail without a change say nothing about it.
    assert "untested  estimation/broken.py:2  estimation/broken.py:f: -a -> a" in done.stdout
    # What is tried is the copy: the tree stays as it is.
    assert (tree / "src/armland/control/made_up.py").read_text() == CODE


@pytest.mark.parametrize(
    "wrong", [pytest.param([], marks=pytest.mark.slow), ["control/made_up.py:force: a - b -> (a + b)"]]
)
def test_listed_equivalents_are_no_survivors_and_must_not_be_noticed(tree, wrong) -> None:
    (tree / "tests/control/test_made_up.py").write_text(STRICT)
    (tree / "tools/equivalents.toml").write_text(listed(*(f"{IDLE}{new}" for new in ("(a - 0.0)", "a", "0.0")), *wrong))
    done = run(tree)
    assert done.returncode == len(wrong), done.stdout
    assert "6 changes: 3 noticed, 3 equivalent, 0 unnoticed" in done.stdout
    assert [line for line in done.stdout.splitlines() if "listed as equivalent" in line] == [
        f"listed as equivalent, and noticed: {change}" for change in wrong
    ]


HIDDEN = """
import sys
sys.path.insert(0, {tools!r})
from interpreted import interpret
interpret()
import numpy as np
kept = np.zeros(1, np.dtype([("flags", "i8"), ("sum", "f8", (2,)), ("part", np.dtype([("max", "f8")]))]))
record = kept[0]
record.flags |= 4
record.sum[1] += 2.0
record.part.max = 3.0
print(kept["flags"][0], kept["sum"][0, 1], record.part.max, record.dtype.names)
"""


def test_fields_are_found_in_plain_python_whatever_else_numpy_calls_so() -> None:
    """Without Numba a record of NumPy has `flags`, `sum` and the like of its own."""
    code = HIDDEN.format(tools=str(TOOLS))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=300, check=False)
    assert done.stdout.split() == ["4", "2.0", "3.0", "('flags',", "'sum',", "'part')"], done.stderr


def test_sample_is_the_same_for_the_same_seed() -> None:
    samples = [run(ROOT, "--list", "--only", "control", "--count", "20", "--seed", s).stdout for s in ("7", "7", "8")]
    assert len(samples[0].splitlines()) == 20
    assert samples[0] == samples[1] != samples[2]


def test_listed_equivalents_exist_and_have_a_reason() -> None:
    sys.path.insert(0, str(TOOLS))
    try:
        spec = importlib.util.spec_from_file_location("mutants", TOOLS / "mutants.py")
        mutants = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(mutants)
    finally:
        sys.path.remove(str(TOOLS))
    known = tomllib.loads((TOOLS / "equivalents.toml").read_text("utf-8")).get("equivalent", [])
    keys = {change.key for change in mutants.chosen(mutants.sources(), None, 0)}
    assert len(keys) > 1000
    assert [entry["change"] for entry in known if entry["change"] not in keys] == []
    assert all(len(entry["reason"].split()) >= 4 for entry in known)
