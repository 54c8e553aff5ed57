"""Which frame of a robot carries the tool, where its user does not say, and which way its axes point.

An end effector is asked for as `FRAME`, or as `FRAME:AXIS` where another axis than z points outwards, e.g. `flange:x`. A length after
the axis mounts the tool so much further out along it, m, where the file has no frame there: `link7:z+0.107`.
"""

import re
from collections.abc import Iterator
from typing import NamedTuple

import mujoco
import numpy as np

from armland.errors import ModelError
from armland.models.arm_file.tree import Frame, Pose, Tree, here
from armland.rotations import Array, matrix, multiply

USUAL = (
    r"tool0",
    r"flange",
    r"attachment_site",
    r".*[_/-]tool0",
    r".*[_/-]flange",
    r"ee_link|.*[_/-]ee_link|.*[_/-]link_ee|link_eef",
    r"end_effector(_link)?|.*end_?effector(_link)?",
    r"(.*[_/-])?(ee|tcp|tool|tool_frame|tool_link|ee_tool)",
    r"(.*[_/-])?(right_hand|hand|gripper_base(_link)?|pinch(_site)?)",
)
"""What frames for tools are called, the surest first; letters of either case."""

NEEDED = 6
"""Joints that hold a position and an orientation."""

FINGER = re.compile(r"grip|finger|jaw|knuckle|thumb|claw", re.IGNORECASE)
"""What the joints of a gripper are called, which hold no end effector."""

AXES = {
    "x": (0.0, 1.0, 0.0),
    "-x": (0.0, -1.0, 0.0),
    "y": (-1.0, 0.0, 0.0),
    "-y": (1.0, 0.0, 0.0),
    "z": (0.0, 0.0, 0.0),
    "-z": (2.0, 0.0, 0.0),
}
"""Quarter turns that bring z to the axis: about which axis and how many, as a rotation vector over π/2."""

MOUNT = re.compile(r"\s*\+?(-?[xyz])\s*(?:\+\s*(\d*\.?\d+))?\s*", re.IGNORECASE)
"""What stands after the colon: the axis and how far out along it."""

FARTHEST_M = 1.0
"""An end effector is mounted at most so far out from a frame; more is a length in millimetres."""


class Tip(NamedTuple):
    """The end effector: where the tool is mounted, z outwards."""

    label: str
    body: int
    pose: Pose
    notes: tuple[str, ...]


def tip(tree: Tree, asked: str | None) -> Tip:
    """The end effector that is asked for, or the one that is plain from the file.

    Raises:
        ModelError: no such frame, or none that stands out; the message names those there are.
    """
    if asked is not None:
        name, axis, out = _asked(tree, asked)
        frame = _frame(tree, name)
        notes = (_sideways(tree, frame),) if axis is None else ()
        return Tip(asked, frame.body, _mounted(frame.pose, axis or "z", out), tuple(n for n in notes if n))
    frame = _plain(tree)
    axis = outward(tree, frame)
    label = frame.name if axis in (None, "z") else f"{frame.name}:{axis}"
    said = f"end effector: {label!r}, chosen from the file's frames; --ee names another"
    return Tip(label, frame.body, _mounted(frame.pose, axis or "z", 0.0), (said,))


def _asked(tree: Tree, asked: str) -> tuple[str, str | None, float]:
    name, colon, mount = asked.rpartition(":")
    if not colon or any(f.name == asked for f in tree.frames):
        return asked, None, 0.0
    told = MOUNT.fullmatch(mount)
    if told is None:
        raise ModelError(
            f"{tree.what}: end effector {asked!r}: the axis after the colon is one of {', '.join(AXES)}, with a length in metres where "
            "the tool is mounted further out, as in z+0.05"
        )
    out = float(told[2] or 0.0)
    if out > FARTHEST_M:
        raise ModelError(
            f"{tree.what}: end effector {asked!r} is {out:g} m out from its frame; at most {FARTHEST_M:g} m are"
        )
    return name, told[1].lower(), out


def farther(label: str, out: float) -> str:
    """An end effector as it is asked for, `out` m further along its axis."""
    name, colon, mount = label.rpartition(":")
    told = MOUNT.fullmatch(mount) if colon else None
    if told is None:
        return f"{label}:z+{out:.3f}"
    return f"{name}:{told[1]}+{float(told[2] or 0.0) + out:.3f}"


def _frame(tree: Tree, name: str) -> Frame:
    # A site before a body of the same name.
    found = [f for f in tree.frames if f.name == name]
    if not found:
        known = ", ".join(f.name for f in tree.frames) or "none"
        raise ModelError(f"{tree.what}: the arm has no frame {name!r}; its frames are: {known}")
    return found[-1]


def hinges(tree: Tree, body: int) -> int:
    """Joints that a motor can drive between the world and a body, those of a gripper left out."""
    return sum(j.driven and not FINGER.search(j.name) for b in tree.way(body) for j in tree.bodies[b].joints)


def others(tree: Tree, end: Tip) -> Iterator[str]:
    """Frames that the same joints move as `end`, as they are asked for with the axis that points out."""

    def movers(body: int) -> list[str]:
        return [j.name for b in tree.way(body) for j in tree.bodies[b].joints if j.driven and not FINGER.search(j.name)]

    for frame in tree.frames:
        axis = outward(tree, frame)
        if axis is not None and movers(frame.body) == movers(end.body):
            yield frame.name if axis == "z" else f"{frame.name}:{axis}"


def further_out(tree: Tree, end: Tip, least: float = 5e-3) -> tuple[str, float] | None:
    """The next frame along the tool's axis that the same joints move as `end`, as it is asked for, and by how much, m.

    A frame that is called as tools are mounted may lie inside the wrist, as where a gripper of its own would overlap it.

    Args:
        tree: of the file.
        end: end effector of it.
        least: by how much it must be further out, m.
    """
    heights = {"": _out(tree, end.body, end.pose)}
    axes = {frame.name: frame for frame in tree.frames}
    for other in others(tree, end):
        frame = axes.get(other) or axes[other.rpartition(":")[0]]
        heights[other] = _out(tree, frame.body, frame.pose)
    sign = 1.0 if _leads(tree, end) > 0.0 else -1.0
    beyond = [(sign * (h - heights[""]), name) for name, h in heights.items()]
    found = sorted((gain, name) for gain, name in beyond if gain >= least)
    return (found[0][1], found[0][0]) if found else None


def _out(tree: Tree, body: int, pose: Pose) -> float:
    # How far along the last joint's axis a frame lies, from the joint's anchor, m.
    last = last_joint(tree, body)
    return 0.0 if last is None else float((pose.pos - last[1]) @ last[0])


def _leads(tree: Tree, end: Tip) -> float:
    last = last_joint(tree, end.body)
    return 0.0 if last is None else float(matrix(end.pose.quat)[:, 2] @ last[0])


def _plain(tree: Tree) -> Frame:
    behind = [f for f in tree.frames if hinges(tree, f.body) >= NEEDED]
    if not behind:
        most = max((hinges(tree, f.body) for f in tree.frames), default=0)
        raise ModelError(
            f"{tree.what} has {most} joints in a row; the end effector needs at least {NEEDED} to hold a position and an orientation"
        )
    for pattern in USUAL:
        found = {f.name: f for f in behind if re.fullmatch(pattern, f.name, re.IGNORECASE)}
        if len(found) == 1:
            return next(iter(found.values()))
    ends = _ends(tree)
    if len(ends) != 1:
        known = ", ".join(tree.bodies[b].name for b in ends[:12]) or ", ".join(f.name for f in behind[:12])
        raise ModelError(f"{tree.what}: its end effector is not plain; name it with --ee, e.g. one of: {known}")
    return next(f for f in tree.frames if f.body == ends[0] and f.name == tree.bodies[ends[0]].name)


def _ends(tree: Tree) -> list[int]:
    # Last bodies of chains of six joints and more, before they part or become fingers.
    children: dict[int, list[int]] = {}
    for i, b in enumerate(tree.bodies):
        children.setdefault(b.parent, []).append(i)

    def moving(body: int) -> bool:
        own = any(j.driven and not FINGER.search(j.name) for j in tree.bodies[body].joints)
        return own or any(moving(c) for c in children.get(body, []))

    out, open_ = [], list(children.get(-1, []))
    while open_:
        body = open_.pop()
        on = [c for c in children.get(body, []) if moving(c)]
        if hinges(tree, body) < NEEDED or len(on) == 1:
            open_ += on
            continue
        while not on and len(children.get(body, [])) == 1 and not tree.bodies[children[body][0]].joints:
            # Fixed links behind the last joint, as long as they do not part.
            body = children[body][0]
        out.append(body)
    return sorted(out)


def last_joint(tree: Tree, body: int) -> tuple[Array, Array, Array] | None:
    """Axis (3,) and anchor (3,) m of the last joint before `body` that is no gripper's, and the anchor (3,) of the one before that, in
    the frame of `body`.

    None where there are not two. The joints stand where the file's poses have them.
    """
    at, found = here(), []
    for b in reversed(tree.way(body)):
        for joint in reversed(tree.bodies[b].joints):
            if joint.driven and not FINGER.search(joint.name):
                back = at.inverse()
                R = matrix(back.quat)
                found.append((R @ joint.axis, back.pos + R @ joint.pos))
        at = tree.bodies[b].pose.then(at)
        if len(found) > 1:
            return found[0][0], found[0][1], found[1][1]
    return None


def outward(tree: Tree, frame: Frame) -> str | None:
    """Axis of `frame` that points out along the last joint's axis; None where none does or the direction is not plain."""
    last = last_joint(tree, frame.body)
    if last is None:
        return None
    axis, anchor, before = last
    along = [float((frame.pose.pos - p) @ axis) for p in (before, anchor)]
    sign = next((np.sign(x) for x in along if abs(x) > 5e-3), 0.0)
    share = matrix(frame.pose.quat).T @ axis * (sign or 1.0)
    best = int(np.abs(share).argmax())
    if abs(share[best]) < 0.9:
        return None
    if sign == 0.0:
        return "z" if best == 2 else None
    return ("" if share[best] > 0.0 else "-") + "xyz"[best]


def _sideways(tree: Tree, frame: Frame) -> str:
    axis = outward(tree, frame)
    if axis in (None, "z"):
        return ""
    way = "back into the arm" if axis == "-z" else "sideways"
    return (
        f"end effector {frame.name!r}: its z axis points {way}; the tool goes out along z, and {axis} points out along the last "
        f"joint: --ee '{frame.name}:{axis}' mounts it there"
    )


def _mounted(pose: Pose, axis: str, out: float) -> Pose:
    # Turned so that z is the axis, and moved so far along it.
    turn = np.array(AXES[axis])
    if turn.any():
        quat = np.zeros(4)
        mujoco.mju_axisAngle2Quat(quat, turn / np.linalg.norm(turn), 0.5 * np.pi * np.linalg.norm(turn))
        pose = Pose(pose.pos, multiply(pose.quat, quat))
    return pose.then(Pose(np.array([0.0, 0.0, out]), here().quat)) if out else pose
