"""The loop's order, its end, what it tells and records; that the port is let go whatever happens; that both loops fly the same."""

from types import SimpleNamespace

import numpy as np
import pytest

from armland.errors import PlantError
from armland.records import Tick
from armland.runtime.loops import BLOCK, fly, fly_in_python
from armland.runtime.recorder import Recorder

FINAL = 3
"""Phase of the stand-in that ends its mission."""


class World:
    """Port and controller in one: counts, changes phases at given ticks, and remembers who was called in what order."""

    def __init__(self, phases=(), breaks_at=-1, compilable=False):
        self.tick, self.calls, self.number = Tick(7), [], 0
        self.compilable = compilable
        self._phases, self._breaks_at, self._begin = dict(phases), breaks_at, 0

    def connect(self):
        self.calls.append("connect")

    def read(self, tick):
        self.calls.append("read")
        tick.measurement["tick"] = self.number

    def update(self, tick):
        self.calls.append("update")
        if self.number == self._breaks_at:
            raise ZeroDivisionError
        if self.number in self._phases:
            tick.mission["phase"], self._begin = self._phases[self.number], self.number
        tick.mission["tick"] = tick.command["tau"] = self.number

    def command(self, tick):
        self.calls.append("command")
        tick.truth["tick"] = self.number
        self.number += 1

    def stop(self):
        self.calls.append("stop")

    def ended_for(self):
        return self.number - 1 - self._begin if self.tick.mission["phase"][0] >= FINAL else -1

    def advance(self, controller, rows):
        """As compiled code does it: until the rows are full, the mission is over, or the next tick is not finite."""
        for i in range(len(rows)):
            if self.number == self._breaks_at:
                return i, PlantError("not finite")
            for step in (self.read, self.update, self.command):
                step(self.tick)
            rows[i] = self.tick.buffer[0]
            if self.ended_for() >= PLAN["watch"]:
                return i + 1, None
        return len(rows), None


PLAN = {"watch": 5}


def plan(ticks):
    scenario = SimpleNamespace(run=SimpleNamespace(rate_hz=1000))
    return SimpleNamespace(ticks=ticks, scenario=scenario, names=("wait", "go", "rest", "done", "braked"), **PLAN)


def flown(world, ticks, loop, progress=None):
    with Recorder(None, 7, 1_000_000) as recorder:
        loop(world, world, plan(ticks), recorder, progress)
    return recorder.ticks


EACH_LOOP = pytest.mark.parametrize(("loop", "compilable"), [(fly, True), (fly, False), (fly_in_python, False)])


@EACH_LOOP
def test_each_tick_is_read_updated_commanded_and_then_recorded(loop, compilable):
    world = World(compilable=compilable)
    ticks = flown(world, 3, loop)
    assert world.calls == ["connect", *3 * ["read", "update", "command"], "stop"]
    assert ticks["command"]["tau"][:, 0].tolist() == [0.0, 1.0, 2.0]
    assert ticks["truth"]["tick"].tolist() == [0, 1, 2]


@EACH_LOOP
@pytest.mark.parametrize("end", [0, 1, 249, 250, 600])
def test_ended_mission_is_watched_on(loop, compilable, end):
    ticks = flown(World({end: FINAL}, compilable=compilable), 5000, loop)
    assert ticks["truth"]["tick"].tolist() == list(range(end + PLAN["watch"] + 1))


@EACH_LOOP
def test_graver_end_is_watched_as_long(loop, compilable):
    ticks = flown(World({10: FINAL, 14: FINAL + 1}, compilable=compilable), 5000, loop)
    assert len(ticks) == 14 + PLAN["watch"] + 1


@EACH_LOOP
@pytest.mark.parametrize("most", [1, 2, BLOCK, BLOCK + 1, 3 * BLOCK + 7])
def test_run_is_over_after_its_most_ticks(loop, compilable, most):
    assert len(flown(World(compilable=compilable), most, loop)) == most


@EACH_LOOP
def test_phases_are_told_with_the_time_of_their_begin(loop, compilable):
    told = []
    world = World({0: 0, 249: 1, 250: 2, 777: FINAL}, compilable=compilable)
    flown(world, 5000, loop, lambda phase, t: told.append((phase, t)))
    assert told == [("wait", 0.0), ("go", 0.249), ("rest", 0.25), ("done", 0.777)]


@EACH_LOOP
def test_port_is_stopped_when_something_breaks_and_the_ticks_before_are_kept(loop, compilable):
    world = World(breaks_at=333, compilable=compilable)
    with Recorder(None, 7, 1_000_000) as recorder, pytest.raises(PlantError if compilable else ZeroDivisionError):
        loop(world, world, plan(1000), recorder)
    assert world.calls[-1] == "stop"
    assert recorder.ticks["truth"]["tick"].tolist() == list(range(333))


@EACH_LOOP
def test_ctrl_c_between_blocks_stops_the_port_and_keeps_the_ticks(loop, compilable):
    def interrupt(phase, t):
        if phase == "go":
            raise KeyboardInterrupt

    world = World({0: 0, 400: 1}, compilable=compilable)
    with Recorder(None, 7, 1_000_000) as recorder, pytest.raises(KeyboardInterrupt):
        loop(world, world, plan(5000), recorder, interrupt)
    assert world.calls[-1] == "stop"
    assert len(recorder.ticks) == 2 * BLOCK


@EACH_LOOP
def test_recorder_that_fails_does_not_end_the_flight(loop, compilable, tmp_path):
    class Full:
        def __init__(self, file):
            self._file = file

        def write(self, data):
            raise OSError(28, "No space left on device")

        def __getattr__(self, name):
            return getattr(self._file, name)

    world = World(compilable=compilable)
    with Recorder(tmp_path / "run.mcap", 7, 1_000_000, keep_in_memory=True) as recorder:
        recorder._file._file = Full(recorder._file._file)
        loop(world, world, plan(2000), recorder)
    assert len(recorder.ticks) == 2000
    assert "No space left" in str(recorder.failure)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "mission"), [("paper", "E3"), ("landing", "landing")])
def test_compiled_and_python_loop_fly_the_same_bytes(name, mission):
    from armland.experiments.episode import prepare
    from armland.scenario import load_scenario

    rows = []
    for loop in (fly, fly_in_python):
        flight = prepare(load_scenario(name), mission)
        short = flight.plan._replace(ticks=3200)
        with Recorder(None, 7, 1_000_000) as recorder:
            loop(flight.simulator, flight.controller, short, recorder)
        rows.append(recorder.ticks)
    assert len(rows[0]) == 3200
    assert rows[0].tobytes() == rows[1].tobytes()
    # Negative control: something moved, and noise was drawn more than once.
    assert np.abs(np.diff(rows[0]["measurement"]["q"], axis=0)).min(axis=1).max() > 0.0
