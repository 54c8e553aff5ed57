"""The screening design as flown: levels of rows, a planted pair found through made-up flights, the worst corner."""

import numpy as np
import pytest

from armland.experiments.margins import screening
from armland.experiments.margins.effects import Effect
from armland.experiments.margins.screening import level, listed, screened
from armland.experiments.paper import silent
from armland.scenario.deviation import rows

ROWS = {row.path: row for row in rows()}
CHOSEN = [ROWS[p] for p in ("uav.mass", "uav.thrust", "link.loss", "air.wind_mps", "uav.rotor", "arm.inertia")]


def at_level(path, high, seed=1):
    (spread,) = level(ROWS[path], high, 2.0, seed).values()
    return spread["low"], spread["high"]


def test_levels_are_ends_of_one_number_of_two_signs_and_else_absent_and_there():
    assert (at_level("uav.mass", False), at_level("uav.mass", True)) == ((-0.14, -0.14), (0.14, 0.14))
    assert (at_level("air.wind_mps", False), at_level("air.wind_mps", True)) == ((0.0, 0.0), (2.0, 2.0))
    assert (at_level("uav.rotor", False), at_level("uav.rotor", True)) == ((0.0, 0.0), (-0.08, 0.08))


def flies_by(figure):
    """Flights whose hinge force, over its bound, is `figure` of the deviations."""

    def fake(scenario, mission, seed, changes):
        high = {
            f"{device}.{key}": spread["high"]
            for device, keys in changes["deviation"].items()
            for key, spread in keys.items()
        }
        share = figure(high, np.random.default_rng(seed))
        return {"seed": seed, "success": share < 1.0, "state": "standing", "hinge_force_max_n": 106.2 * share}

    return fake


def test_planted_single_and_pair_are_found_by_name(landing_scenario, monkeypatch):
    def figure(high, random):
        heavy_and_weak = high["uav.mass"] > 0.0 and high["uav.thrust"] < 0.0
        return 0.3 + 0.2 * (high["air.wind_mps"] > 0.0) + 0.3 * heavy_and_weak + 0.02 * random.standard_normal()

    monkeypatch.setattr(screening, "flown", flies_by(figure))
    told = []
    found = screened(landing_scenario, "landing", CHOSEN, 1.0, 2, lambda *done: told.append(done))
    assert (found.flights, found.landed, told[-1]) == (24, 24, ("pairs", 24, 24))
    wind, pair = found.singles[0], found.pairs[0]
    assert {s.rows for s in found.singles if s.clear} == {("air.wind_mps",), ("uav.mass",), ("uav.thrust",)}
    assert [s.worst_at for s in found.singles if s.rows == ("air.wind_mps",)] == [("there",)]
    assert wind.size == pytest.approx(0.2, abs=0.04)
    assert [p.rows for p in found.pairs if p.clear] == [("uav.mass", "uav.thrust")]
    assert (pair.worst_at, pair.clear) == (("high", "low"), True)
    # Of 0.3 where both are at their worst, half a difference of differences is 0.15.
    assert pair.size == pytest.approx(-0.15, abs=0.04)


def test_in_noise_no_pair_is_found(landing_scenario, monkeypatch):
    monkeypatch.setattr(screening, "flown", flies_by(lambda high, random: 0.5 + 0.1 * random.uniform(-1.0, 1.0)))
    found = screened(landing_scenario, "landing", CHOSEN, 1.0, 1, silent)
    assert not any(e.clear for e in (*found.singles, *found.pairs))


def test_worst_corner_weighs_single_effects_and_pair():
    pair = Effect((0, 2), 0.2, 0.01, True)
    assert listed(pair, {(0,): 0.0, (2,): 0.1}, CHOSEN).worst_at == ("high", "there")
    assert listed(pair, {(0,): -0.1, (2,): -0.05}, CHOSEN).worst_at == ("low", "absent")
    assert listed(pair._replace(size=-0.2), {(0,): 0.1, (2,): 0.0}, CHOSEN).worst_at == ("high", "absent")
