"""The wind that a user foretells, held against the plant's own air, and what it changes before anything moves."""

import numpy as np
import pytest

from armland.experiments.episode import fly
from armland.mission.missions.landing import LANDING
from armland.mission.missions.weather import MOST_CARRIED, judged, weathered
from armland.mission.registry import MISSIONS
from armland.models.airframe.sizing import sized
from armland.models.parameters import plate_mass, rotor_set, uav_parameters
from armland.models.weather import (
    HEIGHT_M,
    MOST_RAD,
    POSTURE_RAD_S,
    SPARE_RAD,
    expected,
    most_lean,
    started,
    swayed,
)
from armland.plant.wind.dryden import intensities, lengths
from armland.plant.wind.profile import height_of_catch, speed_at
from armland.scenario import load_scenario


def landing(w20, **changes):
    """A landing of which the user foretells `w20`, m/s; the air itself is as `changes` say."""
    return load_scenario("landing", {"forecast": {"wind_mps": w20}, **changes})


def mass_of(scenario):
    return uav_parameters(scenario).mass + plate_mass(scenario)


@pytest.mark.parametrize("w20", [2.0, 8.0, 12.0])
def test_wind_at_the_catch_is_the_one_that_the_plant_makes_of_the_same_wind(w20):
    blown = load_scenario("landing", {"air": {"wind_mps": w20, "turbulence": "by_wind"}})
    wind, height = expected(blown), height_of_catch(blown)
    assert wind.mean == pytest.approx(speed_at(blown, height), rel=1e-9)
    np.testing.assert_allclose([wind.sigma, wind.sigma, wind.sinking], intensities(w20, height), rtol=2e-3)


def test_controller_is_told_the_speed_alone_and_what_the_user_foretells_before_what_the_air_does():
    air = {"wind_mps": 6.0, "turbulence": "by_wind", "towards_deg": 50.0}
    believed = load_scenario("landing", {"air": air}).believed()
    assert believed.foretold_mps == 6.0
    assert believed.air == load_scenario("landing").air
    assert load_scenario("landing", {"air": air, "forecast": {"wind_mps": 2.0}}).believed().foretold_mps == 2.0


def test_lean_balances_drag_and_weight():
    scenario = landing(8.0)
    mass, wind = mass_of(scenario), expected(scenario)
    drag, weight = scenario.uav.drag_nspm * wind.gust(2.0), mass * 9.81
    lean = wind.lean(scenario.uav.drag_nspm / weight, 2.0)
    # A thrust along the leaning axis whose vertical part is the weight has the drag as its horizontal part.
    assert weight / np.cos(lean) * np.sin(lean) == pytest.approx(drag)


def test_uav_that_a_gust_takes_along_is_under_control_at_the_speed_that_its_own_hover_stops():
    """Its drag in the gust, of two standard deviations, over the damping of its own hover; the lean is that of three."""
    scenario = landing(8.0)
    mass, wind = mass_of(scenario), expected(scenario)
    lean, speed = swayed(scenario, mass)
    assert speed * scenario.onboard.hover.k_velocity * mass == pytest.approx(scenario.uav.drag_nspm * 2.0 * wind.sigma)
    assert np.tan(np.deg2rad(lean)) * mass * 9.81 == pytest.approx(scenario.uav.drag_nspm * wind.gust(3.0))


def test_calm_changes_nothing():
    scenario = landing(0.0)
    assert started(scenario, mass_of(scenario)) == {}
    believed = sized(scenario).believed()
    assert weathered(believed, mass_of(scenario)) is believed
    assert judged(LANDING, believed, 5.0) is LANDING
    assert swayed(scenario, mass_of(scenario)) == (0.0, 0.0)
    assert LANDING.phases(believed) == LANDING.phases(load_scenario("landing").believed())


def test_more_wind_asks_for_more_and_what_the_user_has_set_stays():
    def limits(scenario):
        made = weathered(sized(scenario).believed(), mass_of(scenario))
        return made.control.station.tilt_max_rad, made.bounds.align_tilt_deg, made.place.start_above_m

    weak, strong = limits(landing(4.0)), limits(landing(8.0))
    assert all(b > a for a, b in zip(weak, strong, strict=True))
    assert strong[0] <= MOST_RAD
    own = {"control": {"station": {"tilt_max_rad": 0.31}}, "bounds": {"align_tilt_deg": 11.0}}
    assert limits(landing(8.0, **own, place={"start_above_m": 0.25})) == (0.31, 11.0, 0.25)


@pytest.mark.parametrize(("w20", "seconds", "lasts"), [(0.1, 45.0, 300.0), (4.0, 45.0, 151.0), (0.1, 500.0, 500.0)])
def test_weak_wind_with_its_long_gusts_asks_for_no_longer_run_than_there_may_be(w20, seconds, lasts):
    scenario = landing(w20, run={"duration_s": seconds})
    wanted = started(scenario, mass_of(scenario))["run.duration_s"]
    assert scenario.replaced({"run": {"duration_s": wanted}}).run.duration_s == pytest.approx(lasts, abs=5.0)


def test_uav_that_waits_in_wind_is_guided_from_the_first_sight_on():
    first, second, *_ = LANDING.phases(landing(4.0).believed())
    assert (first.name, first.uav, first.guards[0].target) == ("find", "autonomous", "self_test")
    assert (second.name, second.uav, second.seeks) == ("self_test", "station", True)


def test_rotors_of_a_carried_uav_keep_what_its_heading_needs_beyond_what_holds_it_upright():
    """Drag at the centre of mass, hinge below it: the torque that a couple of rotors a reach apart holds against."""
    scenario = sized(landing(8.0)).believed()
    mass, wind, lever = mass_of(scenario), expected(scenario), abs(uav_parameters(scenario).lever[2])
    made = weathered(scenario, mass)
    share = made.control.thrust.carry_share - scenario.control.thrust.carry_share
    reach = np.abs(rotor_set(scenario).place[:, :2]).mean()
    assert share * mass * 9.81 * reach == pytest.approx(scenario.uav.drag_nspm * wind.gust(2.0) * lever)
    assert share > 0.1
    assert weathered(scenario, mass, lands=False).control.thrust == scenario.control.thrust
    strongest = weathered(sized(landing(12.0, uav={"drag_nspm": 0.4})).believed(), mass)
    assert strongest.control.thrust.carry_share == MOST_CARRIED < 1.0 - strongest.bounds.share_carried


def test_arm_yields_until_both_skids_of_a_leaning_uav_bear():
    scenario = sized(landing(8.0)).believed()
    made = weathered(scenario, mass_of(scenario)).control.approach.give_way_max_m
    assert made - scenario.control.approach.give_way_max_m == pytest.approx(0.15 * np.sin(np.deg2rad(5.0)))


def test_uav_out_of_view_is_looked_for_until_a_gust_has_passed():
    scenario = sized(landing(8.0)).believed()
    more = 1e-3 * (weathered(scenario, mass_of(scenario)).limits.search_ms - scenario.limits.search_ms)
    along, *_ = lengths(HEIGHT_M)
    assert more * expected(scenario).mean == pytest.approx(2.0 * along, rel=0.01)
    assert sized(landing(8.0)).run.duration_s > landing(8.0).run.duration_s + 2.0 * more
    phases = {p.name: p for p in LANDING.phases(scenario)}
    assert min(phases[name].timeout_s for name in ("find", "guide", "miss")) > more + 8.0


@pytest.mark.slow
@pytest.mark.parametrize(("share", "kept"), [(None, True), (0.5, False)])
def test_carried_uav_keeps_its_heading_in_gusts_by_that_thrust(share, kept):
    """Seed 73043, W20 of 8 m/s: with half of the weight on the rotors two of them stand still, and it turns by 40 degrees."""
    own = {} if share is None else {"control": {"thrust": {"carry_share": share}}}
    air = {"wind_mps": 8.0, "turbulence": "by_wind"}
    scenario = load_scenario("landing", {"deviation": {"level": "published"}, "air": air, **own})
    table = fly(scenario, "landing", 73043).table()
    turned = np.rad2deg(2.0 * np.arctan2(table["truth.quat.3"], table["truth.quat.0"]))
    standing = table["truth.cradle_force.2"] > 3.0
    assert (float(np.abs(turned[standing]).max()) < 3.0) is kept


@pytest.mark.parametrize("wind", [0.0, 4.0])
def test_uav_waits_higher_above_a_deck_that_moves(wind):
    """By what a hull rises before it is guided, 0.4 m/s for half a second; what the user has set stays."""
    still, moves = (sized(landing(wind, forecast={"wind_mps": wind, "deck_moves": moves})) for moves in (False, True))
    assert moves.place.start_above_m - still.place.start_above_m == pytest.approx(0.2)
    own = landing(wind, forecast={"wind_mps": wind, "deck_moves": True}, place={"start_above_m": 0.3})
    assert sized(own).place.start_above_m == 0.3


@pytest.mark.parametrize(("wind", "moves"), [(4.0, False), (0.0, True)])
def test_rough_weather_gives_room_below_the_catch_and_holds_pose_and_uav(wind, moves):
    rough = sized(landing(wind, forecast={"wind_mps": wind, "deck_moves": moves}))
    calm = sized(landing(0.0))
    room, before = (s.place.catch_m[2] - s.place.put_down_m[2] for s in (rough, calm))
    assert room == pytest.approx(0.33)
    assert before == pytest.approx(0.159)
    assert (rough.control.posture_rad_s, rough.place.keep_hold) == (POSTURE_RAD_S, True)
    assert (calm.control.posture_rad_s, calm.place.keep_hold) == (0.0, False)


@pytest.mark.parametrize("key", ["catch_m", "put_down_m"])
def test_one_place_that_the_user_has_set_keeps_both_where_they_are(key):
    own = {"catch_m": (0.62, 0.0, 0.85), "put_down_m": (0.68, 0.0, 0.70)}
    made = sized(landing(8.0, place={key: own[key], "keep_hold": False})).place
    usual = landing(0.0).place
    assert getattr(made, key) == own[key]
    other = next(k for k in own if k != key)
    assert getattr(made, other) == getattr(usual, other)
    assert not made.keep_hold


@pytest.mark.parametrize("w20", [2.0, 8.0, 14.0])
def test_uav_may_lean_as_far_as_the_strongest_gust_asks_of_more_drag_than_believed(w20):
    """No further than an autopilot is set to; it counts as out of control well beyond that, and its own hover leans as far."""
    made = sized(landing(w20))
    wind, slope = expected(made), made.uav.drag_nspm / (mass_of(made) * 9.81)
    lean = most_lean(wind, slope)
    gust = np.arctan(1.3 * slope * (wind.mean + 3.0 * wind.sigma))
    assert lean == pytest.approx(min(gust + SPARE_RAD, MOST_RAD))
    assert made.onboard.hover.tilt_max_rad == pytest.approx(max(0.4, lean))
    told = weathered(made.believed(), mass_of(made))
    assert told.control.station.tilt_max_rad >= lean
    assert told.limits.tilt_deg >= np.rad2deg(lean) + 5.0


def test_uav_that_is_kept_is_judged_without_being_let_go():
    rough, calm = (sized(landing(wind)).believed() for wind in (8.0, 0.0))
    assert judged(LANDING, rough, 5.0).judged_as == "kept"
    assert judged(LANDING, calm, 5.0).judged_as == "landing"
    assert judged(MISSIONS["takeoff"], rough, 5.0).judged_as == "takeoff"


def test_pad_of_a_uav_that_lands_by_itself_stays_where_it_is():
    pad = load_scenario("unassisted", {"air": {"wind_mps": 8.0}})
    assert sized(pad).place.put_down_m == pad.place.put_down_m
    assert sized(pad).place.catch_m == pad.place.catch_m
