"""Keeps Numba's cache honest: compiled code goes when anything that it was compiled from has changed, and is not mixed up.

Numba looks at the one file in which a compiled function stands. What that function calls in other files, and the constants
that it takes from them, are compiled into it all the same. So each module is stamped here with the contents of all modules
of the package that it imports, directly or not, and where a stamp no longer fits, the module's compiled functions are deleted.

Numba names a compiled function after its arguments' types, and a record's type after the number that it has in the process:
code that two processes compiled for different records can bear the same name in the cache, and a third process that loads both
calls one of them for the other, which reads the wrong bytes. Here a record's type is named after its layout.
"""

import contextlib
import hashlib
import json
import re
from pathlib import Path
from typing import Any

PACKAGE = Path(__file__).parent
STAMPS = Path("__pycache__") / "compiled.json"


def name_records_by_layout() -> None:
    """Make Numba name a record's type after its fields, offsets and size; to be called before anything is compiled."""
    from numba.core import types

    def mangling_args(self: Any) -> tuple[str, tuple[str]]:
        return type(self).__name__, (hashlib.sha256(str(self.name).encode()).hexdigest(),)

    types.Record.mangling_args = property(mangling_args)  # type: ignore[assignment, method-assign]


def drop_stale(package: Path = PACKAGE) -> list[Path]:
    """Delete compiled functions of `package` that older sources made; returns the modules concerned.

    A package that cannot be written to is left alone: Numba keeps its cache elsewhere then.
    """
    known = _read(package / STAMPS)
    stamps = _stamps(package)
    if stamps == known:
        return []
    stale = [package / name for name, stamp in stamps.items() if known.get(name) != stamp]
    try:
        for module in stale:
            for file in (module.parent / "__pycache__").glob(f"{module.stem}.*.nb[ci]"):
                file.unlink(missing_ok=True)
        (package / STAMPS).parent.mkdir(exist_ok=True)
        (package / STAMPS).write_text(json.dumps(stamps), encoding="utf-8")
    except OSError:
        return []
    return stale


def _read(path: Path) -> dict[str, str]:
    with contextlib.suppress(OSError, ValueError):
        return dict(json.loads(path.read_text(encoding="utf-8")))
    return {}


def _stamps(package: Path) -> dict[str, str]:
    sources = {p.relative_to(package).as_posix(): p.read_bytes() for p in sorted(package.rglob("*.py"))}
    # How names are made is part of what is compiled.
    own = hashlib.sha256(Path(__file__).read_bytes()).hexdigest()
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
