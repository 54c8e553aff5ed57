"""Threads that fly: rows of all tasks, and an end in the middle."""

import time

from armland.experiments.campaign.crews.threads import threads
from armland.experiments.campaign.rows import Job, Task


def test_all_tasks_are_done_and_a_few_in_advance_at_most(fakes):
    asked = []

    def tasks():
        for run in range(20):
            asked.append(run)
            yield Task(run, 0, run, {})

    found = []
    for row in threads(3)(fakes.quick, Job("", "x"), tasks()):
        found.append(row)
        assert len(asked) <= len(found) + 6
    assert sorted(found) == [fakes.quick(Job("", "x"), Task(run, 0, run, {})) for run in range(20)]


def test_who_asks_for_no_more_rows_ends_it(fakes):
    begun = []

    def work(job, task):
        begun.append(task.run)
        time.sleep(0.01)
        return fakes.quick(job, task)

    rows = threads(2)(work, Job("", "x"), (Task(run, 0, run, {}) for run in range(1000)))
    next(rows)
    rows.close()
    time.sleep(0.1)
    assert len(begun) < 20
