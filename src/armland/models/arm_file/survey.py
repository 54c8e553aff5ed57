"""What an arm can do by its own numbers: reach, what it needs to hold itself, and what it can carry.

| symbol | name | unit |
|---|---|---|
| g (n,) | torque of the weight of links and tool | N·m |
| 𝒥_z (n,) | row of the Jacobian that lifts the end effector | m |
| m | payload: the largest with \\|g + m 9.81 𝒥_z\\| ≤ 0.9 τ_max in all joints | kg |
"""

from typing import NamedTuple

import numpy as np

from armland.errors import WorkspaceError
from armland.models import posture
from armland.models.arm import ArmModel
from armland.models.arm_file import strength
from armland.models.description import EE_SITE
from armland.rotations import Array

SHARE = 0.9
"""Of the torque limits that a payload may use: as the landing's check."""

LIGHTEST = 1e-9


class Survey(NamedTuple):
    """What an arm can do."""

    mass: float  # kg, of the links that move and of the tool
    reach: float  # m, from the second joint
    held: Array  # (n,) N·m, worst torque of the weight of links and tool
    anywhere: float  # kg at the tool's tip in the worst pose of all
    catching: tuple[float, float]  # kg, worst and best of poses that point upwards; NaN where there is none
    pose: Array  # (n,) rad, pointing upwards where that is possible


def survey(arm: ArmModel, elbow: int) -> Survey:
    """Survey an arm with its tool mounted; its state is overwritten. `elbow` is the index of the elbow's joint."""
    model, mass = arm.model, float(arm.model.body_subtreemass[arm.model.jnt_bodyid[0]])
    anywhere = min(_payload(arm, q) for q in strength.poses(model))
    pose, catching = np.clip(np.zeros(arm.joints), arm.q_min, arm.q_max), (np.nan, np.nan)
    try:
        up = [p.q for p in posture.home_poses(arm, None, None, elbow)]
        loads = [_payload(arm, q) for q in up]
        pose, catching = max(up, key=lambda q: _height(arm, q)), (min(loads), max(loads))
    except WorkspaceError:
        pass
    return Survey(mass, strength.reach(model, EE_SITE), strength.held(model), anywhere, catching, pose)


def _height(arm: ArmModel, q: Array) -> float:
    # Of the lowest joint behind the shoulder, m.
    arm.update(q, np.zeros(arm.joints))
    return float(arm.anchor[2:, 2].min())


def _payload(arm: ArmModel, q: Array) -> float:
    arm.update(q, np.zeros(arm.joints))
    lift = 9.81 * arm.jacobian[2]
    left = SHARE * arm.tau_max - np.sign(lift) * arm.gravity
    bound = np.where(np.abs(lift) > LIGHTEST, left / np.maximum(np.abs(lift), LIGHTEST), np.inf)
    # A joint that the weight alone overloads carries nothing.
    return float(max(min(bound.min(), np.inf if (np.abs(arm.gravity) <= SHARE * arm.tau_max).all() else 0.0), 0.0))
