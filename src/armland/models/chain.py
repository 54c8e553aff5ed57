"""Kinematics and dynamics of one serial chain, compiled: MuJoCo's functions and what the laws need beyond them.

| symbol | name | unit |
|---|---|---|
| φ̇ (n,) | `qvel` | rad/s |
| 𝒥 (6, n) | `jacobian`: end effector point, axes of the arm's base, linear rows first | m, 1 |
| M (n, n) | `mass_matrix`, reflected motor inertia included | kg·m² |
| g (n,) | `gravity` | N·m |
| Λ = (𝒥 M⁻¹ 𝒥ᵀ)⁻¹ (4) | `lambda_ee` (6, 6) | kg, kg·m² |
| C φ̇ (n,), 𝒥̇ φ̇ (6,) | `coriolis`, `acceleration_bias` | N·m; m/s², rad/s² |
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from armland.models.operational import operational_inertia
from armland.native import (
    mj_comPos,
    mj_comVel,
    mj_factorM,
    mj_jacDot,
    mj_kinematics,
    mj_makeM,
    mj_rne,
    mj_solveM,
)
from armland.records import Record, Records
from armland.rotations import Array


def state_layout(joints: int) -> np.dtype:
    """What `refresh` evaluates, as one record that compiled laws take."""
    return np.dtype(
        [
            ("jacobian", "f8", (6, joints)),
            ("mass_matrix", "f8", (joints, joints)),
            ("gravity", "f8", (joints,)),
            ("cholesky", "f8", (joints, joints)),  # of M, lower
            ("lambda_ee", "f8", (6, 6)),
            ("position", "f8", (3,)),
            ("rotation", "f8", (3, 3)),
            ("axis", "f8", (joints, 3)),  # joint axes, axes of the arm's base
            ("anchor", "f8", (joints, 3)),  # a point on each axis, m
            ("coriolis", "f8", (joints,)),  # C φ̇, N·m; only where velocity terms are asked for
            ("acceleration_bias", "f8", (6,)),  # 𝒥̇ φ̇, m/s², rad/s²; likewise
        ]
    )


def constants_layout(joints: int, nonzeros: int) -> np.dtype:
    """What never changes: of each joint, and where the `nonzeros` of M's lower triangle stand."""
    return np.dtype(
        [
            ("hinge", "i8", (joints,)),  # 1: hinge, 0: slide
            ("moves_ee", "i8", (joints,)),
            ("body", "i8", (joints,)),
            ("mass", "f8", (joints,)),  # of the subtree behind the joint, kg
            ("row", "i8", (nonzeros,)),
            ("column", "i8", (nonzeros,)),
            ("ee_body", "i8"),
        ]
    )


class Views(NamedTuple):
    """An arm model for compiled code: where MuJoCo keeps it, and views of what goes in and comes out."""

    model: int
    """Address of the `MjModel`."""
    data: int
    """Address of the `MjData`."""
    qpos: Array
    """Joint positions (n,), rad or m: set them before `refresh`."""
    qvel: Array
    """Joint velocities (n,), rad/s or m/s: likewise."""
    gravity: Array
    """(3,) m/s², axes of the arm's base: see `feel`."""
    axis: Array
    """Joint axes (n, 3)."""
    anchor: Array
    """A point on each axis (n, 3), m."""
    position: Array
    """Of the end effector (3,), m."""
    rotation: Array
    """Of the end effector (9,)."""
    subtree_com: Array
    """Centre of mass behind each body (bodies, 3), m."""
    inertia: Array
    """Nonzeros of M's lower triangle."""
    bias: Array
    """C φ̇ + g (n,), N·m."""
    constants: Records
    """(1,) of `constants_layout`."""
    com: Array
    """Centre of mass of each body (bodies, 3), m, axes of the arm's base."""
    principal: Array
    """Rotation (bodies, 9) to its principal axes."""
    mass: Array
    """(bodies,), kg."""
    moments: Array
    """Principal moments of inertia (bodies, 3), kg·m²."""
    behind: Array
    """(n, bodies), 1 where the joint moves the body, else 0."""


@njit(cache=True)
def feel(views: Views, environment: Record, carried: bool = True) -> None:
    """Give the arm the gravity that its base feels, (3,) m/s²: that of `environment` less the base's acceleration, where `carried`."""
    for i in range(3):
        views.gravity[i] = environment.gravity[i] - (environment.base_a[i] if carried else 0.0)


@njit(cache=True)
def refresh(views: Views, s: Record, velocity_terms: bool) -> None:
    """Evaluate the arm at `views.qpos`, `views.qvel` into the record `s`, `state_layout`.

    Args:
        views: of the arm model.
        s: written.
        velocity_terms: whether C φ̇ and 𝒥̇ φ̇ are evaluated too; else they keep what they hold.
    """
    mj_kinematics(views.model, views.data)
    mj_comPos(views.model, views.data)
    mj_makeM(views.model, views.data)
    _joints(views, views.constants[0], s)
    operational_inertia(s.mass_matrix, s.jacobian, s.cholesky, s.lambda_ee)
    if velocity_terms:
        bias(views)
        _velocity_terms(views.bias, views.qvel, views.constants[0], s)


@njit(cache=True)
def bias(views: Views) -> None:
    """Evaluate C φ̇ + g into `views.bias` (n,), N·m, at the positions last refreshed and the velocities in `views.qvel`."""
    mj_comVel(views.model, views.data)
    mj_rne(views.model, views.data, 0, views.bias.ctypes.data)


@njit(cache=True)
def coriolis_wrench(views: Views, s: Record, twist: Array, wrench: Array) -> None:
    """μ ẋ_d into `wrench` (6,), N, N·m, for a desired `twist` (6,), m/s, rad/s, at the last `refresh` into `s`.

    μ = Λ (𝒥 M⁻¹ C − 𝒥̇) 𝒥̄ with C of Christoffel symbols: C(φ, φ̇) b = ½ [h(φ̇ + b) − h(φ̇) − h(b)], h the velocity-product torque.
    Source: (3); the factorisation is ours.
    """
    n = views.qvel.shape[0]
    qd, force, b, product = views.qvel.copy(), np.zeros(n), np.zeros(n), np.zeros(n)
    for i in range(n):
        for k in range(6):
            for j in range(6):
                force[i] += s.jacobian[k, i] * s.lambda_ee[k, j] * twist[j]
    mj_factorM(views.model, views.data)
    mj_solveM(views.model, views.data, b.ctypes.data, force.ctypes.data, 1)  # b = 𝒥̄ ẋ_d
    for ahead, still, sign in ((1.0, 1.0, 0.5), (1.0, 0.0, -0.5), (0.0, 1.0, -0.5)):
        for i in range(n):
            views.qvel[i] = ahead * qd[i] + still * b[i]
        bias(views)
        for i in range(n):
            product[i] += sign * (views.bias[i] - s.gravity[i])
    views.qvel[:] = qd
    mj_comVel(views.model, views.data)
    rate, point = np.zeros((2, 3, n)), views.position.copy()
    c = views.constants[0]
    mj_jacDot(views.model, views.data, rate[0].ctypes.data, rate[1].ctypes.data, point.ctypes.data, np.int32(c.ee_body))
    mj_solveM(views.model, views.data, force.ctypes.data, product.ctypes.data, 1)
    for j in range(6):
        wrench[j] = 0.0
    for k in range(6):
        acceleration = 0.0
        for i in range(n):
            acceleration += s.jacobian[k, i] * force[i] - rate[k // 3, k % 3, i] * b[i]
        for j in range(6):
            wrench[j] += s.lambda_ee[j, k] * acceleration  # (3)


@njit(cache=True)
def _joints(views: Views, c: Record, s: Record) -> None:
    # 𝒥 and gravity from the joints' axes and anchors, M from MuJoCo's sparse lower triangle.
    axis, anchor, position, g = views.axis, views.anchor, views.position, views.gravity
    for i in range(axis.shape[0]):
        for k in range(3):
            s.axis[i, k] = axis[i, k]
            s.anchor[i, k] = anchor[i, k]
    for i in range(3):
        s.position[i] = position[i]
        for k in range(3):
            s.rotation[i, k] = views.rotation[3 * i + k]
    for i in range(c.row.shape[0]):
        s.mass_matrix[c.row[i], c.column[i]] = views.inertia[i]
        s.mass_matrix[c.column[i], c.row[i]] = views.inertia[i]
    for i in range(axis.shape[0]):
        # Written out: a 3-vector in compiled code is an allocation, and this runs for every joint of every tick.
        a0, a1, a2 = axis[i, 0], axis[i, 1], axis[i, 2]
        o0, o1, o2 = anchor[i, 0], anchor[i, 1], anchor[i, 2]
        b, moves = c.body[i], c.moves_ee[i]
        # Force that holds up the subtree behind the joint, N.
        f0, f1, f2 = -c.mass[i] * g[0], -c.mass[i] * g[1], -c.mass[i] * g[2]
        if c.hinge[i]:
            d0, d1, d2 = views.subtree_com[b, 0] - o0, views.subtree_com[b, 1] - o1, views.subtree_com[b, 2] - o2
            s.gravity[i] = f0 * (a1 * d2 - a2 * d1) + f1 * (a2 * d0 - a0 * d2) + f2 * (a0 * d1 - a1 * d0)
            d0, d1, d2 = position[0] - o0, position[1] - o1, position[2] - o2
            s.jacobian[0, i] = moves * (a1 * d2 - a2 * d1)
            s.jacobian[1, i] = moves * (a2 * d0 - a0 * d2)
            s.jacobian[2, i] = moves * (a0 * d1 - a1 * d0)
            s.jacobian[3, i], s.jacobian[4, i], s.jacobian[5, i] = moves * a0, moves * a1, moves * a2
        else:
            s.gravity[i] = f0 * a0 + f1 * a1 + f2 * a2
            s.jacobian[0, i], s.jacobian[1, i], s.jacobian[2, i] = moves * a0, moves * a1, moves * a2
            s.jacobian[3, i], s.jacobian[4, i], s.jacobian[5, i] = 0.0, 0.0, 0.0


@njit(cache=True)
def _velocity_terms(bias: Array, qd: Array, c: Record, s: Record) -> None:
    # 𝒥̇ φ̇ is the end effector's acceleration with φ̈ = 0, carried from joint to joint along the chain. Written out:
    # every 3-vector would be an allocation.
    w0 = w1 = w2 = b0 = b1 = b2 = a0 = a1 = a2 = 0.0
    n = qd.shape[0]
    for i in range(n + 1):
        if i > 0:
            d0, d1, d2 = -s.anchor[i - 1, 0], -s.anchor[i - 1, 1], -s.anchor[i - 1, 2]
            if i < n:
                d0, d1, d2 = d0 + s.anchor[i, 0], d1 + s.anchor[i, 1], d2 + s.anchor[i, 2]
            else:
                d0, d1, d2 = d0 + s.position[0], d1 + s.position[1], d2 + s.position[2]
            # α × d + ω × (ω × d) = α × d + ω (ω·d) − d |ω|²
            along, square = w0 * d0 + w1 * d1 + w2 * d2, w0 * w0 + w1 * w1 + w2 * w2
            a0 += b1 * d2 - b2 * d1 + w0 * along - d0 * square
            a1 += b2 * d0 - b0 * d2 + w1 * along - d1 * square
            a2 += b0 * d1 - b1 * d0 + w2 * along - d2 * square
        if i == n:
            break
        s.coriolis[i] = bias[i] - s.gravity[i]
        r0, r1, r2 = s.axis[i, 0] * qd[i], s.axis[i, 1] * qd[i], s.axis[i, 2] * qd[i]
        x0, x1, x2 = w1 * r2 - w2 * r1, w2 * r0 - w0 * r2, w0 * r1 - w1 * r0
        if c.hinge[i]:
            b0, b1, b2 = b0 + x0, b1 + x1, b2 + x2
            w0, w1, w2 = w0 + r0, w1 + r1, w2 + r2
        else:
            a0, a1, a2 = a0 + 2.0 * x0, a1 + 2.0 * x1, a2 + 2.0 * x2
    s.acceleration_bias[0], s.acceleration_bias[1], s.acceleration_bias[2] = a0, a1, a2
    s.acceleration_bias[3], s.acceleration_bias[4], s.acceleration_bias[5] = b0, b1, b2
