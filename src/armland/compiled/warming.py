"""What a command needs is compiled beforehand, by processes side by side, into the cache.

Each piece of work is a call `module:function(argument)`. Two processes take them one after the other, so the longest come first.
"""

import json
import os
import subprocess
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from queue import Empty, SimpleQueue
from subprocess import PIPE

from armland.compiled.stamps import PACKAGE, STAMPS, cache, places

WARM = "warm_{joints}.json"
"""Beside the stamps: those with which everything for an arm with so many joints was compiled last."""

PROCESSES = 2

_WORKER = """
import gc, importlib, sys
gc.disable()  # a tenth of the time
for line in sys.stdin:
    module, function, argument = line.split()
    getattr(importlib.import_module(module), function)(argument)
    print("done", flush=True)
"""


def is_warm(joints: int) -> bool:
    """Whether the compiled code for an arm with `joints` joints is there; also where there is to be none, or nowhere to keep it."""
    at = place()
    if os.environ.get("NUMBA_DISABLE_JIT") == "1" or at is None:
        return True
    return _stamps(at / WARM.format(joints=joints)) == _stamps(at / STAMPS)


def warm(joints: int, work: Sequence[tuple[str, str]], tell: Callable[[int, int], None]) -> bool:
    """Compile; returns whether all went well. Where not, the command compiles what is missing as it goes.

    Args:
        joints: of the arm.
        work: calls as `module:function` and argument, the longest first.
        tell: called with how many of them are done, and how many there are.
    """
    left: SimpleQueue[tuple[str, str]] = SimpleQueue()
    for piece in work:
        left.put(piece)
    done: list[str] = []

    def run() -> None:
        command = [sys.executable, "-c", _WORKER]
        with subprocess.Popen(command, bufsize=0, stdin=PIPE, stdout=PIPE, stderr=subprocess.DEVNULL) as worker:
            assert worker.stdin is not None
            assert worker.stdout is not None
            while not left.empty():
                try:
                    call, argument = left.get_nowait()
                    worker.stdin.write(f"{call.replace(':', ' ')} {argument}\n".encode())
                except (Empty, BrokenPipeError):
                    return
                # A worker that died answers nothing.
                if not worker.stdout.readline():
                    return
                done.append(call)
                tell(len(done), len(work))

    with ThreadPoolExecutor(min(PROCESSES, os.cpu_count() or 1)) as pool:
        for finished in [pool.submit(run) for _ in range(PROCESSES)]:
            finished.result()
    if good := len(done) == len(work):
        at = place()
        if at is not None:
            with suppress(OSError):
                (at / WARM.format(joints=joints)).write_text(json.dumps(_stamps(at / STAMPS)), encoding="utf-8")
    return good


def place() -> Path | None:
    """The folder in which compiled code of the package is kept; None where it cannot be kept."""
    # The first place with stamps that can be written is the one that Numba uses.
    for folder in places():
        if os.access(cache(PACKAGE, folder) / STAMPS, os.W_OK):
            return cache(PACKAGE, folder)
    return None


def _stamps(file: Path) -> object:
    try:
        return json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
