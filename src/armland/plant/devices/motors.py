"""The arm's motors: joint torques act at once, within their limits, with gain and offset.

| name | what | unit |
|---|---|---|
| `limit` (n,) | largest torque; infinite where the arm's file says none | N·m |
| `gain` (n,), `offset` (n,) | torque given over torque asked, and what is given beyond it | 1, N·m |
| `sigma` (n,) | white noise of the torque given | N·m |
| `delay` | from command to torque | ticks |
| `load` | dry friction per torque given | 1 |

Coulomb friction and damping of the joints stand in the arm's file; friction is the brake's to change (`devices.brake`).
"""

import numpy as np
from numba import njit

from armland.plant.scene.composition import Scene
from armland.records import Record, Records
from armland.rotations import Array

RING = 32
"""Ticks of torques that a delay can hold."""

STICK_RAD_S = 0.02
"""Speed about which the friction of the load turns over."""


def told_layout(joints: int) -> np.dtype:
    """What the motors of an arm with `joints` joints are told."""
    each = [(name, "f8", (joints,)) for name in ("limit", "gain", "offset", "sigma")]
    return np.dtype([*each, ("delay", "i8"), ("load", "f8"), ("at_qd", "i8"), ("odd", "i8")])


def kept_layout(joints: int) -> np.dtype:
    """What the motors keep: the torques asked for in the last ticks."""
    return np.dtype([("line", "f8", (RING, joints)), ("sent", "i8")])


def tell(told: Records, scene: Scene) -> None:
    """Fill `told` (1,)."""
    m, joint = scene.model, scene.model.dof_jntid[scene.joint_dof]
    limited = m.jnt_actfrclimited[joint].astype(bool)
    told["limit"] = np.where(limited, np.abs(m.jnt_actfrcrange[joint]).min(axis=1), np.inf)
    told["gain"] = 1.0
    if not scene.joints:
        return
    first = scene.model.joint(int(scene.model.dof_jntid[scene.joint_dof[0]])).name
    told["at_qd"] = scene.sensor[f"qd_{first}"]


@njit(cache=True)
def drive(tau: Array, told: Record, kept: Record, noise: Array, data: Array, ctrl: Array) -> None:
    """Turn the torques that are asked for into MuJoCo's.

    Args:
        tau: (n,), N·m, asked for.
        told: of `told_layout`.
        kept: of `kept_layout`, updated.
        noise: standard normal numbers (n,).
        data: MuJoCo's `sensordata` (nsensordata,), of which the joints' speeds are read, rad/s.
        ctrl: MuJoCo's (n,), N·m, written.
    """
    late = 0
    if told.delay > 0:
        row = kept.sent % RING
        for i in range(tau.shape[0]):
            kept.line[row, i] = tau[i]
        late = (kept.sent - min(told.delay, kept.sent)) % RING
        kept.sent += 1
    for i in range(tau.shape[0]):
        asked = kept.line[late, i] if told.delay > 0 else tau[i]
        ctrl[i] = told.gain[i] * min(max(asked, -told.limit[i]), told.limit[i]) + told.offset[i]
        if told.odd:
            given = ctrl[i] + told.sigma[i] * noise[i]
            # Smooth about standstill, where a step of 1 ms would let it chatter.
            given -= told.load * abs(ctrl[i]) * np.tanh(data[told.at_qd + i] / STICK_RAD_S)
            ctrl[i] = min(max(given, -told.limit[i]), told.limit[i])
