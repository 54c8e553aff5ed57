"""Where a camera stands that has a set of spheres in its picture, seen from a given side."""

from typing import NamedTuple

import numpy as np

from armland.rotations import Array

FROM = (0.78, -1.0, 0.36)
"""Direction, W, from which one looks: from ahead of the arm and its right, a little from above."""

ANGLE_DEG = 28.0
"""Angle of view from top to bottom."""

MARGIN = 0.92
"""Share of the picture that the spheres may take."""

STEPS = 60


class Framing(NamedTuple):
    """A camera."""

    eye: tuple[float, ...]  # (3,) m, W
    target: Array  # (3,) m, W, middle of the picture
    axes: Array  # (6,) its x and y axes, W
    angle_deg: float


def framed(middles: Array, radii: Array, aspect: float) -> Framing:
    """The nearest camera that sees all spheres with a margin around them.

    Args:
        middles: (n, 3) m, W.
        radii: (n,) m.
        aspect: width of the picture over its height.
    """
    back = np.array(FROM) / np.linalg.norm(FROM)
    right = np.cross([0.0, 0.0, 1.0], back)
    right /= np.linalg.norm(right)
    up = np.cross(back, right)
    tall = MARGIN * np.tan(0.5 * np.deg2rad(ANGLE_DEG))
    wide, target, far = aspect * tall, middles.mean(axis=0), 0.0
    for _ in range(STEPS):
        apart = middles - target
        depth = apart @ back
        # Distances at which each edge of the picture just holds all.
        sides = [
            float(np.max(depth + (sign * apart @ axis + radii) / slope))
            for axis, slope in ((right, wide), (up, tall))
            for sign in (1.0, -1.0)
        ]
        target = target + 0.5 * (0.5 * wide * (sides[0] - sides[1]) * right + 0.5 * tall * (sides[2] - sides[3]) * up)
        far = max(sides)
    return Framing(tuple(target + far * back), target, np.concatenate([right, up]), ANGLE_DEG)
