"""A platform on six legs: lengths of the legs from its pose, and the pose from the lengths; compiled.

| symbol | name | unit, frame |
|---|---|---|
| b_i | `feet` (6, 3): joints of the legs on the deck | m, D |
| p_i | `heads` (6, 3): those on the platform, from its middle | m, P |
| c | `middle` (3,): where the platform's middle is in its neutral pose | m, D |
| x | pose (6,): displacement of the middle, yaw, pitch, roll: R = Rz Ry Rx | m, rad, D |
| l_i | |c + d + R p_i − b_i| (H.1), d the displacement | m |
| J | (6, 6), l̇ = J ẋ: row i [u_iᵀ, u_iᵀ ∂(R p_i)/∂angles], u_i along the leg (H.2) | 1, m |

Six feet and six heads on circles, in pairs; a foot's pair stands between two heads' pairs, as in Stewart's platform.
"""

import numpy as np
from numba import njit

from armland.rotations import Array

PAIR_RAD = 0.35
"""Angle between the two joints of a pair, seen from the middle; assumption."""

STEPS, CLOSE_M = 8, 1e-10
"""Most steps of Newton's method, and the error of a leg's length that ends it: from tick to tick one or two are enough."""


def joints_of(foot_radius: float, head_radius: float, below: float) -> tuple[Array, Array]:
    """Feet (6, 3), m, from a point on the deck below the middle, and heads (6, 3), m, from the middle.

    Args:
        foot_radius: of the feet's circle, m.
        head_radius: of the heads', m.
        below: how far below the middle the heads are, m.
    """
    feet, heads = np.zeros((6, 3)), np.zeros((6, 3))
    for i in range(6):
        third, side = i // 2, 1.0 if i % 2 else -1.0
        foot = 2.0 * np.pi / 3.0 * third + side * 0.5 * PAIR_RAD
        # The head of a leg stands a sixth of a turn beside its foot.
        head = 2.0 * np.pi / 3.0 * third + side * (np.pi / 3.0 - 0.5 * PAIR_RAD)
        feet[i] = [foot_radius * np.cos(foot), foot_radius * np.sin(foot), 0.0]
        heads[i] = [head_radius * np.cos(head), head_radius * np.sin(head), -below]
    return feet, heads


@njit(cache=True)
def attitude(x: Array) -> Array:
    """R (3, 3), D<-P, of a pose x (6,), m and rad."""
    cz, sz, cy, sy, cx, sx = np.cos(x[3]), np.sin(x[3]), np.cos(x[4]), np.sin(x[4]), np.cos(x[5]), np.sin(x[5])
    return np.array(
        [
            [cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx],
            [sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx],
            [-sy, cy * sx, cy * cx],
        ]
    )


@njit(cache=True)
def legs(x: Array, middle: Array, feet: Array, heads: Array) -> Array:
    """l (6,), m, of a pose x (6,), m and rad; `middle` (3,), `feet` and `heads` (6, 3), m."""
    R, out = attitude(x), np.empty(6)
    for i in range(6):
        square = 0.0
        for k in range(3):
            along = middle[k] + x[k] - feet[i, k]
            for j in range(3):
                along += R[k, j] * heads[i, j]
            square += along * along
        out[i] = np.sqrt(square)  # (H.1)
    return out


@njit(cache=True)
def leg_rates(x: Array, middle: Array, feet: Array, heads: Array) -> Array:
    """J (6, 6), 1 and m, at a pose x (6,), m and rad; the others as for `legs`."""
    R, J = attitude(x), np.empty((6, 6))
    # Axes about which yaw, pitch and roll turn: z, then y turned by yaw, then x turned by both.
    axes = np.zeros((3, 3))
    axes[0, 2] = 1.0
    axes[1, 0], axes[1, 1] = -np.sin(x[3]), np.cos(x[3])
    axes[2, 0], axes[2, 1], axes[2, 2] = R[0, 0], R[1, 0], R[2, 0]
    u, arm = np.empty(3), np.empty(3)
    for i in range(6):
        length = 0.0
        for k in range(3):
            arm[k] = 0.0
            for j in range(3):
                arm[k] += R[k, j] * heads[i, j]
            u[k] = middle[k] + x[k] + arm[k] - feet[i, k]
            length += u[k] * u[k]
        length = np.sqrt(length)
        for k in range(3):
            u[k] /= length
            J[i, k] = u[k]
        for a in range(3):
            w = axes[a]
            J[i, 3 + a] = (
                u[0] * (w[1] * arm[2] - w[2] * arm[1])
                + u[1] * (w[2] * arm[0] - w[0] * arm[2])
                + u[2] * (w[0] * arm[1] - w[1] * arm[0])
            )  # (H.2)
    return J


@njit(cache=True)
def pose(lengths: Array, guess: Array, middle: Array, feet: Array, heads: Array) -> Array:
    """x (6,), m and rad, with legs of `lengths` (6,), m, near `guess` (6,); the others as for `legs`."""
    x = guess.copy()
    for _ in range(STEPS):
        error = lengths - legs(x, middle, feet, heads)
        if np.abs(error).max() < CLOSE_M:
            break
        x += np.linalg.solve(leg_rates(x, middle, feet, heads), error)
    return x
