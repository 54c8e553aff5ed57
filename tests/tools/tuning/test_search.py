"""The optimiser of the methods: finds what is best, keeps its budget, on flights made by hand."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.experiments.methods.table import METHODS
from armland.scenario import load_scenario
from tuning.search import FALLEN, cost, draw, near, tune

BOUNDS = {"touchdown.speed_mps": 0.25, "touchdown.tilt_deg": 5.0}
SPACE = {"descent.sink_mps": (0.05, 0.4), "descent.cut_m": (0.0, 0.05)}


def result(success=False, state="standing", speed=0.2, tilt=2.0):
    return {"success": success, "state": state, "touchdown": {"speed_mps": speed, "tilt_deg": tilt}}


@pytest.mark.parametrize(
    ("flight", "expected"),
    [
        (result(success=True, speed=0.24), 0.0),
        (result(state="lost"), FALLEN),
        (result(state="flying"), FALLEN),
        (result(speed=0.375, tilt=2.0), 1.5),
        (result(speed=0.3, tilt=6.0), 1.4),
        (result(speed=9.0, tilt=90.0), 2.0),
        ({"success": False, "state": "standing", "touchdown": None}, 2.0),
    ],
)
def test_cost_of_a_flight(flight, expected):
    assert cost(flight, BOUNDS) == pytest.approx(expected)


def test_settings_fill_their_space_and_repeat():
    drawn = draw(SPACE, 50, 7)
    assert drawn == draw(SPACE, 50, 7)
    assert drawn != draw(SPACE, 50, 8)
    for path, (low, high) in SPACE.items():
        values = np.array([d[path] for d in drawn])
        assert (values >= low).all()
        assert (values <= high).all()
        # One in each fiftieth of the range, but for rounding.
        assert len(np.unique(np.floor(50.0 * (values - low) / (high - low) + 1e-6))) > 40


def test_box_about_the_best_lies_in_the_space():
    box = near(SPACE, {"descent.sink_mps": 0.06, "descent.cut_m": 0.025})
    assert box["descent.sink_mps"][0] == 0.05
    assert box["descent.sink_mps"][1] == pytest.approx(0.06 + 0.35 / 6.0)
    assert box["descent.cut_m"] == pytest.approx((0.025 - 0.05 / 6.0, 0.025 + 0.05 / 6.0))
    for path, ends in near(SPACE, {}).items():
        assert ends == pytest.approx(SPACE[path])


@pytest.fixture(scope="module")
def unassisted():
    return load_scenario("unassisted")


def test_the_best_is_found_and_every_candidate_costs_as_much(unassisted):
    flown = []

    def fly(scenario, method, seed):
        flown.append(seed)
        # A slow descent succeeds; each seed has luck of its own.
        lucky = (seed * 7919) % 100 / 100.0
        return result(success=scenario.descent.sink_mps < 0.12 + 0.05 * lucky, speed=scenario.descent.sink_mps)

    seeds, number = range(10), 20
    trials = tune(METHODS["unassisted"], SPACE, [unassisted], seeds, draw(SPACE, number, 1), BOUNDS, fly)
    assert trials[0].settings["descent.sink_mps"] < 0.17
    assert trials[0].cost <= trials[-1].cost
    assert all(t.flights == len(seeds) for t in trials)
    # Four seeds for each and for the scenario as it stands, six more for a quarter of them.
    assert len(flown) == 4 * (number + 1) + 6 * ((number + 1) // 4)


def test_the_scenario_as_it_stands_is_tried_as_well(unassisted):
    seen = []
    tune(METHODS["unassisted"], SPACE, [unassisted], [1], [], BOUNDS, lambda s, m, k: seen.append(s) or result())
    assert seen == [unassisted]


def test_settings_that_the_scenario_refuses_are_no_candidates(unassisted):
    space = {"descent.ready_m": (0.1, 0.9)}
    bad = {"descent.ready_m": 0.8}
    trials = tune(METHODS["unassisted"], space, [unassisted], [1, 2], [bad], BOUNDS, lambda s, m, k: result())
    assert all(t.settings != bad for t in trials)


def test_settings_outside_the_space_are_refused(unassisted):
    with pytest.raises(ConfigurationError, match=r"descent\.sink_mps = 0\.9 lies outside the space, 0\.05 to 0\.4"):
        tune(METHODS["unassisted"], SPACE, [unassisted], [1], [{"descent.sink_mps": 0.9}], BOUNDS)
