"""What the bits of a flight depend on beside its scenario."""

import hashlib
import platform
from functools import cache
from importlib.metadata import version
from pathlib import Path

_PACKAGE = Path(__file__).parents[2]
_IDLE = ("cli", "view")  # Parts that no flight depends on


def versions() -> dict[str, str]:
    """Versions by name: packages, sources of armland, kind of machine."""
    names = {name: version(name) for name in ("armland", "mujoco", "numba", "numpy")}
    return {**names, "sources": _sources(), "python": platform.python_version(), "machine": platform.machine()}


@cache
def _sources() -> str:
    found = hashlib.sha256()
    for file in sorted(_PACKAGE.rglob("*.py")):
        if file.relative_to(_PACKAGE).parts[0] not in _IDLE:
            found.update(file.read_bytes())
    return found.hexdigest()[:12]
