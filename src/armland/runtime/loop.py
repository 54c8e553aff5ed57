"""The loop: read, update, command, record. Nothing else ties the parts together."""

import time
from collections.abc import Callable, Iterable
from typing import TypeVar

from armland.records import AnyTick
from armland.runtime.ports import Controller, Port
from armland.runtime.recorder import Recorder

T = TypeVar("T", bound=AnyTick)

REPORT_EVERY = 500
"""Ticks between reports of progress."""


def run_loop(
    port: Port[T],
    controller: Controller[T],
    recorder: Recorder,
    tick: T,
    ticks: Iterable[int],
    progress: Callable[[int], None] | None = None,
) -> float:
    """Run the loop once for each of `ticks` and return the wall-clock time they took, s.

    A tick is recorded after its command was given, so the record shows what was really asked. Whatever happens, the port is
    stopped; the recorder is the caller's to close.

    Args:
        port: simulator, replay or devices.
        controller: fills the messages.
        recorder: takes each tick.
        tick: the messages of the tick in progress.
        ticks: their numbers, e.g. `range(1000)`; a generator that looks at `tick` decides from tick to tick whether it goes on.
        progress: called with the number of ticks done, now and then.
    """
    port.connect()
    read, update, command, append = port.read, controller.update, port.command, recorder.append
    begin = time.perf_counter()
    try:
        for k in ticks:
            read(tick)
            update(tick)
            command(tick)
            append()
            if progress is not None and k % REPORT_EVERY == 0:
                progress(k)
    finally:
        port.stop()
    return time.perf_counter() - begin
