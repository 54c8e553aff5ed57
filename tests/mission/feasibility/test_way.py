"""The poses of a whole landing, null space sunk: they are those that are flown, and what is too near on them is refused."""

import numpy as np
import pytest

from armland.errors import WorkspaceError
from armland.experiments.episode import fly_prepared, prepare
from armland.mission.feasibility.obstacles import Obstacles
from armland.mission.feasibility.way import AT_ONCE, WAYS, check_clear, drawn, sinking, stops
from armland.models.nearby import body_of, sink
from armland.scenario import load_scenario


def whole(plan, **overrides):
    scenario = load_scenario("landing", overrides).believed() if overrides else plan.scenario
    place, up = scenario.place, np.array([0.0, 0.0, 1.0])
    catch, put = np.array(place.catch_m), np.array(place.put_down_m)
    points = [catch - place.wait_below_m * up, catch, put + place.above_m * up, put, put - place.withdraw_m * up]
    around = Obstacles(scenario)
    around.put_cradle(put, scenario.cradle.heading_deg)
    return scenario, stops(np.array(points), scenario, "air"), around


def test_uav_is_on_the_arm_except_above_it_at_its_station_and_on_the_cradle(landing_plan):
    scenario, way, _ = whole(landing_plan)
    np.testing.assert_allclose(way[0].pivot, scenario.place.catch_m)
    np.testing.assert_allclose(way[2].pivot, way[2].point)
    np.testing.assert_allclose(way[4].pivot, scenario.place.put_down_m)
    far, low = np.array([s.pivot for s in way[5:]]) - scenario.place.catch_m, way[0].point
    np.testing.assert_allclose(np.ptp(far, axis=0), [0.12, 0.10, 0.15], atol=1e-9)
    # Sideways ends are checked on the straight way up to them, the others alone.
    sideways = [s for s in way[5:] if abs(s.pivot[2] - scenario.place.catch_m[2]) < 1e-9]
    shares = [np.linalg.norm(s.point - low) / np.linalg.norm(s.pivot - low) for s in sideways]
    np.testing.assert_allclose(shares, 4 * [0.25, 0.5, 0.75, 1.0])
    for s in sideways:
        np.testing.assert_allclose(np.cross(s.point - low, s.pivot - low), 0.0, atol=1e-12)
    assert len(way) == 5 + len(sideways) + 2


def test_wrist_that_meets_the_rails_on_the_way_to_where_it_is_clear_is_refused(landing_plan):
    """Between narrow rails the last link but one is in the way 0.06 m below the catch, where none of the ends of the box is."""
    scenario, way, around = whole(landing_plan, cradle={"gap_m": 0.2}, arm={"width_m": 0.04})
    with pytest.raises(WorkspaceError, match=r"at \(0\.62, -0\.04, 0\.80\) m link_6 comes within"):
        check_clear(landing_plan.arm, landing_plan.home, way, scenario, around)


def test_way_of_the_landing_is_clear(landing_plan):
    scenario, way, around = whole(landing_plan)
    assert check_clear(landing_plan.arm, landing_plan.home, way, scenario, around) > 0.0


def test_arm_is_flown_as_its_null_space_is_expected_to_sink(landing_plan, landed):
    """At the end of the phase in which the arm waits, in the joints of the measurement."""
    scenario, way, _ = whole(landing_plan)
    q, arm = landing_plan.home.copy(), landing_plan.arm
    assert sink(body_of(arm), q, way[0].point, sinking(arm, scenario), AT_ONCE)
    ticks = landed.ticks
    last = np.flatnonzero(ticks["mission"]["phase"] == landing_plan.number("guide"))[-1]
    flown = ticks["measurement"]["q"][last]
    # Dry friction of the joints holds the last of it.
    np.testing.assert_allclose(flown, q, atol=0.15)


def test_arm_that_holds_its_posture_is_flown_as_it_is_expected():
    """At the end, away from where the posture was, with links of wrong weights; a free null space ends half a radian off."""
    apart = {}
    for rate in (6.0, 0.0):
        scenario = load_scenario("landing", {"control": {"posture_rad_s": rate}, "deviation": {"level": "published"}})
        ready = prepare(scenario, "landing", 4)
        arm, q, ticks = ready.plan.arm, ready.plan.home.copy(), fly_prepared(ready).ticks
        held = drawn(sinking(arm, scenario), arm, scenario.replaced({"control": {"posture_rad_s": 6.0}}), q)
        assert sink(body_of(arm), q, ticks["estimate"]["r"][-1], held, AT_ONCE)
        apart[rate] = np.abs(ticks["measurement"]["q"][-1] - q).max()
    assert apart[6.0] < 0.1
    assert apart[0.0] > 0.3


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        ({"cradle": {"gap_m": 0.2}, "arm": {"width_m": 0.06}}, r"comes within -?\d+ mm of the cradle; \d+ mm are kept"),
        (
            {"limits": {"sigma_min": 0.2}},
            r"near a singularity: smallest singular value 0\.\d+; a plan leaves 1\.2 times",
        ),
        ({"limits": {"joint_margin_rad": 0.6}}, r"joint \w+ sinks to 0\.\d+ rad from its range's end"),
    ],
)
def test_what_is_too_near_on_the_way_is_refused(landing_plan, overrides, words):
    scenario, way, around = whole(landing_plan, **overrides)
    with pytest.raises(WorkspaceError, match=words):
        check_clear(landing_plan.arm, landing_plan.home, way, scenario, around)


def test_way_is_followed_with_the_null_space_held_by_friction_too(landing_plan, monkeypatch):
    """An elbow that begins high passes the rails too near, though it would be clear once it has sunk."""
    scenario, way, around = whole(landing_plan)
    arm, high = landing_plan.arm, landing_plan.home.copy()
    body, how = body_of(arm), sinking(arm, scenario)
    assert sink(body, high, way[0].point, how._replace(pull=-how.pull), AT_ONCE)
    with pytest.raises(WorkspaceError, match="its null space held by friction"):
        check_clear(arm, high, way, scenario, around)
    monkeypatch.delitem(WAYS, ", its null space held by friction")
    assert check_clear(arm, high, way, scenario, around) >= 0.0
