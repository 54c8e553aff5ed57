"""The serial chain to the end effector: joints off it locked, what does not move lumped, all else of the file left behind."""

from typing import NamedTuple

import mujoco
import numpy as np

from armland.errors import ModelError
from armland.models.arm_file.inertia import NOTHING, lumped
from armland.models.arm_file.tip import NEEDED, Tip, tip
from armland.models.arm_file.tree import HINGE, SLIDE, Body, Inertial, Joint, Mesh, Pose, Shape, Tree, here
from armland.rotations import matrix

WEIGHTY = 0.05
"""Share of a moving link's mass above which a body that is fixed to it must have an inertia that can be."""


class Link(NamedTuple):
    """A body of the chain, with all that is fixed to it."""

    name: str
    pose: Pose  # in the link before, the first in the world
    joints: tuple[Joint, ...]  # driven
    inertial: Inertial | None
    shapes: tuple[Shape, ...]
    meshes: tuple[Mesh, ...] = ()


class Chain(NamedTuple):
    """The arm: links from base to end effector."""

    what: str
    form: str
    links: tuple[Link, ...]  # the first is the base, which stands still
    tip: Tip
    ee: Pose  # in the last link, z outwards
    notes: tuple[str, ...]

    @property
    def joints(self) -> tuple[Joint, ...]:
        """Those that are driven, from the base on."""
        return tuple(j for link in self.links for j in link.joints)


def chain(tree: Tree, ee: str | None, lock: dict[str, float]) -> Chain:
    """The chain of `tree` to its end effector.

    Args:
        tree: of the file.
        ee: `FRAME` or `FRAME:AXIS`; chosen if absent.
        lock: positions of joints that shall not move, by name, rad or m.

    Raises:
        ModelError: too few joints, one that no motor can drive, a link without mass, a joint to lock that there is not.
    """
    end = tip(tree, ee)
    way = tree.way(end.body)
    _check_lock(tree, lock)
    driven = _driven(tree, way, lock, end)
    still = {j.name: _rest(tree, j, lock) for j in tree.joints() if j.name not in driven}
    carrier, at, owns = _carried(tree, way, driven, still)
    gripper = _gripper(tree, [i for i, c in enumerate(carrier) if c == len(owns) - 1], owns[-1].body)
    links = []
    for number, own in enumerate(owns):
        members = [i for i in range(len(tree.bodies)) if carrier[i] == number]
        link = _link(tree, members, at, own)
        links.append(link._replace(meshes=tuple(m for m in link.meshes if m.of not in gripper)))
    ee_pose = at[end.body].then(end.pose)
    notes = (*tree.notes, *end.notes, *_told(tree, way, driven, still, lock, end))
    drawn = [b.name for b in tree.bodies if b.name in gripper and b.meshes]
    if drawn:
        notes = (
            *notes,
            f"the meshes of the gripper are not looked at, as the tool takes its place: {', '.join(drawn)}",
        )
    return Chain(tree.what, tree.form, tuple(links), end, ee_pose, notes)


def _check_lock(tree: Tree, lock: dict[str, float]) -> None:
    known = {j.name: j for j in tree.joints() if j.driven}
    for name, value in lock.items():
        if name not in known:
            raise ModelError(f"arm.lock: the arm has no joint {name!r}; its joints are: {', '.join(known) or 'none'}")
        low, high = known[name].low, known[name].high
        if low is not None and high is not None and not low.number <= value <= high.number:
            raise ModelError(
                f"arm.lock.{name} = {value:g} lies outside the joint's range, {low.number:g} to {high.number:g}"
            )


def _driven(tree: Tree, way: list[int], lock: dict[str, float], end: Tip) -> set[str]:
    on = [j for b in way for j in tree.bodies[b].joints if j.kind != "free"]
    ball = next((j for j in on if not j.driven), None)
    if ball is not None:
        raise ModelError(f"{tree.what}: joint {ball.name!r} is neither a hinge nor a slide, so it cannot be driven")
    follower = next((j for j in on if j.follows and j.name not in lock), None)
    if follower is not None and follower.follows is not None:
        raise ModelError(
            f"{tree.what}: joint {follower.name!r} mimics {follower.follows[0]!r}, and no motor drives it; "
            f"choose an end effector before it, or lock it: --lock {follower.name}=0"
        )
    free = [j for j in on if j.name not in lock]
    hinges = [j for j in free if j.kind == HINGE]
    arm = [j for j in hinges if j not in _mobile(on)]
    # Rails, lifts and a base that drives stand still where the arm has enough without them.
    chosen = next((few for few in (arm, hinges) if len(few) >= NEEDED), free)
    if len(chosen) < NEEDED:
        raise ModelError(
            f"{tree.what} has {len(chosen)} joints on the way to {end.label!r}; the end effector needs at least {NEEDED} to hold a "
            "position and an orientation"
        )
    return {j.name for j in chosen}


def _mobile(on: list[Joint]) -> list[Joint]:
    # Joints by which a base drives over the floor: two ways and a turn, in any order, before all others.
    first = on[:3]
    return first if sorted(j.kind for j in first) == [HINGE, SLIDE, SLIDE] else []


def _rest(tree: Tree, joint: Joint, lock: dict[str, float]) -> float:
    # Where the file's rest pose has it, within its range.
    if joint.name in lock:
        return lock[joint.name]
    if joint.follows is not None:
        name, factor, offset = joint.follows
        leader = next((j for j in tree.joints() if j.name == name and j.follows is None), None)
        return offset + factor * (_rest(tree, leader, lock) if leader is not None else 0.0)
    low, high = (e.number if e is not None else s * np.inf for e, s in ((joint.low, -1), (joint.high, 1)))
    return float(min(max(joint.ref, low), high)) if low <= high else joint.ref


def _moved(joint: Joint, value: float) -> Pose:
    # Of the body, from where its pose says.
    if joint.kind == "slide":
        return Pose(joint.axis * (value - joint.ref), here().quat)
    if joint.kind != "hinge" or value == joint.ref:
        return here()
    quat = np.zeros(4)
    mujoco.mju_axisAngle2Quat(quat, joint.axis, value - joint.ref)
    return Pose(joint.pos - matrix(quat) @ joint.pos, quat)


class _Own(NamedTuple):
    pose: Pose  # in the link before
    body: int
    joints: tuple[Joint, ...]


def _carried(
    tree: Tree, way: list[int], driven: set[str], still: dict[str, float]
) -> tuple[list[int], list[Pose], list[_Own]]:
    # For each body the link that carries it (-1: none) and its pose there; and the links.
    root = _base(tree, way, driven)
    carrier, at, links = [-1] * len(tree.bodies), [here() for _ in tree.bodies], [_Own(here(), root, ())]
    for i, body in enumerate(tree.bodies):
        joints, inner = _placed(body, driven, still)
        up = body.parent
        place = (at[up] if up >= 0 else here()).then(body.pose)
        if i in way and joints:
            carrier[i], at[i] = len(links), inner
            links.append(_Own(place, i, joints))
        else:
            carrier[i], at[i] = carrier[up] if up >= 0 else -1, place.then(inner)
    # Bodies that no driven joint moves: those of the same tree are the base's.
    base = at[root] if root >= 0 else here()
    for i in range(len(tree.bodies)):
        if carrier[i] < 0 and tree.way(i)[0] == way[0]:
            carrier[i] = 0
            if not base.still:
                at[i] = here() if i == root else base.inverse().then(at[i])
    first = links[1]
    links[:2] = [_Own(base, root, ()), first if base.still else first._replace(pose=tree.bodies[first.body].pose)]
    return carrier, at, links


def _placed(body: Body, driven: set[str], still: dict[str, float]) -> tuple[tuple[Joint, ...], Pose]:
    # Driven joints of a body as its locked ones have moved them, and where its contents are.
    at, out = here(), []
    for joint in body.joints:
        if joint.name in driven:
            R = matrix(at.quat)
            out.append(joint if at.still else joint._replace(pos=at.pos + R @ joint.pos, axis=R @ joint.axis))
        elif joint.driven:
            at = at.then(_moved(joint, still[joint.name]))
    return tuple(out), at


def _base(tree: Tree, way: list[int], driven: set[str]) -> int:
    # The last body before the first driven joint.
    moving = next(b for b in way if any(j.name in driven for j in tree.bodies[b].joints))
    return tree.bodies[moving].parent


def _gripper(tree: Tree, members: list[int], last: int) -> set[str]:
    # Names of what hangs on the last link and has joints of its own: its fingers, and the hand that carries them.
    out: set[int] = set()
    for i in members:
        if any(j.driven for j in tree.bodies[i].joints) and i != last:
            hand = tree.bodies[i].parent
            root = hand if hand in members and hand != last else i
            out |= {k for k in members if root in tree.way(k)}
    return {tree.bodies[k].name for k in out}


def _link(tree: Tree, members: list[int], at: list[Pose], own: _Own) -> Link:
    bodies = tree.bodies
    parts = [(i, at[m]) for m in members if (i := bodies[m].inertial) is not None]
    name = bodies[own.body].name if own.body >= 0 else "base"
    if own.joints:
        _check_mass(tree, members, own)
    shapes = tuple(s._replace(pose=at[m].then(s.pose), of=bodies[m].name) for m in members for s in bodies[m].shapes)
    meshes = tuple(x._replace(pose=at[m].then(x.pose), of=bodies[m].name) for m in members for x in bodies[m].meshes)
    return Link(name, own.pose, own.joints, lumped(parts), shapes, meshes)


def _check_mass(tree: Tree, members: list[int], own: _Own) -> None:
    masses = {m: i.mass if (i := tree.bodies[m].inertial) is not None else 0.0 for m in members}
    total = sum(masses.values())
    for m, mass in masses.items():
        if tree.bodies[m].complaint and (m == own.body or mass > WEIGHTY * total):
            raise ModelError(f"{tree.what}: {tree.bodies[m].complaint}")
    if total <= NOTHING:
        raise ModelError(
            f"{tree.what}: link {tree.bodies[own.body].name!r}, which joint {own.joints[0].name!r} moves, has no mass: give it an "
            "<inertial> with mass, centre of mass and inertia (your CAD or the vendor's description has them)"
        )


def _told(
    tree: Tree, way: list[int], driven: set[str], still: dict[str, float], lock: dict[str, float], end: Tip
) -> list[str]:
    # What stands still or was left behind, in lines.
    on = {j.name for b in way for j in tree.bodies[b].joints}
    joints = {j.name: j for j in tree.joints()}
    lines = []

    def listed(names: list[str]) -> str:
        return ", ".join(f"{n} = {still[n]:.4g} {'m' if joints[n].kind == 'slide' else 'rad'}" for n in names)

    fixed = [n for n in joints if n in on and joints[n].kind == "free"]
    if fixed:
        lines.append(f"floating base: joint {', '.join(fixed)} is fixed where the file has it")
    asked = [n for n in lock if n not in driven]
    slides = [n for n in joints if n in on and n in still and n not in lock and joints[n].driven]
    tree_of = [j.name for i, b in enumerate(tree.bodies) if tree.way(i)[0] == way[0] for j in b.joints]
    off = [n for n in tree_of if n not in on and n not in lock and joints[n].driven]
    if asked:
        lines.append(f"locked as asked: {listed(asked)}")
    if slides:
        lines.append(
            f"locked, as the arm has {NEEDED} joints and more without: {listed(slides)}; --lock NAME=VALUE says where"
        )
    if off:
        lines.append(
            f"not on the chain to {end.label!r}, locked at the file's rest pose: {listed(off)}; --lock NAME=VALUE says where"
        )
    others = [b.name for i, b in enumerate(tree.bodies) if b.parent < 0 and i != way[0]]
    if others:
        lines.append(f"left behind, as it is not the arm: {', '.join(others)}")
    return lines
