import json

import pytest

from armland.view import machine
from armland.view.machine import Check

FOUND = [
    Check("system", "good", "armland"),
    Check("OpenGL", "lacks", "none", "install EGL"),
]


@pytest.mark.parametrize(
    ("more", "code"), [((), 0), ((Check("packages", "bad", "numpy is missing", "pip install"),), 1)]
)
def test_exit_code_says_whether_something_needed_is_missing(armland, monkeypatch, more, code) -> None:
    monkeypatch.setattr(machine, "checks", lambda: iter([*FOUND, *more]))
    done = armland("doctor")
    assert done.code == code
    lines = done.out.splitlines()
    assert lines[0].split(maxsplit=1) == ["good", "system: armland"]
    assert lines[1].split(maxsplit=1) == ["lacks", "OpenGL: none"]
    assert lines[2].strip() == "install EGL"


def test_json_is_alone_on_standard_output(armland, monkeypatch) -> None:
    monkeypatch.setattr(machine, "checks", lambda: iter(FOUND))
    found = json.loads(armland("doctor", "--json").out)
    assert found[1] == {"name": "OpenGL", "state": "lacks", "found": "none", "remedy": "install EGL"}
