"""The arm in the scene: a motor on each joint, shapes that can touch, and an arm heavier than its file says."""

import mujoco
import numpy as np

from armland.models.description import compile_spec
from armland.plant.scene.deck import DECK
from armland.rotations import Array

LINK_RADIUS_M = 0.06
"""Of the capsules that stand for the arm's links. Assumption: the LWR's links are 0.12 m wide."""


def add_motors(spec: mujoco.MjSpec) -> None:
    """Put one motor of unit gear on each joint of `spec`, in place of whatever actuators its file brings."""
    for actuator in list(spec.actuators):
        spec.delete(actuator)
    for joint in spec.joints:
        motor = spec.add_actuator(name=f"motor_{joint.name}", target=joint.name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        motor.set_to_motor()


def add_links(spec: mujoco.MjSpec, radius: float = LINK_RADIUS_M) -> list[str]:
    """Cover the arm's outer half with capsules of `radius` m from joint to joint; returns their names.

    Only the outer half can reach the cradle, the floor or the UAV.
    """
    model = compile_spec(spec, "the arm")
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    names = []
    for i in range(model.njnt // 2, model.njnt - 1):
        body = int(model.jnt_bodyid[i])
        ends = (data.xanchor[[i, i + 1]] - data.xpos[body]) @ data.xmat[body].reshape(3, 3)
        if np.linalg.norm(ends[1] - ends[0]) < 2.0 * radius:
            # Too short for a capsule that ends at its joints: a sphere.
            ends = ends.mean(axis=0) + np.array([[0.0, 0.0, -1e-4], [0.0, 0.0, 1e-4]])
        names.append(f"link_{i + 1}_shape")
        add_capsule(spec.joint(model.joint(i).name).parent, names[-1], ends.ravel(), radius)
    return names


def add_capsule(body: mujoco.MjsBody, name: str, ends: list[float] | Array, radius: float) -> None:
    """Give `body` a massless capsule of `radius` m between `ends` (6,) m, that touches but is not drawn."""
    body.add_geom(name=name, type=mujoco.mjtGeom.mjGEOM_CAPSULE, fromto=ends, size=[radius, 0, 0], mass=0, group=3)


def scale_inertia(model: mujoco.MjModel, scale: float, joints: list[int]) -> None:
    """Multiply masses and inertias of the bodies that `joints` move, tool included, and the joints' armature by `scale`.

    The UAV keeps its own. `scale` is a ratio; with 1 nothing is touched.
    """
    if scale == 1.0:
        return
    stands_on = {0, *(b for b in range(model.nbody) if model.body(b).name == DECK)}
    root = int(model.jnt_bodyid[joints[0]])
    while (parent := int(model.body_parentid[root])) not in stands_on:
        root = parent
    arm = {root}
    for body in range(root + 1, model.nbody):
        if int(model.body_parentid[body]) in arm:
            arm.add(body)
    for body in sorted(arm):
        if not model.body(body).name.startswith("uav/"):
            model.body_mass[body] *= scale
            model.body_inertia[body] *= scale
    model.dof_armature[model.jnt_dofadr[joints]] *= scale
    mujoco.mj_setConst(model, mujoco.MjData(model))
