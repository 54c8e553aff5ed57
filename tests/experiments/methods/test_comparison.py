"""Methods side by side, on rows made by hand: rates, pairs, quantiles worked on paper."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.experiments.campaign.rows import Row
from armland.experiments.campaign.store import Store
from armland.experiments.methods.comparison import (
    as_data,
    campaign_of_method,
    flights_of,
    paired,
    quantiles,
    rate,
)
from armland.experiments.methods.table import METHODS, method_named
from armland.mission.registry import mission_named
from armland.scenario import load_scenario

LIMITS = {"touchdown.speed_mps": 0.25, "touchdown.offset_m": 0.3}


def row(run, success=True, state="standing", speed=0.1, offset=0.02, seed=None):
    touchdown = {"speed_mps": speed, "tilt_deg": 1.0, "offset_m": offset}
    reason = "landed" if success else f"speed of the pivot: {speed} m/s"
    result = {"state": state, "reason": reason, "touchdown": touchdown, "success": success}
    return Row(run, 0, 100 + run if seed is None else seed, {}, success, "done", result)


@pytest.fixture
def stored(tmp_path):
    def made(name, rows):
        with Store(tmp_path / f"{name}.sqlite", write=True) as store:
            store.describe({"runs": len(rows)})
            for one in rows:
                store.add(one, "{}")
            return flights_of(store, name, LIMITS)

    return made


def test_columns_are_by_seed_whatever_the_order_of_the_rows(stored):
    m = stored("a", [row(2, speed=0.3, success=False), row(0, speed=0.1), row(1, speed=0.2)])
    np.testing.assert_array_equal(m.seed, [100, 101, 102])
    np.testing.assert_allclose(m.figures["touchdown.speed_mps"], [0.1, 0.2, 0.3])
    np.testing.assert_array_equal(m.success, [True, True, False])


def test_to_stand_is_to_stand_where_it_should(stored):
    m = stored("a", [row(0, success=False), row(1, offset=0.5, success=False), row(2, state="lost", success=False)])
    np.testing.assert_array_equal(m.stands, [True, False, False])
    np.testing.assert_array_equal(m.lost, [False, False, True])


def test_a_flight_that_broke_counts_against_its_method(stored):
    broke = Row(1, 0, 101, {}, False, "broke", None, error="PlantError: not finite")
    m = stored("a", [row(0), broke])
    assert rate(m.success)[:2] == (1, 2)
    assert np.isnan(m.figures["touchdown.speed_mps"][1])
    assert not m.stands[1]


def test_wilsons_interval():
    # 8 of 10, by Wilson's formula on paper with z = 1.96.
    r = rate(np.array([True] * 8 + [False] * 2))
    assert (r.low, r.high) == (pytest.approx(0.4902, abs=2e-4), pytest.approx(0.9433, abs=2e-4))


def test_quantiles_leave_out_what_never_touched_down():
    assert quantiles(np.array([1.0, 2.0, 3.0, np.nan])) == pytest.approx((2.0, 2.9))
    assert all(np.isnan(quantiles(np.array([np.nan]))))


def test_pairs_are_by_seed(stored):
    a = stored("a", [row(k, success=k != 5) for k in range(8)])
    b = stored("b", [row(k, success=k == 5) for k in range(3, 8)])
    p = paired(a, b)
    # Seeds 103 to 107: a fails at 105 alone, b succeeds there alone.
    assert (p.only_first, p.only_second, p.difference.pairs) == (4, 1, 5)
    assert p.difference.value == pytest.approx(-0.6)
    # Five fair coins with one head or fewer, or four and more: 2 (1 + 5)/32.
    assert p.chance == pytest.approx(0.375)


def test_equal_methods_do_not_differ(stored):
    a, b = (stored(n, [row(k) for k in range(20)]) for n in "ab")
    p = paired(a, b)
    assert (p.difference.value, p.chance) == (0.0, 1.0)
    assert p.difference.low < 0.0 < p.difference.high


def test_without_a_seed_in_common_there_is_no_comparison(stored):
    with pytest.raises(ConfigurationError, match="different seeds"):
        paired(stored("a", [row(0)]), stored("b", [row(1)]))


def test_an_empty_store_is_refused(tmp_path):
    with Store(tmp_path / "a.sqlite", write=True) as store, pytest.raises(ConfigurationError, match="no rows yet"):
        flights_of(store, "a", LIMITS)


def test_data_holds_all_that_is_shown(stored):
    a = stored("a", [row(k) for k in range(4)])
    b = stored("b", [row(k, success=False, speed=0.4) for k in range(4)])
    data = as_data([a, b])
    assert [m["name"] for m in data["methods"]] == ["a", "b"]
    assert data["methods"][1]["reasons"] == {"speed of the pivot": 4}
    assert data["methods"][1]["figures"]["touchdown.speed_mps"]["0.5"] == 0.4
    assert {(p["of"], p["only_first"]) for p in data["paired"]} == {("success", 4), ("stands", 0)}


@pytest.mark.parametrize("name", METHODS)
def test_each_method_is_a_mission_with_a_scenario(name):
    method = METHODS[name]
    assert mission_named(method.mission).name == method.mission
    load_scenario(method.scenario, method.overrides)


def test_unknown_method_names_those_that_are():
    with pytest.raises(ConfigurationError, match="'parachute' is unknown; known are arm, arm-paper, unassisted"):
        method_named("parachute")


def test_campaign_of_a_method_has_its_criteria_as_bounds():
    scenario = load_scenario("unassisted")
    campaign = campaign_of_method(METHODS["unassisted"], "unassisted", scenario, 5, 40)
    assert campaign.bounds["touchdown.offset_m"] == 0.3
    assert [t.seed for t in campaign.schedule.tasks()] == [40, 41, 42, 43, 44]
