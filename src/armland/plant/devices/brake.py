"""The arm's brakes: friction that holds each joint while they are on.

| name | what | unit |
|---|---|---|
| `hold` (n,), `free` (n,) | Coulomb friction with the brakes on, and off | N·m |
| `delay` | from the command to its effect | ticks |
"""

import numpy as np
from numba import njit

from armland.plant.scene.composition import Scene
from armland.records import Record, Records
from armland.rotations import Array
from armland.scenario import Scenario

HARD = (0.9999, 0.9999, 0.001, 0.5, 2.0)
"""MuJoCo's friction is soft: as it stands by default a brake under load creeps by a degree per second."""


def told_layout(joints: int) -> np.dtype:
    """What the brakes of an arm with `joints` joints are told."""
    return np.dtype(
        [
            ("dof", "i8", (joints,)),
            ("hold", "f8", (joints,)),
            ("free", "f8", (joints,)),
            ("hard", "f8", (5,)),  # MuJoCo's solimp while they hold
            ("soft", "f8", (joints, 5)),  # and while they do not
            ("delay", "i8"),
        ]
    )


def kept_layout(joints: int) -> np.dtype:
    """What the brakes keep: whether they are on, what is wanted, and since which tick."""
    return np.dtype([("on", "i8"), ("wanted", "i8"), ("since", "i8")])


def tell(told: Records, scenario: Scenario, scene: Scene) -> None:
    """Fill `told` (1,) from the scene's model, whose brakes are off."""
    told["dof"], told["hold"], told["hard"] = scene.joint_dof, scenario.arm.brake_nm, HARD
    told["free"] = scene.model.dof_frictionloss[scene.joint_dof]
    told["soft"] = scene.model.dof_solimp[scene.joint_dof]


@njit(cache=True)
def brake(k: int, wanted: int, told: Record, kept: Record, frictionloss: Array, solimp: Array) -> None:
    """Put the brakes on or off.

    Args:
        k: present tick.
        wanted: 1 where they shall be on.
        told: of `told_layout`.
        kept: of `kept_layout`, updated.
        frictionloss: MuJoCo's `dof_frictionloss` (nv,), N·m, written.
        solimp: MuJoCo's `dof_solimp` (nv, 5), 1 and rad, written.
    """
    if wanted != kept.wanted:
        kept.wanted, kept.since = wanted, k
    if kept.on != wanted and k - kept.since >= told.delay:
        kept.on = wanted
        switch(told, kept, frictionloss, solimp)


@njit(cache=True)
def switch(told: Record, kept: Record, frictionloss: Array, solimp: Array) -> None:
    """Write the friction of brakes that are `kept.on` or not.

    Args:
        told: of `told_layout`.
        kept: of `kept_layout`.
        frictionloss: MuJoCo's `dof_frictionloss` (nv,), N·m, written.
        solimp: MuJoCo's `dof_solimp` (nv, 5), 1 and rad, written.
    """
    for i in range(told.dof.shape[0]):
        dof = told.dof[i]
        frictionloss[dof] = told.hold[i] if kept.on else told.free[i]
        for j in range(5):
            solimp[dof, j] = told.hard[j] if kept.on else told.soft[i, j]
