from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from armland.records import MESSAGES, Records
from armland.runtime.recorder import Recorder

PERIOD_NS = 1_000_000


def fill(rows: Records, number: int) -> None:
    """Random bits, odd floats included, that depend on nothing but the tick's number, into the first of `rows`."""
    words = rows[:1].view(np.uint64)
    words[:] = np.random.default_rng(number).integers(0, 2**64, words.shape, np.uint64)
    for name in MESSAGES:
        rows[name]["tick"][0] = number


@pytest.fixture
def fill_tick() -> Callable[[Records, int], None]:
    return fill


@pytest.fixture
def record() -> Callable[..., np.ndarray]:
    """Record a run of random ticks and return them."""

    def run(path: Path | None, count: int, joints: int = 7, block: int = 4, **options) -> np.ndarray:
        with Recorder(path, joints, PERIOD_NS, block=block, keep_in_memory=True, **options) as recorder:
            for number in range(count):
                fill(recorder.rows(1), number)
                recorder.add(1)
        return recorder.ticks

    return run
