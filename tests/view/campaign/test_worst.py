"""Strips of the worst flights: flown again, drawn, or with words where they cannot be."""

import base64
import io
import json

import numpy as np
import pytest
from PIL import Image

from armland.errors import ConfigurationError, PictureError
from armland.experiments.campaign.answers.report import report
from armland.experiments.campaign.crews.threads import threads
from armland.experiments.campaign.description import Description
from armland.experiments.campaign.engine import Campaign, conduct
from armland.experiments.campaign.rows import Job
from armland.experiments.campaign.store import Store
from armland.scenario.files.loading import load_scenario
from armland.view.campaign import worst as module
from armland.view.campaign.page import page
from armland.view.campaign.worst import MOST, SIZE_PX, Strip, strips


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    """A store of two short flights, its report and its table."""
    file = tmp_path_factory.mktemp("flown") / "a.sqlite"
    scenario = load_scenario("landing", {"run": {"duration_s": 1.2}})
    campaign = Campaign(Description(), Job(scenario.frozen(), "landing"), 2, {})
    with Store(file, write=True) as store:
        conduct(campaign, store, threads(1))
        return file, *report(store)


def drawn(flown, tmp_path, told=lambda *_: None):
    file, said, _ = flown
    with Store(file) as store:
        return strips(store, said, tmp_path / "a.mcap", told)


def test_each_of_the_worst_has_a_strip_of_its_last_phases(flown, tmp_path):
    told = []
    made = drawn(flown, tmp_path, lambda *done: told.append(done))
    assert made.keys() == {w.run for w in flown[1].worst}
    assert told == [(1, 2), (2, 2)]
    assert list(tmp_path.iterdir()) == []
    for strip in made.values():
        if strip.words:
            assert "There are no pictures" in strip.words
            pytest.skip("no OpenGL here")
        assert 1 <= len(strip.pictures) <= MOST
        times = [p.time_s for p in strip.pictures]
        assert times == sorted(times)
        assert times[-1] == pytest.approx(1.2)
        image = Image.open(io.BytesIO(base64.b64decode(strip.pictures[-1].source.partition(",")[2])))
        assert image.size == SIZE_PX
        assert np.asarray(image).std() > 10.0
    first, second = (strip.pictures[-1].source for strip in made.values())
    assert first != second


def test_page_shows_strips_beside_the_command(flown, tmp_path):
    file, said, table = flown
    strip = Strip((module.Picture("guide", 0.6, "data:image/jpeg;base64,AAAA"),), "Flown again with other versions.")
    text = page(said, table, file, {said.worst[0].run: strip})
    assert '<img alt="guide at 0.6 s" src="data:image/jpeg;base64,AAAA">' in text
    assert text.count('<div class="strip">') == 1
    assert "Flown again with other versions." in text


def test_where_no_picture_can_be_drawn_the_page_says_so_of_all(flown, tmp_path, monkeypatch):
    asked = []

    def refuse(*_):
        asked.append(1)
        raise PictureError("no OpenGL; install libegl1")

    monkeypatch.setattr(module, "stills", refuse)
    made = drawn(flown, tmp_path)
    assert len(asked) == 1
    assert {s.words for s in made.values()} == {"There are no pictures: no OpenGL; install libegl1."}
    file, said, table = flown
    text = page(said, table, file, made)
    assert text.count("install libegl1") == len(said.worst)
    assert "armland campaign replay" in text


def test_what_came_to_no_flight_says_why_and_the_others_are_drawn(flown, tmp_path, monkeypatch):
    _, said, _ = flown
    first, fly = said.worst[0].run, module.replay

    def one_refused(store, run, log):
        if run == first:
            raise ConfigurationError("too heavy")
        return fly(store, run, log)

    monkeypatch.setattr(module, "replay", one_refused)
    monkeypatch.setattr(module, "stills", lambda *_: iter([]))
    made = drawn(flown, tmp_path)
    assert made[first].words == "There are no pictures, for it came to no flight: too heavy"
    assert [s.words for run, s in made.items() if run != first] == [""]


def test_flight_of_another_version_is_shown_with_a_warning(flown, tmp_path, monkeypatch):
    file, _, _ = flown
    monkeypatch.setattr(module, "stills", lambda *_: iter([]))
    with Store(file, write=True) as store:
        kept = store._base.execute("SELECT hash, text FROM texts").fetchall()
        other = json.dumps({**json.loads(kept[0][1]), "mujoco": "9.9"})
        store._base.execute("UPDATE texts SET text = ?", (other,))
        store._base.execute("UPDATE runs SET digest = 'x' WHERE run = 1")
    try:
        made = drawn(flown, tmp_path)
    finally:
        with Store(file, write=True) as store:
            store._base.execute("UPDATE texts SET text = ?", (kept[0][1],))
    assert made[0].words == ""
    assert "Flown again with other versions (mujoco 9.9 there" in made[1].words
