"""What the loop needs of the world: the same four methods for the simulator, a replay and real devices."""

from typing import Protocol

from armland.records import Records, Tick


class Port(Protocol):
    """The world as the loop sees it."""

    def connect(self) -> None:
        """Get ready; afterwards `read` gives measurements."""

    def read(self, tick: Tick) -> None:
        """Fill the measurement of `tick` (and its truth, where there is one)."""

    def command(self, tick: Tick) -> Records:
        """Apply the command of `tick` for one cycle; returns the command (1,) as it was really applied."""

    def stop(self) -> None:
        """Let go safely. Never raises."""
