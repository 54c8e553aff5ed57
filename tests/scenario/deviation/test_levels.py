"""What a level multiplies, what a range of its own replaces, and that the controller never learns of either."""

import json

import pytest

from armland.scenario import load_scenario
from armland.scenario.deviation import LEVELS, Deviation, ranges, rows

ROWS = {row.path: row.told for row in rows()}


def landing(**deviation):
    return load_scenario("landing", {"deviation": deviation})


def test_nominal_plant_is_what_the_controller_believes() -> None:
    assert ranges(Deviation()) == {}
    assert ranges(landing(level="nominal").deviation) == {}


@pytest.mark.parametrize(("level", "share"), [("mild", 0.5), ("published", 1.0), ("harsh", 2.0)])
def test_level_is_a_share_of_every_published_range_within_its_bound(level, share) -> None:
    found = ranges(landing(level=level).deviation)
    assert set(found) == set(ROWS)
    for path, spread in found.items():
        told = ROWS[path]
        assert spread.low == max(share * told.low, told.least), path
        assert spread.high == min(share * told.high, told.most), path
    assert LEVELS[level] == share


def test_twice_a_range_that_reaches_beyond_what_a_device_can_be_ends_there() -> None:
    """Losses in bursts: published up to 0.5, so twice that is 1, of which a chain would never leave its state."""
    assert ranges(landing(level="harsh").deviation)["link.burst"].high == 0.99


def test_range_of_its_own_replaces_the_levels() -> None:
    found = ranges(landing(level="published", uav={"mass": [0.1, 0.2], "thrust": 0.0}).deviation)
    assert (found["uav.mass"].low, found["uav.mass"].high) == (0.1, 0.2)
    # None at all is one, too.
    assert "uav.thrust" not in found
    assert set(found) == set(ROWS) - {"uav.thrust"}
    assert set(ranges(landing(uav={"mass": [0.1, 0.2]}).deviation)) == {"uav.mass"}


@pytest.mark.parametrize(("path", "told"), ROWS.items())
def test_published_range_holds_nothing_or_more_and_lies_within_its_bound(path, told) -> None:
    assert told.least <= told.low <= told.high <= told.most
    assert told.low < told.high
    assert told.size == "n" or int(told.size) >= 1


@pytest.mark.parametrize("row", list(rows()), ids=lambda row: row.path)
def test_source_or_assumption_stands_beside_every_range(row) -> None:
    assert "assumption" in row.meaning or "(" in row.meaning


def test_deviation_survives_another_seed_and_other_changes() -> None:
    scenario = landing(
        level="mild", uav={"mass": [0.1, 0.2]}, air={"wind_mps": {"low": 0.0, "high": 1.0, "normal": True}}
    )
    for after in (scenario.with_seed(7), scenario.replaced({"title": "other"}), scenario.replaced({"deviation": {}})):
        assert after.deviation == scenario.deviation
        assert ranges(after.deviation) == ranges(scenario.deviation)
    narrower = scenario.replaced({"deviation": {"uav": {"mass": 0.05}}}).deviation
    assert (narrower.uav.mass.low, narrower.uav.mass.high) == (-0.05, 0.05)
    assert narrower.air == scenario.deviation.air


def test_controller_never_learns_of_it() -> None:
    scenario = landing(level="harsh", uav={"mass": [0.2, 0.2]})
    nominal = landing(level="nominal")
    assert scenario.believed().deviation == Deviation()
    assert scenario.believed().model_dump_json() == nominal.believed().model_dump_json()
    assert json.loads(scenario.model_dump_json())["deviation"]["level"] == "harsh"
