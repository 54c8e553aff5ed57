"""A cache that is torn, or that cannot be, ends in compilation and not in a traceback."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

CODE = """
import sys

if sys.argv[1] == "forgiving":
    from armland.compiled import set_up

    set_up()
from kept import twice

print(twice(2.0), sum(twice.stats.cache_hits.values()))
"""


@pytest.fixture
def module(tmp_path: Path) -> Path:
    (tmp_path / "kept.py").write_text(
        "from numba import njit\n\n@njit(cache=True)\ndef twice(x):\n    return 2.0 * x\n"
    )
    return tmp_path


def run(folder: Path, how: str = "forgiving", **environment: str) -> tuple[int, str]:
    command = [sys.executable, "-c", CODE, how]
    found = subprocess.run(
        command,
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "NUMBA_CACHE_DIR": "", **environment},
    )
    return found.returncode, found.stdout.strip() or found.stderr.strip().rpartition("\n")[2]


def test_whole_cache_is_used(module: Path) -> None:
    assert run(module) == (0, "4.0 0")
    assert run(module) == (0, "4.0 1")


@pytest.mark.parametrize(("suffix", "share"), [pytest.param("nbi", 0.5, marks=pytest.mark.slow), ("nbc", 0.0)])
def test_torn_file_is_compiled_again(module: Path, suffix: str, share: float) -> None:
    run(module)
    (file,) = (module / "__pycache__").glob(f"*.{suffix}")
    whole = file.read_bytes()
    file.write_bytes(whole[: int(share * len(whole))])
    # Negative control: Numba by itself ends in a traceback.
    assert run(module, "bare")[0] == 1
    file.write_bytes(whole[: int(share * len(whole))])
    assert run(module) == (0, "4.0 0")
    assert run(module) == (0, "4.0 1")


def test_nowhere_to_write_is_no_reason_to_fail(module: Path) -> None:
    (module / "__pycache__").write_text("in the way")
    nowhere = str(module / "kept.py")
    assert run(module, "bare", XDG_CACHE_HOME=nowhere, HOME=nowhere)[0] == 1
    assert run(module, XDG_CACHE_HOME=nowhere, HOME=nowhere) == (0, "4.0 0")
