"""What the loop needs of the world: the same four methods for the simulator, a replay and real devices."""

from typing import Protocol, TypeVar

from armland.records import AnyTick

T = TypeVar("T", bound=AnyTick, contravariant=True)


class Port(Protocol[T]):
    """The world as the loop sees it."""

    def connect(self) -> None:
        """Get ready; afterwards `read` gives measurements."""

    def read(self, tick: T) -> None:
        """Fill the measurement of `tick` (and its truth, where there is one)."""

    def command(self, tick: T) -> None:
        """Apply the command of `tick` for one cycle."""

    def stop(self) -> None:
        """Let go safely. Never raises."""


class Controller(Protocol[T]):
    """What turns a measurement into a command."""

    def update(self, tick: T) -> None:
        """Fill estimate, reference, command and health of `tick` from its measurement. Never raises on bad samples."""
