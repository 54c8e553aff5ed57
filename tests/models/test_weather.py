"""The wind that a user foretells, held against the plant's own air, and what it changes before anything moves."""

import numpy as np
import pytest

from armland.mission.missions.landing import LANDING
from armland.mission.missions.weather import judged, weathered
from armland.models.airframe.sizing import sized
from armland.models.parameters import plate_mass, uav_parameters
from armland.models.weather import MOST_RAD, expected, started, swayed
from armland.plant.wind.dryden import intensities
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


def test_uav_that_waits_in_wind_is_guided_from_the_first_sight_on():
    first, second, *_ = LANDING.phases(landing(4.0).believed())
    assert (first.name, first.uav, first.guards[0].target) == ("find", "autonomous", "self_test")
    assert (second.name, second.uav, second.seeks) == ("self_test", "station", True)


@pytest.mark.parametrize("wind", [0.0, 4.0])
def test_uav_waits_higher_above_a_deck_that_moves(wind):
    """By what a hull rises before it is guided, 0.4 m/s for half a second; what the user has set stays."""
    still, moves = (sized(landing(wind, forecast={"wind_mps": wind, "deck_moves": moves})) for moves in (False, True))
    assert moves.place.start_above_m - still.place.start_above_m == pytest.approx(0.2)
    own = landing(wind, forecast={"wind_mps": wind, "deck_moves": True}, place={"start_above_m": 0.3})
    assert sized(own).place.start_above_m == 0.3
