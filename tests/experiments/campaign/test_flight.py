"""Rows of true flights: the same as the flight alone, and what breaks is a row with its error."""

import json

import numpy as np
import pytest

from armland.experiments.campaign import flight as module
from armland.experiments.campaign.flight import attempt, digest_of, fingerprint, flown, prepared
from armland.experiments.campaign.rows import BROKE, REFUSED, Job, Task
from armland.experiments.episode import fly
from armland.scenario import Scenario, load_scenario


@pytest.fixture(scope="module")
def short():
    return load_scenario("landing", {"run": {"duration_s": 1.5}, "deviation": {"level": "published"}})


@pytest.fixture(scope="module")
def job(short):
    return Job(short.frozen(), "landing")


def test_row_is_the_flight_alone(short, job):
    values = {"air.wind_mps": 2.5, "place.start_speed_mps": 0.1}
    row, episode = flown(job, Task(3, 0, 11, values))
    changed = short.replaced({"air": {"wind_mps": 2.5}, "place": {"start_speed_mps": 0.1}})
    alone = fly(changed, "landing", 11)
    assert row.digest == digest_of(alone.ticks) == digest_of(episode.ticks)
    assert (row.run, row.seed, row.values, row.outcome) == (3, 11, values, alone.result["end"])
    assert {k: v for k, v in row.result.items() if k not in ("wall_s", "real_time_factor")} == {
        k: v for k, v in alone.result.items() if k not in ("wall_s", "real_time_factor")
    }
    assert json.loads(json.dumps(row.result)) == row.result
    assert row.cpu_s > 0.0


def test_digest_sees_one_bit(short):
    ticks = fly(short, "landing", 2).ticks
    other = ticks.copy()
    other["truth"]["r"][700, 2] = np.nextafter(other["truth"]["r"][700, 2], 2.0)
    assert digest_of(ticks) == digest_of(ticks.copy())
    assert digest_of(ticks) != digest_of(other)


def test_plan_is_made_anew_unless_values_come_again_and_gives_the_same_flight(job, monkeypatch):
    module._memory.plans.clear()
    first = [attempt(job, Task(k, 0, 5, {"air.wind_mps": 3.0})).digest for k in range(3)]
    assert len(set(first)) == 1
    assert first[0]
    assert [p is not None for p in module._memory.plans.values()] == [True]
    attempt(job, Task(4, 0, 5, {"air.wind_mps": 3.2}))
    assert [p is not None for p in module._memory.plans.values()] == [True, False]
    monkeypatch.setattr(module, "KEPT_PLANS", 2)
    prepared(job, Task(5, 0, 5, {"air.wind_mps": 3.4}))
    assert len(module._memory.plans) == 2


def test_what_is_refused_or_breaks_is_a_row(job, monkeypatch):
    row = attempt(job, Task(1, 0, 4, {"air.wind_mps": 90.0}))
    assert (row.success, row.outcome, row.result, row.digest) == (False, REFUSED, None, "")
    assert "air.wind_mps: 90.0 lies outside" in row.error
    assert row.judged()["reason"].startswith("refused: ")
    monkeypatch.setattr(module, "fly_prepared", lambda *_: 1 / 0)
    row = attempt(job, Task(1, 0, 4, {}))
    assert (row.success, row.outcome, row.error) == (False, BROKE, "ZeroDivisionError: division by zero")


def test_scenario_is_the_same_after_it_was_kept(short):
    kept = Scenario.thawed(short.frozen())
    assert kept == short
    assert (kept.own, kept.asked, kept.settled, kept.text) == (short.own, short.asked, short.settled, short.text)
    assert fingerprint(kept) == fingerprint(short)
    assert fingerprint(short) != fingerprint(short.with_seed(99))
