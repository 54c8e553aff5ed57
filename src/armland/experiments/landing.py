"""A whole landing, or take-off, in simulation: flown, recorded, judged; and campaigns of many seeds."""

import contextlib
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.experiments.landing_judge import Judgement, PhaseTime, judge_landing, judge_takeoff
from armland.mission.landing_controller import LandingController
from armland.mission.landing_scenario import LandingScenario
from armland.mission.landing_setup import Setup, set_up
from armland.mission.records import LandingTick
from armland.mission.supervisor import FAULTS
from armland.plant.landing import LandingPlant
from armland.plant.landing_start import check_start
from armland.runtime.loop import run_loop
from armland.runtime.recorder import Recorder

SETTLE_S = 3.0
"""How long a mission that has ended is watched further."""

BLOCK = 250
"""Ticks that a killed process may lose."""

Progress = Callable[[str, float], None]
Mission = Literal["landing", "takeoff"]


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


class Flight(NamedTuple):
    """A mission that nothing speaks against: controller and plant are ready."""

    setup: Setup
    plant: LandingPlant


def prepare(scenario: LandingScenario, mission: Mission = "landing", seed: int | None = None) -> Flight:
    """Check everything about a mission before anything moves or is written.

    Args:
        scenario: of `landing_scenario`.
        mission: landing or take-off.
        seed: replaces the scenario's.

    Raises:
        ConfigurationError: what is refused, with the value and its bound.
    """
    if seed is not None:
        scenario = scenario._replace(landing=scenario.landing.model_copy(update={"seed": seed}))
    setup = set_up(scenario, mission)
    plant = LandingPlant(scenario, setup.home, "air" if mission == "landing" else "cradle")
    if mission == "landing":
        check_start(scenario, plant.scene, setup.home)
    return Flight(setup, plant)


def fly_landing(
    scenario: LandingScenario, seed: int | None = None, progress: Progress | None = None, log: Path | None = None
) -> LandingOutcome:
    """Fly one landing and judge it.

    Args:
        scenario: of `landing_scenario`.
        seed: replaces the scenario's.
        progress: called with phase and time, s, when a phase begins.
        log: file of the run log; none is written if absent.

    Raises:
        ConfigurationError: what is refused before anything moves.
        LogError: the log cannot be written.
    """
    return fly(prepare(scenario, "landing", seed), progress, log)


def fly_takeoff(
    scenario: LandingScenario, seed: int | None = None, progress: Progress | None = None, log: Path | None = None
) -> LandingOutcome:
    """Fly one take-off from the cradle and judge it; arguments and errors as for `fly_landing`."""
    return fly(prepare(scenario, "takeoff", seed), progress, log)


def fly(flight: Flight, progress: Progress | None = None, log: Path | None = None) -> LandingOutcome:
    """Fly what was prepared, and judge it; arguments and errors as for `fly_landing`."""
    setup, plant = flight
    records, wall = run(setup, plant, progress, log)
    rate = setup.scenario.demonstrator.run.rate_hz
    judge = judge_landing if setup.mission == "landing" else judge_takeoff
    judgement: Judgement = judge(records, setup, plant.scene.put_down, rate)
    simulated = len(records) / rate
    return LandingOutcome(
        **judgement._asdict(), real_time_factor=simulated / wall, seed=setup.scenario.landing.seed, records=records
    )


def run(
    setup: Setup, plant: LandingPlant, progress: Progress | None = None, log: Path | None = None
) -> tuple[NDArray[np.void], float]:
    """Run a mission until it has ended and settled; returns the ticks and the wall-clock time, s, the log's included."""
    controller, tick = LandingController(setup), LandingTick(setup.arm.joints)
    scenario, rate = setup.scenario, setup.scenario.demonstrator.run.rate_hz
    watch = _Watch(controller, tick, rate, progress)
    metadata = log_metadata(setup)
    with Recorder(
        log, tick, round(1e9 / rate), metadata, scenario=scenario.text, keep_in_memory=True, block=BLOCK
    ) as recorder:
        run_loop(plant, controller, recorder, tick, watch)
    wall = time.perf_counter() - watch.begin
    return recorder.ticks, wall


def log_metadata(setup: Setup) -> dict[str, str]:
    """What a log says about a mission: by the lists of names a reader finds the phase and the fault of `mission`'s numbers."""
    landing = setup.scenario.landing
    data = {
        "mission": setup.mission,
        "title": landing.title,
        "seed": str(landing.seed),
        "phases": ",".join(setup.table.names),
        "faults": ",".join(FAULTS),
    }
    return data | ({"overrides": setup.scenario.overrides} if setup.scenario.overrides else {})


class _Watch:
    """The numbers of a mission's ticks, until it has ended and settled or its time is over; tells of phases that begin."""

    def __init__(self, controller: LandingController, tick: LandingTick, rate: int, progress: Progress | None) -> None:
        self._controller, self._phase, self._rate, self._progress = controller, tick.mission["phase"], rate, progress
        self.begin = time.perf_counter()
        """When the first tick was over, which loads compiled code."""

    def __iter__(self) -> Iterator[int]:
        phase, rate, now, k = self._phase, self._rate, -1, 0
        last = total = round(self._controller.setup.scenario.landing.duration_s * rate)
        while k < last:
            yield k
            k += 1
            if k == 1:
                self.begin = time.perf_counter()
            if phase[0] != now:
                now = int(phase[0])
                if self._progress is not None:
                    self._progress(self._controller.phase, k / rate)
                if self._controller.final:
                    # An end may lead on to a graver one, which is watched as long.
                    last = min(total, k + round(SETTLE_S * rate))


def campaign(
    scenario: LandingScenario,
    seeds: range,
    mission: Mission = "landing",
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


def _one(task: tuple[LandingScenario, Mission, int]) -> LandingOutcome:
    outcome = fly(prepare(*task))
    return LandingOutcome(**{**outcome.__dict__, "records": None})
