"""What a rare campaign says while it learns, where nothing fails, and where seeds decide; and what a plain one counts."""

import json

import pytest
from scipy.stats import binomtest, norm

from armland.experiments.campaign.answers.report import report
from armland.experiments.campaign.crews.threads import threads
from armland.experiments.campaign.engine import conduct
from armland.experiments.campaign.rare.search import conduct_rare
from armland.experiments.campaign.store import Store

STUDY = """
[parameters]
a = {normal = [10.0, 2.0]}

[failure]
figure = "hinge_force_max_n"
above = ABOVE
stage = 20
"""


@pytest.fixture
def said(fakes, made_up, tmp_path):
    """The report of a campaign that fails above a value of `a`."""

    def make(runs, above, work=fakes.tailed, text=STUDY, rare=True):
        campaign = made_up(runs, text.replace("ABOVE", str(above)))._replace(rare=rare)
        with Store(tmp_path / "a.sqlite", write=True) as store:
            (conduct_rare if rare else conduct)(campaign, store, threads(2), work=work)
            return report(store)[0]

    return make


def test_while_it_learns_there_is_no_rate(said):
    found = said(50, 24.0).rare
    assert (found.rate, found.gain, [s.flights for s in found.stages]) == (None, 0.0, [20, 20, 10])
    assert "still learnt" in found.doubt
    assert found.stages[0].level < 0.0


def test_what_never_fails_has_an_upper_bound(said):
    found = said(600, 1e6).rare
    assert found.rate.value == 0.0
    assert 0.0 < found.rate.interval.high < 0.25
    assert "only an upper bound" in found.doubt
    assert json.loads(json.dumps(found.result()))["rate"]["deviation"] is None


def test_where_seeds_decide_it_says_that_plain_flights_do_as_well(said, fakes):
    text = STUDY.replace("[parameters]", "[parameters]\nb = {uniform = [0.0, 1.0]}")
    found = said(1500, 87.5, fakes.lucky, text).rare
    assert found.rate.interval.low <= 0.125 <= found.rate.interval.high
    assert "plain flights, without --rare, would have done as well" in found.doubt


def test_report_of_a_rare_campaign_has_no_rates_of_how_it_was_drawn(said):
    found = said(400, 10.0 + 2.0 * norm.isf(1e-3))
    assert (found.points, found.pairings, found.sensitivity.single, found.counted) == ((), (), (), ())
    assert found.rare.rate.failed > 0
    # The worst are those with the largest figure.
    worst = [w.values["a"] for w in found.worst]
    assert worst == sorted(worst, reverse=True)
    assert worst[0] > 10.0 + 2.0 * norm.isf(1e-3)
    assert json.loads(json.dumps(found.result()))["rare"]["flights"] == 400


def test_plain_campaign_counts_the_failure_of_its_file(said):
    found = said(500, 10.0 + 2.0 * norm.isf(0.1), rare=False)
    (counted,) = found.counted
    assert found.rare is None
    wilson = binomtest(counted.failed, 500).proportion_ci(0.95, method="wilson")
    assert (counted.flights, *counted.wilson) == (500, wilson.low, wilson.high)
    assert counted.wilson.low < 0.1 < counted.wilson.high
