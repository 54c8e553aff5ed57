"""Work goes to processes side by side, is counted as it is done, and is not done twice."""

import json
import os
from pathlib import Path

import pytest

from armland.compiled import warming


@pytest.fixture
def place(tmp_path: Path, monkeypatch) -> Path:
    """A package of its own with stamps, and a module of work that workers can import."""
    (tmp_path / "lander" / "__pycache__").mkdir(parents=True)
    (tmp_path / "lander" / "__pycache__" / "compiled.json").write_text(json.dumps({"a.py": "1"}))
    (tmp_path / "work.py").write_text(
        "import os, pathlib\n"
        "def note(name): (pathlib.Path(__file__).parent / f'{name}.{os.getpid()}').touch()\n"
        "def fail(name): raise ZeroDivisionError(name)\n"
        "def die(name): os._exit(1)\n"
    )
    monkeypatch.setattr(warming, "PACKAGE", tmp_path / "lander")
    monkeypatch.setattr(warming, "places", lambda: [None])
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")]))
    monkeypatch.delenv("NUMBA_DISABLE_JIT", raising=False)
    return tmp_path


def test_all_work_is_done_and_told_and_counts_until_something_changes(place: Path) -> None:
    assert not warming.is_warm(7)
    told = []
    assert warming.warm(7, [("work:note", f"n{i}") for i in range(7)], lambda done, total: told.append((done, total)))
    assert sorted(told) == [(i + 1, 7) for i in range(7)]
    assert sorted(p.stem for p in place.glob("n*.*")) == [f"n{i}" for i in range(7)]
    assert warming.is_warm(7)
    (place / "lander" / "__pycache__" / "compiled.json").write_text(json.dumps({"a.py": "2"}))
    assert not warming.is_warm(7)


@pytest.mark.parametrize("call", ["work:fail", "work:die", "nowhere:note"])
def test_work_that_fails_is_left_to_the_command(place: Path, call: str) -> None:
    assert not warming.warm(7, [("work:note", "a"), (call, "b"), ("work:note", "c")], lambda done, total: None)
    assert not warming.is_warm(7)


def test_nothing_is_to_be_done_where_nothing_is_compiled_or_kept(place: Path, monkeypatch) -> None:
    monkeypatch.setattr(warming, "places", lambda: [place / "nowhere"])
    assert warming.place() is None
    assert warming.is_warm(7)
    monkeypatch.setattr(warming, "places", lambda: [None])
    assert warming.place() == place / "lander" / "__pycache__"
    assert not warming.is_warm(7)
    monkeypatch.setenv("NUMBA_DISABLE_JIT", "1")
    assert warming.is_warm(7)


def test_full_disk_is_no_error(place: Path, monkeypatch) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_text", full)
    assert warming.warm(7, [("work:note", "a")], lambda done, total: None)
    assert not warming.is_warm(7)
