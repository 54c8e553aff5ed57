"""What a campaign says, from rows that are made up."""

import json

import numpy as np
import pytest
from scipy.stats import binomtest

from armland.experiments.campaign.answers.report import mapped, names_of, point_names, report
from armland.experiments.campaign.crews.threads import threads
from armland.experiments.campaign.engine import conduct
from armland.experiments.campaign.store import Store

SWEPT = "[parameters]\nair.wind_mps = {sweep = [0.0, 6.0]}\nuav.extra_mass_kg = {uniform = [0.0, 0.1]}\n"


@pytest.fixture
def reported(fakes, made_up, tmp_path):
    def make(runs, text="", work=fakes.quick, until=None):
        file = tmp_path / "a.sqlite"
        with Store(file, write=True) as store:
            conduct(made_up(runs, text), store, threads(2), until, work=work)
            return report(store)

    return make


def test_rates_have_wilsons_interval_and_that_of_all_looks(reported):
    found, _ = reported(70)
    (point,) = found.points
    assert (point.name, point.flights, point.successes) == ("all flights", 70, 60)
    wilson = binomtest(60, 70).proportion_ci(0.95, method="wilson")
    assert point.wilson == pytest.approx((wilson.low, wilson.high))
    assert point.always.low < point.wilson.low
    assert point.always.high > point.wilson.high
    assert (found.rows, found.planned, found.until) == (70, 70, None)


def test_figures_have_quantiles_and_the_worst_with_its_row_and_bound(reported):
    found, _ = reported(70)
    (force,) = [f for f in found.points[0].figures if f.figure == "hinge_force_max_n"]
    assert force.quantiles == pytest.approx(np.quantile(np.arange(70.0), (0.05, 0.5, 0.95, 0.99)))
    assert (force.worst, force.worst_run, force.bound, force.flights) == (69.0, 69, 50.0, 70)


def test_points_are_named_by_what_differs_and_compared_with_the_first(reported):
    found, table = reported(30, SWEPT)
    assert [p.name for p in found.points] == ["air.wind_mps = 0", "air.wind_mps = 6"]
    (pairing,) = found.pairings
    assert (pairing.first, pairing.second, pairing.rate.pairs, pairing.rate.value) == (0, 1, 30, 0.0)
    assert mapped(found, table) == ("air.wind_mps", "uav.extra_mass_kg")


def test_variants_are_named_and_compared_with_the_first(reported, described):
    text = '[[variants]]\nname = "usual"\n[[variants]]\nname = "windy"\nvalues.air.wind_mps = 6.0\n'
    found, _ = reported(14, text)
    assert [p.name for p in found.points] == ["usual", "windy"]
    assert [(p.first, p.second, p.rate.pairs) for p in found.pairings] == [(0, 1, 14)]
    swept = described(
        f"[parameters]\nair.wind_mps = {{sweep = [0.0, 6.0]}}\n{text.replace('values.air.wind_mps', 'values.uav.extra_mass_kg')}"
    )
    assert names_of(swept) == [
        "usual, air.wind_mps = 0",
        "usual, air.wind_mps = 6",
        "windy, air.wind_mps = 0",
        "windy, air.wind_mps = 6",
    ]


def test_worst_are_failed_flights_by_their_share_then_what_came_nearest(reported):
    found, _ = reported(28)
    failed = [w for w in found.worst if not w.success]
    assert [w.run for w in failed] == [24, 17, 10, 3]
    assert [w.run for w in found.worst[4:6]] == [27, 26]
    assert found.worst[4].share == pytest.approx(27.0 / 50.0)
    assert len(found.worst) == 10


def test_report_of_a_campaign_that_stops_early_says_so_and_is_plain_data(reported):
    found, _ = reported(3000, until=0.15)
    assert found.until == 0.15
    assert found.rows < 400
    data = json.loads(json.dumps(found.result()))
    assert data["points"][0]["flights"] == found.rows
    assert data["worst"][0]["run"] == found.worst[0].run
    assert {"versions", "sensitivity", "pairings", "reasons", "description"} <= data.keys()


def test_names_of_points():
    assert point_names([{}]) == ["all flights"]
    assert point_names([{"a.b": 1.23456, "c": "x"}, {"a.b": 2.0, "c": "x"}]) == ["a.b = 1.235", "a.b = 2"]
