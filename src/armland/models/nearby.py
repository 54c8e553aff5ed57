"""Upright poses near a known one, compiled: damped Newton steps to a point, and steps along the null space to where it sinks.

The same equations as `models.posture`, for searches that try thousands of points. Types do not depend on the number of joints.

| symbol | name | unit |
|---|---|---|
| q | `q` (n,) joint positions | rad or m |
| 𝒥_w (6, n) | Jacobian of the end effector point, rotation rows weighted | m/rad |
| e (6,) | position error and weighted rotation error to the upright attitude | m |
| N = I − 𝒥⁺𝒥 | projection onto motions that leave the end effector where it is (n, n) | 1 |
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from armland.models.arm import ArmModel
from armland.native import mj_kinematics
from armland.rotations import Array

ROTATION_WEIGHT_M = 0.3
"""Length at which a radian weighs as much as a metre."""

REACHED_M, EXACT = 1e-4, 1e-8
"""Error, weighted, at which a point counts as reached, and at which no further step is made."""

DAMPING, CAUTION = 1e-9, 0.05
"""Damping of the steps, and what is added of it over the squared error (1/m²) from a start that may be far."""

LONGEST_RAD, SUNK_RAD = 0.5, 1e-3
"""Longest Newton step of a joint; step along the null space below which the arm has sunk."""


class Body(NamedTuple):
    """An arm for compiled code: addresses of MuJoCo's model and data, views of what goes in and comes out, its ranges."""

    model: int
    data: int
    qpos: Array
    axis: Array  # (n, 3)
    anchor: Array  # (n, 3) m
    position: Array  # (3,) m
    rotation: Array  # (9,)
    hinge: Array  # (n,) 1: hinge, 0: slide
    low: Array  # (n,) rad
    high: Array  # (n,) rad


class Sinking(NamedTuple):
    """How the null space sinks: the controller's pull at the elbow, its push from the joints' ends, what draws it to a posture, and the
    steps."""

    elbow: int
    pull: float  # N
    margin: float  # rad
    stiffness: float  # N·m/rad
    gain: float  # rad per N·m
    longest: float  # rad
    posture: Array  # (n,) rad
    drawn: Array  # (n, n) N·m/rad, with which it is drawn there; zero where it is not


def body_of(arm: ArmModel) -> Body:
    """Views of `arm`, whose state compiled code then overwrites."""
    v = arm.views
    hinge = arm.views.constants["hinge"][0].astype(float)
    low = np.where(np.isfinite(arm.q_min), arm.q_min, -2.0 * np.pi)
    high = np.where(np.isfinite(arm.q_max), arm.q_max, 2.0 * np.pi)
    return Body(v.model, v.data, v.qpos, v.axis, v.anchor, v.position, v.rotation, hinge, low, high)


@njit(cache=True)
def reached(b: Body, q: Array, point: Array, steps: int, caution: float) -> bool:
    """Move to the upright pose at a point; whether it was reached.

    Args:
        b: the arm.
        q: joint positions (n,), rad, overwritten.
        point: (3,), m, D.
        steps: Newton steps, at most.
        caution: damping over the squared error, 1/m²: 0 from near, `CAUTION` from afar.
    """
    e, J = np.empty(6), np.empty((6, q.size))
    for _ in range(steps):
        if _look(b, q, point, e, J) < EXACT:
            return True
        _newton(b, q, e, J, caution)
    return _look(b, q, point, e, J) < REACHED_M


@njit(cache=True)
def sink(b: Body, q: Array, point: Array, s: Sinking, steps: int) -> bool:
    """Sink the null space of the upright pose `q` (n,), in place, by at most `steps` steps; whether it still is at `point` then.

    Args:
        b: the arm.
        q: joint positions (n,), rad, at the point or near it, overwritten.
        point: (3,), m, D.
        s: what it follows.
        steps: at most.
    """
    if not reached(b, q, point, 20, 0.0):
        return False
    e, J, tau = np.empty(6), np.empty((6, q.size)), np.empty(q.size)
    for _ in range(steps if q.size > 6 else 0):
        _look(b, q, point, e, J)
        _wish(b, q, s, tau)
        dq = tau - J.T @ np.linalg.solve(J @ J.T + DAMPING * np.eye(6), J @ tau)
        gain = _gain(dq, s)
        most = np.abs(dq).max() * gain
        if most < SUNK_RAD:
            break
        scale = gain * s.longest / max(most, s.longest)
        for i in range(q.size):
            q[i] = min(max(q[i] + scale * dq[i], b.low[i]), b.high[i])
        if not reached(b, q, point, 20, 0.0):
            return False
    return True


@njit(cache=True)
def _gain(dq: Array, s: Sinking) -> float:
    # To where what draws to the posture leaves nothing of a step, and no further than the ends' push allows.
    drawn = float(np.dot(dq, s.drawn @ dq))
    return s.gain if drawn == 0.0 else 1.0 / (drawn / float(np.dot(dq, dq)) + 1.0 / s.gain)


@njit(cache=True)
def _look(b: Body, q: Array, point: Array, e: Array, J: Array) -> float:
    # Error and Jacobian; returns the largest error.
    b.qpos[:] = q
    mj_kinematics(b.model, b.data)
    R = b.rotation
    for i in range(3):
        e[i] = point[i] - b.position[i]
    # Rotation vector from the attitude to the upright one, by the sine of half the angle twice: exact where it is small.
    e[3] = ROTATION_WEIGHT_M * 0.5 * (R[5] - R[7])
    e[4] = ROTATION_WEIGHT_M * 0.5 * (R[6] - R[2])
    e[5] = ROTATION_WEIGHT_M * 0.5 * (R[1] - R[3])
    trace = R[0] + R[4] + R[8]
    # Turned by more than a right angle, the sine falls again: the error must not.
    if trace < 1.0:
        size = np.sqrt(e[3] ** 2 + e[4] ** 2 + e[5] ** 2)
        if size > 1e-9:
            for i in range(3, 6):
                e[i] *= ROTATION_WEIGHT_M / size
        else:
            e[3] = ROTATION_WEIGHT_M
    for k in range(q.size):
        x, y, z = b.axis[k]
        if b.hinge[k] > 0.5:
            dx, dy, dz = b.position[0] - b.anchor[k, 0], b.position[1] - b.anchor[k, 1], b.position[2] - b.anchor[k, 2]
            J[0, k], J[1, k], J[2, k] = y * dz - z * dy, z * dx - x * dz, x * dy - y * dx
            J[3, k], J[4, k], J[5, k] = ROTATION_WEIGHT_M * x, ROTATION_WEIGHT_M * y, ROTATION_WEIGHT_M * z
        else:
            J[0, k], J[1, k], J[2, k] = x, y, z
            J[3, k] = J[4, k] = J[5, k] = 0.0
    return np.abs(e).max()


@njit(cache=True)
def _newton(b: Body, q: Array, e: Array, J: Array, caution: float) -> None:
    # Joints that would leave their range are held at its end and the others solve again.
    n = q.size
    free, dq = np.ones(n), np.zeros(n)
    damping = DAMPING + caution * min(e @ e, 0.2)  # type: ignore[operator]
    for _ in range(n):
        F = J * free
        dq = F.T @ np.linalg.solve(F @ F.T + damping * np.eye(6), e)
        dq *= LONGEST_RAD / max(np.abs(dq).max(), LONGEST_RAD)
        stuck = False
        for i in range(n):
            if free[i] > 0.5 and (
                (dq[i] < 0.0 and q[i] <= b.low[i] + 1e-12) or (dq[i] > 0.0 and q[i] >= b.high[i] - 1e-12)
            ):
                free[i], stuck = 0.0, True
        if not stuck:
            break
    for i in range(n):
        q[i] = min(max(q[i] + dq[i], b.low[i]), b.high[i])


@njit(cache=True)
def _wish(b: Body, q: Array, s: Sinking, tau: Array) -> None:
    # As `control.laws.nullspace`, without damping: that of an arm at rest.
    tau[:] = s.drawn @ (s.posture - q)
    for i in range(s.elbow):
        if b.hinge[i] > 0.5:
            dx, dy = b.anchor[s.elbow, 0] - b.anchor[i, 0], b.anchor[s.elbow, 1] - b.anchor[i, 1]
            tau[i] -= s.pull * (b.axis[i, 0] * dy - b.axis[i, 1] * dx)
    for i in range(q.size):
        if q[i] < b.low[i] + s.margin:
            tau[i] += s.stiffness * (b.low[i] + s.margin - q[i])
        elif q[i] > b.high[i] - s.margin:
            tau[i] -= s.stiffness * (q[i] - b.high[i] + s.margin)
