"""How near the arm came to a singularity by its true joint angles: from the plant's joint axes, not from what a sensor said.

| symbol | name | unit |
|---|---|---|
| c_i, a_i | `anchor`, `axis`: a point on joint i's axis and its direction at q₀, base axes | m, 1 |
| q₀ | `q` | rad, m |
| 𝒥 (6, n) | column i: [a_i × (x − c_i); a_i] of a hinge, [a_i; 0] of a slide; x: end effector point | m, 1 |

Each joint moves all that is behind it (product of exponentials), so one pass along the chain gives 𝒥 at all ticks at once.
"""

from typing import NamedTuple

import mujoco
import numpy as np

from armland.models.description import EE_SITE
from armland.plant.scene.composition import Scene
from armland.rotations import Array


class Screws(NamedTuple):
    """The chain of the joints that move the end effector."""

    joint: list[int]  # Index in q of each
    hinge: list[bool]  # Else it slides
    q: list[float]
    anchor: list[list[float]]
    axis: list[list[float]]
    ee: list[float]  # End effector point at `q`, m


def screws_of(scene: Scene) -> Screws:
    """The screws of a scene's arm, at the joints' reference positions."""
    model, data = scene.model, mujoco.MjData(scene.model)
    mujoco.mj_kinematics(model, data)
    above, body = set(), int(model.site(EE_SITE).bodyid[0])
    while body:
        above.add(body)
        body = int(model.body_parentid[body])
    ids = model.dof_jntid[scene.joint_dof]
    found = [(i, int(j)) for i, j in enumerate(ids) if int(model.jnt_bodyid[j]) in above]
    return Screws(
        joint=[i for i, _ in found],
        hinge=[bool(model.jnt_type[j] == mujoco.mjtJoint.mjJNT_HINGE) for _, j in found],
        q=[float(model.qpos0[model.jnt_qposadr[j]]) for _, j in found],
        anchor=[data.xanchor[j].tolist() for _, j in found],
        axis=[data.xaxis[j].tolist() for _, j in found],
        ee=data.site(EE_SITE).xpos.tolist(),
    )


def jacobians(q: Array, screws: Screws) -> Array:
    """𝒥 (k, 6, m) of the m joints in `screws` at joint positions q (k, n)."""
    k = len(q)
    R, p = np.broadcast_to(np.eye(3), (k, 3, 3)), np.zeros((k, 3))
    axes, anchors = [], []
    for joint, hinge, start, c, a in zip(*screws[:5], strict=True):
        axis, anchor, moved = np.array(a), np.array(c), q[:, joint] - start
        axes.append(R @ axis)
        anchors.append(R @ anchor + p)
        if hinge:
            turn = _turns(axis, moved)
            p = p + np.einsum("kij,kj->ki", R, anchor - turn @ anchor)
            R = R @ turn
        else:
            p = p + moved[:, None] * axes[-1]
    ee = R @ np.array(screws.ee) + p
    out = np.zeros((k, 6, len(axes)))
    for i, hinge in enumerate(screws.hinge):
        out[:, :3, i] = np.cross(axes[i], ee - anchors[i]) if hinge else axes[i]
        out[:, 3:, i] = axes[i] if hinge else 0.0
    return out


def smallest_singular_values(q: Array, screws: Screws) -> Array:
    """Smallest singular value (k,) of 𝒥 at joint positions q (k, n)."""
    values = np.linalg.svd(jacobians(q, screws), compute_uv=False)
    return np.asarray(values[:, -1], dtype=np.float64)


def _turns(axis: Array, angle: Array) -> Array:
    # Rodrigues: I + sin θ [a]× + (1 − cos θ) [a]×².
    K = np.array([[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]])
    return np.eye(3) + np.sin(angle)[:, None, None] * K + (1.0 - np.cos(angle))[:, None, None] * (K @ K)
