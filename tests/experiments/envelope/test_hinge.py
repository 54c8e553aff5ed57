"""Angles of the hinge."""

import numpy as np

from armland.experiments.envelope.hinge import hinge_angles
from armland.rotations import from_rotation_vector, matrix


def test_hinge_angles_are_those_of_the_rotations_in_turn():
    y, x, z = 0.3, -0.2, 0.7
    turns = [matrix(from_rotation_vector(a * np.eye(3)[i])) for a, i in ((y, 1), (x, 0), (z, 2))]
    np.testing.assert_allclose(hinge_angles(turns[0] @ turns[1] @ turns[2]), [y, x, z], atol=1e-12)
