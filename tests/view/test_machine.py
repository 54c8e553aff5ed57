"""Each check finds what is missing, and says how to get it."""

import os
from pathlib import Path

import pytest
from packaging.requirements import Requirement

from armland.runtime.latency import Latency
from armland.view import machine
from armland.view.machine import Check, checks, missing


def named(name: str) -> Check:
    return next(c for c in checks() if c.name == name)


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    monkeypatch.setattr(machine, "measured", lambda: Latency(5e-5, 1e-4, 2e-4, 0, 1000, 1e-9))
    monkeypatch.setattr(machine, "working_backend", lambda: "egl")


def test_machine_that_runs_the_tests_lacks_nothing_that_is_needed() -> None:
    found = list(checks())
    assert [c.name for c in found if c.state == "bad"] == []
    assert len(found) == 11
    assert all(c.remedy for c in found if c.state != "good")


def test_packages_that_are_missing_or_too_old_are_found() -> None:
    needed = [Requirement("numpy>=1"), Requirement("numpy>=999"), Requirement("no-such-package>=1")]
    found = missing(needed)
    assert len(found) == 2
    assert found[0].startswith("numpy ")
    assert found[0].endswith("is not >=999")
    assert found[1] == "no-such-package is missing"


def test_missing_package_is_bad_and_missing_extra_is_not(monkeypatch) -> None:
    monkeypatch.setattr(machine, "_needed", lambda extra="": [Requirement("no-such-package")])
    assert named("packages").state == "bad"
    extra = named("extra export")
    assert (extra.state, extra.remedy) == ("lacks", "pip install 'armland[export]'")


def test_extras_are_those_of_the_package() -> None:
    import importlib.metadata

    offered = set(importlib.metadata.metadata("armland").get_all("Provides-Extra"))
    assert machine.EXTRAS.keys() <= offered
    assert {r.name for r in machine._needed("export")} == {"pyarrow", "rerun-sdk"}
    assert "pyarrow" not in {r.name for r in machine._needed()}


def test_no_opengl_says_what_helps(monkeypatch) -> None:
    from armland.vision import opengl

    monkeypatch.setenv("MUJOCO_GL", "disable")
    monkeypatch.setattr(machine, "working_backend", opengl.working_backend)
    found = named("OpenGL")
    assert found.state == "lacks"
    assert found.found.startswith("no OpenGL for off-screen pictures (disable: ")
    assert found.remedy.startswith("unset MUJOCO_GL, or install EGL")


@pytest.mark.parametrize(("p99", "missed", "state"), [(1e-4, 0, "good"), (3e-4, 0, "lacks"), (1e-4, 1, "lacks")])
def test_late_loop_is_said(monkeypatch, p99, missed, state) -> None:
    monkeypatch.setattr(machine, "measured", lambda: Latency(5e-5, p99, 2e-3, missed, 1000, 1e-9))
    found = named("1 kHz loop")
    assert found.state == state
    assert f"{1e6 * p99:.0f} µs (99 %)" in found.found
    assert f"{missed} of 1000 periods missed" in found.found


def test_disk_that_is_full_or_cannot_be_written_is_said(monkeypatch, tmp_path) -> None:
    monkeypatch.chdir(tmp_path)
    assert named("disk").state == "good"
    assert list(tmp_path.iterdir()) == []
    monkeypatch.setattr(
        machine.shutil, "disk_usage", lambda _: os.terminal_size((0, 0)) and type("U", (), {"free": 4e8})()
    )
    assert named("disk").state == "lacks"

    def refuse(*_: object, **__: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(machine.tempfile, "TemporaryFile", refuse)
    assert "cannot be written to: Permission denied" in named("disk").found


def test_cache_that_can_be_kept_nowhere_is_said(monkeypatch) -> None:
    monkeypatch.setattr(machine, "place", lambda: None)
    assert "NUMBA_CACHE_DIR" in named("compiled code").remedy
    monkeypatch.setattr(machine, "place", lambda: Path("/kept"))
    monkeypatch.setattr(machine, "is_warm", lambda joints: joints == 7)
    assert named("compiled code").found == "there, in /kept"
    monkeypatch.setattr(machine, "is_warm", lambda joints: False)
    assert "not there yet" in named("compiled code").found


def test_check_that_breaks_stops_no_other(monkeypatch) -> None:
    def broken() -> str:
        raise RuntimeError("driver")

    monkeypatch.setattr(machine, "working_backend", broken)
    found = {c.name: c for c in checks()}
    assert found["OpenGL"].found == "could not be looked at: RuntimeError: driver"
    assert found["films"].state == "good"
