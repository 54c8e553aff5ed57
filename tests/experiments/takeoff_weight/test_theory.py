"""Theory of the take-off weight: what it must not depend on, and how it must order."""

import numpy as np
import pytest

from armland.experiments.takeoff_weight.theory import (
    READINGS,
    Air,
    Throw,
    heaviest_at_any_speed,
    heaviest_thrown,
    level_share,
    speed_for_gain,
    survives,
    theory,
)
from armland.models.environment import STANDARD_GRAVITY
from armland.models.inflow import Rotors, advance_of, disc_of, sustained

ROTORS = Rotors(4, 7.44, disc_of(0.1, 1.225), 0.7, advance_of(0.7, 0.115))


@pytest.mark.slow
def test_no_speed_lifts_no_more_and_drag_costs():
    still, fast = theory(ROTORS, 0.22, 0.0, 0.0), theory(ROTORS, 0.22, 0.9, 0.5)
    for name in READINGS:
        assert still.sustained[name] == pytest.approx(1.0, abs=1e-9)
        assert fast.sustained[name] > 1.0
        assert fast.sustained[f"{name}, no drag"] > fast.sustained[name]
        assert still.thrown[f"{name}, 0.5 m"]["thrown"] == still.thrown[f"{name}, 0.5 m"]["from rest"]
        assert fast.thrown[f"{name}, 0.5 m"]["thrown"] > fast.thrown[f"{name}, 0.5 m"]["from rest"]


# The AR.Drone's of the landing.
AIR = Air(Rotors(4, 7.44, disc_of(0.1, 1.225), 0.7, advance_of(0.7, 0.115)), 0.22)
# Rotors that do not feel the air.
STUBBORN = AIR._replace(rotors=AIR.rotors._replace(slope=1e-9, advance=0.0))


def upwards(share, speed, height, air=AIR, tilt=0.1, target=3.0):
    return survives(share, Throw(speed, 0.5 * np.pi, height), tilt, target, air)


def test_faster_throws_lift_more_and_never_more_than_level_flight_at_its_best():
    shares = [heaviest_thrown(AIR, v, 0.03)[0] for v in (0.0, 0.3, 0.6, 1.2)]
    assert shares == sorted(shares)
    assert shares[0] == pytest.approx(1.0, abs=2e-3)
    assert 1.01 < shares[-1] < heaviest_at_any_speed(AIR)[0]


def test_height_to_lose_is_worth_weight():
    assert heaviest_thrown(AIR, 0.0, 0.5)[0] > heaviest_thrown(AIR, 0.0, 0.03)[0] + 0.005


def test_without_the_gain_of_forward_flight_no_throw_helps():
    # Thrown up at 1 m/s a UAV 2 % too heavy comes down again.
    assert upwards(1.02, 1.0, 0.5)
    assert not upwards(1.02, 1.0, 0.5, STUBBORN)


def test_rotors_that_do_not_feel_the_air_make_a_parabola():
    # Without tilt: from v up, a UAV too heavy by ε has sunk by h at t = v/a + √((v² + 2ah))/a, a = gε/(1+ε).
    eps, v, h = 0.05, 1.0, 4.0
    a = STANDARD_GRAVITY * eps / (1.0 + eps)
    fallen = (v + np.sqrt(v * v + 2.0 * a * h)) / a
    assert fallen < 12.0
    assert not upwards(1.0 + eps, v, h, STUBBORN, tilt=0.0, target=0.0)
    assert upwards(1.0 - 1e-3, 0.0, 1e-3, STUBBORN, tilt=0.0, target=0.0)


def test_speed_for_a_gain_is_where_level_flight_has_it():
    v, still = speed_for_gain(AIR, 0.05), AIR._replace(drag=0.0)
    assert level_share(AIR, v) == pytest.approx(1.05, abs=5e-4)
    assert level_share(AIR, v) == pytest.approx(sustained(AIR.rotors, v, AIR.drag) / AIR.rotors.static)
    assert speed_for_gain(AIR, 0.2) is None
    assert speed_for_gain(still, 0.2) == pytest.approx(6.3, abs=0.1)
