"""A flight that listens to an operator: a port around the simulator's, which acts between ticks and keeps what was done."""

from collections import deque
from collections.abc import Callable, Sequence

from armland.errors import ArmlandError
from armland.experiments.episode import Flight
from armland.experiments.judge.brief import metadata_of
from armland.experiments.operator.acts import Acts
from armland.experiments.operator.message import Message
from armland.experiments.operator.script import SCRIPT_NAME, text_of
from armland.mission.controller import Controller
from armland.mission.supervisor.operator import OPERATOR, waiting
from armland.mission.table.arrays import PHASES
from armland.records import Records, Tick

Attach = Callable[[str, str], None]


def steerable(flight: Flight) -> Flight:
    """The flight with the phases in which an operator holds it, and his name among the faults of its log."""
    plan = flight.plan
    if len(plan.phases) + 2 <= PHASES:
        plan = plan._replace(phases=(*plan.phases, *waiting()))
    flight.controller.plan = plan
    metadata = metadata_of(flight.scenario, plan, flight.simulator.scene)
    return flight._replace(plan=plan, metadata={**metadata, "faults": f"{metadata['faults']},{OPERATOR}"})


class Hand:
    """The port of a flight that is steered: by a script, or by messages that come while it flies.

    Args:
        flight: of `episode.prepare`; nothing of it has been flown yet.
        script: messages that act by themselves, in their order.
    """

    def __init__(self, flight: Flight, script: Sequence[Message] = ()) -> None:
        self.flight = steerable(flight)
        self.acts = Acts(self.flight)
        self.done: list[Message] = []
        """What has been done so far."""
        self.attach: Attach | None = None
        """What takes the script for the log, each time that there is more of it."""
        self._simulator, self._due = flight.simulator, deque(script)

    @property
    def compilable(self) -> bool:
        """Whether whole blocks can be flown."""
        return self._simulator.compilable

    @property
    def tick(self) -> int:
        """The tick that comes next."""
        return self._simulator.tick

    def connect(self) -> None:
        """Put everything at its start."""
        self._simulator.connect()

    def read(self, tick: Tick) -> None:
        """Do what is due, and fill measurement and truth of `tick`; errors as for `do`."""
        self._do_due()
        self._simulator.read(tick)

    def command(self, tick: Tick) -> Records:
        """Apply the command of `tick`; returns it (1,) as it was really applied."""
        return self._simulator.command(tick)

    def stop(self) -> None:
        """Let go. Never raises."""
        self._simulator.stop()

    def advance(self, controller: Controller, rows: Records) -> tuple[int, ArmlandError | None]:
        """Do what is due and fly on into `rows`, up to where something is due again; see `loops.Simulated`.

        Raises:
            ConfigurationError: a message of the script that cannot be done here.
        """
        self._do_due()
        most = self._due[0].tick - self.tick if self._due else len(rows)
        return self._simulator.advance(controller, rows[:most])

    def do(self, message: Message) -> Message:
        """Do a message now, whatever its tick says; returns it with the tick at which it was done.

        Raises:
            ConfigurationError: it cannot be done here; nothing is changed.
        """
        message = message.at(self.tick)
        self.acts.do(message)
        self.done.append(message)
        if self.attach is not None:
            self.attach(SCRIPT_NAME, text_of(self.done))
        return message

    def _do_due(self) -> None:
        while self._due and self._due[0].tick <= self.tick:
            self.do(self._due.popleft())
