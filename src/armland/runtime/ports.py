"""What the loop needs of the world: the same four methods for the simulator, a replay and real devices."""

from typing import Protocol

from armland.records import Tick


class Port(Protocol):
    """The world as the loop sees it."""

    def connect(self) -> None:
        """Get ready; afterwards `read` gives measurements."""

    def read(self, tick: Tick) -> None:
        """Fill the measurement of `tick` (and its truth, where there is one)."""

    def command(self, tick: Tick) -> None:
        """Apply the command of `tick` for one cycle."""

    def stop(self) -> None:
        """Let go safely. Never raises."""


class Controller(Protocol):
    """What turns a measurement into a command."""

    def update(self, tick: Tick) -> None:
        """Fill estimate, reference, command and health of `tick` from its measurement. Never raises on bad samples."""
