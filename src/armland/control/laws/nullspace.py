"""Null-space behaviour of the arm: elbow pulled down, joints kept from their ends, damping, a posture; compiled.

| symbol | name | unit |
|---|---|---|
| τ₀ | wanted joint torque, `null_space_wish` (n,) | N·m |
| τ_nsp | its part that does not accelerate the end effector, `models.operational.null_space_torque` | N·m |
"""

import numpy as np
from numba import njit

from armland.records import Record
from armland.rotations import Array

WALL_FROM, WALL = 2.0 / 3.0, 10.0
"""Share of the margin to a joint's end from which on the push grows faster, and by how many times."""


@njit(cache=True)
def elbow_field(axis: Array, anchor: Array, elbow: int, pull: float, tau: Array) -> None:
    """Add the joint torques of a force `pull` downwards at the elbow, the anchor of joint `elbow`, to `tau` (n,), N·m.

    Args:
        axis: joint axes (n, 3), D.
        anchor: a point on each joint's axis (n, 3), m, D.
        elbow: index of the elbow's joint; only the hinges before it move its anchor.
        pull: N.
        tau: (n,), N·m, added to.

    Source: the paper's null-space behaviour, elbow pulled downwards.
    """
    for i in range(elbow):
        dx, dy = anchor[elbow, 0] - anchor[i, 0], anchor[elbow, 1] - anchor[i, 1]
        # z component of axis × lever: how fast joint i raises the elbow.
        tau[i] -= pull * (axis[i, 0] * dy - axis[i, 1] * dx)


@njit(cache=True)
def range_field(q: Array, low: Array, high: Array, margin: float, stiffness: float, tau: Array) -> None:
    """Add the joint torques that push joints away from their range's ends within `margin` to `tau` (n,), N·m.

    Args:
        q: joint positions (n,), rad.
        low: ends of the ranges (n,), rad; −inf where there is none.
        high: (n,), rad, likewise; inf.
        margin: rad.
        stiffness: N·m/rad.
        tau: (n,), N·m, added to.
    """
    for i in range(q.shape[0]):
        if q[i] < low[i] + margin:
            tau[i] += _push(low[i] + margin - q[i], margin, stiffness)
        elif q[i] > high[i] - margin:
            tau[i] -= _push(q[i] - high[i] + margin, margin, stiffness)


@njit(cache=True)
def _push(depth: float, margin: float, stiffness: float) -> float:
    # A joint whose friction or whose haste takes it close meets a wall before the supervisor has to stop the arm.
    return stiffness * depth + WALL * stiffness * max(depth - WALL_FROM * margin, 0.0)


@njit(cache=True)
def null_space_wish(q: Array, qd: Array, arm: Record, p: Record) -> Array:
    """τ₀ (n,), N·m: both fields, damping of the joints, and what draws them to a posture.

    Args:
        q: joint positions (n,), rad.
        qd: joint velocities (n,), rad/s.
        arm: of `models.chain.state_layout`.
        p: of `control.laws.realisation.told_layout`.
    """
    tau = np.zeros(q.shape[0])
    elbow_field(arm.axis, arm.anchor, p.elbow, p.elbow_force, tau)
    range_field(q, p.q_min, p.q_max, p.range_margin, p.range_stiffness, tau)
    for i in range(q.shape[0]):
        tau[i] -= p.null_damping * qd[i]
    if p.posture_rate > 0.0:
        _posture(q, qd, arm, p, tau)
    return tau


@njit(cache=True)
def _posture(q: Array, qd: Array, arm: Record, p: Record, tau: Array) -> None:
    # M (ω² (q₀ − q) − 2 ω φ̇): weighted by the inertia it is as fast in the null space of a heavy arm as of a light one.
    n, rate = q.shape[0], p.posture_rate
    for k in range(n):
        back = rate * (rate * (p.posture[k] - q[k]) - 2.0 * qd[k])
        for i in range(n):
            tau[i] += arm.mass_matrix[i, k] * back
