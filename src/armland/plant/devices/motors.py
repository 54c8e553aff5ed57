"""The arm's motors: joint torques act at once, within their limits, with gain and offset.

| name | what | unit |
|---|---|---|
| `limit` (n,) | largest torque; infinite where the arm's file says none | N·m |
| `gain` (n,), `offset` (n,) | torque given over torque asked, and what is given beyond it | 1, N·m |

Coulomb friction and damping of the joints stand in the arm's file; friction is the brake's to change (`devices.brake`).
"""

import numpy as np
from numba import njit

from armland.plant.scene.composition import Scene
from armland.records import Record, Records
from armland.rotations import Array


def told_layout(joints: int) -> np.dtype:
    """What the motors of an arm with `joints` joints are told."""
    return np.dtype([(name, "f8", (joints,)) for name in ("limit", "gain", "offset")])


def tell(told: Records, scene: Scene) -> None:
    """Fill `told` (1,)."""
    m, joint = scene.model, scene.model.dof_jntid[scene.joint_dof]
    limited = m.jnt_actfrclimited[joint].astype(bool)
    told["limit"] = np.where(limited, np.abs(m.jnt_actfrcrange[joint]).min(axis=1), np.inf)
    told["gain"] = 1.0


@njit(cache=True)
def drive(tau: Array, told: Record, ctrl: Array) -> None:
    """Turn the torques `tau` (n,) N·m that are asked for into MuJoCo's `ctrl` (n,) N·m."""
    for i in range(tau.shape[0]):
        ctrl[i] = told.gain[i] * min(max(tau[i], -told.limit[i]), told.limit[i]) + told.offset[i]
