"""The thread that flies: in blocks, between which it takes messages; what pages need it leaves behind and never waits for them."""

import threading
import time
from collections.abc import Callable
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Any, NamedTuple

import numpy as np

from armland.console.live.choices import Choices
from armland.console.live.pace import Pace
from armland.errors import ArmlandError, ConfigurationError
from armland.experiments.episode import Flight, fly_prepared
from armland.experiments.operator.hand import Hand
from armland.experiments.operator.message import Message
from armland.mission.controller import Controller
from armland.records import Records
from armland.rotations import Array

THIN_TICKS = 33
"""Of so many ticks one is left for the plots."""

Prepare = Callable[[Choices], Flight]
"""Makes a flight of what was chosen."""


class Stopped(ArmlandError):
    """The flight was given up for another."""


class Now(NamedTuple):
    """The newest moment of a flight."""

    tick: Records  # (1,) of `tick_layout`
    signals: Array  # of `SIGNALS`, in their units
    held_for: Array  # ticks for which each guard has held
    air: Array  # (3,) m/s, W, of the air around the UAV


class Ended(NamedTuple):
    """What came of a flight."""

    words: str
    success: bool


class Steered(Hand):
    """A flight that pages steer while it flies."""

    def __init__(self, flight: Flight, pace: Pace, said: Callable[[str], None]) -> None:
        """Make the port of a flight that goes at `pace`; `said` takes what could not be done, and why."""
        super().__init__(flight)
        self.pace, self._said = pace, said
        self.inbox: SimpleQueue[Message] = SimpleQueue()
        self.thinned: SimpleQueue[Records] = SimpleQueue()
        """Ticks for the plots, copied; whoever shows them takes them out."""
        self.now: Now | None = None
        self.stopped = False
        """Set to give the flight up."""

    def advance(self, controller: Controller, rows: Records) -> tuple[int, ArmlandError | None]:
        """Fly on as far as the pace allows, see `Hand.advance`.

        Raises:
            Stopped: the flight was given up.
        """
        while True:
            self._take()
            if self.stopped:
                raise Stopped("given up")
            if most := self.pace.due(len(rows)):
                break
            self.pace.rest()
        flown, broken = super().advance(controller, rows[:most])
        if flown:
            self._leave(controller, rows[:flown])
        if self.tick <= 1:
            # The first tick may have loaded what is compiled.
            self.pace.begin()
        return flown, broken

    def _take(self) -> None:
        while True:
            try:
                self.do(self.inbox.get_nowait())
            except Empty:
                return
            except ConfigurationError as no:
                self._said(str(no))

    def _leave(self, controller: Controller, rows: Records) -> None:
        first = int(rows["measurement"]["tick"][0])
        kept, air = controller.board["kept"]["decide"], self.flight.simulator.world["kept"]["air"]["velocity"]
        self.now = Now(rows[-1:].copy(), kept["signals"][0].copy(), kept["held_for"][0].copy(), air[0].copy())
        if (thin := rows[-first % THIN_TICKS :: THIN_TICKS]).size:
            self.thinned.put(thin.copy())


class Pilot:
    """Flies one flight after the other, each when it is asked for.

    Args:
        prepare: makes a flight.
        folder: for the logs.
        said: takes what a person should read.
    """

    def __init__(self, prepare: Prepare, folder: Path, said: Callable[[str], None]) -> None:
        self._prepare, self._folder, self._said = prepare, folder, said
        self.pace = Pace(1000)
        self.flight: Steered | None = None
        """What flies, or has flown last."""
        self.ended: Ended | None = None
        self.choices: Choices | None = None
        """Of the flight."""
        self.log: Path | None = None
        """Of the flight, when it is whole."""
        self.preparing = False
        self._orders: SimpleQueue[tuple[Choices, list[Message]] | None] = SimpleQueue()
        self._thread = threading.Thread(target=self._run, name="pilot", daemon=True)
        self._thread.start()

    @property
    def flying(self) -> bool:
        """Whether a flight is under way."""
        return self.flight is not None and self.ended is None and not self.preparing

    def start(self, choices: Choices, messages: list[Message]) -> None:
        """Fly what was chosen, with `messages` from the first tick on; a flight under way is given up."""
        self.stop()
        self._orders.put((choices, messages))

    def tell(self, message: Message) -> None:
        """Hand a message on to the flight.

        Raises:
            ConfigurationError: nothing flies.
        """
        if self.flight is None or not self.flying:
            raise ConfigurationError(f"{message.do}: nothing flies; press start")
        self.flight.inbox.put(message)
        self.pace.wake()

    def stop(self) -> None:
        """Give up the flight under way."""
        if self.flight is not None:
            self.flight.stopped = True
            self.pace.wake()

    def close(self) -> None:
        """Give up the flight and end the thread."""
        self.stop()
        self._orders.put(None)
        self._thread.join(timeout=10.0)

    def _run(self) -> None:
        while (order := self._orders.get()) is not None:
            self.preparing, self.ended = True, None
            try:
                self._fly(*order)
            except Stopped:
                self.ended = Ended("given up", False)
            except ArmlandError as no:
                self._said(str(no))
                self.ended = Ended(str(no), False)
            except Exception as broken:
                self._said(f"an error inside armland: {type(broken).__name__}: {broken}")
                self.ended = Ended(str(broken), False)
            self.preparing = False

    def _fly(self, choices: Choices, messages: list[Message]) -> None:
        flight = Steered(self._prepare(choices), self.pace, self._said)
        if not self._orders.empty():
            raise Stopped("another flight was asked for meanwhile")
        self._folder.mkdir(parents=True, exist_ok=True)
        log = self._folder / f"{choices.mission}_{choices.seed}_{time.strftime('%H%M%S')}.mcap"
        for message in messages:
            flight.inbox.put(message)
        self.pace.rate_hz = flight.flight.scenario.run.rate_hz
        self.choices, self.flight, self.log, self.preparing = choices, flight, None, False
        if flight.flight.moved:
            self._said(f"place: {flight.flight.moved}")
        episode = fly_prepared(flight.flight, log, port=flight)
        self.log = log
        self.ended = Ended(str(episode.result["reason"]), bool(episode.result["success"]))


def drained(queue: SimpleQueue[Any]) -> list[Any]:
    """All that is in a queue."""
    found = []
    while True:
        try:
            found.append(queue.get_nowait())
        except Empty:
            return found


def joined_rows(parts: list[Records]) -> Records:
    """Ticks one after the other."""
    # As opaque bytes: NumPy joins structured arrays field by field.
    opaque = np.dtype((np.void, parts[0].itemsize))
    return np.concatenate([p.view(opaque) for p in parts]).view(parts[0].dtype)
