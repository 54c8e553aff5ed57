"""The landing's phases in the order of their guards, and its retries."""

import pytest

from armland.mission.missions.landing import BLIND_S
from armland.mission.registry import MISSIONS
from armland.scenario import load_scenario

BLIND = ("approach", "align")
"""Phases in which the arm is near a UAV that must be in view."""


@pytest.fixture(scope="module")
def phases():
    return {p.name: p for p in MISSIONS["landing"].phases(load_scenario("landing"))}


def test_first_guards_lead_from_the_self_test_to_the_goal(phases):
    here, way = "self_test", []
    while not phases[here].final:
        way.append(here)
        here = next(g.target for g in phases[here].guards if g.target not in ("miss", "abort"))
    assert here == "done"
    assert way == [n for n in phases if n != "miss" and not phases[n].final]


def test_magnet_is_on_from_the_closing_to_the_release(phases):
    on = [n for n, p in phases.items() if p.magnet == "on" and not p.final]
    assert on == ["close", "capture", "hand_over", "carry", "set_down", "unload"]


def test_uav_may_touch_the_cradle_from_the_set_down_on(phases):
    assert [n for n, p in phases.items() if p.on_cradle and not p.final] == [
        "set_down",
        "unload",
        "release",
        "withdraw",
    ]
    assert phases["done"].on_cradle


def test_capture_that_is_missed_is_tried_again_until_it_has_been_too_often(phases):
    targets = [g.target for g in phases["miss"].guards]
    assert targets == ["abort", "guide"]
    assert phases["miss"].guards[0].conditions[0].threshold == "retries_allowed"


@pytest.mark.parametrize(
    ("sea", "told", "first"), [("ss2", None, "find"), ("calm", None, "self_test"), ("ss2", False, "self_test")]
)
def test_uav_is_guided_from_the_first_sight_on_where_the_deck_is_said_to_move(sea, told, first):
    believed = load_scenario("landing", {"sea": {"state": sea}, "forecast": {"deck_moves": told}}).believed()
    assert not believed.sea.moves
    found = {p.name: p for p in MISSIONS["landing"].phases(believed)}
    assert next(iter(found)) == first
    assert found["self_test"].uav == ("station" if first == "find" else "autonomous")


def test_arm_that_keeps_hold_neither_lets_go_nor_draws_back():
    """The magnet stays on to the end, and a hinge that the wind pushes at need not come free of force."""
    found = {p.name: p for p in MISSIONS["landing"].phases(load_scenario("landing", {"place": {"keep_hold": True}}))}
    assert not {"release", "withdraw"} & found.keys()
    (guard,) = found["unload"].guards
    assert guard.target == "done"
    assert "hinge_force" not in [c.signal for c in guard.conditions]
    done = found["done"]
    assert (done.magnet, done.arm, done.uav, done.final) == ("on", "hold", "off", True)


def test_in_rough_weather_the_arm_comes_to_a_uav_that_has_thrust_to_spare_and_draws_away_at_once():
    """In calm air it waits for no thrust, counts what it feels as a contact wherever the plate is reckoned, and goes back by a move."""
    rough = load_scenario("landing", {"air": {"wind_mps": 8.0}, "sea": {"state": "ss2"}}).believed()
    found, calm = (
        {p.name: p for p in MISSIONS["landing"].phases(s)} for s in (rough, load_scenario("landing").believed())
    )
    for phases, differs in ((found, True), (calm, False)):
        asks = {n: [c.signal for g in p.guards for c in g.conditions] for n, p in phases.items()}
        assert ("spare" in asks["guide"]) == differs
        assert ("relative_speed" in asks["approach"]) == differs
        assert ("gap" in asks["close"]) == differs
        assert (phases["miss"].arm, phases["guide"].arm) == (("flee", "move") if differs else ("move", "hold"))
    blind = {
        n: next(g for g in p.guards if g.conditions[0][:2] == ("uav_seen", "<")) for n, p in found.items() if n in BLIND
    }
    assert all(g.target == "miss" and g.hold_s == BLIND_S for g in blind.values())
    assert found["capture"].timeout_s > calm["capture"].timeout_s
    assert found["close"].duration_s < calm["close"].duration_s


def test_every_phase_of_rough_weather_leads_to_the_goal_by_its_guards():
    found = {
        p.name: p for p in MISSIONS["landing"].phases(load_scenario("landing", {"air": {"wind_mps": 8.0}}).believed())
    }
    here, way = "find", []
    while not found[here].final:
        way.append(here)
        here = next(g.target for g in found[here].guards if g.target not in ("miss", "abort"))
    assert here == "done"
    assert way == [n for n in found if n != "miss" and not found[n].final]
