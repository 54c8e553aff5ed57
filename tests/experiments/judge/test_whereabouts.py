"""Where the UAV is at the end: each state, and each way to be lost."""

import numpy as np
import pytest

from armland.experiments.judge.whereabouts import in_words, state_of, tilt_deg
from armland.rotations import from_rotation_vector


def test_tilt_is_the_angle_of_the_bodys_axis():
    quats = np.array([from_rotation_vector(np.deg2rad(a) * np.array([0.6, 0.8, 0.0])) for a in (0.0, 5.0, 90.0, 170.0)])
    np.testing.assert_allclose(tilt_deg(quats), [0.0, 5.0, 90.0, 170.0], atol=1e-6)


def test_standing_on_the_cradle(ticks, brief):
    assert state_of(ticks, brief) == "standing"
    assert in_words(ticks, brief) == (
        "the arm holds still, the magnet is off, the UAV stands on the cradle, its rotors stopped"
    )
    ticks["truth"]["rotor_thrust"][-1] = 1.0
    assert "its rotors running" in in_words(ticks, brief)


def test_held_needs_all_pads_and_an_upright_uav(ticks, brief):
    held = ticks[:1400]
    assert state_of(held, brief) == "held"
    held["truth"]["touching"][-20] = 3
    held["truth"]["r"][:, 2] = 0.5
    assert state_of(held, brief) == "lost"
    held["truth"]["touching"] = 4
    # One without thrust leans on the hinge's stops.
    held["truth"]["quat"] = from_rotation_vector(np.deg2rad([45.0, 0.0, 0.0]))
    assert state_of(held, brief) == "held"
    held["truth"]["quat"] = from_rotation_vector(np.deg2rad([47.0, 0.0, 0.0]))
    assert state_of(held, brief) == "lost"
    assert "toppled by 47°" in in_words(held, brief)


def test_one_that_leans_on_the_hinge_and_presses_on_a_rail_does_not_stand(ticks, brief):
    ticks["truth"]["touching"] = 4
    ticks["truth"]["quat"] = from_rotation_vector(np.deg2rad([24.0, 0.0, 0.0]))
    assert state_of(ticks, brief) == "standing"
    ticks["truth"]["quat"] = from_rotation_vector(np.deg2rad([42.0, 0.0, 0.0]))
    assert state_of(ticks, brief) == "held"
    ticks["truth"]["touching"] = 0
    assert state_of(ticks, brief) == "lost"


def test_flying_within_what_it_was_given(ticks, brief):
    flying = ticks[:900]
    assert state_of(flying, brief) == "flying"
    assert "flies at a height of 0.96 m" in in_words(flying, brief)
    flying["truth"]["v"][:, 0] = 0.8
    assert state_of(flying, brief) == "lost"
    assert state_of(flying, brief._replace(given=np.array([0.7, 0.0, 0.0]))) == "flying"


def test_in_wind_one_that_leans_and_sways_is_not_lost(ticks, brief):
    flying, lean = ticks[:900], np.deg2rad(30.0)
    flying["truth"]["quat"] = [np.cos(0.5 * lean), np.sin(0.5 * lean), 0.0, 0.0]
    assert state_of(flying, brief) == "lost"
    assert state_of(flying, brief._replace(swayed=(20.0, 0.5))) == "flying"
    assert state_of(flying, brief._replace(swayed=(4.0, 0.5))) == "lost"
    flying["truth"]["v"][:, 0] = 0.8
    assert state_of(flying, brief._replace(swayed=(20.0, 0.0))) == "lost"
    assert state_of(flying, brief._replace(swayed=(20.0, 0.5))) == "flying"


def test_one_that_lies_on_the_arm_is_not_held(ticks, brief):
    held = ticks[:1400]
    held["truth"]["foul"][-5:, 2] = 1.0
    held["truth"]["r"][-100:, 2] = 0.3
    assert state_of(held, brief) == "lost"
    assert "lies against the arm" in in_words(held, brief)


def test_one_that_fell_before_is_lost_wherever_it_lies(ticks, brief):
    ticks["truth"]["v"][1200, 2] = -1.3
    assert state_of(ticks, brief) == "lost"
    assert "fell at up to 1.3 m/s" in in_words(ticks, brief)


def test_on_the_hinge_it_cannot_leave(ticks, brief):
    hinged = brief._replace(start="hinged")
    assert state_of(ticks[:900], hinged) == "held"
    assert "magnet" not in in_words(ticks[:900], hinged)


@pytest.mark.parametrize(("brake", "moved", "words"), [(1, 0.1, "brakes are on"), (0, 0.1, "moves"), (0, 0.0, "holds")])
def test_arm_in_words(ticks, brief, brake, moved, words):
    ticks["command"]["brake"], ticks["truth"]["ee"][-50:, 0] = brake, 0.681 + moved
    assert words in in_words(ticks, brief)


def test_light_uav_stands_with_a_force_that_is_a_share_of_its_weight(ticks, brief):
    ticks["truth"]["cradle_force"][:, 2] *= 0.07
    assert state_of(ticks, brief) != "standing"
    assert state_of(ticks, brief._replace(weight=0.35)) == "standing"
