"""What stands in the way of an arm that can land nowhere, by random poses and not by the grid of `places`.

Poses drawn over the joints' ranges are led to the upright attitude, each near where it is. Then one condition after the other is
asked of them, in the order in which a user would look; the first that leaves none is what stands in the way.

| symbol | name | unit |
|---|---|---|
| q | joint positions (n,) | rad |
| σ | smallest singular value of 𝒥 | 1 |
"""

from typing import NamedTuple

import numpy as np

from armland.mission.belief import flyer
from armland.mission.feasibility.obstacles import Obstacles
from armland.mission.feasibility.reach import point
from armland.mission.feasibility.way import MARGINS, SIGMAS
from armland.mission.table.mission import Mission
from armland.models.arm import ArmModel
from armland.models.arm_file.strength import poses
from armland.models.nearby import CAUTION, body_of, reached
from armland.models.parameters import arm_model
from armland.rotations import Array
from armland.scenario import Scenario

TORQUE_SHARE = 0.9
"""Of the joints' limits, as `reach` leaves it."""

FAR = np.array([99.0, 0.0, 1.0])
"""Where UAV and cradle are in no arm's way, m, D."""


MISSED = {
    "margin": "has all joints {bound:.3g} rad from their ends; at most {best:.3f} rad",
    "sigma": "has a smallest singular value of {bound:.3g}, with which it can move in all directions; at most {best:.3f}",
    "torque": "takes up to {bound:g} of the joints' torques for arm and UAV; at least {best:.2f}",
    "room": "is clear of the floor and of itself; at best {near:.0f} mm too near",
}
"""Condition -> what no pose does, in the order in which they are asked."""


class _Pose(NamedTuple):
    height: float  # m, of the end effector
    margin: float  # rad, least distance to a joint's end
    sigma: float
    torque: float  # largest share of a joint's limit that arm and half as much again as the UAV take
    room: float  # m, to floor and arm beyond what is kept


def hindrance(scenario: Scenario, mission: Mission) -> str:
    """One sentence on the first condition that no upright pose of a scenario's arm fulfils; empty where some fulfil all.

    Args:
        scenario: as it is wanted.
        mission: one with way points.
    """
    believed = scenario.believed()
    arm, limits = arm_model(believed), believed.limits
    found = _upright(arm, believed)
    if not found:
        return "In none of its poses can it hold its end effector upright, the tool's x axis along the base's"
    bounds = {
        "margin": MARGINS * limits.joint_margin_rad,
        "sigma": SIGMAS * limits.sigma_min,
        "torque": TORQUE_SHARE,
        "room": 0.0,
    }
    many = len(found)
    for field, bound in bounds.items():
        sign = -1.0 if field == "torque" else 1.0
        values = [getattr(p, field) for p in found]
        best = max(values, key=lambda v: sign * v)
        found = [p for p, v in zip(found, values, strict=True) if sign * v >= sign * bound]
        if not found:
            text = MISSED[field].format(bound=bound, best=best, near=-1e3 * best)
            return f"Of {many} poses in which it is upright none {text}"
    heights = [p.height for p in found]
    way = [float(point(at, believed)[2]) for at in mission.points(believed)]
    needed, span = max(way) - min(way), max(heights) - min(heights)
    if span < needed:
        return (
            f"Upright, clear of the floor and at the margins it stays between {min(heights):.2f} and {max(heights):.2f} m above its "
            f"base's plane; the {mission.name}'s way takes {needed:.2f} m of height"
        )
    return ""


def _upright(arm: ArmModel, scenario: Scenario) -> list[_Pose]:
    body, obstacles, still, out = body_of(arm), Obstacles(scenario), np.zeros(arm.joints), []
    obstacles.put_cradle(FAR, 0.0)
    weight = flyer(scenario).weight
    for start in poses(arm.model):
        q = start.copy()
        arm.update(q, still)
        if not reached(body, q, arm.position.copy(), 60, CAUTION):
            continue
        arm.update(q, still)
        out.append(_Pose(float(arm.position[2]), *_measured(arm, q, weight), obstacles.nearest(q, FAR).room))
    return out


def _measured(arm: ArmModel, q: Array, weight: float) -> tuple[float, float, float]:
    margin = float(np.minimum(q - arm.q_min, arm.q_max - q).min())
    sigma = float(np.linalg.svd(arm.jacobian, compute_uv=False)[-1])
    return margin, sigma, float((np.abs(arm.gravity + 1.5 * weight * arm.jacobian[2]) / arm.tau_max).max())
