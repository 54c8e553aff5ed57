"""A whole landing, or take-off, in simulation: flown, recorded, judged; and campaigns of many seeds."""

import contextlib
import time
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from armland.experiments.landing_judge import Judgement, PhaseTime, judge_landing, judge_takeoff
from armland.mission.landing_controller import LandingController
from armland.mission.landing_scenario import LandingScenario
from armland.mission.landing_setup import Setup, set_up
from armland.mission.records import LandingTick
from armland.plant.landing import LandingPlant

SETTLE_S = 3.0
"""How long a mission that has ended is watched further."""

Progress = Callable[[str, float], None]


@dataclass(frozen=True)
class LandingOutcome:
    """What came of a landing or a take-off."""

    success: bool
    reason: str
    phases: list[PhaseTime]
    retries: int
    capture: dict[str, float | None]
    touchdown: dict[str, float | None]
    hinge_force_max_n: float
    joint_torque_max_ratio: float
    limits_violated: list[str]
    real_time_factor: float
    fault: str = "none"
    end: str = ""
    state: str = ""
    seed: int = 0
    release: dict[str, float | None] = field(default_factory=dict)
    records: NDArray[np.void] | None = field(default=None, repr=False, compare=False)

    def result(self) -> dict[str, Any]:
        """The outcome as plain data, for JSON."""
        data = {k: v for k, v in self.__dict__.items() if k != "records"}
        data["phases"] = [asdict(p) for p in self.phases]
        return data


def fly_landing(scenario: LandingScenario, seed: int | None = None, progress: Progress | None = None) -> LandingOutcome:
    """Fly one landing and judge it.

    Args:
        scenario: of `landing_scenario`.
        seed: replaces the scenario's.
        progress: called with phase and time, s, when a phase begins.

    Raises:
        ConfigurationError: what is refused before anything moves.
    """
    return _fly(scenario, "landing", seed, progress)


def fly_takeoff(scenario: LandingScenario, seed: int | None = None, progress: Progress | None = None) -> LandingOutcome:
    """Fly one take-off from the cradle and judge it; arguments and errors as for `fly_landing`."""
    return _fly(scenario, "takeoff", seed, progress)


def _fly(
    scenario: LandingScenario, mission: Literal["landing", "takeoff"], seed: int | None, progress: Progress | None
) -> LandingOutcome:
    if seed is not None:
        scenario = scenario._replace(landing=scenario.landing.model_copy(update={"seed": seed}))
    setup = set_up(scenario, mission)
    plant = LandingPlant(scenario, setup.home, "air" if mission == "landing" else "cradle")
    records, wall = run(setup, plant, progress)
    rate = scenario.demonstrator.run.rate_hz
    judge = judge_landing if mission == "landing" else judge_takeoff
    judgement: Judgement = judge(records, setup, plant.scene.put_down, rate)
    simulated = len(records) / rate
    return LandingOutcome(
        **judgement._asdict(), real_time_factor=simulated / wall, seed=scenario.landing.seed, records=records
    )


def run(setup: Setup, plant: LandingPlant, progress: Progress | None = None) -> tuple[NDArray[np.void], float]:
    """Run a mission until it has ended and settled; returns the ticks and the wall-clock time, s."""
    controller, tick = LandingController(setup), LandingTick(setup.arm.joints)
    rate = setup.scenario.demonstrator.run.rate_hz
    last = round(setup.scenario.landing.duration_s * rate)
    rows = np.empty(last, tick.buffer.dtype)
    opaque, source = rows.view(np.dtype((np.void, rows.itemsize))), tick.buffer.view(np.uint8).data
    plant.connect()
    read, update, command = plant.read, controller.update, plant.command
    phase = tick.mission["phase"]
    now, k, begin = -1, 0, time.perf_counter()
    try:
        while k < last:
            read(tick)
            update(tick)
            command(tick)
            opaque[k] = source
            k += 1
            if k == 1:
                # The first tick loads compiled code.
                begin = time.perf_counter()
            if phase[0] != now:
                now = int(phase[0])
                if progress is not None:
                    progress(controller.phase, k / rate)
                if controller.final:
                    # An end may lead on to a graver one, which is watched as long.
                    last = min(len(rows), k + round(SETTLE_S * rate))
    finally:
        plant.stop()
    return rows[:k], time.perf_counter() - begin


def campaign(
    scenario: LandingScenario,
    seeds: range,
    mission: Literal["landing", "takeoff"] = "landing",
    jobs: int | None = None,
    done: Callable[[LandingOutcome], None] | None = None,
) -> list[LandingOutcome]:
    """Fly many seeds over processes; the outcomes in the order of the seeds, without their records.

    Args:
        scenario: of `landing_scenario`.
        seeds: which.
        mission: landing or take-off.
        jobs: processes; all cores if absent, 1 runs here.
        done: called with each outcome.
    """
    tasks, out = [(scenario, mission, seed) for seed in seeds], []
    with contextlib.ExitStack() as stack:
        pool = None if jobs == 1 else stack.enter_context(ProcessPoolExecutor(jobs))
        results: Iterable[LandingOutcome] = map(_one, tasks) if pool is None else pool.map(_one, tasks, chunksize=4)
        for outcome in results:
            out.append(outcome)
            if done is not None:
                done(outcome)
    return out


def _one(task: tuple[LandingScenario, Literal["landing", "takeoff"], int]) -> LandingOutcome:
    scenario, mission, seed = task
    outcome = _fly(scenario, mission, seed, None)
    return LandingOutcome(**{**outcome.__dict__, "records": None})
