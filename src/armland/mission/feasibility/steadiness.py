"""How stiffly an arm may hold its attitude: a light wrist swings where its damping acts faster than the loop is closed.

| symbol | name | unit |
|---|---|---|
| 𝒥_ω | rotation rows of the Jacobian (3, n) | 1 |
| k_d | `control.orientation_kd` | N·m·s/rad |
| r | largest eigenvalue of k_d M⁻¹ 𝒥_ωᵀ 𝒥_ω: the rate at which the damping stops a joint | 1/s |
| T | from a joint's motion to the torque that answers it | s |

A joint that damping alone stops is ω˙(t) = −r ω(t − T): stable where r T < π/2, and at that rate it swings at 1/(4 T), 100 Hz where
T = 2.5 ms. Where the torque's rate is bounded it does so long before, once it has begun.
"""

import numpy as np

from armland.errors import ConfigurationError
from armland.mission.feasibility.reach import point
from armland.mission.table.mission import Mission
from armland.models.airframe.sizing import is_settled
from armland.models.arm import ArmModel
from armland.models.posture import lead
from armland.rotations import Array
from armland.scenario import Scenario

TICKS, DELAY_S = 1.5, 0.001
"""Delay of the loop: a bus cycle and half of one for which a torque is held; of a joint's own loop (published: up to 1 ms)."""

SHARE = 0.5
"""Of the rate at which the attitude would swing: a gain margin of 2, for inertia that is less than reckoned and joints that give."""

GAINS = ("control.orientation_kp", "control.orientation_kd")


def swinging(rate_hz: float) -> float:
    """Rate of damping, 1/s, from which on a joint swings in a loop that is closed `rate_hz` times a second."""
    return 0.5 * np.pi / (TICKS / rate_hz + DELAY_S)


def stopping(arm: ArmModel, damping: float) -> float:
    """r, 1/s, of `damping` k_d, N·m·s/rad, in the arm's present pose."""
    turn = arm.jacobian[3:]
    # Those of 𝒥_ω M⁻¹ 𝒥_ωᵀ but for zeros, and that is symmetric.
    return damping * float(np.linalg.eigvalsh(turn @ np.linalg.solve(arm.mass_matrix, turn.T))[-1])


def steadied(scenario: Scenario, mission: Mission, arm: ArmModel, home: Array) -> Scenario:
    """The scenario with an attitude held as softly as the arm's lightest joint needs; as it is where that is no softer.

    Stiffness and damping are lessened alike: the attitude comes back as fast as before.

    Args:
        scenario: believed.
        mission: one with way points.
        arm: believed; its state is overwritten.
        home: joint positions (n,), rad, at the first of them.

    Raises:
        ConfigurationError: gains that the user set are too large; says which would do.
    """
    c, q, fastest = scenario.control, home, 0.0
    for at in mission.points(scenario):
        q = lead(arm, q, point(at, scenario))
        arm.update(q, np.zeros(arm.joints))
        fastest = max(fastest, stopping(arm, c.orientation_kd))
    least = swinging(scenario.run.rate_hz)
    share = SHARE * least / fastest
    if share >= 1.0:
        return scenario
    if any(is_settled(scenario, key) for key in GAINS):
        if fastest < least:
            return scenario
        raise ConfigurationError(
            f"control.orientation_kd = {c.orientation_kd:g} N·m·s/rad stops the arm's lightest joint at {fastest:.0f} 1/s; from "
            f"{least:.0f} 1/s on it swings, since a torque comes {1e3 * (TICKS / scenario.run.rate_hz + DELAY_S):.1f} ms late; at most "
            f"{share * c.orientation_kd:.2f} leaves a margin, with control.orientation_kp = {share * c.orientation_kp:.1f}, and both "
            "left out follow the arm"
        )
    gains = {"orientation_kp": share * c.orientation_kp, "orientation_kd": share * c.orientation_kd}
    return scenario.replaced({"control": gains})
