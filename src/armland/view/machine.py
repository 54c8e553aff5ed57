"""What a machine has and lacks of what armland needs: each check with what was found, and how to get what is missing."""

import importlib.metadata
import os
import platform
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Literal, NamedTuple

from packaging.requirements import Requirement

from armland import __version__
from armland.compiled.warming import is_warm, place
from armland.errors import PictureError
from armland.runtime.latency import measured
from armland.vision.opengl import working_backend

State = Literal["good", "lacks", "bad"]
"""All is well; something that one can be without; something without which armland does not work."""

LOG_MB = 45
"""Of a landing."""

LEAST_FREE_MB = 500

LATE_S = 2.5e-4
"""Wake-ups of a 1 kHz loop of which one in a hundred is later are too late for an arm: a quarter of its period."""

WRITTEN_MB = 16


class Check(NamedTuple):
    """One thing that was looked at."""

    name: str
    state: State
    found: str
    remedy: str = ""


def checks(arm_joints: int = 7) -> Iterator[Check]:
    """All checks, one after the other; a check that breaks says so and stops no other. Some take a second."""
    makers: dict[str, Callable[[], Check]] = {
        "system": _system,
        "packages": _packages,
        **{f"extra {name}": partial(_extra, name, what) for name, what in EXTRAS.items()},
        "cores": _cores,
        "OpenGL": _opengl,
        "films": _films,
        "1 kHz loop": _loop,
        "disk": _disk,
        "compiled code": partial(_compiled, arm_joints),
    }
    for name, make in makers.items():
        try:
            yield make()
        except Exception as e:
            yield Check(name, "lacks", f"could not be looked at: {type(e).__name__}: {e}")


EXTRAS = {
    "vision": "the marker detector",
    "export": "Parquet files and Rerun recordings",
    "cluster": "campaigns on several machines",
}
"""Extra of the package -> what needs it."""


def _system() -> Check:
    words = f"armland {__version__}, Python {platform.python_version()}, {platform.system()} {platform.machine()}"
    return Check("system", "good", words)


def _needed(extra: str = "") -> list[Requirement]:
    found = [Requirement(text) for text in importlib.metadata.requires("armland") or []]
    plain = [r for r in found if r.marker is None or r.marker.evaluate({"extra": ""})]
    if not extra:
        return plain
    return [r for r in found if r.marker is not None and r.marker.evaluate({"extra": extra}) and r not in plain]


def missing(needed: list[Requirement]) -> list[str]:
    """What is not there of the packages `needed`, or is too old or too new."""
    out = []
    for r in needed:
        try:
            version = importlib.metadata.version(r.name)
        except importlib.metadata.PackageNotFoundError:
            out.append(f"{r.name} is missing")
            continue
        if not r.specifier.contains(version, prereleases=True):
            out.append(f"{r.name} {version} is not {r.specifier}")
    return out


def _packages() -> Check:
    shown = ", ".join(f"{name} {importlib.metadata.version(name)}" for name in ("mujoco", "numba", "numpy", "scipy"))
    if wrong := missing(_needed()):
        return Check("packages", "bad", "; ".join(wrong), "pip install --upgrade armland")
    return Check("packages", "good", shown)


def _extra(name: str, what: str) -> Check:
    wrong = missing(_needed(name))
    if wrong:
        return Check(f"extra {name}", "lacks", f"{'; '.join(wrong)}: no {what}", f"pip install 'armland[{name}]'")
    return Check(f"extra {name}", "good", what)


def _cores() -> Check:
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    words = f"{cores} to use, of {os.cpu_count()}"
    if hasattr(os, "getloadavg"):
        words += f"; load {os.getloadavg()[0]:.1f}"
    return Check("cores", "good", words)


def _opengl() -> Check:
    try:
        return Check("OpenGL", "good", f"{working_backend() or 'the system' + chr(39) + 's own'}, off-screen")
    except PictureError as e:
        found, _, remedy = str(e).partition("); ")
        return Check("OpenGL", "lacks", f"{found}): no films, stills and pictures", remedy)


def _films() -> Check:
    import av

    lacking = [name for name in ("libx264", "libvpx-vp9") if name not in av.codec.codecs_available]
    if lacking:
        return Check("films", "lacks", f"PyAV without {', '.join(lacking)}", "pip install --force-reinstall av")
    return Check("films", "good", f"PyAV {av.__version__} with H.264 and VP9")


def _loop() -> Check:
    late = measured()
    words = (
        f"wakes {1e6 * late.median:.0f} µs late (median), {1e6 * late.p99:.0f} µs (99 %), {1e6 * late.worst:.0f} µs (worst); "
        f"{late.missed} of {late.periods} periods missed; clock of {1e9 * late.resolution:.0f} ns"
    )
    if late.p99 > LATE_S or late.missed:
        remedy = "simulation does not mind; for a real arm: a kernel with PREEMPT_RT, and cores without other work"
        return Check("1 kHz loop", "lacks", words, remedy)
    return Check("1 kHz loop", "good", words)


def _disk() -> Check:
    here = Path.cwd()
    free = shutil.disk_usage(here).free / 1e6
    try:
        speed = f", written at {_writing(here):.0f} MB/s"
    except OSError as e:
        return Check("disk", "lacks", f"{here} cannot be written to: {e.strerror}", "name a folder that can: --out DIR")
    words = f"{free / 1e3:.1f} GB free here{speed}; the log of a landing has {LOG_MB} MB"
    if free < LEAST_FREE_MB:
        return Check("disk", "lacks", words, "make room, or write elsewhere: --out DIR; or fly with --no-log")
    return Check("disk", "good", words)


def _writing(folder: Path) -> float:
    # MB/s with which a file reaches the disk.
    with tempfile.TemporaryFile(dir=folder) as file:
        start = time.perf_counter()
        file.write(os.urandom(1_000_000) * WRITTEN_MB)
        file.flush()
        os.fsync(file.fileno())
        return WRITTEN_MB / max(time.perf_counter() - start, 1e-9)


def _compiled(joints: int) -> Check:
    at = place()
    if at is None:
        remedy = "let NUMBA_CACHE_DIR name a folder that can be written to"
        return Check("compiled code", "lacks", "can be kept nowhere: each start compiles for a minute or two", remedy)
    if not is_warm(joints):
        return Check(
            "compiled code", "good", f"not there yet: the first flight compiles it, less than a minute; kept in {at}"
        )
    return Check("compiled code", "good", f"there, in {at}")
