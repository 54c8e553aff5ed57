"""The rotors in a UAV's file of other people: actuators at sites, or places that are called so.

A rotor that is a body stands where its mass is: URDFs often leave the joint at the origin and place the inertia alone.
"""

import re
from typing import NamedTuple

import numpy as np

from armland.errors import ModelError
from armland.models.airframe.actuators import Push
from armland.models.arm_file.tree import Pose, Tree
from armland.rotations import Array, matrix

CALLED = re.compile(
    r"(?:.*[/_\-.])?(rotor|thrust|thruster|motor|prop|propeller)s?[_\-]?(\d+)(?:[_\-]?link)?", re.IGNORECASE
)
"""Names of rotors: the kind, and its number."""

_SIDE = "(?:front|rear|back|left|right|mid|middle|upper|lower|top|bottom|[fbr][lr]|[lr][fbr])"

SIDED = re.compile(
    rf"(?:.*?[/_\-.])??((?:{_SIDE}[_\-]?)*)(rotor|thrust|thruster|motor|prop|propeller)s?((?:[_\-]?{_SIDE})*)(?:[_\-]?link)?",
    re.IGNORECASE,
)
"""Names of rotors that say where each is: sides before the kind, the kind, sides behind it."""

KINDS = ("rotor", "thrust", "thruster", "motor", "prop", "propeller")
"""In the order in which they are believed, where a file has several."""

MIDDLE = 0.05
"""Share of the rotors' distance from the middle within which what pushes is none of them."""

FEWEST = 3
"""Rotors below which names are taken for a coincidence."""

STANDARD_GRAVITY = 9.80665


class FoundRotors(NamedTuple):
    """Rotors, body axes, from the centre of mass; None where the file says nothing."""

    place: Array  # (n, 3) m
    axis: Array  # (n, 3)
    spin: Array | None = None  # (n,)
    drag_torque: float | None = None  # N·m/N
    low: float | None = None  # N, of one rotor
    high: float | None = None


class _Named(NamedTuple):
    """A frame that may be a rotor, of the body that flies."""

    kind: str
    number: int | None
    """None where the name says a side instead."""
    pose: Pose
    is_site: bool


def of_actuators(pushes: list[Push], sites: dict[str, Pose], cm: Array, what: str) -> FoundRotors | None:
    """Rotors of which each is an actuator at a site of its own; None where those are too few.

    Args:
        pushes: actuators at sites.
        sites: where they are on the body that flies.
        cm: its centre of mass (3,), m, in the same axes.
        what: the file's name in messages.

    Raises:
        ModelError: the rotors are not alike.
    """
    found = [p for p in pushes if p.site in sites and np.linalg.norm(p.force) > 0.0]
    # Of a file that drives the whole body beside its rotors, for another kind of controller.
    apart = [float(np.hypot(*(sites[p.site].pos - cm)[:2])) for p in found]
    found = [p for p, far in zip(found, apart, strict=True) if far > MIDDLE * max(apart)]
    if len({p.site for p in found}) < FEWEST:
        return None
    size = [float(np.linalg.norm(p.force)) for p in found]
    place = np.array([sites[p.site].pos - cm for p in found])
    axis = np.array([matrix(sites[p.site].quat) @ p.force / s for p, s in zip(found, size, strict=True)])
    torque = np.array([p.torque @ p.force / s**2 for p, s in zip(found, size, strict=True)])
    drag = float(np.abs(torque).mean())
    spin = -np.sign(torque) if torque.all() else None
    low, high = (_alike([_end(p, end, s) for p, s in zip(found, size, strict=True)], what) for end in (0, 1))
    return FoundRotors(place, axis, spin, drag or None, low, high or None)


def _end(push: Push, end: int, size: float) -> float | None:
    return None if push.range is None else push.range[end] * size


def _alike(ends: list[float | None], what: str) -> float | None:
    known = [e for e in ends if e is not None]
    if known and not np.allclose(known, known[0], rtol=0.01, atol=1e-9):
        thrusts = ", ".join(f"{e:g}" for e in known)
        raise ModelError(
            f"{what}: its rotors are not alike: thrusts up to {thrusts} N; armland flies rotors of one kind"
        )
    return known[0] if known and len(known) == len(ends) else None


def with_properties(rotors: FoundRotors, said: dict[str, float], mass: float) -> FoundRotors:
    """`rotors` with what a URDF's properties say of them where the rest of the file is silent; `mass` in kg of all that flies."""
    drag, high = rotors.drag_torque, rotors.high
    if drag is None and said.get("kf", 0.0) > 0.0 and said.get("km", 0.0) > 0.0:
        drag = said["km"] / said["kf"]
    if high is None and said.get("thrust2weight", 0.0) > 0.0:
        high = said["thrust2weight"] * mass * STANDARD_GRAVITY / len(rotors.place)
    return rotors._replace(drag_torque=drag, high=high)


def of_names(tree: Tree, poses: dict[int, Pose], placed: dict[str, Array], cm: Array) -> FoundRotors | None:
    """Rotors by the names of sites and bodies; None where none are called so.

    Args:
        tree: all that the file says.
        poses: of the bodies on the one that flies, in its axes.
        placed: where the inertia of a link is that has no mass (3,), m, link axes.
        cm: centre of mass (3,), m, in the same axes.

    Raises:
        ModelError: a number is missing between them.
    """
    found = _named(tree, poses, placed)
    for is_site in (True, False):
        for kind in KINDS:
            alike = [r for r in found if r.kind == kind and r.is_site is is_site]
            family = {r.number: r.pose for r in reversed(alike) if r.number is not None}
            at = [r.pose for r in alike if r.number is None]
            if len(family) >= FEWEST:
                at = [family[n] for n in _counted(kind, sorted(family), tree.what)]
            if len(at) >= FEWEST:
                return FoundRotors(np.array([p.pos - cm for p in at]), np.array([matrix(p.quat)[:, 2] for p in at]))
    return None


def called(name: str) -> tuple[str, int | None] | None:
    """Kind of the rotor that is called `name`, and its number, None where it has a side instead; None of what is no rotor."""
    if match := CALLED.fullmatch(name):
        return match.group(1).lower(), int(match.group(2))
    match = SIDED.fullmatch(name)
    return (match.group(2).lower(), None) if match and (match.group(1) or match.group(3)) else None


def _named(tree: Tree, poses: dict[int, Pose], placed: dict[str, Array]) -> list[_Named]:
    bodies, out, none = {b.name for b in tree.bodies}, list[_Named](), np.zeros(3)
    for f in tree.frames:
        rotor = called(f.name)
        if rotor is None or f.body not in poses:
            continue
        own, inertial = f.name in bodies, tree.bodies[f.body].inertial
        shift = none if not own else inertial.pos if inertial is not None else placed.get(f.name, none)
        pose = poses[f.body].then(f.pose)
        at = Pose(pose.pos + matrix(pose.quat) @ shift, pose.quat)
        out.append(_Named(*rotor, at, not own))
    return out


def _counted(kind: str, numbers: list[int], what: str) -> list[int]:
    gap = sorted(set(range(numbers[0], numbers[-1])) - set(numbers))
    if gap or numbers[0] > 1:
        raise ModelError(
            f"{what} has the rotors {kind} {', '.join(map(str, numbers))}; it lacks "
            f"{', '.join(map(str, gap or range(1, numbers[0])))}: number them from 1 on"
        )
    return numbers
