"""A row flown again is the same bit for bit, and one that is not is told from it."""

import sqlite3

import pytest

from armland.errors import ConfigurationError
from armland.experiments.campaign.crews.threads import threads
from armland.experiments.campaign.engine import Campaign, conduct
from armland.experiments.campaign.replay import replay
from armland.experiments.campaign.rows import Job
from armland.experiments.campaign.store import Store
from armland.runtime.log import read_log
from armland.scenario import load_scenario


@pytest.fixture
def store(described, tmp_path):
    scenario = load_scenario("landing", {"run": {"duration_s": 1.2}})
    campaign = Campaign(
        described("[parameters]\nair.wind_mps = {sweep = [3.0, 90.0]}"),
        Job(scenario.frozen(), "landing"),
        1,
        {},
    )
    with Store(tmp_path / "a.sqlite", write=True) as store:
        conduct(campaign, store, threads(2))
        yield store


def test_row_is_the_same_bit_for_bit_with_its_log(store, tmp_path):
    flown = [row for row in store.rows() if row.digest]
    assert len(flown) == 1
    again = replay(store, flown[0].run, tmp_path / "run.mcap")
    assert again.same
    assert again.changed == ()
    assert again.again.result["reason"] == flown[0].result["reason"]
    assert len(read_log(tmp_path / "run.mcap").messages["truth"]) == len(again.episode.ticks)


def test_row_that_was_refused_is_refused_again(store):
    (refused, *_) = [row for row in store.rows() if not row.digest]
    with pytest.raises(ConfigurationError, match=r"air\.wind_mps: 90.0 lies outside"):
        replay(store, refused.run)


def test_another_digest_or_version_is_told(store):
    run = next(row.run for row in store.rows() if row.digest)
    with sqlite3.connect(store.file) as base:
        base.execute("UPDATE runs SET digest = 'x' WHERE run = ?", (run,))
        base.execute('UPDATE texts SET text = replace(text, \'"numba": "\', \'"numba": "9.\')')
    again = replay(store, run)
    assert not again.same
    assert len(again.changed) == 1
    assert again.changed[0].startswith("numba 9.")
