"""MJCF into a `Tree`: MuJoCo's own reader and compiler say what the file means, after all that is not the robot is taken out.

Kept of the file are `compiler`, `default`, `worldbody` and the actuators of joints. Options, flags, sizes, sensors, keyframes, tendons,
equalities, contact tables, cameras, lights, textures and plug-ins are left behind. Meshes are opened only where a body's mass is
to come from them.
"""

import copy
import re
import xml.etree.ElementTree as ET
from pathlib import Path

import mujoco
import numpy as np

from armland.errors import ModelError
from armland.models.arm_file.formats import actuators
from armland.models.arm_file.formats.marks import MARK, Mark, mark, meshes
from armland.models.arm_file.formats.text import included, numbers
from armland.models.arm_file.inertia import NOTHING, extended, impossible, lacking, principal
from armland.models.arm_file.tree import CLASS, FILE, Body, Frame, Inertial, Joint, Kind, Pose, Shape, Tree, Value, here

KEPT = ("compiler", "default", "worldbody", "asset", "actuator")
NO_PART = ("camera", "light", "plugin", "flexcomp", "composite", "attach")
MESHES = (
    mujoco.mjtGeom.mjGEOM_MESH,
    mujoco.mjtGeom.mjGEOM_HFIELD,
    mujoco.mjtGeom.mjGEOM_SDF,
    mujoco.mjtGeom.mjGEOM_PLANE,
)
KINDS: dict[int, Kind] = {
    int(mujoco.mjtJoint.mjJNT_HINGE): "hinge",
    int(mujoco.mjtJoint.mjJNT_SLIDE): "slide",
    int(mujoco.mjtJoint.mjJNT_BALL): "ball",
    int(mujoco.mjtJoint.mjJNT_FREE): "free",
}
SOLIDS = {
    int(getattr(mujoco.mjtGeom, f"mjGEOM_{kind.upper()}")): kind
    for kind in ("sphere", "capsule", "cylinder", "box", "ellipsoid")
}
OWN = {"speed": "joint_speed_rad_s", "torque_rate": "torque_rate_nm_s"}
"""What MJCF has no word for: `<custom><numeric name=…/>`, one number for each joint in the order of the file."""

UNKNOWN = re.compile(r"unrecognized attribute: '([^']+)' Element '([^']+)'")

PART = "it may be a part that other files include; give the file that includes it"
"""What is said of a file without a robot."""

TINY = 1e-9
"""kg and kg·m² that stand for nothing while the file is compiled."""


def read_mjcf(root: ET.Element, path: Path, what: str) -> Tree:
    """The robot of an MJCF file.

    Args:
        root: its `<mujoco>`.
        path: of the file; what it includes stands beside it.
        what: its name in messages.

    Raises:
        ModelError: what MuJoCo complains of, or a body without mass where its meshes are missing.
    """
    root = included(root, path, what)
    if root.find("./worldbody//body") is None and root.find("./worldbody//frame") is None:
        raise ModelError(f"{what} has no <body> in its <worldbody>: {PART}")
    own = _own(root, what)
    model, complaints, marks = _compiled(_robot(root), path, what)
    written = {j.get("name", ""): j for j in root.iter("joint")}
    bodies = tuple(_body(model, i, complaints)._replace(meshes=meshes(model, i, marks)) for i in range(1, model.nbody))
    joints = _joints(model, written, own)
    bodies = tuple(b._replace(joints=tuple(joints[i + 1])) for i, b in enumerate(bodies))
    frames = [Frame(b.name, i, here()) for i, b in enumerate(bodies)]
    for i in range(model.nsite):
        if model.site_bodyid[i] > 0 and model.site(i).name:
            at = Pose(model.site_pos[i].copy(), model.site_quat[i].copy())
            frames.append(Frame(model.site(i).name, int(model.site_bodyid[i]) - 1, at))
    return Tree(what, "MJCF", bodies, tuple(frames), ())


def _own(root: ET.Element, what: str) -> dict[str, tuple[float, ...]]:
    out = {}
    for numeric in root.iter("numeric"):
        for field, name in OWN.items():
            if numeric.get("name") == name:
                text = numeric.get("data", "")
                out[field] = numbers(text, len(text.split()), (), f"{what}: numeric {name}")
    return out


def _robot(root: ET.Element) -> ET.Element:
    # The file without what is not the robot; several sections of one name are legal.
    out = ET.Element("mujoco", {"model": root.get("model", "arm")})
    for section in root:
        if section.tag not in KEPT:
            continue
        part = copy.deepcopy(section)
        if section.tag == "actuator":
            for actuator in list(part):
                if actuator.tag == "plugin" or not (actuator.get("joint") or actuator.get("jointinparent")):
                    part.remove(actuator)
        if section.tag == "asset":
            for asset in list(part):
                if asset.tag not in ("mesh", "material") or asset.find("plugin") is not None:
                    part.remove(asset)
        for parent in list(part.iter()):
            parent.attrib.pop("texture", None)
            for child in list(parent):
                if child.tag in NO_PART or (child.tag == "layer" and parent.tag == "material"):
                    parent.remove(child)
        out.append(part)
    return out


def _compiled(root: ET.Element, path: Path, what: str) -> tuple[mujoco.MjModel, dict[str, str], dict[str, Mark]]:
    try:
        spec = parsed(root)
        spec.modelfiledir = str(path.parent)
        marks, complaints = mark(spec, path), _drop_meshes(spec, path)
        c = spec.compiler
        c.fusestatic, c.discardvisual, c.settotalmass = False, False, -1.0
        c.boundmass, c.boundinertia = max(c.boundmass, TINY), max(c.boundinertia, TINY)
        if not c.balanceinertia:
            complaints |= _balance(spec)
        actuators.forget_lengths(spec)
        return spec.compile(), complaints, marks
    except (ValueError, mujoco.FatalError) as e:
        raise ModelError(f"{what} cannot be read: {' '.join(str(e).split())}") from e


def parsed(root: ET.Element) -> mujoco.MjSpec:
    """The spec of an MJCF's `root`, without the attributes that this version of MuJoCo does not know.

    Raises:
        ValueError: what MuJoCo complains of besides.
    """
    # Versions of MuJoCo differ in what they know; what this one does not is left behind.
    for _ in range(50):
        try:
            return mujoco.MjSpec.from_string(ET.tostring(root, encoding="unicode"))
        except ValueError as e:
            found = UNKNOWN.search(" ".join(str(e).split()))
            if found is None:
                raise
            attribute, tag = found.groups()
            for element in root.iter(tag):
                element.attrib.pop(attribute, None)
    return mujoco.MjSpec.from_string(ET.tostring(root, encoding="unicode"))


def _drop_meshes(spec: mujoco.MjSpec, path: Path) -> dict[str, str]:
    # Meshes are opened only where a moving body has no other source of its mass.
    complaints, needed = {}, set()
    for body in spec.bodies:
        shapes = [g for g in body.geoms if g.type in MESHES or g.meshname]
        weighs = [g for g in body.geoms if g.mass != 0.0 and g.density != 0.0]
        solid, other = [g for g in weighs if g.meshname], any(not g.meshname for g in weighs)
        if other:
            # What is drawn beside a shape may be that shape again; a mass that is said is one.
            solid = [g for g in solid if np.isfinite(g.mass)]
        wanted = not body.explicitinertial and body.name != "world" and solid
        files = {g.meshname: _mesh_file(spec, g.meshname, path) for g in solid}
        if wanted and all(f is not None for f in files.values()):
            needed |= set(files)
            shapes = [g for g in shapes if g.meshname not in files]
        elif wanted and not other:
            missing = next(n for n, f in files.items() if f is None)
            complaints[body.name] = (
                f"body {body.name!r} has no <inertial>, and the mesh {missing!r} from which its mass would come is not there; "
                "give it an <inertial>, or put the mesh where the file says"
            )
        for geom in shapes:
            spec.delete(geom)
    for mesh in list(spec.meshes):
        if mesh.name not in needed:
            spec.delete(mesh)
    return complaints


def _mesh_file(spec: mujoco.MjSpec, name: str, path: Path) -> Path | None:
    mesh = spec.mesh(name)
    if mesh is None:
        return None
    if not mesh.file:
        return path if len(mesh.uservert) else None
    file = path.parent / (spec.meshdir or "") / mesh.file
    return file if file.is_file() else None


def _balance(spec: mujoco.MjSpec) -> dict[str, str]:
    # MuJoCo refuses without a name; a little is rounding, and the bodies that miss more complain where they move.
    out = {}
    for body in spec.bodies:
        if not body.explicitinertial:
            continue
        full = np.array(body.fullinertia)
        if np.isfinite(full).all() and full.any():
            xx, yy, zz, xy, xz, yz = full
            moments, _ = principal(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]))
        else:
            moments, full = np.array(body.inertia), np.full(6, np.nan)
        if body.mass < 0.0 or lacking(moments) > 0.0:
            text = (
                impossible(body.name, moments)
                if body.mass >= 0.0
                else f"body {body.name!r} has a mass of {body.mass:g} kg"
            )
            if text:
                out[body.name] = text
            body.mass = abs(body.mass)
            a, b, c = np.sort(moments)
            more = (max(c - a - b, 0.0) + max(-a, 0.0)) * (1.0 + 1e-9)
            if np.isfinite(full).all():
                body.fullinertia = full + more * np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
            else:
                body.inertia = moments + more
    return out


def _body(model: mujoco.MjModel, i: int, complaints: dict[str, str]) -> Body:
    own = model.body(i).name
    inertial = None
    if model.body_mass[i] > NOTHING:
        moments = np.where(model.body_inertia[i] > 2.0 * TINY, model.body_inertia[i], 0.0)
        inertial = extended(
            Inertial(float(model.body_mass[i]), model.body_ipos[i].copy(), model.body_iquat[i].copy(), moments)
        )
    first, count = model.body_geomadr[i], model.body_geomnum[i]
    shapes = tuple(s for g in range(first, first + count) if (s := _shape(model, g)) is not None)
    at = Pose(model.body_pos[i].copy(), model.body_quat[i].copy())
    name = own or f"body_{i}"
    return Body(name, int(model.body_parentid[i]) - 1, at, (), inertial, shapes, complaints.get(own, "") if own else "")


def _shape(model: mujoco.MjModel, g: int) -> Shape | None:
    kind = SOLIDS.get(int(model.geom_type[g]))
    if kind is None or model.geom(g).name.startswith(MARK):
        return None
    material = int(model.geom_matid[g])
    rgba, gloss = model.geom_rgba[g].astype(float), (0.5, 0.5)
    if material >= 0:
        gloss = float(model.mat_specular[material]), float(model.mat_shininess[material])
        if (model.geom_rgba[g] == np.array([0.5, 0.5, 0.5, 1.0], dtype=np.float32)).all():
            rgba = model.mat_rgba[material].astype(float)
    touches = bool(model.geom_contype[g] or model.geom_conaffinity[g])
    return Shape(
        kind, model.geom_size[g].copy(), Pose(model.geom_pos[g].copy(), model.geom_quat[g].copy()), rgba, gloss, touches
    )


def _joints(
    model: mujoco.MjModel, written: dict[str, ET.Element], own: dict[str, tuple[float, ...]]
) -> list[list[Joint]]:
    out: list[list[Joint]] = [[] for _ in range(model.nbody)]
    driven = actuators.limits(model)
    for j in range(model.njnt):
        body, name = int(model.jnt_bodyid[j]), model.joint(j).name
        element = written.get(name) if name else None
        said = {f: Value(row[j], FILE) for f, row in own.items() if j < len(row)}
        named = name or f"{model.body(body).name or f'body_{body}'}/joint"
        out[body].append(_joint(model, j, named, element, driven.get(j, {}) | said))
    return out


def _joint(model: mujoco.MjModel, j: int, name: str, element: ET.Element | None, more: dict[str, Value]) -> Joint:
    kind, at = KINDS[int(model.jnt_type[j])], (model.jnt_pos[j].copy(), model.jnt_axis[j].copy())
    if kind in ("ball", "free"):
        return Joint(name, kind, *at)
    dof = int(model.jnt_dofadr[j])

    def source(key: str) -> str:
        return FILE if element is not None and element.get(key) is not None else CLASS

    def said(key: str, number: float) -> Value | None:
        return Value(float(number), source(key)) if number or source(key) == FILE else None

    low = high = None
    if model.jnt_limited[j]:
        low, high = (Value(float(x), source("range")) for x in model.jnt_range[j])
    bound = actuators.least(model.jnt_actfrcrange[j]) if model.jnt_actfrclimited[j] else None
    if bound is not None:
        torque = Value(bound, source("actuatorfrcrange"))
        if "torque" not in more or torque.number <= more["torque"].number:
            more = more | {"torque": torque}
    return Joint(
        name,
        kind,
        *at,
        ref=float(model.qpos0[model.jnt_qposadr[j]]),
        low=low,
        high=high,
        friction=said("frictionloss", model.dof_frictionloss[dof]),
        damping=said("damping", model.dof_damping[dof]),
        armature=said("armature", model.dof_armature[dof]),
        speed=more.get("speed"),
        torque=more.get("torque"),
        torque_rate=more.get("torque_rate"),
    )
