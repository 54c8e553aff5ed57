"""Inner functions have no entry and no code of their own, and what is linked of them computes the same."""

import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from numba import njit
from numba.extending import overload

from armland.compiled import inner as inner_code
from armland.compiled import set_up

set_up()

TYPING = threading.Event()


@njit
def grown(x):
    return x + 1.0


@njit
def root_of(x):
    if x < 0.0:
        raise ValueError("negative")
    return np.sqrt(x)


@njit
def doubled(x):
    return 2.0 * grown(x)


@njit
def all_of_it(x):
    return doubled(x) + grown(x) + root_of(x) + np.sum(np.array([x, x]) * 0.5)


@pytest.fixture
def ours(monkeypatch):
    monkeypatch.setattr(inner_code, "PACKAGE", __name__)


def is_inner(function):
    return [inner_code.deferred(result.library) for result in function.overloads.values()]


def test_functions_that_compiled_code_calls_are_linked_and_can_be_called_as_well(ours):
    assert all_of_it(4.0) == 10.0 + 5.0 + 2.0 + 4.0
    assert is_inner(all_of_it) == [False]
    for function in (doubled, grown, root_of):
        assert is_inner(function) == [True]
    assert (doubled(4.0), grown(4.0)) == (10.0, 5.0)
    assert is_inner(doubled) == is_inner(grown) == [False]
    assert is_inner(root_of) == [True]
    assert all_of_it(1.0) == 4.0 + 2.0 + 1.0 + 1.0


def still_typed():
    return None


@overload(still_typed)
def _still_typed():
    TYPING.set()
    time.sleep(0.5)
    return lambda: 0.0


@njit
def asked_by_two(x):
    return x + 2.0


@njit
def slowly_compiled(x):
    return asked_by_two(x) + still_typed()


def test_a_function_that_another_thread_compiles_as_an_inner_one_can_be_called(ours):
    with ThreadPoolExecutor(1) as pool:
        whole = pool.submit(slowly_compiled, 1.0)
        assert TYPING.wait(30.0)
        assert asked_by_two(1.0) == 3.0
        assert whole.result() == 3.0


def test_exception_of_an_inner_function_arrives(ours):
    with pytest.raises(ValueError, match="negative"):
        all_of_it(-1.0)


def test_code_of_others_is_left_alone():
    @njit
    def inner(x):
        return x - 1.0

    @njit
    def outer(x):
        return inner(x)

    assert outer(1.0) == 0.0
    assert is_inner(inner) == [False]


PACKAGE = """
from numba import njit

@njit(cache=True)
def inner(x):
    if x < 0.0:
        raise ValueError("negative")
    return 3.0 * x

@njit(cache=True)
def outer(x):
    return inner(x) + 1.0
"""

CODE = """
import sys
from armland.compiled import inner as inner_code
from armland.compiled import set_up
inner_code.PACKAGE = "laws"
set_up()
from laws import inner, outer
for name in sys.argv[1:]:
    f = {"inner": inner, "outer": outer}[name]
    print(f(1.0), sum(f.stats.cache_hits.values()))
    try:
        f(-1.0)
    except ValueError as error:
        print(error)
"""


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Call functions by name in a process of its own: results with hits of the cache, and messages of their exceptions."""
    (tmp_path / "laws.py").write_text(PACKAGE)
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)

    def called(*names):
        command = [sys.executable, "-c", CODE, *names]
        found = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True).stdout.split("\n")
        return found[:-1:2], found[1::2]

    return called


def test_only_functions_with_an_entry_are_cached(run, tmp_path):
    assert run("outer") == (["4.0 0"], ["negative"])
    assert [p.name.partition("-")[0] for p in (tmp_path / "__pycache__").glob("*.nbi")] == ["laws.outer"]
    assert run("outer", "inner") == (["4.0 1", "3.0 0"], ["negative", "negative"])
    assert run("inner", "outer") == (["3.0 1", "4.0 1"], ["negative", "negative"])


def test_inner_function_that_is_cached_with_its_entry_is_linked_from_there(run):
    assert run("inner") == (["3.0 0"], ["negative"])
    assert run("outer", "inner") == (["4.0 0", "3.0 1"], ["negative", "negative"])
