"""Throws: never better than the best level flight, better the faster, and nothing without the gain of forward flight."""

import numpy as np
import pytest

from armland.experiments.throw import heaviest_at_any_speed, heaviest_thrown, speed_for_gain, survives
from armland.mission.landing_scenario import landing_scenario
from armland.mission.launch import rotors_of
from armland.models.inflow import sustained
from armland.models.uav import GRAVITY

LOADED = landing_scenario()
ROTORS, DRAG = rotors_of(LOADED.landing, LOADED.demonstrator), LOADED.landing.rotors.drag_nspm


def survives_with(share, speed, height, slope=ROTORS.slope, advance=ROTORS.advance, tilt=0.1, target=3.0):
    r = ROTORS
    return survives(
        share, speed, 0.5 * np.pi, height, tilt, target, DRAG, False, r.number, r.static, r.disc, slope, advance
    )


def test_faster_throws_lift_more_and_never_more_than_level_flight_at_its_best():
    shares = [heaviest_thrown(ROTORS, v, 0.03, DRAG)[0] for v in (0.0, 0.3, 0.6, 1.2)]
    assert shares == sorted(shares)
    assert shares[0] == pytest.approx(1.0, abs=2e-3)
    assert 1.01 < shares[-1] < heaviest_at_any_speed(ROTORS, DRAG)[0]


def test_height_to_lose_is_worth_weight():
    assert heaviest_thrown(ROTORS, 0.0, 0.5, DRAG)[0] > heaviest_thrown(ROTORS, 0.0, 0.03, DRAG)[0] + 0.005


def test_without_the_gain_of_forward_flight_no_throw_helps():
    # Rotors that do not feel the air: thrown up at 1 m/s a UAV 2 % too heavy comes down again.
    assert survives_with(1.02, 1.0, 0.5)
    assert not survives_with(1.02, 1.0, 0.5, slope=1e-9, advance=0.0)


def test_rotors_that_do_not_feel_the_air_make_a_parabola():
    # Without tilt: from v up, a UAV too heavy by ε has sunk by h at t = v/a + √((v² + 2ah))/a, a = gε/(1+ε).
    eps, v, h = 0.05, 1.0, 4.0
    a = GRAVITY * eps / (1.0 + eps)
    fallen = (v + np.sqrt(v * v + 2.0 * a * h)) / a
    assert fallen < 12.0
    assert not survives_with(1.0 + eps, v, h, slope=1e-9, advance=0.0, tilt=0.0, target=0.0)
    assert survives_with(1.0 - 1e-3, 0.0, 1e-3, slope=1e-9, advance=0.0, tilt=0.0, target=0.0)


def test_speed_for_a_gain_is_where_level_flight_has_it():
    v = speed_for_gain(ROTORS, 0.05, DRAG)
    assert sustained(ROTORS, v, DRAG) / ROTORS.static == pytest.approx(1.05, abs=5e-4)
    assert speed_for_gain(ROTORS, 0.2, DRAG) is None
    assert speed_for_gain(ROTORS, 0.2, 0.0) == pytest.approx(6.3, abs=0.1)
