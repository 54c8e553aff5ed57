"""A copy of the package for the API reference, whose reader of sources takes no folder without `__init__.py` for a package."""

import shutil
from pathlib import Path


def regular(package: Path, place: Path) -> Path:
    """Copy the sources of a package, with an empty `__init__.py` where there is none, into an emptied place; the copy's parent."""
    shutil.rmtree(place, ignore_errors=True)
    copy = place / package.name
    shutil.copytree(package, copy, ignore=lambda folder, names: [n for n in names if not _wanted(Path(folder) / n)])
    for folder in (copy, *copy.rglob("*/")):
        (folder / "__init__.py").touch()
    return place


def _wanted(path: Path) -> bool:
    return path.suffix == ".py" or (path.is_dir() and path.name != "__pycache__")
