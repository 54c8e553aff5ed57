"""Unit quaternions, scalar first (η, ε), rotating body into deck (on land: world); compiled, one sample at a time.

| symbol | name | unit |
|---|---|---|
| q = (η, ε) | `q` (4,) | 1 |
| S(a) b = a × b | `skew` (3, 3) | |
| R | `matrix` (3, 3), body to deck | 1 |
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]


@njit(cache=True)
def sgn(x: float) -> float:
    """Sign with sgn(0) = +1. Source: (18)."""
    return 1.0 if x >= 0.0 else -1.0  # (18)


@njit(cache=True)
def cross(a: Array, b: Array) -> Array:
    """Cross product a × b, (3,), of two vectors (3,); its unit is the product of theirs."""
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


@njit(cache=True)
def turned(R: Array, a: Array) -> Array:
    """R a, (3,), in the unit of a (3,); R (3, 3). A tenth of what a call of BLAS costs at this size."""
    return np.array(
        [
            R[0, 0] * a[0] + R[0, 1] * a[1] + R[0, 2] * a[2],
            R[1, 0] * a[0] + R[1, 1] * a[1] + R[1, 2] * a[2],
            R[2, 0] * a[0] + R[2, 1] * a[1] + R[2, 2] * a[2],
        ]
    )


@njit(cache=True)
def turned_back(R: Array, a: Array) -> Array:
    """Rᵀ a, (3,), in the unit of a (3,); R (3, 3)."""
    return np.array(
        [
            R[0, 0] * a[0] + R[1, 0] * a[1] + R[2, 0] * a[2],
            R[0, 1] * a[0] + R[1, 1] * a[1] + R[2, 1] * a[2],
            R[0, 2] * a[0] + R[1, 2] * a[1] + R[2, 2] * a[2],
        ]
    )


@njit(cache=True)
def skew(a: Array) -> Array:
    """S(a), (3, 3), in the unit of a (3,), with S(a) b = a × b."""
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


@njit(cache=True)
def conjugate(q: Array) -> Array:
    """q⁻¹ of a unit quaternion (4,)."""
    return np.array([q[0], -q[1], -q[2], -q[3]])


@njit(cache=True)
def multiply(a: Array, b: Array) -> Array:
    """Hamilton product a ⊗ b, (4,), of quaternions (4,)."""
    return np.array(
        [
            a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
            a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
            a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
            a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
        ]
    )


@njit(cache=True)
def matrix(q: Array) -> Array:
    """Rotation matrix R (3, 3) of a unit quaternion (4,): v_deck = R v_body."""
    w, x, y, z = q[0], q[1], q[2], q[3]
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


@njit(cache=True)
def error(q_d: Array, q: Array) -> Array:
    """Attitude error q_e = q_d⁻¹ ⊗ q, (4,), of unit quaternions (4,). Source: (15)."""
    return multiply(conjugate(q_d), q)  # (15)


@njit(cache=True)
def angle(q: Array) -> float:
    """Rotation angle of a unit quaternion (4,), rad, in [0, π]; the same for q and −q."""
    sine = np.sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    return float(2.0 * np.arctan2(sine, abs(q[0])))


@njit(cache=True)
def from_rotation_vector(a: Array) -> Array:
    """Unit quaternion (4,) of a rotation by |a| rad about a, (3,)."""
    theta = np.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
    half = 0.5 * theta
    # sin(θ/2)/θ by its series near zero, where the quotient loses all digits.
    scale = 0.5 - theta * theta / 48.0 if theta < 1e-4 else np.sin(half) / theta
    return np.array([np.cos(half), scale * a[0], scale * a[1], scale * a[2]])


@njit(cache=True)
def rotation_error(R: Array, R_d: Array) -> Array:
    """Rotation vector (3,), rad, outer axes, that turns R into R_d; exact up to π. Both (3, 3)."""
    E = np.zeros((3, 3))
    for i in range(3):
        for j in range(3):
            for k in range(3):
                E[i, j] += R_d[i, k] * R[j, k]
    axis = np.array([E[2, 1] - E[1, 2], E[0, 2] - E[2, 0], E[1, 0] - E[0, 1]])
    sine = 0.5 * np.sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2])
    cosine = 0.5 * (E[0, 0] + E[1, 1] + E[2, 2] - 1.0)
    theta = np.arctan2(sine, cosine)
    if sine > 1e-9:
        return axis * (0.5 * theta / sine)
    if cosine > 0.0:
        return 0.5 * axis
    # θ = π: the axis is the column of E + I with the largest diagonal element.
    k = 0
    for i in range(1, 3):
        if E[i, i] > E[k, k]:
            k = i
    column = E[:, k].copy()
    column[k] += 1.0
    return column * (np.pi / np.sqrt(column[0] ** 2 + column[1] ** 2 + column[2] ** 2))


@njit(cache=True)
def quaternion_of(R: Array) -> Array:
    """Unit quaternion (4,) of a rotation matrix (3, 3); of both the one whose largest element is positive."""
    q = np.empty(4)
    trace = R[0, 0] + R[1, 1] + R[2, 2]
    if trace > 0.0:
        s = np.sqrt(trace + 1.0) * 2.0
        q[0], q[1], q[2], q[3] = 0.25 * s, (R[2, 1] - R[1, 2]) / s, (R[0, 2] - R[2, 0]) / s, (R[1, 0] - R[0, 1]) / s
        return q
    k = 0
    for i in range(1, 3):
        if R[i, i] > R[k, k]:
            k = i
    a, b = (k + 1) % 3, (k + 2) % 3
    s = np.sqrt(1.0 + R[k, k] - R[a, a] - R[b, b]) * 2.0
    q[0], q[1 + k] = (R[b, a] - R[a, b]) / s, 0.25 * s
    q[1 + a], q[1 + b] = (R[a, k] + R[k, a]) / s, (R[b, k] + R[k, b]) / s
    return q
