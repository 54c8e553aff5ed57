"""Cost of the closed loop against a bare `mj_step` of the same scene, in one process, interleaved; and the controller's tail.

Run: .venv/bin/python benchmarks/loop.py
"""

import tempfile
import time
from pathlib import Path

import mujoco
import numpy as np
from armland.config import load_scenario
from armland.experiments.assembly import Assembly, assemble, survey
from armland.runtime.loop import run_loop

from armland.runtime.recorder import Recorder

ROUNDS = 8
STEPS = 14500


def bare(assembly: Assembly) -> float:
    model, data = assembly.plant.scene.model, assembly.plant.data
    assembly.plant.connect()
    step = mujoco.mj_step
    begin = time.perf_counter()
    for _ in range(STEPS):
        step(model, data)
    return (time.perf_counter() - begin) / STEPS


def closed(assembly: Assembly, folder: Path) -> float:
    begin = time.perf_counter()
    with Recorder(folder / "loop.mcap", assembly.tick, 1_000_000) as recorder:
        run_loop(assembly.plant, assembly.controller, recorder, assembly.tick, range(STEPS))
    return (time.perf_counter() - begin) / STEPS


def parts(assembly: Assembly) -> dict[str, np.ndarray]:
    plant, controller, tick = assembly.plant, assembly.controller, assembly.tick
    names = {"read": plant.read, "update": controller.update, "command": plant.command}
    times: dict[str, list[float]] = {name: [] for name in names}
    plant.connect()
    for _ in range(20000):
        for name, call in names.items():
            begin = time.perf_counter()
            call(tick)
            times[name].append(time.perf_counter() - begin)
    return {name: 1e6 * np.array(t) for name, t in times.items()}


def main() -> None:
    scenario = load_scenario("compare")
    workplace = survey(scenario)
    for law in ("E3", "observer"):
        assembly = assemble(scenario, law, workplace)
        rounds = []
        with tempfile.TemporaryDirectory() as folder:
            closed(assembly, Path(folder))
            for _ in range(ROUNDS):
                rounds.append((bare(assembly), closed(assembly, Path(folder))))
        step, loop = 1e6 * np.array(rounds).T
        print(f"law {law}")
        print(f"  bare mj_step   {np.median(step):6.1f} µs a step, {step.min():.1f} at best")
        print(
            f"  closed loop    {np.median(loop):6.1f} µs a tick, {loop.min():.1f} at best, recorder and file included"
        )
        print(f"  ratio          {np.median(loop / step):6.2f} (median of {ROUNDS} interleaved rounds; bound 4)")
        for name, t in parts(assembly).items():
            print(f"  {name:14s} {np.median(t):6.1f} µs median, {np.percentile(t, 99.9):6.1f} µs p99.9")


if __name__ == "__main__":
    main()
