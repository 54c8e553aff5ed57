"""A recorded flight as a page shows it: as much of a log as can be shown, and what cannot be and why."""

import json
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from armland.console.gauges import name_of
from armland.console.plots import Curves, curves_of, thin
from armland.console.stage.poses import armless_scene_of, scene_of
from armland.errors import LogError
from armland.experiments.judge.deck import seen_from_deck
from armland.experiments.operator.message import Message
from armland.experiments.operator.script import script_of
from armland.plant.scene.composition import Scene
from armland.plant.wind.profile import height_of_catch, speed_at, towards
from armland.records import Records
from armland.rotations import Array
from armland.runtime.log import Log
from armland.runtime.recorder import SCENARIO_NAME
from armland.scenario import Scenario
from armland.view.page.again import again


class Event(NamedTuple):
    """Something that happened."""

    time: float  # s
    kind: str  # `phase`, `supervisor`, `operator`
    words: str


class Recording:
    """One log.

    Args:
        log: as it was read.
        file: where it was read.

    Raises:
        LogError: it holds nothing that could be shown.
    """

    def __init__(self, log: Log, file: Path) -> None:
        self.file, self.log, self.ticks = file, log, log.ticks
        if len(self.ticks) < 2:
            raise LogError(f"{file}: it holds {len(self.ticks)} ticks; a page over time needs two")
        self.notes: list[str] = []
        """What is not as it should be, one sentence each."""
        if not log.complete:
            self.notes.append(f"{file.name} was cut off: what stands in it until then is shown.")
        self.period_s = int(log.metadata["period_ns"]) * 1e-9
        self.rate_hz = max(1, round(1.0 / self.period_s))
        self.phases, self.faults = self._names("phases"), self._names("faults")
        self.scenario = self._scenario()
        self.armless = False
        """Whether the scene's arm is none that flew."""
        self.scene = self._scene()
        # Charts show motion against the deck, as the judge sees it.
        seen = seen_from_deck(thin(self.ticks, self.rate_hz))
        self.curves: Curves = curves_of(seen, self.period_s)  # type: ignore[arg-type]
        self.told = self._told()
        """What an operator did."""
        self.events = self._events()

    @property
    def name(self) -> str:
        """How the flight is told from another."""
        m = self.log.metadata
        return f"{m.get('experiment') or m.get('mission', 'run')} seed {m.get('seed', '?')} ({self.file.stem})"

    @property
    def command(self) -> str:
        """The command that flies the same again; empty where the log says too little."""
        more = ("--operator", str(self.file)) if self.told else ()
        try:
            return again(self.log.metadata, self.log.attachments.get(SCENARIO_NAME), more).command
        except (LookupError, TypeError, ValueError):
            return ""

    @property
    def joints(self) -> int:
        """Of the arm that flew; 0 where none did."""
        return int(self.ticks["truth"]["q"].shape[1])

    @property
    def begin(self) -> float:
        """Time of the first tick, s."""
        return float(self.curves.time[0])

    @property
    def end(self) -> float:
        """Time of the last tick, s."""
        return float(self.ticks["measurement"]["tick"][-1] * self.period_s)

    @property
    def weight(self) -> float:
        """Of all that flies, N; not a number where the log does not say."""
        try:
            return float(self.log.metadata["weight"])
        except (LookupError, ValueError):
            return float("nan")

    def at(self, time: float) -> Records:
        """The tick at a time, s, or the nearest."""
        return self.ticks[int(np.clip(round((time - self.begin) / self.period_s), 0, len(self.ticks) - 1))]

    def ahead(self, time: float, seconds: float = 4.0) -> Array:
        """The reference (k, 3), m, D, of the end effector from a time on, thinned."""
        k = int(np.clip(round((time - self.begin) / self.period_s), 0, len(self.ticks) - 1))
        return np.array(
            self.ticks["reference"]["r"][k : k + round(seconds / self.period_s) : max(1, self.rate_hz // 15)]
        )

    def phase(self, tick: Records) -> str:
        """Name of the phase of a tick."""
        return name_of(self.phases, int(tick["mission"]["phase"]))

    def wind(self, time: float) -> Array | None:
        """Mean wind (3,), m/s, W, where the UAV is caught, as scenario and operator have it; None where none is known of."""
        if self.scenario is None:
            return None
        air = self.scenario.air
        for message in self.told:
            if message.do == "wind" and message.tick * self.period_s <= time:
                air = air.model_copy(update={"wind_mps": message.value})
        scenario = self.scenario.model_copy(update={"air": air})
        return speed_at(scenario, height_of_catch(scenario)) * towards(scenario) if air.wind_mps > 0.0 else None

    def share_of_sea(self, time: float) -> float:
        """Share of the deck's motion that the operator asked for until then, 1 where he said nothing."""
        return next((m.value for m in reversed(self.told) if m.do == "sea" and m.tick * self.period_s <= time), 1.0)

    def _names(self, what: str) -> tuple[str, ...]:
        try:
            return self.log.names(what)
        except LogError as lost:
            self.notes.append(f"{self.file.name}: {lost}; they are shown by their numbers.")
            return ()

    def _scenario(self) -> Scenario | None:
        try:
            return Scenario.model_validate_json(self.log.metadata.get("scenario", ""))
        except ValueError:
            return None

    def _scene(self) -> Scene | None:
        metadata, name = self.log.metadata, self.file.name
        try:
            scene = scene_of(metadata)
            if scene.joints == self.joints:
                return scene
            lost = LogError("its arm has not as many joints as its scenario's")
        except LogError as no:
            lost = no
        try:
            scene = armless_scene_of(metadata)
        except LogError:
            self.notes.append(f"{name}: {lost}. Its plots are shown.")
            return None
        self.armless = True
        self.notes.append(f"{name}: {lost}. All but the arm is shown.")
        return scene

    def _told(self) -> tuple[Message, ...]:
        try:
            return script_of(self.log.attachments)
        except LogError as lost:
            self.notes.append(f"{self.file.name}: {lost}; what the operator did is not shown.")
            return ()

    def _events(self) -> list[Event]:
        mission, events = self.ticks["mission"], []
        for k in np.flatnonzero(np.diff(mission["phase"], prepend=-1)):
            words = name_of(self.phases, int(mission["phase"][k])).replace("_", " ")
            events.append(Event(self._time(k), "phase", words))
        for k in np.flatnonzero((np.diff(mission["fault"], prepend=0) != 0) & (mission["fault"] > 0)):
            fault, end = name_of(self.faults, int(mission["fault"][k])), name_of(self.phases, int(mission["phase"][k]))
            events.append(Event(self._time(k), "supervisor", f"{fault} found, on to {end}"))
        events += [Event(m.tick * self.period_s, "operator", m.words()) for m in self.told]
        return sorted(events)

    def _time(self, k: int | np.signedinteger[Any]) -> float:
        return float(self.ticks["measurement"]["tick"][k] * self.period_s)


def threshold(metadata: dict[str, str], name: str) -> float:
    """A threshold of the mission that a log was flown by; 0 where it has none."""
    try:
        return float(json.loads(metadata["thresholds"])[name])
    except (LookupError, TypeError, ValueError):
        return 0.0
