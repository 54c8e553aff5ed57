"""How fast a whole landing runs: real-time factor, and what a tick costs beside the bare physics step of the same flight.

Run: .venv/bin/python benchmarks/landing.py [FLIGHTS]
"""

import sys
import time

import mujoco
import numpy as np

from armland.mission.landing_controller import LandingController
from armland.mission.landing_scenario import landing_scenario
from armland.mission.landing_setup import Setup, set_up
from armland.mission.records import LandingTick
from armland.plant.landing import LandingPlant

PARTS = ("read", "update", "command", "of it mj_step")


def fly(setup: Setup) -> tuple[float, int]:
    """Wall-clock time in s and ticks of one flight as the command flies it, without record and figures."""
    plant, controller, tick = LandingPlant(setup.scenario, setup.home), LandingController(setup), LandingTick(7)
    plant.connect()
    read, update, command, ticks = plant.read, controller.update, plant.command, 0
    begin = time.perf_counter()
    while not controller.final:
        read(tick)
        update(tick)
        command(tick)
        ticks += 1
    return time.perf_counter() - begin, ticks


def parts(setup: Setup) -> np.ndarray:
    """Times (ticks, 4) in s of `PARTS` in one flight."""
    plant, controller, tick = LandingPlant(setup.scenario, setup.home), LandingController(setup), LandingTick(7)
    plant.connect()
    step, now, rows, inner = mujoco.mj_step, time.perf_counter, [], [0.0]

    def timed(model: mujoco.MjModel, data: mujoco.MjData) -> None:
        begin = now()
        step(model, data)
        inner[0] = now() - begin

    mujoco.mj_step = timed
    try:
        while not controller.final:
            a = now()
            plant.read(tick)
            b = now()
            controller.update(tick)
            c = now()
            plant.command(tick)
            rows.append((b - a, c - b, now() - c, inner[0]))
    finally:
        mujoco.mj_step = step
    return np.array(rows[10:])


def main() -> None:
    """Print the table."""
    flights = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    setup = set_up(landing_scenario())
    fly(setup)
    times = [fly(setup) for _ in range(flights)]
    factor = [1e-3 * ticks / wall for wall, ticks in times]
    print(f"real-time factor of {flights} flights: median {np.median(factor):.1f}, best {max(factor):.1f}")
    print(f"20 s of landing in {20.0 / np.median(factor):.2f} s (median), {20.0 / max(factor):.2f} s (best)")
    cost = parts(setup)
    step = np.median(cost[:, 3])
    for name, column in zip(PARTS, cost.T, strict=True):
        median = np.median(column)
        print(f"{name:14s} {1e6 * median:6.1f} us a tick (median), {median / step:4.2f} of a physics step")


if __name__ == "__main__":
    main()
