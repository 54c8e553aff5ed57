"""One flight as a pure function: scenario and seed in, ticks, log and judgement out."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from armland.errors import MountingError, WorkspaceError
from armland.experiments.judge.brief import Brief, brief_of, metadata_of
from armland.experiments.judge.judgement import Judgement, check_kind, judge
from armland.experiments.placing import mounted_further, placed
from armland.mission.controller import Controller
from armland.mission.plan import Plan, plan
from armland.mission.registry import UNAIDED, mission_named
from armland.mission.tuning import fitted
from armland.mission.unaided.controller import UnaidedController
from armland.mission.unaided.plan import unaided_plan
from armland.models.airframe.sizing import sized
from armland.plant.simulator import Simulator
from armland.plant.start import check_start
from armland.plant.unaided.simulator import PadSimulator
from armland.plant.wind.limits import check_wind
from armland.runtime import loops
from armland.runtime.log import Log
from armland.runtime.log.columns import columns
from armland.runtime.recorder import Recorder
from armland.scenario import Scenario
from armland.scenario.sensing import Imperfections

Progress = Callable[[str, float], None]  # Called with phase and time, s, when a phase begins


class Flight(NamedTuple):
    """A mission that nothing speaks against: everything is checked, nothing has moved. It can be flown once."""

    scenario: Scenario
    plan: Plan
    simulator: Simulator
    controller: Controller
    metadata: dict[str, str]  # For the log: what the judge, a report or a figure needs to know beside the ticks
    moved: str = ""  # Where catch and cradle were put, and why, if they are not where the scenario wanted them

    @property
    def period_ns(self) -> int:
        """Length of a tick."""
        return round(1e9 / self.scenario.run.rate_hz)

    @property
    def brief(self) -> Brief:
        """What the judge is told."""
        return brief_of({**self.metadata, "period_ns": str(self.period_ns)})


@dataclass(frozen=True)
class Episode:
    """One flight, flown and judged."""

    result: dict[str, Any]
    """Plain data: the judgement, and mission, experiment, law, seed, `law_failure`, `never_acted`, `log_cut_short`,
    `real_time_factor`."""
    ticks: NDArray[np.void] = field(repr=False)  # (k,) of `records.tick_layout`
    log: Path | None  # The run log, where one was asked for
    judgement: Judgement
    metadata: dict[str, str] = field(repr=False)  # As it stands in the log

    def table(self) -> dict[str, NDArray]:
        """The ticks as flat columns (k,) by name, such as `truth.r.2`, with `time` in s: `pandas.DataFrame(episode.table())`."""
        return columns(self.ticks, int(self.metadata["period_ns"]))


def prepare(
    scenario: Scenario,
    mission: str,
    seed: int | None = None,
    law: str | None = None,
    experiment: str | None = None,
    trial: bool = False,
    known: Plan | None = None,
) -> Flight:
    """Check everything about a flight, with arguments as for `fly`, before anything moves or is written.

    Args:
        known: the plan of a flight that differs in nothing but the seed, where there is one.

    Raises:
        ConfigurationError: what is refused, with the value and its bound.
    """
    if seed is not None:
        scenario = scenario.with_seed(seed)

    if mission in UNAIDED:
        return unaided(scenario if scenario.sized else sized(scenario), mission, known)

    def make(one: Scenario) -> Flight:
        if known is not None:
            return _simulated(one, known.again(one.run.seed))
        return _simulated(one, plan(one, mission, law=law, experiment=experiment, trial=trial))

    scenario = sized(scenario)
    try:
        return make(scenario)
    except MountingError as refusal:
        if scenario.arm.ee is not None or refusal.works is None:
            raise
        # Nobody chose the end effector: one that works is as good.
        other = scenario.replaced({"arm": {"ee": refusal.works}})
        flight = prepare(other, mission, law=law, experiment=experiment, trial=trial)
        chosen = f"arm.ee = {refusal.works!r} chosen, because {refusal}"
        return flight._replace(moved=f"{chosen}. {flight.moved}" if flight.moved else chosen)
    except WorkspaceError as refusal:
        value = mission_named(mission)
        if value.start == "hinged":
            raise
        try:
            flight, moved = placed(scenario, value, refusal, make)
        except WorkspaceError as nowhere:
            again = partial(prepare, mission=mission, law=law, experiment=experiment, trial=trial)
            flight, moved = mounted_further(scenario, nowhere, again)
            moved = f"{moved}. {flight.moved}" if flight.moved else moved
        return flight._replace(moved=moved)


def _simulated(scenario: Scenario, made: Plan) -> Flight:
    check_kind(made.mission)
    if made.experiment is not None:
        # An experiment sets the UAV's own controller as well.
        scenario = fitted(scenario, made.scenario, made.experiment)
    simulator = Simulator(scenario, made.home, made.mission.start, made.names)
    # Where it foretells wind, a mission lets the UAV lean further than in calm air.
    check_wind(scenario, simulator.scene.uav_mass, simulator.timed_wind, made.scenario.control.station.tilt_max_rad)
    if made.mission.start == "air":
        check_start(scenario, simulator.scene, made.home)
    return Flight(scenario, made, simulator, Controller(made), metadata_of(scenario, made, simulator.scene))


def unaided(scenario: Scenario, mission: str, known: Any = None) -> Flight:
    """The flight of a mission without an arm; `known` as for `prepare`.

    Raises:
        ConfigurationError: what is refused, with the value and its bound.
    """
    made: Any = unaided_plan(scenario, mission) if known is None else known.again(scenario.run.seed)
    check_kind(made.mission)
    simulator = PadSimulator(scenario, made)
    check_wind(scenario, simulator.scene.uav_mass, simulator.timed_wind)
    controller: Any = UnaidedController(made)
    return Flight(scenario, made, simulator, controller, metadata_of(scenario, made, simulator.scene))


def fly(
    scenario: Scenario,
    mission: str = "landing",
    seed: int | None = None,
    *,
    law: str | None = None,
    experiment: str | None = None,
    trial: bool = False,
    log: Path | None = None,
    progress: Progress | None = None,
) -> Episode:
    """Fly one mission and judge it. The same scenario and seed give the same ticks, byte for byte.

    Args:
        scenario: what is flown.
        mission: name in `mission.registry.MISSIONS`.
        seed: replaces the scenario's.
        law: row of the law table, or FILE.py:FUNCTION, instead of the mission's own.
        experiment: row of the scenario's experiments, for missions that fly one.
        trial: whether a UAV may fly that is too heavy to hover.
        log: file of the run log; none is written if absent.
        progress: called with phase and time, s, when a phase begins.

    Raises:
        ConfigurationError: what is refused before anything moves.
        LogError: the log cannot be created.
    """
    return fly_prepared(prepare(scenario, mission, seed, law, experiment, trial), log, progress)


class Steered(loops.Simulated, Protocol):
    """A port that acts on its own between ticks, and says what it did as a text for the log."""

    attach: Callable[[str, str], None] | None
    """Takes name and text of the log's attachment."""


def fly_prepared(
    flight: Flight, log: Path | None = None, progress: Progress | None = None, port: Steered | None = None
) -> Episode:
    """Fly what was prepared and judge it; arguments and errors as for `fly`.

    Args:
        port: around the flight's simulator, in its place.
    """
    scenario, made, simulator, controller, metadata, _ = flight
    period = flight.period_ns
    with Recorder(log, made.joints, period, metadata, scenario=scenario.text, keep_in_memory=True) as recorder:
        if port is not None:
            port.attach = recorder.attach
        wall = loops.fly(port or simulator, controller, made, recorder, progress)
    ticks = recorder.ticks
    judgement, simulated = judge(ticks, flight.brief), 1e-9 * period * len(ticks)
    result = {
        **_result(judgement, metadata),
        "law_failure": law_failure(made, controller),
        "never_acted": never_acted(scenario, simulator.acted),
        "log_cut_short": str(recorder.failure or ""),
        "simulated_s": simulated,
        "wall_s": wall,
        "real_time_factor": simulated / wall,
    }
    return Episode(result, ticks, log, judgement, {**metadata, "period_ns": str(period)})


def attempt(scenario: Scenario, mission: str, seed: int, **more: Any) -> dict[str, Any]:
    """The result of one flight, arguments as for `prepare`; where it raises, a row that says what broke."""
    try:
        return fly_prepared(prepare(scenario, mission, seed, **more)).result
    except Exception as error:
        reason = f"broke: {type(error).__name__}: {error}"
        return {"mission": mission, "seed": seed, "success": False, "reason": reason, "state": "unknown"}


def result_of_log(log: Log) -> dict[str, Any]:
    """The result of a flight from its log; what the log does not know is left out.

    Raises:
        LogError: it lacks what judging needs.
    """
    return _result(judge(log.messages, brief_of(log.metadata)), log.metadata)


def law_failure(made: Plan, controller: Controller) -> str:
    """What a user's own law did wrong, with its tick and value; empty where it did nothing wrong."""
    kept = controller.board["kept"]["act"]["law"][0]
    if made.law is None or not kept["failed"]:
        return ""
    return made.law.explain(int(kept["failed"]), int(kept["tick"]), kept["given"], kept["returned"])


def never_acted(scenario: Scenario, acted: Any) -> list[str]:
    """The scenario's faults that never acted, as a reader knows them: kind, phase, time after its begin."""
    return [
        f"{fault.kind} ({fault.after_s:g} s after {fault.phase or 'the start'})"
        for fault, did in zip(scenario.faults, acted, strict=True)
        if not did
    ]


def _result(judgement: Judgement, metadata: dict[str, str]) -> dict[str, Any]:
    told = {name: metadata[name] for name in ("mission", "experiment", "law")}
    return {**told, "seed": int(metadata["seed"]), **judgement.result()}


def quiet(scenario: Scenario, camera: bool = False) -> Scenario:
    """The scenario without imperfections, faults and differences between seeds.

    Args:
        scenario: any.
        camera: whether noise, delay and drop-outs of the camera stay.
    """
    none = {name: 0.0 for name, f in Imperfections.model_fields.items() if f.annotation is not bool}
    start = {"start_offset_m": (0.0, 0.0, 0.0), "start_speed_mps": 0.0, "start_heading_deg": 0.0}
    imperfections = {**none, "camera": camera, "noise": False}
    return scenario.replaced({"imperfections": imperfections, "place": start, "faults": ()})
