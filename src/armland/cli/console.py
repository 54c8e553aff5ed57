"""Progress on standard error, and whether a start compiles."""

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

COMPILING = "Compiling the control laws: this happens once and takes less than a minute."

SEARCHING = "Looking for a place where this arm can catch and put down; where few poses work that takes minutes: {:.0f} s so far."

PATIENCE_S = 5.0
"""Seconds after which a search says that it goes on; each further line comes after twice as long."""

TELL_S = 30.0
"""Seconds between two lines about a campaign where there is no terminal."""

UNKEPT = (
    "Compiling as it flies, which takes a minute or two each time: nothing compiled can be kept here. "
    "To keep it, let NUMBA_CACHE_DIR name a folder that can be written to."
)


def diagnostics() -> Console:
    """Standard error."""
    return Console(stderr=True)


def ready(joints: int = 7) -> Console:
    """Standard error, when what a flight needs is compiled; where it is not there yet, says so and how far that is.

    Args:
        joints: of the arm; that which comes with armland has seven.
    """
    from armland.compiled.warming import is_warm, place, warm

    console = diagnostics()
    if place() is None:
        console.print(UNKEPT, highlight=False)
    if is_warm(joints):
        return console
    console.print(COMPILING, highlight=False)
    from armland.experiments.warming import pieces

    with progress_bar(console) as bar:
        task = bar.add_task("compiled")
        warm(joints, pieces(joints), lambda done, total: bar.update(task, completed=done, total=total))
    return console


@contextmanager
def patiently(console: Console, patience_s: float = PATIENCE_S) -> Iterator[None]:
    """Say now and then that a search goes on, for as long as what stands inside takes."""
    done, begun = threading.Event(), time.monotonic()

    def tell() -> None:
        wait = patience_s
        while not done.wait(wait):
            console.print(SEARCHING.format(time.monotonic() - begun), highlight=False)
            wait *= 2.0

    teller = threading.Thread(target=tell, daemon=True)
    teller.start()
    try:
        yield
    finally:
        done.set()
        teller.join()


def progress_bar(console: Console) -> Progress:
    """Bars that vanish when they are done."""
    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        TaskProgressColumn(),
        TimeElapsedColumn(),
        console=console,
        transient=True,
    )


@contextmanager
def reported(console: Console) -> Iterator[Callable[[str, int, int], None]]:
    """Takes name, done and total: one bar per name, made when the name is first heard of."""
    tasks: dict[str, Any] = {}
    with progress_bar(console) as bar:

        def report(name: str, done: int, total: int) -> None:
            if name not in tasks:
                tasks[name] = bar.add_task(name, total=total)
            bar.update(tasks[name], completed=done, total=total)

        yield report


@contextmanager
def phases_told(console: Console, mission: str) -> Iterator[Callable[[str, float], None]]:
    """Takes phase and time, s: one line that changes on a terminal, a line for each phase where there is none."""
    if console.is_terminal:
        # Of the spinners this one is of letters that every terminal has.
        with console.status(mission, spinner="line") as status:
            yield lambda phase, t: status.update(f"{t:5.1f} s  {phase}")
    else:
        yield lambda phase, t: console.print(f"{t:5.1f} s  {phase}", highlight=False)


@contextmanager
def flights_told(console: Console, mission: str, total: int) -> Iterator[Callable[[bool], None]]:
    """Takes the success of each flight of a campaign: a bar on a terminal, some ten lines where there is none."""
    if console.is_terminal:
        with progress_bar(console) as bar:
            task = bar.add_task(mission, total=total)
            yield lambda _: bar.advance(task)
        return
    flown: list[bool] = []

    def tell(success: bool) -> None:
        flown.append(success)
        if len(flown) * 10 // total > (len(flown) - 1) * 10 // total:
            console.print(f"{len(flown)} of {total} flown, {sum(flown)} succeed", highlight=False)

    yield tell


@contextmanager
def campaign_told(console: Console, mission: str, total: int, there: int = 0) -> Iterator[Callable[[bool], None]]:
    """Takes the success of each new flight: how many, how fast, how long yet, in a bar on a terminal, every half minute without one.

    Args:
        console: where it is told.
        mission: what is flown.
        total: flights of the campaign.
        there: flights that were made before.
    """
    begun, told, done, good = time.monotonic(), time.monotonic(), 0, 0

    def words() -> str:
        rate = done / max(time.monotonic() - begun, 1e-9)
        left = (total - there - done) / rate if rate else 0.0
        return f"{there + done} of {total} flown, {good} of {done} succeed, {rate:.3g} per s, {_duration(left)} left"

    def count(success: bool) -> None:
        nonlocal done, good
        done, good = done + 1, good + success

    if console.is_terminal:
        columns = (
            TextColumn("{task.description}"),
            BarColumn(),
            TaskProgressColumn(),
            TextColumn("{task.fields[words]}"),
        )
        with Progress(*columns, console=console, transient=True) as bar:
            task = bar.add_task(mission, total=total, completed=there, words="starting")

            def advance(success: bool) -> None:
                count(success)
                bar.update(task, advance=1, words=words().partition(", ")[2])

            yield advance
        return

    def tell(success: bool) -> None:
        nonlocal told
        count(success)
        if time.monotonic() - told > TELL_S or there + done == total:
            told = time.monotonic()
            console.print(words(), highlight=False)

    yield tell


def _duration(seconds: float) -> str:
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 5400.0 else f"{seconds / 3600.0:.1f} h"
