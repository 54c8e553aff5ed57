"""Campaigns over threads: rows in the order of the seeds, the same as flights alone, and breakages as rows."""

import pytest

from armland.experiments.campaign import campaign


def timeless(row):
    return {k: v for k, v in row.items() if k not in ("wall_s", "real_time_factor")}


def test_rows_are_those_of_flights_alone_in_the_order_of_the_seeds(landing_scenario, landed):
    told = []
    rows = campaign(landing_scenario, "landing", (2, 1), jobs=2, done=told.append)
    assert [row["seed"] for row in rows] == [2, 1]
    assert told == rows
    assert timeless(rows[1]) == timeless(landed.result)
    assert rows[0]["touchdown"] != rows[1]["touchdown"]


def test_flights_that_break_are_rows(landing_scenario):
    rows = campaign(landing_scenario, "landing", range(3), law="no_such_law")
    assert [(row["seed"], row["success"]) for row in rows] == [(0, False), (1, False), (2, False)]


@pytest.mark.slow
@pytest.mark.parametrize("mission", ["landing", "takeoff"])
def test_seeds_succeed(landing_scenario, mission):
    rows = campaign(landing_scenario, mission, range(100, 112))
    assert [(row["seed"], row["reason"]) for row in rows if not row["success"]] == []
    assert len({round(row["phases"][1]["end_s"], 3) for row in rows}) > 5 or mission == "takeoff"
