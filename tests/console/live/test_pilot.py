"""The pilot: flies in a thread, takes messages between blocks, and never waits for whoever watches."""

import threading

import numpy as np
import pytest

from armland.console.live.choices import Choices
from armland.console.live.pilot import Pilot, drained, joined_rows
from armland.errors import ConfigurationError
from armland.experiments.episode import prepare
from armland.experiments.operator.hand import Hand
from armland.experiments.operator.message import asked
from armland.experiments.operator.script import first_difference, read_script
from armland.mission.table.phases import SIGNALS
from armland.runtime.log import read_log

SECONDS = 60.0


@pytest.fixture(scope="module")
def known(landing_scenario):
    return prepare(landing_scenario, "landing", 1).plan


@pytest.fixture
def flights(landing_scenario, known):
    """How the pilot's flights are made; `fail` makes the next one fail."""

    class Flights:
        fail: Exception | None = None
        gate = threading.Event()

        def __call__(self, choices: Choices):
            self.gate.wait(SECONDS)
            if self.fail is not None:
                raise self.fail
            return prepare(landing_scenario, choices.mission, choices.seed, known=known)

    made = Flights()
    made.gate.set()
    return made


@pytest.fixture
def pilot(flights, tmp_path):
    said = []
    made = Pilot(flights, tmp_path / "logs", said.append)
    made.said = said
    made.pace.set(None)
    yield made
    made.close()
    assert not made._thread.is_alive()


@pytest.mark.slow
def test_flies_as_the_command_does(pilot, wait_until, landed) -> None:
    pilot.start(Choices(), [])
    assert wait_until(lambda: pilot.ended is not None, SECONDS)
    assert pilot.ended == ("landed", True)
    assert not pilot.flying
    log = read_log(pilot.log)
    assert log.complete
    assert first_difference(log.ticks, landed.ticks) is None


def test_steered_it_flies_again_from_its_log(pilot, wait_until, landing_scenario, known) -> None:
    # Time stands still while messages come, however late they are.
    pilot.pace.pause(True)
    pilot.pace.step(2000)
    pilot.start(Choices(seed=2), [asked("noise", 1.5)])
    for tick, message in ((2000, "wind"), (2000, "hold"), (2500, "resume"), (2700, "abort")):
        assert wait_until(lambda tick=tick: pilot.flight is not None and pilot.flight.tick == tick, SECONDS)
        done = len(pilot.flight.done)
        pilot.tell(asked(message, 2.5 if message == "wind" else 0.0))
        assert wait_until(lambda done=done: len(pilot.flight.done) == done + 1, SECONDS)
        pilot.pace.step({"hold": 500, "resume": 200}.get(message, 0))
    pilot.pace.pause(False)
    assert wait_until(lambda: pilot.ended is not None, SECONDS)
    assert "the operator aborted it" in pilot.ended.words
    script = read_script(pilot.log)
    assert [m.do for m in script] == ["noise", "wind", "hold", "resume", "abort"]
    assert [m.tick for m in script] == [0, 2000, 2000, 2500, 2700]
    again = Hand(prepare(landing_scenario, "landing", 2, known=known), script)
    from armland.experiments.episode import fly_prepared

    assert first_difference(fly_prepared(again.flight, port=again).ticks, read_log(pilot.log).ticks) is None


def test_what_cannot_be_done_is_said_and_left_out(pilot, wait_until) -> None:
    with pytest.raises(ConfigurationError, match="hold: nothing flies; press start"):
        pilot.tell(asked("hold"))
    pilot.pace.pause(True)
    pilot.start(Choices(), [])
    assert wait_until(lambda: pilot.flying, SECONDS)
    pilot.tell(asked("resume"))
    pilot.pace.step(3)
    assert wait_until(lambda: pilot.said != [], SECONDS)
    assert "the mission is not held" in pilot.said[0]
    assert pilot.flight.done == []


def test_paused_it_goes_tick_by_tick(pilot, wait_until) -> None:
    pilot.pace.pause(True)
    pilot.start(Choices(), [])
    assert wait_until(lambda: pilot.flying, SECONDS)
    pilot.pace.step(1)
    assert wait_until(lambda: pilot.flight.tick == 1, SECONDS)
    pilot.pace.step(10)
    assert wait_until(lambda: pilot.flight.tick == 11, SECONDS)
    assert pilot.flight.now.tick["measurement"]["tick"][0] == 10
    # Messages are taken while time stands still.
    pilot.tell(asked("wind", 1.0))
    assert wait_until(lambda: [m.tick for m in pilot.flight.done] == [11], SECONDS)


@pytest.mark.slow
def test_what_pages_need_is_left_behind_whole(pilot, wait_until, landed) -> None:
    pilot.start(Choices(), [])
    assert wait_until(lambda: pilot.ended is not None, SECONDS)
    rows = joined_rows(drained(pilot.flight.thinned))
    np.testing.assert_array_equal(rows["measurement"]["tick"], np.arange(0, len(landed.ticks), 33))
    assert rows.tobytes() == landed.ticks[::33].tobytes()
    assert drained(pilot.flight.thinned) == []
    now = pilot.flight.now
    assert now.tick.tobytes() == landed.ticks[-1:].tobytes()
    assert now.signals.shape == (len(SIGNALS),)


@pytest.mark.slow
def test_another_flight_takes_the_place_of_the_one_under_way(pilot, wait_until) -> None:
    pilot.pace.pause(True)
    pilot.start(Choices(seed=1), [])
    assert wait_until(lambda: pilot.flying, SECONDS)
    first = pilot.flight
    pilot.start(Choices(seed=2), [])
    pilot.pace.pause(False)
    assert wait_until(lambda: pilot.flight is not first and pilot.ended is not None, SECONDS)
    assert first.stopped
    assert pilot.choices.seed == 2
    assert read_log(pilot.log).metadata["seed"] == "2"


@pytest.mark.slow
def test_what_was_asked_for_while_it_was_prepared_is_flown_alone(pilot, flights, wait_until) -> None:
    flights.gate.clear()
    for seed in (1, 2, 3):
        pilot.start(Choices(seed=seed), [])
    assert wait_until(lambda: pilot.preparing)
    flights.gate.set()
    assert wait_until(
        lambda: pilot.ended is not None and pilot.choices is not None and pilot.choices.seed == 3, SECONDS
    )
    assert pilot.ended.success


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (ConfigurationError("no such arm"), "no such arm"),
        (ZeroDivisionError("x"), "an error inside armland: ZeroDivisionError: x"),
    ],
)
def test_a_flight_that_cannot_be_is_said_and_the_next_one_flies(pilot, flights, wait_until, error, words: str) -> None:
    flights.fail = error
    pilot.start(Choices(), [])
    assert wait_until(lambda: pilot.said == [words], SECONDS)
    assert not pilot.flying
    flights.fail = None
    pilot.start(Choices(), [])
    assert wait_until(lambda: pilot.ended is not None and pilot.ended.success, SECONDS)


@pytest.mark.slow
def test_given_up_it_leaves_what_was_recorded(pilot, wait_until, tmp_path) -> None:
    pilot.pace.pause(True)
    pilot.pace.step(1200)
    pilot.start(Choices(), [])
    assert wait_until(lambda: pilot.flight is not None and pilot.flight.tick == 1200, SECONDS)
    pilot.stop()
    assert wait_until(lambda: pilot.ended is not None, SECONDS)
    assert pilot.ended.words == "given up"
    (file,) = (tmp_path / "logs").iterdir()
    assert len(read_log(file).ticks) == 1200
