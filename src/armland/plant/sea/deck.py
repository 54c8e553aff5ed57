"""The deck: moved by the sea whatever stands on it, at each tick before the step.

| symbol | name | unit |
|---|---|---|
| q, q̇, q̈ | of the deck's joints, `scene.deck.JOINTS`, by `sea.timed` | m, rad, per s and s² |
| I | `inertia`: reflected, of each joint | kg, kg·m² |

State q, q̇ is set and the force I q̈ + b applied, b MuJoCo's bias force of the step before: the weight of all that stands on the deck.
What is left, contacts and inertia of arm and cradle, accelerates the deck by their share of I: below 1e-4 m/s².
"""

import numpy as np
from numba import njit

from armland.plant.scene.composition import Scene
from armland.plant.scene.deck import INERTIA
from armland.records import Record, Records
from armland.rotations import Array


def told_layout(joints: int) -> np.dtype:
    """What the deck is told."""
    return np.dtype([("moves", "i8"), ("qpos", "i8"), ("dof", "i8"), ("inertia", "f8")])


def tell(told: Records, scene: Scene) -> None:
    """Fill `told` (1,); where the scene has no deck it stays empty."""
    if scene.deck_dof >= 0:
        told["moves"], told["qpos"], told["dof"], told["inertia"] = 1, scene.deck_qpos, scene.deck_dof, INERTIA


@njit(cache=True)
def move(told: Record, row: Array, qpos: Array, qvel: Array, applied: Array, bias: Array) -> None:
    """Put the deck where the sea has it.

    Args:
        told: of `told_layout`, of a deck that moves.
        row: q, q̇, q̈ (18,), m, rad, per s and s².
        qpos: MuJoCo's (nq,), m, rad, written.
        qvel: MuJoCo's (nv,), m/s, rad/s, written.
        applied: MuJoCo's `qfrc_applied` (nv,), N, N·m, written.
        bias: MuJoCo's `qfrc_bias` (nv,), N, N·m.
    """
    for i in range(6):
        qpos[told.qpos + i] = row[i]
        qvel[told.dof + i] = row[6 + i]
        applied[told.dof + i] = told.inertia * row[12 + i] + bias[told.dof + i]
