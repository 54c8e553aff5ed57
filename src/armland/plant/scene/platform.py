"""The platform on six legs in the scene: a body on joints of its own between deck and pad.

Its pose is set at each tick as the deck's is, see `scene.deck`: six stiff legs are not moved by a UAV of half a kilogram. The frame of
the platform is the deck's in its neutral pose, so that whoever knows the one as the deck may know the other as it.
"""

import mujoco
import numpy as np

from armland.models.unaided.hexapod import joints_of
from armland.plant.scene.deck import INERTIA, ground
from armland.rotations import Array
from armland.scenario import Scenario

PLATFORM = "platform"

JOINTS = tuple(f"{PLATFORM}_{name}" for name in ("x", "y", "z", "yaw", "pitch", "roll"))
"""From deck to platform: displacement of its middle, then its attitude Rz Ry Rx about it."""

LEG_RADIUS_M = 0.018

HEADS_BELOW_M = 0.04
"""Heads of the legs below the platform's middle, which lies on the pad's surface."""


def put_on_platform(pad: mujoco.MjSpec, middle: Array) -> mujoco.MjSpec:
    """A scene with the platform alone, turning about `middle` (3,), m, D, and all of `pad` on it."""
    spec = mujoco.MjSpec()
    spec.compiler.degree, spec.compiler.autolimits = False, True
    body = spec.worldbody.add_body(name=PLATFORM, mass=1.0, inertia=[1.0, 1.0, 1.0], explicitinertial=True)
    slide, hinge = mujoco.mjtJoint.mjJNT_SLIDE, mujoco.mjtJoint.mjJNT_HINGE
    axes = np.vstack([np.eye(3), np.eye(3)[::-1]])
    for name, kind, axis in zip(JOINTS, 3 * [slide] + 3 * [hinge], axes, strict=True):
        body.add_joint(name=name, type=kind, axis=axis, pos=middle, armature=INERTIA)
    spec.attach(pad, prefix="", frame=body.add_frame())
    return spec


def draw_legs(spec: mujoco.MjSpec, middle: Array, feet: Array, heads: Array) -> None:
    """Draw the legs' lower halves on the deck and their upper ones on the platform, as they stand in the neutral pose.

    Args:
        spec: of deck and platform.
        middle: (3,), m, D.
        feet: (6, 3), m, D.
        heads: (6, 3), m, from the middle.
    """
    look = {"type": mujoco.mjtGeom.mjGEOM_CAPSULE, "mass": 0, "group": 2}
    deck, platform = ground(spec), spec.body(PLATFORM)
    for foot, head in zip(feet, heads + middle, strict=True):
        half = 0.5 * (foot + head)
        deck.add_geom(fromto=[*foot, *half], size=[LEG_RADIUS_M, 0, 0], rgba=[0.3, 0.32, 0.36, 1], **look)
        platform.add_geom(fromto=[*half, *head], size=[0.6 * LEG_RADIUS_M, 0, 0], rgba=[0.75, 0.77, 0.8, 1], **look)


def geometry(scenario: Scenario) -> tuple[Array, Array, Array]:
    """Middle (3,), feet and heads (6, 3), m: of a scenario's platform, D, D and P."""
    h, catch = scenario.hexapod, scenario.place.catch_m
    feet, heads = joints_of(h.foot_radius_m, h.head_radius_m, HEADS_BELOW_M)
    return np.array([catch[0], catch[1], scenario.pad.height_m]), feet + [catch[0], catch[1], 0.0], heads


def has_platform(model: mujoco.MjModel) -> bool:
    """Whether a scene has a platform."""
    return int(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, JOINTS[0])) >= 0
