"""Compiled code must go when anything that it was compiled from has changed, and only then."""

import subprocess
import sys

import pytest

from armland.compiled.stamps import PACKAGE, STAMPS, cache, drop_stale, places, user_cache

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
    assert any((cache(PACKAGE, place) / STAMPS).is_file() for place in places())


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


@pytest.mark.parametrize("variable", ["NUMBA_CACHE_DIR", "XDG_CACHE_HOME"])
def test_code_goes_wherever_numba_keeps_it(package, tmp_path, monkeypatch, variable):
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    monkeypatch.setenv(variable, str(tmp_path / "kept"))
    place = tmp_path / "kept" if variable == "NUMBA_CACHE_DIR" else user_cache()
    folder = cache(package / "laws", place)
    folder.mkdir(parents=True)
    cache(package, place).mkdir(parents=True)
    drop_stale(package)
    for name in ("callee", "other"):
        (folder / f"{name}.f-3.py311.1.nbc").touch()
    with (package / "laws/callee.py").open("a", encoding="utf-8") as file:
        file.write("# another line\n")
    drop_stale(package)
    assert [p.name for p in folder.iterdir()] == ["other.f-3.py311.1.nbc"]


def test_folders_are_those_of_numba(tmp_path, monkeypatch):
    from numba.core import caching, config

    file = tmp_path / "module.py"
    file.write_text("def f():\n    pass\n")
    function = compile(file.read_text(), str(file), "exec").co_consts[0]
    stand_in = type("F", (), {"__code__": function})
    monkeypatch.setattr(config, "CACHE_DIR", str(tmp_path / "named"))
    named = caching.UserProvidedCacheLocator(stand_in, str(file))
    assert named.get_cache_path() == str(cache(tmp_path, tmp_path / "named"))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    own = caching.UserWideCacheLocator(stand_in, str(file))
    assert own.get_cache_path() == str(cache(tmp_path, user_cache()))
    beside = caching.InTreeCacheLocator(stand_in, str(file))
    assert beside.get_cache_path() == str(cache(tmp_path, None))


def test_package_that_cannot_be_written_is_left_alone(package, monkeypatch, tmp_path):
    drop_stale(package)
    compile_all(package)
    (package / "laws/callee.py").write_text("# new\n")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    monkeypatch.setattr("os.access", lambda path, mode: False)
    monkeypatch.setattr("pathlib.Path.unlink", lambda self, missing_ok: (_ for _ in ()).throw(PermissionError()))
    assert drop_stale(package) != []
    assert compiled(package) == everything()
