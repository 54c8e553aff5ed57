"""What an arm needs to hold itself, and how far it reaches, from poses drawn over its joints' ranges."""

import mujoco
import numpy as np

from armland.rotations import Array

SAMPLES = 1500
GRAVITY = 9.81


def demand(model: mujoco.MjModel, site: str) -> tuple[Array, Array]:
    """Worst over poses, whatever the direction of gravity: for bases on walls and ceilings too.

    Args:
        model: the arm alone.
        site: of its end effector.

    Returns:
        Torque of the links' own weight (n,), N·m or N, and distance of the end effector from each joint's axis (n,), m.
    """
    own, lever = np.zeros(model.nv), np.zeros(model.nv)
    data, at = mujoco.MjData(model), model.site(site).id
    slide, mass = model.jnt_type == int(mujoco.mjtJoint.mjJNT_SLIDE), model.body_subtreemass[model.jnt_bodyid]
    for q in poses(model):
        place(model, data, q)
        com = data.subtree_com[model.jnt_bodyid] - data.xanchor
        arm = np.linalg.norm(np.cross(data.xaxis, com), axis=1)
        own = np.maximum(own, GRAVITY * mass * np.where(slide, 1.0, arm))
        out = np.linalg.norm(np.cross(data.xaxis, data.site_xpos[at] - data.xanchor), axis=1)
        lever = np.maximum(lever, np.where(slide, 1.0, out))
    return own, lever


def held(model: mujoco.MjModel) -> Array:
    """Worst torque (n,), N·m or N, of the weight of links and tool over poses, the base as its file has it."""
    data, slide = mujoco.MjData(model), model.jnt_type == int(mujoco.mjtJoint.mjJNT_SLIDE)
    worst, mass = np.zeros(model.nv), model.body_subtreemass[model.jnt_bodyid]
    for q in poses(model):
        place(model, data, q)
        com = data.subtree_com[model.jnt_bodyid] - data.xanchor
        turning = np.cross(com, [0.0, 0.0, -GRAVITY])
        share = np.where(slide, GRAVITY * data.xaxis[:, 2], np.einsum("ij,ij->i", turning, data.xaxis))
        worst = np.maximum(worst, np.abs(share) * mass)
    return worst


def reach(model: mujoco.MjModel, site: str) -> float:
    """Largest distance of the end effector from the second joint, m: the shoulder of most arms."""
    data, at = mujoco.MjData(model), model.site(site).id
    most = 0.0
    for q in poses(model):
        place(model, data, q)
        most = max(most, float(np.linalg.norm(data.site_xpos[at] - data.xanchor[1])))
    return most


def poses(model: mujoco.MjModel) -> Array:
    """Joint positions (k, n) over the ranges, at most half a turn each way; always the same."""
    rng = np.random.default_rng(1)
    low, high = np.maximum(model.jnt_range[:, 0], -np.pi), np.minimum(model.jnt_range[:, 1], np.pi)
    return rng.uniform(low, high, (SAMPLES, model.nv))


def place(model: mujoco.MjModel, data: mujoco.MjData, q: Array) -> None:
    """Put the arm at joint positions `q` (n,), rad or m, with what MuJoCo derives of places and masses."""
    data.qpos[:] = q
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
