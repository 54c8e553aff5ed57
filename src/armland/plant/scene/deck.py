"""The deck that carries arm and cradle where the sea moves it: a body on joints of its own, D in W.

A mocap body passes no velocity to contacts and joints. So the deck is a dynamic body whose joints have so much reflected inertia
that nothing on it moves it; `sea.deck` sets its state at each tick and applies the force that its acceleration needs. On a
calm sea there is no such body: what stands on the ground belongs to the world.
"""

import mujoco
import numpy as np

DECK = "deck"

JOINTS = tuple(f"{DECK}_{name}" for name in ("surge", "sway", "heave", "yaw", "pitch", "roll"))
"""From the world to the deck: its attitude in W is Rz Ry Rx."""

INERTIA = 1e6
"""Reflected inertia of each joint, kg, kg·m²: 200 N of arm and cradle accelerate it by 2e-4 m/s², and their weight is fed forward.
More would drown the solver's residual in the rounding of 1e6 kg times the deck's acceleration."""

FLOOR_M = (20.0, 20.0, 0.5)
"""Half sizes of the deck's floor: MuJoCo has planes in the world alone."""


def put_on_deck(arm: mujoco.MjSpec) -> mujoco.MjSpec:
    """A scene with the deck alone, and all of `arm` on it under the names that it has."""
    spec = mujoco.MjSpec()
    spec.modelname, spec.compiler.degree = arm.modelname, False
    spec.compiler.autolimits, spec.compiler.fusestatic = True, False
    deck = spec.worldbody.add_body(name=DECK, mass=1.0, inertia=[1.0, 1.0, 1.0], explicitinertial=True)
    slide, hinge = mujoco.mjtJoint.mjJNT_SLIDE, mujoco.mjtJoint.mjJNT_HINGE
    kinds, axes = 3 * [slide] + 3 * [hinge], np.vstack([np.eye(3), np.eye(3)[::-1]])
    for name, kind, axis in zip(JOINTS, kinds, axes, strict=True):
        deck.add_joint(name=name, type=kind, axis=axis, armature=INERTIA)
    spec.attach(arm, prefix="", frame=deck.add_frame())
    return spec


def ground(spec: mujoco.MjSpec) -> mujoco.MjsBody:
    """What arm and cradle stand on: the deck, or the world where there is none."""
    return next((b for b in spec.bodies if b.name == DECK), spec.worldbody)


def moves(model: mujoco.MjModel) -> bool:
    """Whether the scene has a deck of its own."""
    return int(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, DECK)) > 0


def settle_solver(model: mujoco.MjModel) -> None:
    """Let MuJoCo's solver go on until its residual is as small for the inertia of all but the deck as on land it is for that of all.

    MuJoCo measures it by the mean inertia, of which the deck is nearly all. By that it stops while the hinge of a UAV on the cradle is
    1 N and more off, in another way at each tick; to go on costs fewer iterations, since each tick begins where the one before ended.
    """
    if not moves(model):
        return
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    M = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, M)
    own = np.diag(M)[model.dof_armature < INERTIA]
    model.opt.tolerance *= own.mean() / np.diag(M).mean()
