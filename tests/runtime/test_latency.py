import time

import numpy as np
import pytest

from armland.runtime import latency
from armland.runtime.latency import measured, summary


def test_summary_counts_what_came_a_period_late() -> None:
    late = np.full(100, 5e-5)
    late[[3, 50]] = 0.002, 0.004
    found = summary(late, 1e-3)
    assert (found.median, found.worst, found.missed, found.periods) == (5e-5, 0.004, 2, 100)
    assert 5e-5 < found.p99 < 0.004
    assert 0.0 < found.resolution < 1e-3


def test_lateness_counts_from_the_deadlines_and_not_from_wake_up_to_wake_up(monkeypatch) -> None:
    """A clock by hand: each sleep takes 0.2 ms longer than asked for, and one 3 ms."""
    clock, sleeps = [0], []
    monkeypatch.setattr(latency.time, "monotonic_ns", lambda: clock[0])

    def sleep(seconds: float) -> None:
        sleeps.append(seconds)
        clock[0] += round(1e9 * seconds) + (3_000_000 if len(sleeps) == 5 else 200_000)

    monkeypatch.setattr(latency.time, "sleep", sleep)
    found = measured(20)
    assert found.median == pytest.approx(2e-4)
    assert found.worst == pytest.approx(3e-3)
    # Two deadlines have passed when it wakes up again; for them it does not sleep.
    assert found.missed == 2
    assert len(sleeps) == 20 - 3
    assert sleeps[1] == pytest.approx(8e-4)


def test_it_takes_as_long_as_its_periods() -> None:
    start = time.monotonic()
    found = measured(50)
    assert time.monotonic() - start >= 0.05
    assert found.periods == 50
    assert 0.0 <= found.median <= found.p99 <= found.worst
