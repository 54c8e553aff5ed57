"""A mission flown once, kept at the beginning of each phase, and flown on from there with faults: the beginning is not paid twice.

What is kept is everything that changes while a mission runs: all arrays and counters of plant, controller and messages, MuJoCo's
state with its warm start, and the random streams. A mission that is continued gives byte for byte the records of one that was
flown through (a test says so).
"""

from dataclasses import dataclass
from typing import Any, Literal

import mujoco
import numpy as np
from numpy.typing import NDArray

from armland.experiments.landing import SETTLE_S
from armland.experiments.landing_judge import Judgement, judge_landing, judge_takeoff
from armland.mission.failures import Fault
from armland.mission.landing_controller import LandingController
from armland.mission.landing_scenario import LandingScenario
from armland.mission.landing_setup import Setup, set_up
from armland.mission.records import LandingTick
from armland.mission.supervisor import FAULTS
from armland.models.arm import ArmModel
from armland.plant.landing import LandingPlant
from armland.plant.landing_faults import FaultSchedule
from armland.plant.noise import WhiteNoise

Mission = Literal["landing", "takeoff"]
Saved = dict[str, Any]
"""Values by the names of what holds them."""


@dataclass(frozen=True)
class Start:
    """Where a mission can be continued: at the first tick of a phase, before its command acts."""

    phase: str
    tick: int
    plant: Saved
    controller: Saved
    buffer: NDArray[np.void]


def saved(thing: object) -> Saved:
    """Copies of all that changes in `thing` while a mission runs: arrays, numbers, random streams, MuJoCo's state."""
    out: Saved = {}
    for name, value in vars(thing).items():
        if isinstance(value, np.ndarray):
            out[name] = value.copy()
        elif isinstance(value, tuple):
            out[name] = [v.copy() if isinstance(v, np.ndarray) else None for v in value]
        elif isinstance(value, bool | int | float):
            out[name] = value
        elif isinstance(value, mujoco.MjData):
            model = vars(thing).get("model") or vars(thing)["scene"].model
            out[name] = mujoco.MjData(model)
            mujoco.mj_copyData(out[name], model, value)
        elif isinstance(value, np.random.Generator):
            out[name] = value.bit_generator.state
        elif isinstance(value, WhiteNoise | ArmModel):
            out[name] = saved(value)
    return out


def restore(thing: object, state: Saved) -> None:
    """Put back what `saved` has kept: into the same arrays, so that views of them stay what they are."""
    for name, kept in state.items():
        value = getattr(thing, name)
        if isinstance(value, np.ndarray):
            value[...] = kept
        elif isinstance(value, tuple):
            for part, old in zip(value, kept, strict=True):
                if old is not None:
                    part[...] = old
        elif isinstance(value, mujoco.MjData):
            model = vars(thing).get("model") or vars(thing)["scene"].model
            mujoco.mj_copyData(value, model, kept)
        elif isinstance(value, np.random.Generator):
            value.bit_generator.state = kept
        elif isinstance(value, WhiteNoise | ArmModel):
            restore(value, kept)
        else:
            setattr(thing, name, kept)


class Branches:
    """A mission without faults, and its continuations with them.

    Args:
        scenario: of `landing_scenario`; its own faults are left out.
        mission: landing or take-off.

    Raises:
        ConfigurationError: what is refused before anything moves.
    """

    def __init__(self, scenario: LandingScenario, mission: Mission = "landing") -> None:
        self.scenario = scenario._replace(landing=scenario.landing.model_copy(update={"faults": ()}))
        self.setup: Setup = set_up(self.scenario, mission)
        self.rate: int = scenario.demonstrator.run.rate_hz
        self._begin: Literal["air", "cradle"] = "air" if mission == "landing" else "cradle"
        self._judge = judge_landing if mission == "landing" else judge_takeoff
        self._plant = LandingPlant(self.scenario, self.setup.home, self._begin)
        self._controller = LandingController(self.setup)
        self._tick = LandingTick(self.setup.arm.joints)
        self._rows = np.empty(round(scenario.landing.duration_s * self.rate), self._tick.buffer.dtype)
        self.starts: dict[str, Start] = {}
        self._plant.connect()
        self._plant.read(self._tick)
        self._controller.update(self._tick)
        self._keep(0)
        self.records: NDArray[np.void] = self._run(0, keep=True).copy()

    def fly(self, faults: tuple[Fault, ...], blind_to: tuple[str, ...] = ()) -> tuple[NDArray[np.void], Judgement]:
        """Records and judgement of the mission with `faults`, which begin in the phase of the first one.

        Args:
            faults: what fails; phases of which the mission is not at its begin yet are all right.
            blind_to: faults that the supervisor shall not see; for negative controls.
        """
        start = self.starts[faults[0].phase or self.setup.table.names[0]]
        restore(self._plant, start.plant)
        restore(self._controller, start.controller)
        self._tick.buffer[...] = start.buffer
        self._plant._brake(bool(self._plant._braked))
        self._plant.faults = FaultSchedule(faults, self.setup.table.names, self.rate, self.setup.arm.joints)
        self._rows[: start.tick] = self.records[: start.tick]
        rows = next(t for t in self._controller._tables if isinstance(t, np.ndarray) and t.shape[0] == len(FAULTS))
        seen = rows.copy()
        for name in blind_to:
            rows[FAULTS.index(name)] = -1
        try:
            records = self._run(start.tick).copy()
        finally:
            rows[:] = seen
        judgement = self._judge(records, self.setup, self._plant.scene.put_down, self.rate)
        return records, judgement

    def _keep(self, k: int) -> None:
        name = self._controller.phase
        if name not in self.starts:
            self.starts[name] = Start(name, k, saved(self._plant), saved(self._controller), self._tick.buffer.copy())

    def _run(self, k: int, keep: bool = False) -> NDArray[np.void]:
        # Tick k is read and decided already; what is missing is its action.
        plant, controller, tick, rows = self._plant, self._controller, self._tick, self._rows
        settle, last, phase = round(SETTLE_S * self.rate), len(rows), -1
        while True:
            now = int(tick.mission["phase"][0])
            if now != phase:
                phase = now
                if keep:
                    self._keep(k)
                if controller.final:
                    last = min(len(rows), k + 1 + settle)
            plant.command(tick)
            rows[k] = tick.buffer[0]
            k += 1
            if k >= last:
                return rows[:k]
            plant.read(tick)
            controller.update(tick)
