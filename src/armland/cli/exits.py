"""Exit codes, and how whatever ends a command becomes one message and one of them."""

import os
import signal
import sys
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from armland.cli.streams import outlets
from armland.errors import ArmlandError, ConfigurationError, LogError

SUCCEEDED = 0
FAILED = 1  # It ran, and the UAV did not land, or a verdict does not hold
REFUSED = 2  # Bad input; nothing moved and nothing was written
BROKEN = 3  # Something broke: the machine, a disk, or armland itself
STOPPED = 130  # By Ctrl-C, as shells have it

EXPLAINED = "Exit code: 0 if it succeeds, 1 if not, 2 for bad input, 3 if something broke, 130 if it was stopped."
"""For the help of commands."""

TRACEBACK = "ARMLAND_TRACEBACK"  # Variable that names a file into which the details of an unexpected error go


class Judged(SystemExit):
    """The end of a command by its verdict, when its result is in its folder: nothing that happens later changes the exit code."""

    def __init__(self, success: bool) -> None:
        super().__init__(SUCCEEDED if success else FAILED)


def run_guarded(command: Callable[[], object]) -> int:
    """Run a command and return its exit code; whatever it raises ends in one message on standard error."""
    judged = False

    def watched() -> None:
        nonlocal judged
        try:
            command()
        except Judged:
            judged = True
            raise

    with outlets() as (out, _), _stoppable() as stop:
        code = _code(watched, stop)
        out.flush()
        if out.lost and out.failure is not None:
            say(f"standard output cannot be written: {out.failure.strerror}")
            code = BROKEN if code == SUCCEEDED and not judged else code
    return code


class _Stop:
    """Whether somebody has asked to stop."""

    asked = False

    def ask(self, *_: object) -> None:
        self.asked = True
        raise KeyboardInterrupt


@contextmanager
def _stoppable() -> Iterator[_Stop]:
    # Code that calls back into Python may swallow the interrupt and end in an error of its own: what was asked counts.
    stop, before = _Stop(), {}
    for number in (signal.SIGINT, signal.SIGTERM):
        with suppress(ValueError):
            before[number] = signal.signal(number, stop.ask)
    try:
        yield stop
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _code(command: Callable[[], object], stop: _Stop) -> int:
    try:
        command()
    except SystemExit as end:
        if end.code == STOPPED:
            say("stopped")
        return end.code if isinstance(end.code, int) else SUCCEEDED if end.code is None else BROKEN
    except KeyboardInterrupt:
        say("stopped")
        return STOPPED
    except Exception as e:
        said, code = (str(e), REFUSED) if isinstance(e, ConfigurationError | LogError) else (in_words(e), BROKEN)
        if stop.asked:
            said, code = "stopped", STOPPED
        say(said)
        return code
    return SUCCEEDED


def in_words(error: BaseException) -> str:
    """An error as one message."""
    if isinstance(error, ArmlandError):
        return str(error)
    if isinstance(error, MemoryError):
        return "there is not enough memory"
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename}: {error.strerror}" if error.filename else error.strerror
    _keep(error)
    first = (str(error).strip().splitlines() or [""])[0]
    return (
        f"an error inside armland ({type(error).__name__}: {first[:200]}); "
        f"please report it with the file that {TRACEBACK}=FILE armland ... writes"
    )


def _keep(error: BaseException) -> None:
    name = os.environ.get(TRACEBACK)
    if name:
        with suppress(OSError), open(name, "w", encoding="utf-8", errors="backslashreplace") as file:
            traceback.print_exception(error, file=file)


@contextmanager
def attempted(what: str) -> Iterator[None]:
    """Do what a finished result can be without; where it fails, say so."""
    try:
        yield
    except Exception as e:
        say(f"no {what}: {in_words(e)}")


def say(message: str) -> None:
    """One message on standard error."""
    print(f"armland: {message}", file=sys.stderr)
