"""Compiled code goes when anything that it was compiled from has changed.

Numba looks at the one file in which a compiled function stands. What that function calls in other files, and the constants
that it takes from them, are compiled into it all the same. So each module is stamped here with the contents of all modules
of the package that it imports, directly or not, and where a stamp no longer fits, the module's compiled functions are deleted,
wherever Numba keeps them: beside the module, in the folder that `NUMBA_CACHE_DIR` names, or in the user's own cache where the
package cannot be written to.
"""

import contextlib
import hashlib
import json
import os
import re
import sys
from pathlib import Path

PACKAGE = Path(__file__).parents[1]
OWN = Path(__file__).parent
STAMPS = "compiled.json"


def drop_stale(package: Path = PACKAGE) -> list[Path]:
    """Delete compiled functions of `package` that older sources made; returns the modules concerned.

    A place that cannot be written to is left alone: Numba does not use it either.
    """
    stamps, gone = _stamps(package), set()
    for place in places(package):
        known = _read(cache(package, place) / STAMPS)
        if stamps == known:
            continue
        stale = {package / name for name, stamp in stamps.items() if known.get(name) != stamp}
        with contextlib.suppress(OSError):
            for module in stale:
                for file in cache(module.parent, place).glob(f"{module.stem}.*.nb[ci]"):
                    file.unlink(missing_ok=True)
            cache(package, place).mkdir(parents=True, exist_ok=True)
            (cache(package, place) / STAMPS).write_text(json.dumps(stamps), encoding="utf-8")
            gone |= stale
    return sorted(gone)


def places(package: Path = PACKAGE) -> list[Path | None]:
    """Where Numba may keep compiled code of `package`: None is beside each module. The first that can be written is the one in use."""
    named = os.environ.get("NUMBA_CACHE_DIR")
    found: list[Path | None] = [Path(named)] if named else []
    found.append(None)
    if not os.access(package, os.W_OK) or cache(package, user_cache()).is_dir():
        found.append(user_cache())
    return found


def cache(folder: Path, place: Path | None) -> Path:
    """Where compiled code of the modules in `folder` is in a place: as Numba names it."""
    if place is None:
        return folder / "__pycache__"
    path = os.path.abspath(folder)
    return place / f"{os.path.basename(path)}_{hashlib.sha1(path.encode()).hexdigest()}"


def user_cache() -> Path:
    """The folder that Numba has for a user's compiled code."""
    if sys.platform == "darwin":
        return Path("~/Library/Caches/numba").expanduser()
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", "~")).expanduser() / "numba" / "Cache"
    return Path(os.environ.get("XDG_CACHE_HOME", "~/.cache")).expanduser() / "numba"


def _read(path: Path) -> dict[str, str]:
    with contextlib.suppress(OSError, ValueError):
        return dict(json.loads(path.read_text(encoding="utf-8")))
    return {}


def _stamps(package: Path) -> dict[str, str]:
    sources = {p.relative_to(package).as_posix(): p.read_bytes() for p in sorted(package.rglob("*.py"))}
    # How code is made is part of what is compiled.
    own = hashlib.sha256(b"".join(p.read_bytes() for p in sorted(OWN.glob("*.py")))).hexdigest()
    imports = {name: _imported(text.decode(), package.name, sources) for name, text in sources.items()}
    digests = {name: hashlib.sha256(text).hexdigest() for name, text in sources.items()}
    stamps = {}
    for name in sources:
        reached, ahead = {name}, [name]
        while ahead:
            new = imports[ahead.pop()] - reached
            reached |= new
            ahead += new
        stamps[name] = hashlib.sha256("".join([own, *(digests[r] for r in sorted(reached))]).encode()).hexdigest()
    return stamps


def _imported(text: str, package: str, sources: dict[str, bytes]) -> set[str]:
    found = set()
    for module in re.findall(rf"^\s*import {package}\.([\w.]+)", text, re.MULTILINE):
        found.add(f"{module.replace('.', '/')}.py")
    # What is imported from a package may be a module of it.
    for module, names in re.findall(rf"^\s*from {package}([\w.]*) import (\([^)]*\)|[^\n(]+)", text, re.MULTILINE):
        path = module.replace(".", "/").removeprefix("/")
        found |= {f"{path}.py", *(f"{path}/{name}.py".removeprefix("/") for name in re.findall(r"\w+", names))}
    return found & sources.keys()
