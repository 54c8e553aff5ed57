"""A crew of processes: one that dies costs the flight that it made, which is made once more; none outlives who started it."""

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from functools import partial
from multiprocessing.connection import Connection, Pipe, wait

from armland.errors import ClusterError
from armland.experiments.campaign.crews.threads import Crew, Work
from armland.experiments.campaign.crews.worker import READY
from armland.experiments.campaign.rows import Job, Row, Task, lost

FRUGAL = {
    "MALLOC_MMAP_THRESHOLD_": "262144",
    "MALLOC_ARENA_MAX": "2",
    "OPENBLAS_NUM_THREADS": "1",
    "OMP_NUM_THREADS": "1",
}
"""Memory of a flight's ticks goes back to the system after it: by default the C library keeps it in pieces, and a process grows to
three times of what it needs. And one flight is for one core."""

TRIES = 2
"""Workers that may die over a flight before it is a row with that error."""


def processes(jobs: int) -> Crew:
    """A crew of `jobs` processes."""
    return partial(_by_processes, jobs)


class _Worker:
    # A process, this end of its pipe, and what it was asked for. Closing the pipe ends it; so does the death of this process.
    def __init__(self, work: Work, job: Job) -> None:
        own, other = Pipe()
        with other:
            # The other process finds what this one finds, wherever it was imported from.
            path = os.pathsep.join(p for p in sys.path if p)
            self.process = subprocess.Popen(
                [sys.executable, "-m", "armland.experiments.campaign.crews.worker", str(other.fileno())],
                stdin=subprocess.DEVNULL,
                pass_fds=[other.fileno()],
                env={**os.environ, **FRUGAL, "PYTHONPATH": path},
                # Ctrl-C at a terminal is for who started it, and he ends this one.
                process_group=0,
            )
        self.pipe: Connection = own
        self.ready, self.tries = False, 0
        self.task: Task | None = None
        self._send((work, job))

    def give(self, task: Task, tries: int = 1) -> None:
        self.task, self.tries = task, tries
        self._send(task)

    def _send(self, what: object) -> None:
        # A worker that is dead is noticed when its answer is waited for.
        with suppress(OSError):
            self.pipe.send(what)

    def end(self) -> None:
        self.pipe.close()

    def died(self) -> str:
        """How, in words."""
        self.pipe.close()
        code = self.process.wait()
        return f"its worker was ended by signal {-code}" if code < 0 else f"its worker ended with exit code {code}"


def _by_processes(jobs: int, work: Work, job: Job, tasks: Iterator[Task]) -> Iterator[Row]:
    first = next(tasks, None)
    workers: list[_Worker] = []
    try:
        while first is not None and len(workers) < jobs:
            workers.append(_started(work, job, first))
            first = next(tasks, None) if len(workers) < jobs else None
        while busy := {w.pipe: w for w in workers if w.task is not None}:
            for pipe in wait(list(busy)):
                row = _heard(busy[pipe], workers, work, job)  # type: ignore[index]
                if row is not None:
                    following = next(tasks, None)
                    spare = next((w for w in workers if w.task is None), None)
                    if following is not None and spare is not None:
                        spare.give(following)
                    yield row
    finally:
        for worker in workers:
            worker.end()
        for worker in workers:
            worker.process.wait()


def _started(work: Work, job: Job, task: Task, tries: int = 1) -> _Worker:
    worker = _Worker(work, job)
    worker.give(task, tries)
    return worker


def _heard(worker: _Worker, workers: list[_Worker], work: Work, job: Job) -> Row | None:
    # What a worker says: that it is ready, or a row. Where it is dead another takes its place, and its flight once more.
    try:
        said = worker.pipe.recv()
    except (EOFError, OSError):
        why, task = worker.died(), worker.task
        workers.remove(worker)
        assert task is not None
        if worker.tries < TRIES:
            workers.append(_started(work, job, task, worker.tries + 1))
            return None
        if not worker.ready:
            raise ClusterError(f"workers of the campaign do not start: {why}") from None
        spare = _Worker(work, job)
        workers.append(spare)
        return lost(task, f"{why}, {TRIES} times over")
    if said == READY:
        worker.ready = True
        return None
    worker.task = None
    return said
