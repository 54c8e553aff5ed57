#!/usr/bin/env python3
"""Changes one thing at a time in what computes, and asks whether a test notices.

    tools/mutants.py                          all changes of control, estimation, models and mission
    tools/mutants.py --count 132 --seed 7     a sample
    tools/mutants.py --only control/laws      part of them
    tools/mutants.py --list                   say what would be tried

Each change is made in a copy of the working tree, with Numba switched off. It is tried with the tests of its module first and, where
none of them fails, with those of its part. A change that no test notices has survived. Those that mean the same as the original are
listed with the reason in `tools/equivalents.toml`; any other survivor makes the exit code 1.
"""

import argparse
import json
import multiprocessing
import multiprocessing.util
import os
import random
import shutil
import signal
import sys
import tempfile
import time
import tomllib
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

sys.path.insert(0, str(Path(__file__).parent))

from changes import Change, changes

ROOT = Path(__file__).parents[1]
PACKAGE = Path("src") / "armland"
PARTS = ("control", "estimation", "models", "mission")
LIST = ROOT / "tools" / "equivalents.toml"
COPIED = ("src", "tests", "pyproject.toml", "tools", "README.md", "docs", "examples", "benchmarks")
PRELOADED = (
    "numpy",
    "scipy.linalg",
    "scipy.optimize",
    "numba",
    "mujoco",
    "pydantic",
    "pytest",
    "hypothesis",
    "pinocchio",
)
LONGEST_S = 1800.0
"""How long the tests of a part may take without a change."""
PATIENCE_S = 20.0
"""How much longer than without a change the tests may take, besides three times as long; then the change counts as noticed."""


class Outcome(NamedTuple):
    """What became of one change."""

    change: Change
    fate: str
    """`killed`, `survived`, or `untested` where no test passes without the change."""
    seconds: float


def stages(module: str, root: Path = ROOT) -> list[str]:
    """Tests to try a change of `module` with, one after the other: those of the module, then those of its part."""
    path = Path(module)
    own = Path("tests") / path.parent / f"test_{path.name}"
    part = Path("tests") / path.parts[0]
    return [str(tests) for tests in (own, part) if (root / tests).exists()]


def sources(only: str = "") -> dict[str, str]:
    """Sources of the parts by path inside the package, those whose path begins with `only`."""
    files = [f for part in PARTS for f in sorted((ROOT / PACKAGE / part).rglob("*.py"))]
    named = {f.relative_to(ROOT / PACKAGE).as_posix(): f for f in files}
    return {name: f.read_text("utf-8") for name, f in named.items() if name.startswith(only)}


def equivalents(file: Path = LIST) -> dict[str, str]:
    """Changes that mean the same as the original: key -> reason."""
    entries = tomllib.loads(file.read_text("utf-8")).get("equivalent", []) if file.exists() else []
    return {entry["change"]: entry["reason"] for entry in entries}


class Plain(NamedTuple):
    """What tests do without a change."""

    seconds: dict[str, float]
    """Time of each test that passes."""
    total: float


class Trial:
    """Plugin of pytest: runs the tests that pass without a change, quick ones first, and notes how each ends."""

    def __init__(self, plain: Plain | None) -> None:
        self.plain = plain
        self.seconds: dict[str, float] = {}
        self.failed: set[str] = set()

    def pytest_collection_modifyitems(self, items: list[Any]) -> None:
        """Order the tests, and leave out those that fail as they are."""
        if self.plain is not None:
            known = self.plain.seconds
            items[:] = sorted((item for item in items if item.nodeid in known), key=lambda item: known[item.nodeid])

    def pytest_runtest_logreport(self, report: Any) -> None:
        """Note time and end of one test."""
        self.seconds[report.nodeid] = self.seconds.get(report.nodeid, 0.0) + report.duration
        if report.failed:
            self.failed.add(report.nodeid)


class Workshop:
    """A copy of the working tree in which changes are tried, one at a time. Made once in each worker."""

    def __init__(self) -> None:
        self.root = Path(tempfile.mkdtemp(prefix="mutants-"))
        for name in COPIED:
            source, target = ROOT / name, self.root / name
            if source.is_dir():
                shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__", "*.egg-info", "*.nb[ci]"))
            elif source.exists():
                shutil.copy(source, target)
        self._plain: dict[str, Plain] = {}
        self._clock = time.time()

    def close(self) -> None:
        """Remove the copy."""
        shutil.rmtree(self.root, ignore_errors=True)

    def attempt(self, change: Change, source: str) -> Outcome:
        """Try one change of `source` with the tests of its module and of its part."""
        start, fate = time.perf_counter(), "untested"
        file = self.root / PACKAGE / change.module
        for tests in stages(change.module, self.root):
            plain = self._plain.get(tests) or self._plain.setdefault(tests, self._as_it_is(tests))
            if not plain.seconds:
                continue
            self._write(file, change.applied(source))
            passed, _ = self._run(tests, plain, 3.0 * plain.total + PATIENCE_S)
            self._write(file, source)
            fate = "survived" if passed else "killed"
            if fate == "killed":
                break
        return Outcome(change, fate, time.perf_counter() - start)

    def _as_it_is(self, tests: str) -> Plain:
        start = time.perf_counter()
        _, seconds = self._run(tests, None, LONGEST_S)
        return Plain(seconds, time.perf_counter() - start)

    def _write(self, file: Path, source: str) -> None:
        # Python takes a compiled file for current by its time in whole seconds and its size.
        file.write_text(source, encoding="utf-8")
        self._clock += 2.0
        os.utime(file, (self._clock, self._clock))

    def _run(self, tests: str, plain: Plain | None, limit: float) -> tuple[bool, dict[str, float]]:
        # Whether tests pass, and the time of those that do. A child of this process has the libraries, and nothing of armland.
        start, told = time.perf_counter(), self.root / "trial.json"
        told.unlink(missing_ok=True)
        child = os.fork()
        if child == 0:
            os._exit(self._tested(tests, plain, told))
        while time.perf_counter() - start < limit:
            done, status = os.waitpid(child, os.WNOHANG)
            if done:
                return status == 0, json.loads(told.read_text()) if told.exists() else {}
            time.sleep(0.01)
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        return False, {}

    def _tested(self, tests: str, plain: Plain | None, told: Path) -> int:
        import pytest

        from interpreted import interpret

        silence = os.open(os.devnull, os.O_RDWR)
        for stream in (0, 1, 2):
            os.dup2(silence, stream)
        os.chdir(self.root)
        sys.path.insert(0, str(self.root / "src"))
        trial = Trial(plain)
        options = ["-q", "-p", "no:cacheprovider", "-p", "no:xdist", "-m", "not slow", "--hypothesis-seed=0", "--tb=no"]
        options += ["--continue-on-collection-errors"] if plain is None else ["-x"]
        code = 1
        with suppress(BaseException):
            interpret()
            code = int(pytest.main([*options, tests], plugins=[trial]))
        told.write_text(json.dumps({name: s for name, s in trial.seconds.items() if name not in trial.failed}))
        return code


_workshop: Workshop | None = None
_sources: dict[str, str] = {}


def _begin(found: dict[str, str]) -> None:
    global _workshop
    _workshop = Workshop()
    _sources.update(found)
    multiprocessing.util.Finalize(_workshop, _workshop.close, exitpriority=10)


def _attempt(change: Change) -> Outcome:
    assert _workshop is not None
    return _workshop.attempt(change, _sources[change.module])


def preload() -> None:
    """Import the libraries that the tests need, so that each child of this process has them from the start; Numba switched off."""
    os.environ["NUMBA_DISABLE_JIT"] = "1"
    for name in PRELOADED:
        with suppress(ImportError):
            __import__(name)


def chosen(found: dict[str, str], count: int | None, seed: int) -> list[Change]:
    """All changes of the sources, or a sample of `count`."""
    everything = [change for module, source in found.items() for change in changes(module, source)]
    if count is None or count >= len(everything):
        return everything
    return sorted(random.Random(seed).sample(everything, count), key=lambda change: (change.module, change.line))


def report(outcomes: list[Outcome], known: dict[str, str]) -> int:
    """Print what survived; returns the exit code."""
    fates = [outcome.fate for outcome in outcomes]
    listed = [o for o in outcomes if o.fate == "survived" and o.change.key in known]
    unlisted = [o for o in outcomes if o.fate != "killed" and o.change.key not in known]
    print(
        f"{len(outcomes)} changes: {fates.count('killed')} noticed, {len(listed)} equivalent, {len(unlisted)} unnoticed"
    )
    for outcome in unlisted:
        print(f"{outcome.fate}  {outcome.change.place}  {outcome.change.key}")
    wrong = [o.change.key for o in outcomes if o.fate == "killed" and o.change.key in known]
    for key in wrong:
        print(f"listed as equivalent, and noticed: {key}")
    return 1 if unlisted or wrong else 0


def main() -> int:
    """Try the changes that the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--count", type=int, help="size of the sample; all if absent")
    parser.add_argument("--seed", type=int, default=1, help="of the sample")
    parser.add_argument("--only", default="", help="beginning of the path inside the package, such as control/laws")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="how many are tried at a time")
    parser.add_argument("--list", action="store_true", help="print the changes and stop")
    given = parser.parse_args()
    found = sources(given.only)
    asked = chosen(found, given.count, given.seed)
    if given.list:
        print("\n".join(f"{change.place}  {change.key}" for change in asked))
        return 0
    preload()
    outcomes: list[Outcome] = []
    with multiprocessing.get_context("fork").Pool(max(1, given.jobs), _begin, (found,)) as pool:
        for outcome in pool.imap_unordered(_attempt, asked):
            outcomes.append(outcome)
            said = f"[{len(outcomes)}/{len(asked)}] {outcome.fate} {outcome.seconds:.1f} s  {outcome.change.place}"
            print(said, flush=True, file=sys.stderr)
        pool.close()
        pool.join()
    return report(sorted(outcomes, key=lambda o: (o.change.module, o.change.line)), equivalents())


if __name__ == "__main__":
    sys.exit(main())
