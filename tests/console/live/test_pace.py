"""The pace: shares of real time, pause and single steps, with a clock of the test's own."""

import time

import pytest

from armland.console.live import pace as module
from armland.console.live.pace import FACTORS, LATE_S, Pace


@pytest.fixture
def clock(monkeypatch):
    class Clock:
        now = 100.0

        def perf_counter(self):
            return self.now

    made = Clock()
    monkeypatch.setattr(module.time, "perf_counter", made.perf_counter)
    return made


def fly(pace: Pace, clock, seconds: float, most: int = 250) -> int:
    """Ticks flown in so many seconds, looked at every millisecond."""
    flown = 0
    for _ in range(round(seconds * 1000)):
        clock.now += 1e-3
        flown += pace.due(most)
    return flown


@pytest.mark.parametrize("text", FACTORS)
def test_each_factor_is_kept(clock, text: str) -> None:
    pace = Pace(1000)
    pace.set(FACTORS[text])
    fly(pace, clock, 1.0)
    flown = fly(pace, clock, 16.0)
    # A block more or less.
    assert flown == pytest.approx(16_000 * FACTORS[text], abs=max(40 * FACTORS[text], 1.1))


def test_as_fast_as_it_goes_is_all_that_is_asked_for(clock) -> None:
    pace = Pace(1000)
    pace.set(None)
    assert pace.due(250) == 250
    assert pace.due(7) == 7


def test_paused_nothing_flies_but_single_steps(clock) -> None:
    pace = Pace(1000)
    pace.pause(True)
    assert fly(pace, clock, 1.0) == 0
    pace.step(1)
    assert fly(pace, clock, 0.1) == 1
    pace.step(300)
    assert pace.due(250) == 250
    assert pace.due(250) == 50
    assert pace.due(250) == 0
    # What was missed in a pause is not made up for.
    pace.pause(False)
    assert fly(pace, clock, 1.0) == pytest.approx(1000, abs=40)


def test_steps_that_are_left_are_dropped_when_time_goes_on(clock) -> None:
    pace = Pace(1000)
    pace.pause(True)
    pace.step(5000)
    pace.pause(False)
    pace.due(1)
    pace.pause(True)
    assert pace.due(250) == 0


def test_a_flight_that_fell_far_behind_goes_on_from_where_it_is(clock) -> None:
    pace = Pace(1000)
    fly(pace, clock, 1.0)
    clock.now += 30.0
    caught_up = sum(pace.due(250) for _ in range(1000))
    assert 0 < caught_up <= 1000 * LATE_S + 70


def test_a_flight_that_begins_makes_up_for_nothing(clock) -> None:
    pace = Pace(1000)
    clock.now += 30.0
    pace.begin()
    assert sum(pace.due(250) for _ in range(1000)) <= 33


def test_who_waits_is_woken(monkeypatch) -> None:
    pace, woken = Pace(1000), []
    wait = pace._woken.wait
    monkeypatch.setattr(pace._woken, "wait", lambda seconds: woken.append(wait(seconds)) or woken[-1])
    pace.pause(True)
    pace.wake()
    pace.rest()
    begin = time.monotonic()
    pace.rest()
    # The first at once, the second by itself.
    assert woken == [True, False]
    assert time.monotonic() - begin > 0.03
