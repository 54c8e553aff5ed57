"""How fast a flight goes: at a share of real time, as fast as it can, tick by tick, or not at all. Times are read, never slept over."""

import threading
import time

FRAMES_HZ = 30.0
"""Blocks a second of a flight that is paced: what a page can show."""

LATE_S = 0.25
"""How far behind a flight may fall and still catch up; beyond, it goes on from where it is."""

FACTORS = {
    "1/32": 1 / 32,
    "1/16": 1 / 16,
    "1/8": 1 / 8,
    "1/4": 1 / 4,
    "1/2": 1 / 2,
    "1": 1.0,
    "2": 2.0,
    "4": 4.0,
    "8": 8.0,
}
FASTEST = "as fast as it goes"


class Pace:
    """Set by pages, read by the thread that flies.

    Args:
        rate_hz: of the ticks.
    """

    def __init__(self, rate_hz: int) -> None:
        self.rate_hz, self.factor = rate_hz, 1.0
        self.paused = False
        """Whether time stands still."""
        self._steps, self._due, self._woken = 0, time.perf_counter(), threading.Event()

    def begin(self) -> None:
        """Count from now on: what went before is not made up for."""
        self._due = time.perf_counter()

    def set(self, factor: float | None) -> None:
        """Go at `factor` times real time, None for as fast as it can."""
        self.factor = 0.0 if factor is None else factor
        self.wake()

    def pause(self, on: bool) -> None:
        """Stop time, or let it go on."""
        self.paused = on
        self.wake()

    def step(self, ticks: int) -> None:
        """Fly so many ticks though time stands still."""
        self._steps += ticks
        self.wake()

    def wake(self) -> None:
        """Let whoever waits look again."""
        self._woken.set()

    def due(self, most: int) -> int:
        """How many of `most` ticks may be flown now; 0: none, wait with `rest`."""
        if self.paused:
            self._due = time.perf_counter()
            flown, self._steps = min(self._steps, most), max(self._steps - most, 0)
            return flown
        self._steps = 0
        if not self.factor:
            return most
        now = time.perf_counter()
        if now < self._due:
            return 0
        ticks = min(max(1, round(self.factor * self.rate_hz / FRAMES_HZ)), most)
        self._due = max(self._due, now - LATE_S) + ticks / (self.factor * self.rate_hz)
        return ticks

    def rest(self) -> None:
        """Wait until something may be due again, or something is new."""
        ahead = self._due - time.perf_counter() if not self.paused and self.factor else 0.05
        if self._woken.wait(min(max(ahead, 0.0), 0.05)):
            self._woken.clear()
