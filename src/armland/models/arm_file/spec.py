"""From chain and table to a MuJoCo spec that holds the arm and nothing else of its file.

Every name begins with `arm/`, so that no file can clash with what armland puts beside it. Shapes neither weigh nor collide by
themselves: what may touch is the scene's to say.
"""

import mujoco
import numpy as np

from armland.models.arm_file.chain import Chain, Link
from armland.models.arm_file.table import Row
from armland.models.arm_file.tree import Joint, Shape

PREFIX = "arm/"
"""Of every name that comes from the arm's file."""

SHAPE = f"{PREFIX}shape_"
"""What the arm is touched at: the shapes of a link that its file means for contact, else those that it draws, else what stands for a
link without any. This, a number, and after a colon the body of the file."""

SEEN, HIDDEN = 2, 3
"""Groups of MuJoCo's shapes: drawn, and not drawn."""


def arm_spec(chain: Chain, rows: list[Row]) -> mujoco.MjSpec:
    """The arm alone: bodies, joints, inertias, limits and shapes, and a site at its end effector, see `ee_site`."""
    spec = mujoco.MjSpec()
    spec.modelname = "arm"
    spec.compiler.degree, spec.compiler.autolimits, spec.compiler.fusestatic = False, True, False
    body, left = spec.worldbody, list(rows)
    for link in chain.links:
        body = _add_link(spec, body, link)
        for joint in link.joints:
            _add_joint(body, joint, left.pop(0))
    body.add_site(name=ee_site(chain), pos=chain.ee.pos, quat=chain.ee.quat)
    return spec


def ee_site(chain: Chain) -> str:
    """Name of the site at the end effector."""
    return f"{PREFIX}{chain.tip.label}"


def _add_link(spec: mujoco.MjSpec, parent: mujoco.MjsBody, link: Link) -> mujoco.MjsBody:
    body = parent.add_body(name=f"{PREFIX}{link.name}", pos=link.pose.pos, quat=link.pose.quat)
    if link.inertial is not None:
        i = link.inertial
        body.mass, body.ipos, body.iquat, body.inertia = i.mass, i.pos, i.quat, i.moments
        body.explicitinertial = True
    painted, meant = (any(s.touches is way for s in link.shapes) for way in (False, True))
    for shape in link.shapes:
        name = f"{SHAPE}{len(spec.geoms)}:{shape.of}" if shape.touches or not meant else ""
        _add_shape(spec, body, shape, name, HIDDEN if shape.touches and painted else SEEN)
    return body


def _add_shape(spec: mujoco.MjSpec, body: mujoco.MjsBody, shape: Shape, name: str, group: int) -> None:
    count = len(spec.materials)
    material = next((m.name for m in spec.materials if _looks(m, shape)), None)
    if material is None:
        material = f"{PREFIX}{count}"
        spec.add_material(name=material, rgba=shape.rgba, specular=shape.gloss[0], shininess=shape.gloss[1])
    body.add_geom(
        name=name,
        type=getattr(mujoco.mjtGeom, f"mjGEOM_{shape.kind.upper()}"),
        size=shape.size,
        pos=shape.pose.pos,
        quat=shape.pose.quat,
        material=material,
        mass=0.0,
        contype=0,
        conaffinity=0,
        group=group,
    )


def _looks(material: mujoco.MjsMaterial, shape: Shape) -> bool:
    same = np.allclose(material.rgba, shape.rgba, atol=1e-6)
    return bool(same and np.allclose([material.specular, material.shininess], shape.gloss, atol=1e-6))


def _add_joint(body: mujoco.MjsBody, joint: Joint, row: Row) -> None:
    kind = mujoco.mjtJoint.mjJNT_HINGE if joint.kind == "hinge" else mujoco.mjtJoint.mjJNT_SLIDE
    limit = row.torque.number
    body.add_joint(
        name=f"{PREFIX}{joint.name}",
        type=kind,
        pos=joint.pos,
        axis=joint.axis,
        ref=joint.ref,
        limited=mujoco.mjtLimited.mjLIMITED_TRUE,
        range=[row.low.number, row.high.number],
        actfrclimited=mujoco.mjtLimited.mjLIMITED_TRUE,
        actfrcrange=[-limit, limit],
        frictionloss=row.friction.number,
        damping=[row.damping.number, 0.0, 0.0],
        armature=row.armature.number,
    )
