from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from armland.records import AnyTick, Tick
from armland.runtime.recorder import Recorder

PERIOD_NS = 1_000_000


def fill(tick: AnyTick, number: int) -> None:
    """Random bits, odd floats included, that depend on nothing but the tick's number."""
    words = tick.buffer.view(np.uint64)
    words[:] = np.random.default_rng(number).integers(0, 2**64, words.shape, np.uint64)
    for name in tick.table.messages:
        getattr(tick, name)["tick"] = number


@pytest.fixture
def fill_tick() -> Callable[[AnyTick, int], None]:
    return fill


@pytest.fixture
def record() -> Callable[..., np.ndarray]:
    """Record a run of random ticks and return them."""

    def run(
        path: Path | None, count: int, joints: int = 7, block: int = 4, kind: type[AnyTick] = Tick, **options
    ) -> np.ndarray:
        tick = kind(joints)
        with Recorder(path, tick, PERIOD_NS, block=block, keep_in_memory=True, **options) as recorder:
            for number in range(count):
                fill(tick, number)
                recorder.append()
        return recorder.ticks

    return run
