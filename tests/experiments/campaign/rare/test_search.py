"""A rare campaign over a store: the rate of a known tail, stopped anywhere and gone on with, refused where it is none."""

import pytest
from scipy.stats import norm

from armland.errors import ConfigurationError
from armland.experiments.campaign.crews.processes import processes
from armland.experiments.campaign.crews.threads import threads
from armland.experiments.campaign.engine import conduct
from armland.experiments.campaign.rare.answer import rare_report
from armland.experiments.campaign.rare.search import Search, conduct_rare
from armland.experiments.campaign.store import Store

P = 1e-5
STUDY = f"""
[parameters]
a = {{normal = [10.0, 2.0]}}
b = {{uniform = [0.0, 1.0]}}
c = {{choice = ["x", "y"]}}

[failure]
figure = "hinge_force_max_n"
above = {10.0 + 2.0 * norm.isf(P)}
stage = 50
"""


@pytest.fixture
def rare(made_up):
    return lambda runs, text=STUDY: made_up(runs, text)._replace(rare=True)


def flown(campaign, file, work, crew=None, **more):
    with Store(file, write=True) as store:
        return conduct_rare(campaign, store, crew or threads(2), work=work, **more)


def stored(file):
    with Store(file) as store:
        return [row._replace(wall_s=0.0, cpu_s=0.0) for row in store.rows()]


def test_rate_of_a_known_tail_is_found_by_few_flights(fakes, rare, tmp_path):
    campaign, file = rare(1200), tmp_path / "a.sqlite"
    search = flown(campaign, file, fakes.tailed)
    assert search.next.learnt
    with Store(file) as store:
        found = rare_report(campaign, store)
    assert found.rate.interval.low <= P <= found.rate.interval.high
    assert found.rate.deviation < 0.2
    assert found.flights == 1200
    assert sum(s.flights for s in found.stages) + found.rate.flights == 1200
    assert found.gain > 1000.0
    assert (found.doubt, found.failure) == ("", "hinge force max above 18.5298 N")
    # Failures are where `a` is large; the rest is as drawn.
    places = {p.name: p for p in found.places}
    assert places["a"].failing[0] > 18.5
    assert places["b"].failing == pytest.approx(places["b"].all, abs=0.15)
    assert places.keys() == {"a", "b"}


class Enough(Exception):
    pass


@pytest.mark.parametrize("after", [1, 49, 50, 51, 170, 399])
def test_stopped_anywhere_and_resumed_equals_unbroken(fakes, rare, tmp_path, after):
    campaign, told = rare(400), []

    def tell(row):
        told.append(row)
        if len(told) == after:
            raise Enough

    with pytest.raises(Enough):
        flown(campaign, tmp_path / "a.sqlite", fakes.tailed, told=tell)
    assert len(stored(tmp_path / "a.sqlite")) == after
    flown(campaign, tmp_path / "a.sqlite", fakes.tailed)
    flown(campaign, tmp_path / "b.sqlite", fakes.tailed, threads(1))
    rows = stored(tmp_path / "a.sqlite")
    assert rows == stored(tmp_path / "b.sqlite")
    assert [row.run for row in rows] == list(range(400))
    assert [row.seed for row in rows] == list(range(400))


def test_processes_give_the_same_store_and_a_store_may_grow(fakes, rare, tmp_path):
    flown(rare(200), tmp_path / "a.sqlite", fakes.tailed, processes(2))
    few = stored(tmp_path / "a.sqlite")
    flown(rare(600), tmp_path / "a.sqlite", fakes.tailed)
    flown(rare(600), tmp_path / "b.sqlite", fakes.tailed)
    assert stored(tmp_path / "a.sqlite") == stored(tmp_path / "b.sqlite")
    assert stored(tmp_path / "a.sqlite")[:200] == few


def test_rows_that_do_not_belong_together_are_refused(fakes, rare, tmp_path):
    campaign, file = rare(300), tmp_path / "a.sqlite"
    flown(campaign, file, fakes.tailed)
    with Store(file, write=True) as store:
        store._base.execute("UPDATE runs SET result = replace(result, 'n\": 1', 'n\": 3') WHERE run < 50")
        with pytest.raises(ConfigurationError, match="row 50 is none that the rows before it lead to"):
            rare_report(campaign, store)


BAD = {
    "points": ("[parameters]\na = {sweep = [1.0, 2.0]}\nb = {uniform = [0.0, 1.0]}\n", 400, "the file has 2 points"),
    "nothing drawn": ("[parameters]\na = {fixed = 1.0}\n", 400, "has none"),
    "a design": ('design = "sobol"\n' + STUDY, 400, "'sobol' does not work, 'random' does"),
    "too few": (STUDY, 99, "--runs 99: with --rare 100 to"),
}


@pytest.mark.parametrize(("text", "runs", "words"), BAD.values(), ids=BAD)
def test_what_cannot_be_flown_so_is_refused(rare, text, runs, words):
    with pytest.raises(ConfigurationError, match=words):
        Search(rare(runs, text))


def test_rare_and_plain_rows_do_not_mix(fakes, rare, tmp_path):
    flown(rare(200), tmp_path / "a.sqlite", fakes.tailed)
    with (
        Store(tmp_path / "a.sqlite", write=True) as store,
        pytest.raises(ConfigurationError, match="was flown with --rare, not without"),
    ):
        conduct(rare(200)._replace(rare=False), store, threads(1), work=fakes.tailed)
    with Store(tmp_path / "b.sqlite", write=True) as store:
        conduct(rare(200)._replace(rare=False), store, threads(1), work=fakes.tailed)
        with pytest.raises(ConfigurationError, match="was flown without --rare, not with"):
            conduct_rare(rare(200), store, threads(1), work=fakes.tailed)
