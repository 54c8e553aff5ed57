"""The controls: what they hand on, and what is wrong with it, by a pilot that only listens."""

import pytest

from armland.console.live.choices import Choices
from armland.console.live.controls import AS_SCENARIO, SLIDERS, Controls
from armland.console.live.forecast import AT_ONCE
from armland.console.live.pace import FASTEST, Pace
from armland.errors import ConfigurationError
from armland.experiments.operator.message import RANGES, message_of


class Listener:
    """A pilot that flies nothing and keeps what it was told."""

    def __init__(self) -> None:
        self.pace, self.flying, self.flight, self.choices = Pace(1000), True, None, None
        self.told, self.started = [], []

    def tell(self, message) -> None:
        if not self.flying:
            raise ConfigurationError(f"{message.do}: nothing flies; press start")
        self.told.append(message)

    def start(self, choices, messages) -> None:
        self.started.append((choices, messages))
        self.choices = choices


class Page:
    def __init__(self, server, page, first=None) -> None:
        self.said, self.pilot, self.page, self.gui = [], Listener(), page, server.viser.gui
        self.controls = Controls(self.gui, self.pilot, first or Choices(), self.said.append)
        self.controls.build_rest()

    def set(self, label: str, value: object) -> None:
        handles = self.gui._gui_input_handle_from_uuid.values()
        self.page.set(next(h for h in handles if h.label == label), value)

    def press(self, label: str) -> None:
        commands = self.gui._command_handle_from_uuid.values()
        self.page.press(next(c for c in commands if c.label == label))


@pytest.fixture
def page(server, fake_page):
    return Page(server, fake_page(server))


def test_buttons_and_keys_hand_messages_on(page, wait_until) -> None:
    for button in ("hold", "go on", "abort"):
        page.set("flight", button)
    assert wait_until(lambda: len(page.pilot.told) == 3)
    assert sorted(m.do for m in page.pilot.told) == ["abort", "hold", "resume"]
    page.pilot.told.clear()
    page.press("hold, or go on")
    assert wait_until(lambda: [m.do for m in page.pilot.told] == ["hold"])
    page.press("abort")
    assert wait_until(lambda: [m.do for m in page.pilot.told] == ["hold", "abort"])


def test_space_goes_on_where_it_is_held(page, wait_until) -> None:
    class Held:
        done = (message_of({"do": "hold"}),)

    page.pilot.flight = Held()
    page.press("hold, or go on")
    assert wait_until(lambda: [m.do for m in page.pilot.told] == ["resume"])


def test_time_stands_still_steps_and_goes_on(page, wait_until) -> None:
    pace = page.pilot.pace
    page.set("time", "pause")
    assert wait_until(lambda: pace.paused)
    page.set("time", "run")
    assert wait_until(lambda: not pace.paused)
    page.set("time", "10 ticks")
    assert wait_until(lambda: pace.paused and pace.due(250) == 10)
    page.press("one tick")
    assert wait_until(lambda: pace.due(250) == 1)
    page.press("pause, or run")
    assert wait_until(lambda: not pace.paused)
    page.set("times real time", "1/8")
    assert wait_until(lambda: pace.factor == 1 / 8)
    page.set("times real time", FASTEST)
    assert wait_until(lambda: pace.factor == 0.0)


@pytest.mark.parametrize("verb", SLIDERS)
def test_a_slider_acts_at_once_within_the_range_of_its_message(page, wait_until, verb: str) -> None:
    label, low, high, _, _ = SLIDERS[verb]
    least, most, _ = RANGES[verb]
    assert least <= low < high <= most
    page.set(label, high)
    assert wait_until(lambda: [(m.do, m.value) for m in page.pilot.told] == [(verb, high)])


def test_a_slider_moved_while_nothing_flies_acts_from_the_next_flight_on(page, wait_until) -> None:
    page.pilot.flying = False
    for verb, value in (("noise", 2.0), ("wind", 3.0), ("sea", 0.5)):
        page.set(SLIDERS[verb][0], value)
    assert wait_until(lambda: len(page.said) == 3)
    assert page.said[0] == "noise: nothing flies; it acts from the next flight on"
    page.set("flight", "start")
    assert wait_until(lambda: len(page.pilot.started) == 1)
    choices, messages = page.pilot.started[0]
    # The wind is foretold to the next flight; a share of a calm sea is nothing.
    assert choices.wind == 3.0
    assert [(m.do, m.value) for m in messages] == [("noise", 2.0)]
    page.set("sea state", "2")
    page.press("start")
    assert wait_until(lambda: len(page.pilot.started) == 2)
    assert [(m.do, m.value) for m in page.pilot.started[1][1]] == [("sea", 0.5), ("noise", 2.0)]


def test_seeds(page, wait_until) -> None:
    page.set("seed", "retry")
    assert wait_until(lambda: len(page.pilot.started) == 1)
    page.set("seed", "next seed")
    assert wait_until(lambda: len(page.pilot.started) == 2)
    page.set("seed", "next seed")
    assert wait_until(lambda: len(page.pilot.started) == 3)
    page.set("seed", "retry")
    assert wait_until(lambda: len(page.pilot.started) == 4)
    assert [choices.seed for choices, _ in page.pilot.started] == [1, 2, 3, 3]


def test_choices_of_the_page_are_those_of_the_next_flight(page, wait_until) -> None:
    for label, value in (
        ("mission", "takeoff"),
        ("arm (file, name)", "mine.urdf"),
        ("tool frame", "tip"),
        ("UAV", "x500"),
        ("law", "exact"),
        ("sea state", "3"),
    ):
        page.set(label, value)
    want = Choices(mission="takeoff", arm="mine.urdf", ee="tip", uav="x500", law="exact", sea="3")
    assert wait_until(lambda: page.controls.choices() == want)
    page.set("UAV", AS_SCENARIO)
    assert wait_until(lambda: page.controls.choices().uav == "")


def test_what_was_chosen_on_the_command_line_is_chosen_at_first(server, fake_page) -> None:
    first = Choices(
        mission="E1", scenario="/my/own.toml", uav="/my/uav.toml", law="mine.py:law", sea="1", wind=4.0, seed=9
    )
    assert Page(server, fake_page(server), first).controls.choices() == first


def test_faults_are_thrown_in_at_once_or_for_a_phase(page, wait_until) -> None:
    noted, picked = [], []
    page.controls.thrown = lambda *cell: noted.append(cell)
    page.controls.picked = lambda: picked.append(page.controls.cell())
    page.set("throw it in", True)
    assert wait_until(lambda: len(noted) == 1)
    page.controls.offer(["guide", "carry"])
    page.set("phase", "carry")
    page.set("fault", "slip")
    assert wait_until(lambda: ("slip", "carry") in picked)
    page.set("throw it in", True)
    assert wait_until(lambda: len(noted) == 2)
    assert noted == [("uav_silent", AT_ONCE), ("slip", "carry")]
    assert [(m.fault.kind, m.fault.phase) for m in page.pilot.told] == [("link_loss", None), ("magnet_slip", "carry")]


def test_errors_stand_on_the_page(page, wait_until) -> None:
    page.pilot.flying = False
    page.set("flight", "abort")
    assert wait_until(lambda: page.said == ["abort: nothing flies; press start"])
    page.set("throw it in", True)
    assert wait_until(lambda: page.said[1:] == ["fault: nothing flies; press start"])
