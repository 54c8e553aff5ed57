"""Flights on a Ray cluster: the same rows as here, dead workers, and addresses where nobody is."""

import socket

import pytest

from armland.errors import ConfigurationError
from armland.experiments.campaign.crews.cluster import cluster
from armland.experiments.campaign.rows import KILLED, Job, Task

pytest.importorskip("ray", reason="Ray is an extra: armland[cluster]")


def tasks(count):
    return iter([Task(run, 0, run, {}) for run in range(count)])


@pytest.fixture
def reached(fakes, tmp_path, monkeypatch):
    """Workers of Ray find the fakes as processes do: by the path of this one."""
    monkeypatch.setenv("PYTHONPATH", str(tmp_path / "modules"), prepend=":")
    return fakes


@pytest.mark.slow
def test_two_workers_give_the_rows_of_this_process(reached):
    rows = sorted(cluster("local", 2)(reached.quick, Job("", "x"), tasks(30)))
    assert rows == [reached.quick(Job("", "x"), task) for task in tasks(30)]


@pytest.mark.slow
def test_flight_that_kills_its_worker_twice_is_a_row_with_that_error(reached):
    rows = sorted(cluster("local", 2)(reached.deadly, Job("", "x"), tasks(8)))
    assert [r.run for r in rows] == list(range(8))
    assert [r.run for r in rows if r.outcome == KILLED] == [5]


def test_where_nobody_answers_it_is_said_at_once():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"127.0.0.1:{free.getsockname()[1]}"
    with pytest.raises(ConfigurationError, match="no cluster there"):
        cluster(address)
