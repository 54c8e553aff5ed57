"""Places over a grid in front of an arm: reached, upright, in front, the same again, and nearer where nearness counts."""

from pathlib import Path

import numpy as np
import pytest

from armland.mission.belief import flyer
from armland.mission.feasibility import places as grid
from armland.mission.feasibility.obstacles import Obstacles
from armland.mission.feasibility.places import Bench, Place, places
from armland.models.parameters import arm_model
from armland.scenario import load_scenario

ROOT = Path(__file__).parents[3]

EVERYTHING: frozenset[str] = frozenset()


def bench(nearness=0.5, **overrides):
    scenario = load_scenario("landing", overrides).believed()
    return Bench(arm_model(scenario), scenario, flyer(scenario).weight, Obstacles(scenario), nearness)


@pytest.fixture(scope="module")
def found():
    return next(places(bench(), EVERYTHING))


def test_places_lie_ahead_within_reach_and_hold_the_arm_upright_below_the_catch(found):
    arm, scenario = bench().arm, load_scenario("landing")
    assert len(found) > 5
    for place in found:
        arm.update(place.home, np.zeros(7))
        below = place.catch - [0.0, 0.0, scenario.place.wait_below_m]
        np.testing.assert_allclose(arm.position, below, atol=2e-4)
        np.testing.assert_allclose(arm.rotation, np.eye(3), atol=1e-3)
        assert place.catch[0] > 0.1
        assert (place.home > arm.q_min).all()
        assert (place.home < arm.q_max).all()


def test_cradle_is_where_it_was_from_the_catch(found):
    scenario = load_scenario("landing").place
    apart = np.array(scenario.put_down_m) - scenario.catch_m
    for place in found:
        np.testing.assert_allclose(place.put_down - place.catch, apart, atol=1e-9)


def test_places_are_told_by_falling_merit_and_are_the_same_again(found):
    merits = [p.merit for p in found]
    assert merits == sorted(merits, reverse=True)
    again = next(places(bench(), EVERYTHING))
    np.testing.assert_array_equal([p.catch for p in again], [p.catch for p in found])


def test_arm_that_reaches_no_centre_begins_from_poses_that_it_can_take(monkeypatch):
    monkeypatch.setattr(grid, "CENTRES", ((5.0, 5.0),))
    assert next(places(bench(), EVERYTHING))
    monkeypatch.setattr(grid, "_scattered", lambda search: [])
    assert not next(places(bench(), EVERYTHING))


def counted(monkeypatch, same_rad):
    """Places of an arm of six joints, and how many poses were measured to find them."""
    calls, measure = [], grid._merit

    def counting(*args):
        calls.append(1)
        return measure(*args)

    monkeypatch.setattr(grid, "_merit", counting)
    monkeypatch.setattr(grid, "SAME_RAD", same_rad)
    found = grid.everywhere(bench(arm={"file": str(ROOT / "examples" / "six_axis.urdf")}))
    monkeypatch.setattr(grid, "_merit", measure)
    return [(p.catch.tolist(), p.home.tolist()) for p in found], len(calls)


@pytest.mark.slow
def test_branches_that_meet_are_not_measured_twice_and_the_places_are_the_same(monkeypatch):
    once, few = counted(monkeypatch, grid.SAME_RAD)
    every, many = counted(monkeypatch, 0.0)
    assert once == every
    assert once
    assert few < 0.8 * many


def test_the_best_is_nearer_where_nearness_counts_for_more(found):
    def far(place):
        return np.linalg.norm(place.catch - load_scenario("landing").place.catch_m)

    near = next(places(bench(nearness=20.0), EVERYTHING))
    assert far(near[0]) <= far(found[0])
    assert far(near[0]) < 0.1


def test_what_is_kept_does_not_move():
    for keep in ("catch", "put_down"):
        kept = next(places(bench(), frozenset({keep})))
        assert [p.catch.tolist() for p in kept] == [pytest.approx([0.62, 0.0, 0.86])]


@pytest.mark.slow
def test_an_arm_too_weak_has_no_place():
    weak = bench(arm={"torque_limits_nm": [2.0] * 7})
    assert [p for some in places(weak, EVERYTHING) for p in some] == []


def test_place_becomes_a_scenario():
    place = Place(np.array([0.5, 0.1, 0.9]), np.array([0.56, 0.1, 0.74]), 180.0, np.full(7, 0.1), 1.0)
    made = place.of(load_scenario("landing"))
    assert made.place.catch_m == (0.5, 0.1, 0.9)
    assert made.place.put_down_m == (0.56, 0.1, 0.74)
    assert made.cradle.heading_deg == 180.0
    np.testing.assert_allclose(np.deg2rad(made.place.home_deg), 0.1, atol=1e-4)
