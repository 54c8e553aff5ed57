"""Other people's UAV files, MJCF or URDF: the body that flies and its rotors, as numbers about the centre of mass.

| of the UAV | taken from |
|---|---|
| body | `uav`, else the one with rotors of those that stand free in the world and weigh something |
| mass, inertia, centre of mass | it and all bodies on it, joints at zero; the centre of mass is the site `cm`, where there is one |
| pivot | the site `pivot`; else by rule, the paper's lever, shorter where the rotors sit closer |
| rotors | actuators at sites; else sites or bodies called rotor, thrust, motor or prop, and a number or a side |
| thrust limits, reaction torque, spin | actuators at sites; of a URDF the `<properties>` of gym-pybullet-drones, where it has them |
"""

from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from armland.errors import ModelError
from armland.models.airframe.actuators import Push, pushes_of, urdf_places, urdf_properties
from armland.models.airframe.found_rotors import FEWEST, called, of_actuators, of_names, with_properties
from armland.models.arm_file.inertia import lumped, tensor
from armland.models.arm_file.reading import read_tree
from armland.models.arm_file.tree import Inertial, Pose, Tree, here
from armland.rotations import Array

LEVER_M, REACH_M = 0.06, 0.1796
"""Of the AR.Drone: centre of mass to pivot, and to the rotors."""


class Foreign(NamedTuple):
    """What a file says of a UAV, body axes, from its centre of mass; None where it says nothing."""

    body: str
    mass: float  # kg
    inertia: Array  # (3, 3) kg·m²
    pivot: Array | None  # (3,) m
    place: Array | None  # (n, 3) m
    axis: Array | None  # (n, 3)
    spin: Array | None  # (n,)
    drag_torque: float | None  # N·m/N
    low: float | None  # N, of one rotor
    high: float | None

    @property
    def lever(self) -> Array:
        """Centre of mass to pivot (3,), m: the file's, or by rule."""
        if self.pivot is not None:
            return self.pivot
        reach = REACH_M if self.place is None else float(np.hypot(self.place[:, 0], self.place[:, 1]).mean())
        return np.array([0.0, 0.0, -LEVER_M * min(1.0, reach / REACH_M)])


def read_foreign(path: Path) -> Foreign:
    """What the file at `path` says.

    Raises:
        ModelError: it cannot be read, nothing in it flies, or several do.
    """
    return _read(path, path.stat().st_mtime_ns)


@lru_cache(maxsize=16)
def _read(path: Path, changed: int) -> Foreign:
    tree = read_tree(path, "UAV file")
    pushes, placed = pushes_of(path), urdf_places(path)
    root = _flying(tree, pushes)
    poses = _poses(tree, root)
    for i in poses:
        if tree.bodies[i].complaint:
            raise ModelError(f"{tree.what}: {tree.bodies[i].complaint}")
    whole = lumped([(b.inertial, poses[i]) for i, b in enumerate(tree.bodies) if i in poses and b.inertial])
    if whole is None:
        raise ModelError(f"{tree.what}: its body {tree.bodies[root].name!r} has no mass; give it an <inertial>")
    sites = {f.name: poses[f.body].then(f.pose) for f in tree.frames if f.body in poses}
    cm = sites["cm"].pos if "cm" in sites else whole.pos
    rotors = of_actuators(pushes, sites, cm, tree.what) or of_names(tree, poses, placed, cm)
    if rotors is not None:
        rotors = with_properties(rotors, urdf_properties(path), whole.mass)
    return Foreign(
        tree.bodies[root].name,
        whole.mass,
        _about(whole, cm),
        sites["pivot"].pos - cm if "pivot" in sites else None,
        *(rotors or (None,) * 6),
    )


def _flying(tree: Tree, pushes: list[Push]) -> int:
    # The body that flies, by index.
    heavy = {i for i, b in enumerate(tree.bodies) if b.inertial is not None}
    roots = [i for i, b in enumerate(tree.bodies) if b.parent < 0]
    roots = [i for i in roots if any(i in tree.way(h) for h in heavy)]
    named = [i for i in roots if tree.bodies[i].name == "uav"]
    pushed = {p.site for p in pushes}

    def carries(i: int) -> bool:
        frames = [f for f in tree.frames if i in tree.way(f.body)]
        return any(f.name in pushed for f in frames) or len([f for f in frames if called(f.name)]) >= FEWEST

    likely = named or [i for i in roots if carries(i)] or roots
    if len(likely) == 1:
        return likely[0]
    if not likely:
        raise ModelError(f"{tree.what}: no body in it weighs anything; a UAV is a body with an <inertial>")
    names = ", ".join(tree.bodies[i].name for i in likely)
    raise ModelError(f"{tree.what}: the bodies {names} could each be the UAV; call the one that is `uav`")


def _poses(tree: Tree, root: int) -> dict[int, Pose]:
    # Of each body on the one that flies, in its axes, joints at zero.
    out = {root: here()}
    for i, body in enumerate(tree.bodies):
        if body.parent in out:
            out[i] = out[body.parent].then(body.pose)
    return out


def _about(i: Inertial, point: Array) -> Array:
    # Inertia (3, 3), kg·m², about `point` (3,), m, body axes.
    d = i.pos - point
    return tensor(i) + i.mass * (d @ d * np.eye(3) - np.outer(d, d))
