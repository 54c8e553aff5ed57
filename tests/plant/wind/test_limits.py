"""Steady wind: what it asks of a hovering UAV, and which is refused."""

import re

import numpy as np
import pytest
from scipy.optimize import brentq

from armland.errors import ConfigurationError
from armland.mission.belief import rotors_of
from armland.models.inflow import sustained
from armland.plant.devices import rotors as device
from armland.plant.wind.limits import check_wind, holds_height_in, left_in_gust, lift_gain, steady_wind, told_gusts
from armland.plant.wind.profile import speed_at
from armland.plant.wind.timed import timed_wind

MASS = 0.48


def check(scenario, mass=MASS):
    check_wind(scenario, mass, timed_wind(scenario))


def trace(tmp_path, speed, up=0.0):
    file = tmp_path / "wind.csv"
    file.write_text("time_s,x,y,z\n" + "".join(f"{t},{0.6 * speed},{0.8 * speed},{up}\n" for t in range(60)))
    return str(file)


def test_steady_wind_is_the_mean_at_its_height_or_that_of_the_record(landing, tmp_path):
    s = landing(air={"wind_mps": 8.0, "towards_deg": 180.0})
    np.testing.assert_allclose(steady_wind(s, 1.0, timed_wind(s)), [-speed_at(s, 1.0), 0.0, 0.0], atol=1e-12)
    s = landing(air={"trace": trace(tmp_path, 5.0, up=0.7)})
    np.testing.assert_allclose(steady_wind(s, 1.0, timed_wind(s)), [3.0, 4.0, 0.0], atol=1e-9)


def test_what_is_refused_names_the_lean_and_a_wind_that_flies(landing):
    """0.22 N·s/m: tan 0.3 × 0.48 × 9.81 N are held at 6.62 m/s, where the UAV leans by the 0.3 rad that it may."""
    with pytest.raises(
        ConfigurationError, match=r"control.station.tilt_max_rad = 0.3; this UAV can fly in 6.62 m/s"
    ) as e:
        check(landing(air={"wind_mps": 14.0}))
    most = float(re.search(r"there, air.wind_mps = ([\d.]+)", str(e.value))[1])
    assert most == pytest.approx(
        14.0 * np.tan(0.3) * MASS * 9.81 / 0.22 / speed_at(landing(air={"wind_mps": 14.0}), 0.86), abs=0.1
    )
    check(landing(air={"wind_mps": most}))
    with pytest.raises(ConfigurationError):
        check(landing(air={"wind_mps": most + 0.2}))


def test_wind_that_a_mission_leans_against_is_flown_until_no_lean_holds_the_drag(landing):
    """14 m/s ask for 0.39 rad. 20.8 m/s blow at 12.5 m/s there, faster than the rotors move air through them at any lean."""
    air, own = {"wind_mps": 14.0}, {"hover": {"tilt_max_rad": 0.56}}
    s = landing(air=air, onboard=own)
    check_wind(s, MASS, timed_wind(s), 0.52)
    with pytest.raises(ConfigurationError, match=r"control.station.tilt_max_rad = 0.3;"):
        check(s)
    s = landing(air={"wind_mps": 20.8}, onboard=own)
    with pytest.raises(ConfigurationError, match=r"2\.\d\d N of drag at no lean; this UAV can fly in 1[12]\.\d\d m/s"):
        check_wind(s, MASS, timed_wind(s), 0.55)


def test_the_uavs_own_bound_counts_as_well(landing):
    s = landing(air={"wind_mps": 8.0}, onboard={"hover": {"tilt_max_rad": 0.15}})
    with pytest.raises(ConfigurationError, match=r"onboard.hover.tilt_max_rad = 0.15"):
        check(s)


def test_thrust_that_does_not_reach_is_refused(landing):
    """Leaning 0.2 rad a UAV of 4.71 N needs 4.80 N; without translational lift that is what its rotors have to give."""
    wind, rotors = {"wind_mps": 8.0}, {"inflow": False}
    check(landing(air=wind, rotors=rotors, onboard={"hover": {"thrust_max_n": 4.9}}))
    s = landing(air=wind, rotors=rotors, onboard={"hover": {"thrust_max_n": 4.75}})
    with pytest.raises(ConfigurationError, match=r"rotors carry 4\.6\d N of its 4\.71 N"):
        check(s)


def test_record_is_refused_by_its_mean(landing, tmp_path):
    check(landing(air={"trace": trace(tmp_path, 6.0)}))
    with pytest.raises(ConfigurationError, match=r"air.trace: 9.00 m/s .* on average"):
        check(landing(air={"trace": trace(tmp_path, 9.0)}))


def test_still_air_and_gusts_alone_are_never_refused(landing):
    check(landing(onboard={"hover": {"tilt_max_rad": 0.001}}))
    check(landing(air={"gusts": [{"at_s": 1.0, "peak_mps": 30.0, "length_m": 5.0}]}))


@pytest.mark.parametrize("speed", [2.0, 5.0])
def test_gain_in_wind_is_that_of_level_flight(landing, speed):
    """Who stands still in wind flies level through the air: the two solutions of momentum theory meet."""
    s, drag = landing(), 0.22
    own = rotors_of(s)._replace(static=5.0)
    weight = sustained(own, speed, drag)
    up = np.array([-drag * speed, 0.0, weight])
    pull = float(np.linalg.norm(up))
    told = np.zeros(1, device.told_layout(7))
    told["count"], told["inflow"], told["disc"] = own.number, 1, own.disc
    told["slope"], told["advance"] = own.slope, own.advance
    wind = np.array([speed, 0.0, 0.0])
    assert pull / lift_gain(told[0], pull, wind, up / pull) == pytest.approx(5.0, rel=1e-6)
    told["inflow"] = 0
    assert lift_gain(told[0], pull, wind, up / pull) == 1.0


def held(scenario, w20, gust, lean, thrust):
    """Forces along and up, N, on a UAV that leans in a gust, by (I.1) and (I.2) solved by SciPy, another way than `inflow` does."""
    own, mean = rotors_of(scenario), speed_at(scenario.replaced({"air": {"wind_mps": w20}}), scenario.place.catch_m[2])
    along, down, one = mean + 0.196 * w20 * gust, 0.1 * w20 * gust, thrust / own.number
    v_h = np.sqrt(one / own.disc)
    x, c = (along * np.cos(lean) - down * np.sin(lean)) / v_h, (along * np.sin(lean) + down * np.cos(lean)) / v_h
    most = 1.0 + own.slope * (1.0 - c) + own.advance * x * x

    def left(w):
        return w * np.hypot(x, w + c) - (most - own.slope * w)

    pull = thrust * (most - own.slope * brentq(left, 0.0, 10.0))
    drag = scenario.uav.drag_nspm
    return pull * np.sin(lean) - drag * along, pull * np.cos(lean) - drag * down - MASS * 9.81


@pytest.mark.parametrize(("gust", "most"), [(1.0, 12.94), (2.0, 9.28), (3.0, 7.17)])
def test_wind_in_which_gusts_leave_just_enough_thrust(landing, gust, most):
    """At the bound a lean holds drag and weight both, and none does in a wind that is a tenth stronger."""
    s = landing()
    w20 = holds_height_in(s, MASS, gust)
    assert w20 == pytest.approx(most, abs=0.05)

    def best(w20):
        leans = np.deg2rad(np.arange(0.0, 60.0, 0.25))
        return max(min(held(s, w20, gust, lean, 7.0)) for lean in leans)

    assert abs(best(w20)) < 0.1
    assert best(1.1 * w20) < -0.1
    assert left_in_gust(s, MASS, 0.9 * w20, gust) > 0.1


def test_gusts_that_take_it_down_are_told_and_others_not(landing):
    calm, rough = (landing(forecast={"wind_mps": w}) for w in (8.0, 12.0))
    assert told_gusts(calm, MASS) == ""
    assert re.search(
        r"in 12 m/s .* two standard deviations up to \d+\.\d m/s, of one up to \d+\.\d m/s", told_gusts(rough, MASS)
    )
