"""Processes that fly: rows, deaths of workers, death of who started them."""

import os
import signal
import subprocess
import sys
import time

import pytest

from armland.errors import ClusterError
from armland.experiments.campaign.crews.processes import processes
from armland.experiments.campaign.rows import KILLED, Job, Task


def tasks(count):
    return iter([Task(run, 0, run, {}) for run in range(count)])


def test_rows_are_those_of_this_process(fakes):
    rows = sorted(processes(2)(fakes.quick, Job("", "x"), tasks(30)))
    assert rows == [fakes.quick(Job("", "x"), task) for task in tasks(30)]


def test_no_task_starts_nobody(fakes):
    assert list(processes(2)(fakes.quick, Job("", "x"), tasks(0))) == []


def test_flight_of_a_killed_worker_is_made_once_more(fakes, tmp_path):
    rows = sorted(processes(2)(fakes.mortal, Job("", str(tmp_path / "mark")), tasks(12)))
    assert (tmp_path / "mark").exists()
    assert [r.run for r in rows] == list(range(12))
    assert all(r.outcome == "done" for r in rows)


def test_flight_that_kills_its_worker_twice_is_a_row_with_that_error(fakes):
    rows = sorted(processes(2)(fakes.deadly, Job("", "x"), tasks(12)))
    assert [r.run for r in rows] == list(range(12))
    assert [(r.run, r.outcome, r.error) for r in rows if r.outcome != "done"] == [
        (5, KILLED, "its worker was ended by signal 9, 2 times over")
    ]


def test_workers_that_cannot_start_are_one_message(fakes, monkeypatch):
    monkeypatch.setattr(sys, "executable", "/bin/false")
    with pytest.raises(ClusterError, match="do not start: its worker ended with exit code 1"):
        list(processes(1)(fakes.quick, Job("", "x"), tasks(3)))


PARENT = """
import sys
sys.path.insert(0, sys.argv[1])
import fakes
from armland.experiments.campaign.crews.processes import processes
from armland.experiments.campaign.rows import Job, Task
list(processes(2)(fakes.endless, Job("", sys.argv[2]), iter([Task(k, 0, k, {}) for k in range(4)])))
"""


def alive(number):
    try:
        with open(f"/proc/{number}/stat") as file:
            return file.read().split(") ")[1][0] != "Z"
    except OSError:
        return False


def wait_until(condition, seconds=20.0):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.02)


def test_workers_do_not_outlive_a_killed_parent(fakes, tmp_path):
    (tmp_path / "pids").mkdir()
    call = [sys.executable, "-c", PARENT, tmp_path / "modules", tmp_path / "pids"]
    with subprocess.Popen(call) as parent:
        # In the middle of a flight that never ends by itself.
        wait_until(lambda: len(list((tmp_path / "pids").iterdir())) == 2)
        workers = [int(p.name) for p in (tmp_path / "pids").iterdir()]
        assert all(alive(w) for w in workers)
        parent.send_signal(signal.SIGKILL)
    wait_until(lambda: not any(alive(w) for w in workers), 5.0)


def test_who_asks_for_no_more_rows_ends_the_workers(fakes):
    def children():
        return set(open(f"/proc/self/task/{os.getpid()}/children").read().split())

    before, rows = children(), processes(2)(fakes.quick, Job("", "x"), tasks(1000))
    next(rows)
    assert len(children() - before) == 2
    rows.close()
    assert children() == before
