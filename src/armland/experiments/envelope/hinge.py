"""Angles of the spherical hinge below a free UAV."""

import numpy as np

from armland.rotations import Array


def hinge_angles(R: Array) -> Array:
    """The hinge's angles (3,) rad of the plate's attitude R (3, 3) in the body's, R = Ry Rx Rz: about y, x, then the swivel."""
    return np.array([np.arctan2(R[0, 2], R[2, 2]), -np.arcsin(R[1, 2]), np.arctan2(R[1, 0], R[1, 1])])
