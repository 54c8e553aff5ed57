"""The loop: read, update, command, record. Compiled in blocks with the physics inside, or tick by tick in Python: the same bytes.

Between blocks Python draws noise, writes the record and tells of phases that began; there Ctrl-C takes effect as well.
"""

import time
from collections.abc import Callable
from typing import Protocol

import numpy as np

from armland.errors import ArmlandError
from armland.mission.controller import Controller
from armland.mission.plan import Plan
from armland.records import Records
from armland.runtime.ports import Port
from armland.runtime.recorder import Recorder

BLOCK = 250
"""Most ticks between two looks at what else is to be done."""

Progress = Callable[[str, float], None]
"""Called with a phase's name and the time, s, at which it began, after the block in which it did."""


class Simulated(Port, Protocol):
    """A port that can also fly whole blocks, with the controller inside."""

    @property
    def compilable(self) -> bool:
        """Whether it can."""

    def advance(self, controller: Controller, rows: Records) -> tuple[int, ArmlandError | None]:
        """Fly on into `rows`: how many were filled, and why the tick after them could not be flown, where it could not."""


def fly(
    simulator: Simulated, controller: Controller, plan: Plan, recorder: Recorder, progress: Progress | None = None
) -> float:
    """Fly a mission to its end in compiled blocks, and return the wall-clock time that took, s, without the first tick's.

    It ends after `plan.ticks` ticks, or when a final phase was watched for `plan.watch` ticks; an end may lead on to a graver one,
    which is watched as long. Whatever happens, the port is stopped and the ticks flown are recorded. A recorder that fails ends no
    flight: see `Recorder.failure`.

    Args:
        simulator: what is flown; one that cannot fly blocks is flown by `fly_in_python`.
        controller: of the `plan`.
        plan: of the mission.
        recorder: takes the ticks; the caller closes it.
        progress: told of the phases.

    Raises:
        PlantError: command or state are no longer finite.
    """
    if not simulator.compilable:
        return fly_in_python(simulator, controller, plan, recorder, progress)

    def advance(rows: Records) -> int:
        flown, broken = simulator.advance(controller, rows)
        recorder.add(flown)
        if broken is not None:
            raise broken
        return flown

    return _fly(simulator, advance, controller, plan, recorder, progress)


def fly_in_python(
    port: Port, controller: Controller, plan: Plan, recorder: Recorder, progress: Progress | None = None
) -> float:
    """The same, tick by tick in Python: for devices, pictures and debuggers; arguments and errors as for `fly`."""
    tick, over = controller.tick, plan.watch
    read, update, command, source = port.read, controller.update, port.command, tick.buffer.view(np.uint8).data

    def advance(rows: Records) -> int:
        # As opaque bytes a row is copied in 0.15 µs; a structured one, field by field, takes 1.3 µs.
        raw, flown = rows.view(np.dtype((np.void, rows.itemsize))), 0
        try:
            while flown < len(raw):
                read(tick)
                update(tick)
                command(tick)
                raw[flown] = source
                flown += 1
                if controller.ended_for() >= over:
                    break
        finally:
            recorder.add(flown)
        return flown

    return _fly(port, advance, controller, plan, recorder, progress)


def _fly(
    port: Port,
    advance: Callable[[Records], int],
    controller: Controller,
    plan: Plan,
    recorder: Recorder,
    progress: Progress | None,
) -> float:
    port.connect()
    flown, phase, begin = 0, -1, time.perf_counter()
    try:
        while flown < plan.ticks and controller.ended_for() < plan.watch:
            # The first tick by itself: it may load or compile.
            rows = recorder.rows(min(BLOCK - flown % BLOCK, plan.ticks - flown) if flown else 1)
            done = advance(rows)
            if progress is not None:
                phase = _tell(rows[:done], phase, plan, progress)
            if not flown:
                begin = time.perf_counter()
            flown += done
    finally:
        port.stop()
    return time.perf_counter() - begin


def _tell(rows: Records, phase: int, plan: Plan, progress: Progress) -> int:
    phases = rows["mission"]["phase"]
    for k in np.flatnonzero(np.diff(phases, prepend=phase)):
        progress(plan.names[int(phases[k])], int(rows["mission"]["tick"][k]) / plan.scenario.run.rate_hz)
    return int(phases[-1]) if len(phases) else phase
