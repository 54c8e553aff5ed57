"""Merit of a flight, shortened reasons, rows of flights that did not come about, work over threads."""

import pytest

from armland.experiments.margins import flights
from armland.experiments.margins.flights import FAILED, NOT_FLOWN, flown, merit, on_threads, shortened

BOUNDS = {"touchdown.speed_mps": 0.15, "touchdown.offset_m": 0.01, "hinge_force_max_n": 100.0, "rest.touching": 0.0}


def result(**more):
    flight = {"success": True, "state": "standing", "retries": 0, "hinge_force_max_n": 30.0}
    return {**flight, "touchdown": {"speed_mps": 0.03, "offset_m": 0.002}, "rest": {"touching": 0}, **more}


def test_merit_is_the_largest_figure_over_its_bound():
    assert merit(result(), BOUNDS, 3) == pytest.approx(0.3)
    assert merit(result(touchdown={"speed_mps": 0.12, "offset_m": 0.002}), BOUNDS, 3) == pytest.approx(0.8)
    assert merit(result(touchdown={"speed_mps": 0.03, "offset_m": 0.009}), BOUNDS, 3) == pytest.approx(0.9)
    assert merit(result(retries=2), BOUNDS, 3) == pytest.approx(2 / 3)


def test_failure_is_twice_the_bound_and_what_was_not_flown_has_no_merit():
    assert merit(result(success=False), BOUNDS, 3) == FAILED
    assert merit(result(hinge_force_max_n=1e4), BOUNDS, 3) == FAILED
    assert merit(result(success=False, state=NOT_FLOWN), BOUNDS, 3) is None


def test_reason_is_cut_at_its_first_cause_and_at_a_word():
    assert shortened("too fast: 0.2 m/s; then it fell") == "too fast: 0.2 m/s"
    long = shortened("word " * 50)
    assert long.endswith("word …")
    assert len(long) <= 102


def test_device_that_cannot_be_simulated_is_a_row_and_not_a_failed_flight(landing_scenario):
    fast = landing_scenario.replaced({"camera": {"rate_hz": 50}})
    row = flown(fast, "landing", 1, {"deviation": {"camera": {"delay_ms": [400.0, 400.0]}}})
    assert (row["success"], row["state"]) == (False, NOT_FLOWN)
    assert "deviation.camera.delay_ms" in row["reason"]


def test_flight_that_breaks_is_a_row(landing_scenario, monkeypatch):
    def breaks(*_):
        raise ZeroDivisionError("x")

    monkeypatch.setattr(flights, "fly", breaks)
    row = flown(landing_scenario, "landing", 4, {})
    assert (row["seed"], row["success"], row["reason"]) == (4, False, "broke: ZeroDivisionError: x")


def test_threads_keep_the_order_and_count():
    told = []
    assert on_threads(lambda x: x * x, range(20), 4, told.append) == [x * x for x in range(20)]
    assert told == list(range(1, 21))
    with pytest.raises(ZeroDivisionError):
        on_threads(lambda x: 1 // x, [1, 0, 1], 1, lambda _: None)
