"""How stiffly an arm holds its attitude, and how much its null space is damped: as its weight and inertia have it.

| symbol | name | unit |
|---|---|---|
| 𝒥_ω | rotation rows of the Jacobian (3, n) | 1 |
| k_d | `control.orientation_kd` | N·m·s/rad |
| r | largest eigenvalue of k_d M⁻¹ 𝒥_ωᵀ 𝒥_ω: the rate at which the damping stops a joint | 1/s |
| T | from a joint's motion to the torque that answers it | s |
| N | orthonormal basis of the Jacobian's null space (n, n − 6) | 1 |
| d | `control.null_space_damping_nms` | N·m·s/rad |
| m_n | largest eigenvalue of NᵀMN: the inertia of a motion that leaves the end effector where it is | kg·m² |
| τ_n | torque in the null space of links whose weights are wrong, each on its own, by `WRONG` | N·m |

A joint that damping alone stops is ω˙(t) = −r ω(t − T): stable where r T < π/2, and at that rate it swings at 1/(4 T), 100 Hz where
T = 2.5 ms. Where the torque's rate is bounded it does so long before, once it has begun.

What masses wrong by some percent make of torque grows with the arm's weight: a spring that holds the LWR's attitude to a degree left
18° of a heavy arm's. And where the end effector does not move, joints stop at d/m_n, and wrong weights drive them at τ_n/d:
the same d stops a heavy arm's ten times later, and lets its elbow rise.
"""

import mujoco
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

DAMPED = "control.null_space_damping_nms"

BORNE_KG = 18.0
"""Weight that an arm's joints move up to which the attitude's gains stay: more than the LWR's 13.6 kg, or 16.3 kg in a wrong belief."""

STOPS = 10.0
"""Least d/m_n, 1/s: the LWR's is 13."""

WRONG, DRIFTS = 0.1, 0.08
"""Of each link's weight, and largest τ_n/d that this may make, rad/s of all joints together: the LWR's is 0.055."""


def swinging(rate_hz: float) -> float:
    """Rate of damping, 1/s, from which on a joint swings in a loop that is closed `rate_hz` times a second."""
    return 0.5 * np.pi / (TICKS / rate_hz + DELAY_S)


def stopping(arm: ArmModel, damping: float) -> float:
    """r, 1/s, of `damping` k_d, N·m·s/rad, in the arm's present pose."""
    turn = arm.jacobian[3:]
    # Those of 𝒥_ω M⁻¹ 𝒥_ωᵀ but for zeros, and that is symmetric.
    return damping * float(np.linalg.eigvalsh(turn @ np.linalg.solve(arm.mass_matrix, turn.T))[-1])


def self_inertia(arm: ArmModel) -> float:
    """m_n, kg·m², in the arm's present pose; 0 where no joint moves without the end effector."""
    free = np.linalg.svd(arm.jacobian)[2][6:]
    return float(np.linalg.eigvalsh(free @ arm.mass_matrix @ free.T)[-1]) if len(free) else 0.0


def drifting(arm: ArmModel) -> float:
    """τ_n, N·m, in the arm's present pose; 0 where no joint moves without the end effector."""
    free, rise = np.linalg.svd(arm.jacobian)[2][6:], np.zeros((3, arm.joints))
    down, total = arm.model.opt.gravity, np.zeros(len(free))
    for body in range(1, arm.model.nbody):
        mujoco.mj_jacBodyCom(arm.model, arm.data, rise, None, body)
        total += (free @ (rise.T @ down) * arm.model.body_mass[body]) ** 2
    return WRONG * float(np.sqrt(total.sum()))


def steadied(scenario: Scenario, mission: Mission, arm: ArmModel, home: Array) -> Scenario:
    """The scenario with the attitude's gains and the null space's damping as the arm needs them; itself where they suit it.

    The attitude is held more stiffly by an arm that is heavier, and as softly as the lightest joint needs. Stiffness and damping
    change alike: the attitude comes back as fast as before. What the user has set stays.

    Args:
        scenario: believed.
        mission: one with way points.
        arm: believed; its state is overwritten.
        home: joint positions (n,), rad, at the first of them.

    Raises:
        ConfigurationError: gains that the user set are too large; says which would do.
    """
    q, c, fastest, damping = home, scenario.control, 0.0, 0.0
    for at in mission.points(scenario):
        q = lead(arm, q, point(at, scenario))
        arm.update(q, np.zeros(arm.joints))
        fastest = max(fastest, stopping(arm, c.orientation_kd))
        damping = max(damping, STOPS * self_inertia(arm), drifting(arm) / DRIFTS)
    share = min(_share(scenario, fastest), max(1.0, moved_mass(arm) / BORNE_KG))
    gains = {}
    if share != 1.0 and not any(is_settled(scenario, key) for key in GAINS):
        gains = {"orientation_kp": share * c.orientation_kp, "orientation_kd": share * c.orientation_kd}
    if damping > c.null_space_damping_nms and not is_settled(scenario, DAMPED):
        gains["null_space_damping_nms"] = damping
    return scenario.replaced({"control": gains}) if gains else scenario


def moved_mass(arm: ArmModel) -> float:
    """Mass, kg, that the arm's joints move, its tool included."""
    return float(arm.model.body_subtreemass[arm.model.jnt_bodyid[0]])


def _share(scenario: Scenario, fastest: float) -> float:
    # By which the attitude's gains may be multiplied; refuses those that the user set and that make a joint swing.
    c, least = scenario.control, swinging(scenario.run.rate_hz)
    share = SHARE * least / fastest
    if fastest >= least and any(is_settled(scenario, key) for key in GAINS):
        raise ConfigurationError(
            f"control.orientation_kd = {c.orientation_kd:g} N·m·s/rad stops the arm's lightest joint at {fastest:.0f} 1/s; from "
            f"{least:.0f} 1/s on it swings, since a torque comes {1e3 * (TICKS / scenario.run.rate_hz + DELAY_S):.1f} ms late; at most "
            f"{share * c.orientation_kd:.2f} leaves a margin, with control.orientation_kp = {share * c.orientation_kp:.1f}, and both "
            "left out follow the arm"
        )
    return share
