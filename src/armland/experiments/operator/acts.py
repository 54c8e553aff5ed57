"""What each message does: to the plant and to the mission's table, at the begin of a tick; never to anything that is compiled.

| verb | changes |
|---|---|
| `hold`, `resume`, `abort` | the phase, see `mission.supervisor.operator` |
| `wind` | speed of the mean wind, with the turbulence that goes with it, of the devices of the air |
| `sea` | the share of the deck's motion, smoothly; needs a scene with a deck |
| `delay` | ticks more on both ways of the link |
| `noise` | standard deviations of encoders, force sensor, inertial sensor and camera |
| `mass` | mass and inertia of the UAV's body; neither believes it |
| `fault` | one more row of the plant's table of faults |
"""

from typing import Any

import mujoco
import numpy as np

from armland.errors import ConfigurationError
from armland.experiments.episode import Flight
from armland.experiments.operator.message import Message
from armland.mission.supervisor.operator import (
    ABORTS,
    HELD_BY_HAND,
    NUMBER,
    step_into,
    wait,
    why_not_held,
)
from armland.mission.table.phases import ARM, UAV
from armland.plant.devices.air import tell_wind
from armland.plant.devices.link import RING
from armland.plant.faults import table as faults
from armland.plant.noise import BLOCK
from armland.plant.sea.swell import swelled, turned
from armland.scenario.faults import Fault

NOISE = {
    "encoders": ("sigma_q", "sigma_qd"),
    "wrench": ("sigma",),
    "imu": ("sigma_attitude", "sigma_rate", "sigma_force"),
    "camera": ("honesty",),
}
"""Devices, and the fields of what they are told that `noise` scales."""


class Acts:
    """What an operator can do to one flight.

    Args:
        flight: of `hand.steerable`; nothing of it has been flown yet.
    """

    def __init__(self, flight: Flight) -> None:
        self._flight, self._simulator = flight, flight.simulator
        self.faults: list[Fault] = list(flight.scenario.faults)
        """What fails: the scenario's faults, then those that were thrown in."""
        self._told: Any = flight.simulator.world["told"].copy()
        model, uav = flight.simulator.scene.model, flight.simulator.scene.uav_body
        self._mass_kg, self._inertia = float(model.body_mass[uav]), model.body_inertia[uav].copy()
        self._deck, self._share = flight.simulator.timed_deck, np.ones(len(flight.simulator.timed_deck))
        self._before = -1
        # Compiled now: at the first message it would hold the flight up.
        step_into(flight.controller.board.copy(), 0, 0, 0)

    def do(self, message: Message) -> None:
        """Do what a message says, now.

        Raises:
            ConfigurationError: it cannot be done here; nothing is changed.
        """
        acts = {
            "hold": self._hold,
            "resume": self._resume,
            "abort": self._abort,
            "wind": self._wind,
            "sea": self._sea,
            "delay": self._delay,
            "noise": self._noise,
            "mass": self._mass,
            "fault": self._fault,
        }
        acts[message.do](message)

    def _hold(self, message: Message) -> None:
        self._check_flying()
        phases, now = self._flight.plan.phases, self._phase()
        if no := why_not_held(phases[now]):
            raise ConfigurationError(f"hold: {no}")
        self._before = now
        wait(self._flight.controller.board, phases, now, self._simulator.tick, UAV.index("level"), ARM.index("hold"))

    def _resume(self, message: Message) -> None:
        phase = self._flight.plan.phases[self._phase()].name
        if phase not in HELD_BY_HAND:
            raise ConfigurationError(f"resume: the mission is not held, it is in {phase}")
        step_into(self._flight.controller.board, self._before, self._simulator.tick, 0)

    def _abort(self, message: Message) -> None:
        self._check_flying()
        phase = self._flight.plan.phases[self._phase()]
        if phase.final:
            raise ConfigurationError(f"abort: the mission has ended in {phase.name}")
        step_into(self._flight.controller.board, self._end_of_abort(), self._simulator.tick, NUMBER)

    def _end_of_abort(self) -> int:
        plan, now = self._flight.plan, self._phase()
        held = plan.phases[now].name in HELD_BY_HAND
        end = ABORTS[plan.phases[self._before if held else now].kind]
        if end not in plan.names:
            raise ConfigurationError(f"abort: the mission has no end {end!r}; its ends are {', '.join(self._ends())}")
        return plan.number(end)

    def _ends(self) -> list[str]:
        return [p.name for p in self._flight.plan.phases if p.final]

    def _wind(self, message: Message) -> None:
        scenario = self._flight.scenario
        if scenario.air.trace is not None:
            raise ConfigurationError("wind: the scenario's is a recorded one; fly one without air.trace")
        told, v = self._simulator.world["told"]["air"], message.value
        if v > 0.0:
            by = scenario.air.turbulence if scenario.air.turbulence != "none" else "by_wind"
            air = scenario.air.model_copy(update={"wind_mps": v, "turbulence": by})
            tell_wind(told, scenario.model_copy(update={"air": air}))
        else:
            told["speed"], told["strength"] = 0.0, 0.0

    def _sea(self, message: Message) -> None:
        s, rate = self._simulator, self._flight.scenario.run.rate_hz
        if not len(self._deck):
            raise ConfigurationError(
                "sea: this flight is on land, where nothing moves; choose a sea state, it acts from the next flight on"
            )
        self._share = turned(self._share, s.tick, message.value, rate)
        s.timed_deck = swelled(self._deck, self._share, rate)
        # The block in use was drawn with the sea as it was.
        first = s.tick - s.tick % BLOCK
        ticks = np.minimum(np.arange(first, first + BLOCK), len(self._deck) - 1)
        s.noise.deck[s.tick % BLOCK :] = s.timed_deck[ticks][s.tick % BLOCK :]

    def _delay(self, message: Message) -> None:
        more = round(1e-3 * message.value * self._flight.scenario.run.rate_hz)
        link, before = self._simulator.world["told"]["link"], self._told["link"]
        for way in ("up", "down"):
            link[way] = np.minimum(before[way] + more, RING - 1)

    def _noise(self, message: Message) -> None:
        for device, fields in NOISE.items():
            for field in fields:
                self._simulator.world["told"][device][field] = message.value * self._told[device][field]

    def _mass(self, message: Message) -> None:
        model, uav = self._simulator.scene.model, self._simulator.scene.uav_body
        model.body_mass[uav], model.body_inertia[uav] = message.value * self._mass_kg, message.value * self._inertia
        mujoco.mj_setConst(model, mujoco.MjData(model))

    def _fault(self, message: Message) -> None:
        assert message.fault is not None
        s, kept = self._simulator, self._simulator.world["kept"]["faults"]
        if len(self.faults) >= faults.MOST:
            raise ConfigurationError(f"fault: {len(self.faults)} have been thrown in; there is room for {faults.MOST}")
        made = (*self.faults, message.fault)
        scenario = self._flight.scenario.model_copy(update={"faults": made})
        faults.tell(s.world["told"]["faults"], scenario, s.scene, self._flight.plan.names)
        kept["armed"][0, len(made) - 1] = s.tick if message.fault.phase is None else -1
        self.faults.append(message.fault)

    def _phase(self) -> int:
        return int(self._flight.controller.board["kept"]["decide"]["phase"][0])

    def _check_flying(self) -> None:
        if self._simulator.tick == 0:
            raise ConfigurationError("the flight has not begun")
