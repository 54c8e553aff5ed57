"""The loop's order, its end, and that the port is let go whatever happens; any kind of tick."""

from collections.abc import Iterator

import pytest

from armland.mission.records import LandingTick
from armland.records import AnyTick, Tick
from armland.runtime.loop import REPORT_EVERY, run_loop
from armland.runtime.recorder import Recorder


class World:
    """Port and controller in one: counts, and remembers who was called in what order."""

    def __init__(self, breaks_at: int = -1) -> None:
        self.calls: list[str] = []
        self._breaks_at = breaks_at

    def connect(self) -> None:
        self.calls.append("connect")
        self._number = 0

    def read(self, tick: AnyTick) -> None:
        self.calls.append("read")
        tick.measurement["tick"] = self._number

    def update(self, tick: AnyTick) -> None:
        self.calls.append("update")
        if self._number == self._breaks_at:
            raise ZeroDivisionError
        tick.command["tau"] = self._number

    def command(self, tick: AnyTick) -> None:
        self.calls.append("command")
        tick.truth["tick"] = self._number
        self._number += 1

    def stop(self) -> None:
        self.calls.append("stop")


@pytest.mark.parametrize("kind", [Tick, LandingTick])
def test_each_tick_is_read_updated_commanded_and_then_recorded(kind: type[AnyTick]) -> None:
    world, tick = World(), kind(7)
    with Recorder(None, tick, 1_000_000) as recorder:
        run_loop(world, world, recorder, tick, range(3))
    assert world.calls == ["connect", *3 * ["read", "update", "command"], "stop"]
    assert recorder.ticks["command"]["tau"][:, 0].tolist() == [0.0, 1.0, 2.0]
    assert recorder.ticks["truth"]["tick"].tolist() == [0, 1, 2]


def test_generator_ends_the_run_by_what_it_sees_in_the_tick() -> None:
    world, tick = World(), Tick(7)

    def until_seven() -> Iterator[int]:
        k = 0
        while not k or tick.command["tau"][0, 0] < 7.0:
            yield k
            k += 1

    with Recorder(None, tick, 1_000_000) as recorder:
        run_loop(world, world, recorder, tick, until_seven())
    assert len(recorder.ticks) == 8
    assert world.calls[-1] == "stop"


def test_port_is_stopped_when_the_law_breaks_and_the_ticks_before_are_kept() -> None:
    world, tick = World(breaks_at=2), Tick(7)
    with Recorder(None, tick, 1_000_000) as recorder, pytest.raises(ZeroDivisionError):
        run_loop(world, world, recorder, tick, range(10))
    assert world.calls[-2:] == ["update", "stop"]
    assert len(recorder.ticks) == 2


def test_progress_is_told_now_and_then() -> None:
    world, tick, told = World(), Tick(7), []
    with Recorder(None, tick, 1_000_000) as recorder:
        run_loop(world, world, recorder, tick, range(2 * REPORT_EVERY + 1), told.append)
    assert told == [0, REPORT_EVERY, 2 * REPORT_EVERY]
