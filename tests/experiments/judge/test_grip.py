"""Loads of the magnet against hand-worked forces on a plate that leans."""

import numpy as np
import pytest

from armland.experiments.judge.brief import Hold
from armland.experiments.judge.grip import loads, shear_ratio
from armland.rotations import from_rotation_vector, matrix


def test_pull_is_away_from_the_face_and_shear_along_it(ticks):
    quat = from_rotation_vector(np.array([0.3, -0.2, 0.5]))
    ticks["truth"]["plate_quat"] = quat
    # On the UAV, in plate axes: 5 N along the face; the plate is drawn upwards, so its UAV is drawn down.
    ticks["truth"]["hinge_force"] = matrix(quat) @ [3.0, 4.0, -7.0]
    pull, shear = loads(ticks)
    assert (pull[1200], shear[1200]) == (pytest.approx(7.0), pytest.approx(5.0))


def test_push_is_no_load_and_neither_is_what_the_magnet_does_not_hold(ticks):
    ticks["truth"]["hinge_force"] = [0.0, 0.0, 7.0]
    assert loads(ticks)[0].max() == 0.0
    ticks["truth"]["hinge_force"] = [5.0, 0.0, -7.0]
    pull, shear = loads(ticks)
    held = np.flatnonzero(pull)
    np.testing.assert_array_equal(held, np.flatnonzero(shear))
    assert (held[0], held[-1]) == (1000, 2499)
    ticks["command"]["magnet"] = 2
    assert loads(ticks)[0].max() == 0.0


def test_pull_leaves_less_to_hold_shear():
    hold = Hold(rating_n=100.0, shear_share=0.2, share=0.6)
    found = shear_ratio(np.array([0.0, 50.0, 100.0, 120.0, 120.0]), np.array([5.0, 5.0, 5.0, 5.0, 0.0]), hold)
    np.testing.assert_allclose(found, [0.25, 0.5, np.inf, np.inf, 0.0])
