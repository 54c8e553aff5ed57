"""Inertias as files have them: which can be one of a rigid body, which are nearly so, and several bodies as one.

A rigid body's principal moments obey A + B ≥ C. Files that were rounded miss it by a little: they are raised by the difference,
alike about all axes. What misses it by more is not an inertia, and is refused with the body's name.
"""

import mujoco
import numpy as np

from armland.models.arm_file.tree import Inertial, Pose
from armland.rotations import Array, matrix

ROUNDED = 0.05
"""Share of the largest principal moment by which A + B may miss it and still be rounding."""

NOTHING = 1e-8
"""kg below which a mass is none."""

RADIUS_M = 0.03
"""Of gyration, where a file gives a mass and no inertia."""


def principal(tensor: Array) -> tuple[Array, Array]:
    """Principal moments (3,) and the axes as a quaternion (4,), of a symmetric `tensor` (3, 3), kg·m²."""
    if not (tensor - np.diag(np.diag(tensor))).any():
        return np.diag(tensor).copy(), np.array([1.0, 0.0, 0.0, 0.0])
    moments, axes = np.linalg.eigh(tensor)
    if np.linalg.det(axes) < 0.0:
        axes[:, 2] *= -1.0
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, np.ascontiguousarray(axes).ravel())
    return moments, quat


def lacking(moments: Array) -> float:
    """By how much A + B of `moments` (3,), kg·m², misses C, over C; at most 0 where it does not, 1 where one is negative."""
    a, b, c = np.sort(moments)
    if a < -1e-12 and a < -ROUNDED * c:
        return 1.0
    return float((c - a - b) / c) if c > 1e-12 else 0.0


def raised(moments: Array) -> Array:
    """Moments that a body can have: `moments` (3,), kg·m², raised alike about all axes by what is missing and no more."""
    a, b, c = np.sort(moments)
    return moments + max(c - a - b, 0.0) * (1.0 + 1e-9)


def impossible(name: str, moments: Array) -> str:
    """Why the link `name` cannot have the principal `moments` (3,), kg·m²; empty where it nearly can."""
    short = lacking(moments)
    if short <= ROUNDED:
        return ""
    a, b, c = np.sort(moments)
    return (
        f"link {name!r}: no rigid body has the principal inertias {a:.4g}, {b:.4g}, {c:.4g} kg·m²: the two smaller must add up to "
        'at least the largest; correct its <inertia>, or let <mujoco><compiler balanceinertia="true"/></mujoco> in the file '
        "make all three their mean"
    )


def tensor(i: Inertial) -> Array:
    """Inertia (3, 3) about the centre of mass, axes of the body, kg·m²."""
    R = matrix(i.quat)
    return R @ np.diag(i.moments) @ R.T


def lumped(parts: list[tuple[Inertial, Pose]]) -> Inertial | None:
    """Several bodies that move as one; `parts` are their inertias and where they are in the one's frame. None of no mass.

    A single part that is in place is returned as it is, to the last bit.
    """
    parts = [(i, at) for i, at in parts if i.mass > NOTHING]
    if not parts:
        return None
    if len(parts) == 1 and parts[0][1].still:
        return parts[0][0]
    mass = sum(i.mass for i, _ in parts)
    places = [at.pos + matrix(at.quat) @ i.pos for i, at in parts]
    com = np.average(places, axis=0, weights=[i.mass for i, _ in parts])
    total = np.zeros((3, 3))
    for (i, at), place in zip(parts, places, strict=True):
        R, d = matrix(at.quat), place - com
        total += R @ tensor(i) @ R.T + i.mass * (d @ d * np.eye(3) - np.outer(d, d))
    moments, quat = principal(total)
    return Inertial(mass, com, quat, raised(moments))


def extended(i: Inertial) -> Inertial:
    """The same, with the inertia of a compact solid where the file gives none: a point does not turn like a link."""
    return i if i.moments.min() > 1e-12 else i._replace(moments=i.moments + i.mass * RADIUS_M**2)
