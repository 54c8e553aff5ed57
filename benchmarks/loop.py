"""What a simulated tick costs beside the bare physics step, part by part; two threads; the controller's tick from Python.

Run: .venv/bin/python benchmarks/loop.py [ROUNDS]

Rounds are interleaved, in one process. The whole loop is the compiled one with recorder and file. Two bare steps stand beside it:
`still` begins at the same start, with the motors as they stand there, and `flown` has what acted on each tick of the flight put in
place, so that the same contacts come. The parts are read from the processor's clock in a copy of the compiled loop.
"""

import sys
import tempfile
import threading
import time
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir
from numba import int64, njit
from numba.core import cgutils
from numba.extending import intrinsic

from armland.experiments.episode import Flight, prepare
from armland.mission.controller import act, begin, decide, estimate, limit, refer, refresh_arm, screen
from armland.native import mj_step
from armland.plant.cycle import APPLIED, actuate, sense
from armland.plant.noise import BLOCK
from armland.runtime import loops
from armland.runtime.recorder import Recorder
from armland.scenario import load_scenario

PARTS = ("sense", "screen", "model", "estimate", "decide", "refer", "act", "limit", "actuate", "copy", "step", "record")


class Case(NamedTuple):
    scenario: str
    mission: str
    experiment: str | None
    bound: float  # of the ratio


CASES = {
    "E3": Case("paper", "E3", None, 2.3),
    "law with observers": Case("compare", "track", "observer", 2.6),
    "landing": Case("landing", "landing", None, 1.7),
}


@intrinsic
def now(typing):
    def build(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        kind = ir.FunctionType(ir.IntType(64), [])
        return builder.call(cgutils.get_or_insert_function(builder.module, kind, "llvm.readcyclecounter"), [])

    return int64(), build


@njit(nogil=True)
def still(model, data, steps):
    for _ in range(steps):
        mj_step(model, data)


@njit(nogil=True)
def flown(model, data, acted, ctrl, wrenches):
    for k in range(acted[0].shape[0]):
        ctrl[:], wrenches[:] = acted[0][k], acted[1][k]
        mj_step(model, data)


@njit(nogil=True)
def parts(k, world, views, noise, physics, brain, watch, rows, spent):
    """`plant.block.fly_block` with the time of each part added to `spent`."""
    board, path, arm = brain
    b, w = board[0], world[0]
    t, s, c = b.tick, b.kept.decide, np.empty(12, np.int64)
    for i in range(rows.shape[0]):
        c[0] = now()
        sense(k + i, w, views, noise, t.measurement, t.truth)
        c[1] = now()
        screen(b)
        c[2] = now()
        refresh_arm(b, path, arm)
        if b.kept.limit.started == 0:
            begin(b)
        c[3] = now()
        estimate(b)
        c[4] = now()
        decide(b)
        c[5] = now()
        refer(b, path)
        c[6] = now()
        act(b, path)
        c[7] = now()
        limit(b)
        c[8] = now()
        status = actuate(k + i, w, views, noise, t.mission.phase, t.command, t.truth)
        c[9] = now()
        rows[i] = t
        c[10] = now()
        mj_step(physics[0], physics[1])
        c[11] = now()
        for j in range(11):
            spent[j] += c[j + 1] - c[j]
        if status != APPLIED or (b.table.phases[s.phase].final == 1 and k + i - s.begin >= watch):
            return i + 1
    return rows.shape[0]


def made(c: Case, seed: int | None = None) -> Flight:
    return prepare(load_scenario(c.scenario), c.mission, seed, experiment=c.experiment)


def whole(flight: Flight, file: Path) -> float:
    """Seconds a tick, with recorder and file: a new one, since some file systems flush what replaces an older one first."""
    file.unlink(missing_ok=True)
    begun = time.perf_counter()
    with Recorder(file, flight.plan.joints, flight.period_ns, flight.metadata, keep_in_memory=True) as recorder:
        loops.fly(flight.simulator, flight.controller, flight.plan, recorder)
    return (time.perf_counter() - begun) / flight.simulator.tick


def noted(flight: Flight) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """What acted on the physics in each tick, motors and wrenches, and the seconds of the controller's tick, in a loop in Python."""
    simulator, controller, plan, late = flight.simulator, flight.controller, flight.plan, []
    tick, ctrl, wrenches = controller.tick, [], []
    simulator.connect()
    while len(ctrl) < plan.ticks and controller.ended_for() < plan.watch:
        simulator.read(tick)
        begun = time.perf_counter()
        controller.update(tick)
        late.append(time.perf_counter() - begun)
        simulator.command(tick)
        ctrl.append(simulator.data.ctrl.copy())
        wrenches.append(simulator.data.xfrc_applied.copy())
    return np.array(ctrl), np.array(wrenches), np.array(late[1000:])


def shares(flight: Flight) -> np.ndarray:
    """Seconds a tick of each part but the last."""
    simulator, controller, plan = flight.simulator, flight.controller, flight.plan
    spent, rows, seconds = np.zeros(11, np.int64), np.zeros(250, controller.tick.buffer.dtype), 0.0
    simulator.connect()
    while simulator.tick < plan.ticks and controller.ended_for() < plan.watch:
        if simulator.tick % BLOCK == 0:
            simulator.draw_noise()
        arguments, begun = simulator.block_arguments(controller, rows), time.perf_counter()
        simulator.tick += parts(*arguments, spent)
        seconds += time.perf_counter() - begun
    return spent / spent.sum() * seconds / simulator.tick


def threads(file: Path) -> float:
    """Time of two landings in turn over that of two at once."""
    one, two = ([made(CASES["landing"], seed) for seed in (1, 2)] for _ in range(2))
    begun = time.perf_counter()
    _ = [whole(flight, file) for flight in one]
    middle = time.perf_counter()
    both = [threading.Thread(target=whole, args=(f, file.with_suffix(f".{k}"))) for k, f in enumerate(two)]
    for thread in both:
        thread.start()
    for thread in both:
        thread.join()
    return (middle - begun) / (time.perf_counter() - middle)


def measure(name: str, case: Case, rounds: int, file: Path) -> None:
    flight = made(case)
    ctrl, wrenches, late = noted(flight)
    simulator, data, acted, found = flight.simulator, flight.simulator.data, (ctrl, wrenches), []
    shares(made(case))
    for _ in range(rounds + 1):
        times = []
        for steps, what in ((still, (len(ctrl),)), (flown, (acted, data.ctrl, data.xfrc_applied))):
            simulator.connect()
            begun = time.perf_counter()
            steps(simulator.scene.model._address, data._address, *what)
            times.append((time.perf_counter() - begun) / len(ctrl))
        apart = shares(made(case))
        loop = whole(made(case), file)
        found.append([*times, loop, loop / times[0], loop / times[1], *apart, loop - apart.sum()])
    s, f, loop, by_still, by_flown, *apart = np.median(found[1:], axis=0)
    print(f"{name}: {1e6 * loop:.1f} us a tick; bare step still {1e6 * s:.1f}, flown {1e6 * f:.1f} us;")
    print(f"  ratio {by_still:.2f} to still, {by_flown:.2f} to flown (bound {case.bound})")
    print("  " + ", ".join(f"{part} {1e6 * x:.2f}" for part, x in zip(PARTS, apart, strict=True)))
    p50, tail = np.percentile(1e6 * late, (50.0, 99.9))
    print(f"  controller from Python: p50 {p50:.1f} us (bound 12), p99.9 {tail:.0f} us (bound 100)")


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "loop.mcap"
        for name, case in CASES.items():
            measure(name, case, rounds, file)
        print(f"two threads against one: {np.median([threads(file) for _ in range(rounds)]):.2f} (bound 1.85)")


if __name__ == "__main__":
    main()
