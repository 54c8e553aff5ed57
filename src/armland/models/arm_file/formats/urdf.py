"""URDF into a `Tree`: links, joints, limits, primitive shapes, places of meshes; transmissions, plug-ins, sensors are left behind.

What the format means by silence is not what a robot has: a `<limit>` without effort or velocity, or with 0, says nothing of them,
and a revolute joint whose ends are both 0 says nothing of its range.
"""

import xml.etree.ElementTree as ET
from pathlib import Path

import mujoco
import numpy as np

from armland.errors import ModelError
from armland.models.arm_file.formats.text import mesh_file, numbers, refuse_xacro
from armland.models.arm_file.inertia import extended, impossible, lacking, principal, raised
from armland.models.arm_file.tree import (
    BALL,
    FILE,
    FREE,
    HINGE,
    SLIDE,
    Body,
    Frame,
    Inertial,
    Joint,
    Mesh,
    Pose,
    Shape,
    Tree,
    Value,
    here,
)

KINDS = {
    "revolute": HINGE,
    "continuous": HINGE,
    "prismatic": SLIDE,
    "floating": FREE,
    "planar": FREE,
    "spherical": BALL,
}

GREY = (0.7, 0.72, 0.75, 1.0)


def read_urdf(root: ET.Element, path: Path, what: str) -> Tree:
    """The robot of a URDF.

    Args:
        root: its `<robot>`.
        path: of the file; meshes stand near it.
        what: its name in messages.

    Raises:
        ModelError: a link or joint that cannot be what it is, by name.
    """
    refuse_xacro(root, what)
    links = _named(root.findall("link"), "link", what)
    joints = _named(root.findall("joint"), "joint", what)
    into: dict[str, ET.Element] = {}
    for name, joint in joints.items():
        ends = [_end(joint, end, name, what) for end in ("parent", "child")]
        for end in ends:
            if end not in links:
                raise ModelError(f"{what}: joint {name!r} names the link {end!r}, which is not there")
        if ends[1] in into:
            raise ModelError(
                f"{what}: the link {ends[1]!r} is the child of two joints, {name!r} and another; it can have one"
            )
        into[ends[1]] = joint
    balance = any(c.get("balanceinertia") == "true" for c in root.iter("compiler"))
    order, bodies = _order(links, into, what), []
    number = {name: i for i, name in enumerate(order)}
    for name in order:
        body = _body(name, links[name], into.get(name), number, (what, balance))
        bodies.append(
            body._replace(meshes=tuple(m for e in links[name] for m in _mesh(e, path, f"{what}: link {name!r}")))
        )
    frames = tuple(Frame(b.name, i, here()) for i, b in enumerate(bodies))
    return Tree(what, "URDF", tuple(bodies), frames, ())


def _named(elements: list[ET.Element], kind: str, what: str) -> dict[str, ET.Element]:
    out: dict[str, ET.Element] = {}
    for element in elements:
        name = element.get("name") or ""
        if not name:
            raise ModelError(f"{what}: a <{kind}> has no name; name it in the file")
        if name in out:
            raise ModelError(f"{what}: two of its {kind}s are called {name!r}; rename one")
        out[name] = element
    return out


def _end(joint: ET.Element, end: str, name: str, what: str) -> str:
    element = joint.find(end)
    if element is None or not element.get("link"):
        raise ModelError(f"{what}: joint {name!r} lacks <{end} link=…/>")
    return str(element.get("link"))


def _order(links: dict[str, ET.Element], into: dict[str, ET.Element], what: str) -> list[str]:
    # Parents first, whatever their order in the file.
    out: list[str] = []
    placed: set[str | None] = set()
    waiting = list(links)
    while waiting:
        ready = [n for n in waiting if n not in into or _get(into[n], "parent", "link") in placed]
        if not ready:
            raise ModelError(f"{what}: the joints make a loop of the links {', '.join(waiting)}; a serial arm has none")
        out += ready
        placed |= set(ready)
        waiting = [n for n in waiting if n not in placed]
    return out


def _body(name: str, link: ET.Element, joint: ET.Element | None, number: dict[str, int], how: tuple[str, bool]) -> Body:
    what, balance = how
    inertial, complaint = _inertial(name, link.find("inertial"), what, balance)
    shapes = tuple(s for e in link for s in _shape(e, f"{what}: link {name!r}"))
    if joint is None:
        return Body(name, -1, here(), (), inertial, shapes, complaint)
    called, parent = str(joint.get("name")), number[str(_get(joint, "parent", "link"))]
    where = f"{what}: joint {called!r}"
    at = _pose(joint.find("origin"), where)
    kind = joint.get("type", "")
    if kind == "fixed":
        return Body(name, parent, at, (), inertial, shapes, complaint)
    if kind not in KINDS:
        raise ModelError(f"{where} has the type {kind!r}; known are fixed, {', '.join(KINDS)}")
    return Body(name, parent, at, (_joint(called, kind, joint, where),), inertial, shapes, complaint)


def _joint(name: str, kind: str, element: ET.Element, where: str) -> Joint:
    axis = np.array(numbers(_get(element, "axis", "xyz"), 3, (1.0, 0.0, 0.0), f"{where}: axis"))
    length = float(np.linalg.norm(axis))
    if length < 1e-6 and KINDS[kind] in (HINGE, SLIDE):
        raise ModelError(f"{where}: its axis is 0 0 0; give the direction in which it turns")
    limit: dict[str, float | None] = {}
    for key in ("lower", "upper", "effort", "velocity"):
        text = _get(element, "limit", key)
        # Where a number is written as infinite, it is no limit.
        endless = text is not None and text.strip().lower().lstrip("+-") in ("inf", "infinity", "nan", ".inf")
        limit[key] = None if text is None or endless else numbers(text, 1, (), f"{where}: limit {key}")[0]
    dynamics = {k: _get(element, "dynamics", k) for k in ("damping", "friction")}
    felt = {
        k: None if t is None else Value(abs(numbers(t, 1, (0.0,), f"{where}: {k}")[0]), FILE)
        for k, t in dynamics.items()
    }
    low, high = _range(kind, limit["lower"], limit["upper"])
    return Joint(
        name,
        KINDS[kind],  # type: ignore[arg-type]
        np.zeros(3),
        axis / max(length, 1e-6),
        low=low,
        high=high,
        speed=_said(limit["velocity"]),
        torque=_said(limit["effort"]),
        friction=felt["friction"],
        damping=felt["damping"],
        follows=_mimic(element, where),
    )


def _range(kind: str, low: float | None, high: float | None) -> tuple[Value | None, Value | None]:
    # By the format's definition a continuous joint has no ends, whatever its <limit> says.
    if kind == "continuous" or (low or 0.0) == (high or 0.0) == 0.0:
        return None, None
    return Value(low or 0.0, FILE if low is not None else "default"), Value(
        high or 0.0, FILE if high is not None else "default"
    )


def _said(number: float | None) -> Value | None:
    return None if number is None or number == 0.0 else Value(abs(number), FILE)


def _mimic(element: ET.Element, where: str) -> tuple[str, float, float] | None:
    mimic = element.find("mimic")
    if mimic is None or not mimic.get("joint"):
        return None
    factor = numbers(mimic.get("multiplier"), 1, (1.0,), f"{where}: mimic multiplier")[0]
    return str(mimic.get("joint")), factor, numbers(mimic.get("offset"), 1, (0.0,), f"{where}: mimic offset")[0]


def _get(element: ET.Element, child: str, key: str) -> str | None:
    found = element.find(child)
    return None if found is None else found.get(key)


def _pose(origin: ET.Element | None, where: str) -> Pose:
    if origin is None:
        return here()
    pos = np.array(numbers(origin.get("xyz"), 3, (0.0, 0.0, 0.0), f"{where}: origin xyz"))
    rpy = numbers(origin.get("rpy"), 3, (0.0, 0.0, 0.0), f"{where}: origin rpy")
    quat = np.array([1.0, 0.0, 0.0, 0.0])
    if any(rpy):
        # Roll, pitch, yaw about the parent's fixed axes.
        mujoco.mju_euler2Quat(quat, np.array(rpy), "XYZ")
    return Pose(pos, quat)


def _inertial(name: str, element: ET.Element | None, what: str, balance: bool) -> tuple[Inertial | None, str]:
    if element is None:
        return None, ""
    where = f"{what}: link {name!r}"
    mass = numbers(_get(element, "mass", "value"), 1, (0.0,), f"{where}: mass")[0]
    if mass < 0.0:
        return None, f"link {name!r} has a mass of {mass:g} kg; it must be above 0"
    at = _pose(element.find("origin"), where)
    xx, yy, zz, xy, xz, yz = (
        numbers(_get(element, "inertia", k), 1, (0.0,), f"{where}: inertia {k}")[0]
        for k in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
    )
    moments, turn = principal(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]))
    complaint = ""
    if balance and lacking(moments) > 0.0:
        moments = np.full(3, moments.mean())
    elif lacking(moments) > 0.0:
        complaint = impossible(name, moments)
        moments = raised(moments)
    at = at.then(Pose(np.zeros(3), turn))
    return extended(Inertial(mass, at.pos, at.quat, np.maximum(moments, 0.0))), complaint


def _shape(part: ET.Element, where: str) -> list[Shape]:
    geometry = part.find("geometry") if part.tag in ("visual", "collision") else None
    if geometry is None:
        return []
    rgba = _colour(_get(part.find("material") or part, "color", "rgba"))
    touches, at = part.tag == "collision", _pose(part.find("origin"), where)
    for solid in geometry:
        half = _size(solid, where)
        if half is not None and half[1].max() > 0.0:
            return [Shape(half[0], half[1], at, rgba, touches=touches)]
    return []


def _mesh(part: ET.Element, path: Path, where: str) -> list[Mesh]:
    mesh = part.find("geometry/mesh") if part.tag in ("visual", "collision") else None
    name = mesh.get("filename") if mesh is not None else None
    if mesh is None or not name:
        return []
    scale = np.array(numbers(mesh.get("scale"), 3, (1.0, 1.0, 1.0), f"{where}: scale of a mesh"))
    return [Mesh(mesh_file(name, path), scale, _pose(part.find("origin"), where), part.tag == "collision")]


def _colour(text: str | None) -> np.ndarray:
    # Nothing depends on it: one that nobody can read is grey.
    try:
        return np.array(numbers(text, 4, GREY, "colour"))
    except ModelError:
        return np.array(GREY)


def _size(solid: ET.Element, where: str) -> tuple[str, np.ndarray] | None:
    if solid.tag == "box":
        return "box", 0.5 * np.abs(numbers(solid.get("size"), 3, (0.0, 0.0, 0.0), f"{where}: box size"))
    if solid.tag in ("cylinder", "capsule", "sphere"):
        radius = abs(numbers(solid.get("radius"), 1, (0.0,), f"{where}: radius")[0])
        length = abs(numbers(solid.get("length"), 1, (0.0,), f"{where}: length")[0])
        return solid.tag, np.array([radius, 0.5 * length, 0.0])
    return None
