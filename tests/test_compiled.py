"""Compiled code must go when anything that it was compiled from has changed, and only then."""

import subprocess
import sys

import pytest

from armland.compiled import PACKAGE, STAMPS, drop_stale

SOURCES = {
    "__init__.py": "",
    "constants.py": "GRAVITY = 9.81\n",
    "laws/callee.py": "from lander.constants import GRAVITY\n",
    "laws/caller.py": "from lander.laws.callee import (\n    one,\n    two,\n)\n",
    "laws/user.py": "from lander.laws import caller\n",
    "laws/other.py": "import numpy\n",
    "top.py": "def late():\n    import lander.laws.user\n",
    "named.py": "from lander import constants as c, errors\n",
}


@pytest.fixture
def package(tmp_path):
    """A package whose every module has a compiled function."""
    root = tmp_path / "lander"
    for name, text in SOURCES.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        compile_all(root)
    return root


def compile_all(root):
    for path in root.rglob("*.py"):
        (path.parent / "__pycache__").mkdir(exist_ok=True)
        for suffix in ("nbi", "1.nbc"):
            (path.parent / "__pycache__" / f"{path.stem}.f-3.py311.{suffix}").touch()


def compiled(root):
    """Modules whose compiled functions are there, both files or none."""
    found = {
        suffix: {
            p.parent.parent.joinpath(p.name.split(".")[0]).relative_to(root).as_posix()
            for p in root.rglob(f"*.{suffix}")
        }
        for suffix in ("nbi", "nbc")
    }
    assert found["nbi"] == found["nbc"]
    return found["nbi"]


def everything():
    return {name.removesuffix(".py") for name in SOURCES}


def test_what_nobody_vouches_for_goes_and_what_was_compiled_since_stays(package):
    drop_stale(package)
    assert compiled(package) == set()
    compile_all(package)
    assert drop_stale(package) == []
    assert compiled(package) == everything()


@pytest.mark.parametrize(
    ("changed", "gone"),
    [
        ("laws/callee.py", {"laws/callee", "laws/caller", "laws/user", "top"}),
        ("laws/other.py", {"laws/other"}),
        ("constants.py", {"constants", "laws/callee", "laws/caller", "laws/user", "top", "named"}),
        ("laws/user.py", {"laws/user", "top"}),
    ],
)
def test_change_takes_along_all_that_is_built_on_it(package, changed, gone):
    drop_stale(package)
    compile_all(package)
    with (package / changed).open("a", encoding="utf-8") as file:
        file.write("# another line\n")
    assert {p.relative_to(package).with_suffix("").as_posix() for p in drop_stale(package)} == gone
    assert compiled(package) == everything() - gone


def test_module_of_a_similar_name_keeps_its_own(package):
    """`caller.py` and `caller_two.py`: the names of cache files begin alike."""
    (package / "laws" / "caller_two.py").write_text("", encoding="utf-8")
    drop_stale(package)
    compile_all(package)
    with (package / "laws/caller.py").open("a", encoding="utf-8") as file:
        file.write("# another line\n")
    drop_stale(package)
    assert "laws/caller_two" in compiled(package)
    assert "laws/caller" not in compiled(package)


def test_spoilt_stamps_count_as_none(package):
    drop_stale(package)
    compile_all(package)
    (package / "__pycache__" / "compiled.json").write_text("{", encoding="utf-8")
    assert len(drop_stale(package)) == len(SOURCES)
    assert compiled(package) == set()


def test_package_itself_was_checked_when_it_was_imported():
    assert (PACKAGE / STAMPS).is_file()


@pytest.mark.slow
def test_numba_alone_runs_old_code_and_with_this_the_new(tmp_path):
    """Negative control: without `drop_stale` the caller still computes what the callee was before its change."""
    root = tmp_path / "lander"
    root.mkdir()
    (root / "__init__.py").touch()
    jit = "from numba import njit\n"
    (root / "caller.py").write_text(
        f"{jit}from lander.callee import inner\n@njit(cache=True)\ndef outer(x):\n    return inner(x)\n"
    )

    def callee(factor):
        (root / "callee.py").write_text(f"{jit}@njit(cache=True)\ndef inner(x):\n    return {factor} * x\n")

    def run():
        code = "from lander.caller import outer; print(outer(1.0))"
        found = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
        return float(found.stdout)

    callee(2.0)
    drop_stale(root)
    assert run() == 2.0
    callee(3.0)
    assert run() == 2.0
    drop_stale(root)
    assert run() == 3.0


RECORDS = """
import sys

import numpy as np
from numba import njit

if sys.argv[1] == "named":
    from armland.compiled import name_records_by_layout

    name_records_by_layout()


@njit(cache=True)
def callee(r):
    total = 0.0
    for i in range(r.a.shape[0]):
        total += np.sin(r.a[i])
    for _ in range(100):
        # Long enough not to be merged into its caller.
        total += np.cos(total + r.b)
    return r.b + 0.0 * total


@njit(cache=True)
def caller(records):
    return callee(records[0])


for n in map(int, sys.argv[2:]):
    x = np.zeros(1, np.dtype([("a", "f8", (n,)), ("b", "f8")]))
    x["b"] = 7.0
    print(caller(x))
"""


@pytest.mark.parametrize(("names", "right"), [("named", True), ("numbered", False)])
def test_code_for_two_records_from_two_processes_is_not_mixed_up(names, right, tmp_path):
    script = tmp_path / "records.py"
    script.write_text(RECORDS, encoding="utf-8")

    def run(*sizes):
        command = [sys.executable, str(script), names, *map(str, sizes)]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()

    assert run(3) == run(9) == ["7.0"]
    # Without the names a function compiled for the one record is called with the other: Numba's own behaviour.
    assert (run(3, 9) == ["7.0", "7.0"]) == right
