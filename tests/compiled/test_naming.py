"""Code that two processes compiled for different records must not be mixed up by a third."""

import subprocess
import sys

import pytest

RECORDS = """
import sys

import numpy as np
from numba import njit

if sys.argv[1] == "named":
    from armland.compiled.naming import name_records_by_layout

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
