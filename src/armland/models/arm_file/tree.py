"""What a robot's file says, in one form for URDF and MJCF: bodies, joints, inertias, shapes, frames, values with their sources.

Quaternions are scalar first; a pose says where a frame is in its parent's. Nothing here is corrected or made up: `table` does that.
"""

from typing import Literal, NamedTuple

import numpy as np

from armland.rotations import Array, matrix, multiply

Kind = Literal["hinge", "slide", "ball", "free"]

HINGE, SLIDE, BALL, FREE = "hinge", "slide", "ball", "free"

FILE, ACTUATOR, CLASS, DEFAULT, RULE, OPTION = "file", "actuator", "default class", "default", "rule", "option"
"""Where a value comes from: the joint itself, its actuator, a default class of the file, what the format means by silence, a
stated rule of armland's, or the user."""


class Value(NamedTuple):
    """A number and where it comes from."""

    number: float
    source: str


class Pose(NamedTuple):
    """Of a frame in its parent's."""

    pos: Array  # (3,) m
    quat: Array  # (4,)

    def then(self, inner: "Pose") -> "Pose":
        """The pose of a frame that is at `inner` in this one; nothing is rounded where one of the two does not move."""
        if inner.still:
            return self
        if self.still:
            return inner
        return Pose(self.pos + matrix(self.quat) @ inner.pos, multiply(self.quat, inner.quat))

    @property
    def still(self) -> bool:
        """Whether it is where its parent is."""
        return not self.pos.any() and self.quat[0] == 1.0

    def inverse(self) -> "Pose":
        """The pose of the parent in this frame."""
        back = self.quat * [1.0, -1.0, -1.0, -1.0]
        return Pose(-(matrix(back) @ self.pos), back)


def here() -> Pose:
    """The pose of a frame that coincides with its parent's."""
    return Pose(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]))


class Joint(NamedTuple):
    """A joint as its file has it; None where the file is silent."""

    name: str
    kind: Kind
    pos: Array  # (3,) m, a point of its axis, body
    axis: Array  # (3,) of length 1, body
    ref: float = 0.0  # position at which the body is where its pose says; rad or m
    low: Value | None = None  # rad or m
    high: Value | None = None
    speed: Value | None = None  # rad/s or m/s
    torque: Value | None = None  # N·m or N
    torque_rate: Value | None = None  # N·m/s or N/s
    friction: Value | None = None  # N·m or N
    damping: Value | None = None  # N·m·s/rad or N·s/m
    armature: Value | None = None  # kg·m² or kg
    follows: tuple[str, float, float] | None = None  # joint that it mimics, factor, offset

    @property
    def driven(self) -> bool:
        """Whether one motor can drive it."""
        return self.kind in (HINGE, SLIDE)


class Inertial(NamedTuple):
    """Mass, centre of mass and principal inertia."""

    mass: float  # kg
    pos: Array  # (3,) m
    quat: Array  # (4,)
    moments: Array  # (3,) kg·m²


class Shape(NamedTuple):
    """What a body looks like or is touched at."""

    kind: str  # sphere, capsule, cylinder, box, ellipsoid
    size: Array  # (3,) m, as in MuJoCo: half lengths
    pose: Pose
    rgba: Array  # (4,)
    gloss: tuple[float, float] = (0.5, 0.5)  # specular, shininess
    touches: bool = True  # whether the file means it for contact
    of: str = ""  # body of the file that it belongs to


class Mesh(NamedTuple):
    """A file of triangles that a body looks like or is touched at. Nobody who plans or flies opens it."""

    file: str  # as it is found beside the robot's file; it need not be there
    scale: Array  # (3,)
    pose: Pose
    touches: bool = True  # whether the file means it for contact
    of: str = ""  # body of the file that it belongs to


class Body(NamedTuple):
    """A body, or a link with the joint to its parent."""

    name: str
    parent: int  # of the bodies, -1: the world
    pose: Pose
    joints: tuple[Joint, ...]
    inertial: Inertial | None
    shapes: tuple[Shape, ...] = ()
    complaint: str = ""  # why its inertia cannot be used
    meshes: tuple[Mesh, ...] = ()


class Frame(NamedTuple):
    """A named place on a body that can carry a tool."""

    name: str
    body: int
    pose: Pose


class Tree(NamedTuple):
    """All that a file says about a robot."""

    what: str  # its name in messages
    form: Literal["URDF", "MJCF"]
    bodies: tuple[Body, ...]  # parents first
    frames: tuple[Frame, ...]
    notes: tuple[str, ...]  # what was left behind

    def way(self, body: int) -> list[int]:
        """The bodies from the world to `body`, that one included."""
        out: list[int] = []
        while body >= 0:
            out.insert(0, body)
            body = self.bodies[body].parent
        return out

    def joints(self) -> list[Joint]:
        """Joints of all bodies, those that nothing drives among them."""
        return [j for b in self.bodies for j in b.joints]
