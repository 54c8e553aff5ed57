"""Who flies: processes, threads of this process, or a cluster. Each takes tasks and gives rows as they are done.

Processes are the rule. The compiled loop runs without Python's lock, but a flight's start and judging hold it: half of the
processor's time where each flight has a scenario of its own. So any number of threads is twice as fast at most, and a crash takes all.
Threads need no start, which is as long as four flights: they fly a few seeds.
"""

from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from functools import partial
from itertools import islice

from armland.experiments.campaign.rows import Job, Row, Task

Work = Callable[[Job, Task], Row]
"""Makes the row of a task and raises nothing; a function of a module, so that other processes find it."""

Crew = Callable[[Work, Job, Iterator[Task]], Iterator[Row]]
"""Gives the rows of all tasks, in any order; whoever stops to ask for more ends it."""


def threads(jobs: int) -> Crew:
    """A crew of `jobs` threads of this process."""
    return partial(_by_threads, jobs)


def _by_threads(jobs: int, work: Work, job: Job, tasks: Iterator[Task]) -> Iterator[Row]:
    pool = ThreadPoolExecutor(jobs, "flight")
    under_way: set[Future[Row]] = {pool.submit(work, job, task) for task in islice(tasks, jobs)}
    try:
        while under_way:
            done, under_way = wait(under_way, return_when=FIRST_COMPLETED)
            under_way |= {pool.submit(work, job, task) for task in islice(tasks, len(done))}
            yield from (future.result() for future in done)
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
