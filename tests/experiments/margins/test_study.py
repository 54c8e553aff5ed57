"""The study: margins from made-up flights in their order, companions, shares, what is refused; one margin as flown."""

import json

import pytest

from armland.errors import ConfigurationError
from armland.experiments.margins import study as module
from armland.experiments.margins.corners import at, chosen, nested
from armland.experiments.margins.flights import NOT_FLOWN
from armland.experiments.margins.study import Terms, study


@pytest.fixture
def made_up(monkeypatch):
    """Flights that fail beyond limits of the deviations, given by path; those of `odd` seeds alone where the limit is negative."""
    seen = []

    def use(limits, state="lost", bad=()):
        def fake(scenario, mission, seed, changes):
            given = {
                f"{device}.{key}": spread["low"]
                for device, keys in changes.get("deviation", {}).items()
                for key, spread in keys.items()
            }
            seen.append((seed, given, scenario.deviation.level))
            beyond = [p for p, v in given.items() if p in limits and abs(v) > limits[p]]
            success = not beyond and seed not in bad
            return {"seed": seed, "success": success, "state": state, "reason": "; ".join(["too much", *beyond])}

        monkeypatch.setattr(module, "flown", fake)
        return seen

    return use


def test_margins_are_found_and_the_narrowest_stands_first(landing_scenario, made_up):
    made_up({"uav.mass": 0.2, "link.loss": 0.02, "air.wind_mps": 1.5})
    found = study(landing_scenario, chosen("uav.mass,uav.drag,link.loss,air.wind_mps"), Terms(jobs=1), pairs=False)
    assert [m.row.path for m in found.margins] == ["link.loss", "air.wind_mps", "uav.mass", "uav.drag"]
    for m, limit in zip(found.margins[:3], (0.02 / 0.05, 1.5, 0.2 / 0.07), strict=True):
        assert m.lands <= limit < m.fails
    drag = found.margins[3]
    # 0.3 is published, and no drag is less than none.
    assert (drag.fails, drag.lands) == (None, pytest.approx(1.0 / 0.3))
    assert (found.holds, found.margins[0].holds, found.margins[1].holds) == (False, False, True)
    assert json.loads(json.dumps(found.result()))["margins"][0]["failure"]["reason"] == "too much"


def test_seeds_that_cannot_change_the_verdict_are_not_flown(landing_scenario, made_up):
    seen = made_up({"uav.mass": 0.0})
    study(landing_scenario, chosen("uav.mass"), Terms(jobs=1, seeds=5), pairs=False)
    assert len([1 for _, given, _ in seen if not given]) == 5
    assert len([1 for _, given, _ in seen if given]) == 6


def test_share_lets_some_seeds_fail(landing_scenario, made_up):
    made_up({"uav.mass": 0.2}, bad=(2,))
    with pytest.raises(ConfigurationError, match="seed 2: too much"):
        study(landing_scenario, chosen("uav.mass"), Terms(jobs=1), pairs=False)
    (found,) = study(landing_scenario, chosen("uav.mass"), Terms(jobs=1, share=0.6), pairs=False).margins
    assert found.lands <= 0.2 / 0.07 < found.fails


def test_row_that_does_nothing_alone_has_company_and_others_stand_around(landing_scenario, made_up):
    seen = made_up({})
    study(landing_scenario, chosen("link.burst"), Terms(jobs=1, seeds=1, around="mild"), pairs=False)
    assert {level for _, _, level in seen} == {"mild"}
    assert [given for _, given, _ in seen][1] == {"link.loss": 0.05, "link.burst": 0.5}


def test_device_that_cannot_be_simulated_ends_the_search_without_a_failure(landing_scenario, made_up):
    made_up({"link.up_ms": 60.0}, state=NOT_FLOWN)
    (found,) = study(landing_scenario, chosen("link.up_ms"), Terms(jobs=1, seeds=1), pairs=False).margins
    assert 1.0 < found.lands <= 2.4
    assert found.fails is None
    assert found.data()["failure"]["flown"] is False


PLACED_M = 0.015
"""How far beside the cradle's middle a UAV may stand; it misses by a millimetre or two where the cradle is not off."""


def test_cradle_beside_its_place_is_a_failure_as_flown(landing_scenario):
    (row,), terms = chosen("cradle.place_m"), Terms(seeds=1)

    def off(metres):
        return module.first_failure(landing_scenario, (1,), terms, lambda seed: nested([at(row, metres / 0.003, seed)]))

    # At the ends of the range x and y are off alike.
    assert off(0.5 * PLACED_M / 2**0.5) is None
    failure = off(1.5 * PLACED_M / 2**0.5)
    assert (failure.seed, failure.flown) == (1, True)


@pytest.mark.slow
def test_margin_of_the_cradle_s_place_as_flown(landing_scenario):
    (found,) = study(landing_scenario, chosen("cradle.place_m"), Terms(jobs=1, seeds=2), pairs=False).margins
    low, high = (0.003 * k for k in (found.lands, found.fails))
    # Beyond what is allowed plus what is missed anyway it must fail; what the touch itself does not bear ends it earlier.
    assert 0.003 < low < high < (PLACED_M + 0.002) / 2**0.5
