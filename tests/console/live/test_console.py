"""The console as a whole: a page starts a flight, steers it, and sees what came of it."""

import threading

import numpy as np
import pytest

from armland.console.live.choices import Choices
from armland.console.live.console import Console, way_of
from armland.console.live.pilot import Pilot
from armland.experiments.episode import prepare
from armland.experiments.operator.script import read_script

SECONDS = 60.0


@pytest.fixture(scope="module")
def known(landing_scenario):
    return prepare(landing_scenario, "landing", 1).plan


@pytest.fixture
def console(server, fake_page, landing_scenario, known, tmp_path):
    pilot = Pilot(
        lambda c: prepare(landing_scenario, c.mission, c.seed, known=known if c.mission == "landing" else None),
        tmp_path,
        lambda words: made.say(words),
    )
    made = Console(server, pilot, Choices(), ("run.duration_s=45.0",))
    server._refused = made.say
    made.pilot, made.page, made.gui = pilot, fake_page(server), server.viser.gui
    made.page.control = lambda label: next(h for h in made.gui._gui_input_handle_from_uuid.values() if h.label == label)
    thread = threading.Thread(target=made.run, daemon=True)
    thread.start()
    yield made
    made.close()
    thread.join(timeout=10.0)
    assert not thread.is_alive()
    pilot.close()


def press(console, label: str, value: object) -> None:
    console.page.set(console.page.control(label), value)


@pytest.fixture
def fly_into(console, recording, wait_until):
    """Fly on into a phase of the landing, and let time stand still there: however slow the machine is, nothing passes unseen."""

    def fly(phase: str) -> None:
        ticks, names = recording.ticks["mission"]["phase"], recording.phases
        tick = int(np.flatnonzero(ticks == names.index(phase))[0]) + 50
        console.pilot.pace.pause(True)
        if console._flight is None:
            press(console, "flight", "start")
            assert wait_until(lambda: console._flight is not None and console.pilot.flying, SECONDS)
        console.pilot.pace.step(tick - console._flight.tick)
        assert wait_until(lambda: console._flight.tick == tick, SECONDS)

    return fly


def test_a_flight_is_started_watched_and_judged(console, fly_into, wait_until) -> None:
    assert wait_until(lambda: "press start" in console._status.content)
    fly_into("carry")
    assert wait_until(lambda: 'data-phase="carry"' in console._strip.content)
    assert wait_until(lambda: "set down" in console._gauges.content and "joint torque" in console._gauges.content)
    press(console, "times real time", "8")
    press(console, "time", "run")
    assert wait_until(lambda: "✓ landed" in console._status.content, SECONDS)
    uav, last = (
        console._stage._frames[console._flight.flight.simulator.scene.uav_body],
        console._flight.now.tick["truth"][0],
    )
    assert wait_until(lambda: np.allclose(uav.wxyz, last["quat"], atol=2e-5))
    # A window of the plots: the newest 12 s, thinned.
    chart = console._charts._charts[0]
    assert wait_until(lambda: chart.data[0][-1] == pytest.approx(last["tick"] * 1e-3, abs=0.04))
    assert chart.data[0][-1] - chart.data[0][0] < 12.1
    command = ">armland run landing landing --seed 1 --set run.duration_s=45.0</code>"
    assert wait_until(lambda: command in console._again.content)


def test_a_fault_is_foreseen_thrown_in_and_its_outcome_told(console, fly_into, wait_until) -> None:
    fly_into("guide")
    assert wait_until(lambda: len(console.page.control("phase").options) > 5)
    press(console, "phase", "approach")
    assert wait_until(lambda: "in approach the supervisor goes to abort" in console.controls.forecast.content)
    assert wait_until(lambda: "background:#E69F0088" in console.controls.table.content)
    press(console, "throw it in", True)
    assert wait_until(lambda: [m.do for m in console._flight.done] == ["fault"])
    press(console, "times real time", "8")
    press(console, "time", "run")
    assert wait_until(lambda: "as the table says" in console.controls.outcomes.content, SECONDS)
    assert "uav_silent thrown into approach: found uav_silent in " in console.controls.outcomes.content
    assert "went to abort" in console.controls.outcomes.content
    assert wait_until(lambda: console.pilot.log is not None, SECONDS)
    assert wait_until(lambda: f"--operator {console.pilot.log}</code>" in console._again.content)
    assert [m.do for m in read_script(console.pilot.log)] == ["fault"]


def test_the_next_flight_stands_in_the_scene_of_the_last(console, wait_until) -> None:
    press(console, "times real time", "as fast as it goes")
    press(console, "flight", "start")
    assert wait_until(lambda: console._flight is not None and console.pilot.log is not None, SECONDS)
    first, stage, poses = console._flight, console._stage, console._stage.poses
    press(console, "seed", "next seed")
    assert wait_until(lambda: console._flight is not first, SECONDS)
    assert wait_until(lambda: console._stage.poses is not poses)
    assert console._stage is stage
    assert console._number == 1


@pytest.mark.slow
def test_held_by_space_and_aborted_by_escape(console, fly_into, wait_until) -> None:
    commands = {c.hotkey: c for c in console.gui._command_handle_from_uuid.values()}
    console.pilot.pace.pause(True)
    console.page.press(commands["enter"])
    assert wait_until(lambda: console._flight is not None and console.pilot.flying, SECONDS)
    fly_into("guide")
    console.page.press(commands["space"])
    assert wait_until(lambda: [m.do for m in console._flight.done] == ["hold"])
    console.pilot.pace.step(50)
    assert wait_until(lambda: 'data-phase="held_by_operator"' in console._strip.content)
    assert wait_until(lambda: "held by the operator" in console._gauges.content)
    console.page.press(commands["space"])
    assert wait_until(lambda: [m.do for m in console._flight.done] == ["hold", "resume"])
    console.page.press(commands["escape"])
    console.pilot.pace.pause(False)
    assert wait_until(lambda: "aborted by hand in " in console.controls.outcomes.content, SECONDS)
    assert wait_until(lambda: "the operator aborted it" in console._status.content, SECONDS)


def test_errors_are_shown_and_go_again(console, wait_until, monkeypatch) -> None:
    from armland.console.live import console as module

    press(console, "flight", "hold")
    assert wait_until(lambda: "hold: nothing flies; press start" in console._errors.content)
    console.page.set(console.page.control("wind (m/s)"), 999.0)
    assert wait_until(lambda: "999.0, which this control cannot have; it was ignored" in console._errors.content)
    press(console, "mission", "track")
    press(console, "flight", "start")
    # What could not be flown stays in sight for longer than a message does.
    assert wait_until(lambda: "✗ " in console._status.content, SECONDS)
    assert "track" in console._status.content
    monkeypatch.setattr(module, "ERROR_S", 0.0)
    assert wait_until(lambda: console._errors.content == "")


def test_the_way_is_the_mission_s_points_or_its_path(known, paper) -> None:
    way = way_of(known)
    assert way.shape == (6, 3)
    np.testing.assert_allclose(way[1], known.scenario.place.catch_m)
    path = way_of(prepare(paper, "E1", 1).plan)
    assert len(path) > 50
