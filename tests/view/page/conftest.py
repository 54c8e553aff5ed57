"""Pages of real flights, and what a browser or a reader would find in them."""

import re
from html.parser import HTMLParser
from typing import NamedTuple

import pytest

from armland.view.page.flight import flight_sheet
from armland.view.page.sheet import html
from armland.view.report import result_of

VOID = ("meta", "img", "br", "link", "input")


class Found(NamedTuple):
    """A page taken apart."""

    text: str
    tags: list[tuple[str, dict[str, str]]]
    ids: list[str]
    open: list[str]


class _Reader(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.words, self.tags, self.stack = [], [], []

    def handle_starttag(self, tag, attrs) -> None:
        self.tags.append((tag, {k: v or "" for k, v in attrs}))
        if tag not in VOID:
            self.stack.append(tag)

    def handle_startendtag(self, tag, attrs) -> None:
        self.tags.append((tag, {k: v or "" for k, v in attrs}))

    def handle_endtag(self, tag) -> None:
        assert self.stack[-1] == tag, (tag, self.stack[-3:])
        self.stack.pop()

    def handle_data(self, data) -> None:
        if self.stack[-1:] != ["style"]:
            self.words.append(data)


@pytest.fixture(scope="session")
def taken_apart():
    def take(page: str) -> Found:
        reader = _Reader()
        reader.feed(page)
        text = re.sub(r"\s+", " ", " ".join(reader.words))
        return Found(text, reader.tags, [a["id"] for _, a in reader.tags if "id" in a], reader.stack)

    return take


@pytest.fixture(scope="session")
def landing_page(landing_log) -> str:
    return html(flight_sheet(landing_log, result_of([landing_log]), pictures=False))


@pytest.fixture(scope="session")
def failed_log(log_of):
    """A landing in which a rotor fails while the arm carries the UAV, in a plant that differs and a belief that is wrong."""
    from armland.experiments.episode import fly
    from armland.scenario import load_scenario

    changes = {
        "faults": [{"kind": "rotor_loss", "phase": "carry"}],
        "deviation": {"level": "published"},
        "belief": {"uav": {"mass_kg": 0.5}},
    }
    return log_of(fly(load_scenario("landing", changes), "landing", seed=4))
