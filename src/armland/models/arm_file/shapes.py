"""What an arm is touched at: the shapes of its file where it has some, capsules along its links where it has none.

Meshes are not needed. A capsule runs from a link's joint to the next one's, at the radius of a real link of an arm of that size.
"""

import numpy as np

from armland.models.arm_file.chain import Chain
from armland.models.arm_file.tree import Pose, Shape, here
from armland.rotations import Array

RADIUS_M, OF_REACH = 0.06, 0.8
"""A link's radius and the length of the arm that has it; the LWR's links are 0.12 m wide."""

LEAST_M, MOST_M = 0.02, 0.065
"""Bounds of the radius: longer arms have longer links, and hardly thicker ones."""

COLOUR = np.array([0.75, 0.77, 0.8, 1.0])


def length(chain: Chain) -> float:
    """Length of the arm from its second link's joint to the end effector along its links, m."""
    steps = [float(np.linalg.norm(link.pose.pos)) for link in chain.links[3:]]
    return sum(steps) + float(np.linalg.norm(chain.ee.pos))


def clothed(chain: Chain) -> Chain:
    """The chain with a capsule on each moving link that has no shape."""
    radius = float(np.clip(RADIUS_M * length(chain) / OF_REACH, LEAST_M, MOST_M))
    links = list(chain.links)
    for i, link in enumerate(links):
        after = links[i + 1].pose if i + 1 < len(links) else chain.ee
        start = link.joints[0].pos if link.joints else np.zeros(3)
        if not link.shapes and i > 0:
            links[i] = link._replace(shapes=(capsule(start, after.pos, radius),))
    return chain._replace(links=tuple(links))


def capsule(a: Array, b: Array, radius: float) -> Shape:
    """A capsule of `radius` m between the points `a` and `b` (3,), m, or a sphere where they are too near for one."""
    span = np.asarray(b) - a
    reach = float(np.linalg.norm(span))
    if reach < radius:
        return Shape("sphere", np.array([radius, 0.0, 0.0]), Pose(0.5 * (a + b), here().quat), COLOUR)
    return Shape("capsule", np.array([radius, 0.5 * reach, 0.0]), Pose(0.5 * (a + b), _towards(span / reach)), COLOUR)


def _towards(direction: Array) -> Array:
    # The quaternion (4,) that turns z into a direction.
    quat = np.array([1.0 + direction[2], -direction[1], direction[0], 0.0])
    if quat[0] < 1e-9:
        return np.array([0.0, 1.0, 0.0, 0.0])
    return quat / np.linalg.norm(quat)
