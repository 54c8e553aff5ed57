"""Cost of the closed loop against a bare `mj_step` of the same scene, interleaved in one process: a ratio, which noise moves least.

Run: .venv/bin/python benchmarks/loop.py [ROUNDS]

The closed loop is the compiled one with recorder and file. The bare steps begin at the same start, with the motors as they stand
there. Two threads fly two landings, against one thread that flies both one after the other.
"""

import sys
import tempfile
import threading
import time
from pathlib import Path

import numpy as np
from numba import njit

from armland.experiments.episode import Flight, prepare
from armland.native import mj_step
from armland.plant.simulator import Simulator
from armland.runtime import loops
from armland.runtime.recorder import Recorder
from armland.scenario import load_scenario

CASES = {
    "E3": (("paper", "E3", None), 2.3),
    "law with observers": (("compare", "track", "observer"), 2.6),
    "landing": (("landing", "landing", None), 1.7),
}
"""Scenario, mission and experiment, and the bound of the ratio."""


@njit(cache=True, nogil=True)
def step(model: int, data: int, steps: int) -> None:
    """Bare steps of the physics."""
    for _ in range(steps):
        mj_step(model, data)


def made(case: tuple[str, str, str | None], seed: int | None = None) -> Flight:
    scenario, mission, experiment = case
    return prepare(load_scenario(scenario), mission, seed, experiment=experiment)


def closed(flight: Flight, file: Path) -> tuple[float, int]:
    """Seconds of a flight, and its ticks."""
    begin = time.perf_counter()
    with Recorder(file, flight.plan.joints, flight.period_ns, flight.metadata, keep_in_memory=True) as recorder:
        loops.fly(flight.simulator, flight.controller, flight.plan, recorder, None)
        ticks = len(recorder.ticks)
    return time.perf_counter() - begin, ticks


def bare(simulator: Simulator, ticks: int) -> float:
    simulator.connect()
    begin = time.perf_counter()
    step(simulator.scene.model._address, simulator.data._address, ticks)
    return time.perf_counter() - begin


def python_tick(flight: Flight) -> np.ndarray:
    """Seconds of the controller's tick (k,) in a loop in Python."""
    simulator, controller, out = flight.simulator, flight.controller, []
    simulator.connect()
    for _ in range(6000):
        simulator.read(controller.tick)
        begin = time.perf_counter()
        controller.update(controller.tick)
        out.append(time.perf_counter() - begin)
        simulator.command(controller.tick)
    return np.array(out[1000:])


def threads(file: Path) -> float:
    """Time of two landings one after the other over that of two at once."""

    def fly(flight: Flight, k: int) -> None:
        closed(flight, file.with_suffix(f".{k}"))

    ones = [made(CASES["landing"][0], seed) for seed in (1, 2)]
    twos = [made(CASES["landing"][0], seed) for seed in (1, 2)]
    begin = time.perf_counter()
    for k, flight in enumerate(ones):
        fly(flight, k)
    middle = time.perf_counter()
    both = [threading.Thread(target=fly, args=(flight, k)) for k, flight in enumerate(twos)]
    for thread in both:
        thread.start()
    for thread in both:
        thread.join()
    return (middle - begin) / (time.perf_counter() - middle)


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 7
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "loop.mcap"
        for name, (case, bound) in CASES.items():
            closed(made(case), file)
            found = []
            for _ in range(rounds):
                wall, ticks = closed(made(case), file)
                found.append((wall / ticks, bare(made(case).simulator, ticks) / ticks))
            loop, physics = np.median(found, axis=0)
            ratio = np.median([a / b for a, b in found])
            print(
                f"{name:20s} {1e6 * loop:6.1f} us a tick, step {1e6 * physics:5.1f} us, ratio {ratio:4.2f} (bound {bound})"
            )
        print(f"two threads against one: {np.median([threads(file) for _ in range(rounds)]):.2f} (bound 1.85)")
        late = 1e6 * python_tick(made(CASES["E3"][0]))
        p50, p999 = np.percentile(late, (50.0, 99.9))
        print(f"controller in Python: p50 {p50:.1f} us (bound 12), p99.9 {p999:.0f} us (bound 100)")


if __name__ == "__main__":
    main()
