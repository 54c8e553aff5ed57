"""Kinematics and dynamics of one serial chain from MuJoCo's arrays, compiled; the inner part of `arm.ArmModel`."""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.models.operational import operational_inertia
from armland.records import Record
from armland.rotations import Array


@njit(cache=True)
def evaluate(
    axis: Array,
    anchor: Array,
    position: Array,
    rotation: Array,
    subtree_com: Array,
    inertia: Array,
    bias: Array,
    qd: Array,
    velocity_terms: bool,
    c_: NDArray[np.void],
    s_: NDArray[np.void],
) -> None:
    """Fill the arm's state: 𝒥 and gravity from the joints' axes and anchors, M from MuJoCo's sparse lower triangle, Λ of both.

    Args:
        axis: joint axes (n, 3), world.
        anchor: a point on each axis (n, 3), m, world.
        position: of the end effector (3,), m, world.
        rotation: of the end effector (9,), world.
        subtree_com: centre of mass behind each body (bodies, 3), m, world.
        inertia: nonzeros of M's lower triangle.
        bias: C φ̇ + g (n,), N·m; read with `velocity_terms` only.
        qd: joint velocities (n,).
        velocity_terms: whether C φ̇ and 𝒥̇ φ̇ are filled too.
        c_: what never changes (1,), see `arm.ArmModel`.
        s_: receives the result (1,), `arm.state_layout`.
    """
    c, s = c_[0], s_[0]
    for i in range(axis.shape[0]):
        for k in range(3):
            s.axis[i, k] = axis[i, k]
            s.anchor[i, k] = anchor[i, k]
    for i in range(3):
        s.position[i] = position[i]
        for k in range(3):
            s.rotation[i, k] = rotation[3 * i + k]
    for i in range(c.row.shape[0]):
        s.mass_matrix[c.row[i], c.column[i]] = inertia[i]
        s.mass_matrix[c.column[i], c.row[i]] = inertia[i]
    for i in range(axis.shape[0]):
        # Written out: a 3-vector in compiled code is an allocation, and this runs for every joint of every tick.
        a0, a1, a2 = axis[i, 0], axis[i, 1], axis[i, 2]
        o0, o1, o2 = anchor[i, 0], anchor[i, 1], anchor[i, 2]
        b, moves = c.body[i], c.moves_ee[i]
        f0, f1, f2 = c.weight[i, 0], c.weight[i, 1], c.weight[i, 2]
        if c.hinge[i]:
            d0, d1, d2 = subtree_com[b, 0] - o0, subtree_com[b, 1] - o1, subtree_com[b, 2] - o2
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
    operational_inertia(s.mass_matrix, s.jacobian, s.lambda_ee)
    if velocity_terms:
        _velocity_terms(bias, qd, c, s)


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
