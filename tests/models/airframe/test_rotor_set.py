"""Rotors from places, axes and spins: moments by hand, and who is refused."""

import numpy as np
import pytest

from armland.errors import ModelError
from armland.models.airframe.rotor_set import RotorSet, alternating, beams, by_azimuth, check_rotors, effect_of


def ring(count, height=0.0):
    angle = 2.0 * np.pi * (np.arange(count) + 0.5) / count
    place = np.stack([np.cos(angle), np.sin(angle), np.full(count, height)], axis=1)
    return RotorSet(0.2 * place, np.tile([0.0, 0.0, 1.0], (count, 1)), alternating(place))


def test_eq1_by_hand():
    """One newton 0.2 m to the left, leaning forwards, from a rotor that turns counter-clockwise: its reaction is clockwise."""
    axis = np.array([[0.6, 0.0, 0.8]])
    found = effect_of(RotorSet(np.array([[0.0, 0.2, 0.0]]), axis, np.array([1.0])), 0.05)[:, 0]
    np.testing.assert_allclose(found, [0.8, 0.16 - 0.03, 0.0, -0.12 - 0.04, 0.6, 0.0], atol=1e-15)


@pytest.mark.parametrize("count", [4, 6, 8])
def test_spins_alternate_so_that_equal_thrusts_do_not_turn(count):
    rotors = ring(count)
    np.testing.assert_allclose(effect_of(rotors, 0.02)[:4] @ np.ones(count), [count, 0.0, 0.0, 0.0], atol=1e-14)
    assert (rotors.spin[by_azimuth(rotors.place)] == [-1.0, 1.0] * (count // 2)).all()


def test_two_on_one_beam_turn_against_each_other():
    place = np.array([[x, y, z] for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1)) for z in (0.05, -0.05)], float)
    assert (alternating(place).reshape(4, 2).sum(axis=1) == 0.0).all()


def test_beams_join_opposite_rotors_whatever_their_numbers():
    place = ring(6).place[[0, 3, 1, 4, 2, 5]]
    assert len(beams(place)) == 3
    for one, other in beams(place):
        np.testing.assert_allclose(one, -other, atol=1e-12)
    assert len(beams(ring(5).place)) == 5


def test_three_upright_rotors_are_refused_with_what_they_cannot_make():
    with pytest.raises(ModelError, match=r"3 rotors make 3 of the four independently.*What works: 4 to 8 rotors"):
        check_rotors(ring(3), 0.02, "tri.xml")


def test_rotors_in_a_row_are_refused_with_the_axis():
    place = np.array([[x, 0.0, 0.0] for x in (-0.3, -0.1, 0.1, 0.3)])
    row = RotorSet(place, np.tile([0.0, 0.0, 1.0], (4, 1)), np.array([1.0, -1.0, -1.0, 1.0]))
    with pytest.raises(ModelError, match="not by itself: roll torque"):
        check_rotors(row, 0.02, "row.xml")


def test_too_many_are_refused():
    with pytest.raises(ModelError, match="has 10 rotors; armland flies 4 to 8"):
        check_rotors(ring(10), 0.02, "ten.xml")
