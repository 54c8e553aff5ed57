"""Many flights in a few numbers, and those flights on threads: in the order of the seeds, the same as alone, breakages as rows."""

import json

import pytest

from armland.experiments.campaign.engine import campaign
from armland.experiments.campaign.summary import FIGURES, summarise, value


def timeless(row):
    return {k: v for k, v in row.items() if k not in ("wall_s", "real_time_factor")}


def test_rows_are_those_of_flights_alone_in_the_order_of_the_seeds(landing_scenario, landed):
    rows = campaign(landing_scenario, "landing", (2, 1), jobs=2)
    assert [row["seed"] for row in rows] == [2, 1]
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


BOUNDS = {"touchdown.speed_mps": 0.15, "touchdown.offset_m": 0.01, "hinge_force_max_n": 106.0}


def row(seed, speed=0.02, success=True, reason="landed", **more):
    return {
        "seed": seed,
        "success": success,
        "reason": reason,
        "phases": [{"name": "done", "start_s": 0.0, "end_s": 17.0}],
        "retries": 0,
        "touchdown": {"speed_mps": speed, "tilt_deg": 0.2, "offset_m": 0.002},
        "hinge_force_max_n": 27.0,
        "limits_violated": [],
        **more,
    }


def spread(summary, name):
    (found,) = (s for s in summary.spreads if s.name.startswith(name))
    return found


def test_counts_and_interval():
    rows = [row(i) for i in range(8)] + [row(8, success=False, reason="lost"), row(9, retries=2)]
    summary = summarise(rows, BOUNDS)
    assert (summary.flights, summary.successes, summary.retries) == (10, 9, 2)
    assert summary.reasons == {"lost": 1}
    # Wilson's interval of 9 in 10, worked by hand: (p + z²/2n ± z √(p(1−p)/n + z²/4n²)) / (1 + z²/n).
    assert summary.interval == pytest.approx((0.5958, 0.9821), abs=1e-3)


def test_worst_flight_is_named_and_its_bound_can_fail():
    summary = summarise([row(1), row(2, speed=0.2), row(3)], BOUNDS)
    worst = spread(summary, "touchdown speed")
    assert (worst.worst, worst.worst_seed, worst.median) == (0.2, 2, 0.02)
    assert not worst.holds
    off = spread(summary, "off centre")
    assert (off.worst, off.bound, off.holds) == (2.0, 10.0, True)
    assert not spread(summarise([row(1)], {"hinge_force_max_n": 20.0}), "hinge force max").holds


def test_a_flight_that_broke_counts_as_failed_and_has_no_figures():
    broken = {"seed": 3, "success": False, "reason": "RuntimeError: out of luck"}
    summary = summarise([row(1), broken], BOUNDS)
    assert (summary.successes, summary.reasons) == (1, {"RuntimeError: out of luck": 1})
    assert all(value(broken, figure) is None for figure in FIGURES)
    assert not any(s.name.startswith("release") for s in summary.spreads)


def test_limits_are_counted_by_flight():
    rows = [row(1, limits_violated=["torque_rate"]), row(2, limits_violated=["torque_rate", "singularity"])]
    assert summarise(rows, {}).violated == {"torque_rate": 2, "singularity": 1}


def test_result_is_plain_data():
    assert json.loads(json.dumps(summarise([row(1)], BOUNDS).result()))["spreads"][0]["worst_seed"] == 1
