"""The replay: play, pause, speed, scrub, jumps; one flight, or two and their difference."""

import threading
import time

import numpy as np
import pytest

from armland.console import replay as module
from armland.console.recording import Recording
from armland.console.replay import WHOLE, WINDOW_S, Replay
from armland.experiments.episode import fly
from armland.runtime.log import Log, read_log


class Served:
    """A replay that runs in a thread, with one page that is open."""

    def __init__(self, server, recordings, page):
        self.server, self.page = server, page
        self.replay = Replay(server, recordings)
        self.thread = threading.Thread(target=self.replay.run, daemon=True)
        self.thread.start()

    def control(self, label: str):
        handles = self.server.viser.gui._gui_input_handle_from_uuid.values()
        return next(h for h in handles if h.label == label)

    def command(self, label: str):
        return next(c for c in self.server.viser.gui._command_handle_from_uuid.values() if c.label == label)

    def stop(self):
        self.replay.close()
        self.thread.join(timeout=5.0)
        assert not self.thread.is_alive()


@pytest.fixture
def served(server, recording, fake_page):
    made = Served(server, [recording], fake_page(server))
    yield made
    made.stop()


def test_scrubbed_it_shows_that_time(served, recording, wait_until) -> None:
    served.page.set(served.control("time (s)"), 7.25)
    assert wait_until(lambda: served.replay.time == 7.25)
    uav = served.replay._stages[0][1]._frames[recording.scene.uav_body]
    truth = recording.at(7.25)["truth"]
    assert wait_until(lambda: np.allclose(uav.wxyz, truth["quat"], atol=1e-12))
    assert wait_until(lambda: "7.250 s, carry" in served.replay._status.content)
    assert 'data-phase="carry"' in served.replay._strip.content
    assert not served.replay.playing


@pytest.fixture
def clock(monkeypatch):
    """The clock by which a replay plays: it goes on when the test says so, however busy the machine is."""

    class Clock:
        now = 100.0

        def perf_counter(self) -> float:
            return self.now

    made = Clock()
    monkeypatch.setattr(module, "time", made)
    return made


def test_played_time_goes_on_at_its_speed(clock, served, wait_until) -> None:
    served.page.set(served.control("speed"), "4")
    served.page.set(served.control("Play"), True)
    assert wait_until(lambda: served.replay.playing)
    assert served.control("Pause")
    for at in (2.0, 4.0):
        clock.now += 0.5
        assert wait_until(lambda at=at: served.replay.time == pytest.approx(at))
    served.page.press(served.command("play or pause"))
    assert wait_until(lambda: not served.replay.playing)
    clock.now += 0.5
    time.sleep(0.15)
    assert served.replay.time == pytest.approx(4.0)


def test_at_its_end_it_stops_and_begins_anew(clock, served, recording, wait_until) -> None:
    served.replay.go_to(recording.end - 0.05)
    served.page.press(served.command("play or pause"))
    assert wait_until(lambda: served.replay.playing)
    clock.now += 1.0
    assert wait_until(lambda: served.replay.time == recording.end and not served.replay.playing)
    served.page.press(served.command("play or pause"))
    assert wait_until(lambda: served.replay.playing)
    assert served.replay.time == recording.begin


def test_jumps_to_events(served, recording, wait_until) -> None:
    menu = served.control("jump to")
    carry = next(o for o in menu.options if o.endswith("phase: carry"))
    served.page.set(menu, carry)
    begin = next(e.time for e in recording.events if e.words == "carry")
    assert wait_until(lambda: served.replay.time == pytest.approx(begin, abs=1e-3))
    served.page.set(served.control("event"), "next")
    following = next(e.time for e in recording.events if e.time > begin)
    assert wait_until(lambda: served.replay.time == pytest.approx(following))
    served.page.set(served.control("event"), "previous")
    assert wait_until(lambda: served.replay.time == pytest.approx(begin))
    served.page.press(served.command("a tenth of a second on"))
    assert wait_until(lambda: served.replay.time == pytest.approx(begin + 0.1))


def test_plots_show_all_or_a_window(served, recording, wait_until) -> None:
    served.replay.go_to(8.0)
    chart = served.replay._charts._charts[0]
    assert wait_until(lambda: len(chart.data[0]) == len(recording.curves.time))
    window = next(o for o in served.control("plots show").options if o != WHOLE)
    served.page.set(served.control("plots show"), window)
    assert wait_until(lambda: len(chart.data[0]) < len(recording.curves.time))
    assert chart.data[0][-1] - chart.data[0][0] == pytest.approx(WINDOW_S, abs=0.1)
    assert chart.data[0][0] <= 8.0 <= chart.data[0][-1]


def test_nonsense_from_a_page_changes_nothing(served, wait_until) -> None:
    slider = served.control("time (s)")
    for value in (-1.0, 1e9, "seven", None, float("nan"), [1.0]):
        served.page.set(slider, value)
    assert wait_until(lambda: served.server.ignored == 6)
    assert served.replay.time == 0.0


def test_without_a_page_nothing_is_drawn(server, recording) -> None:
    replay = Replay(server, [recording])
    thread = threading.Thread(target=replay.run, daemon=True)
    thread.start()
    before = server.viser._websock_server._broadcast_buffer.message_counter
    replay.go_to(5.0)
    time.sleep(0.2)
    assert server.viser._websock_server._broadcast_buffer.message_counter == before
    replay.close()
    thread.join(timeout=5.0)


@pytest.fixture(scope="module")
def later(recording):
    """The same flight, a fifth of a metre higher and two seconds shorter."""
    ticks = recording.ticks[:-2000].copy()
    ticks["truth"]["r"][:, 2] += 0.2
    metadata = recording.log.metadata | {"seed": "9"}
    return Recording(Log(ticks, metadata, {}, True), recording.file)


def test_two_flights_stand_in_one_scene_and_are_subtracted(server, recording, later, fake_page, wait_until) -> None:
    made = Served(server, [recording, later], fake_page(server))
    try:
        made.page.set(made.control("time (s)"), 6.0)
        chart = made.replay._charts._charts[0]
        assert wait_until(lambda: len(chart.data[0]) == len(recording.curves.time))
        uav, k = chart.data[-2], int(np.searchsorted(chart.data[0], 6.0))
        np.testing.assert_allclose(uav[:k], -0.2, atol=1e-12)
        assert np.isfinite(uav).all()
        assert len(made.replay._stages) == 2
        words = [e.words for e in made.replay.events]
        assert "carry [1]" in words
        assert "carry [2]" in words
    finally:
        made.stop()


@pytest.mark.slow
def test_an_experiment_on_the_hinge_is_shown(server, fake_page, wait_until, paper, tmp_path) -> None:
    file = tmp_path / "E1.mcap"
    fly(paper, "E1", 1, log=file)
    made = Served(server, [Recording(read_log(file), file)], fake_page(server))
    try:
        made.page.set(made.control("time (s)"), 4.0)
        assert wait_until(lambda: "4.000 s" in made.replay._status.content)
        ((_, stage),) = made.replay._stages
        assert stage._eye is None
        assert stage._disc is None
        assert wait_until(lambda: stage._path.visible)
    finally:
        made.stop()


def test_without_the_arm_s_file_the_rest_of_the_scene_plays(server, recording, fake_page, wait_until) -> None:
    text = recording.log.metadata["scenario"].replace('"lwr4.xml"', '"gone.xml"')
    metadata = recording.log.metadata | {"scenario": text}
    made = Served(server, [Recording(Log(recording.ticks, metadata, {}, True), recording.file)], fake_page(server))
    try:
        made.page.set(made.control("time (s)"), 6.0)
        ((_, stage),) = made.replay._stages
        uav = stage._frames[recording.scene.uav_body]
        assert wait_until(lambda: np.allclose(uav.wxyz, recording.at(6.0)["truth"]["quat"], atol=1e-9))
        assert not stage.poses.absent & set(stage._frames)
        assert wait_until(lambda: "marker at" in made.replay._sight.content)
    finally:
        made.stop()


def test_a_log_without_picture_still_plays(server, recording, fake_page, wait_until) -> None:
    metadata = {k: v for k, v in recording.log.metadata.items() if k in ("period_ns", "joints", "version")}
    bare = Recording(Log(recording.ticks, metadata, {}, False), recording.file)
    made = Served(server, [bare], fake_page(server))
    try:
        assert made.replay._stages == []
        made.page.set(made.control("time (s)"), 6.0)
        assert wait_until(lambda: "6.000 s, number" in made.replay._status.content)
    finally:
        made.stop()
