"""What the recorder costs the loop: µs per tick for the copy and, amortised, for the blocks; size of the file."""

import tempfile
import time
from pathlib import Path

import numpy as np

from armland.records import Tick
from armland.runtime.log import read_log
from armland.runtime.recorder import Recorder

TICKS = 20_000
ROUNDS = 7


def _loop(path: Path | None, block: int, tick: Tick) -> float:
    with Recorder(path, tick, 1_000_000, block=block, keep_in_memory=False) as recorder:
        append, ticks = recorder.append, tick.measurement["tick"]
        start = time.perf_counter()
        for i in range(TICKS):
            ticks[0] = i
            append()
        return (time.perf_counter() - start) / TICKS * 1e6


def _empty_loop(tick: Tick) -> float:
    ticks = tick.measurement["tick"]
    start = time.perf_counter()
    for i in range(TICKS):
        ticks[0] = i
    return (time.perf_counter() - start) / TICKS * 1e6


def main() -> None:
    tick = Tick(7)
    numbers = tick.buffer.view(np.float64)
    numbers[:] = np.random.default_rng(0).standard_normal(numbers.shape)
    loop = min(_empty_loop(tick) for _ in range(ROUNDS))
    append = min(_loop(None, 500, tick) for _ in range(ROUNDS)) - loop
    print(f"append                {append:.2f} µs per tick")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "run.mcap")
        for block in (100, 250, 500, 1000, 2000):
            total = min(_loop(path, block, tick) for _ in range(ROUNDS)) - loop
            print(f"blocks of {block:4d} ticks  {total - append:.2f} µs per tick, amortised; {total:.2f} with append")
        print(f"file                  {path.stat().st_size / TICKS:.0f} kB per simulated second at 1 kHz")
        start = time.perf_counter()
        read_log(path)
        print(f"read_log              {(time.perf_counter() - start) / TICKS * 1e6:.2f} µs per tick")


if __name__ == "__main__":
    main()
