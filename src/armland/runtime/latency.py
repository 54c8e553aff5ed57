"""How late this machine wakes a loop of 1 kHz: what a real arm's loop would meet here; a simulated one does not mind."""

import time
from typing import NamedTuple

import numpy as np

PERIOD_NS = 1_000_000


class Latency(NamedTuple):
    """Of the wake-ups of a loop, s."""

    median: float
    p99: float
    worst: float
    missed: int  # Periods that were over before the loop woke
    periods: int
    resolution: float  # Of the clock


def measured(periods: int = 1000, period_ns: int = PERIOD_NS) -> Latency:
    """Sleep until each of `periods` deadlines, `period_ns` apart, and see how late it is then."""
    late = np.zeros(periods)
    start = time.monotonic_ns()
    for k in range(periods):
        deadline = start + (k + 1) * period_ns
        rest = deadline - time.monotonic_ns()
        if rest > 0:
            time.sleep(1e-9 * rest)
        late[k] = 1e-9 * (time.monotonic_ns() - deadline)
    return summary(late, 1e-9 * period_ns)


def summary(late: np.ndarray, period: float) -> Latency:
    """The figures of how `late` (k,), s, a loop of this `period`, s, woke."""
    return Latency(
        float(np.median(late)),
        float(np.percentile(late, 99.0)),
        float(late.max()),
        int((late > period).sum()),
        len(late),
        time.get_clock_info("monotonic").resolution,
    )
